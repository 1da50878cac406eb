//! What the fake sees of surfaces without light is what rays see of them.

use film::{Feature, Features};
use gpu::Gpu;
use pathtrace::{FeaturePass, SamplerKind, Tracer};
use raster::{Fake, FakeKnobs, Raster, RasterSettings, Show};
use scene::{Bsdf, Scene, Vec3, builtin};

const SIZE: (u32, u32) = (160, 90);

/// Bytes that two colours of a display may differ by in the middle of a surface: a normal is interpolated over a triangle.
const ALIKE: f32 = 3.0 / 255.0;

fn settings(fake: Fake, show: Show) -> RasterSettings {
    RasterSettings { fake, show, ..RasterSettings::new(SIZE.0, SIZE.1) }
}

fn drawn(scene: &Scene, knobs: FakeKnobs) -> Features {
    let mut raster = Raster::new(&Gpu::headless().unwrap()).unwrap();
    let settings = RasterSettings { knobs, ..settings(Fake::Fair, Show::Picture) };
    raster.features(scene, &scene.camera, &settings).unwrap()
}

fn traced(scene: &Scene) -> Features {
    let pass = FeaturePass::new(&scene.camera, SIZE, 64, (SamplerKind::Sobol, 1));
    Tracer::new(scene).features(&pass, &|| false).unwrap()
}

/// The share of pixels of which this holds.
fn share(holds: impl Iterator<Item = bool>) -> f32 {
    let (count, all) = holds.fold((0, 0), |(count, all), holds| (count + u32::from(holds), all + 1));
    count as f32 / all as f32
}

fn alike(a: &[Vec3], b: &[Vec3]) -> f32 {
    share(a.iter().zip(b).map(|(a, b)| a.abs_diff_eq(*b, ALIKE)))
}

/// Nearer to each other than by a hundredth, or both nowhere.
fn as_far(a: &[f32], b: &[f32]) -> f32 {
    share(a.iter().zip(b).map(|(a, b)| a == b || (a - b).abs() < 0.01 * a))
}

/// As [`alike`], or between the colours around, as four places in a pixel at an edge may be when 64 are something else.
fn alike_within_antialiasing(a: &[Vec3], b: &[Vec3]) -> f32 {
    let (width, height) = (SIZE.0 as usize, SIZE.1 as usize);
    let around = |at: usize| {
        let (x, y) = (at % width, at / width);
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        rows.flat_map(move |y| (x.saturating_sub(1)..(x + 2).min(width)).map(move |x| b[y * width + x]))
    };
    let between = |at: usize| {
        let low = around(at).fold(Vec3::INFINITY, Vec3::min) - ALIKE;
        let high = around(at).fold(Vec3::NEG_INFINITY, Vec3::max) + ALIKE;
        low.cmple(a[at]).all() && a[at].cmple(high).all()
    };
    share((0..a.len()).map(between))
}

#[test]
fn where_nothing_is_specular_fake_and_rays_see_the_same_surfaces() {
    let [phong, cornell] = ["phong", "cornell"].map(|name| builtin::named(name).unwrap());
    let mut from_below = phong.clone();
    from_below.camera.eye.y *= -1.0;
    for (name, scene) in [("phong", phong), ("cornell", cornell), ("the back of its floor", from_below)] {
        let (drawn, traced) = (drawn(&scene, FakeKnobs::default()), traced(&scene));
        let (albedo, normal) = ([&*drawn.albedo, &*traced.albedo], [&*drawn.normal, &*traced.normal]);
        for [drawn, traced] in [albedo, normal] {
            let (within, exactly) = (alike_within_antialiasing(drawn, traced), alike(drawn, traced));
            assert!(within > 0.99 && exactly > 0.9, "{name}: {within}, and {exactly} of all without the edges");
        }
        let depth = as_far(&drawn.depth, &traced.depth);
        assert!(depth > 0.95, "{name}: {depth}");
        let covered = share(traced.depth.iter().map(|depth| depth.is_finite()));
        assert!(covered > 0.2, "{name}: {covered}");
    }
}

