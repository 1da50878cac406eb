//! Light as it leaves what shines, for walks that begin there (pbrt-v3, 16.1.2): a light, a point of it or of the
//! scene's disc, and a direction, with the power that goes along.
//!
//! Twin: `shaders/pathtrace/light/emission.wgsl`.

use super::aim::{Aim, Bounds, around_each};
use super::ball::ALL_DIRECTIONS;
use super::textured::TexturedLights;
use super::{Environment, Light, Lights, mixed_probabilities, powers};
use crate::intersect::{Ray, SurfacePoint, SurfacePoints};
use crate::sampling::{self, UNIFORM_HEMISPHERE_PDF, warp};
use crate::vectors::{glam_vector, lane_vector};
use film::colour;
use scene::material::Emission;
use scene::{Bsdf, Scene, Sun, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::Arc;

/// All that sends out light.
#[derive(Debug, Clone)]
pub struct Emitters {
    lights: Vec<Light>,
    environment: Option<Arc<Environment>>,
    textured: Option<Arc<TexturedLights>>,
    /// Of a sky of one colour, which light sampling leaves to chance and which is the last of the emitters.
    sky: Vec3,
    probabilities: Vec<f32>,
    /// Running sum of the probabilities, the last one 1.
    cumulative: Vec<f32>,
    /// The sphere around all shapes of the scene.
    scene: Bounds,
    /// Around what focuses light, each shape or all together.
    casters: Vec<Bounds>,
}

/// A photon as it leaves a light.
#[derive(Debug, Clone, Copy)]
pub struct Emitted {
    /// The ray along which the photon leaves its light.
    pub ray: Ray,
    /// Power over the density of the choices, RGB.
    pub power: Vec3,
    /// Index into the list of lights; its length for a sky of one colour.
    pub light: u32,
}

/// The ray along which a photon leaves, and its power over the density of the choices but for that of the light.
type Leaving = (Ray, Vec3);

/// Numbers in [0, 1) that choose a photon.
#[derive(Debug, Clone, Copy)]
pub struct EmissionChoice {
    /// The number that chooses a light, in [0, 1).
    pub light: f32,
    /// Whether to aim, and at what.
    pub aim: f32,
    /// Which side of what shines on both.
    pub side: f32,
    /// A point of the light, or a direction towards the sun or the sky.
    pub place: [f32; 2],
    /// The direction from there, or a point of the disc through which light from far away comes.
    pub way: [f32; 2],
}

impl Emitters {
    /// Of a scene and its lights.
    pub fn new(scene: &Scene, lights: &Lights) -> Self {
        let (lo, hi) = scene.bounds();
        let sky = if scene.environment.is_some() { Vec3::ZERO } else { scene.sky };
        let bounds = Bounds::of((lo, hi));
        let of_sky = 4.0 * PI * PI * bounds.radius * bounds.radius * colour::luminance(sky);
        let of_lights = powers(&lights.lights, &lights.textured, bounds.radius);
        let powers: Vec<f64> = of_lights.chain((of_sky > 0.0).then_some(of_sky)).map(f64::from).collect();
        let focuses = |bsdf: &Bsdf| match bsdf {
            Bsdf::Diffuse { .. } => false,
            Bsdf::MetallicRoughness(model) => model.metallic >= 0.5,
            Bsdf::Mirror { .. } | Bsdf::RoughConductor { .. } | Bsdf::Dielectric { .. } => true,
        };
        let casters = scene.shapes.iter().filter(|shape| focuses(&scene.material_of(shape).bsdf));
        let probabilities: Vec<f32> = mixed_probabilities(&powers).into_iter().map(|p| p as f32).collect();
        let sums = probabilities.iter().scan(0.0, |sum, probability| {
            *sum += probability;
            Some(*sum)
        });
        Emitters {
            lights: lights.lights.clone(),
            environment: lights.environment.clone(),
            textured: lights.textured.clone(),
            sky,
            cumulative: sums.collect(),
            probabilities,
            scene: bounds,
            casters: around_each(casters.map(|shape| &shape.geometry).collect()),
        }
    }

    /// What photons are aimed at for a camera that sees what lies in these spheres.
    pub fn aim(&self, seen: &[Bounds]) -> Aim {
        Aim::at(&self.casters, seen)
    }

    /// The sphere around all shapes of the scene.
    pub fn scene(&self) -> Bounds {
        self.scene
    }

    /// Radiance of a sky of one colour.
    pub(crate) fn sky(&self) -> Vec3 {
        self.sky
    }

    /// Of each emitter the running sum of the probabilities, and its probability.
    pub(crate) fn chances(&self) -> impl ExactSizeIterator<Item = (f32, f32)> {
        self.cumulative.iter().copied().zip(self.probabilities.iter().copied())
    }

    /// A photon; `None` where nothing leaves that way.
    pub fn emit(&self, aim: &Aim, choice: &EmissionChoice) -> Option<Emitted> {
        let (index, probability) = self.choose(choice.light)?;
        let (ray, power) = match self.lights.get(index) {
            Some(Light::Flat(flat, emission)) => {
                let [s, t] = flat.place(choice.place);
                let [corner, u, v, normal] =
                    [flat.corner, flat.edge_u * s, flat.edge_v * t, flat.normal].map(lane_vector);
                let point = SurfacePoints::on_plane(corner, u, v, normal);
                let (ray, power) = leaving_surface((&point.into(), flat.area), emission, aim, choice);
                (ray, power * self.textured.as_ref().map_or(Vec3::ONE, |textured| textured.at_one(index, [s, t])))
            }
            Some(Light::Sphere(sphere, emission)) => {
                let out = warp::cone(ALL_DIRECTIONS, choice.place);
                let point = SurfacePoints::on_sphere(lane_vector(sphere.center), sphere.radius, out);
                leaving_surface((&point.into(), 4.0 * PI * sphere.radius * sphere.radius), emission, aim, choice)
            }
            Some(Light::Point(point)) => {
                let everywhere = (sampling::cone(ALL_DIRECTIONS, choice.way), |_: Vec3| 0.5 * UNIFORM_HEMISPHERE_PDF);
                let (direction, pdf) = aim.direction((point.position, None), everywhere, (choice.aim, choice.way));
                let share = point.spot.map_or(1.0, |spot| spot.share(direction));
                (Ray::new(point.position, direction), point.intensity * share / pdf)
            }
            Some(Light::Sun(sun)) => self.coming_from_afar(from_sun(sun, choice.place), aim, choice),
            Some(Light::Environment(_)) => {
                let sample = self.environment.as_deref()?.sample::<f32>(choice.place);
                let radiance_over_pdf = glam_vector(sample.radiance) / sample.pdf;
                self.coming_from_afar((glam_vector(sample.wi), radiance_over_pdf), aim, choice)
            }
            None => {
                let towards = sampling::cone(ALL_DIRECTIONS, choice.place);
                self.coming_from_afar((towards, self.sky * (2.0 / UNIFORM_HEMISPHERE_PDF)), aim, choice)
            }
        };
        let power = power / probability;
        (power.is_finite() && power.max_element() > 0.0).then_some(Emitted { ray, power, light: index as u32 })
    }

    /// The emitter that a number chooses, with its probability.
    fn choose(&self, u: f32) -> Option<(usize, f32)> {
        let passed = self.cumulative.partition_point(|sum| *sum <= u);
        // the last sum may be rounded to below 1
        let index = passed.min(self.probabilities.len().checked_sub(1)?);
        Some((index, self.probabilities[index]))
    }

    /// A photon from the sun or the sky, on the disc that the scene fills as seen from there, or on that of what is aimed at.
    fn coming_from_afar(
        &self,
        (towards, radiance_over_pdf): (Vec3, Vec3),
        aim: &Aim,
        choice: &EmissionChoice,
    ) -> Leaving {
        let (s, t) = sampling::orthonormal_basis(towards);
        let ([x, y], pdf) = aim.place(&self.scene, (s, t), (choice.aim, choice.way));
        // a target's sphere may reach out of the scene's: twice its radius is outside of both
        let origin = self.scene.center + s * x + t * y + towards * (2.0 * self.scene.radius);
        (Ray::new(origin, -towards), radiance_over_pdf / pdf)
    }
}

/// A photon from a surface that shines.
fn leaving_surface(
    (at, area): (&SurfacePoint, f32),
    emission: &Emission,
    aim: &Aim,
    choice: &EmissionChoice,
) -> Leaving {
    let sides = if emission.two_sided { 2.0 } else { 1.0 };
    let normal = if emission.two_sided && choice.side < 0.5 { -at.normal } else { at.normal };
    let by_cosine = sampling::to_world(sampling::cosine_hemisphere(choice.way), normal);
    let pdf_of_cosine = |direction: Vec3| direction.dot(normal).max(0.0) * FRAC_1_PI;
    let from = (at.position, Some(normal));
    let (direction, pdf) = aim.direction(from, (by_cosine, pdf_of_cosine), (choice.aim, choice.way));
    let cosine = direction.dot(normal).max(0.0);
    let power = emission.radiance * (cosine * area * sides / pdf);
    (Ray::new(at.leaving_towards(direction), direction), power)
}

/// A direction towards the sun, and its radiance over the density of that.
fn from_sun(sun: &Sun, u: [f32; 2]) -> (Vec3, Vec3) {
    let one_minus_cos = sun.one_minus_cos();
    if one_minus_cos == 0.0 {
        return (sun.towards, sun.irradiance);
    }
    let towards = sampling::to_world(sampling::cone(one_minus_cos, u), sun.towards);
    (towards, sun.radiance() / sampling::cone_pdf(one_minus_cos))
}

#[cfg(test)]
mod tests;
