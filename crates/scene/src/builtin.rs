//! The scenes that are part of the program: the same files as under `assets/scenes`, embedded.

use crate::{Scene, SceneError, file, nearest};
use std::path::Path;

const FILES: [(&str, &str); 3] = [
    ("whitted", include_str!("../../../assets/scenes/whitted.toml")),
    ("cornell", include_str!("../../../assets/scenes/cornell.toml")),
    ("phong", include_str!("../../../assets/scenes/phong.toml")),
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
    if let Some(text) = text(name) {
        return file::parse(text, name, Path::new(name));
    }
    let path = Path::new(name);
    if name == "hard/?" {
        return Err(unknown(name, hard_names().collect::<Vec<_>>().join(", ")));
    }
    if name.starts_with("hard/") && !path.is_file() {
        return Err(unknown(name, format!("{} and those that hard/? lists", names().collect::<Vec<_>>().join(", "))));
    }
    let like_a_file = path.extension().is_some() || path.components().count() > 1 || path.exists();
    if like_a_file { file::load(path) } else { Err(unknown(name, names().collect::<Vec<_>>().join(", "))) }
}

fn unknown(name: &str, known: String) -> SceneError {
    let meant = nearest(name, names().chain(hard_names())).map(str::to_owned);
    SceneError::Unknown { name: name.to_owned(), known, meant }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
