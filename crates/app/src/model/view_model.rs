//! What there is to show: results, as those who draw them take them.

use super::{
    Against, CasesView, Effort, ErrorHistory, ErrorMap, ErrorPoint, External, LadderView, LightByBounce, ObjectMap,
    PaneId, PaneProbe, PaneSource, Panes, Progress, Region, ShapesAlong, ShownEffects, TileFacts, TreesView,
};
use crate::ruler::ReferenceImage;
use compare::{Errors, Histogram};
use film::Image;
use std::sync::Arc;
use technique::{Lag, Provenance, Technique};

/// All that there is to show, beside the pictures' pixels.
#[derive(Debug, Clone, Default)]
pub struct ViewModel {
    /// What is known of each pane's picture.
    pub panes: Panes<PaneView>,
    /// What the rays of panes wait for, in words, before there is a picture.
    pub waiting: Panes<String>,
    /// Where the errors are, while that is looked at.
    pub map: Option<Arc<ErrorMap>>,
    /// Which effects of light make what, while the map of errors names them.
    pub effects: Option<ShownEffects>,
    /// What is known of the pixel that is looked into.
    pub probe: Panes<PaneProbe>,
    /// Which shape each pixel shows, while parts of the scene are looked at: of the view that was asked for last.
    pub objects: Option<Arc<ObjectMap>>,
    /// Which shapes lie behind each other where that view is looked into.
    pub along: Option<ShapesAlong>,
    /// How far the reference has come, while it is asked for.
    pub reference: Option<Progress>,
    /// How much light each bounce brings, of panes where that is looked at.
    pub light: Panes<LightByBounce>,
    /// What is known of a sweep's tiles.
    pub sweep: SweepView,
    /// What is known of a ladder's rungs.
    pub ladder: LadderView,
    /// What is known of rays with and without trees.
    pub trees: TreesView,
    /// What is known of hard cases, whatever scene is open.
    pub cases: CasesView,
}

/// What there is to show of a sweep.
#[derive(Debug, Clone, Default)]
pub struct SweepView {
    /// In the order of its tiles.
    pub tiles: Vec<TileFacts>,
    /// How far the reference has come that they are measured by.
    pub reference: Option<Progress>,
}

/// What there is to show of one pane.
#[derive(Debug, Clone, Default)]
pub struct PaneView {
    /// Its linear radiance, for the loupe.
    pub image: Option<Image>,
    /// What its picture was made from; `None` while there is none.
    pub provenance: Option<Arc<Provenance>>,
    /// What is known of a picture that another program has made, of whose provenance the shot alone holds.
    pub external: Option<Arc<External>>,
    /// Samples per pixel, of all runs, where the technique samples.
    pub spp: Option<u32>,
    /// Pictures of which it is the mean, each of as many samples.
    pub runs: u32,
    /// Seconds that rendering has taken so far.
    pub seconds: f64,
    /// How they were spent.
    pub effort: Option<Effort>,
    /// Whether it is still noisy where its settings leave light to chance.
    pub noisy: bool,
    /// Samples that were not finite and are left out.
    pub nonfinite: u64,
    /// Whether the picture is a rough first one.
    pub rough: bool,
    /// Whether coarse meshes stand in it for large ones whose trees are not there yet.
    pub coarse: bool,
    /// How many pixels of the picture area one of its pixels takes, along a side.
    pub shrink: u32,
    /// Whether more of it will come.
    pub unfinished: bool,
    /// What it is compared with, and how far it is from that.
    pub errors: Option<(Against, Errors)>,
    /// The reference that it is compared with, where that is the reference of the same pixels.
    pub reference: Option<ReferenceImage>,
    /// The part of the picture that they are of; `None` for all of it.
    pub region: Option<Region>,
    /// How bright its pixels there are, while that is looked at.
    pub histogram: Option<Arc<Histogram>>,
    /// What taking out its noise took, and how far off it was before.
    pub denoised: Option<Denoising>,
    /// What it has of earlier views, where they count.
    pub lag: Option<Lag>,
    /// How far it was from that while it was made.
    pub history: ErrorHistory,
    /// What made it: a device's name, or a number of threads.
    pub adapter: Option<Arc<str>>,
    /// Why there is no picture.
    pub fault: Option<String>,
    /// Why it was not made where it should be.
    pub refused: Option<Arc<str>>,
    /// Why it is not denoised, or not where it should be.
    pub filter_fault: Option<Arc<str>>,
    /// What the camera's planes cut of the fake: one line.
    pub cut: Option<Arc<str>>,
    /// What the history is of.
    pub(crate) course: Option<Course>,
}

/// What is known of a denoised picture's denoising.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Denoising {
    /// Seconds that the filter took.
    pub seconds: f64,
    /// How far the picture was before from the reference, where that judges it.
    pub errors_before: Option<Errors>,
}

/// What errors must have in common to be points of one curve: the picture, but for its number of samples, what
/// judges it and where.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Course {
    against: Against,
    judged: Provenance,
    /// Which picture of another program it is, where one is.
    external: Option<(PaneSource, String)>,
    /// The picture that judges; `None` for the reference.
    judge: Option<Provenance>,
    region: Option<Region>,
}

impl Course {
    /// What judges the picture, and in which part of it.
    pub(crate) fn against(&self) -> (Against, Option<Region>) {
        (self.against, self.region)
    }
}

impl PaneView {
    /// Width and height of a picture that another program has made, where they are not those of what is seen:
    /// then nothing judges it.
    pub fn misfit(&self) -> Option<[(u32, u32); 2]> {
        let (image, made) = (self.image.as_ref()?, self.provenance.as_ref()?);
        let sizes = [image.size(), made.shot.size];
        (self.external.is_some() && sizes[0] != sizes[1]).then_some(sizes)
    }

