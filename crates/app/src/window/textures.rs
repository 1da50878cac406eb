//! Textures on the window's device: sRGB-encoded bytes.

use crate::viewer::{Place, TextureStore};
use egui::TextureFilter;
use gpu::Gpu;
use std::collections::HashMap;

/// One texture a place, as large as its last picture.
#[derive(Default)]
pub struct WindowTextures(HashMap<Place, Kept>);

/// A texture, and as what egui knows it.
struct Kept {
    texture: wgpu::Texture,
    id: egui::TextureId,
    filter: TextureFilter,
}

/// The textures beside what fills them.
pub struct Uploads<'a> {
    pub gpu: &'a Gpu,
    pub renderer: &'a mut egui_wgpu::Renderer,
    /// All that there are.
    pub textures: &'a mut WindowTextures,
}

impl TextureStore for Uploads<'_> {
    fn upload(
        &mut self,
        place: Place,
        (width, height): (u32, u32),
        rgba: &[u8],
        filter: TextureFilter,
    ) -> egui::TextureId {
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let kept = match self.textures.0.remove(&place) {
            Some(kept) if kept.texture.size() == size && kept.filter == filter => kept,
            old => {
                let texture = texture_of(self.gpu, size);
                let id = self.show(&texture, filter, old.map(|old| old.id));
                Kept { texture, id, filter }
            }
        };
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        self.gpu.queue.write_texture(kept.texture.as_image_copy(), rgba, layout, size);
        let id = kept.id;
        self.textures.0.insert(place, kept);
        id
    }
}

impl Uploads<'_> {
    /// Lets egui know a texture, in the place of an old one if there is one.
    fn show(
        &mut self,
        texture: &wgpu::Texture,
        filter: TextureFilter,
        old: Option<egui::TextureId>,
    ) -> egui::TextureId {
        let device = &self.gpu.device;
        let filter = match filter {
            TextureFilter::Nearest => wgpu::FilterMode::Nearest,
            TextureFilter::Linear => wgpu::FilterMode::Linear,
        };
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        // one that is larger than its place, as another program's may be, is no mosaic of single pixels
        let min_filter = wgpu::FilterMode::Linear;
        let sampler = wgpu::SamplerDescriptor { mag_filter: filter, min_filter, ..Default::default() };
        match old {
            Some(id) => {
                self.renderer.update_egui_texture_from_wgpu_texture_with_sampler_options(device, &view, sampler, id);
                id
            }
            None => self.renderer.register_native_texture_with_sampler_options(device, &view, sampler),
        }
    }
}

fn texture_of(gpu: &Gpu, size: wgpu::Extent3d) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("pane"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}
