//! Visavis: the rasterised fake of a scene face to face with its path-traced truth.
//!
//! [`run`] reads the command line ([`cli`]): headless commands, or the viewer. The viewer's state is a [`model`], plain
//! values; [`ui`] draws it into egui, and the [`engine`] makes beside it what it wants; neither knows of the other. The
//! [`viewer`] is all three in a frame, and [`window`] the only place that knows winit.

#[macro_use]
mod console;

pub mod cli;
pub mod engine;
pub mod environment;
pub mod lab_report;
pub mod ladder;
pub mod lettering;
pub mod model;
pub mod ruler;
pub mod sweep;
mod tree_store;
pub mod ui;
pub mod viewer;
pub mod window;

use std::ffi::OsString;
use std::process::ExitCode;

/// Runs the program on its arguments (without its own name). Exit code 0 is done, 1 failed, 2 wrong usage; a failure
/// prints one line on stderr. What a signal has interrupted does not return: the process ends by that signal.
pub fn run(args: impl IntoIterator<Item = OsString>) -> ExitCode {
    match cli::Command::parse(args).and_then(cli::Command::execute) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::to_stderr(format_args!("visavis: {}\n", error.line()));
            error.end()
        }
    }
}
