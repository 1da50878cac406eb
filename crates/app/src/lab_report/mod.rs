//! The lab report: what was rendered, how, what it took and how far off it is, as one page that needs nothing else
//! ([`LabReport::html`]), or as a slide of the same ([`LabReport::slide`]). Window and command line fill it in; who writes
//! it to a file has time, for the figures are measured here.

mod measured;
mod page;
mod pictures;
pub mod plot;
mod settings;
mod slide;

pub use measured::Measured;
pub use slide::SlideColours;

use crate::model::{Curve, External, PaneId, Session};
use crate::ruler::ReferenceImage;
use film::Image;
use pathtrace::Stats;
use scene::Scene;
use scene::edit::Edits;
use std::sync::Arc;
use technique::Provenance;

/// What a report is of.
#[derive(Debug, Clone)]
pub struct LabReport {
    /// The scene as it was opened.
    pub scene: Arc<Scene>,
    /// Panes, view, comparison, display and what is plotted.
    pub session: Session,
    /// The pictures, A first.
    pub pictures: Vec<ReportedPicture>,
    /// What judges them, where that is there.
    pub reference: Option<ReportedReference>,
    /// How errors have fallen, those that were pinned too.
    pub curves: Vec<Curve>,
    /// The text of the session's file, which makes all of it again.
    pub session_text: String,
    /// The day on which it was made: "2026-03-01".
    pub date: String,
}

/// A pane's picture and what it took.
#[derive(Debug, Clone)]
pub struct ReportedPicture {
    /// The pane whose picture it is.
    pub pane: PaneId,
    /// Its linear radiance, through no display transform.
    pub image: Image,
    /// What makes it again, with the runs that it has.
    pub provenance: Provenance,
    /// What it is where another program has made it: then its provenance says no more than what is seen.
    pub external: Option<Arc<External>>,
    /// Samples per pixel of all runs; `None` for a technique that does not sample.
    pub spp: Option<u32>,
    /// Pictures of which it is the mean.
    pub runs: u32,
    /// Seconds that rendering has taken in all.
    pub seconds: f64,
    /// Seconds of processor time that all threads took together, where that is known.
    pub core_seconds: Option<f64>,
    /// How many samples and rays it took, where it was traced.
    pub stats: Option<Stats>,
    /// What made it: a GPU's name, or a number of threads.
    pub adapter: String,
    /// What is to be known of it, a sentence each.
    pub notes: Vec<String>,
}

/// The reference of what is seen.
#[derive(Debug, Clone)]
pub struct ReportedReference {
    /// With its own noise.
    pub image: ReferenceImage,
    /// How it came about: "64 pictures, 12.3 s".
    pub made: String,
}

impl LabReport {
    /// The scene's name, and that it is a changed one where it is.
    fn name_of_scene(&self) -> String {
        let shown = self.pictures.first().map(|picture| &picture.provenance.shot.changes.edits);
        let edited = shown.and_then(Edits::told);
        std::iter::once(self.scene.name.clone()).chain(edited).collect::<Vec<_>>().join(", ")
    }
}

impl ReportedPicture {
    /// What tells it from the other pictures: "Path tracing, 0 bounces".
    fn label(&self, others: &[ReportedPicture]) -> String {
        if let Some(external) = &self.external {
            return external.title();
        }
        let technique = &self.provenance.technique;
        match others.iter().find(|other| other.pane != self.pane && other.external.is_none()) {
            Some(other) => technique.label_beside(&other.provenance.technique, &self.provenance.shot.scene),
            None => technique.label(),
        }
    }

    /// Its label, and its denoiser: no biased picture goes by the plain name of an unbiased one.
    fn title(&self, others: &[ReportedPicture]) -> String {
        std::iter::once(self.label(others)).chain(self.untold_denoiser(others)).collect::<Vec<_>>().join(", ")
    }

    /// "denoised by atrous (biased)", where it is and its label does not say so.
    fn untold_denoiser(&self, others: &[ReportedPicture]) -> Option<String> {
        self.denoised().filter(|denoised| !self.label(others).contains(denoised))
    }

    fn denoised(&self) -> Option<String> {
        let technique = &self.provenance.technique;
        let denoise = technique.denoise();
        let is_denoised = self.external.is_none() && technique.shows_the_scene() && denoise.is_on();
        is_denoised.then(|| format!("denoised by {} (biased)", denoise.denoiser.name()))
    }

    /// Whether it shows light, but not all of it.
    fn shows_a_part_of_the_light(&self) -> bool {
        let technique = &self.provenance.technique;
        self.external.is_none() && technique.shows_the_scene() && !technique.light().is_all()
    }

    /// "64 samples per pixel, 2.50 s"; what another program's picture took is not known here.
    fn cost(&self) -> String {
        if self.external.is_some() {
            return "made by another program".into();
        }
        self.samples().into_iter().chain([duration(self.seconds)]).collect::<Vec<_>>().join(", ")
    }

    /// Samples per pixel of one run.
    fn spp_of_run(&self) -> u32 {
        self.spp.unwrap_or(1) / self.runs.max(1)
    }

    /// "64 samples per pixel", "8 runs of 64 samples per pixel", or nothing.
    fn samples(&self) -> Option<String> {
        let spp = self.spp?;
        let of_run = match self.spp_of_run() {
            1 => "1 sample per pixel".into(),
            spp => format!("{spp} samples per pixel"),
        };
        Some(if self.runs > 1 { format!("{} runs of {of_run}", self.runs) } else { of_run }).filter(|_| spp > 0)
    }

    /// The line that makes it again; of another program's picture what it is.
    fn command(&self, exposure: f32) -> String {
        if let Some(external) = &self.external {
            return format!("# {}: {}", self.pane, external.told());
        }
        self.provenance.command(self.spp_of_run(), exposure, &format!("{}.png", self.pane.name().to_lowercase()))
    }
}

/// Why a picture of some of the light is not held against the reference.
const NO_REFERENCE_OF_A_PART: &str = "a part of the light has no reference";

/// A time for people: "4.2 ms", "1.3 s", "12 min".
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.01 => format!("{:.1} ms", 1e3 * s),
        s if s < 1.0 => format!("{:.0} ms", 1e3 * s),
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 600.0 => format!("{s:.1} s"),
        s => format!("{:.1} min", s / 60.0),
    }
}

#[cfg(test)]
mod tests;
