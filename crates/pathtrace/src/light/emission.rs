//! Light as it leaves what shines, for walks that begin there (pbrt-v3, 16.1.2): a light, a point of it or of the
//! scene's disc, and a direction, with the power that goes along.
//!
//! Few photons find what focuses light where that is small in a wide scene. So half of them are aimed at the spheres
//! around mirrors, metal and glass, as Jensen's projection maps do ("Realistic Image Synthesis Using Photon Mapping",
//! 2001, 5.3), and the other half goes everywhere. The density is that of the mixture: power is bounded by the half that is
//! not aimed.

use super::ball::ALL_DIRECTIONS;
use super::{Environment, Light, Lights, mixed_probabilities};
use crate::intersect::{Ray, SurfacePoint, SurfacePoints};
use crate::sampling::{self, UNIFORM_HEMISPHERE_PDF, warp};
use crate::vectors::{glam_vector, lane_vector};
use film::colour;
use scene::material::Emission;
use scene::{Bsdf, Geometry, Scene, Sun, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::Arc;

/// Share of the photons that are aimed at casters, where there are any.
const AIMED: f32 = 0.5;

/// A sphere around something.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bounds {
    center: Vec3,
    radius: f32,
}

/// All that sends out light.
#[derive(Debug, Clone)]
pub struct Emitters {
    lights: Vec<Light>,
    environment: Option<Arc<Environment>>,
    /// Of a sky of one colour, which light sampling leaves to chance and which is the last of the emitters.
    sky: Vec3,
    probabilities: Vec<f32>,
    /// Running sum of the probabilities, the last one 1.
    cumulative: Vec<f32>,
    /// The box around all shapes of the scene.
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
}

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
        let of_lights = lights.lights.iter().map(|light| light.power(bounds.radius));
        let powers: Vec<f64> = of_lights.chain((of_sky > 0.0).then_some(of_sky)).map(f64::from).collect();
        let focuses = |bsdf: Bsdf| !matches!(bsdf, Bsdf::Diffuse { .. });
        let casters = scene.shapes.iter().filter(|shape| focuses(scene.material_of(shape).bsdf));
        let probabilities: Vec<f32> = mixed_probabilities(&powers).into_iter().map(|p| p as f32).collect();
        let sums = probabilities.iter().scan(0.0, |sum, probability| {
            *sum += probability;
            Some(*sum)
        });
        Emitters {
            lights: lights.lights.clone(),
            environment: lights.environment.clone(),
            sky,
            cumulative: sums.collect(),
            probabilities,
            scene: bounds,
            casters: few(casters.map(|shape| &shape.geometry).collect()),
        }
    }

    /// A photon; `None` where nothing leaves that way.
    pub fn emit(&self, choice: &EmissionChoice) -> Option<Emitted> {
        let (index, probability) = self.choose(choice.light)?;
        let emitted = match self.lights.get(index) {
            Some(Light::Flat(flat, emission)) => {
                let [s, t] = flat.place(choice.place);
                let [corner, u, v, normal] =
                    [flat.corner, flat.edge_u * s, flat.edge_v * t, flat.normal].map(lane_vector);
                self.leaving_surface(&SurfacePoints::on_plane(corner, u, v, normal).into(), emission, flat.area, choice)
            }
            Some(Light::Sphere(sphere, emission)) => {
                let out = warp::cone(ALL_DIRECTIONS, choice.place);
                let point = SurfacePoints::on_sphere(lane_vector(sphere.center), sphere.radius, out);
                self.leaving_surface(&point.into(), emission, 4.0 * PI * sphere.radius * sphere.radius, choice)
            }
            Some(Light::Point(point)) => {
                let everywhere = (sampling::cone(ALL_DIRECTIONS, choice.way), |_: Vec3| 0.5 * UNIFORM_HEMISPHERE_PDF);
                let (direction, pdf) = self.aimed_direction(point.position, everywhere, choice);
                Emitted { ray: Ray::new(point.position, direction), power: point.intensity / pdf }
            }
            Some(Light::Sun(sun)) => {
                let (towards, radiance_over_pdf) = from_sun(sun, choice.place);
                self.coming_from_afar(towards, radiance_over_pdf, choice)
            }
            Some(Light::Environment(_)) => {
                let sample = self.environment.as_deref()?.sample::<f32>(choice.place);
                self.coming_from_afar(glam_vector(sample.wi), glam_vector(sample.radiance) / sample.pdf, choice)
            }
            None => {
                let towards = sampling::cone(ALL_DIRECTIONS, choice.place);
                self.coming_from_afar(towards, self.sky * (2.0 / UNIFORM_HEMISPHERE_PDF), choice)
            }
        };
        let power = emitted.power / probability;
        (power.is_finite() && power.max_element() > 0.0).then_some(Emitted { power, ..emitted })
    }

    /// The emitter that a number chooses, with its probability.
    fn choose(&self, u: f32) -> Option<(usize, f32)> {
        let passed = self.cumulative.partition_point(|sum| *sum <= u);
        // the last sum may be rounded to below 1
        let index = passed.min(self.probabilities.len().checked_sub(1)?);
        Some((index, self.probabilities[index]))
    }

    fn leaving_surface(&self, at: &SurfacePoint, emission: &Emission, area: f32, choice: &EmissionChoice) -> Emitted {
        let sides = if emission.two_sided { 2.0 } else { 1.0 };
        let normal = if emission.two_sided && choice.side < 0.5 { -at.normal } else { at.normal };
        let by_cosine = sampling::to_world(sampling::cosine_hemisphere(choice.way), normal);
        let pdf_of_cosine = |direction: Vec3| direction.dot(normal).max(0.0) * FRAC_1_PI;
        let (direction, pdf) = self.aimed_direction(at.position, (by_cosine, pdf_of_cosine), choice);
        let cosine = direction.dot(normal).max(0.0);
        let power = emission.radiance * (cosine * area * sides / pdf);
        Emitted { ray: Ray::new(at.leaving_towards(direction), direction), power }
    }

    /// A direction from a point with its density: one that is given, or one towards a caster.
    fn aimed_direction(
        &self,
        from: Vec3,
        (elsewhere, pdf_elsewhere): (Vec3, impl Fn(Vec3) -> f32),
        choice: &EmissionChoice,
    ) -> (Vec3, f32) {
        let cones: Vec<(Vec3, f32)> = self.casters.iter().filter_map(|caster| caster.cone_from(from)).collect();
        let (share, aim) = aim_at(cones.len(), choice.aim);
        let direction =
            aim.map_or(elsewhere, |i| sampling::to_world(sampling::cone(cones[i].1, choice.way), cones[i].0));
        let pdf_of = |(i, (axis, one_minus_cos)): (usize, &(Vec3, f32))| {
            // by the chord, which stays exact for small cones; rounding must not put what was drawn there outside
            let inside = aim == Some(i) || (direction - *axis).length_squared() < 2.0 * one_minus_cos;
            if inside { sampling::cone_pdf(*one_minus_cos) } else { 0.0 }
        };
        let aimed: f32 = cones.iter().enumerate().map(pdf_of).sum();
        (direction, (1.0 - share) * pdf_elsewhere(direction) + share * aimed / cones.len().max(1) as f32)
    }

    /// A photon from the sun or the sky, on the disc that the scene fills as seen from there, or on that of a caster.
    fn coming_from_afar(&self, towards: Vec3, radiance_over_pdf: Vec3, choice: &EmissionChoice) -> Emitted {
        let (s, t) = sampling::orthonormal_basis(towards);
        let across = |v: Vec3| [v.dot(s), v.dot(t)];
        let discs: Vec<([f32; 2], f32)> =
            self.casters.iter().map(|caster| (across(caster.center - self.scene.center), caster.radius)).collect();
        let (share, aim) = aim_at(discs.len(), choice.aim);
        let ([x, y], radius) = aim.map_or(([0.0; 2], self.scene.radius), |i| discs[i]);
        let [u, v] = warp::disk(choice.way);
        let [x, y] = [x + radius * u, y + radius * v];
        let pdf_of = |(i, ([cx, cy], radius)): (usize, &([f32; 2], f32))| {
            let inside = aim == Some(i) || (x - cx).powi(2) + (y - cy).powi(2) < radius * radius;
            if inside { FRAC_1_PI / (radius * radius) } else { 0.0 }
        };
        let aimed: f32 = discs.iter().enumerate().map(pdf_of).sum();
        let everywhere = FRAC_1_PI / (self.scene.radius * self.scene.radius);
        let pdf = (1.0 - share) * everywhere + share * aimed / discs.len().max(1) as f32;
        // a caster's sphere may reach out of the scene's: twice its radius is outside of both
        let origin = self.scene.center + s * x + t * y + towards * (2.0 * self.scene.radius);
        Emitted { ray: Ray::new(origin, -towards), power: radiance_over_pdf / pdf }
    }
}

