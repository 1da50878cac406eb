//! From the fake to the truth, one defect at a time: the settings of that workspace, what is to be made for it, and what is known
//! of that.

mod rung;

pub use rung::{Order, Rung, as_taught, repaired, repairs_of};

use super::{COMPARE, ErrorMap, Model, PaneId, PaneSource, PictureArea, Progress, TileErrors};
use compare::ErrorMetric;
use raster::{Repair, Repairs};
use scene::Scene;
use std::sync::{Arc, Weak};
use technique::{PaneSettings, Shot, TechniqueName};

/// Which rungs there are, and how they are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LadderSettings {
    /// The repairs that are climbed, as far as the scene has something to repair for them.
    pub repairs: Repairs,
    /// Which defect is repaired next.
    pub order: Order,
    /// The rung whose picture is shown.
    pub selected: Rung,
    /// Beside what it is shown.
    pub shows: LadderShows,
}

impl Default for LadderSettings {
    fn default() -> Self {
        LadderSettings {
            repairs: Repairs::ALL,
            order: Order::Light,
            selected: Rung::AsTaught,
            shows: LadderShows::Beside,
        }
    }
}

/// Beside what a rung's picture is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LadderShows {
    /// The reference at its right.
    #[default]
    Beside,
    /// The reference behind a line.
    Wipe,
    /// The rung before it, in front of a line.
    Step,
    /// Where its errors are, in place of it.
    Errors,
}

impl LadderShows {
    /// In the order of the choice.
    pub const ALL: [LadderShows; 4] = [LadderShows::Beside, LadderShows::Wipe, LadderShows::Step, LadderShows::Errors];

    /// As the choice and a session's file have it.
    pub fn name(self) -> &'static str {
        match self {
            LadderShows::Beside => "beside",
            LadderShows::Wipe => "wipe",
            LadderShows::Step => "step",
            LadderShows::Errors => "errors",
        }
    }
}

/// What a scene lacks for each rung to be one, by [`Rung::place`]: known once for a scene, which may have many shapes.
#[derive(Debug, Clone, Default)]
pub struct LadderState {
    scene: Weak<Scene>,
    missing: Vec<Option<&'static str>>,
}

/// What is to be made of a ladder.
#[derive(Debug, Clone)]
pub struct WantedLadder {
    /// Scene, camera and size of the pictures.
    pub shot: Shot,
    /// The repairs that are climbed, in the order in which light meets the defects.
    pub repairs: Vec<Repair>,
    /// Which of them comes next.
    pub order: Order,
    /// The rung of whose errors a map is looked at, what its colours show, and where their scale ends.
    pub map: Option<(Rung, ErrorMetric, Option<f32>)>,
    /// How often the user began anew.
    pub restarts: u64,
}

impl WantedLadder {
    /// Whether both are climbed alike; another map is another look at the same ladder.
    pub fn is_of_the_same_ladder(&self, other: &WantedLadder) -> bool {
        let of = |wanted: &WantedLadder| (wanted.order, wanted.restarts);
        self.shot.is_of_the_same_view(&other.shot) && self.repairs == other.repairs && of(self) == of(other)
    }
}

/// What is known of a rung that was reached.
#[derive(Debug, Clone, PartialEq)]
pub struct RungFacts {
    /// How it is made.
    pub pane: PaneSettings,
    /// How far it is from the reference, once there is one.
    pub errors: Option<TileErrors>,
    /// Milliseconds of a frame when only the camera moves; of rays those of the whole picture.
    pub frame_ms: f64,
    /// Milliseconds of a frame when the scene has changed: maps are drawn too.
    pub anew_ms: f64,
}

/// All that there is to show of a ladder.
#[derive(Debug, Clone, Default)]
pub struct LadderView {
    /// What is known of each rung, by [`Rung::place`]; empty before the first.
    pub rungs: Vec<Option<RungFacts>>,
    /// The rungs that were reached, from the bottom.
    pub climbed: Vec<Rung>,
    /// How far the reference has come that all are measured by.
    pub reference: Option<Progress>,
    /// Where the errors of a rung are, while that is looked at.
    pub map: Option<(Rung, Arc<ErrorMap>)>,
    /// What is being done, while something is.
    pub doing: Option<String>,
    /// Why it came no farther: one line.
    pub fault: Option<String>,
}

impl LadderView {
    /// What is known of a rung, if it was reached.
    pub fn facts(&self, rung: Rung) -> Option<&RungFacts> {
        self.rungs.get(rung.place())?.as_ref()
    }

    /// The rung below one that was reached.
    pub fn below(&self, rung: Rung) -> Option<Rung> {
        let place = self.climbed.iter().position(|reached| *reached == rung)?;
        self.climbed.get(place.checked_sub(1)?).copied()
    }

    /// relMSE that a rung takes away from the one below it; below zero where it makes the picture worse.
    pub fn taken_by(&self, rung: Rung) -> Option<f64> {
        let [below, here] = [self.below(rung)?, rung].map(|rung| self.facts(rung)?.errors.map(|e| e.errors.rel_mse));
        Some(below? - here?)
    }

