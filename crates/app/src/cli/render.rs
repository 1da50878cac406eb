//! `visavis render`: a picture to a file, without a window.

mod report;
mod samples;
mod terminal;

use self::report::report;
use self::terminal::Terminal;
use super::{RenderArgs, interrupt, reference, trees};
use crate::ruler::{FEWEST_RUNS_OF_A_BIAS, bias_words, brief, error_records, error_words, noise_line};
use anyhow::Context;
use compare::Errors;
use film::{DisplayTransform, Features, Image};
use gpu::Gpu;
use image_file::{self, Kind};
use pathtrace::{ChainStats, Stats};
use raster::Raster;
use scene::Scene;
use std::io::IsTerminal;
use std::sync::Arc;
use std::time::{Duration, Instant};
use technique::settings::{OF_SCENES, Setting, all_of_panes};
use technique::{
    Backend, BlindSpot, DenoiseSettings, Denoised, Device, DeviceChoice, FakeSettings, Frame, Halves, INSTEAD, Made,
    NOISY, PaneSettings, Provenance, Rendered, Renderer, Runs, Shot, Technique, Threads, TracedSettings,
};

/// How long a device may work on what nobody has read yet.
const AT_RISK: Duration = Duration::from_secs(5);

/// A finished picture and what it cost.
pub(super) struct Timed {
    pub rendered: Rendered,
    pub seconds: f64,
}

pub fn run(args: &mut RenderArgs) -> anyhow::Result<()> {
    let shot = args.shot()?;
    tell_what_has_no_effect(args, &shot.scene);
    args.tell_of_another_scene(&shot.scene);
    args.tell_of_what_is_not_made_again();
    args.pane.denoise.history = 0;
    let scene = shot.scene.clone();
    if !args.chose_estimator {
        args.pane.take_usual_estimator(&scene);
    }
    let args = &*args;
    let technique = args.pane.in_use();
    anyhow::ensure!(
        !args.errors || technique.shows_the_scene(),
        "what shows no light has no errors: --errors needs a picture of it (--show picture, and not --technique normals)"
    );
    anyhow::ensure!(
        !args.errors || technique.has_a_reference(),
        "a part of the light has no errors: the reference has all of it; leave out --errors or --light"
    );
    image_file::check_writable(&args.out)?;
    let _heeded = interrupt::heed();
    let Timed { rendered, seconds } = match technique {
        Technique::Fake(fake) => raster(args, &fake.applied_to(&scene), fake)?,
        Technique::Traced(traced) => trace(args, &shot, traced, None)?,
    };
    let mut image = picture_of(&rendered);
    let before = matches!(rendered.denoised, Some(Ok(_))).then(|| rendered.film.image());
    if args.layers {
        image.layers.extend(rendered.features.iter().flat_map(Features::layers));
        image.layers.extend(before.iter().map(|before| before.as_layer(NOISY)));
    }
    image.layers.extend(samples::layers(args, &rendered.film));
    let halves = halves(args, &rendered);
    image.layers.extend(halves.iter().flat_map(Halves::layers));
    let measured = args.errors.then(|| measure(&shot, (&image, before.as_ref()))).transpose();
    let told = measured.as_ref().ok().and_then(Option::as_ref);
    save(args, shot, (&rendered, seconds), (&image, halves.map(|halves| halves.samples)), told)?;
    let out = image_file::shown(&args.out);
    let made = spp_made(args, &rendered);
    let errors = measured.with_context(|| format!("{made} are saved, without their errors: {out}"))?;
    if let Some(Err(fault)) = &rendered.denoised {
        anyhow::bail!("{made} are saved, not denoised ({fault}): {out}");
    }
    if let Some(Ok(Denoised { refused: Some(why), .. })) = &rendered.denoised {
        note!("note: denoised by the processor, the graphics device failed: {why}");
    }
    if rendered.film.nonfinite > 0 {
        note!(
            "visavis: {} samples were not finite and are left out: please report this scene",
            rendered.film.nonfinite
        );
    }
    for (count, what) in rendered.stats.cut_short() {
        note!("note: {count} {what} were cut short and miss light: too many rays");
    }
    if args.json {
        super::print(&format!("{}\n", report(args, &scene, (&rendered, seconds), errors.as_ref())))?;
    } else {
        note!(
            "{} of {} at {}x{} in {:.2} s: {}",
            args.pane.technique.name(),
            scene.name,
            args.seen.size.0,
            args.seen.size.1,
            seconds,
            out
        );
        if let Some(line) = chains(&rendered.stats.chains, args.pane.metropolis.metropolis.chains) {
            note!("{line}");
        }
        if let Some(Ok(Denoised { seconds, .. })) = &rendered.denoised {
            let bias = if technique.denoise().trusts() {
                "biased, the less the more samples"
            } else {
                "biased, however many samples"
            };
            note!("denoised by {} in {seconds:.2} s: {bias}", technique.denoise().denoiser.name());
        }
        if technique.runs() > 1 {
            note!("the mean of {} of {} runs of {} spp", rendered.runs, technique.runs(), spp_of_run(&rendered));
        }
        if let Some(Measured { errors: e, before }) = errors {
            let noise = noise_line(&e).map_or_else(String::new, |line| format!(", noise {line}"));
            let [off, brightness] = error_words(&e, None);
            let brightness = match rendered.denoised {
                Some(Ok(_)) if rendered.runs >= FEWEST_RUNS_OF_A_BIAS => bias_words(&e, rendered.runs),
                _ => brightness,
            };
            let (rel_mse, rmse) = (brief(e.rel_mse), brief(e.rmse));
            let before = before.map_or_else(String::new, |e| format!(", before denoising relMSE {}", brief(e.rel_mse)));
            note!("against the reference: {off}, {brightness}; relMSE {rel_mse}, RMSE {rmse}{noise}{before}");
        }
    }
    anyhow::ensure!(!interrupt::is_asked(), "{made} are saved: {out}");
    Ok(())
}

