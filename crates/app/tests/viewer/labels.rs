//! The labels on the pictures: what they say, and where they stand.

use super::{User, both_whole};
use egui::Key;
use visavis::model::{Line, PaneId, View};
use visavis_tests::Frame;

/// Two path-traced pictures of so many bounces at most.
fn two_limits_of_bounces(user: &mut User, bounces: [u32; 2]) {
    user.wait_for("both pictures", both_whole);
    user.click_nth("Path", 0);
    let mut viewer = user.viewer.borrow_mut();
    for (pane, bounces) in [PaneId::A, PaneId::B].into_iter().zip(bounces) {
        viewer.model.session.panes[pane].truth.path.bounces = Some(bounces);
    }
}

fn lines<'a>(frame: &'a Frame, pane: &str) -> Vec<&'a str> {
    frame.value(&format!("label {pane}")).lines().collect()
}

#[test]
fn two_pictures_of_one_technique_are_called_by_what_differs_and_say_what_they_lack() {
    let mut user = User::of("cornell");
    two_limits_of_bounces(&mut user, [0, 1]);
    let shown = user.wait_for("both limits", |f| {
        both_whole(f) && lines(f, "B")[0] == "B: Path tracing, 1 bounce" && f.state("a")["rel_mse"].is_number()
    });
    assert_eq!(lines(&shown, "A")[0], "A: Path tracing, 0 bounces");
    assert!(lines(&shown, "A").contains(&"missing: indirect light (biased)"), "{:?}", lines(&shown, "A"));
    assert!(lines(&shown, "B").contains(&"missing: light after more than 1 bounce (biased)"));
    // of two techniques their names say enough
    user.click_nth("Whitted", 0);
    let other = user.wait_for("Whitted", |f| both_whole(f) && lines(f, "A")[0] == "A: Whitted, depth 8");
    assert_eq!(lines(&other, "B")[0], "B: Path tracing, light");
}

#[test]
fn rays_are_counted_where_paths_branch() {
    let mut user = User::of("cornell");
    two_limits_of_bounces(&mut user, [1, 1]);
    user.viewer.borrow_mut().model.session.panes[PaneId::B].truth.path.branches = 4;
    let told = user.wait_for("both pictures", |f| both_whole(f) && lines(f, "B")[0] == "B: Path tracing, N = 4");
    let counted =
        lines(&told, "B").into_iter().find(|line| line.starts_with("N = 4, at most 4^2 = 16 paths a sample: "));
    let counted = counted.expect("the count");
    let figure = counted.split(": ").nth(1).and_then(|rays| rays.split(' ').next()?.parse::<f64>().ok());
    // at most a camera ray, 20 of 4 + 16 branches and a shadow ray from each of 5 vertices; many leave the box
    assert!(figure.is_some_and(|rays| (8.0..26.0).contains(&rays)), "{counted}");
    assert!(counted.ends_with(" rays a second"), "{counted}");
    assert_eq!(lines(&told, "A")[0], "A: Path tracing, N = 1");
    let straight = lines(&told, "A").into_iter().find(|line| line.starts_with("N = 1, one path a sample: "));
    assert!(straight.is_some_and(|line| line.ends_with(" rays a second")), "{:?}", lines(&told, "A"));
}

#[test]
fn l_hides_the_labels_and_shows_them_again_as_its_box_does() {
    let mut user = User::of("cornell");
    let both = |f: &Frame| [f.shows("label A"), f.shows("label B")];
    let first = user.wait_for("both pictures", both_whole);
    assert_eq!(both(&first), [true; 2]);
    assert_eq!(both(&user.key(Key::L)), [false; 2]);
    assert_eq!(both(&user.key(Key::L)), [true; 2]);
    user.click("Look");
    assert_eq!(both(&user.click("Labels on the pictures")), [false; 2]);
}

#[test]
fn two_pictures_against_each_other_have_their_difference_told_once() {
    let mut user = User::of("cornell");
    let told = user.wait_for("the difference", |f| both_whole(f) && f.value("label A").contains("differs from B by"));
    assert!(told.state("b")["rel_mse"].is_number(), "it is measured both ways, for the files");
    assert!(!told.value("label B").contains("differs") && !told.value("label B").contains("relMSE"));
    assert!(!told.value("label A").contains("bias"), "of one picture it is a mean difference");
    user.key(Key::Num2);
    user.wait_for("the difference where B is alone", |f| {
        !f.shows("label A") && f.value("label B").contains("A differs from B by")
    });
}

