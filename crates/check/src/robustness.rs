//! Scenes scaled and moved, and geometry that is not what it should be.

use crate::hard::{known, spot};
use crate::lamps::RECTANGLE;
use crate::measure::{Trial, independent};
use pathtrace::geometry::Ray;
use pathtrace::{Estimator, PathSettings, Roulette, Tracer, WhittedSettings};
use scene::{Bsdf, Camera, Geometry, Scene, Shape, Texture, Vec3};
use std::path::Path;

/// The scene and camera, every point `p` now at `p * scale + shift`.
fn placed(mut scene: Scene, camera: Camera, scale: f32, shift: f32) -> (Scene, Camera) {
    let point = |p: Vec3| p * scale + Vec3::splat(shift);
    let mut shapes = scene.shapes.to_vec();
    for shape in &mut shapes {
        match &mut shape.geometry {
            Geometry::Sphere { center, radius } | Geometry::Disk { center, radius, .. } => {
                (*center, *radius) = (point(*center), *radius * scale);
            }
            Geometry::Rectangle { corner, edge_u, edge_v } => {
                (*corner, *edge_u, *edge_v) = (point(*corner), *edge_u * scale, *edge_v * scale);
            }
            Geometry::Box { corner, size, .. } => (*corner, *size) = (point(*corner), *size * scale),
            Geometry::Mesh { positions, .. } => positions.iter_mut().for_each(|p| *p = point(*p)),
        }
    }
    scene.shapes = shapes.into();
    (scene, Camera { eye: point(camera.eye), target: point(camera.target), ..camera })
}

pub fn invariance(trial: &mut Trial) {
    let (x, y, lambert) = RECTANGLE[2];
    let wide = |camera: Camera| Camera { fov_y: 0.5, ..camera };
    let over_floor = wide(spot(Vec3::new(x, y, 0.5), Vec3::new(x, y, 0.0)));
    let slanting = wide(spot(Vec3::new(3.0, 0.0, 3.0f32.sqrt()), Vec3::ZERO));
    let furnace = known("closed-box");
    let camera = furnace.camera;
    let direct = PathSettings { bounces: Some(0), roulette: Roulette::OFF, ..independent() };
    let cases = [
        ("closed box", furnace, camera, independent(), 1.0),
        ("rectangle light", known("rectangle-light"), over_floor, direct, lambert),
        (
            "rectangle light, mis",
            known("rectangle-light"),
            over_floor,
            PathSettings { estimator: Estimator::MIS, ..direct },
            lambert,
        ),
        (
            "slab at 60 degrees",
            known("slab"),
            slanting,
            PathSettings { roulette: Roulette::OFF, ..direct },
            0.8362324627,
        ),
    ];
    for (name, scene, camera, settings, expected) in cases {
        let settings = if name.starts_with("slab") { PathSettings { bounces: None, ..settings } } else { settings };
        let subject = format!("path {}", settings.estimator.name());
        let mut still = None;
        for (scale, shift, allowed) in [
            (1.0f32, 0.0f32, 0.0),
            (1e-4, 0.0, 1e-4),
            (1e4, 0.0, 1e-4),
            (1.0, 1e3, 3e-3),
            (1.0, 1e4, 5e-2),
            (1e3, 1e6, 3e-3),
        ] {
            let (scene, camera) = placed(scene.clone(), camera, scale, shift);
            let tracer = Tracer::new(&scene);
            let mut mean = trial.path_film((&tracer, &camera), &settings, 32, trial.pick(64, 512)).mean()[0];
            let quantity = format!("{name}, scale {scale}, moved {shift}");
            if name.starts_with("slab") {
                // two branches have no noise
                let settings = WhittedSettings { depth: 64, ambient: Some(0.0), ..WhittedSettings::default() };
                mean = trial.whitted_film((&tracer, &camera), &settings, 8, 4).mean()[0];
            }
            match still {
                None => {
                    trial.equal(&subject, &quantity, expected, mean, 0.02 * expected);
                    still = Some(mean);
                }
                Some(still) => trial.equal(&subject, &quantity, still, mean, allowed * still),
            }
        }
    }
}

