//! How long dispatches take: by the device's own clock where it has one, by the wall's where not; and how much work
//! fits a frame.

use gpu::{Gpu, wgpu};
use std::time::Instant;
use wgpu::BufferUsages;

/// The longest a dispatch should take, unless someone says otherwise: far below the seconds after which a driver gives
/// a device up.
pub const BUDGET_SECONDS: f64 = 0.05;

/// Samples of the first dispatch, when nothing is known about the device's speed.
const FIRST_SAMPLES: f64 = 4096.0;

/// How fast the device is, learned from dispatch to dispatch.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    samples_that_fit: f64,
}

impl Default for Pace {
    fn default() -> Self {
        Pace { samples_that_fit: FIRST_SAMPLES }
    }
}

impl Pace {
    /// Samples that fit into a budget.
    pub fn samples_that_fit(&self) -> f64 {
        self.samples_that_fit
    }

    /// Learns from a dispatch. Slower is believed at once, faster step by step: one part of a picture is not like
    /// another.
    pub fn learn(&mut self, samples: f64, seconds: f64, budget: f64) {
        // the rest at a picture's edge says little: a few threads take as long as many
        if samples < 0.5 * self.samples_that_fit && seconds <= budget {
            return;
        }
        let fit = samples * budget / seconds.max(1e-6);
        self.samples_that_fit = fit.clamp(1.0, 2.0 * self.samples_that_fit);
    }

    /// Something has changed that may make each sample take longer, though hardly several times as long.
    pub fn doubt(&mut self) {
        self.samples_that_fit = (self.samples_that_fit / 4.0).max(1.0);
    }
}

/// Times dispatches, two of which may be on their way.
#[derive(Debug)]
pub struct Stopwatch {
    clock: Option<DeviceClock>,
    last_end: Instant,
    /// Whether no pass of this series is done yet.
    first: bool,
    /// Whether the device's clock was ever off.
    doubted: bool,
}

#[derive(Debug)]
struct DeviceClock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    read: [wgpu::Buffer; 2],
    seconds_per_tick: f64,
}

/// A device's clock is doubted where the wall's says more than this many times as much. Some software devices answer
/// now and then that a pass ended before its work was done.
const DOUBT: f64 = 4.0;

/// Seconds beside a pass's own that the wall's clock may hold: submitting it, waking up after it.
const OVERHEAD: f64 = 0.01;

/// The same before the first pass of a series, whose film is on its way to the device.
const FIRST_OVERHEAD: f64 = 0.25;

/// Bytes of a begin and an end; queries are resolved at multiples of 256.
const PAIR: u64 = 16;

impl Stopwatch {
    /// A stopwatch for this device.
    pub fn new(gpu: &Gpu) -> Self {
        Stopwatch { clock: DeviceClock::new(gpu), last_end: Instant::now(), first: true, doubted: false }
    }

    /// Whether the device has a clock, and none of its times was doubted so far.
    pub fn is_exact(&self) -> bool {
        self.clock.is_some() && !self.doubted
    }

    /// What a compute pass writes when it begins and ends; `slot` 0 or 1.
    pub fn marks(&self, slot: usize) -> Option<wgpu::ComputePassTimestampWrites<'_>> {
        self.clock.as_ref().map(|clock| wgpu::ComputePassTimestampWrites {
            query_set: &clock.queries,
            beginning_of_pass_write_index: Some(2 * slot as u32),
            end_of_pass_write_index: Some(2 * slot as u32 + 1),
        })
    }

    /// Asks for the marks of a pass that was just encoded.
    pub fn collect(&self, encoder: &mut wgpu::CommandEncoder, slot: usize) {
        if let Some(clock) = &self.clock {
            let first = 2 * slot as u32;
            let at = 256 * slot as u64;
            encoder.resolve_query_set(&clock.queries, first..first + 2, &clock.resolved, at);
            encoder.copy_buffer_to_buffer(&clock.resolved, at, &clock.read[slot], 0, PAIR);
        }
    }

    /// To be called when the pass is submitted.
    pub fn submitted(&self, slot: usize) {
        if let Some(clock) = &self.clock {
            clock.read[slot].map_async(wgpu::MapMode::Read, .., |_| {});
        }
    }

    /// Seconds that the pass took, once it is done. Without a clock that is believed, since the pass before it was done.
    pub fn seconds(&mut self, slot: usize) -> f64 {
        let now = Instant::now();
        let wall = now.duration_since(self.last_end).as_secs_f64();
        self.last_end = now;
        let device = self.clock.as_ref().and_then(|clock| clock.seconds(slot));
        self.settled(device, wall)
    }

    /// What the device's clock says, unless the wall's says far more.
    fn settled(&mut self, device: Option<f64>, wall: f64) -> f64 {
        let overhead = if std::mem::take(&mut self.first) { FIRST_OVERHEAD } else { OVERHEAD };
        let Some(device) = device else { return wall };
        let believed = wall <= DOUBT * device + overhead;
        self.doubted |= !believed;
        if believed { device } else { wall }
    }

    /// Begins a series of passes: what came before does not count.
    pub fn restart(&mut self) {
        (self.last_end, self.first) = (Instant::now(), true);
    }
}

