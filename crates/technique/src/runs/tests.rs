use super::*;
use crate::{Adapters, Denoiser, DeviceChoice, NoMemory, ProgressiveRenderer, Request, Shot, Threads};
use film::{Image, Vec3};
use pathtrace::PathSettings;
use std::sync::{Arc, Mutex};

const SIZE: (u32, u32) = (33, 17);
const UNET: DenoiseSettings = DenoiseSettings { denoiser: Denoiser::Unet, ..DenoiseSettings::OFF };

/// What was shown: runs, samples per pixel, whether more comes, and the picture.
type Shown = (u32, u32, bool, Image);

/// Watches as a pane does, and ends where so many samples per pixel are there, all runs together.
struct Pane {
    denoise: DenoiseSettings,
    end: u32,
    counted: AtomicU32,
    shown: Mutex<Vec<Shown>>,
}

impl Pane {
    fn new(denoise: DenoiseSettings, end: u32) -> Self {
        Pane { denoise, end, counted: AtomicU32::new(0), shown: Mutex::default() }
    }
}

impl Watch for Pane {
    fn ends_soon(&self, _spp: u32) -> bool {
        self.counted.load(Ordering::Relaxed) >= self.end
    }

    fn denoise(&self) -> DenoiseSettings {
        self.denoise
    }

    /// So little at a time that there are several passes, all shown.
    fn pacing(&self, _spent: Duration) -> Pacing {
        Pacing { pass: Duration::ZERO, show: Duration::ZERO, growth: 1 }
    }

    fn show(&self, frame: Frame) {
        if !frame.rough {
            let image = frame.denoised.map_or_else(|| frame.film.image(), |denoised| denoised.unwrap().image);
            let shown = (frame.runs, frame.film.samples_per_pixel(), frame.unfinished, image);
            self.shown.lock().unwrap().push(shown);
        }
    }

    fn count(&self, spp: u32) {
        self.counted.store(spp, Ordering::Relaxed);
    }
}

/// Two samples of a pixel, of seeds from 5 on.
fn settings(runs: u32, denoise: DenoiseSettings) -> TracedSettings {
    let path = PathSettings { seed: 5, ..PathSettings::default() };
    TracedSettings { runs, denoise, device: DeviceChoice::Cpu, ..TracedSettings::new(path.into(), 2) }
}

fn renderer() -> Renderer {
    let scene = Arc::new(scene::builtin::named("cornell").unwrap());
    Renderer::on_the_processor(scene, Arc::new(Threads::all()))
}

/// The mean of so many, made at once.
fn mean_of(runs: u32, spp: u32, denoise: DenoiseSettings) -> Rendered {
    let (mut renderer, blank) = (renderer(), Accumulation::blank(SIZE).unwrap());
    let camera = renderer.scene().camera;
    let films = (blank, Runs::blank(SIZE, spp, denoise).unwrap());
    renderer.finish_runs(films, &camera, (&settings(runs, denoise).integrator, runs), &Pane::new(denoise, u32::MAX))
}

/// One picture, of its own seed.
fn alone(seed: u32, spp: u32, denoise: DenoiseSettings) -> Rendered {
    let mut renderer = renderer();
    let camera = renderer.scene().camera;
    let integrator = settings(1, denoise).integrator.with_seed(seed);
    let blank = Accumulation::blank(SIZE).unwrap();
    renderer.finish(blank, &camera, (&integrator, spp), denoise, &Pane::new(denoise, u32::MAX))
}

fn image_of(rendered: &Rendered) -> Image {
    rendered.denoised.as_ref().map_or_else(|| rendered.film.image(), |denoised| denoised.clone().unwrap().image)
}

/// In f64, rounded once.
fn mean(images: &[Image]) -> Vec<Vec3> {
    let of = |pixel: usize, c: usize| images.iter().map(|image| f64::from(image.radiances()[pixel][c])).sum::<f64>();
    let mean = |pixel| Vec3::from_array([0, 1, 2].map(|c| (of(pixel, c) / images.len() as f64) as f32));
    (0..images[0].radiances().len()).map(mean).collect()
}

#[test]
fn the_mean_of_runs_is_that_of_pictures_of_their_seeds_each_denoised_by_itself() {
    let trusting = DenoiseSettings { trust: 1.0, ..UNET };
    for (spp, denoise) in [(2, DenoiseSettings::OFF), (2, UNET), (4, trusting)] {
        let (mean_of_runs, alone) = (mean_of(3, spp, denoise), [5, 6, 7].map(|seed| alone(seed, spp, denoise)));
        let mut film = Film::new(SIZE.0, SIZE.1);
        alone.iter().for_each(|one| film.add_all(&one.film));
        assert!(mean_of_runs.film == film, "all samples of all");
        assert_eq!((mean_of_runs.runs, film.samples_per_pixel()), (3, 3 * spp));
        assert_eq!(mean_of_runs.stats.rays, alone.iter().map(|one| one.stats.rays).sum::<u64>());
        if denoise.is_on() {
            let image = image_of(&mean_of_runs);
            assert_eq!(image.radiances(), mean(&alone.each_ref().map(image_of)));
            assert_eq!(image.layers.len(), usize::from(denoise.trusts()), "the weight's mean");
        }
    }
}