/// Denoised, where that was asked for and could be done.
pub(super) fn picture_of(rendered: &Rendered) -> Image {
    match &rendered.denoised {
        Some(Ok(denoised)) => denoised.image.clone(),
        Some(Err(_)) | None => rendered.film.image(),
    }
}

/// Samples per pixel of each run.
fn spp_of_run(rendered: &Rendered) -> u32 {
    rendered.film.samples_per_pixel() / rendered.runs.max(1)
}

/// `12 of 64 spp`, `2 of 8 runs of 64 spp`.
fn spp_made(args: &RenderArgs, rendered: &Rendered) -> String {
    let (made, runs) = (spp_of_run(rendered), args.pane.in_use().runs());
    match (args.pane.in_use(), args.spp_wanted()) {
        (Technique::Traced(_), wanted) if runs > 1 && made == wanted => {
            format!("{} of {runs} runs of {made} spp", rendered.runs)
        }
        (Technique::Traced(_), u32::MAX) | (Technique::Fake(_), _) => format!("{made} spp"),
        (Technique::Traced(_), wanted) => format!("{made} of {wanted} spp"),
    }
}

/// How far a finished picture is from the reference of what it shows.
struct Measured {
    errors: Errors,
    /// And how far before it was denoised.
    before: Option<Errors>,
}

/// Measures a picture, and what it was before it was denoised.
fn measure(shot: &Shot, (image, before): (&Image, Option<&Image>)) -> anyhow::Result<Measured> {
    let reference = reference::obtain(shot, None)?;
    let before = before.map(|before| reference.errors(before)).transpose()?;
    Ok(Measured { errors: reference.errors(image)?, before })
}

/// The halves of the samples, where the layers of a traced picture are wanted.
fn halves(args: &RenderArgs, rendered: &Rendered) -> Option<Halves> {
    let halves = rendered.earlier.as_ref().filter(|_| args.layers).and_then(|half| Halves::of(&rendered.film, half));
    if keeps_halves(args) && halves.is_none() && rendered.film.samples_per_pixel() > 1 {
        note!(
            "note: the halves of the samples are no layers: there was not enough memory for another film, or not enough time"
        );
    }
    halves
}

fn keeps_halves(args: &RenderArgs) -> bool {
    args.layers && args.pane.in_use().traces_light()
}

