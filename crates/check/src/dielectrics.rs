//! Glass.

use crate::hard::{known, spot, with_geometry};
use crate::measure::{Trial, farthest};
use film::Film;
use pathtrace::bsdf::Interface;
use pathtrace::intersect::{Accel, Ray};
use pathtrace::{Estimator, PathSettings, Roulette, SamplerKind, Tracer, WhittedSettings};
use scene::{Camera, Geometry, Scene, Vec3};

const INTO_GLASS: Interface = Interface { ior: 1.5, entering: true };
const OUT_OF_GLASS: Interface = Interface { ior: 1.5, entering: false };

/// Independent samples of paths that end by themselves.
pub fn without_roulette() -> PathSettings {
    PathSettings { roulette: Roulette::OFF, ..PathSettings::independent() }
}

/// Whitted's trees without ambient light.
pub fn to_depth(depth: u32) -> WhittedSettings {
    WhittedSettings { depth, ambient: Some(0.0), ..WhittedSettings::default() }
}

/// What a surface reflects of light that meets it at one angle.
#[derive(Debug, Clone)]
pub struct Reflectance {
    pub interface: Interface,
    /// Of the angle.
    pub cosine: f32,
    quantity: String,
    expected: f64,
    tolerance: f64,
}

impl Reflectance {
    /// Compares what a device says.
    pub fn compare(&self, trial: &mut Trial, measured: f32) {
        trial.equal("fresnel", &self.quantity, self.expected, f64::from(measured), self.tolerance);
    }
}

/// The Fresnel table.
pub fn reflectances() -> Vec<Reflectance> {
    let table = [
        (0.0f64, 0.04),
        (45.0, 0.05023991101),
        (60.0, 0.0891867128),
        (80.0, 0.3877043547),
        (89.0, 0.9041849498),
        (89.99, 0.9989858952),
    ];
    let cos = |degrees: f64| degrees.to_radians().cos() as f32;
    let one = |interface, cosine, quantity: String, expected, tolerance| Reflectance {
        interface,
        cosine,
        quantity,
        expected,
        tolerance,
    };
    let into =
        |(degrees, expected)| one(INTO_GLASS, cos(degrees), format!("air to glass, {degrees} degrees"), expected, 1e-6);
    let critical = (1.0 / 1.5f64).asin();
    let near = [
        (1e-2, 0.4395760565, 2e-7),
        (1e-4, 0.9172379199, 2e-5),
        (1e-6, 0.9913495867, 5e-4),
        (1e-8, 0.9991310712, 2e-3),
    ];
    let near_critical = |(below, expected, tolerance): (f64, f64, f64)| {
        let cosine = (critical - below).cos() as f32;
        // what rounding the cosine to f32 does by itself is not the formula's fault
        let rounded = (exact_fresnel(f64::from(cosine), 1.0 / 1.5) - expected).abs();
        let quantity = format!("glass to air, {below} rad below critical");
        one(OUT_OF_GLASS, cosine, quantity, expected, tolerance + rounded)
    };
    let beyond = |degrees: f64| one(OUT_OF_GLASS, cos(degrees), format!("glass to air, {degrees} degrees"), 1.0, 0.0);
    let grazing = one(INTO_GLASS, 0.0, "air to glass, cosine 0".to_owned(), 1.0, 0.0);
    // 1.0001 itself is rounded by 2e-8, and the reflectance goes with the square of what exceeds 1
    let (ior, expected) = (1.0001f32, 0.01574674889);
    let rounded = (exact_fresnel(f64::from(cos(89.0)), f64::from(ior)) - expected).abs();
    let quantity = "n = 1.0001, 89 degrees".to_owned();
    let faint = one(Interface { ior, entering: true }, cos(89.0), quantity, expected, 1e-6 + rounded);
    let most = table.map(into).into_iter().chain(near.map(near_critical)).chain([41.9, 60.0, 90.0].map(beyond));
    most.chain([grazing, faint]).collect()
}

/// Against light that meets a surface of normal +z at 80 degrees.
pub fn at_80_degrees() -> Vec3 {
    let angle = 80f32.to_radians();
    Vec3::new(angle.sin(), 0.0, angle.cos())
}

/// Compares the direction in which such light goes on inside of glass.
pub fn compare_angle(trial: &mut Trial, refracted: Vec3) {
    let measured = f64::from(refracted.x.abs()).atan2(f64::from(-refracted.z)).to_degrees();
    trial.equal("fresnel", "refracted angle at 80 degrees", 41.036411, measured, 1e-4);
}

