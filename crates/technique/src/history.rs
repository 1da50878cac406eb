//! What earlier views showed, put together with the picture in hand while the camera moves ([`mod@denoise::temporal`]).
//!
//! The first picture of a view that was moved to is not of its film: it has random numbers of its own. Pixels at rest, such as
//! those about which an orbit turns, would have the noise of the view before in each film, and no mean takes that away.

use crate::denoiser::{luminance_variance, variances};
use crate::patience::Patient;
use crate::{Accumulation, DenoiseSettings, Filters, Frame, Rank, Renderer, Request, Watch};
use denoise::temporal::{Accumulated, History, Now, Reuse, accumulate, fade};
use denoise::{DenoiseError, Stop};
use film::{Features, Film, Image, Layer, LayerValues};
use scene::Camera;
use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The layer that tells how old each pixel's light is, in seconds: the mean over its samples, of which those of the picture
/// itself are of now.
pub const LAG: &str = "lag";

/// Time that the samples of the first picture of another view may take: with features, reprojection and the window it is on the
/// screen about a tenth of a second after the mouse.
const MOVING: Duration = Duration::from_millis(50);

/// Time that it may go on after a newer request came: else a drag would never show anything.
const GRACE: Duration = Duration::from_millis(250);

/// Most samples of it.
const MOST_SAMPLES: u32 = 16;

/// A picture in which earlier views count.
#[derive(Debug, Clone)]
pub struct Reused {
    /// Linear radiance, before any other filter.
    pub image: Image,
    /// How much of it is of earlier views.
    pub lag: Lag,
    /// Seconds that putting both together took.
    pub seconds: f64,
    /// Of each pixel, as in [`LAG`].
    age: Arc<[f32]>,
    /// As how many samples earlier views count in each pixel.
    earlier: Vec<f32>,
}

/// What a picture has of earlier views.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag {
    /// Samples of a pixel, the mean over the picture.
    pub samples: f32,
    /// Their mean age in seconds.
    pub seconds: f32,
}

impl fmt::Display for Lag {
    /// "30 spp of earlier views, 0.4 s old".
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let decimals = usize::from(self.samples < 9.95);
        write!(f, "{:.decimals$} spp of earlier views, {:.1} s old", self.samples, self.seconds)
    }
}

/// What a pane showed.
#[derive(Default)]
pub(crate) struct Past {
    /// The picture in hand.
    request: Option<Request>,
    /// The last that was shown of another view.
    earlier: Option<Shown>,
    /// The last that was shown of this view.
    latest: Option<Shown>,
    /// Counts the views so far: each has random numbers of its own.
    views: u32,
    /// Seconds that the denoiser took of a pixel.
    filter: f64,
}

struct Shown {
    history: History,
    at: Instant,
    pixels: usize,
    /// How many samples all its pixels stand for.
    samples: f64,
    /// Share of its pixels that the view before it showed.
    overlap: f64,
    /// Whether it is the first picture of a view that was moved to.
    of_a_move: bool,
}

impl Shown {
    /// Whether the view `before` tells the next one more, where earlier views count as `limit` samples at most: a coarse picture
    /// stands for few, and what it was put together with is found again as well from two views on.
    fn is_worth_less_than(&self, before: &Shown, limit: u32) -> bool {
        let counting = before.samples.min(before.pixels as f64 * f64::from(limit));
        self.of_a_move && self.pixels < before.pixels && self.samples < self.overlap * counting
    }
}

impl Past {
    /// Goes on with this picture, for which earlier views count as `limit` samples at most: they do where nothing but the
    /// camera, or the picture's size, is another one.
    pub(crate) fn turn_to(&mut self, request: &Request, limit: u32) {
        if limit == 0 {
            *self = Past::default();
        } else if !self.request.as_ref().is_some_and(|before| before.is_same_picture(request)) {
            let moved = self.request.as_ref().is_some_and(|before| before.is_of_another_camera(request));
            let earlier = self.take_earlier(limit).filter(|_| moved);
            let (views, request) = (self.views.wrapping_add(1), Some(request.clone()));
            *self = Past { request, earlier, latest: None, views, filter: self.filter };
        }
    }

    /// What the next view has as its history: a view that showed nothing, or little, was only passed by.
    fn take_earlier(&mut self, limit: u32) -> Option<Shown> {
        let (latest, before) = (self.latest.take(), self.earlier.take());
        match (&latest, &before) {
            (Some(latest), Some(known)) if latest.is_worth_less_than(known, limit) => before,
            _ => latest.or(before),
        }
    }

