//! The options of `visavis reference`.

use super::options::{CommandOption, Typed, read, set_in_the_scene};
use super::seen::Seen;
use super::usage;
use super::values::{seconds, text};
use crate::cli::{CliError, Command};
use image_file::Kind;
use lexopt::prelude::*;
use reference::Goal;
use std::ffi::OsString;
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
        seen: Box<Seen>,
        /// When it is good enough.
        goal: Goal,
    },
}

/// The words after `reference` on their way.
#[derive(Default)]
pub struct Reading {
    out: Option<PathBuf>,
    clear: bool,
    seen: Seen,
    noise: Option<f64>,
    limit: Option<f64>,
}

impl AsMut<Seen> for Reading {
    fn as_mut(&mut self) -> &mut Seen {
        &mut self.seen
    }
}

pub fn options() -> Vec<CommandOption<Reading>> {
    let mut options: Vec<CommandOption<Reading>> = vec![
        CommandOption {
            names: &["-o"],
            value: "OUT",
            help: "the file to write, an .exr with its standard error as a layer",
            read: |args, parser| {
                args.out = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--noise"],
            value: "R",
            help: "until its own relMSE is R or less (default 1e-5)",
            read: |args, parser| {
                args.noise = Some(rel_mse(parser)?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--time"],
            value: "SECONDS",
            help: "or this long was spent on it, in all (default 120; without limit if --noise is given)",
            read: |args, parser| {
                args.limit = Some(seconds(parser)?);
                Ok(())
            },
        },
    ];
    options.extend(super::seen::options());
    options.push(CommandOption {
        names: &["--clear"],
        value: "",
        help: "throw all references away, and do nothing else",
        read: |args, _| {
            args.clear = true;
            Ok(())
        },
    });
    options
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let of_scenes =
        |args: &mut Reading, name: &str, parser: &mut lexopt::Parser| set_in_the_scene(&mut args.seen, name, parser);
    let (reading, words) = match read(parser, Reading::default(), &options(), 1, of_scenes)? {
        Typed::Words(reading, words) => (reading, words),
        Typed::Print(text) => return Ok(Command::Print(text)),
    };
    let Reading { out, clear, seen, noise, limit } = reading;
    let scene = words.into_iter().next().map(OsString::string).transpose()?;
    let nothing_else = out.is_none() && seen == Seen::default() && noise.is_none() && limit.is_none();
    Ok(Command::Reference(match (scene, out, clear) {
        (None, None, true) if nothing_else => ReferenceArgs::Clear,
        (None, None, false) if nothing_else => ReferenceArgs::Usage,
        (_, _, true) => return usage("--clear empties the store and does nothing else: visavis reference --clear"),
        (Some(scene), Some(out), false) if Kind::of(&out) == Some(Kind::Exr) => {
            ReferenceArgs::Make { scene, out, seen: Box::new(seen), goal: goal(noise, limit) }
        }
        (Some(_), Some(out), false) => return usage(format!("-o must end in .exr: {}", image_file::shown(&out))),
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
