//! The row of what traced pictures go through before they are shown.

use super::{BLANK, LIGHT, PLAIN, each, named};
use crate::settings::{Control, Kind, Look, Setting, Value};
use crate::{Denoiser, PaneSettings};

/// The filter of all that is traced and shows light.
pub const ROWS: &[Setting<PaneSettings>] = &[Setting {
    name: "denoise",
    of: LIGHT,
    kind: Kind::Choice(&["off", "atrous", "unet", "unet-base"]),
    default: Some(Value::Word("off")),
    help: "takes the noise out of the picture, and some of the truth: wavelets guided by features, or Open Image Denoise's \
           network, small or as it is usually taken",
    get: |pane| Some(Value::Word(pane.denoiser.name())),
    set: |pane, value| each(named(value, Denoiser::named), [&mut pane.denoiser]),
    control: Control {
        label: "Denoise",
        aside: |value| if value == Value::Word("off") { String::new() } else { " (biased)".into() },
        brief: Some(|value| match value {
            Value::Word("off") => "not denoised".into(),
            value => format!("denoised by {value} (biased)"),
        }),
        hover: "A filter between the samples and the picture. What is behind it are the same samples: it costs no new ones",
        look: Look::Words(&[
            ("off", "The mean of the samples, as noisy as it is"),
            (
                "atrous",
                "Wavelets with holes (a-trous): means over ever wider neighbours of like albedo, normal and depth",
            ),
            ("unet", "Open Image Denoise's small network"),
            ("unet-base", "Open Image Denoise's usual network: three times as large and as slow"),
        ]),
        ..BLANK
    },
    ..PLAIN
}];
