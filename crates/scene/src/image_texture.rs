//! A picture on a surface, as textures of materials read it.

use glam::{Mat2, Vec2, Vec4};
use std::sync::{Arc, OnceLock};

/// What lies outside of the picture along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Wrap {
    /// The picture again and again.
    #[default]
    Repeat,
    /// The texels at its border.
    Clamp,
    /// The picture, every other time turned over.
    Mirror,
}

/// Texels in linear light, row by row from the top, with how they are looked up.
#[derive(Debug)]
pub struct ImageTexture {
    width: u32,
    height: u32,
    /// Red, green, blue, alpha; one list for all the ways in which a picture is read.
    texels: Arc<Vec<[f32; 4]>>,
    /// How it is read.
    pub sampling: Sampling,
    content: OnceLock<u128>,
}

/// How a place in texture coordinates becomes a texel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampling {
    /// Along u and along v.
    pub wrap: [Wrap; 2],
    /// Whether the four texels around a place are mixed; else the nearest is taken.
    pub bilinear: bool,
    /// Applied to texture coordinates first: `uv -> turn_and_scale * uv + offset` (KHR_texture_transform).
    pub turn_and_scale: Mat2,
    /// What is added then, see [`Sampling::turn_and_scale`].
    pub offset: Vec2,
}

impl Default for Sampling {
    fn default() -> Self {
        Sampling { wrap: [Wrap::Repeat; 2], bilinear: true, turn_and_scale: Mat2::IDENTITY, offset: Vec2::ZERO }
    }
}

impl ImageTexture {
    /// Of `width * height` texels, both at least 1; `None` if they are another number.
    pub fn new(width: u32, height: u32, texels: Vec<[f32; 4]>, sampling: Sampling) -> Option<Self> {
        let fits = width > 0 && height > 0 && texels.len() as u64 == u64::from(width) * u64::from(height);
        fits.then(|| ImageTexture { width, height, texels: texels.into(), sampling, content: OnceLock::new() })
    }

    /// The same texels, not kept twice, read in another way.
    pub fn with_sampling(&self, sampling: Sampling) -> Self {
        let ImageTexture { width, height, ref texels, .. } = *self;
        ImageTexture { width, height, texels: texels.clone(), sampling, content: OnceLock::new() }
    }

    /// (width, height) in texels.
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Red, green, blue and alpha, linear, row by row from the top.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// A hash of all that it holds, made once.
    pub fn content(&self) -> u128 {
        *self.content.get_or_init(|| crate::canonical::hash(|canonical| canonical.image_texture(self)))
    }

    /// What is seen at a place in texture coordinates, (0, 0) at the upper left corner of the upper left texel.
    pub fn at(&self, uv: Vec2) -> Vec4 {
        let Sampling { wrap, bilinear, turn_and_scale, offset } = self.sampling;
        let size = Vec2::new(self.width as f32, self.height as f32);
        let place = (turn_and_scale * uv + offset) * size;
        if !bilinear {
            return self.texel(wrap, place.floor());
        }
        let corner = (place - 0.5).floor();
        let [right, down] = (place - 0.5 - corner).to_array();
        let [a, b] = [corner, corner + Vec2::X].map(|at| self.texel(wrap, at));
        let [c, d] = [corner + Vec2::Y, corner + Vec2::ONE].map(|at| self.texel(wrap, at));
        let (above, below) = (a + (b - a) * right, c + (d - c) * right);
        above + (below - above) * down
    }

    fn texel(&self, wrap: [Wrap; 2], at: Vec2) -> Vec4 {
        let [x, y] = [wrapped(at.x, self.width, wrap[0]), wrapped(at.y, self.height, wrap[1])];
        Vec4::from(self.texels[y as usize * self.width as usize + x as usize])
    }
}

impl PartialEq for ImageTexture {
    fn eq(&self, other: &ImageTexture) -> bool {
        std::ptr::eq(self, other)
            || (self.width == other.width
                && self.height == other.height
                && self.sampling == other.sampling
                && (Arc::ptr_eq(&self.texels, &other.texels) || self.texels == other.texels))
    }
}

/// The texel that stands at a whole place along an axis. NaN is 0.
fn wrapped(at: f32, count: u32, wrap: Wrap) -> u32 {
    let size = count as f32;
    let inside = match wrap {
        Wrap::Repeat => at - size * (at / size).floor(),
        Wrap::Clamp => at,
        Wrap::Mirror => {
            let twice = at - 2.0 * size * (at / (2.0 * size)).floor();
            if twice < size { twice } else { 2.0 * size - 1.0 - twice }
        }
    };
    (inside.max(0.0) as u32).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(wrap: Wrap, bilinear: bool) -> ImageTexture {
        let texels = (0..4).map(|x| [x as f32, 0.0, 0.0, 1.0]).collect();
        let sampling = Sampling { wrap: [wrap; 2], bilinear, ..Sampling::default() };
        ImageTexture::new(4, 1, texels, sampling).unwrap()
    }

    #[test]
    fn wraps_go_on_as_their_names_say() {
        let at = |wrap, place: f32| row(wrap, false).at(Vec2::new(place, 0.5)).x;
        let places = [-0.3, -0.1, 0.1, 0.9, 1.1, 1.4, 2.1];
        assert_eq!(places.map(|p| at(Wrap::Repeat, p)), [2.0, 3.0, 0.0, 3.0, 0.0, 1.0, 0.0]);
        assert_eq!(places.map(|p| at(Wrap::Clamp, p)), [0.0, 0.0, 0.0, 3.0, 3.0, 3.0, 3.0]);
        assert_eq!(places.map(|p| at(Wrap::Mirror, p)), [1.0, 0.0, 0.0, 3.0, 3.0, 2.0, 0.0]);
    }

    #[test]
    fn texels_are_met_in_their_middles_and_mixed_between() {
        let at = |place: f32| row(Wrap::Repeat, true).at(Vec2::new(place, 0.5)).x;
        assert_eq!([0.125, 0.375, 0.25, 0.5].map(at), [0.0, 1.0, 0.5, 1.5]);
        // across the seam: halfway between the last and the first
        assert_eq!(at(1.0), 1.5);
    }

    #[test]
    fn a_picture_that_is_read_in_two_ways_is_kept_once() {
        let (near, smooth) = (row(Wrap::Repeat, false), row(Wrap::Clamp, true));
        let shared = near.with_sampling(smooth.sampling);
        assert_eq!(shared.texels().as_ptr(), near.texels().as_ptr());
        assert_eq!((&shared, shared.content()), (&smooth, smooth.content()));
        assert!(shared != near && shared.content() != near.content());
    }

    #[test]
    fn places_that_are_no_numbers_have_a_texel() {
        for bilinear in [false, true] {
            for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
                row(wrap, bilinear).at(Vec2::new(f32::NAN, 1e30));
                row(wrap, bilinear).at(Vec2::new(f32::INFINITY, -1e30));
            }
        }
    }
}
