//! A changed scene as a file of its own, which names the scene that it is a change of and what is changed in it.

use super::session::source_from;
use anyhow::{Context, bail};
use image_file::shown;
use scene::edit::{Edits, quoted};
use scene::{Camera, Vec3, builtin};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A changed scene to write.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneToSave {
    /// What is changed, part by part.
    pub edits: Edits,
    /// Where it is seen from, if not as the scene itself says.
    pub camera: Option<Camera>,
    /// The scene as it was opened: a built-in name or a file.
    pub source: String,
}

impl SceneToSave {
    /// Writes it to a file; where there is one, to another beside it. Returns where.
    ///
    /// # Errors
    /// If its name is none of a scene, or if it cannot be written.
    pub fn save(&self, path: &Path) -> anyhow::Result<PathBuf> {
        if !path.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("toml")) {
            bail!("the name of a scene must end in .toml: {}", shown(path));
        }
        let path = std::path::absolute(path).with_context(|| format!("cannot save to {}", shown(path)))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(image_file::write_new(&path, self.text_in(folder).as_bytes())?)
    }

    /// How it is opened once it is saved here, for the message.
    pub fn how_to_open(&self, file: &Path) -> String {
        let folder = file.parent().unwrap_or(Path::new(""));
        let base = source_from(folder, &self.source);
        let is_beside = builtin::text(&base).is_some() || is_below(Path::new(&base));
        let outside =
            if is_beside { "" } else { ", with --allow-outside, for the scene that it changes lies elsewhere" };
        format!("open it as any scene: drop it here, or visavis {}{outside}", shown(file))
    }

    /// Its text for a file in this folder.
    pub fn text_in(&self, folder: &Path) -> String {
        let mut text = format!("base = {}\n", quoted(&source_from(folder, &self.source)));
        if let Some(Camera { eye, target, up, fov_y, .. }) = self.camera {
            let point = |Vec3 { x, y, z }| format!("[{x:?}, {y:?}, {z:?}]");
            let (eye, target, up) = (point(eye), point(target), point(up));
            // writing to a text does not fail
            _ = write!(text, "\n[camera]\neye = {eye}\ntarget = {target}\nup = {up}\nfov_y = {fov_y:?}\n");
        }
        if !self.edits.is_empty() {
            _ = write!(text, "\n{}", self.edits.tables());
        }
        text
    }
}

/// Whether a file lies in the folder from which it is named, or below.
fn is_below(file: &Path) -> bool {
    file.components().all(|part| matches!(part, std::path::Component::Normal(_) | std::path::Component::CurDir))
}

#[cfg(test)]
mod tests {
    use super::*;
    use visavis_tests::TestFolder;

    fn to_save(source: &str, text: &str, camera: Option<Camera>) -> SceneToSave {
        SceneToSave { edits: text.parse().expect("changes"), camera, source: source.into() }
    }

    #[test]
    fn its_text_names_the_scene_and_what_is_changed() {
        let edits = "{ material.glass.ior = 1.5, sun.elevation = 20 }";
        let of = |camera| to_save("whitted", edits, camera).text_in(Path::new("/a"));
        let tables = "\n[edit]\n\n[edit.material.glass]\nior = 1.5\n\n[edit.sun]\nelevation = 20.0\n";
        assert_eq!(of(None), format!("base = \"whitted\"\n{tables}"));
        let own = builtin::named("whitted").expect("a built-in scene").camera;
        let camera = Camera { eye: Vec3::new(1.0, 2.5, 1e-7), target: Vec3::ZERO, up: Vec3::Y, fov_y: 40.0, ..own };
        let seen = "\n[camera]\neye = [1.0, 2.5, 1e-7]\ntarget = [0.0, 0.0, 0.0]\nup = [0.0, 1.0, 0.0]\nfov_y = 40.0\n";
        assert_eq!(of(Some(camera)), format!("base = \"whitted\"\n{seen}{tables}"));
    }

    #[test]
    fn it_is_written_beside_its_scene_and_over_nothing() {
        let folder = TestFolder::new();
        let scene = folder.file("room.toml");
        std::fs::write(&scene, "").expect("a file");
        let to_save = to_save(&scene.display().to_string(), "{ sun.elevation = 20 }", None);
        let first = to_save.save(&folder.file("room-edited.toml")).expect("it can be written");
        let second = to_save.save(&folder.file("room-edited.toml")).expect("it can be written");
        assert_eq!((first, second.clone()), (folder.file("room-edited.toml"), folder.file("room-edited-2.toml")));
        let text = std::fs::read_to_string(&second).expect("a text");
        assert!(text.starts_with("base = \"room.toml\"\n"), "{text}");
        assert!(!to_save.how_to_open(&second).contains("--allow-outside"));
        std::fs::create_dir_all(folder.file("elsewhere")).expect("a folder");
        let far = to_save.how_to_open(&folder.file("elsewhere/a.toml"));
        assert!(far.contains("elsewhere/a.toml, with --allow-outside"), "{far}");
        let fault = to_save.save(&folder.file("room.png")).expect_err("no scene");
        assert!(format!("{fault:#}").contains("must end in .toml"), "{fault:#}");
    }
}
