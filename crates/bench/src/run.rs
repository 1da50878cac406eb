//! A whole bench: plan, references, measurements, and what is written about them.

use crate::clock::{Clock, Progress};
use crate::host::{Host, peak_memory, today};
use crate::journal::{self, Journal, Run};
use crate::line::Line;
use crate::measure::{self, Measurement};
use crate::page::Page;
use crate::peer::{self, PeerRow};
use crate::pictures::{self, PicturePair};
use crate::plan::{self, Effort, Part, SEEDS};
use crate::plots::{self, duration};
use crate::references::{self, Truth};
use crate::summary::{PartSummary, slope_words};
use crate::variant::MakeTracer;
use crate::{BenchError, tables};
use gpu::Gpu;
use image_file::{check_writable, write_whole};
use pathtrace::Integrator;
use raster::Raster;
use reference::Store;
use scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use technique::{Backend, FakeSettings, Renderer, Technique, Threads, TracedSettings};

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Options {
    /// Folder for everything that is written.
    pub folder: PathBuf,
    /// How long it may take.
    pub effort: Effort,
    /// Names of the scenes, of [`plan::SCENES`]; empty for all.
    pub scenes: Vec<String>,
    /// Tables of other programs.
    pub peers: Vec<PathBuf>,
    /// Version and build of this program: measurements of another one are not mixed with its own.
    pub program: String,
    /// The command line, for the page.
    pub command: String,
}

/// What came of it.
#[derive(Debug)]
pub struct Outcome {
    /// The page.
    pub page: PathBuf,
    /// What was left out or went wrong, a sentence each.
    pub notes: Vec<String>,
    /// Measurements that were there already.
    pub kept: usize,
    /// All measurements.
    pub measurements: usize,
    /// The lines at their last rung, as plain text.
    pub table: String,
}

/// Name of the page.
const PAGE: &str = "bench.html";
/// Names of the tables.
const MEASUREMENTS: &str = "measurements.csv";
const SUMMARY: &str = "summary.csv";
/// Forecast of a fake's measurement, in seconds.
const FAKE_SECONDS: f64 = 0.1;

struct Bench<'a> {
    journal: Journal,
    store: Store,
    raster: Option<Raster>,
    gpu: Option<Gpu>,
    threads: Arc<Threads>,
    clock: Clock,
    notes: Vec<String>,
    /// Parts and lines whose device was timed by the wall's clock.
    by_the_wall: Vec<(String, String)>,
    progress: &'a mut dyn FnMut(&Progress),
}

/// Runs it, or goes on with it. `progress` is told now and then.
///
/// # Errors
/// [`BenchError`], one line; what was measured before stays in the journal.
pub fn run(options: &Options, progress: &mut dyn FnMut(&Progress)) -> Result<Outcome, BenchError> {
    let start = Instant::now();
    let peers: Vec<PeerRow> =
        options.peers.iter().map(|path| peer::read(path)).collect::<Result<Vec<_>, _>>()?.concat();
    let folder = &options.folder;
    std::fs::create_dir_all(folder).map_err(|why| BenchError::Folder { why, folder: folder.clone() })?;
    [PAGE, MEASUREMENTS, SUMMARY].iter().try_for_each(|name| check_writable(&folder.join(name)))?;
    let mut notes = Vec::new();
    let (raster, gpu, adapter) = rasteriser();
    if raster.is_none() {
        notes.push(format!("The fakes are left out: {adapter}."));
    }
    let host = Host::this(adapter);
    let run = Run { program: options.program.clone(), host, effort: options.effort, scenes: options.scenes.clone() };
    let (journal, parts) = Journal::open(folder, &run, || plan::plan(options))?;
    let store = Store::of_the_user().unwrap_or_else(|why| {
        notes.push(format!("References are kept with the results: {why}."));
        Store::new(folder.join("references"), Store::MOST_BYTES)
    });
    let with_lines = |part: &Part| Ok((part.clone(), part.lines(&part.scene()?)));
    let planned: Vec<(Part, Vec<Line>)> = parts.iter().map(with_lines).collect::<Result<_, BenchError>>()?;
    let ahead = planned.iter().map(|(part, lines)| forecast(&journal, part, lines)).sum();
    let kept = journal.measurements().len();
    let mut bench = Bench {
        journal,
        store,
        raster,
        gpu,
        threads: Arc::new(Threads::all()),
        clock: Clock::new(ahead),
        notes,
        by_the_wall: Vec::new(),
        progress,
    };
    let mut pairs = Vec::new();
    for (part, lines) in &planned {
        pairs.push((part.title(), bench.part(part, lines)?));
    }
    let summaries: Vec<PartSummary> =
        planned.iter().filter_map(|(part, lines)| summary(&bench.journal, part, lines, &peers)).collect();
    write_tables(folder, &planned, &summaries, bench.journal.measurements())?;
    let page = folder.join(PAGE);
    let parts = summaries.iter().map(|summary| (summary, plots::of(summary))).collect::<Vec<_>>();
    for plot in parts.iter().flat_map(|(_, plots)| plots) {
        write_whole(&folder.join(format!("{}.svg", plot.name)), plot.svg.as_bytes())?;
    }
    let made = provenance(options, &run.host, kept, bench.journal.measurements().len(), start);
    let html = Page { parts, pairs, notes: &bench.notes, by_the_wall: &bench.by_the_wall, made }.html();
    write_whole(&page, html.as_bytes())?;
    if !bench.by_the_wall.is_empty() {
        let lines = bench.by_the_wall.len();
        bench.notes.push(format!("Seconds of {lines} lines are in part by the wall's clock; the page says of which."));
    }
    let measurements = bench.journal.measurements().len();
    Ok(Outcome { page, notes: bench.notes, kept, measurements, table: text(&summaries) })
}

