//! The words after `device-report`.

use super::options::{CommandOption, Typed, no_more, read};
use super::usage;
use super::values::{shown, size, text};
use crate::cli::{CliError, Command};
use std::path::PathBuf;

/// What `visavis device-report` was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviceReportArgs {
    /// Where the page is written to, beside stdout.
    pub out: Option<PathBuf>,
    /// Width and height of the pictures that are timed, in pixels.
    pub size: (u32, u32),
    /// What is asked for.
    pub parts: Vec<ReportPart>,
    /// Seconds after which no further part begins.
    pub seconds: u32,
}

/// A part of the page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportPart {
    /// What would be used.
    Adapters,
    /// The hard cases, coarsely.
    Checks,
    /// How much the device does at most, and how many rays it traces.
    Rates,
    /// How long pictures take while a slider moves.
    Frames,
    /// Whether pictures are the processor's.
    Agreement,
    /// What happens where it is lost.
    Loss,
}

impl ReportPart {
    /// All, in the order of the page.
    pub const ALL: [ReportPart; 6] = [
        ReportPart::Adapters,
        ReportPart::Rates,
        ReportPart::Frames,
        ReportPart::Agreement,
        ReportPart::Loss,
        ReportPart::Checks,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            ReportPart::Adapters => "adapters",
            ReportPart::Checks => "checks",
            ReportPart::Rates => "rates",
            ReportPart::Frames => "frames",
            ReportPart::Agreement => "agreement",
            ReportPart::Loss => "loss",
        }
    }
}

/// Seconds after which no further part begins, unless something else is said.
const SECONDS: u32 = 480;

pub fn options() -> Vec<CommandOption<DeviceReportArgs>> {
    vec![
        CommandOption {
            names: &["-o"],
            value: "FILE",
            help: "a text file for the page, beside stdout",
            read: |args, parser| {
                args.out = Some(PathBuf::from(parser.value()?));
                Ok(())
            },
        },
        CommandOption {
            names: &["--size"],
            value: "WxH",
            help: "pixels of the pictures that are timed (default 1920x1080)",
            read: |args, parser| {
                args.size = size(&text(parser)?)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--parts"],
            value: "NAME,NAME,...",
            help: "these parts alone: adapters, rates, frames, agreement, loss, checks",
            read: |args, parser| {
                args.parts = parts(&text(parser)?)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--seconds"],
            value: "N",
            help: "after so many no further part begins (default 480)",
            read: |args, parser| {
                let word = text(parser)?;
                match word.parse() {
                    Ok(seconds) => args.seconds = seconds,
                    Err(_) => return usage(format!("--seconds {}: expected a whole number", shown(&word))),
                }
                Ok(())
            },
        },
    ]
}

pub fn parse(parser: lexopt::Parser) -> Result<Command, CliError> {
    let args = DeviceReportArgs { out: None, size: (1920, 1080), parts: ReportPart::ALL.to_vec(), seconds: SECONDS };
    match read(parser, args, &options(), 0, no_more)? {
        Typed::Words(args, _) => Ok(Command::DeviceReport(args)),
        Typed::Print(text) => Ok(Command::Print(text)),
    }
}

fn parts(words: &str) -> Result<Vec<ReportPart>, CliError> {
    let named = |word: &str| ReportPart::ALL.into_iter().find(|part| part.name() == word.trim());
    let parts: Option<Vec<ReportPart>> = words.split(',').map(named).collect();
    let names = ReportPart::ALL.map(ReportPart::name).join(", ");
    parts.map_or_else(|| usage(format!("--parts {}: expected names of {names}", shown(words))), Ok)
}
