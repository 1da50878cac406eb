//! What shall be made: a plain value, stated anew in every frame. Who makes it compares it with what was wanted before.

use super::{
    Comparison, LightWish, MapWish, ObjectsWish, PaneSource, Panes, ProbeWish, SweepPlan, WantedCases, WantedLadder,
    WantedTrees,
};
use film::DisplayTransform;
use scene::Camera;
use technique::Shot;
use technique::Technique;

/// All pictures that are wanted, and what is to be known of them.
#[derive(Debug, Clone, Default)]
pub struct Wanted {
    /// Counts the scenes opened: what was made of an older one is no longer shown.
    pub opened: u64,
    /// For each pane the picture that is to be made.
    pub panes: Panes<WantedPane>,
    /// Where the pictures of all panes come from that are not made here, also of those that are not seen: what another
    /// program sends meanwhile is not lost.
    pub sources: Panes<PaneSource>,
    /// Whose errors are measured, and by what.
    pub comparisons: Vec<Comparison>,
    /// The map of errors that is looked at, if one is.
    pub map: Option<MapWish>,
    /// The tiles that are to be made, where a sweep is looked at.
    pub sweep: Option<WantedSweep>,
    /// The ladder that is to be climbed, where one is looked at.
    pub ladder: Option<WantedLadder>,
    /// What is traced of trees, where they are looked at.
    pub trees: Option<WantedTrees>,
    /// Hard cases that are measured, where they are looked at.
    pub cases: Option<WantedCases>,
    /// Whether histograms of the pictures are looked at.
    pub histograms: bool,
    /// The pixel that is looked into, if one is.
    pub probe: Option<ProbeWish>,
    /// Where parts of the scene are seen, while they are looked at.
    pub objects: Option<ObjectsWish>,
    /// The view whose effects of light are named, if they are.
    pub effects: Option<Shot>,
    /// Whose light by bounce is looked at.
    pub light: Vec<LightWish>,
    /// How all are shown.
    pub display: DisplayTransform,
    /// Whether what is traced waits.
    pub paused: bool,
    /// How often the user began the pictures anew.
    pub restarts: u64,
}

/// A picture: what it shows and how it is made.
#[derive(Debug, Clone)]
pub struct WantedPane {
    /// Scene, camera and size.
    pub shot: Shot,
    /// The document's camera, of which a narrow picture shows more above and below.
    pub own_camera: Camera,
    /// The technique with its settings; one that stands for another program's, whose settings are not known.
    pub technique: Technique,
    /// Where the picture comes from, if it is not made by that.
    pub source: PaneSource,
    /// Pixels of the picture area along a side of one of the picture.
    pub shrink: u32,
}

/// A sweep: what all of its tiles show, and how each is made.
#[derive(Debug, Clone)]
pub struct WantedSweep {
    /// Scene, camera and size of a tile.
    pub shot: Shot,
    /// All tiles of it, and how each is made.
    pub plan: SweepPlan,
}

impl PartialEq for WantedSweep {
    fn eq(&self, other: &Self) -> bool {
        self.shot.is_of_the_same_view(&other.shot) && self.plan == other.plan
    }
}

#[cfg(test)]
mod tests {
    use crate::model::{Model, PaneId, Theme};

    #[test]
    fn no_picture_is_wanted_before_there_is_a_place_for_it() {
        let mut model = Model::new(scene::builtin::named("cornell").unwrap(), "cornell".into(), Theme::Dark);
        let wanted = |model: &Model| model.wanted([PaneId::A, PaneId::B]).panes.ids().count();
        assert_eq!(wanted(&model), 0);
        model.state.picture.size = (1, 1);
        assert_eq!(wanted(&model), 2);
    }
}