pub fn fresnel(trial: &mut Trial) {
    for one in reflectances() {
        one.compare(trial, one.interface.fresnel(one.cosine));
    }
    compare_angle(trial, INTO_GLASS.refract(at_80_degrees(), Vec3::Z).unwrap_or(Vec3::NAN));
}

/// Unpolarised reflectance in f64, by Fresnel's textbook form; `eta` is the index behind over the one before.
fn exact_fresnel(cos_i: f64, eta: f64) -> f64 {
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (eta * eta)).max(0.0).sqrt();
    let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (s * s + p * p)
}

/// The scene with glass of index 1, and without.
pub fn with_and_without() -> [Scene; 2] {
    let with = known("index-one");
    let mut without = with.clone();
    let solid = with.shapes.iter().filter(|shape| with.material_of(shape).name != "nothing");
    without.shapes = solid.cloned().collect();
    [with, without]
}

/// The largest difference of two pictures' pixels.
pub fn apart(a: &Film, b: &Film) -> f64 {
    let off = a.radiances().zip(b.radiances()).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f32::max);
    f64::from(off)
}

/// Against light that meets a surface of normal +z: with cosines down to grazing, where the textbook's form of Snell's
/// law is off by 1.65e-4.
pub fn down_to_grazing() -> impl Iterator<Item = Vec3> {
    (0..20_000).map(|i| {
        let cosine = (i as f32 + 0.5) / 20_000.0;
        Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine)
    })
}

pub fn index_one(trial: &mut Trial) {
    let [with, without] = with_and_without();
    let (with, camera, without) = (Tracer::new(&with), with.camera, Tracer::new(&without));
    // one sample a pixel, in the same place of both pictures
    for estimator in [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS] {
        let settings = PathSettings { estimator, ..without_roulette() };
        let [a, b] = [&with, &without].map(|tracer| trial.film((tracer, &camera), settings, 128, 1));
        trial.at_most(&format!("path {}", estimator.name()), "largest difference", 1e-5, apart(&a, &b));
    }
    let mut turned = 0f32;
    for (wo, entering) in down_to_grazing().flat_map(|wo| [(wo, true), (wo, false)]) {
        let wi = Interface { ior: 1.0, entering }.refract(wo, Vec3::Z).unwrap_or(Vec3::INFINITY);
        let change = (wi + wo).abs().max_element();
        turned = turned.max(change);
    }
    trial.at_most("refraction", "largest change of direction at index 1", 1e-6, f64::from(turned));
    let [a, b] = [&with, &without].map(|tracer| trial.film((tracer, &camera), to_depth(16), 128, 1));
    trial.at_most("whitted", "largest difference", 1e-5, apart(&a, &b));
}

/// Angle in degrees and what passes of a slab n = 1.5, all inter-reflections counted.
pub const PASSES: [(f64, f64); 4] =
    [(0.0, 0.9230769231), (30.0, 0.9202655325), (60.0, 0.8362324627), (80.0, 0.4412291734)];
/// What passes after at most 0, 2 and 4 internal reflections, at 0 and 80 degrees.
pub const CAPPED: [(f64, [f64; 3]); 2] =
    [(0.0, [0.9216, 0.92307456, 0.923076919]), (80.0, [0.374905957, 0.431259821, 0.439730634])];

/// Internal reflections of [`CAPPED`].
pub const REFLECTIONS_OF_CAPPED: [u32; 3] = [0, 2, 4];

pub const THICKNESSES: [f32; 3] = [1.0, 1e-2, 1e-4];

/// A slab in light from behind it alone, or from before it.
pub fn slab_of(thickness: f32, behind: bool) -> Scene {
    with_geometry(known("slab"), |_, geometry| match geometry {
        Geometry::Box { corner, size, .. } => (corner.z, size.z) = (-thickness, thickness),
        Geometry::Rectangle { corner, edge_u, .. } if !behind => {
            // before the slab, and behind the camera
            corner.z = 4.0;
            (corner.x, *edge_u) = (-corner.x, -*edge_u);
        }
        _ => {}
    })
}

/// What looks at the slab from so far off its normal.
pub fn off_the_normal(degrees: f64) -> Camera {
    let (sin, cos) = degrees.to_radians().sin_cos();
    spot(Vec3::new(2.0 * sin as f32, 0.0, 2.0 * cos as f32), Vec3::ZERO)
}

/// Degrees, and how far a slab moves a ray that it lets through, over its thickness.
pub const SHIFTS: [(f64, f64); 3] = [(30.0, 0.193813782), (60.0, 0.512472013), (80.0, 0.83366385)];

