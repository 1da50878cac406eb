//! What becomes of the power that lights send out, and of the radius.

use super::*;
use crate::drive::lanes::FilmPass;
use crate::integrator::guide::{cells::Cells, guides::Guides};
use crate::tracer::Tracer;
use scene::builtin;

/// The photons of the first pass, with all that came from lights directly.
fn photons_of(tracer: &Tracer, scene: &Scene, photons: u32) -> Vec<Photon> {
    let film = Film::new(1, 1);
    let pass = FilmPass::new(&film, &scene.camera, 1, (SamplerKind::Sobol, 1));
    let (ready, stand_ins) = (tracer.prepared(), &scene.fake);
    let guides = &Guides::new(Cells::new(scene.bounds()));
    let job = FilmJob { scene: ready, stand_ins, guides, lanes: tracer.lanes(), pass, stop: &|| false };
    let traces = PhotonPass { number: 0, photons, purpose: Purpose::Map, direct: true }.trace(&job);
    traces.expect("nobody stops it").photons
}

/// The six walls of a closed unit box shine with 1/2 and send back half of what falls on them: 1/2 pi leaves each, half of it is
/// stored a second time, and so on, and none is lost.
#[test]
fn a_closed_box_keeps_all_the_power_that_its_walls_send_out() {
    let closed = builtin::named("hard/closed-box").expect("a built-in scene");
    let photons = photons_of(&Tracer::new(&closed), &closed, 1 << 16);
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
