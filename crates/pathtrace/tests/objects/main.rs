//! Which shape each pixel shows, against each shape's own equation in f64.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

mod survey;

use pathtrace::{Lanes, NO_SHAPE, Tracer};
use scene::camera::PictureFrame;
use scene::glam::{Affine3A, DVec3, Quat, Vec2};
use scene::image_texture::{ImageTexture, Sampling};
use scene::{Alpha, Geometry, Instance, Mesh, Scene, Shape, Vec3, builtin};
use std::sync::Arc;
use survey::Survey;

const SIZE: (u32, u32) = (45, 30);

fn frame_of(scene: &Scene) -> PictureFrame {
    scene.camera.frame(SIZE.0 as f32 / SIZE.1 as f32)
}

fn direction(frame: &PictureFrame, pixel: usize) -> DVec3 {
    let (column, row) = (pixel as u32 % SIZE.0, pixel as u32 / SIZE.0);
    let x = 2.0 * (f64::from(column) + 0.5) / f64::from(SIZE.0) - 1.0;
    let y = 1.0 - 2.0 * (f64::from(row) + 0.5) / f64::from(SIZE.1);
    (frame.forward.as_dvec3() + frame.right.as_dvec3() * x + frame.up.as_dvec3() * y).normalize()
}

/// Pixels where what is told is not the first shape by their equations. Shapes that lie in one another, or touch and are
/// held apart, are equally near.
fn wrong(scene: &Scene, told: &[u32]) -> usize {
    let (frame, survey) = (frame_of(scene), Survey::of(scene));
    let is_wrong = |(pixel, told): (usize, &u32)| {
        let distances = survey.distances(frame.eye.as_dvec3(), direction(&frame, pixel));
        let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
        match *told {
            NO_SHAPE => least < f64::INFINITY,
            told => distances[told as usize].is_infinite() || distances[told as usize] > least * (1.0 + 1e-4),
        }
    };
    told.iter().enumerate().filter(|pixel| is_wrong(*pixel)).count()
}

fn told(tracer: &Tracer, scene: &Scene) -> Vec<u32> {
    tracer.first_shapes(&frame_of(scene), SIZE, &|| false).expect("nobody stops it")
}

/// All ways to find it: shapes in a list, trees, every kind of lanes.
fn assert_right(name: &str, scene: &Scene) {
    let first = told(&Tracer::new(scene), scene);
    let by_trees = told(&Tracer::new(scene).with_single_rays(), scene);
    let (wrong, wrong_by_trees) = (wrong(scene, &first), wrong(scene, &by_trees));
    println!("{name}: {} shapes, {wrong} and {wrong_by_trees} pixels wrong", scene.shapes.len());
    // a ray through a silhouette meets one of two by the last digit
    assert!(wrong <= 1 && wrong_by_trees <= 1, "{name}: {wrong} and {wrong_by_trees} pixels");
    for lanes in Lanes::available() {
        assert!(told(&Tracer::new(scene).with_lanes(lanes), scene) == first, "{name}: {lanes:?}");
    }
}

#[test]
fn each_pixel_of_the_built_in_scenes_shows_the_shape_that_is_nearest_by_its_equation() {
    for name in builtin::names().chain(builtin::hard_names()) {
        assert_right(name, &builtin::named(name).expect("built in"));
    }
}

/// A sheet from a corner along two edges, the whole of a picture on it.
fn sheet(corner: Vec3, u: Vec3, v: Vec3) -> Mesh {
    let positions = vec![corner, corner + u, corner + u + v, corner + v];
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec();
    Mesh::with_attributes(positions, vec![[0, 1, 2], [0, 2, 3]], Vec::new(), uvs)
}

