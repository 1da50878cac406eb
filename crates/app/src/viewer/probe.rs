//! The samples of a pixel as a file.

use super::Viewer;
use crate::engine::export::{Content, Export};
use crate::model::Destination;

impl Viewer {
    /// Writes all samples that were traced again, of all panes that have any.
    pub(super) fn export_samples(&mut self, to: Destination) {
        let probed = self.presentation.shown.probe.iter();
        let samples: Vec<_> = probed.filter_map(|(id, probe)| Some((id, probe.samples.clone()?))).collect();
        if samples.is_empty() {
            self.model.say(Err("no samples of the pixel have been traced yet; try again in a moment".into()));
            return;
        }
        self.engine.export(Export { content: Content::Samples(samples), records: Vec::new(), to });
    }
}
