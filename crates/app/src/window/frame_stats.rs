//! What a frame costs the UI thread: running egui, tessellation and uploads, but not waiting for the screen or drawing.
//! And how long it is from one frame to the next while the user drags: all of it.

use std::fmt;
use std::time::{Duration, Instant};

/// Times of frames, by view in the order in which they were first seen.
#[derive(Debug, Default)]
pub struct FrameStats {
    frames: Vec<(&'static str, Vec<f32>)>,
    /// From one shown frame to the next while a button of the mouse is down.
    intervals: Vec<f32>,
    last_shown: Option<Instant>,
}

/// A running measurement of the UI thread's own time.
pub struct Clock(Duration);

/// The most frames that are kept of each view: at 60 a second, an hour and more.
const MOST_FRAMES: usize = 1 << 18;

impl Clock {
    /// Starts it on the current thread.
    pub fn start() -> Self {
        Clock(thread_time())
    }

    /// Time that the thread has worked since.
    pub fn elapsed(&self) -> Duration {
        thread_time().saturating_sub(self.0)
    }
}

/// Processor time of the current thread, so that other programs on the machine do not count.
#[cfg(unix)]
fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// Where the system does not tell the processor time of a thread, the clock on the view.
#[cfg(not(unix))]
fn thread_time() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}

impl FrameStats {
    /// Counts a frame.
    pub fn note(&mut self, view: &'static str, took: Duration) {
        let known = self.frames.iter().position(|(name, _)| *name == view);
        let place = known.unwrap_or_else(|| {
            self.frames.push((view, Vec::new()));
            self.frames.len() - 1
        });
        let (_, frames) = &mut self.frames[place];
        if frames.len() < MOST_FRAMES {
            frames.push(took.as_secs_f32() * 1000.0);
        }
    }

    /// Counts a frame that is on the screen, in the middle of a drag or not.
    pub fn note_shown(&mut self, dragging: bool) {
        let now = Instant::now();
        let before = std::mem::replace(&mut self.last_shown, dragging.then_some(now));
        if let Some(before) = before.filter(|_| dragging && self.intervals.len() < MOST_FRAMES) {
            self.intervals.push((now - before).as_secs_f32() * 1000.0);
        }
    }

    /// How many intervals there were between frames while dragging; their median, 99th percentile and greatest, in
    /// milliseconds.
    pub fn while_dragging(&self) -> Option<(usize, [f32; 3])> {
        let count = self.intervals.len();
        (count > 0).then(|| (count, quantiles(&self.intervals, [0.5, 0.99, 1.0])))
    }
}

impl fmt::Display for FrameStats {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "{:<14}{:>8}{:>14}{:>14}", "view", "frames", "median (ms)", "99th (ms)")?;
        for (view, frames) in &self.frames {
            let [median, most] = quantiles(frames, [0.5, 0.99]);
            writeln!(f, "{:<14}{:>8}{median:>14.2}{most:>14.2}", view, frames.len())?;
        }
        if let Some((count, [median, most, _])) = self.while_dragging() {
            writeln!(f, "{:<14}{count:>8}{median:>14.2}{most:>14.2}", "drag intervals")?;
        }
        Ok(())
    }
}

/// What these shares of the numbers do not exceed; there must be some.
fn quantiles<const N: usize>(numbers: &[f32], shares: [f32; N]) -> [f32; N] {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f32::total_cmp);
    shares.map(|share| sorted[((sorted.len() - 1) as f32 * share).round() as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_names_median_and_99th_percentile_of_each_view_seen() {
        let mut stats = FrameStats::default();
        for i in 0..=100 {
            stats.note("Wipe", Duration::from_millis(i));
        }
        let table = stats.to_string();
        assert_eq!(table.lines().count(), 2);
        assert!(table.contains("Wipe") && table.contains("50.00") && table.contains("99.00"), "{table}");
    }

    #[test]
    fn intervals_are_those_within_a_drag() {
        let mut stats = FrameStats::default();
        for dragging in [false, true, false, true, true, true, false] {
            stats.note_shown(dragging);
        }
        assert_eq!(stats.while_dragging().map(|(count, _)| count), Some(2));
        assert_eq!(quantiles(&[3.0, 1.0, 2.0], [0.5, 1.0]), [2.0, 3.0]);
    }

    #[test]
    fn sleeping_costs_no_processor_time() {
        let clock = Clock::start();
        std::thread::sleep(Duration::from_millis(50));
        assert!(!cfg!(unix) || clock.elapsed() < Duration::from_millis(25));
    }
}
