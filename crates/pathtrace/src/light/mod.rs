//! What shines, as light sampling sees it: area lights (emissive shapes), point lights, the sun and a sky from a
//! picture. Task 2 c), "Sampling Area Light". One light is chosen, then a direction to it; [`Lights::pdf`] is the
//! density of doing so, as MIS needs it.

pub(crate) mod aim;
pub(crate) mod ball;
mod emission;
mod environment;
pub(crate) mod flat;
mod light_samples;
mod spherical_rectangle;
mod spot;
mod sun;
mod table;
pub(crate) mod textured;
mod tree;
mod tree_build;

pub(crate) use aim::{Aim, Bounds};
pub use emission::{EmissionChoice, Emitted, Emitters};
pub use environment::{Environment, EnvironmentSamples};
pub use light_samples::LightSamples;
pub use spherical_rectangle::SphericalRectangle;
pub(crate) use spot::cone_of;
pub use sun::SunDisc;
pub(crate) use table::Table as LightTable;

use crate::intersect::sphere::Sphere;
use crate::intersect::{NO_LIGHT, SurfacePoint, triangle_normal};
use crate::sampling::discrete::Discrete;
use crate::sampling::warp;
use crate::vectors::{glam_vector, lane_vector};
use film::colour;
use flat::Flat;
use scene::material::Emission;
use scene::{Geometry, PointLight, Scene, Shape, Sun, Vec3};
use std::f32::consts::PI;
use std::sync::Arc;
use table::Table;
use textured::TexturedLights;
use tree::LightTree;
pub(crate) use tree::{BELOW_ONE, LEAF, LEAST_SQUARE};
use tree_build::Bounds as LightBounds;

/// A light that can be sampled from a point.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Light {
    Flat(Flat, Emission),
    Sphere(Sphere, Emission),
    Point(PointLight),
    Sun(Sun),
    /// Irradiance of the whole sky on a surface that faced all of it, by luminance.
    Environment(f32),
}

/// All lights of a scene that are sampled, with the probabilities of choosing each.
#[derive(Debug, Clone, Default)]
pub struct Lights {
    pub(crate) lights: Vec<Light>,
    /// The probability of choosing each.
    pub(crate) probabilities: Vec<f32>,
    /// See [`Lights::light_of_shape`].
    light_of_shape: Vec<u32>,
    /// Index of the sun.
    sun: Option<usize>,
    environment: Option<Arc<Environment>>,
    /// What they wear, where any wears pictures.
    pub(crate) textured: Option<Arc<TexturedLights>>,
    /// All of this as lanes look it up.
    table: Table,
}

/// Light that arrives at a point from one sampled direction, if nothing stands between.
#[derive(Debug, Clone, Copy)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// Radiance divided by `pdf`; for a point or a delta sun its irradiance.
    pub radiance_over_pdf: Vec3,
    /// Density per solid angle; infinite for a point and a delta sun.
    pub pdf: f32,
    /// Where the shadow ray ends.
    pub end: ShadowEnd,
}

/// The far end of a shadow ray.
#[derive(Debug, Clone, Copy)]
pub enum ShadowEnd {
    /// A point on an area light.
    AreaLight(SurfacePoint),
    /// A point in the air.
    Point(Vec3),
    /// The sun or the sky.
    Infinity,
}

impl Lights {
    /// Collects the lights. Half of the choices go by power and half to all alike, so that a small area light beside a
    /// strong sun still gets its samples.
    pub fn new(scene: &Scene) -> Self {
        let mut lights = Vec::new();
        let mut light_of_shape = Vec::new();
        for shape in scene.shapes.iter() {
            let emission = scene.material_of(shape).emission.filter(|e| e.radiance.max_element() > 0.0);
            let first = lights.len();
            emission.into_iter().for_each(|emission| push_area_lights(shape, emission, &mut lights));
            light_of_shape.push(if lights.len() > first { first as u32 } else { NO_LIGHT });
        }
        let shines = |point: &&PointLight| point.intensity.max_element() > 0.0;
        lights.extend(scene.point_lights.iter().filter(shines).copied().map(Light::Point));
        let sun = scene.sun.filter(|sun| sun.irradiance.max_element() > 0.0);
        let sun = sun.map(|sun| (lights.push(Light::Sun(sun)), lights.len() - 1).1);
        let environment = scene.environment.as_ref().and_then(|map| {
            lights.push(Light::Environment(4.0 * PI * colour::luminance(map.mean())));
            Environment::new(map).or_else(|| (lights.pop(), None).1)
        });
        let (lo, hi) = scene.bounds();
        let scene_radius = 0.5 * (hi - lo).length();
        let textured = TexturedLights::of(scene, &light_of_shape, lights.len());
        let powers: Vec<f64> = powers(&lights, &textured, scene_radius).map(f64::from).collect();
        let probabilities = mixed_probabilities(&powers);
        let choice = Discrete::new(probabilities.iter().copied());
        let probabilities: Vec<f32> = probabilities.iter().map(|&p| p as f32).collect();
        let environment = environment.zip(probabilities.last()).map(|(map, &last)| Arc::new(map.chosen_with(last)));
        let tree = LightTree::over(&lights);
        let table = Table::new(&lights, &probabilities, choice, (tree, environment.clone()), textured.clone());
        Lights { lights, probabilities, light_of_shape, sun, environment, textured, table }
    }

