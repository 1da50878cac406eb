//! Random numbers, what they are turned into, and the densities that go with it.

use crate::hard::{known, with_geometry};
use crate::measure::Trial;
use crate::meshes::any_direction;
use crate::warps::{COLUMNS, Histogram, ROWS, alike};
use pathtrace::bsdf::Interface;
use pathtrace::intersect::Ray;
use pathtrace::light::{ShadowEnd, SphericalRectangle};
use pathtrace::sampling::sampler::Sampler;
use pathtrace::sampling::{self, rng};
use pathtrace::{SamplerKind, Tracer};
use scene::{Geometry, Scene, Vec3};
use std::f64::consts::TAU;

/// Standard deviations that chi-square may exceed: .01 shared by 16 runs, after Sidak.
const MOST_DEVIATION: f64 = 3.23;

fn azimuth(w: Vec3) -> f64 {
    (f64::from(w.y).atan2(f64::from(w.x)) / TAU).rem_euclid(1.0)
}

pub fn samplers(trial: &mut Trial) {
    words(trial);
    warps(trial);
    choices(trial);
    densities(trial);
    sobol(trial);
    streams(trial);
}

fn words(trial: &mut Trial) {
    trial.at_most("rng", "largest float", 1.0 - f64::from(f32::EPSILON) / 2.0, f64::from(rng::unit_float(u32::MAX)));
    for n in [[0.00038527316f32, 0.00038460016, -0.99999988079], [-0.00019813581, -0.00008946839, -0.99999988079]] {
        let n = Vec3::from_array(n);
        let (s, t) = sampling::orthonormal_basis(n);
        let [n, s, t] = [n, s, t].map(|v| v.as_dvec3());
        let lengths = [n, s, t].map(|v| (v.length() - 1.0).powi(2)).iter().sum::<f64>();
        let error = (lengths + n.dot(s).powi(2) + s.dot(t).powi(2) + t.dot(n).powi(2)) / 6.0;
        trial.at_most("sampling", &format!("error of the frame at {n}"), 1e-10, error);
    }
    let last = 1.0 - f32::EPSILON / 2.0;
    let mut bad = 0;
    for u in [[0.0, 0.0], [last, last], [0.0, last], [last, 0.0]] {
        let directions = [sampling::uniform_hemisphere(u), sampling::cosine_hemisphere(u), any_direction(u)];
        let cones = [sampling::cone(1e-6, u), sampling::cone(1e-12, u), sampling::cone(0.3, u)];
        bad += directions.iter().chain(&cones).filter(|w| !((w.length() - 1.0).abs() < 1e-6)).count();
        bad += usize::from(!sampling::disk(u).is_finite() || sampling::disk(u).length() > 1.0);
        bad += sampling::triangle(u).iter().filter(|b| !(0.0..=1.0).contains(*b)).count();
        let seen = SphericalRectangle::new(Vec3::new(0.3, 0.4, 0.5), Vec3::ZERO, Vec3::X, Vec3::Y);
        bad += seen.sample(u).iter().filter(|s| !(0.0..=1.0).contains(*s)).count();
    }
    trial.equal("sampling", "bad results at the ends of the random numbers", 0.0, bad as f64, 0.0);
}

