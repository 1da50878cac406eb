//! `visavis render`: a picture to a file, without a window.

use super::tracing::{self, Traced, Tracing};
use super::{RenderArgs, reference};
use crate::ruler::{Sought, brief, error_records, noise_line};
use crate::technique::{Device, FakeSettings, Made, Provenance, RaySettings, Recipe, Technique};
use anyhow::Context;
use compare::Errors;
use film::DisplayTransform;
use film::Film;
use gpu::Gpu;
use image_file::{self, Kind, Linear};
use pathtrace::{SamplerKind, Stats};
use raster::Raster;
use scene::{Scene, Vec3, builtin};
use serde_json::json;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Samples per pixel where neither --spp nor --time says how many.
const DEFAULT_SPP: u32 = 64;

/// A finished picture and what it cost.
struct Rendered {
    film: Film,
    seconds: f64,
    stats: Stats,
    /// Where it was made, at the end.
    machine: Device,
    /// Name of the GPU, or of the CPU renderer's threads.
    adapter: String,
}

pub fn run(args: &mut RenderArgs) -> anyhow::Result<()> {
    tell_what_has_no_effect(args, &builtin::named(&args.scene)?);
    let sought = args.seen.of(&args.scene)?;
    let scene = sought.scene.clone();
    if !args.chose_estimator {
        args.pane.take_usual_estimator(&scene);
    }
    let args = &*args;
    let recipe = args.pane.recipe();
    anyhow::ensure!(
        !args.errors || recipe.shows_the_scene(),
        "a map of the fake has no errors: --errors needs --show picture"
    );
    image_file::check_writable(&args.out)?;
    let rendered = match recipe {
        Recipe::Fake(fake) => raster(args, &fake.applied_to(&scene), fake)?,
        Recipe::Rays(rays) => trace(args, &scene, rays)?,
    };
    let errors = if args.errors { Some(measure(&sought, &rendered.film)?) } else { None };
    save(args, &scene, &rendered, errors.as_ref())?;
    if rendered.film.nonfinite > 0 {
        note!(
            "visavis: {} samples were not finite and are left out: please report this scene",
            rendered.film.nonfinite
        );
    }
    if rendered.stats.cut_paths > 0 {
        note!("note: {} samples were cut short and miss light: too many rays", rendered.stats.cut_paths);
    }
    if args.json {
        super::print(&format!("{}\n", report(args, &scene, &rendered, errors.as_ref())))?;
    } else {
        note!(
            "{} of {} at {}x{} in {:.2} s: {}",
            args.pane.technique.name(),
            scene.name,
            args.seen.size.0,
            args.seen.size.1,
            rendered.seconds,
            args.out.display()
        );
        if let Some(e) = errors {
            let noise = noise_line(&e).map_or_else(String::new, |line| format!(", noise {line}"));
            let (rel_mse, rmse) = (brief(e.rel_mse), brief(e.rmse));
            note!("A - reference: relMSE {rel_mse}, RMSE {rmse}, bias {:+.2} %{noise}", 100.0 * e.relative_bias);
        }
    }
    Ok(())
}

/// How far a finished picture is from the reference of what it shows.
fn measure(sought: &Sought, film: &Film) -> anyhow::Result<Errors> {
    let reference = reference::obtain(sought, None)?;
    Ok(reference.errors(&film.radiances().collect::<Vec<_>>())?)
}

fn save(args: &RenderArgs, scene: &Scene, rendered: &Rendered, errors: Option<&Errors>) -> anyhow::Result<()> {
    let provenance = Provenance {
        source: args.scene.clone(),
        changes: args.seen.changes,
        camera: scene.camera,
        recipe: args.pane.recipe(),
        size: args.seen.size,
        device: rendered.machine,
    };
    let made = Made {
        spp: rendered.film.samples_per_pixel(),
        seconds: rendered.seconds,
        adapter: &rendered.adapter,
        exposure: args.exposure,
    };
    let mut records = provenance.records(made);
    records.extend(errors.into_iter().flat_map(|e| error_records(e, "reference".into())));
    let radiances: Vec<Vec3> = rendered.film.radiances().collect();
    let picture = Linear { width: args.seen.size.0, height: args.seen.size.1, radiances: &radiances };
    let kind = Kind::of(&args.out).context("a picture's name must end in .png or .exr")?;
    let bytes = image_file::encode(kind, picture, &DisplayTransform { exposure: args.exposure }, &records)?;
    Ok(image_file::write_whole(&args.out, &bytes)?)
}

fn tell_what_has_no_effect(args: &RenderArgs, scene: &Scene) {
    for option in &args.without_effect {
        note!("note: {option} has no effect with --technique {}", args.pane.technique.name());
    }
    let fake = args.pane.recipe().technique() == Technique::Raster;
    if scene.refraction_ratio().is_none() {
        if args.seen.changes.refraction_ratio.is_some() {
            note!("note: --refraction-ratio has no effect: {} has no glass", scene.name);
        }
        if fake && args.pane.fake.reflectivity.is_some() {
            note!("note: --reflectivity has no effect: {} has no glass", scene.name);
        }
    }
    if scene.sun.is_none() && args.seen.changes.sun_radius.is_some() {
        note!("note: --sun-radius has no effect: {} has no sun", scene.name);
    }
}

