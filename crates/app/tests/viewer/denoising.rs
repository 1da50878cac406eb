//! A filter between a pane's film and the screen.

use super::{User, both_whole};
use technique::Denoiser;
use visavis::model::{CompareWith, PaneId};
use visavis_tests::Frame;

fn lines<'a>(frame: &'a Frame, pane: &str) -> Vec<&'a str> {
    frame.value(&format!("label {pane}")).lines().collect()
}

fn denoising<'a>(frame: &'a Frame, pane: &str) -> Option<&'a str> {
    lines(frame, pane).into_iter().find(|line| line.starts_with("denoised by "))
}

/// The reference waits for both pictures.
fn few_samples(user: &mut User) {
    let mut viewer = user.viewer.borrow_mut();
    [PaneId::A, PaneId::B].into_iter().for_each(|pane| viewer.model.session.panes[pane].truth.spp = 4);
}

#[test]
fn a_denoised_picture_says_so_and_how_far_off_it_was_before() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    user.click_nth("Path", 0);
    few_samples(&mut user);
    user.viewer.borrow_mut().model.session.panes[PaneId::B].denoise.denoiser = Denoiser::Unet;
    let beside = user.wait_for("a denoised picture", |f| both_whole(f) && denoising(f, "B").is_some());
    assert!(denoising(&beside, "B").is_some_and(|line| line.ends_with(" (biased)")), "held against A it has no error");
    user.viewer.borrow_mut().model.session.comparison.with = CompareWith::Reference;
    let shown =
        user.wait_for("an error", |f| both_whole(f) && denoising(f, "B").is_some_and(|line| line.contains("before")));
    let line = denoising(&shown, "B").expect("a line");
    assert!(line.starts_with("denoised by unet in ") && line.contains(" (biased), relMSE "), "{line}");
    assert_eq!(denoising(&shown, "A"), None, "the other is not");
    assert_eq!(lines(&shown, "B")[0], "B: Path tracing, denoised by unet (biased)");
    // without it the same samples are there at once, and nothing is said
    user.viewer.borrow_mut().model.session.panes[PaneId::B].denoise.denoiser = Denoiser::Off;
    user.wait_for("the samples' mean", |f| both_whole(f) && denoising(f, "B").is_none());
}

#[test]
fn a_mean_of_denoised_runs_is_held_against_the_reference_as_its_bias() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    user.click_nth("Path", 0);
    few_samples(&mut user);
    {
        let session = &mut user.viewer.borrow_mut().model.session;
        let pane = &mut session.panes[PaneId::B];
        (pane.denoise.denoiser, pane.runs, pane.truth.spp) = (Denoiser::Unet, 4, 2);
        session.comparison.with = CompareWith::Reference;
    }
    let biased =
        |f: &Frame| lines(f, "B").iter().any(|line| line.contains("bias ") && line.contains("4 denoised runs"));
    let shown = user.wait_for("a bias", |f| both_whole(f) && biased(f));
    assert!(lines(&shown, "B").iter().any(|line| line.contains("2 spp, mean of 4 runs, ")), "{:?}", lines(&shown, "B"));
    assert_eq!(shown.state("b")["spp"], 8, "the samples of all");
}

/// The camera moves once, and what was seen before counts until the picture has twice as many samples, or is done.
#[test]
fn earlier_views_count_after_a_move_and_the_label_says_so_until_they_have_faded() {
    let lag = |f: &Frame| lines(f, "B").into_iter().find(|line| line.ends_with(" old (lag)")).map(str::to_owned);
    let mut user = User::of("cornell");
    let first = user.wait_for("both pictures", both_whole);
    user.change(|model| {
        let pane = &mut model.session.panes[PaneId::B];
        (pane.denoise.history, pane.truth.spp) = (256, 15);
    });
    user.wait_for("a picture that may count", |f| both_whole(f) && f.state("b")["spp"] == 15);
    user.change(|model| model.session.panes[PaneId::B].truth.spp = 4096);
    assert_eq!(lag(&first), None);
    user.wheel(first.point("picture", 0.3, 0.5), egui::Modifiers::NONE);
    let moved = user.wait_for("earlier views", |f| lag(f).is_some());
    let line = lag(&moved).expect("a line");
    assert!(line.starts_with("+ ") && line.contains(" spp of earlier views, "), "{line}");
    user.change(|model| model.session.panes[PaneId::B].truth.spp = 16);
    user.wait_for("the samples' mean", |f| f.state("b")["spp"] == 16 && both_whole(f) && lag(f).is_none());
}
