//! The plot of errors as a file: its numbers, or lines for slides and papers.

use super::Viewer;
use crate::engine::export::{Content, Export};
use crate::lab_report::plot;
use crate::model::{Destination, PlotFile, csv};

impl Viewer {
    /// Writes the curves that are shown, and those that are pinned.
    pub(super) fn export_plot(&mut self, kind: PlotFile, to: Destination) {
        let mut curves = self.presentation.shown.curves();
        curves.splice(0..0, self.model.state.pinned.iter().cloned());
        if curves.is_empty() {
            self.model.say(Err("no errors have been measured yet; try again in a moment".into()));
            return;
        }
        let text = match kind {
            PlotFile::Csv => csv(&curves),
            PlotFile::Svg => plot::svg(&curves, self.model.session.plots, &self.model.document.scene.name),
        };
        self.engine.export(Export { content: Content::Text(text), records: Vec::new(), to });
    }
}
