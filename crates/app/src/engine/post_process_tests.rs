//! What comes out of the post_process, and what does not.

use super::*;
use crate::technique::{Device, PaneSettings, Provenance, SceneChanges, Technique};
use film::{Image, Vec3};

fn order(job: u64, view: u64) -> Order {
    let scene = Arc::new(scene::builtin::named("cornell").unwrap());
    let provenance = Arc::new(Provenance {
        source: "cornell".into(),
        changes: SceneChanges::default(),
        camera: scene.camera,
        recipe: PaneSettings::of(Technique::Path).recipe(),
        size: (1, 1),
        device: Device::Cpu,
    });
    Order { job, view, shrink: 1, restarts: 0, scene, provenance }
}

fn pixel(grey: f32) -> Image {
    Image::new(1, 1, [Vec3::splat(grey)]).unwrap()
}

fn picture(view: u64) -> Picture {
    let order = order(view, view);
    Picture {
        image: pixel(view as f32),
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

/// Runs a post_process over what `post` posts, and returns all that it shelved.
fn frame(post: impl Fn(&PostProcess)) -> PaneUpdates {
    let error_map_worker = Arc::new(ErrorMapWorker::start(Arc::new(|| {})).unwrap());
    let (post_process, thread) = PostProcess::start(Arc::new(|| {}), error_map_worker).unwrap();
    post(&post_process);
    let mut updates = PaneUpdates::default();
    for _ in 0..200 {
        for (place, update) in updates.iter_mut().zip(post_process.collect().unwrap_or_default()) {
            *place = update.or_else(|| place.take());
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    post_process.close();
    thread.join().unwrap();
    updates
}

#[test]
fn only_pictures_of_one_view_are_compared() {
    for (view_of_b, comparable) in [(1, true), (2, false)] {
        let updates = frame(|post_process| {
            post_process.deliver(Side::A, picture(1));
            post_process.deliver(Side::B, picture(view_of_b));
        });
        let [Some(PaneUpdate::Picture(a)), Some(PaneUpdate::Picture(b))] = updates else { panic!("two pictures") };
        assert_eq!((a.errors.is_some(), b.errors.is_some()), (comparable, comparable));
    }
}

/// The reference belongs to one view as the pictures do, and tells its noise.
#[test]
fn a_reference_judges_both_sides_of_its_own_view_alone() {
    let reference_image = ReferenceImage { image: pixel(0.5), noise: Some(1.0) };
    for (view, judged) in [(1, true), (2, false)] {
        let updates = frame(|post_process| {
            post_process.set_comparison(Comparison { against: Against::Reference, map: None });
            post_process.deliver(Side::A, picture(1));
            post_process.deliver(Side::B, picture(1));
            post_process.set_reference(Some((view, reference_image.clone())));
        });
        let [Some(PaneUpdate::Picture(a)), Some(PaneUpdate::Picture(b))] = updates else { panic!("two pictures") };
        assert_eq!((a.errors.is_some(), b.errors.is_some()), (judged, judged));
        if let Some(errors) = a.errors {
            assert_eq!((errors.bias, a.against), (0.5, Against::Reference));
            assert!(errors.below_reference_noise());
        }
    }
}

#[test]
fn a_picture_of_an_older_job_does_not_replace_a_newer_one() {
    let updates = frame(|post_process| {
        post_process.deliver(Side::A, Picture { order: order(8, 1), ..picture(1) });
        std::thread::sleep(std::time::Duration::from_millis(20));
        post_process.deliver(Side::A, Picture { order: order(7, 1), ..picture(1) });
    });
    assert!(matches!(&updates[0], Some(PaneUpdate::Picture(frame)) if frame.picture.order.job == 8));
}

#[test]
fn a_fault_stays_and_forgotten_views_do_not_come_back() {
    let updates = frame(|post_process| {
        post_process.forget_before(5);
        post_process.report(Side::A, picture(5).order, "no".into());
        post_process.deliver(Side::B, picture(4));
    });
    assert!(matches!(&updates[0], Some(PaneUpdate::Fault(fault)) if fault == "no"));
    assert!(updates[1].is_none());
}
