//! The normals of a matt body under facets. They are one, but where there are shading normals: then the body is shaded by the
//! normal that meshes and normal maps say, the facets by the one that keeps what they mirror above the triangle, as in Cycles
//! (Blender, the layers of its Principled BSDF). What the coat leaves to the body is the coat's matter and goes by the facets'
//! normal. Light counts for each by its own cosine and [`terminator`].
//!
//! Twin: `shaders/pathtrace/bsdf/two_normals.wgsl`. There such surfaces have a branch of their own, with both lobes in it; lanes
//! go through the lobes of one normal and multiply what these say by [`Shares`], as a second copy would make every kernel larger.

use super::Interactions;
use super::interaction::facing;
use super::shading::{mirroring_normal, terminator};
use simd::{Float, Vector};

/// Of a surface in each lane.
pub struct TwoNormals<F: Float> {
    /// The normal of the facets, bent for what mirrors.
    pub facets: Vector<F>,
    /// The normal of the matt body, as the texture has it.
    body: Vector<F>,
    /// Of the triangle, on the side of `wo`.
    triangle: Vector<F>,
    /// Back along the ray.
    wo: Vector<F>,
    /// Whether it is light that comes from `wo`.
    photons: bool,
    /// Whether they may be several: the same in all lanes.
    differ: bool,
}

/// What such a surface makes of light in a direction `wi`, beside the lobes that facets and body have by their normals.
pub struct Shares<F> {
    /// By what the facets' lobe is multiplied, 0 where it has no part.
    pub facets: F,
    /// The same of the body's.
    pub body: F,
    /// Cosine of `wi` to what the body's directions are drawn around.
    pub cosine: F,
}

impl<F: Float> Shares<F> {
    /// Where there is one normal, to which `wi` has this cosine.
    #[inline(always)]
    pub fn of_one_normal(cosine: F) -> Self {
        let share = F::select(cosine.gt(F::splat(0.0)), F::splat(1.0), F::splat(0.0));
        Shares { facets: share, body: share, cosine }
    }
}

impl<F: Float> TwoNormals<F> {
    /// As surfaces are met: by paths, or by photons, which come from `wo`; `differ` says whether a scene has shading normals.
    #[inline(always)]
    pub fn of(at: &Interactions<F>, photons: bool, differ: bool) -> Self {
        let (body, wo) = (at.normal, at.wo);
        if !differ {
            return TwoNormals { facets: body, body, triangle: body, wo, photons, differ };
        }
        TwoNormals { facets: mirroring_normal(at), body, triangle: facing(at.point.normal, wo), wo, photons, differ }
    }

    /// What the body's directions are drawn around, if it is not the facets' normal: light leaves bodies by the triangle's
    /// cosine.
    #[inline(always)]
    pub fn drawn_around(&self) -> Option<Vector<F>> {
        self.differ.then_some(if self.photons { self.triangle } else { self.body })
    }

    /// Of BSDF times cosine for the direction `wi`, whose cosine to the facets' normal is given.
    #[inline(always)]
    pub fn shares(&self, wi: Vector<F>, cosine: F) -> Shares<F> {
        let Some(around) = self.drawn_around() else { return Shares::of_one_normal(cosine) };
        let [facets, body] = self.of_light(wi, cosine);
        let drawn = around.dot(wi);
        Shares { facets: ratio(facets, cosine), body: ratio(body, drawn), cosine: drawn }
    }

    /// Of the BSDF: the same over the larger of both cosines, for photons over the triangle's.
    #[inline(always)]
    pub fn shares_of_value(&self, wi: Vector<F>, cosine: F) -> Shares<F> {
        let Some(around) = self.drawn_around() else { return Shares::of_one_normal(cosine) };
        let [facets, body] = self.of_light(wi, cosine);
        let drawn = around.dot(wi);
        let over = if self.photons { drawn } else { cosine.max(drawn) };
        Shares { facets: ratio(facets, over), body: ratio(body, over), cosine: drawn }
    }

    /// By how much light between `wi` and `wo` counts for facets and body: by its cosine to either normal where it comes from. Of
    /// photons as many come as the triangle's cosine says, and as many leave.
    #[inline(always)]
    fn of_light(&self, wi: Vector<F>, cosine: F) -> [F; 2] {
        let zero = F::splat(0.0);
        let from = if self.photons { self.wo } else { wi };
        let mut counts = [
            self.facets.dot(from) * terminator(self.facets, self.triangle, from),
            self.body.dot(from) * terminator(self.body, self.triangle, from),
        ];
        if self.photons {
            let grows = ratio(self.triangle.dot(wi), self.triangle.dot(self.wo));
            counts = [counts[0] * grows, counts[1] * grows];
        }
        [F::select(cosine.gt(zero), counts[0], zero), counts[1]]
    }
}

/// `a / b` of what lies above, else 0.
#[inline(always)]
fn ratio<F: Float>(a: F, b: F) -> F {
    let zero = F::splat(0.0);
    F::select(a.gt(zero) & b.gt(zero), a / b, zero)
}
