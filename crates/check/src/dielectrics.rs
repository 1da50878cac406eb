//! Glass.

use crate::hard::{known, spot, with_geometry};
use crate::measure::{Trial, farthest, independent};
use pathtrace::bsdf::Interface;
use pathtrace::geometry::{Accel, Ray};
use pathtrace::{Estimator, PathSettings, Roulette, SamplerKind, Tracer, WhittedSettings};
use scene::{Geometry, Vec3};

const INTO_GLASS: Interface = Interface { ior: 1.5, entering: true };
const OUT_OF_GLASS: Interface = Interface { ior: 1.5, entering: false };

fn without_roulette() -> PathSettings {
    PathSettings { roulette: Roulette::OFF, ..independent() }
}

fn to_depth(depth: u32) -> WhittedSettings {
    WhittedSettings { depth, ambient: Some(0.0), ..WhittedSettings::default() }
}

pub fn fresnel(trial: &mut Trial) {
    let table = [
        (0.0f64, 0.04),
        (45.0, 0.05023991101),
        (60.0, 0.0891867128),
        (80.0, 0.3877043547),
        (89.0, 0.9041849498),
        (89.99, 0.9989858952),
    ];
    for (degrees, expected) in table {
        let measured = f64::from(INTO_GLASS.fresnel(degrees.to_radians().cos() as f32));
        trial.equal("fresnel", &format!("air to glass, {degrees} degrees"), expected, measured, 1e-6);
    }
    let critical = (1.0 / 1.5f64).asin();
    let near = [
        (1e-2, 0.4395760565, 2e-7),
        (1e-4, 0.9172379199, 2e-5),
        (1e-6, 0.9913495867, 5e-4),
        (1e-8, 0.9991310712, 2e-3),
    ];
    for (below, expected, tolerance) in near {
        let cosine = (critical - below).cos() as f32;
        // what rounding the cosine to f32 does by itself is not the formula's fault
        let given = exact_fresnel(f64::from(cosine), 1.0 / 1.5);
        let measured = f64::from(OUT_OF_GLASS.fresnel(cosine));
        let quantity = format!("glass to air, {below} rad below critical");
        trial.equal("fresnel", &quantity, expected, measured, tolerance + (given - expected).abs());
    }
    for degrees in [41.9f64, 60.0, 90.0] {
        let measured = f64::from(OUT_OF_GLASS.fresnel(degrees.to_radians().cos() as f32));
        trial.equal("fresnel", &format!("glass to air, {degrees} degrees"), 1.0, measured, 0.0);
    }
    trial.equal("fresnel", "air to glass, cosine 0", 1.0, f64::from(INTO_GLASS.fresnel(0.0)), 0.0);
    // 1.0001 itself is rounded by 2e-8, and the reflectance goes with the square of what exceeds 1
    let thin = Interface { ior: 1.0001, entering: true };
    let given = exact_fresnel(f64::from(89f64.to_radians().cos() as f32), f64::from(1.0001f32));
    let measured = f64::from(thin.fresnel(89f64.to_radians().cos() as f32));
    trial.equal("fresnel", "n = 1.0001, 89 degrees", 0.01574674889, measured, 1e-6 + (given - 0.01574674889).abs());
    let angle = 80f32.to_radians();
    let refracted = INTO_GLASS.refract(Vec3::new(angle.sin(), 0.0, angle.cos()), Vec3::Z).unwrap_or(Vec3::NAN);
    let measured = f64::from(refracted.x.abs()).atan2(f64::from(-refracted.z)).to_degrees();
    trial.equal("fresnel", "refracted angle at 80 degrees", 41.036411, measured, 1e-4);
}

/// Unpolarised reflectance in f64, by Fresnel's textbook form; `eta` is the index behind over the one before.
fn exact_fresnel(cos_i: f64, eta: f64) -> f64 {
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (eta * eta)).max(0.0).sqrt();
    let s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    0.5 * (s * s + p * p)
}

