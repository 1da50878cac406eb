//! `visavis ladder`: from the fake as taught to the truth in a folder of pictures, with a table, a chart and a sheet.

use super::sweep::devices;
use super::{LadderArgs, interrupt, reference};
use crate::ladder::{Climber, Reached, chart, csv, json, numbered, repairs_of, text};
use crate::model::{PlannedTile, SweepLine, SweepMeasure, SweepPlan, TileFacts};
use crate::ruler::ReferenceImage;
use crate::sweep::{Onlooker, Sheet, Tile, TileMaker};
use anyhow::Context;
use film::DisplayTransform;
use gpu::Gpu;
use std::io::IsTerminal;
use std::sync::Arc;
use technique::{Made, Shot};

/// Pictures in a row of the sheet.
const COLUMNS: usize = 4;

/// Whoever has asked at a terminal can end it.
struct Terminal;

impl Onlooker for Terminal {
    fn ends_now(&self) -> bool {
        interrupt::is_asked()
    }
}

pub fn run(args: &LadderArgs) -> anyhow::Result<()> {
    let shot = args.seen.of(&args.scene)?;
    let folder = image_file::shown(&args.folder);
    std::fs::create_dir_all(&args.folder).with_context(|| format!("cannot make the folder {folder}"))?;
    let gpu = Gpu::headless().context("the fake needs a GPU")?;
    let reference = ReferenceImage::of(&reference::obtain(&shot, None)?);
    let (repairs, idle) = repairs_of(&shot.scene);
    let _heeded = interrupt::heed();
    let mut climber = Climber::new((&shot, &reference), (&gpu, TileMaker::new(devices())), &Terminal, args.spp)?;
    let mut count = 0;
    let reached = climber.climb(&repairs, args.order, |rung| {
        count += 1;
        if std::io::stderr().is_terminal() {
            note!("{count}: {}: relMSE {:.4}, {:.1} ms", rung.rung.title(), rung.errors.errors.rel_mse, rung.anew_ms);
        }
    })?;
    save(args, &shot, &reached)?;
    if args.json {
        super::print(&format!("{}\n", json(&reached, &idle)))?;
    } else {
        super::print(&text(&reached, &idle))?;
        note!(
            "{} rungs of {}, with pictures, ladder.csv, ladder.svg and sheet.png: {folder}",
            reached.len(),
            shot.scene.name
        );
    }
    anyhow::ensure!(!interrupt::is_asked(), "{} rungs are saved: {folder}", reached.len());
    Ok(())
}

/// A picture a rung, the table, the chart and the sheet; each is there whole or not at all.
fn save(args: &LadderArgs, shot: &Shot, reached: &[Reached]) -> anyhow::Result<()> {
    let write = |name: &str, bytes: &[u8]| image_file::write_or_keep(&args.folder.join(name), bytes);
    let display = DisplayTransform::default();
    for (index, rung) in reached.iter().enumerate() {
        let Tile { image, facts, provenance, spp, made_by } = &rung.tile;
        let (seconds, exposure) = (facts.seconds, display.exposure);
        let records = provenance.records(Made { spp: *spp, seconds, adapter: made_by, denoised_by: None, exposure });
        let (width, height) = image.size();
        let bytes = image_file::encode_rgba8(width, height, &display.rgba8_of(image), &records)?;
        write(&format!("{}.png", numbered(index, rung.rung)), &bytes)?;
    }
    write("ladder.csv", csv(reached).as_bytes())?;
    write("ladder.svg", chart(&shot.scene.name, reached).as_bytes())?;
    let sheet = sheet(reached, display);
    let canvas = sheet.canvas().map_err(|fault| anyhow::anyhow!("{fault}"))?;
    write("sheet.png", &image_file::encode_rgba8(canvas.size.0, canvas.size.1, &canvas.rgba(), &Vec::new())?)?;
    Ok(())
}

/// All rungs side by side with their errors.
fn sheet(reached: &[Reached], display: DisplayTransform) -> Sheet {
    let names: Vec<String> = reached.iter().map(|rung| rung.rung.name().to_owned()).collect();
    let tiles = reached.iter().map(|rung| PlannedTile { names: vec![rung.rung.title().to_owned()], pane: rung.pane });
    let columns = names.iter().take(COLUMNS).cloned().collect();
    let rows = names.iter().step_by(COLUMNS).cloned().collect();
    let facts = |rung: &Reached| TileFacts {
        errors: Some(rung.errors),
        // what a frame takes, not what the first one took
        seconds: 1e-3 * rung.anew_ms,
        ..rung.tile.facts.clone()
    };
    Sheet {
        plan: SweepPlan {
            columns: SweepLine { setting: "rung", values: columns },
            rows: Some(SweepLine { setting: "from", values: rows }),
            tiles: tiles.collect(),
            seconds: None,
        },
        tiles: reached.iter().map(|rung| Some(Arc::new(rung.tile.clone()))).collect(),
        facts: reached.iter().map(facts).collect(),
        measure: SweepMeasure::RelMse,
        display,
    }
}
