//! The scenes of the hard cases that a scene file can say: those under `assets/scenes/hard`, embedded. A case moves the
//! camera and turns numbers from there.

use scene::glam::Vec3;
use scene::{Camera, Geometry, Scene, SceneError};
use std::path::Path;

/// Names and texts.
pub const FILES: &[(&str, &str)] = &[
    ("camera-inside-glass", include_str!("../../../assets/scenes/hard/camera-inside-glass.toml")),
    ("closed-box", include_str!("../../../assets/scenes/hard/closed-box.toml")),
    ("disk-touching", include_str!("../../../assets/scenes/hard/disk-touching.toml")),
    ("edge-on-light", include_str!("../../../assets/scenes/hard/edge-on-light.toml")),
    ("glass-sphere-in-furnace", include_str!("../../../assets/scenes/hard/glass-sphere-in-furnace.toml")),
    ("index-one", include_str!("../../../assets/scenes/hard/index-one.toml")),
    ("light-tight-box", include_str!("../../../assets/scenes/hard/light-tight-box.toml")),
    ("light-touching-wall", include_str!("../../../assets/scenes/hard/light-touching-wall.toml")),
    ("mirror-box", include_str!("../../../assets/scenes/hard/mirror-box.toml")),
    ("nested-glass", include_str!("../../../assets/scenes/hard/nested-glass.toml")),
    ("point-light-in-sphere", include_str!("../../../assets/scenes/hard/point-light-in-sphere.toml")),
    ("rectangle-light", include_str!("../../../assets/scenes/hard/rectangle-light.toml")),
    ("slab", include_str!("../../../assets/scenes/hard/slab.toml")),
    ("sphere-light", include_str!("../../../assets/scenes/hard/sphere-light.toml")),
    ("white-furnace", include_str!("../../../assets/scenes/hard/white-furnace.toml")),
];

/// The scene of this name.
///
/// # Errors
/// [`SceneError`] for an unknown name, or a file that holds no scene.
pub fn scene(name: &str) -> Result<Scene, SceneError> {
    match FILES.iter().find(|(known, _)| *known == name) {
        Some((name, text)) => scene::parse(text, name, Path::new(name)),
        None => {
            let known = FILES.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
            Err(SceneError::Unknown { name: name.to_owned(), known })
        }
    }
}

/// A scene of [`FILES`].
#[expect(clippy::expect_used, reason = "the files are embedded, and a test loads each of them")]
pub(crate) fn known(name: &str) -> Scene {
    scene(name).expect("an embedded scene")
}

/// A camera that sees nothing but a spot of `target`, from `eye`.
pub(crate) fn spot(eye: Vec3, target: Vec3) -> Camera {
    let along = (target - eye).normalize_or_zero();
    let up = if along.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
    Camera { eye, target, up, fov_y: 1e-7, near: 1e-3, far: 1e4 }
}

/// The scene with another list of shapes.
pub(crate) fn with_geometry(mut scene: Scene, change: impl Fn(usize, &mut Geometry)) -> Scene {
    let mut shapes = scene.shapes.to_vec();
    for (index, shape) in shapes.iter_mut().enumerate() {
        change(index, &mut shape.geometry);
    }
    scene.shapes = shapes.into();
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_hard_scene_loads_and_every_file_is_listed() {
        for (name, _) in FILES {
            let loaded = scene(name).unwrap();
            assert!(!loaded.shapes.is_empty(), "{name}");
        }
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/hard");
        assert_eq!(std::fs::read_dir(folder).unwrap().count(), FILES.len());
        assert!(scene("unheard-of").is_err());
    }
}
