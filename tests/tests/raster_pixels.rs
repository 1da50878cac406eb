//! Pixels of the whole fake against closed forms: what is seen where, in which units, through which map.

use film::DisplayTransform;
use film::{Film, colour};
use gpu::Gpu;
use raster::{Fake, FakeKnobs, Raster, RasterSettings, Shading, shading};
use scene::glam::Vec2;
use scene::{Bsdf, Camera, Geometry, Scene, Sun, Texture, Vec3, builtin};
use std::f32::consts::PI;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;

/// Sub-pixel positions of the fair fake: 4x multisampling's rotated grid.
const GRID: [Vec2; 4] =
    [Vec2::new(0.375, 0.125), Vec2::new(0.875, 0.375), Vec2::new(0.125, 0.625), Vec2::new(0.625, 0.875)];

fn rendered(scene: &Scene, settings: RasterSettings) -> Film {
    let gpu = Gpu::headless().unwrap();
    let film = Raster::new(&gpu).unwrap().render(scene, &scene.camera, &settings).unwrap();
    assert_eq!((gpu.fault(), film.nonfinite), (None, 0));
    film
}

fn as_taught(width: u32, height: u32) -> RasterSettings {
    RasterSettings { fake: Fake::AsTaught, ..RasterSettings::new(width, height) }
}

fn bytes(film: &Film, (x, y): (u32, u32)) -> [i32; 3] {
    let [r, g, b, _] = DisplayTransform::default().rgba8(film.at(x, y)).map(i32::from);
    [r, g, b]
}

#[track_caller]
fn assert_bytes(film: &Film, pixel: (u32, u32), expected: [i32; 3], tolerance: i32) {
    let found = bytes(film, pixel);
    let off = (0..3).map(|c| (found[c] - expected[c]).abs()).max();
    assert!(off <= Some(tolerance), "{pixel:?} is {found:?}, not {expected:?} +- {tolerance}");
}

fn direction(camera: &Camera, film: &Film, at: Vec2) -> Vec3 {
    let size = Vec2::new(film.width() as f32, film.height() as f32);
    camera.frame(size.x / size.y).direction(at / size)
}

/// The pixel that sees a point.
fn pixel_of(camera: &Camera, film: &Film, point: Vec3) -> (u32, u32) {
    let clip = camera.clip_from_world(film.width() as f32 / film.height() as f32).project_point3(point);
    let (x, y) = ((0.5 + 0.5 * clip.x) * film.width() as f32, (0.5 - 0.5 * clip.y) * film.height() as f32);
    (x as u32, y as u32)
}

/// Where a ray meets the plane y = `height`.
fn on_plane(eye: Vec3, d: Vec3, height: f32) -> Vec3 {
    eye + d * ((height - eye.y) / d.y)
}

fn board(scene: &Scene) -> scene::material::Checkerboard {
    let mut boards = scene.materials.iter().filter_map(|m| match m.bsdf {
        Bsdf::Diffuse { albedo: Texture::Checkerboard(board) } => Some(board),
        _ => None,
    });
    boards.next().unwrap()
}

const YELLOW_LIT: Vec3 = Vec3::new(2.5, 0.0, -6.0);
const RED_LIT: Vec3 = Vec3::new(1.5, 0.0, -6.0);
const RED_SHADOWED: Vec3 = Vec3::new(1.7, 0.0, -3.8);

#[test]
fn as_taught_has_the_bytes_of_the_tutorials_picture() {
    let scene = builtin::named("whitted").unwrap();
    let film = rendered(&scene, as_taught(WIDTH, HEIGHT));
    let at = |point| pixel_of(&scene.camera, &film, point);
    // .3 and .9 lie half-way between two bytes: devices round them either way
    assert_bytes(&film, (100, 100), [76, 128, 229], 1);
    assert_bytes(&film, (640, 150), [94, 141, 232], 1);
    assert_bytes(&film, at(YELLOW_LIT), [207, 207, 1], 1);
    assert_bytes(&film, at(RED_LIT), [207, 1, 1], 1);
    assert_bytes(&film, at(RED_SHADOWED), [47, 0, 0], 1);
}

