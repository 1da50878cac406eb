//! What hangs in the window: for each pane its texture, what the UI says about it, and the picture itself for export.

use super::textures::PaneTexture;
use crate::technique::Made;
use crate::ui::{Pane, Viewer};
use crate::workers::darkroom::{News, Shelf};
use crate::workers::exporter::Content;
use crate::workers::{Picture, Side};
use gpu::Gpu;
use picture_file::Records;
use scene::display::DisplayTransform;

/// Both panes.
#[derive(Default)]
pub struct Exhibit {
    /// What the UI is told.
    pub panes: [Pane; 2],
    pictures: [Option<Picture>; 2],
    textures: [PaneTexture; 2],
}

impl Exhibit {
    /// Takes everything down; the textures stay for the next.
    pub fn clear(&mut self) {
        self.panes = Default::default();
        self.pictures = Default::default();
    }

    /// Puts up what is new.
    pub fn hang(&mut self, shelf: Shelf, gpu: &Gpu, renderer: &mut egui_wgpu::Renderer) {
        for (side, news) in shelf.into_iter().enumerate() {
            let pane = &mut self.panes[side];
            match news {
                None => {}
                Some(News::Fault(fault)) => {
                    *pane = Pane { fault: Some(fault), ..Pane::default() };
                    self.pictures[side] = None;
                }
                Some(News::Picture(developed)) => {
                    let picture = developed.picture;
                    if let Some(rgba) = &developed.rgba {
                        let texture = &mut self.textures[side];
                        pane.texture = Some(texture.upload(gpu, renderer, picture.width, picture.height, rgba));
                        pane.fault = None;
                    }
                    pane.provenance = Some(picture.order.provenance.clone());
                    (pane.spp, pane.seconds, pane.nonfinite) = (picture.spp, picture.seconds, picture.nonfinite);
                    (pane.rough, pane.unfinished) = (picture.rough, picture.unfinished);
                    pane.errors = developed.errors;
                    self.pictures[side] = Some(picture);
                }
            }
        }
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
        let records = picture.order.provenance.records(made);
        Some((Content::Pane(picture.clone(), display), records))
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
