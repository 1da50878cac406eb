//! Meshes as they are: smooth normals, pictures, holes and normal maps, against closed forms and against shapes that
//! need none of it.

#![expect(clippy::expect_used, reason = "a test stops at the first thing that is not as it must be")]

mod device;
mod grazing;
mod subjects;

use film::Film;
use pathtrace::{
    DirectLight, Estimator, FeaturePass, Lanes, LightTracingSettings, PathSettings, PhotonSettings, SamplerKind,
    Tracer, WhittedSettings,
};
use scene::glam::{Affine3A, Quat, Vec4};
use scene::{Alpha, Bsdf, Geometry, Instance, Mesh, MetallicRoughness, NormalMap, Scene, Shape, Texture, Vec3};
use std::sync::Arc;
use subjects::{SUN, WHITE, apart, ball, ball_under, globe, grey, picture, plain, render, sheet, with_mesh};

const SIZE: (u32, u32) = (48, 48);

fn mis() -> PathSettings {
    PathSettings { estimator: Estimator::MIS, ..PathSettings::default() }
}

/// Triangles leave out .3 % of the disc that the ball fills, and their terminator reaches further into the light
/// than the ball's own.
#[test]
fn smooth_triangles_are_lit_as_the_ball_that_they_stand_for() {
    let round = ball_under(SUN, WHITE);
    let truth = render(&round, SIZE, 64, mis());
    let [smooth, flat] =
        [true, false].map(|smooth| render(&with_mesh(round.clone(), 0, ball(smooth)), SIZE, 64, mis()));
    let of_whitted = render(&with_mesh(round.clone(), 0, ball(true)), SIZE, 64, WhittedSettings::default());
    let whitted = render(&round, SIZE, 64, WhittedSettings::default());
    println!("mean {} {} {}", grey(&truth), grey(&smooth), grey(&flat));
    println!("apart {} {} {}", apart(&smooth, &truth), apart(&flat, &truth), apart(&of_whitted, &whitted));
    assert!((grey(&smooth) / grey(&truth) - 1.0).abs() < 0.01, "{} {}", grey(&smooth), grey(&truth));
    assert!((grey(&of_whitted) / grey(&whitted) - 1.0).abs() < 0.01);
    assert!(apart(&smooth, &truth) < 0.7 * apart(&flat, &truth));
}

/// What a mirror shows of a sky whose radiance differs from texel to texel: facets show a few of them, a smooth one all.
#[test]
fn a_smooth_mirror_of_triangles_shows_what_a_round_one_does() {
    let mut round = ball_under("", "mirror = { reflectance = [1, 1, 1] }");
    let texels = (0..16 * 8).map(|i| Vec3::new((i % 16) as f32, (i / 16) as f32, ((i * 7) % 13) as f32) / 10.0);
    let image = film::Image::new(16, 8, texels.collect::<Vec<_>>()).expect("as many texels as it says");
    round.environment = Some(Arc::new(scene::EnvironmentMap::new(image, 1.0, 0.0).expect("a sky")));
    for (name, settings) in [("path", mis().into()), ("whitted", WhittedSettings::default().into())] {
        let settings: pathtrace::Integrator = settings;
        let truth = render(&round, SIZE, 64, settings);
        let [smooth, flat] =
            [true, false].map(|smooth| render(&with_mesh(round.clone(), 0, ball(smooth)), SIZE, 64, settings));
        println!("{name}: {} {}", apart(&smooth, &truth), apart(&flat, &truth));
        assert!(apart(&smooth, &truth) < 0.4 * apart(&flat, &truth), "{name}");
        assert!((grey(&smooth) / grey(&truth) - 1.0).abs() < 0.01, "{name}");
    }
}

/// What glass of triangles does to a picture, against the ball's: refraction goes by the smooth normals too.
#[test]
fn smooth_glass_of_triangles_refracts_as_a_ball_does() {
    let mut round = ball_under("", "dielectric = { ior = 1.5 }");
    let texels = (0..16 * 8).map(|i| Vec3::splat(((i % 16) + (i / 16)) as f32 / 10.0));
    let image = film::Image::new(16, 8, texels.collect::<Vec<_>>()).expect("as many texels as it says");
    round.environment = Some(Arc::new(scene::EnvironmentMap::new(image, 1.0, 0.0).expect("a sky")));
    let truth = render(&round, SIZE, 64, mis());
    let [smooth, flat] =
        [true, false].map(|smooth| render(&with_mesh(round.clone(), 0, ball(smooth)), SIZE, 64, mis()));
    println!("glass: {} {}, {} {}", apart(&smooth, &truth), apart(&flat, &truth), grey(&smooth), grey(&truth));
    assert!(apart(&smooth, &truth) < 0.6 * apart(&flat, &truth));
    assert!((grey(&smooth) / grey(&truth) - 1.0).abs() < 0.02);
}

