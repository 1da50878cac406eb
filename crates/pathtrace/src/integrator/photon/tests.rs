//! What becomes of the power that lights send out, and of the radius.

use super::walk::share_kept;
use super::*;
use crate::drive::lanes::FilmPass;
use crate::integrator::guide::{cells::Cells, guides::Guides};
use crate::light::Bounds;
use crate::tracer::Tracer;
use scene::{Scene, builtin};

/// Does something to the first pass that keeps photons, with all that came from lights directly.
fn with_first_pass<T>(scene: &Scene, photons: u32, of: impl FnOnce(&PhotonPass, &FilmJob) -> T) -> T {
    let direct = DirectLight::Photons;
    with_first_pass_of(&Tracer::new(scene), scene, (photons, direct), of)
}

fn with_first_pass_of<T>(
    tracer: &Tracer,
    scene: &Scene,
    (photons, direct): (u32, DirectLight),
    of: impl FnOnce(&PhotonPass, &FilmJob) -> T,
) -> T {
    let film = Film::new(1, 1);
    let pass = FilmPass::new(&film, &scene.camera, 1, (SamplerKind::Sobol, 1));
    let (ready, stand_ins) = (tracer.prepared(), &scene.fake);
    let guides = &Guides::new(Cells::new(scene.bounds()));
    let job = FilmJob { scene: ready, stand_ins, guides, lanes: tracer.lanes(), pass, stop: &|| false };
    let (aim, direct) = (job.aim(ready.photon_radius), direct == DirectLight::Photons);
    of(&PhotonPass { number: 0, photons, purpose: Purpose::Map, direct, aim: &aim }, &job)
}

/// The photons of the first pass.
pub fn photons_of(tracer: &Tracer, scene: &Scene, photons: u32, direct: DirectLight) -> Vec<Photon> {
    with_first_pass_of(tracer, scene, (photons, direct), |pass, job| {
        let mut all = Vec::new();
        pass.trace(job, |traces| all.extend(traces.photons)).expect("nobody stops it");
        all
    })
}

/// The six walls of a closed unit box shine with 1/2 and send back half of what falls on them: 1/2 pi leaves each, half of it is
/// stored a second time, and so on, and none is lost.
#[test]
fn a_closed_box_keeps_all_the_power_that_its_walls_send_out() {
    let closed = builtin::named("hard/closed-box").expect("a built-in scene");
    let photons = photons_of(&Tracer::new(&closed), &closed, 1 << 16, DirectLight::Photons);
    let stored: f64 = photons.iter().map(|photon| f64::from(photon.power.x)).sum();
    let expected = 6.0 * 0.5 * std::f64::consts::PI / (1.0 - 0.5);
    // roulette's share: a standard error of a two hundredth of the photons' root
    assert!((stored / expected - 1.0).abs() < 0.01, "{stored}, sent out and sent on {expected}");
    assert!(photons.iter().all(|photon| photon.normal.is_normalized() && photon.power.min_element() > 0.0));
}

#[test]
fn the_radius_shrinks_by_the_rule_and_from_the_first_pass_on() {
    let squared = |pass| radius_of_pass(2.0, 0.5, pass).powi(2);
    // 4, then times 1.5 / 2, then times 2.5 / 3
    for (pass, expected) in [(0, 4.0), (1, 3.0), (2, 2.5)] {
        assert!((squared(pass) - expected).abs() < 1e-5, "{pass}: {}", squared(pass));
    }
    // the product goes like a power of the number of passes
    let ratio = squared(40_000) / squared(10_000);
    assert!((ratio - 4f32.powf(-0.5)).abs() < 1e-3, "{ratio}");
}

#[test]
fn settings_without_meaning_are_refused() {
    let fine = PhotonSettings::default();
    assert_eq!(fine.check(), Ok(()));
    for wrong in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert!(PhotonSettings { radius: Some(wrong), ..fine }.check().is_err(), "{wrong}");
    }
    for wrong in [0.0, 1.0, f32::NAN] {
        assert!(PhotonSettings { alpha: wrong, ..fine }.check().is_err(), "{wrong}");
    }
    for photons in [0, MOST_PHOTONS + 1] {
        assert_eq!(PhotonSettings { photons, ..fine }.check(), Err(SettingsError::Photons(photons)));
        assert!(LightTracingSettings { photons, ..LightTracingSettings::default() }.check().is_err());
    }
}

/// What a pass leaves where only a quarter is kept is the same power, and nothing but a part of the same photons.
#[test]
fn a_share_of_the_photons_brings_the_power_of_all() {
    let closed = builtin::named("hard/closed-box").expect("a built-in scene");
    let kept = |share: f32| -> Vec<Photon> {
        let chunks = |pass: &PhotonPass, job: &FilmJob| pass.chunks(job, (0, 1 << 16), share).expect("nobody stops it");
        with_first_pass(&closed, 1 << 16, chunks).into_iter().flat_map(|traces| traces.photons).collect()
    };
    let (all, quarter) = (kept(1.0), kept(0.25));
    let power = |photons: &[Photon]| photons.iter().map(|photon| f64::from(photon.power.x)).sum::<f64>();
    // of some 10^5 photons a quarter, whose standard error is half a hundredth
    let of_all =
        |of_quarter: f64, of_all: f64| assert!((of_quarter / of_all - 1.0).abs() < 0.02, "{of_quarter}, {of_all}");
    of_all(4.0 * quarter.len() as f64, all.len() as f64);
    of_all(power(&quarter), power(&all));
    let places: std::collections::HashSet<_> =
        all.iter().map(|photon| photon.position.to_array().map(f32::to_bits)).collect();
    assert!(quarter.iter().all(|photon| places.contains(&photon.position.to_array().map(f32::to_bits))));
}

