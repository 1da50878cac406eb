//! A picture's file that is read again whenever it changes. A program may still be writing it: what cannot be read is tried
//! again, and the picture before stays.

use super::protocol::{MOST_PIXELS, MOST_SIDE};
use crate::engine::bare;
use film::Image;
use image_file::{Loaded, shown};
use scene::FileStamp;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How long a file that cannot be read waits for the next try, unless it changes before.
const RETRY: Duration = Duration::from_secs(2);

/// A file, and what was read of it.
#[derive(Debug)]
pub struct Follower {
    path: PathBuf,
    /// As it was when it was last looked at.
    seen: Option<FileStamp>,
    /// As it was when it was last read, and when that was.
    read: Option<(Option<FileStamp>, Instant)>,
    begun: Option<Instant>,
    state: FileState,
}

/// What there is of a file to show.
#[derive(Debug, Clone, Default)]
pub struct FileState {
    /// Counts the times that it was looked into.
    pub version: u64,
    /// The latest that could be read.
    pub picture: Option<Image>,
    /// What of the file it does not show, a line each.
    pub notes: Vec<String>,
    /// Seconds from the first picture to the latest.
    pub seconds: f64,
    /// How often another came.
    pub changes: u64,
    /// Why nothing newer was read: one line.
    pub fault: Option<String>,
}

impl Follower {
    /// Follows a file, which need not be there yet.
    pub fn new(path: PathBuf) -> Self {
        Follower { path, seen: None, read: None, begun: None, state: FileState::default() }
    }

    /// Looks at the file; returns what there is to show, if that has changed since a version.
    pub fn since(&mut self, version: Option<u64>) -> Option<&FileState> {
        let before = self.seen;
        self.seen = FileStamp::of(&self.path);
        if self.is_due(before) {
            self.read = Some((self.seen, Instant::now()));
            self.look_into();
        }
        (version != Some(self.state.version)).then_some(&self.state)
    }

    /// At first, and where it has changed and stays as it is; where it could not be read, now and then.
    fn is_due(&self, before: Option<FileStamp>) -> bool {
        match self.read {
            None => true,
            Some((then, _)) if then != self.seen => before == self.seen,
            Some((_, when)) => self.state.fault.is_some() && when.elapsed() >= RETRY,
        }
    }

    fn look_into(&mut self) {
        let now = Instant::now();
        match self.seen.map_or_else(|| Err(self.not_there()), |_| load(&self.path)) {
            Ok(Loaded { image, notes }) => {
                let begun = *self.begun.get_or_insert(now);
                let FileState { version, changes, picture, .. } = &self.state;
                let changes = changes + u64::from(picture.is_some());
                let (picture, seconds) = (Some(bare(&image)), (now - begun).as_secs_f64());
                self.state = FileState { version: version + 1, picture, notes, seconds, changes, fault: None };
            }
            Err(fault) if self.state.fault.as_ref() != Some(&fault) => {
                (self.state.fault, self.state.version) = (Some(fault), self.state.version + 1);
            }
            Err(_) => {}
        }
    }

    /// Why there is nothing to read.
    fn not_there(&self) -> String {
        let path = shown(&self.path);
        match std::fs::metadata(&self.path) {
            Ok(_) => format!("this is not a file, and a picture is shown as soon as it is one: {path}"),
            Err(why) if why.kind() != ErrorKind::NotFound => format!("cannot look at the picture ({why}): {path}"),
            Err(_) if self.state.picture.is_some() => {
                format!("the picture {path} is gone: what it was is shown until it is written again")
            }
            Err(_) => format!("there is no picture {path} yet: it is shown as soon as it is written"),
        }
    }
}

fn load(path: &std::path::Path) -> Result<Loaded, String> {
    let loaded = image_file::read(path).map_err(|fault| format!("{fault}; tried again when it changes"))?;
    let (width, height) = loaded.image.size();
    if width.max(height) > MOST_SIDE || u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!(
            "{width}x{height} pixels, where a side has at most {MOST_SIDE} and all are at most {MOST_PIXELS}: {}",
            shown(path)
        ));
    }
    Ok(loaded)
}

