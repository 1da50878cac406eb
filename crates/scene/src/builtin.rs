//! The scenes that are part of the program: the same files as under `assets/scenes`, embedded.

use crate::progress::Progress;
use crate::{Scene, SceneError, file, nearest};
use std::path::Path;

const FILES: [(&str, &str); 8] = [
    ("whitted", include_str!("../../../assets/scenes/whitted.toml")),
    ("cornell", include_str!("../../../assets/scenes/cornell.toml")),
    ("phong", include_str!("../../../assets/scenes/phong.toml")),
    ("cornell-balls", include_str!("../../../assets/scenes/cornell-balls.toml")),
    ("veach", include_str!("../../../assets/scenes/veach.toml")),
    ("caustic", include_str!("../../../assets/scenes/caustic.toml")),
    ("door-ajar", include_str!("../../../assets/scenes/door-ajar.toml")),
    ("statues", include_str!("../../../assets/scenes/statues.toml")),
];

/// Scenes with known answers, which hard cases are made of: `hard/NAME`.
const HARD: [(&str, &str); 20] = [
    ("hard/ball-on-floor", include_str!("../../../assets/scenes/hard/ball-on-floor.toml")),
    ("hard/ball-on-mirror", include_str!("../../../assets/scenes/hard/ball-on-mirror.toml")),
    ("hard/camera-inside-glass", include_str!("../../../assets/scenes/hard/camera-inside-glass.toml")),
    ("hard/closed-box", include_str!("../../../assets/scenes/hard/closed-box.toml")),
    ("hard/crossing-lamps", include_str!("../../../assets/scenes/hard/crossing-lamps.toml")),
    ("hard/disk-touching", include_str!("../../../assets/scenes/hard/disk-touching.toml")),
    ("hard/edge-on-light", include_str!("../../../assets/scenes/hard/edge-on-light.toml")),
    ("hard/far-lamp", include_str!("../../../assets/scenes/hard/far-lamp.toml")),
    ("hard/glass-sphere-in-furnace", include_str!("../../../assets/scenes/hard/glass-sphere-in-furnace.toml")),
    ("hard/index-one", include_str!("../../../assets/scenes/hard/index-one.toml")),
    ("hard/light-tight-box", include_str!("../../../assets/scenes/hard/light-tight-box.toml")),
    ("hard/light-touching-wall", include_str!("../../../assets/scenes/hard/light-touching-wall.toml")),
    ("hard/mirror-box", include_str!("../../../assets/scenes/hard/mirror-box.toml")),
    ("hard/nested-glass", include_str!("../../../assets/scenes/hard/nested-glass.toml")),
    ("hard/point-light-in-sphere", include_str!("../../../assets/scenes/hard/point-light-in-sphere.toml")),
    ("hard/rectangle-light", include_str!("../../../assets/scenes/hard/rectangle-light.toml")),
    ("hard/slab", include_str!("../../../assets/scenes/hard/slab.toml")),
    ("hard/sphere-light", include_str!("../../../assets/scenes/hard/sphere-light.toml")),
    ("hard/whispering-gallery", include_str!("../../../assets/scenes/hard/whispering-gallery.toml")),
    ("hard/white-furnace", include_str!("../../../assets/scenes/hard/white-furnace.toml")),
];

/// Names of the hard scenes, as [`named`] takes them.
pub fn hard_names() -> impl Iterator<Item = &'static str> {
    HARD.iter().map(|(name, _)| *name)
}

/// Names of the built-in scenes, the viewer's first one first.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

/// The file of a built-in scene.
pub fn text(name: &str) -> Option<&'static str> {
    FILES.iter().chain(&HARD).find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// What a built-in scene is, in a sentence or two: the comment at the head of its file.
pub fn about(name: &str) -> Option<String> {
    let comment = text(name)?.lines().map_while(|line| line.strip_prefix('#'));
    Some(comment.map(str::trim).collect::<Vec<_>>().join(" "))
}

/// A scene by built-in name, or from a file if `name` has a suffix or a folder in it.
///
/// # Errors
/// [`SceneError::Unknown`] lists the known names; the others say which file, line and column is wrong.
pub fn named(name: &str) -> Result<Scene, SceneError> {
    named_telling(name, &Progress::untold())
}

