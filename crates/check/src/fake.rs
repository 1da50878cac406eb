//! Pixels of the rasterised fake that are known in closed form, by the CPU twins of its shaders, and the planes between
//! which it is drawn.

use crate::hard::known;
use crate::measure::Trial;
use crate::robustness::placed;
use film::colour;
use raster::planes::Planes;
use raster::shading::{blinn_phong, phong, refract};
use scene::{Bsdf, Camera, Scene, Texture, Vec3};
use std::f64::consts::PI;

pub fn closed_forms(trial: &mut Trial) {
    let (n, l, v) = (Vec3::Y, Vec3::new(1.0, 1.0, 0.0).normalize(), Vec3::new(-1.0, 2.0, 0.0).normalize());
    // ka = .1 is the caller's, kd = .6, ks = .3, p = 32
    let kd = Vec3::splat(0.6);
    let blinn = 0.1 + blinn_phong(n, l, v, kd, 0.3, 32.0, Vec3::ONE).x;
    let classic = 0.1 + phong(n, l, v, kd, 0.3, 32.0, Vec3::ONE).x;
    trial.equal("raster", "Blinn-Phong", 0.7221894682, f64::from(blinn), 1e-4);
    trial.equal("raster", "Phong", 0.5798546744, f64::from(classic), 1e-4);
    for p in [1.0f32, 10.0, 32.0, 100.0] {
        let expected = 2.0 * PI / (f64::from(p) + 2.0);
        trial.equal("raster", &format!("lobe's integral, p = {p}"), expected, lobe_integral(p), 1e-3 * expected);
    }
    for (b, short) in [(0.1f64, 1.916617), (0.5, 10.528779), (0.9, 27.288170)] {
        let d = Vec3::X;
        let front = Vec3::new(-(1.0 - b * b).sqrt() as f32, b as f32, 0.0);
        // front faces: the normal towards the viewer; back faces as taught: the far side's, turned to the viewer
        let back = Vec3::new(-(1.0 - b * b).sqrt() as f32, -(b as f32), 0.0);
        for (normal, sign, side) in [(front, 1.0, "front"), (back, -1.0, "back")] {
            let bent = refract(d, normal, 1.0 / 1.5);
            let towards_axis = f64::from(-bent.y).atan2(f64::from(bent.x)).to_degrees();
            let quantity = format!("degrees bent towards the axis by {side} faces, b = {b}");
            trial.equal("raster", &quantity, sign * short, towards_axis, 90.0 / 512.0);
        }
    }
    for (linear, byte) in [(0.0f32, 0.0), (0.5, 188.0), (1.0, 255.0)] {
        let encoded = f64::from(colour::srgb_encode(linear) * 255.0).round();
        trial.equal("display", &format!("sRGB of {linear}"), byte, encoded, 1.0);
    }
}

/// Of Phong's lobe times the cosine over the hemisphere, light along the normal: a midpoint sum over the renderer's own
/// function.
fn lobe_integral(p: f32) -> f64 {
    let n = 20_000;
    let step = 0.5 * PI / f64::from(n);
    let at = |i: u32| {
        let theta = (f64::from(i) + 0.5) * step;
        let v = Vec3::new(theta.sin() as f32, theta.cos() as f32, 0.0);
        let lobe = f64::from(phong(Vec3::Y, Vec3::Y, v, Vec3::ZERO, 1.0, p, Vec3::ONE).x);
        lobe * theta.cos() * theta.sin()
    };
    2.0 * PI * step * (0..n).map(at).sum::<f64>()
}

/// Scales at which the fake of a scene must be the one at scale 1.
pub const SCALES: [f32; 6] = [1e-6, 1e-3, 0.02, 1e3, 1e4, 1e6];

/// A scene at another scale: every length of it, those that only the fake reads too.
pub fn scaled(scene: &Scene, scale: f32) -> Scene {
    let (mut scene, camera) = placed(scene.clone(), scene.camera, scale, 0.0);
    scene.camera = Camera { near: camera.near.map(|d| d * scale), far: camera.far.map(|d| d * scale), ..camera };
    for material in &mut scene.materials {
        if let Bsdf::Diffuse { albedo: Texture::Checkerboard(board) } = &mut material.bsdf {
            (board.origin, board.cell) = (board.origin * scale, board.cell * scale);
        }
    }
    let fake = &mut scene.fake;
    fake.light_position = fake.light_position.map(|position| position * scale);
    fake.shadow_half_width = fake.shadow_half_width.map(|width| width * scale);
    scene
}

/// The planes that the fake is drawn between, without a device: what it sees at any scale has one depth.
pub fn planes_at_any_scale(trial: &mut Trial) {
    let depths = |scene: &Scene| {
        let planes = Planes::of(scene, &scene.camera, 1.0);
        let clip = planes.applied_to(scene.camera.clip_from_world(1.0));
        let front = scene.shapes[0].geometry.center() + Vec3::Z * scene.camera.eye.z * 0.2;
        (f64::from(clip.project_point3(front).z), f64::from(planes.near / (scene.camera.eye - front).length()))
    };
    let scene = known("ball-on-floor");
    let (still, _) = depths(&scene);
    for scale in SCALES {
        let (depth, nearness) = depths(&scaled(&scene, scale));
        trial.equal(
            "raster",
            &format!("depth of the ball's front over that at scale 1, scale {scale}"),
            1.0,
            depth / still,
            1e-5,
        );
        trial.at_most("raster", &format!("near plane over the ball's distance, scale {scale}"), 1.0, nearness);
    }
}
