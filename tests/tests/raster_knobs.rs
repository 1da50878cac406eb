//! The knobs of the fake, the maps that can be looked at in place of the picture, and what must not make it stumble.

use film::DisplayTransform;
use film::{Film, colour};
use gpu::Gpu;
use raster::{Fake, FakeKnobs, MOST_CUBE_MAPS, Raster, RasterError, RasterSettings, Shading, ShadowFilter, Show, maps};
use scene::glam::Vec2;
use scene::{Bsdf, Camera, Geometry, Scene, Shape, Vec3, builtin};

struct Studio {
    gpu: Gpu,
    raster: Raster,
}

impl Studio {
    fn new() -> Studio {
        let gpu = Gpu::headless().unwrap();
        let raster = Raster::new(&gpu).unwrap();
        Studio { gpu, raster }
    }

    fn film(&mut self, scene: &Scene, settings: RasterSettings) -> Film {
        let film = self.raster.render(scene, &scene.camera, &settings).unwrap();
        assert_eq!((self.gpu.fault(), film.nonfinite), (None, 0));
        assert_eq!((film.width(), film.height()), (settings.width, settings.height));
        film
    }
}

fn whitted() -> Scene {
    builtin::named("whitted").unwrap()
}

fn with(fake: Fake, knobs: FakeKnobs) -> RasterSettings {
    RasterSettings { fake, knobs, ..RasterSettings::new(160, 90) }
}

/// Maps and spheres that are quickly drawn.
fn small() -> FakeKnobs {
    FakeKnobs { segments: Some(12), cube_map: Some(16), shadow_map: Some(64), ..FakeKnobs::default() }
}

/// Every knob turned, one at a time.
fn turned() -> Vec<FakeKnobs> {
    let d = small();
    vec![
        FakeKnobs { shininess: Some(5.0), ..d },
        FakeKnobs { ambient: Some(0.5), ..d },
        FakeKnobs { diffuse: Some(0.5), ..d },
        FakeKnobs { specular: Some(0.5), ..d },
        FakeKnobs { cube_map: Some(8), ..d },
        FakeKnobs { shadow_map: Some(32), ..d },
        FakeKnobs { filter: ShadowFilter::Hard, ..d },
        FakeKnobs { filter: ShadowFilter::Pcf, ..d },
        FakeKnobs { bias: -0.02, ..d },
        FakeKnobs { segments: Some(6), ..d },
    ]
}

#[test]
fn every_knob_changes_both_fakes_and_leaves_no_trace() {
    let (mut forth, mut back, scene) = (Studio::new(), Studio::new(), whitted());
    for fake in Fake::ALL {
        let plain = forth.film(&scene, with(fake, small()));
        let films: Vec<_> = turned().into_iter().map(|knobs| forth.film(&scene, with(fake, knobs))).collect();
        for (knobs, film) in turned().into_iter().zip(&films).rev() {
            assert_ne!(*film, plain, "{knobs:?}");
            assert_eq!(*film, back.film(&scene, with(fake, knobs)), "{knobs:?}");
        }
        assert_eq!(forth.film(&scene, with(fake, small())), plain);
    }
}

/// Shadow map and cube maps are kept while only the camera moves, and drawn again when anything that they show changes.
#[test]
fn a_picture_after_others_is_the_one_of_a_fresh_start() {
    let mut kept = Studio::new();
    let moved = |scene: &Scene| Scene { camera: scene.camera.orbited(0.7, 0.2).dollied(1.3), ..scene.clone() };
    let mut other_sun = whitted();
    other_sun.sun.as_mut().unwrap().towards = Vec3::new(-0.3, 0.8, 0.5).normalize();
    let other_sky = Scene { sky: Vec3::new(0.9, 0.2, 0.1), ..whitted() };
    let mut other_metal = whitted();
    let metal = other_metal.materials.iter_mut().find(|m| matches!(m.bsdf, Bsdf::Mirror { .. })).unwrap();
    metal.bsdf = Bsdf::Diffuse { albedo: scene::Texture::Constant(Vec3::new(0.1, 0.8, 0.1)) };
    let mut other_glass = whitted();
    other_glass.set_refraction_ratio(0.9);
    let mut smaller_ball = whitted();
    let mut shapes = smaller_ball.shapes.to_vec();
    shapes.iter_mut().for_each(|s| {
        if let Geometry::Sphere { radius, .. } = &mut s.geometry {
            *radius *= 0.8
        }
    });
    smaller_ball.shapes = shapes.into();
    for fake in Fake::ALL {
        for scene in [
            whitted(),
            other_sun.clone(),
            other_sky.clone(),
            other_metal.clone(),
            smaller_ball.clone(),
            other_glass.clone(),
        ] {
            let settings = with(fake, FakeKnobs::default());
            let films = [&scene, &moved(&scene)].map(|scene| kept.film(scene, settings));
            assert_ne!(films[0], films[1]);
            assert_eq!(films[1], Studio::new().film(&moved(&scene), settings));
        }
    }
}

