//! What shines, as light sampling sees it: lamps (emissive shapes) and the sun. Task 2 c), "Sampling Area Light".

use crate::geometry::SurfacePoint;
use crate::geometry::sphere::Sphere;
use crate::sampling;
use scene::glam::DVec3;
use scene::material::Emission;
use scene::{Geometry, Scene, Shape, Sun, Vec3, colour};
use std::f32::consts::PI;

/// A light that can be sampled from a point.
#[derive(Debug, Clone, Copy)]
enum Light {
    Parallelogram { corner: Vec3, edge_u: Vec3, edge_v: Vec3, normal: Vec3, area: f32, emission: Emission },
    Triangle { corners: [Vec3; 3], normal: Vec3, area: f32, emission: Emission },
    Sphere { sphere: Sphere, emission: Emission },
    Sun(Sun),
}

/// All lights of a scene that are sampled, with the probabilities of choosing each.
#[derive(Debug, Clone, Default)]
pub struct Lights {
    lights: Vec<Light>,
    /// The probability of choosing each.
    probabilities: Vec<f32>,
    /// Their running sum, the last one 1.
    cumulative: Vec<f32>,
}

/// Light that arrives at a point from one sampled direction, if nothing stands between.
#[derive(Debug, Clone, Copy)]
pub struct LightSample {
    /// Unit direction towards the light.
    pub wi: Vec3,
    /// Radiance divided by the sample's density per solid angle (for a delta sun: its irradiance).
    pub radiance_over_pdf: Vec3,
    /// Where the shadow ray ends.
    pub end: ShadowEnd,
}

/// The far end of a shadow ray.
#[derive(Debug, Clone, Copy)]
pub enum ShadowEnd {
    /// A point on a lamp.
    At(SurfacePoint),
    /// The sun.
    Infinity,
}

impl Lights {
    /// Collects the lights. Half of the choices go by power and half to all alike, so that a small lamp beside a strong
    /// sun still gets its samples.
    pub fn new(scene: &Scene) -> Self {
        let mut lights = Vec::new();
        for shape in scene.shapes.iter() {
            if let Some(emission) = scene.material_of(shape).emission.filter(|e| e.radiance.max_element() > 0.0) {
                push_lamps(shape, emission, &mut lights);
            }
        }
        lights.extend(scene.sun.filter(|sun| sun.irradiance.max_element() > 0.0).map(Light::Sun));
        let (lo, hi) = scene.bounds();
        let scene_radius = 0.5 * (hi - lo).length();
        let powers: Vec<f64> = lights.iter().map(|light| f64::from(light.power(scene_radius))).collect();
        let probabilities = mixed_probabilities(&powers);
        let mut sum = 0.0;
        let running = probabilities.iter().map(|probability| {
            sum += probability;
            sum as f32
        });
        let mut cumulative: Vec<f32> = running.collect();
        if let Some(last) = cumulative.last_mut() {
            *last = 1.0;
        }
        Lights { lights, probabilities: probabilities.iter().map(|&p| p as f32).collect(), cumulative }
    }

    /// Whether there is nothing to sample.
    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// Samples the light that reaches the point `x`: one number in [0, 1) to choose a light, two to choose a point on
    /// it. `None` where the chosen light does not shine.
    pub fn sample(&self, x: Vec3, u_light: f32, u: [f32; 2]) -> Option<LightSample> {
        let index = self.cumulative.partition_point(|&c| c <= u_light).min(self.lights.len().checked_sub(1)?);
        let mut sample = self.lights[index].sample(x, u)?;
        sample.radiance_over_pdf /= self.probabilities[index];
        Some(sample)
    }
}

fn mixed_probabilities(powers: &[f64]) -> Vec<f64> {
    let alike = 1.0 / powers.len() as f64;
    let total: f64 = powers.iter().sum();
    let by_power = |power: &f64| if total.is_finite() && total > 0.0 { power / total } else { alike };
    powers.iter().map(|power| 0.5 * (alike + by_power(power))).collect()
}