    /// Number of lights; each triangle of a mesh that shines is one.
    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// Whether there is nothing to sample.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// Of each shape of the scene the index of its first light, or [`NO_LIGHT`]: its triangles with area are lights in
    /// their order, other shapes are one light.
    pub fn light_of_shape(&self) -> &[u32] {
        &self.light_of_shape
    }

    /// The lights in lanes.
    #[inline(always)]
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// The light that `u` in [0, 1) chooses where they are not so many that their place counts; there must be one.
    pub fn choose(&self, u: f32) -> usize {
        self.table.choose(u) as usize
    }

    /// The probability that [`Lights::choose`] gives this light.
    pub fn probability(&self, light: usize) -> f32 {
        self.probabilities[light]
    }

    /// Samples the light that reaches the point `x`: one number in [0, 1) to choose a light, two to choose a point on
    /// it. `None` where the chosen light does not shine.
    pub fn sample(&self, x: Vec3, u_light: f32, u: [f32; 2]) -> Option<LightSample> {
        if self.lights.is_empty() {
            return None;
        }
        let sample = self.table.sample(lane_vector(x), u_light, u);
        let end = match self.lights[sample.light as usize] {
            Light::Flat(..) | Light::Sphere(..) => ShadowEnd::AreaLight(sample.point.into()),
            Light::Point(point) => ShadowEnd::Point(point.position),
            Light::Sun(_) | Light::Environment(_) => ShadowEnd::Infinity,
        };
        let (wi, radiance_over_pdf) = (glam_vector(sample.wi), glam_vector(sample.radiance_over_pdf));
        sample.shines.then_some(LightSample { wi, radiance_over_pdf, pdf: sample.pdf, end })
    }

    /// Density per solid angle with which [`Lights::sample`] at `x` draws the direction that met `light` at `hit`.
    pub fn pdf(&self, light: u32, x: Vec3, hit: &SurfacePoint) -> f32 {
        self.table.pdf(light, lane_vector(x), lane_vector(hit.position))
    }

    /// Density per solid angle with which [`Lights::sample`] draws a direction in the sun's disc.
    pub fn sun_pdf(&self) -> f32 {
        self.sun.map_or(0.0, |index| match self.lights[index] {
            Light::Sun(sun) => warp::cone_pdf(sun.one_minus_cos()) * self.probabilities[index],
            _ => 0.0,
        })
    }

    /// The sky from a picture, if it is a light.
    #[inline(always)]
    pub fn environment(&self) -> Option<&Environment> {
        self.environment.as_deref()
    }

    /// Whether one sample of this light is exact: it shines from one direction.
    pub fn is_delta(&self, light: usize) -> bool {
        match self.lights[light] {
            Light::Point(_) => true,
            Light::Sun(sun) => sun.one_minus_cos() == 0.0,
            Light::Flat(..) | Light::Sphere(..) | Light::Environment(_) => false,
        }
    }
}

/// Emitted power of each light as far as choosing needs it, with what pictures leave of it.
fn powers<'a>(
    lights: &'a [Light],
    textured: &'a Option<Arc<TexturedLights>>,
    scene_radius: f32,
) -> impl Iterator<Item = f32> + 'a {
    let mean = move |index: usize, light: &Light| match (textured, light) {
        (Some(textured), Light::Flat(_, emission)) => textured.mean(index, emission.radiance),
        _ => 1.0,
    };
    lights.iter().enumerate().map(move |(index, light)| light.power(scene_radius) * mean(index, light))
}

fn mixed_probabilities(powers: &[f64]) -> Vec<f64> {
    let alike = 1.0 / powers.len() as f64;
    let total: f64 = powers.iter().sum();
    let by_power = |power: &f64| if total.is_finite() && total > 0.0 { power / total } else { alike };
    powers.iter().map(|power| 0.5 * (alike + by_power(power))).collect()
}

fn push_area_lights(shape: &Shape, emission: Emission, lights: &mut Vec<Light>) {
    let mut push = |flat: Option<Flat>| lights.extend(flat.map(|flat| Light::Flat(flat, emission)));
    match shape.geometry {
        Geometry::Sphere { center, radius } => lights.push(Light::Sphere(Sphere { center, radius }, emission)),
        Geometry::Rectangle { corner, edge_u, edge_v } => push(Flat::parallelogram(corner, edge_u, edge_v)),
        Geometry::Disk { center, normal, radius } => push(Some(Flat::disk(center, normal, radius))),
        Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
            let (positions, triangles) = shape.geometry.flat_triangles();
            for corners in triangles.iter().map(|t| t.map(|i| positions[i as usize])) {
                push(triangle_normal(corners).map(|normal| Flat::triangle(corners, normal)));
            }
        }
    }
}

impl Light {
    /// Emitted power, as far as choosing needs it; the sun's and the sky's is what falls on the scene's disc.
    fn power(&self, scene_radius: f32) -> f32 {
        let of = |emission: &Emission, area: f32| {
            colour::luminance(emission.radiance) * area * PI * if emission.two_sided { 2.0 } else { 1.0 }
        };
        match self {
            Light::Flat(flat, emission) => of(emission, flat.area),
            Light::Sphere(sphere, emission) => of(emission, 4.0 * PI * sphere.radius * sphere.radius),
            Light::Point(point) => colour::luminance(point.intensity) * spot::full_solid_angle(point),
            Light::Sun(sun) => colour::luminance(sun.irradiance) * PI * scene_radius * scene_radius,
            Light::Environment(irradiance) => irradiance * PI * scene_radius * scene_radius,
        }
    }
}
