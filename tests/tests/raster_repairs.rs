//! The fake's repairs against rays: glass and mirror against Whitted's trees of rays, caustics and shadows against path tracing.

use film::{Film, colour};
use gpu::Gpu;
use pathtrace::{PathSettings, Tracer};
use raster::{FakeKnobs, GatherKnobs, PatchClamp, Raster, RasterSettings, Repair, Repairs, TextureFilter};
use scene::{Geometry, Scene, Vec3, builtin};
use std::path::Path;

const SIZE: (u32, u32) = (160, 90);

/// Where a quarter of the size is not to be too coarse.
const LARGER: (u32, u32) = (320, 240);

fn fake(scene: &Scene, repairs: Repairs) -> Film {
    fake_of(scene, (repairs, FakeKnobs::default()), SIZE)
}

fn fake_of(scene: &Scene, (repairs, knobs): (Repairs, FakeKnobs), (width, height): (u32, u32)) -> Film {
    let gpu = Gpu::headless().expect("a device");
    let settings = RasterSettings { repairs, knobs, ..RasterSettings::new(width, height) };
    let film = Raster::new(&gpu).expect("a rasteriser").render(scene, &scene.camera, &settings).expect("a picture");
    assert_eq!(film.nonfinite, 0);
    film
}

fn truth(scene: &Scene, spp: u32) -> Film {
    traced(scene, PathSettings::default(), spp, SIZE)
}

/// What paths of so many bounces make.
fn of_bounces(scene: &Scene, bounces: u32, spp: u32, size: (u32, u32)) -> Film {
    traced(scene, PathSettings { bounces: Some(bounces), ..PathSettings::default() }, spp, size)
}

fn traced(scene: &Scene, settings: PathSettings, spp: u32, (width, height): (u32, u32)) -> Film {
    let mut film = Film::new(width, height);
    Tracer::new(scene).render(&mut film, &scene.camera, &settings.into(), spp, &|| false);
    film
}

fn radiances(film: &Film) -> Vec<Vec3> {
    film.image().radiances().to_vec()
}

/// Mean over all channels of the squared error relative to the truth's square, as the ruler has it.
fn rel_mse(film: &Film, truth: &Film) -> f64 {
    let (a, b) = (radiances(film), radiances(truth));
    let of = |(a, b): (&Vec3, &Vec3)| ((*a - *b) * (*a - *b) / (*b * *b + 0.01)).element_sum() / 3.0;
    a.iter().zip(&b).map(|pair| f64::from(of(pair))).sum::<f64>() / a.len() as f64
}

fn set(repairs: &[Repair]) -> Repairs {
    repairs.iter().copied().collect()
}

/// Of 1.0 that the fair fake is off, .024 stay at this size: aliasing of the checkerboard seen in glass, and metal seen in glass.
/// The truth's own noise is below .005.
#[test]
fn repaired_whitted_keeps_less_than_a_twentieth_of_the_fair_fakes_error() {
    let scene = builtin::named("whitted").expect("a built-in scene");
    let truth = truth(&scene, 128);
    let [fair, repaired] = [Repairs::NONE, Repairs::ALL].map(|repairs| rel_mse(&fake(&scene, repairs), &truth));
    assert!(fair > 0.5 && repaired < fair / 20.0, "{repaired} of {fair}");
}

/// A ball above a white floor under a sun straight above, seen from the side, and no other light.
fn ball_over_floor(material: &str) -> Scene {
    let text = format!(
        "camera = {{ eye = [0, 9, 14], target = [0, 0, 0], fov_y = 40 }}\n\
         sun = {{ towards = [0.1, 1, 0.05], angular_radius = 2, irradiance = [3, 3, 3] }}\n\
         [fake]\nambient = 0\n\
         [material.white]\ndiffuse = {{ albedo = [0.8, 0.8, 0.8] }}\nfake = {{ specular = 0 }}\n\
         [material.ball]\n{material}\n\
         [[rectangle]]\nmaterial = \"white\"\ncorner = [-6, 0, 6]\nedge_u = [12, 0, 0]\nedge_v = [0, 0, -12]\n\
         [[sphere]]\nmaterial = \"ball\"\ncenter = [0, 2.2, 0]\nradius = 1\n"
    );
    scene::parse(&text, "test", Path::new("test.toml")).expect("a scene")
}

