//! A picture on the device: half floats in linear light, and smaller ones of it for where it is far away, each texel the
//! mean of those that it stands for (Williams, "Pyramidal parametrics", 1983).

use gpu::{Gpu, GpuError};
use half::f16;
use scene::ImageTexture;
use scene::image_texture::{Sampling, Wrap};
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{AddressMode, FilterMode, Sampler, TextureView};

/// A texture and how it is looked up.
#[derive(Debug, Clone)]
pub struct Bound {
    /// All sizes of it.
    pub view: TextureView,
    /// Its wrap and filter.
    pub sampler: Sampler,
}

impl Bound {
    /// Uploads a picture with all of its mips.
    pub fn new(gpu: &Gpu, image: &ImageTexture) -> Result<Bound, GpuError> {
        let (width, height) = image.size();
        gpu.check_size("a picture on a surface", width, height)?;
        let bytes: Vec<u8> = levels(image).flat_map(|level| level.bytes()).collect();
        let descriptor = wgpu::TextureDescriptor {
            label: Some("a picture on a surface"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: width.max(height).ilog2() + 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        let texture = gpu.checked("a picture on a surface", || {
            gpu.device.create_texture_with_data(&gpu.queue, &descriptor, TextureDataOrder::LayerMajor, &bytes)
        })?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Bound { view, sampler: sampler(gpu, &image.sampling) })
    }
}

/// Stands in for pictures that a material does not have.
pub fn white(gpu: &Gpu) -> Result<Bound, GpuError> {
    let image = ImageTexture::new(1, 1, vec![[1.0; 4]], Sampling::default());
    image.map_or(Err(GpuError::Empty { what: "a picture".to_owned(), width: 1, height: 1 }), |it| Bound::new(gpu, &it))
}

fn sampler(gpu: &Gpu, sampling: &Sampling) -> Sampler {
    let [address_mode_u, address_mode_v] = sampling.wrap.map(|wrap| match wrap {
        Wrap::Repeat => AddressMode::Repeat,
        Wrap::Clamp => AddressMode::ClampToEdge,
        Wrap::Mirror => AddressMode::MirrorRepeat,
    });
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u,
        address_mode_v,
        mag_filter: if sampling.bilinear { FilterMode::Linear } else { FilterMode::Nearest },
        // from afar texels are as small as pixels, and the truth is their mean whatever they are up close
        min_filter: FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..wgpu::SamplerDescriptor::default()
    })
}

/// One size of a picture.
#[derive(Debug, Clone, PartialEq)]
struct Level {
    width: usize,
    height: usize,
    texels: Vec<[f32; 4]>,
}

/// A picture and its halves, down to one texel.
fn levels(image: &ImageTexture) -> impl Iterator<Item = Level> {
    let (width, height) = image.size();
    let whole = Level { width: width as usize, height: height as usize, texels: image.texels().to_vec() };
    std::iter::successors(Some(whole), |level| (level.width.max(level.height) > 1).then(|| level.halved()))
}

impl Level {
    fn halved(&self) -> Level {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let texel = |at: usize| self.mean(part(at % width, width, self.width), part(at / width, height, self.height));
        Level { width, height, texels: (0..width * height).map(texel).collect() }
    }

    fn mean(&self, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> [f32; 4] {
        let count = (columns.len() * rows.len()) as f32;
        let mut sum = [0.0; 4];
        for texel in rows.flat_map(|y| &self.texels[y * self.width..][columns.clone()]) {
            sum.iter_mut().zip(texel).for_each(|(sum, channel)| *sum += channel);
        }
        sum.map(|channel| channel / count)
    }

    /// Half floats; those beyond their range are the largest ones.
    fn bytes(&self) -> Vec<u8> {
        let largest = f32::from(f16::MAX);
        let half = |channel: &f32| f16::from_f32(channel.clamp(-largest, largest)).to_le_bytes();
        self.texels.iter().flatten().flat_map(half).collect()
    }
}

/// The texels along an axis of `size` that one of `count` stands for: two, or three where their number is odd.
fn part(index: usize, count: usize, size: usize) -> std::ops::Range<usize> {
    index * size / count..((index + 1) * size).div_ceil(count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smaller_pictures_are_means_down_to_one_texel() {
        let texels = (0..15).map(|i| [i as f32, 1.0, 0.0, 1.0]).collect();
        let image = ImageTexture::new(5, 3, texels, Sampling::default()).unwrap();
        let levels: Vec<_> = levels(&image).collect();
        assert_eq!(levels.iter().map(|l| (l.width, l.height)).collect::<Vec<_>>(), [(5, 3), (2, 1), (1, 1)]);
        // columns 0 to 2 and 2 to 4 of all three rows
        assert_eq!(levels[1].texels, [[6.0, 1.0, 0.0, 1.0], [8.0, 1.0, 0.0, 1.0]]);
        assert_eq!(levels[2].texels, [[7.0, 1.0, 0.0, 1.0]]);
    }
}