/// Casters that each have a sphere of their own: a photon asks all of them for its density.
const MOST_CASTERS: usize = 64;

/// Spheres around these shapes, or one around all where there are many.
fn few(shapes: Vec<&Geometry>) -> Vec<Bounds> {
    if shapes.len() <= MOST_CASTERS {
        return shapes.into_iter().map(Bounds::around).collect();
    }
    let boxes = shapes.into_iter().map(Geometry::bounds);
    boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).map(Bounds::of).into_iter().collect()
}

/// The share of photons that are aimed where there are so many casters, and at which this one is.
fn aim_at(casters: usize, u: f32) -> (f32, Option<usize>) {
    let share = if casters == 0 { 0.0 } else { AIMED };
    (share, (u < share).then(|| ((u / share * casters as f32) as usize).min(casters - 1)))
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

impl Bounds {
    fn of((lo, hi): (Vec3, Vec3)) -> Self {
        // centre and half diagonal are rounded; a photon at the very rim shall not miss what is there
        let rounding = 1.0 + 16.0 * f32::EPSILON;
        Bounds { center: 0.5 * (lo + hi), radius: 0.5 * (hi - lo).length() * rounding }
    }

    fn around(geometry: &Geometry) -> Self {
        match *geometry {
            Geometry::Sphere { center, radius } | Geometry::Disk { center, radius, .. } => Bounds { center, radius },
            _ => Bounds::of(geometry.bounds()),
        }
    }

    /// Axis and `1 - cos` of the cone that it fills as seen from a point outside.
    fn cone_from(&self, from: Vec3) -> Option<(Vec3, f32)> {
        let to_center = self.center - from;
        let distance = to_center.length();
        (distance > self.radius).then(|| {
            let cos = ((distance - self.radius) * (distance + self.radius)).sqrt() / distance;
            let sin = self.radius / distance;
            (to_center / distance, sin * sin / (1.0 + cos))
        })
    }
}

#[cfg(test)]
mod tests;
