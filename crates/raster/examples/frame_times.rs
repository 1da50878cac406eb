//! What frames of large scenes take: a mesh of two million triangles, several instances of it, and thousands of shapes.
//! `cargo run --release -p raster --example frame_times`

use gpu::Gpu;
use raster::planes::Planes;
use raster::{Raster, RasterSettings, cut};
use scene::glam::{Affine3A, Quat, Vec3};
use scene::{Camera, Geometry, Instance, Mesh, Scene, Shape, Sun};
use std::error::Error;
use std::f32::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// A wrinkled ball of `2 * rings^2` triangles.
fn wrinkled(rings: u32, smooth: bool) -> Mesh {
    let at = |row: u32, column: u32| {
        let (theta, phi) = (PI * row as f32 / rings as f32, TAU * column as f32 / rings as f32);
        let direction = Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin());
        let wrinkles = (9.0 * direction.x).sin() + (11.0 * direction.y).sin() + (13.0 * direction.z).sin();
        direction * (1.0 + 0.05 * wrinkles)
    };
    let positions: Vec<_> = (0..=rings).flat_map(|row| (0..=rings).map(move |column| at(row, column))).collect();
    let index = |row: u32, column: u32| row * (rings + 1) + column;
    let cell = |row, column| {
        let [a, b] = [index(row, column), index(row, column + 1)];
        let [c, d] = [index(row + 1, column), index(row + 1, column + 1)];
        [[a, b, d], [a, d, c]]
    };
    let triangles = (0..rings).flat_map(|row| (0..rings).flat_map(move |column| cell(row, column))).collect();
    let normals = if smooth { positions.iter().map(|p| p.normalize()).collect() } else { Vec::new() };
    Mesh::with_attributes(positions, triangles, normals, Vec::new())
}

fn small_box(at: Vec3) -> Geometry {
    let shape = Geometry::Box { corner: at, size: Vec3::splat(0.05), turn_y: 20.0 };
    let (positions, triangles) = shape.flat_triangles();
    Geometry::mesh(positions.into_owned(), triangles.into_owned())
}

fn scene(shapes: Vec<Geometry>) -> Result<Scene, Box<dyn Error>> {
    let text = "camera = { eye = [0, 1, 4], target = [0, 0, 0], fov_y = 40, near = 0.01 }\nsky.radiance = [1, 1, 1]\n\
                material.grey.diffuse.albedo = [0.5, 0.5, 0.5]";
    let mut scene = scene::parse(text, "frame times", Path::new("frame_times.toml"))?;
    scene.shapes = shapes.into_iter().map(|geometry| Shape { geometry, material: 0 }).collect();
    scene.sun = Some(Sun { towards: Vec3::new(0.48, 0.8, 0.36), angular_radius: 0.0, irradiance: Vec3::splat(3.0) });
    Ok(scene)
}

fn main() -> Result<(), Box<dyn Error>> {
    let place = |i: i32| {
        let at = Vec3::new((i % 2) as f32 - 0.5, 0.0, (i / 2) as f32 - 0.5);
        Affine3A::from_scale_rotation_translation(Vec3::splat(0.4), Quat::from_rotation_y(i as f32), at)
    };
    let smooth = Arc::new(wrinkled(1024, true));
    let instance = |i: i32| Geometry::Instance(Instance { mesh: smooth.clone(), to_world: place(i) });
    let boxes = |i: i32| small_box(Vec3::new((i % 55) as f32, (i / 55) as f32, 0.0) * 0.06 - Vec3::new(1.6, 1.6, 0.0));
    let cases = [
        ("2,097,152 triangles, smooth", scene(vec![Geometry::Mesh(smooth.clone())])?),
        ("2,097,152 triangles, flat", scene(vec![Geometry::Mesh(Arc::new(wrinkled(1024, false)))])?),
        ("4 instances of them", scene((0..4).map(instance).collect())?),
        ("3,000 boxes", scene((0..3000).map(boxes).collect())?),
    ];
    let gpu = Gpu::headless()?;
    println!("{}", gpu.describe());
    let settings = RasterSettings::new(640, 360);
    for (name, scene) in cases {
        let mut raster = Raster::new(&gpu)?;
        let mut frame = |camera: &Camera| -> Result<f64, Box<dyn Error>> {
            let begun = Instant::now();
            raster.render(&scene, camera, &settings)?;
            Ok(1e3 * begun.elapsed().as_secs_f64())
        };
        let first = frame(&scene.camera)?;
        let next = frame(&scene.camera.orbited(0.1, 0.0))?;
        // within the mesh's box, where what is near is looked at more closely
        let inside = frame(&scene.camera.dollied(3.6))?;
        // what is kept of a mesh is made by the first one who asks
        cut(&scene, &scene.camera.dollied(3.6), &settings);
        let begun = Instant::now();
        let near = Planes::of(&scene, &scene.camera.dollied(3.6), 16.0 / 9.0).near;
        let planes = 1e3 * begun.elapsed().as_secs_f64();
        let begun = Instant::now();
        let found = cut(&scene, &scene.camera.dollied(3.6), &settings).is_some();
        let cut = 1e3 * begun.elapsed().as_secs_f64();
        println!("{name}: first {first:.0} ms, next {next:.0}, inside {inside:.0}");
        println!("  of which planes {planes:.2} ms (near {near:.3}), what they cut {cut:.2} ms ({found})");
    }
    Ok(())
}
