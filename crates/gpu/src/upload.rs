//! Buffers and textures from slices of plain data.

use crate::error::one_line;
use crate::{Gpu, GpuError};
use wgpu::util::DeviceExt;

impl Gpu {
    /// A buffer that holds `data` (zero bytes grow to the smallest buffer there is). `label` names it in errors.
    ///
    /// # Errors
    /// [`GpuError::TooManyBytes`] beyond the device's limit, [`GpuError::Refused`] if memory is short.
    pub fn buffer<T: bytemuck::NoUninit>(
        &self,
        label: &str,
        data: &[T],
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let contents = if data.is_empty() { &[0; 4] } else { bytemuck::cast_slice(data) };
        let (bytes, limit) = (contents.len() as u64, self.device.limits().max_buffer_size);
        if bytes > limit {
            return Err(GpuError::TooManyBytes { what: label.to_owned(), bytes, limit });
        }
        let size = bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: true };
        // not `create_buffer_init`, which panics where there is no memory or the device is lost
        let buffer = self.checked(label, || self.device.create_buffer(&descriptor))?;
        let refused = |why: wgpu::MapRangeError| GpuError::Refused { what: label.to_owned(), why: one_line(&why) };
        buffer.get_mapped_range_mut(..).map_err(refused)?.slice(..contents.len()).copy_from_slice(contents);
        buffer.unmap();
        Ok(buffer)
    }

    /// A two-dimensional texture of `layers` layers without contents. `label` names it in errors.
    ///
    /// # Errors
    /// [`GpuError::Empty`], [`GpuError::TooLarge`], or [`GpuError::Refused`] if memory is short.
    pub fn texture(&self, label: &str, plan: &TexturePlan) -> Result<wgpu::Texture, GpuError> {
        self.check_size(label, plan.width, plan.height)?;
        let descriptor = plan.descriptor(label);
        self.checked(label, || self.device.create_texture(&descriptor))
    }

    /// A texture that holds `data`: layer by layer, rows from the top, without gaps.
    ///
    /// # Errors
    /// As [`Gpu::texture`]; [`GpuError::Refused`] also if `data` has the wrong length.
    pub fn texture_of<T: bytemuck::NoUninit>(
        &self,
        label: &str,
        plan: &TexturePlan,
        data: &[T],
    ) -> Result<wgpu::Texture, GpuError> {
        self.check_size(label, plan.width, plan.height)?;
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let texel = u64::from(plan.format.block_copy_size(None).unwrap_or(0));
        let expected = u64::from(plan.width) * u64::from(plan.height) * u64::from(plan.layers) * texel;
        if bytes.len() as u64 != expected {
            let why = format!("{} bytes were given, {expected} are needed", bytes.len());
            return Err(GpuError::Refused { what: label.to_owned(), why });
        }
        let descriptor = plan.descriptor(label);
        let order = wgpu::util::TextureDataOrder::LayerMajor;
        self.checked(label, || self.device.create_texture_with_data(&self.queue, &descriptor, order, bytes))
    }
}

/// Size, format and use of a two-dimensional texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TexturePlan {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// How many layers.
    pub layers: u32,
    /// Samples per texel: 1 or 4.
    pub samples: u32,
    /// What a texel is.
    pub format: wgpu::TextureFormat,
    /// What it is for.
    pub usage: wgpu::TextureUsages,
}

impl TexturePlan {
    fn descriptor<'a>(&self, label: &'a str) -> wgpu::TextureDescriptor<'a> {
        wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width: self.width, height: self.height, depth_or_array_layers: self.layers },
            mip_level_count: 1,
            sample_count: self.samples,
            dimension: wgpu::TextureDimension::D2,
            format: self.format,
            usage: self.usage,
            view_formats: &[],
        }
    }
}
