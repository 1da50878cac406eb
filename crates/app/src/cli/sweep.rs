//! `visavis sweep`: many pictures of one scene with their captions as one picture, without a window.

use super::{SweepArgs, interrupt, reference, trees};
use crate::engine::restore::SESSION;
use crate::model::{
    Model, PlannedTile, SavedSession, SweepMeasure, SweepPlan, Theme, TileFacts, best, captions, sweep_csv,
};
use crate::ruler::ReferenceImage;
use crate::sweep::{Asked, Devices, Onlooker, Sheet, Tile, TileMaker, measure};
use anyhow::Context;
use film::DisplayTransform;
use gpu::Gpu;
use scene::Scene;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use technique::{Backend, Device, DeviceChoice, INSTEAD, Provenance, Shot, Technique, Threads};

pub fn run(args: &SweepArgs) -> anyhow::Result<()> {
    let shot = args.seen.of(&args.scene)?;
    let plan = args.plan(Some(&shot.scene)).map_err(anyhow::Error::msg)?;
    anyhow::ensure!(
        args.errors.is_none() || plan.tiles.iter().all(|tile| tile.pane.in_use().shows_the_scene()),
        "what shows no light has no errors: --errors needs pictures of it (show=picture, and no normals)"
    );
    anyhow::ensure!(
        args.errors.is_none() || plan.tiles.iter().any(|tile| tile.pane.in_use().has_a_reference()),
        "a part of the light has no errors: the reference has all of it; leave out --errors or light="
    );
    if args.jobs {
        return super::print(&jobs(args, &plan, &shot));
    }
    check_files(args)?;
    Sheet::check_size(&plan, &shot, args.errors.is_some())?;
    let _heeded = interrupt::heed();
    let tiles = make(&plan, &shot)?;
    let display = DisplayTransform { exposure: args.exposure };
    let measured = if args.errors.is_some() && !interrupt::is_asked() { judge(&shot).map(Some) } else { Ok(None) };
    let facts = facts_of(&plan, &tiles, (measured.as_ref().ok().and_then(Option::as_ref), &display))?;
    let tiles: Vec<_> = tiles.into_iter().map(|tile| Some(Arc::new(tile))).collect();
    let made = tiles.len();
    let mut padded = tiles.clone();
    padded.resize(plan.tiles.len(), None);
    let figure = args.errors.unwrap_or(SweepMeasure::RelMse);
    let sheet = Sheet { plan, tiles: padded, facts, measure: figure, display };
    save(args, &sheet, session_text(args, &shot, &sheet))?;
    let out = image_file::shown(&args.out);
    let count = sheet.plan.tiles.len();
    measured.with_context(|| format!("{made} tiles are saved, without their errors: {out}"))?;
    if args.json {
        super::print(&format!("{}\n", report(args, &sheet)))?;
    } else {
        for caption in captions(&sheet.plan, &sheet.facts, figure) {
            note!("{}", caption.join(", "));
        }
        note!("{count} tiles of {} at {}x{}: {out}", shot.scene.name, shot.size.0, shot.size.1);
    }
    anyhow::ensure!(!interrupt::is_asked(), "{made} of {count} tiles are saved: {out}");
    Ok(())
}

/// For each tile the line that makes it, for other machines.
fn jobs(args: &SweepArgs, plan: &SweepPlan, shot: &Shot) -> String {
    let outside = if scene::allows_files_outside() { " --allow-outside" } else { "" };
    let line = |(index, tile): (usize, &PlannedTile)| {
        let technique = tile.pane.in_use();
        let spp = match technique {
            Technique::Fake(_) => 1,
            Technique::Traced(traced) => traced.spp,
        };
        let out = args.out.with_extension(format!("{}.png", index + 1)).display().to_string();
        // a fake is drawn by the device that there is, and rays where each machine finds it best
        let device = if args.device == DeviceChoice::Gpu { Device::Gpu } else { technique.name().usual_device() };
        let command = Provenance { shot: shot.clone(), technique, device }.command(spp, args.exposure, &out);
        format!("{command}{outside}\n")
    };
    plan.tiles.iter().enumerate().map(line).collect()
}

/// Each is another file, and none the scene's.
fn check_files(args: &SweepArgs) -> anyhow::Result<()> {
    let scene = Path::new(&args.scene);
    for (option, file) in std::iter::once(("-o", &args.out)).chain(args.csv.iter().map(|csv| ("--csv", csv))) {
        let shown = image_file::shown(file);
        anyhow::ensure!(
            !image_file::is_same_file(scene, file),
            "{option} would overwrite the scene; give another name: {shown}"
        );
        image_file::check_writable(file)?;
    }
    let twice = args.csv.as_ref().filter(|csv| will_be_same_file(&args.out, csv));
    match twice {
        Some(csv) => anyhow::bail!(
            "-o and --csv are one file, which cannot be both; give another name: {}",
            image_file::shown(csv)
        ),
        None => Ok(()),
    }
}

/// Whether two names stand for one file, or will once it is there.
fn will_be_same_file(a: &Path, b: &Path) -> bool {
    let place = |file: &Path| {
        let file = std::path::absolute(file).ok()?;
        Some((file.parent()?.canonicalize().ok()?, file.file_name()?.to_owned()))
    };
    image_file::is_same_file(a, b) || matches!((place(a), place(b)), (Some(a), Some(b)) if a == b)
}