pub fn index_one(trial: &mut Trial) {
    let with = known("index-one");
    let mut without = with.clone();
    let solid = with.shapes.iter().filter(|shape| with.material_of(shape).name != "nothing");
    without.shapes = solid.cloned().collect();
    let (with, camera, without) = (Tracer::new(&with), with.camera, Tracer::new(&without));
    // one sample a pixel, in the same place of both pictures
    for estimator in [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS] {
        let settings = PathSettings { estimator, ..without_roulette() };
        let [a, b] = [&with, &without].map(|tracer| trial.path_film((tracer, &camera), &settings, 128, 1));
        let off = a.radiances().zip(b.radiances()).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f32::max);
        trial.at_most(&format!("path {}", estimator.name()), "largest difference", 1e-5, f64::from(off));
    }
    let mut turned = 0f32;
    for (i, entering) in (0..20_000).flat_map(|i| [(i, true), (i, false)]) {
        // cosines down to grazing, where the textbook's form is off by 1.65e-4
        let cosine = (i as f32 + 0.5) / 20_000.0;
        let wo = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
        let wi = Interface { ior: 1.0, entering }.refract(wo, Vec3::Z).unwrap_or(Vec3::INFINITY);
        let change = (wi + wo).abs().max_element();
        turned = turned.max(change);
    }
    trial.at_most("refraction", "largest change of direction at index 1", 1e-6, f64::from(turned));
    let [a, b] = [&with, &without].map(|tracer| trial.whitted_film((tracer, &camera), &to_depth(16), 128, 1));
    let off = a.radiances().zip(b.radiances()).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f32::max);
    trial.at_most("whitted", "largest difference", 1e-5, f64::from(off));
}

/// Angle in degrees and what passes of a slab n = 1.5, all inter-reflections counted.
const PASSES: [(f64, f64); 4] = [(0.0, 0.9230769231), (30.0, 0.9202655325), (60.0, 0.8362324627), (80.0, 0.4412291734)];
/// What passes after at most 0, 2 and 4 internal reflections, at 0 and 80 degrees.
const CAPPED: [(f64, [f64; 3]); 2] =
    [(0.0, [0.9216, 0.92307456, 0.923076919]), (80.0, [0.374905957, 0.431259821, 0.439730634])];

pub fn slab(trial: &mut Trial) {
    for thickness in [1.0f32, 1e-2, 1e-4] {
        let make = |behind: bool| {
            with_geometry(known("slab"), |_, geometry| match geometry {
                Geometry::Box { corner, size, .. } => (corner.z, size.z) = (-thickness, thickness),
                Geometry::Rectangle { corner, edge_u, .. } if !behind => {
                    // before the slab, and behind the camera
                    corner.z = 4.0;
                    (corner.x, *edge_u) = (-corner.x, -*edge_u);
                }
                _ => {}
            })
        };
        let (behind, before) = (Tracer::new(&make(true)), Tracer::new(&make(false)));
        for (degrees, passes) in PASSES {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let camera = spot(Vec3::new(2.0 * sin as f32, 0.0, 2.0 * cos as f32), Vec3::ZERO);
            for (tracer, expected, what) in [(&behind, passes, "passes"), (&before, 1.0 - passes, "is reflected")] {
                let quantity = format!("thickness {thickness}, {degrees} degrees, {what}");
                let film = trial.whitted_film((tracer, &camera), &to_depth(64), 4, 1);
                trial.equal("whitted", &quantity, expected, farthest(&film, expected), 1e-5);
                if thickness == 1e-4 || trial.full() {
                    trial.path(&quantity, expected, (tracer, &camera), &without_roulette());
                }
            }
        }
        for (degrees, table) in CAPPED {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let camera = spot(Vec3::new(2.0 * sin as f32, 0.0, 2.0 * cos as f32), Vec3::ZERO);
            for (reflections, expected) in [0, 2, 4].into_iter().zip(table) {
                let film = trial.whitted_film((&behind, &camera), &to_depth(2 + reflections), 4, 1);
                let quantity = format!("thickness {thickness}, {degrees} degrees, {reflections} internal reflections");
                trial.equal("whitted", &quantity, expected, farthest(&film, expected), 1e-5);
            }
        }
        // no wider than needed: a large box's points are known less well
        let small = Tracer::new(&with_geometry(make(true), |_, geometry| {
            if let Geometry::Box { corner, size, .. } = geometry {
                (corner.x, corner.y) = (-20.0 * thickness, -20.0 * thickness);
                (size.x, size.y) = (40.0 * thickness, 40.0 * thickness);
            }
        }));
        for (degrees, expected) in [(30.0f64, 0.193813782), (60.0, 0.512472013), (80.0, 0.83366385)] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let direction = Vec3::new(-sin as f32, 0.0, -cos as f32);
            let exit = refracted_through(small.accel(), Ray::new(-10.0 * thickness * direction, direction));
            // distance of the way out from the ray as it came
            let (end, direction) = (exit.origin.as_dvec3(), direction.as_dvec3().normalize());
            let measured = (end - direction * end.dot(direction)).length() / f64::from(thickness);
            let quantity = format!("thickness {thickness}, {degrees} degrees, shift");
            trial.equal("refraction", &quantity, expected, measured, 1e-5);
        }
    }
}

