//! `visavis ladder`: from the fake as taught to the truth in a folder of pictures, with a table, a chart and a sheet.

use super::sweep::devices;
use super::{LadderArgs, interrupt, reference};
use crate::ladder::{Climber, Reached, RungMaker, json, save, text};
use crate::model::repairs_of;
use crate::ruler::ReferenceImage;
use crate::sweep::{Onlooker, TileMaker};
use anyhow::Context;
use gpu::Gpu;
use std::io::IsTerminal;

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
    let (mut repairs, idle) = repairs_of(&shot.scene);
    repairs.retain(|repair| args.repairs.has(*repair));
    let _heeded = interrupt::heed();
    let mut maker = RungMaker::new(&gpu, TileMaker::new(devices()), 0)?;
    let (maker, onlooker, of_all) = (&mut maker, &Terminal, Some(&reference));
    let mut climber = Climber { shot: &shot, reference: of_all, maker, onlooker, spp: args.spp };
    let mut reached: Vec<Reached> = Vec::new();
    climber.climb(&repairs, args.order, |made| {
        let rung = made.measured(&reference)?;
        if std::io::stderr().is_terminal() {
            let (count, rel_mse) = (reached.len() + 1, rung.errors.errors.rel_mse);
            note!("{count}: {}: relMSE {rel_mse:.4}, {:.1} ms", rung.rung.title(), rung.anew_ms);
        }
        reached.push(rung);
        Ok(())
    })?;
    save(&args.folder, &shot.scene.name, &reached)?;
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
