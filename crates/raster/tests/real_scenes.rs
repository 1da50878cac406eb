//! Meshes with normals and places in pictures, instances, pictures on surfaces, alpha masks, and the highlight of glTF's
//! material: pixels in closed form.

#![allow(clippy::unwrap_used)]

use film::Film;
use gpu::Gpu;
use raster::{Fake, Raster, RasterSettings, Shading};
use scene::glam::{Affine3A, Mat2, Quat, Vec2, Vec4};
use scene::image_texture::{Sampling, Wrap};
use scene::material::Emission;
use scene::{
    Alpha, Bsdf, Geometry, ImageTexture, Instance, Mesh, MetallicRoughness, NormalMap, Scene, Shape, Sun, Texture, Vec3,
};
use std::path::Path;
use std::sync::Arc;

const SIZE: u32 = 96;

/// Seen from 10 away along -z, 2 wide and high at z = 0; a white sky and no other light.
fn empty() -> Scene {
    let text = "camera = { eye = [0, 0, 10], target = [0, 0, 0], fov_y = 11.421186 }\nsky.radiance = [1, 1, 1]\n\
                material.grey.diffuse.albedo = [0.5, 0.5, 0.5]";
    scene::parse(text, "test", Path::new("test.toml")).unwrap()
}

fn with(shapes: Vec<Geometry>, bsdf: Bsdf) -> Scene {
    let mut scene = empty();
    scene.materials[0].bsdf = bsdf;
    scene.shapes = shapes.into_iter().map(|geometry| Shape { geometry, material: 0 }).collect();
    scene
}

fn diffuse(albedo: Texture) -> Bsdf {
    Bsdf::Diffuse { albedo }
}

fn white() -> Bsdf {
    diffuse(Texture::Constant(Vec3::ONE))
}

fn film(scene: &Scene, settings: RasterSettings) -> Film {
    let gpu = Gpu::headless().unwrap();
    let film = Raster::new(&gpu).unwrap().render(scene, &scene.camera, &settings).unwrap();
    assert_eq!((gpu.fault(), film.nonfinite), (None, 0));
    film
}

fn features(scene: &Scene) -> film::Features {
    let gpu = Gpu::headless().unwrap();
    let settings = RasterSettings::new(SIZE, SIZE);
    let features = Raster::new(&gpu).unwrap().features(scene, &scene.camera, &settings).unwrap();
    assert_eq!(gpu.fault(), None);
    features
}

/// From -1 to 1 in x and y at z = 0, facing the eye; `uv_of` says what lies at its corners.
fn quad(uv_of: impl Fn(Vec2) -> Vec2) -> Mesh {
    let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::ONE, Vec2::new(-1.0, 1.0)];
    let positions = corners.map(|c| c.extend(0.0)).to_vec();
    Mesh::with_attributes(positions, vec![[0, 1, 2], [0, 2, 3]], vec![Vec3::Z; 4], corners.map(uv_of).to_vec())
}

/// As pictures lie: (0, 0) in the upper left corner.
fn upright(corner: Vec2) -> Vec2 {
    Vec2::new(0.5 + 0.5 * corner.x, 0.5 - 0.5 * corner.y)
}

fn mesh(mesh: Mesh) -> Geometry {
    Geometry::Mesh(Arc::new(mesh))
}

/// A ball of radius 1 about the origin, of `2 * rings * rings` triangles or less.
fn ball(rings: u32, smooth: bool) -> Mesh {
    let at = |row: u32, column: u32| {
        let (theta, phi) = (row as f32 / rings as f32, 2.0 * column as f32 / rings as f32);
        let (theta, phi) = (theta * std::f32::consts::PI, phi * std::f32::consts::PI);
        Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
    };
    let positions: Vec<_> = (0..=rings).flat_map(|row| (0..=rings).map(move |column| at(row, column))).collect();
    let index = |row: u32, column: u32| row * (rings + 1) + column;
    let cell = |row, column| {
        let [a, b, c, d] =
            [index(row, column), index(row, column + 1), index(row + 1, column), index(row + 1, column + 1)];
        [[a, b, d], [a, d, c]]
    };
    let triangles = (0..rings).flat_map(|row| (0..rings).flat_map(move |column| cell(row, column))).collect();
    let normals = if smooth { positions.clone() } else { Vec::new() };
    Mesh::with_attributes(positions, triangles, normals, Vec::new())
}

fn image(sampling: Sampling) -> ImageTexture {
    let texel =
        |i: u32| [0.1 + 0.1 * i as f32, 0.9 - 0.1 * i as f32, if i.is_multiple_of(3) { 0.25 } else { 0.75 }, 1.0];
    ImageTexture::new(4, 2, (0..8).map(texel).collect(), sampling).unwrap()
}