    /// A pane without a picture, and why.
    pub fn failed(fault: String) -> Self {
        PaneView { fault: Some(fault), ..PaneView::default() }
    }
}

impl ViewModel {
    /// Adds the errors of a pane to its history; one of another picture, or against another, begins anew. `earlier` errors of
    /// the same picture, measured only now, take the place of what was known of it.
    pub fn note_errors(&mut self, id: PaneId, earlier: Vec<ErrorPoint>) {
        let judge = |against| match against {
            Against::Pane(judge) => self.panes.get(judge)?.provenance.as_deref().map(without_spp),
            Against::Reference => None,
        };
        let Some(pane) = self.panes.get(id).filter(|pane| !pane.rough && pane.lag.is_none()) else { return };
        let (Some((against, errors)), Some(judged)) = (pane.errors, pane.provenance.as_deref()) else { return };
        let external = pane.external.as_ref().map(|external| (external.source.clone(), external.name.clone()));
        let (judge, region) = (judge(against), pane.region);
        let course = Course { against, judged: without_spp(judged), external, judge, region };
        let point = ErrorPoint { spp: pane.spp, seconds: pane.seconds, errors };
        let pane = &mut self.panes[id];
        // a fake that is measured again has a time before that of its first point
        let is_before = |latest: &ErrorPoint| latest.spp > point.spp || latest.seconds > point.seconds;
        let begun_anew = pane.history.latest().is_some_and(is_before);
        if begun_anew || !earlier.is_empty() || pane.course.as_ref() != Some(&course) {
            (pane.history, pane.course) = (ErrorHistory::default(), Some(course));
        }
        let before = earlier.into_iter().filter(|earlier| earlier.spp <= point.spp && earlier.seconds <= point.seconds);
        before.chain(std::iter::once(point)).for_each(|point| pane.history.push(point));
    }
}

/// A picture of more samples is still the same one.
fn without_spp(provenance: &Provenance) -> Provenance {
    let mut provenance = provenance.clone();
    if let Technique::Traced(rays) = &mut provenance.technique {
        rays.spp = 0;
    }
    provenance
}

#[cfg(test)]
mod tests {
    use super::*;
    use technique::{Device, PaneSettings, Shot, TechniqueName};

    fn pane(technique: TechniqueName, wished: u32, spp: u32) -> PaneView {
        let mut settings = PaneSettings::of(technique);
        settings.truth.spp = wished;
        let shot = Shot::of(scene::builtin::named("cornell").unwrap(), (1, 1));
        let provenance = Provenance { shot, technique: settings.in_use(), device: Device::Cpu };
        let errors = compare::Errors { rmse: f64::from(spp), ..compare::Errors::default() };
        let errors = Some((Against::Pane(PaneId::A), errors));
        PaneView { provenance: Some(Arc::new(provenance)), spp: Some(spp), errors, ..PaneView::default() }
    }

    /// Shows pictures of B one after the other, A's technique beside each, and returns the samples in B's history.
    fn history(shown: &[(TechniqueName, PaneView)]) -> Vec<u32> {
        let mut model = ViewModel::default();
        for (technique_of_a, b) in shown {
            model.panes.insert(PaneId::A, pane(*technique_of_a, 256, 1));
            let (history, course) = model.panes.remove(PaneId::B).map(|b| (b.history, b.course)).unwrap_or_default();
            model.panes.insert(PaneId::B, PaneView { history, course, ..b.clone() });
            model.note_errors(PaneId::B, Vec::new());
        }
        model.panes[PaneId::B].history.iter().filter_map(|point| point.spp).collect()
    }

    #[test]
    fn a_history_goes_on_with_more_samples_and_begins_anew_with_another_picture() {
        use TechniqueName::{Path, Raster, Whitted};
        let path = |wished, spp| (Raster, pane(Path, wished, spp));
        assert_eq!(
            history(&[path(256, 1), path(256, 2), path(512, 4)]),
            [1, 2, 4],
            "more are wished: the same picture"
        );
        assert_eq!(history(&[path(256, 4), path(256, 1), path(256, 2)]), [1, 2], "begun anew");
        let again = PaneView { seconds: 0.1, ..pane(Path, 256, 2) };
        let slow = PaneView { seconds: 0.5, ..pane(Path, 256, 1) };
        assert_eq!(history(&[(Raster, slow), (Raster, again)]), [2], "no time goes back");
        assert_eq!(history(&[path(256, 1), (Raster, pane(Whitted, 256, 2))]), [2], "by another technique");
        assert_eq!(history(&[path(256, 1), (Whitted, pane(Path, 256, 2))]), [2], "against another picture");
        let mut judged_late = ViewModel::default();
        judged_late.panes.insert(PaneId::A, pane(Raster, 256, 1));
        judged_late.panes.insert(PaneId::B, pane(Path, 256, 4));
        let earlier = [1, 2, 8].map(|spp| ErrorPoint { spp: Some(spp), seconds: 0.0, errors: Errors::default() });
        judged_late.note_errors(PaneId::B, earlier.into());
        let spps: Vec<_> = judged_late.panes[PaneId::B].history.iter().filter_map(|point| point.spp).collect();
        assert_eq!(spps, [1, 2, 4], "what was measured later, and nothing of a longer picture");
        let rough = PaneView { rough: true, ..pane(Path, 256, 2) };
        assert_eq!(history(&[path(256, 1), (Raster, rough)]), [1], "rough ones are no points");
        let part = PaneView { region: Region::between([0.0; 2], [0.5; 2]), ..pane(Path, 256, 4) };
        assert_eq!(history(&[path(256, 1), path(256, 2), (Raster, part)]), [4], "another part");
    }
}
