//! What there is to look at of each case.

use check::{CASES, Mark};
use film::Film;
use pathtrace::Tracer;
use scene::Camera;
use technique::Technique;

#[test]
fn every_case_has_a_scene_and_says_what_is_measured_on_it() {
    for case in CASES {
        let view = case.view();
        let scene = view.scene(case).expect("an embedded scene");
        assert!(scene.name.ends_with(case.title) && !scene.shapes.is_empty(), "{}", case.title);
        for sentence in [case.claim, view.measured] {
            assert!(sentence.len() > 20 && sentence.ends_with('.'), "{sentence}");
        }
        let frame = scene.camera.frame(1.0);
        let is_seen =
            |mark: &Mark| frame.project(mark.at).is_some_and(|at| at.min_element() > 0.02 && at.max_element() < 0.98);
        assert!(view.marks.iter().all(is_seen), "{}", case.title);
    }
}

/// The expected value that stands beside a ring is what its point looks like, by the settings of the picture.
#[test]
fn points_look_as_their_marks_say() {
    let mut marks = 0;
    for case in CASES {
        let view = case.view();
        let scene = view.scene(case).expect("an embedded scene");
        let Technique::Traced(traced) = view.technique else { continue };
        let tracer = Tracer::new(&scene);
        for mark in view.marks {
            let camera = Camera { target: mark.at, fov_y: 1e-3, ..scene.camera };
            let mut film = Film::new(16, 16);
            tracer.render(&mut film, &camera, &traced.integrator, 64, &|| false);
            let mean = film.mean()[0];
            assert!((mean - mark.expected).abs() < 0.03 * mark.expected, "{}: {mean} at {mark:?}", case.title);
            marks += 1;
        }
    }
    assert!(marks >= 10, "{marks}");
}
