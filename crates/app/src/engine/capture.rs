//! A part of a frame that was drawn into a texture, to be read back beside the UI.

use gpu::Gpu;

/// The texture and what of it is wanted.
#[derive(Debug)]
pub struct Capture {
    /// The device that it lives on.
    pub gpu: Gpu,
    /// Eight bits a channel, red or blue first.
    pub texture: wgpu::Texture,
    /// Left, top, right and bottom of the wanted part, in pixels.
    pub part: [u32; 4],
}

/// Opaque RGBA bytes, rows from the top.
#[derive(Debug)]
pub struct Pixels {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

impl Capture {
    /// Waits for the device and reads the part back.
    ///
    /// # Errors
    /// If the device fails.
    pub fn pixels(&self) -> anyhow::Result<Pixels> {
        let bytes = self.gpu.read_texture("picture as seen", &self.texture)?;
        let [left, top, right, bottom] = self.part;
        let rows = bytes.chunks_exact(4 * self.texture.width() as usize).take(bottom as usize).skip(top as usize);
        let mut rgba: Vec<u8> = rows.flat_map(|row| &row[4 * left as usize..4 * right as usize]).copied().collect();
        if self.texture.format().remove_srgb_suffix() == wgpu::TextureFormat::Bgra8Unorm {
            rgba.chunks_exact_mut(4).for_each(|pixel| pixel.swap(0, 2));
        }
        Ok(Pixels { width: right - left, height: bottom - top, rgba })
    }
}
