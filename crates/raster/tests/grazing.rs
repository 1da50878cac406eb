//! Shading normals where surfaces are seen at grazing angles: those of highlights against rays' rule found by bisection in
//! f64, matt ones as they are.

#![allow(clippy::unwrap_used)]

use gpu::Gpu;
use raster::{Raster, RasterSettings, Shading};
use scene::glam::{DVec3, Vec2};
use scene::image_texture::Sampling;
use scene::{Bsdf, Geometry, ImageTexture, Mesh, NormalMap, Scene, Shape, Texture, Vec3};
use std::f32::consts::PI;
use std::path::Path;
use std::sync::Arc;

const SIZE: u32 = 64;

/// A matt square of side 2 in z = 0, seen from this height over a distance of 10 along x, under a sun straight above.
fn square_seen_from(height: f32) -> Scene {
    let text = format!(
        "camera = {{ eye = [10, 0, {height}], target = [0, 0, 0], up = [0, 0, 1], fov_y = 11 }}\n\
         sun = {{ towards = [0, 0, 1], angular_radius = 0, irradiance = [1, 1, 1] }}\n\
         [fake]\nambient = 0\n[material.white]\ndiffuse = {{ albedo = [1, 1, 1] }}\nfake = {{ specular = 0 }}"
    );
    scene::parse(&text, "test", Path::new("test.toml")).unwrap()
}

fn square(normal: Vec3) -> Mesh {
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::ONE, Vec2::new(-1.0, 1.0)];
    let positions = corners.map(|c| c.extend(0.0)).to_vec();
    let uvs = corners.map(|c| Vec2::new(0.5 + 0.5 * c.x, 0.5 - 0.5 * c.y)).to_vec();
    Mesh::with_attributes(positions, vec![[0, 1, 2], [0, 2, 3]], vec![normal; 4], uvs)
}

/// The square with this normal, that of its corners or of a picture.
fn scene(height: f32, normal: Vec3, pictured: bool) -> Scene {
    let mut scene = square_seen_from(height);
    let mesh = square(if pictured { Vec3::Z } else { normal });
    scene.shapes = [Shape { geometry: Geometry::Mesh(Arc::new(mesh)), material: 0 }].into();
    if pictured {
        let texels = vec![(0.5 + 0.5 * normal).extend(1.0).to_array()];
        let image = Arc::new(ImageTexture::new(1, 1, texels, Sampling::default()).unwrap());
        scene.materials[0].surface.normal_map = Some(NormalMap { image, scale: 1.0 });
    }
    scene
}

/// The first normal on the way from `n` to the square's own, z, that mirrors `wo` to a hundredth above the square, or to
/// nine tenths of the height of `wo`.
fn bent(n: DVec3, wo: DVec3) -> DVec3 {
    let least = (0.9 * wo.z).min(0.01);
    let sideways = DVec3::new(n.x, n.y, 0.0).normalize();
    let at = |angle: f64| sideways * angle.sin() + DVec3::Z * angle.cos();
    let valid = |angle: f64| (2.0 * at(angle).dot(wo) * at(angle) - wo).z >= least;
    let own = n.z.acos();
    if valid(own) {
        return n;
    }
    let (mut inside, mut outside) = (0.0, own);
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        *(if valid(middle) { &mut inside } else { &mut outside }) = middle;
    }
    at(inside)
}

/// The square with a highlight for a colour: the cosine between its normal and the half vector.
fn shining(mut scene: Scene) -> Scene {
    scene.materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::ZERO) };
    (scene.materials[0].fake.specular, scene.materials[0].fake.shininess) = (1.0, 1.0);
    scene
}

#[test]
fn normals_of_highlights_bend_as_those_of_rays_do_and_matt_ones_stay_where_surfaces_are_seen_at_grazing_angles() {
    let gpu = Gpu::headless().unwrap();
    let mut raster = Raster::new(&gpu).unwrap();
    // whose highlight a specular of 0 takes away; that of the others rises to 1 at grazing angles
    let settings = RasterSettings { shading: Shading::BlinnPhong, ..RasterSettings::new(SIZE, SIZE) };
    let mut turned = 0;
    let away =
        [Vec3::new(-0.6, 0.0, 0.8), Vec3::new(-0.48, 0.64, 0.6), Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.6, 0.8)];
    for (height, n, pictured) in [0.8, 2.5, 8.0]
        .into_iter()
        .flat_map(|height| away.into_iter().flat_map(move |n| [false, true].map(move |it| (height, n, it))))
    {
        let scene = scene(height, n, pictured);
        let features = raster.features(&scene, &scene.camera, &settings).unwrap();
        let film = raster.render(&scene, &scene.camera, &settings).unwrap();
        let highlight = raster.render(&shining(scene.clone()), &scene.camera, &settings).unwrap();
        let middle = Vec2::splat((SIZE / 2) as f32 + 0.5) / SIZE as f32;
        let wo = -scene.camera.frame(1.0).direction(middle).as_dvec3().normalize();
        let expected = bent(n.as_dvec3(), wo);
        turned += u32::from(expected != n.as_dvec3());
        let found = features.normal[(SIZE / 2 * (SIZE + 1)) as usize].as_dvec3();
        // half a byte's 256th of the picture's normal
        assert!((found - n.as_dvec3()).abs().max_element() < 2e-3, "{found} is not {n}: {height}, {pictured}");
        // the mean of four places in the pixel
        let light = f64::from(film.at(SIZE / 2, SIZE / 2).x * PI);
        assert!((light - f64::from(n.z)).abs() < 5e-3, "{light} is not {}: {n}, {height}, {pictured}", n.z);
        // whose normals differ by a hundredth there
        let light = f64::from(highlight.at(SIZE / 2, SIZE / 2).x * PI);
        let cosine = expected.dot((wo + DVec3::Z).normalize());
        assert!((light - cosine).abs() < 5e-3, "{light} is not {cosine}: {n}, {height}, {pictured}");
    }
    assert_eq!(gpu.fault(), None);
    assert!((6..20).contains(&turned), "{turned} of 24 are turned");
}