#[test]
fn as_taught_film_shows_exactly_the_bytes_that_were_drawn() {
    let scene = builtin::named("whitted").unwrap();
    let film = rendered(&scene, as_taught(320, 180));
    for (x, y) in (0..180).flat_map(|y| (0..320).map(move |x| (x, y))) {
        let shown = bytes(&film, (x, y)).map(|byte| colour::srgb_decode(byte as f32 / 255.0));
        assert_eq!(film.at(x, y).to_array(), shown);
    }
}

/// Where the floor is found through the fake's glass: refracted once at the far side, then looked up from the centre.
fn floor_through_glass(scene: &Scene, d: Vec3) -> Option<Vec3> {
    let (center, radius, ratio) = (Vec3::new(4.2, 2.6, -4.2), 1.0, 0.7);
    let to_center = center - scene.camera.eye;
    let along = to_center.dot(d);
    let half_chord = (radius * radius - (to_center.length_squared() - along * along)).sqrt();
    let exit = scene.camera.eye + d * (along + half_chord);
    let looked_up = shading::refract(d, (center - exit).normalize(), ratio);
    (half_chord > 0.2 && looked_up.y < -0.02).then(|| on_plane(center, looked_up, 0.0))
}

/// Pixels that see the middle part of a lit cell through the glass: the pixel and the point of the floor. Beside the
/// metal sphere and its shadow; the glass's own shadow, about (2.2, -3.8), is hidden from its cube map.
fn floor_pixels_through_glass(scene: &Scene, film: &Film) -> Vec<((u32, u32), Vec3)> {
    let board = board(scene);
    let pixels = (0..film.height()).flat_map(|y| (0..film.width()).map(move |x| (x, y)));
    let seen = pixels.filter_map(|(x, y)| {
        let d = direction(&scene.camera, film, Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
        floor_through_glass(scene, d).map(|p| ((x, y), p))
    });
    let plain = seen.filter(|(_, p)| {
        let in_cell = ((p - board.origin) * board.cells_per_unit()).fract();
        let inside = |t: f32| (0.25..0.75).contains(&t);
        p.x > -5.0 && p.x < 3.5 && p.z > -7.0 && p.z < -4.0 && inside(in_cell.x) && inside(in_cell.z)
    });
    let plain: Vec<_> = plain.collect();
    let yellow = plain.iter().filter(|(_, p)| board.at(*p) == board.even).count();
    let in_shadow = plain.iter().filter(|(_, p)| (p - Vec3::new(2.2, 0.0, -3.8)).length() < 0.9).count();
    assert!(yellow > 100 && plain.len() - yellow > 100 && in_shadow > 20, "{yellow} of {}, {in_shadow}", plain.len());
    plain
}

#[test]
fn glass_shows_what_lies_in_the_refracted_direction() {
    let scene = builtin::named("whitted").unwrap();
    let film = rendered(&scene, as_taught(WIDTH, HEIGHT));
    let board = board(&scene);
    for (pixel, p) in floor_pixels_through_glass(&scene, &film) {
        let expected = if board.at(p) == board.even { [212, 212, 26] } else { [212, 26, 26] };
        assert_bytes(&film, pixel, expected, 2);
    }
}

#[test]
fn fair_glass_shows_the_same_in_the_truths_units() {
    let scene = builtin::named("whitted").unwrap();
    let film = rendered(&scene, RasterSettings::new(WIDTH, HEIGHT));
    let (sun, board) = (scene.sun.unwrap(), board(&scene));
    for (pixel, p) in floor_pixels_through_glass(&scene, &film) {
        let (kd, v) = (board.at(p), (Vec3::new(4.2, 2.6, -4.2) - p).normalize());
        let lit = shading::three_blinn_phong(Vec3::Y, sun.towards, v, kd, 17.0 / 255.0, 30.0, sun.irradiance / PI);
        let expected = 0.1 + 0.9 * (kd * scene.sky + lit);
        let found = film.at(pixel.0, pixel.1);
        // yellow exceeds 1 by .03, which a device whose cube maps hold bytes cuts off
        assert!((found - expected).abs().max_element() < 0.03, "{pixel:?}: {found} is not {expected}");
    }
}

#[test]
fn fair_floor_is_sun_times_cosine_plus_sky_plus_highlight() {
    let scene = builtin::named("whitted").unwrap();
    let film = rendered(&scene, RasterSettings::new(WIDTH, HEIGHT));
    let (sun, board) = (scene.sun.unwrap(), board(&scene));
    for point in [YELLOW_LIT, RED_LIT, RED_SHADOWED] {
        let (x, y) = pixel_of(&scene.camera, &film, point);
        let mut expected = Vec3::ZERO;
        for sub in GRID {
            let d = direction(&scene.camera, &film, Vec2::new(x as f32, y as f32) + sub);
            let p = on_plane(scene.camera.eye, d, 0.0);
            let kd = board.at(p);
            let lit = shading::three_blinn_phong(Vec3::Y, sun.towards, -d, kd, 17.0 / 255.0, 30.0, sun.irradiance / PI);
            expected += 0.25 * (kd * scene.sky + if point == RED_SHADOWED { Vec3::ZERO } else { lit });
        }
        let found = film.at(x, y);
        let off = (found - expected).abs();
        assert!(off.cmple(expected.abs() * 1e-4 + 1e-6).all(), "{point}: {found} is not {expected}");
    }
}

/// Cells of the floor of `phong` within the highlights, and beside them.
const GLOSSY: [Vec3; 4] =
    [Vec3::new(1.5, 0.0, 1.5), Vec3::new(0.5, 0.0, 1.5), Vec3::new(1.5, 0.0, 0.5), Vec3::new(2.5, 0.0, -1.5)];

#[test]
fn highlights_follow_the_slides_formulas_with_the_knobs_coefficients() {
    let scene = builtin::named("phong").unwrap();
    let (sun, board) = (scene.sun.unwrap(), board(&scene));
    let (kd, ks, p, n, l) = (0.5, 0.4, 50.0, Vec3::Y, sun.towards);
    let knobs = FakeKnobs { diffuse: Some(kd), specular: Some(ks), shininess: Some(p), ..FakeKnobs::default() };
    let cosine_of_phong = |v: Vec3| (2.0 * n.dot(l) * n - l).dot(v);
    let cosine_of_blinn = |v: Vec3| n.dot((l + v).normalize());
    let models: [(Shading, &dyn Fn(Vec3) -> f32); 2] =
        [(Shading::Phong, &cosine_of_phong), (Shading::BlinnPhong, &cosine_of_blinn)];
    for (shading, cosine) in models {
        let film = rendered(&scene, RasterSettings { shading, knobs, ..RasterSettings::new(WIDTH, HEIGHT) });
        for point in GLOSSY {
            let (x, y) = pixel_of(&scene.camera, &film, point);
            let of_sample = |sub: Vec2| {
                let d = direction(&scene.camera, &film, Vec2::new(x as f32, y as f32) + sub);
                let colour = board.at(on_plane(scene.camera.eye, d, 0.0));
                let incident = sun.irradiance / PI;
                colour * scene.sky + kd * colour * incident * n.dot(l) + ks * incident * cosine(-d).max(0.0).powf(p)
            };
            let expected = GRID.into_iter().map(of_sample).sum::<Vec3>() / 4.0;
            let found = film.at(x, y);
            let off = (found - expected).abs().max_element();
            assert!(off < 1e-4, "{} at {point}: {found} is not {expected}", shading.name());
        }
    }
}

#[test]
fn without_diffuse_and_specular_light_ambient_light_is_all() {
    let scene = builtin::named("phong").unwrap();
    let board = board(&scene);
    let knobs = FakeKnobs { diffuse: Some(0.0), specular: Some(0.0), ..FakeKnobs::default() };
    for shading in [Shading::Phong, Shading::BlinnPhong] {
        let fair = rendered(&scene, RasterSettings { shading, knobs, ..RasterSettings::new(WIDTH, HEIGHT) });
        let taught = rendered(&scene, RasterSettings { shading, knobs, ..as_taught(WIDTH, HEIGHT) });
        for point in GLOSSY {
            let (x, y) = pixel_of(&scene.camera, &fair, point);
            assert_eq!(fair.at(x, y), board.at(point) * scene.sky, "{point}");
            let grey = (board.at(point) * scene.fake.ambient * 255.0).round();
            assert_bytes(&taught, (x, y), grey.to_array().map(|byte| byte as i32), 1);
        }
    }
}

/// What a student sees: more than a tenth of the picture differs by more than two steps of an 8-bit display.
#[test]
fn the_scene_phong_tells_phong_from_blinn_phong_and_burns_nothing() {
    let scene = builtin::named("phong").unwrap();
    let shown = |shading| {
        let film = rendered(&scene, RasterSettings { shading, ..RasterSettings::new(320, 180) });
        assert!(film.radiances().all(|l| l.max_element() < 1.0), "{} burns", shading.name());
        (0..180).flat_map(|y| (0..320).map(move |x| (x, y))).map(|at| bytes(&film, at)).collect::<Vec<_>>()
    };
    shown(Shading::Three);
    let (phong, blinn) = (shown(Shading::Phong), shown(Shading::BlinnPhong));
    let differs = |(a, b): &(&[i32; 3], &[i32; 3])| (0..3).any(|c| (a[c] - b[c]).abs() > 2);
    let share = phong.iter().zip(&blinn).filter(differs).count() as f32 / phong.len() as f32;
    assert!(share > 0.1, "{share} of the pixels");
}

#[test]
fn fair_area_light_is_the_one_sample_direct_light() {
    let scene = builtin::named("cornell").unwrap();
    let film = rendered(&scene, RasterSettings { shading: Shading::Phong, ..RasterSettings::new(256, 256) });
    let (radiance, area, area_light) = (30.0, 130.0 * 105.0, Vec3::new(278.0, 554.5, 278.0));
    // the middle of the floor, and the top of the short box, which casts shadows but none on itself
    for point in [Vec3::new(278.0, 1.0, 277.5), Vec3::new(180.0, 165.0, 140.0)] {
        let (x, y) = pixel_of(&scene.camera, &film, point);
        let d = direction(&scene.camera, &film, Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
        let to_area_light = area_light - on_plane(scene.camera.eye, d, point.y);
        let l = to_area_light.normalize();
        let irradiance_facing_the_area_light = Vec3::splat(radiance * area * l.y / to_area_light.length_squared());
        let kd = Vec3::splat(0.5);
        let expected = shading::phong(Vec3::Y, l, -d, kd, 17.0 / 255.0, 30.0, irradiance_facing_the_area_light / PI);
        let found = film.at(x, y);
        assert!(((found - expected) / expected).abs().max_element() < 1e-3, "{point}: {found} is not {expected}");
    }
    // the floor before the short box lies in its shadow, and without a sky that is black
    let (x, y) = pixel_of(&scene.camera, &film, Vec3::new(150.0, 1.0, 40.0));
    assert_eq!(film.at(x, y), Vec3::ZERO);
}

/// One matt sphere of radius 1 at the origin, lit from +x, seen along -z from far away.
fn lit_from_the_side(segments: u32) -> Scene {
    let mut scene = builtin::named("whitted").unwrap();
    let mut spheres = scene.shapes.iter().filter(|s| matches!(s.geometry, Geometry::Sphere { .. })).cloned();
    let mut sphere = spheres.next().expect("a sphere");
    sphere.geometry = Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 };
    scene.shapes = [sphere].into();
    let material = &mut scene.materials[scene.shapes[0].material];
    material.bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::splat(0.5)) };
    material.fake.specular = 0.0;
    scene.sun = Some(Sun { towards: Vec3::X, angular_radius: 0.0, irradiance: Vec3::splat(PI) });
    scene.sky = Vec3::splat(1e-3);
    scene.fake.light_position = None;
    scene.fake.shadow_half_width = None;
    scene.fake.segments = segments;
    scene.camera = Camera {
        eye: Vec3::new(0.0, 0.0, 100.0),
        target: Vec3::ZERO,
        up: Vec3::Y,
        fov_y: 1.5,
        near: Some(1.0),
        far: Some(200.0),
    };
    scene
}

