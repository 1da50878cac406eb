//! The threads that trace, shared by all who have something to trace: panes and the reference take them in turns of one
//! pass, so that two of them do not ask for twice the cores.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU8, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Whose turn is next: the highest that waits, and of those the first that came.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rank {
    /// What goes on where nobody waits for it.
    Background = 1,
    /// More samples of a picture that is there.
    Refinement = 2,
    /// The first picture of what is asked for now.
    FirstPicture = 3,
    /// A rough one before it, in a few milliseconds.
    RoughPicture = 4,
}

/// How often who waits asks whether that is still wanted.
const ASKS_EVERY: Duration = Duration::from_millis(5);

/// A pool of threads and whose turn it is.
#[derive(Debug, Default)]
pub struct Threads {
    /// `None` for the pool of the whole process.
    pool: Option<rayon::ThreadPool>,
    /// One fewer, for while somebody needs a core; `None` where the pool leaves one anyway.
    fewer: Option<rayon::ThreadPool>,
    /// How many need one now.
    spared: AtomicUsize,
    turns: Mutex<Turns>,
    passed_on: Condvar,
    /// The highest rank that waits; 0 if nobody does. Read before every segment of a path, so without the lock.
    wanted: AtomicU8,
}

#[derive(Debug, Default)]
struct Turns {
    taken: bool,
    tickets: u64,
    /// Rank and ticket; tickets count down, so that the last of the set is the next.
    waiting: BTreeSet<(Rank, u64)>,
}

/// A core that is left to somebody; dropping it gives it back.
pub struct SparedCore<'a>(&'a Threads);

impl Drop for SparedCore<'_> {
    fn drop(&mut self) {
        self.0.spared.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Threads {
    /// Every core, for a program that does nothing else.
    pub fn all() -> Self {
        Threads::default()
    }

    /// Every core where `start`, which each thread runs first, lets the user interface go before them
    /// (`they_step_back`); else all but one, which is the user interface's.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn beside_the_ui(start: fn(), they_step_back: bool) -> Result<Self, rayon::ThreadPoolBuildError> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let but_one = cores.saturating_sub(1).max(1);
        let pool_of = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.thread_name(|i| format!("rays {i}")).start_handler(move |_| start()).build()
        };
        let pool = pool_of(if they_step_back { cores } else { but_one })?;
        let fewer = (they_step_back && but_one < cores).then(|| pool_of(but_one)).transpose()?;
        Ok(Threads { pool: Some(pool), fewer, ..Threads::default() })
    }

    /// Leaves a core to who asks, in all turns that begin until what is returned is dropped. Work that the system does
    /// beside it for the first time, as compiling what draws, is done sooner.
    pub fn spare_a_core(&self) -> SparedCore<'_> {
        self.spared.fetch_add(1, Ordering::Relaxed);
        SparedCore(self)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.pool.as_ref().map_or_else(rayon::current_num_threads, rayon::ThreadPool::current_num_threads)
    }

    /// Waits for its turn and works on these threads.
    pub fn turn<R: Send>(&self, rank: Rank, work: impl FnOnce() -> R + Send) -> R {
        let _turn = self.wait(rank, &|| false);
        self.install(work)
    }

    /// The same, but `None` if `gives_up` says so before it is its turn.
    pub fn turn_unless<R: Send>(
        &self,
        gives_up: &dyn Fn() -> bool,
        rank: Rank,
        work: impl FnOnce() -> R + Send,
    ) -> Option<R> {
        let _turn = self.wait(rank, gives_up)?;
        Some(self.install(work))
    }

    fn install<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        let fewer = self.fewer.as_ref().filter(|_| self.spared.load(Ordering::Relaxed) > 0);
        match fewer.or(self.pool.as_ref()) {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Whether someone of a higher rank waits: a turn of `rank` should end soon.
    pub fn are_wanted_by_more_than(&self, rank: Rank) -> bool {
        self.wanted.load(Ordering::Relaxed) > rank as u8
    }

    fn wait(&self, rank: Rank, gives_up: &dyn Fn() -> bool) -> Option<Turn<'_>> {
        let mut turns = self.lock();
        turns.tickets += 1;
        let own = (rank, u64::MAX - turns.tickets);
        turns.waiting.insert(own);
        self.tell_who_waits(&turns);
        let mut wanted = true;
        while wanted && (turns.taken || turns.waiting.last() != Some(&own)) {
            (turns, _) = self.passed_on.wait_timeout(turns, ASKS_EVERY).unwrap_or_else(PoisonError::into_inner);
            wanted = !gives_up();
        }
        turns.waiting.remove(&own);
        turns.taken |= wanted;
        self.tell_who_waits(&turns);
        if wanted {
            return Some(Turn(self));
        }
        // who is next now may have looked already
        self.passed_on.notify_all();
        None
    }

    fn tell_who_waits(&self, turns: &Turns) {
        self.wanted.store(turns.waiting.last().map_or(0, |(rank, _)| *rank as u8), Ordering::Relaxed);
    }

    /// A panic within a turn happens outside the lock: what is locked is whole.
    fn lock(&self) -> MutexGuard<'_, Turns> {
        self.turns.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Passes on when it goes, by a panic too.
