//! Glass whose index is below that of what is around it: beyond the critical angle it is a mirror from outside, in the
//! truth, for Whitted's trees and in the fake.

use film::Film;
use gpu::Gpu;
use pathtrace::{Integrator, PathSettings, Tracer, WhittedSettings};
use raster::{Fake, Raster, RasterSettings};
use scene::glam::Vec2;
use scene::{Bsdf, Scene, Texture, Vec3, builtin};
use std::path::Path;

const SIZE: u32 = 64;

/// A ball of radius 1 under a sky, over a floor that shines.
fn ball(material: &str, floor: &str) -> Scene {
    let text = format!(
        r#"
[camera]
eye = [0, 2, 30]
target = [0, 0, 0]
fov_y = 4.5
[sky]
radiance = [1, 1, 1]
[material.ball]
{material}
[material.floor]
emissive = {{ radiance = {floor}, two_sided = true }}
[[sphere]]
center = [0, 0, 0]
radius = 1
material = "ball"
[[rectangle]]
corner = [-50, -1.5, -50]
edge_u = [0, 0, 100]
edge_v = [100, 0, 0]
material = "floor"
"#
    );
    scene::parse(&text, "ball", Path::new("ball.toml")).expect("a scene")
}

fn bubble(ratio: f32, floor: &str) -> Scene {
    let mut scene = ball("dielectric = { ior = 1.5 }", floor);
    scene.set_refraction_ratio(ratio);
    scene
}

fn traced(scene: &Scene, integrator: &Integrator) -> Film {
    let mut film = Film::new(SIZE, SIZE);
    Tracer::new(scene).render(&mut film, &scene.camera, integrator, 1, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

fn integrators() -> [Integrator; 2] {
    let tree = WhittedSettings { depth: 32, ambient: Some(0.0), ..WhittedSettings::default() };
    [PathSettings::default().into(), tree.into()]
}

/// The sine of the angle at which a ray through a pixel's middle meets the ball.
fn sine_at(scene: &Scene, (x, y): (u32, u32)) -> f32 {
    let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / SIZE as f32;
    scene.camera.eye.cross(scene.camera.frame(1.0).direction(at)).length()
}

#[test]
fn what_grazes_a_bubble_is_reflected_as_by_a_mirror() {
    let ratio = 2.0;
    let floor = "[0.2, 0.5, 0.1]";
    let (bubble, mirror) = (bubble(ratio, floor), ball("mirror = { reflectance = [1, 1, 1] }", floor));
    for integrator in integrators() {
        let (seen, expected) = (traced(&bubble, &integrator), traced(&mirror, &integrator));
        let mut counts = [0, 0];
        for pixel in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            // a pixel is .037 wide: samples lie anywhere in it
            let sine = sine_at(&bubble, pixel);
            if sine > 1.0 / ratio + 0.03 && sine < 0.97 {
                let (seen, expected) = (seen.at(pixel.0, pixel.1), expected.at(pixel.0, pixel.1));
                assert!((seen - expected).abs().max_element() < 1e-5, "{pixel:?}: {seen} is not {expected}");
                counts[usize::from(expected.x < 0.5)] += 1;
            }
        }
        assert!(counts[0] > 50 && counts[1] > 50, "sky and floor are both reflected: {counts:?}");
        assert_ne!(seen.at(SIZE / 2, SIZE / 2), expected.at(SIZE / 2, SIZE / 2), "the middle lets light through");
    }
}

/// Where everything shines alike nothing is seen of any clear glass.
#[test]
fn no_ratio_of_the_slider_loses_light_or_makes_it() {
    for ratio in [0.4, 0.7, 1.0, 1.3, 2.5] {
        let [path, tree] = integrators().map(|integrator| traced(&bubble(ratio, "[1, 1, 1]"), &integrator));
        let off = path.radiances().map(|l| (l - 1.0).abs().max_element()).fold(0.0, f32::max);
        assert!(off < 1e-5, "ratio {ratio}: a path is off by {off}");
        // light that enters at all but the critical angle goes round inside for longer than a tree of 32 follows
        let lost = 1.0 - tree.mean()[0];
        assert!((-1e-6..1e-4).contains(&lost), "ratio {ratio}: trees lose {lost}");
    }
}

#[test]
fn the_fakes_bubble_looks_up_the_mirrored_direction_beyond_the_critical_angle() {
    let ratio = 1.6;
    let mut scene = builtin::named("whitted").expect("a built-in scene");
    scene.set_refraction_ratio(ratio);
    let glass = |m: &&scene::Material| matches!(m.bsdf, Bsdf::Dielectric { .. });
    let share = scene.materials.iter().find(glass).expect("glass").fake.reflectivity;
    let gpu = Gpu::headless().expect("a device");
    let settings = RasterSettings { fake: Fake::Fair, ..RasterSettings::new(1280, 720) };
    let film =
        Raster::new(&gpu).and_then(|mut raster| raster.render(&scene, &scene.camera, &settings)).expect("a film");
    assert_eq!((gpu.fault(), film.nonfinite), (None, 0));
    let (center, metal) = (Vec3::new(4.2, 2.6, -4.2), Vec3::new(2.0, 1.9, -2.5));
    let frame = scene.camera.frame(16.0 / 9.0);
    let board = scene.materials.iter().find_map(|m| match m.bsdf {
        Bsdf::Diffuse { albedo: Texture::Checkerboard(board) } => Some(board),
        _ => None,
    });
    let board = board.expect("a checkerboard");
    let (mut sky, mut cells) = (0, [0, 0]);
    for (x, y) in (0..720).flat_map(|y| (0..1280).map(move |x| (x, y))) {
        let d = frame.direction(Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / Vec2::new(1280.0, 720.0));
        let nearest = (center - scene.camera.eye).dot(d) * d - (center - scene.camera.eye);
        // sine of the angle at the far side, where the fake bends; a pixel changes it by .003
        let sine = nearest.length();
        if sine < 1.0 / ratio + 0.05 || sine > 0.95 {
            continue;
        }
        let normal = (nearest + d * (1.0 - sine * sine).sqrt()).normalize();
        let mirrored = d - 2.0 * d.dot(normal) * normal;
        let sees_the_metal = mirrored.dot((metal - center).normalize()) > 0.8;
        let found = film.at(x, y);
        if mirrored.y > 0.1 && !sees_the_metal {
            let expected = Vec3::ONE.lerp(scene.sky, share);
            assert!((found - expected).abs().max_element() < 0.01, "({x}, {y}): {found} is not {expected}");
            sky += 1;
        }
        let floor = center - mirrored * (center.y / mirrored.y);
        let in_cell = ((floor - board.origin) * board.cells_per_unit()).fract();
        let within = |t: f32| (0.3..0.7).contains(&t);
        if mirrored.y < -0.4 && !sees_the_metal && within(in_cell.x) && within(in_cell.z) && floor.z.abs() < 7.0 {
            // yellow and red differ in green alone, also in the shadow
            let even = board.at(floor) == board.even;
            assert_eq!(found.y > 0.3, even, "({x}, {y}) sees {floor}: {found}");
            cells[usize::from(even)] += 1;
        }
    }
    assert!(sky > 2000 && cells[0] > 100 && cells[1] > 100, "{sky} of the sky, {cells:?} of the floor");
}
