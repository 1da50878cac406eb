//! Reading scenes, sessions, and pictures that say which scene they show, beside the UI: a large file takes its time.

use super::Wake;
use super::find_scene::scene_of;
use super::restore::{self, Kept, Told};
use super::session;
use super::watch::Stamp;
use super::worker::{Control, Service, Worker};
use crate::model::{SavedSession, Setup};
use image_file::{Kind, shown};
use reference::Reference;
use scene::{Scene, SceneError, builtin};
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// Reads scenes and pictures; the last one asked for wins, and does not wait for the others.
pub struct Loader {
    wake: Wake,
    /// Reads the last one; or why it does not.
    last: RefCell<Option<Result<Reader, Refusal>>>,
}

type Reader = Worker<Option<Asked>, Option<Result<Loaded, Refusal>>>;

/// What was in a file, or under a name.
#[derive(Debug)]
pub enum Loaded {
    /// Something to look at.
    Scene(Box<Opened>),
    /// A picture without a scene: something to compare with.
    Reference(ReferenceFile),
}

/// A picture to compare with.
#[derive(Debug, Clone)]
pub struct ReferenceFile {
    /// Its file, which can be read.
    pub file: PathBuf,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Why its scene is not opened, if it says which one that is.
    pub sceneless: Option<String>,
}

/// A scene that was read.
#[derive(Debug)]
pub struct Opened {
    /// What opened it: a built-in name, a scene's file, a session or a picture.
    pub asked: String,
    /// The scene's built-in name or file.
    pub source: String,
    /// The scene that was read from it.
    pub scene: Scene,
    /// When that file was written, if it is one.
    pub stamp: Option<Stamp>,
    /// What the picture sets up that was opened, if one was.
    pub setup: Option<Setup>,
    /// The session that was opened, or in which that picture was seen.
    pub session: Option<Box<SavedSession>>,
    /// That picture, where it is the scene's reference.
    pub reference: Option<ReferenceFile>,
    /// What else is to be said, a line each.
    pub notes: Vec<String>,
}

/// Why there is nothing to look at.
#[derive(Debug)]
pub struct Refusal {
    /// What was asked for.
    pub asked: String,
    /// What is wrong, where, and what to do, in one line.
    pub line: String,
    /// Whether there is no such file.
    pub missing: bool,
}

/// What the user has asked for: to be looked at, or to be compared with.
#[derive(Debug, Clone)]
pub enum Asked {
    /// A scene by its built-in name, a scene's file, a session, or a picture.
    Open {
        /// A built-in name, or the path of a scene, a session or a picture.
        name: String,
        /// The files that were opened before, among which the scene of a picture or a session may be.
        recent: Vec<PathBuf>,
    },
    /// A picture to compare with.
    Reference(PathBuf),
}

impl Asked {
    fn name(&self) -> String {
        match self {
            Asked::Open { name, .. } => name.clone(),
            Asked::Reference(file) => file.display().to_string(),
        }
    }
}

/// Reads what is asked for.
///
/// # Errors
/// One line that says what is wrong, and where.
pub fn read(asked: &Asked) -> Result<Loaded, Refusal> {
    match asked {
        Asked::Reference(file) => read_reference(file).map(Loaded::Reference),
        Asked::Open { name, recent } => match Kind::of(Path::new(name)) {
            Some(kind) if builtin::text(name).is_none() => read_picture(Path::new(name), kind, recent),
            _ if builtin::text(name).is_none() && session::is_session_file(Path::new(name)) => {
                let opened = session::read(Path::new(name), recent);
                opened.map(|opened| Loaded::Scene(Box::new(opened))).map_err(|line| refuse(Path::new(name), line))
            }
            _ => read_scene(name).map(|opened| Loaded::Scene(Box::new(opened))).map_err(|fault| refusal(name, &fault)),
        },
    }
}

fn refusal(asked: &str, fault: &SceneError) -> Refusal {
    let missing = matches!(fault, SceneError::Read { why, .. } if why.kind() == std::io::ErrorKind::NotFound);
    Refusal { asked: asked.to_owned(), line: fault.to_string(), missing }
}

/// A scene by its built-in name, or from its file.
///
/// # Errors
/// What is wrong with it.
pub(super) fn read_scene(source: &str) -> Result<Opened, SceneError> {
    // before it is read, so that what is written meanwhile is newer
    let stamp = Stamp::of(Path::new(source)).filter(|_| builtin::text(source).is_none());
    let scene = builtin::named(source)?;
    let notes = scene.notes();
    Ok(Opened {
        asked: source.to_owned(),
        source: source.to_owned(),
        scene,
        stamp,
        setup: None,
        session: None,
        reference: None,
        notes,
    })
}