fn save(
    args: &RenderArgs,
    shot: Shot,
    (rendered, seconds): (&Rendered, f64),
    (image, halves): (&Image, Option<[u32; 2]>),
    errors: Option<&Measured>,
) -> anyhow::Result<()> {
    let technique = args.pane.in_use().with_runs(rendered.runs);
    let mut provenance = Provenance { shot, technique, device: rendered.device };
    if let (Some(Err(_)), Technique::Traced(traced)) = (&rendered.denoised, &mut provenance.technique) {
        traced.denoise = DenoiseSettings::OFF;
    }
    let made = Made {
        spp: spp_of_run(rendered),
        seconds,
        adapter: &rendered.made_by,
        denoised_by: rendered.denoised.as_ref().and_then(|denoised| Some(denoised.as_ref().ok()?.made_by.as_str())),
        exposure: args.exposure,
    };
    let mut records = provenance.records(made);
    let parts = || Halves::samples_in(&rendered.film, rendered.earlier.as_ref()?);
    let parts = halves.or_else(|| parts().filter(|_| technique.denoise().trusts()));
    records.extend(parts.into_iter().flat_map(Halves::records));
    records.extend(errors.into_iter().flat_map(|e| error_records(&e.errors, "reference".into())));
    let records = samples::records(args, &rendered.film, records)?;
    let kind = Kind::of(&args.out).context("a picture's name must end in .png or .exr")?;
    let bytes = image_file::encode_with_read(kind, image, &DisplayTransform { exposure: args.exposure }, &records)?;
    Ok(image_file::write_or_keep(&args.out, &bytes)?)
}

/// What Metropolis' chains did.
fn chains(stats: &ChainStats, chains: u32) -> Option<String> {
    let scale = stats.scale()?;
    let taken = stats.acceptance().map_or_else(
        || "found no light".to_owned(),
        |share| format!("took {:.0} % of {} mutations", 100.0 * share, stats.mutations),
    );
    Some(format!("{chains} chains a sample {taken}; start-up scale {}", brief(scale)))
}

fn tell_what_has_no_effect(args: &RenderArgs, scene: &Scene) {
    let technique = args.pane.technique;
    for option in &args.without_effect {
        note!("note: {option} has no effect with --technique {}", technique.name());
    }
    if args.pane.in_use().denoise().history > 0 && args.original.is_none() {
        note!("note: --history has no effect here: there are no earlier views but in the window");
    }
    let of_scene = OF_SCENES.iter().filter(|setting| (setting.get)(&args.seen.changes).is_some());
    let of_scene = of_scene.map(|setting| (setting.name, setting.needs));
    // what a picture was made with before there was the setting is nobody's choice
    let chosen = |setting: &&Setting<PaneSettings>| {
        let value = (setting.get)(&args.pane);
        value != setting.default && value != setting.before
    };
    let of_pane = all_of_panes().filter(|setting| setting.is_of(technique)).filter(chosen);
    let mut given: Vec<_> = of_scene.chain(of_pane.map(|setting| (setting.name, setting.needs))).collect();
    given.sort_by_key(|(_, needs)| *needs);
    for (name, needs) in given {
        if let Some(missing) = needs.missing_in(scene) {
            note!("note: --{name} has no effect: {} has no {missing}", scene.name);
        }
    }
    tell_what_others_undo(args, scene);
}

/// What was given and changes nothing beside the other settings: of features no light is traced.
fn tell_what_others_undo(args: &RenderArgs, scene: &Scene) {
    let others = match args.pane.in_use().feature() {
        Some(feature) => format!("with --show {}", feature.name()),
        None => "beside the other settings".into(),
    };
    let is_given = |setting: &&Setting<PaneSettings>| args.given.iter().any(|given| given == setting.name);
    let of_technique = |setting: &&Setting<PaneSettings>| setting.is_of(args.pane.technique);
    let there = |setting: &&Setting<PaneSettings>| setting.needs.missing_in(scene).is_none();
    for setting in all_of_panes().filter(is_given).filter(of_technique).filter(there) {
        if !args.pane.is_changed_by(setting, scene) {
            note!("note: --{} has no effect {others}", setting.name);
        }
    }
}