/// The old picture stays until the new one has come, and so do its name and its number of samples.
#[test]
fn a_label_is_that_of_the_picture_that_is_shown_until_the_next_one_is() {
    let mut user = User::of("cornell");
    user.wait_for("samples", |f| both_whole(f) && f.state("b")["spp"].as_u64() >= Some(2));
    user.click_nth("Fake", 1);
    for _ in 0..1000 {
        let frame = user.frame();
        let label = frame.value("label B");
        if frame.state("b")["label"] == "Fake, fair" {
            assert!(label.starts_with("B: Fake, fair") && !label.contains("spp"), "{label}");
            return;
        }
        let of_256 = label.contains(" of 256 spp") || frame.state("b")["unfinished"] == false;
        assert!(label.starts_with("B: Path tracing, light") && of_256, "{label}");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the fake has not come");
}

#[test]
fn the_fakes_time_is_measured_again_once_its_pipelines_are_compiled() {
    let mut user = User::of("whitted");
    let warm = user.wait_for("a warm fake", |f| both_whole(f) && f.state("a")["unfinished"] == false);
    let cost = warm.value("label A").lines().last().expect("a line of figures");
    assert!(cost.ends_with(" ms") || cost.ends_with(" s"), "{cost}");
}

#[test]
fn the_fakes_time_is_measured_again_once_the_other_picture_is_done() {
    let mut user = User::of("whitted");
    user.viewer.borrow_mut().model.session.panes[PaneId::B].truth.spp = 16;
    let is_done = |f: &Frame| both_whole(f) && ["a", "b"].iter().all(|pane| f.state(pane)["unfinished"] == false);
    let at_work = user.wait_for("the fake, warm", |f| both_whole(f) && f.state("a")["unfinished"] == false);
    assert!(is_done(&at_work) || at_work.state("a")["at_rest"] == false, "path tracing goes on beside it");
    user.wait_for("the fake's time at rest", |f| is_done(f) && f.state("a")["at_rest"] == true);
    // each picture has its own time
    user.viewer.borrow_mut().model.session.panes[PaneId::A].fake.knobs.shininess = Some(7.0);
    user.wait_for("another fake", |f| f.state("a")["at_rest"] == false);
    user.wait_for("its time at rest", |f| is_done(f) && f.state("a")["at_rest"] == true);
}

#[test]
fn two_fakes_are_measured_one_after_the_other() {
    let mut user = User::of("cornell");
    user.click_nth("Fake", 1);
    user.wait_for("both at rest", |f| both_whole(f) && ["a", "b"].iter().all(|pane| f.state(pane)["at_rest"] == true));
}

/// Its rectangle, which must be seen whole.
fn place(frame: &Frame, pane: &str) -> Option<[f32; 4]> {
    let name = format!("label {pane}");
    frame.shows(&name).then(|| {
        assert_eq!(frame.rect(&name), frame.visible(&name), "{name} is clipped");
        frame.rect(&name)
    })
}

#[test]
fn labels_keep_away_from_the_line_and_are_never_clipped() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    let mut seen = 0;
    for line in [Line::Vertical, Line::Horizontal] {
        for wipe in [0.0, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.98, 1.0] {
            {
                let session = &mut user.viewer.borrow_mut().model.session;
                (session.view, session.line, session.wipe) = (View::Wipe, line, wipe);
            }
            user.frame();
            let frame = user.frame();
            let [left, top, right, bottom] = frame.rect("picture");
            for pane in ["A", "B"] {
                let Some(label) = place(&frame, pane) else { continue };
                seen += 1;
                let (start, end, from, to) = match line {
                    Line::Vertical => (label[0], label[2], left, right),
                    Line::Horizontal => (label[1], label[3], top, bottom),
                };
                let at = from + wipe * (to - from);
                // half of the handle, and the ground around the text
                let clear = if pane == "A" { at - end } else { start - at };
                assert!(clear > 7.0 || line == Line::Horizontal && clear > 0.0, "{pane} {line:?} {wipe}: {label:?}");
                if line == Line::Horizontal && pane == "B" {
                    assert!(bottom - label[3] < start - at + 60.0, "it is nearer to the line than to the foot");
                }
            }
        }
    }
    assert!(seen >= 20, "only {seen} labels were there");
}
