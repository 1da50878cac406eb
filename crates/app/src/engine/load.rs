//! Reading scenes, and pictures that say which scene they show, beside the UI: a large file takes its time.

use super::Wake;
use super::restore::{self, Kept};
use super::watch::Stamp;
use super::worker::{Control, Service, Worker};
use crate::model::Setup;
use image_file::{Kind, shown};
use scene::{Scene, SceneError, builtin};
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// Reads scenes and pictures; the last one asked for wins, and does not wait for the others.
pub struct Loader {
    wake: Wake,
    /// Reads the last one; or why it does not.
    last: RefCell<Option<Result<Reader, Refusal>>>,
}

type Reader = Worker<Option<String>, Option<Result<Loaded, Refusal>>>;

/// What was in a file, or under a name.
#[derive(Debug)]
pub enum Loaded {
    /// Something to look at.
    Scene(Box<Opened>),
    /// A picture that does not say how it was made: something to compare with.
    Reference(PathBuf),
}

/// A scene that was read.
#[derive(Debug)]
pub struct Opened {
    /// What opened it: a built-in name, a scene's file or a picture.
    pub asked: String,
    /// The scene's built-in name or file.
    pub source: String,
    /// The scene that was read from it.
    pub scene: Scene,
    /// When that file was written, if it is one.
    pub stamp: Option<Stamp>,
    /// What the picture sets up that was opened, if one was.
    pub setup: Option<Setup>,
    /// What else is to be said, a line each.
    pub notes: Vec<String>,
}

/// Why there is nothing to look at.
#[derive(Debug)]
pub struct Refusal {
    /// What was asked for.
    pub asked: String,
    /// One line.
    pub line: String,
    /// Whether there is no such file.
    pub missing: bool,
}

/// Reads what stands under a built-in name or in a file.
///
/// # Errors
/// One line that says what is wrong, and where.
pub fn read(asked: &str) -> Result<Loaded, Refusal> {
    let path = Path::new(asked);
    match Kind::of(path) {
        Some(kind) if builtin::text(asked).is_none() => read_picture(asked, path, kind),
        _ => read_scene(asked).map(|opened| Loaded::Scene(Box::new(opened))).map_err(|fault| refusal(asked, &fault)),
    }
}

fn refusal(asked: &str, fault: &SceneError) -> Refusal {
    let missing = matches!(fault, SceneError::Read { why, .. } if why.kind() == std::io::ErrorKind::NotFound);
    Refusal { asked: asked.to_owned(), line: fault.to_string(), missing }
}

fn read_scene(source: &str) -> Result<Opened, SceneError> {
    // before it is read, so that what is written meanwhile is newer
    let stamp = Stamp::of(Path::new(source)).filter(|_| builtin::text(source).is_none());
    let scene = builtin::named(source)?;
    let notes = scene.notes();
    Ok(Opened { asked: source.to_owned(), source: source.to_owned(), scene, stamp, setup: None, notes })
}

fn read_picture(asked: &str, path: &Path, kind: Kind) -> Result<Loaded, Refusal> {
    let refuse = |line: String| Refusal { asked: asked.to_owned(), line, missing: !path.exists() };
    let Some(kept) = restore::read(path).map_err(|fault| refuse(format!("{fault:#}")))? else {
        return match kind {
            Kind::Exr => Ok(Loaded::Reference(path.to_owned())),
            Kind::Png => Err(refuse(format!(
                "this picture does not say how it was made, and only an .exr can be a reference: {}",
                shown(path)
            ))),
        };
    };
    let mut opened = scene_of(&kept, path).map_err(|fault| match fault {
        SceneError::Read { .. } | SceneError::Unknown { .. } => refuse(format!(
            "the scene of {} is not found; open it in the folder where it was made, or put the scene beside it: {fault}",
            shown(path)
        )),
        fault => refuse(format!("the scene of {}: {fault}", shown(path))),
    })?;
    opened.notes.extend(kept.note(path, &opened.scene));
    Ok(Loaded::Scene(Box::new(Opened { asked: asked.to_owned(), setup: Some(kept.setup), ..opened })))
}

