//! The rows of how paths find caustics.

use super::{BLANK, PATH, PATHS, PLAIN, all_paths, each, named, path_of};
use crate::PaneSettings;
use crate::settings::{Control, Kind, Look, Need, Setting, Value};
use pathtrace::{ConesAt, Directions, PathSettings, shapes_with_cones};
use scene::Scene;

/// What finds light by way of glass and mirrors that chance finds badly.
pub const ROWS: &[Setting<PaneSettings>] = &[
    Setting {
        name: "connections",
        of: PATHS,
        kind: Kind::Choice(&["on", "off"]),
        default: Some(Value::Word("on")),
        before: Some(Value::Word("off")),
        needs: Need::Caster,
        acts: |pane, _| path_of(pane).estimator.samples_lights() && !path_of(pane).is_broken(),
        help: "light that is sampled also arrives by way of spheres of glass and mirror, computed; off: found by chance",
        always_recorded: true,
        get: |pane| Some(Value::Word(if path_of(pane).connections { "on" } else { "off" })),
        set: |pane, value| {
            let on = value == Value::Word("on");
            each(Some(on), all_paths(pane).map(|path| &mut path.connections));
        },
        control: Control {
            label: "Connections",
            brief: Some(|value| if value == Value::Word("on") { "connections" } else { "no connections" }.into()),
            hover: "How light gets through spheres of glass, and off those and mirroring ones, to where its caustic is",
            look: Look::Words(&[
                (
                    "on",
                    "Lights are sampled through spheres too: the ray between two points by way of a sphere is computed",
                ),
                ("off", "What spheres send on is found by chance alone"),
            ]),
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "cones",
        of: PATH,
        kind: Kind::Choice(&["off", "auto", "all"]),
        default: Some(Value::Word("auto")),
        before: Some(Value::Word("off")),
        needs: Need::Specular,
        acts: |pane, scene| may_have_cones(&pane.truth.path, scene),
        help: "shapes of glass and mirror that get a part of the directions; auto is meshes, and balls where there are several",
        always_recorded: true,
        get: |pane| Some(Value::Word(pane.truth.path.cones.name())),
        set: |pane, value| each(named(value, ConesAt::named), [&mut pane.truth.path.cones]),
        control: Control {
            label: "Cones at glass and mirrors",
            brief: Some(brief_cones),
            hover: "A part of the directions at a diffuse surface goes to what throws caustics on it",
            look: Look::Words(&[
                ("off", "Caustics are found as often as a direction happens to meet what throws them"),
                (
                    "auto",
                    "A part of the directions goes to meshes of glass and mirror, and to balls where there are several",
                ),
                ("all", "A part of the directions goes to every shape of glass and mirror"),
            ]),
            more: PATH,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "split-glass",
        of: PATH,
        kind: Kind::Choice(&["on", "off"]),
        default: Some(Value::Word("on")),
        before: Some(Value::Word("off")),
        needs: Need::Glass,
        acts: |pane, _| pane.truth.path.branches < 2 && !pane.truth.path.is_broken(),
        help: "whether the first glass that the camera sees both reflects and refracts a path; off: one of them by chance",
        always_recorded: true,
        get: |pane| Some(Value::Word(if pane.truth.path.split_glass { "on" } else { "off" })),
        set: |pane, value| pane.truth.path.split_glass = value == Value::Word("on"),
        control: Control {
            label: "Glass splits paths",
            brief: Some(|value| if value == Value::Word("on") { "glass split" } else { "glass not split" }.into()),
            hover: "What a path does at the first glass that the camera sees",
            look: Look::Words(&[
                ("on", "It goes on both ways, as in Whitted's trees: the sun glints in glass without noise"),
                ("off", "It goes on one way, reflected or refracted, by chance"),
            ]),
            more: PATH,
            ..BLANK
        },
        ..PLAIN
    },
];

/// Whether a scene has shapes that cones can be at, and paths draw directions that cones can take a part of.
fn may_have_cones(path: &PathSettings, scene: &Scene) -> bool {
    let drawn_well = path.estimator.directions == Directions::Cosine && path.estimator.samples_lights();
    drawn_well && !path.is_broken() && !shapes_with_cones(ConesAt::Everything, scene).is_empty()
}

/// What a label calls it, such as "cones at glass".
fn brief_cones(value: Value) -> String {
    match named(value, ConesAt::named) {
        Some(ConesAt::Usual) => "cones at glass",
        Some(ConesAt::Everything) => "cones at all glass and mirrors",
        Some(ConesAt::Nothing) | None => "no cones",
    }
    .into()
}
