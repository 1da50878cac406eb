//! The words after `bench`.

use super::usage;
use super::values::number;
use crate::cli::{CliError, Command, help};
use bench::plan::{Effort, QUICK_SECONDS, SCENES};
use lexopt::prelude::*;
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

pub fn parse(mut parser: lexopt::Parser) -> Result<Command, CliError> {
    let mut folder = None;
    let mut args = BenchArgs { folder: PathBuf::new(), effort: Effort::Full, scenes: Vec::new(), peers: Vec::new() };
    while let Some(arg) = parser.next()? {
        match arg {
            Short('o') => folder = Some(PathBuf::from(parser.value()?)),
            Long("quick") => args.effort = Effort::Seconds(QUICK_SECONDS),
            Long("time") => {
                let seconds = number(&mut parser, "--time", "seconds from 1 to 1e6", |v| (1.0..=1e6).contains(&v))?;
                args.effort = Effort::Seconds(f64::from(seconds));
            }
            Long("scene") => args.scenes = scenes(&parser.value()?.string()?)?,
            Long("peer") => args.peers.push(PathBuf::from(parser.value()?)),
            Long("help") => return Ok(Command::Print(help::HELP)),
            other => return Err(other.unexpected().into()),
        }
    }
    match folder {
        Some(folder) => Ok(Command::Bench(BenchArgs { folder, ..args })),
        None => usage("bench needs a folder for its results: visavis bench -o DIR"),
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
