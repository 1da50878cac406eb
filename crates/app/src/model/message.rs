//! The last thing worth saying: good news goes away by itself, bad news and notes at the next key or click.

use std::time::{Duration, Instant};

/// A line for the user.
#[derive(Debug, Clone)]
pub struct Message {
    /// What to say.
    pub text: String,
    /// Whether something failed.
    pub failed: bool,
    /// Whether it waits for a key or a click.
    stays: bool,
    since: Instant,
}

/// How long a message is at least there, whatever the user does.
const LEAST: Duration = Duration::from_secs(2);

/// How long good news stays.
const STAY: Duration = Duration::from_secs(6);

impl Message {
    /// A line that is said from now on.
    pub fn new(outcome: Result<String, String>) -> Self {
        let failed = outcome.is_err();
        Message { text: outcome.unwrap_or_else(|fault| fault), failed, stays: failed, since: Instant::now() }
    }

    /// What should be known though nothing failed.
    pub fn note(text: String) -> Self {
        Message { text, failed: false, stays: true, since: Instant::now() }
    }

    /// Whether it has been there long enough to have been read.
    pub fn is_old(&self) -> bool {
        self.since.elapsed() > LEAST
    }

    /// How long it still stays; `None` for what stays.
    pub fn remaining(&self) -> Option<Duration> {
        (!self.stays).then(|| STAY.saturating_sub(self.since.elapsed()))
    }
}
