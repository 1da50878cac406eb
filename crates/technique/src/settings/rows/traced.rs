//! The rows of what is traced.

use super::{BLANK, PATH, PLAIN, TRACED, WHITTED, by_integrator, each, named, whole};
use crate::PaneSettings;
use crate::settings::{Control, Kind, Look, Need, Setting, Value};
use pathtrace::{Estimator, GlassShadows, Roulette, SamplerKind, WhittedSettings};

/// The settings of Whitted's method and of the truth.
pub const ROWS: &[Setting<PaneSettings>] = &[
    Setting {
        name: "spp",
        of: TRACED,
        kind: Kind::Whole(1..=u32::MAX),
        letter: "N",
        default: Some(Value::Whole(64)),
        help: "samples per pixel",
        always_recorded: true,
        get: |pane| pane.wished_spp().map(Value::Whole),
        set: |pane, value| each(whole(value), [&mut pane.truth.spp, &mut pane.whitted.spp]),
        control: Control { label: "Samples per pixel (spp)", look: Look::Doubling(0..=16), ..BLANK },
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
            let kind = by_integrator(pane, pane.truth.path.sampler, pane.whitted.tree.sampler);
            Some(Value::Word(kind.name()))
        },
        set: |pane, value| {
            each(named(value, SamplerKind::named), [&mut pane.truth.path.sampler, &mut pane.whitted.tree.sampler]);
        },
        control: Control {
            label: "Random numbers",
            look: Look::Words(&[
                ("independent", "Each number independent of all others"),
                ("sobol", "Samples of a pixel keep apart from each other: errors fall faster"),
            ]),
            more: TRACED,
            ..BLANK
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
        control: Control {
            label: "Limit bounces",
            aside: |value| if value == Value::Bounces(None) { String::new() } else { " (biased)".into() },
            hover: "Longer paths are lost: the picture gets too dark",
            look: Look::Whole(0..=20),
            ..BLANK
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
        control: Control { label: "Roulette", look: Look::Steps { range: 0.05..=1.0, step: 0.01 }, ..BLANK },
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
        control: Control {
            look: Look::Words(&[
                ("uniform", "Directions uniform on the hemisphere, light found by chance"),
                ("cosine", "Directions cosine-weighted, light found by chance"),
                ("light", "Light sampled at every vertex, indirect light cosine-weighted"),
                ("mis", "Light sampled and met by chance, weighted; cosine-weighted directions"),
            ]),
            ..BLANK
        },
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
        control: Control { label: "Directions N at each vertex", look: Look::Doubling(0..=4), more: PATH, ..BLANK },
        ..PLAIN
    },
    Setting {
        name: "depth",
        of: WHITTED,
        kind: Kind::Whole(0..=WhittedSettings::MOST_DEPTH),
        letter: "N",
        default: Some(Value::Whole(8)),
        needs: Need::Specular,
        help: "specular scatterings along a branch",
        always_recorded: true,
        get: |pane| Some(Value::Whole(pane.whitted.tree.depth)),
        set: |pane, value| each(whole(value), [&mut pane.whitted.tree.depth]),
        control: Control { label: "Depth of mirrors and glass", look: Look::Whole(0..=16), ..BLANK },
        ..PLAIN
    },
    Setting {
        name: "glass-shadows",
        of: WHITTED,
        kind: Kind::Choice(&["opaque", "clear"]),
        default: Some(Value::Word("opaque")),
        needs: Need::Glass,
        help: "whether glass stops light",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.whitted.tree.glass_shadows.name())),
        set: |pane, value| each(named(value, GlassShadows::named), [&mut pane.whitted.tree.glass_shadows]),
        control: Control {
            label: "Shadows of glass",
            look: Look::Words(&[
                ("opaque", "Glass throws a black shadow"),
                ("clear", "Light passes glass straight on"),
            ]),
            ..BLANK
        },
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
        control: Control { label: "Shadow rays to each lamp", look: Look::Doubling(0..=6), more: WHITTED, ..BLANK },
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
        get: |pane| Some(Value::Whole(by_integrator(pane, pane.truth.path.seed, pane.whitted.tree.seed))),
        set: |pane, value| each(whole(value), [&mut pane.truth.path.seed, &mut pane.whitted.tree.seed]),
        control: Control {
            label: "Seed",
            hover: "One of 2^32 independent pictures",
            look: Look::Typed,
            more: TRACED,
            ..BLANK
        },
        ..PLAIN
    },
];
