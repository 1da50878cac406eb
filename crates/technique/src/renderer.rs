//! Adding samples to a film, pass by pass, until there are as many as are wanted. A graphics device that fails is
//! replaced by the processor, which goes on from the film as it was last read; nowhere else is the loss of a device that
//! traces rays dealt with.

use crate::history::Past;
use crate::speeds::Speeds;
use crate::{Accumulation, Backend, DenoiseSettings, Denoised, Device, Frame, Pacing, Rank, Threads, Watch, features};
use denoise::DenoiseError;
use film::{Feature, Features, Film};
use pathtrace::gpu::GpuTraceError;
use pathtrace::{Integrator, Stats};
use scene::{Camera, Scene};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A scene on what traces it.
pub struct Renderer {
    pub(crate) scene: Arc<Scene>,
    pub(crate) backend: Backend,
    pub(crate) threads: Arc<Threads>,
    /// How urgent its passes are.
    pub rank: Rank,
    /// What of surfaces its films show, in place of the integrator's light.
    pub feature: Option<Feature>,
    pub(crate) past: Past,
    pub(crate) speeds: Speeds,
    /// Why the graphics device does not trace, where it should.
    refusal: Option<Arc<str>>,
}

impl Renderer {
    /// A scene on a backend that was made for it.
    pub fn new(scene: Arc<Scene>, backend: Backend, threads: Arc<Threads>) -> Self {
        let (rank, speeds) = (Rank::Refinement, Speeds::default());
        Renderer { scene, backend, threads, rank, feature: None, past: Past::default(), speeds, refusal: None }
    }

    /// A scene on the processor.
    pub fn on_the_processor(scene: Arc<Scene>, threads: Arc<Threads>) -> Self {
        let backend = threads.turn(Rank::Refinement, || Backend::on_the_processor(&scene));
        Renderer::new(scene, backend, threads)
    }

    /// The scene that is rendered, with its changes.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The device that traces now: after a loss the processor.
    pub fn device(&self) -> Device {
        self.backend.device()
    }

    /// The scene as it is ready.
    pub fn backend(&self) -> &Backend {
        &self.backend
    }

    /// Why the graphics device does not trace, where it should.
    pub fn refusal(&self) -> Option<&Arc<str>> {
        self.refusal.as_ref()
    }

    pub(crate) fn with_refusal(self, refusal: Option<Arc<str>>) -> Self {
        Renderer { refusal, ..self }
    }

    pub(crate) fn with_speeds(self, speeds: Speeds) -> Self {
        Renderer { speeds, ..self }
    }

    pub(crate) fn into_backend(self) -> Backend {
        self.backend
    }

    /// Whether it has this scene on this device.
    pub(crate) fn is_ready_for(&self, scene: &Arc<Scene>, device: Device, adapter: &str) -> bool {
        let same_adapter = self.backend.adapter().is_none_or(|own| own == adapter);
        Arc::ptr_eq(&self.scene, scene) && self.device() == device && same_adapter
    }

    /// Takes a film off the device, as far as that still gives it back.
    pub(crate) fn release(&self, accumulation: &mut Accumulation) {
        self.backend.release(accumulation);
    }

    /// Seconds that so many samples of one pixel take, by the speed of the last pass.
    pub fn forecast(&self, samples: f64) -> f64 {
        samples * self.speeds.of(self.device())
    }

