//! What a label says of a picture that another program has made: no samples, no settings, but how large it is and
//! how it came here.

use super::text::{LabelText, duration};
use crate::model::{External, PaneSource, PaneView};
use technique::settings::grouped;

/// Adds what is known of it.
pub fn tell(text: &mut LabelText, shown: &PaneView, external: &External) {
    if let Some(image) = &shown.image {
        text.figures.push(format!("{} x {} pixels", image.width(), image.height()));
    }
    text.figures.extend(changes(external, shown.seconds));
    text.facts.push(match &external.source {
        PaneSource::Followed(_) => "a file, read again whenever it changes".into(),
        source => source.to_string(),
    });
    text.notes.extend(shown.misfit().map(|[has, seen]| {
        format!("it has {}x{} pixels, and what is seen {}x{}: not measured", has.0, has.1, seen.0, seen.1)
    }));
    let nonfinite = shown.nonfinite;
    text.notes
        .extend((nonfinite > 0).then(|| format!("{} pixels are not finite, and not measured", grouped_of(nonfinite))));
    text.notes.extend(external.fault.as_ref().map(|fault| without_folders(fault, external)));
    text.notes.extend(external.notes.iter().cloned());
}

/// A file's folders are nobody's business on a projector: the message that says it once has all of its path.
fn without_folders(fault: &str, external: &External) -> String {
    match &external.source {
        PaneSource::Followed(file) => fault.replace(&image_file::shown(file), &external.title()),
        _ => fault.to_owned(),
    }
}

/// "changed 41 times in 12.3 s"; nothing of one that came as it is.
fn changes(external: &External, seconds: f64) -> Option<String> {
    match external.changes {
        0 => None,
        1 => Some(format!("changed once, after {}", duration(seconds))),
        changes => Some(format!("changed {} times in {}", grouped_of(changes), duration(seconds))),
    }
}

fn grouped_of(number: u64) -> String {
    grouped(u32::try_from(number).unwrap_or(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::PaneId;
    use film::{Image, Vec3};
    use std::sync::Arc;
    use technique::{Device, PaneSettings, Provenance, Shot, TechniqueName};

    fn shown(seen: (u32, u32)) -> PaneView {
        let shot = Shot::of(scene::builtin::named("cornell").unwrap(), seen);
        let technique = PaneSettings::of(TechniqueName::Raster).in_use();
        let source = PaneSource::Received(14158);
        let name = "killeroo\n(12)".into();
        let external =
            External { name, source, changes: 41, notes: vec!["a note".into()], fault: Some("closed".into()) };
        PaneView {
            image: Image::new(2, 1, [Vec3::ONE; 2]),
            provenance: Some(Arc::new(Provenance { shot, technique, device: Device::Cpu })),
            external: Some(Arc::new(external)),
            seconds: 12.34,
            nonfinite: 1,
            ..PaneView::default()
        }
    }

    #[test]
    fn it_says_how_large_it_is_and_how_it_came_and_nothing_of_settings() {
        let text = LabelText::of(PaneId::B, &shown((2, 1)), None, None, false);
        assert_eq!(text.name, "killeroo\\n(12)");
        assert_eq!(text.figures, ["2 x 1 pixels", "changed 41 times in 12.3 s"]);
        assert_eq!(text.facts, ["received on 127.0.0.1:14158"]);
        assert_eq!(text.notes, ["1 pixels are not finite, and not measured", "closed", "a note"]);
        assert_eq!(text.explanations, [""; 0]);
    }

    #[test]
    fn of_a_file_that_cannot_be_read_the_label_has_the_name_alone() {
        let source = PaneSource::Followed("/home/me/mine.exr".into());
        let fault = Some("cannot read the picture (half): /home/me/mine.exr; tried again when it changes".into());
        let external = External { name: "mine.exr".into(), source, changes: 0, notes: Vec::new(), fault };
        let shown = PaneView { external: Some(Arc::new(external)), nonfinite: 0, ..shown((2, 1)) };
        let text = LabelText::of(PaneId::B, &shown, None, None, false);
        assert_eq!(text.notes, ["cannot read the picture (half): mine.exr; tried again when it changes"]);
    }

    #[test]
    fn that_it_is_not_measured_is_said_where_what_is_seen_has_another_size() {
        let text = LabelText::of(PaneId::B, &shown((4, 2)), None, None, false);
        assert_eq!(text.notes[0], "it has 2x1 pixels, and what is seen 4x2: not measured");
    }
}
