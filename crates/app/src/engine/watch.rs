//! Watches the files that the scene that is open was read from, and reads it again where one changes: by their times and sizes,
//! twice a second, which needs nothing of the system. Editors write a new file and give it the name of the old one: what has
//! the name counts.

use super::Wake;
use super::worker::{Control, Service, Worker};
use scene::{FileRead, FileStamp, Progress, Scene, SceneError, builtin};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// How often the files are looked at.
const EVERY: Duration = Duration::from_millis(500);

/// How long a file that has changed must stay as it is: it may be in the middle of being written.
const SETTLED: Duration = Duration::from_millis(100);

/// A scene's files as they were when it was read.
#[derive(Debug, Clone)]
pub struct Watched {
    /// Counts the scenes opened.
    pub opened: u64,
    /// Where the file of the scene lies that is open.
    pub path: PathBuf,
    /// All that it was read from: itself, its base, and the pictures and models that they name.
    pub files: Vec<FileRead>,
    /// Whether it is read again without having changed.
    pub at_once: bool,
}

/// A scene that was read again, or why it was not.
#[derive(Debug)]
pub struct Reread {
    /// The scene opened that it is another version of.
    pub opened: u64,
    /// One line with line and column where it is faulty.
    pub scene: Result<Scene, String>,
}

/// What was found since the last look.
#[derive(Debug, Default)]
pub struct News {
    /// The scene, where its file was read again.
    pub reread: Option<Reread>,
    /// The scenes in its folder, where they are others than before.
    pub folder: Option<Vec<PathBuf>>,
}

/// The thread; dropping it ends it.
pub struct Watcher(Worker<Option<Watched>, News>);

impl Watcher {
    /// Starts the thread, which calls `wake` whenever [`Watcher::news`] has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake) -> std::io::Result<Self> {
        Worker::start("watcher", wake, || Files).map(Watcher)
    }

    /// Watches this file from now on, or none.
    pub fn watch(&self, watched: Option<Watched>) {
        self.0.post(|slot| *slot = watched);
    }

    /// What was found since the last call.
    pub fn news(&self) -> News {
        self.0.collect().unwrap_or_default()
    }
}

struct Files;

impl Service for Files {
    type Job = Option<Watched>;
    type Update = News;

    fn serve(&mut self, watched: Option<Watched>, control: &Control<Self::Job, Self::Update>) {
        let Some(Watched { opened, path, mut files, at_once }) = watched else { return };
        let (mut reads, mut folder) = (at_once, Folder::beside(&path));
        while !control.ends_soon() {
            if reads {
                let goes_on = |_: &str, _: f32| !control.ends_soon();
                let progress = Progress::new(&goes_on);
                let scene = builtin::named_telling(&path.display().to_string(), &progress);
                if matches!(scene, Err(SceneError::Stopped)) {
                    return;
                }
                files = progress.files();
                if files.is_empty() {
                    // a name without a suffix is no file's while there is none
                    files.push(FileRead { path: path.clone(), stamp: None });
                }
                let scene = scene.map_err(|fault| fault.to_string());
                control.tell(|news| news.reread = Some(Reread { opened, scene }));
            }
            if let Some(scenes) = folder.look_again() {
                control.tell(|news| news.folder = Some(scenes));
            }
            control.rest(EVERY);
            let written: Vec<FileRead> =
                files.iter().filter(|file| file.has_changed()).map(|file| FileRead::now(&file.path)).collect();
            reads = !written.is_empty();
            if reads {
                control.rest(SETTLED);
                // else they are looked at once more
                reads = !written.iter().any(FileRead::has_changed);
            }
        }
    }

    fn recover(&mut self, _control: &Control<Self::Job, Self::Update>) {}
}

/// The most files of a folder that are looked into.
const MOST_FILES: usize = 200;

/// Bytes in which a scene says that it has a camera.
const HEAD: u64 = 1 << 16;

/// A folder and the scenes in it as last seen.
struct Folder {
    path: PathBuf,
    modified: Option<SystemTime>,
    files: Vec<Candidate>,
    scenes: Option<Vec<PathBuf>>,
}

/// What models' names end in: each is put into a scene of its own.
const MODELS: [&str; 4] = ["glb", "gltf", "obj", "ply"];

