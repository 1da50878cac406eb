//! What is shown: for each pane its texture, what the UI says about it, and the picture itself for
//! export; and the map of errors.

use super::external;
use crate::engine::Picture;
use crate::engine::export::Content;
use crate::engine::post_process::{DisplayFrame, PaneUpdate, PaneUpdates};
use crate::engine::restore::QUALIFIED;
use crate::engine::thumbnails::Thumbnail;
use crate::engine::view_records::{file_of, records_of_view};
use crate::model::{Against, Denoising, ErrorMap, Model, PaneId, PaneProbe, PaneView, Panes, ViewModel, Wanted};
use crate::ruler::error_records;
use crate::ui::Textures;
use egui::{TextureFilter, TextureId};
use film::DisplayTransform;
use image_file::Records;
use std::sync::Arc;
use technique::{EARLIER_VIEWS, Halves, Made, OWN_FOV, Technique};

/// All panes and the map.
#[derive(Default)]
pub struct Presentation {
    /// What the UI is told.
    pub shown: ViewModel,
    /// The pixels of that.
    pub textures: Textures,
    pictures: Panes<Picture>,
}

/// Where pixels are kept to be drawn: one texture for each place.
pub trait TextureStore {
    /// Replaces what a place shows by `size` pixels of RGBA, rows from the top; between them `filter` reads.
    fn upload(&mut self, place: Place, size: (u32, u32), rgba: &[u8], filter: TextureFilter) -> TextureId;
}

/// Something that shows pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// The picture of a pane.
    Pane(PaneId),
    /// The map of errors.
    ErrorMap,
    /// The outline of the part of the scene that is in hand.
    Outline,
    /// A tile of a sweep, by its place.
    Tile(usize),
    /// The picture of a ladder's rung, by its place; behind the last the reference.
    Rung(usize),
    /// The map of a rung's errors.
    LadderMap,
    /// Rays through the statue in one structure, by its place.
    Trees(usize),
    /// A small picture of the built-in scene of this name.
    Thumbnail(&'static str),
}

impl Presentation {
    /// Forgets all pictures of the scene and the textures that show them.
    pub fn clear(&mut self) {
        let thumbnails = std::mem::take(&mut self.textures.thumbnails);
        self.textures = Textures { thumbnails, ..Textures::default() };
        let cases = std::mem::take(&mut self.shown.cases);
        self.shown = ViewModel { cases, ..ViewModel::default() };
        self.pictures = Panes::default();
    }

    /// Takes all textures down, whose device has failed; the pictures stay for the next device.
    pub fn lose_textures(&mut self) {
        self.textures = Textures::default();
        self.shown.map = None;
    }

    /// Puts up what is new.
    pub fn update(&mut self, updates: PaneUpdates, textures: &mut impl TextureStore) {
        let changed: Vec<PaneId> = updates.ids().collect();
        let mut courses = Panes::default();
        for (pane, update) in updates {
            match update {
                PaneUpdate::Fault(fault) => {
                    self.shown.panes.insert(pane, PaneView::failed(fault));
                    self.textures.panes.remove(pane);
                    self.pictures.remove(pane);
                }
                PaneUpdate::Picture(mut frame) => {
                    frame.course.take().into_iter().for_each(|course| drop(courses.insert(pane, course)));
                    self.put_up(pane, *frame, textures);
                }
            }
        }
        // the error of one belongs to the picture of the other
        changed.into_iter().for_each(|pane| self.shown.note_errors(pane, courses.remove(pane).unwrap_or_default()));
    }