#[test]
fn knobs_at_the_scenes_numbers_change_nothing() {
    let (mut studio, scene) = (Studio::new(), whitted());
    let same = FakeKnobs {
        shininess: Some(30.0),
        ambient: Some(0.23),
        diffuse: Some(1.0),
        specular: Some(17.0 / 255.0),
        cube_map: Some(512),
        shadow_map: Some(512),
        segments: Some(100),
        ..FakeKnobs::default()
    };
    for fake in Fake::ALL {
        assert_eq!(studio.film(&scene, with(fake, same)), studio.film(&scene, with(fake, FakeKnobs::default())));
    }
}

#[test]
fn knobs_beyond_their_range_are_refused_by_name() {
    let (mut studio, scene) = (Studio::new(), whitted());
    let knobs = FakeKnobs { cube_map: Some(4096), ..FakeKnobs::default() };
    let refused = studio.raster.render(&scene, &scene.camera, &with(Fake::Fair, knobs)).unwrap_err();
    assert!(matches!(&refused, RasterError::Knob(why) if why.contains("cube map size 4096") && why.contains("2048")));
    let widest =
        FakeKnobs { cube_map: Some(2048), shadow_map: Some(4096), segments: Some(512), ..FakeKnobs::default() };
    studio.film(&scene, with(Fake::AsTaught, widest));
}

/// The camera sees nothing but floor, by the shadow of the metal sphere.
fn over_the_floor() -> Scene {
    let mut scene = whitted();
    scene.camera =
        Camera { eye: Vec3::new(0.6, 1.6, -1.0), target: Vec3::new(0.538, 0.0, -2.2), fov_y: 35.0, ..scene.camera };
    scene
}

#[test]
fn filters_blur_by_their_kernels() {
    let (mut studio, scene) = (Studio::new(), over_the_floor());
    let levels = |film: &Film| {
        // red is the same in all cells: .8 (shadow cos + .23), and a highlight
        let mut shares: Vec<_> = film.radiances().map(|l| (l.x * 1e4) as i32).collect();
        shares.sort_unstable();
        shares.dedup_by(|a, b| (*a - *b).abs() < 30);
        shares.len()
    };
    let [hard, pcf, soft] = ShadowFilter::ALL.map(|filter| {
        let knobs = FakeKnobs { filter, shadow_map: Some(64), ..FakeKnobs::default() };
        let settings = RasterSettings { fake: Fake::AsTaught, knobs, ..RasterSettings::new(320, 180) };
        levels(&studio.film(&scene, settings))
    });
    // 4 samples a pixel blend the borders of cells only
    assert!(hard < pcf && pcf < soft, "{hard} levels of hard, {pcf} of PCF, {soft} of PCF soft");
}

#[test]
fn ambient_light_scales_alike_in_both_fakes() {
    let (mut studio, scene) = (Studio::new(), whitted());
    // the metal's dark side has nothing but ambient light
    let dark = |studio: &mut Studio, fake, ambient| {
        let knobs = FakeKnobs { ambient, ..FakeKnobs::default() };
        let film = studio.film(&scene, with(fake, knobs));
        let clip = scene.camera.clip_from_world(160.0 / 90.0).project_point3(Vec3::new(2.2, 0.96, -2.5));
        let (x, y) = ((0.5 + 0.5 * clip.x) * 160.0, (0.5 - 0.5 * clip.y) * 90.0);
        film.at(x as u32, y as u32)
    };
    let metal = Vec3::new(0.7921569, 0.8627451, 0.8509804);
    let fair = |studio: &mut Studio, ambient| dark(studio, Fake::Fair, ambient);
    let own = fair(&mut studio, None);
    assert!((own - metal * scene.sky).abs().max_element() < 1e-5, "{own}");
    assert!((fair(&mut studio, Some(0.46)) - 2.0 * own).abs().max_element() < 1e-5);
    assert_eq!(fair(&mut studio, Some(0.0)), Vec3::ZERO);
    let taught = dark(&mut studio, Fake::AsTaught, Some(0.46));
    let expected = metal * 0.46;
    for (found, byte) in taught.to_array().into_iter().zip(expected.to_array()) {
        assert!((colour::srgb_encode(found) - byte).abs() < 0.6 / 255.0, "{taught} is not {expected}");
    }
}

