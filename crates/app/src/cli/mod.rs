//! The command line, a contract that scripts depend on. Words become a [`Command`] (in `args`); a command runs and
//! either is done or fails with one line.

mod args;
mod bench;
mod check;
mod compare;
mod denoise;
mod device_report;
mod info;
mod interrupt;
mod ladder;
mod merge;
mod original;
mod reference;
mod render;
mod report;
mod sweep;
mod trees;

pub use args::{
    BenchArgs, CheckArgs, CompareArgs, DenoiseArgs, DeviceReportArgs, LadderArgs, MergeArgs, ReferenceArgs, RenderArgs,
    ReportArgs, Seen, SweepArgs,
};

use crate::model::ViewArgs;
use crate::tree_store;
use pathtrace::intersect::mesh_kept;
use std::process::ExitCode;

/// What the user asked for.
#[derive(Debug)]
pub enum Command {
    /// The viewer.
    View(Box<ViewArgs>),
    /// A picture to a file, without a window.
    Render(Box<RenderArgs>),
    /// A lab report or a slide of two pictures.
    Report(Box<ReportArgs>),
    /// The distance between two pictures, or of one from its reference.
    Compare(CompareArgs),
    /// A picture without its noise.
    Denoise(DenoiseArgs),
    /// Films of ranges of one picture's samples, put together.
    Merge(MergeArgs),
    /// Speed against error of all techniques on the built-in scenes.
    Bench(BenchArgs),
    /// References: made, kept, thrown away.
    Reference(ReferenceArgs),
    /// Every hard case.
    Check(CheckArgs),
    /// Many pictures of one scene as one.
    Sweep(Box<SweepArgs>),
    /// The fake, repaired step by step.
    Ladder(Box<LadderArgs>),
    /// Adapters, limits, and what would be used.
    Info,
    /// What a graphics device is worth.
    DeviceReport(DeviceReportArgs),
    /// A text to print.
    Print(String),
}

/// Why the program stops.
#[derive(Debug)]
pub enum CliError {
    /// The words make no command: exit code 2.
    Usage(String),
    /// The command failed: exit code 1.
    Failed(anyhow::Error),
    /// The user ended the command before it was done, and what came of it is said: it ends by the signal that asked for it, which shells
    /// report as 128 and its number.
    Interrupted(Option<anyhow::Error>),
}

impl CliError {
    /// What, where, and what to do, in one line.
    pub fn line(&self) -> String {
        match self {
            CliError::Usage(line) => one_line(&format!("{line} (visavis --help lists the options)")),
            CliError::Failed(error) => one_line(&format!("{error:#}")),
            CliError::Interrupted(Some(error)) => one_line(&format!("interrupted: {error:#}")),
            CliError::Interrupted(None) => "interrupted: what there was by then is kept".into(),
        }
    }

    /// How the process ends: with 1, with 2, or at once by the signal that has interrupted it.
    pub fn end(&self) -> ExitCode {
        match self {
            CliError::Usage(_) => ExitCode::from(2),
            CliError::Failed(_) => ExitCode::from(1),
            CliError::Interrupted(_) => interrupt::end(),
        }
    }
}

impl From<anyhow::Error> for CliError {
    fn from(error: anyhow::Error) -> Self {
        CliError::Failed(error)
    }
}

impl Command {
    /// Does it.
    ///
    /// # Errors
    /// [`CliError::Failed`] or [`CliError::Interrupted`], with one line for the user.
    pub fn execute(self) -> Result<(), CliError> {
        interrupt::listen();
        tree_store::keep();
        let outcome = self.run();
        mesh_kept::finish();
        match outcome {
            outcome if interrupt::is_asked() => Err(CliError::Interrupted(outcome.err())),
            outcome => outcome.map_err(CliError::Failed),
        }
    }

    fn run(self) -> anyhow::Result<()> {
        match self {
            Command::View(args) => crate::window::open(&args, interrupt::heed_when_woken),
            Command::Render(mut args) => render::run(&mut args),
            Command::Report(args) => report::run(&args),
            Command::Compare(args) => compare::run(&args),
            Command::Denoise(args) => denoise::run(&args),
            Command::Merge(args) => merge::run(&args),
            Command::Bench(args) => bench::run(&args),
            Command::Reference(args) => reference::run(&args),
            Command::Check(args) => check::run(&args),
            Command::Sweep(args) => sweep::run(&args),
            Command::Ladder(args) => ladder::run(&args),
            Command::Info => info::run(),
            Command::DeviceReport(args) => device_report::run(&args),
            Command::Print(text) => print(&text),
        }
    }
}

fn one_line(text: &str) -> String {
    image_file::escaped(&text.lines().collect::<Vec<_>>().join(", "))
}

/// Prints to stdout; that a pipe was closed early is not a failure.
fn print(text: &str) -> anyhow::Result<()> {
    use std::io::{ErrorKind, Write};
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(anyhow::anyhow!("cannot print to stdout ({e})")),
        _ => Ok(()),
    }
}
