//! What comes out of the darkroom, and what does not.

use super::*;
use crate::technique::{Machine, PaneSettings, Provenance, SceneChanges, Technique};
use scene::Vec3;

fn order(job: u64, view: u64) -> Order {
    let scene = Arc::new(scene::builtin::named("cornell").unwrap());
    let provenance = Arc::new(Provenance {
        source: "cornell".into(),
        changes: SceneChanges::default(),
        camera: scene.camera,
        recipe: PaneSettings::of(Technique::Path).recipe(),
        size: (1, 1),
        device: Machine::Cpu,
    });
    Order { job, view, shrink: 1, restarts: 0, scene, provenance }
}

fn picture(view: u64) -> Picture {
    let order = order(view, view);
    let radiances = [Vec3::splat(view as f32)].into();
    Picture {
        width: 1,
        height: 1,
        radiances,
        spp: None,
        seconds: 0.0,
        nonfinite: 0,
        adapter: "none".into(),
        refused: None,
        rough: false,
        unfinished: false,
        order,
    }
}

/// Runs a darkroom over what `post` posts, and returns all that it shelved.
fn developed(post: impl Fn(&Darkroom)) -> Shelf {
    let surveyor = Arc::new(Surveyor::start(Arc::new(|| {})).unwrap());
    let (darkroom, thread) = Darkroom::start(Arc::new(|| {}), surveyor).unwrap();
    post(&darkroom);
    let mut shelf = Shelf::default();
    for _ in 0..200 {
        for (place, news) in shelf.iter_mut().zip(darkroom.collect().unwrap_or_default()) {
            *place = news.or_else(|| place.take());
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    darkroom.close();
    thread.join().unwrap();
    shelf
}

#[test]
fn only_pictures_of_one_view_are_compared() {
    for (view_of_b, comparable) in [(1, true), (2, false)] {
        let shelf = developed(|darkroom| {
            darkroom.deliver(Side::A, picture(1));
            darkroom.deliver(Side::B, picture(view_of_b));
        });
        let [Some(News::Picture(a)), Some(News::Picture(b))] = shelf else { panic!("two pictures") };
        assert_eq!((a.errors.is_some(), b.errors.is_some()), (comparable, comparable));
    }
}

/// The reference belongs to one view as the pictures do, and tells its noise.
#[test]
fn a_reference_judges_both_sides_of_its_own_view_alone() {
    let yardstick = Yardstick { size: (1, 1), radiances: [Vec3::splat(0.5)].into(), noise: Some(1.0) };
    for (view, judged) in [(1, true), (2, false)] {
        let shelf = developed(|darkroom| {
            darkroom.set_comparison(Comparison { against: Against::Reference, map: None });
            darkroom.deliver(Side::A, picture(1));
            darkroom.deliver(Side::B, picture(1));
            darkroom.set_reference(Some((view, yardstick.clone())));
        });
        let [Some(News::Picture(a)), Some(News::Picture(b))] = shelf else { panic!("two pictures") };
        assert_eq!((a.errors.is_some(), b.errors.is_some()), (judged, judged));
        if let Some(errors) = a.errors {
            assert_eq!((errors.bias, a.against), (0.5, Against::Reference));
            assert!(errors.below_reference_noise());
        }
    }
}

#[test]
fn a_picture_of_an_older_job_does_not_replace_a_newer_one() {
    let shelf = developed(|darkroom| {
        darkroom.deliver(Side::A, Picture { order: order(8, 1), ..picture(1) });
        std::thread::sleep(std::time::Duration::from_millis(20));
        darkroom.deliver(Side::A, Picture { order: order(7, 1), ..picture(1) });
    });
    assert!(matches!(&shelf[0], Some(News::Picture(developed)) if developed.picture.order.job == 8));
}

#[test]
fn a_fault_stays_and_forgotten_views_do_not_come_back() {
    let shelf = developed(|darkroom| {
        darkroom.forget_before(5);
        darkroom.report(Side::A, picture(5).order, "no".into());
        darkroom.deliver(Side::B, picture(4));
    });
    assert!(matches!(&shelf[0], Some(News::Fault(fault)) if fault == "no"));
    assert!(shelf[1].is_none());
}
