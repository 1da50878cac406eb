//! The rows of what photons do.

use super::{BLANK, OF_PHOTONS, PHOTON, PLAIN, by_integrator, each, named, number, whole};
use crate::PaneSettings;
use crate::settings::{Control, Kind, Look, Setting, Value, grouped};
use pathtrace::{DirectLight, MOST_PHOTONS, USUAL_PHOTONS, usual_radius};

/// The settings of photon mapping and of light tracing.
pub const ROWS: &[Setting<PaneSettings>] = &[
    Setting {
        name: "photons",
        of: OF_PHOTONS,
        kind: Kind::Whole(1..=MOST_PHOTONS),
        letter: "N",
        default: Some(Value::Whole(USUAL_PHOTONS)),
        help: "that leave the lights in each pass, which gives each pixel a sample",
        always_recorded: true,
        get: |pane| {
            let (photon, light) = (pane.photon.photon.photons, pane.light.light.photons);
            Some(Value::Whole(by_integrator(pane, [0, 0, photon, light, 0, 0])))
        },
        set: |pane, value| each(whole(value), [&mut pane.photon.photon.photons, &mut pane.light.light.photons]),
        control: Control {
            label: "Photons a pass",
            brief: Some(|value| format!("{} photons a pass", whole(value).map_or_else(String::new, grouped))),
            hover: "Photons that leave the lights in each pass. Half of them are aimed at mirrors and glass, or at what the \
                    camera sees of a wide scene",
            look: Look::Doubling(8..=18),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "radius",
        of: PHOTON,
        kind: Kind::Number(1e-6..=1e6),
        letter: "R",
        own: |scene| Some(Value::Number(usual_radius(scene))),
        acts: |pane, _| !pane.photon.photon.points,
        help: "in which the first pass gathers photons, in the scene's unit; it shrinks from pass to pass. The default goes by the \
               scene's size and by what its camera sees as loaded or by --eye, not as moved in the window",
        get: |pane| pane.photon.photon.radius.map(Value::Number),
        set: |pane, value| pane.photon.photon.radius = number(value),
        control: Control {
            label: "First radius",
            hover: "In which the first pass gathers photons, in the scene's unit; by default at most a tenth of the height of what \
                    the scene's camera sees before it is moved. A large one blurs light and has little noise, a \
                    small one is sharp and noisy; it shrinks from pass to pass, so that the blur vanishes",
            look: Look::Logarithmic(0.01..=20.0),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "alpha",
        of: PHOTON,
        kind: Kind::Number(0.01..=0.99),
        letter: "A",
        default: Some(Value::Number(2.0 / 3.0)),
        acts: |pane, _| !pane.photon.photon.points,
        help: "share of the photons in its disc that the next pass keeps: the larger, the slower the radius shrinks",
        always_recorded: true,
        get: |pane| Some(Value::Number(pane.photon.photon.alpha)),
        set: |pane, value| each(number(value), [&mut pane.photon.photon.alpha]),
        control: Control {
            label: "Alpha",
            hover: "How slowly the radius shrinks: after N passes its area is the first one's over N to the power of 1 - alpha. Near 1 \
                    the blur stays, near 0 the noise",
            look: Look::Steps { range: 0.05..=0.95, step: 0.01 },
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "direct-light",
        of: PHOTON,
        kind: Kind::Choice(&["sampled", "photons"]),
        default: Some(Value::Word("sampled")),
        help: "whether light straight from the lights is sampled, with sharp shadows, or gathered like the rest",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.photon.photon.direct.name())),
        set: |pane, value| each(named(value, DirectLight::named), [&mut pane.photon.photon.direct]),
        control: Control {
            label: "Light straight from the lights",
            brief: Some(|value| match value {
                Value::Word("photons") => "all light by photons".into(),
                _ => "direct light sampled".into(),
            }),
            look: Look::Words(&[
                ("sampled", "Lights are sampled as by path tracing; photons bring what has met another surface before"),
                ("photons", "Photons bring all light: shadows are blurred too"),
            ]),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "photon-picture",
        of: PHOTON,
        kind: Kind::Choice(&["light", "points"]),
        default: Some(Value::Word("light")),
        help: "the light that is gathered, or the photons of the first pass that the camera sees, a point each",
        get: |pane| Some(Value::Word(if pane.photon.photon.points { "points" } else { "light" })),
        set: |pane, value| pane.photon.photon.points = value == Value::Word("points"),
        control: Control {
            label: "Photons are shown as",
            brief: Some(|value| value.to_string()),
            look: Look::Words(&[
                ("light", "The light that is gathered"),
                ("points", "The photons of the first pass that the camera sees, a point each in its colour"),
            ]),
            ..BLANK
        },
        ..PLAIN
    },
];