/// The scene of a picture, where it was when the picture was made, or beside the picture.
fn scene_of(kept: &Kept, picture: &Path) -> Result<Opened, SceneError> {
    let there = read_scene(&kept.scene);
    let Err(SceneError::Read { .. } | SceneError::Unknown { .. }) = &there else { return there };
    let name = Path::new(&kept.scene);
    let beside = [picture.with_file_name(name), picture.with_file_name(name.file_name().unwrap_or_default())];
    beside.iter().find(|file| file.is_file()).map_or(there, |file| read_scene(&file.display().to_string()))
}

impl Loader {
    /// Calls `wake` whenever [`Loader::loaded`] has something.
    pub fn new(wake: Wake) -> Self {
        Loader { wake, last: RefCell::default() }
    }

    /// Reads a scene or a picture, by name or file, on a thread of its own.
    pub fn load(&self, name: String) {
        let started = Worker::start("loader", self.wake.clone(), || Scenes { asked: String::new() });
        let reader = started.map_err(|e| Refusal {
            asked: name.clone(),
            line: format!("no thread to read the scene ({e})"),
            missing: false,
        });
        if let Ok(reader) = &reader {
            reader.post(|slot| *slot = Some(name));
        }
        if let Some(Ok(before)) = self.last.replace(Some(reader)) {
            before.leave();
        }
    }

    /// What was read since the last call, or why nothing was.
    pub fn loaded(&self) -> Option<Result<Loaded, Refusal>> {
        let mut last = self.last.borrow_mut();
        if let Ok(reader) = last.as_ref()? {
            let loaded = reader.collect().flatten()?;
            if let Some(Ok(reader)) = last.take() {
                reader.leave();
            }
            return Some(loaded);
        }
        last.take().and_then(Result::err).map(Err)
    }
}

impl Drop for Loader {
    fn drop(&mut self) {
        if let Some(Ok(reader)) = self.last.take() {
            // a window does not stay open until a scene is read
            reader.leave();
        }
    }
}

struct Scenes {
    asked: String,
}

impl Service for Scenes {
    type Job = Option<String>;
    type Update = Option<Result<Loaded, Refusal>>;

    fn serve(&mut self, name: Option<String>, control: &Control<Self::Job, Self::Update>) {
        let Some(name) = name else { return };
        self.asked.clone_from(&name);
        let read = read(&name);
        control.tell(|loaded| *loaded = Some(read));
    }

    fn recover(&mut self, control: &Control<Self::Job, Self::Update>) {
        let line = "reading the scene stopped at a fault of its own".into();
        let refusal = Refusal { asked: std::mem::take(&mut self.asked), line, missing: false };
        control.tell(|loaded| *loaded = Some(Err(refusal)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use visavis_tests::TestFolder;

    #[test]
    fn what_is_not_there_is_told_apart_from_what_is_wrong() {
        let folder = TestFolder::new();
        let missing = |name: &str| read(&folder.file(name).display().to_string()).expect_err(name).missing;
        std::fs::write(folder.file("wrong.toml"), "camera = 1").expect("a file");
        std::fs::write(folder.file("wrong.png"), "no picture").expect("a file");
        assert_eq!(["gone.toml", "gone.png", "wrong.toml", "wrong.png"].map(missing), [true, true, false, false]);
    }

    #[test]
    fn the_scene_of_a_picture_is_looked_for_beside_it_too() {
        let folder = TestFolder::new();
        let kept = |scene: &str| Kept { scene: scene.to_owned(), scene_hash: None, setup: Setup::default() };
        let cornell = builtin::text("cornell").expect("a built-in scene");
        std::fs::create_dir(folder.file("scenes")).expect("a folder");
        for name in ["moved.toml", "scenes/below.toml"] {
            std::fs::write(folder.file(name), cornell).expect("a file");
        }
        let source =
            |scene: &str| scene_of(&kept(scene), &folder.file("a.png")).map(|opened| PathBuf::from(opened.source));
        for (scene, file) in [("elsewhere/moved.toml", "moved.toml"), ("scenes/below.toml", "scenes/below.toml")] {
            assert_eq!(source(scene).expect(scene), folder.file(file));
        }
        assert!(matches!(source("gone.toml"), Err(SceneError::Read { .. })));
        assert_eq!(source("cornell").expect("a built-in scene"), PathBuf::from("cornell"));
    }
}
