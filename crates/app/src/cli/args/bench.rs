//! The words after `bench`.

use super::options::{CommandOption, Typed, no_more, read};
use super::usage;
use super::values::number;
use crate::cli::{CliError, Command};
use bench::plan::{Effort, QUICK_SECONDS, SCENES};
use lexopt::ValueExt;
use std::path::PathBuf;

/// `visavis bench -o DIR ...`.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchArgs {
    /// Folder for everything that is written.
    pub folder: PathBuf,
    /// How long it may take.
    pub effort: Effort,
    /// Names of the scenes; empty for all.
    pub scenes: Vec<String>,
    /// Tables of other programs.
    pub peers: Vec<PathBuf>,
}

/// The words after `bench` on their way.
pub struct Reading {
    folder: Option<PathBuf>,
    args: BenchArgs,
}

pub fn options() -> Vec<CommandOption<Reading>> {
    vec![
        CommandOption {
            names: &["-o"],
            value: "DIR",
            help: "the folder for its results",
            read: |reading, parser| {
                reading.folder = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--quick"],
            value: "",
            help: "as small as fits into a minute on an idle machine; without: three quarters of an hour on two fast cores",
            read: |reading, _| {
                reading.args.effort = Effort::Seconds(QUICK_SECONDS);
                Ok(())
            },
        },
        CommandOption {
            names: &["--time"],
            value: "SECONDS",
            help: "as small as fits into this long",
            read: |reading, parser| {
                let seconds = number(parser, "--time", "seconds from 1 to 1e6", |v| (1.0..=1e6).contains(&v))?;
                reading.args.effort = Effort::Seconds(f64::from(seconds));
                Ok(())
            },
        },
        CommandOption {
            names: &["--scene"],
            value: "cornell,whitted",
            help: "these scenes alone",
            read: |reading, parser| {
                reading.args.scenes = scenes(&parser.value()?.string()?)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--peer"],
            value: "FILE.csv",
            help: "further lines from another renderer, may be repeated; columns name,scene,spp,seconds,relmse; scene is \
                   cornell, whitted-sun-0, whitted-sun-0.5 or whitted-sun-2.5",
            read: |reading, parser| {
                reading.args.peers.push(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let args = BenchArgs { folder: PathBuf::new(), effort: Effort::Full, scenes: Vec::new(), peers: Vec::new() };
    match read(parser, Reading { folder: None, args }, &options(), 0, no_more)? {
        Typed::Print(text) => Ok(Command::Print(text)),
        Typed::Words(Reading { folder: Some(folder), args }, _) => Ok(Command::Bench(BenchArgs { folder, ..args })),
        Typed::Words(..) => usage("bench needs a folder for its results: visavis bench -o DIR"),
    }
}

/// Names of scenes in the bench's own order, so that "a,b" and "b,a" are one bench.
fn scenes(word: &str) -> Result<Vec<String>, CliError> {
    let asked: Vec<&str> = word.split(',').map(str::trim).collect();
    if asked.iter().any(|name| !SCENES.contains(name)) {
        return usage(format!("--scene {word}: expected {}, or both with a comma between", SCENES.join(" or ")));
    }
    let all = SCENES.iter().all(|name| asked.contains(name));
    let chosen = SCENES.iter().filter(|name| !all && asked.contains(name));
    Ok(chosen.map(|name| (*name).to_owned()).collect())
}