#[test]
fn texels_are_seen_where_wrap_and_transform_put_them() {
    let turned = Mat2::from_cols(Vec2::new(0.0, 0.5), Vec2::new(-0.5, 0.0));
    let d = Sampling { bilinear: false, ..Sampling::default() };
    let samplings = [
        d,
        Sampling { wrap: [Wrap::Clamp, Wrap::Mirror], ..d },
        Sampling { wrap: [Wrap::Mirror, Wrap::Clamp], ..d },
        Sampling { turn_and_scale: turned, offset: Vec2::new(0.375, 0.25), ..d },
    ];
    for sampling in samplings {
        let image = Arc::new(image(sampling));
        // three pictures wide and high, the middle one in the middle
        let uv_of = |corner: Vec2| upright(corner) * 3.0 - 1.0;
        let factor = Vec3::new(1.0, 0.5, 1.0);
        let scene = with(vec![mesh(quad(uv_of))], diffuse(Texture::Image { image: image.clone(), factor }));
        let film = film(&scene, RasterSettings::new(SIZE, SIZE));
        let (mut seen, mut colours) = (0, Vec::new());
        for (x, y) in (2..SIZE - 2).flat_map(|y| (2..SIZE - 2).map(move |x| (x, y))) {
            let uv = |x: f32, y: f32| Vec2::new(x, y) / SIZE as f32 * 3.0 - 1.0;
            let (x0, y0) = (x as f32, y as f32);
            let around =
                [uv(x0 - 0.1, y0 - 0.1), uv(x0 + 1.1, y0 - 0.1), uv(x0 - 0.1, y0 + 1.1), uv(x0 + 1.1, y0 + 1.1)];
            let expected = around.map(|uv| image.at(uv).truncate() * factor);
            // the middle of a texel
            if expected.iter().all(|colour| *colour == expected[0]) {
                let found = film.at(x, y);
                assert!((found - expected[0]).abs().max_element() < 1e-3, "{found} is not {} at {x}, {y}", expected[0]);
                seen += 1;
                if !colours.contains(&expected[0]) {
                    colours.push(expected[0]);
                }
            }
        }
        assert!(seen > 4000 && colours.len() == 8, "{seen} pixels of {} colours", colours.len());
    }
}

/// Where texels are smaller than pixels: their mean, and not one of them.
#[test]
fn a_picture_far_away_is_its_mean() {
    let texel = |i: u32| if i.is_multiple_of(4) { [1.0; 4] } else { [0.0, 0.0, 0.0, 1.0] };
    let image =
        Arc::new(ImageTexture::new(256, 256, (0..256 * 256).map(texel).collect(), Sampling::default()).unwrap());
    // whose texels fall on other places of each pixel
    let shape = mesh(quad(|corner| upright(corner) * 8.13));
    let scene = with(vec![shape], diffuse(Texture::Image { image, factor: Vec3::ONE }));
    let film = film(&scene, RasterSettings::new(32, 32));
    let off = film.radiances().map(|radiance| (radiance - 0.25).abs().max_element()).fold(0.0, f32::max);
    assert!(off < 0.01, "{off}");
}

/// The unit normal of an ellipsoid about the origin, of these radii, where the ray through a pixel's middle meets it.
fn normal_of_ellipsoid(scene: &Scene, radii: Vec3, x: u32, y: u32) -> Option<Vec3> {
    let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / SIZE as f32;
    let d = scene.camera.frame(1.0).direction(at) / radii;
    let o = scene.camera.eye / radii;
    let (a, half_b, c) = (d.length_squared(), o.dot(d), o.length_squared() - 1.0);
    let root = half_b * half_b - a * c;
    // well within the silhouette
    (root > 0.2 * half_b * half_b * c / o.length_squared() / 50.0)
        .then(|| ((o - d * ((half_b + root.sqrt()) / a)) / radii).normalize())
}

#[track_caller]
fn assert_normals(scene: &Scene, radii: Vec3, within: f32) {
    let features = features(scene);
    let mut seen = 0;
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        let Some(expected) = normal_of_ellipsoid(scene, radii, x, y).filter(|n| n.z > 0.3) else { continue };
        let found = features.normal[(y * SIZE + x) as usize];
        assert!((found - expected).abs().max_element() < within, "{found} is not {expected} at {x}, {y}");
        seen += 1;
    }
    assert!(seen > 400, "{seen}");
}