    /// Adds `samples` to every pixel, unless `stop` says so. Where someone of a higher rank waits for the threads it
    /// returns as well, and the next pass completes this one.
    ///
    /// # Errors
    /// What has failed: the processor has taken over, and the film is as it was last read.
    pub fn add(
        &mut self,
        accumulation: &mut Accumulation,
        camera: &Camera,
        integrator: &Integrator,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Result<(), GpuTraceError> {
        let Renderer { backend, threads, rank, feature, .. } = self;
        let (threads, rank) = (&**threads, *rank);
        let on_device = backend.device() == Device::Gpu;
        let gives_up: &dyn Fn() -> bool = stop;
        let stop = || stop() || (!on_device && threads.are_wanted_by_more_than(rank));
        let mut timed = || {
            let start = Instant::now();
            let added = match feature {
                Some(feature) => accumulation.add_features(backend, (camera, integrator), (*feature, samples), &stop),
                None => backend.accumulate(accumulation, camera, integrator, samples, &stop),
            };
            (added, start.elapsed())
        };
        // what is no longer wanted while it waits for its turn has taken nothing
        let (added, spent) = if on_device {
            timed()
        } else {
            threads.turn_unless(gives_up, rank, timed).unwrap_or((Ok(0), Duration::ZERO))
        };
        accumulation.spent += spent;
        match added {
            Ok(taken) => {
                self.speeds.note(self.device(), taken, spent);
                Ok(())
            }
            Err(fault) => Err(self.replace(accumulation, fault)),
        }
    }

    /// Brings what the device has added into the film.
    ///
    /// # Errors
    /// As [`Renderer::add`].
    pub fn resolve(&mut self, accumulation: &mut Accumulation) -> Result<(), GpuTraceError> {
        self.backend.resolve(accumulation).map_err(|fault| self.replace(accumulation, fault))
    }

    /// The processor takes over from a device that has failed.
    pub(crate) fn replace(&mut self, accumulation: &mut Accumulation, fault: GpuTraceError) -> GpuTraceError {
        self.refusal = Some(fault.to_string().into());
        let processor = self.threads.turn(self.rank, || Backend::on_the_processor(&self.scene));
        std::mem::replace(&mut self.backend, processor).abandon(&fault);
        accumulation.forget_the_device();
        fault
    }

    /// Adds samples up to the wished number, or as many as there is time for. A pass that was stopped in the middle is
    /// completed by the next one.
    pub fn refine(
        &mut self,
        accumulation: &mut Accumulation,
        camera: &Camera,
        (integrator, wished): (&Integrator, u32),
        watch: &impl Watch,
    ) {
        let wished = if self.feature.is_some() { wished.min(features::MOST) } else { wished };
        let mut shown = Instant::now();
        // a film that goes on is shown at once, for its label says how far it shall go
        let how = (camera, integrator);
        if accumulation.spp > 0 {
            self.show(accumulation, how, wished, watch);
        }
        while accumulation.spp < wished {
            let before = accumulation.spp;
            // while held, a new picture still gets its first pass
            if before > 0 && watch.is_held() {
                self.show(accumulation, how, wished, watch);
                watch.wait();
            }
            if watch.ends_soon(accumulation.spp) {
                break;
            }
            let pacing = watch.pacing(accumulation.spent);
            let half = if watch.keeps_parts() { watch.parts_meet_at().unwrap_or(wished / 2) } else { wished };
            let until = if before < half { half } else { wished };
            let samples = self.samples_of_a_pass(accumulation, &pacing).min(until - before);
            self.rank = if before > 0 { Rank::Refinement } else { Rank::FirstPicture };
            if let Err(fault) = self.add(accumulation, camera, integrator, samples, &|| watch.ends_now()) {
                watch.told_of_loss(&fault, accumulation.spp);
            }
            if watch.ends_now() {
                break;
            }
            let spp = accumulation.spp;
            watch.count(spp);
            if spp > before && watch.keeps_parts() && accumulation.is_to_be_kept(half, (watch.parts_meet_at(), wished))
            {
                self.read(accumulation, watch);
                accumulation.keep();
            }
            // one part alone tells no weight
            let tells = !watch.denoise().shows_the_weight() || accumulation.earlier_part().is_some();
            if spp == wished || spp > 0 && tells && (before == 0 || shown.elapsed() >= pacing.show) {
                self.show(accumulation, how, wished, watch);
                shown = Instant::now();
            }
        }
    }

    /// As many as there is time for, but not many times what is there: the speed is a guess at first.
    fn samples_of_a_pass(&self, accumulation: &Accumulation, pacing: &Pacing) -> u32 {
        let pixels = accumulation.film().pixels().len() as f64;
        let fitting = (pacing.pass.as_secs_f64() / self.forecast(pixels)) as u32;
        fitting.clamp(1, accumulation.spp.saturating_mul(pacing.growth).max(1))
    }

    pub(crate) fn read(&mut self, accumulation: &mut Accumulation, watch: &impl Watch) {
        if let Err(fault) = self.resolve(accumulation) {
            watch.told_of_loss(&fault, accumulation.spp);
        }
    }

    fn show(&mut self, accumulation: &mut Accumulation, how: (&Camera, &Integrator), wished: u32, watch: &impl Watch) {
        self.read(accumulation, watch);
        if watch.wants_features() {
            self.make_features(accumulation, how, accumulation.spp >= wished, watch);
        }
        self.show_together(accumulation, how.0, watch.denoise(), Some(wished), watch);
    }

    /// A film as it was last read.
    pub(crate) fn frame<'a>(&self, accumulation: &'a Accumulation, [rough, unfinished]: [bool; 2]) -> Frame<'a> {
        Frame {
            film: accumulation.film(),
            runs: 1,
            earlier: accumulation.earlier_part(),
            features: accumulation.features.as_ref().map(|(_, features)| features),
            reused: None,
            denoised: None,
            stats: accumulation.stats(),
            seconds: accumulation.spent.as_secs_f64(),
            made_by: accumulation.made_by(),
            device: self.device(),
            refused: self.refusal.clone(),
            rough,
            coarse: false,
            unfinished,
        }
    }
}

