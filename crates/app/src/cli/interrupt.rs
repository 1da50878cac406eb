//! Ctrl-C, and what asks a program to end: the first one asks a command that can to end soon with what it has made so far,
//! the next one ends the program at once, as the first one does where nothing would be lost.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// What a shell calls a program that Ctrl-C has ended.
pub const EXIT_CODE: u8 = 130;

static ASKED: AtomicBool = AtomicBool::new(false);
/// Pieces of work in hand that end soon when they are asked to.
static HEEDING: AtomicUsize = AtomicUsize::new(0);

/// Whether to end soon.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// As long as this lives, a first Ctrl-C does not end the program: whoever holds it looks at [`is_asked`].
pub struct Heeded(());

pub fn heed() -> Heeded {
    HEEDING.fetch_add(1, Ordering::Relaxed);
    Heeded(())
}

impl Drop for Heeded {
    fn drop(&mut self) {
        HEEDING.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Takes signals from now on; where the system does not let it, they end the program as they always did.
#[cfg(unix)]
pub fn listen() {
    use signal_hook::consts::{SIGINT, SIGTERM};
    let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM]) else { return };
    // a system without threads renders nothing either
    let _ = std::thread::Builder::new().name("signals".into()).spawn(move || signals.forever().for_each(take));
}

#[cfg(unix)]
fn take(signal: i32) {
    use std::io::IsTerminal;
    if HEEDING.load(Ordering::Relaxed) > 0 && !ASKED.swap(true, Ordering::Relaxed) {
        // the terminal has just shown ^C
        let new_line = if std::io::stderr().is_terminal() { "\n" } else { "" };
        note!("{new_line}note: ends soon and saves what there is; once more ends at once");
    } else {
        let _no_more_files = image_file::remove_partial_files();
        signal_hook::low_level::exit(128 + signal);
    }
}

/// Elsewhere Ctrl-C ends the program at once.
#[cfg(not(unix))]
pub fn listen() {}
