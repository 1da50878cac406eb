//! A ladder on its way into a folder: measuring and encoding take their time.

use crate::ladder::{Made, Reached, save};
use crate::ruler::ReferenceImage;
use anyhow::Context;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A ladder to write.
#[derive(Debug, Clone)]
pub struct LadderToSave {
    /// Name of the scene that was climbed, for the chart.
    pub scene: String,
    /// Its rungs in the order in which they were reached.
    pub rungs: Vec<Made>,
    /// What they are measured by.
    pub reference: Arc<ReferenceImage>,
}

impl LadderToSave {
    /// Writes the files of `visavis ladder` into a folder of this name; where there is one, into another with a number behind its
    /// name. Returns where.
    ///
    /// # Errors
    /// If a file can't be written: one line.
    pub fn save(&self, folder: &Path) -> anyhow::Result<PathBuf> {
        let numbered = (2..1000).map(|number| {
            let mut name = folder.as_os_str().to_owned();
            name.push(format!("-{number}"));
            PathBuf::from(name)
        });
        let free = std::iter::once(folder.to_owned()).chain(numbered).find(|folder| !folder.exists());
        let name = image_file::shown(folder);
        let folder = free.with_context(|| format!("there are a thousand of these already: {name}"))?;
        let reached = self.rungs.iter().map(|made| made.measured(&self.reference));
        save(&folder, &self.scene, &reached.collect::<anyhow::Result<Vec<Reached>>>()?)?;
        Ok(folder)
    }
}
