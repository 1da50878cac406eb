//! The textures of the two panes: sRGB-encoded bytes, shown one texel a pixel.

use gpu::Gpu;

/// One pane's texture, as large as the last picture.
#[derive(Default)]
pub struct PaneTexture {
    shown: Option<(wgpu::Texture, egui::TextureId)>,
}

impl PaneTexture {
    /// Uploads a picture of `width` x `height` RGBA bytes and returns what egui knows it by.
    pub fn upload(
        &mut self,
        gpu: &Gpu,
        renderer: &mut egui_wgpu::Renderer,
        width: u32,
        height: u32,
        rgba: &[u8],
    ) -> egui::TextureId {
        let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let (texture, id) = match self.shown.take() {
            Some((texture, id)) if texture.size() == size => (texture, id),
            old => {
                let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                    label: Some("pane"),
                    size,
                    mip_level_count: 1,
                    sample_count: 1,
                    dimension: wgpu::TextureDimension::D2,
                    format: wgpu::TextureFormat::Rgba8Unorm,
                    usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                    view_formats: &[],
                });
                let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
                let nearest = wgpu::FilterMode::Nearest;
                let id = match old {
                    Some((_, id)) => {
                        renderer.update_egui_texture_from_wgpu_texture(&gpu.device, &view, nearest, id);
                        id
                    }
                    None => renderer.register_native_texture(&gpu.device, &view, nearest),
                };
                (texture, id)
            }
        };
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: None };
        gpu.queue.write_texture(texture.as_image_copy(), rgba, layout, size);
        self.shown = Some((texture, id));
        id
    }
}
