//! Near and far planes of the fake: without stated ones nothing is cut, however near, small or large; stated ones are
//! obeyed, and told where they cut.

use check::{CASES, Effort, Machine, Runner, Verdict};
use film::Film;
use gpu::Gpu;
use raster::{Cut, Fake, Raster, RasterSettings, cut};
use scene::{Camera, Scene, Vec3, builtin};
use std::path::Path;
use std::sync::atomic::AtomicBool;

const SIZE: u32 = 48;

fn settings(fake: Fake) -> RasterSettings {
    RasterSettings { fake, ..RasterSettings::new(SIZE, SIZE) }
}

/// All devices: OpenGL takes depths to -1..1 on their way.
#[test]
fn the_fake_of_a_scene_is_the_same_at_any_scale_on_each_device() {
    let case: Vec<_> = CASES.iter().filter(|case| case.number == 30).copied().collect();
    for gpu in Gpu::each().unwrap() {
        let never = AtomicBool::new(false);
        let rows = Runner::new(Machine::Device(&gpu), Effort::Quick, &never).run(&case, |_, _| true).unwrap();
        let failed: Vec<_> = rows.iter().filter(|row| row.verdict == Verdict::Fail).map(ToString::to_string).collect();
        assert!(rows.len() > 30 && failed.is_empty(), "{}:\n{}", gpu.describe(), failed.join("\n"));
    }
}

/// A red floor 20 000 wide, a ball of radius 1000 on the horizon and one of a millimetre before the eye, all without
/// light but the sky's: a pixel's colour is its material's.
fn from_millimetres_to_miles() -> Scene {
    let text = r#"
        camera = { eye = [0, 0.001, 0], target = [0, 0.0009, -0.01], fov_y = 60 }
        sky = { radiance = [1, 1, 1] }
        material.floor = { diffuse.albedo = [0.5, 0, 0], fake.specular = 0 }
        material.small = { diffuse.albedo = [0, 0.5, 0], fake.specular = 0 }
        material.large = { diffuse.albedo = [0, 0, 0.5], fake.specular = 0 }
        sphere = [
            { center = [0.001, 0.001, -0.004], radius = 0.001, material = "small" },
            { center = [-1000, 500, -4000], radius = 1000, material = "large" },
        ]
        rectangle = [{ corner = [-10000, 0, 10000], edge_u = [20000, 0, 0], edge_v = [0, 0, -20000], material = "floor" }]
    "#;
    scene::parse(text, "from millimetres to miles", Path::new("miles.toml")).unwrap()
}

fn at(film: &Film, camera: &Camera, point: Vec3) -> Vec3 {
    let clip = camera.clip_from_world(1.0).project_point3(point);
    let pixel = |clip: f32| ((0.5 + 0.5 * clip) * SIZE as f32) as u32;
    film.at(pixel(clip.x), pixel(-clip.y))
}

const FLOOR: Vec3 = Vec3::new(0.5, 0.0, 0.0);
const SMALL: Vec3 = Vec3::new(0.0, 0.5, 0.0);
const LARGE: Vec3 = Vec3::new(0.0, 0.0, 0.5);

#[test]
fn what_is_a_millimetre_away_hides_what_is_miles_away() {
    let scene = from_millimetres_to_miles();
    for gpu in Gpu::each().unwrap() {
        let film = Raster::new(&gpu).unwrap().render(&scene, &scene.camera, &settings(Fake::Fair)).unwrap();
        let seen = |point| at(&film, &scene.camera, point);
        assert_eq!(seen(Vec3::new(0.001, 0.001, -0.004)), SMALL, "{}", gpu.describe());
        assert_eq!(seen(Vec3::new(-1000.0, 700.0, -4000.0)), LARGE);
        assert_eq!(seen(Vec3::new(0.0, 0.0, -0.003)), FLOOR);
        assert_eq!(seen(Vec3::new(-0.002, 0.0, -0.006)), FLOOR);
    }
}

/// One rasteriser, as in a window: planes follow the camera.
#[test]
fn a_dolly_towards_a_surface_never_cuts_it() {
    // the sky would be seen through a wall that is cut
    let text = r#"
        camera = { eye = [0, 1, 5], target = [0, 1, 0], fov_y = 40 }
        sky = { radiance = [1, 1, 1] }
        material.wall = { diffuse.albedo = [0.8, 0.2, 0.2] }
        rectangle = [{ corner = [-9, -9, 1], edge_u = [18, 0, 0], edge_v = [0, 18, 0], material = "wall" }]
    "#;
    let scene = scene::parse(text, "wall", Path::new("wall.toml")).unwrap();
    let wall = Vec3::new(0.8, 0.2, 0.2);
    for gpu in Gpu::each().unwrap() {
        let mut raster = Raster::new(&gpu).unwrap();
        for distance in [4.0, 0.3, 0.05, 1e-3, 1e-5] {
            let camera = Camera { eye: Vec3::new(0.0, 1.0, 1.0 + distance), ..scene.camera };
            for fake in Fake::ALL {
                let film = raster.render(&scene, &camera, &settings(fake)).unwrap();
                let middle = film.at(SIZE / 2, SIZE / 2);
                let expected = if fake == Fake::Fair { wall } else { as_taught(wall * scene.fake.ambient) };
                assert!((middle - expected).abs().max_element() < 1e-3, "{middle} from {distance}, {}", fake.name());
            }
        }
    }
}