#[test]
fn glass_and_mirrors_show_their_own_surface_as_far_away_as_for_rays() {
    let scene = builtin::named("whitted").unwrap();
    let (drawn, traced) = (drawn(&scene, FakeKnobs::default()), traced(&scene));
    let same_depth = as_far(&drawn.depth, &traced.depth);
    assert!(same_depth > 0.95, "{same_depth}");
    let frame = scene.camera.frame(SIZE.0 as f32 / SIZE.1 as f32);
    for shape in &*scene.shapes {
        let own = match scene.material_of(shape).bsdf {
            Bsdf::Dielectric { .. } => Vec3::ONE,
            Bsdf::Mirror { reflectance } => reflectance,
            Bsdf::Diffuse { .. } | Bsdf::RoughConductor { .. } | Bsdf::MetallicRoughness(_) => continue,
        };
        let to = shape.geometry.center() - frame.eye;
        let along = to / to.dot(frame.forward);
        let of = |axis: Vec3| 0.5 + 0.5 * along.dot(axis) / axis.length_squared();
        let (column, row) = (of(frame.right) * SIZE.0 as f32, (1.0 - of(frame.up)) * SIZE.1 as f32);
        let at = row as usize * SIZE.0 as usize + column as usize;
        assert!(drawn.albedo[at].abs_diff_eq(own, ALIKE), "{} is not {own}", drawn.albedo[at]);
        // the middle of a sphere faces the eye
        assert!(drawn.normal[at].dot(-to.normalize()) > 0.98, "{}", drawn.normal[at]);
        assert!(!traced.albedo[at].abs_diff_eq(own, ALIKE), "rays go on: {}", traced.albedo[at]);
    }
}

/// A lamp is as white as its light makes it, the sky as its radiance up to 1, and there is no normal.
#[test]
fn what_shines_is_seen_as_its_light_up_to_one() {
    let mut scene = builtin::named("phong").unwrap();
    scene.sky = Vec3::new(0.25, 0.5, 7.0);
    let (drawn, traced) = (drawn(&scene, FakeKnobs::default()), traced(&scene));
    let sky: Vec<_> = (0..drawn.depth.len()).filter(|at| traced.depth[*at] == f32::INFINITY).collect();
    assert!(sky.len() > 100, "{}", sky.len());
    let nothing = |at: &usize| drawn.albedo[*at] == Vec3::new(0.25, 0.5, 1.0) && drawn.normal[*at] == Vec3::ZERO;
    assert!(share(sky.iter().map(nothing)) > 0.95);
    let cornell = builtin::named("cornell").unwrap();
    let lamps = self::drawn(&cornell, FakeKnobs::default()).albedo;
    assert!(lamps.contains(&Vec3::ONE) && lamps.iter().all(|albedo| albedo.max_element() <= 1.0));
}

#[test]
fn either_fake_shows_the_same_features_as_films() {
    let scene = builtin::named("whitted").unwrap();
    let mut raster = Raster::new(&Gpu::headless().unwrap()).unwrap();
    let features = raster.features(&scene, &scene.camera, &settings(Fake::Fair, Show::Picture)).unwrap();
    let picture = raster.render(&scene, &scene.camera, &settings(Fake::Fair, Show::Picture)).unwrap();
    for feature in Feature::ALL {
        for fake in Fake::ALL {
            let film = raster.render(&scene, &scene.camera, &settings(fake, Show::Feature(feature))).unwrap();
            assert_eq!(Some(film), features.film(feature, 1), "{feature:?} {fake:?}");
        }
    }
    let again = raster.render(&scene, &scene.camera, &settings(Fake::Fair, Show::Picture)).unwrap();
    assert!(picture == again, "features leave nothing behind in the maps");
    let empty = Scene { shapes: [].into(), ..scene.clone() };
    let nothing = raster.features(&empty, &empty.camera, &settings(Fake::Fair, Show::Picture)).unwrap();
    assert!(nothing.depth.iter().all(|depth| *depth == f32::INFINITY));
}
