//! Ctrl-C, and what else asks a program to end (SIGTERM, and SIGHUP of a terminal that is closed): the first one asks a command that can to end soon with what it has made so far,
//! the next one ends the program at once, as the first one does where nothing would be lost.

use std::process::ExitCode;
use std::sync::atomic::{AtomicI32, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The signal that asked; 0 if none did.
static ASKED: AtomicI32 = AtomicI32::new(0);
/// Pieces of work in hand that end soon when they are asked to.
static HEEDING: AtomicUsize = AtomicUsize::new(0);

/// Whether to end soon.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed) != 0
}

/// As long as this lives, a first Ctrl-C does not end the program: whoever holds it looks at [`is_asked`].
pub struct Heeded(());

pub fn heed() -> Heeded {
    HEEDING.fetch_add(1, Ordering::Relaxed);
    Heeded(())
}

/// What is called when the program is first asked to end, beside whoever looks at [`is_asked`].
static WAKE: Mutex<Option<Wake>> = Mutex::new(None);

type Wake = Box<dyn Fn() + Send>;

/// As [`heed`], for who sleeps until it is woken.
pub fn heed_when_woken(wake: Wake) -> Heeded {
    *WAKE.lock().unwrap_or_else(PoisonError::into_inner) = Some(wake);
    heed()
}

impl Drop for Heeded {
    fn drop(&mut self) {
        HEEDING.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Takes signals from now on, those excepted that whoever began this program lets it ignore, as nohup and a shell's `&` do;
/// where the system does not let it, they end the program as they always did.
#[cfg(unix)]
pub fn listen() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let ignored = ignored_signals();
    let taken = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let Ok(mut signals) = signal_hook::iterator::Signals::new(taken) else { return };
    // a system without threads renders nothing either
    let _ = std::thread::Builder::new().name("signals".into()).spawn(move || signals.forever().for_each(take));
}

/// Signal `n` is bit `n - 1`: proc(5). Elsewhere than on Linux none is known.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(unix)]
fn take(signal: i32) {
    use signal_hook::consts::SIGHUP;
    use std::io::IsTerminal;
    if HEEDING.load(Ordering::Relaxed) == 0 {
        end_at_once(signal);
    }
    let is_first = ASKED.compare_exchange(0, signal, Ordering::Relaxed, Ordering::Relaxed).is_ok();
    if is_first {
        // the terminal has just shown ^C
        let new_line = if std::io::stderr().is_terminal() { "\n" } else { "" };
        crate::console::to_stderr(format_args!(
            "{new_line}note: ends soon and saves what there is; once more ends at once\n"
        ));
        WAKE.lock().unwrap_or_else(PoisonError::into_inner).iter().for_each(|wake| wake());
    } else if signal != SIGHUP {
        // of a terminal that is closed both the shell and the system tell
        end_at_once(signal);
    }
}

#[cfg(unix)]
fn end_at_once(signal: i32) {
    let _no_more_files = image_file::remove_partial_files();
    end_by(signal);
}

/// As the signal ends a program that does not take it: whoever waits for it, a shell with a loop say, sees why it ended.
#[cfg(unix)]
fn end_by(signal: i32) {
    // it ends the process whatever happens
    let _ = signal_hook::low_level::emulate_default_handler(signal);
}

/// Ends the process that was asked to end, once it has saved and said what there is.
pub fn end() -> ExitCode {
    #[cfg(unix)]
    if is_asked() {
        end_by(ASKED.load(Ordering::Relaxed));
    }
    ExitCode::FAILURE
}

/// Elsewhere Ctrl-C ends the program at once.
#[cfg(not(unix))]
pub fn listen() {}
