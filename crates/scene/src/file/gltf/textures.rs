//! Pictures on surfaces: decoded, turned to linear light, and read as samplers and KHR_texture_transform say.

use super::buffers::Document;
use super::json::{TextureInfo, TextureTransform};
use super::{Refused, Remarks, uri};
use crate::ImageTexture;
use crate::image_texture::{Sampling, Wrap};
use glam::{Mat2, Vec2};
use image_file::CodeCurve;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

/// Texels of all pictures of a file at most; they take 2 GiB.
const MOST_TEXELS: u64 = 1 << 27;

/// Bytes that are read of pictures in files of their own, as often as they are.
const MOST_BYTES: u64 = 4 << 30;

/// A picture as it is used: pictures that are used alike are one.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Key {
    image: u32,
    curve: CodeCurve,
    wrap: [u32; 2],
    nearest: bool,
    placement: [u32; 6],
}

/// The pictures of a file, each made once.
pub struct Textures<'a> {
    document: &'a Document,
    made: HashMap<Key, Arc<ImageTexture>>,
    /// Of each picture, by its curve, one that keeps its texels: all that are placed otherwise share them.
    kept: HashMap<(u32, CodeCurve), Arc<ImageTexture>>,
    texels_left: u64,
    bytes_left: u64,
}

impl<'a> Textures<'a> {
    pub fn new(document: &'a Document) -> Self {
        let (made, kept) = Default::default();
        Textures { document, made, kept, texels_left: MOST_TEXELS, bytes_left: MOST_BYTES }
    }

    /// The picture that a material names; `None` if there is none that this program reads.
    pub fn of(
        &mut self,
        info: &TextureInfo,
        curve: CodeCurve,
        remarks: &mut Remarks,
    ) -> Result<Option<Arc<ImageTexture>>, Refused> {
        let root = &self.document.root;
        let Some(texture) = root.textures.get(info.index as usize) else {
            let count = root.textures.len();
            return Err(Refused(format!("texture {} is named, but there are {count}", info.index)));
        };
        let Some(image) = texture.source else {
            remarks.of("textures that are neither PNG nor JPEG are left out", format!("texture {}", info.index));
            return Ok(None);
        };
        let sampling = self.sampling(texture.sampler, info.extensions.transform.as_ref())?;
        let key = key(image, curve, &sampling);
        if let Some(made) = self.made.get(&key) {
            return Ok(Some(made.clone()));
        }
        let named = |Refused(why)| Refused(format!("image {image}: {why}"));
        let made = Arc::new(match self.kept.get(&(image, curve)) {
            Some(kept) => kept.with_sampling(sampling),
            None => self.make(image, curve, sampling).map_err(named)?,
        });
        self.kept.entry((image, curve)).or_insert_with(|| made.clone());
        self.made.insert(key, made.clone());
        Ok(Some(made))
    }

    fn sampling(&self, sampler: Option<u32>, transform: Option<&TextureTransform>) -> Result<Sampling, Refused> {
        let mut sampling = Sampling::default();
        if let Some(index) = sampler {
            let samplers = &self.document.root.samplers;
            let Some(sampler) = samplers.get(index as usize) else {
                return Err(Refused(format!("sampler {index} is named, but there are {}", samplers.len())));
            };
            sampling.wrap = [wrap(sampler.wrap_s)?, wrap(sampler.wrap_t)?];
            sampling.bilinear = sampler.mag_filter != Some(NEAREST);
        }
        if let Some(transform) = transform {
            place(&mut sampling, transform);
        }
        if !(sampling.turn_and_scale.is_finite() && sampling.offset.is_finite()) {
            return Err(Refused("its KHR_texture_transform is not finite".into()));
        }
        Ok(sampling)
    }

    fn make(&mut self, index: u32, curve: CodeCurve, sampling: Sampling) -> Result<ImageTexture, Refused> {
        let bytes = self.bytes(index)?;
        let codes = image_file::decode_codes(&bytes, self.texels_left).map_err(Refused)?;
        let (width, height) = codes.size();
        self.texels_left -= u64::from(width) * u64::from(height);
        let texture = ImageTexture::new(width, height, codes.texels(curve), sampling);
        texture.ok_or_else(|| Refused("it has no texels".into()))
    }

    fn bytes(&mut self, index: u32) -> Result<Cow<'a, [u8]>, Refused> {
        let images = &self.document.root.images;
        let Some(image) = images.get(index as usize) else {
            return Err(Refused(format!("it is named, but there are {}", images.len())));
        };
        match (image.buffer_view, &image.uri) {
            (Some(view), _) => Ok(self.document.view(view)?.bytes.into()),
            (None, Some(uri)) => {
                let bytes = uri::bytes(uri, &self.document.folder, self.bytes_left)?;
                self.bytes_left -= bytes.len() as u64;
                Ok(bytes.into())
            }
            (None, None) => Err(Refused("it has neither a bufferView nor a uri".into())),
        }
    }
}

const NEAREST: u32 = 9728;

fn wrap(code: Option<u32>) -> Result<Wrap, Refused> {
    match code {
        None | Some(10497) => Ok(Wrap::Repeat),
        Some(33071) => Ok(Wrap::Clamp),
        Some(33648) => Ok(Wrap::Mirror),
        Some(other) => Err(Refused(format!("a sampler wraps by {other}: expected 10497, 33071 or 33648"))),
    }
}

/// Scaled, then turned, then moved. Positive angles turn counterclockwise as one sees the picture, whose v points down: the
/// extension's words, its example and the sample model TextureTransformTest have it so, and the matrix that its text prints
/// turns the other way (KhronosGroup/glTF, issue 1563).
fn place(sampling: &mut Sampling, transform: &TextureTransform) {
    let (sin, cos) = transform.rotation.sin_cos();
    let turn = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
    let scale = Vec2::from(transform.scale.unwrap_or([1.0; 2]));
    sampling.turn_and_scale = turn * Mat2::from_diagonal(scale);
    sampling.offset = Vec2::from(transform.offset.unwrap_or([0.0; 2]));
}

fn key(image: u32, curve: CodeCurve, sampling: &Sampling) -> Key {
    let [a, b, c, d] = sampling.turn_and_scale.to_cols_array();
    let placement = [a, b, c, d, sampling.offset.x, sampling.offset.y].map(f32::to_bits);
    Key { image, curve, wrap: sampling.wrap.map(|wrap| wrap as u32), nearest: !sampling.bilinear, placement }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the extension's own text: the lower left quarter of a picture, turned clockwise by a quarter.
    #[test]
    fn textures_are_placed_as_in_the_extensions_example() {
        let transform = TextureTransform {
            offset: Some([0.0, 1.0]),
            rotation: std::f32::consts::FRAC_PI_2,
            scale: Some([0.5, 0.5]),
            tex_coord: None,
        };
        let mut sampling = Sampling::default();
        place(&mut sampling, &transform);
        let placed = |u, v| sampling.turn_and_scale * Vec2::new(u, v) + sampling.offset;
        let near = |a: Vec2, b: Vec2| (a - b).length() < 1e-6;
        // what is shown in the upper left lies in the lower left, and what is shown to the right of that above it
        assert!(near(placed(0.0, 0.0), Vec2::new(0.0, 1.0)), "{}", placed(0.0, 0.0));
        assert!(near(placed(1.0, 0.0), Vec2::new(0.0, 0.5)), "{}", placed(1.0, 0.0));
        assert!(near(placed(1.0, 1.0), Vec2::new(0.5, 0.5)), "{}", placed(1.0, 1.0));
    }
}