impl DeviceClock {
    fn new(gpu: &Gpu) -> Option<Self> {
        if !gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return None;
        }
        let buffer = |size, usage| {
            let descriptor = wgpu::BufferDescriptor { label: Some("times"), size, usage, mapped_at_creation: false };
            gpu.device.create_buffer(&descriptor)
        };
        let read = || buffer(PAIR, BufferUsages::COPY_DST | BufferUsages::MAP_READ);
        let clock = gpu.checked("a clock", || DeviceClock {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: 4,
            }),
            resolved: buffer(512, BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC),
            read: [read(), read()],
            seconds_per_tick: f64::from(gpu.queue.get_timestamp_period()) * 1e-9,
        });
        // a device that refuses is timed by the wall
        clock.ok().filter(|clock| clock.seconds_per_tick > 0.0)
    }

    fn seconds(&self, slot: usize) -> Option<f64> {
        let ticks = self.read[slot].get_mapped_range(..).ok().map(|bytes| {
            let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
            ticks[1].wrapping_sub(ticks[0])
        });
        self.read[slot].unmap();
        // some drivers answer with zeros, or with times before the beginning
        ticks.map(|ticks| ticks as f64 * self.seconds_per_tick).filter(|s| *s > 0.0 && *s < 100.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slowness_is_believed_at_once_and_speed_step_by_step() {
        let mut pace = Pace::default();
        let first = pace.samples_that_fit();
        pace.learn(first, 1e-5, 0.05);
        assert_eq!(pace.samples_that_fit(), 2.0 * first);
        pace.learn(pace.samples_that_fit(), 5.0, 0.05);
        assert!((pace.samples_that_fit() - 0.02 * first).abs() < 1e-6 * first);
        // a small rest that fits says nothing
        let before = pace.samples_that_fit();
        pace.learn(0.1 * before, 0.049, 0.05);
        assert_eq!(pace.samples_that_fit(), before);
        // never less than a sample, or nothing would ever be done
        pace.learn(1.0, 5.0, 0.05);
        assert_eq!(pace.samples_that_fit(), 1.0);
    }

    #[test]
    fn a_device_that_says_less_than_the_wall_allows_is_not_believed() {
        let begun = || Stopwatch { clock: None, last_end: Instant::now(), first: false, doubted: false };
        // as once of llvmpipe: two million samples in a third of a millisecond, of two seconds by the wall
        for (device, wall, expected) in [
            (Some(3.6e-4), 2.0, 2.0),
            (Some(0.05), 0.3, 0.3),
            (Some(0.05), 0.06, 0.05),
            (Some(0.05), 0.04, 0.05),
            (Some(1e-5), 5e-3, 1e-5),
            (None, 0.02, 0.02),
        ] {
            let mut stopwatch = begun();
            assert_eq!(stopwatch.settled(device, wall), expected, "{device:?} {wall}");
            assert_eq!(stopwatch.doubted, device.is_some_and(|device| device != expected), "{device:?} {wall}");
        }
        let mut first = Stopwatch { first: true, ..begun() };
        assert_eq!(first.settled(Some(1e-4), 0.2), 1e-4, "a film was on its way");
        assert_eq!(first.settled(Some(1e-4), 0.2), 0.2, "now none is");
        assert_eq!(first.settled(Some(0.1), 0.1), 0.1, "a later time is believed again");
        assert!(first.doubted, "and what was off stays known");
    }
}
