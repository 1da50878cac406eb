//! What paths do beside sampling lights where a scene has casters: at vertices they connect to a light by way of a sphere,
//! and light that chance finds by the same chain counts so much the less.
//!
//! Twin: `shaders/pathtrace/integrator/connected.wgsl`.

use crate::bsdf::Interactions;
use crate::caster::connect::{ConnectedRays, Connections, End, facing};
use crate::caster::sphere_chain::MOST_ROOTS;
use crate::integrator::chain_state::SeenFromCenter;
use crate::integrator::directions::DirectionsAt;
use crate::integrator::light_paths::counts;
use crate::integrator::path::PathLanes;
use crate::integrator::path_state::balance;
use crate::integrator::settings::LightSampling;
use crate::integrator::waiting::ConnectingVertices;
use crate::intersect::{Intersections, Rays, SurfacePoints};
use crate::light::LightSamples;
use crate::prepared::{NOT_A_LIGHT, between, towards};
use simd::{Float, Mask, Vector, Word};

/// The straight parts of a connection.
#[derive(Clone, Copy)]
enum Leg {
    /// From the vertex to where the ray meets the sphere.
    ToSphere,
    /// Through the sphere, from one face to the other.
    Chord,
    /// From where the ray leaves the sphere.
    ToLight,
}

const LEGS: [Leg; 3] = [Leg::ToSphere, Leg::Chord, Leg::ToLight];

impl Leg {
    /// The shadow rays of it, and which light may be at their ends.
    #[inline(always)]
    fn rays<F: Float>(self, at: &SurfacePoints<F>, by: &Connections<F>, ray: &ConnectedRays<F>) -> (Rays<F>, F::U) {
        match self {
            Leg::ToSphere => (between(at, &ray.first, ray.wi), F::U::splat(NOT_A_LIGHT)),
            Leg::Chord => {
                let chord = (ray.last.position - ray.first.position).normalize();
                (between(&ray.first, &ray.last, chord), F::U::splat(NOT_A_LIGHT))
            }
            Leg::ToLight => {
                let light = LightSamples { wi: ray.arriving, ..by.light };
                (towards(&ray.last, &light), light.light)
            }
        }
    }
}

