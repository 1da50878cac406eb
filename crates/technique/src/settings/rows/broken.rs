//! The rows of what is wrong on purpose in path tracing.

use super::{BLANK, PATH, PLAIN, each, whole};
use crate::PaneSettings;
use crate::settings::{Control, Kind, Look, Setting, Value};
use pathtrace::{Bug, Bugs};

/// Bugs, told and hidden.
pub const ROWS: &[Setting<PaneSettings>] = &[
    Setting {
        name: "bugs",
        of: PATH,
        kind: Kind::Bugs,
        letter: "NAMES",
        default: Some(Value::Bugs(Bugs::NONE)),
        help: "bugs that students make, in a plain path tracer: none, or names with + between",
        get: |pane| Some(Value::Bugs(pane.truth.path.bugs)),
        set: |pane, value| {
            if let Value::Bugs(bugs) = value {
                pane.truth.path.bugs = bugs;
            }
        },
        control: Control {
            label: "Bugs",
            aside: |value| match value {
                Value::Bugs(bugs) if !bugs.is_none() => format!(" ({} of {})", bugs.count(), Bug::ALL.len()),
                _ => String::new(),
            },
            brief: Some(|value| match value {
                Value::Bugs(bugs) if bugs.is_none() => "no bug".into(),
                bugs => format!("bugs: {bugs}"),
            }),
            hover: "Mistakes that path tracers are written with, one by one: what each does and how it is found is told at its name. With any, paths are \
                    plain: no connections, no cones, no glass that splits them",
            look: Look::Bugs,
            ..BLANK
        },
        ..PLAIN
    },
    Setting {
        name: "find-bug",
        of: PATH,
        kind: Kind::Whole(0..=u32::MAX),
        letter: "N",
        default: Some(Value::Whole(0)),
        help: "switches on a bug and does not tell which: the same for all who say the same number; 0 is none",
        get: |pane| Some(Value::Whole(pane.truth.path.find_bug)),
        set: |pane, value| each(whole(value), [&mut pane.truth.path.find_bug]),
        control: Control {
            label: "Hidden bug number",
            aside: |value| if value == Value::Whole(0) { " (none)".into() } else { String::new() },
            brief: Some(|value| match value {
                Value::Whole(0) => "no hidden bug".into(),
                number => format!("hidden bug {number}"),
            }),
            hover: "Switches on one bug that shows in this scene and does not tell which. The number says which: all who type the same one look for \
                    the same bug. 0 is none",
            look: Look::Typed,
            ..BLANK
        },
        ..PLAIN
    },
];
