//! The rows, in the order in which files keep them.

use super::{Kind, Need, Setting, Value};
use crate::{PaneSettings, SceneChanges, TechniqueName};
use pathtrace::{Estimator, GlassShadows, Roulette, SamplerKind, Space, WhittedSettings};
use raster::{Fake, FakeKnobs, Shading, ShadowFilter, Show};

const RASTER: &[TechniqueName] = &[TechniqueName::Raster];
const WHITTED: &[TechniqueName] = &[TechniqueName::Whitted];
const PATH: &[TechniqueName] = &[TechniqueName::Path];
const NORMALS: &[TechniqueName] = &[TechniqueName::Normals];
const TRACED: &[TechniqueName] = &[TechniqueName::Whitted, TechniqueName::Path, TechniqueName::Normals];
const LOCAL: &[TechniqueName] = &[TechniqueName::Raster, TechniqueName::Whitted];

/// What each row begins from.
const PLAIN: Setting<PaneSettings> = Setting {
    name: "",
    of: &[],
    kind: Kind::Bounces,
    letter: "",
    default: None,
    needs: Need::Nothing,
    help: "",
    always_recorded: false,
    get: |_| None,
    set: |_, _| {},
};

/// What is changed in a scene, for all techniques at once.
pub const OF_SCENES: &[Setting<SceneChanges>] = &[
    Setting {
        name: "refraction-ratio",
        of: &TechniqueName::ALL,
        kind: Kind::Number(0.001..=1000.0),
        letter: "R",
        default: None,
        needs: Need::Glass,
        help: "index outside over inside of all glass",
        always_recorded: false,
        get: |changes| changes.refraction_ratio.map(Value::Number),
        set: |changes, value| changes.refraction_ratio = number(value),
    },
    Setting {
        name: "sun-radius",
        of: TRACED,
        kind: Kind::DegreesBelow(90.0),
        letter: "DEG",
        default: None,
        needs: Need::Sun,
        help: "angular radius of the sun, 0 is a delta light",
        always_recorded: false,
        get: |changes| changes.sun_radius.map(Value::Number),
        set: |changes, value| changes.sun_radius = number(value),
    },
];