/// Light that shading normals send into the surface is lost, and none is made: of the coarser ball more.
#[test]
fn a_white_furnace_with_smooth_normals_loses_little_and_makes_nothing() {
    let furnace = ball_under("[sky]\nradiance = [1, 1, 1]", WHITE);
    for (mesh, least) in [(ball(true), 0.99), (globe(16, 8, true), 0.93)] {
        for estimator in [Estimator::COSINE, Estimator::UNIFORM] {
            let settings = PathSettings { estimator, sampler: SamplerKind::Independent, ..PathSettings::default() };
            let copies = Mesh::with_attributes(
                mesh.positions().to_vec(),
                mesh.triangles().to_vec(),
                mesh.normals().to_vec(),
                Vec::new(),
            );
            let film = render(&with_mesh(furnace.clone(), 0, copies), (32, 32), 256, settings);
            let (mean, error) = (grey(&film), film.standard_error()[0]);
            println!("furnace {estimator:?}: {mean} +- {error}");
            assert!(mean <= 1.0 + 4.0 * error && mean >= least, "{estimator:?}: {mean} +- {error}");
        }
    }
}

/// The ball is closed: whatever its normals say, no light comes in.
#[test]
fn no_light_leaks_through_smooth_normals() {
    let mut inside =
        with_mesh(ball_under(&format!("{SUN}\n[sky]\nradiance = [1, 1, 1]"), WHITE), 0, globe(16, 8, true));
    inside.camera.eye = Vec3::new(0.0, 0.0, 0.3);
    inside.camera.fov_y = 120.0;
    for integrator in [mis().into(), PathSettings { estimator: Estimator::COSINE, ..mis() }.into()] {
        let integrator: pathtrace::Integrator = integrator;
        assert_eq!(grey(&render(&inside, SIZE, 64, integrator)), 0.0, "{integrator:?}");
    }
    inside.fake.ambient = 0.0;
    assert_eq!(grey(&render(&inside, SIZE, 16, WhittedSettings::default())), 0.0);
}

/// Photons walk against the way that lobes are made for, and bring as much light as paths find.
#[test]
fn photons_on_smooth_normals_bring_what_paths_find() {
    let lit = "[[point_light]]\nposition = [3, 2, 3]\nintensity = [30, 30, 30]";
    let mut scene = with_mesh(ball_under(lit, "diffuse = { albedo = [0.8, 0.8, 0.8] }"), 0, globe(16, 8, true));
    // a floor that sends light back
    scene.shapes = scene.shapes.iter().cloned().chain([floor(-1.2, 0)]).collect();
    let truth = grey(&render(&scene, SIZE, 256, mis()));
    let maps = DirectLight::ALL.map(|direct| PhotonSettings {
        direct,
        photons: 1 << 15,
        radius: Some(0.05),
        ..PhotonSettings::default()
    });
    for settings in maps {
        let found = grey(&render(&scene, SIZE, 16, settings));
        println!("{settings:?}: {found} {truth}");
        // a disc of photons reaches beyond edges: a few hundredths
        assert!((found / truth - 1.0).abs() < 0.03, "{settings:?}: {found} {truth}");
    }
    let settings = LightTracingSettings { photons: 1 << 17, ..LightTracingSettings::default() };
    let found = grey(&render(&scene, SIZE, 16, settings));
    println!("{found} {truth}");
    assert!((found / truth - 1.0).abs() < 0.01, "light tracing: {found} {truth}");
}

fn floor(y: f32, material: usize) -> Shape {
    let mesh = sheet(Vec3::new(-3.0, y, 3.0), Vec3::X * 6.0, Vec3::Z * -6.0, 1);
    Shape { geometry: Geometry::Mesh(Arc::new(mesh)), material }
}

/// A sheet before the camera that fills the picture, whose material is called `ball`.
fn poster(light: &str, cells: u32) -> Scene {
    let mut scene = ball_under(light, WHITE);
    // half of the height over the distance is the tangent of half the angle
    let half = 6.0 * (12f32).to_radians().tan();
    let mesh = sheet(Vec3::new(-half, -half, 0.0), Vec3::X * 2.0 * half, Vec3::Y * 2.0 * half, cells);
    scene = with_mesh(scene, 0, mesh);
    scene
}

