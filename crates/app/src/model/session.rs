//! How it is looked at: what one would want to find again after a pause.

use super::{
    COMPARE, CompareWith, ComparisonSettings, LadderSettings, Line, PaneId, PaneSource, Panes, PlotSettings,
    ProbeSettings, SweepSettings, TreesSettings, View,
};
use film::DisplayTransform;
use raster::Show;
use scene::{Needs, Scene};
use technique::{DeviceChoice, PaneSettings, TechniqueName};

/// The panes and how they are shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Session {
    /// What the window is used for: one of [`EVERYBODYS`](super::EVERYBODYS).
    pub workspace: &'static str,
    /// How each is made.
    pub panes: Panes<PaneSettings>,
    /// Where the pictures come from that are not made here.
    pub sources: Panes<PaneSource>,
    /// How all are shown.
    pub display: DisplayTransform,
    /// How many pixels pictures have.
    pub resolution: Resolution,
    /// Which of the panes, or what is made of them, is shown.
    pub view: View,
    /// How the wipe's line stands.
    pub line: Line,
    /// Where it stands, from 0 (left or top edge) to 1.
    pub wipe: f32,
    /// What is compared with what, and how it is drawn.
    pub comparison: ComparisonSettings,
    /// What is plotted of the errors.
    pub plots: PlotSettings,
    /// What is varied in a sweep.
    pub sweep: SweepSettings,
    /// The pixel that is looked into.
    pub probe: ProbeSettings,
    /// Which rungs a ladder has, and how they are looked at.
    pub ladder: LadderSettings,
    /// How trees are looked at.
    pub trees: TreesSettings,
}

/// How many pixels a picture has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resolution {
    /// As many as the picture area. While something changes, pictures that take too long for that begin coarser.
    #[default]
    Full,
    /// One for two by two.
    Half,
    /// One for four by four.
    Quarter,
}

impl Resolution {
    /// All, the finest first.
    pub const ALL: [Resolution; 3] = [Resolution::Full, Resolution::Half, Resolution::Quarter];

    /// Pixels of the picture area along a side of one of the picture.
    pub fn shrink(self) -> u32 {
        match self {
            Resolution::Full => 1,
            Resolution::Half => 2,
            Resolution::Quarter => 4,
        }
    }

    /// As the control shows it: "full", "1/2", "1/4".
    pub fn name(self) -> &'static str {
        match self {
            Resolution::Full => "full",
            Resolution::Half => "1/2",
            Resolution::Quarter => "1/4",
        }
    }
}

impl Default for Session {
    /// The fake against the truth.
    fn default() -> Self {
        let panes = [(PaneId::A, TechniqueName::Raster), (PaneId::B, TechniqueName::Path)];
        Session {
            workspace: COMPARE,
            panes: panes.into_iter().map(|(id, technique)| (id, PaneSettings::of(technique))).collect(),
            sources: Panes::default(),
            display: DisplayTransform::default(),
            resolution: Resolution::default(),
            view: View::Wipe,
            line: Line::Vertical,
            wipe: 0.5,
            comparison: ComparisonSettings::default(),
            plots: PlotSettings::default(),
            sweep: SweepSettings::default(),
            probe: ProbeSettings::default(),
            ladder: LadderSettings::default(),
            trees: TreesSettings::default(),
        }
    }
}

impl Session {
    /// Traces the rays of all panes where this says.
    pub fn trace_on(&mut self, device: DeviceChoice) {
        self.panes.values_mut().for_each(|pane| pane.device = device);
    }

    /// What was set against the scene before goes, the estimator with it that it asked for; techniques and their ways stay.
    pub fn forget_the_scene(&mut self, before: &Needs, scene: &Scene) {
        for pane in self.panes.values_mut() {
            pane.forget_the_scene(scene);
            pane.take_usual_estimator_after(before, scene);
        }
    }

    /// Panes that look at a map which this scene does not have look at the picture.
    pub fn look_at_what_there_is(&mut self, scene: &Scene) {
        for pane in self.panes.values_mut().filter(|pane| !pane.fake.show.available(scene)) {
            pane.fake.show = Show::Picture;
        }
    }

    /// A becomes B and B becomes A; from a view of both it goes to A. Maps against the reference take turns too.
    pub fn toggle(&mut self) {
        match (self.view, self.comparison.with) {
            (View::ErrorMap, CompareWith::Reference) => self.comparison.of = other(self.comparison.of),
            (View::Pane(shown), _) => self.view = View::Pane(other(shown)),
            _ => self.view = View::Pane(PaneId::A),
        }
    }

    /// Shows a view; choosing the wipe once more turns its line. From one pane it goes to the map of that pane's
    /// errors.
    pub fn choose(&mut self, view: View) {
        match (self.view, view) {
            (View::Wipe, View::Wipe) => self.line = self.line.turned(),
            (View::Pane(shown), View::ErrorMap) => self.comparison.of = shown,
            _ => {}
        }
        self.view = view;
    }
}

/// The other one of the two panes that are compared.
pub fn other(pane: PaneId) -> PaneId {
    if pane == PaneId::A { PaneId::B } else { PaneId::A }
}

#[cfg(test)]
mod tests {
    use crate::model::{Model, PaneId, Theme};
    use pathtrace::Estimator;
    use scene::builtin;

    #[test]
    fn a_scene_that_is_opened_brings_the_estimator_that_it_asks_for() {
        let named = |name: &str| (builtin::named(name).unwrap(), name.to_owned());
        let (scene, source) = named("whitted");
        let mut model = Model::new(scene, source, Theme::Dark);
        let estimator = |model: &Model| model.session.panes[PaneId::B].truth.path.estimator;
        assert_eq!(estimator(&model), Estimator::MIS);
        let (scene, source) = named("cornell");
        model.open(scene, source);
        assert_eq!(estimator(&model), Estimator::LIGHT);
    }
}
