//! What is on the screen as a lab report, or as a slide.

use super::Viewer;
use crate::engine::Picture;
use crate::engine::export::{Content, Export};
use crate::engine::report::{ReportToSave, SlideToSave};
use crate::lab_report::{LabReport, ReportedPicture, ReportedReference, SlideColours};
use crate::model::{Destination, Effort, PaneId, Progress, SlideSize, Theme};
use std::sync::Arc;
use technique::{Denoiser, Technique};

impl Viewer {
    /// Writes all that is known of the pictures as a page.
    pub(super) fn export_report(&mut self, to: Destination) {
        let Some(report) = self.report() else { return };
        let content = Content::Report(Box::new(ReportToSave { report, session: self.session() }));
        self.engine.export(Export { content, records: Vec::new(), to });
    }

    /// Writes the pictures of the view with large labels; the file opens as what it shows.
    pub(super) fn export_slide(&mut self, size: SlideSize, to: Destination) {
        let Some(report) = self.report() else { return };
        let colours = SlideColours::of(self.model.state.theme == Theme::Dark);
        let records = self.presentation.records_of_all(&self.model);
        self.engine.export(Export {
            content: Content::Slide(Box::new(SlideToSave { report, size, colours })),
            records,
            to,
        });
    }

    /// All but the session's text; or a line on why there is nothing to report yet.
    fn report(&mut self) -> Option<LabReport> {
        let pictures = match self.presentation.whole_pictures(&self.model) {
            Ok(pictures) => pictures.into_iter().map(|(pane, picture)| reported(pane, picture)).collect(),
            Err(pane) => {
                self.model.say(Err(format!("{pane} has no whole picture yet; try again in a moment")));
                return None;
            }
        };
        let shown = &self.presentation.shown;
        let curves = self.model.state.pinned.iter().cloned().chain(shown.curves()).collect();
        Some(LabReport {
            scene: self.model.document.scene.clone(),
            session: self.model.session.clone(),
            pictures,
            reference: self.reference(),
            curves,
            session_text: String::new(),
            date: bench::today(),
        })
    }

    /// What judges the pictures, if the reference does.
    fn reference(&self) -> Option<ReportedReference> {
        let shown = &self.presentation.shown;
        let image = shown.panes.values().find_map(|pane| pane.reference.clone())?;
        let made = match &shown.reference {
            Some(Progress { pictures, seconds, .. }) if *pictures > 0 => {
                format!("{pictures} pictures, {seconds:.1} s")
            }
            _ => "from a file".to_owned(),
        };
        Some(ReportedReference { image, made })
    }
}

fn reported(pane: PaneId, picture: &Picture) -> ReportedPicture {
    let mut image = picture.image.clone();
    image.layers.clear();
    let unfinished = picture.unfinished.then(|| "still being made".to_owned());
    let lag = picture.lag.map(|lag| format!("earlier views count in it: {lag}"));
    let told = [&picture.refused, &picture.filter_fault, &picture.cut].into_iter().flatten().map(Arc::to_string);
    let (mut provenance, _) = picture.made();
    if let (None, Technique::Traced(traced)) = (&picture.before, &mut provenance.technique) {
        traced.denoise.denoiser = Denoiser::Off;
    }
    ReportedPicture {
        pane,
        image,
        provenance,
        external: picture.external.clone(),
        spp: picture.spp,
        runs: picture.runs,
        seconds: picture.seconds,
        core_seconds: None,
        stats: match picture.effort {
            Effort::Traced(stats) => Some(stats),
            Effort::Drawn(_) => None,
        },
        adapter: picture.adapter.to_string(),
        notes: unfinished.into_iter().chain(lag).chain(told).collect(),
    }
}