/// Whoever has asked at a terminal can end it.
struct Terminal;

impl Onlooker for Terminal {
    fn ends_now(&self) -> bool {
        interrupt::is_asked()
    }
}

/// One tile after the other, until the user has enough.
fn make(plan: &SweepPlan, shot: &Shot) -> anyhow::Result<Vec<Tile>> {
    let mut maker = TileMaker::new(devices());
    let limit = plan.seconds.map(Duration::from_secs_f32);
    let mut tiles = Vec::new();
    for planned in &plan.tiles {
        if interrupt::is_asked() {
            break;
        }
        let asked = Asked { shot, pane: &planned.pane, limit };
        let tile = maker.finish(asked, None, &Terminal).with_context(|| planned.name())?;
        tile.facts.fault.iter().for_each(|fault| note!("note: {}: {fault}", planned.name()));
        tiles.push(tile);
    }
    anyhow::ensure!(!tiles.is_empty(), "no tile was made");
    Ok(tiles)
}

/// What the fake is drawn by, and what rays are traced on.
pub fn devices() -> Devices {
    Devices {
        threads: Arc::new(Threads::all()),
        open_gpu: Box::new(|| Gpu::headless().context("the raster technique needs a GPU")),
        ready: Box::new(|traced, scene, samples| {
            let choice = traced.device_choice();
            let _trees = trees::of(scene)?;
            match choice.open(samples)?.map(|gpu| Backend::on_the_device(&gpu, scene)) {
                Some(Ok(backend)) => Ok((backend, None)),
                Some(Err(fault)) if choice == DeviceChoice::Gpu => Err(fault).context(INSTEAD),
                Some(Err(fault)) => {
                    Ok((Backend::on_the_processor(scene), Some(format!("by the CPU: the GPU failed: {fault}"))))
                }
                None => Ok((Backend::on_the_processor(scene), None)),
            }
        }),
    }
}

fn judge(shot: &Shot) -> anyhow::Result<ReferenceImage> {
    Ok(ReferenceImage::of(&reference::obtain(shot, None)?))
}

/// What is known of each tile, with its errors where there is a reference.
fn facts_of(
    plan: &SweepPlan,
    tiles: &[Tile],
    (reference, display): (Option<&ReferenceImage>, &DisplayTransform),
) -> anyhow::Result<Vec<TileFacts>> {
    let facts = |tile: &Tile| {
        let judged = reference.filter(|_| tile.provenance.technique.has_a_reference());
        let errors = judged.map(|reference| measure(&tile.image, reference, display)).transpose()?;
        Ok(TileFacts { errors, ..tile.facts.clone() })
    };
    let mut all: Vec<TileFacts> = tiles.iter().map(facts).collect::<anyhow::Result<_>>()?;
    all.resize(plan.tiles.len(), TileFacts::default());
    Ok(all)
}

/// The session of a window that shows these tiles.
fn session_text(args: &SweepArgs, shot: &Shot, sheet: &Sheet) -> String {
    let mut model = Model::new(Scene::clone(&shot.scene), shot.source.clone(), Theme::default());
    (model.document.changes, model.session.display) = (shot.changes.clone(), sheet.display);
    model.session.sweep.measure = sheet.measure;
    model.session.panes.insert(model.session.sweep.of, args.base(Some(&shot.scene)));
    model.session.show_sweep(&sheet.plan);
    SavedSession::of(&model, None).text(&shot.scene, &shot.source)
}

fn save(args: &SweepArgs, sheet: &Sheet, session: String) -> anyhow::Result<()> {
    image_file::write_or_keep(&args.out, &sheet.png(vec![(SESSION, session)])?)?;
    if let Some(csv) = &args.csv {
        image_file::write_or_keep(csv, sweep_csv(&sheet.plan, &sheet.facts).as_bytes())?;
    }
    Ok(())
}

/// One object about the tiles and what they took.
fn report(args: &SweepArgs, sheet: &Sheet) -> Value {
    let Sheet { plan, tiles, facts, measure, .. } = sheet;
    let best = best(facts, *measure);
    let tile = |(index, (planned, facts)): (usize, (&crate::model::PlannedTile, &TileFacts))| {
        let made = tiles[index].as_ref();
        json!({
            "name": planned.name(),
            "technique": planned.pane.technique.name(),
            "spp": facts.spp,
            "seconds": facts.seconds,
            "done": facts.done,
            "adapter": made.map(|tile| tile.made_by.clone()),
            "command": made.map(|tile| tile.command(args.exposure)),
            "best": best.contains(&index),
            "errors": facts.errors.map(|e| json!({
                "against": "reference", "relmse": e.errors.rel_mse, "rmse": e.errors.rmse, "mae": e.errors.mae,
                "flip": e.flip, "reference_noise": e.errors.reference_noise,
            })),
        })
    };
    let rows = plan.rows.as_ref().map(|rows| json!({ "setting": rows.setting, "values": rows.values }));
    json!({
        "scene": args.scene,
        "width": args.seen.size.0,
        "height": args.seen.size.1,
        "columns": { "setting": plan.columns.setting, "values": plan.columns.values },
        "rows": rows,
        // in as few digits as were typed
        "time": plan.seconds.and_then(|seconds| seconds.to_string().parse::<f64>().ok()),
        "tiles": plan.tiles.iter().zip(facts).enumerate().map(tile).collect::<Vec<_>>(),
    })
}
