//! The scenes that are part of the program: the same files as under `assets/scenes`, embedded.

use crate::{Scene, SceneError, file};
use std::path::Path;

const FILES: [(&str, &str); 2] = [
    ("whitted", include_str!("../../../assets/scenes/whitted.toml")),
    ("cornell", include_str!("../../../assets/scenes/cornell.toml")),
];

/// Names of the built-in scenes, the viewer's first one first.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}

/// A scene by built-in name, or from a file if `name` ends in `.toml` or has a folder in it.
///
/// # Errors
/// [`SceneError::Unknown`] lists the known names; the others say which file, line and column is wrong.
pub fn named(name: &str) -> Result<Scene, SceneError> {
    if let Some((name, text)) = FILES.iter().find(|(known, _)| *known == name) {
        return file::parse(text, name, Path::new(name));
    }
    let path = Path::new(name);
    let like_a_file = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml")) || path.components().count() > 1;
    if like_a_file || path.is_file() {
        return file::load(path);
    }
    Err(SceneError::Unknown { name: name.to_owned(), known: names().collect::<Vec<_>>().join(", ") })
}
