//! What the next window is to know: files that were opened, size and place of the window. One small file of the user's, whole
//! or not there.

use super::worker::{Control, Service, Worker};
use crate::model::{Remembered, WindowPlace};
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file of more bytes than this is none of ours.
const LARGEST: u64 = 1 << 16;

/// What has happened that the next window is to know of.
#[derive(Debug, Clone, PartialEq)]
pub enum Memo {
    /// A file that was opened.
    Opened(PathBuf),
    /// A file that is no longer there.
    Gone(PathBuf),
    /// Size and place of the window.
    Window(WindowPlace),
}

impl Memo {
    /// Adds it to what is remembered.
    pub fn note_in(self, remembered: &mut Remembered) {
        match self {
            Memo::Opened(file) => remembered.opened(file),
            Memo::Gone(file) => remembered.forget(&file),
            Memo::Window(place) => remembered.window = Some(place),
        }
    }
}

/// The user's file, in the system's folder for what programs remember; `None` without such a folder.
pub fn file_of_the_user() -> Option<PathBuf> {
    image_file::state_folder().map(|folder| folder.join("visavis").join("window.json"))
}

/// What the file holds; nothing where there is none.
///
/// # Errors
/// One line where it is damaged.
pub fn recall(file: &Path) -> Result<Remembered, String> {
    let damaged =
        |why: String| format!("what was remembered is damaged ({why}) and begins anew: {}", image_file::shown(file));
    let Ok(found) = std::fs::metadata(file) else { return Ok(Remembered::default()) };
    if !found.is_file() || found.len() > LARGEST {
        return Err(damaged("it is no file of this program".into()));
    }
    let text = std::fs::read_to_string(file).map_err(|why| damaged(why.to_string()))?;
    let remembered: Remembered = serde_json::from_str(&text).map_err(|why| damaged(why.to_string()))?;
    Ok(remembered.bounded())
}

/// The thread that writes it; dropping it ends the thread once all is written.
pub struct Memory(Worker<Vec<Memo>>);

impl Memory {
    /// Starts the thread that writes to `file`.
    ///
    /// # Errors
    /// If the system gives none.
    pub fn start(file: PathBuf) -> std::io::Result<Self> {
        Worker::start("memory", Arc::new(|| {}), || Pen { file, told: false }).map(Memory)
    }

    /// Remembers this, after what came before.
    pub fn note(&self, memo: Memo) {
        self.0.post(|memos| memos.push(memo));
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        self.0.close_when_done();
    }
}

struct Pen {
    file: PathBuf,
    /// Whether it was told that the file cannot be written.
    told: bool,
}

impl Service for Pen {
    type Job = Vec<Memo>;
    type Update = ();

    fn serve(&mut self, memos: Vec<Memo>, _control: &Control<Self::Job, Self::Update>) {
        // nobody would miss it today, and there may be no window any more
        if let Some(line) = self.fault_of(memos) {
            note!("note: {line}");
        }
    }

    fn recover(&mut self, _control: &Control<Self::Job, Self::Update>) {}
}

impl Pen {
    /// Why these are not remembered: one line, the first time.
    fn fault_of(&mut self, memos: Vec<Memo>) -> Option<String> {
        let fault = add(memos, &self.file).err()?;
        let first = !std::mem::replace(&mut self.told, true);
        first.then(|| format!("recent files and the window's place are not remembered: {fault:#}"))
    }
}