/// A file of TOML, or a model.
struct Candidate {
    path: PathBuf,
    is_scene: bool,
    /// The file as it was when it was none; `None` if it could not be read.
    looked_into: Option<FileStamp>,
}

fn is_model(suffix: &OsStr) -> bool {
    MODELS.iter().any(|known| suffix.eq_ignore_ascii_case(known))
}

impl Candidate {
    fn new(path: PathBuf) -> Self {
        let is_scene = path.extension().is_some_and(is_model);
        Candidate { path, is_scene, looked_into: None }
    }

    /// Looks into one that was no scene and has changed: who makes a file may write it later, which no folder tells.
    fn look_again(&mut self) {
        let stamp = FileStamp::of(&self.path);
        if self.is_scene || stamp.is_none() || stamp == self.looked_into {
            return;
        }
        let found = has_a_camera(&self.path);
        (self.is_scene, self.looked_into) = (found == Some(true), stamp.filter(|_| found.is_some()));
    }
}

impl Folder {
    fn beside(file: &Path) -> Self {
        let path = file.parent().unwrap_or(Path::new("")).to_owned();
        Folder { path, modified: None, files: Vec::new(), scenes: None }
    }

    /// The scenes in it, if they are others than the last time.
    fn look_again(&mut self) -> Option<Vec<PathBuf>> {
        let place = if self.path.as_os_str().is_empty() { Path::new(".") } else { &self.path };
        let modified = std::fs::metadata(place).ok().and_then(|found| found.modified().ok());
        if self.scenes.is_none() || modified != self.modified {
            self.files = self.list(place).into_iter().map(Candidate::new).collect();
        }
        self.modified = modified;
        self.files.iter_mut().for_each(Candidate::look_again);
        let now = Some(self.files.iter().filter(|file| file.is_scene).map(|file| file.path.clone()).collect());
        if now == self.scenes {
            return None;
        }
        self.scenes.clone_from(&now);
        now
    }

    fn list(&self, place: &Path) -> Vec<PathBuf> {
        let entries = std::fs::read_dir(place).into_iter().flatten().flatten();
        let mut names: Vec<_> = entries.map(|entry| self.path.join(entry.file_name())).collect();
        let may_be_one = |kind: &OsStr| kind.eq_ignore_ascii_case("toml") || is_model(kind);
        names.retain(|path| path.extension().is_some_and(may_be_one));
        names.sort();
        names.truncate(MOST_FILES);
        names
    }
}