#[test]
fn smooth_meshes_have_the_normals_of_the_ball_that_they_stand_for() {
    for rings in [40, 120] {
        let ball = Arc::new(ball(rings, true));
        assert_eq!(ball.is_large(), rings == 120);
        let scene = with(vec![Geometry::Mesh(ball.clone())], white());
        assert_normals(&scene, Vec3::ONE, 0.03);
        // squeezed, turned and mirrored
        let radii = Vec3::new(0.9, 0.5, 0.7);
        let turn = Affine3A::from_quat(Quat::from_rotation_y(0.8));
        let to_world = Affine3A::from_scale(radii * Vec3::new(1.0, -1.0, 1.0)) * turn;
        assert_normals(&with(vec![Geometry::Instance(Instance { mesh: ball, to_world })], white()), radii, 0.05);
    }
}

#[test]
fn a_large_mesh_without_normals_has_those_of_its_triangles() {
    let [large, small] = [128, 40].map(|rings| features(&with(vec![mesh(ball(rings, false))], white())).normal);
    assert!(ball(128, false).is_large() && !ball(40, false).is_large());
    let lengths = large.iter().filter(|normal| normal.z > 0.5).map(|normal| normal.length());
    assert!(lengths.fold(1.0, f32::min) > 0.99);
    // of facets a 128th of half a turn wide, and a 40th
    let scene = with(vec![mesh(ball(128, false))], white());
    assert_normals(&scene, Vec3::ONE, 0.06);
    assert_ne!(large, small);
}

/// A sheet that shines towards the eye alone, and is dark behind.
#[test]
fn a_mirrored_instance_shows_its_front() {
    for large in [false, true] {
        let sheet = if large { ball(100, true) } else { quad(upright) };
        let sheet = Arc::new(sheet);
        assert_eq!(sheet.is_large(), large);
        for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::new(-0.5, -0.5, 1.0), Vec3::new(1.0, 1.0, -1.0)] {
            let to_world = Affine3A::from_scale(scale);
            let mut scene = with(vec![Geometry::Instance(Instance { mesh: sheet.clone(), to_world })], white());
            scene.sky = Vec3::ZERO;
            scene.materials[0].emission = Some(Emission { radiance: Vec3::splat(3.0), two_sided: false });
            let seen = film(&scene, RasterSettings::new(SIZE, SIZE)).at(SIZE / 2, SIZE / 2);
            // turned about by its z the sheet shows its back, and a ball never
            let front = large || scale.z > 0.0;
            assert_eq!(seen, if front { Vec3::splat(3.0) } else { Vec3::ZERO }, "{scale}, large: {large}");
        }
    }
}

/// A sheet, whose left half is cut out, stands between the sun and a wall.
#[test]
fn an_alpha_mask_is_cut_out_of_the_picture_its_shadow_and_its_features() {
    let texels = (0..64).map(|i| [1.0, 1.0, 1.0, if i % 8 < 4 { 0.2 } else { 0.9 }]).collect();
    let sampling = Sampling { wrap: [Wrap::Clamp; 2], ..Sampling::default() };
    let picture = Arc::new(ImageTexture::new(8, 8, texels, sampling).unwrap());
    let wall = Geometry::Rectangle {
        corner: Vec3::new(-1.0, -1.0, -0.5),
        edge_u: Vec3::new(2.0, 0.0, 0.0),
        edge_v: Vec3::new(0.0, 2.0, 0.0),
    };
    let mut scene = with(vec![wall, mesh(quad(upright))], white());
    let mut red = scene.materials[0].clone();
    red.bsdf = diffuse(Texture::Constant(Vec3::X));
    red.surface.alpha = Alpha::Mask { cutoff: 0.5, factor: 1.0, image: Some(picture) };
    scene.materials.push(red);
    let mut shapes = scene.shapes.to_vec();
    shapes[1].material = 1;
    scene.shapes = shapes.into();
    // from the right: the sheet's shadow falls half of the distance to the left
    let towards = Vec3::new(1.0, 0.0, 1.0).normalize();
    scene.sun = Some(Sun { towards, angular_radius: 0.0, irradiance: Vec3::splat(std::f32::consts::PI) });
    (scene.sky, scene.fake.ambient, scene.fake.shadow_map) = (Vec3::ZERO, 0.0, 1024);
    for fake in Fake::ALL {
        let picture = film(&scene, RasterSettings { fake, ..RasterSettings::new(SIZE, SIZE) });
        let at = |x: f32| picture.at(((0.5 + 0.5 * x) * SIZE as f32) as u32, SIZE / 2);
        // red on the right; on the left the wall: lit but for a strip a half wide, on which the sheet's red half lies
        // but for a highlight
        assert!(at(0.5).y < 0.05 && at(0.5).x > 0.4, "{fake:?}: {}", at(0.5));
        assert!(at(-0.75).min_element() > 0.4, "{fake:?}: {}", at(-0.75));
        assert!(at(-0.25).max_element() == 0.0, "{fake:?}: {}", at(-0.25));
    }
    let features = features(&scene);
    let at = |x: f32| ((0.5 + 0.5 * x) * SIZE as f32) as usize + (SIZE * SIZE / 2) as usize;
    assert_eq!([features.albedo[at(0.5)], features.albedo[at(-0.5)]], [Vec3::X, Vec3::ONE]);
    assert!((features.depth[at(0.1)] - 10.0).abs() < 0.05 && (features.depth[at(-0.1)] - 10.5).abs() < 0.05);
    // a mask without a picture leaves all or nothing
    for (factor, seen) in [(0.4, Vec3::ONE), (0.6, Vec3::X)] {
        scene.materials[1].surface.alpha = Alpha::Mask { cutoff: 0.5, factor, image: None };
        assert_eq!(self::features(&scene).albedo[at(-0.5)], seen);
    }
}

