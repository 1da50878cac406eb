//! Cones and glass that splits paths change the noise and nothing else.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use pathtrace::{ConesAt, Estimator, PathSettings, SamplerKind, Tracer};
use scene::{Geometry, Scene, Vec3};
use std::path::Path;

const SIZE: (u32, u32) = (48, 32);
/// Pixels along the side of a block whose means are compared.
const BLOCK: u32 = 8;
const BLOCKS: usize = (SIZE.0 / BLOCK * SIZE.1 / BLOCK) as usize;

/// A glass mesh, a glass box and a mirror above a floor under a sun so wide that chance finds it; one diffuse ball stands
/// inside the sphere around the mirror. All of it `away` from the origin, the mesh `height` above the floor.
fn casters(away: f32, height: f32) -> Scene {
    let at = |x: f32, y: f32, z: f32| format!("[{:?}, {:?}, {:?}]", x + away, y, z - away);
    let corners = [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
    let corners = corners.map(|[x, y, z]: [f32; 3]| at(0.5 * x - 0.9, 0.5 * y + 0.5 + height, 0.5 * z)).join(", ");
    let text = format!(
        "[camera]\neye = {}\ntarget = {}\nfov_y = 45\n\
         [sun]\ntowards = [1, 1.6, -1]\nangular_radius = 15\nirradiance = [3, 3, 3]\n\
         [sky]\nradiance = [0.2, 0.2, 0.2]\n\
         [material.floor]\ndiffuse = {{ albedo = [0.7, 0.5, 0.3] }}\n\
         [material.glass]\ndielectric = {{ ior = 1.5 }}\n\
         [material.mirror]\nmirror = {{ reflectance = [0.9, 0.9, 0.9] }}\n\
         [[rectangle]]\ncorner = {}\nedge_u = [0, 0, 12]\nedge_v = [12, 0, 0]\nmaterial = 'floor'\n\
         [[mesh]]\npositions = [{corners}]\n\
         triangles = [[0, 2, 4], [4, 2, 1], [1, 2, 5], [5, 2, 0], [4, 3, 0], [1, 3, 4], [5, 3, 1], [0, 3, 5]]\n\
         material = 'glass'\n\
         [[box]]\ncorner = {}\nsize = [0.5, 0.5, 0.5]\nturn_y = 25\nmaterial = 'glass'\n\
         [[disk]]\ncenter = {}\nnormal = [-0.5, 0.3, 0.6]\nradius = 0.6\nmaterial = 'mirror'\n\
         [[sphere]]\ncenter = {}\nradius = 0.15\nmaterial = 'floor'\n",
        at(0., 2.2, 5.),
        at(0., 0.5, 0.),
        at(-6., 0., -6.),
        at(0.1, 0.2, 0.4),
        at(1.3, 0.9, 0.),
        at(1.0, 0.8, 0.3),
    );
    scene::parse(&text, "casters", Path::new("casters.toml")).expect("a scene")
}

/// The spheres of whitted without its floor: what is left of the sun are its glints.
fn glints() -> Scene {
    let mut scene = scene::builtin::named("whitted").expect("built in");
    let spheres = scene.shapes.iter().filter(|shape| matches!(shape.geometry, Geometry::Sphere { .. }));
    scene.shapes = spheres.cloned().collect();
    scene
}

fn film(tracer: &Tracer, scene: &Scene, settings: PathSettings, spp: u32) -> Film {
    let mut film = Film::new(SIZE.0, SIZE.1);
    tracer.render(&mut film, &scene.camera, &settings.into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

/// Mean and its squared standard error in each block, over pictures of different seeds.
fn blocks(scene: &Scene, settings: PathSettings, pictures: u32) -> Vec<(f64, f64)> {
    let tracer = Tracer::new(scene);
    let mut sums = vec![[0.0f64; 2]; BLOCKS];
    for seed in 0..pictures {
        let image = film(&tracer, scene, PathSettings { seed, ..settings }, 16).image();
        let mut of_blocks = vec![0.0f64; BLOCKS];
        for (i, radiance) in (0..).zip(image.radiances()) {
            let (x, y) = (i % SIZE.0 / BLOCK, i / SIZE.0 / BLOCK);
            of_blocks[(y * (SIZE.0 / BLOCK) + x) as usize] += f64::from(radiance.dot(Vec3::ONE));
        }
        for ([sum, squares], value) in sums.iter_mut().zip(of_blocks) {
            *sum += value;
            *squares += value * value;
        }
    }
    let n = f64::from(pictures);
    sums.iter().map(|[sum, squares]| (sum / n, (squares / n - (sum / n).powi(2)) / (n - 1.0))).collect()
}

/// No block differs by more than 4.6 standard errors: for 24 blocks of 64 pictures each, about 1 in 5000 by chance.
fn assert_same_means(scene: &Scene, with: PathSettings, without: PathSettings, what: &str) {
    let pairs = blocks(scene, with, 64).into_iter().zip(blocks(scene, without, 64));
    for (block, (a, b)) in pairs.enumerate() {
        let z = (a.0 - b.0) / (a.1 + b.1).sqrt().max(1e-9);
        assert!(z.abs() < 4.6, "{what}, block {block}: {} and {}, z {z}", a.0, b.0);
    }
}

fn settings(estimator: Estimator, cones: ConesAt, split_glass: bool) -> PathSettings {
    PathSettings { estimator, cones, split_glass, sampler: SamplerKind::Independent, ..PathSettings::default() }
}

#[test]
fn cones_and_splits_leave_all_means_as_they_are() {
    for (away, height) in [(0.0, 0.0), (0.0, 0.6), (1000.0, 0.3)] {
        let scene = casters(away, height);
        for estimator in [Estimator::LIGHT, Estimator::MIS] {
            let chance = settings(estimator, ConesAt::Nothing, false);
            let all = settings(estimator, ConesAt::Everything, true);
            let what = format!("{} at {away}, {height} above the floor", estimator.name());
            assert_same_means(&scene, all, chance, &what);
        }
    }
}

#[test]
fn a_limit_of_bounces_leaves_the_same_light_with_and_without_them() {
    let scene = casters(0.0, 0.3);
    for bounces in 0..4 {
        let limited = |settings| PathSettings { bounces: Some(bounces), ..settings };
        let chance = limited(settings(Estimator::LIGHT, ConesAt::Nothing, false));
        let all = limited(settings(Estimator::LIGHT, ConesAt::Everything, true));
        assert_same_means(&scene, all, chance, &format!("{bounces} bounces"));
    }
}

/// relMSE of a picture of 16 spp against the mean of 64 such pictures.
fn noise(scene: &Scene, settings: PathSettings) -> f64 {
    let tracer = Tracer::new(scene);
    let pictures = (0..64).map(|seed| film(&tracer, scene, PathSettings { seed, ..settings }, 16).image());
    let mut sums = vec![[0.0f64; 2]; (SIZE.0 * SIZE.1) as usize];
    for picture in pictures {
        for ([sum, squares], radiance) in sums.iter_mut().zip(picture.radiances()) {
            let value = f64::from(radiance.dot(Vec3::ONE));
            *sum += value;
            *squares += value * value;
        }
    }
    let relative = |[sum, squares]: &[f64; 2]| {
        let mean = sum / 64.0;
        (squares / 64.0 - mean * mean) / (mean * mean + 0.09)
    };
    sums.iter().map(relative).sum::<f64>() / sums.len() as f64
}

#[test]
fn glints_in_glass_that_splits_paths_have_less_than_a_fifth_of_the_noise() {
    let of = |split_glass| noise(&glints(), PathSettings { split_glass, ..PathSettings::default() });
    let (split, by_chance) = (of(true), of(false));
    assert!(split < 0.2 * by_chance, "{split} and {by_chance}");
}

#[test]
fn caustics_of_glass_meshes_have_less_than_half_the_noise_with_cones() {
    let mut scene = casters(0.0, 0.6);
    scene.sun = scene.sun.map(|sun| scene::Sun { angular_radius: 4.0, ..sun });
    let of_floor_and_mesh =
        |shape: &&scene::Shape| matches!(shape.geometry, Geometry::Mesh(_) | Geometry::Rectangle { .. });
    scene.shapes = scene.shapes.iter().filter(of_floor_and_mesh).cloned().collect();
    let of = |cones| noise(&scene, settings(Estimator::LIGHT, cones, true));
    let (chance, cones) = (of(ConesAt::Nothing), of(ConesAt::Usual));
    assert!(cones < 0.5 * chance, "{cones} and {chance}");
}

/// Techniques that a lecture shows as they are have neither, nor have scenes without glass and mirrors: bit for bit.
#[test]
fn what_has_no_cones_and_splits_nothing_is_as_before() {
    let scene = casters(0.0, 0.3);
    let naive = |cones, split_glass| {
        let settings =
            PathSettings { branches: 2, bounces: Some(2), ..settings(Estimator::UNIFORM, cones, split_glass) };
        film(&Tracer::new(&scene), &scene, settings, 2)
    };
    assert!(naive(ConesAt::Everything, true) == naive(ConesAt::Nothing, false));
    let cornell = scene::builtin::named("cornell").expect("built in");
    let of =
        |cones, split_glass| film(&Tracer::new(&cornell), &cornell, settings(Estimator::MIS, cones, split_glass), 2);
    assert!(of(ConesAt::Everything, true) == of(ConesAt::Nothing, false));
}
