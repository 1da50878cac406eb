//! Many pictures of one scene at once, side by side: one setting at 2 to 8 values is a strip, two settings are a matrix. What is varied
//! is told in the words of the table of settings, so that a setting that comes there can be varied too.

mod caption;
mod plan;
mod presets;

pub use caption::{TileErrors, TileFacts, best, captions, sweep_csv};
pub use plan::{Line, MOST_TILES, MOST_VALUES, PlannedTile, SweepPlan, TECHNIQUE};
pub use presets::{SWEEPS, SweepPreset};

use super::{COMPARE, Model, PaneId, PaneSource, SWEEP, Session};
use pathtrace::Bugs;
use scene::Scene;
use technique::settings::{Kind, Look, Setting, Value, all_of_panes, of_panes};
use technique::{PaneSettings, TechniqueName};

/// What is varied, and how pictures of different values are kept comparable.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSettings {
    /// The pane whose settings all tiles have but for what is varied.
    pub of: PaneId,
    /// What is varied from column to column.
    pub columns: Axis,
    /// What is varied from row to row; of nothing in a strip.
    pub rows: Axis,
    /// What all tiles have the same of.
    pub equal: Equal,
    /// Seconds of rendering that each tile has where that is time.
    pub seconds: f32,
    /// The error that captions tell.
    pub measure: SweepMeasure,
}

impl Default for SweepSettings {
    fn default() -> Self {
        SweepSettings {
            of: PaneId::B,
            columns: Axis::new("spp", "1, 4, 16"),
            rows: Axis::default(),
            equal: Equal::Samples,
            seconds: 1.0,
            measure: SweepMeasure::RelMse,
        }
    }
}

/// A setting and its values as they are typed.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Axis {
    /// Its name in the table, or [`TECHNIQUE`]; empty for nothing.
    pub setting: String,
    /// With commas between them.
    pub values: String,
}

impl Axis {
    /// A setting at these values.
    pub fn new(setting: &str, values: &str) -> Self {
        Axis { setting: setting.into(), values: values.into() }
    }

    /// A setting at the values that tell most of it: the choices that the window offers in this scene, or a few of its numbers.
    pub fn usual(setting: &str, technique: TechniqueName, scene: &Scene) -> Self {
        Axis::new(setting, &usual_values(setting, technique, scene))
    }

    /// Whether nothing is varied along it.
    pub fn is_empty(&self) -> bool {
        self.setting.is_empty()
    }
}

/// What tiles have the same of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Equal {
    /// Samples per pixel, as many as the pane is set to.
    #[default]
    Samples,
    /// Seconds of rendering that each tile has at equal time.
    Time,
}

impl Equal {
    /// Both, the usual one first.
    pub const ALL: [Equal; 2] = [Equal::Samples, Equal::Time];

    /// On its button and in a session's file.
    pub fn name(self) -> &'static str {
        match self {
            Equal::Samples => "samples",
            Equal::Time => "time",
        }
    }
}

/// How far a tile is from the reference, as one figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SweepMeasure {
    /// Relative mean squared error.
    #[default]
    RelMse,
    /// Root of the mean squared error.
    Rmse,
    /// Mean of FLIP's map: what is seen of the difference.
    Flip,
}

impl SweepMeasure {
    /// All, the usual one first.
    pub const ALL: [SweepMeasure; 3] = [SweepMeasure::RelMse, SweepMeasure::Rmse, SweepMeasure::Flip];

    /// On its button, in captions and in a session's file.
    pub fn name(self) -> &'static str {
        match self {
            SweepMeasure::RelMse => "relMSE",
            SweepMeasure::Rmse => "RMSE",
            SweepMeasure::Flip => "FLIP",
        }
    }
}

/// What can be varied of a pane of this technique, by its name: the technique itself, and its settings.
pub fn variable(technique: TechniqueName) -> impl Iterator<Item = &'static str> {
    variable_of_any().filter(move |name| *name == TECHNIQUE || of_panes(name).is_some_and(|row| row.is_of(technique)))
}

/// What can be varied of a pane of some technique.
fn variable_of_any() -> impl Iterator<Item = &'static str> {
    std::iter::once(TECHNIQUE).chain(all_of_panes().map(|row| row.name).filter(|name| *name != plan::HISTORY))
}

fn usual_values(setting: &str, technique: TechniqueName, scene: &Scene) -> String {
    if setting == TECHNIQUE {
        return "whitted, path, photon, light-tracing, metropolis".into();
    }
    let row = all_of_panes().find(|row| row.name == setting);
    let values = row.map(|row| values_of(row, technique, scene)).unwrap_or_default();
    values.join(", ")
}