/// What a pane is set to.
pub const OF_PANES: &[Setting<PaneSettings>] = &[
    Setting {
        name: "spp",
        of: TRACED,
        kind: Kind::Whole(1..=u32::MAX),
        letter: "N",
        default: Some(Value::Whole(64)),
        help: "samples per pixel",
        always_recorded: true,
        get: |pane| pane.wished_spp().map(Value::Whole),
        set: |pane, value| each(whole(value), [&mut pane.truth.spp, &mut pane.whitted.spp, &mut pane.normals.spp]),
        ..PLAIN
    },
    Setting {
        name: "sampler",
        of: TRACED,
        kind: Kind::Choice(&["independent", "sobol"]),
        default: Some(Value::Word("sobol")),
        help: "where random numbers come from",
        always_recorded: true,
        get: |pane| {
            let of_all = [pane.truth.path.sampler, pane.whitted.tree.sampler, pane.normals.normals.sampler];
            let kind = by_integrator(pane, of_all);
            Some(Value::Word(kind.name()))
        },
        set: |pane, value| {
            let PaneSettings { truth, whitted, normals, .. } = pane;
            let of_all = [&mut truth.path.sampler, &mut whitted.tree.sampler, &mut normals.normals.sampler];
            each(named(value, SamplerKind::named), of_all);
        },
        ..PLAIN
    },
    Setting {
        name: "bounces",
        of: PATH,
        kind: Kind::Bounces,
        letter: "N|inf",
        default: Some(Value::Bounces(None)),
        help: "scattering vertices after the first; 0 is direct light",
        always_recorded: true,
        get: |pane| Some(Value::Bounces(pane.truth.path.bounces)),
        set: |pane, value| {
            if let Value::Bounces(bounces) = value {
                pane.truth.path.bounces = bounces;
            }
        },
        ..PLAIN
    },
    Setting {
        name: "roulette",
        of: PATH,
        kind: Kind::Roulette,
        letter: "P|throughput|P+throughput|off",
        default: Some(Value::Roulette(Roulette::THROUGHPUT)),
        help: "probability to survive a vertex, P in (0, 1]",
        always_recorded: true,
        get: |pane| Some(Value::Roulette(pane.truth.path.roulette)),
        set: |pane, value| {
            if let Value::Roulette(roulette) = value {
                pane.truth.path.roulette = roulette;
            }
        },
        ..PLAIN
    },
    Setting {
        name: "estimator",
        of: PATH,
        kind: Kind::Choice(&["uniform", "cosine", "light", "mis", "uniform-light", "uniform-mis"]),
        default: Some(Value::Word("light")),
        help: "directions uniform or cosine-weighted, light found by chance, by sampling or by both, weighted; \
               without it mis where there is rough metal",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.truth.path.estimator.name())),
        set: |pane, value| each(named(value, Estimator::named), [&mut pane.truth.path.estimator]),
        ..PLAIN
    },
    Setting {
        name: "branches",
        of: PATH,
        kind: Kind::Whole(1..=u32::MAX),
        letter: "N",
        default: Some(Value::Whole(1)),
        help: "directions at each diffuse vertex, with a limit of bounces",
        always_recorded: true,
        get: |pane| Some(Value::Whole(pane.truth.path.branches)),
        set: |pane, value| each(whole(value), [&mut pane.truth.path.branches]),
        ..PLAIN
    },
    Setting {
        name: "depth",
        of: WHITTED,
        kind: Kind::Whole(0..=WhittedSettings::MOST_DEPTH),
        letter: "N",
        default: Some(Value::Whole(8)),
        help: "specular scatterings along a branch",
        always_recorded: true,
        get: |pane| Some(Value::Whole(pane.whitted.tree.depth)),
        set: |pane, value| each(whole(value), [&mut pane.whitted.tree.depth]),
        ..PLAIN
    },
    Setting {
        name: "glass-shadows",
        of: WHITTED,
        kind: Kind::Choice(&["opaque", "clear"]),
        default: Some(Value::Word("opaque")),
        help: "whether glass stops light",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.whitted.tree.glass_shadows.name())),
        set: |pane, value| each(named(value, GlassShadows::named), [&mut pane.whitted.tree.glass_shadows]),
        ..PLAIN
    },
    Setting {
        name: "shadow-rays",
        of: WHITTED,
        kind: Kind::Whole(1..=1024),
        letter: "N",
        default: Some(Value::Whole(1)),
        help: "to each lamp",
        always_recorded: true,
        get: |pane| Some(Value::Whole(pane.whitted.tree.shadow_rays)),
        set: |pane, value| each(whole(value), [&mut pane.whitted.tree.shadow_rays]),
        ..PLAIN
    },
    Setting {
        name: "seed",
        of: TRACED,
        kind: Kind::Whole(0..=u32::MAX),
        letter: "N",
        default: Some(Value::Whole(1)),
        help: "selects one of 2^32 independent pictures",
        always_recorded: true,
        get: |pane| {
            let of_all = [pane.truth.path.seed, pane.whitted.tree.seed, pane.normals.normals.seed];
            Some(Value::Whole(by_integrator(pane, of_all)))
        },
        set: |pane, value| {
            let PaneSettings { truth, whitted, normals, .. } = pane;
            each(whole(value), [&mut truth.path.seed, &mut whitted.tree.seed, &mut normals.normals.seed]);
        },
        ..PLAIN
    },
    Setting {
        name: "space",
        of: NORMALS,
        kind: Kind::Choice(&["world", "camera"]),
        default: Some(Value::Word("world")),
        help: "whose axes are red, green and blue",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.normals.normals.space.name())),
        set: |pane, value| each(named(value, Space::named), [&mut pane.normals.normals.space]),
        ..PLAIN
    },
    Setting {
        name: "fake",
        of: RASTER,
        kind: Kind::Choice(&["fair", "as-taught"]),
        default: Some(Value::Word("fair")),
        help: "on the truth's data, linear; or as the tutorial's viewer drew it",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.fake.fake.name())),
        set: |pane, value| each(named(value, Fake::named), [&mut pane.fake.fake]),
        ..PLAIN
    },
    Setting {
        name: "shading",
        of: RASTER,
        kind: Kind::Choice(&["three", "phong", "blinn-phong"]),
        default: Some(Value::Word("three")),
        help: "whose highlight",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.fake.shading.name())),
        set: |pane, value| each(named(value, Shading::named), [&mut pane.fake.shading]),
        ..PLAIN
    },
    Setting {
        name: "reflectivity",
        of: RASTER,
        kind: Kind::Number(0.0..=1.0),
        letter: "R",
        needs: Need::Glass,
        help: "share of the surroundings in fake glass",
        get: |pane| pane.fake.reflectivity.map(Value::Number),
        set: |pane, value| pane.fake.reflectivity = number(value),
        ..PLAIN
    },
    Setting {
        name: "shininess",
        of: RASTER,
        kind: Kind::Number(FakeKnobs::SHININESS),
        letter: "S",
        help: "exponent of every highlight",
        get: |pane| pane.fake.knobs.shininess.map(Value::Number),
        set: |pane, value| pane.fake.knobs.shininess = number(value),
        ..PLAIN
    },
    Setting {
        name: "ambient",
        of: LOCAL,
        kind: Kind::Number(FakeKnobs::AMBIENT),
        letter: "A",
        help: "ambient light, Whitted's and the fake's; fair scales the sky's by it",
        get: |pane| {
            let ambient = match pane.technique {
                TechniqueName::Raster => pane.fake.knobs.ambient,
                TechniqueName::Whitted | TechniqueName::Path | TechniqueName::Normals => pane.whitted.tree.ambient,
            };
            ambient.map(Value::Number)
        },
        set: |pane, value| {
            pane.fake.knobs.ambient = number(value);
            pane.whitted.tree.ambient = number(value);
        },
        ..PLAIN
    },
    Setting {
        name: "cube-map",
        of: RASTER,
        kind: Kind::Whole(FakeKnobs::CUBE_MAP),
        letter: "N",
        help: "texels along a side of a cube map's face",
        get: |pane| pane.fake.knobs.cube_map.map(Value::Whole),
        set: |pane, value| pane.fake.knobs.cube_map = whole(value),
        ..PLAIN
    },
    Setting {
        name: "shadow-map",
        of: RASTER,
        kind: Kind::Whole(FakeKnobs::SHADOW_MAP),
        letter: "N",
        help: "texels along a side of the shadow map",
        get: |pane| pane.fake.knobs.shadow_map.map(Value::Whole),
        set: |pane, value| pane.fake.knobs.shadow_map = whole(value),
        ..PLAIN
    },
    Setting {
        name: "shadow-filter",
        of: RASTER,
        kind: Kind::Choice(&["hard", "pcf", "pcf-soft"]),
        default: Some(Value::Word("pcf-soft")),
        help: "how the shadow map is looked up",
        get: |pane| Some(Value::Word(pane.fake.knobs.filter.name())),
        set: |pane, value| each(named(value, ShadowFilter::named), [&mut pane.fake.knobs.filter]),
        ..PLAIN
    },
    Setting {
        name: "shadow-bias",
        of: RASTER,
        kind: Kind::Number(FakeKnobs::BIAS),
        letter: "B",
        default: Some(Value::Number(0.0)),
        help: "added to depths before they are compared",
        get: |pane| Some(Value::Number(pane.fake.knobs.bias)),
        set: |pane, value| each(number(value), [&mut pane.fake.knobs.bias]),
        ..PLAIN
    },
    Setting {
        name: "segments",
        of: RASTER,
        kind: Kind::Whole(FakeKnobs::SEGMENTS),
        letter: "N",
        help: "segments of a sphere",
        get: |pane| pane.fake.knobs.segments.map(Value::Whole),
        set: |pane, value| pane.fake.knobs.segments = whole(value),
        ..PLAIN
    },
    Setting {
        name: "show",
        of: RASTER,
        kind: Kind::Choice(&["picture", "cube-faces", "shadow-map"]),
        default: Some(Value::Word("picture")),
        help: "the picture, or a map that it is made from",
        get: |pane| Some(Value::Word(pane.fake.show.name())),
        set: |pane, value| each(named(value, Show::named), [&mut pane.fake.show]),
        ..PLAIN
    },
];

fn by_integrator<T>(pane: &PaneSettings, [path, whitted, normals]: [T; 3]) -> T {
    match pane.technique {
        TechniqueName::Whitted => whitted,
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