fn push_lamps(shape: &Shape, emission: Emission, lights: &mut Vec<Light>) {
    match shape.geometry {
        Geometry::Sphere { center, radius } => {
            lights.push(Light::Sphere { sphere: Sphere { center, radius }, emission })
        }
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            if let Some((normal, area)) = normal_and_area(edge_u.as_dvec3(), edge_v.as_dvec3()) {
                lights.push(Light::Parallelogram { corner, edge_u, edge_v, normal, area, emission });
            }
        }
        Geometry::Box { .. } | Geometry::Mesh { .. } => {
            let (positions, triangles) = shape.geometry.flat_triangles();
            for corners in triangles.iter().map(|t| t.map(|i| positions[i as usize])) {
                let [a, b, c] = corners.map(|corner| corner.as_dvec3());
                if let Some((normal, doubled)) = normal_and_area(b - a, c - a) {
                    lights.push(Light::Triangle { corners, normal, area: 0.5 * doubled, emission });
                }
            }
        }
    }
}

/// Unit normal and area of a parallelogram, in f64 whose squares hold what f32's do not; `None` without area.
fn normal_and_area(edge_u: DVec3, edge_v: DVec3) -> Option<(Vec3, f32)> {
    let cross = edge_u.cross(edge_v);
    cross.try_normalize().map(|normal| (normal.as_vec3(), cross.length() as f32))
}

impl Light {
    /// Emitted power, as far as choosing needs it; the sun's is what falls on the scene's disc.
    fn power(&self, scene_radius: f32) -> f32 {
        let of = |emission: &Emission, area: f32| {
            colour::luminance(emission.radiance) * area * PI * if emission.two_sided { 2.0 } else { 1.0 }
        };
        match self {
            Light::Parallelogram { area, emission, .. } | Light::Triangle { area, emission, .. } => of(emission, *area),
            Light::Sphere { sphere, emission } => of(emission, 4.0 * PI * sphere.radius * sphere.radius),
            Light::Sun(sun) => colour::luminance(sun.irradiance) * PI * scene_radius * scene_radius,
        }
    }

    fn sample(&self, x: Vec3, u: [f32; 2]) -> Option<LightSample> {
        match *self {
            Light::Parallelogram { corner, edge_u, edge_v, normal, area, emission } => {
                let (along_u, along_v) = (edge_u * u[0], edge_v * u[1]);
                let error = crate::geometry::gamma(4) * (corner.abs() + along_u.abs() + along_v.abs());
                let point = SurfacePoint { position: corner + along_u + along_v, error, normal };
                sample_area(x, point, area, emission)
            }
            Light::Triangle { corners, normal, area, emission } => {
                sample_area(x, SurfacePoint::on_triangle(corners, sampling::triangle(u), normal), area, emission)
            }
            Light::Sphere { sphere, emission } => sample_sphere(x, sphere, emission, u),
            Light::Sun(sun) => Some(sample_sun(sun, u)),
        }
    }
}

/// The tutorial's `L cos' S / |x - x'|^2`: emission over the density `1 / S` on the lamp, turned into solid angle.
fn sample_area(x: Vec3, point: SurfacePoint, area: f32, emission: Emission) -> Option<LightSample> {
    let to_light = point.position - x;
    let distance_squared = to_light.length_squared();
    let wi = to_light / distance_squared.sqrt();
    let mut cos_light = -point.normal.dot(wi);
    if emission.two_sided {
        cos_light = cos_light.abs();
    }
    // also refuses x on the lamp itself, where wi is NaN
    if !(cos_light > 0.0) {
        return None;
    }
    let radiance_over_pdf = emission.radiance * (cos_light * area / distance_squared);
    Some(LightSample { wi, radiance_over_pdf, end: ShadowEnd::At(point) })
}