/// In a room that sends back all light each photon comes to a thousand surfaces: of as many as a pass may have, whose first chunk
/// stands for all, a share is kept that there is memory for.
#[test]
fn a_pass_leaves_no_more_than_a_map_holds() {
    const CHUNK: u32 = 4096;
    let closed = builtin::text("hard/closed-box").expect("a built-in scene");
    let white = scene_of(&closed.replace("albedo = [0.5, 0.5, 0.5]", "albedo = [1, 1, 1]"));
    let (left, kept) = with_first_pass(&white, MOST_PHOTONS, |pass, job| {
        let left = pass.left_by_each(job) * f64::from(MOST_PHOTONS);
        let chunk = pass.chunks(job, (0, CHUNK), share_kept(left)).expect("nobody stops it");
        (left, chunk.iter().map(|traces| traces.photons.len()).sum::<usize>())
    });
    let kept = kept as f64 * f64::from(MOST_PHOTONS / CHUNK);
    // five standard errors of some 16,000 photons
    assert!(left > 3e9 && (kept / f64::from(1 << 24) - 1.0).abs() < 0.04, "{kept} of {left}");
    assert_eq!(share_kept(1e6), 1.0);
}

fn seen_in(scene: &Scene) -> Vec<Bounds> {
    with_first_pass(scene, 1, |_, job| seen::spheres(job.scene, &job.pass.frame, 0.0))
}

/// What is seen of a wide floor lies in the spheres, whatever is between two of them; of a room that fills the picture there are none.
#[test]
fn what_is_seen_of_a_wide_scene_is_aimed_at() {
    let wide = wide_floor("");
    let spheres = seen_in(&wide);
    let frame = wide.camera.frame(1.0);
    for (i, j) in (0..100).flat_map(|i| (0..100).map(move |j| (i, j))) {
        let [x, y] = [i, j].map(|k| (k as f32 + 0.5) / 50.0 - 1.0);
        let direction = frame.forward + frame.right * x + frame.up * y;
        let at = frame.eye - direction * (frame.eye.y / direction.y);
        let within = spheres.iter().filter(|sphere| (at - sphere.center).length() < sphere.radius).count();
        assert!(within >= 3, "{at}: {within}");
    }
    assert!(spheres.iter().all(|sphere| sphere.radius < 10.0), "{spheres:?}");
    assert_eq!(seen_in(&builtin::named("cornell").expect("a built-in scene")), []);
}

/// A mirror stands in for what it shows.
#[test]
fn what_a_mirror_shows_is_aimed_at() {
    let mirror = "[material.mirror]\nmirror = { reflectance = [1, 1, 1] }\n\
                  [[rectangle]]\ncorner = [-40, 0.5, -40]\nedge_u = [80, 0, 0]\nedge_v = [0, 0, 80]\nmaterial = 'mirror'\n\
                  [[disk]]\ncenter = [0, 9, 0]\nnormal = [0, 1, 0]\nradius = 40\nmaterial = 'floor'\n";
    let spheres = seen_in(&wide_floor(mirror));
    assert!(!spheres.is_empty() && spheres.iter().all(|sphere| (sphere.center.y - 9.0).abs() < 0.01), "{spheres:?}");
}

/// A floor 6000 wide, of which the camera sees a few units.
fn wide_floor(more: &str) -> Scene {
    let text = format!(
        "[camera]\neye = [0, 4, 4]\ntarget = [0, 0, 0]\nfov_y = 30\n[sun]\ntowards = [0, 1, 0]\nangular_radius = 0\nirradiance = [1, 1, 1]\n\
         [material.floor]\ndiffuse = {{ albedo = [0.5, 0.5, 0.5] }}\n\
         [[rectangle]]\ncorner = [-3000, 0, -3000]\nedge_u = [0, 0, 6000]\nedge_v = [6000, 0, 0]\nmaterial = 'floor'\n{more}"
    );
    scene_of(&text)
}

fn scene_of(text: &str) -> Scene {
    scene::parse(text, "test", std::path::Path::new("test.toml")).expect("a scene")
}

/// Of the scenes that fill their pictures it is what it was by their bounds alone; a floor that goes on far beyond the picture does not
/// count.
#[test]
fn the_usual_radius_goes_by_what_is_seen() {
    let of = |name: &str| usual_radius(&builtin::named(name).expect("a built-in scene"));
    for (name, by_bounds) in [("cornell", 10.61), ("phong", 0.1976), ("hard/closed-box", 0.01914)] {
        // it is told in three digits
        assert!((of(name) / by_bounds - 1.0).abs() < 5e-3, "{name}: {}", of(name));
    }
    let wide = usual_radius(&wide_floor(""));
    // the picture is some 3 units high where the floor is
    assert!((0.25..0.35).contains(&wide), "{wide}");
    // of a floor of 1e8 units f32 knows places to some 8: a disc must hold many of them
    let ball = "[[sphere]]\ncenter = [1e8, 1, 0]\nradius = 1\nmaterial = 'floor'\n";
    assert!(usual_radius(&wide_floor(ball)) > 500.0);
    assert!(sees_little(&wide_floor("")) && !sees_little(&builtin::named("whitted").expect("a built-in scene")));
}