/// A slab no wider than needed: a large box's points are known less well.
pub fn small_slab(thickness: f32) -> Scene {
    with_geometry(slab_of(thickness, true), |_, geometry| {
        if let Geometry::Box { corner, size, .. } = geometry {
            (corner.x, corner.y) = (-20.0 * thickness, -20.0 * thickness);
            (size.x, size.y) = (40.0 * thickness, 40.0 * thickness);
        }
    })
}

/// A ray at the slab from so far off its normal.
pub fn slanting_ray(thickness: f32, degrees: f64) -> Ray {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let direction = Vec3::new(-sin as f32, 0.0, -cos as f32);
    Ray::new(-10.0 * thickness * direction, direction)
}

/// Compares where such rays leave the slab.
pub fn compare_shifts(trial: &mut Trial, thickness: f32, exits: &[Ray]) {
    for ((degrees, expected), exit) in SHIFTS.into_iter().zip(exits) {
        // distance of the way out from the ray as it came
        let direction = slanting_ray(thickness, degrees).direction.as_dvec3().normalize();
        let end = exit.origin.as_dvec3();
        let measured = (end - direction * end.dot(direction)).length() / f64::from(thickness);
        let quantity = format!("thickness {thickness}, {degrees} degrees, shift");
        trial.equal("refraction", &quantity, expected, measured, 1e-5);
    }
}

pub fn slab(trial: &mut Trial) {
    for thickness in THICKNESSES {
        let (behind, before) = (Tracer::new(&slab_of(thickness, true)), Tracer::new(&slab_of(thickness, false)));
        for (degrees, passes) in PASSES {
            let camera = off_the_normal(degrees);
            for (tracer, expected, what) in [(&behind, passes, "passes"), (&before, 1.0 - passes, "is reflected")] {
                let quantity = format!("thickness {thickness}, {degrees} degrees, {what}");
                let film = trial.film((tracer, &camera), to_depth(64), 4, 1);
                trial.equal("whitted", &quantity, expected, farthest(&film, expected), 1e-5);
                if thickness == 1e-4 || trial.full() {
                    trial.traced(&quantity, expected, (tracer, &camera), without_roulette());
                }
            }
        }
        for (degrees, table) in CAPPED {
            let camera = off_the_normal(degrees);
            for (reflections, expected) in REFLECTIONS_OF_CAPPED.into_iter().zip(table) {
                let film = trial.film((&behind, &camera), to_depth(2 + reflections), 4, 1);
                let quantity = format!("thickness {thickness}, {degrees} degrees, {reflections} internal reflections");
                trial.equal("whitted", &quantity, expected, farthest(&film, expected), 1e-5);
            }
        }
        let small = Tracer::new(&small_slab(thickness));
        let exits = SHIFTS.map(|(degrees, _)| refracted_through(small.accel(), slanting_ray(thickness, degrees)));
        compare_shifts(trial, thickness, &exits);
    }
}

/// The way out of a ray that has met no glass.
pub const NOWHERE: Ray = Ray { origin: Vec3::NAN, direction: Vec3::NAN, tmax: 0.0 };

/// A ray that enters glass of index 1.5 and leaves it again, without reflections; it starts where it left.
fn refracted_through(accel: &Accel, mut ray: Ray) -> Ray {
    for interface in [INTO_GLASS, OUT_OF_GLASS] {
        let Some(hit) = accel.first_met(&ray) else { return NOWHERE };
        let wo = -ray.direction;
        let normal = if interface.entering { hit.point.normal } else { -hit.point.normal };
        let wi = interface.refract(wo, normal).unwrap_or(Vec3::NAN).normalize();
        ray = Ray::new(hit.point.leaving_towards(wi), wi);
    }
    ray
}

/// Impact parameters at a unit sphere n = 1.5, the degrees by which it turns such a ray, and the tolerance in radians.
const DEVIATIONS: [(f64, f64, f64); 5] = [
    (0.1, 3.833233496, 1e-6),
    (0.5, 21.05755873, 1e-6),
    (0.9, 54.57633918, 1e-6),
    (0.999, 91.3567056, 1e-5),
    (0.99999, 95.86792568, 1e-4),
];

/// Those rays, and one near the axis.
pub fn rays_at_the_sphere() -> Vec<Ray> {
    let parameters = DEVIATIONS.iter().map(|(b, ..)| *b as f32).chain([1e-2]);
    parameters.map(|b| Ray::new(Vec3::new(-2.0, b, 0.0), Vec3::X)).collect()
}

