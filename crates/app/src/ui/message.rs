//! The last thing worth saying: good news goes away by itself, bad news stays until the next.

use std::time::{Duration, Instant};

/// A line for the user.
#[derive(Debug, Clone)]
pub struct Message {
    /// What to say.
    pub text: String,
    /// Whether something failed.
    pub failed: bool,
    since: Instant,
}

/// How long good news stays.
const STAY: Duration = Duration::from_secs(6);

impl Message {
    /// A line that is said from now on.
    pub fn new(outcome: Result<String, String>) -> Self {
        let failed = outcome.is_err();
        Message { text: outcome.unwrap_or_else(|fault| fault), failed, since: Instant::now() }
    }

    /// How long it still stays; `None` for a failure, which stays.
    pub fn remaining(&self) -> Option<Duration> {
        (!self.failed).then(|| STAY.saturating_sub(self.since.elapsed()))
    }
}
