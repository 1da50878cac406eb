//! The words after `check`.

use super::options::{CommandOption, Typed, no_more, read};
use super::usage;
use super::values::{DEVICES, choice, lanes};
use crate::cli::{CliError, Command};
use lexopt::ValueExt;
use technique::DeviceChoice;

/// What `visavis check` was asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CheckArgs {
    /// Whether to look coarsely.
    pub quick: bool,
    /// Whether the graphics device is checked, in those of the cases that it renders.
    pub on_gpu: bool,
    /// Numbers of the cases to run; empty for all.
    pub cases: Vec<u32>,
    /// One JSON object on stdout instead of a table.
    pub json: bool,
    /// What cases claim, and nothing run.
    pub list: bool,
    /// Whether expectations are wrong on purpose.
    pub spoilt: bool,
}

pub fn options() -> Vec<CommandOption<CheckArgs>> {
    vec![
        CommandOption {
            names: &["--quick"],
            value: "",
            help: "coarser, within a minute",
            read: |args, _| {
                args.quick = true;
                Ok(())
            },
        },
        CommandOption {
            names: &["--case"],
            value: "N,N,...",
            help: "these cases alone",
            read: |args, parser| {
                args.cases = cases(&parser.value()?.string()?)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--device"],
            value: "auto|cpu|gpu",
            help: "what is checked; the gpu renders 29 of the 31 cases (default auto: the cpu)",
            read: |args, parser| {
                args.on_gpu = choice(parser, "--device", DeviceChoice::named, DEVICES)? == DeviceChoice::Gpu;
                Ok(())
            },
        },
        CommandOption {
            names: &["--lanes"],
            value: "avx512|avx2|array|scalar",
            help: "as for render",
            read: |_, parser| lanes(parser),
        },
        CommandOption {
            names: &["--json"],
            value: "",
            help: "one JSON object on stdout",
            read: |args, _| {
                args.json = true;
                Ok(())
            },
        },
        CommandOption {
            names: &["--list"],
            value: "",
            help: "what each case claims, without running it",
            read: |args, _| {
                args.list = true;
                Ok(())
            },
        },
        CommandOption {
            names: &["--spoil"],
            value: "",
            help: "expects a twentieth too much, to see the check fail",
            read: |args, _| {
                args.spoilt = true;
                Ok(())
            },
        },
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let args = CheckArgs { quick: false, on_gpu: false, cases: Vec::new(), json: false, list: false, spoilt: false };
    match read(parser, args, &options(), 0, no_more)? {
        Typed::Words(args, _) => Ok(Command::Check(args)),
        Typed::Print(text) => Ok(Command::Print(text)),
    }
}

fn cases(word: &str) -> Result<Vec<u32>, CliError> {
    let known = |number: &u32| ::check::CASES.iter().any(|case| case.number == *number);
    let numbers: Option<Vec<u32>> = word.split(',').map(|n| n.trim().parse().ok().filter(known)).collect();
    let most = ::check::CASES.len();
    numbers.map_or_else(|| usage(format!("--case {word}: expected numbers from 1 to {most}, like 4 or 4,5")), Ok)
}
