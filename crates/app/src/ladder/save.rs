//! A ladder as a folder of files, the same from window and command line.

use super::{Reached, chart, csv, numbered};
use crate::model::{PlannedTile, SweepLine, SweepMeasure, SweepPlan, TileFacts};
use crate::sweep::{Sheet, Tile};
use anyhow::Context;
use film::DisplayTransform;
use std::path::Path;
use technique::Made;

/// Pictures in a row of the sheet.
const COLUMNS: usize = 4;

/// A picture a rung, the table, the chart and the sheet into a folder, which is made if it is not there; each file is there whole
/// or not at all.
///
/// # Errors
/// If the folder or a file can't be written: one line.
pub fn save(folder: &Path, scene: &str, reached: &[Reached]) -> anyhow::Result<()> {
    let name_of_folder = image_file::shown(folder);
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {name_of_folder}"))?;
    let write = |name: &str, bytes: &[u8]| image_file::write_or_keep(&folder.join(name), bytes);
    let display = DisplayTransform::default();
    for (index, rung) in reached.iter().enumerate() {
        let Tile { image, facts, provenance, spp, made_by } = &*rung.tile;
        let (seconds, exposure) = (facts.seconds, display.exposure);
        let records = provenance.records(Made { spp: *spp, seconds, adapter: made_by, denoised_by: None, exposure });
        let (width, height) = image.size();
        let bytes = image_file::encode_rgba8(width, height, &display.rgba8_of(image), &records)?;
        write(&format!("{}.png", numbered(index, rung.rung)), &bytes)?;
    }
    write("ladder.csv", csv(reached).as_bytes())?;
    write("ladder.svg", chart(scene, reached).as_bytes())?;
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
        tiles: reached.iter().map(|rung| Some(rung.tile.clone())).collect(),
        facts: reached.iter().map(facts).collect(),
        measure: SweepMeasure::RelMse,
        display,
    }
}
