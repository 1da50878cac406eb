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

/// The most lines that are said at once: a model has many notes, and they would cover the pictures.
const MOST_LINES: usize = 2;

/// The first of these lines with the count of the others, and those, which are for stderr.
pub fn in_few(lines: &[String]) -> (String, &[String]) {
    let (said, left) = lines.split_at(lines.len().min(MOST_LINES));
    let more = (!left.is_empty()).then(|| format!("{} more on stderr", left.len()));
    (said.iter().cloned().chain(more).collect::<Vec<_>>().join("; "), left)
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_notes_two_are_said_and_the_others_left() {
        let notes = ["a", "b", "c", "d"].map(String::from);
        assert_eq!(in_few(&notes), ("a; b; 2 more on stderr".into(), &notes[2..]));
        assert_eq!(in_few(&notes[..2]), ("a; b".into(), &[][..]));
        assert_eq!(in_few(&[]), (String::new(), &[][..]));
    }
}
