//! Sessions in files: read with their scenes, and written so that both can be moved together.

use super::find_scene::scene_of;
use super::load::Opened;
use super::restore::Kept;
use crate::model::{PaneSource, SavedSession, SavedWindow, SessionDraft, Setup, is_session};
use anyhow::{Context, bail};
use image_file::shown;
use scene::paths::{file_from, without_detours};
use scene::{Progress, Scene, builtin};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest session that is read, in bytes.
const LARGEST_FILE: u64 = 1 << 20;

/// Whether a file is a session: a regular one that begins as such.
pub fn is_session_file(path: &Path) -> bool {
    head_of(path).is_some_and(|head| is_session(&String::from_utf8_lossy(&head)))
}

/// As much of a file as a session may have, and one byte; `None` of what is no file, or cannot be read.
fn head_of(path: &Path) -> Option<Vec<u8>> {
    use std::io::Read;
    std::fs::metadata(path).ok().filter(|found| found.is_file())?;
    let mut head = Vec::new();
    std::fs::File::open(path).ok()?.take(LARGEST_FILE + 1).read_to_end(&mut head).ok()?;
    Some(head)
}

/// Opens a session with its scene.
///
/// # Errors
/// One line that says what is wrong, and where.
pub fn read(path: &Path, recent: &[PathBuf], progress: &Progress) -> Result<Opened, String> {
    let head = head_of(path).ok_or_else(|| format!("cannot read the session: {}", shown(path)))?;
    if head.len() as u64 > LARGEST_FILE {
        return Err(format!("a session has at most {LARGEST_FILE} bytes, and this file has more: {}", shown(path)));
    }
    let text = String::from_utf8(head)
        .map_err(|_| format!("this is not a text in UTF-8: a session is saved as one: {}", shown(path)))?;
    let draft = SessionDraft::parse(&text, path)?;
    let scene = source_beside(path, &draft.scene);
    let kept = Kept { scene, scene_hash: draft.scene_hash, setup: Setup::default(), session: None };
    let opened = scene_of(&kept, path, recent, progress)?;
    let mut session = draft.beside(&opened.scene, path)?;
    files_as(&mut session, |file| {
        std::path::absolute(path.with_file_name(file)).map_or_else(|_| file.to_owned(), |file| without_detours(&file))
    });
    let notes = opened.notes.iter().cloned().chain(kept.note(path, &opened.scene)).collect();
    Ok(Opened { asked: path.display().to_string(), session: Some(Box::new(session)), notes, ..opened })
}

/// The session in which a picture was seen, where it keeps one: what the picture's other records do not say.
///
/// # Errors
/// A line on why it is left; the other records are enough to see the picture again.
pub fn of_picture(kept: &Kept, scene: &Scene, picture: &Path) -> Result<Option<Box<SavedSession>>, String> {
    let Some(text) = &kept.session else { return Ok(None) };
    if text.len() as u64 > LARGEST_FILE {
        return Err(format!("only what it shows is set up, its session is larger than {LARGEST_FILE} bytes"));
    }
    let read = SessionDraft::parse(text, picture).and_then(|draft| draft.beside(scene, picture));
    let session = read.map_err(|fault| format!("only what it shows is set up, its session cannot be read: {fault}"))?;
    // the picture may be older than the last change, and a window keeps its size
    let session = SavedSession { changes: kept.setup.changes.clone(), window: SavedWindow::default(), ..session };
    Ok(Some(Box::new(session)))
}

/// A built-in name, or a file as seen from the session's folder.
fn source_beside(session: &Path, scene: &str) -> String {
    match builtin::text(scene) {
        Some(_) => scene.to_owned(),
        None => without_detours(&session.with_file_name(scene)).display().to_string(),
    }
}

/// Names the pictures that are followed in another way.
fn files_as(session: &mut SavedSession, named: impl Fn(&Path) -> PathBuf) {
    for source in session.session.sources.values_mut() {
        if let PaneSource::Followed(file) = source {
            *file = named(file);
        }
    }
}

/// A session to write.
#[derive(Debug, Clone)]
pub struct SessionToSave {
    /// Scene, view, panes and window as the file shall keep them.
    pub session: SavedSession,
    /// Its scene as it was opened.
    pub scene: Arc<Scene>,
    /// The scene's built-in name or file.
    pub source: String,
}

impl SessionToSave {
    /// Writes it to a file; where there is one, to another beside it. Returns where.
    ///
    /// # Errors
    /// If its name is none of a session, if it cannot be written, or if a picture's name cannot be kept.
    pub fn save(&self, path: &Path) -> anyhow::Result<PathBuf> {
        if !path.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("toml")) {
            bail!("the name of a session must end in .toml: {}", shown(path));
        }
        let path = std::path::absolute(path).with_context(|| format!("cannot save to {}", shown(path)))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        if let Some((pane, file)) = self.in_folder(folder).files_without_a_text().next() {
            bail!(
                "a session is a text in UTF-8, and the name of {pane}'s picture is none: rename it or its folder: {}",
                shown(file)
            );
        }
        Ok(image_file::write_new(&path, self.text_in(folder).as_bytes())?)
    }

    /// Its text for any folder.
    pub fn text(&self) -> String {
        self.text_in(Path::new(""))
    }

    /// Its text for a file in this folder.
    pub fn text_in(&self, folder: &Path) -> String {
        self.in_folder(folder).text(&self.scene, &source_from(folder, &self.source))
    }

    /// With pictures as a file in this folder names them.
    fn in_folder(&self, folder: &Path) -> SavedSession {
        let mut session = self.session.clone();
        files_as(&mut session, |file| file_from(folder, file));
        session
    }
}

