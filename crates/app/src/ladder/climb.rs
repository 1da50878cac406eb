//! Climbs: makes a picture on each rung, one after the other, in the order of light or the best first.

use super::{Made, Reached, RungMaker};
use crate::model::{Order, Rung, as_taught, repaired};
use crate::ruler::ReferenceImage;
use crate::sweep::Onlooker;
use anyhow::Context;
use raster::{RefractedAt, Repair, Repairs};
use technique::settings::{Value, of_panes};
use technique::{PaneSettings, Shot, TechniqueName};

/// How often each frame is timed; the median counts. Once where every rung is tried again and again.
const TIMES: usize = 3;

/// Time below which a difference is not told from none, in milliseconds.
const NO_TIME: f64 = 0.05;

/// Whoever goes from rung to rung.
pub struct Climber<'a, O> {
    /// What all pictures show.
    pub shot: &'a Shot,
    /// What rungs are measured by where the best is to come first; the order of light needs none.
    pub reference: Option<&'a ReferenceImage>,
    /// What makes the pictures.
    pub maker: &'a mut RungMaker,
    /// Who may end it, or hold it between two rungs.
    pub onlooker: &'a O,
    /// Samples per pixel of what is traced.
    pub spp: u32,
}

impl<O: Onlooker> Climber<'_, O> {
    /// All rungs from the bottom to the top, each handed to `told` when it is reached; what the onlooker ends is as far as it
    /// came.
    ///
    /// # Errors
    /// If a picture can't be made or measured: one line that names the rung.
    pub fn climb(
        &mut self,
        repairs: &[Repair],
        order: Order,
        mut told: impl FnMut(Made) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        let taught = [
            (Rung::AsTaught, as_taught(RefractedAt::Vertices)),
            (Rung::Fragments, as_taught(RefractedAt::Fragments)),
            (Rung::Encoding, repaired(Repairs::NONE)),
        ];
        let mut last = None;
        for (rung, pane) in taught.into_iter().filter(|(rung, _)| rung.missing_in(&self.shot.scene).is_none()) {
            let Some(made) = self.reach(rung, pane, TIMES)? else { return Ok(()) };
            last = Some(made.clone());
            told(made)?;
        }
        let (mut left, mut done) = (repairs.to_vec(), Repairs::NONE);
        while !left.is_empty() {
            let Some(next) = self.next(&left, (done, last.as_ref()), order)? else { return Ok(()) };
            left.retain(|repair| Rung::Repair(*repair) != next.rung);
            done = next.pane.fake.repairs;
            last = Some(next.clone());
            told(next)?;
        }
        for (rung, technique) in [(Rung::Whitted, TechniqueName::Whitted), (Rung::Path, TechniqueName::Path)] {
            let mut pane = PaneSettings::of(technique);
            pane.take_usual_estimator(&self.shot.scene);
            if let Some(row) = of_panes("spp") {
                pane.set(row, Value::Whole(self.spp));
            }
            let Some(made) = self.reach(rung, pane, TIMES)? else { return Ok(()) };
            told(made)?;
        }
        Ok(())
    }

    /// The next rung: the next of the list, or of all the one that is worth most; `None` if the onlooker ends it.
    fn next(
        &mut self,
        left: &[Repair],
        (done, last): (Repairs, Option<&Made>),
        order: Order,
    ) -> anyhow::Result<Option<Made>> {
        if order == Order::Light {
            return self.reach(Rung::Repair(left[0]), repaired(done.with(left[0])), TIMES);
        }
        let reference = self.reference.context("the best can't come first without a reference")?;
        let below = last.context("there is no rung below")?.measured(reference)?;
        let mut best: Option<Reached> = None;
        for &repair in left {
            let Some(tried) = self.reach(Rung::Repair(repair), repaired(done.with(repair)), 1)? else {
                return Ok(None);
            };
            let tried = tried.measured(reference)?;
            if best.as_ref().is_none_or(|best| worth(&tried, &below) > worth(best, &below)) {
                best = Some(tried);
            }
        }
        let Reached { rung, tile, pane, frame_ms, anew_ms, .. } = best.context("there is no rung left")?;
        Ok(Some(Made { rung, tile, pane, frame_ms, anew_ms }))
    }

    /// The picture of a rung, if the onlooker waits for it.
    fn reach(&mut self, rung: Rung, pane: PaneSettings, times: usize) -> anyhow::Result<Option<Made>> {
        if self.onlooker.is_held() {
            self.onlooker.wait();
        }
        if self.onlooker.ends_now() {
            return Ok(None);
        }
        let made = self.maker.make((rung, pane), self.shot, times, self.onlooker)?;
        Ok(Some(made).filter(|_| !self.onlooker.ends_now()))
    }
}

/// Error that a rung takes away for each millisecond that it costs when the scene changes.
fn worth(rung: &Reached, below: &Reached) -> f64 {
    let [taken, cost] = [below.errors.errors.rel_mse - rung.errors.errors.rel_mse, rung.anew_ms - below.anew_ms];
    // what makes it worse is worth less the less it costs
    if taken > 0.0 { taken / cost.max(NO_TIME) } else { taken }
}
