//! Makes the picture of a rung and times its frames; what was made of a view stays for the next ladder of it.

use crate::model::{Rung, TileErrors};
use crate::ruler::ReferenceImage;
use crate::sweep::{Asked, Onlooker, Tile, TileMaker, measure};
use anyhow::Context;
use film::DisplayTransform;
use gpu::Gpu;
use raster::Raster;
use std::sync::Arc;
use std::time::Instant;
use technique::{PaneSettings, Shot, Technique};

/// A rung that was reached, before it is measured.
#[derive(Debug, Clone)]
pub struct Made {
    /// The rung that was reached.
    pub rung: Rung,
    /// The picture there, and what makes it again.
    pub tile: Arc<Tile>,
    /// How it is made.
    pub pane: PaneSettings,
    /// Milliseconds of a frame when only the camera moves: maps stay. Of rays the whole picture.
    pub frame_ms: f64,
    /// Milliseconds of a frame when the scene has changed: maps are drawn too.
    pub anew_ms: f64,
}

/// A rung that was reached, and how far it is from the truth.
#[derive(Debug, Clone)]
pub struct Reached {
    /// The rung that was reached.
    pub rung: Rung,
    /// The picture there, and what makes it again.
    pub tile: Arc<Tile>,
    /// How it is made.
    pub pane: PaneSettings,
    /// How far it is from the reference.
    pub errors: TileErrors,
    /// Milliseconds of a frame when only the camera moves: maps stay. Of rays the whole picture.
    pub frame_ms: f64,
    /// Milliseconds of a frame when the scene has changed: maps are drawn too.
    pub anew_ms: f64,
}

impl Made {
    /// The same with its errors.
    pub fn with(&self, errors: TileErrors) -> Reached {
        let Made { rung, tile, pane, frame_ms, anew_ms } = self.clone();
        Reached { rung, tile, pane, errors, frame_ms, anew_ms }
    }

    /// Measures it as it is shown by default.
    ///
    /// # Errors
    /// If the reference has other pixels: one line that names the rung.
    pub fn measured(&self, reference: &ReferenceImage) -> anyhow::Result<Reached> {
        let errors = measure(&self.tile.image, reference, &DisplayTransform::default());
        Ok(self.with(errors.with_context(|| named(self.rung))?))
    }
}

/// What makes the pictures of ladders.
pub struct RungMaker {
    raster: Raster,
    maker: TileMaker,
    /// How many pictures of one view stay at most.
    most_kept: usize,
    /// Those, each with how often its frames were timed; the latest last.
    kept: Vec<(Made, usize)>,
}

impl RungMaker {
    /// One that keeps so many pictures of one view for the next ladder of it.
    ///
    /// # Errors
    /// If the device can't draw the fake: one line.
    pub fn new(gpu: &Gpu, maker: TileMaker, most_kept: usize) -> anyhow::Result<Self> {
        Ok(RungMaker { raster: Raster::new(gpu)?, maker, most_kept, kept: Vec::new() })
    }

    /// Keeps nothing that shows something else than this.
    pub fn forget_other_views(&mut self, shot: &Shot) {
        self.kept.retain(|(made, _)| made.tile.provenance.shot.is_of_the_same_view(shot));
    }

    /// Keeps nothing at all: all is to be made again.
    pub fn forget(&mut self) {
        self.kept.clear();
    }

    /// The picture of a rung, and the medians of so many frames. What the onlooker ends is as far as it came.
    ///
    /// # Errors
    /// If it can't be made: one line that names the rung.
    pub fn make(
        &mut self,
        (rung, pane): (Rung, PaneSettings),
        shot: &Shot,
        times: usize,
        onlooker: &impl Onlooker,
    ) -> anyhow::Result<Made> {
        let known = self.kept.iter().find(|(made, timed)| {
            made.pane == pane && *timed >= times && made.tile.provenance.shot.is_of_the_same_view(shot)
        });
        if let Some((made, _)) = known {
            return Ok(Made { rung, ..made.clone() });
        }
        let tile = self.maker.finish(Asked { shot, pane: &pane, limit: None }, None, onlooker);
        let tile = Arc::new(tile.with_context(|| named(rung))?);
        let (frame_ms, anew_ms) = match pane.in_use() {
            Technique::Fake(_) => self.timed(&pane, shot, times, onlooker).with_context(|| named(rung))?,
            Technique::Traced(_) => (1e3 * tile.facts.seconds, 1e3 * tile.facts.seconds),
        };
        let made = Made { rung, tile, pane, frame_ms, anew_ms };
        if made.tile.facts.done && !onlooker.ends_now() {
            self.keep(&made, times);
        }
        Ok(made)
    }

    fn keep(&mut self, made: &Made, times: usize) {
        self.kept.retain(|(kept, _)| kept.pane != made.pane);
        self.kept.push((made.clone(), times));
        self.kept.drain(..self.kept.len().saturating_sub(self.most_kept));
    }

    /// Medians of a frame with maps that stay and of one with all maps, in milliseconds, until the device has drawn it: the
    /// picture is not read back. Pipelines are compiled before.
    fn timed(
        &mut self,
        pane: &PaneSettings,
        shot: &Shot,
        times: usize,
        onlooker: &impl Onlooker,
    ) -> anyhow::Result<(f64, f64)> {
        let Technique::Fake(fake) = pane.in_use() else { return Ok((0.0, 0.0)) };
        let Shot { scene, camera, size: (width, height), .. } = shot;
        let (scene, settings) = (fake.applied_to(scene), fake.sized(*width, *height));
        let mut frame = |anew: bool| -> anyhow::Result<f64> {
            if onlooker.ends_now() {
                return Ok(0.0);
            }
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

fn named(rung: Rung) -> String {
    format!("{} of the ladder", rung.name())
}
