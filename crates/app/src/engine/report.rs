//! Reports and slides that are written beside the UI: measuring and encoding take their time.

use super::capture::Pixels;
use super::session::SessionToSave;
use crate::lab_report::{LabReport, SlideColours};
use crate::model::SlideSize;
use anyhow::ensure;
use image_file::shown;
use std::path::{Path, PathBuf};

/// A report to write.
#[derive(Debug, Clone)]
pub struct ReportToSave {
    /// All of it but the session's text.
    pub report: LabReport,
    /// What makes all of it again.
    pub session: SessionToSave,
}

/// A slide to write.
#[derive(Debug, Clone)]
pub struct SlideToSave {
    /// All that is known of the pictures, of which the slide shows those of the view.
    pub report: LabReport,
    /// How large it is.
    pub size: SlideSize,
    /// Those of its ground and of its text: dark, or light.
    pub colours: SlideColours,
}

impl ReportToSave {
    /// Writes it to a file; where there is one, to another beside it. Returns where.
    ///
    /// # Errors
    /// If its name is none of a page, if there is no memory, or if it cannot be written.
    pub fn save(&self, path: &Path) -> anyhow::Result<PathBuf> {
        let is_page = |kind: &std::ffi::OsStr| ["html", "htm"].iter().any(|page| kind.eq_ignore_ascii_case(page));
        ensure!(path.extension().is_some_and(is_page), "the name of a report must end in .html: {}", shown(path));
        let folder = std::path::absolute(path).ok().and_then(|path| path.parent().map(Path::to_owned));
        let session_text = self.session.text_in(&folder.unwrap_or_default());
        let report = LabReport { session_text, ..self.report.clone() };
        Ok(image_file::write_new(path, report.html()?.as_bytes())?)
    }
}

impl SlideToSave {
    /// Draws the slide where time does not matter: off the UI thread.
    ///
    /// # Errors
    /// If there is no memory, or nothing to show.
    pub fn pixels(&self) -> anyhow::Result<Pixels> {
        let rgba = self.report.slide(self.size, self.colours)?;
        let (width, height) = self.size.pixels();
        Ok(Pixels { width, height, rgba })
    }
}