#[test]
fn half_of_a_sphere_is_lit_from_the_side() {
    let scene = lit_from_the_side(16);
    let film = rendered(&scene, RasterSettings { shading: Shading::Phong, ..RasterSettings::new(256, 256) });
    let covered: Vec<_> = film.radiances().map(|l| l.x).filter(|l| (l - 1e-3).abs() > 1e-6).collect();
    let lit = covered.iter().filter(|&&l| l > 1.1 * 0.5e-3).count() as f32 / covered.len() as f32;
    assert!((lit - 0.5).abs() < 0.02, "{lit} of {} pixels", covered.len());
}

#[test]
fn a_matt_sphere_follows_lamberts_law() {
    let scene = lit_from_the_side(100);
    let film = rendered(&scene, RasterSettings { shading: Shading::Phong, ..RasterSettings::new(257, 257) });
    for x in [-0.9f32, -0.3, 0.1, 0.3, 0.5, 0.7, 0.9] {
        let n = Vec3::new(x, 0.2, (1.0 - x * x - 0.04).sqrt());
        let (column, row) = pixel_of(&scene.camera, &film, n);
        let d = direction(&scene.camera, &film, Vec2::new(column as f32 + 0.5, row as f32 + 0.5));
        // parallel rays but for a hundredth: the x of the ray's nearest point to the centre is the normal's x
        let nearest = scene.camera.eye - d * scene.camera.eye.dot(d);
        let expected = 0.5 * (nearest.x.max(0.0) + 1e-3);
        let found = film.at(column, row).x;
        assert!((found - expected).abs() < 0.01 * 0.5, "at {x}: {found} is not {expected}");
    }
}