/// What draws the fakes, its device and its description, or why nothing does.
fn rasteriser() -> (Option<Raster>, Option<Gpu>, String) {
    let opened = Gpu::headless()
        .map_err(|why| why.to_string())
        .and_then(|gpu| Ok((Raster::new(&gpu).map_err(|why| why.to_string())?, gpu)));
    match opened {
        Ok((raster, gpu)) => (Some(raster), Some(gpu.clone()), gpu.describe()),
        Err(why) => (None, None, why.lines().collect::<Vec<_>>().join(", ")),
    }
}

/// Seconds that a part still takes.
fn forecast(journal: &Journal, part: &Part, lines: &[Line]) -> f64 {
    let missing = lines.iter().flat_map(|line| part.rungs(line).into_iter().map(move |spp| (line, spp)));
    let missing = missing.filter(|(line, spp)| journal.find(&part.name, &line.name(), *spp).is_none());
    let seconds: f64 = missing.map(|(line, spp)| forecast_of(part, line, spp)).sum();
    if seconds > 0.0 { seconds + part.forecast_reference() } else { 0.0 }
}

fn forecast_of(part: &Part, line: &Line, spp: u32) -> f64 {
    if matches!(line.technique, Technique::Fake(_)) { FAKE_SECONDS } else { part.seconds(line, spp) }
}

impl Bench<'_> {
    /// Measures what is missing of a part, and makes its pictures.
    fn part(&mut self, part: &Part, lines: &[Line]) -> Result<Vec<PicturePair>, BenchError> {
        let scene = Arc::new(part.scene()?);
        let mut renderer = Renderer::on_the_processor(scene.clone(), self.threads.clone());
        let truth = self.reference(part, &mut renderer)?;
        for line in lines {
            let mut processor = match (line.technique, line.variant.tracer) {
                (Technique::Traced(_), MakeTracer::Cpu(tracer)) => Some(Backend::from(tracer(&scene))),
                _ => None,
            };
            for (rung, spp) in part.rungs(line).into_iter().enumerate() {
                if self.journal.find(&part.name, &line.name(), spp).is_some() {
                    continue;
                }
                let what = format!("{}: {}, {spp} spp", part.name, line.name());
                (self.progress)(&self.clock.progress(&what, 0.0));
                let measured = match (&line.technique, &mut processor) {
                    (Technique::Fake(fake), _) => self.fake(part, &scene, line, fake, &truth)?,
                    (Technique::Traced(TracedSettings { integrator, .. }), Some(backend)) => {
                        Some(measure::traced(part, &scene, backend, (line, integrator), rung, &truth)?)
                    }
                    (Technique::Traced(TracedSettings { integrator, .. }), None) => {
                        self.on_gpu(part, &scene, (line, integrator), &truth)?
                    }
                };
                measured.map_or(Ok(()), |measured| self.journal.add(measured))?;
                self.clock.done(forecast_of(part, line, spp));
            }
        }
        pictures::of(part, &mut renderer, self.raster.as_mut(), &truth)
    }

    fn reference(&mut self, part: &Part, renderer: &mut Renderer) -> Result<Truth, BenchError> {
        let forecast = part.forecast_reference();
        let what = format!("{}: reference", part.name);
        let (clock, progress) = (&mut self.clock, &mut self.progress);
        // what an earlier run has made of it takes no time
        let mut there = None;
        let mut tell = |share: f64| {
            let there = *there.get_or_insert_with(|| {
                clock.skip(share * forecast);
                share
            });
            progress(&clock.progress(&what, (share - there) * forecast));
        };
        let (truth, fault) = references::make(part, renderer, Some(&self.store), &mut tell)?;
        self.notes.extend(fault.map(|why| format!("The reference of {}: {why}.", part.name)));
        self.clock.done((1.0 - there.unwrap_or(0.0)) * forecast);
        Ok(truth)
    }

    /// What the graphics device makes of a line; one that fails leaves it out, and is told of.
    fn on_gpu(
        &mut self,
        part: &Part,
        scene: &Scene,
        (line, integrator): (&Line, &Integrator),
        truth: &Truth,
    ) -> Result<Option<Measurement>, BenchError> {
        let (Some(gpu), MakeTracer::Gpu(tracer)) = (&self.gpu, line.variant.tracer) else { return Ok(None) };
        let measured = tracer(gpu, scene).map_err(BenchError::from).and_then(|tracer| {
            let mut backend = Backend::from(tracer);
            let measured = measure::traced(part, scene, &mut backend, (line, integrator), 0, truth);
            Ok((measured?, backend.is_timed_by_the_wall()))
        });
        let measured = measured.map(|(measured, by_the_wall)| {
            if by_the_wall {
                self.by_the_wall.push((part.name.clone(), line.name()));
            }
            measured
        });
        match measured {
            Err(BenchError::Gpu(why)) => {
                self.notes.push(format!("{} of {} is left out: {why}.", line.name(), part.name));
                Ok(None)
            }
            measured => measured.map(Some),
        }
    }

    /// A fake's measurement; a device that fails leaves it out, and is told of once a part.
    fn fake(
        &mut self,
        part: &Part,
        scene: &Scene,
        line: &Line,
        fake: &FakeSettings,
        truth: &Truth,
    ) -> Result<Option<Measurement>, BenchError> {
        let Some(raster) = &mut self.raster else { return Ok(None) };
        match measure::drawn(part, scene, raster, (line, fake), truth) {
            Ok(measured) => measured.map(Some),
            Err(why) => {
                self.notes.push(format!("The fake ({}) of {} is left out: {why}.", fake.fake.name(), part.name));
                Ok(None)
            }
        }
    }
}

