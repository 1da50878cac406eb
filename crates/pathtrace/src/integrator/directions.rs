//! Directions in which paths leave their vertices: by the lobe, uniform as in the tutorial's naive tracer, or in part
//! into the cones at what may bring light.
//!
//! Twin: `shaders/pathtrace/integrator/path.wgsl`.

use crate::bsdf::interaction::facing;
use crate::bsdf::materials::Materials;
use crate::bsdf::{BsdfSamples, Interactions, lambert};
use crate::caster::cone::SeenCones;
use crate::sampling::UNIFORM_HEMISPHERE_PDF;
use crate::sampling::warp::{to_world, uniform_hemisphere};
use simd::{Float, Mask, Vector};

/// How the vertices in the lanes draw directions.
pub struct DirectionsAt<'a, F: Float> {
    pub materials: &'a Materials,
    /// Whatever the surface (Task 2 b).
    pub uniform: bool,
    /// A part of the diffuse vertices' directions goes there.
    pub cones: Option<SeenCones<F>>,
}

/// Directions that were drawn.
pub struct Drawn<F: Float> {
    pub sample: BsdfSamples<F>,
    /// What is left of a path's throughput.
    pub throughput: Vector<F>,
    /// What would be left, had the lobe drawn the direction: roulette goes by that, or it would undo the choice of a cone.
    pub deserved: Vector<F>,
}

impl<F: Float> DirectionsAt<'_, F> {
    /// Density per solid angle of directions `wi` whose cosine to the normal is above 0, at vertices that leave a choice.
    #[inline(always)]
    pub fn pdf(&self, at: &Interactions<F>, wi: Vector<F>, cosine: F) -> F {
        if self.uniform {
            return F::splat(UNIFORM_HEMISPHERE_PDF);
        }
        let lobe = self.materials.pdf(at, wi, cosine);
        match &self.cones {
            Some(cones) => F::select(at.is_diffuse(), cones.pdf(wi, lobe), lobe),
            None => lobe,
        }
    }

    /// Draws directions `here` for paths of some throughput, from two random numbers for the direction and one for the
    /// choice among several.
    #[inline(always)]
    pub fn sample(&self, here: F::M, at: &Interactions<F>, throughput: Vector<F>, u: [F; 3]) -> Drawn<F> {
        let delta = at.is_delta();
        let sample = self.materials.sample(if self.uniform { here & delta } else { here }, at, u);
        let by_lobe = throughput * sample.weight;
        let by_lobe = Drawn { sample, throughput: by_lobe, deserved: by_lobe };
        if self.uniform {
            return Drawn::select(delta, by_lobe, self.uniformly(at, throughput, [u[0], u[1]]));
        }
        let diffuse = here & at.is_diffuse();
        match &self.cones {
            Some(cones) if diffuse.any() => {
                Drawn::select(diffuse, by_lobe.or_into((cones, self.materials), at, throughput, u), by_lobe)
            }
            _ => by_lobe,
        }
    }

    /// Uniform on the hemisphere above the surface.
    #[inline(always)]
    fn uniformly(&self, at: &Interactions<F>, throughput: Vector<F>, u: [F; 2]) -> Drawn<F> {
        let local = uniform_hemisphere(u);
        // with shading normals above the triangle, where all are that light may come from by any of them
        let has_shading_normals = self.materials.has().shading_normals;
        let above = if has_shading_normals { facing(at.point.normal, at.normal) } else { at.normal };
        let wi = to_world(local, above);
        let mut weight = self.materials.eval(at, wi);
        weight.factor = if has_shading_normals {
            let (zero, cosine) = (F::splat(0.0), self.materials.cosine(at, wi));
            F::select(cosine.gt(zero), cosine * (weight.factor / F::splat(UNIFORM_HEMISPHERE_PDF)), zero)
        } else {
            local.z * (weight.factor / F::splat(UNIFORM_HEMISPHERE_PDF))
        };
        let throughput = weight.times(throughput);
        let sample = BsdfSamples { wi, weight: weight.colour, pdf: F::splat(UNIFORM_HEMISPHERE_PDF) };
        Drawn { sample, throughput, deserved: throughput }
    }
}

impl<F: Float> Drawn<F> {
    /// The same where they were drawn so many times as dense, by a guide.
    #[inline(always)]
    pub fn times_as_dense(self, ratio: F) -> Self {
        let Drawn { sample, throughput, deserved } = self;
        Drawn {
            sample: BsdfSamples { pdf: sample.pdf * ratio, ..sample },
            throughput: throughput.divided_by(ratio),
            deserved: deserved.divided_by(ratio),
        }
    }

    /// Directions of Lambert's lobe, some of them replaced by directions in cones; all weighted by the density of both.
    #[inline(always)]
    fn or_into(
        &self,
        (cones, materials): (&SeenCones<F>, &Materials),
        at: &Interactions<F>,
        throughput: Vector<F>,
        u: [F; 3],
    ) -> Self {
        let (into_cone, towards_shape) = cones.sample(u[2], [u[0], u[1]]);
        let wi = Vector::select(into_cone, towards_shape, self.sample.wi);
        let lobe = lambert::pdf(at.normal.dot(wi).max(F::splat(0.0)));
        let pdf = cones.pdf(wi, lobe);
        let deserved = throughput * at.colour;
        // rounding takes a direction at a rim out of its cone, and it may lie below the horizon: then neither draws it
        let weight = lobe / pdf.max(F::splat(f32::MIN_POSITIVE));
        let weight = at.colour * materials.shadowed(at.normal, at.point.normal, wi, weight);
        Drawn { sample: BsdfSamples { wi, weight, pdf }, throughput: throughput * weight, deserved }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Drawn {
            sample: BsdfSamples::select(mask, yes.sample, no.sample),
            throughput: Vector::select(mask, yes.throughput, no.throughput),
            deserved: Vector::select(mask, yes.deserved, no.deserved),
        }
    }
}
