//! A film on its way: what is in it, what a device has added to it meanwhile, and who has.

use denoise::DenoiseError;
use film::{Features, Film, Pixel};
use gpu::Gpu;
use pathtrace::gpu::{GpuFilm, GpuTraceError, GpuTracer};
use pathtrace::{FeatureFilm, Stats};
use std::time::Duration;

/// A film, and what a device has added to it.
pub struct Accumulation {
    /// The film as last read. Its pixels count the samples that are left out, too.
    pub(crate) film: Film,
    /// Samples of each pixel that are left out, before the first.
    left_out: u32,
    pub(crate) stats: Stats,
    /// Samples that every pixel has, on the device too.
    pub(crate) spp: u32,
    /// Samples that a pixel may have at most: a pass that was stopped leaves some with more than others.
    pub(crate) most: u32,
    pub(crate) spent: Duration,
    on_device: Option<OnDevice>,
    /// What it was before, for who keeps that.
    earlier: Option<EarlierStates>,
    /// What its pixels show, and from how many samples of them that was made.
    pub(crate) features: Option<(u32, Features)>,
    /// Why that was not made.
    pub(crate) features_fault: Option<DenoiseError>,
    /// The samples of a film that shows them in place of light.
    pub(crate) feature_film: Option<FeatureFilm>,
    /// What has added to it, one after the other.
    makers: Vec<String>,
    /// How many of them have added to the film as last read.
    resolved_by: usize,
}

/// A film when it had fewer samples.
struct EarlierStates {
    /// The latest that had at most half of the samples that there are.
    half: Option<Film>,
    /// The one that takes its place once there are twice its samples.
    next: Film,
}

struct OnDevice {
    film: GpuFilm,
    /// What the film had taken before it came to the device.
    before: Stats,
    /// Whether something was added since it was last read.
    has_more: bool,
}

impl Accumulation {
    /// A film without light; `None` if there is no memory for it.
    pub fn blank((width, height): (u32, u32)) -> Option<Self> {
        Film::try_new(width, height).map(Accumulation::of)
    }

    /// A film without light, whose first sample will be the one of this number: what comes before is somebody else's. Until it is
    /// [finished](crate::Renderer::finish) it is not to be looked at.
    pub fn beginning_at(first: u32, size: (u32, u32)) -> Option<Self> {
        let mut blank = Accumulation::blank(size)?;
        blank.film.pixels_mut().iter_mut().for_each(|pixel| pixel.samples = first);
        Some(Accumulation { left_out: first, ..blank })
    }

    fn of(film: Film) -> Self {
        Accumulation {
            film,
            left_out: 0,
            stats: Stats::default(),
            spp: 0,
            most: 0,
            spent: Duration::ZERO,
            on_device: None,
            earlier: None,
            features: None,
            features_fault: None,
            feature_film: None,
            makers: Vec::new(),
            resolved_by: 0,
        }
    }

    /// Begins another picture of the same size.
    pub fn clear(&mut self) {
        let mut film = std::mem::replace(&mut self.film, Film::new(0, 0));
        film.pixels_mut().fill(Pixel::default());
        film.nonfinite = 0;
        *self = Accumulation::of(film);
    }

    /// The film as last read.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// The film as last read, alone.
    pub fn into_film(self) -> Film {
        self.film
    }

    /// What the film took, as last read.
    pub fn stats(&self) -> Stats {
        self.stats
    }

    /// Samples that every pixel has, on the device too.
    pub fn spp(&self) -> u32 {
        self.spp
    }

    /// Of as many samples a pixel, the number behind the last.
    pub(crate) fn end_of(&self, samples: u32) -> u32 {
        self.left_out.saturating_add(samples)
    }

    /// Takes what is left out off the counts of all pixels, once nothing is added any more.
    pub(crate) fn count_its_own(&mut self) {
        let left_out = std::mem::take(&mut self.left_out);
        let earlier = self.earlier.iter_mut().flat_map(|earlier| earlier.half.iter_mut().chain([&mut earlier.next]));
        for pixel in earlier.chain([&mut self.film]).flat_map(Film::pixels_mut) {
            pixel.samples -= left_out;
        }
    }

