//! What paths do beside sampling lights where a scene has casters: at vertices they connect to a light by way of a sphere,
//! and light that chance finds by the same chain counts so much the less.
//!
//! Twin: `shaders/pathtrace/integrator/connected.wgsl`.

use crate::bsdf::Interactions;
use crate::caster::connect::{ConnectedRays, Connections, End, facing};
use crate::caster::sphere_chain::MOST_ROOTS;
use crate::integrator::chain_state::SeenFromCenter;
use crate::integrator::directions::DirectionsAt;
use crate::integrator::path::PathLanes;
use crate::integrator::path_state::balance;
use crate::integrator::settings::LightSampling;
use crate::intersect::{Intersections, SurfacePoints};
use crate::light::LightSamples;
use simd::{Float, Mask, Vector, Word};

impl<F: Float> PathLanes<'_, F> {
    /// Takes the light of one sample of the lights by way of one sphere: of every ray that goes there. Its specular
    /// vertices count against the limit of bounces as they do by chance.
    #[inline(always)]
    pub(super) fn connect(&mut self, here: F::M, at: &Interactions<F>, directions: &DirectionsAt<F>, u: [F; 4]) {
        let chain = self.scene.casters.choose(u[3]);
        let specular = F::U::select(chain.through, F::U::splat(2), F::U::splat(1));
        let fits = self.path.vertices.wrapping_add(specular).lt(F::U::splat(self.plan.limit));
        let light = self.scene.lights.table().sample(chain.center, u[2], [u[0], u[1]]);
        let connections = Connections::new(at.point.position, chain, light);
        let fits = fits & !self.is_left_to_chance(&connections.light);
        let wanted = here & fits & connections.possible & !connections.is_behind(at.normal);
        for index in 0..MOST_ROOTS {
            let root = connections.root(index, wanted);
            if root.found.any() {
                self.receive_by(root.found, (at, directions), &connections, &connections.ray(&root));
            }
        }
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
        (at, directions): (&Interactions<F>, &DirectionsAt<F>),
        by: &Connections<F>,
        ray: &ConnectedRays<F>,
    ) {
        let (zero, cosine) = (F::splat(0.0), at.normal.dot(ray.wi));
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
        let bsdf = self.scene.materials.eval(at, ray.wi);
        self.receive(arrives, bsdf.times(by.light.radiance_over_pdf * colour * (cosine * ray.passes / density)));
    }

    /// Where nothing stands in a connection's way.
    #[inline(always)]
    fn arrives(&mut self, here: F::M, at: &SurfacePoints<F>, by: &Connections<F>, ray: &ConnectedRays<F>) -> F::M {
        self.rays += u64::from(here.count());
        if !here.any() {
            return here;
        }
        let (scene, scratch) = (self.scene, &mut self.scratch);
        let mut free = here & !scene.blocked(at, &ray.first, ray.wi, here, scratch);
        let inside = free & by.chain.through;
        if !scene.casters.are_hollow() && inside.any() {
            self.rays += u64::from(inside.count());
            let chord = (ray.last.position - ray.first.position).normalize();
            free = free & !scene.blocked(&ray.first, &ray.last, chord, inside, scratch);
        }
        self.rays += u64::from(free.count());
        if !free.any() {
            return free;
        }
        let last = LightSamples { wi: ray.arriving, ..by.light };
        free & !scene.in_shadow(&ray.last, &last, free, false, scratch)
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
