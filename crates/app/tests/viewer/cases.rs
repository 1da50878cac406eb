//! Hard cases: measured and rendered beside the UI, seen to fail, and opened as scenes.

use crate::User;
use egui::{Key, Modifiers};
use visavis::model::CASES;

#[test]
fn a_case_is_measured_beside_its_picture_seen_to_fail_and_opened() {
    let mut user = User::of("cornell");
    user.change(|model| {
        model.session.workspace = CASES;
        model.state.cases.looked_at = 4;
    });
    let text = |frame: &visavis_tests::Frame, name: &str| frame.value(name).to_owned();
    let frame =
        user.wait_for("the picture of case 4", |frame| frame.value("case picture").contains(" samples a pixel"));
    let ring = text(&frame, "ring 2");
    let here = ring.strip_prefix("expected 0.7052169, here ").and_then(|here| here.parse::<f64>().ok());
    // few samples by then, which are off by some percent
    assert!(here.is_some_and(|here| (here - 0.7052).abs() < 0.07), "{ring}");
    user.change(|model| model.state.cases.looked_at = 15);
    user.click("Run this");
    let frame = user.wait_for("rows that pass", |frame| frame.value("text case mark") == "passes");
    assert!(text(&frame, "case verdict").contains("expected 1 ± 1e-5"), "{}", text(&frame, "case verdict"));
    user.click("See it fail");
    user.click("Run this");
    let frame = user.wait_for("rows that fail", |frame| {
        frame.value("text case mark") == "fails" && frame.value("text case course").contains(" rows in ")
    });
    let verdict = text(&frame, "case verdict");
    assert!(verdict.contains("Fails: path light: every pixel: ") && verdict.contains("expected 1.05 ± "), "{verdict}");
    assert!(text(&frame, "case row 1").starts_with("fail, path light"), "{}", text(&frame, "case row 1"));
    user.click("Open as a scene");
    let frame =
        user.wait_for("both pictures", |frame| frame.state("a")["ready"] == true && frame.state("b")["ready"] == true);
    assert_eq!(frame.state("scene"), "Case 15: Camera inside glass");
    user.key_with(Key::Z, Modifiers::COMMAND);
    let frame = user.wait_for("both pictures of before", |frame| {
        frame.state("a")["ready"] == true && frame.state("b")["ready"] == true && frame.state("scene") == "cornell"
    });
    assert_eq!(frame.state("cases")["results"][0]["course"], "Done", "what was measured stays known");
}
