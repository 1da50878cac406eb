//! `visavis report`: both pictures and their reference, made without a window, as a page or a slide.

use super::args::ReportKind;
use super::{RenderArgs, ReportArgs, Seen, interrupt, reference, render};
use crate::engine::beginning::Beginning;
use crate::engine::session::SessionToSave;
use crate::engine::view_records::{file_of, records_of_view};
use crate::lab_report::{LabReport, ReportedPicture, ReportedReference, SlideColours};
use crate::model::{
    Against, CompareWith, Curve, ErrorPoint, Model, PaneId, PaneSource, PictureArea, SavedSession, SlideSize, Theme,
    View,
};
use crate::ruler::ReferenceImage;
use anyhow::{Context, bail, ensure};
use scene::Scene;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use technique::settings::{Value, of_panes};
use technique::{BlindSpot, DenoiseSettings, Denoised, DeviceChoice, Frame, PaneSettings, Provenance, Shot, Technique};

pub fn run(args: &ReportArgs) -> anyhow::Result<()> {
    ensure!(
        !image_file::is_same_file(Path::new(&args.view.scene), &args.out),
        "-o would overwrite what is reported on; give another name: {}",
        image_file::shown(&args.out)
    );
    image_file::check_writable(&args.out)?;
    let beginning = Beginning::read(&args.view.scene)?;
    beginning.opened.notes.iter().for_each(|line| note!("note: {line}"));
    let model = model(&beginning, args)?;
    let shot = model.document.shot(&model.state.picture);
    let panes = panes(&model, args.kind);
    for (pane, settings) in &panes {
        check(&model, *pane, settings)?;
    }
    let _heeded = interrupt::heed();
    let reference = reference_of(&model, &shot, &panes)?;
    let mut report = LabReport {
        scene: model.document.scene.clone(),
        session: model.session.clone(),
        pictures: Vec::new(),
        reference,
        curves: Vec::new(),
        session_text: session_text(&model, &args.out),
        date: bench::today(),
    };
    for (pane, settings) in &panes {
        let (picture, points) = picture(args, &shot, (*pane, settings), report.reference.as_ref())?;
        report.curves.extend(Curve::of_pane(*pane, &picture.provenance, points, (Against::Reference, None), None));
        report.pictures.push(picture);
    }
    save(args, &report, &model, &shot)?;
    let out = image_file::shown(&args.out);
    ensure!(!interrupt::is_asked(), "the pictures as far as they came are saved: {out}");
    note!(
        "{} of {}: {out}",
        if matches!(args.kind, ReportKind::Page(_)) { "report" } else { "slide" },
        report.scene.name
    );
    Ok(())
}

/// What a window would show that is opened with these words, held against the reference unless they say otherwise.
fn model(beginning: &Beginning, args: &ReportArgs) -> anyhow::Result<Model> {
    let mut model = beginning.model(&args.view)?;
    let comparison = &mut model.session.comparison;
    comparison.with = args.view.setup.with.unwrap_or(CompareWith::Reference);
    args.view.device.into_iter().for_each(|device| model.session.trace_on(device));
    let samples = of_panes("spp").zip(args.spp);
    for pane in model.session.panes.values_mut() {
        pane.denoise.history = 0;
        if let Some((row, spp)) = samples.filter(|(row, _)| row.is_of(pane.technique)) {
            pane.set(row, Value::Whole(spp));
        }
    }
    let (width, height) = match args.kind {
        ReportKind::Page(size) => size,
        ReportKind::Slide(size) => size.size_of_pictures(model.session.view),
    };
    let area = [width as f32, height as f32];
    model.state.picture = PictureArea::new(area, area, 1, [0.0, 0.0, area[0], area[1]]);
    model.place_line();
    model.settle(false);
    Ok(model)
}

/// A slide of one pane needs no other.
fn panes(model: &Model, kind: ReportKind) -> Vec<(PaneId, PaneSettings)> {
    let is_seen = |pane: PaneId| match (kind, model.session.view) {
        (ReportKind::Slide(_), View::Pane(seen)) => pane == seen,
        _ => true,
    };
    model.session.panes.iter().filter(|(pane, _)| is_seen(*pane)).map(|(pane, settings)| (pane, *settings)).collect()
}

