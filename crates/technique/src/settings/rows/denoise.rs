//! The rows of what traced pictures go through before they are shown, and of how many they are the mean.

use super::{BLANK, LIGHT, PLAIN, each, named, number, whole};
use crate::settings::{Control, Kind, Look, Setting, Value};
use crate::{Denoiser, PaneSettings};

/// Those of all that is traced and shows light.
pub const ROWS: &[Setting<PaneSettings>] = &[DENOISE, TRUST, HISTORY, RUNS];

const DENOISE: Setting<PaneSettings> = Setting {
    name: "denoise",
    of: LIGHT,
    kind: Kind::Choice(&["off", "atrous", "unet", "unet-base"]),
    default: Some(Value::Word("off")),
    help: "takes the noise out of the picture, and some of the truth: wavelets guided by features, or Open Image Denoise's \
           network, small or as it is usually taken",
    acts: |pane, _| pane.in_use().traces_light(),
    get: |pane| Some(Value::Word(pane.denoise.denoiser.name())),
    set: |pane, value| each(named(value, Denoiser::named), [&mut pane.denoise.denoiser]),
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
};

const TRUST: Setting<PaneSettings> = Setting {
    name: "trust",
    of: LIGHT,
    kind: Kind::Number(0.0..=1.0),
    letter: "T",
    default: Some(Value::Number(0.0)),
    acts: |pane, _| pane.in_use().denoise().is_on(),
    help: "how far to go back from a denoiser's picture to the samples where they tell it is wrong (James and Stein), 0 to 1: at 1 \
           the picture comes to the truth as samples become many; above 0 the filter runs twice, on either part of them",
    get: |pane| Some(Value::Number(pane.denoise.trust)),
    set: |pane, value| each(number(value), [&mut pane.denoise.trust]),
    control: Control {
        label: "Trust the samples",
        brief: Some(|value| match number(value) {
            Some(0.0) => "samples not trusted".into(),
            _ => format!("samples trusted by {value}"),
        }),
        hover: "Where the samples differ from the denoiser's picture by more than their noise it is the filter that is wrong, and \
                this share of the way back to them is gone. At 1 the picture comes to the truth as samples become many",
        look: Look::Steps { range: 0.0..=1.0, step: 0.05 },
        more: LIGHT,
        ..BLANK
    },
    ..PLAIN
};

const RUNS: Setting<PaneSettings> = Setting {
    name: "runs",
    of: LIGHT,
    kind: Kind::Whole(1..=64),
    letter: "K",
    default: Some(Value::Whole(1)),
    acts: |pane, _| pane.in_use().traces_light(),
    help: "the mean of so many pictures of --spp samples each, of the seeds from --seed on, and each denoised by itself: of their \
           noise 1 / sqrt(K) is left, of a denoiser's bias all",
    get: |pane| Some(Value::Whole(pane.runs)),
    set: |pane, value| each(whole(value), [&mut pane.runs]),
    control: Control {
        label: "Runs",
        brief: Some(|value| match value {
            Value::Whole(1) => "one run".into(),
            value => format!("mean of {value} runs"),
        }),
        hover: "The mean of so many independent pictures, each of as many samples and denoised by itself. What noise they have \
                becomes less, and what they have in common is left: with a denoiser, held against the reference, its bias",
        look: Look::Doubling(0..=6),
        more: LIGHT,
        ..BLANK
    },
    ..PLAIN
};

const HISTORY: Setting<PaneSettings> = Setting {
    name: "history",
    of: LIGHT,
    kind: Kind::Whole(0..=256),
    letter: "N",
    default: Some(Value::Whole(0)),
    acts: |pane, _| pane.in_use().shows_the_scene(),
    help: "in the window, while the camera moves: what earlier views showed at the same points counts as so many samples at most; what \
           is seen in mirrors and glass lags behind. It fades, and is gone at twice as many samples, or where the picture \
           is done",
    get: |pane| Some(Value::Whole(pane.denoise.history)),
    set: |pane, value| each(whole(value), [&mut pane.denoise.history]),
    control: Control {
        label: "Reuse earlier views",
        aside: |value| if value == Value::Whole(0) { String::new() } else { " (spp, lags)".into() },
        brief: Some(|value| match value {
            Value::Whole(0) => "no earlier views".into(),
            _ => format!("{value} spp of earlier views"),
        }),
        hover: "While the camera moves, what earlier pictures showed at the same points counts as so many samples at most (temporal \
                accumulation). Reflections, refractions and highlights lag behind. Once the camera stands it fades, and is gone at \
                twice as many samples, or where the picture is done",
        look: Look::Whole(0..=256),
        more: LIGHT,
        ..BLANK
    },
    ..PLAIN
};
