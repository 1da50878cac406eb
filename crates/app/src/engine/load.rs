//! Reading scenes, sessions, and pictures that say which scene they show, beside the UI: a large file takes its time.

use super::Wake;
use super::find_scene::scene_of;
use super::restore::{self, Kept, Told};
use super::session;
use super::worker::{Control, Service, Worker};
use crate::model::{SavedSession, Setup};
use image_file::{Kind, shown};
use reference::Reference;
use scene::{FileRead, Progress, Scene, SceneError, builtin};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// Reads scenes and pictures; the last one asked for wins, and does not wait for the others.
pub struct Loader {
    wake: Wake,
    /// Reads the last one; or why it does not.
    last: RefCell<Option<Result<Reader, Refusal>>>,
}

type Reader = Worker<Option<Asked>, Heard>;

/// What a reader has told since it was last asked.
#[derive(Default)]
struct Heard {
    doing: Option<String>,
    read: Option<Result<Loaded, Refusal>>,
}

/// How long reading takes before it is worth a word.
pub const WORTH_A_WORD: Duration = Duration::from_millis(200);

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
    /// The files that the scene was read from, as they were; none of a built-in scene.
    pub files: Vec<FileRead>,
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
pub fn read(asked: &Asked, progress: &Progress) -> Result<Loaded, Refusal> {
    match asked {
        Asked::Reference(file) => read_reference(file).map(Loaded::Reference),
        Asked::Open { name, recent } => match Kind::of(Path::new(name)) {
            Some(kind) if builtin::text(name).is_none() => read_picture(Path::new(name), kind, recent, progress),
            _ if builtin::text(name).is_none() && session::is_session_file(Path::new(name)) => {
                let opened = session::read(Path::new(name), recent, progress);
                opened.map(|opened| Loaded::Scene(Box::new(opened))).map_err(|line| refuse(Path::new(name), line))
            }
            _ => {
                let opened = read_scene(name, progress);
                opened.map(|opened| Loaded::Scene(Box::new(opened))).map_err(|fault| refusal(name, &fault))
            }
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
pub(super) fn read_scene(source: &str, progress: &Progress) -> Result<Opened, SceneError> {
    // of this scene alone: another of its name may have been read before
    let hear = |what: &str, share: f32| progress.tell(what, share).is_ok();
    let own = Progress::new(&hear);
    let scene = builtin::named_telling(source, &own)?;
    let notes = scene.notes();
    Ok(Opened {
        asked: source.to_owned(),
        source: source.to_owned(),
        scene,
        files: own.files(),
        setup: None,
        session: None,
        reference: None,
        notes,
    })
}

fn read_picture(path: &Path, kind: Kind, recent: &[PathBuf], progress: &Progress) -> Result<Loaded, Refusal> {
    let refuse = |line: String| refuse(path, line);
    match (restore::read(path).map_err(|fault| refuse(format!("{fault:#}")))?, kind) {
        (Told::Picture(kept), _) => {
            let opened = scene_of(&kept, path, recent, progress).map_err(refuse)?;
            Ok(Loaded::Scene(Box::new(set_up(opened, kept, path))))
        }
        (Told::Reference(kept), _) => {
            let reference = read_reference(path)?;
            Ok(match scene_of(&kept, path, recent, progress) {
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
        self.end(self.last.replace(Some(reader)));
    }

    /// Reads no further; whether something was being read.
    pub fn stop(&self) -> bool {
        let last = self.last.take();
        let reads = last.is_some();
        self.end(last);
        reads
    }

    /// Nobody waits for it: what is half read is given up.
    fn end(&self, reader: Option<Result<Reader, Refusal>>) {
        if let Some(Ok(reader)) = reader {
            reader.cancel();
            reader.leave();
        }
    }

    /// What was read since the last call, or why nothing was. What is being read is put into `doing`, in words.
    pub fn loaded(&self, doing: &mut Option<String>) -> Option<Result<Loaded, Refusal>> {
        let mut last = self.last.borrow_mut();
        if let Ok(reader) = last.as_ref()? {
            let heard = reader.collect()?;
            *doing = heard.doing.or(doing.take());
            let loaded = heard.read?;
            *doing = None;
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
        // a window does not stay open until a scene is read
        self.stop();
    }
}

struct Scenes {
    asked: String,
}

impl Service for Scenes {
    type Job = Option<Asked>;
    type Update = Heard;

    fn serve(&mut self, asked: Option<Asked>, control: &Control<Self::Job, Self::Update>) {
        let Some(asked) = asked else { return };
        self.asked = asked.name();
        let hear = hearing(control);
        let read = read(&asked, &Progress::new(&hear));
        control.tell(|heard| heard.read = Some(read));
    }

    fn recover(&mut self, control: &Control<Self::Job, Self::Update>) {
        let line = "reading the scene stopped at a fault of its own".into();
        let refusal = Refusal { asked: std::mem::take(&mut self.asked), line, missing: false };
        control.tell(|heard| heard.read = Some(Err(refusal)));
    }
}

/// Tells the window what takes long, percent by percent, and stops when the job is cancelled.
fn hearing(control: &Control<Option<Asked>, Heard>) -> impl Fn(&str, f32) -> bool + Sync {
    let (begun, last) = (Instant::now(), AtomicU32::new(u32::MAX));
    move |what, share| {
        let percent = (100.0 * share) as u32;
        if begun.elapsed() > WORTH_A_WORD && last.swap(percent, Ordering::Relaxed) != percent {
            control.tell(|heard| heard.doing = Some(format!("{what}: {percent} % (Esc stops)")));
        }
        !control.ends_now()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use visavis_tests::TestFolder;

    #[test]
    fn what_takes_long_is_told_of_and_given_up_when_it_is_not_wanted() {
        let folder = TestFolder::new();
        let large = folder.file("large.toml");
        let statue = "[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\nfov_y = 45\n[material.a]\n\
                      diffuse = { albedo = [1, 1, 1] }\n[[statue]]\nlevel = 11\nmaterial = \"a\"\n";
        std::fs::write(&large, statue).expect("a file");
        let open = |name: &str| Asked::Open { name: name.to_owned(), recent: Vec::new() };
        let loader = Loader::new(Arc::new(|| {}));
        let mut doing = None;
        loader.load(open(&large.display().to_string()));
        let begun = Instant::now();
        while doing.is_none() {
            assert!(loader.loaded(&mut doing).is_none() && begun.elapsed() < Duration::from_secs(60));
            std::thread::yield_now();
        }
        assert!(doing.as_ref().is_some_and(|words| words.starts_with("making a statue of level 11: ")), "{doing:?}");
        assert!(loader.stop() && !loader.stop());
        loader.load(open("cornell"));
        let loaded = loop {
            assert!(begun.elapsed() < Duration::from_secs(60));
            if let Some(loaded) = loader.loaded(&mut doing) {
                break loaded.expect("a scene");
            }
            std::thread::yield_now();
        };
        assert!(matches!(loaded, Loaded::Scene(opened) if opened.source == "cornell") && doing.is_none());
    }

    #[test]
    fn what_is_not_there_is_told_apart_from_what_is_wrong() {
        let folder = TestFolder::new();
        let asked = |name: &str| Asked::Open { name: folder.file(name).display().to_string(), recent: Vec::new() };
        let missing = |name: &str| read(&asked(name), &Progress::untold()).expect_err(name).missing;
        std::fs::write(folder.file("wrong.toml"), "camera = 1").expect("a file");
        std::fs::write(folder.file("wrong.png"), "no picture").expect("a file");
        assert_eq!(["gone.toml", "gone.png", "wrong.toml", "wrong.png"].map(missing), [true, true, false, false]);
    }
}