/// Settings that make no picture are refused before any is made.
fn check(model: &Model, pane: PaneId, settings: &PaneSettings) -> anyhow::Result<()> {
    ensure!(
        *model.session.source(pane) == PaneSource::Made,
        "{pane} is another program's picture, which the window alone shows: save its report from there (Export, Report)"
    );
    let Technique::Traced(traced) = settings.in_use() else { return Ok(()) };
    if let Some(why) = traced.needs_the_processor()
        && settings.device == DeviceChoice::Gpu
    {
        bail!("{pane} cannot be made by the gpu: {why}");
    }
    traced.integrator.check().with_context(|| format!("{pane} cannot be made"))
}

/// What judges the pictures, where one of them shows the scene's light.
fn reference_of(
    model: &Model,
    shot: &Shot,
    panes: &[(PaneId, PaneSettings)],
) -> anyhow::Result<Option<ReportedReference>> {
    let is_judged = panes.iter().any(|(_, settings)| settings.in_use().has_a_reference());
    if model.session.comparison.with == CompareWith::EachOther || !is_judged {
        return Ok(None);
    }
    let reference = reference::obtain(shot, None)?;
    let made = reference::course(&reference);
    Ok(Some(ReportedReference { image: ReferenceImage::of(&reference), made }))
}

fn session_text(model: &Model, out: &Path) -> String {
    let document = &model.document;
    let (scene, source) = (document.scene.clone(), document.source.clone());
    let folder = std::path::absolute(out).ok().and_then(|out| out.parent().map(Path::to_owned));
    SessionToSave { session: SavedSession::of(model, None), scene, source }.text_in(&folder.unwrap_or_default())
}

/// One pane's picture, and how its errors fell.
fn picture(
    args: &ReportArgs,
    shot: &Shot,
    (pane, settings): (PaneId, &PaneSettings),
    reference: Option<&ReportedReference>,
) -> anyhow::Result<(ReportedPicture, Vec<ErrorPoint>)> {
    let technique = settings.in_use();
    let own = render_args(args, shot, settings);
    let judge = reference.filter(|_| technique.has_a_reference()).map(|reference| &reference.image);
    let follower = Follower::new(judge.filter(|_| technique.runs() == 1 && !technique.denoise().is_on()));
    let before = core_seconds();
    let timed = match technique {
        Technique::Fake(fake) => render::raster(&own, &fake.applied_to(&shot.scene), fake),
        Technique::Traced(traced) => render::trace(&own, shot, traced, Some(&|frame| follower.follow(frame))),
    };
    let render::Timed { rendered, seconds } = timed.with_context(|| format!("{pane} cannot be made"))?;
    let (measuring, mut points) = follower.into_points();
    let seconds = seconds - measuring.as_secs_f64();
    let core_seconds = core_seconds().zip(before).map(|(after, before)| after - before - measuring.as_secs_f64());
    let spp = matches!(technique, Technique::Traced(_)).then(|| rendered.film.samples_per_pixel());
    let ended = ended_early(&technique, rendered.runs, spp);
    let (image, mut technique) = (render::picture_of(&rendered), technique.with_runs(rendered.runs));
    if let (Some(Err(_)), Technique::Traced(traced)) = (&rendered.denoised, &mut technique) {
        traced.denoise = DenoiseSettings::OFF;
    }
    if let Some(errors) = judge.map(|judge| judge.errors(&image)).transpose()? {
        points.retain(|point| point.spp < spp);
        points.push(ErrorPoint { spp, seconds, errors });
    }
    let mut notes = notes(&technique, &shot.scene, rendered.film.nonfinite);
    notes.extend(ended);
    match &rendered.denoised {
        Some(Ok(Denoised { seconds, .. })) => notes.push(format!("denoising took {seconds:.2} s")),
        Some(Err(fault)) => notes.push(format!("not denoised: {fault}")),
        None => {}
    }
    let picture = ReportedPicture {
        pane,
        image,
        provenance: Provenance { shot: shot.clone(), technique, device: rendered.device },
        external: None,
        spp,
        runs: rendered.runs,
        seconds,
        core_seconds,
        stats: spp.map(|_| rendered.stats),
        adapter: rendered.made_by,
        notes,
    };
    Ok((picture, points))
}

/// "ended at 1 of 100000 samples per pixel": what an interruption or a limit of time has left of what was asked for.
fn ended_early(wished: &Technique, runs: u32, spp: Option<u32>) -> Option<String> {
    let Technique::Traced(traced) = wished else { return None };
    let spp = spp? / runs.max(1);
    let samples = (spp < traced.spp).then(|| format!("{spp} of {} samples per pixel", traced.spp));
    let runs = (runs < wished.runs()).then(|| format!("{runs} of {} runs", wished.runs()));
    let parts: Vec<String> = samples.into_iter().chain(runs).collect();
    (!parts.is_empty()).then(|| format!("ended at {}", parts.join(", ")))
}

