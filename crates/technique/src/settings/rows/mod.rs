//! The rows, in the order in which files keep them.

mod broken;
mod caustics;
mod denoise;
mod fake;
mod light;
mod metropolis;
mod patches;
mod photon;
mod show;
mod traced;

pub use light::{LIGHT_PATHS, light_paths, light_words};

use super::{Control, Kind, Look, Need, Setting, Value};
use crate::{PaneSettings, SceneChanges, TechniqueName};
use pathtrace::PathSettings;

const RASTER: &[TechniqueName] = &[TechniqueName::Raster];
const WHITTED: &[TechniqueName] = &[TechniqueName::Whitted];
const PATH: &[TechniqueName] = &[TechniqueName::Path];
const PHOTON: &[TechniqueName] = &[TechniqueName::Photon];
const OF_PHOTONS: &[TechniqueName] = &[TechniqueName::Photon, TechniqueName::LightTracing];
const METROPOLIS: &[TechniqueName] = &[TechniqueName::Metropolis];
const PATHS: &[TechniqueName] = &[TechniqueName::Path, TechniqueName::Metropolis];
const NORMALS: &[TechniqueName] = &[TechniqueName::Normals];
const TRACED: &[TechniqueName] = &[
    TechniqueName::Whitted,
    TechniqueName::Path,
    TechniqueName::Photon,
    TechniqueName::LightTracing,
    TechniqueName::Metropolis,
    TechniqueName::Normals,
];
/// What shows light and is traced.
pub const LIGHT: &[TechniqueName] = &[
    TechniqueName::Whitted,
    TechniqueName::Path,
    TechniqueName::Photon,
    TechniqueName::LightTracing,
    TechniqueName::Metropolis,
];
const ALL_OF_LIGHT: &[TechniqueName] = &TechniqueName::OF_LIGHT;
const LOCAL: &[TechniqueName] = &[TechniqueName::Raster, TechniqueName::Whitted];

/// What each row begins from.
const PLAIN: Setting<PaneSettings> = Setting {
    name: "",
    of: &[],
    kind: Kind::Bounces,
    fewer_in: &[],
    letter: "",
    default: None,
    before: None,
    own: |_| None,
    needs: Need::Nothing,
    acts: |_, _| true,
    help: "",
    always_recorded: false,
    get: |_| None,
    set: |_, _| {},
    control: BLANK,
};

/// What each control begins from.
const BLANK: Control = Control {
    label: "",
    aside: |_| String::new(),
    brief: None,
    below: |_| "",
    hover: "",
    hover_in: None,
    look: Look::Typed,
    offers: |_, _, _| true,
    more: &[],
    dump_name: None,
};

/// What is changed in a scene, for all techniques at once.
pub const OF_SCENES: &[Setting<SceneChanges>] = &[
    Setting {
        name: "refraction-ratio",
        of: &TechniqueName::ALL,
        kind: Kind::Number(0.001..=1000.0),
        fewer_in: &[],
        letter: "R",
        default: None,
        before: None,
        own: |scene| scene.refraction_ratio().map(Value::Number),
        needs: Need::Glass,
        acts: |_, _| true,
        help: "index outside over inside of all glass",
        always_recorded: false,
        get: |changes| changes.refraction_ratio.map(Value::Number),
        set: |changes, value| changes.set_refraction_ratio(number(value)),
        control: Control {
            label: "Refraction ratio",
            aside: |value| number(value).map_or_else(String::new, |ratio| format!(" (n = {:.2})", 1.0 / ratio)),
            hover: "Index of refraction outside over inside: 1 is no glass at all, above it a bubble, which reflects all \
                    light that grazes it",
            look: Look::Steps { range: 0.4..=2.5, step: 0.01 },
            ..BLANK
        },
    },
    Setting {
        name: "sun-radius",
        of: &TechniqueName::ALL,
        kind: Kind::DegreesBelow(90.0),
        fewer_in: &[],
        letter: "DEG",
        default: None,
        before: None,
        own: |scene| scene.sun.map(|sun| Value::Number(sun.angular_radius)),
        needs: Need::Sun,
        acts: |_, _| true,
        help: "angular radius of the sun, 0 is a delta light",
        always_recorded: false,
        get: |changes| changes.sun_radius.map(Value::Number),
        set: |changes, value| changes.set_sun_radius(number(value)),
        control: Control {
            label: "Sun radius",
            hover: "0: hard shadows, and caustics that chance never finds, but connections and photons do. Larger: softer \
                    shadows, the fake's where they are repaired",
            look: Look::Steps { range: 0.0..=5.0, step: 0.1 },
            ..BLANK
        },
    },
];

/// What a pane is set to.
pub fn all_of_panes() -> impl Iterator<Item = &'static Setting<PaneSettings>> {
    traced::ROWS
        .iter()
        .chain(caustics::ROWS)
        .chain(photon::ROWS)
        .chain(metropolis::ROWS)
        .chain(denoise::ROWS)
        .chain(fake::ROWS)
        .chain(show::ROWS)
        .chain(light::ROWS)
        .chain(broken::ROWS)
        .chain(patches::ROWS)
}

/// How the paths of the technique in use walk.
fn path_of(pane: &PaneSettings) -> &PathSettings {
    let PaneSettings { truth, metropolis, .. } = pane;
    if pane.technique == TechniqueName::Metropolis { &metropolis.metropolis.path } else { &truth.path }
}

/// How paths walk, whoever's they are.
fn all_paths(pane: &mut PaneSettings) -> [&mut PathSettings; 2] {
    [&mut pane.truth.path, &mut pane.metropolis.metropolis.path]
}

fn by_integrator<T>(pane: &PaneSettings, [path, whitted, photon, light, metropolis, normals]: [T; 6]) -> T {
    match pane.technique {
        TechniqueName::Whitted => whitted,
        TechniqueName::Photon => photon,
        TechniqueName::LightTracing => light,
        TechniqueName::Metropolis => metropolis,
        TechniqueName::Normals => normals,
        TechniqueName::Raster | TechniqueName::Path => path,
    }
}

fn number(value: Value) -> Option<f32> {
    if let Value::Number(number) = value { Some(number) } else { None }
}

fn whole(value: Value) -> Option<u32> {
    if let Value::Whole(number) = value { Some(number) } else { None }
}

fn named<T>(value: Value, named: fn(&str) -> Option<T>) -> Option<T> {
    if let Value::Word(word) = value { named(word) } else { None }
}

/// Gives a value to each place; one of another kind to none.
fn each<T: Copy, const N: usize>(value: Option<T>, places: [&mut T; N]) {
    if let Some(value) = value {
        places.into_iter().for_each(|place| *place = value);
    }
}
