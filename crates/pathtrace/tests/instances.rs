//! Pictures with large meshes: an instance of a tree looks as its triangles in the world do.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::Film;
use pathtrace::{FeaturePass, PathSettings, SamplerKind, Tracer};
use scene::glam::{Affine3A, Quat, Vec2};
use scene::image_texture::{ImageTexture, Sampling};
use scene::{Alpha, Bsdf, Geometry, Instance, Mesh, NormalMap, Scene, Shape, Texture, Vec3, builtin};
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

/// A mesh whose every attribute varies, turned, mirrored and squeezed, in a material of pictures. Where `alpha` is a mask of no holes it
/// keeps no tree of its own.
fn ornate(alpha: Alpha) -> Scene {
    let (positions, triangles) = statue::statue(5);
    let normals = positions.iter().map(|p| (p + Vec3::new(0.1, 0.0, 0.2)).normalize()).collect();
    let uvs = positions.iter().map(|p| Vec2::new(3.0 * p.x + p.y, 2.0 * p.z - p.y)).collect();
    let mesh = Arc::new(Mesh::with_attributes(positions, triangles, normals, uvs));
    let to_world =
        Affine3A::from_scale_rotation_translation(Vec3::new(-90.0, 110.0, 70.0), Quat::from_rotation_y(0.6), CENTER);
    let mut scene = room_with([Geometry::Instance(Instance { mesh, to_world })]);
    let shape = scene.shapes.last().expect("the mesh").material;
    let picture =
        |texels: [[f32; 4]; 4]| Arc::new(ImageTexture::new(2, 2, texels.into(), Sampling::default()).expect("2 x 2"));
    let colours = picture([[0.9, 0.1, 0.1, 1.0], [0.1, 0.9, 0.1, 1.0], [0.1, 0.1, 0.9, 1.0], [0.5, 0.5, 0.5, 1.0]]);
    let bumps = picture([[0.6, 0.5, 0.9, 1.0], [0.5, 0.4, 0.9, 1.0], [0.5, 0.7, 0.9, 1.0], [0.4, 0.5, 0.9, 1.0]]);
    let mut material = scene.materials[shape].clone();
    material.bsdf = Bsdf::Diffuse { albedo: Texture::Image { image: colours, factor: Vec3::ONE } };
    material.surface.normal_map = Some(NormalMap { image: bumps, scale: 1.0 });
    material.surface.alpha = alpha;
    scene.materials.push(material);
    let mut shapes = scene.shapes.to_vec();
    shapes.last_mut().expect("the mesh").material = scene.materials.len() - 1;
    scene.shapes = shapes.into();
    scene
}

const CENTER: Vec3 = Vec3::new(278.0, 250.0, 200.0);

#[test]
fn an_instance_has_the_normals_and_pictures_of_its_triangles_in_the_world() {
    let seen = |alpha| {
        let scene = ornate(alpha);
        let pass = FeaturePass::new(&scene.camera, (48, 48), 1, (SamplerKind::Sobol, 1));
        Tracer::new(&scene).features(&pass, &|| false).expect("nobody stops it")
    };
    let instanced = seen(Alpha::Opaque);
    let baked = seen(Alpha::Mask { cutoff: 0.5, factor: 1.0, image: None });
    let alike = |(a, b): (&Vec3, &Vec3)| a.abs_diff_eq(*b, 2e-3);
    let same = |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).filter(|pair| alike(*pair)).count();
    let count = instanced.normal.len();
    // rays at edges may meet the neighbour
    assert!(same(&instanced.normal, &baked.normal) > count - 12);
    assert!(same(&instanced.albedo, &baked.albedo) > count - 12);
    let walls = [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z];
    let on_mesh = instanced.normal.iter().filter(|n| walls.iter().all(|wall| n.dot(*wall) < 0.999)).count();
    assert!(on_mesh > count / 20, "{on_mesh} of {count}");
}
