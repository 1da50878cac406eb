//! How threads hand over: the newest wins, and nobody waits to post.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// A place for the latest wish: posting changes what has not been taken yet.
#[derive(Debug, Default)]
pub struct Mailbox<T> {
    state: Mutex<State<T>>,
    arrived: Condvar,
}

#[derive(Debug, Default)]
struct State<T> {
    content: T,
    fresh: bool,
    closed: bool,
    /// Whether what is fresh is still taken after closing.
    finish: bool,
}

impl<T: Default> Mailbox<T> {
    /// Changes the content and wakes the taker.
    pub fn post(&self, change: impl FnOnce(&mut T)) {
        let mut state = self.lock();
        change(&mut state.content);
        state.fresh = true;
        self.arrived.notify_one();
    }

    /// Waits for something fresh and takes it; `None` once closed, or once closed and empty.
    pub fn take(&self) -> Option<T> {
        let mut state = self.lock();
        while !state.fresh && !state.closed {
            state = self.arrived.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        if state.closed && !(state.finish && state.fresh) {
            return None;
        }
        state.fresh = false;
        Some(std::mem::take(&mut state.content))
    }

    /// Takes what is fresh now, without waiting.
    pub fn take_now(&self) -> Option<T> {
        let mut state = self.lock();
        std::mem::take(&mut state.fresh).then(|| std::mem::take(&mut state.content))
    }
}

impl<T> Mailbox<T> {
    /// Whether something waits to be taken, or the end.
    pub fn has_fresh(&self) -> bool {
        let state = self.lock();
        state.fresh || state.closed
    }

    /// Ends the taker's loop.
    pub fn close(&self) {
        self.lock().closed = true;
        self.arrived.notify_all();
    }

    /// Ends the taker's loop once it has taken what is there.
    pub fn close_when_empty(&self) {
        self.lock().finish = true;
        self.close();
    }

    /// A thread that panicked while it held the lock left whole content behind: posting and taking do not stop midway.
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn newer_wishes_replace_older_ones() {
        let mailbox = Mailbox::<u32>::default();
        mailbox.post(|v| *v = 1);
        mailbox.post(|v| *v = 2);
        assert_eq!((mailbox.take(), mailbox.take_now()), (Some(2), None));
    }

    #[test]
    fn closing_when_empty_hands_out_the_rest() {
        let mailbox = Mailbox::<u32>::default();
        mailbox.post(|v| *v = 3);
        mailbox.close_when_empty();
        assert_eq!((mailbox.take(), mailbox.take()), (Some(3), None));
    }

    #[test]
    fn closing_ends_a_waiting_taker() {
        let mailbox = Arc::new(Mailbox::<u32>::default());
        let taker = std::thread::spawn({
            let mailbox = mailbox.clone();
            move || mailbox.take()
        });
        mailbox.close();
        assert_eq!(taker.join().unwrap(), None);
    }
}
