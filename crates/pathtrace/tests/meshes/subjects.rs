//! Meshes and pictures with known answers.

use film::Film;
use pathtrace::{Integrator, Tracer};
use scene::glam::{Vec2, Vec4};
use scene::image_texture::Sampling;
use scene::{Geometry, ImageTexture, Mesh, Scene, Shape, Vec3};
use std::f32::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

pub fn parse(text: &str) -> Scene {
    scene::parse(text, "test", Path::new("test.toml")).expect("a scene")
}

/// A unit ball in the origin under this light, its material called `ball`.
pub fn ball_under(light: &str, material: &str) -> Scene {
    parse(&format!(
        "[camera]\neye = [0, 0, 6]\ntarget = [0, 0, 0]\nfov_y = 24\n{light}\n[material.ball]\n{material}\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"ball\"\n"
    ))
}

pub const SUN: &str = "[sun]\ntowards = [2, 1, 1]\nangular_radius = 0\nirradiance = [3.1415927, 3.1415927, 3.1415927]";
pub const WHITE: &str = "diffuse = { albedo = [1, 1, 1] }";

/// A unit ball of 3,968 triangles, fewer than have a tree of their own.
pub fn ball(smooth: bool) -> Mesh {
    globe(62, 33, smooth)
}

pub fn globe(sectors: u32, bands: u32, smooth: bool) -> Mesh {
    let (mut normals, mut uvs) = (Vec::new(), Vec::new());
    for band in 0..=bands {
        for sector in 0..=sectors {
            let uv = Vec2::new(sector as f32 / sectors as f32, band as f32 / bands as f32);
            let (theta, phi) = (PI * uv.y, TAU * (sector % sectors) as f32 / sectors as f32);
            normals.push(Vec3::new(theta.sin() * phi.cos(), theta.cos(), -theta.sin() * phi.sin()).normalize());
            uvs.push(uv);
        }
    }
    let index = |sector: u32, band: u32| band * (sectors + 1) + sector;
    let mut triangles = Vec::new();
    for band in 0..bands {
        for sector in 0..sectors {
            let [a, b] = [index(sector, band), index(sector, band + 1)];
            triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    let positions = normals.clone();
    Mesh::with_attributes(positions, triangles, if smooth { normals } else { Vec::new() }, uvs)
}

/// A rectangle with (0, 0) of pictures at `corner + up`, and (1, 1) at `corner + right`, in so many columns and rows.
pub fn sheet(corner: Vec3, right: Vec3, up: Vec3, cells: u32) -> Mesh {
    let along = |i: u32| i as f32 / cells as f32;
    let places = (0..=cells).flat_map(|j| (0..=cells).map(move |i| Vec2::new(along(i), along(j))));
    let positions = places.clone().map(|p| corner + right * p.x + up * (1.0 - p.y)).collect();
    let mut triangles = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let a = j * (cells + 1) + i;
            let below = a + cells + 1;
            triangles.extend([[a, below, below + 1], [a, below + 1, a + 1]]);
        }
    }
    Mesh::with_attributes(positions, triangles, Vec::new(), places.collect())
}

/// The scene with a mesh for one of its shapes.
pub fn with_mesh(mut scene: Scene, shape: usize, mesh: Mesh) -> Scene {
    let mut shapes: Vec<Shape> = scene.shapes.to_vec();
    shapes[shape].geometry = Geometry::Mesh(Arc::new(mesh));
    scene.shapes = shapes.into();
    scene
}

pub fn picture(width: u32, texels: &[[f32; 4]], bilinear: bool) -> Arc<ImageTexture> {
    let height = texels.len() as u32 / width;
    let sampling = Sampling { bilinear, ..Sampling::default() };
    Arc::new(ImageTexture::new(width, height, texels.to_vec(), sampling).expect("as many texels as it says"))
}

/// A picture of one colour.
pub fn plain(colour: Vec4) -> Arc<ImageTexture> {
    picture(1, &[colour.to_array()], false)
}

pub fn render(scene: &Scene, size: (u32, u32), spp: u32, integrator: impl Into<Integrator>) -> Film {
    let mut film = Film::new(size.0, size.1);
    Tracer::new(scene).render(&mut film, &scene.camera, &integrator.into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

/// Mean of all channels.
pub fn grey(film: &Film) -> f64 {
    film.mean().iter().sum::<f64>() / 3.0
}

/// Root of the mean square of the difference of two pictures.
pub fn apart(a: &Film, b: &Film) -> f64 {
    let squares: f64 = a.radiances().zip(b.radiances()).map(|(a, b)| f64::from((a - b).length_squared()) / 3.0).sum();
    (squares / f64::from(a.width() * a.height())).sqrt()
}