#[test]
fn a_run_that_is_stopped_is_left_out_unless_it_is_the_only_one() {
    let end = |spp| {
        let mut renderer = renderer();
        let camera = renderer.scene().camera;
        let films = (Accumulation::blank(SIZE).unwrap(), Runs::blank(SIZE, 2, UNET).unwrap());
        renderer.finish_runs(films, &camera, (&settings(8, UNET).integrator, 8), &Pane::new(UNET, spp))
    };
    let stopped = end(5);
    assert_eq!((stopped.runs, stopped.film.samples_per_pixel()), (2, 4));
    assert_eq!(image_of(&stopped), image_of(&mean_of(2, 2, UNET)));
    let stopped = end(1);
    assert_eq!((stopped.runs, stopped.film.samples_per_pixel()), (1, 1));
}

/// A window's pane, and what it looks at.
struct Looking(ProgressiveRenderer, Shot);

impl Looking {
    fn new() -> Self {
        let threads = Arc::new(Threads::all());
        let shot = Shot::of(scene::builtin::named("cornell").unwrap(), SIZE);
        Looking(ProgressiveRenderer::new(Adapters::default(), threads), shot)
    }

    /// Makes a picture as far as `end` lets it, and returns what was shown.
    fn go_on(&mut self, settings: TracedSettings, end: u32) -> Vec<Shown> {
        let pane = Pane::new(settings.denoise, end);
        let request = Request { shot: self.1.clone(), settings, restarts: 0 };
        assert_eq!(self.0.render(&request, &pane), Ok::<(), NoMemory>(()));
        pane.shown.into_inner().unwrap()
    }
}

#[test]
fn the_first_run_is_shown_as_it_comes_and_then_the_mean_of_those_that_are_done() {
    let shown = Looking::new().go_on(settings(3, UNET), u32::MAX);
    let progress: Vec<_> = shown.iter().map(|(runs, spp, unfinished, _)| (*runs, *spp, *unfinished)).collect();
    assert_eq!(progress, [(1, 1, true), (1, 2, true), (2, 4, true), (3, 6, false)]);
    let whole = [1, 2, 3].map(|runs| image_of(&mean_of(runs, 2, UNET)));
    assert!(shown[1..].iter().map(|shown| &shown.3).eq(&whole));
}

#[test]
fn runs_go_on_where_they_were_stopped_and_more_of_them_where_they_ended() {
    let mut pane = Looking::new();
    let whole = image_of(&mean_of(4, 2, UNET));
    // in the middle of the third
    assert_eq!(pane.go_on(settings(3, UNET), 5).last().map(|last| (last.0, last.2)), Some((2, true)));
    let rest = pane.go_on(settings(3, UNET), u32::MAX);
    assert_eq!(rest.iter().map(|shown| shown.0).collect::<Vec<_>>(), [2, 3], "nothing is made twice");
    let more = pane.go_on(settings(4, UNET), u32::MAX);
    assert_eq!(more.iter().map(|shown| shown.0).collect::<Vec<_>>(), [3, 4]);
    assert_eq!(more[1].3, whole);
    let fewer = pane.go_on(settings(1, UNET), u32::MAX);
    assert_eq!(fewer.last().map(|last| last.3.clone()), Some(image_of(&alone(5, 2, UNET))), "begun anew");
    // in the middle of the second, whose samples are of another seed
    pane.go_on(settings(2, UNET), 3);
    let one = pane.go_on(settings(1, UNET), u32::MAX);
    assert_eq!(one.last().map(|last| last.3.clone()), Some(image_of(&alone(5, 2, UNET))), "its own seed");
    assert_eq!(pane.go_on(settings(4, UNET), u32::MAX).last().map(|last| last.3.clone()), Some(whole));
    let raw = pane.go_on(settings(4, DenoiseSettings::OFF), u32::MAX);
    assert_eq!(raw.last().map(|last| last.3.clone()), Some(image_of(&mean_of(4, 2, DenoiseSettings::OFF))));
}

/// And so it is the same picture whatever the passes were.
#[test]
fn the_part_that_judges_a_denoiser_is_half_of_the_samples() {
    let trusting = DenoiseSettings { trust: 1.0, ..UNET };
    let earlier = |spp| alone(5, spp, trusting).earlier.map(|film| film.samples_per_pixel());
    assert_eq!([1, 2, 3, 5, 6, 7, 8, 13].map(earlier), [0, 1, 1, 2, 3, 3, 4, 6].map(|spp| (spp > 0).then_some(spp)));
    let half = mean_of(5, 1, trusting).earlier.map(|film| film.samples_per_pixel());
    assert_eq!(half, Some(2), "of runs the first ones");
}

#[test]
fn the_view_of_trust_is_its_weight_as_steps_of_grey_and_black_where_there_is_none() {
    let view = DenoiseSettings { trust: 1.0, shows_trust: true, ..UNET };
    let shown = image_of(&alone(5, 8, view));
    let [LayerValues::Numbers(weight)] = &shown.layers.iter().map(|layer| layer.values.clone()).collect::<Vec<_>>()[..]
    else {
        panic!("{:?}", shown.layers)
    };
    assert!(weight.iter().any(|weight| *weight > 0.1) && weight.iter().all(|weight| (0.0..=1.0).contains(weight)));
    let grey = |weight: &f32| Vec3::splat(film::colour::srgb_decode(*weight));
    assert!(shown.radiances().iter().copied().eq(weight.iter().map(grey)));
    let picture = image_of(&alone(5, 8, DenoiseSettings { shows_trust: false, ..view }));
    assert_eq!(picture.layers, shown.layers, "the picture's own");
    assert!(
        image_of(&alone(5, 1, view)).radiances().iter().all(|grey| *grey == Vec3::ZERO),
        "one sample has no halves"
    );
}
