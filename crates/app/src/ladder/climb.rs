//! Climbs: makes a picture on each rung, measures it against the reference, and times it.

use super::{Rung, repaired};
use crate::model::TileErrors;
use crate::ruler::ReferenceImage;
use crate::sweep::{Asked, Onlooker, Tile, TileMaker, measure};
use anyhow::Context;
use film::DisplayTransform;
use gpu::Gpu;
use raster::{Raster, Repair, Repairs};
use std::time::Instant;
use technique::settings::{Value, of_panes};
use technique::{PaneSettings, Shot, Technique, TechniqueName};

/// In which order defects are repaired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Order {
    /// That in which light meets them.
    #[default]
    Light,
    /// First what takes most error away for its milliseconds, of what is left.
    BestFirst,
}

impl Order {
    /// Both, the usual one first.
    pub const ALL: [Order; 2] = [Order::Light, Order::BestFirst];

    /// On the command line.
    pub fn name(self) -> &'static str {
        match self {
            Order::Light => "light",
            Order::BestFirst => "best-first",
        }
    }
}

/// A rung that was climbed.
#[derive(Debug, Clone)]
pub struct Reached {
    /// The rung that was reached.
    pub rung: Rung,
    /// The picture there, and what makes it again.
    pub tile: Tile,
    /// How it is made.
    pub pane: PaneSettings,
    /// How far it is from the reference.
    pub errors: TileErrors,
    /// A frame when only the camera moves: maps stay. Of rays the whole picture.
    pub frame_ms: f64,
    /// A frame when the scene has changed: maps are drawn too.
    pub anew_ms: f64,
}

/// How often each frame is timed; the median counts. Once where every rung is tried again and again.
const TIMES: usize = 3;

/// Time below which a difference is not told from none, in milliseconds.
const NO_TIME: f64 = 0.05;

/// What makes the pictures of a ladder.
pub struct Climber<'a, O> {
    shot: &'a Shot,
    reference: &'a ReferenceImage,
    display: DisplayTransform,
    raster: Raster,
    maker: TileMaker,
    onlooker: &'a O,
    /// Samples per pixel of what is traced.
    spp: u32,
}

impl<'a, O: Onlooker> Climber<'a, O> {
    /// One at the foot of the ladder.
    ///
    /// # Errors
    /// If the device can't draw the fake: one line.
    pub fn new(
        (shot, reference): (&'a Shot, &'a ReferenceImage),
        (gpu, maker): (&Gpu, TileMaker),
        onlooker: &'a O,
        spp: u32,
    ) -> anyhow::Result<Self> {
        let raster = Raster::new(gpu)?;
        Ok(Climber { shot, reference, display: DisplayTransform::default(), raster, maker, onlooker, spp })
    }

    /// All rungs from the bottom to the top, each handed to `told` when it is reached; what the onlooker ends is as far as it
    /// came.
    ///
    /// # Errors
    /// If a picture can't be made or measured: one line that names the rung.
    pub fn climb(
        &mut self,
        repairs: &[Repair],
        order: Order,
        mut told: impl FnMut(&Reached),
    ) -> anyhow::Result<Vec<Reached>> {
        let mut reached = Vec::new();
        let mut tell = |rung: Reached, reached: &mut Vec<Reached>| {
            told(&rung);
            reached.push(rung);
        };
        let mut as_taught = PaneSettings::of(TechniqueName::Raster);
        as_taught.fake.fake = raster::Fake::AsTaught;
        tell(self.reach(Rung::AsTaught, as_taught)?, &mut reached);
        tell(self.reach(Rung::Encoding, repaired(Repairs::NONE))?, &mut reached);
        let (mut left, mut done) = (repairs.to_vec(), Repairs::NONE);
        while !left.is_empty() && !self.onlooker.ends_now() {
            let next = self.next(&left, (done, reached.last()), order)?;
            left.retain(|repair| Rung::Repair(*repair) != next.rung);
            done = next.pane.fake.repairs;
            tell(next, &mut reached);
        }
        for (rung, technique) in [(Rung::Whitted, TechniqueName::Whitted), (Rung::Path, TechniqueName::Path)] {
            if self.onlooker.ends_now() {
                break;
            }
            let mut pane = PaneSettings::of(technique);
            pane.take_usual_estimator(&self.shot.scene);
            if let Some(row) = of_panes("spp") {
                pane.set(row, Value::Whole(self.spp));
            }
            tell(self.reach(rung, pane)?, &mut reached);
        }
        Ok(reached)
    }

