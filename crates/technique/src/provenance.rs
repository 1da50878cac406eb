//! Where a picture comes from: everything that makes it again, as records to keep in its file and as a command to type.

use crate::command::size_option;
use crate::settings::unsaid_of_old;
use crate::{Device, HALVES, SampleRanges, Shot, Technique, TechniqueName, TracedSettings};
use anyhow::Context;
use image_file::Records;
use pathtrace::{Integrator, usual_radius};
use scene::{Scene, SceneHash};

/// All that a picture depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    /// Scene, camera and size of the picture.
    pub shot: Shot,
    /// How it is made.
    pub technique: Technique,
    /// What has made it.
    pub device: Device,
}

impl Provenance {
    /// The same of a picture that is the mean of so many, where more may have been asked for.
    pub fn of_runs(&self, runs: u32) -> Self {
        Provenance { technique: self.technique.with_runs(runs), ..self.clone() }
    }
}

/// What a picture took, and how it is shown.
#[derive(Debug, Clone, Copy)]
pub struct Made<'a> {
    /// Samples per pixel, of one run where there are several; 1 for a technique that does not sample.
    pub spp: u32,
    /// Seconds that rendering took.
    pub seconds: f64,
    /// What made it: a GPU's name, or a number of threads.
    pub adapter: &'a str,
    /// What denoised it, likewise; `None` of a picture as it is rendered. Machines filter alike but for rounding.
    pub denoised_by: Option<&'a str>,
    /// Exposure of the display transform, in stops.
    pub exposure: f32,
}

/// What a picture's records say of how it was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// The scene as the user asked for it then.
    pub scene: String,
    /// The scene as it was read then; `None` of records from before it was kept.
    pub scene_hash: Option<SceneHash>,
    /// Options of `visavis render`.
    pub options: Vec<String>,
}

impl Recorded {
    /// With what these options leave unsaid because they are older than a setting.
    pub(crate) fn new(scene: String, scene_hash: Option<SceneHash>, mut options: Vec<String>) -> Self {
        let pairs = options.iter().filter_map(|option| option.strip_prefix("--")?.split_once('='));
        let value = |name: &str| pairs.clone().find(|(known, _)| *known == name).map(|(_, value)| value);
        let technique = value("technique").map_or(Some(TechniqueName::Path), TechniqueName::named);
        let unsaid = technique.into_iter().flat_map(|technique| unsaid_of_old(technique, |name| value(name).is_some()));
        let unsaid: Vec<String> = unsaid.map(|(name, value)| format!("--{name}={value}")).collect();
        options.extend(unsaid);
        Recorded { scene, scene_hash, options }
    }
}

/// Version of the records; it grows when an older program would misread them, or when a scene has another hash.
/// 2: with the scene's hash.
const RECORDS_VERSION: u32 = 2;

/// The record's name of the hash that [`Scene::as_read`](scene::Scene::as_read) makes.
const SCENE_HASH: &str = "scene.hash";

/// Holds the vertical angle of view of the camera whose picture this is, where the picture shows more: it was in a part of a
/// window that has room for that above and below.
pub const OWN_FOV: &str = "camera.fov";

/// The record of a picture in which earlier views of a window count, which nothing makes again: how much.
pub const EARLIER_VIEWS: &str = "history.counts";

/// The record of a picture whose sums are kept: which samples of its pixels they are of.
pub const SAMPLES: &str = "samples";

/// Its option, where they are not those from the first on.
const SPP: &str = "spp";

/// The record of such a picture of how many samples were not finite, if any were.
pub const NONFINITE: &str = "nonfinite";

/// Records that say what a picture took or where it was, and are no options of `visavis render`.
const NO_OPTIONS: [&str; 10] =
    ["records", "version", "scene", SCENE_HASH, "adapter", "seconds", "command", OWN_FOV, EARLIER_VIEWS, NONFINITE];

/// The record's name of the weights that a picture was denoised by.
pub const WEIGHTS: &str = "denoise.weights";

/// The record's name of what denoised a picture, as `adapter` says what traced it.
const DENOISED_BY: &str = "denoise.adapter";

/// Records that say how far a picture is from another begin with this.
const MEASURED: &str = "error.";

/// The record's name of the filter that took a picture's noise away, which is an option of `visavis render` too; with a dot behind
/// it the beginning of what more is said of that.
pub const DENOISE: &str = "denoise";

/// The option that says how far samples are trusted beside that.
const TRUST: &str = "trust";

/// The record of a filter that cannot be asked for again: of a picture that was denoised before, or that no light was traced for.
pub const FILTER: &str = "denoise.filter";

