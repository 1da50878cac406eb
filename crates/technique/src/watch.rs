//! Who has asked for a picture, and what they are shown.

use crate::{DenoiseSettings, Denoised, Device, Reused, TreeProgress};
use denoise::DenoiseError;
use film::{Features, Film};
use pathtrace::Stats;
use pathtrace::gpu::GpuTraceError;
use std::sync::Arc;
use std::time::Duration;

/// How long things may take from one look at a picture to the next.
#[derive(Debug, Clone, Copy)]
pub struct Pacing {
    /// The time that one pass should take.
    pub pass: Duration,
    /// A film is read from the device, and shown, after this.
    pub show: Duration,
    /// A pass adds at most this many times the samples that are there.
    pub growth: u32,
}

/// A picture as far as it is made.
pub struct Frame<'a> {
    /// Samples summed so far, pixel by pixel.
    pub film: &'a Film,
    /// Pictures of which it is the mean, each of as many samples.
    pub runs: u32,
    /// The film when it had half of its samples or fewer, where [`Watch::keeps_parts`].
    pub earlier: Option<&'a Film>,
    /// What the pixels show, where [`Watch::wants_features`]; of a rough picture it is not made.
    pub features: Option<&'a Features>,
    /// The film put together with earlier views, where they count.
    pub reused: Option<Reused>,
    /// The film as the denoiser that [`Watch::denoise`] asks for leaves it, or why there is no memory for that.
    pub denoised: Option<Result<Denoised, DenoiseError>>,
    /// Samples and rays that it took so far.
    pub stats: Stats,
    /// Seconds that tracing has taken so far.
    pub seconds: f64,
    /// Names of what has made it.
    pub made_by: String,
    /// The device that traces now: after a loss the processor.
    pub device: Device,
    /// Why the graphics device does not, where it should: one line.
    pub refused: Option<Arc<str>>,
    /// Whether this is a rough picture at a lower resolution.
    pub rough: bool,
    /// Whether coarse meshes stand for those whose trees are not there yet; then it is rough too.
    pub coarse: bool,
    /// Whether more of it will come.
    pub unfinished: bool,
}

/// Who has asked for a picture: says how it goes on, and is shown what there is.
pub trait Watch: Sync {
    /// Whether to end at once, in the middle of a pass. Every thread asks this before every segment of a path.
    fn ends_now(&self) -> bool {
        false
    }

    /// Whether to end after the pass in hand, where every pixel has `spp` samples.
    fn ends_soon(&self, spp: u32) -> bool;

    /// Whether frames shall come with what denoisers are guided by.
    fn wants_features(&self) -> bool {
        self.denoise().wants_features()
    }

    /// What frames shall go through before they are shown.
    fn denoise(&self) -> DenoiseSettings {
        DenoiseSettings::OFF
    }

    /// Whether to end where one of several runs is done.
    fn ends_after_run(&self) -> bool {
        self.ends_soon(1)
    }

    /// Whether a filter in hand is to end, and the picture to go without it.
    fn skips_filters(&self) -> bool {
        self.ends_now()
    }

    /// Whether a film of half of the samples is kept, or of somewhat fewer, by which a denoiser is judged.
    fn keeps_parts(&self) -> bool {
        self.denoise().trusts()
    }

    /// After how many samples the parts meet, where that is not the half: as those of a picture that is made again.
    fn parts_meet_at(&self) -> Option<u32> {
        None
    }

    /// Whether to wait where the film is.
    fn is_held(&self) -> bool {
        false
    }

    /// Waits until it is held no more, or ends.
    fn wait(&self) {}

    /// How long the next pass may take, after so much time of tracing.
    fn pacing(&self, spent: Duration) -> Pacing;

    /// Shows the mean of the passes so far.
    fn show(&self, frame: Frame);

    /// The trees of large meshes are so far, without which there is no picture; `None` once they are done, or given up.
    fn waits_for_trees(&self, _trees: Option<TreeProgress>) {}

    /// A pass is done: every pixel has `spp` samples.
    fn count(&self, _spp: u32) {}

    /// The graphics device has failed, and the processor goes on from `spp` samples.
    fn told_of_loss(&self, _fault: &GpuTraceError, _spp: u32) {}
}
