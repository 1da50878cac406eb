//! How surfaces scatter light: one file a lobe, and what integrators ask of whatever lobe a surface has. Directions point
//! away from the surface; `wo` is where the path came from, `wi` where it goes on.
//!
//! [`Materials::sample`] draws a direction, [`Materials::eval`] is the BSDF for a given one, and [`Materials::pdf`] the
//! density with which `sample` draws it. Lobes that a scene lacks cost nothing, and one that no lane has is skipped. A
//! new lobe is a file here, its twin in `shaders/pathtrace/bsdf/`, its columns in [`materials`], and an arm in each of
//! the questions below. Twin: `shaders/pathtrace/bsdf/bsdf.wgsl`.

pub mod dielectric;
pub mod interaction;
pub mod lambert;
pub mod materials;
pub mod metallic_roughness;
pub mod microfacets;
pub mod mirror;
pub mod rough_conductor;
pub mod shading;
pub mod textures;
mod two_normals;

pub use dielectric::{Interface, Interfaces};
pub use interaction::Interactions;
use interaction::facing;
use materials::Materials;
pub use metallic_roughness::MetallicRoughness;
pub use rough_conductor::RoughConductor;
use simd::{Float, Mask, Vector};
use two_normals::TwoNormals;

/// A BSDF's value: a colour times a number, kept apart so that products are rounded in one order whatever the lobe.
#[derive(Debug, Clone, Copy)]
pub struct ScaledColours<F> {
    /// The colour.
    pub colour: Vector<F>,
    /// The number, at least 0.
    pub factor: F,
}

/// A direction that was drawn, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct BsdfSamples<F> {
    /// Unit direction in which the path goes on.
    pub wi: Vector<F>,
    /// BSDF times cosine over density.
    pub weight: Vector<F>,
    /// Density per solid angle; infinite where the lobe left no choice.
    pub pdf: F,
}

/// Where a surface sends all light on in one or two directions, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Speculars<F: Float> {
    /// Where it reflects ...
    pub reflects: F::M,
    /// ... in this unit direction ...
    pub reflected: Vector<F>,
    /// ... this share.
    pub reflectance: ScaledColours<F>,
    /// Where it refracts ...
    pub refracts: F::M,
    /// ... in this unit direction ...
    pub refracted: Vector<F>,
    /// ... this share.
    pub transmittance: F,
}

impl Materials {
    /// Draws a direction `here`, from two random numbers for the direction and one for the choice among several.
    #[inline(always)]
    pub fn sample<F: Float>(&self, here: F::M, at: &Interactions<F>, u: [F; 3]) -> BsdfSamples<F> {
        let sample = self.sample_lobe(here, at, false, u);
        if !self.has().shading_normals {
            return sample;
        }
        let share = self.unless_two_normals(at, shading::kept(at, sample.wi));
        BsdfSamples { weight: sample.weight * share, ..sample }
    }

    /// Draws the direction in which a photon goes on `here` that came from `wo`, as [`Materials::sample`] does for paths.
    #[inline(always)]
    pub fn sample_adjoint<F: Float>(&self, here: F::M, at: &Interactions<F>, u: [F; 3]) -> BsdfSamples<F> {
        let sample = self.sample_lobe(here, at, true, u);
        if !self.has().shading_normals {
            return sample;
        }
        let share = shading::kept(&self.as_left(at), sample.wi) * shading::adjoint(at, sample.wi);
        BsdfSamples { weight: sample.weight * self.unless_two_normals(at, share), ..sample }
    }

    /// Surfaces as photons leave them: see [`shading::as_left`].
    #[inline(always)]
    pub fn as_left<F: Float>(&self, at: &Interactions<F>) -> Interactions<F> {
        if self.has().shading_normals { shading::as_left(at) } else { *at }
    }

    /// What shading normals leave of light, which lobes of [`TwoNormals`] count themselves.
    #[inline(always)]
    fn unless_two_normals<F: Float>(&self, at: &Interactions<F>, share: F) -> F {
        if self.has().metallic_roughness {
            return F::select(at.kinds.metallic_roughness(), F::splat(1.0), share);
        }
        share
    }

    #[inline(always)]
    fn two_normals<F: Float>(&self, at: &Interactions<F>, photons: bool) -> TwoNormals<F> {
        TwoNormals::of(at, photons, self.has().shading_normals)
    }

