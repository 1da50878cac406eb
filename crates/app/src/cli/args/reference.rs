//! The options of `visavis reference`.

use super::seen::{Seen, parse_seen};
use super::usage;
use super::values::{seconds, text};
use crate::cli::{CliError, Command, help};
use image_file::Kind;
use lexopt::prelude::*;
use reference::Goal;
use std::path::PathBuf;

/// `visavis reference ...`.
#[derive(Debug, Clone, PartialEq)]
pub enum ReferenceArgs {
    /// Says what the store holds.
    Usage,
    /// Empties the store.
    Clear,
    /// Makes or fetches the reference of a scene.
    Make {
        /// A built-in name or a file.
        scene: String,
        /// Where to write it, an .exr.
        out: PathBuf,
        /// What is seen.
        seen: Seen,
        /// When it is good enough.
        goal: Goal,
    },
}

pub fn parse(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let (mut scene, mut out, mut clear, mut seen) = (None, None, false, Seen::default());
    let (mut noise, mut limit) = (None, None);
    while let Some(arg) = parser.next()? {
        match arg {
            Value(word) if scene.is_none() => scene = Some(word.string()?),
            Short('o') => out = Some(PathBuf::from(parser.value()?)),
            Long("clear") => clear = true,
            Long("noise") => noise = Some(rel_mse(&mut parser)?),
            Long("time") => limit = Some(seconds(&mut parser)?),
            Long("help") => return Ok(Command::Print(help::HELP)),
            Long(option) => {
                let option = option.to_owned();
                if !parse_seen(&option, &mut parser, &mut seen)? {
                    return Err(Long(&option).unexpected().into());
                }
            }
            other => return Err(other.unexpected().into()),
        }
    }
    let nothing_else = out.is_none() && seen == Seen::default() && noise.is_none() && limit.is_none();
    Ok(Command::Reference(match (scene, out, clear) {
        (None, None, true) if nothing_else => ReferenceArgs::Clear,
        (None, None, false) if nothing_else => ReferenceArgs::Usage,
        (_, _, true) => return usage("--clear empties the store and does nothing else: visavis reference --clear"),
        (Some(scene), Some(out), false) if Kind::of(&out) == Some(Kind::Exr) => {
            ReferenceArgs::Make { scene, out, seen, goal: goal(noise, limit) }
        }
        (Some(_), Some(out), false) => return usage(format!("-o must end in .exr: {}", out.display())),
        (None, _, false) => return usage("reference needs a scene: visavis reference SCENE -o OUT.exr"),
        (Some(_), None, false) => return usage("reference needs a file to write: -o OUT.exr"),
    }))
}

/// Noise that is asked for is waited for, unless the time is limited as well.
fn goal(noise: Option<f64>, limit: Option<f64>) -> Goal {
    let usual = Goal::default();
    let unlimited = if noise.is_some() { f64::INFINITY } else { usual.seconds };
    Goal { rel_mse: noise.unwrap_or(usual.rel_mse), seconds: limit.unwrap_or(unlimited) }
}

fn rel_mse(parser: &mut lexopt::Parser) -> Result<f64, CliError> {
    let word = text(parser)?;
    let value = word.trim().parse::<f64>().ok().filter(|v| *v > 0.0 && *v <= 1e9);
    value.map_or_else(|| usage(format!("--noise {word}: expected a relMSE above 0, like 1e-5")), Ok)
}
