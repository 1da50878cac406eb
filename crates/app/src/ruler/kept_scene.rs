//! Which scene a picture shows, as its file tells.

use scene::SceneHash;
use std::path::Path;

/// The scene that a picture's file keeps; `None` of pictures by other programs.
///
/// # Errors
/// With a line for the user where the file says how it was made, but not of which scene.
pub fn kept_scene(file: &Path) -> Result<Option<SceneHash>, String> {
    // a file that cannot be read is told by who reads the picture
    let Ok(records) = image_file::records(file) else { return Ok(None) };
    match technique::scene_hash(&records) {
        Ok(None) if records.iter().any(|(name, _)| name == "scene") => Err(made_before(file)),
        Ok(scene) => Ok(scene),
        Err(fault) => Err(format!("{fault:#}: {}", file.display())),
    }
}

/// A line on a picture whose records keep no scene.
pub fn made_before(file: &Path) -> String {
    let file = file.display();
    format!("{file} was made before scenes were kept with pictures: whether its scene has changed since cannot be told")
}