fn shown(show: Show, fake: Fake, (width, height): (u32, u32), knobs: FakeKnobs) -> RasterSettings {
    RasterSettings { show, fake, knobs, ..RasterSettings::new(width, height) }
}

fn bytes(radiance: Vec3) -> [u8; 3] {
    let [r, g, b, _] = DisplayTransform::default().rgba8(radiance);
    [r, g, b]
}

/// Middle of the cross's cell at `column`, `row` of a film of 4 x 3 faces of 64 pixels.
fn cell(film: &Film, column: u32, row: u32, s: f32, t: f32) -> Vec3 {
    film.at(column * 64 + (s * 64.0) as u32, row * 64 + (t * 64.0) as u32)
}

#[test]
fn cube_faces_join_to_a_cross_seen_from_inside() {
    let (mut studio, scene) = (Studio::new(), whitted());
    let film = studio.film(&scene, shown(Show::CubeFaces, Fake::AsTaught, (256, 192), FakeKnobs::default()));
    let (sky, empty) = ([76, 128, 229], bytes(Vec3::splat(maps::BACKGROUND)));
    let off = |a: [u8; 3], b: [u8; 3]| (0..3).map(|c| a[c].abs_diff(b[c])).max();
    for column in 0..4 {
        // sky above the horizon, around and overhead
        assert!(off(bytes(cell(&film, column, 1, 0.1, 0.1)), sky) <= Some(1));
        for row in [0, 2].into_iter().filter(|_| column != 1) {
            assert_eq!(bytes(cell(&film, column, row, 0.5, 0.5)), empty);
        }
    }
    assert!(off(bytes(cell(&film, 1, 0, 0.5, 0.5)), sky) <= Some(1));
    // each place on the floor is found where its direction from the middle of the glass falls
    let eye = Vec3::new(4.2, 2.6, -4.2);
    let floor = scene.materials.iter().find_map(|m| match &m.bsdf {
        Bsdf::Diffuse { albedo } => Some(albedo),
        _ => None,
    });
    let columns = [(0, Vec3::NEG_X), (1, Vec3::NEG_Z), (2, Vec3::X), (3, Vec3::Z)];
    let (mut below, mut around) = (0, 0);
    for x in -10..7 {
        for z in -7..7 {
            let p = Vec3::new(x as f32 + 0.5, 0.0, z as f32);
            let d = p - eye;
            let a = d.abs();
            let (column, row, forward, up) = if a.y > a.x.max(a.z) {
                (1, 2, Vec3::NEG_Y, Vec3::NEG_Z)
            } else {
                let (column, forward) = *columns.iter().max_by(|p, q| p.1.dot(d).total_cmp(&q.1.dot(d))).unwrap();
                (column, 1, forward, Vec3::Y)
            };
            let reach = d.dot(forward);
            let (s, t) = (0.5 + 0.5 * d.dot(forward.cross(up)) / reach, 0.5 - 0.5 * d.dot(up) / reach);
            // one unit of the floor must be wider than some pixels, and nothing may stand or throw its shadow before it
            let metal = (Vec3::new(2.0, 1.9, -2.5) - eye).cross(d.normalize()).length() < 1.3;
            let shadow = (p - Vec3::new(0.54, 0.0, -2.2)).length() < 1.8;
            if reach > 5.0 && row == 1 || metal || shadow || !(0.02..0.98).contains(&s) || !(0.02..0.98).contains(&t) {
                continue;
            }
            let green = floor.unwrap().at(p, Vec2::ZERO).y > 0.5;
            assert_eq!(bytes(cell(&film, column, row, s, t))[1] > 100, green, "{p} at {s}, {t} of {column}, {row}");
            if row == 1 { around += 1 } else { below += 1 }
        }
    }
    assert!(below > 10 && around > 20, "{below} below, {around} around");
}