    fn put_up(&mut self, pane: PaneId, frame: DisplayFrame, textures: &mut impl TextureStore) {
        let DisplayFrame { picture, rgba, errors, reference, histogram, region, course: _, errors_before } = frame;
        let shown = self.shown.panes.entry(pane);
        if let Some(rgba) = &rgba {
            let texture = textures.upload(Place::Pane(pane), picture.image.size(), rgba, filter_of(&picture));
            self.textures.panes.insert(pane, texture);
            shown.fault = None;
        }
        shown.provenance = Some(picture.order.provenance.clone());
        shown.external.clone_from(&picture.external);
        (shown.spp, shown.seconds, shown.nonfinite) = (picture.spp, picture.seconds, picture.nonfinite);
        shown.runs = picture.runs;
        (shown.effort, shown.noisy) = (Some(picture.effort), picture.noisy);
        (shown.refused, shown.cut) = (picture.refused.clone(), picture.cut.clone());
        shown.filter_fault = picture.filter_fault.clone();
        shown.adapter = Some(picture.adapter.clone());
        (shown.rough, shown.coarse, shown.unfinished) = (picture.rough, picture.coarse, picture.unfinished);
        let coarser = picture.order.size().0.div_ceil(picture.image.width().max(1)) * picture.order.shrink;
        shown.shrink = if picture.external.is_some() { 1 } else { coarser };
        (shown.errors, shown.region) = (errors, region);
        (shown.image, shown.reference, shown.histogram) = (Some(picture.image.clone()), reference, histogram);
        shown.lag = picture.lag;
        shown.denoised = picture.before.as_ref().map(|before| Denoising { seconds: before.seconds, errors_before });
        self.pictures.insert(pane, picture);
    }

    /// Takes down what is no longer wanted: it is not made again, and would grow old.
    pub fn keep(&mut self, wanted: &Wanted) {
        let is_wanted = |pane| wanted.panes.get(pane).is_some();
        self.shown.panes.retain(|pane, _| is_wanted(pane));
        self.shown.waiting.retain(|pane, _| is_wanted(pane));
        self.textures.panes.retain(|pane, _| is_wanted(pane));
        self.pictures.retain(|pane, _| is_wanted(pane));
        let is_traced =
            |pane| wanted.panes.get(pane).is_some_and(|pane| matches!(pane.technique, Technique::Traced(_)));
        self.shown.probe.retain(|pane, _| wanted.probe.is_some() && is_traced(pane));
        self.keep_objects(wanted);
        self.keep_effects(wanted);
        if wanted.map.is_none() {
            (self.shown.map, self.textures.map) = (None, None);
        }
    }

    /// Puts up a map of errors, or takes it down.
    pub fn update_map(&mut self, drawn: Option<ErrorMap>, textures: &mut impl TextureStore) {
        self.textures.map = drawn.as_ref().map(|drawn| {
            textures.upload(Place::ErrorMap, (drawn.map.width, drawn.map.height()), &drawn.rgba, TextureFilter::Nearest)
        });
        self.shown.map = drawn.map(Arc::new);
    }

    /// Takes what panes wait for, or that they do no more.
    pub fn update_waiting(&mut self, waiting: Panes<Option<String>>) {
        for (pane, words) in waiting {
            match words {
                Some(words) => drop(self.shown.waiting.insert(pane, words)),
                None => drop(self.shown.waiting.remove(pane)),
            }
        }
    }

    /// Takes what is new of the pixel that is looked into.
    pub fn update_probe(&mut self, probed: Panes<PaneProbe>) {
        probed.into_iter().for_each(|(pane, probe)| drop(self.shown.probe.insert(pane, probe)));
    }

    /// Puts up small pictures of scenes.
    pub fn update_thumbnails(&mut self, drawn: Vec<Thumbnail>, textures: &mut impl TextureStore) {
        for Thumbnail { name, size, rgba } in drawn {
            self.textures
                .thumbnails
                .insert(name, textures.upload(Place::Thumbnail(name), size, &rgba, TextureFilter::Linear));
        }
    }

    /// The pictures of all panes; or the pane that has no whole one yet.
    pub fn whole_pictures(&self, model: &Model) -> Result<Vec<(PaneId, &Picture)>, PaneId> {
        let whole = |pane| self.pictures.get(pane).filter(|picture| !picture.rough).map(|picture| (pane, picture));
        model.session.panes.ids().map(|pane| whole(pane).ok_or(pane)).collect()
    }

    /// The map for export, if there is one.
    pub fn map(&self, model: &Model) -> Option<(Content, Records)> {
        let drawn = self.shown.map.clone()?;
        Some((Content::Map(drawn), self.records_of_all(model)))
    }