fn gradient() -> Arc<scene::ImageTexture> {
    let texel = |i: u32| [i as f32 / 12.0, (11 - i) as f32 / 12.0, (i * i % 7) as f32 / 7.0, 1.0];
    picture(4, &(0..12).map(texel).collect::<Vec<_>>(), true)
}

/// The camera's features show a picture where it hangs, upright, among few shapes and in trees of both kinds.
#[test]
fn a_picture_hangs_upright_on_its_sheet() {
    let image = gradient();
    for cells in [1, 7, 12] {
        let mut scene = poster("", cells);
        scene.materials[0].bsdf =
            Bsdf::Diffuse { albedo: Texture::Image { image: image.clone(), factor: Vec3::new(1.0, 0.5, 1.0) } };
        let pass = FeaturePass::new(&scene.camera, SIZE, 256, (SamplerKind::Sobol, 1));
        let seen = Tracer::new(&scene).features(&pass, &|| false).expect("nobody stops it");
        for (index, albedo) in seen.albedo.iter().enumerate() {
            let at = |k: usize| {
                let [x, y] = [index % 48, index / 48].map(|pixel| pixel as f32);
                scene::glam::Vec2::new(x + (k % 8) as f32 / 8.0 + 0.06, y + (k / 8) as f32 / 8.0 + 0.06) / 48.0
            };
            let mean: Vec3 = (0..64).map(|k| image.at(at(k)).truncate() / 64.0).sum();
            let expected = mean * Vec3::new(1.0, 0.5, 1.0);
            assert!(albedo.abs_diff_eq(expected, 0.01), "{cells}: pixel {index}: {albedo}, expected {expected}");
        }
    }
}

/// A lamp of two texels, of which one is black, lights a floor as the half that shines does: sampled by light, met by
/// chance, and by photons.
#[test]
fn a_lamp_wears_a_picture() {
    let lamp = |half: bool, cells: u32| {
        let mut scene = ball_under("", "emissive = { radiance = [4, 4, 4] }");
        let start = if half { 0.0 } else { -1.0 };
        // it shines down
        let mesh = sheet(Vec3::new(start, 1.0, -1.0), Vec3::X * (1.0 - start), Vec3::Z * 2.0, cells);
        scene = with_mesh(scene, 0, mesh);
        let mut white = scene.materials[0].clone();
        white.emission = None;
        white.bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::splat(0.5)) };
        scene.materials.push(white);
        scene.shapes = scene.shapes.iter().cloned().chain([floor(-1.0, 1)]).collect();
        if !half {
            scene.materials[0].surface.emission =
                Some(picture(2, &[[0.0, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, 1.0]], false));
        }
        scene
    };
    for cells in [1, 10] {
        let (half, whole) = (lamp(true, cells), lamp(false, cells));
        let truth = grey(&render(&half, SIZE, 256, mis()));
        let estimators = [Estimator::MIS, Estimator::LIGHT, Estimator::COSINE];
        for estimator in estimators {
            let found = grey(&render(&whole, SIZE, 256, PathSettings { estimator, ..mis() }));
            println!("{cells} {estimator:?}: {found} {truth}");
            assert!((found / truth - 1.0).abs() < 0.01, "{cells} {estimator:?}: {found} {truth}");
        }
        let whitted = [&half, &whole].map(|scene| grey(&render(scene, SIZE, 64, WhittedSettings::default())));
        assert!((whitted[1] / whitted[0] - 1.0).abs() < 0.01, "{cells} whitted: {whitted:?}");
        let settings = LightTracingSettings { photons: 1 << 16, ..LightTracingSettings::default() };
        let found = grey(&render(&whole, SIZE, 16, settings));
        assert!((found / truth - 1.0).abs() < 0.01, "{cells} light tracing: {found} {truth}");
    }
}