/// A red floor in the plane y = 0 and a green ball of radius 1 at (0, 3, 0).
fn ball_above_floor(half_width: f32) -> Scene {
    let (corner, edge) = (-half_width, 2.0 * half_width);
    let text = format!(
        r#"
        camera = {{ eye = [0, 0, 8], target = [0, 1, 0], fov_y = 40 }}
        sky = {{ radiance = [1, 1, 1] }}
        material.floor = {{ diffuse.albedo = [0.5, 0, 0], fake.specular = 0 }}
        material.ball = {{ diffuse.albedo = [0, 0.5, 0], fake.specular = 0 }}
        sphere = [{{ center = [0, 3, 0], radius = 1, material = "ball" }}]
        rectangle = [
            {{ corner = [{corner}, 0, {corner}], edge_u = [0, 0, {edge}], edge_v = [{edge}, 0, 0], material = "floor" }},
        ]
        "#
    );
    scene::parse(&text, "ball above floor", Path::new("floor.toml")).unwrap()
}

/// From the very plane of the floor and from so near that f32 does not know the side, with a ball in view and with nothing
/// else: what is drawn is what is drawn without the floor, but for a pixel at its edge.
#[test]
fn a_plane_through_the_eye_hides_nothing() {
    let with_ball = ball_above_floor(40.0);
    let alone = Scene { shapes: with_ball.shapes[1..].into(), ..with_ball.clone() };
    for gpu in Gpu::each().unwrap() {
        let mut raster = Raster::new(&gpu).unwrap();
        for (scene, height, fake) in [(&with_ball, 0.0), (&with_ball, 1e-6), (&alone, 0.0), (&alone, -1e-6)]
            .into_iter()
            .flat_map(|(scene, height)| Fake::ALL.map(|fake| (scene, height, fake)))
        {
            let camera = Camera { eye: Vec3::new(0.0, height, 8.0), ..scene.camera };
            let without = Scene { shapes: scene.shapes[..scene.shapes.len() - 1].into(), ..scene.clone() };
            let mut draw = |scene| raster.render(scene, &camera, &settings(fake)).unwrap();
            let (seen, expected) = (draw(scene), draw(&without));
            let differs = |&(x, y): &(u32, u32)| (seen.at(x, y) - expected.at(x, y)).abs().max_element() > 1e-3;
            let count = (0..SIZE * SIZE).map(|i| (i % SIZE, i / SIZE)).filter(differs).count();
            assert!(count <= SIZE as usize, "{count} pixels from {height}, {}, {}", fake.name(), gpu.describe());
        }
    }
}

#[test]
fn a_floor_however_wide_takes_nothing_from_before_the_eye() {
    for gpu in Gpu::each().unwrap() {
        let mut raster = Raster::new(&gpu).unwrap();
        for half_width in [1e2, 1e6, 1e9, 1e11] {
            let scene = ball_above_floor(half_width);
            let camera = Camera { eye: Vec3::new(0.0, 2.0, 5.0), target: Vec3::new(0.0, 3.0, 0.0), ..scene.camera };
            for fake in Fake::ALL {
                let film = raster.render(&scene, &camera, &settings(fake)).unwrap();
                let (seen, ball) = (film.at(SIZE / 2, SIZE / 2), Vec3::new(0.0, 0.5, 0.0));
                let expected = if fake == Fake::Fair { ball } else { as_taught(ball * scene.fake.ambient) };
                assert!((seen - expected).abs().max_element() < 1e-3, "{seen}, {half_width}, {}", fake.name());
            }
        }
    }
}

/// The light of the byte that is drawn.
fn as_taught(colour: Vec3) -> Vec3 {
    colour.map(|channel| film::colour::srgb_decode((255.0 * channel).round() / 255.0))
}

#[test]
fn stated_planes_are_obeyed_and_told_where_they_cut() {
    let mut scene = from_millimetres_to_miles();
    scene.camera.target = Vec3::new(0.001, 0.001, -0.004);
    let mut raster = Raster::new(&Gpu::headless().unwrap()).unwrap();
    let mut seen = |near, far| {
        let camera = Camera { near, far, ..scene.camera };
        let film = raster.render(&scene, &camera, &settings(Fake::Fair)).unwrap();
        let points = [Vec3::new(0.001, 0.0016, -0.004), Vec3::new(-1000.0, 700.0, -4000.0)];
        (points.map(|point| at(&film, &camera, point)), cut(&scene, &camera, &settings(Fake::Fair)))
    };
    let sky = scene.sky;
    assert_eq!(seen(None, None), ([SMALL, LARGE], None));
    assert_eq!(seen(Some(1e-4), Some(1e5)), ([SMALL, LARGE], None));
    // behind both balls lies sky
    assert_eq!(seen(Some(0.1), None), ([sky, LARGE], Some(Cut { near: Some(0.1), far: None })));
    assert_eq!(seen(None, Some(2000.0)), ([SMALL, sky], Some(Cut { near: None, far: Some(2000.0) })));
    assert_eq!(seen(Some(0.1), Some(2000.0)), ([sky, sky], Some(Cut { near: Some(0.1), far: Some(2000.0) })));
}

/// The fair fake's sun lies at infinity: what stands behind the place from which the shadow map looks casts too.
#[test]
fn what_lies_behind_the_lights_place_casts_a_shadow_too() {
    let mut scene = builtin::named("hard/ball-on-floor").unwrap();
    scene.sun.as_mut().unwrap().towards = Vec3::Y;
    scene.camera.eye = Vec3::new(0.0, 2.0, 6.0);
    scene.fake.light_position = Some(Vec3::new(0.0, 0.5, 0.0));
    let mut raster = Raster::new(&Gpu::headless().unwrap()).unwrap();
    let film = raster.render(&scene, &scene.camera, &settings(Fake::Fair)).unwrap();
    let shadowed = at(&film, &scene.camera, Vec3::new(0.0, 0.0, 0.9));
    assert!((shadowed - Vec3::splat(0.3)).abs().max_element() < 1e-4, "{shadowed}");
}