fn read_picture(path: &Path, kind: Kind, recent: &[PathBuf]) -> Result<Loaded, Refusal> {
    let refuse = |line: String| refuse(path, line);
    match (restore::read(path).map_err(|fault| refuse(format!("{fault:#}")))?, kind) {
        (Told::Picture(kept), _) => {
            let opened = scene_of(&kept, path, recent).map_err(refuse)?;
            Ok(Loaded::Scene(Box::new(set_up(opened, kept, path))))
        }
        (Told::Reference(kept), _) => {
            let reference = read_reference(path)?;
            Ok(match scene_of(&kept, path, recent) {
                Ok(opened) => {
                    let opened = set_up(opened, kept, path);
                    Loaded::Scene(Box::new(Opened { reference: Some(reference), ..opened }))
                }
                Err(line) => Loaded::Reference(ReferenceFile { sceneless: Some(line), ..reference }),
            })
        }
        (Told::ErrorMap, _) => Err(refuse(map_of_errors(path))),
        (Told::Nothing, Kind::Exr) => read_reference(path).map(Loaded::Reference),
        (Told::Nothing, Kind::Png) => Err(refuse(format!(
            "this picture does not say how it was made: {}; a scene (.toml) can be opened, a picture that visavis has saved, \
             or an .exr to compare with; another program's picture can be shown in a pane: Settings of B, Another program's \
             picture",
            shown(path)
        ))),
    }
}

fn refuse(path: &Path, line: String) -> Refusal {
    Refusal { asked: path.display().to_string(), line, missing: !path.exists() }
}

/// What its picture shows.
fn set_up(opened: Opened, kept: Kept, picture: &Path) -> Opened {
    let (session, left) = match session::of_picture(&kept, &opened.scene, picture) {
        Ok(session) => (session, None),
        Err(why) => (None, Some(why)),
    };
    let notes = opened.notes.iter().cloned().chain(kept.note(picture, &opened.scene)).chain(left).collect();
    Opened { asked: picture.display().to_string(), setup: Some(kept.setup), session, notes, ..opened }
}

fn read_reference(path: &Path) -> Result<ReferenceFile, Refusal> {
    let loaded = Reference::load(path).map_err(|fault| refuse(path, fault.to_string()))?;
    if matches!(restore::read(path), Ok(Told::ErrorMap)) {
        return Err(refuse(path, map_of_errors(path)));
    }
    Ok(ReferenceFile { file: path.to_owned(), size: loaded.image.size(), sceneless: None })
}

fn map_of_errors(path: &Path) -> String {
    format!(
        "this is a map of errors, with which no picture can be compared: {}; open one of its two pictures",
        shown(path)
    )
}

impl Loader {
    /// Calls `wake` whenever [`Loader::loaded`] has something.
    pub fn new(wake: Wake) -> Self {
        Loader { wake, last: RefCell::default() }
    }

    /// Reads this on a thread of its own.
    pub fn load(&self, asked: Asked) {
        let started = Worker::start("loader", self.wake.clone(), || Scenes { asked: String::new() });
        let reader = started.map_err(|e| Refusal {
            asked: asked.name(),
            line: format!("no thread to read the scene ({e})"),
            missing: false,
        });
        if let Ok(reader) = &reader {
            reader.post(|slot| *slot = Some(asked));
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
    type Job = Option<Asked>;
    type Update = Option<Result<Loaded, Refusal>>;

    fn serve(&mut self, asked: Option<Asked>, control: &Control<Self::Job, Self::Update>) {
        let Some(asked) = asked else { return };
        self.asked = asked.name();
        let read = read(&asked);
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
        let asked = |name: &str| Asked::Open { name: folder.file(name).display().to_string(), recent: Vec::new() };
        let missing = |name: &str| read(&asked(name)).expect_err(name).missing;
        std::fs::write(folder.file("wrong.toml"), "camera = 1").expect("a file");
        std::fs::write(folder.file("wrong.png"), "no picture").expect("a file");
        assert_eq!(["gone.toml", "gone.png", "wrong.toml", "wrong.png"].map(missing), [true, true, false, false]);
    }
}