fn raster(args: &RenderArgs, scene: &Scene, fake: FakeSettings) -> anyhow::Result<Rendered> {
    let gpu = Gpu::headless().context("the raster technique needs a GPU")?;
    let mut raster = Raster::new(&gpu)?;
    let start = Instant::now();
    let film = raster.render(scene, &scene.camera, &fake.sized(args.seen.size.0, args.seen.size.1))?;
    let (seconds, machine) = (start.elapsed().as_secs_f64(), Device::Gpu);
    Ok(Rendered { film, seconds, stats: Stats::default(), machine, adapter: gpu.describe() })
}

fn trace(args: &RenderArgs, scene: &Scene, rays: RaySettings) -> anyhow::Result<Rendered> {
    if let Some(blind) = rays.blind_spot(scene) {
        note!("note: {blind}");
    }
    let spp = args.spp.unwrap_or(if args.seconds.is_some() { u32::MAX } else { DEFAULT_SPP });
    let (width, height) = args.seen.size;
    let film = Film::try_new(width, height)
        .with_context(|| format!("not enough memory for {width}x{height} pixels; ask for a smaller --size"))?;
    let work = u64::from(width) * u64::from(height) * u64::from(spp);
    let gpu = tracing::device(args.device, work)?;
    let start = Instant::now();
    let mut tracing = Tracing::begin(gpu, scene, rays, film, args.device)?;
    let limit = args.seconds.map(Duration::from_secs_f64);
    let progress = Progress::new(spp);
    // one sample of every pixel is made however late it is
    let is_late = |tracing: &Tracing| tracing.spp() > 0 && limit.is_some_and(|limit| start.elapsed() >= limit);
    let mut batch = 1;
    loop {
        let batch_start = Instant::now();
        let samples = batch.min(spp.saturating_sub(tracing.spp()));
        // what is not read yet may be lost, and is then made up for
        let machine = tracing.machine();
        if samples == 0 || is_late(&tracing) {
            tracing.read();
            if tracing.machine() == machine || is_late(&tracing) {
                break;
            }
        } else {
            tracing.add(samples);
        }
        progress.show(tracing.spp(), start.elapsed());
        batch = if tracing.machine() == machine {
            next_batch(samples, batch_start.elapsed(), limit.map(|l| l.saturating_sub(start.elapsed())))
        } else {
            1
        };
    }
    progress.finish();
    let Traced { film, stats, machine, adapter } = tracing.finish();
    Ok(Rendered { film, seconds: start.elapsed().as_secs_f64(), stats, machine, adapter })
}

/// How many samples fill a quarter of a second, or what is left of the time, at the speed of the last batch.
fn next_batch(samples: u32, took: Duration, left: Option<Duration>) -> u32 {
    let goal = left.unwrap_or(Duration::MAX).min(Duration::from_millis(250)).as_secs_f64();
    let per_sample = took.as_secs_f64().max(1e-6) / f64::from(samples);
    ((goal / per_sample) as u32).clamp(1, samples.saturating_mul(4))
}

/// A line on stderr that counts samples, where someone can see it.
struct Progress {
    spp: u32,
    shown: bool,
}

impl Progress {
    fn new(spp: u32) -> Self {
        Progress { spp, shown: std::io::stderr().is_terminal() }
    }

    fn show(&self, done: u32, elapsed: Duration) {
        if self.shown {
            let of = if self.spp == u32::MAX { String::new() } else { format!(" of {}", self.spp) };
            super::to_stderr(format_args!("\r{done}{of} spp, {:.1} s ", elapsed.as_secs_f64()));
        }
    }

    fn finish(&self) {
        if self.shown {
            super::to_stderr(format_args!("\r\x1b[K"));
        }
    }
}

fn report(args: &RenderArgs, scene: &Scene, rendered: &Rendered, errors: Option<&Errors>) -> serde_json::Value {
    let technique = args.pane.technique;
    let per_second = |count: u64| count as f64 / rendered.seconds;
    let mut report = json!({
        "scene": scene.name,
        "technique": technique.name(),
        "device": rendered.machine.name(),
        "adapter": rendered.adapter,
        "width": args.seen.size.0,
        "height": args.seen.size.1,
        "spp": rendered.film.samples_per_pixel(),
        "seconds": rendered.seconds,
        "samples_per_second": per_second(rendered.stats.samples),
        "rays_per_second": per_second(rendered.stats.rays),
        "mean": rendered.film.mean(),
        "nonfinite": rendered.film.nonfinite,
    });
    match args.pane.recipe() {
        Recipe::Fake(fake) => report["fake"] = json!(fake.fake.name()),
        Recipe::Rays(rays) => {
            for (name, value) in rays.options(rendered.film.samples_per_pixel()).into_iter().skip(1) {
                let counts = ["seed", "branches", "depth", "shadow-rays"].contains(&name);
                let number = value.parse::<u64>().ok().filter(|_| counts);
                report[name.replace('-', "_")] = number.map_or_else(|| json!(value), |number| json!(number));
            }
            report["samples"] = json!(rendered.stats.samples);
            report["rays"] = json!(rendered.stats.rays);
            report["cut_paths"] = json!(rendered.stats.cut_paths);
            report["standard_error"] = json!(rendered.film.standard_error());
            let independent = rays.sampler() == SamplerKind::Independent;
            let reliable = independent && rendered.film.standard_error_is_reliable();
            report["standard_error_reliable"] = json!(reliable);
        }
    }
    if let Some(e) = errors {
        report["errors"] = json!({
            "against": "reference", "rmse": e.rmse, "relmse": e.rel_mse, "mae": e.mae, "bias": e.bias,
            "relative_bias": e.relative_bias, "reference_noise": e.reference_noise,
            "below_reference_noise": e.below_reference_noise(),
        });
    }
    report
}