    /// Samples that a pixel may have at most.
    pub fn most(&self) -> u32 {
        self.most
    }

    /// Time that tracing has taken, without building the scene.
    pub fn spent(&self) -> Duration {
        self.spent
    }

    /// What has made it: an adapter's name, or how many threads; both where one took over.
    pub fn made_by(&self) -> String {
        self.makers.join(", then ")
    }

    /// Goes on from the film as last read.
    pub fn forget_the_device(&mut self) {
        self.makers.truncate(self.resolved_by);
        if self.on_device.take().is_some() {
            self.spp = self.own(self.film.samples_per_pixel());
        }
    }

    /// Of the samples that a pixel counts, those that are not left out.
    pub(crate) fn own(&self, counted: u32) -> u32 {
        counted - self.left_out
    }

    /// Whether this is the `half` that shall be the earlier part, or there are twice as many samples as when it was last kept for
    /// being that; where the parts meet at a number of their own, whether it is that or the end.
    pub(crate) fn is_to_be_kept(&self, half: u32, (meet_at, wished): (Option<u32>, u32)) -> bool {
        let of = |earlier: &EarlierStates| self.own(earlier.next.samples_per_pixel());
        let doubled = || self.earlier.as_ref().is_none_or(|earlier| self.spp / 2 >= of(earlier));
        match meet_at {
            Some(meet_at) => [meet_at, wished].contains(&self.spp),
            None => self.spp == half || doubled(),
        }
    }

    /// Keeps the film as last read, if there is memory for one more.
    pub(crate) fn keep(&mut self) {
        let Some(next) = copy_of(&self.film) else { return };
        let half = self.earlier.take().map(|earlier| earlier.next);
        self.earlier = Some(EarlierStates { half, next });
    }

    /// The film when it had half of its samples, or somewhat fewer, where that was kept.
    pub(crate) fn earlier_part(&self) -> Option<&Film> {
        self.earlier.as_ref()?.half.as_ref()
    }

    /// Takes that film, and forgets the other states.
    pub(crate) fn take_earlier_part(&mut self) -> Option<Film> {
        self.earlier.take()?.half
    }

    /// Someone adds up to so many samples.
    pub(crate) fn begin_pass(&mut self, maker: String, until: u32) {
        self.most = self.most.max(until);
        if self.makers.last() != Some(&maker) {
            self.makers.push(maker);
        }
    }

    /// The film holds all that was added.
    pub(crate) fn is_read(&mut self) {
        self.resolved_by = self.makers.len();
    }

    /// The film on the device to add to, brought there if it is not.
    pub(crate) fn on_device(&mut self, tracer: &GpuTracer) -> Result<&mut GpuFilm, GpuTraceError> {
        let on_device = match self.on_device.take() {
            Some(on_device) => on_device,
            None => OnDevice { film: tracer.film(self.film.clone())?, before: self.stats, has_more: false },
        };
        let on_device = self.on_device.insert(on_device);
        on_device.has_more = true;
        Ok(&mut on_device.film)
    }

    /// Brings what the device has added into the film.
    pub(crate) fn read(&mut self, gpu: &Gpu) -> Result<(), GpuTraceError> {
        if let Some(OnDevice { film, before, has_more: has_more @ true }) = &mut self.on_device {
            let (read, stats) = film.read(gpu)?;
            *has_more = false;
            (self.film, self.stats) = (read, before.plus(stats));
            self.is_read();
        }
        Ok(())
    }
}

/// `None` if there is no memory for it.
pub(crate) fn copy_of(film: &Film) -> Option<Film> {
    let mut copy = Film::try_new(film.width(), film.height())?;
    copy.pixels_mut().copy_from_slice(film.pixels());
    copy.nonfinite = film.nonfinite;
    Some(copy)
}

#[cfg(test)]
mod tests;