/// A sheet with a hole in its right half, and half a sheet: in sight, in their shadow, as lamps.
#[test]
fn holes_are_no_surface() {
    let half = 6.0 * (12f32).to_radians().tan();
    for (cells, light, material) in
        [(1, SUN, WHITE), (12, SUN, WHITE), (12, "", "emissive = { radiance = [4, 4, 4], two_sided = true }")]
    {
        let stand = |width: f32| {
            let mesh = sheet(Vec3::new(-half, -half, 0.5), Vec3::X * width, Vec3::Y * 2.0 * half, cells);
            let mut scene = with_mesh(ball_under(light, material), 0, mesh);
            let mut white = ball_under("", "diffuse = { albedo = [0.5, 0.5, 0.5] }").materials[0].clone();
            white.name = "wall".to_owned();
            scene.materials.push(white);
            let wall = sheet(Vec3::new(-4.0, -4.0, -0.5), Vec3::X * 8.0, Vec3::Y * 8.0, 1);
            let wall = Shape { geometry: Geometry::Mesh(Arc::new(wall)), material: 1 };
            scene.shapes = scene.shapes.iter().cloned().chain([wall]).collect();
            scene
        };
        let (mut masked, cut) = (stand(2.0 * half), stand(half));
        let image = Some(picture(2, &[[1.0; 4], [1.0, 1.0, 1.0, 0.4]], false));
        masked.materials[0].surface.alpha = Alpha::Mask { cutoff: 0.5, factor: 1.0, image };
        for (name, integrator) in [
            ("path", mis().into()),
            ("whitted", WhittedSettings { shadow_rays: 4, ..WhittedSettings::default() }.into()),
        ] {
            let integrator: pathtrace::Integrator = integrator;
            let [masked, cut] = [&masked, &cut].map(|scene| render(scene, SIZE, 256, integrator));
            println!("{cells} {name}: {} {}, {}", grey(&masked), grey(&cut), apart(&masked, &cut));
            assert!((grey(&masked) / grey(&cut) - 1.0).abs() < 0.01, "{cells} {name}");
            assert!(apart(&masked, &cut) < 0.03 * grey(&cut), "{cells} {name}");
        }
    }
}

/// Without any alpha there is nothing at all.
#[test]
fn a_ball_without_alpha_is_not_there() {
    let mut scene = ball_under("[sky]\nradiance = [1, 1, 1]", "diffuse = { albedo = [0, 0, 0] }");
    scene.materials[0].surface.alpha = Alpha::Mask { cutoff: 0.5, factor: 0.4, image: None };
    assert_eq!(grey(&render(&scene, SIZE, 1, mis())), 1.0);
}

/// What a white sheet across z sends back of light of irradiance pi from `sun` where it is shaded by `normal`: the cosine,
/// and where the sheet itself faces the light less than that says, less (Chiang, Li and Burley 2019).
fn lit(normal: Vec3, sun: Vec3) -> f64 {
    let cosine = f64::from(normal.dot(sun));
    let ratio = (f64::from(sun.z) / (cosine * f64::from(normal.z))).min(1.0);
    cosine * (ratio + ratio.powi(2) - ratio.powi(3))
}

/// A map of one normal that leans to the right, or up: lit as a sheet that leans so, also where the picture is mirrored
/// and where the sheet is an instance that mirrors.
#[test]
fn a_normal_map_leans_the_way_that_it_says() {
    let lean = 0.3f32;
    // the normal as colours
    let leaning = |x: f32, y: f32| Vec4::new(0.5 + 0.5 * x, 0.5 + 0.5 * y, 0.5 + 0.5 * lean.cos(), 1.0);
    let sun = Vec3::new(0.5, 0.3, 1.0).normalize();
    let light = "[sun]\ntowards = [0.5, 0.3, 1]\nangular_radius = 0\nirradiance = [3.1415927, 3.1415927, 3.1415927]";
    for (map, normal) in [
        (leaning(lean.sin(), 0.0), Vec3::new(lean.sin(), 0.0, lean.cos())),
        (leaning(0.0, lean.sin()), Vec3::new(0.0, lean.sin(), lean.cos())),
    ] {
        let mut scene = poster(light, 1);
        scene.materials[0].surface.normal_map = Some(NormalMap { image: plain(map), scale: 1.0 });
        let found = grey(&render(&scene, (4, 4), 16, mis()));
        let expected = lit(normal, sun);
        println!("{normal}: {found} {expected}");
        assert!((found - expected).abs() < 1e-4, "{normal}: {found}, expected {expected}");
        // left and right of the picture change places: its normals lean the other way
        let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let mesh = scene.shapes[0].geometry.mesh_of().expect("a sheet").clone();
        let shape = Shape { geometry: Geometry::Instance(Instance { mesh, to_world: mirror }), material: 0 };
        scene.shapes = [shape].into();
        let found = grey(&render(&scene, (4, 4), 16, mis()));
        let expected = lit(normal * Vec3::new(-1.0, 1.0, 1.0), sun);
        assert!((found - expected).abs() < 1e-4, "mirrored {normal}: {found}, expected {expected}");
    }
}