fn values_of(row: &Setting<PaneSettings>, technique: TechniqueName, scene: &Scene) -> Vec<String> {
    match (row.kind_in(technique), &row.control.look) {
        (Kind::Choice(_), _) => {
            let offered = row.words(Some(technique), scene).into_iter().take(MOST_VALUES);
            offered.map(|(_, value, _)| value.to_string()).collect()
        }
        (Kind::Roulette, _) => ["0.5", "0.8", "throughput", "0.8+throughput"].map(String::from).into(),
        (Kind::Bounces, _) => ["0", "1", "2", "inf"].map(String::from).into(),
        (_, Look::Doubling(exponents)) => {
            let middle = exponents.start().midpoint(*exponents.end());
            let first = if *exponents.start() == 0 { 0 } else { middle.saturating_sub(2) };
            [0, 2, 4].map(|step| (1u64 << (first + step)).to_string()).into()
        }
        (_, Look::Whole(range) | Look::WholeOrNone(range)) => {
            let [least, most] = [*range.start(), *range.end()];
            let mut values = vec![least, least.midpoint(most), most];
            values.dedup();
            values.iter().map(ToString::to_string).collect()
        }
        (_, look @ (Look::Steps { .. } | Look::Logarithmic(_))) => numbers_of(look),
        (_, Look::LightPaths) => ["all", "direct", "indirect", "bounce-1"].map(String::from).into(),
        (_, Look::Repairs) => ["none", "two-interfaces", "surroundings+two-interfaces", "all"].map(String::from).into(),
        (_, Look::Bugs) => {
            let suited = Bugs::suited_to(scene);
            std::iter::once("none".into()).chain(suited.iter().take(3).map(|bug| bug.name().to_owned())).collect()
        }
        (_, Look::Typed | Look::Words(_)) => ["1", "2", "3", "4"].map(String::from).into(),
    }
}

/// The ends of a slider and what is halfway between them.
fn numbers_of(look: &Look) -> Vec<String> {
    let [least, middle, most] = match look {
        Look::Steps { range, .. } => [*range.start(), range.start().midpoint(*range.end()), *range.end()],
        Look::Logarithmic(range) => [*range.start(), (range.start() * range.end()).sqrt(), *range.end()],
        _ => return Vec::new(),
    };
    [least, middle, most].map(|number| look.rounded(Value::Number(number)).to_string()).into()
}

impl SweepSettings {
    /// Varies what a plan does.
    fn follow(&mut self, plan: &SweepPlan) {
        self.columns = plan.columns.axis();
        self.rows = plan.rows.as_ref().map(Line::axis).unwrap_or_default();
        self.equal = if plan.seconds.is_some() { Equal::Time } else { Equal::Samples };
        self.seconds = plan.seconds.unwrap_or(self.seconds);
    }
}

impl Session {
    /// Opens the sweep of these tiles, whatever has been typed since they were planned.
    pub fn show_sweep(&mut self, plan: &SweepPlan) {
        self.workspace = SWEEP;
        let is_shown = |session: &Session| session.sweep_plan().as_ref() == Ok(plan);
        if !is_shown(self) {
            self.sweep.follow(plan);
        }
        if !is_shown(self) {
            // the pane is another by now, and each tile has all of what it was
            self.panes.insert(self.sweep.of, plan.tiles[0].pane);
        }
    }

    /// What the sweep is to show.
    ///
    /// # Errors
    /// Why it shows nothing: one line.
    fn sweep_plan(&self) -> Result<SweepPlan, String> {
        let sweep = &self.sweep;
        let base = self.panes.get(sweep.of).ok_or_else(|| format!("there is no pane {}", sweep.of))?;
        if *self.source(sweep.of) != PaneSource::Made {
            let of = sweep.of;
            return Err(format!(
                "{of} shows another program's picture, of which nothing can be varied: choose the other pane above, a technique \
                 for {of}, or a ready sweep"
            ));
        }
        let seconds = (sweep.equal == Equal::Time).then_some(sweep.seconds);
        SweepPlan::of(base, [&sweep.columns, &sweep.rows], seconds)
    }
}

impl Model {
    /// What the sweep is to show.
    ///
    /// # Errors
    /// Why it shows nothing: one line.
    pub fn sweep_plan(&self) -> Result<SweepPlan, String> {
        self.session.sweep_plan()
    }

    /// What is set up of the sweep; where that is none, as in the middle of typing, what its tiles show.
    pub(super) fn sweep_to_save(&self) -> SweepSettings {
        let mut sweep = self.session.sweep.clone();
        let shown = self.state.sweep.plan.as_ref().filter(|_| self.sweep_plan().is_err());
        shown.into_iter().for_each(|plan| sweep.follow(plan));
        sweep
    }

