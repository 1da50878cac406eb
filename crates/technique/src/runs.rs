//! The mean of several pictures, of one seed after the other, each of which goes through the denoiser by itself. Their noise becomes
//! less, as one over the root of their number; what they have in common stays: the bias of the denoiser, or of chains of few
//! mutations. Seeds are as independent as pixels, for Sobol points too: each
//! scrambles them anew ([`pathtrace::sampling::sampler`]).

use crate::accumulation::copy_of;
use crate::denoiser::weight_of;
use crate::{Accumulation, DenoiseSettings, Denoised, Frame, Pacing, Rendered, Renderer, TRUST, TracedSettings, Watch};
use denoise::DenoiseError;
use film::{Features, Film, LayerValues};
use pathtrace::gpu::GpuTraceError;
use pathtrace::{Integrator, Stats};
use scene::Camera;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// Pictures that are done, as sums: two films, however many there are.
pub struct Runs {
    done: u32,
    /// Samples per pixel of each.
    spp: u32,
    denoise: DenoiseSettings,
    /// The samples of all.
    film: Film,
    /// Those of the first half of them, where parts are kept.
    half: Option<Film>,
    /// Each picture as a denoiser has left it is a sample of its pixels; sums are f64.
    denoised: Option<Film>,
    /// Sums of how far samples were trusted; empty where they were not.
    trust: Vec<f32>,
    filter_seconds: f64,
    /// What has filtered, one after the other.
    filter_makers: Vec<String>,
    /// Why the device has not, where it should.
    filter_refusal: Option<Arc<str>>,
    /// Why one was not denoised.
    fault: Option<DenoiseError>,
    /// What the pixels of the last one show.
    features: Option<Features>,
    stats: Stats,
    spent: Duration,
    makers: Vec<String>,
}

impl Runs {
    /// None so far, of pictures of so many samples; `None` if there is no memory for their sums.
    pub fn blank((width, height): (u32, u32), spp: u32, denoise: DenoiseSettings) -> Option<Self> {
        let denoised = if denoise.is_on() { Some(Film::try_new(width, height)?) } else { None };
        Some(Runs {
            done: 0,
            spp,
            denoise,
            film: Film::try_new(width, height)?,
            half: None,
            denoised,
            trust: Vec::new(),
            filter_seconds: 0.0,
            filter_makers: Vec::new(),
            filter_refusal: None,
            fault: None,
            features: None,
            stats: Stats::default(),
            spent: Duration::ZERO,
            makers: Vec::new(),
        })
    }

    /// How many are done.
    pub fn done(&self) -> u32 {
        self.done
    }

    /// Whether they are the first of those that are asked for.
    pub(crate) fn go_on_to(&self, settings: &TracedSettings) -> bool {
        (self.spp, self.denoise) == (settings.spp, settings.denoise) && self.done <= settings.runs
    }

    /// Takes one that is done, and leaves room for the next.
    fn add(&mut self, accumulation: &mut Accumulation, denoised: Option<Result<Denoised, DenoiseError>>) {
        self.film.add_all(accumulation.film());
        self.stats = self.stats.plus(accumulation.stats());
        self.spent += accumulation.spent();
        let maker = accumulation.made_by();
        if self.makers.last() != Some(&maker) {
            self.makers.push(maker);
        }
        self.features = accumulation.features.take().map(|(_, features)| features);
        match denoised {
            Some(Ok(denoised)) => self.add_denoised(&denoised),
            Some(Err(fault)) => self.fault = Some(fault),
            None => {}
        }
        self.done += 1;
        accumulation.clear();
    }