fn warps(trial: &mut Trial) {
    let n = trial.pick(250_000, 1_000_000);
    let ring = |w: Vec3, cumulative: f64| [cumulative, azimuth(w)];
    let mut test = |what: &str, histogram: Histogram| {
        let quantity = format!("chi-square, {what}, standard deviations");
        trial.at_most("sampling", &quantity, MOST_DEVIATION, histogram.deviation());
    };
    test(
        "cosine hemisphere",
        Histogram::of_square(
            n,
            |u| {
                let w = sampling::cosine_hemisphere([u[0], u[1]]);
                ring(w, 1.0 - f64::from(w.z).powi(2))
            },
            alike,
        ),
    );
    test(
        "uniform hemisphere",
        Histogram::of_square(
            n,
            |u| {
                let w = sampling::uniform_hemisphere([u[0], u[1]]);
                ring(w, 1.0 - f64::from(w.z))
            },
            alike,
        ),
    );
    test(
        "cone",
        Histogram::of_square(
            n,
            |u| {
                let w = sampling::cone(0.3, [u[0], u[1]]);
                ring(w, (1.0 - f64::from(w.z)) / 0.3)
            },
            alike,
        ),
    );
    test(
        "sphere",
        Histogram::of_square(
            n,
            |u| {
                let w = any_direction([u[0], u[1]]);
                ring(w, (1.0 - f64::from(w.z)) / 2.0)
            },
            alike,
        ),
    );
    test(
        "disk",
        Histogram::of_square(
            n,
            |u| {
                let p = sampling::disk([u[0], u[1]]);
                ring(p, f64::from(p.length_squared()))
            },
            alike,
        ),
    );
    let seen = SphericalRectangle::new(Vec3::new(0.3, 0.4, 0.2), Vec3::ZERO, Vec3::X, Vec3::Y);
    let cell = |row: usize, column: usize| {
        let corner = Vec3::new(row as f32 / ROWS as f32, column as f32 / COLUMNS as f32, 0.0);
        let size = [1.0 / ROWS as f32, 1.0 / COLUMNS as f32];
        let part = SphericalRectangle::new(Vec3::new(0.3, 0.4, 0.2), corner, Vec3::X * size[0], Vec3::Y * size[1]);
        f64::from(part.solid_angle() / seen.solid_angle())
    };
    test("rectangle by solid angle", Histogram::of_square(n, |u| seen.sample([u[0], u[1]]).map(f64::from), cell));
    test(
        "triangle",
        Histogram::of_square(
            n,
            |u| {
                let [a, b, _] = sampling::triangle([u[0], u[1]]);
                [f64::from(a), f64::from(b)]
            },
            half_cell,
        ),
    );
}

/// Share of the triangle below the square's diagonal that lies in a cell.
fn half_cell(row: usize, column: usize) -> f64 {
    let (width, height) = (1.0 / ROWS as f64, 1.0 / COLUMNS as f64);
    let bottom = column as f64 * height;
    let slices = 1000;
    let slice = |i: usize| {
        let x = (row as f64 + (i as f64 + 0.5) / f64::from(slices)) * width;
        (1.0 - x - bottom).clamp(0.0, height)
    };
    2.0 * width / f64::from(slices) * (0..slices as usize).map(slice).sum::<f64>()
}

fn choices(trial: &mut Trial) {
    let n = trial.pick(250_000, 1_000_000);
    let lights = Tracer::new(&known("closed-box"));
    let probabilities: Vec<f64> =
        (0..lights.lights().len()).map(|i| f64::from(lights.lights().probability(i))).collect();
    let deviation = Histogram::of_bins(n, probabilities, |u| lights.lights().choose(u[2])).deviation();
    trial.at_most("sampling", "chi-square, choice of a light", MOST_DEVIATION, deviation);
    let reflected = Interface { ior: 1.5, entering: true }.fresnel(80f32.to_radians().cos());
    let probabilities = vec![f64::from(reflected), 1.0 - f64::from(reflected)];
    let deviation = Histogram::of_bins(n, probabilities, |u| usize::from(u[3] >= reflected)).deviation();
    trial.at_most("sampling", "chi-square, Fresnel's choice", MOST_DEVIATION, deviation);
}

/// Scenes of one area light, and a point that sees it.
fn area_lights() -> Vec<(&'static str, Scene, Vec3)> {
    let point = Vec3::new(0.3, 0.2, 0.0);
    let only_area_light = |name: &str, geometry: Option<Geometry>| {
        let mut scene = known(name);
        let area_light = |shape: &&scene::Shape| scene.material_of(shape).emission.is_some();
        scene.shapes = scene.shapes.iter().filter(area_light).cloned().collect();
        match geometry {
            None => scene,
            Some(geometry) => with_geometry(scene, |_, old| *old = geometry.clone()),
        }
    };
    let near = Geometry::Rectangle { corner: Vec3::new(-1.0, -0.5, 0.4), edge_u: Vec3::Y, edge_v: Vec3::X * 2.0 };
    let (positions, triangles) = near.flat_triangles();
    let halves = Geometry::mesh(positions.into_owned(), triangles.into_owned());
    vec![
        ("rectangle by area", only_area_light("rectangle-light", None), point),
        ("rectangle by solid angle", only_area_light("rectangle-light", Some(near)), point),
        ("mesh", only_area_light("rectangle-light", Some(halves)), point),
        (
            "disk",
            only_area_light("disk-touching", Some(Geometry::Disk { center: Vec3::Z, normal: -Vec3::Z, radius: 1.0 })),
            point,
        ),
        ("sphere", only_area_light("sphere-light", None), point),
        (
            "sphere almost touching",
            only_area_light("sphere-light", Some(Geometry::Sphere { center: Vec3::new(0.3, 0.2, 1.001), radius: 1.0 })),
            point,
        ),
    ]
}

