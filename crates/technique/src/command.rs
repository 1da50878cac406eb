//! The command lines that make a picture or a reference again, for a shell of the POSIX kind.

use crate::{Provenance, Shot};
use image_file::Records;
use scene::{Camera, Vec3};

impl Provenance {
    /// The `visavis render` line that makes the same picture with `spp` samples per pixel.
    pub fn command(&self, spp: u32, exposure: f32, out: &str) -> String {
        let Provenance { shot, technique, device } = self;
        let mut options = vec![("technique", technique.name().name().to_owned())];
        if *device != technique.name().usual_device() {
            options.push(("device", device.name().into()));
        }
        options.push(size_option(shot.size));
        options.extend(camera_options(&shot.camera));
        options.extend(shot.changes.options_of(technique.name()));
        if exposure != 0.0 {
            options.push(("exposure", exposure.to_string()));
        }
        options.extend(technique.options(spp));
        line("render", &shot.source, out, &options)
    }
}

impl Shot {
    /// The `visavis reference` line that makes the reference of what is seen.
    pub fn reference_command(&self) -> String {
        let mut options = vec![size_option(self.size)];
        options.extend(camera_options(&self.camera));
        options.extend(self.changes.options());
        line("reference", &self.source, "reference.exr", &options)
    }
}

fn line(command: &str, source: &str, out: &str, options: &Records) -> String {
    let options = options.iter().map(|(name, value)| format!(" --{name} {value}"));
    format!("visavis {command} {} -o {}{}", quoted(source), quoted(out), options.collect::<String>())
}

pub(crate) fn size_option((width, height): (u32, u32)) -> (&'static str, String) {
    ("size", format!("{width}x{height}"))
}

pub(crate) fn camera_options(camera: &Camera) -> Records {
    vec![("eye", point(camera.eye)), ("target", point(camera.target)), ("fov", camera.fov_y.to_string())]
}

/// Three numbers that are read back as the same ones.
fn point(p: Vec3) -> String {
    format!("{},{},{}", p.x, p.y, p.z)
}

/// A word as a shell takes it whole.
fn quoted(word: &str) -> String {
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
