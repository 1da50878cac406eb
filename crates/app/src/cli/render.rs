//! `visavis render`: a picture to a file, without a window.

use super::RenderArgs;
use crate::picture_file::{self, Settings};
use crate::technique::{FakeSettings, Technique, TruthSettings, bounces_name, roulette_name};
use anyhow::Context;
use gpu::Gpu;
use pathtrace::{Stats, Tracer};
use raster::Raster;
use scene::display::DisplayTransform;
use scene::{Camera, Film, Scene, builtin};
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
    /// Name of the GPU, or of the CPU renderer's threads.
    adapter: String,
    device: &'static str,
}

pub fn run(args: &RenderArgs) -> anyhow::Result<()> {
    let mut scene = builtin::named(&args.scene)?;
    apply(args, &mut scene)?;
    picture_file::check_writable(&args.out)?;
    let rendered = match args.technique {
        Technique::Raster => raster(args, &scene)?,
        Technique::Path => path(args, &scene)?,
    };
    let display = DisplayTransform { exposure: args.exposure };
    picture_file::save(&args.out, &rendered.film, &display, &settings(args, &scene, &rendered))?;
    if rendered.film.nonfinite > 0 {
        note!(
            "visavis: {} samples were not finite and are left out: please report this scene",
            rendered.film.nonfinite
        );
    }
    if args.json {
        super::print(&format!("{}\n", report(args, &scene, &rendered)))?;
    } else {
        note!(
            "{} of {} at {}x{} in {:.2} s: {}",
            args.technique.name(),
            scene.name,
            args.size.0,
            args.size.1,
            rendered.seconds,
            args.out.display()
        );
    }
    Ok(())
}

/// Applies what the command line changes in the scene, and says what of it has no effect.
fn apply(args: &RenderArgs, scene: &mut Scene) -> anyhow::Result<()> {
    for option in &args.without_effect {
        note!("note: {option} has no effect with --technique {}", args.technique.name());
    }
    if let Some(ratio) = args.refraction_ratio {
        if scene.refraction_ratio().is_none() {
            note!("note: --refraction-ratio has no effect: {} has no glass", scene.name);
        }
        scene.set_refraction_ratio(ratio);
    }
    if let Some(radius) = args.sun_radius {
        match &mut scene.sun {
            Some(sun) => sun.angular_radius = radius,
            None => note!("note: --sun-radius has no effect: {} has no sun", scene.name),
        }
    }
    let camera = &mut scene.camera;
    *camera = Camera {
        eye: args.eye.unwrap_or(camera.eye),
        target: args.target.unwrap_or(camera.target),
        fov_y: args.fov.unwrap_or(camera.fov_y),
        ..*camera
    };
    match camera.fault() {
        Some(fault) => anyhow::bail!("this camera sees nothing: {fault}; change --eye, --target or --fov"),
        None => Ok(()),
    }
}

fn raster(args: &RenderArgs, scene: &Scene) -> anyhow::Result<Rendered> {
    let gpu = Gpu::headless().context("the raster technique needs a GPU")?;
    let mut raster = Raster::new(&gpu)?;
    let settings = FakeSettings { fake: args.fake, ..FakeSettings::default() }.sized(args.size.0, args.size.1);
    let start = Instant::now();
    let film = raster.render(scene, &scene.camera, &settings)?;
    Ok(Rendered {
        film,
        seconds: start.elapsed().as_secs_f64(),
        stats: Stats::default(),
        adapter: gpu.describe(),
        device: "gpu",
    })
}

fn path(args: &RenderArgs, scene: &Scene) -> anyhow::Result<Rendered> {
    let spp = args.spp.unwrap_or(if args.seconds.is_some() { u32::MAX } else { DEFAULT_SPP });
    if let Some(blind) = (TruthSettings { path: args.path, spp }).blind_spot(scene) {
        note!("note: {blind}");
    }
    let start = Instant::now();
    let tracer = Tracer::new(scene);
    let (width, height) = args.size;
    let mut film = Film::try_new(width, height)
        .with_context(|| format!("not enough memory for {width}x{height} pixels; ask for a smaller --size"))?;
    let mut stats = Stats::default();
    let limit = args.seconds.map(Duration::from_secs_f64);
    let progress = Progress::new(spp);
    let mut batch = 1;
    let mut done = 0;
    while done < spp {
        let batch_start = Instant::now();
        let samples = batch.min(spp - done);
        stats = stats.plus(tracer.render(&mut film, &scene.camera, &args.path, samples, &|| false));
        done += samples;
        progress.show(done, start.elapsed());
        if limit.is_some_and(|limit| start.elapsed() >= limit) {
            break;
        }
        batch = next_batch(samples, batch_start.elapsed(), limit.map(|l| l.saturating_sub(start.elapsed())));
    }
    progress.finish();
    let adapter = format!("{} threads", rayon::current_num_threads());
    Ok(Rendered { film, seconds: start.elapsed().as_secs_f64(), stats, adapter, device: "cpu" })
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

fn settings(args: &RenderArgs, scene: &Scene, rendered: &Rendered) -> Settings {
    let mut settings = vec![
        ("scene", scene.name.clone()),
        ("technique", args.technique.name().into()),
        ("device", rendered.device.into()),
        ("adapter", rendered.adapter.clone()),
        ("seconds", rendered.seconds.to_string()),
        ("eye", scene.camera.eye.to_string()),
        ("target", scene.camera.target.to_string()),
        ("fov", scene.camera.fov_y.to_string()),
    ];
    settings.extend(scene.refraction_ratio().map(|ratio| ("refraction_ratio", ratio.to_string())));
    match args.technique {
        Technique::Raster => settings.push(("fake", args.fake.name().into())),
        Technique::Path => settings.extend([
            ("spp", rendered.film.samples_per_pixel().to_string()),
            ("bounces", bounces_name(args.path.bounces)),
            ("roulette", roulette_name(args.path.roulette)),
            ("estimator", args.path.estimator.name().into()),
            ("seed", args.path.seed.to_string()),
        ]),
    }
    if let (Technique::Path, Some(sun)) = (args.technique, scene.sun) {
        settings.push(("sun_radius", sun.angular_radius.to_string()));
    }
    settings
}

fn report(args: &RenderArgs, scene: &Scene, rendered: &Rendered) -> serde_json::Value {
    let per_second = |count: u64| count as f64 / rendered.seconds;
    let mut report = json!({
        "scene": scene.name,
        "technique": args.technique.name(),
        "device": rendered.device,
        "adapter": rendered.adapter,
        "width": args.size.0,
        "height": args.size.1,
        "spp": rendered.film.samples_per_pixel(),
        "seconds": rendered.seconds,
        "samples_per_second": per_second(rendered.stats.samples),
        "rays_per_second": per_second(rendered.stats.rays),
        "mean": rendered.film.mean(),
        "nonfinite": rendered.film.nonfinite,
    });
    match args.technique {
        Technique::Raster => report["fake"] = json!(args.fake.name()),
        Technique::Path => {
            report["standard_error"] = json!(rendered.film.standard_error());
            report["estimator"] = json!(args.path.estimator.name());
            report["bounces"] = json!(bounces_name(args.path.bounces));
            report["roulette"] = json!(roulette_name(args.path.roulette));
            report["seed"] = json!(args.path.seed);
            report["cut_paths"] = json!(rendered.stats.cut_paths);
        }
    }
    report
}