/// The filter that took a picture's noise away, if one did.
pub fn denoised_by(records: &[(String, String)]) -> Option<&str> {
    records
        .iter()
        .find(|(name, filter)| [DENOISE, FILTER].contains(&name.as_str()) && filter != "off")
        .map(|(_, filter)| filter.as_str())
}

/// The bugs that a picture was made with on purpose, by its records: "bugs on (no-cosine)", or that one is hidden.
pub fn bugs_of(records: &[(String, String)]) -> Option<String> {
    let value = |name: &str, none: &str| {
        records.iter().find(|(known, value)| known == name && value != none).map(|(_, value)| value.as_str())
    };
    match (value("bugs", "none"), value("find-bug", "0")) {
        (None, None) => None,
        (Some(bugs), None) => Some(format!("bugs on ({bugs})")),
        (None, Some(_)) => Some("a bug on that is not told".into()),
        (Some(bugs), Some(_)) => Some(format!("bugs on ({bugs} and one that is not told)")),
    }
}

/// Which light a picture shows by its records, in the words of `--light`; `None` of records that say nothing of how it was made.
pub fn light_of(records: &[(String, String)]) -> Option<&str> {
    let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
    // references, and what cannot choose, have all light and need not say so
    value("scene").map(|_| value("light").unwrap_or("all"))
}

/// Whether a record says something of the noisy picture that does not hold once it is denoised, or of denoising itself.
pub fn is_of_its_pixels(name: &str) -> bool {
    let is_of_halves = HALVES.iter().any(|half| name.starts_with(half));
    name.starts_with(MEASURED) || name.starts_with(DENOISE) || name == TRUST || is_of_halves
}

/// What makes a picture with these records again. `None` if they are not those of one pane's picture.
///
/// # Errors
/// If the records are of a later version, or damaged.
pub fn made_from(records: &[(String, String)]) -> anyhow::Result<Option<Recorded>> {
    let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
    let (Some(version), Some(scene)) = (value("records"), value("scene")) else { return Ok(None) };
    anyhow::ensure!(
        version.parse().is_ok_and(|version: u32| (1..=RECORDS_VERSION).contains(&version)),
        "its records are of version {version}, and this program reads versions 1 to {RECORDS_VERSION}: use a newer one"
    );
    // only rays traced on the graphics device ask for it: the fake has no other, and the processor is the usual one
    let asks_for_gpu = value("device") == Some("gpu") && value("technique") != Some(TechniqueName::Raster.name());
    let says_nothing = |name: &str| NO_OPTIONS.contains(&name) || (name == "device" && !asks_for_gpu);
    let of_samples = if sample_ranges(records)?.is_none_or(|ranges| ranges.are_the_first()) { SAMPLES } else { SPP };
    let says_nothing = |name: &str| says_nothing(name) || name == of_samples;
    let is_option = |name: &str| !says_nothing(name) && ([DENOISE, TRUST].contains(&name) || !is_of_its_pixels(name));
    let options = records.iter().filter(|(name, _)| is_option(name));
    let words = options.map(|(name, value)| format!("--{name}={value}")).collect();
    Ok(Some(Recorded::new(scene.to_owned(), scene_hash(records)?, words)))
}

/// The scene that a picture or a reference shows, as it was read then; `None` if its records do not tell.
///
/// # Errors
/// If they are damaged.
pub fn scene_hash(records: &[(String, String)]) -> anyhow::Result<Option<SceneHash>> {
    let Some((_, word)) = records.iter().find(|(name, _)| name == SCENE_HASH) else { return Ok(None) };
    Ok(Some(word.parse().with_context(|| format!("its record {SCENE_HASH} is damaged: {word}"))?))
}

/// Which samples of its pixels a picture has the sums of; `None` if its records do not tell.
///
/// # Errors
/// If they are damaged.
pub fn sample_ranges(records: &[(String, String)]) -> anyhow::Result<Option<SampleRanges>> {
    let Some((_, words)) = records.iter().find(|(name, _)| name == SAMPLES) else { return Ok(None) };
    let ranges = words.parse().map_err(anyhow::Error::msg);
    Ok(Some(ranges.with_context(|| format!("its record {SAMPLES} is damaged: {words}"))?))
}

