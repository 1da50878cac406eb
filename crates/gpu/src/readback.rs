//! Results back from the device. A texture's rows come padded to 256 bytes; callers get them without.

use crate::{Gpu, GpuError};
use std::sync::mpsc;

impl Gpu {
    /// The texels of a texture's layer 0, rows from the top without gaps, as bytes. Waits until they are there. The
    /// texture needs `COPY_SRC` and one sample per texel; `what` names it in errors.
    ///
    /// # Errors
    /// [`GpuError::TooManyBytes`] beyond the largest buffer, [`GpuError::Lost`] if the device fails.
    pub fn read_texture(&self, what: &str, texture: &wgpu::Texture) -> Result<Vec<u8>, GpuError> {
        let (width, height) = (texture.width(), texture.height());
        let row = width * texture.format().block_copy_size(None).unwrap_or(4);
        let padded_row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(padded_row) * u64::from(height);
        let staging = self.staging(what, size)?;
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(what) });
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded_row), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &staging, layout },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        self.queue.submit([encoder.finish()]);
        self.mapped(what, &staging, |bytes| {
            bytes.chunks_exact(padded_row as usize).flat_map(|padded| &padded[..row as usize]).copied().collect()
        })
    }

    /// The contents of a buffer that has `COPY_SRC`, as bytes. Waits until they are there; `what` names it in errors.
    ///
    /// # Errors
    /// As [`Gpu::read_texture`].
    pub fn read_buffer(&self, what: &str, buffer: &wgpu::Buffer) -> Result<Vec<u8>, GpuError> {
        let staging = self.staging(what, buffer.size())?;
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(what) });
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
        self.queue.submit([encoder.finish()]);
        self.mapped(what, &staging, <[u8]>::to_vec)
    }

    fn staging(&self, what: &str, size: u64) -> Result<wgpu::Buffer, GpuError> {
        let limit = self.device.limits().max_buffer_size;
        if size > limit {
            return Err(GpuError::TooManyBytes { what: what.to_owned(), bytes: size, limit });
        }
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let descriptor = wgpu::BufferDescriptor { label: Some(what), size, usage, mapped_at_creation: false };
        self.checked(what, || self.device.create_buffer(&descriptor))
    }

    fn mapped(&self, what: &str, staging: &wgpu::Buffer, take: impl Fn(&[u8]) -> Vec<u8>) -> Result<Vec<u8>, GpuError> {
        let lost = |why: String| self.lost(what, why);
        let (send, receive) = mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |outcome| {
            // nobody listens any more only if the wait below failed
            let _ = send.send(outcome);
        });
        self.wait_for_all(what)?;
        receive.try_recv().map_err(|why| lost(why.to_string()))?.map_err(|why| lost(why.to_string()))?;
        let range = staging.get_mapped_range(..).map_err(|why| lost(why.to_string()))?;
        Ok(take(&range))
    }
}
