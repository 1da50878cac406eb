//! One tile: the picture that `visavis render` makes of the same settings, with as many samples or for as long
//! as the sweep says.

use crate::model::{TileErrors, TileFacts};
use crate::ruler::ReferenceImage;
use compare::{CompareError, ErrorMetric, finite_mean};
use film::{DisplayTransform, Film, Image};
use gpu::Gpu;
use raster::Raster;
use scene::Scene;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use technique::{
    Accumulation, Backend, DenoiseSettings, Denoised, Device, FakeSettings, Frame, Pacing, PaneSettings, Provenance,
    Rendered, Renderer, Runs, Shot, Technique, Threads, TracedSettings, Watch,
};

/// A tile's picture, and what makes it again.
#[derive(Debug, Clone)]
pub struct Tile {
    /// Its pixels, in linear radiance.
    pub image: Image,
    /// What was found out while it was made, but for its errors.
    pub facts: TileFacts,
    /// What it depends on.
    pub provenance: Provenance,
    /// Samples per pixel of one run; 1 of what does not sample.
    pub spp: u32,
    /// What made it: a device's name, or a number of threads.
    pub made_by: String,
}

impl Tile {
    /// A tile of which there is no picture: one black pixel stands for it.
    pub fn without_light(facts: TileFacts, provenance: Provenance) -> Self {
        let image = Film::new(1, 1).image();
        Tile { image, facts, provenance, spp: 1, made_by: String::new() }
    }

    /// The command that makes it as a picture of its own.
    pub fn command(&self, exposure: f32) -> String {
        self.provenance.command(self.spp, exposure, "tile.png")
    }
}

/// Who waits for tiles.
pub trait Onlooker: Sync {
    /// Whether to end in the middle of a pass.
    fn ends_now(&self) -> bool;

    /// Whether to wait where the picture is.
    fn is_held(&self) -> bool {
        false
    }

    /// Waits until it is held no more, or ends.
    fn wait(&self) {}

    /// Is shown a picture on its way.
    fn see(&self, _tile: Tile) {}
}

/// Readies a scene for rays where its settings say, for so many samples; or the processor, and why.
pub type Ready = Box<dyn FnMut(&TracedSettings, &Scene, u64) -> anyhow::Result<(Backend, Option<String>)> + Send>;

/// What tiles are made by.
pub struct Devices {
    /// What rays are traced on beside a device.
    pub threads: Arc<Threads>,
    /// Opens what draws the fake.
    pub open_gpu: Box<dyn FnMut() -> anyhow::Result<Gpu> + Send>,
    /// Opens what traces rays.
    pub ready: Ready,
}

/// Makes one tile after the other, and keeps what is ready from one to the next.
pub struct TileMaker {
    devices: Devices,
    /// What draws the fake.
    raster: Option<(Gpu, Raster)>,
    /// The scene of the last tile, where it was asked for, and why not there.
    renderer: Option<(Renderer, TracedSettings, Option<String>)>,
}

/// A picture to make.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// Scene, camera and size of it.
    pub shot: &'a Shot,
    /// How it is made.
    pub pane: &'a PaneSettings,
    /// How long rays are traced; `None` for as many samples as the settings say.
    pub limit: Option<Duration>,
}

impl Asked<'_> {
    /// `u32::MAX` where the time alone decides, which it does not within one of several runs.
    fn spp(&self, traced: &TracedSettings) -> u32 {
        if self.limit.is_some() && traced.runs == 1 { u32::MAX } else { traced.spp }
    }
}

impl TileMaker {
    /// One that has made nothing yet.
    pub fn new(devices: Devices) -> Self {
        TileMaker { devices, raster: None, renderer: None }
    }

    /// A first picture of a tile, one sample of each pixel, and the film to go on with; `None` of what is made at once
    /// or in several runs.
    ///
    /// # Errors
    /// Why there is none: one line.
    pub fn begin(&mut self, asked: Asked, onlooker: &impl Onlooker) -> anyhow::Result<Option<Accumulation>> {
        let Technique::Traced(traced) = asked.pane.in_use() else { return Ok(None) };
        if asked.pane.in_use().runs() > 1 {
            return Ok(None);
        }
        let mut film = blank(asked.shot.size)?;
        let why = self.make_ready(asked, &traced)?;
        let Some((renderer, ..)) = &mut self.renderer else { return Ok(None) };
        let watch = TileWatch { most: 1, ..TileWatch::of(asked, why, onlooker) };
        renderer.refine(&mut film, &asked.shot.camera, (&traced.integrator, asked.spp(&traced)), &watch);
        Ok(Some(film))
    }