/// The density integrates to 1 over the directions that meet an area light, and is the one that samples come with.
fn densities(trial: &mut Trial) {
    for (name, scene, point) in area_lights() {
        let tracer = Tracer::new(&scene);
        let side = trial.pick(700, 1500);
        let mut integral = 0.0;
        for i in 0..side {
            for j in 0..side {
                let z = 1.0 - 2.0 * (i as f32 + 0.5) / side as f32;
                let (sin, cos) = (std::f32::consts::TAU * (j as f32 + 0.5) / side as f32).sin_cos();
                let rest = (1.0 - z * z).sqrt();
                let Some(hit) = tracer.accel().first_met(&Ray::new(point, Vec3::new(rest * cos, rest * sin, z))) else {
                    continue;
                };
                integral += f64::from(tracer.lights().pdf(hit.light, point, &hit.point));
            }
        }
        integral *= 2.0 * TAU / f64::from(side * side);
        trial.equal("light", &format!("integral of the density, {name}"), 1.0, integral, trial.pick(3e-3, 1e-3));
        let (mut off, mut missed) = (0f64, 0u32);
        let samples = 20_000;
        for i in 0..samples {
            let u = Sampler::independent(22, i, 2).unit4(0);
            let Some(sample) = tracer.lights().sample(point, u[2], [u[0], u[1]]) else { continue };
            let ShadowEnd::AreaLight(end) = sample.end else { continue };
            match tracer.accel().first_met(&Ray::new(point, sample.wi)) {
                // at the rim of an area light, rounding may find the other side or nothing
                Some(hit) if (hit.point.position - end.position).length() < 1e-3 => {
                    let pdf = tracer.lights().pdf(hit.light, point, &hit.point);
                    off = off.max(f64::from((pdf / sample.pdf - 1.0).abs()));
                }
                _ => missed += 1,
            }
        }
        trial.at_most("light", &format!("density of samples against directions, {name}"), 2e-3, off);
        trial.at_most(
            "light",
            &format!("share of samples off the lamp, {name}"),
            0.002,
            f64::from(missed) / f64::from(samples),
        );
    }
}

fn sobol(trial: &mut Trial) {
    let mut wrong = 0u32;
    for (pixel, dimension, seed) in [(0, 0, 1), (7, 3, 9), (123_456, 2, 4)] {
        for m in 2..=10u32 {
            for split in 0..=m {
                let (columns, rows) = (1usize << split, 1usize << (m - split));
                let mut seen = vec![false; columns * rows];
                for sample in 0..1 << m {
                    let [x, y, ..] = Sampler { kind: SamplerKind::Sobol, pixel, sample, seed }.unit4(dimension);
                    let cell = (x * columns as f32) as usize * rows + (y * rows as f32) as usize;
                    wrong += u32::from(std::mem::replace(&mut seen[cell], true));
                }
            }
        }
    }
    trial.equal("sobol", "elementary intervals without exactly one point", 0.0, f64::from(wrong), 0.0);
}

fn streams(trial: &mut Trial) {
    let n = trial.pick(100_000u32, 1_000_000);
    for kind in SamplerKind::ALL {
        let mut largest = 0f64;
        for word in 0..4 {
            let number = |pixel, sample, dimension, seed| {
                f64::from(Sampler { kind, pixel, sample, seed }.unit4(dimension)[word]) - 0.5
            };
            for (pixel, dimension, seed) in [(8, 1, 3), (263, 1, 3), (7, 2, 3), (7, 1, 4)] {
                let products = (0..n).map(|s| number(7, s, 1, 3) * number(pixel, s, dimension, seed));
                largest = largest.max((12.0 * products.sum::<f64>() / f64::from(n)).abs());
            }
        }
        let bound = 4.0 / f64::from(n).sqrt();
        trial.at_most(kind.name(), "correlation of neighbouring pixels, dimensions, seeds", bound, largest);
    }
}
