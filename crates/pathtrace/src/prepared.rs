//! What every walk of rays needs: the scene made ready, and what rays meet in it.
//!
//! Twin: `shaders/pathtrace/prepared.wgsl`.

use crate::bsdf::interaction::facing;
use crate::bsdf::materials::{Kinds, Materials};
use crate::bsdf::{Interactions, shading};
use crate::caster::Casters;
use crate::caster::cone::Cones;
use crate::integrator::broken::Bugs;
use crate::integrator::photon::usual_radius;
use crate::integrator::settings::ConesAt;
use crate::intersect::aggregate::Aggregate;
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Intersections, NO_LIGHT, Rays, SHADOW_END, SurfaceAttributes, SurfacePoints};
use crate::light::{Emitters, LightSamples, Lights, SunDisc};
use crate::vectors::in_all_lanes;
use scene::{Scene, Vec3};
use simd::{Float, Vector};

/// What a path walks through.
pub struct PreparedScene {
    /// The shapes.
    pub aggregate: Aggregate,
    /// What they are made of.
    pub materials: Materials,
    /// What shines and is sampled.
    pub lights: Lights,
    /// What lights are connected to vertices by.
    pub casters: Casters,
    /// Where directions may go to shapes of mirror and glass, by the settings' choice.
    pub cones: [Cones; ConesAt::ALL.len()],
    /// Radiance where nothing is hit, of a sky of one colour; a picture is one of the lights.
    pub sky: Vec3,
    /// The sun that a ray can hit.
    pub sun_disc: Option<SunDisc>,
    /// Density per solid angle with which the sun's disc is sampled.
    pub sun_pdf: f32,
    /// What sends out photons.
    pub emitters: Emitters,
    /// The radius of photon maps if nobody says otherwise.
    pub photon_radius: f32,
    /// Bugs that do something here.
    pub suited_bugs: Bugs,
}

/// What stands for the light that a shadow ray goes to, where it goes to none: of no surface, not even of one that is no
/// light.
pub(crate) const NOT_A_LIGHT: u32 = NO_LIGHT - 1;

/// Shadow rays between points, which lie in these unit directions from each other, both ends off their surfaces.
#[inline(always)]
pub fn between<F: Float>(at: &SurfacePoints<F>, to: &SurfacePoints<F>, direction: Vector<F>) -> Rays<F> {
    let from = at.leaving_towards(direction);
    let to = to.leaving_towards(-direction);
    Rays { origin: from, direction: to - from, tmax: F::splat(SHADOW_END) }
}

/// Shadow rays from points to what shines on them.
#[inline(always)]
pub fn towards<F: Float>(at: &SurfacePoints<F>, sample: &LightSamples<F>) -> Rays<F> {
    let between = between(at, &sample.point, sample.wi);
    Rays::select(sample.endless, Rays::new(between.origin, sample.wi), between)
}

/// What the samples in the lanes have brought home so far.
#[derive(Debug, Clone, Copy)]
pub struct Outcomes<F: Float> {
    /// Radiance along the camera ray.
    pub radiance: Vector<F>,
    /// Whether rays were left out that no setting asked to leave out: beyond [`crate::PathSettings::HARD_CAP`], or
    /// beyond [`crate::integrator::whitted::MOST_BRANCHES`].
    pub cut: F::M,
}

impl PreparedScene {
    /// Of a scene whose shapes are held apart.
    pub fn new(scene: &Scene) -> Self {
        let lights = Lights::new(scene);
        PreparedScene {
            aggregate: Aggregate::new(scene, lights.light_of_shape()),
            materials: Materials::new(&scene.materials).with_shading_normals(scene.needs().shading_normals),
            sky: if scene.environment.is_some() { Vec3::ZERO } else { scene.sky },
            sun_disc: scene.sun.as_ref().and_then(SunDisc::new),
            sun_pdf: lights.sun_pdf(),
            casters: Casters::new(scene),
            emitters: Emitters::new(scene, &lights),
            photon_radius: usual_radius(scene),
            suited_bugs: Bugs::suited_to(scene),
            cones: ConesAt::ALL.map(|at| Cones::new(at, scene, &lights)),
            lights,
        }
    }