/// The Cornell box, its lamp at the end of the list though it comes first for rays, with what takes another way to rays: large
/// meshes and instances of them, one of them in no space, small instances, a mesh that no ray can meet, and, if they are
/// asked for, holes.
fn crowd(holes: bool) -> Scene {
    let mut scene = builtin::named("cornell").expect("built in");
    let large = Arc::new(scene::statue(5, &scene::Progress::untold()).expect("nobody stops it"));
    assert!(large.is_large());
    let (low, high) = large.bounds();
    let at = |x: f32, y: f32, z: f32, turn: f32| {
        let scale = 150.0 / (high - low).max_element();
        Affine3A::from_scale_rotation_translation(
            Vec3::new(scale, -scale, scale),
            Quat::from_rotation_y(turn),
            Vec3::new(x, y, z),
        )
    };
    let screen = Arc::new(sheet(Vec3::ZERO, Vec3::X * 200.0, Vec3::Y * 150.0));
    let instance = |mesh: &Arc<Mesh>, to_world| Geometry::Instance(Instance { mesh: mesh.clone(), to_world });
    let flattened = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let line = Mesh::new(vec![Vec3::ZERO, Vec3::X * 500.0, Vec3::X * 900.0], vec![[0, 1, 2]]);
    let masked = scene.materials.len();
    let mut material = scene.materials[scene.shapes[0].material].clone();
    if holes {
        let texels = vec![[1.0; 4], [1.0, 1.0, 1.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0; 4]];
        let sampling = Sampling { bilinear: false, ..Sampling::default() };
        let image = ImageTexture::new(2, 2, texels, sampling).map(Arc::new);
        material.surface.alpha = Alpha::Mask { cutoff: 0.5, factor: 1.0, image };
    }
    scene.materials.push(material);
    let more = [
        (instance(&large, at(120.0, 200.0, 120.0, 0.4)), 0),
        (instance(&large, flattened), 0),
        (instance(&large, at(430.0, 380.0, 200.0, 2.0)), 1),
        (Geometry::Mesh(Arc::new(line)), 1),
        (instance(&screen, Affine3A::from_translation(Vec3::new(250.0, 150.0, 20.0))), masked),
        (Geometry::Mesh(Arc::new(sheet(Vec3::new(50.0, 420.0, 10.0), Vec3::X * 180.0, Vec3::Y * 90.0))), masked),
        (Geometry::Disk { center: Vec3::new(300.0, 60.0, 40.0), normal: Vec3::NEG_Z, radius: 50.0 }, 1),
        (Geometry::Sphere { center: Vec3::new(470.0, 470.0, 300.0), radius: 60.0 }, 0),
    ];
    let more = more.into_iter().map(|(geometry, material)| Shape { geometry, material });
    let (lamps, others): (Vec<Shape>, Vec<Shape>) =
        scene.shapes.iter().cloned().partition(|shape| scene.material_of(shape).shines());
    scene.shapes = others.into_iter().chain(more).chain(lamps).collect();
    scene
}

#[test]
fn shapes_that_take_other_ways_to_rays_keep_their_places_in_the_scene() {
    for holes in [false, true] {
        let scene = crowd(holes);
        assert_right(&format!("crowd, holes: {holes}"), &scene);
        let told = told(&Tracer::new(&scene), &scene);
        let seen = |shape: usize| told.contains(&(shape as u32));
        let never = scene
            .shapes
            .iter()
            .position(|shape| shape.geometry.mesh_of().is_some_and(|mesh| mesh.triangles().len() == 1));
        let lamp = scene.shapes.len() - 1;
        assert!(seen(lamp) && !never.is_some_and(seen), "the lamp is seen, a line is not");
        assert!((0..scene.shapes.len()).filter(|shape| seen(*shape)).count() >= scene.shapes.len() - 4);
    }
}

#[test]
fn along_a_ray_lie_the_shapes_by_their_distance_each_once_and_the_first_is_what_the_pixel_shows() {
    let scene = crowd(true);
    let (tracer, frame, survey) = (Tracer::new(&scene), frame_of(&scene), Survey::of(&scene));
    let first = told(&tracer, &scene);
    let (mut deepest, mut wrong) = (0, 0);
    for pixel in (0..first.len()).step_by(7) {
        let along = tracer.shapes_along(&frame, SIZE, [pixel as u32 % SIZE.0, pixel as u32 / SIZE.0], 16);
        assert_eq!(along.first().map_or(NO_SHAPE, |met| met.shape), first[pixel]);
        let direction = direction(&frame, pixel);
        let distances = survey.distances(frame.eye.as_dvec3(), direction);
        let mut expected: Vec<usize> = (0..distances.len()).filter(|shape| distances[*shape].is_finite()).collect();
        expected.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        wrong += usize::from(!along.iter().map(|met| met.shape as usize).eq(expected.iter().copied()));
        for met in &along {
            let distance = distances[met.shape as usize];
            let off = (frame.eye.as_dvec3() + direction * distance).distance(met.position.as_dvec3());
            let is_right = (f64::from(met.distance) - distance).abs() < 1e-4 * distance && off < 1e-4 * distance;
            assert!(is_right || distance.is_infinite(), "{met:?}: {distance}");
        }
        deepest = deepest.max(along.len());
        let fewer = tracer.shapes_along(&frame, SIZE, [pixel as u32 % SIZE.0, pixel as u32 / SIZE.0], 2);
        assert_eq!(fewer, along[..along.len().min(2)]);
    }
    println!("{deepest} deep, {wrong} rays wrong");
    assert!(deepest >= 3 && wrong <= 1, "{deepest} deep, {wrong} rays wrong");
}

#[test]
fn what_is_stopped_tells_nothing() {
    let scene = builtin::named("whitted").expect("built in");
    assert_eq!(Tracer::new(&scene).first_shapes(&frame_of(&scene), SIZE, &|| true), None);
}
