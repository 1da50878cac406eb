//! A point of a surface as a ray meets it: what an integrator asks the scene for, and then asks how light goes on.
//! Twin: `shaders/pathtrace/bsdf/interaction.wgsl`.

use super::materials::Kinds;
use crate::intersect::SurfacePoints;
use simd::{Float, Vector, Word};

/// A surface as it is met, in each lane.
#[derive(Clone, Copy)]
pub struct Interactions<F: Float> {
    /// Where, with the bound on its error and the outward normal.
    pub point: SurfacePoints<F>,
    /// Unit normal that it is shaded by, on the side of the surface that `wo` sees: see [`super::shading`]. Where
    /// facets cover a body that of the body.
    pub normal: Vector<F>,
    /// Unit direction back along the ray.
    pub wo: Vector<F>,
    /// Albedo of diffuse surfaces there, reflectance of mirrors and of metal at normal incidence, base colour of
    /// metallic-roughness, 1 for glass.
    pub colour: Vector<F>,
    /// What the surface does to light.
    pub kinds: Kinds<F::U>,
    /// Index into the scene's materials.
    pub material: F::U,
    /// Where the surface lies in its textures.
    pub uv: [F; 2],
}

impl<F: Float> Interactions<F> {
    /// Where the surface scatters by Lambert's law.
    #[inline(always)]
    pub fn is_diffuse(&self) -> F::M {
        self.kinds.diffuse()
    }

    /// Where the surface leaves no choice of direction but among few: what falls on it from a light that is sampled is
    /// never seen.
    #[inline(always)]
    pub fn is_delta(&self) -> F::M {
        self.kinds.delta()
    }

    /// Where the surface scatters any light: a coat does also on a black body.
    #[inline(always)]
    pub fn scatters(&self) -> F::M {
        !self.colour.is_zero() | self.kinds.metallic_roughness()
    }

    /// Where a path goes on with a diffuse vertex of its own instead.
    #[inline(always)]
    pub fn or_diffuse(&self, here: F::M, point: &SurfacePoints<F>, normal: Vector<F>, albedo: Vector<F>) -> Self {
        Interactions {
            point: SurfacePoints::select(here, *point, self.point),
            normal: Vector::select(here, normal, self.normal),
            colour: Vector::select(here, albedo, self.colour),
            kinds: self.kinds.or_diffuse(here),
            ..*self
        }
    }

    /// What stands in lanes that are at no surface.
    #[inline(always)]
    pub fn none() -> Self {
        let (zero, point) = (Vector::zero(), SurfacePoints::in_the_air(Vector::zero()));
        Interactions {
            point,
            normal: zero,
            wo: zero,
            colour: zero,
            kinds: Kinds::none(),
            material: F::U::splat(0),
            uv: [F::splat(0.0); 2],
        }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Interactions {
            point: SurfacePoints::select(mask, yes.point, no.point),
            normal: Vector::select(mask, yes.normal, no.normal),
            wo: Vector::select(mask, yes.wo, no.wo),
            colour: Vector::select(mask, yes.colour, no.colour),
            kinds: Kinds::select(mask, yes.kinds, no.kinds),
            material: F::U::select(mask, yes.material, no.material),
            uv: [0, 1].map(|axis| F::select(mask, yes.uv[axis], no.uv[axis])),
        }
    }
}

/// The normal on the side of `wo`.
#[inline(always)]
pub fn facing<F: Float>(normal: Vector<F>, wo: Vector<F>) -> Vector<F> {
    Vector::select(normal.dot(wo).lt(F::splat(0.0)), -normal, normal)
}