/// Mean luminances of blocks of 4 x 3 pixels where the sun's light through the ball lands in the picture, and its shadow.
fn blocks(film: &Film) -> Vec<f64> {
    let image = film.image();
    let mean = |(x, y): (u32, u32)| {
        let pixels = (y..y + 3).flat_map(|y| (x..x + 4).map(move |x| (x, y)));
        pixels.filter_map(|(x, y)| image.at(x, y)).map(|l| f64::from(colour::luminance(l))).sum::<f64>() / 12.0
    };
    (39..51).step_by(3).flat_map(|y| (64..92).step_by(4).map(move |x| (x, y))).map(mean).collect()
}

/// The largest difference of two films' blocks.
fn apart(a: &Film, b: &Film) -> f64 {
    blocks(a).iter().zip(blocks(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn caustics_are_as_bright_as_paths_through_the_glass_block_by_block() {
    let scene = ball_over_floor("dielectric = { ior = 1.5 }");
    let repaired = fake(&scene, set(&[Repair::SoftShadows, Repair::LightThroughGlass, Repair::Caustics]));
    let shadowed = fake(&scene, set(&[Repair::SoftShadows]));
    let truth = truth(&scene, 256);
    // blocks have from .3 to 1.2; what the ball reflects to the floor is missing: a hundredth
    let (repaired, shadowed) = (apart(&repaired, &truth), apart(&shadowed, &truth));
    assert!(repaired < 0.05 && shadowed > 0.5, "{repaired}, and {shadowed} without");
}

#[test]
fn soft_shadows_of_a_ball_are_nearer_to_what_paths_make_than_hard_ones() {
    let mut scene = ball_over_floor("diffuse = { albedo = [0, 0, 0] }");
    if let Some(sun) = &mut scene.sun {
        sun.angular_radius = 8.0;
    }
    let truth = truth(&scene, 256);
    let [soft, hard] =
        [set(&[Repair::SoftShadows]), Repairs::NONE].map(|repairs| apart(&fake(&scene, repairs), &truth));
    // one distance stands for all of what casts, and the map has the far side of the ball
    assert!(soft < 0.6 * hard && hard > 0.05, "{soft} of {hard}");
}

/// A glass ball before a wall of cells and above a floor: what is behind is seen by two refractions and what is before by one
/// reflection, which a tree of rays finds exactly.
#[test]
fn glass_with_both_interfaces_and_fresnel_shows_what_rays_find() {
    let mut scene = builtin::named("whitted").expect("a built-in scene");
    scene.sun = None;
    // the glass alone, and the floor
    let shapes = scene.shapes.to_vec();
    let kept = shapes.into_iter().filter(|s| !matches!(scene.material_of(s).bsdf, scene::Bsdf::Mirror { .. }));
    scene.shapes = kept.collect::<Vec<_>>().into();
    let truth = truth(&scene, 64);
    let repairs = [Repair::Surroundings, Repair::TwoInterfaces, Repair::Fresnel];
    let [repaired, without_parallax, fair] =
        [set(&repairs), set(&repairs[1..]), Repairs::NONE].map(|repairs| rel_mse(&fake(&scene, repairs), &truth));
    // edges of far cells, which four samples do not resolve
    assert!(repaired < 0.02 * fair, "{repaired} of {fair}");
    // most of the glass shows the sky, which has no parallax
    assert!(repaired < 0.95 * without_parallax, "{repaired} of {without_parallax}");
}

/// A floor of small cells to the horizon, as bright as its colour everywhere: nothing but how cells are looked up is wrong.
#[test]
fn cells_of_a_texture_are_near_their_means_where_it_is_looked_up_along_footprints() {
    let text = "camera = { eye = [0, 1, 0], target = [0, 0.7, -4], fov_y = 40 }\n\
                sky = { radiance = [1, 1, 1] }\n\
                [material.board]\n\
                diffuse = { albedo = { even = [0.8, 0.8, 0.8], odd = [0.1, 0.1, 0.1], origin = [0, 0, 0], cell = [0.5, 0, 0.5] } }\n\
                [[rectangle]]\nmaterial = \"board\"\ncorner = [-30, 0, 1]\nedge_u = [60, 0, 0]\nedge_v = [0, 0, -60]\n";
    let scene = scene::parse(text, "test", Path::new("test.toml")).expect("a scene");
    let truth = truth(&scene, 512);
    let mapped = |textures: TextureFilter| {
        let knobs = FakeKnobs { textures, ..FakeKnobs::default() };
        rel_mse(&fake_of(&scene, (set(&[Repair::TextureMapping]), knobs), SIZE), &truth)
    };
    let formula = rel_mse(&fake(&scene, Repairs::NONE), &truth);
    let [bilinear, trilinear, anisotropic] = TextureFilter::ALL.map(mapped);
    // a largest level alone is what the formula is, but for soft sides
    assert!((bilinear - formula).abs() < 0.2 * formula, "{bilinear} of {formula}");
    // trilinear blurs as much as that aliases
    assert!(anisotropic < 0.3 * bilinear.min(trilinear), "{anisotropic}, {trilinear}, {bilinear}");
}

/// The Cornell box without highlights, which paths do not have, and without its boxes.
fn empty_cornell() -> Scene {
    let mut scene = matt_cornell();
    let shapes = scene.shapes.to_vec();
    let kept = shapes.into_iter().filter(|shape| !matches!(shape.geometry, Geometry::Box { .. }));
    scene.shapes = kept.collect::<Vec<_>>().into();
    scene
}

/// The Cornell box without highlights, which paths do not have.
fn matt_cornell() -> Scene {
    let mut scene = builtin::named("cornell").expect("a built-in scene");
    scene.materials.iter_mut().for_each(|material| material.fake.specular = 0.0);
    scene
}

/// The mean of two films' differences as a share of the second one's mean, by luminance, where `counts` says so.
fn share_apart(a: &[Vec3], b: &[Vec3], counts: impl Fn(usize) -> bool) -> f32 {
    let of = |(index, (a, b)): (usize, (&Vec3, &Vec3))| {
        let [apart, all] = [(*a - *b).abs(), b.abs()].map(colour::luminance);
        if counts(index) { [apart, all] } else { [0.0; 2] }
    };
    let [apart, all] = a.iter().zip(b).enumerate().map(of).fold([0.0; 2], |sum, x| [sum[0] + x[0], sum[1] + x[1]]);
    apart / all
}

/// A floor beside a ball that shines, half of which lies below it: of the floor's horizon.
fn ball_at_the_horizon() -> Scene {
    let text = "camera = { eye = [-2, 4, 0], target = [4, 0, 0], fov_y = 40 }\n\
         [material.white]\ndiffuse = { albedo = [0.8, 0.8, 0.8] }\nfake = { specular = 0 }\n\
         [material.lamp]\nemissive = { radiance = [3, 3, 3] }\n\
         [[rectangle]]\nmaterial = \"white\"\ncorner = [0, 0, 3]\nedge_u = [6, 0, 0]\nedge_v = [0, 0, -6]\n\
         [[sphere]]\nmaterial = \"lamp\"\ncenter = [-2, 0.5, 0]\nradius = 1.5\n";
    scene::parse(text, "test", Path::new("test.toml")).expect("a scene")
}

/// Near the lamp a point in its middle is too bright or too dark. What is left is mostly the noise of 256 paths a pixel.
#[test]
fn lamps_with_an_area_light_what_is_in_no_shadow_as_direct_light_does() {
    for scene in [empty_cornell(), ball_at_the_horizon()] {
        let truth = radiances(&of_bounces(&scene, 0, 256, SIZE));
        // the lamp itself, and what its rim covers of a pixel
        let lit = |index: usize| truth[index].max_element() < 1.0;
        let [point, area] = [Repairs::NONE, set(&[Repair::AreaLights])]
            .map(|repairs| share_apart(&radiances(&fake(&scene, repairs)), &truth, lit));
        assert!(area < 0.01 && point > 3.0 * area, "{}: {area} of {point}", scene.name);
    }
}

/// What paths add to direct light when they may bounce so often.
fn added_by_bounces(scene: &Scene, bounces: Option<u32>) -> Vec<Vec3> {
    let settings = PathSettings { bounces, ..PathSettings::default() };
    let [direct, all] =
        [of_bounces(scene, 0, 512, LARGER), traced(scene, settings, 512, LARGER)].map(|f| radiances(&f));
    all.iter().zip(&direct).map(|(all, direct)| *all - *direct).collect()
}

/// How far what a repair adds to a lamp's own light is from what paths add when they may bounce more often.
fn bounces_apart(scene: &Scene, paths: &[Vec3], (repair, gather): (Repair, GatherKnobs)) -> f32 {
    let direct = set(&[Repair::AreaLights, Repair::SoftShadows]);
    let knobs = FakeKnobs { gather, ..FakeKnobs::default() };
    let [without, with] =
        [direct, direct.with(repair)].map(|repairs| radiances(&fake_of(scene, (repairs, knobs), LARGER)));
    let added: Vec<_> = with.iter().zip(&without).map(|(with, without)| *with - *without).collect();
    share_apart(&added, paths, |_| true)
}

/// The path class camera - diffuse - diffuse - lamp of the Cornell box. A twelfth is left: the resolution that it is gathered at
/// and penumbras, whose patches have all of their light or none; and the noise of the paths.
#[test]
fn patches_add_what_the_second_bounce_of_paths_adds_and_each_lie_takes_it_away_from_that() {
    let scene = matt_cornell();
    let paths = added_by_bounces(&scene, Some(1));
    let honest = GatherKnobs::default();
    let apart = |gather| bounces_apart(&scene, &paths, (Repair::ReflectiveShadowMap, gather));
    let least = apart(honest);
    assert!(least < 0.12, "{least}");
    let lies = [
        ("nothing hides", GatherKnobs { shapes_hide: false, ..honest }, 1.5),
        ("few patches", GatherKnobs { samples: 16, ..honest }, 1.5),
        ("no clamp", GatherKnobs { clamp: PatchClamp::None, ..honest }, 1.0),
    ];
    for (name, lie, times) in lies {
        let lied = apart(lie);
        assert!(lied > times * least, "{name}: {lied} of {least}");
    }
}

/// A floor in the sun, and a wall that has it in its back: it is lit by the floor, and shadows a part of that.
#[test]
fn patches_of_the_sun_light_a_wall_in_shade_as_paths_do() {
    let text = "camera = { eye = [0, 3, 9], target = [0, 1, 0], fov_y = 40 }\n\
         sun = { towards = [0.3, 1, -1], angular_radius = 0.3, irradiance = [3, 2, 1] }\n\
         [material.white]\ndiffuse = { albedo = [0.8, 0.8, 0.8] }\nfake = { specular = 0 }\n\
         [[rectangle]]\nmaterial = \"white\"\ncorner = [-5, 0, 5]\nedge_u = [10, 0, 0]\nedge_v = [0, 0, -10]\n\
         [[rectangle]]\nmaterial = \"white\"\ncorner = [-3, 0, 0]\nedge_u = [6, 0, 0]\nedge_v = [0, 2.5, 0]\n";
    let scene = scene::parse(text, "test", Path::new("test.toml")).expect("a scene");
    let paths = added_by_bounces(&scene, Some(1));
    let apart = bounces_apart(&scene, &paths, (Repair::ReflectiveShadowMap, GatherKnobs::default()));
    assert!(apart < 0.2, "{apart}");
}

/// Of all light that goes on from wall to wall patches have the second bounce alone.
#[test]
fn probes_add_what_all_bounces_of_paths_add_and_patches_less() {
    let scene = matt_cornell();
    let paths = added_by_bounces(&scene, None);
    let [patches, probes] = [Repair::ReflectiveShadowMap, Repair::IrradianceProbes]
        .map(|repair| bounces_apart(&scene, &paths, (repair, GatherKnobs::default())));
    assert!(probes < 0.15 && patches > 2.0 * probes, "{probes}, and patches {patches}");
}

#[test]
fn each_repair_changes_a_scene_that_has_what_it_repairs_and_leaves_others_as_they_are() {
    let [whitted, cornell] = ["whitted", "cornell"].map(|name| builtin::named(name).expect("a built-in scene"));
    let [of_whitted, of_cornell] = [&whitted, &cornell].map(|scene| radiances(&fake(scene, Repairs::NONE)));
    for repair in Repair::ALL {
        for (scene, before) in [(&whitted, &of_whitted), (&cornell, &of_cornell)] {
            let missing = (repair.row().missing_in)(scene);
            // whatever is drawn of a parallax needs a cube map, which glass has already
            let changed = radiances(&fake(scene, set(&[repair]))) != *before;
            assert_eq!(changed, missing.is_none(), "{} of {}", repair.name(), scene.name);
        }
    }
}