/// Uniform in the cone that the sphere fills as seen from `x`; from inside, where only a two-sided lamp shines, in all
/// directions.
fn sample_sphere(x: Vec3, sphere: Sphere, emission: Emission, u: [f32; 2]) -> Option<LightSample> {
    let to_center = sphere.center - x;
    let distance_squared = to_center.length_squared();
    let radius_squared = sphere.radius * sphere.radius;
    if distance_squared <= radius_squared {
        return emission.two_sided.then(|| sample_sphere_from_inside(x, sphere, emission, u));
    }
    let sin2 = radius_squared / distance_squared;
    let one_minus_cos = sin2 / (1.0 + (1.0 - sin2).sqrt());
    let axis = to_center / distance_squared.sqrt();
    let wi = sampling::to_world(sampling::cone(one_minus_cos, u), axis);
    // the nearest of the two meetings; at the rim, rounding may find none, then the tangent point stands for it
    let along = to_center.dot(wi);
    let off_axis = (to_center - wi * along).length_squared();
    let near = x + wi * (along - (radius_squared - off_axis).max(0.0).sqrt());
    let point = SurfacePoint::on_sphere(sphere.center, sphere.radius, near);
    let radiance_over_pdf = emission.radiance / sampling::cone_pdf(one_minus_cos);
    Some(LightSample { wi, radiance_over_pdf, end: ShadowEnd::At(point) })
}

fn sample_sphere_from_inside(x: Vec3, sphere: Sphere, emission: Emission, u: [f32; 2]) -> LightSample {
    const WHOLE_SPHERE: f32 = 2.0;
    let wi = sampling::cone(WHOLE_SPHERE, u);
    let to_center = sphere.center - x;
    let along = to_center.dot(wi);
    let off_axis = (to_center - wi * along).length_squared();
    let far = x + wi * (along + (sphere.radius * sphere.radius - off_axis).max(0.0).sqrt());
    let point = SurfacePoint::on_sphere(sphere.center, sphere.radius, far);
    LightSample {
        wi,
        radiance_over_pdf: emission.radiance / sampling::cone_pdf(WHOLE_SPHERE),
        end: ShadowEnd::At(point),
    }
}

fn sample_sun(sun: Sun, u: [f32; 2]) -> LightSample {
    let one_minus_cos = sun.one_minus_cos();
    if one_minus_cos == 0.0 {
        return LightSample { wi: sun.towards, radiance_over_pdf: sun.irradiance, end: ShadowEnd::Infinity };
    }
    let wi = sampling::to_world(sampling::cone(one_minus_cos, u), sun.towards);
    LightSample { wi, radiance_over_pdf: sun.radiance() / sampling::cone_pdf(one_minus_cos), end: ShadowEnd::Infinity }
}

/// Radiance that a ray finds where it hits nothing: the sky, and the sun's disc unless it is a delta light. Measured by
/// the chord between unit vectors, which stays exact for a small sun where a cosine does not.
pub fn environment(sky: Vec3, sun: Option<&SunDisc>, direction: Vec3) -> Vec3 {
    let Some(disc) = sun else { return sky };
    let inside = (direction - disc.towards).length_squared() < disc.chord_squared;
    sky + if inside { disc.radiance } else { Vec3::ZERO }
}

/// The visible disc of a sun.
#[derive(Debug, Clone, Copy)]
pub struct SunDisc {
    towards: Vec3,
    /// Square of the chord that spans the angular radius: `4 sin^2 (radius / 2)`.
    chord_squared: f32,
    radiance: Vec3,
}

impl SunDisc {
    /// The disc of a sun that has one.
    pub fn new(sun: &Sun) -> Option<Self> {
        let one_minus_cos = sun.one_minus_cos();
        (one_minus_cos > 0.0).then(|| SunDisc {
            towards: sun.towards,
            chord_squared: 2.0 * one_minus_cos,
            radiance: sun.radiance(),
        })
    }
}
