//! What a frame costs the UI thread: running egui, tessellation and uploads, but not waiting for the screen or drawing.

use crate::ui::View;
use std::fmt;
use std::time::Duration;

/// Times of frames, by view.
#[derive(Debug, Default)]
pub struct FrameStats {
    frames: [Vec<f32>; View::ALL.len()],
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

/// Where the system does not tell the processor time of a thread, the clock on the wall.
#[cfg(not(unix))]
fn thread_time() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}

impl FrameStats {
    /// Counts a frame.
    pub fn note(&mut self, view: View, took: Duration) {
        let frames = &mut self.frames[view as usize];
        if frames.len() < MOST_FRAMES {
            frames.push(took.as_secs_f32() * 1000.0);
        }
    }
}

impl fmt::Display for FrameStats {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        writeln!(f, "{:<14}{:>8}{:>14}{:>14}", "view", "frames", "median (ms)", "99th (ms)")?;
        for (view, frames) in View::ALL.iter().zip(&self.frames).filter(|(_, frames)| !frames.is_empty()) {
            let mut sorted = frames.clone();
            sorted.sort_by(f32::total_cmp);
            let at = |share: f32| sorted[((sorted.len() - 1) as f32 * share).round() as usize];
            writeln!(f, "{:<14}{:>8}{:>14.2}{:>14.2}", view.name(), sorted.len(), at(0.5), at(0.99))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_names_median_and_99th_percentile_of_each_view_seen() {
        let mut stats = FrameStats::default();
        for i in 0..=100 {
            stats.note(View::Wipe, Duration::from_millis(i));
        }
        let table = stats.to_string();
        assert_eq!(table.lines().count(), 2);
        assert!(table.contains("Wipe") && table.contains("50.00") && table.contains("99.00"), "{table}");
    }

    #[test]
    fn sleeping_costs_no_processor_time() {
        let clock = Clock::start();
        std::thread::sleep(Duration::from_millis(50));
        assert!(!cfg!(unix) || clock.elapsed() < Duration::from_millis(25));
    }
}