    /// What the `wanted` rays meet first.
    #[inline(always)]
    pub fn closest<F: Float>(&self, rays: &Rays<F>, wanted: F::M, scratch: &mut Scratch<F>) -> Intersections<F> {
        let hits = self.aggregate.closest(rays, wanted, scratch);
        self.aggregate.intersections(rays, &hits)
    }

    /// Where what was met shines.
    #[inline(always)]
    pub fn shines<F: Float>(&self, hit: &Intersections<F>) -> F::M {
        self.materials.kinds(hit.material).area_light()
    }

    /// What the surfaces that were met send out towards `wo`.
    #[inline(always)]
    pub fn emitted<F: Float>(&self, hit: &Intersections<F>, wo: Vector<F>) -> Vector<F> {
        let radiance = self.materials.emitted(hit.material, hit.point.normal.dot(wo));
        let textures = self.materials.textures();
        match self.aggregate.attributes(hit) {
            Some(attributes) if textures.has_emission() => radiance * textures.emission(hit.material, attributes.uv),
            _ => radiance,
        }
    }

    /// The surfaces that were met, seen from `wo`.
    #[inline(always)]
    pub fn interaction<F: Float>(&self, hit: &Intersections<F>, wo: Vector<F>) -> Interactions<F> {
        let kinds = self.materials.kinds(hit.material);
        let (mut normal, mut uv) = (facing(hit.point.normal, wo), [F::splat(0.0); 2]);
        if let Some(attributes) = self.aggregate.attributes(hit) {
            uv = attributes.uv;
            normal = self.shading_normal(hit, &attributes, normal, wo, kinds);
        }
        let colour = self.materials.colour(hit.material, kinds, &hit.point, uv);
        Interactions { point: hit.point, normal, wo, colour, kinds, material: hit.material, uv }
    }

    /// The normal that surfaces are shaded by, on the side that `wo` sees; their own where nothing says another.
    #[inline(always)]
    fn shading_normal<F: Float>(
        &self,
        hit: &Intersections<F>,
        attributes: &SurfaceAttributes<F>,
        own: Vector<F>,
        wo: Vector<F>,
        kinds: Kinds<F::U>,
    ) -> Vector<F> {
        if !self.materials.has().shading_normals {
            return own;
        }
        let textures = self.materials.textures();
        let bumps = textures.has_normals().then(|| textures.normals(hit.material, attributes.uv));
        shading::shading_normal(hit.point.normal, attributes, bumps, wo, kinds.only_mirrors())
    }

    /// Where something stands between the `wanted` points and what shines on them; if `opaque`, glass does not count.
    #[inline(always)]
    pub fn in_shadow<F: Float>(
        &self,
        at: &SurfacePoints<F>,
        sample: &LightSamples<F>,
        wanted: F::M,
        opaque: bool,
        scratch: &mut Scratch<F>,
    ) -> F::M {
        self.aggregate.occluded(&towards(at, sample), sample.light, wanted, opaque, scratch)
    }

    /// Where what the `wanted` photons have met lies behind another surface than that of the lights that they left: of those that
    /// coincide one is there, as light sampling has it. They left along rays from `origin` in these unit directions.
    #[inline(always)]
    pub fn is_another_light_there<F: Float>(
        &self,
        (origin, direction, light): (Vector<F>, Vector<F>, F::U),
        met: &SurfacePoints<F>,
        wanted: F::M,
        scratch: &mut Scratch<F>,
    ) -> F::M {
        let from = met.leaving_towards(-direction);
        let back = Rays { origin: from, direction: origin - from, tmax: F::splat(SHADOW_END) };
        self.aggregate.occluded(&back, light, wanted, false, scratch)
    }

    /// Radiance that rays find where they hit nothing: the sky of one colour, and `sun_weight` times the sun's disc unless it is a
    /// delta light.
    #[inline(always)]
    pub fn environment<F: Float>(&self, direction: Vector<F>, sun_weight: F) -> Vector<F> {
        let sky = in_all_lanes(self.sky);
        match &self.sun_disc {
            Some(disc) => sky + disc.radiance(direction) * sun_weight,
            None => sky,
        }
    }

    /// Whether rays that hit nothing may find light.
    pub fn has_environment(&self) -> bool {
        self.sky != Vec3::ZERO || self.sun_disc.is_some()
    }
}