#[cfg(test)]
mod tests {
    use super::*;
    use film::{DisplayTransform, Vec3};
    use image_file::Kind;
    use visavis_tests::TestFolder;

    fn bytes(grey: f32) -> Vec<u8> {
        let image = Image::new(4, 2, vec![Vec3::splat(grey); 8]).expect("pixels");
        image_file::encode(Kind::Exr, &image, &DisplayTransform::default(), &Vec::new()).expect("an EXR")
    }

    /// Looks until it changes; two looks tell that a file stays as it is.
    fn next(follower: &mut Follower) -> FileState {
        let version = follower.state.version;
        let start = Instant::now();
        while follower.since(Some(version)).is_none() {
            assert!(start.elapsed() < Duration::from_secs(60), "waited a minute");
            std::thread::yield_now();
        }
        follower.state.clone()
    }

    fn grey(state: &FileState) -> Option<f32> {
        Some(state.picture.as_ref()?.radiances()[0].x)
    }

    #[test]
    fn a_file_is_waited_for_and_read_again_whenever_it_is_written_or_replaced() {
        let folder = TestFolder::new();
        let (file, other) = (folder.file("mine.exr"), folder.file("other"));
        let mut follower = Follower::new(file.clone());
        let waiting = follower.since(None).expect("a state").clone();
        assert!(waiting.picture.is_none() && waiting.fault.is_some_and(|fault| fault.contains("mine.exr yet")));
        std::fs::write(&file, bytes(0.25)).expect("a file");
        let first = next(&mut follower);
        assert_eq!((grey(&first), first.changes, first.seconds, first.fault), (Some(0.25), 0, 0.0, None));
        assert!(follower.since(Some(first.version)).is_none(), "it has not changed");
        std::fs::write(&other, bytes(0.5)).expect("a file");
        std::fs::rename(&other, &file).expect("a new name");
        let second = next(&mut follower);
        assert_eq!((grey(&second), second.changes), (Some(0.5), 1));
        assert!(second.seconds > 0.0);
    }

    #[test]
    fn of_a_file_that_is_half_written_the_picture_before_stays_and_the_rest_is_read() {
        let folder = TestFolder::new();
        let file = folder.file("mine.exr");
        std::fs::write(&file, bytes(0.25)).expect("a file");
        let mut follower = Follower::new(file.clone());
        assert_eq!(grey(follower.since(None).expect("a state")), Some(0.25));
        let whole = bytes(0.5);
        std::fs::write(&file, &whole[..whole.len() / 2]).expect("a file");
        let half = next(&mut follower);
        assert_eq!(grey(&half), Some(0.25));
        assert!(half.fault.is_some_and(|fault| fault.contains("mine.exr")));
        let version = Some(half.version);
        std::fs::write(&file, &whole[..whole.len() / 3]).expect("a file");
        assert!(follower.since(version).is_none(), "it may be in the middle of being written");
        std::fs::write(&file, &whole).expect("a file");
        assert!(follower.since(version).is_none(), "it has just changed again");
        let done = next(&mut follower);
        assert_eq!((grey(&done), done.fault), (Some(0.5), None));
        std::fs::remove_file(&file).expect("a file");
        let gone = next(&mut follower);
        assert_eq!(grey(&gone), Some(0.5), "what was there is still shown");
        assert!(gone.fault.is_some_and(|fault| fault.contains("mine.exr is gone")));
    }

    #[test]
    fn what_is_no_file_is_told_from_what_is_not_there() {
        let folder = TestFolder::new();
        let path = folder.file("mine.exr");
        let mut follower = Follower::new(path.clone());
        let said = |follower: &mut Follower| follower.state.fault.clone().expect("a fault");
        follower.since(None);
        assert!(said(&mut follower).contains("yet"));
        std::fs::create_dir(&path).expect("a folder");
        let folder = next(&mut follower);
        assert!(
            folder.fault.is_some_and(|fault| fault.starts_with("this is not a file") && fault.contains("mine.exr"))
        );
        #[cfg(unix)]
        assert!(Follower::new("/dev/null".into()).since(None).is_some_and(|state| {
            state.fault.as_ref().is_some_and(|fault| fault.starts_with("this is not a file"))
        }));
    }
}