/// Tilted by as much along u, which goes to the right in the picture or, mirrored, to the left.
#[test]
fn normal_maps_tilt_along_the_places_in_pictures() {
    let tilted = Vec3::new(0.6, 0.0, 0.8);
    for (texel, mirrored, scale, expected) in [
        (tilted, false, 1.0, tilted),
        (tilted, true, 1.0, Vec3::new(-0.6, 0.0, 0.8)),
        (Vec3::new(0.0, 0.6, 0.8), false, 1.0, Vec3::new(0.0, 0.6, 0.8)),
        (Vec3::new(0.0, 0.6, 0.8), true, 1.0, Vec3::new(0.0, 0.6, 0.8)),
        (tilted, false, 0.5, Vec3::new(0.3, 0.0, 0.8).normalize()),
    ] {
        let uv_of = |corner: Vec2| upright(if mirrored { corner * Vec2::new(-1.0, 1.0) } else { corner });
        let mut scene = with(vec![mesh(quad(uv_of))], white());
        let texels = vec![(0.5 + 0.5 * texel).extend(1.0).to_array()];
        let image = Arc::new(ImageTexture::new(1, 1, texels, Sampling::default()).unwrap());
        scene.materials[0].surface.normal_map = Some(NormalMap { image, scale });
        let found = features(&scene).normal[(SIZE * SIZE / 2 + SIZE / 2) as usize];
        assert!((found - expected).abs().max_element() < 2e-3, "{found} is not {expected}");
        // the quad without places in pictures keeps its own normal
        let flat =
            Mesh::new(scene.shapes[0].geometry.mesh_of().unwrap().positions().to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
        scene.shapes = [Shape { geometry: mesh(flat), material: 0 }].into();
        assert_eq!(features(&scene).normal[(SIZE * SIZE / 2 + SIZE / 2) as usize], Vec3::Z);
    }
}

/// glTF 2.0, appendix B, written out in f64: what is sent back of light of irradiance pi on a surface that faces it.
fn gltf([n, l, v]: [[f64; 3]; 3], base: [f64; 3], metallic: f64, roughness: f64, ior: f64) -> [f64; 3] {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let sum = [l[0] + v[0], l[1] + v[1], l[2] + v[2]];
    let h = sum.map(|x| x / dot(sum, sum).sqrt());
    let (n_l, n_v, n_h, v_h) = (dot(n, l), dot(n, v), dot(n, h), dot(v, h));
    let square = roughness.powi(4);
    let distribution = square / (std::f64::consts::PI * (n_h * n_h * (square - 1.0) + 1.0).powi(2));
    let masked = |a: f64, b: f64| a * (b * b * (1.0 - square) + square).sqrt();
    let specular = distribution * 0.5 / (masked(n_l, n_v) + masked(n_v, n_l));
    let schlick = |f0: f64| f0 + (1.0 - f0) * (1.0 - v_h).powi(5);
    let coat = schlick(((ior - 1.0) / (ior + 1.0)).powi(2));
    base.map(|base| {
        let dielectric = (1.0 - coat) * base / std::f64::consts::PI + coat * specular;
        std::f64::consts::PI * n_l * ((1.0 - metallic) * dielectric + metallic * schlick(base) * specular)
    })
}

#[test]
fn metallic_roughness_is_gltfs_formula_under_the_sun() {
    let (base, l) = (Vec3::new(0.9, 0.6, 0.2), Vec3::new(0.48, 0.36, 0.8));
    for (metallic, roughness) in [(0.0, 0.4), (1.0, 0.3), (0.35, 0.7)] {
        for pictures in [false, true] {
            // with pictures half of both numbers comes from them
            let share = if pictures { 2.0 } else { 1.0 };
            let texel =
                |texel: Vec4| Arc::new(ImageTexture::new(1, 1, vec![texel.to_array()], Sampling::default()).unwrap());
            let model = MetallicRoughness {
                base_colour: match pictures {
                    false => Texture::Constant(base),
                    true => Texture::Image { image: texel((0.5 * base).extend(1.0)), factor: Vec3::splat(2.0) },
                },
                metallic: metallic * share,
                roughness: roughness * share,
                metallic_roughness: pictures.then(|| texel(Vec4::new(0.1, 0.5, 0.5, 1.0))),
                ior: 1.6,
            };
            let mut scene = with(vec![mesh(quad(upright))], Bsdf::MetallicRoughness(model));
            scene.sun = Some(Sun { towards: l, angular_radius: 0.0, irradiance: Vec3::splat(std::f32::consts::PI) });
            scene.sky = Vec3::ZERO;
            let chosen = |shading| RasterSettings { shading, ..RasterSettings::new(SIZE, SIZE) };
            let picture = film(&scene, chosen(Shading::Three));
            assert_eq!(picture, film(&scene, chosen(Shading::CookTorrance)));
            assert_ne!(picture, film(&scene, chosen(Shading::BlinnPhong)));
            for (x, y) in [(20, 30), (48, 48), (70, 80)] {
                let d = scene.camera.frame(1.0).direction(Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / SIZE as f32);
                let double = |v: Vec3| v.to_array().map(f64::from);
                let directions = [double(Vec3::Z), double(l), double(-d)];
                let expected = gltf(directions, double(base), metallic.into(), roughness.into(), 1.6);
                let found = double(picture.at(x, y));
                let off = (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f64::max);
                // half floats, and the mean of four places in the pixel
                assert!(off < 2e-3, "{found:?} is not {expected:?} at {x}, {y}");
            }
        }
    }
}

#[test]
fn the_light_that_glows_in_places_is_a_pictures() {
    let texels = vec![[1.0, 0.5, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0]];
    let sampling = Sampling { bilinear: false, ..Sampling::default() };
    let mut scene = with(vec![mesh(quad(upright))], diffuse(Texture::Constant(Vec3::ZERO)));
    scene.sky = Vec3::ZERO;
    scene.materials[0].emission = Some(Emission { radiance: Vec3::splat(4.0), two_sided: false });
    scene.materials[0].surface.emission = Some(Arc::new(ImageTexture::new(2, 1, texels, sampling).unwrap()));
    let film = film(&scene, RasterSettings::new(SIZE, SIZE));
    assert_eq!(film.at(SIZE / 4, SIZE / 2), Vec3::new(4.0, 2.0, 0.0));
    assert_eq!(film.at(3 * SIZE / 4, SIZE / 2), Vec3::ZERO);
}

/// A ball of 28,800 triangles, shown nine times: another ball of the same mesh takes no more memory, and moving one brings
/// nothing new to the device.
#[test]
fn moved_instances_look_as_from_a_fresh_start() {
    let gpu = Gpu::headless().unwrap();
    let mut raster = Raster::new(&gpu).unwrap();
    let ball = Arc::new(ball(120, true));
    let scene = |x: f32| {
        // the outer ones stay, and so does what light and shadow map cover
        let column = |i: i32| if i % 3 == 1 { x } else { (i % 3 - 1) as f32 * 0.6 };
        let place = |i: i32| {
            let at = Vec3::new(column(i), (i / 3 - 1) as f32 * 0.6, 0.0);
            Affine3A::from_scale_rotation_translation(Vec3::splat(0.25), Quat::IDENTITY, at)
        };
        let instance = |i| Geometry::Instance(Instance { mesh: ball.clone(), to_world: place(i) });
        let mut scene = with((0..9).map(instance).collect(), white());
        scene.sun = Some(Sun { towards: Vec3::new(0.6, 0.0, 0.8), angular_radius: 0.0, irradiance: Vec3::splat(3.0) });
        scene
    };
    let settings = RasterSettings::new(SIZE, SIZE);
    let mut seen = |scene: &Scene| raster.render(scene, &scene.camera, &settings).unwrap();
    let films = [0.0, -0.1].map(|x| seen(&scene(x)));
    assert_ne!(films[0], films[1]);
    assert_eq!(films[1], film(&scene(-0.1), settings));
}