/// What of a picture is to be known where it is read.
fn notes(technique: &Technique, scene: &Scene, nonfinite: u64) -> Vec<String> {
    let mut notes = Vec::new();
    if let Technique::Traced(traced) = technique {
        notes.extend(
            traced.blind_spots(scene).into_iter().filter_map(BlindSpot::explanation).map(|line| line.to_string()),
        );
    }
    if nonfinite > 0 {
        notes.push(format!("{nonfinite} samples were not finite and are left out"));
    }
    notes
}

/// What `visavis render` would be asked for.
fn render_args(args: &ReportArgs, shot: &Shot, settings: &PaneSettings) -> RenderArgs {
    RenderArgs {
        scene: shot.source.clone(),
        original: None,
        out: args.out.clone(),
        pane: *settings,
        seen: Seen { changes: shot.changes.clone(), size: shot.size, ..Seen::default() },
        device: settings.device,
        spp: settings.wished_spp(),
        samples: None,
        jobs: None,
        seconds: args.seconds,
        exposure: 0.0,
        errors: false,
        layers: false,
        json: false,
        without_effect: Vec::new(),
        given: Vec::new(),
        chose_estimator: true,
    }
}

fn save(args: &ReportArgs, report: &LabReport, model: &Model, shot: &Shot) -> anyhow::Result<()> {
    let bytes = match args.kind {
        ReportKind::Page(_) => report.html()?.into_bytes(),
        ReportKind::Slide(size) => slide(report, size, model, shot)?,
    };
    Ok(image_file::write_or_keep(&args.out, &bytes)?)
}

/// With records as a picture as seen has them: it opens as what it shows.
fn slide(report: &LabReport, size: SlideSize, model: &Model, shot: &Shot) -> anyhow::Result<Vec<u8>> {
    let rgba = report.slide(size, SlideColours::of(model.state.theme == Theme::Dark))?;
    let exposure = model.session.display.exposure;
    let commands = report.pictures.iter().map(|picture| {
        let spp = picture.spp.unwrap_or(1) / picture.runs.max(1);
        (picture.pane, picture.provenance.command(spp, exposure, &file_of(picture.pane)))
    });
    let records = records_of_view(model, Some((shot, &model.document.camera)), commands);
    let (width, height) = size.pixels();
    Ok(image_file::encode_rgba8(width, height, &rgba, &records)?)
}

/// Measures a picture at every doubling of its samples while it is made.
struct Follower<'a> {
    judge: Option<&'a ReferenceImage>,
    followed: Mutex<Followed>,
}

#[derive(Default)]
struct Followed {
    points: Vec<ErrorPoint>,
    /// How long measuring took, which is no time of rendering.
    measuring: Duration,
}

impl<'a> Follower<'a> {
    fn new(judge: Option<&'a ReferenceImage>) -> Self {
        Follower { judge, followed: Mutex::default() }
    }

    fn follow(&self, frame: &Frame) {
        let begin = Instant::now();
        let spp = frame.film.samples_per_pixel();
        let Some(judge) = self.judge.filter(|_| spp > 0) else { return };
        let mut followed = self.followed.lock().unwrap_or_else(PoisonError::into_inner);
        let is_due = followed.points.last().and_then(|point| point.spp).is_none_or(|latest| spp / 2 >= latest);
        if is_due && let Ok(errors) = judge.errors(&frame.film.image()) {
            followed.points.push(ErrorPoint { spp: Some(spp), seconds: frame.seconds, errors });
        }
        followed.measuring += begin.elapsed();
    }

    fn into_points(self) -> (Duration, Vec<ErrorPoint>) {
        let Followed { points, measuring } = self.followed.into_inner().unwrap_or_else(PoisonError::into_inner);
        (measuring, points)
    }
}

/// Processor time of all threads so far, where the system tells.
#[cfg(unix)]
fn core_seconds() -> Option<f64> {
    let spent = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(spent.tv_sec as f64 + 1e-9 * spent.tv_nsec as f64)
}

#[cfg(not(unix))]
fn core_seconds() -> Option<f64> {
    None
}
