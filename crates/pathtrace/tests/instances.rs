//! Pictures with large meshes: an instance of a tree looks as its triangles in the world do.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use pathtrace::{PathSettings, Tracer};
use scene::glam::{Affine3A, Quat};
use scene::{Geometry, Instance, Mesh, Scene, Shape, Vec3, builtin};
use std::sync::Arc;

#[path = "../examples/meshes/statue.rs"]
mod statue;

/// The Cornell box with more shapes in it.
fn room_with(geometries: impl IntoIterator<Item = Geometry>) -> Scene {
    let mut scene = builtin::named("cornell").expect("built in");
    let material = scene.materials.iter().position(|material| !material.shines()).expect("a wall");
    let more = geometries.into_iter().map(|geometry| Shape { geometry, material });
    scene.shapes = scene.shapes.iter().cloned().chain(more).collect();
    scene
}

fn picture(scene: &Scene) -> Film {
    let mut film = Film::new(40, 40);
    let settings = PathSettings { seed: 3, ..PathSettings::default() };
    let _ = Tracer::new(scene).render(&mut film, &scene.camera, &settings.into(), 64, &|| false);
    film
}

#[test]
fn an_instance_looks_as_its_triangles_in_the_world() {
    let (positions, triangles) = statue::statue(5);
    let mesh = Arc::new(Mesh::new(positions, triangles));
    let (lo, hi) = room_with([]).bounds();
    let size = (hi - lo).min_element();
    let turn = Quat::from_rotation_y(0.6);
    let to_world = Affine3A::from_scale_rotation_translation(
        size * Vec3::new(-0.5, 0.35, 0.4),
        turn,
        lo + (hi - lo) * Vec3::new(0.5, 0.45, 0.4),
    );
    let instance = Instance { mesh, to_world };
    let baked = instance.baked();
    let pieces: Vec<Geometry> = baked
        .triangles()
        .chunks(Mesh::LARGE / 2)
        .map(|piece| Geometry::mesh(baked.positions().to_vec(), piece.to_vec()))
        .collect();
    let empty = picture(&room_with([]));
    let (instanced, baked) = (picture(&room_with([Geometry::Instance(instance)])), picture(&room_with(pieces)));
    let means = |film: &Film| Vec3::from_array(film.mean().map(|channel| channel as f32));
    // the same paths but for rounding: few go another way
    let (one, other, without) = (means(&instanced), means(&baked), means(&empty));
    assert!((one - other).abs().max_element() < 2e-3 * other.max_element(), "{one} {other}");
    assert!((one - without).abs().max_element() > 0.05 * other.max_element(), "{one} {without}");
    let differ = |(a, b): (Vec3, Vec3)| (a - b).abs().max_element() > 0.02 * b.max_element();
    let differing = instanced.radiances().zip(baked.radiances()).filter(|pair| differ(*pair)).count();
    assert!(differing < 80, "{differing} of 1600 pixels");
}