struct Turn<'a>(&'a Threads);

impl Drop for Turn<'_> {
    fn drop(&mut self) {
        self.0.lock().taken = false;
        self.0.passed_on.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    /// While a turn lasts others come; then the highest goes first, and of equals the one that came first.
    #[test]
    fn the_highest_goes_first_and_equals_in_the_order_in_which_they_came() {
        let threads = Threads::beside_the_ui(|| (), true).unwrap();
        let (order, served) = channel();
        std::thread::scope(|scope| {
            let turn = threads.wait(Rank::Refinement, &|| false);
            let ranks = [Rank::Background, Rank::Refinement, Rank::FirstPicture, Rank::Refinement];
            for (i, rank) in ranks.into_iter().enumerate() {
                let (threads, order) = (&threads, order.clone());
                scope.spawn(move || threads.turn(rank, || order.send(i)));
                while threads.lock().waiting.len() <= i {
                    std::thread::yield_now();
                }
            }
            assert!(threads.are_wanted_by_more_than(Rank::Refinement));
            assert!(!threads.are_wanted_by_more_than(Rank::FirstPicture));
            drop(turn);
        });
        assert_eq!(served.try_iter().collect::<Vec<_>>(), [2, 1, 3, 0]);
    }

    /// Two that take turns with each other leave none to one of a lower rank, which must be able to go.
    #[test]
    fn who_waits_in_vain_can_give_up_and_nothing_is_left_of_it() {
        let threads = Threads::beside_the_ui(|| (), true).unwrap();
        let turn = threads.wait(Rank::Refinement, &|| false);
        let asked = AtomicU8::new(0);
        let gives_up = || asked.fetch_add(1, Ordering::Relaxed) == 2;
        assert_eq!(threads.turn_unless(&gives_up, Rank::RoughPicture, || 1), None);
        assert!(threads.lock().waiting.is_empty() && !threads.are_wanted_by_more_than(Rank::Background));
        drop(turn);
        assert_eq!(threads.turn_unless(&|| true, Rank::Background, || 1), Some(1), "nothing to wait for");
    }

    #[test]
    fn no_core_is_idle_where_threads_step_back_and_one_is_the_windows_where_they_do_not() {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let count = |they_step_back| Threads::beside_the_ui(|| (), they_step_back).unwrap().count();
        assert_eq!([count(true), count(false)], [cores, (cores - 1).max(1)]);
    }

    #[test]
    fn a_core_is_left_to_who_asks_until_it_is_given_back() {
        let threads = Threads::beside_the_ui(|| (), true).unwrap();
        let cores = threads.count();
        let in_a_turn = || threads.turn(Rank::Background, rayon::current_num_threads);
        let (first, second) = (threads.spare_a_core(), threads.spare_a_core());
        assert_eq!(in_a_turn(), (cores - 1).max(1));
        drop(first);
        assert_eq!(in_a_turn(), (cores - 1).max(1), "one needs it still");
        drop(second);
        assert_eq!(in_a_turn(), cores);
    }

    #[test]
    fn a_panic_passes_the_turn_on() {
        let threads = Threads::beside_the_ui(|| (), true).unwrap();
        let fails = || threads.turn(Rank::Background, || panic!("on purpose"));
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(fails)).is_err());
        assert_eq!(threads.turn(Rank::Background, || 1), 1);
    }
}