    #[inline(always)]
    fn sample_lobe<F: Float>(&self, here: F::M, at: &Interactions<F>, photons: bool, u: [F; 3]) -> BsdfSamples<F> {
        let diffuse = here & at.kinds.diffuse();
        let left = if photons { self.as_left(at) } else { *at };
        let mut sample = if diffuse.any() { lambert::sample(&left, [u[0], u[1]]) } else { BsdfSamples::delta(at) };
        let mirrors = here & at.kinds.mirror();
        if self.has().mirrors && mirrors.any() {
            sample = BsdfSamples::select(mirrors, mirror::sample(at), sample);
        }
        let glass = here & at.kinds.glass();
        if self.has().glass && glass.any() {
            sample = BsdfSamples::select(glass, dielectric::sample(at, self.ior(at.material), u[2]), sample);
        }
        let rough = here & at.kinds.rough_conductor();
        if self.has().rough_conductors && rough.any() {
            let drawn = rough_conductor::sample(at, &self.rough_conductor(at), [u[0], u[1]]);
            sample = BsdfSamples::select(rough, drawn, sample);
        }
        let coated = here & at.kinds.metallic_roughness();
        if self.has().metallic_roughness && coated.any() {
            let normals = self.two_normals(at, photons);
            let drawn = metallic_roughness::sample(at, &self.metallic_roughness(at), &normals, u);
            sample = BsdfSamples::select(coated, drawn, sample);
        }
        sample
    }

    /// Share that glass reflects of light of which the rest goes on in the refracted direction `wi`.
    #[inline(always)]
    pub fn reflected_beside<F: Float>(&self, at: &Interactions<F>, wi: Vector<F>) -> F {
        dielectric::reflected_beside(at, self.ior(at.material), wi)
    }

    /// The BSDF for light from the unit direction `wi`, on the side of `wo`, of which [`Materials::cosine`] is the cosine. Not
    /// of lobes that leave no choice.
    #[inline(always)]
    pub fn eval<F: Float>(&self, at: &Interactions<F>, wi: Vector<F>) -> ScaledColours<F> {
        let ScaledColours { colour, factor } = self.eval_lobe(at, false, wi);
        if !self.has().shading_normals {
            return ScaledColours { colour, factor };
        }
        let share = shading::terminator(at.normal, at.point.normal, wi);
        ScaledColours { colour, factor: factor * self.unless_two_normals(at, share) }
    }

    /// What surfaces send on to `wi` of a photon's power that came from `wo`, over the cosine of `wi` to the normal of the
    /// surface as it is left ([`Materials::as_left`]).
    #[inline(always)]
    pub fn eval_adjoint<F: Float>(&self, at: &Interactions<F>, wi: Vector<F>) -> ScaledColours<F> {
        let ScaledColours { colour, factor } = self.eval_lobe(at, true, wi);
        if !self.has().shading_normals {
            return ScaledColours { colour, factor };
        }
        let share = shading::kept(&self.as_left(at), wi) * shading::adjoint(at, wi);
        ScaledColours { colour, factor: factor * self.unless_two_normals(at, share) }
    }

    /// The cosine of light from `wi` to the normal, and where there are two to the one that it is nearer to: above 0 where any
    /// may be scattered.
    #[inline(always)]
    pub fn cosine<F: Float>(&self, at: &Interactions<F>, wi: Vector<F>) -> F {
        let cosine = at.normal.dot(wi);
        let has = self.has();
        if has.shading_normals && has.metallic_roughness {
            // of surfaces with one normal it is the same
            return cosine.max(self.mirroring_normal(at).dot(wi));
        }
        cosine
    }

    /// A value or a cosine for light from `wi`, with what shading normals leave of it.
    #[inline(always)]
    pub fn shadowed<F: Float>(&self, normal: Vector<F>, outwards: Vector<F>, wi: Vector<F>, value: F) -> F {
        if self.has().shading_normals { value * shading::terminator(normal, outwards, wi) } else { value }
    }

    #[inline(always)]
    fn eval_lobe<F: Float>(&self, at: &Interactions<F>, photons: bool, wi: Vector<F>) -> ScaledColours<F> {
        let mut value = lambert::eval(at);
        let rough = at.kinds.rough_conductor();
        if self.has().rough_conductors && rough.any() {
            value = ScaledColours::select(rough, rough_conductor::eval(at, &self.rough_conductor(at), wi), value);
        }
        let coated = at.kinds.metallic_roughness();
        if self.has().metallic_roughness && coated.any() {
            let normals = self.two_normals(at, photons);
            let of_coated = metallic_roughness::eval(at, &self.metallic_roughness(at), &normals, wi);
            value = ScaledColours::select(coated, of_coated, value);
        }
        value
    }

    /// Density per solid angle of [`Materials::sample`] at `wi`, whose [`Materials::cosine`] is above 0. Not of lobes that
    /// leave no choice.
    #[inline(always)]
    pub fn pdf<F: Float>(&self, at: &Interactions<F>, wi: Vector<F>, cosine: F) -> F {
        let mut density = lambert::pdf(cosine);
        let rough = at.kinds.rough_conductor();
        if self.has().rough_conductors && rough.any() {
            density = F::select(rough, rough_conductor::pdf(at, &self.rough_conductor(at), wi), density);
        }
        let coated = at.kinds.metallic_roughness();
        if self.has().metallic_roughness && coated.any() {
            let normals = self.two_normals(at, false);
            let of_coated = metallic_roughness::pdf(at, &self.metallic_roughness(at), &normals, wi);
            density = F::select(coated, of_coated, density);
        }
        density
    }