/// A built-in scene's name, or its file as a folder finds it.
pub(super) fn source_from(folder: &Path, source: &str) -> String {
    match builtin::text(source) {
        Some(_) => source.to_owned(),
        None => file_from(folder, Path::new(source)).display().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Model, PaneId, Theme};
    use visavis_tests::TestFolder;

    #[test]
    fn a_scenes_file_is_named_as_the_sessions_folder_finds_it() {
        let test = TestFolder::new();
        for folder in ["course/sessions", "course/scenes"] {
            std::fs::create_dir_all(test.file(folder)).expect("a folder");
        }
        let scene = test.file("course/scenes/a.toml");
        std::fs::write(&scene, "").expect("a file");
        let from = |folder: &str| source_from(&test.file(folder), &scene.display().to_string());
        assert_eq!(from("course"), "scenes/a.toml");
        assert_eq!(from("course/sessions"), "../scenes/a.toml");
        assert_eq!(from("course/scenes"), "a.toml");
        assert_eq!(source_from(&test.file("course"), "cornell"), "cornell");
        let later = test.file("course/pictures/later/mine.exr");
        let from = |folder: &str| file_from(&test.file(folder), &later);
        assert_eq!(from("course/sessions"), Path::new("../pictures/later/mine.exr"), "it is not there yet");
    }

    /// A session that follows this picture in B.
    fn following(picture: &Path) -> SessionToSave {
        let scene = Arc::new(builtin::named("cornell").expect("a built-in scene"));
        let mut model = Model::new((*scene).clone(), "cornell".into(), Theme::Dark);
        model.session.set_source(PaneId::B, PaneSource::Followed(picture.to_owned()));
        SessionToSave { session: SavedSession::of(&model, None), scene, source: "cornell".into() }
    }

    fn followed(session: &Path) -> PathBuf {
        let opened = read(session, &[], &Progress::untold()).expect("a session").session.expect("all of it");
        match opened.session.source(PaneId::B) {
            PaneSource::Followed(file) => file.clone(),
            other => panic!("{other}"),
        }
    }

    #[test]
    fn a_picture_that_sessions_follow_from_folder_to_folder_keeps_one_path() {
        let test = TestFolder::new();
        for folder in ["a", "b", "pictures"] {
            std::fs::create_dir_all(test.file(folder)).expect("a folder");
        }
        let picture = test.file("pictures/mine.exr");
        for is_there in [false, true] {
            if is_there {
                std::fs::write(&picture, "").expect("a file");
            }
            let first = following(&picture).save(&test.file("a/first.toml")).expect("a session");
            let opened = followed(&first);
            assert_eq!(opened, std::path::absolute(&picture).expect("a path"));
            let second = following(&opened).save(&test.file("b/second.toml")).expect("a session");
            let text = std::fs::read_to_string(&second).expect("a text");
            assert!(text.contains("\npicture = \"../pictures/mine.exr\"\n"), "{text}");
        }
        assert_eq!(source_beside(&test.file("a/b.toml"), "../c/d.toml"), test.file("c/d.toml").display().to_string());
    }

    #[cfg(unix)]
    #[test]
    fn a_picture_whose_name_is_no_text_is_not_saved_as_another() {
        use std::os::unix::ffi::OsStrExt;
        let test = TestFolder::new();
        let picture = test.file("").join(std::ffi::OsStr::from_bytes(b"mine\xff.exr"));
        let session = following(&picture);
        let fault = session.save(&test.file("a.toml")).expect_err("no text");
        assert!(format!("{fault:#}").contains("B's picture is none: rename it"), "{fault:#}");
        assert!(!test.file("a.toml").exists());
        let text = session.text();
        assert!(text.contains("\n# picture, whose name") && !text.contains("picture ="), "{text}");
        assert!(SessionDraft::parse(&text, Path::new("a.toml")).is_ok());
    }

    #[test]
    fn a_pictures_session_that_cannot_be_read_is_left_with_a_line() {
        let scene = builtin::named("whitted").expect("a built-in scene");
        let of = |text: Option<&str>| {
            let session = text.map(str::to_owned);
            let kept = Kept { scene: "whitted".into(), scene_hash: None, setup: Setup::default(), session };
            of_picture(&kept, &scene, Path::new("seen.png"))
        };
        assert_eq!(of(None), Ok(None));
        let session = of(Some("session = 1\nscene = \"whitted\"\n[window]\nsize = [900, 600]")).expect("a session");
        assert_eq!(session.map(|session| session.window), Some(SavedWindow::default()), "a window keeps its size");
        let left = of(Some("session = 2")).expect_err("a later one");
        assert!(left.starts_with("only what it shows is set up") && left.contains("version 2"), "{left}");
    }

    /// `linked/..` is the folder of the link's target.
    #[cfg(unix)]
    #[test]
    fn where_a_link_leads_elsewhere_all_of_the_path_is_kept() {
        let test = TestFolder::new();
        std::fs::create_dir_all(test.file("far/away")).expect("a folder");
        std::os::unix::fs::symlink(test.file("far/away"), test.file("linked")).expect("a link");
        let scene = test.file("a.toml");
        std::fs::write(&scene, "").expect("a file");
        let source = source_from(&test.file("linked"), &scene.display().to_string());
        assert_eq!(source, scene.display().to_string());
        let through = test.file("linked/../b.toml");
        assert_eq!(without_detours(&through), through, "nor is it made shorter");
    }
}