    /// All rungs from the bottom: in the order of light, or else those that were reached in the order in which they were, and
    /// then the others.
    pub fn rows(&self, order: Order) -> Vec<Rung> {
        if order == Order::Light {
            return Rung::all().collect();
        }
        let of_rays = [Rung::Whitted, Rung::Path];
        let reached = self.climbed.iter().copied().filter(|rung| !of_rays.contains(rung));
        let mut rows: Vec<Rung> = reached.collect();
        let others: Vec<Rung> = Rung::all().filter(|rung| !rows.contains(rung)).collect();
        rows.extend(others);
        rows
    }
}

/// Width and height in pixels of the pictures: what a processor that draws the fake climbs on in seconds.
const SIZE: [f32; 2] = [480.0, 270.0];

impl Model {
    /// Finds out what the scene lacks that is seen now, before the ladder is drawn.
    pub fn follow_the_ladder(&mut self) {
        let seen = self.document.seen();
        if !std::ptr::eq(self.state.ladder.scene.as_ptr(), Arc::as_ptr(seen)) {
            let missing = Rung::all().map(|rung| rung.missing_in(seen)).collect();
            self.state.ladder = LadderState { scene: Arc::downgrade(seen), missing };
        }
    }

    /// What the scene that is seen lacks for a rung to be one, after "no".
    pub fn missing_for(&self, rung: Rung) -> Option<&'static str> {
        let (LadderState { scene, missing }, seen) = (&self.state.ladder, self.document.seen());
        let known = missing.get(rung.place()).filter(|_| std::ptr::eq(scene.as_ptr(), Arc::as_ptr(seen)));
        known.copied().unwrap_or_else(|| rung.missing_in(seen))
    }

    /// Whether a rung is climbed.
    pub fn climbs(&self, rung: Rung) -> bool {
        match rung {
            Rung::Repair(repair) if !self.session.ladder.repairs.has(repair) => false,
            _ => self.missing_for(rung).is_none(),
        }
    }

    /// What is repaired, in the order in which light meets the defects.
    fn repairs_to_climb(&self) -> Vec<Repair> {
        Repair::ALL.into_iter().filter(|repair| self.climbs(Rung::Repair(*repair))).collect()
    }

    /// What all pictures of the ladder show.
    fn ladder_shot(&self) -> Shot {
        self.document.shot(&PictureArea::new(SIZE, SIZE, 1, [0.0; 4]))
    }

    /// The ladder as it is set, and the map that is looked at.
    pub fn wanted_ladder(&self) -> WantedLadder {
        let ladder = &self.session.ladder;
        let comparison = &self.session.comparison;
        let (metric, held) = (comparison.metric, comparison.held[comparison.metric as usize]);
        WantedLadder {
            shot: self.ladder_shot(),
            repairs: self.repairs_to_climb(),
            order: ladder.order,
            map: (ladder.shows == LadderShows::Errors).then_some((ladder.selected, metric, held)),
            restarts: self.state.restarts,
        }
    }

    /// Selects the rung so many rows farther down, or up, of those that are climbed; `rows` are all, from the top.
    pub fn step_on_the_ladder(&mut self, rows: &[Rung], steps: i32) {
        let climbed: Vec<Rung> = rows.iter().copied().filter(|rung| self.climbs(*rung)).collect();
        let ladder = &mut self.session.ladder;
        let at = climbed.iter().position(|rung| *rung == ladder.selected).unwrap_or(0) as i32;
        let next = (at + steps).clamp(0, climbed.len().saturating_sub(1) as i32) as usize;
        ladder.selected = climbed.get(next).copied().unwrap_or_default();
    }

    /// Shows a rung as A beside the truth as B in the comparison.
    pub fn compare_rung(&mut self, rung: Rung, pane: PaneSettings) {
        let place = |model: &Model, id| model.session.panes.get(id).map(|pane| (pane.device, pane.adapter));
        let mut truth = PaneSettings::of(TechniqueName::Path);
        truth.take_usual_estimator(self.document.seen());
        for (id, mut settings) in [(PaneId::A, pane), (PaneId::B, truth)] {
            (settings.device, settings.adapter) = place(self, id).unwrap_or_default();
            self.session.panes.insert(id, settings);
            self.session.set_source(id, PaneSource::Made);
        }
        self.session.workspace = COMPARE;
        self.say(Ok(format!("A is the ladder's rung \"{}\", B path tracing", rung.title())));
    }

    /// The line that makes the whole ladder in a folder.
    pub fn ladder_command(&self) -> String {
        let ladder = &self.session.ladder;
        let mut more = vec![("order", ladder.order.name().to_owned())];
        let repairs: Repairs = self.repairs_to_climb().into_iter().collect();
        let useful = Repair::ALL.into_iter().filter(|repair| self.missing_for(Rung::Repair(*repair)).is_none());
        let left_out = useful.count() > repairs.count();
        more.extend(left_out.then(|| ("repairs", repairs.to_string())));
        self.ladder_shot().ladder_command("ladder", more)
    }
}

#[cfg(test)]
mod tests;
