//! `visavis bench`: speed against error, on one page.

use super::BenchArgs;
use bench::{Options, Progress, build_of_this_program};
use std::io::IsTerminal;

pub fn run(args: &BenchArgs) -> anyhow::Result<()> {
    let options = Options {
        folder: args.folder.clone(),
        effort: args.effort,
        scenes: args.scenes.clone(),
        peers: args.peers.clone(),
        program: format!("{} (build {})", env!("CARGO_PKG_VERSION"), build_of_this_program()),
        command: command_line(),
    };
    let terminal = std::io::stderr().is_terminal();
    let mut show = |progress: &Progress| {
        if terminal {
            let (percent, left) = (100.0 * progress.done, time_left(progress.seconds_left));
            crate::console::to_stderr(format_args!("\r\x1b[K{percent:.0} %, {left} left: {}", progress.what));
        }
    };
    let outcome = bench::run(&options, &mut show);
    if terminal {
        crate::console::to_stderr(format_args!("\r\x1b[K"));
    }
    let outcome = outcome?;
    for line in &outcome.notes {
        note!("note: {line}");
    }
    let kept = if outcome.kept > 0 {
        format!(", {} of {} measurements were there already", outcome.kept, outcome.measurements)
    } else {
        String::new()
    };
    note!("wrote the page, its plots and tables{kept}: {}", image_file::shown(&outcome.page));
    super::print(&outcome.table)
}

/// As it was typed, words with blanks in quotes.
fn command_line() -> String {
    let words = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let quoted = words.map(|word| if word.contains([' ', '\'', '"']) { format!("{word:?}") } else { word });
    std::iter::once("visavis".to_owned()).chain(quoted).collect::<Vec<_>>().join(" ")
}

fn time_left(seconds: f64) -> String {
    if seconds < 90.0 { format!("{seconds:.0} s") } else { format!("{:.0} min", seconds / 60.0) }
}