#[test]
fn fair_cube_faces_hold_radiance_and_small_films_hold_faces_too() {
    let (mut studio, scene) = (Studio::new(), whitted());
    let film = studio.film(&scene, shown(Show::CubeFaces, Fake::Fair, (256, 192), FakeKnobs::default()));
    assert!((cell(&film, 1, 0, 0.5, 0.5) - scene.sky).abs().max_element() < 1e-3);
    for size in [(1, 1), (7, 3), (3, 300)] {
        for show in [Show::CubeFaces, Show::ShadowMap] {
            studio.film(
                &scene,
                shown(show, Fake::Fair, size, FakeKnobs { shadow_map: Some(16), ..FakeKnobs::default() }),
            );
        }
    }
}

#[test]
fn the_suns_map_is_a_square_with_two_discs_near_ones_brighter() {
    let (mut studio, scene) = (Studio::new(), whitted());
    for fake in Fake::ALL {
        let film = studio.film(&scene, shown(Show::ShadowMap, fake, (300, 200), FakeKnobs::default()));
        assert_eq!(film.at(20, 100), Vec3::splat(maps::BACKGROUND));
        let position = Vec3::new(10.0, 13.0, -2.0);
        let right = (-position).cross(Vec3::Y).normalize();
        let up = right.cross(-position.normalize());
        let at = |p: Vec3| {
            let (x, y) = (150.0 + 20.0 * (p - position).dot(right), 100.0 - 20.0 * (p - position).dot(up));
            film.at(x as u32, y as u32).x
        };
        let (glass, metal) = (at(Vec3::new(4.2, 2.6, -4.2)), at(Vec3::new(2.0, 1.9, -2.5)));
        assert!(glass > metal && metal > 0.9 * maps::DARKEST, "{glass}, {metal}");
        assert_eq!(at(Vec3::new(0.0, 0.0, 3.0)), 0.0);
        let drawn: Vec<_> = film.radiances().map(|l| l.x).filter(|l| *l > 0.05).collect();
        assert!(drawn.iter().copied().fold(0.0, f32::max) > 0.999);
        // two discs of radius 20 pixels
        assert!((drawn.len() as f32 / (2.0 * std::f32::consts::PI * 400.0) - 1.0).abs() < 0.05, "{}", drawn.len());
    }
}

#[test]
fn the_area_lights_map_is_a_cross_with_the_boxes_below() {
    let (mut studio, scene) = (Studio::new(), builtin::named("cornell").unwrap());
    let film = studio.film(&scene, shown(Show::ShadowMap, Fake::Fair, (256, 192), FakeKnobs::default()));
    // in the cell -y the top is -z and the right is +x; the tall box, at greater x and z, reaches nearer to the area
    // light, and the floor casts on nothing
    let [tall, short, floor] = [(0.66, 0.7), (0.38, 0.36), (0.5, 0.1)].map(|(s, t)| cell(&film, 1, 2, s, t).x);
    assert!(tall > 1.2 * short && short >= maps::DARKEST && floor == 0.0, "{tall}, {short}, {floor}");
    assert_eq!(cell(&film, 3, 0, 0.5, 0.5).x, maps::BACKGROUND);
}

#[test]
fn a_map_that_a_scene_does_not_have_is_said_to_be_missing() {
    let (mut studio, cornell, mut dark) = (Studio::new(), builtin::named("cornell").unwrap(), whitted());
    dark.sun = None;
    assert!(Show::ALL.iter().all(|show| show.available(&whitted())));
    for (scene, show, missing) in [(&cornell, Show::CubeFaces, "glass"), (&dark, Show::ShadowMap, "sun or lamp")] {
        assert!(!show.available(scene) && Show::Picture.available(scene));
        for fake in Fake::ALL {
            let settings = shown(show, fake, (64, 64), FakeKnobs::default());
            let refused = studio.raster.render(scene, &scene.camera, &settings).unwrap_err();
            assert!(refused.to_string().contains(missing), "{refused}");
        }
    }
}

fn seen_from(scene: &Scene, eye: Vec3, target: Vec3) -> Scene {
    Scene { camera: Camera { eye, target, ..scene.camera }, ..scene.clone() }
}

