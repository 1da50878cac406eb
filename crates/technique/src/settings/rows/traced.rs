//! The rows of what is traced.

use super::{BLANK, LIGHT, NORMALS, PATH, PATHS, PLAIN, TRACED, WHITTED};
use super::{all_paths, by_integrator, each, named, number, path_of, whole};
use crate::settings::{Control, Kind, Look, Need, Setting, Value};
use crate::{PaneSettings, TechniqueName};
use pathtrace::{
    Directions, Estimator, GlassShadows, LightSampling, PathSettings, Roulette, SamplerKind, Space, WhittedSettings,
};
use scene::Scene;

/// The settings of Whitted's method and of path tracing.
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
        set: |pane, value| {
            let PaneSettings { truth, whitted, photon, light, metropolis, normals, .. } = pane;
            each(whole(value), [&mut truth.spp, &mut whitted.spp, &mut metropolis.spp, &mut normals.spp]);
            each(whole(value), [&mut photon.spp, &mut light.spp]);
        },
        control: Control {
            label: "Samples per pixel (spp)",
            brief: Some(|value| format!("{value} spp")),
            look: Look::Doubling(0..=16),
            ..BLANK
        },
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
            let (path, PaneSettings { whitted, photon, light, normals, .. }) = (path_of(pane).sampler, pane);
            let of_photons = [photon.photon.sampler, light.light.sampler];
            let of_all = [path, whitted.tree.sampler, of_photons[0], of_photons[1], path, normals.normals.sampler];
            Some(Value::Word(by_integrator(pane, of_all).name()))
        },
        set: |pane, value| {
            let sampler = named(value, SamplerKind::named);
            let PaneSettings { whitted, photon, light, normals, .. } = pane;
            each(sampler, [&mut whitted.tree.sampler, &mut normals.normals.sampler]);
            each(sampler, [&mut photon.photon.sampler, &mut light.light.sampler]);
            each(sampler, all_paths(pane).map(|path| &mut path.sampler));
        },
        control: Control {
            label: "Random numbers",
            brief: Some(|value| format!("{value} random numbers")),
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
        of: PATHS,
        kind: Kind::Bounces,
        letter: "N|inf",
        default: Some(Value::Bounces(None)),
        help: "scattering vertices after the first; 0 is direct light",
        always_recorded: true,
        get: |pane| Some(Value::Bounces(path_of(pane).bounces)),
        set: |pane, value| {
            if let Value::Bounces(bounces) = value {
                each(Some(bounces), all_paths(pane).map(|path| &mut path.bounces));
            }
        },
        control: Control {
            label: "Bounces",
            aside: |value| if value == Value::Bounces(None) { " (unbiased)" } else { " (biased)" }.into(),
            brief: Some(|value| match value {
                Value::Bounces(None) => "no limit of bounces".into(),
                Value::Bounces(Some(1)) => "1 bounce".into(),
                bounces => format!("{bounces} bounces"),
            }),
            hover: "Scattering vertices after the first: 0 is direct light only. With a limit longer paths are lost and the \
                    picture gets too dark: it is biased",
            look: Look::WholeOrNone(0..=20),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "roulette",
        of: PATHS,
        kind: Kind::Roulette,
        letter: "P|throughput|P+throughput|off",
        default: Some(Value::Roulette(Roulette::THROUGHPUT)),
        help: "probability to survive a vertex, P in (0, 1]",
        always_recorded: true,
        acts: |pane, scene| plays_roulette(path_of(pane), scene),
        get: |pane| Some(Value::Roulette(path_of(pane).roulette)),
        set: |pane, value| {
            if let Value::Roulette(roulette) = value {
                each(Some(roulette), all_paths(pane).map(|path| &mut path.roulette));
            }
        },
        control: Control {
            label: "Roulette",
            aside: |value| if value == Value::Roulette(Roulette::OFF) { String::new() } else { " (unbiased)".into() },
            brief: Some(brief_roulette),
            look: Look::Steps { range: 0.05..=1.0, step: 0.01 },
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "estimator",
        of: PATHS,
        kind: Kind::Choice(&[
            "uniform",
            "cosine",
            "light",
            "mis",
            "uniform-light",
            "uniform-mis",
            "guided",
            "guided-mis",
            "guided-chance",
        ]),
        default: Some(Value::Word("light")),
        help: "directions uniform, cosine-weighted or guided by what some paths before have found (path alone, by the \
               processor), light found by chance, by sampling or by both, weighted; \
               without it mis where there is rough metal or a ball of glass or mirror",
        always_recorded: true,
        get: |pane| Some(Value::Word(path_of(pane).estimator.name())),
        set: |pane, value| {
            each(named(value, Estimator::named), all_paths(pane).map(|path| &mut path.estimator));
        },
        control: Control {
            brief: Some(|value| value.to_string()),
            look: Look::Words(&[
                ("uniform", "Directions uniform on the hemisphere, light found by chance"),
                ("cosine", "Directions cosine-weighted, light found by chance"),
                ("light", "Light sampled at every vertex, indirect light cosine-weighted"),
                ("mis", "Light sampled and met by chance, weighted; cosine-weighted directions"),
                ("guided", "Light sampled; directions as 131,072 paths before have learned where light comes from"),
            ]),
            offers: |word, technique, _| technique != Some(TechniqueName::Metropolis) || !is_guided(word),
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
        control: Control {
            label: "Directions N at each vertex",
            brief: Some(|value| format!("N = {value}")),
            look: Look::Doubling(0..=4),
            ..BLANK
        },
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
            brief: Some(|value| format!("{value} glass")),
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
        acts: has_wide_lights,
        get: |pane| Some(Value::Whole(pane.whitted.tree.shadow_rays)),
        set: |pane, value| each(whole(value), [&mut pane.whitted.tree.shadow_rays]),
        control: Control {
            label: "Shadow rays to each lamp",
            brief: Some(|value| format!("{value} shadow rays to each lamp")),
            look: Look::Doubling(0..=6),
            more: WHITTED,
            ..BLANK
        },
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
            let (path, PaneSettings { whitted, photon, light, normals, .. }) = (path_of(pane).seed, pane);
            let of_all = [path, whitted.tree.seed, photon.photon.seed, light.light.seed, path, normals.normals.seed];
            Some(Value::Whole(by_integrator(pane, of_all)))
        },
        set: |pane, value| {
            let PaneSettings { whitted, photon, light, normals, .. } = pane;
            each(whole(value), [&mut whitted.tree.seed, &mut normals.normals.seed]);
            each(whole(value), [&mut photon.photon.seed, &mut light.light.seed]);
            each(whole(value), all_paths(pane).map(|path| &mut path.seed));
        },
        control: Control {
            label: "Seed",
            hover: "One of 2^32 independent pictures",
            look: Look::Typed,
            more: TRACED,
            ..BLANK
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
        control: Control {
            label: "Axes",
            brief: Some(|value| format!("{value} axes")),
            look: Look::Words(&[("world", "The scene's own axes"), ("camera", "Right, up and towards the camera")]),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "traced-sun",
        of: LIGHT,
        kind: Kind::DegreesBelow(90.0),
        letter: "DEG",
        needs: Need::Sun,
        help: "angular radius of the sun for these rays alone, 0 as in 1980; references keep the scene's",
        get: |pane| {
            let PaneSettings { truth, whitted, photon, light, metropolis, .. } = pane;
            let of_photons = [photon.sun_radius, light.sun_radius];
            let of_all =
                [truth.sun_radius, whitted.sun_radius, of_photons[0], of_photons[1], metropolis.sun_radius, None];
            by_integrator(pane, of_all).map(Value::Number)
        },
        set: |pane, value| {
            let PaneSettings { truth, whitted, photon, light, metropolis, .. } = pane;
            let of_paths = [&mut truth.sun_radius, &mut whitted.sun_radius, &mut metropolis.sun_radius];
            of_paths
                .into_iter()
                .chain([&mut photon.sun_radius, &mut light.sun_radius])
                .for_each(|radius| *radius = number(value));
        },
        own: |scene| scene.sun.map(|sun| Value::Number(sun.angular_radius)),
        control: Control {
            label: "This picture's sun radius",
            hover: "Of this picture alone: its errors are against the scene's own sun. 0 is the point that Whitted had \
                    in 1980",
            look: Look::Steps { range: 0.0..=5.0, step: 0.1 },
            more: &[TechniqueName::Path, TechniqueName::Photon, TechniqueName::LightTracing, TechniqueName::Metropolis],
            ..BLANK
        },
        ..PLAIN
    },
];

/// Whether an estimator of this name follows a guide, which chains have none of.
fn is_guided(estimator: &str) -> bool {
    Estimator::named(estimator).is_some_and(|estimator| estimator.directions == Directions::Guided)
}

/// Whether roulette ends paths that would still bring something. With direct light alone, sampled, and no sky to be
/// met, none does that has left a surface; those that mirrors and glass send on end by a constant probability alone.
fn plays_roulette(path: &PathSettings, scene: &Scene) -> bool {
    let needs = scene.needs();
    let over = path.bounces == Some(0) && path.estimator.light == LightSampling::NextEvent && !needs.sky;
    let chosen_ways = needs.dielectric || needs.mirror;
    !over || (chosen_ways && path.roulette.probability.is_some_and(|p| p < 1.0))
}

/// Whether there are lights that more than one shadow ray can ask for.
fn has_wide_lights(pane: &PaneSettings, scene: &Scene) -> bool {
    let sun_radius = scene.sun.map_or(0.0, |sun| pane.whitted.sun_radius.unwrap_or(sun.angular_radius));
    scene.needs().area_lights || scene.environment.is_some() || sun_radius > 0.0
}

/// "roulette P 0.8 and throughput".
fn brief_roulette(value: Value) -> String {
    match value {
        Value::Roulette(Roulette { probability: Some(p), throughput: false }) => format!("roulette P {p}"),
        Value::Roulette(Roulette { probability: Some(p), throughput: true }) => {
            format!("roulette P {p} and throughput")
        }
        Value::Roulette(Roulette { probability: None, throughput: true }) => "roulette by throughput".into(),
        _ => "no roulette".into(),
    }
}
