//! The rows of Metropolis' chains.

use super::{BLANK, METROPOLIS, PLAIN, each, number, whole};
use crate::PaneSettings;
use crate::settings::{Control, Kind, Look, Setting, Value};

/// What chains are beside their paths.
pub const ROWS: &[Setting<PaneSettings>] = &[
    Setting {
        name: "chains",
        of: METROPOLIS,
        kind: Kind::Whole(1..=65_536),
        letter: "N",
        default: Some(Value::Whole(32)),
        help: "chains that share each sample's mutations, one a pixel; few are long, and their noise is blotches",
        always_recorded: true,
        get: |pane| Some(Value::Whole(pane.metropolis.metropolis.chains)),
        set: |pane, value| each(whole(value), [&mut pane.metropolis.metropolis.chains]),
        control: Control {
            label: "Chains",
            brief: Some(|value| format!("{value} chains")),
            hover: "A sample of all pixels is as many mutations as there are pixels, shared by so many chains, which begin \
                    anew with each. Paths of a chain are alike, and so is their noise: it comes in blotches and streaks, \
                    neighbouring pixels share it, and their spread does not tell the error. Few chains are long and find \
                    what is hard to find; many forget sooner where they began",
            look: Look::Doubling(0..=12),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "large-step",
        of: METROPOLIS,
        kind: Kind::Number(0.0..=1.0),
        letter: "P",
        default: Some(Value::Number(0.3)),
        help: "probability that a mutation draws a new path instead of one nearby",
        always_recorded: true,
        get: |pane| Some(Value::Number(pane.metropolis.metropolis.large_step)),
        set: |pane, value| each(number(value), [&mut pane.metropolis.metropolis.large_step]),
        control: Control {
            label: "Large steps",
            brief: Some(|value| format!("large steps with P {value}")),
            hover: "Probability that a mutation draws a whole new path. 1: none remembers another, but bright paths are \
                    kept for long. 0: chains go on nearby, and may never leave the light that they began with",
            look: Look::Steps { range: 0.0..=1.0, step: 0.01 },
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "mutation",
        of: METROPOLIS,
        kind: Kind::Number(0.0001..=0.25),
        letter: "S",
        default: Some(Value::Number(0.015_625)),
        help: "the most by which a small step moves a random number, and a place in the picture",
        always_recorded: true,
        get: |pane| Some(Value::Number(pane.metropolis.metropolis.mutation)),
        set: |pane, value| each(number(value), [&mut pane.metropolis.metropolis.mutation]),
        control: Control {
            label: "Size of mutations",
            brief: Some(|value| format!("mutations of {value}")),
            hover: "The most by which a small step moves each random number of a path, two of which are its place in the \
                    picture: .016 is a 64th of its width. Small ones are taken more often and lead less far",
            look: Look::Steps { range: 0.001..=0.25, step: 0.001 },
            ..BLANK
        },
        ..PLAIN
    },
];
