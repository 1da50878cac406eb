//! What Open Image Denoise does (filter RT, HDR, features not prefiltered), with its networks: one exposure and a transfer
//! curve in front of the network, their inverse behind. Checked against that program's own pictures in `tests/oidn.rs`.
//! On the device: `shaders/denoise/unet/input.wgsl`, output.wgsl.

use crate::network::{Memory, Network};
use crate::planes::{BLOCK, Pixel, Planes, Shape, strips};
use crate::tiles::{MOST_PIXELS, Tile, tiles};
use crate::transfer::{Transfer, exposure};
use crate::{DenoiseError, Features, Stop};
use film::{Image, Vec3};
use rayon::prelude::*;
use simd::Lanes;

impl Network {
    /// The picture without its noise, and not without a bias. Inputs that are not finite count as 0. Memory beside the
    /// pictures: at most .37 GiB with the small network and .5 GiB with the other, whatever the size.
    ///
    /// # Errors
    /// [`DenoiseError`] if features are of another size, `stop` said so, or there is not enough memory.
    pub fn denoise(&self, color: &Image, features: Features, stop: Stop) -> Result<Image, DenoiseError> {
        self.denoise_on(Lanes::best(), color, features, MOST_PIXELS, stop)
    }

    /// As [`Network::denoise`], on these lanes and with at most so many pixels in memory at once.
    ///
    /// # Errors
    /// As [`Network::denoise`].
    pub fn denoise_on(
        &self,
        lanes: Lanes,
        color: &Image,
        features: Features,
        most_pixels: usize,
        stop: Stop,
    ) -> Result<Image, DenoiseError> {
        features.check(color)?;
        let size = [color.width() as usize, color.height() as usize];
        let mut denoised = vec![Vec3::ZERO; color.radiances().len()];
        let tiles = tiles(size, most_pixels);
        let most = |axis: usize| tiles.iter().map(|tile| tile.size()[axis]).max().unwrap_or(0);
        let mut memory =
            self.memory(most(0), most(1)).ok_or(DenoiseError::Memory(self.memory_size(most(0), most(1))))?;
        let work = Work {
            size,
            color: color.radiances(),
            features,
            transfer: Transfer::new(exposure(color.radiances(), size[0])),
        };
        for tile in &tiles {
            work.read(tile, &mut memory);
            let output = self.run(&mut memory, lanes, stop).ok_or(DenoiseError::Stopped)?;
            work.write(tile, output, &mut denoised);
        }
        Image::new(color.width(), color.height(), denoised).ok_or(DenoiseError::Size)
    }
}

/// What is between a picture and the network.
pub(crate) struct Work<'a> {
    /// Columns and rows of the whole picture.
    pub size: [usize; 2],
    pub color: &'a [Vec3],
    pub features: Features<'a>,
    pub transfer: Transfer,
}

impl Work<'_> {
    /// Puts a tile into the network's input: zeros where the picture has no pixel.
    pub fn read(&self, tile: &Tile, memory: &mut Memory) {
        let [width, height] = tile.size();
        let input = memory.input(width, height);
        let shape = input.shape;
        let [left, top] = [tile.read[0].start, tile.read[1].start];
        for plane in input.planes_mut() {
            let rows: Vec<&mut [Pixel]> = strips(plane, shape, 1).collect();
            rows.into_par_iter().enumerate().for_each(|(row, pixels)| {
                let inside = if top + row < self.size[1] { self.size[0].saturating_sub(left).min(width) } else { 0 };
                let first = (top + row) * self.size[0] + left;
                for (x, pixel) in pixels[1..=width].iter_mut().enumerate() {
                    *pixel = if x < inside { self.seen(first + x) } else { [0.0; BLOCK] };
                }
            });
        }
    }

    /// The network's input at a pixel: each value in [0, 1].
    fn seen(&self, pixel: usize) -> Pixel {
        let number = |value: f32| if value.is_nan() { 0.0 } else { value };
        let albedo = self.features.albedo[pixel].to_array().map(|value| number(value).clamp(0.0, 1.0));
        let normal = self.features.normal[pixel].to_array().map(|value| 0.5 * number(value).clamp(-1.0, 1.0) + 0.5);
        let mut seen = [0.0; BLOCK];
        seen[..3].copy_from_slice(&self.transfer.forward(self.color[pixel]).to_array());
        seen[3..6].copy_from_slice(&albedo);
        seen[6..9].copy_from_slice(&normal);
        seen
    }

    /// Puts what the network says of a tile into the picture.
    fn write(&self, tile: &Tile, output: &Planes, denoised: &mut [Vec3]) {
        let Shape { width, .. } = output.shape;
        let [columns, rows] = [0, 1].map(|axis| tile.written[axis].start..tile.written[axis].end.min(self.size[axis]));
        let said: Vec<&[Pixel]> = output.rows(0).skip(rows.start - tile.read[1].start).take(rows.len()).collect();
        let first = columns.start - tile.read[0].start;
        let picture = denoised.par_chunks_mut(self.size[0]).skip(rows.start).zip(said);
        picture.for_each(|(row, said)| {
            let said = said[1..=width][first..].iter();
            for (radiance, &[r, g, b, ..]) in row[columns.clone()].iter_mut().zip(said) {
                *radiance = self.transfer.inverse(Vec3::new(r, g, b));
            }
        });
    }
}