/// A film that is done.
pub struct Rendered {
    /// Samples summed so far, pixel by pixel.
    pub film: Film,
    /// Pictures of which it is the mean, each of as many samples.
    pub runs: u32,
    /// The film when it had half of its samples or fewer, where [`Watch::keeps_parts`] and there was memory for it.
    pub earlier: Option<Film>,
    /// What the pixels show, where it was asked for.
    pub features: Option<Features>,
    /// The film as a denoiser leaves it, where one was asked for, or why there is no memory for that.
    pub denoised: Option<Result<Denoised, DenoiseError>>,
    /// Rays and samples that it took.
    pub stats: Stats,
    /// What it was made by in the end.
    pub device: Device,
    /// Names of all that has made it.
    pub made_by: String,
}

impl Renderer {
    /// Makes a picture from the beginning to the end, wherever it was made in the end: what a device loses is made again,
    /// unless it is too late; then it goes through a denoiser. `accumulation` is blank.
    pub fn finish(
        &mut self,
        mut accumulation: Accumulation,
        camera: &Camera,
        wanted: (&Integrator, u32),
        denoise: DenoiseSettings,
        watch: &impl Watch,
    ) -> Rendered {
        loop {
            self.refine(&mut accumulation, camera, wanted, watch);
            match self.resolve(&mut accumulation) {
                Ok(()) => break,
                Err(fault) => watch.told_of_loss(&fault, accumulation.spp),
            }
            if watch.ends_soon(accumulation.spp) {
                break;
            }
        }
        accumulation.count_its_own();
        // a device that is lost only now has made it all the same
        let (device, made_by) = (self.device(), accumulation.made_by());
        if denoise.is_on() || watch.wants_features() {
            self.make_features(&mut accumulation, (camera, wanted.0), true, watch);
        }
        let denoised = self.denoised(&accumulation, None, denoise, &|| watch.skips_filters());
        let features = accumulation.features.take().map(|(_, features)| features);
        let (stats, earlier) = (accumulation.stats(), accumulation.take_earlier_part());
        Rendered { stats, film: accumulation.into_film(), runs: 1, earlier, features, denoised, device, made_by }
    }
}