/// The ray and the slivers of pbrt's test of bad triangles.
const BAD_CORNERS: [[f32; 3]; 3] = [
    [-1113.45459, -79.049614, -56.2431908],
    [-1113.45459, -87.0922699, -56.2431908],
    [-1113.45459, -79.2090149, -56.2431908],
];
const BAD_RAY: [[f32; 3]; 2] = [[-1081.47925, 99.9999542, 87.7701111], [-32.1072998, -183.355865, -144.607635]];

pub fn degenerate(trial: &mut Trial) {
    let mut positions = BAD_CORNERS.map(Vec3::from_array).to_vec();
    let mut triangles = vec![[0u32, 1, 2]];
    for i in 0..1000u32 {
        let u = pathtrace::sampler::Sampler::independent(i, 0, 21).unit4(0);
        let (a, along) = (Vec3::new(u[0], u[1], u[2]), Vec3::new(u[1], u[2], u[3]));
        let first = positions.len() as u32;
        // a repeated corner, or three in a row: exactly so in f32, by powers of two of an 8-bit vector
        let along = (along * 256.0).floor() / 256.0;
        let a = (a * 256.0).floor() / 256.0;
        positions.extend(if i % 2 == 0 { [a, a, a + along] } else { [a, a + along, a + along * 4.0] });
        triangles.push([first, first + 1, first + 2]);
    }
    let mut scene = known("light-tight-box");
    let flat = Shape { geometry: Geometry::Mesh { positions: positions.clone(), triangles }, material: 0 };
    scene.shapes = vec![flat].into();
    let tracer = Tracer::new(&scene);
    let [o, d] = BAD_RAY.map(Vec3::from_array);
    let mut hits = u32::from(tracer.accel().closest(&Ray::new(o, d.normalize())).is_some());
    for (i, p) in positions.iter().enumerate() {
        let from = Vec3::new(0.3, 0.4, 3.0 + i as f32);
        hits += u32::from(tracer.accel().closest(&Ray::new(from, (*p - from).normalize())).is_some());
    }
    trial.equal("bvh2", "hits on triangles without area", 0.0, f64::from(hits), 0.0);
    trial.equal("bvh2", "triangles without area that are kept", 0.0, tracer.primitives() as f64, 0.0);
    refused(trial);
    slivers(trial);
}

/// A number that is not finite never gets past a scene file.
fn refused(trial: &mut Trial) {
    let text = scene::builtin::text("hard/light-tight-box").unwrap_or_default();
    let mut accepted = 0;
    for bad in ["nan", "inf", "-inf", "1e300"] {
        let broken = text.replacen("[1, 0, 0]", &format!("[{bad}, 0, 0]"), 1);
        accepted += u32::from(scene::parse(&broken, "broken", Path::new("broken.toml")).is_ok());
    }
    trial.equal("scene file", "corners not finite that are accepted", 0.0, f64::from(accepted), 0.0);
}

/// Triangles a millionth wide, between lamp and floor but beside the point that is looked at.
fn slivers(trial: &mut Trial) {
    let mut scene = known("rectangle-light");
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..100u32 {
        let first = positions.len() as u32;
        let y = 0.8 + 0.002 * i as f32;
        positions.extend([Vec3::new(1.9, y, 0.2), Vec3::new(2.1, y, 0.2), Vec3::new(2.1, y + 1e-6, 0.2)]);
        triangles.push([first, first + 1, first + 2]);
    }
    scene.materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::splat(0.5)) };
    let thin = Shape { geometry: Geometry::Mesh { positions, triangles }, material: 0 };
    scene.shapes = scene.shapes.iter().cloned().chain([thin]).collect();
    let (x, y, expected) = RECTANGLE[2];
    let camera = spot(Vec3::new(x + 0.3, y, 0.1), Vec3::new(x, y, 0.0));
    let tracer = Tracer::new(&scene);
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        let settings = PathSettings { estimator, bounces: Some(0), roulette: Roulette::OFF, ..independent() };
        trial.path("under slivers 1e-6 wide", expected, (&tracer, &camera), &settings);
    }
}