/// Scenes that lack something, have too much of it, or are seen from where one can't be.
fn odd_scenes() -> Vec<Scene> {
    let scene = whitted();
    let without = |kept: fn(&Bsdf) -> bool| {
        let shapes: Vec<_> = scene.shapes.iter().filter(|s| kept(&scene.material_of(s).bsdf)).cloned().collect();
        Scene { shapes: shapes.into(), ..scene.clone() }
    };
    let mut many = scene.clone();
    let glass = scene.shapes.iter().find(|s| matches!(scene.material_of(s).bsdf, Bsdf::Dielectric { .. })).unwrap();
    // one more than have cube maps
    let more = (0..MOST_CUBE_MAPS).map(|i| Shape {
        geometry: Geometry::Sphere { center: Vec3::new(-(i as f32), 1.0, (i % 5) as f32 - 4.0), radius: 0.4 },
        ..glass.clone()
    });
    many.shapes = scene.shapes.iter().cloned().chain(more).collect();
    let mut bright = scene.clone();
    bright.sky = Vec3::splat(1e6);
    let (middle, metal) = (Vec3::new(4.2, 2.6, -4.2), Vec3::new(2.0, 1.9, -2.5));
    vec![
        seen_from(&scene, middle, metal),
        seen_from(&scene, middle + Vec3::new(0.9, 0.0, 0.0), metal),
        seen_from(&scene, metal, middle),
        seen_from(&scene, Vec3::new(1.0, -2.0, 1.0), middle),
        seen_from(&scene, Vec3::new(1.0, 0.0, 1.0), Vec3::ZERO),
        without(|bsdf| !matches!(bsdf, Bsdf::Dielectric { .. })),
        without(|_| false),
        Scene { sun: None, ..scene.clone() },
        Scene { sky: Vec3::ZERO, ..scene.clone() },
        many,
        bright,
    ]
}

#[test]
fn odd_scenes_and_sizes_give_finite_films() {
    let mut studio = Studio::new();
    let plain = whitted();
    let odd_sizes = [(1, 1), (7, 3), (3, 300)].map(|size| (plain.clone(), size));
    for (scene, (width, height)) in odd_scenes().into_iter().map(|scene| (scene, (64, 36))).chain(odd_sizes) {
        for fake in Fake::ALL {
            studio.film(&scene, RasterSettings { fake, knobs: small(), ..RasterSettings::new(width, height) });
        }
    }
}

#[test]
fn knobs_at_their_ends_give_finite_films_in_every_model() {
    let mut studio = Studio::new();
    let coarsest = FakeKnobs { segments: Some(3), cube_map: Some(4), shadow_map: Some(16), ..FakeKnobs::default() };
    let low = FakeKnobs { shininess: Some(0.0), ambient: Some(0.0), bias: -0.1, ..coarsest };
    let high = FakeKnobs { shininess: Some(1000.0), ambient: Some(1.0), bias: 0.1, ..coarsest };
    for scene in [whitted(), builtin::named("cornell").unwrap()] {
        for (fake, shading) in Fake::ALL.into_iter().flat_map(|fake| Shading::ALL.map(|shading| (fake, shading))) {
            for (knobs, filter) in [(low, ShadowFilter::Hard), (high, ShadowFilter::Pcf)] {
                let knobs = FakeKnobs { filter, ..knobs };
                studio.film(&scene, RasterSettings { fake, shading, knobs, ..RasterSettings::new(64, 36) });
            }
        }
    }
}

#[test]
fn pictures_too_large_are_refused_and_the_next_one_is_drawn() {
    let (mut studio, scene) = (Studio::new(), whitted());
    let limit = studio.gpu.device.limits().max_texture_dimension_2d;
    for (width, height) in [(16384, 16384), (limit + 1, 1), (1, limit + 1), (limit, limit), (0, 1)] {
        for fake in Fake::ALL {
            let settings = RasterSettings { fake, ..RasterSettings::new(width, height) };
            if let Err(why) = studio.raster.render(&scene, &scene.camera, &settings) {
                assert!(!why.to_string().contains('\n'), "{why}");
            } else {
                panic!("{width} x {height} was drawn");
            }
        }
    }
    studio.film(&scene, RasterSettings::new(16, 16));
}
