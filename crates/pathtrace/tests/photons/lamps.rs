//! Lamps in one another, hard scenes, and wide ones: photons find what paths find.

use crate::pictures::{assert_mean, light_tracing, mean_of_seeds, photon_maps, scene};
use pathtrace::{DirectLight, Estimator, PathSettings, PhotonSettings};
use scene::{Scene, builtin};

/// A floor under lamps of radiance 1, seen from the side, with the lamps in the picture.
fn under_lamps(lamps: &str) -> Scene {
    scene(&format!(
        "[camera]\neye = [0, -6, 3]\ntarget = [0, 0, 1]\nup = [0, 0, 1]\nfov_y = 45\n\
         [material.floor]\ndiffuse = {{ albedo = [0.5, 0.5, 0.5] }}\n\
         [material.lamp]\nemissive = {{ radiance = [1, 1, 1] }}\n\
         [material.bright]\nemissive = {{ radiance = [3, 3, 3], two_sided = true }}\n\
         [material.glass]\ndielectric = {{ ior = 1.5 }}\n\
         [[rectangle]]\ncorner = [-9, -9, 0]\nedge_u = [18, 0, 0]\nedge_v = [0, 18, 0]\nmaterial = 'floor'\n{lamps}"
    ))
}

fn square_lamp(corner: [f32; 3], side: f32, material: &str) -> String {
    format!(
        "[[rectangle]]\ncorner = {corner:?}\nedge_u = [0, {side:?}, 0]\nedge_v = [{side:?}, 0, 0]\nmaterial = '{material}'\n"
    )
}

fn ball(radius: f32, material: &str) -> String {
    format!("[[sphere]]\ncenter = [0, 0, 2]\nradius = {radius:?}\nmaterial = '{material}'\n")
}

/// Of lamps that lie in one another the first one shines, by its own radiance, to photons as to paths; others that meet shine
/// both.
#[test]
fn lamps_that_coincide_shine_once() {
    let small = square_lamp([-0.25, -0.25, 2.0], 0.5, "bright");
    let large = square_lamp([-1.0, -1.0, 2.0], 2.0, "lamp");
    let beside = square_lamp([1.0, -1.0, 2.0], 2.0, "lamp");
    let tilted = |[x, z]: [f32; 2]| {
        format!(
            "[[rectangle]]\ncorner = [{x:?}, -1, {z:?}]\nedge_u = [0, 2, 0]\nedge_v = [1.5, 0, 0.9]\nmaterial = 'lamp'\n"
        )
    };
    let cases = [
        ("twice", large.repeat(2)),
        ("a small one over a large one", format!("{small}{large}")),
        ("a small one under a large one", format!("{large}{small}")),
        ("beside each other", format!("{large}{beside}")),
        ("tilted, in one plane", format!("{}{}", tilted([-1.0, 2.0]), tilted([-0.625, 2.225]))),
        ("a ball twice", ball(0.5, "lamp") + &ball(0.5, "bright")),
        ("a ball in a ball", ball(0.5, "lamp") + &ball(0.4, "bright")),
        ("on a board", square_lamp([-2.0, -2.0, 2.0], 4.0, "floor") + &large),
        ("behind glass", large.repeat(2) + "[[box]]\ncorner = [-2, -2, 1]\nsize = [4, 4, 0.1]\nmaterial = 'glass'\n"),
    ];
    for (what, lamps) in cases {
        let scene = under_lamps(&lamps);
        let (paths, _) = mean_of_seeds(
            &scene,
            24,
            256,
            &PathSettings { estimator: Estimator::MIS, ..PathSettings::default() }.into(),
        );
        let [_, gathered] = photon_maps(1 << 13, 0.1);
        assert_mean(mean_of_seeds(&scene, 24, 16, &gathered), paths, (0.01, 0.01), &format!("{what}, photon map"));
        if what != "behind glass" {
            let traced = mean_of_seeds(&scene, 24, 16, &light_tracing(1 << 13));
            assert_mean(traced, paths, (0.003, 0.01), &format!("{what}, light tracing"));
        }
    }
}

/// The mean of each hard scene, by maps of the usual radius, which are dark at edges: by a hundredth in closed boxes. Light tracing
/// is left out where mirrors or glass are to be seen, which it does not show.
#[test]
fn in_hard_scenes_photons_find_what_paths_find() {
    let gathered = PhotonSettings { photons: 1 << 12, direct: DirectLight::Photons, ..PhotonSettings::default() };
    // between a lamp and the floor there is less room than a disc is wide, and next to no light comes out
    for name in builtin::hard_names().filter(|name| *name != "hard/disk-touching") {
        let scene = builtin::named(name).expect("a built-in scene");
        let paths = PathSettings { estimator: Estimator::MIS, ..PathSettings::default() };
        let (expected, error) = mean_of_seeds(&scene, 16, 128, &paths.into());
        let specular = scene.needs().mirror || scene.needs().dielectric;
        let light = (!specular).then(|| (light_tracing(1 << 12), 0.003));
        for (integrator, bias) in [(gathered.into(), 0.02)].into_iter().chain(light) {
            let (found, own_error) = mean_of_seeds(&scene, 16, 32, &integrator);
            println!("{name}, {}: {found:.5} +- {own_error:.5}, {expected:.5} +- {error:.5}", integrator.name());
            assert_mean((found, own_error.hypot(error)), expected, (bias, 0.02), name);
        }
    }
}

/// A floor of thousands of units, of which the camera sees a few: under a sun, a sky, a small lamp and a large one.
#[test]
fn of_a_wide_floor_is_lit_what_the_camera_sees() {
    let floor = |light: &str| {
        scene(&format!(
            "[camera]\neye = [0, 3, 3]\ntarget = [0, 0, 0]\nfov_y = 20\n\
             [material.floor]\ndiffuse = {{ albedo = [0.5, 0.5, 0.5] }}\n\
             [material.lamp]\nemissive = {{ radiance = [1, 1, 1] }}\n\
             [[rectangle]]\ncorner = [-3000, 0, -3000]\nedge_u = [0, 0, 6000]\nedge_v = [6000, 0, 0]\nmaterial = 'floor'\n{light}"
        ))
    };
    let lamp = |half: f32, height: f32| {
        let (low, side) = (-half, 2.0 * half);
        format!(
            "[[rectangle]]\ncorner = [{low:?}, {height:?}, {low:?}]\nedge_u = [{side:?}, 0, 0]\nedge_v = [0, 0, {side:?}]\nmaterial = 'lamp'\n"
        )
    };
    let lights = [
        "[sun]\ntowards = [1, 2, 0]\nangular_radius = 0\nirradiance = [2, 2, 2]\n".to_owned(),
        "[sky]\nradiance = [1, 1, 1]\n".to_owned(),
        "[[point_light]]\nposition = [100, 500, 0]\nintensity = [1e6, 1e6, 1e6]\n".to_owned(),
        lamp(2.0, 300.0),
        lamp(2000.0, 1000.0),
    ];
    for light in lights {
        let floor = floor(&light);
        let (paths, _) = mean_of_seeds(&floor, 8, 1024, &PathSettings::default().into());
        for integrator in photon_maps(1 << 13, 0.1).into_iter().chain([light_tracing(1 << 13)]) {
            assert_mean(
                mean_of_seeds(&floor, 8, 16, &integrator),
                paths,
                (0.01, 0.02),
                &format!("{light}{integrator:?}"),
            );
        }
    }
}