    /// One pane for export; `None` while there is nothing but a rough picture.
    pub fn pane(&self, pane: PaneId, model: &Model) -> Option<(Content, Records)> {
        let display = model.session.display;
        let picture = self.pictures.get(pane).filter(|picture| !picture.rough)?;
        let mut records = match &picture.external {
            Some(external) => external::records(external, picture, display),
            None => records_of(picture, display),
        };
        if let Some((against, errors)) = self.shown.panes.get(pane).and_then(|shown| shown.errors)
            && let Some(judge) = self.name_of_what_judges(against, display)
        {
            records.extend(error_records(&errors, judge));
            let region = self.shown.panes[pane].region;
            records.extend(region.map(|region| ("error.region", region.record())));
        }
        Some((Content::Pane(Box::new(picture.clone()), display), records))
    }

    /// "B: the command that makes it", or "reference".
    fn name_of_what_judges(&self, against: Against, display: DisplayTransform) -> Option<String> {
        let Against::Pane(judge) = against else { return Some(against.name().into()) };
        let picture = self.pictures.get(judge)?;
        Some(format!("{judge}: {}", external::how_it_is_made(picture, display, &file_of(judge))))
    }

    /// What a file keeps about the picture as seen: the view, for each pane the command that makes it, and the session.
    pub fn records_of_all(&self, model: &Model) -> Records {
        // all panes show one scene from one place
        let shown = self.pictures.values().next().map(|picture| &picture.order);
        let shown = shown.map(|order| (&order.provenance.shot, &order.own_camera));
        let display = model.session.display;
        let commands = self.pictures.iter().map(|(pane, picture)| {
            let [rough, lagging] = QUALIFIED;
            let qualified = if picture.rough { rough } else { picture.lag.map_or("", |_| lagging) };
            (pane, format!("{qualified}{}", external::how_it_is_made(picture, display, &file_of(pane))))
        });
        records_of_view(model, shown, commands)
    }
}

/// What a file keeps of a picture that was made here.
fn records_of(picture: &Picture, display: DisplayTransform) -> Records {
    let (provenance, spp) = picture.made();
    let made = Made {
        spp,
        seconds: picture.seconds,
        adapter: &picture.adapter,
        denoised_by: picture.before.as_ref().map(|before| &*before.by),
        exposure: display.exposure,
    };
    let mut records = provenance.records(made);
    let halves = picture.before.as_ref().and_then(|before| before.halves);
    records.extend(halves.into_iter().flat_map(Halves::records));
    if let Some(lag) = picture.lag {
        records.push((EARLIER_VIEWS, format!("{lag}: command makes it without them")));
    }
    let own = &picture.order.own_camera;
    if own.fov_y != picture.order.camera().fov_y {
        records.push((OWN_FOV, own.fov_y.to_string()));
    }
    records
}

/// A picture that stands for a finer one until that has come is smooth, as that will be; and so is a map, which is seen
/// at any size. All others are shown as they are, pixel by pixel.
fn filter_of(picture: &Picture) -> TextureFilter {
    let is_map = matches!(picture.order.provenance.technique, Technique::Fake(fake) if fake.show.is_map());
    if picture.rough || is_map { TextureFilter::Linear } else { TextureFilter::Nearest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{PaneSource, ProbeWish, Theme};
    use technique::TechniqueName;

    /// The panes of which samples are kept, where B is changed after both were traced.
    fn sampled_after(change: impl FnOnce(&mut Model)) -> Vec<PaneId> {
        let mut model = Model::new(scene::builtin::named("cornell").unwrap(), "cornell".into(), Theme::Dark);
        model.state.picture.size = (1, 1);
        let panes = [PaneId::A, PaneId::B];
        panes.iter().for_each(|pane| model.session.panes[*pane].technique = TechniqueName::Path);
        let mut presentation = Presentation::default();
        presentation.update_probe(panes.into_iter().map(|pane| (pane, PaneProbe::default())).collect());
        change(&mut model);
        presentation.keep(&Wanted { probe: Some(ProbeWish { at: [0.5; 2], sample: None }), ..model.wanted(panes) });
        presentation.shown.probe.ids().collect()
    }

    #[test]
    fn samples_go_with_the_technique_that_they_are_of() {
        assert_eq!(sampled_after(|_| ()), [PaneId::A, PaneId::B]);
        assert_eq!(
            sampled_after(|model| model.session.panes[PaneId::B].technique = TechniqueName::Raster),
            [PaneId::A]
        );
        assert_eq!(sampled_after(|model| model.session.set_source(PaneId::B, PaneSource::Received(9))), [PaneId::A]);
    }
}