/// Says in a picture's records which samples it has the sums of, and by which command they are made, if there is one.
///
/// # Errors
/// Those of [`made_from`], in the same words.
pub fn tell_samples(records: &mut Vec<(String, String)>, samples: &SampleRanges) -> anyhow::Result<()> {
    records.retain(|(name, _)| ![SPP, SAMPLES, "command"].contains(&name.as_str()));
    records.push((SPP.into(), samples.count().to_string()));
    records.push((SAMPLES.into(), samples.to_string()));
    if samples.without_gaps().is_some()
        && let Some(made) = made_from(records)?
    {
        let out = if samples.are_the_first() { "picture.png" } else { "picture.exr" };
        records.push(("command".into(), made.command(out)));
    }
    Ok(())
}

impl Provenance {
    /// What a file keeps of it, with the command that makes it as a PNG.
    pub fn records(&self, made: Made) -> Records {
        let Made { spp, seconds, adapter, denoised_by, exposure } = made;
        let Shot { source, changes, camera, size, .. } = &self.shot;
        let mut records = vec![
            ("records", RECORDS_VERSION.to_string()),
            ("version", env!("CARGO_PKG_VERSION").into()),
            ("scene", source.clone()),
            self.shot.hash_record(),
            ("technique", self.technique.name().name().into()),
            ("device", self.device.name().into()),
            ("adapter", adapter.into()),
            size_option(*size),
            ("seconds", seconds.to_string()),
        ];
        records.extend(self.shot.camera_options(camera));
        // the fake does not see the sun's radius, but what it is compared with does
        records.extend(changes.options());
        records.extend(self.technique.stated_for(&self.shot.scene).options(spp));
        records.extend(self.technique.denoise().denoiser.weights().map(|weights| (WEIGHTS, weights)));
        records.extend(denoised_by.map(|by| (DENOISED_BY, by.to_owned())));
        records.push(("exposure", exposure.to_string()));
        records.push(("command", self.command(spp, exposure, "picture.png")));
        records
    }
}

impl Technique {
    /// The same with what it leaves to `scene` and its camera stated, where another camera would say something else.
    pub(crate) fn stated_for(mut self, scene: &Scene) -> Self {
        if let Technique::Traced(TracedSettings { integrator: Integrator::Photon(photon), .. }) = &mut self {
            photon.radius.get_or_insert_with(|| usual_radius(scene));
        }
        self
    }
}

impl Shot {
    /// What tells a scene from another of its name.
    pub fn hash_record(&self) -> (&'static str, String) {
        (SCENE_HASH, self.scene.as_read.to_string())
    }

    /// What the file of its reference keeps of it, with the command that makes that.
    pub fn reference_records(&self, estimator: &str) -> Records {
        let mut records = vec![
            ("version", env!("CARGO_PKG_VERSION").into()),
            ("scene", self.source.clone()),
            self.hash_record(),
            size_option(self.size),
        ];
        records.extend(self.camera_options(&self.camera));
        records.push(("estimator", estimator.into()));
        records.extend(self.changes.options());
        records.push(("command", self.reference_command()));
        records
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_by_command;

    #[test]
    fn what_a_picture_has_of_earlier_views_is_no_option() {
        let record = |name: &str, value: &str| (name.to_owned(), value.to_owned());
        let records = ["records=2", "scene=cornell", "technique=whitted", "history=32", "history.counts=30 spp"];
        let records = records.map(|pair| pair.split_once('=').map(|(name, value)| record(name, value)).unwrap());
        let made = made_from(&records).unwrap().unwrap();
        assert_eq!(made.options, ["--technique=whitted", "--history=32"]);
    }

    /// Pictures from before there were connections, cones and split glass were made without them, and those of
    /// techniques that have none stay as they are.
    #[test]
    fn what_old_records_leave_unsaid_is_what_was_done_then() {
        let old = |technique: &str| {
            let record = |name: &str, value: &str| (name.to_owned(), value.to_owned());
            let records = [record("records", "2"), record("scene", "whitted"), record("technique", technique)];
            made_from(&records).unwrap().unwrap().options
        };
        let left_to_chance = ["--connections=off", "--cones=off", "--split-glass=off"];
        assert_eq!(old("path"), [&["--technique=path"][..], &left_to_chance].concat());
        assert_eq!(old("whitted"), ["--technique=whitted"]);
        let line = |words: &str| made_by_command(&format!("visavis render whitted {words} -o a.png")).unwrap().options;
        assert_eq!(line("--technique path"), old("path"));
        let said = ["--technique=path", "--connections=on", "--cones=all", "--split-glass=on"];
        assert_eq!(line("--technique path --connections on --cones all --split-glass on"), said);
        let unsaid = [&["--spp=4"][..], &left_to_chance].concat();
        assert_eq!(line("--spp 4"), unsaid, "paths are what is traced unless it says");
    }
}