/// Whether a file of TOML may be a scene, each of which has one; `None` if it cannot be read.
fn has_a_camera(path: &Path) -> Option<bool> {
    use std::io::Read;
    let mut head = Vec::new();
    std::fs::File::open(path).ok()?.take(HEAD).read_to_end(&mut head).ok()?;
    Some(head.windows(6).any(|word| word == b"camera"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::time::Instant;
    use visavis_tests::TestFolder;

    const SCENE: &str = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov_y = 45\n\
                         [material.a]\ndiffuse = { albedo = [1, 1, 1] }\n\
                         [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";

    fn next(watcher: &Watcher) -> Result<Scene, String> {
        let start = Instant::now();
        loop {
            if let Some(reread) = watcher.news().reread {
                return reread.scene;
            }
            assert!(start.elapsed() < Duration::from_secs(60), "waited a minute");
            std::thread::yield_now();
        }
    }

    /// Watches a scene's file from now on, as it is.
    fn watch(watcher: &Watcher, path: &Path) {
        let progress = Progress::untold();
        scene::load(path, &progress).expect("a scene");
        watcher.watch(Some(Watched { opened: 1, path: path.to_owned(), files: progress.files(), at_once: false }));
    }

    #[test]
    fn a_file_is_read_again_when_it_is_written_or_replaced_and_told_where_it_is_faulty() {
        let folder = TestFolder::new();
        let (path, other) = (folder.file("scene.toml"), folder.file("other"));
        std::fs::write(&path, SCENE).expect("a file");
        let watcher = Watcher::start(Arc::new(|| {})).expect("a thread");
        watch(&watcher, &path);

        std::fs::write(&path, SCENE.replace("radius = 1", "radius = none")).expect("a file");
        let fault = next(&watcher).expect_err("a fault");
        assert!(fault.contains("scene.toml:9:10: "), "{fault}");

        std::fs::write(&other, SCENE.replace("fov_y = 45", "fov_y = 30.5")).expect("a file");
        std::fs::rename(&other, &path).expect("a new name");
        assert_eq!(next(&watcher).expect("a scene").camera.fov_y, 30.5);

        std::fs::remove_file(&path).expect("a file");
        assert!(next(&watcher).expect_err("a fault").contains("cannot read the scene file"));
    }

    #[test]
    fn a_scene_is_read_again_when_a_file_that_its_base_names_is_written_goes_or_comes() {
        let folder = TestFolder::new();
        let [path, base, model] = ["own.toml", "base.toml", "m.obj"].map(|name| folder.file(name));
        let height = |scene: Scene| scene.bounds().1.y;
        let triangle = |height: &str| {
            std::fs::write(&model, format!("v 0 0 0\nv 1 0 0\nv 0 {height} 0\nf 1 2 3\n")).expect("a file");
        };
        std::fs::write(&path, "base = 'base.toml'\n").expect("a file");
        std::fs::write(&base, format!("{SCENE}[[mesh]]\nfile = 'm.obj'\nmaterial = 'a'\n")).expect("a file");
        triangle("2");
        let watcher = Watcher::start(Arc::new(|| {})).expect("a thread");
        watch(&watcher, &path);
        triangle("3.5");
        assert_eq!(next(&watcher).map(height), Ok(3.5));
        std::fs::remove_file(&model).expect("a file");
        let fault = next(&watcher).expect_err("a fault");
        assert!(fault.contains("base.toml:") && fault.contains("m.obj"), "{fault}");
        triangle("4.25");
        assert_eq!(next(&watcher).map(height), Ok(4.25));
        std::fs::write(&base, SCENE).expect("a file");
        assert_eq!(next(&watcher).map(height), Ok(1.0), "the ball alone");
    }

    #[test]
    fn asked_to_it_reads_at_once_what_has_not_changed() {
        let folder = TestFolder::new();
        let path = folder.file("scene.toml");
        std::fs::write(&path, SCENE).expect("a file");
        let watcher = Watcher::start(Arc::new(|| {})).expect("a thread");
        watcher.watch(Some(Watched { opened: 1, path, files: Vec::new(), at_once: true }));
        assert!(next(&watcher).is_ok());
    }

    #[test]
    fn the_scenes_of_a_folder_are_told_once_and_again_when_one_comes() {
        let test = TestFolder::new();
        std::fs::write(test.file("b.toml"), SCENE).expect("a file");
        std::fs::write(test.file("Cargo.toml"), "[package]").expect("a file");
        let mut folder = Folder::beside(&test.file("b.toml"));
        assert_eq!((folder.look_again(), folder.look_again()), (Some(vec![test.file("b.toml")]), None));
        // a folder whose time is too coarse to tell
        folder.modified = None;
        std::fs::write(test.file("a.TOML"), SCENE).expect("a file");
        std::fs::write(test.file("ship.GLB"), "glTF").expect("a file");
        let all = ["a.TOML", "b.toml", "ship.GLB"].map(|name| test.file(name));
        assert_eq!(folder.look_again(), Some(all.to_vec()));
    }

    #[test]
    fn a_file_that_is_filled_after_the_folder_was_read_is_told() {
        let test = TestFolder::new();
        let [open, new] = ["b.toml", "new.toml"].map(|name| test.file(name));
        std::fs::write(&open, SCENE).expect("a file");
        let mut folder = Folder::beside(&open);
        folder.look_again();
        // an editor has just emptied the one, and a shell has made the other
        std::fs::write(&open, "").expect("a file");
        std::fs::write(&new, "").expect("a file");
        folder.modified = None;
        assert_eq!((folder.look_again(), folder.look_again()), (Some(vec![]), None));
        let of_the_folder = folder.modified;
        std::fs::write(&open, SCENE).expect("a file");
        std::fs::write(&new, SCENE).expect("a file");
        assert_eq!(folder.look_again(), Some(vec![open, new]));
        assert_eq!(folder.modified, of_the_folder, "which tells nothing of that");
    }
}
