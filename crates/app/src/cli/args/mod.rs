//! From words to commands.

pub mod bench;
pub mod check;
pub mod compare;
pub mod denoise;
pub mod device_report;
mod help;
pub mod ladder;
pub mod merge;
pub mod options;
pub mod reference;
pub mod render;
pub mod report;
mod samples;
mod seen;
pub mod sweep;
mod values;
pub mod view;

pub use bench::BenchArgs;
pub use check::CheckArgs;
pub use compare::CompareArgs;
pub use denoise::DenoiseArgs;
pub use device_report::{DeviceReportArgs, ReportPart};
pub use ladder::LadderArgs;
pub use merge::MergeArgs;
pub use reference::ReferenceArgs;
pub use render::{RenderArgs, made_by};
pub use report::{ReportArgs, ReportKind};
pub use seen::Seen;
pub use sweep::SweepArgs;

use super::{CliError, Command};
use options::{Typed, no_more, read};
use std::ffi::OsString;

fn usage<T>(line: impl Into<String>) -> Result<T, CliError> {
    Err(CliError::Usage(line.into()))
}

impl From<lexopt::Error> for CliError {
    fn from(error: lexopt::Error) -> Self {
        CliError::Usage(error.to_string())
    }
}

impl Command {
    /// Reads the arguments (without the program's name).
    ///
    /// # Errors
    /// [`CliError::Usage`] names the word that is wrong and what was expected.
    pub fn parse(args: impl IntoIterator<Item = OsString>) -> Result<Self, CliError> {
        let words: Vec<OsString> = args.into_iter().collect();
        let command = words.first().and_then(|word| word.to_str()).unwrap_or_default().to_owned();
        let mut parser = lexopt::Parser::from_args(words);
        let named: fn(lexopt::Parser) -> Result<Self, CliError> = match command.as_str() {
            "render" => render::parse,
            "report" => report::parse,
            "compare" => compare::parse,
            "denoise" => denoise::parse,
            "merge" => merge::parse,
            "bench" => bench::parse,
            "sweep" => sweep::parse,
            "ladder" => ladder::parse,
            "info" => parse_info,
            "device-report" => device_report::parse,
            "check" => check::parse,
            "reference" => reference::parse,
            _ => return view::parse(parser),
        };
        parser.next()?;
        named(parser)
    }
}

fn parse_info(parser: lexopt::Parser) -> Result<Command, CliError> {
    match read(parser, (), &[], 0, no_more)? {
        Typed::Words(..) => Ok(Command::Info),
        Typed::Print(text) => Ok(Command::Print(text)),
    }
}
