//! The words after `ladder`.

use super::options::{CommandOption, Typed, read, set_in_the_scene};
use super::seen::{self, Seen};
use super::usage;
use super::values::{choice, shown, text};
use crate::cli::{CliError, Command};
use crate::ladder::SPP;
use crate::model::Order;
use lexopt::ValueExt;
use raster::Repairs;
use std::ffi::OsString;
use std::path::PathBuf;

/// `visavis ladder SCENE -o DIR ...`.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each field is the option of its name, described in --help")]
pub struct LadderArgs {
    pub scene: String,
    pub folder: PathBuf,
    pub seen: Seen,
    pub order: Order,
    pub repairs: Repairs,
    pub spp: u32,
    pub json: bool,
}

/// The words on their way.
pub struct Reading {
    args: LadderArgs,
    folder: Option<PathBuf>,
}

impl AsMut<Seen> for Reading {
    fn as_mut(&mut self) -> &mut Seen {
        &mut self.args.seen
    }
}

pub fn options() -> Vec<CommandOption<Reading>> {
    let mut options: Vec<CommandOption<Reading>> = vec![CommandOption {
        names: &["-o"],
        value: "DIR",
        help: "the folder for a picture of each rung, ladder.csv, ladder.svg (a chart) and sheet.png (all pictures)",
        read: |reading, parser| {
            reading.folder = Some(PathBuf::from(parser.value()?));
            Ok(())
        },
    }];
    options.extend(seen::options());
    options.extend(of_rungs());
    options
}

fn of_rungs() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["--order"],
            value: "light|best-first",
            help: "which defect is repaired next: as light meets them, or that which takes most relMSE away for its milliseconds \
                   (default light)",
            read: |reading, parser| {
                let named = |name: &str| Order::ALL.into_iter().find(|order| order.name() == name);
                reading.args.order = choice(parser, "--order", named, "light or best-first")?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--repairs"],
            value: "NAME+NAME",
            help: "which defects are repaired, by the names that --repairs of render has, or all (default all)",
            read: |reading, parser| {
                let word = text(parser)?;
                match Repairs::parse(&word) {
                    Ok(repairs) => reading.args.repairs = repairs,
                    Err(name) => {
                        let known = Repairs::names().join(", ");
                        return usage(format!(
                            "--repairs {}: expected none, all or names with + between: {known}",
                            shown(&name)
                        ));
                    }
                }
                Ok(())
            },
        },
        CommandOption {
            names: &["--spp"],
            value: "N",
            help: "samples per pixel of the last two rungs, Whitted and path tracing (default 64)",
            read: |reading, parser| {
                let word = text(parser)?;
                match word.parse() {
                    Ok(spp) if spp > 0 => reading.args.spp = spp,
                    _ => return usage(format!("--spp {}: expected a whole number from 1", shown(&word))),
                }
                Ok(())
            },
        },
        CommandOption {
            names: &["--json"],
            value: "",
            help: "print one JSON object about the rungs on stdout in place of the table",
            read: |reading, _| {
                reading.args.json = true;
                Ok(())
            },
        },
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let args = LadderArgs {
        scene: String::new(),
        folder: PathBuf::new(),
        seen: Seen::default(),
        order: Order::default(),
        repairs: Repairs::ALL,
        spp: SPP,
        json: false,
    };
    let in_the_scene = |reading: &mut Reading, name: &str, parser: &mut lexopt::Parser| {
        set_in_the_scene(&mut reading.args.seen, name, parser)
    };
    let (reading, words) = match read(parser, Reading { args, folder: None }, &options(), 1, in_the_scene)? {
        Typed::Words(reading, words) => (reading, words),
        Typed::Print(text) => return Ok(Command::Print(text)),
    };
    let Some(scene) = words.into_iter().next().map(OsString::string).transpose()? else {
        return usage("ladder needs a scene: visavis ladder SCENE -o DIR");
    };
    let Some(folder) = reading.folder else { return usage("ladder needs a folder for its pictures: -o DIR") };
    Ok(Command::Ladder(Box::new(LadderArgs { scene, folder, ..reading.args })))
}