#[test]
fn a_picture_beyond_the_devices_limit_is_refused_by_name() {
    let gpu = Gpu::headless().unwrap();
    let scene = builtin::named("cornell").unwrap();
    let mut raster = Raster::new(&gpu).unwrap();
    let limit = gpu.device.limits().max_texture_dimension_2d;
    let refused = raster.render(&scene, &scene.camera, &RasterSettings::new(limit + 1, 16)).unwrap_err().to_string();
    assert!(refused.contains(&format!("at most {limit} pixels")) && !refused.contains('\n'), "{refused}");
    assert!(raster.render(&scene, &scene.camera, &RasterSettings::new(0, 16)).is_err());
    assert!(raster.render(&scene, &scene.camera, &RasterSettings::new(16, 16)).is_ok());
    assert_eq!(gpu.fault(), None);
}

#[test]
fn a_rasteriser_that_is_used_again_draws_as_a_new_one() {
    let gpu = Gpu::headless().unwrap();
    let mut raster = Raster::new(&gpu).unwrap();
    let mut scene = builtin::named("whitted").unwrap();
    let cornell = builtin::named("cornell").unwrap();
    let settings = as_taught(160, 90);
    let before = raster.render(&scene, &scene.camera, &settings).unwrap();
    scene.set_refraction_ratio(0.9);
    let moved = raster.render(&scene, &scene.camera, &settings).unwrap();
    assert_ne!(moved, before);
    assert_eq!(moved, rendered(&scene, settings));
    assert_eq!(raster.render(&cornell, &cornell.camera, &settings).unwrap(), rendered(&cornell, settings));
    scene.set_refraction_ratio(0.7);
    assert_eq!(raster.render(&scene, &scene.camera, &settings).unwrap(), before);
}