/// As [`named`], telling how far it is.
///
/// # Errors
/// As those of [`named`], and [`SceneError::Stopped`].
pub fn named_telling(name: &str, progress: &Progress) -> Result<Scene, SceneError> {
    if let Some(text) = text(name) {
        return file::parse_telling(text, name, Path::new(name), progress);
    }
    let path = Path::new(name);
    if name == "hard/?" {
        return Err(unknown(name, hard_names().collect::<Vec<_>>().join(", ")));
    }
    if name.starts_with("hard/") && !path.is_file() {
        return Err(unknown(name, format!("{} and those that hard/? lists", names().collect::<Vec<_>>().join(", "))));
    }
    let like_a_file = path.extension().is_some() || path.components().count() > 1 || path.exists();
    if like_a_file { file::load(path, progress) } else { Err(unknown(name, names().collect::<Vec<_>>().join(", "))) }
}

fn unknown(name: &str, known: String) -> SceneError {
    let meant = nearest(name, names().chain(hard_names())).map(str::to_owned);
    SceneError::Unknown { name: name.to_owned(), known, meant }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bsdf, Geometry, Vec3};

    #[test]
    fn every_scene_loads_and_every_hard_file_is_listed() {
        for name in names().chain(hard_names()) {
            assert!(!named(name).unwrap().shapes.is_empty(), "{name}");
            assert!(about(name).is_some_and(|about| about.len() > 20 && about.ends_with('.')), "{name}");
        }
        assert!(named("hard/?").unwrap_err().to_string().contains("hard/slab"));
        assert!(named("cornel").unwrap_err().to_string().ends_with("; did you mean cornell?"));
        assert!(named("hard/slap").unwrap_err().to_string().ends_with("; did you mean hard/slab?"));
        let line = named("hard/foo").unwrap_err().to_string();
        assert!(line.contains("hard/? lists") && !line.contains("hard/slab"), "{line}");
        assert!(!named("nothing").unwrap_err().to_string().contains("mean"));
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/hard");
        assert_eq!(std::fs::read_dir(folder).unwrap().count(), HARD.len());
    }

    /// Radiance times area, in luminance. Numbers in the file have four digits.
    #[test]
    fn veachs_lamps_are_of_one_power_and_of_four_sizes() {
        let scene = named("veach").unwrap();
        let lamps: Vec<(f32, f32)> = (scene.shapes.iter())
            .filter_map(|shape| {
                let Geometry::Sphere { radius, .. } = shape.geometry else { return None };
                let radiance = scene.material_of(shape).emission?.radiance;
                Some((radius, radiance.dot(Vec3::new(0.2126, 0.7152, 0.0722)) * radius * radius))
            })
            .collect();
        assert_eq!(lamps.len(), 4);
        assert!(lamps.iter().all(|(_, power)| (power / lamps[0].1 - 1.0).abs() < 1e-3), "{lamps:?}");
        assert!(lamps.windows(2).all(|two| two[1].0 > 2.9 * two[0].0), "{lamps:?}");
    }

    /// Corners in the file have three digits, which turn a plate by up to a thousandth: 0.01 at the lamps' distance.
    #[test]
    fn veachs_plates_mirror_the_middle_of_the_lamps_into_the_camera_the_smoothest_behind() {
        let scene = named("veach").unwrap();
        let lamps = Vec3::new(0.0, 4.2, 0.0);
        let mut roughnesses = Vec::new();
        for shape in scene.shapes.iter() {
            let Bsdf::RoughConductor { roughness, .. } = scene.material_of(shape).bsdf else { continue };
            let Geometry::Rectangle { corner, edge_u, edge_v } = shape.geometry else { panic!("a plate") };
            let (middle, normal) = (corner + 0.5 * (edge_u + edge_v), edge_u.cross(edge_v).normalize());
            let mirrored = (middle - scene.camera.eye).reflect(normal).normalize();
            let past = (lamps - middle).reject_from_normalized(mirrored).length();
            assert!(past < 0.02, "the plate at {middle} shows what is {past} beside the lamps");
            roughnesses.push(roughness);
        }
        assert_eq!(roughnesses.len(), 4);
        assert!(roughnesses.is_sorted_by(|a, b| a < b), "{roughnesses:?}");
    }
}