    /// Takes what is shown as the next view's history. A film begins with the random numbers of the film before; until it has
    /// more samples than what was shown of a move stands for, that has less noise in common with the film to come.
    fn keep(&mut self, shown: Shown, own_samples: f64) {
        let kept = self.latest.as_ref().filter(|latest| latest.of_a_move);
        if shown.of_a_move || kept.is_none_or(|kept| own_samples >= kept.samples) {
            self.latest = Some(shown);
        }
    }

    /// Remembers how long a denoiser takes.
    pub(crate) fn note_filter(&mut self, seconds: f64, film: &Film) {
        self.filter = seconds / film.pixels().len().max(1) as f64;
    }
}

impl Request {
    /// Whether two requests differ in camera and size alone, and in the wished number of samples.
    fn is_of_another_camera(&self, other: &Request) -> bool {
        let mut moved = self.clone();
        (moved.shot.camera, moved.shot.size) = (other.shot.camera, other.shot.size);
        moved.is_same_picture(other)
    }
}

impl Reused {
    fn new(Accumulated { image, earlier, age }: Accumulated, samples: &[u32], seconds: f64) -> Self {
        let all: f64 = earlier.iter().map(|earlier| f64::from(*earlier)).sum();
        let light = |((age, own), earlier): ((&f32, &u32), &f32)| f64::from(age * (*own as f32 + earlier));
        let ages: f64 = age.iter().zip(samples).zip(&earlier).map(light).sum();
        let seconds_old = if all > 0.0 { (ages / all) as f32 } else { 0.0 };
        let lag = Lag { samples: (all / earlier.len().max(1) as f64) as f32, seconds: seconds_old };
        Reused { image, lag, seconds, age: age.into(), earlier }
    }

    /// Share of its pixels for which there was something.
    fn overlap(&self) -> f64 {
        let found = self.earlier.iter().filter(|earlier| **earlier > 0.0).count();
        found as f64 / self.earlier.len().max(1) as f64
    }

    /// The age of each pixel's light, as the layer [`LAG`].
    pub fn layer(&self) -> Layer {
        Layer { name: LAG, values: LayerValues::Numbers(self.age.clone()) }
    }

    /// What a denoiser makes of it, which has less noise than its film by all that earlier views count.
    pub(crate) fn denoised(
        &self,
        film: &Film,
        settings: DenoiseSettings,
        features: &Features,
        filters: &Filters,
        stop: Stop,
    ) -> Result<Image, DenoiseError> {
        let share = film.pixels().iter().zip(&self.earlier).map(|(pixel, earlier)| {
            let own = pixel.samples as f32;
            own / (own + earlier).max(f32::MIN_POSITIVE)
        });
        let variance = variances(film).map(luminance_variance).zip(share).map(|(variance, share)| variance * share);
        let variance: Option<Vec<f32>> = (film.samples_per_pixel() > 1).then(|| variance.collect());
        settings.denoiser.apply(&self.image, features, variance.as_deref(), filters, stop)
    }
}

/// At how many samples a picture takes nothing of earlier views any more: it needs none where it is twice as good as they may be,
/// and what is done is the mean of its own.
fn gone_at(limit: u32, wished: Option<u32>) -> u32 {
    limit.saturating_mul(2).min(wished.unwrap_or(u32::MAX))
}

impl Renderer {
    /// A film as it was last read together with earlier views, which count as `limit` samples at most; `None` where none do.
    /// The next view has this one as its history. It goes on to as many samples as are `wished` for, or is the first picture of a
    /// view that was moved to.
    ///
    /// # Errors
    /// [`DenoiseError::Stopped`] if `stop` said so, before or meanwhile.
    pub(crate) fn reuse(
        &mut self,
        accumulation: &Accumulation,
        camera: &Camera,
        (limit, wished): (u32, Option<u32>),
        stop: Stop,
    ) -> Result<Option<Reused>, DenoiseError> {
        if limit == 0 {
            return Ok(None);
        }
        let film = accumulation.film();
        let Some((_, features)) = &accumulation.features else {
            return if self.past.earlier.is_some() { Err(DenoiseError::Stopped) } else { Ok(None) };
        };
        let (image, samples) = (film.image(), film.pixels().iter().map(|pixel| pixel.samples).collect::<Vec<_>>());
        let frame = camera.frame(film.width() as f32 / film.height() as f32);
        let now = Now { frame, image: &image, samples: &samples, features };
        let begun = Instant::now();
        let until = gone_at(limit, wished);
        let counts = fade(film.samples_per_pixel(), until) > 0.0;
        if wished.is_some() && !counts {
            // nor does it come back where more samples are wished for then
            self.past.earlier = None;
        }
        let accumulated = match self.past.earlier.as_ref().filter(|_| counts) {
            Some(Shown { history, at, .. }) => {
                let reuse = Reuse { limit, until, elapsed: at.elapsed().as_secs_f32() };
                let put_together = || accumulate(&now, history, reuse, stop);
                let turn = self.threads.turn_unless(stop, self.rank, put_together);
                Some(turn.unwrap_or(Err(DenoiseError::Stopped))?)
            }
            None => None,
        };
        let history = now.history(accumulated.as_ref())?;
        let reused = accumulated.map(|both| Reused::new(both, &samples, begun.elapsed().as_secs_f64()));
        let (pixels, own) = (samples.len(), f64::from(film.samples_per_pixel()));
        let earlier = reused.as_ref().map_or(0.0, |reused| f64::from(reused.lag.samples));
        let (stands_for, overlap) = (pixels as f64 * (own + earlier), reused.as_ref().map_or(0.0, Reused::overlap));
        let (at, of_a_move) = (Instant::now(), wished.is_none());
        self.past.keep(Shown { history, at, pixels, samples: stands_for, overlap, of_a_move }, pixels as f64 * own);
        Ok(reused.filter(|reused| reused.lag.samples > 0.0))
    }

