//! What a pinhole camera sees of a point: the way from a photon to a pixel.

use crate::bsdf::Interactions;
use crate::drive::lanes::FilmPass;
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Rays, SHADOW_END};
use crate::prepared::PreparedScene;
use crate::vectors::in_all_lanes;
use scene::camera::PictureFrame;
use simd::{Float, Mask, Vector, Word};

/// A camera and the pixels of its picture.
#[derive(Debug, Clone, Copy)]
pub struct Pinhole {
    frame: PictureFrame,
    size: [u32; 2],
}

/// Points as pixels see them, in each lane.
pub struct Connections<F: Float> {
    /// Where a pixel sees the point; what else is said holds only there.
    pub seen: F::M,
    /// Row-major index of the pixel.
    pub pixel: F::U,
    /// Unit direction towards the pinhole.
    pub wi: Vector<F>,
    /// What power times BSDF is multiplied by to be the pixel's mean radiance.
    pub weight: F,
}

impl Pinhole {
    /// The camera of a pass.
    pub fn new(pass: &FilmPass) -> Self {
        Pinhole { frame: pass.frame, size: pass.size }
    }

    /// The pixels that see these surfaces `here`, on the side that a photon came from. A pixel's mean radiance is that over
    /// its area in the picture: each point of it counts by the inverse cube of the cosine to the line of sight (pbrt-v3, 16.1.1).
    #[inline(always)]
    pub fn connect<F: Float>(
        &self,
        here: F::M,
        at: &Interactions<F>,
        scene: &PreparedScene,
        scratch: &mut Scratch<F>,
    ) -> Connections<F> {
        let PictureFrame { eye, forward, right, up } = self.frame;
        let (width, height) = (self.size[0] as f32, self.size[1] as f32);
        let to_eye = in_all_lanes::<F>(eye) - at.point.position;
        let distance_squared = to_eye.length_squared();
        let depth = -to_eye.dot(in_all_lanes(forward));
        let across = -to_eye * (F::splat(1.0) / depth);
        let x = across.dot(in_all_lanes(right / right.length_squared()));
        let y = across.dot(in_all_lanes(up / up.length_squared()));
        let (column, row) = ((x + 1.0) * (0.5 * width), (F::splat(1.0) - y) * (0.5 * height));
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        let inside = column.ge(zero) & column.lt(F::splat(width)) & row.ge(zero) & row.lt(F::splat(height));
        let wi = to_eye * (one / distance_squared.sqrt());
        let cosine = at.normal.dot(wi);
        let seen = here & depth.gt(zero) & inside & cosine.gt(zero);
        let of_pixel = 4.0 * right.length() * up.length() / (width * height);
        let cos_eye = depth / distance_squared.sqrt();
        let weight = cosine / (distance_squared * (cos_eye * cos_eye * cos_eye * of_pixel));
        let pixel = row.to_word().wrapping_mul(F::U::splat(self.size[0])).wrapping_add(column.to_word());
        let seen = if seen.any() { seen & !self.is_hidden(seen, at, wi, scene, scratch) } else { seen };
        Connections { seen, pixel, wi, weight }
    }

    /// By a search for what is nearest: shadow rays leave out shapes that hide no light from a surface, and may hide that surface
    /// from the camera.
    #[inline(always)]
    fn is_hidden<F: Float>(
        &self,
        wanted: F::M,
        at: &Interactions<F>,
        wi: Vector<F>,
        scene: &PreparedScene,
        scratch: &mut Scratch<F>,
    ) -> F::M {
        let origin = at.point.leaving_towards(wi);
        let direction = in_all_lanes::<F>(self.frame.eye) - origin;
        let rays = Rays { origin, direction, tmax: F::splat(SHADOW_END) };
        scene.aggregate.closest(&rays, wanted, scratch).met()
    }
}