    /// The next rung: the next of the list, or of all the one that is worth most.
    fn next(
        &mut self,
        left: &[Repair],
        (done, last): (Repairs, Option<&Reached>),
        order: Order,
    ) -> anyhow::Result<Reached> {
        let candidates = if order == Order::Light { &left[..1] } else { left };
        let mut best: Option<Reached> = None;
        for &repair in candidates {
            let times = if order == Order::Light { TIMES } else { 1 };
            let tried = self.reach_timed(Rung::Repair(repair), repaired(done.with(repair)), times)?;
            let better = match (&best, last) {
                (Some(best), Some(last)) => worth(&tried, last) > worth(best, last),
                _ => true,
            };
            if better {
                best = Some(tried);
            }
            if self.onlooker.ends_now() {
                break;
            }
        }
        best.context("there is no rung left")
    }

    fn reach(&mut self, rung: Rung, pane: PaneSettings) -> anyhow::Result<Reached> {
        self.reach_timed(rung, pane, TIMES)
    }

    fn reach_timed(&mut self, rung: Rung, pane: PaneSettings, times: usize) -> anyhow::Result<Reached> {
        let named = || format!("{} of the ladder", rung.name());
        let asked = Asked { shot: self.shot, pane: &pane, limit: None };
        let tile = self.maker.finish(asked, None, self.onlooker).with_context(named)?;
        let errors = measure(&tile.image, self.reference, &self.display).with_context(named)?;
        let (frame_ms, anew_ms) = match pane.in_use() {
            Technique::Fake(_) => self.timed(&pane, times).with_context(named)?,
            Technique::Traced(_) => (1e3 * tile.facts.seconds, 1e3 * tile.facts.seconds),
        };
        Ok(Reached { rung, tile, pane, errors, frame_ms, anew_ms })
    }

    /// Medians of a frame with maps that stay and of one with all maps, in milliseconds, until the device has drawn it: the
    /// picture is not read back. Pipelines are compiled before.
    fn timed(&mut self, pane: &PaneSettings, times: usize) -> anyhow::Result<(f64, f64)> {
        let Technique::Fake(fake) = pane.in_use() else { return Ok((0.0, 0.0)) };
        let Shot { scene, camera, size: (width, height), .. } = self.shot;
        let (scene, settings) = (fake.applied_to(scene), fake.sized(*width, *height));
        let mut frame = |anew: bool| -> anyhow::Result<f64> {
            if anew {
                self.raster.forget_maps();
            }
            let start = Instant::now();
            self.raster.draw(&scene, camera, &settings)?;
            Ok(1e3 * start.elapsed().as_secs_f64())
        };
        frame(true)?;
        let mut median = |anew: bool| -> anyhow::Result<f64> {
            let mut all = (0..times).map(|_| frame(anew)).collect::<anyhow::Result<Vec<_>>>()?;
            all.sort_by(f64::total_cmp);
            Ok(all[times / 2])
        };
        Ok((median(false)?, median(true)?))
    }
}

/// Error that a rung takes away for each millisecond that it costs when the scene changes.
fn worth(rung: &Reached, below: &Reached) -> f64 {
    let [taken, cost] = [below.errors.errors.rel_mse - rung.errors.errors.rel_mse, rung.anew_ms - below.anew_ms];
    // what makes it worse is worth less the less it costs
    if taken > 0.0 { taken / cost.max(NO_TIME) } else { taken }
}
