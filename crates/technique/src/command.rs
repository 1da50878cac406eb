//! The command lines that make a picture or a reference again, for a shell of the POSIX kind.

use crate::{Provenance, Recorded, Shot};
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
        options.extend(shot.camera_options(&shot.camera));
        options.extend(shot.changes.options_of(technique.name()));
        if exposure != 0.0 {
            options.push(("exposure", exposure.to_string()));
        }
        options.extend(technique.stated_for(&shot.scene).options(spp));
        line("render", &shot.source, out, &options)
    }
}

impl Recorded {
    /// The `visavis render` line of these options.
    pub fn command(&self, out: &str) -> String {
        let options = self.options.iter().map(|option| match option.split_once('=') {
            Some((name, value)) => format!(" {name} {}", quoted(value)),
            None => format!(" {option}"),
        });
        format!("visavis render {} -o {}{}", quoted(&self.scene), quoted(out), options.collect::<String>())
    }
}

impl Shot {
    /// The `visavis reference` line that makes the reference of what is seen.
    pub fn reference_command(&self) -> String {
        let mut options = vec![size_option(self.size)];
        options.extend(self.camera_options(&self.camera));
        options.extend(self.changes.options());
        line("reference", &self.source, "reference.exr", &options)
    }

    /// The `visavis ladder` line that climbs from the fake to the truth of what is seen, with these options more.
    pub fn ladder_command(&self, folder: &str, more: Vec<(&'static str, String)>) -> String {
        let mut options = vec![size_option(self.size)];
        options.extend(self.camera_options(&self.camera));
        options.extend(self.changes.options());
        options.extend(more);
        line("ladder", &self.source, folder, &options)
    }

    /// Options of `visavis render` that place a camera in this scene. Which way is up is left to the scene where its own
    /// camera says the same.
    pub fn camera_options(&self, camera: &Camera) -> Records {
        let up = (camera.up != self.own_up).then(|| ("up", point(camera.up)));
        let place = [("eye", point(camera.eye)), ("target", point(camera.target)), ("fov", camera.fov_y.to_string())];
        place.into_iter().chain(up).collect()
    }
}

fn line(command: &str, source: &str, out: &str, options: &Records) -> String {
    let options = options.iter().map(|(name, value)| format!(" --{name} {}", quoted(value)));
    format!("visavis {command} {} -o {}{}", quoted(source), quoted(out), options.collect::<String>())
}

pub(crate) fn size_option((width, height): (u32, u32)) -> (&'static str, String) {
    ("size", format!("{width}x{height}"))
}

/// Three numbers that are read back as the same ones.
fn point(p: Vec3) -> String {
    format!("{},{},{}", p.x, p.y, p.z)
}

/// A word as a shell of the POSIX kind takes it whole.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "/._-+:,=@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word.into() } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

/// What a `visavis render` line of this program makes; `None` if it is none. It knows nothing of the scene's hash.
pub fn made_by_command(command: &str) -> Option<Recorded> {
    let mut words = words(command)?.into_iter();
    if words.next()? != "visavis" || words.next()? != "render" {
        return None;
    }
    let scene = words.next()?;
    let mut options = Vec::new();
    while let Some(name) = words.next() {
        let value = words.next()?;
        if name != "-o" {
            options.push(format!("{name}={value}"));
        }
    }
    Some(Recorded::new(scene, None, options))
}

/// The words of a line as a shell takes them, quoted as [`quoted`] does it; `None` if a quote has no end.
fn words(line: &str) -> Option<Vec<String>> {
    let (mut words, mut word) = (Vec::new(), None::<String>);
    let mut letters = line.chars();
    while let Some(letter) = letters.next() {
        match letter {
            ' ' => words.extend(word.take()),
            '\'' => {
                let (inside, after) = letters.as_str().split_once('\'')?;
                word.get_or_insert_default().push_str(inside);
                letters = after.chars();
            }
            '\\' => word.get_or_insert_default().push(letters.next()?),
            other => word.get_or_insert_default().push(other),
        }
    }
    words.extend(word);
    Some(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_read_back_as_it_was_told() {
        for source in ["whitted", "my scene.toml", "it's/a b.toml", ""] {
            let edit = "{ material.\"it's\" = { ior = 2.0 } }";
            let options = [("technique", "path"), ("eye", "1,-2,3"), ("edit", edit)];
            let options: Records = options.into_iter().map(|(name, value)| (name, value.to_owned())).collect();
            let read = made_by_command(&line("render", source, "a b.png", &options)).expect("a command");
            let before = ["--connections=off", "--cones=off", "--split-glass=off"];
            let edit = format!("--edit={edit}");
            let expected = [&["--technique=path", "--eye=1,-2,3", &edit][..], &before].concat();
            assert_eq!(
                (read.scene.as_str(), read.options),
                (source, expected.into_iter().map(str::to_owned).collect())
            );
        }
        for none in
            ["", "visavis", "visavis reference whitted -o r.exr", "visavis render 'whitted", "visavis render w -o"]
        {
            assert_eq!(made_by_command(none), None, "{none}");
        }
    }

    #[test]
    fn which_way_is_up_is_told_where_the_scenes_own_camera_says_another() {
        let scene = scene::builtin::named("cornell").unwrap();
        let shot = Shot::of(scene, (4, 4));
        let up = |camera: &Camera| shot.camera_options(camera).into_iter().find(|(name, _)| *name == "up");
        assert_eq!(up(&shot.camera), None);
        let rolled = Camera { up: Vec3::new(0.6, 0.8, 0.0), ..shot.camera };
        assert_eq!(up(&rolled), Some(("up", "0.6,0.8,0".to_owned())));
    }

    #[test]
    fn words_with_blanks_and_quotes_stay_one_word() {
        assert_eq!(quoted("whitted"), "whitted");
        assert_eq!(quoted("my scene.toml"), "'my scene.toml'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
    }
}