/// An instance of a small mesh wears its normals where it stands.
#[test]
fn normals_of_an_instance_turn_with_it() {
    let turn = Affine3A::from_quat(Quat::from_euler(scene::glam::EulerRot::XYZ, 0.4, 1.1, -0.3));
    let round = with_mesh(ball_under(SUN, WHITE), 0, ball(true));
    let mesh = round.shapes[0].geometry.mesh_of().expect("a ball").clone();
    let shape = Shape { geometry: Geometry::Instance(Instance { mesh, to_world: turn }), material: 0 };
    let turned = Scene { shapes: [shape].into(), ..round.clone() };
    let [round, turned] = [&round, &turned].map(|scene| render(scene, SIZE, 64, mis()));
    assert!(apart(&round, &turned) < 0.02, "{}", apart(&round, &turned));
}

/// All of it in one scene, for the tests that compare machines and lanes.
pub fn everything() -> Scene {
    let light = format!("{SUN}\n[sky]\nradiance = [0.2, 0.3, 0.4]");
    let mut scene = with_mesh(ball_under(&light, "diffuse = { albedo = [0.8, 0.7, 0.6] }"), 0, ball(true));
    let mut materials: Vec<_> = (0..6).map(|_| scene.materials[0].clone()).collect();
    materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Image { image: gradient(), factor: Vec3::splat(0.9) } };
    let bumps = [[0.6, 0.5, 1.0, 1.0], [0.5, 0.4, 1.0, 1.0], [0.4, 0.5, 1.0, 1.0], [0.5, 0.6, 1.0, 1.0]];
    materials[1].surface.normal_map = Some(NormalMap { image: picture(2, &bumps, true), scale: 0.8 });
    let holes = [[1.0; 4], [1.0, 1.0, 1.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0; 4]];
    materials[2].surface.alpha = Alpha::Mask { cutoff: 0.5, factor: 1.0, image: Some(picture(2, &holes, true)) };
    materials[3].emission = Some(scene::material::Emission { radiance: Vec3::splat(3.0), two_sided: false });
    materials[3].surface.emission = Some(gradient());
    materials[4].bsdf = Bsdf::Mirror { reflectance: Vec3::splat(0.9) };
    let base_colour = Texture::Image { image: gradient(), factor: Vec3::splat(0.9) };
    materials[5].bsdf = Bsdf::MetallicRoughness(MetallicRoughness {
        base_colour,
        metallic: 0.2,
        roughness: 0.4,
        metallic_roughness: None,
        ior: 1.5,
    });
    materials[5].surface.normal_map = Some(NormalMap { image: picture(2, &bumps, true), scale: 5.0 });
    scene.materials = materials;
    let at = |x: f32, y: f32, size: f32, mesh: Mesh, material: usize| {
        let to_world = Affine3A::from_scale_rotation_translation(
            Vec3::splat(size),
            Quat::from_rotation_y(0.5),
            Vec3::new(x, y, 0.3),
        );
        let geometry = Geometry::Instance(Instance { mesh: Arc::new(mesh), to_world });
        Shape { geometry, material }
    };
    let small = |x: f32, y: f32, material: usize| Shape {
        geometry: Geometry::Mesh(Arc::new(sheet(Vec3::new(x, y, 0.9), Vec3::X * 0.5, Vec3::Y * 0.5, 2))),
        material,
    };
    let mut shapes = vec![at(-0.4, 0.1, 0.5, globe(24, 12, true), 0), at(0.7, 0.1, 0.4, globe(12, 6, true), 4)];
    shapes.push(at(0.15, 0.9, 0.3, globe(12, 6, true), 5));
    shapes.extend([floor(-0.6, 1), small(-0.9, 0.3, 2), small(0.2, 0.5, 3)]);
    scene.shapes = shapes.into();
    scene
}

#[test]
fn all_lanes_see_the_same_meshes() {
    let scene = everything();
    for (name, integrator) in integrators() {
        let traced = |lanes: Lanes| {
            let mut film = Film::new(37, 29);
            let tracer = Tracer::new(&scene).with_lanes(lanes);
            tracer.render(&mut film, &scene.camera, &integrator, 4, &|| false);
            film.radiances().map(|radiance| radiance.to_array().map(f32::to_bits)).collect::<Vec<_>>()
        };
        let films: Vec<_> = Lanes::available().map(traced).collect();
        assert!(films.iter().all(|film| *film == films[0]), "{name}");
    }
}

/// Of those that both machines know.
pub fn integrators() -> [(&'static str, pathtrace::Integrator); 3] {
    let photons = PhotonSettings { photons: 1 << 13, radius: Some(0.05), ..PhotonSettings::default() };
    [("path", mis().into()), ("whitted", WhittedSettings::default().into()), ("photons", photons.into())]
}