impl<F: Float> PathLanes<'_, F> {
    /// Takes the light of one sample of the lights by way of one sphere: of every ray that goes there. Its specular
    /// vertices count against the limit of bounces as they do by chance.
    #[inline(always)]
    pub(super) fn connect(&mut self, from: &ConnectingVertices<F>, u: [F; 4]) {
        let at = &from.at;
        let directions = self.directions(from.here, at);
        let chain = self.scene.casters.choose(u[3]);
        let specular = F::U::select(chain.through, F::U::splat(2), F::U::splat(1));
        let fits = from.vertices.wrapping_add(specular).lt(F::U::splat(self.plan.limit));
        let light = self.scene.lights.table().sample_whole(chain.center, u[2], [u[0], u[1]]);
        let connections = Connections::new(at.point.position, chain, light);
        let fits = fits & !self.is_left_to_chance(&connections.light);
        let mut wanted = from.here & fits & connections.possible & !self.is_behind(&connections, at);
        if let Some(counted) = &self.plan.counted {
            let first = counted.after_specular(from.light_path);
            let last = F::U::select(connections.chain.through, counted.after_specular(first), first);
            wanted = wanted & counts(last);
        }
        for index in 0..MOST_ROOTS {
            let root = connections.root(index, wanted);
            if root.found.any() {
                self.receive_by(root.found, (from, &directions), &connections, &connections.ray(&root));
            }
        }
    }

    /// Where nothing of a sphere lies above the surface.
    #[inline(always)]
    fn is_behind(&self, connections: &Connections<F>, at: &Interactions<F>) -> F::M {
        let materials = &self.scene.materials;
        connections.is_behind(at.normal) & connections.is_behind(materials.mirroring_normal(at))
    }

    /// Where a sample is of a sky that is a picture, and connections are not weighed against chance, which finds what comes
    /// from everywhere better.
    #[inline(always)]
    fn is_left_to_chance(&self, sample: &LightSamples<F>) -> F::M {
        let lights = &self.scene.lights;
        if lights.environment().is_none() || self.plan.light == LightSampling::Mis {
            return F::M::splat(false);
        }
        // it is the last of the lights
        sample.light.eq(F::U::splat(lights.len() as u32 - 1))
    }

    /// Takes the light of a connection, if nothing stands in its way; under MIS weighted against chance.
    #[inline(always)]
    fn receive_by(
        &mut self,
        here: F::M,
        (from, directions): (&ConnectingVertices<F>, &DirectionsAt<F>),
        by: &Connections<F>,
        ray: &ConnectedRays<F>,
    ) {
        let at = &from.at;
        let (zero, cosine) = (F::splat(0.0), self.scene.materials.cosine(at, ray.wi));
        let arrives = self.arrives(here & cosine.gt(zero) & ray.density.gt(zero), &at.point, by, ray);
        if !arrives.any() {
            return;
        }
        let surface = &by.chain.surface;
        let mut density = ray.density * surface.probability;
        if self.plan.light == LightSampling::Mis {
            // of what the sample's own density is the unit of
            density = density + ray.passes * self.direction_pdf(at, directions, ray.wi, cosine) / by.light.pdf;
        }
        let colour = Vector::select(by.chain.through, Vector::along_all(F::splat(1.0)), surface.colour);
        let share = self.scene.lights.table().spot_share(by.light.light, -ray.arriving);
        let bsdf = self.scene.materials.eval(at, ray.wi);
        let radiance = bsdf.times(by.light.radiance_over_pdf * colour * (cosine * ray.passes * share / density));
        let found = self.waiting.found;
        self.waiting.found = Vector::select(arrives, found + from.throughput * radiance, found);
    }

    /// Where nothing stands in a connection's way.
    #[inline(always)]
    fn arrives(&mut self, here: F::M, at: &SurfacePoints<F>, by: &Connections<F>, ray: &ConnectedRays<F>) -> F::M {
        let mut free = here;
        // one loop rather than one after the other, or the code that meets shapes would be there three times
        for leg in LEGS {
            let wanted = match leg {
                Leg::Chord if self.scene.casters.are_hollow() => continue,
                Leg::Chord => free & by.chain.through,
                Leg::ToSphere | Leg::ToLight => free,
            };
            if wanted.any() {
                self.rays += u64::from(wanted.count());
                let (rays, light) = leg.rays(at, by, ray);
                free = free & !self.scene.aggregate.occluded(&rays, light, wanted, false, &mut self.scratch);
            }
        }
        free
    }

    /// How much light that a ray finds where it hits nothing counts by its chain, beside connections to the same light,
    /// sampled with this density.
    #[inline(always)]
    pub(super) fn weight_of_chain_to_sky(&self, here: F::M, pdf: F) -> F {
        let everywhere = !F::M::splat(false);
        let end = End { length: F::splat(f32::INFINITY), endless: everywhere };
        let facing = F::splat(1.0);
        self.weight_of_chain(here, &SeenFromCenter { direction: self.path.rays.direction, end, pdf, facing })
    }

    /// The same of light that is met on a surface.
    #[inline(always)]
    pub(super) fn weight_of_chain_to_hit(&self, here: F::M, hit: &Intersections<F>) -> F {
        if !(here & self.chain.is_complete()).any() {
            return F::splat(1.0);
        }
        let (center, radius) = self.chain.sphere();
        let to_light = hit.point.position - center;
        let distance = to_light.length_squared().sqrt();
        let direction = to_light * (F::splat(1.0) / distance);
        let light = SeenFromCenter {
            direction,
            end: End { length: distance / radius, endless: F::M::splat(false) },
            pdf: self.scene.lights.table().pdf_where_sampled(hit.light, center, &hit.point),
            facing: facing(&hit.point, direction, self.path.rays.direction),
        };
        self.weight_of_chain(here, &light)
    }

    #[inline(always)]
    fn weight_of_chain(&self, here: F::M, light: &SeenFromCenter<F>) -> F {
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        if !(here & self.chain.is_complete()).any() {
            return one;
        }
        let [sampled, chance] = self.chain.densities(self.scene.casters.materials(), light);
        let weight = if self.plan.light == LightSampling::Mis { balance(chance, sampled) } else { zero };
        F::select(sampled.gt(zero), weight, one)
    }
}