    /// Notes what can be made of the sweep as it is set, before it is drawn.
    pub fn follow_the_sweep(&mut self) {
        let plan = self.sweep_plan();
        if *self.session.source(self.session.sweep.of) != PaneSource::Made {
            self.state.sweep.plan = None;
        }
        self.state.sweep.fault = plan.as_ref().err().cloned();
        self.state.sweep.plan = plan.ok().or(self.state.sweep.plan.take());
    }

    /// Sets a sweep up by its preset, with the settings that it states for the pane that is varied.
    pub fn take_sweep(&mut self, preset: &SweepPreset) {
        let sweep = &mut self.session.sweep;
        (sweep.columns, sweep.rows) = (Axis::new(preset.columns.0, preset.columns.1), preset.rows());
        sweep.equal = if preset.seconds.is_some() { Equal::Time } else { Equal::Samples };
        sweep.seconds = preset.seconds.unwrap_or(sweep.seconds);
        let of = sweep.of;
        self.session.set_source(of, PaneSource::Made);
        let pane = &mut self.session.panes[of];
        preset.base().apply(pane, self.document.seen());
        self.say(Ok(format!("{}: {}", preset.title, preset.about)));
    }

    /// Gives a pane the settings of a tile, and goes back to the comparison.
    pub fn compare_tile(&mut self, tile: &PlannedTile, pane: PaneId) {
        self.session.panes.insert(pane, tile.pane);
        self.session.set_source(pane, PaneSource::Made);
        self.session.workspace = COMPARE;
        self.say(Ok(format!("{pane} is {}", tile.name())));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Theme;

    #[test]
    fn whatever_can_be_varied_of_a_technique_has_usual_values_that_make_a_plan() {
        let scene = scene::builtin::named("whitted").unwrap();
        for technique in TechniqueName::ALL {
            for setting in variable(technique) {
                let (base, columns) = (PaneSettings::of(technique), Axis::usual(setting, technique, &scene));
                // splitting paths needs a limit of bounces, which the plan says
                if setting == "branches" {
                    continue;
                }
                let plan = SweepPlan::of(&base, [&columns, &Axis::default()], None);
                assert!(plan.is_ok(), "{setting} of {}: {}: {plan:?}", technique.name(), columns.values);
            }
        }
    }

    #[test]
    fn a_tile_that_is_chosen_becomes_a_pane_of_the_comparison_and_undo_brings_it_back() {
        let mut model = Model::new(scene::builtin::named("cornell").unwrap(), "cornell".into(), Theme::Dark);
        model.session.workspace = SWEEP;
        let before = model.session.panes.clone();
        let plan = model.sweep_plan().unwrap();
        let received = PaneSource::Received(14158);
        model.session.set_source(PaneId::A, received.clone());
        model.settle(false);
        model.compare_tile(&plan.tiles[1], PaneId::A);
        model.settle(false);
        assert!(model.session.is_in(COMPARE));
        assert_eq!(model.session.panes[PaneId::A].wished_spp(), Some(4));
        assert_eq!(model.session.source(PaneId::A), &PaneSource::Made, "another program's picture makes room");
        model.undo();
        assert_eq!((&model.session.panes, model.session.source(PaneId::A)), (&before, &received));
    }

    #[test]
    fn a_session_shows_the_sweep_of_a_plan_whatever_its_pane_has_become() {
        let mut session = Session::default();
        (session.sweep.of, session.sweep.columns) = (PaneId::A, Axis::new("bounces", "0, 1"));
        session.panes.insert(PaneId::A, PaneSettings::of(TechniqueName::Path));
        let plan = session.sweep_plan().unwrap();
        // of which there is no such sweep
        session.panes.insert(PaneId::A, PaneSettings::of(TechniqueName::Raster));
        assert!(session.sweep_plan().is_err());
        session.show_sweep(&plan);
        assert!(session.is_in(SWEEP));
        assert_eq!(session.sweep_plan(), Ok(plan));
    }

    #[test]
    fn tiles_are_made_without_earlier_views_which_cannot_be_varied() {
        let mut base = PaneSettings::of(TechniqueName::Path);
        base.denoise.history = 64;
        let plan = SweepPlan::of(&base, [&Axis::new("spp", "1, 2"), &Axis::default()], None).unwrap();
        assert!(plan.tiles.iter().all(|tile| tile.pane.denoise.history == 0));
        assert!(TechniqueName::ALL.into_iter().flat_map(variable).all(|setting| setting != "history"));
        assert!(Axis::parse("history=0,64").is_err_and(|fault| fault.contains("history changes no tile")));
    }
}