    /// The whole picture, beginning with a film of [`TileMaker::begin`] if there is one. What `onlooker` ends is as
    /// far as it came.
    ///
    /// # Errors
    /// Why there is none: one line.
    pub fn finish(
        &mut self,
        asked: Asked,
        begun: Option<Accumulation>,
        onlooker: &impl Onlooker,
    ) -> anyhow::Result<Tile> {
        match asked.pane.in_use() {
            Technique::Fake(fake) => self.draw(asked, fake),
            Technique::Traced(traced) => self.trace(asked, &traced, begun, onlooker),
        }
    }

    fn trace(
        &mut self,
        asked: Asked,
        traced: &TracedSettings,
        begun: Option<Accumulation>,
        onlooker: &impl Onlooker,
    ) -> anyhow::Result<Tile> {
        let technique = asked.pane.in_use();
        let (denoise, runs, spp) = (technique.denoise(), technique.runs(), asked.spp(traced));
        let film = begun.map_or_else(|| blank(asked.shot.size), Ok)?;
        let of_runs = (runs > 1).then(|| Runs::blank(asked.shot.size, spp, denoise).ok_or_else(no_memory));
        let of_runs = of_runs.transpose()?;
        let why = self.make_ready(asked, traced)?;
        let Some((renderer, ..)) = &mut self.renderer else { anyhow::bail!("no renderer is ready") };
        let watch = TileWatch::of(asked, why, onlooker);
        let (camera, integrator) = (&asked.shot.camera, &traced.integrator);
        let rendered = match of_runs {
            Some(of_runs) => renderer.finish_runs((film, of_runs), camera, (integrator, runs), &watch),
            None => renderer.finish(film, camera, (integrator, spp), denoise, &watch),
        };
        let refused = renderer.refusal().map(ToString::to_string);
        let seconds = watch.spent().as_secs_f64();
        let fault = rendered
            .denoised
            .as_ref()
            .and_then(|denoised| denoised.as_ref().err())
            .map(|fault| format!("not denoised: {fault}"));
        Ok(TileWatch { refused: watch.refused.clone().or(refused).or(fault), ..watch }.tile_of(rendered, seconds))
    }

    /// Readies the scene as these rays see it, unless the last tile's serves. Returns why not where it was asked for.
    fn make_ready(&mut self, asked: Asked, traced: &TracedSettings) -> anyhow::Result<Option<String>> {
        let scene = traced.applied_to(&asked.shot.scene);
        let place = |of: &TracedSettings| (of.device_choice(), of.adapter);
        let serves = |(renderer, before, _): &(Renderer, TracedSettings, _)| {
            Arc::ptr_eq(renderer.scene(), &scene) && place(before) == place(traced) && renderer.refusal().is_none()
        };
        if !self.renderer.as_ref().is_some_and(serves) {
            let (width, height) = asked.shot.size;
            let samples = u64::from(width) * u64::from(height) * u64::from(asked.spp(traced));
            let (backend, why) = (self.devices.ready)(traced, &scene, samples)?;
            let renderer = Renderer::new(scene, backend, self.devices.threads.clone());
            self.renderer = Some((renderer, *traced, why));
        }
        let Some((renderer, before, why)) = &mut self.renderer else { return Ok(None) };
        (*before, renderer.feature) = (*traced, traced.feature);
        Ok(why.clone())
    }

    fn draw(&mut self, asked: Asked, fake: FakeSettings) -> anyhow::Result<Tile> {
        let Shot { scene, camera, size: (width, height), .. } = asked.shot;
        if self.raster.is_none() {
            let gpu = (self.devices.open_gpu)()?;
            let raster = Raster::new(&gpu)?;
            self.raster = Some((gpu, raster));
        }
        let Some((gpu, raster)) = &mut self.raster else { anyhow::bail!("nothing draws the fake") };
        let start = Instant::now();
        let drawn = raster.render(&fake.applied_to(scene), camera, &fake.sized(*width, *height));
        let (seconds, made_by) = (start.elapsed().as_secs_f64(), gpu.describe());
        // what has failed once is opened anew
        let film = drawn.inspect_err(|_| self.raster = None)?;
        let edited = asked.shot.changes.edits.told();
        let facts = TileFacts { seconds, done: true, edited, ..TileFacts::default() };
        let provenance = Provenance { shot: asked.shot.clone(), technique: asked.pane.in_use(), device: Device::Gpu };
        Ok(Tile { image: film.image(), made_by, ..Tile::without_light(facts, provenance) })
    }
}

fn blank(size: (u32, u32)) -> anyhow::Result<Accumulation> {
    Accumulation::blank(size).ok_or_else(no_memory)
}

fn no_memory() -> anyhow::Error {
    anyhow::anyhow!("not enough memory for these pixels; make the tiles smaller, or fewer")
}

