//! The rows of light that the fake gathers from patches: the three lies of a reflective shadow map.

use super::{BLANK, PLAIN, RASTER, each, named};
use crate::PaneSettings;
use crate::settings::{Control, Kind, Look, Need, Setting, Value};
use raster::{Fake, GatherKnobs, PatchClamp, Repair, Show};
use scene::Scene;

/// How many patches are summed, how near they may come, and whether something hides them.
pub const ROWS: &[Setting<PaneSettings>] = &[
    Setting {
        name: "patch-samples",
        default: Some(Value::Word("256")),
        kind: Kind::Choice(&SAMPLES),
        help: "patches of each of the light's views that a pixel gathers light from, with the repair reflective-shadow-map",
        get: |pane| {
            let place = GatherKnobs::SAMPLES.iter().position(|samples| *samples == pane.fake.knobs.gather.samples);
            place.map(|place| Value::Word(SAMPLES[place]))
        },
        set: |pane, value| each(named(value, samples), [&mut pane.fake.knobs.gather.samples]),
        control: Control {
            label: "Patches",
            brief: Some(|value| format!("{value} patches")),
            look: Look::Words(&[
                (
                    "16",
                    "Of the 4096 patches of each of the light's views each pixel takes 16, neighbours others: blotches",
                ),
                ("64", "64 patches of each of the light's views"),
                ("256", "256 patches of each of the light's views; 16 pixels take all of them"),
                ("1024", "1024 patches of each of the light's views, four times as slow"),
            ]),
            more: RASTER,
            dump_name: Some("patches"),
            ..BLANK
        },
        ..GATHERS
    },
    Setting {
        name: "patch-clamp",
        default: Some(Value::Word("disc")),
        kind: Kind::Choice(&["none", "disc"]),
        help: "what keeps the light of a patch finite where it touches what it lights",
        get: |pane| Some(Value::Word(pane.fake.knobs.gather.clamp.name())),
        set: |pane, value| each(named(value, PatchClamp::named), [&mut pane.fake.knobs.gather.clamp]),
        control: Control {
            label: "Patch's distance",
            brief: Some(|value| match value {
                Value::Word("none") => "patches unclamped".into(),
                _ => "patches as discs".into(),
            }),
            look: Look::Words(&[
                ("none", "1 / d^2, as in the formula: bright spots where patches touch what they light"),
                (
                    "disc",
                    "1 / (d^2 + A / pi): a disc of the patch's area, which a point that it touches sees fill its view",
                ),
            ]),
            more: RASTER,
            dump_name: Some("patch-clamp"),
            ..BLANK
        },
        ..GATHERS
    },
    Setting {
        name: "patch-visibility",
        default: Some(Value::Word("shapes")),
        kind: Kind::Choice(&["none", "shapes"]),
        help: "whether balls and boxes hide patches from what these light",
        get: |pane| Some(Value::Word(if pane.fake.knobs.gather.shapes_hide { "shapes" } else { "none" })),
        set: |pane, value| {
            let hide = named(value, |word| Some(word == "shapes"));
            each(hide, [&mut pane.fake.knobs.gather.shapes_hide]);
        },
        control: Control {
            label: "Patches hidden by",
            brief: Some(|value| format!("patches hidden by {value}")),
            look: Look::Words(&[
                ("none", "Nothing: light comes through walls and boxes, as in the paper"),
                ("shapes", "Up to 16 balls and 16 boxes of the scene, exactly; meshes and walls hide nothing"),
            ]),
            more: RASTER,
            dump_name: Some("patch-visibility"),
            ..BLANK
        },
        ..GATHERS
    },
];

const SAMPLES: [&str; 4] = ["16", "64", "256", "1024"];

/// What all of them begin from.
const GATHERS: Setting<PaneSettings> = Setting { of: RASTER, needs: Need::ShadowMap, acts: gathers, ..PLAIN };

/// Whether light is gathered from patches.
fn gathers(pane: &PaneSettings, _scene: &Scene) -> bool {
    let fake = &pane.fake;
    fake.show == Show::Picture && fake.fake == Fake::Fair && fake.repairs.has(Repair::ReflectiveShadowMap)
}

fn samples(word: &str) -> Option<u32> {
    let samples = word.parse().ok()?;
    GatherKnobs::SAMPLES.contains(&samples).then_some(samples)
}