    fn add_denoised(&mut self, Denoised { image, seconds, made_by, refused }: &Denoised) {
        let pixels = self.denoised.iter_mut().flat_map(Film::pixels_mut);
        pixels.zip(image.radiances()).for_each(|(pixel, radiance)| pixel.add(*radiance));
        if let Some(LayerValues::Numbers(trust)) =
            image.layers.iter().find(|layer| layer.name == TRUST).map(|layer| &layer.values)
        {
            let room = trust.len().saturating_sub(self.trust.len());
            if self.trust.try_reserve_exact(room).is_err() {
                self.fault = Some(DenoiseError::Memory(size_of_val(&trust[..])));
                return;
            }
            self.trust.resize(trust.len(), 0.0);
            self.trust.iter_mut().zip(trust.iter()).for_each(|(sum, trust)| *sum += trust);
        }
        self.filter_seconds += seconds;
        if self.filter_makers.last() != Some(made_by) {
            self.filter_makers.push(made_by.clone());
        }
        self.filter_refusal = refused.clone().or(self.filter_refusal.take());
    }

    /// The mean of what a denoiser has made of each.
    fn denoised(&self) -> Option<Result<Denoised, DenoiseError>> {
        if let Some(fault) = &self.fault {
            return Some(Err(fault.clone()));
        }
        let mut image = self.denoised.as_ref()?.image();
        if !self.trust.is_empty() {
            let mean = self.trust.iter().map(|sum| sum / self.done.max(1) as f32).collect();
            image = image.with_layer(TRUST, LayerValues::Numbers(mean));
        }
        if self.denoise.shows_the_weight() {
            image = weight_of(&image);
        }
        let (seconds, made_by) = (self.filter_seconds, self.filter_makers.join(", then "));
        Some(Ok(Denoised { image, seconds, made_by, refused: self.filter_refusal.clone() }))
    }

    fn made_by(&self) -> String {
        self.makers.join(", then ")
    }

    /// The mean of those that are done, of so many that are wanted.
    fn frame(&self, renderer: &Renderer, wanted: u32) -> Frame<'_> {
        Frame {
            film: &self.film,
            runs: self.done,
            earlier: self.half.as_ref(),
            features: self.features.as_ref(),
            reused: None,
            denoised: self.denoised(),
            stats: self.stats,
            seconds: self.spent.as_secs_f64(),
            made_by: self.made_by(),
            device: renderer.device(),
            refused: renderer.refusal().cloned(),
            rough: false,
            coarse: false,
            unfinished: self.done < wanted,
        }
    }
}

impl Renderer {
    /// Goes on until so many are done, or as many as there is time for. One that was stopped in the middle is completed
    /// by the next call.
    pub(crate) fn refine_runs(
        &mut self,
        (accumulation, runs): (&mut Accumulation, &mut Runs),
        camera: &Camera,
        (integrator, wanted): (&Integrator, u32),
        watch: &impl Watch,
    ) {
        let mut shown = None::<Instant>;
        if runs.done > 0 {
            watch.show(runs.frame(self, wanted));
        }
        while runs.done < wanted {
            if runs.done > 0 && watch.is_held() {
                watch.show(runs.frame(self, wanted));
                watch.wait();
            }
            if runs.done > 0 && watch.ends_after_run() {
                break;
            }
            let integrator = integrator.with_seed(integrator.seed().wrapping_add(runs.done));
            if !self.add_run((accumulation, runs), camera, &integrator, watch) {
                break;
            }
            if runs.done == wanted / 2 && watch.keeps_parts() {
                runs.half = copy_of(&runs.film);
            }
            let is_due = |shown: Instant| shown.elapsed() >= watch.pacing(runs.spent).show;
            if runs.done == wanted || shown.is_none_or(is_due) {
                watch.show(runs.frame(self, wanted));
                shown = Some(Instant::now());
            }
        }
    }