/// Who watches a tile: for its samples or its time.
struct TileWatch<'a, O> {
    asked: Asked<'a>,
    onlooker: &'a O,
    /// Why the device that was asked for does not trace.
    refused: Option<String>,
    /// Samples after which to end.
    most: u32,
    clock: Mutex<Clock>,
}

/// How long rays have been traced: told before each pass, and what has gone by since.
#[derive(Default)]
struct Clock {
    before: Duration,
    pass: Option<Instant>,
}

impl<'a, O: Onlooker> TileWatch<'a, O> {
    fn of(asked: Asked<'a>, refused: Option<String>, onlooker: &'a O) -> Self {
        TileWatch { asked, onlooker, refused, most: u32::MAX, clock: Mutex::default() }
    }

    fn spent(&self) -> Duration {
        let clock = self.clock.lock().unwrap_or_else(PoisonError::into_inner);
        clock.before + clock.pass.map_or(Duration::ZERO, |begun| begun.elapsed())
    }

    fn set_clock(&self, before: Duration, pass: Option<Instant>) {
        *self.clock.lock().unwrap_or_else(PoisonError::into_inner) = Clock { before, pass };
    }

    fn is_late(&self) -> bool {
        self.asked.limit.is_some_and(|limit| self.spent() >= limit)
    }

    fn tile_of(&self, rendered: Rendered, seconds: f64) -> Tile {
        let Rendered { film, runs, denoised, made_by, device, .. } = rendered;
        let samples = film.samples_per_pixel();
        let whole = !self.onlooker.ends_now();
        let mut tile = self.tile((film.image(), denoised.and_then(Result::ok)), (samples, runs), (seconds, whole));
        (tile.made_by, tile.provenance.device) = (made_by, device);
        tile
    }

    fn tile(
        &self,
        (mean, denoised): (Image, Option<Denoised>),
        (samples, runs): (u32, u32),
        (seconds, done): (f64, bool),
    ) -> Tile {
        let mut technique = self.asked.pane.in_use().with_runs(runs);
        if let (None, Technique::Traced(traced)) = (&denoised, &mut technique) {
            traced.denoise = DenoiseSettings::OFF;
        }
        let filtering = denoised.as_ref().map_or(0.0, |denoised| denoised.seconds);
        let seconds = seconds + filtering;
        let (edited, fault) = (self.asked.shot.changes.edits.told(), self.refused.clone());
        let facts = TileFacts { spp: Some(samples), seconds, errors: None, done, edited, fault };
        let mut image = denoised.map_or(mean, |denoised| denoised.image);
        image.layers.clear();
        Tile {
            image,
            facts,
            provenance: Provenance { shot: self.asked.shot.clone(), technique, device: Device::Cpu },
            spp: samples / runs.max(1),
            made_by: String::new(),
        }
    }
}

/// Least and most time of a pass.
const PASS: [Duration; 2] = [Duration::from_millis(100), Duration::from_millis(400)];

impl<O: Onlooker> Watch for TileWatch<'_, O> {
    fn ends_now(&self) -> bool {
        self.onlooker.ends_now()
    }

    /// One sample of every pixel is made however late it is.
    fn ends_soon(&self, spp: u32) -> bool {
        self.ends_now() || spp > 0 && (spp >= self.most || self.is_late())
    }

    fn keeps_parts(&self) -> bool {
        self.asked.pane.in_use().denoise().trusts()
    }

    fn is_held(&self) -> bool {
        self.onlooker.is_held()
    }

    fn wait(&self) {
        self.onlooker.wait();
    }

    /// What is left of the time, at most: so that it ends with a pass.
    fn pacing(&self, spent: Duration) -> Pacing {
        self.set_clock(spent, Some(Instant::now()));
        let left = self.asked.limit.map_or(Duration::MAX, |limit| limit.saturating_sub(spent));
        let pass = (spent / 8).clamp(PASS[0], PASS[1]);
        Pacing { pass: pass.min(left), show: 2 * pass, growth: 3 }
    }

    fn count(&self, _spp: u32) {
        let spent = self.spent();
        self.set_clock(spent, None);
    }

    /// As it is before it goes through a denoiser.
    fn show(&self, frame: Frame) {
        self.set_clock(Duration::from_secs_f64(frame.seconds), None);
        let of = (frame.film.samples_per_pixel(), frame.runs);
        self.onlooker.see(self.tile((frame.film.image(), None), of, (frame.seconds, false)));
    }
}

/// How far a picture is from the reference of the same pixels.
///
/// # Errors
/// If they are not of one size.
pub fn measure(
    image: &Image,
    reference: &ReferenceImage,
    display: &DisplayTransform,
) -> Result<TileErrors, CompareError> {
    let (flip, _) = finite_mean(&ErrorMetric::Flip.of(image, &reference.image, display)?);
    Ok(TileErrors { errors: reference.errors(image)?, flip })
}
