//! The row of which light counts.

use super::{BLANK, PLAIN, all_paths, each, path_of};
use crate::settings::{Control, Kind, Look, Setting, Value};
use crate::{PaneSettings, TechniqueName};
use pathtrace::{LightPaths, NamedLightPaths};

/// What follows light from the eye.
pub const ROWS: &[Setting<PaneSettings>] = &[Setting {
    name: "light",
    of: &[TechniqueName::Whitted, TechniqueName::Path, TechniqueName::Metropolis],
    kind: Kind::LightPaths,
    letter: "CLASS",
    default: Some(Value::LightPaths(LightPaths::ALL)),
    help: "the light that counts: all, direct (from a light to the first surface that is not mirror or glass), indirect (the \
           rest), emitted, bounce-K (K as in --bounces), up-to-K, from-K, or paths in Heckbert's notation, from the light L by \
           surfaces D (diffuse), G (rough metal), S (mirror, glass) or . (any) to the eye E, with * + ? | ( ) [ ]: LDE, LS+DE",
    get: |pane| {
        let tree = pane.technique == TechniqueName::Whitted;
        Some(Value::LightPaths(if tree { pane.whitted.tree.paths } else { path_of(pane).paths }))
    },
    set: |pane, value| {
        let Value::LightPaths(paths) = value else { return };
        pane.whitted.tree.paths = paths;
        each(Some(paths), all_paths(pane).map(|path| &mut path.paths));
    },
    control: Control {
        label: "Light",
        aside: |value| if value == Value::LightPaths(LightPaths::ALL) { "" } else { " (a part)" }.into(),
        brief: Some(|value| match value {
            Value::LightPaths(paths) => light_words(paths),
            other => other.to_string(),
        }),
        hover: "Which light counts, by the way that it went. What is drawn stays the same: parts that leave out nothing add up to \
                the whole picture, sample by sample. A part has no error against a reference, which has all light",
        look: Look::LightPaths,
        ..BLANK
    },
    ..PLAIN
}];

/// What the option accepts.
pub const LIGHT_PATHS: &str =
    "all, direct, indirect, emitted, bounce-K, up-to-K or from-K with K up to 20, or light paths";

/// The light that a word says.
///
/// # Errors
/// What was expected, and where it is not that.
pub fn light_paths(word: &str) -> Result<Value, String> {
    LightPaths::parse(word).map(Value::LightPaths).map_err(|why| format!("{LIGHT_PATHS}: {why}"))
}

/// What a label calls a part of the light: "only direct light", "only LS+DE".
pub fn light_words(paths: LightPaths) -> String {
    match paths.named() {
        Some(NamedLightPaths::All) => "all light".into(),
        Some(NamedLightPaths::Emitted) => "only lights themselves".into(),
        Some(NamedLightPaths::Direct) => "only direct light".into(),
        Some(NamedLightPaths::Indirect) => "only indirect light".into(),
        Some(NamedLightPaths::Bounce(bounces)) => format!("only bounce {bounces}"),
        Some(NamedLightPaths::UpTo(bounces)) => format!("only up to bounce {bounces}"),
        Some(NamedLightPaths::From(bounces)) => format!("only from bounce {bounces} on"),
        None => format!("only {paths}"),
    }
}