/// A ray that enters glass of index 1.5 and leaves it again, without reflections; it starts where it left.
fn refracted_through(accel: &Accel, mut ray: Ray) -> Ray {
    for interface in [INTO_GLASS, OUT_OF_GLASS] {
        let Some(hit) = accel.closest(&ray) else { return Ray::new(Vec3::NAN, Vec3::NAN) };
        let wo = -ray.direction;
        let normal = if interface.entering { hit.point.normal } else { -hit.point.normal };
        let wi = interface.refract(wo, normal).unwrap_or(Vec3::NAN).normalize();
        ray = Ray::new(hit.point.leaving_towards(wi), wi);
    }
    ray
}

pub fn through_a_sphere(trial: &mut Trial) {
    let tracer = Tracer::new(&known("glass-sphere-in-furnace"));
    let table = [
        (0.1f64, 3.833233496, 1e-6),
        (0.5, 21.05755873, 1e-6),
        (0.9, 54.57633918, 1e-6),
        (0.999, 91.3567056, 1e-5),
        (0.99999, 95.86792568, 1e-4),
    ];
    for (b, expected, tolerance) in table {
        let exit = refracted_through(tracer.accel(), Ray::new(Vec3::new(-2.0, b as f32, 0.0), Vec3::X));
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
    let near_axis = refracted_through(tracer.accel(), Ray::new(Vec3::new(-2.0, 1e-2, 0.0), Vec3::X));
    let focus = near_axis.origin.x - near_axis.origin.y / near_axis.direction.y * near_axis.direction.x - 1.0;
    trial.equal("refraction", "focus behind the rear pole", 0.5, f64::from(focus), 2e-4);
}

/// Degrees by which a sphere n = 1.5 turns a ray at impact parameter `b`.
fn deviation(b: f64) -> f64 {
    (2.0 * (b.asin() - (b / 1.5).asin())).to_degrees()
}

/// A camera far away that looks along -z past the axis at distance b.
fn beside_the_axis(b: f32) -> scene::Camera {
    spot(Vec3::new(b, 0.0, 3.0), Vec3::new(b, 0.0, 0.0))
}

pub fn furnace(trial: &mut Trial) {
    for name in ["glass-sphere-in-furnace", "nested-glass"] {
        let scene = known(name);
        let seen = (&Tracer::new(&scene), &scene.camera);
        for sampler in SamplerKind::ALL {
            let film = trial.path_film(seen, &PathSettings { sampler, ..without_roulette() }, 64, 16);
            let quantity = format!("every pixel, {name}, {}", sampler.name());
            trial.equal("path light", &quantity, 1.0, farthest(&film, 1.0), 1e-5);
        }
    }
    let tracer = Tracer::new(&known("glass-sphere-in-furnace"));
    for b in [0.0f32, 0.5, 0.9, 0.99] {
        let reflected = exact_fresnel((1.0 - f64::from(b).powi(2)).sqrt(), 1.5);
        for reflections in [0u32, 1, 3, 12] {
            let expected = 1.0 - (1.0 - reflected) * reflected.powi(reflections as i32 + 1);
            let film = trial.whitted_film((&tracer, &beside_the_axis(b)), &to_depth(2 + reflections), 4, 1);
            let quantity = format!("b = {b}, {reflections} internal reflections");
            trial.equal("whitted", &quantity, expected, farthest(&film, expected), 1e-5);
            let capped = PathSettings { bounces: Some(1 + reflections), ..without_roulette() };
            trial.path(&quantity, expected, (&tracer, &beside_the_axis(b)), &capped);
        }
    }
}

pub fn camera_inside(trial: &mut Trial) {
    let scene = known("camera-inside-glass");
    let seen = (&Tracer::new(&scene), &scene.camera);
    for roulette in [Roulette::OFF, Roulette::THROUGHPUT] {
        let film = trial.path_film(seen, &PathSettings { roulette, ..independent() }, 32, 16);
        trial.equal("path light", "every pixel", 1.0, farthest(&film, 1.0), 1e-5);
    }
    let film = trial.whitted_film(seen, &to_depth(64), 32, 1);
    trial.equal("whitted", "every pixel", 1.0, farthest(&film, 1.0), 1e-5);
}