/// What is known of a part; `None` if nothing is.
fn summary(journal: &Journal, part: &Part, lines: &[Line], peers: &[PeerRow]) -> Option<PartSummary> {
    let worth = journal.measurements().iter().rfind(|m| m.part == part.name)?.reference;
    Some(PartSummary::new(part, worth, lines, journal.measurements(), peers))
}

fn write_tables(
    folder: &Path,
    planned: &[(Part, Vec<Line>)],
    summaries: &[PartSummary],
    measurements: &[Measurement],
) -> Result<(), BenchError> {
    write_whole(&folder.join(MEASUREMENTS), tables::pictures(planned, measurements).as_bytes())?;
    Ok(write_whole(&folder.join(SUMMARY), tables::summary(summaries).as_bytes())?)
}

fn provenance(
    options: &Options,
    host: &Host,
    kept: usize,
    measurements: usize,
    start: Instant,
) -> Vec<(&'static str, String)> {
    let memory = peak_memory().map_or("not told by this system".into(), |bytes| {
        format!("{:.0} MiB, of the whole process (VmHWM)", bytes as f64 / f64::from(1 << 20))
    });
    let resumed = if kept > 0 {
        format!(", {kept} of them by an earlier run that was interrupted or repeated")
    } else {
        String::new()
    };
    vec![
        ("command", options.command.clone()),
        ("program", format!("visavis {}", options.program)),
        ("date", today()),
        ("processor", format!("{}, {} threads", host.cpu, host.threads)),
        ("system", host.system.clone()),
        ("adapter of the fakes", host.adapter.clone()),
        ("measurements", format!("{measurements} of {SEEDS} pictures each{resumed}")),
        ("time of this run", duration(start.elapsed().as_secs_f64())),
        ("most memory held", memory),
        (
            "to repeat it",
            format!(
                "the same command with another -o; pictures are the same with the same program and sizes, errors as far as the references are, \
                 seconds are the machine's. Every picture is in measurements.csv, every point in summary.csv, what each \
                 column means in docs/bench.md; {} is what an interrupted run goes on with",
                journal::NAME
            ),
        ),
    ]
}

/// The lines at their last rung, for a terminal.
fn text(summaries: &[PartSummary]) -> String {
    let mut text = String::new();
    for summary in summaries {
        let (part, worth) = (&summary.part, &summary.worth);
        text += &format!(
            "{}, {}x{}, reference {} spp, its own relMSE {:.1e}{}\n",
            part.name,
            part.width,
            part.height,
            worth.spp,
            worth.rel_mse,
            if worth.is_reliable() { "" } else { " (unreliable: heavy tail)" }
        );
        text += &format!("  {:<34}{:>6}{:>10}{:>10}{:>10}  slope\n", "", "spp", "time", "RMSE", "relMSE");
        for curve in &summary.curves {
            let Some(point) = curve.last() else { continue };
            let flag = if point.below_reference_noise { "  below the reference's noise" } else { "" };
            text += &format!(
                "  {:<34}{:>6}{:>10}{:>10.2e}{:>10.2e}  {}{flag}\n",
                curve.line.name(),
                point.spp,
                duration(point.seconds.median),
                point.rmse.median,
                point.rel_mse.median,
                curve.slope.map(|fit| slope_words(&fit)).unwrap_or_default()
            );
        }
    }
    text
}