/// Adds to what is there by now: another window may have written since, and waits meanwhile.
fn add(memos: Vec<Memo>, file: &Path) -> anyhow::Result<()> {
    let folder = file.parent().unwrap_or(Path::new(""));
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", image_file::shown(folder)))?;
    let _alone = image_file::hold(folder, true);
    let before = recall(file);
    let mut remembered = before.clone().unwrap_or_default();
    memos.into_iter().for_each(|memo| memo.note_in(&mut remembered));
    if before.as_ref() == Ok(&remembered) {
        return Ok(());
    }
    Ok(image_file::write_whole(file, serde_json::to_string_pretty(&remembered)?.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use visavis_tests::TestFolder;

    #[test]
    fn what_is_noted_is_recalled_beside_what_another_window_noted() {
        let folder = TestFolder::new();
        let file = folder.file("state/window.json");
        let place = WindowPlace { size: [900.0, 600.0], at: Some([10, -20]), maximised: true };
        let [first, second] = [0; 2].map(|_| Memory::start(file.clone()).expect("a thread"));
        first.note(Memo::Opened("/a.toml".into()));
        first.note(Memo::Window(place));
        drop(first);
        second.note(Memo::Opened("/b.toml".into()));
        second.note(Memo::Opened("/c.toml".into()));
        second.note(Memo::Gone("/c.toml".into()));
        drop(second);
        let expected = Remembered { recent: vec!["/b.toml".into(), "/a.toml".into()], window: Some(place) };
        assert_eq!(recall(&file), Ok(expected));
        assert_eq!(folder.names(), ["state"], "nothing is left beside it");
    }

    #[test]
    fn windows_that_remember_at_once_lose_nothing_of_each_other() {
        let folder = TestFolder::new();
        for round in 0..8 {
            let file = folder.file(&format!("{round}/window.json"));
            let windows: Vec<_> = (0..8).map(|_| Memory::start(file.clone()).expect("a thread")).collect();
            for (index, window) in windows.iter().enumerate() {
                window.note(Memo::Opened(format!("/{index}.toml").into()));
            }
            drop(windows);
            let mut recent = recall(&file).expect("a memory").recent;
            recent.sort();
            let all: Vec<PathBuf> = (0..8).map(|index| format!("/{index}.toml").into()).collect();
            assert_eq!(recent, all, "round {round}");
        }
    }

    #[test]
    fn what_cannot_be_written_is_told_once_with_its_path() {
        let folder = TestFolder::new();
        std::fs::write(folder.file("state"), "a file where a folder must be").expect("a file");
        std::fs::create_dir_all(folder.file("taken/window.json")).expect("a folder");
        for (file, path) in [("state/window.json", "state"), ("taken/window.json", "taken/window.json")] {
            let mut pen = Pen { file: folder.file(file), told: false };
            let mut note = || pen.fault_of(vec![Memo::Opened("/a.toml".into())]);
            let line = note().expect("a line");
            let path = image_file::shown(&folder.file(path));
            assert!(line.matches(&path).count() == 1 && line.lines().count() == 1, "{line}");
            assert_eq!(note(), None, "once is enough");
        }
    }

    #[test]
    fn a_damaged_memory_is_told_and_begins_anew() {
        let folder = TestFolder::new();
        let file = folder.file("window.json");
        assert_eq!(recall(&file), Ok(Remembered::default()), "no file is no fault");
        for text in ["{", "words", r#"{"recent": 1}"#, &"x".repeat(1 << 17)] {
            std::fs::write(&file, text).expect("a file");
            let said = recall(&file).expect_err(text);
            assert!(said.contains("window.json") && said.lines().count() == 1, "{said}");
        }
        let memory = Memory::start(file.clone()).expect("a thread");
        memory.note(Memo::Opened("/a.toml".into()));
        drop(memory);
        assert_eq!(recall(&file).expect("a memory").recent, [PathBuf::from("/a.toml")]);
        let strange = r#"{"recent": ["", "a.toml", "/a.toml", "../b.toml"]}"#;
        std::fs::write(&file, strange).expect("a file");
        assert_eq!(recall(&file).expect("a memory").recent, [PathBuf::from("/a.toml")]);
        let many = Remembered { recent: (0..50).map(|i| format!("/{i}.toml").into()).collect(), window: None };
        std::fs::write(&file, serde_json::to_string(&many).expect("JSON")).expect("a file");
        assert_eq!(recall(&file).expect("a memory").recent.len(), Remembered::MOST_FILES);
    }
}
