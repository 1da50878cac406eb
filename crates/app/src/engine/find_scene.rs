//! The scene of a picture or a session: where that says, beside it, or among the files that were opened before.
//! Folders are moved and pictures are sent, so that records keep the scene's file as it was asked for; of several files of
//! that name the one counts that the picture shows, by its hash.

use super::load::{Opened, read_scene};
use super::restore::Kept;
use image_file::shown;
use scene::{Progress, SceneError, builtin};
use std::path::{Path, PathBuf};

/// The scene that a picture shows; where there is none, another one of its name.
///
/// # Errors
/// One line that says where it was looked for, or what is wrong with it.
pub fn scene_of(kept: &Kept, picture: &Path, recent: &[PathBuf], progress: &Progress) -> Result<Opened, String> {
    let (mut another, mut faults) = (None, Vec::new());
    for candidate in candidates(&kept.scene, picture, recent) {
        match read_scene(&candidate, progress) {
            Ok(opened) if kept.scene_hash.is_none_or(|then| then == opened.scene.as_read) => return Ok(opened),
            Ok(opened) => another = another.or(Some(opened)),
            Err(fault) => faults.push(fault),
        }
    }
    another.ok_or_else(|| refusal(&faults, picture))
}

/// The built-in scene of this name; or files, each once.
fn candidates(scene: &str, picture: &Path, recent: &[PathBuf]) -> Vec<String> {
    let mut found = vec![scene.to_owned()];
    let asked = Path::new(scene);
    let Some(name) = asked.file_name().filter(|_| builtin::text(scene).is_none()) else { return found };
    let beside = [picture.with_file_name(asked), picture.with_file_name(name)];
    let before = recent.iter().filter(|file| file.file_name() == Some(name)).cloned();
    for file in beside.into_iter().chain(before).filter(|file| file.is_file()) {
        let file = file.display().to_string();
        if !found.contains(&file) {
            found.push(file);
        }
    }
    found
}

fn refusal(faults: &[SceneError], picture: &Path) -> String {
    let is_missing = |fault: &&SceneError| matches!(fault, SceneError::Read { .. } | SceneError::Unknown { .. });
    let picture = shown(picture);
    match (faults.iter().find(|fault| !is_missing(fault)), faults.first()) {
        (Some(fault), _) => format!("the scene of {picture}: {fault}"),
        (None, Some(fault)) => format!(
            "the scene of {picture} is found neither where it was then, nor beside {picture}, nor among the files opened \
             before; put it there: {fault}"
        ),
        (None, None) => format!("{picture} does not say which scene it shows"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Setup;
    use scene::SceneHash;
    use visavis_tests::TestFolder;

    fn kept(scene: &str, scene_hash: Option<SceneHash>) -> Kept {
        Kept { scene: scene.to_owned(), scene_hash, setup: Setup::default(), session: None }
    }

    /// A scene of this light, and its hash.
    fn write(file: &Path, radiance: &str) -> SceneHash {
        let cornell = builtin::text("cornell").expect("a built-in scene");
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        std::fs::write(file, cornell.replace("[30, 30, 30]", &format!("[{radiance}, 1, 1]"))).expect("a file");
        builtin::named(&file.display().to_string()).expect("a scene").as_read
    }

    #[test]
    fn the_scene_of_a_picture_is_looked_for_beside_it_too() {
        let folder = TestFolder::new();
        for name in ["moved.toml", "scenes/below.toml"] {
            write(&folder.file(name), "45");
        }
        let source = |scene: &str| {
            scene_of(&kept(scene, None), &folder.file("a.png"), &[], &Progress::untold()).map(|opened| opened.source)
        };
        for (scene, file) in [("elsewhere/moved.toml", "moved.toml"), ("scenes/below.toml", "scenes/below.toml")] {
            assert_eq!(source(scene).map(PathBuf::from), Ok(folder.file(file)));
        }
        let missing = source("gone.toml").expect_err("no scene");
        assert!(missing.contains("nor beside ") && missing.contains("opened before"), "{missing}");
        assert_eq!(source("cornell"), Ok("cornell".into()));
    }

    #[test]
    fn of_several_scenes_of_a_name_the_one_is_opened_that_the_picture_shows() {
        let folder = TestFolder::new();
        let [there, beside, before] =
            ["there/a.toml", "pictures/a.toml", "before/a.toml"].map(|name| folder.file(name));
        let recent = [folder.file("before/other.toml"), before.clone()];
        let hashes = [(&there, "30"), (&beside, "40"), (&before, "50")].map(|(file, radiance)| write(file, radiance));
        let (asked, picture) = (there.display().to_string(), folder.file("pictures/a.png"));
        let source = |hash| {
            PathBuf::from(
                scene_of(&kept(&asked, hash), &picture, &recent, &Progress::untold()).expect("a scene").source,
            )
        };
        for (hash, file) in hashes.into_iter().zip([&there, &beside, &before]) {
            assert_eq!(source(Some(hash)), *file);
        }
        // it has changed since: the first one, of which the picture's note tells
        let gone = write(&folder.file("gone.toml"), "60");
        assert_eq!([source(Some(gone)), source(None)], [there.clone(), there.clone()]);
        std::fs::write(&there, "camera = 1").expect("a file");
        assert_eq!(source(Some(gone)), beside, "one that is faulty is none");
    }

    #[test]
    fn a_faulty_scene_is_told_where_there_is_no_other() {
        let folder = TestFolder::new();
        std::fs::write(folder.file("a.toml"), "camera = 1").expect("a file");
        let asked = folder.file("a.toml").display().to_string();
        let fault =
            scene_of(&kept(&asked, None), &folder.file("a.png"), &[], &Progress::untold()).expect_err("a fault");
        assert!(fault.contains("a.toml:1:"), "{fault}");
    }
}
