//! Where a picture comes from: everything that makes it again, as records to keep in its file and as a command to type.

use super::{Device, Recipe, SceneChanges, Technique};
use image_file::Records;
use scene::{Camera, Vec3};

/// All that a picture depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    /// The scene as the user asked for it: a built-in name or a file.
    pub source: String,
    /// What was changed in it.
    pub changes: SceneChanges,
    /// From where.
    pub camera: Camera,
    /// How.
    pub recipe: Recipe,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// On what.
    pub device: Device,
}

/// What a picture took, and how it is shown.
#[derive(Debug, Clone, Copy)]
pub struct Made<'a> {
    /// Samples per pixel; 1 for a technique that does not sample.
    pub spp: u32,
    /// Seconds of rendering.
    pub seconds: f64,
    /// What made it: a GPU's name, or a number of threads.
    pub adapter: &'a str,
    /// In stops.
    pub exposure: f32,
}

/// Version of the records; it grows when an older program would misread them.
const RECORDS_VERSION: &str = "1";

/// Records that say what a picture took, and are no options of `visavis render`.
const NO_OPTIONS: [&str; 6] = ["records", "version", "scene", "adapter", "seconds", "command"];

/// Records that say how far a picture is from another begin with this.
const MEASURED: &str = "error.";

/// What makes a picture with these records again: the scene, and options of `visavis render`. `None` if they are not
/// those of one pane's picture.
///
/// # Errors
/// If the records are of a later version.
pub fn made_from(records: &[(String, String)]) -> anyhow::Result<Option<(String, Vec<String>)>> {
    let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
    let (Some(version), Some(scene)) = (value("records"), value("scene")) else { return Ok(None) };
    anyhow::ensure!(
        version == RECORDS_VERSION,
        "its records are of version {version}, and this program reads version {RECORDS_VERSION}: use a newer one"
    );
    // only rays traced on the graphics device ask for it: the fake has no other, and the processor is the usual one
    let asks_for_gpu = value("device") == Some("gpu") && value("technique") != Some(Technique::Raster.name());
    let says_nothing = |name: &str| NO_OPTIONS.contains(&name) || (name == "device" && !asks_for_gpu);
    let is_option = |name: &str| !says_nothing(name) && !name.starts_with(MEASURED);
    let options = records.iter().filter(|(name, _)| is_option(name));
    let words = options.map(|(name, value)| format!("--{name}={value}"));
    Ok(Some((scene.to_owned(), words.collect())))
}

impl Provenance {
    /// What a file keeps of it, with the command that makes it as a PNG.
    pub fn records(&self, made: Made) -> Records {
        let Made { spp, seconds, adapter, exposure } = made;
        let mut records = vec![
            ("records", RECORDS_VERSION.into()),
            ("version", env!("CARGO_PKG_VERSION").into()),
            ("scene", self.source.clone()),
            ("technique", self.recipe.technique().name().into()),
            ("device", self.device.name().into()),
            ("adapter", adapter.into()),
            ("size", format!("{}x{}", self.size.0, self.size.1)),
            ("seconds", seconds.to_string()),
            ("eye", point(self.camera.eye)),
            ("target", point(self.camera.target)),
            ("fov", self.camera.fov_y.to_string()),
        ];
        // what was not changed is the scene's, and may differ from glass to glass
        records.extend(self.changes.refraction_ratio.map(|ratio| ("refraction-ratio", ratio.to_string())));
        // the fake does not see the sun's radius, but what it is compared with does
        records.extend(self.changes.sun_radius.map(|radius| ("sun-radius", radius.to_string())));
        records.extend(self.recipe.options(spp));
        records.push(("exposure", exposure.to_string()));
        records.push(("command", self.command(spp, exposure, "picture.png")));
        records
    }

    /// The `visavis render` line that makes the same picture with `spp` samples per pixel, for a shell of the POSIX
    /// kind.
    pub fn command(&self, spp: u32, exposure: f32, out: &str) -> String {
        let mut words = vec!["visavis".into(), "render".into(), quoted(&self.source), "-o".into(), quoted(out)];
        let mut option = |name: &str, value: String| words.extend([format!("--{name}"), value]);
        option("technique", self.recipe.technique().name().into());
        if self.device != self.recipe.technique().usual_machine() {
            option("device", self.device.name().into());
        }
        option("size", format!("{}x{}", self.size.0, self.size.1));
        option("eye", point(self.camera.eye));
        option("target", point(self.camera.target));
        option("fov", self.camera.fov_y.to_string());
        if let Some(ratio) = self.changes.refraction_ratio {
            option("refraction-ratio", ratio.to_string());
        }
        if let (Some(radius), Recipe::Rays(_)) = (self.changes.sun_radius, self.recipe) {
            option("sun-radius", radius.to_string());
        }
        if exposure != 0.0 {
            option("exposure", exposure.to_string());
        }
        for (name, value) in self.recipe.options(spp) {
            option(name, value);
        }
        words.join(" ")
    }
}

impl Recipe {
    /// The options of `visavis render` that say how, by their names without dashes.
    pub fn options(&self, spp: u32) -> Records {
        match self {
            Recipe::Fake(fake) => fake.options(),
            Recipe::Rays(rays) => rays.options(spp),
        }
    }
}

/// Three numbers that are read back as the same ones.
pub fn point(p: Vec3) -> String {
    format!("{},{},{}", p.x, p.y, p.z)
}

/// A word as a shell takes it whole.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+:,=@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_with_blanks_and_quotes_stay_one_word() {
        assert_eq!(quoted("whitted"), "whitted");
        assert_eq!(quoted("my scene.toml"), "'my scene.toml'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
    }
}