/// The picture of the fake.
pub(super) fn raster(args: &RenderArgs, scene: &Scene, fake: FakeSettings) -> anyhow::Result<Timed> {
    let gpu = Gpu::headless().context("the raster technique needs a GPU")?;
    let mut raster = Raster::new(&gpu)?;
    let start = Instant::now();
    let settings = fake.sized(args.seen.size.0, args.seen.size.1);
    let film = raster.render(scene, &scene.camera, &settings)?;
    let seconds = start.elapsed().as_secs_f64();
    let features = args.layers.then(|| raster.features(scene, &scene.camera, &settings)).transpose()?;
    if let Some(cut) = raster::cut(scene, &scene.camera, &settings) {
        note!("note: {cut}: a scene file that states neither cuts nothing");
    }
    let (device, made_by) = (Device::Gpu, gpu.describe());
    let (stats, runs, earlier) = (Stats::default(), 1, None);
    let rendered = Rendered { film, runs, earlier, features, denoised: None, stats, device, made_by };
    Ok(Timed { rendered, seconds })
}

/// The picture of rays; `follow` is shown how it comes.
pub(super) fn trace(
    args: &RenderArgs,
    shot: &Shot,
    traced: TracedSettings,
    follow: Option<&(dyn Fn(&Frame) + Sync)>,
) -> anyhow::Result<Timed> {
    for line in traced.blind_spots(&shot.scene).into_iter().filter_map(BlindSpot::explanation) {
        note!("note: {line}");
    }
    let spp = args.spp_wanted();
    let (width, height) = shot.size;
    let no_memory = || format!("not enough memory for {width}x{height} pixels; ask for a smaller --size");
    let blank = samples::blank(args, shot.size).with_context(no_memory)?;
    let (denoise, runs) = (args.pane.in_use().denoise(), args.pane.in_use().runs());
    let of_runs = (runs > 1).then(|| Runs::blank(shot.size, spp, denoise).with_context(no_memory)).transpose()?;
    let device = TracedSettings { device: args.device, ..traced }.device_choice();
    let samples = u64::from(spp).saturating_mul(runs.into());
    let gpu = device.open((u64::from(width) * u64::from(height)).saturating_mul(samples))?;
    let start = Instant::now();
    let scene = traced.applied_to(&shot.scene);
    let backend = backend(gpu.as_ref(), &scene, device)?;
    let watch = Terminal {
        spp: spp.saturating_mul(runs),
        follow,
        parts_meet_at: args.parts_meet_at(spp),
        shown: std::io::stderr().is_terminal(),
        start,
        layers: args.layers,
        limit: args.seconds.map(Duration::from_secs_f64),
        keeps_parts: denoise.trusts() || keeps_halves(args),
        // a test does not wait for seconds
        at_risk: if backend.fails_on_purpose() { Duration::ZERO } else { AT_RISK },
    };
    let mut renderer = Renderer::new(scene, backend, Arc::new(Threads::all()));
    renderer.feature = traced.feature;
    let (camera, integrator) = (&shot.camera, &traced.integrator);
    let rendered = match of_runs {
        Some(of_runs) => renderer.finish_runs((blank, of_runs), camera, (integrator, runs), &watch),
        None => renderer.finish(blank, camera, (integrator, spp), denoise, &watch),
    };
    watch.clear();
    Ok(Timed { rendered, seconds: start.elapsed().as_secs_f64() })
}

/// The scene made ready. What a device refuses the processor traces, unless the device is what is asked for.
fn backend(gpu: Option<&Gpu>, scene: &Scene, choice: DeviceChoice) -> anyhow::Result<Backend> {
    let _trees = trees::of(scene)?;
    match gpu.map(|gpu| Backend::on_the_device(gpu, scene)) {
        Some(Ok(backend)) => return Ok(backend),
        Some(Err(fault)) if choice == DeviceChoice::Gpu => return Err(fault).context(INSTEAD),
        Some(Err(fault)) => note!("note: the processor traces this, the graphics device does not: {fault}"),
        None => {}
    }
    Ok(Backend::on_the_processor(scene))
}