    /// Adds a picture, if it is not stopped before its end.
    fn add_run(
        &mut self,
        (accumulation, runs): (&mut Accumulation, &mut Runs),
        camera: &Camera,
        integrator: &Integrator,
        watch: &impl Watch,
    ) -> bool {
        let of_run = OneOfSeveral::new(watch, runs, accumulation.spp);
        while accumulation.spp < runs.spp {
            self.refine(accumulation, camera, (integrator, runs.spp), &of_run);
            self.read(accumulation, &of_run);
            if watch.ends_now() || (accumulation.spp < runs.spp && of_run.ends_soon(accumulation.spp)) {
                return false;
            }
        }
        self.read(accumulation, &of_run);
        if runs.denoise.is_on() || watch.wants_features() {
            self.make_features(accumulation, (camera, integrator), true, watch);
        }
        let filter = if runs.fault.is_some() { DenoiseSettings::OFF } else { runs.denoise };
        let denoised = self.denoised(accumulation, None, filter, &|| watch.skips_filters());
        let is_whole = accumulation.spp >= runs.spp && !matches!(denoised, Some(Err(DenoiseError::Stopped)));
        if is_whole && !watch.ends_now() {
            runs.add(accumulation, denoised);
            return true;
        }
        false
    }

    /// Makes the mean of so many pictures from the beginning to the end, each as [`Renderer::finish`] makes one; where that is stopped
    /// it is the mean of those that are done. `accumulation` and `runs` are blank.
    pub fn finish_runs(
        &mut self,
        (mut accumulation, mut runs): (Accumulation, Runs),
        camera: &Camera,
        (integrator, wanted): (&Integrator, u32),
        watch: &impl Watch,
    ) -> Rendered {
        self.refine_runs((&mut accumulation, &mut runs), camera, (integrator, wanted), watch);
        if runs.done == 0 {
            return self.finish(accumulation, camera, (integrator, runs.spp), runs.denoise, watch);
        }
        let (denoised, made_by, device) = (runs.denoised(), runs.made_by(), self.device());
        let Runs { film, done: runs, half: earlier, features, stats, .. } = runs;
        Rendered { film, runs, earlier, features, denoised, stats, device, made_by }
    }
}

/// Watches one picture for who watches the mean: that is shown the first as it comes, and nothing of the others.
struct OneOfSeveral<'a, W> {
    watch: &'a W,
    /// Samples per pixel, and time, of those before.
    before: u32,
    spent: Duration,
    wished: u32,
    /// Samples per pixel that this one has.
    spp: AtomicU32,
}

impl<'a, W: Watch> OneOfSeveral<'a, W> {
    fn new(watch: &'a W, runs: &Runs, spp: u32) -> Self {
        let before = runs.spp.saturating_mul(runs.done);
        OneOfSeveral { watch, before, spent: runs.spent, wished: runs.spp, spp: spp.into() }
    }

    /// Once whole it is shown as a mean of one.
    fn is_shown(&self) -> bool {
        self.before == 0 && self.spp.load(Ordering::Relaxed) < self.wished
    }
}

impl<W: Watch> Watch for OneOfSeveral<'_, W> {
    fn ends_now(&self) -> bool {
        self.watch.ends_now()
    }

    fn ends_soon(&self, spp: u32) -> bool {
        self.watch.ends_soon(self.before.saturating_add(spp))
    }

    fn wants_features(&self) -> bool {
        self.is_shown() && self.watch.wants_features()
    }

    fn denoise(&self) -> DenoiseSettings {
        if self.is_shown() { self.watch.denoise() } else { DenoiseSettings::OFF }
    }

    fn skips_filters(&self) -> bool {
        self.watch.skips_filters()
    }

    fn keeps_parts(&self) -> bool {
        self.watch.keeps_parts()
    }

    fn is_held(&self) -> bool {
        self.watch.is_held()
    }

    fn wait(&self) {
        self.watch.wait();
    }

    fn pacing(&self, spent: Duration) -> Pacing {
        self.watch.pacing(self.spent + spent)
    }

    fn show(&self, frame: Frame) {
        if self.is_shown() {
            self.watch.show(Frame { unfinished: true, ..frame });
        }
    }

    fn count(&self, spp: u32) {
        self.spp.store(spp, Ordering::Relaxed);
        self.watch.count(self.before.saturating_add(spp));
    }

    fn told_of_loss(&self, fault: &GpuTraceError, spp: u32) {
        self.watch.told_of_loss(fault, self.before.saturating_add(spp));
    }
}

#[cfg(test)]
mod tests;
