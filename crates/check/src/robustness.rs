//! Scenes scaled and moved, and geometry that is not what it should be.

use crate::area_lights::{RECTANGLE, direct};
use crate::hard::{known, spot};
use crate::measure::Trial;
use crate::meshes::Mesh;
use pathtrace::intersect::Ray;
use pathtrace::{Estimator, PathSettings, Tracer, WhittedSettings};
use scene::{Bsdf, Camera, Geometry, Scene, Shape, Texture, Vec3};
use std::path::Path;

/// The scene and camera, every point `p` now at `p * scale + shift`.
pub fn placed(mut scene: Scene, camera: Camera, scale: f32, shift: f32) -> (Scene, Camera) {
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
            Geometry::Mesh(_) | Geometry::Instance(_) => {
                let (positions, triangles) = shape.geometry.flat_triangles();
                let positions = positions.iter().map(|p| point(*p)).collect();
                shape.geometry = Geometry::mesh(positions, triangles.into_owned());
            }
        }
    }
    scene.shapes = shapes.into();
    (scene, Camera { eye: point(camera.eye), target: point(camera.target), ..camera })
}

/// What must not depend on size and place.
#[derive(Debug, Clone)]
pub struct Invariant {
    pub name: String,
    pub scene: Scene,
    pub camera: Camera,
    pub settings: PathSettings,
    /// By Whitted's trees instead: two branches have no noise.
    pub trees: Option<WhittedSettings>,
    pub expected: f64,
}

/// Scale, shift along every axis, and the relative difference that rounding of the coordinates allows. The first is
/// where scenes stand by themselves.
pub const PLACEMENTS: [(f32, f32, f64); 6] =
    [(1.0, 0.0, 0.0), (1e-4, 0.0, 1e-4), (1e4, 0.0, 1e-4), (1.0, 1e3, 3e-3), (1.0, 1e4, 5e-2), (1e3, 1e6, 3e-3)];

pub fn invariants() -> [Invariant; 4] {
    let (x, y, lambert) = RECTANGLE[2];
    let wide = |camera: Camera| Camera { fov_y: 0.5, ..camera };
    let over_floor = wide(spot(Vec3::new(x, y, 0.5), Vec3::new(x, y, 0.0)));
    let slanting = wide(spot(Vec3::new(3.0, 0.0, 3.0f32.sqrt()), Vec3::ZERO));
    let lit = known("rectangle-light");
    let furnace = known("closed-box");
    let whole = furnace.camera;
    let light = direct(Estimator::LIGHT);
    let glass = PathSettings { bounces: None, ..light };
    let trees = WhittedSettings { depth: 64, ambient: Some(0.0), ..WhittedSettings::default() };
    let one = |name: &str, (scene, camera), settings, expected| Invariant {
        name: name.to_owned(),
        scene,
        camera,
        settings,
        trees: None,
        expected,
    };
    [
        one("closed box", (furnace, whole), PathSettings::independent(), 1.0),
        one("rectangle light", (lit.clone(), over_floor), light, lambert),
        one("rectangle light, mis", (lit, over_floor), direct(Estimator::MIS), lambert),
        Invariant { trees: Some(trees), ..one("slab at 60 degrees", (known("slab"), slanting), glass, 0.8362324627) },
    ]
}

impl Invariant {
    /// Compares the means at all [`PLACEMENTS`].
    pub fn compare(&self, trial: &mut Trial, means: &[f64]) {
        let subject = format!("path {}", self.settings.estimator.name());
        let Some(&still) = means.first() else { return };
        for ((scale, shift, allowed), &mean) in PLACEMENTS.into_iter().zip(means) {
            let quantity = format!("{}, scale {scale}, moved {shift}", self.name);
            if (scale, shift) == (1.0, 0.0) {
                trial.equal(&subject, &quantity, self.expected, mean, 0.02 * self.expected);
            } else {
                trial.equal(&subject, &quantity, still, mean, allowed * still);
            }
        }
    }
}