    /// Both directions in which mirrors and glass send light on, `here`. Rough metal is taken for a mirror that reflects as
    /// much: what a tree of rays, of which each has one direction, can follow. So is the metal of metallic-roughness,
    /// and a polished coat.
    #[inline(always)]
    pub fn speculars<F: Float>(&self, here: F::M, at: &Interactions<F>) -> Speculars<F> {
        let mut speculars = self.speculars_of_lobe(here, at);
        if self.has().shading_normals {
            let g = facing(at.point.normal, at.normal);
            let zero = F::splat(0.0);
            speculars.reflects = speculars.reflects & g.dot(speculars.reflected).gt(zero);
            speculars.refracts = speculars.refracts & g.dot(speculars.refracted).lt(zero);
        }
        speculars
    }

    /// The normal that mirrors, or that facets do.
    #[inline(always)]
    pub fn mirroring_normal<F: Float>(&self, at: &Interactions<F>) -> Vector<F> {
        let has = self.has();
        let coated = at.kinds.metallic_roughness();
        if has.shading_normals && has.metallic_roughness && coated.any() {
            return Vector::select(coated, shading::mirroring_normal(at), at.normal);
        }
        at.normal
    }

    #[inline(always)]
    fn speculars_of_lobe<F: Float>(&self, here: F::M, at: &Interactions<F>) -> Speculars<F> {
        let (nowhere, one) = (F::M::splat(false), F::splat(1.0));
        let mirrors = here & at.kinds.mirror() & !at.colour.is_zero();
        let normal = self.mirroring_normal(at);
        let mut speculars = Speculars {
            reflects: mirrors,
            reflected: mirror::reflected(at.wo, normal),
            reflectance: ScaledColours { colour: at.colour, factor: one },
            refracts: nowhere,
            refracted: at.wo,
            transmittance: one,
        };
        let rough = here & at.kinds.rough_conductor();
        if self.has().rough_conductors && rough.any() {
            let share = self.rough_conductor(at).fresnel(at.normal.dot(at.wo));
            speculars.reflectance.colour = Vector::select(rough, share, at.colour);
            speculars.reflects = mirrors | (rough & !share.is_zero());
        }
        let coated = here & at.kinds.metallic_roughness();
        if self.has().metallic_roughness && coated.any() {
            let [share, _] = self.metallic_roughness(at).stand_ins(normal.dot(at.wo));
            speculars.reflectance.colour = Vector::select(coated, share, speculars.reflectance.colour);
            speculars.reflects = speculars.reflects | (coated & !share.is_zero());
        }
        let glass = here & at.kinds.glass();
        if self.has().glass && glass.any() {
            let split = dielectric::split(at, self.ior(at.material));
            speculars.reflectance.factor = F::select(glass, split.reflectance, one);
            speculars.reflects = speculars.reflects | (glass & split.reflectance.gt(F::splat(0.0)));
            speculars.refracts = glass & split.refracts;
            speculars.refracted = split.refracted;
            speculars.transmittance = one - split.reflectance;
        }
        speculars
    }
}

impl Materials {
    /// The albedo by which a tree of rays lights surfaces directly, beside what [`Materials::speculars`] sends on; black of
    /// those that it does not light.
    #[inline(always)]
    pub fn lit_albedo<F: Float>(&self, at: &Interactions<F>) -> Vector<F> {
        let albedo = Vector::select(at.is_diffuse(), at.colour, Vector::zero());
        let coated = at.kinds.metallic_roughness();
        if self.has().metallic_roughness && coated.any() {
            let [_, rest] = self.metallic_roughness(at).stand_ins(self.mirroring_normal(at).dot(at.wo));
            return Vector::select(coated, rest, albedo);
        }
        albedo
    }
}

impl<F: Float> ScaledColours<F> {
    /// The product with radiance or throughput.
    #[inline(always)]
    pub fn times(&self, light: Vector<F>) -> Vector<F> {
        self.colour * light * self.factor
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        ScaledColours {
            colour: Vector::select(mask, yes.colour, no.colour),
            factor: F::select(mask, yes.factor, no.factor),
        }
    }
}

impl<F: Float> BsdfSamples<F> {
    /// Of lobes that leave no choice, whose weight is the surface's colour.
    #[inline(always)]
    fn delta(at: &Interactions<F>) -> Self {
        BsdfSamples { wi: at.normal, weight: at.colour, pdf: F::splat(f32::INFINITY) }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        BsdfSamples {
            wi: Vector::select(mask, yes.wi, no.wi),
            weight: Vector::select(mask, yes.weight, no.weight),
            pdf: F::select(mask, yes.pdf, no.pdf),
        }
    }
}
