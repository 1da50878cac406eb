//! Who waits for a picture at a terminal.

use crate::cli::interrupt;
use pathtrace::gpu::GpuTraceError;
use std::time::{Duration, Instant};
use technique::{Frame, Pacing, Watch};

/// Watches the time, and counts samples on stderr where someone can see it.
pub struct Terminal<'a> {
    /// Samples per pixel that are wanted, those of all runs together.
    pub spp: u32,
    /// Is shown how the picture comes, where someone follows that.
    pub follow: Option<&'a (dyn Fn(&Frame) + Sync)>,
    /// Whether someone sees the count.
    pub shown: bool,
    /// Whether what pixels show is wanted beside the picture.
    pub layers: bool,
    pub start: Instant,
    pub limit: Option<Duration>,
    /// Whether half of the samples are wanted by themselves.
    pub keeps_parts: bool,
    /// After how many samples they meet, where a picture says so that is made again.
    pub parts_meet_at: Option<u32>,
    /// How long a device may work on what nobody has read yet.
    pub at_risk: Duration,
}

impl Watch for Terminal<'_> {
    /// One sample of every pixel is made however late it is.
    fn ends_soon(&self, spp: u32) -> bool {
        spp > 0 && (interrupt::is_asked() || self.is_late())
    }

    fn keeps_parts(&self) -> bool {
        self.keeps_parts
    }

    fn parts_meet_at(&self) -> Option<u32> {
        self.parts_meet_at
    }

    fn skips_filters(&self) -> bool {
        interrupt::is_asked()
    }

    fn wants_features(&self) -> bool {
        self.layers
    }

    /// Passes of a quarter of a second, or of what is left of the time.
    fn pacing(&self, spent: Duration) -> Pacing {
        let left = self.limit.map_or(Duration::MAX, |limit| limit.saturating_sub(self.start.elapsed()));
        let (pass, show) = (left.min(Duration::from_millis(250)), self.at_risk);
        match self.follow {
            // at every doubling, and so late that reading takes a small share of the time
            Some(_) => Pacing { pass, show: show.min(spent / 4), growth: 1 },
            None => Pacing { pass, show, growth: 3 },
        }
    }

    fn show(&self, frame: Frame) {
        self.follow.iter().for_each(|follow| follow(&frame));
    }

    fn count(&self, spp: u32) {
        if self.shown {
            let of = if self.spp == u32::MAX { String::new() } else { format!(" of {}", self.spp) };
            crate::console::to_stderr(format_args!("\r{spp}{of} spp, {:.1} s ", self.start.elapsed().as_secs_f64()));
        }
    }

    fn told_of_loss(&self, fault: &GpuTraceError, spp: u32) {
        note!("note: the processor goes on from {spp} spp, the graphics device failed: {fault}");
    }
}

impl Terminal<'_> {
    fn is_late(&self) -> bool {
        self.limit.is_some_and(|limit| self.start.elapsed() >= limit)
    }

    /// Takes the count away.
    pub fn clear(&self) {
        if self.shown {
            crate::console::to_stderr(format_args!("\r\x1b[K"));
        }
    }
}
