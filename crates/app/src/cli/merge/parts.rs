//! The films to be merged: whether they are parts of one picture.

use crate::cli::args::made_by;
use anyhow::{Context, bail, ensure};
use std::path::{Path, PathBuf};
use technique::{NONFINITE, SAMPLES, SampleRanges, is_of_its_pixels, sample_ranges};

/// A film of some of a picture's samples.
#[derive(Debug)]
pub struct Part {
    pub file: PathBuf,
    pub samples: SampleRanges,
    records: Vec<(String, String)>,
}

/// Records in which parts of one picture may differ: what a part took, and how a .png would show it.
const OF_A_PART: [&str; 8] = ["spp", SAMPLES, NONFINITE, "seconds", "adapter", "device", "command", "exposure"];

/// Reads what the films say of themselves; in the order of their samples, and which samples these are together.
///
/// # Errors
/// If they are not of one picture, or have samples in common.
pub fn checked(files: &[PathBuf]) -> anyhow::Result<(Vec<Part>, SampleRanges)> {
    let mut parts: Vec<Part> = files.iter().map(|file| Part::read(file)).collect::<anyhow::Result<_>>()?;
    parts.sort_by_key(|part| part.samples.first());
    let [first, others @ ..] = &parts[..] else { bail!("there is nothing to merge") };
    let mut all = first.samples.clone();
    for (index, part) in others.iter().enumerate() {
        part.check_beside(first)?;
        all = all.with(&part.samples).with_context(|| told_twice(&parts[..=index], part))?;
    }
    let device = |part: &Part| part.record("device").map(str::to_owned);
    if others.iter().any(|part| device(part) != device(first)) {
        note!(
            "note: some of these were made on the processor and some on a graphics device: one run has other rounding"
        );
    }
    Ok((parts, all))
}

/// Why a part does not go with those before it.
fn told_twice(before: &[Part], part: &Part) -> String {
    let other = before.iter().find(|other| other.samples.with(&part.samples).is_none());
    let other = other
        .map_or_else(String::new, |other| format!(", and {} in {}", other.samples, image_file::shown(&other.file)));
    let (samples, file) = (&part.samples, image_file::shown(&part.file));
    format!("samples would count twice: {samples}{other}: {file}")
}

/// What is said of a file that cannot be merged.
pub fn no_sums(file: &Path) -> String {
    format!("it has no sums of samples, as render --samples FROM..TO writes them: {}", image_file::shown(file))
}

impl Part {
    fn read(file: &Path) -> anyhow::Result<Self> {
        let mut records = image_file::records(file)?;
        // an .exr has them in no order
        records.sort();
        let damaged = || format!("cannot read its records: {}", image_file::shown(file));
        let samples = sample_ranges(&records).with_context(damaged)?.with_context(|| no_sums(file))?;
        // that they are options of render
        made_by(file)?;
        Ok(Part { file: file.to_owned(), samples, records })
    }

    fn record(&self, name: &str) -> Option<&str> {
        self.records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// Samples that were not finite.
    pub fn nonfinite(&self) -> anyhow::Result<u64> {
        let Some(word) = self.record(NONFINITE) else { return Ok(0) };
        word.parse()
            .with_context(|| format!("its record {NONFINITE} is damaged ({word}): {}", image_file::shown(&self.file)))
    }

    /// Refuses a part that is not of the same picture as another.
    fn check_beside(&self, other: &Part) -> anyhow::Result<()> {
        let [file, beside] = [&self.file, &other.file].map(|file| image_file::shown(file));
        let differs = |name: &str| self.record(name) != other.record(name);
        ensure!(self.record("scene.hash").is_some(), "it does not say of which scene it is: {file}");
        ensure!(!differs("scene.hash"), "it shows another scene than {beside}: {file}");
        // what says most comes first: other techniques have other settings too
        let first = ["version", "technique", "size"].into_iter();
        let names = first.chain(self.records.iter().chain(&other.records).map(|(name, _)| name.as_str()));
        let counts = |name: &&str| !OF_A_PART.contains(name) && *name != "scene" && !is_of_its_pixels(name);
        if let Some(name) = names.filter(counts).find(|name| differs(name)) {
            let of = |part: &Part| image_file::escaped(part.record(name).unwrap_or("not said"));
            bail!("its {name} is {}, and {} in {beside}: {file}", of(self), of(other));
        }
        Ok(())
    }
}

/// What is said of all together: what they have in common, and what they took.
pub fn records_of_all(parts: &[Part], exposure: f32) -> Vec<(String, String)> {
    let common = |(name, _): &&(String, String)| {
        (!OF_A_PART.contains(&name.as_str()) || name == "device") && !is_of_its_pixels(name)
    };
    let mut records: Vec<_> = parts[0].records.iter().filter(common).cloned().collect();
    let seconds = parts.iter().filter_map(|part| part.record("seconds")?.parse::<f64>().ok()).sum::<f64>();
    let mut adapters: Vec<&str> = Vec::new();
    for adapter in parts.iter().filter_map(|part| part.record("adapter")) {
        if !adapters.contains(&adapter) {
            adapters.push(adapter);
        }
    }
    records.push(("adapter".into(), adapters.join(", ")));
    records.push(("seconds".into(), seconds.to_string()));
    records.push(("exposure".into(), exposure.to_string()));
    records
}
