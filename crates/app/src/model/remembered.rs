//! What one window leaves to the next: the files that were opened last, and the window's size and place.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// What earlier windows have left: the whole of the file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Remembered {
    /// Scenes and pictures that were opened, the last one first; absolute paths.
    pub recent: Vec<PathBuf>,
    /// `None` before the first window was closed.
    pub window: Option<WindowPlace>,
}

/// How large a window was, and where.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WindowPlace {
    /// Width and height in points.
    pub size: [f64; 2],
    /// Left and top of its frame in pixels of all screens; `None` where the system does not tell.
    pub at: Option<[i32; 2]>,
    /// Whether it filled its screen.
    pub maximised: bool,
}

impl Remembered {
    /// The most files that are remembered.
    pub const MOST_FILES: usize = 10;

    /// A file was opened.
    pub fn opened(&mut self, file: PathBuf) {
        self.forget(&file);
        self.recent.insert(0, file);
        self.recent.truncate(Self::MOST_FILES);
    }

    /// A file is no longer there.
    pub fn forget(&mut self, file: &Path) {
        self.recent.retain(|known| known != file);
    }

    /// What was read, within bounds, without paths that mean another file in each folder, and without a window whose size is
    /// none.
    pub fn bounded(mut self) -> Self {
        self.recent.retain(|file| file.is_absolute());
        self.recent.truncate(Self::MOST_FILES);
        self.window.take_if(|place| !place.size.iter().all(|side| (1.0..=65536.0).contains(side)));
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_file_comes_first_once_and_ten_are_kept() {
        let mut remembered = Remembered::default();
        (0..12).for_each(|i| remembered.opened(format!("/{i}").into()));
        remembered.opened("/5".into());
        let names: Vec<_> = remembered.recent.iter().map(|path| path.display().to_string()).collect();
        assert_eq!(names, ["/5", "/11", "/10", "/9", "/8", "/7", "/6", "/4", "/3", "/2"]);
    }
}