/// Compares how they leave it.
pub fn compare_exits(trial: &mut Trial, exits: &[Ray]) {
    for ((b, expected, tolerance), exit) in DEVIATIONS.into_iter().zip(exits) {
        let measured = f64::from(-exit.direction.y).atan2(f64::from(exit.direction.x)).to_degrees();
        // b itself is rounded to f32, which near the rim turns the ray by more than the formula does
        let given = deviation(f64::from(b as f32));
        let allowed = f64::to_degrees(tolerance) + (given - expected).abs();
        trial.equal("refraction", &format!("deviation at b = {b}, degrees"), expected, measured, allowed);
        if b == 0.5 || b == 0.9 {
            let point = if b == 0.5 { [0.98784499, 0.15544217] } else { [0.98604917, 0.16645430] };
            for (axis, expected) in point.into_iter().enumerate() {
                let quantity = format!("exit point at b = {b}, {}", ["x", "y"][axis]);
                trial.equal("refraction", &quantity, expected, f64::from(exit.origin[axis]), 2e-6);
            }
        }
    }
    let near_axis = exits.last().copied().unwrap_or(NOWHERE);
    let focus = near_axis.origin.x - near_axis.origin.y / near_axis.direction.y * near_axis.direction.x - 1.0;
    trial.equal("refraction", "focus behind the rear pole", 0.5, f64::from(focus), 2e-4);
}

pub fn through_a_sphere(trial: &mut Trial) {
    let tracer = Tracer::new(&known("glass-sphere-in-furnace"));
    let exits: Vec<Ray> = rays_at_the_sphere().into_iter().map(|ray| refracted_through(tracer.accel(), ray)).collect();
    compare_exits(trial, &exits);
}

/// Degrees by which a sphere n = 1.5 turns a ray at impact parameter `b`.
fn deviation(b: f64) -> f64 {
    (2.0 * (b.asin() - (b / 1.5).asin())).to_degrees()
}

/// A camera far away that looks along -z past the axis at distance b.
pub fn beside_the_axis(b: f32) -> Camera {
    spot(Vec3::new(b, 0.0, 3.0), Vec3::new(b, 0.0, 0.0))
}

/// Impact parameters at a glass sphere in a furnace.
pub const BESIDE_THE_AXIS: [f32; 4] = [0.0, 0.5, 0.9, 0.99];

/// Internal reflections after which branches and paths in it stop.
pub const REFLECTIONS: [u32; 4] = [0, 1, 3, 12];

/// Radiance after at most so many.
pub fn after(reflections: u32, b: f32) -> f64 {
    let reflected = exact_fresnel((1.0 - f64::from(b).powi(2)).sqrt(), 1.5);
    1.0 - (1.0 - reflected) * reflected.powi(reflections as i32 + 1)
}

pub fn furnace(trial: &mut Trial) {
    for name in ["glass-sphere-in-furnace", "nested-glass"] {
        let scene = known(name);
        let seen = (&Tracer::new(&scene), &scene.camera);
        for sampler in SamplerKind::ALL {
            let film = trial.film(seen, PathSettings { sampler, ..without_roulette() }, 64, 16);
            let quantity = format!("every pixel, {name}, {}", sampler.name());
            trial.equal("path light", &quantity, 1.0, farthest(&film, 1.0), 1e-5);
        }
    }
    let tracer = Tracer::new(&known("glass-sphere-in-furnace"));
    for b in BESIDE_THE_AXIS {
        for reflections in REFLECTIONS {
            let expected = after(reflections, b);
            let film = trial.film((&tracer, &beside_the_axis(b)), to_depth(2 + reflections), 4, 1);
            let quantity = format!("b = {b}, {reflections} internal reflections");
            trial.equal("whitted", &quantity, expected, farthest(&film, expected), 1e-5);
            let capped = PathSettings { bounces: Some(1 + reflections), ..without_roulette() };
            trial.traced(&quantity, expected, (&tracer, &beside_the_axis(b)), capped);
        }
    }
}

pub fn camera_inside(trial: &mut Trial) {
    let scene = known("camera-inside-glass");
    let seen = (&Tracer::new(&scene), &scene.camera);
    for roulette in [Roulette::OFF, Roulette::THROUGHPUT] {
        let film = trial.film(seen, PathSettings { roulette, ..PathSettings::independent() }, 32, 16);
        trial.equal("path light", "every pixel", 1.0, farthest(&film, 1.0), 1e-5);
    }
    let film = trial.film(seen, to_depth(64), 32, 1);
    trial.equal("whitted", "every pixel", 1.0, farthest(&film, 1.0), 1e-5);
}
