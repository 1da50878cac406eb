//! What is shown in the window: for each pane its texture, what the UI says about it, and the picture itself for
//! export; and the map of errors.

use super::textures::PaneTexture;
use crate::engine::error_map::ErrorMap;
use crate::engine::export::Content;
use crate::engine::post_process::{PaneUpdate, PaneUpdates};
use crate::engine::{Picture, Side};
use crate::ruler::{Against, error_records};
use crate::technique::Made;
use crate::ui::{MapPane, Pane, ViewModel, Viewer};
use film::DisplayTransform;
use gpu::Gpu;
use image_file::Records;
use std::sync::Arc;

/// Both panes and the map.
#[derive(Default)]
pub struct Presentation {
    /// What the UI is told.
    pub model: ViewModel,
    pictures: [Option<Picture>; 2],
    textures: [PaneTexture; 2],
    map_texture: PaneTexture,
}

impl Presentation {
    /// Takes everything down; the textures stay for the next.
    pub fn clear(&mut self) {
        self.model = ViewModel::default();
        self.pictures = Default::default();
    }

    /// Takes all textures down, whose device has failed; the pictures stay for the next device.
    pub fn lose_textures(&mut self) {
        (self.textures, self.map_texture) = Default::default();
        self.model.panes.iter_mut().for_each(|pane| pane.texture = None);
        self.model.map = None;
    }

    /// Puts up what is new.
    pub fn update(&mut self, updates: PaneUpdates, gpu: &Gpu, renderer: &mut egui_wgpu::Renderer) {
        for (side, update) in updates.into_iter().enumerate() {
            let pane = &mut self.model.panes[side];
            match update {
                None => {}
                Some(PaneUpdate::Fault(fault)) => {
                    *pane = Pane { fault: Some(fault), ..Pane::default() };
                    self.pictures[side] = None;
                }
                Some(PaneUpdate::Picture(frame)) => {
                    let picture = frame.picture;
                    if let Some(rgba) = &frame.rgba {
                        let texture = &mut self.textures[side];
                        pane.texture =
                            Some(texture.upload(gpu, renderer, picture.image.width(), picture.image.height(), rgba));
                        pane.fault = None;
                    }
                    pane.provenance = Some(picture.order.provenance.clone());
                    (pane.spp, pane.seconds, pane.nonfinite) = (picture.spp, picture.seconds, picture.nonfinite);
                    pane.refused = picture.refused.clone();
                    pane.adapter = Some(picture.adapter.clone());
                    (pane.rough, pane.unfinished) = (picture.rough, picture.unfinished);
                    pane.shrink = picture.order.size().0.div_ceil(picture.image.width().max(1)) * picture.order.shrink;
                    (pane.errors, pane.against) = (frame.errors, frame.against);
                    self.pictures[side] = Some(picture);
                }
            }
        }
    }

    /// Puts up a map of errors, or takes it down.
    pub fn update_map(&mut self, drawn: Option<ErrorMap>, gpu: &Gpu, renderer: &mut egui_wgpu::Renderer) {
        self.model.map = drawn.map(|drawn| {
            let (width, height) = (drawn.map.width, drawn.map.height());
            let texture = self.map_texture.upload(gpu, renderer, width, height, &drawn.rgba);
            MapPane { texture, drawn: Arc::new(drawn) }
        });
    }

    /// The map for export, if there is one.
    pub fn map(&self, viewer: &Viewer) -> Option<(Content, Records)> {
        let drawn = self.model.map.as_ref()?.drawn.clone();
        Some((Content::Map(drawn), self.records_of_both(viewer)))
    }

    /// One pane for export; `None` while there is nothing but a rough picture.
    pub fn pane(&self, side: Side, display: DisplayTransform) -> Option<(Content, Records)> {
        let picture = self.pictures[side as usize].as_ref().filter(|picture| !picture.rough)?;
        let made = Made {
            spp: picture.spp.unwrap_or(1),
            seconds: picture.seconds,
            adapter: &picture.adapter,
            exposure: display.exposure,
        };
        let mut records = picture.order.provenance.records(made);
        let pane = &self.model.panes[side as usize];
        if let (Some(errors), Some(against)) = (pane.errors, self.name_of_what_judges(side, display)) {
            records.extend(error_records(&errors, against));
        }
        Some((Content::Pane(picture.clone(), display), records))
    }

    /// "B: the command that makes it", or "reference".
    fn name_of_what_judges(&self, side: Side, display: DisplayTransform) -> Option<String> {
        if self.model.panes[side as usize].against == Against::Reference {
            return Some("reference".into());
        }
        let other = self.pictures[side.other() as usize].as_ref()?;
        let name = side.other().name();
        let out = format!("{}.png", name.to_lowercase());
        let command = other.order.provenance.command(other.spp.unwrap_or(1), display.exposure, &out);
        Some(format!("{name}: {command}"))
    }

    /// What a file keeps about the picture as seen: the view, and for each pane the command that makes it.
    pub fn records_of_both(&self, viewer: &Viewer) -> Records {
        let exposure = viewer.settings.display.exposure;
        let mut records = vec![
            ("view", viewer.view.name().to_owned()),
            ("line", format!("{} at {}", viewer.line.name(), viewer.wipe)),
            ("exposure", exposure.to_string()),
        ];
        for ((name, out), picture) in [("A", "a.png"), ("B", "b.png")].into_iter().zip(&self.pictures) {
            if let Some(picture) = picture {
                let command = picture.order.provenance.command(picture.spp.unwrap_or(1), exposure, out);
                records.push((name, if picture.rough { format!("rough, in full: {command}") } else { command }));
            }
        }
        records
    }
}
