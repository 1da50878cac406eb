//! Which chain by a sphere a path is on since its last vertex that has a choice of directions, in each lane: what light
//! found by chance needs to know, to be weighed against connections. Of no use where a scene has no casters.
//!
//! Twin: `shaders/pathtrace/integrator/chain_state.wgsl`.

use crate::bsdf::Interactions;
use crate::caster::connect::End;
use crate::caster::sphere_chain::{Incidence, SphereChains};
use crate::caster::{CasterMaterials, ChainSurfaces};
use crate::intersect::SurfacePoints;
use simd::{Float, Mask, Vector, Word};

/// On no chain: from the camera, or by more than one sphere, or otherwise than chains go.
pub(crate) const NONE: u32 = 0;
/// Has left the vertex.
pub(crate) const LEFT: u32 = 1;
/// The path has entered a sphere of glass from its vertex.
pub(crate) const INSIDE: u32 = 2;
/// Has been reflected off the sphere.
pub(crate) const OFF: u32 = 3;
/// Has come out of the sphere.
pub(crate) const THROUGH: u32 = 4;

/// The chains of paths on their way.
#[derive(Clone, Copy)]
pub struct ChainStates<F: Float> {
    stage: F::U,
    vertex: Vector<F>,
    /// Density per solid angle with which chance takes the direction at the vertex, and then the chain.
    chance: F,
    center: Vector<F>,
    radius: F,
    incidence: Incidence<F>,
    material: F::U,
}

/// Light that was found, as seen from a sphere's centre.
pub struct SeenFromCenter<F: Float> {
    /// Unit direction to it.
    pub direction: Vector<F>,
    /// How far it is.
    pub end: End<F>,
    /// Density per solid angle with which it is sampled from there; 0 if it is not.
    pub pdf: F,
    /// How the light's surface is turned, see [`crate::caster::connect::facing`].
    pub facing: F,
}

impl<F: Float> ChainStates<F> {
    /// Of paths that are on no chain.
    #[inline(always)]
    pub fn none() -> Self {
        let (zero, nowhere) = (F::splat(0.0), Vector::zero());
        ChainStates {
            stage: F::U::splat(NONE),
            vertex: nowhere,
            chance: zero,
            center: nowhere,
            radius: F::splat(1.0),
            incidence: Incidence { sin: zero, cos: F::splat(1.0) },
            material: F::U::splat(0),
        }
    }

    /// Begins at the camera `here`.
    #[inline(always)]
    pub fn begin(&mut self, here: F::M) {
        self.stage = F::U::select(here, F::U::splat(NONE), self.stage);
    }

    /// Leaves a vertex `here`, in a direction of this density.
    #[inline(always)]
    pub fn leave(&mut self, here: F::M, from: Vector<F>, pdf: F) {
        self.stage = F::U::select(here, F::U::splat(LEFT), self.stage);
        self.vertex = Vector::select(here, from, self.vertex);
        self.chance = F::select(here, pdf, self.chance);
    }

    /// Is reflected or refracted towards `wi` by a surface that leaves no other choice, `here`.
    #[inline(always)]
    pub fn scatter(&mut self, here: F::M, at: &Interactions<F>, wi: Vector<F>, casters: &CasterMaterials) {
        let zero = F::splat(0.0);
        let outside = at.point.normal.dot(at.wo).ge(zero);
        let reflected = at.normal.dot(wi).gt(zero);
        let is_sphere = here & at.point.radius.gt(zero);
        let left = is_sphere & outside & self.stage.eq(F::U::splat(LEFT));
        let leaves = is_sphere & !outside & !reflected & self.stage.eq(F::U::splat(INSIDE)) & self.is_around(&at.point);
        if left.any() {
            self.meet(left, at, reflected, casters);
        }
        let goes_on = (left & !self.surface(casters).probability.eq(zero)) | leaves;
        let after =
            F::U::select(leaves, F::U::splat(THROUGH), F::U::select(reflected, F::U::splat(OFF), F::U::splat(INSIDE)));
        let stage = F::U::select(goes_on, after, F::U::splat(NONE));
        self.stage = F::U::select(here, stage, self.stage);
    }

    /// Notes the sphere that was met, and how.
    #[inline(always)]
    fn meet(&mut self, here: F::M, at: &Interactions<F>, reflected: F::M, casters: &CasterMaterials) {
        let incidence = Incidence { sin: at.normal.cross(at.wo).length_squared().sqrt(), cos: at.normal.dot(at.wo) };
        let surface = casters.of(at.material, !reflected);
        let chance = self.chance * surface.passes(!reflected, incidence);
        self.chance = F::select(here, chance, self.chance);
        self.center = Vector::select(here, center(&at.point), self.center);
        self.radius = F::select(here, at.point.radius, self.radius);
        self.incidence.sin = F::select(here, incidence.sin, self.incidence.sin);
        self.incidence.cos = F::select(here, incidence.cos, self.incidence.cos);
        self.material = F::U::select(here, at.material, self.material);
    }

    /// Where the sphere that was met is the one that this point is on.
    #[inline(always)]
    fn is_around(&self, point: &SurfacePoints<F>) -> F::M {
        let apart = (center(point) - self.center).abs().max_element();
        point.radius.eq(self.radius) & apart.le(point.error.max_element() * 4.0)
    }

    #[inline(always)]
    fn surface(&self, casters: &CasterMaterials) -> ChainSurfaces<F> {
        casters.of(self.material, self.is_through())
    }

    #[inline(always)]
    fn is_through(&self) -> F::M {
        self.stage.eq(F::U::splat(THROUGH))
    }

    /// Where light that is met now was found by a chain.
    #[inline(always)]
    pub fn is_complete(&self) -> F::M {
        F::U::splat(INSIDE).lt(self.stage)
    }

    /// The sphere's centre and radius.
    #[inline(always)]
    pub fn sphere(&self) -> (Vector<F>, F) {
        (self.center, self.radius)
    }

    /// Density per solid angle, at the vertex, with which connections find what has been found by chance, and chance's
    /// own.
    #[inline(always)]
    pub fn densities(&self, casters: &CasterMaterials, light: &SeenFromCenter<F>) -> [F; 2] {
        let surface = self.surface(casters);
        let to_center = self.center - self.vertex;
        let distance = to_center.length_squared().sqrt();
        let near = End { length: distance / self.radius, endless: F::M::splat(false) };
        let sin_angle = to_center.cross(light.direction).length_squared().sqrt() / distance;
        let chains = SphereChains::new(self.is_through(), near.ratio(), light.end.ratio(), surface.inside);
        let density = chains.density(self.incidence, sin_angle) * light.facing * light.pdf * surface.probability;
        let sampled = self.is_complete() & near.is_outside() & light.end.is_outside();
        [F::select(sampled, density, F::splat(0.0)), self.chance]
    }
}

#[inline(always)]
fn center<F: Float>(point: &SurfacePoints<F>) -> Vector<F> {
    point.position - point.normal * point.radius
}
