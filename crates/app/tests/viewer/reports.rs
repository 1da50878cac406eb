//! A report and a slide are of what is on the screen.

use super::comparison::{SCENE, choose_the_reference};
use super::export::export;
use super::{User, both_whole, says};
use egui::{Key, Modifiers};
use visavis::model::{PaneId, View};
use visavis_tests::Frame;

#[test]
fn a_report_tells_what_the_labels_tell() {
    let mut user = User::of("cornell");
    user.change(|model| model.session.panes[PaneId::B].truth.spp = 4);
    let done = |f: &Frame| both_whole(f) && f.state("b")["spp"] == 4 && f.state("a")["rel_mse"].is_f64();
    user.wait_for("four samples", done);
    let frame = user.wait_for("an end", |f| done(f) && f.state("b")["unfinished"] == false);
    let page = user.file("report.html");
    export(&mut user, &["Report"], &page);
    let html = std::fs::read_to_string(&page).expect("the page");
    assert!(html.contains("A: Fake, fair") && html.contains("B: Path tracing, light"), "both pictures");
    assert!(html.contains("4 samples per pixel") && html.contains("<td class=\"n\">4</td>"), "their samples");
    assert!(html.contains(&rel_mse(&frame, "a")) && html.contains("either may be wrong"), "held against B");
    assert!(html.contains("scene = &quot;cornell&quot;") && html.ends_with("</html>\n"), "the session, to the end");
    let missing = user.file("missing").join("report.html");
    let told = export_to_nowhere(&mut user, &missing);
    assert!(told.contains("missing") && told.lines().count() == 1, "{told}");
    assert!(!missing.exists());
}

/// A pane's relMSE as the page tells it.
fn rel_mse(frame: &Frame, pane: &str) -> String {
    format!("<td class=\"n\">{:.6}</td>", frame.state(pane)["rel_mse"].as_f64().expect("an error"))
}

#[test]
fn a_report_has_the_reference_that_judges_the_panes() {
    let mut user = User::of(SCENE);
    choose_the_reference(&mut user);
    let judged = |f: &Frame| ["a", "b"].iter().all(|pane| f.state(pane)["rel_mse"].is_f64());
    user.wait_for("errors", judged);
    // the reference stays as it is
    user.key(Key::P);
    let page = user.file("report.html");
    export(&mut user, &["Report"], &page);
    let html = std::fs::read_to_string(&page).expect("the page");
    assert!(html.contains("<b>Reference</b>") && html.contains("<p>The reference's own error: "));
    assert_eq!(html.matches("<td>reference</td>").count(), 2, "of both");
    assert!(html.contains("visavis reference ") && html.matches("<svg ").count() == 2);
}

/// What the window says of an export that cannot be.
fn export_to_nowhere(user: &mut User, file: &std::path::Path) -> String {
    user.click("Export");
    user.type_into("File", &file.display().to_string());
    user.click("Save");
    let frame = user.wait_for("a refusal", |f| says(f, "missing"));
    frame.state("message").as_str().unwrap_or_default().to_owned()
}

#[test]
fn a_slide_is_as_large_as_chosen_and_opens_as_the_window_was() {
    let mut user = User::of("cornell");
    // before the first pictures: those of another view's size would be whole too
    user.change(|model| model.session.view = View::SideBySide);
    user.wait_for("both pictures", both_whole);
    for (size, pixels) in [("1920 x 1080", (1920, 1080)), ("3840 x 2160", (3840, 2160))] {
        let slide = user.file(&format!("{}.png", pixels.0));
        export(&mut user, &["Slide", size], &slide);
        assert_eq!(image_file::load(&slide).expect("a picture").size(), pixels);
        let records = image_file::records(&slide).expect("records");
        let has = |name: &str| records.iter().any(|(known, _)| known == name);
        assert!(has("A") && has("B") && has("session"), "{records:?}");
    }
    user.key(Key::Num1);
    let slide = user.file("1920.png");
    user.open(&slide.display().to_string());
    let opened = user.wait_for("the slide as it was", |f| says(f, "shows it"));
    assert_eq!(opened.state("view"), "Side by side");
}

#[test]
fn a_key_saves_a_report_where_the_menu_would() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    let folder = user.file("");
    user.change(|model| model.state.export.file = folder.display().to_string());
    user.key_with(Key::P, Modifiers::COMMAND);
    user.wait_for("the report", |f| says(f, "Saved") && says(f, "report.html"));
    assert!(user.file("visavis-cornell-report.html").is_file());
    assert_eq!(user.frame().state("paused"), false, "P alone pauses");
}