    /// Shows the first picture of a view that was moved to, of as many pixels as there is time for; `false` where there is
    /// nothing that it could be put together with.
    pub(crate) fn show_moved(&mut self, request: &Request, watch: &impl Watch) -> bool {
        let Request { shot, settings, .. } = request;
        let compiled = settings.feature.is_some() || self.backend().has_compiled(&settings.integrator);
        if self.past.earlier.is_none() || !compiled {
            return false;
        }
        let patient = Patient::until(watch, Instant::now() + GRACE);
        let (size, samples) = self.affordable(shot.size, settings.spp);
        let Some(mut accumulation) = Accumulation::blank(size) else { return false };
        let integrator = settings.integrator.with_seed(settings.integrator.seed().wrapping_add(self.past.views));
        self.rank = Rank::RoughPicture;
        let added = self.add(&mut accumulation, &shot.camera, &integrator, samples, &|| patient.ends_now());
        if added.is_err() || self.resolve(&mut accumulation).is_err() || accumulation.spp() == 0 {
            // a device that has failed leaves nothing, and the processor begins anew
            return patient.ends_now();
        }
        self.make_features(&mut accumulation, (&shot.camera, &integrator), false, &patient);
        let denoise = DenoiseSettings { denoiser: self.quick_denoiser(&accumulation, watch), ..watch.denoise() };
        self.show_together(&accumulation, &shot.camera, denoise, None, &patient);
        true
    }

    /// Size and samples for which there is time: of a coarser picture where there is none for one of all pixels.
    fn affordable(&self, (width, height): (u32, u32), most: u32) -> ((u32, u32), u32) {
        let size = |shrink: u32| (width.div_ceil(shrink), height.div_ceil(shrink));
        let fitting = |shrink: u32| {
            let (width, height) = size(shrink);
            MOVING.as_secs_f64() / self.forecast(f64::from(width) * f64::from(height))
        };
        let shrink = [1, 2, 4].into_iter().find(|shrink| fitting(*shrink) >= 1.0).unwrap_or(8);
        (size(shrink), (fitting(shrink) as u32).clamp(1, most.clamp(1, MOST_SAMPLES)))
    }

    /// The denoiser that is wished for, where it is done in time by what it took last.
    fn quick_denoiser(&self, accumulation: &Accumulation, watch: &impl Watch) -> crate::Denoiser {
        let pixels = accumulation.film().pixels().len() as f64;
        let in_time = self.past.filter > 0.0 && self.past.filter * pixels <= MOVING.as_secs_f64();
        if in_time { watch.denoise().denoiser } else { crate::Denoiser::Off }
    }

    /// Shows a film as it was last read, put together with earlier views and then denoised; not one that was stopped on the way. How
    /// many samples it goes on to is `wished`, as for [`Renderer::reuse`].
    pub(crate) fn show_together(
        &mut self,
        accumulation: &Accumulation,
        camera: &Camera,
        denoise: DenoiseSettings,
        wished: Option<u32>,
        watch: &impl Watch,
    ) {
        let stop = || watch.ends_now();
        let Ok(reused) = self.reuse(accumulation, camera, (denoise.history, wished), &stop) else { return };
        let denoised = self.denoised(accumulation, reused.as_ref(), denoise, &stop);
        if let Some(Ok(denoised)) = &denoised {
            self.past.note_filter(denoised.seconds, accumulation.film());
        }
        if accumulation.spp > 0 && !matches!(denoised, Some(Err(DenoiseError::Stopped))) {
            let state = [wished.is_none(), wished.is_none_or(|wished| accumulation.spp < wished)];
            watch.show(Frame { denoised, reused, ..self.frame(accumulation, state) });
        }
    }
}

#[cfg(test)]
mod tests;