pub fn invariance(trial: &mut Trial) {
    for invariant in invariants() {
        let means = PLACEMENTS.map(|(scale, shift, _)| {
            let (scene, camera) = placed(invariant.scene.clone(), invariant.camera, scale, shift);
            let seen = (&Tracer::new(&scene), &camera);
            let film = match &invariant.trees {
                Some(trees) => trial.film(seen, *trees, 8, 4),
                None => trial.film(seen, invariant.settings, 32, trial.pick(64, 512)),
            };
            film.mean()[0]
        });
        invariant.compare(trial, &means);
    }
}

/// The ray and the slivers of pbrt's test of bad triangles.
const BAD_CORNERS: [[f32; 3]; 3] = [
    [-1113.45459, -79.049614, -56.2431908],
    [-1113.45459, -87.0922699, -56.2431908],
    [-1113.45459, -79.2090149, -56.2431908],
];
const BAD_RAY: [[f32; 3]; 2] = [[-1081.47925, 99.9999542, 87.7701111], [-32.1072998, -183.355865, -144.607635]];

/// A mesh of triangles without area.
pub fn flat_triangles() -> Mesh {
    let mut positions = BAD_CORNERS.map(Vec3::from_array).to_vec();
    let mut triangles = vec![[0u32, 1, 2]];
    for i in 0..1000u32 {
        let u = pathtrace::sampling::sampler::Sampler::independent(i, 0, 21).unit4(0);
        let (a, along) = (Vec3::new(u[0], u[1], u[2]), Vec3::new(u[1], u[2], u[3]));
        let first = positions.len() as u32;
        // a repeated corner, or three in a row: exactly so in f32, by powers of two of an 8-bit vector
        let along = (along * 256.0).floor() / 256.0;
        let a = (a * 256.0).floor() / 256.0;
        positions.extend(if i % 2 == 0 { [a, a, a + along] } else { [a, a + along, a + along * 4.0] });
        triangles.push([first, first + 1, first + 2]);
    }
    Mesh { positions, triangles }
}

/// Rays at such triangles: pbrt's, and one at each corner.
pub fn rays_at_corners(positions: &[Vec3]) -> Vec<Ray> {
    let [o, d] = BAD_RAY.map(Vec3::from_array);
    let at = |(i, p): (usize, &Vec3)| {
        let from = Vec3::new(0.3, 0.4, 3.0 + i as f32);
        Ray::new(from, (*p - from).normalize())
    };
    [Ray::new(o, d.normalize())].into_iter().chain(positions.iter().enumerate().map(at)).collect()
}

pub fn degenerate(trial: &mut Trial) {
    let flat = flat_triangles();
    let tracer = flat.clone().tracer();
    let hits = rays_at_corners(&flat.positions).iter().filter(|ray| tracer.accel().closest(ray).is_some()).count();
    trial.equal("bvh2", "hits on triangles without area", 0.0, hits as f64, 0.0);
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

/// Triangles a millionth wide, between area light and floor but beside the point that is looked at; and what it looks
/// like.
pub fn under_slivers() -> (Scene, Camera, f64) {
    let mut scene = known("rectangle-light");
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..100u32 {
        let first = positions.len() as u32;
        let y = 0.8 + 0.002 * i as f32;
        positions.extend([Vec3::new(1.9, y, 0.2), Vec3::new(2.1, y, 0.2), Vec3::new(2.1, y + 1e-6, 0.2)]);
        triangles.push([first, first + 1, first + 2]);
    }
    scene.materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::splat(0.5)) };
    let thin = Shape { geometry: Geometry::mesh(positions, triangles), material: 0 };
    scene.shapes = scene.shapes.iter().cloned().chain([thin]).collect();
    let (x, y, expected) = RECTANGLE[2];
    (scene, spot(Vec3::new(x + 0.3, y, 0.1), Vec3::new(x, y, 0.0)), expected)
}

fn slivers(trial: &mut Trial) {
    let (scene, camera, expected) = under_slivers();
    let tracer = Tracer::new(&scene);
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        let settings = direct(estimator);
        trial.traced("under slivers 1e-6 wide", expected, (&tracer, &camera), settings);
    }
}
