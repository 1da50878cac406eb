//! What rays are traced through: all shapes at once in each lane while they are few, else one ray at a time through a
//! tree.
//!
//! Twin: `shaders/pathtrace/intersect/aggregate.wgsl`.

use super::lanes::{Hits, Rays, SurfacePoints};
use super::shape_list::{Scratch, ShapeList};
use super::{Accel, Hit, NO_LIGHT, SurfacePoint};
use crate::light::Lights;
use crate::vectors::of_lanes;
use scene::{Bsdf, Scene, Vec3};
use simd::{Float, MOST_LANES, Mask, Word};

/// A scene's shapes, ready for rays in lanes.
pub struct Aggregate {
    /// The tree.
    accel: Accel,
    shape_list: Option<ShapeList>,
    /// Which materials are glass.
    clear: Vec<bool>,
}

impl Aggregate {
    /// Builds what the scene asks for.
    pub fn new(scene: &Scene, lights: &Lights) -> Self {
        let clear = scene.materials.iter().map(|material| matches!(material.bsdf, Bsdf::Dielectric { .. }));
        Aggregate {
            accel: Accel::new(scene, lights),
            shape_list: ShapeList::new(scene, lights),
            clear: clear.collect(),
        }
    }

    /// The shapes, ready for single rays.
    pub fn accel(&self) -> &Accel {
        &self.accel
    }

    /// The shapes, ready for all lanes at once, if they are few.
    pub fn shape_list(&self) -> Option<&ShapeList> {
        self.shape_list.as_ref()
    }

    /// Traces single rays from now on.
    pub fn forget_shape_list(&mut self) {
        self.shape_list = None;
    }

    /// The nearest hits of the `wanted` rays before `rays.tmax`; of several at one distance an area light, else the
    /// shape that comes first in the scene.
    #[inline(always)]
    pub fn closest<F: Float>(&self, rays: &Rays<F>, wanted: F::M, scratch: &mut Scratch<F>) -> Hits<F> {
        match &self.shape_list {
            Some(shape_list) => shape_list.closest(rays, scratch),
            None => self.closest_one_by_one(rays, wanted),
        }
    }

    /// Where anything lies on the `wanted` rays before `rays.tmax`; if `opaque`, glass does not count.
    #[inline(always)]
    pub fn occluded<F: Float>(&self, rays: &Rays<F>, wanted: F::M, opaque: bool, scratch: &mut Scratch<F>) -> F::M {
        match &self.shape_list {
            Some(shape_list) => shape_list.occluded(rays, wanted, opaque, scratch),
            None => self.occluded_one_by_one(rays, wanted, opaque),
        }
    }

    #[inline(always)]
    fn closest_one_by_one<F: Float>(&self, rays: &Rays<F>, wanted: F::M) -> Hits<F> {
        let rays = rays.each();
        let nowhere = SurfacePoint { position: Vec3::ZERO, error: Vec3::ZERO, normal: Vec3::Z };
        let mut met = [Hit { point: nowhere, material: 0, light: NO_LIGHT }; MOST_LANES];
        let mut bits = 0;
        for lane in lanes_of(wanted) {
            if let Some(hit) = self.accel.closest(&rays[lane]) {
                met[lane] = hit;
                bits |= 1 << lane;
            }
        }
        Hits {
            met: F::M::from_bits(bits),
            point: SurfacePoints {
                position: of_lanes(&met.map(|hit| hit.point.position)),
                error: of_lanes(&met.map(|hit| hit.point.error)),
                normal: of_lanes(&met.map(|hit| hit.point.normal)),
            },
            material: F::U::load(&met.map(|hit| hit.material)),
            light: F::U::load(&met.map(|hit| hit.light)),
        }
    }

    #[inline(always)]
    fn occluded_one_by_one<F: Float>(&self, rays: &Rays<F>, wanted: F::M, opaque: bool) -> F::M {
        let rays = rays.each();
        let stops = |material: u32| !(opaque && self.clear[material as usize]);
        let occluded = lanes_of(wanted).filter(|&lane| self.accel.occluded_by(&rays[lane], stops));
        F::M::from_bits(occluded.fold(0, |bits, lane| bits | 1 << lane))
    }
}

/// The lanes where a mask is true.
#[inline(always)]
pub fn lanes_of(mask: impl Mask) -> impl Iterator<Item = usize> {
    let mut bits = mask.bits();
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (lane < 32).then_some(lane)
    })
}
