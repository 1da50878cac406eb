//! What comes out of the post-process, and what does not.

use super::*;
use crate::model::Effort;
use film::{Image, Vec3};
use technique::{Device, PaneSettings, Provenance, Shot, TechniqueName};

fn order(job: u64, view: u64) -> Order {
    let shot = Shot::of(scene::builtin::named("cornell").unwrap(), (1, 1));
    let technique = PaneSettings::of(TechniqueName::Path).in_use();
    let own_camera = shot.camera;
    let provenance = Arc::new(Provenance { shot, technique, device: Device::Cpu });
    Order { job, view, shrink: 1, restarts: 0, own_camera, provenance }
}

fn pixel(grey: f32) -> Image {
    Image::new(1, 1, [Vec3::splat(grey)]).unwrap()
}

fn picture(view: u64) -> Picture {
    let order = order(view, view);
    Picture {
        external: None,
        image: pixel(view as f32),
        before: None,
        lag: None,
        runs: 1,
        spp: None,
        seconds: 0.0,
        effort: Effort::Traced(pathtrace::Stats::default()),
        noisy: false,
        nonfinite: 0,
        adapter: "none".into(),
        refused: None,
        filter_fault: None,
        cut: None,
        rough: false,
        coarse: false,
        unfinished: false,
        order,
    }
}

fn both(against: impl Fn(PaneId) -> Against) -> Vec<Comparison> {
    [PaneId::A, PaneId::B].map(|of| Comparison { of, against: against(of), region: None }).into()
}

/// Runs a post_process over what `post` posts, and returns all that it shelved.
fn frame(post: impl Fn(&PostProcess)) -> PaneUpdates {
    let error_map_worker = Arc::new(ErrorMapWorker::start(Arc::new(|| {})).unwrap());
    let post_process = PostProcess::start(Arc::new(|| {}), error_map_worker).unwrap();
    post(&post_process);
    let mut updates = PaneUpdates::default();
    for _ in 0..200 {
        for (pane, update) in post_process.collect().unwrap_or_default() {
            updates.insert(pane, update);
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    post_process.close();
    updates
}

#[test]
fn only_pictures_of_one_view_are_compared() {
    for (view_of_b, comparable) in [(1, true), (2, false)] {
        let updates = frame(|post_process| {
            let other = |id| Against::Pane(if id == PaneId::A { PaneId::B } else { PaneId::A });
            post_process.set_comparisons(both(other), None);
            post_process.deliver(PaneId::A, picture(1));
            post_process.deliver(PaneId::B, picture(view_of_b));
        });
        let [Some(PaneUpdate::Picture(a)), Some(PaneUpdate::Picture(b))] =
            [PaneId::A, PaneId::B].map(|id| updates.get(id))
        else {
            panic!("two pictures")
        };
        assert_eq!((a.errors.is_some(), b.errors.is_some()), (comparable, comparable));
    }
}

#[test]
fn a_picture_with_coarse_meshes_is_compared_with_nothing() {
    let reference_image = ReferenceImage { image: pixel(0.5), standard_errors: None, noise: Some(1.0) };
    for against in [Against::Pane(PaneId::A), Against::Reference] {
        let updates = frame(|post_process| {
            post_process.set_comparisons(vec![Comparison { of: PaneId::B, against, region: None }], None);
            post_process.set_reference(Some((1, reference_image.clone())));
            post_process.deliver(PaneId::A, picture(1));
            post_process.deliver(PaneId::B, Picture { rough: true, coarse: true, ..picture(1) });
        });
        let Some(PaneUpdate::Picture(shown)) = updates.get(PaneId::B) else { panic!("a picture") };
        assert!(shown.picture.coarse && shown.errors.is_none(), "{against:?}");
    }
}

/// The reference belongs to one view as the pictures do, and tells its noise.
#[test]
fn a_reference_judges_both_sides_of_its_own_view_alone() {
    let reference_image = ReferenceImage { image: pixel(0.5), standard_errors: None, noise: Some(1.0) };
    for (view, judged) in [(1, true), (2, false)] {
        let updates = frame(|post_process| {
            post_process.set_comparisons(both(|_| Against::Reference), None);
            post_process.deliver(PaneId::A, picture(1));
            post_process.deliver(PaneId::B, picture(1));
            post_process.set_reference(Some((view, reference_image.clone())));
        });
        let [Some(PaneUpdate::Picture(a)), Some(PaneUpdate::Picture(b))] =
            [PaneId::A, PaneId::B].map(|id| updates.get(id))
        else {
            panic!("two pictures")
        };
        assert_eq!((a.errors.is_some(), b.errors.is_some()), (judged, judged));
        if let Some((against, errors)) = a.errors {
            assert_eq!((errors.bias, against), (0.5, Against::Reference));
            assert!(errors.below_reference_noise());
        }
    }
}

#[test]
fn a_picture_of_an_older_job_does_not_replace_a_newer_one() {
    let updates = frame(|post_process| {
        post_process.deliver(PaneId::A, Picture { order: order(8, 1), ..picture(1) });
        std::thread::sleep(std::time::Duration::from_millis(20));
        post_process.deliver(PaneId::A, Picture { order: order(7, 1), ..picture(1) });
    });
    assert!(matches!(updates.get(PaneId::A), Some(PaneUpdate::Picture(frame)) if frame.picture.order.job == 8));
}

#[test]
fn a_fault_stays_and_forgotten_views_do_not_come_back() {
    let updates = frame(|post_process| {
        post_process.forget_before(5);
        post_process.report(PaneId::A, picture(5).order, "no".into());
        post_process.deliver(PaneId::B, picture(4));
    });
    assert!(matches!(updates.get(PaneId::A), Some(PaneUpdate::Fault(fault)) if fault == "no"));
    assert!(updates.get(PaneId::B).is_none());
}

/// Two pictures of two pixels that differ in the right one alone.
#[test]
fn in_a_region_the_errors_are_those_of_its_pixels() {
    let wide = |right: f32| Picture { image: Image::new(2, 1, [Vec3::ONE, Vec3::splat(right)]).unwrap(), ..picture(1) };
    let rmse = |region: Option<[f32; 2]>| {
        let region = region.map(|[left, right]| Region { start: [left, 0.0], end: [right, 1.0] });
        let comparison = Comparison { of: PaneId::A, against: Against::Pane(PaneId::B), region };
        let updates = frame(|post_process| {
            post_process.set_comparisons(vec![comparison], None);
            post_process.deliver(PaneId::A, wide(3.0));
            post_process.deliver(PaneId::B, wide(1.0));
        });
        let Some(PaneUpdate::Picture(shown)) = updates.get(PaneId::A) else { panic!("no picture") };
        assert_eq!(shown.region, region);
        shown.errors.expect("errors").1.rmse
    };
    assert_eq!([rmse(Some([0.0, 0.5])), rmse(Some([0.5, 1.0]))], [0.0, 2.0]);
    assert!((rmse(None) - 2f64.sqrt()).abs() < 1e-12);
}
