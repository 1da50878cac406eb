//! What keys and mouse do to the views: full screen, the wipe's line, and what each shows of the scene.

use super::Panels;
use egui_kittest::kittest::Queryable;
use visavis::model::{Line, Model, PaneId, Theme};
use visavis::ui::UiCommand;

#[test]
fn f11_asks_for_the_full_screen_and_esc_closes_one_thing_after_the_other() {
    let mut panels = Panels::of("whitted");
    let press = |panels: &mut Panels, key| {
        panels.harness.key_press(key);
        panels.harness.run_steps(3);
    };
    press(&mut panels, egui::Key::F11);
    assert_eq!(panels.requests.borrow_mut().drain(..).collect::<Vec<_>>(), [UiCommand::FullScreen]);
    let help = "full screen, and back";
    press(&mut panels, egui::Key::Questionmark);
    panels.click("Look", 0);
    assert!(panels.shows(help) && panels.shows("Theme"));
    press(&mut panels, egui::Key::Escape);
    assert!(panels.shows(help) && !panels.shows("Theme"), "the menu lies above the help");
    press(&mut panels, egui::Key::Escape);
    assert!(!panels.shows(help));
    let before = panels.model.borrow().session.clone();
    press(&mut panels, egui::Key::Escape);
    assert!(panels.requests.borrow().is_empty() && panels.model.borrow().session == before, "a presenter's remote");
}

/// Where the line stands, as a share of the picture.
fn line(panels: &Panels) -> (Line, f32) {
    let session = &panels.model.borrow().session;
    (session.line, session.wipe)
}

#[test]
fn the_line_begins_where_glass_and_metal_lie_on_both_sides_and_comes_back_there() {
    let mut panels = Panels::of("whitted");
    panels.harness.run_steps(2);
    let first = line(&panels);
    assert!(first.0 == Line::Horizontal && (0.45..0.55).contains(&first.1), "{first:?}");
    // a line that the user has moved stays, until it is clicked twice
    panels.model.borrow_mut().session.wipe = 0.2;
    panels.harness.run_steps(2);
    assert_eq!(line(&panels), (Line::Horizontal, 0.2));
    let [left, top, right, bottom] = panels.model.borrow().state.picture.corners;
    let pos = egui::pos2(0.5 * (left + right), top + 0.2 * (bottom - top));
    // each event is a frame, and a frame a quarter of a second
    panels.harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 10.0);
    panels.harness.hover_at(pos);
    for pressed in [true, false, true, false] {
        let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::NONE);
        panels.harness.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
    }
    panels.harness.run_steps(2);
    assert_eq!(line(&panels), first);
    panels.click("Wipe", 0);
    let turned = line(&panels);
    assert!(turned.0 == Line::Vertical && (0.25..0.4).contains(&turned.1), "it cuts both balls: {turned:?}");
    let cornell = scene::builtin::named("cornell").expect("a built-in scene");
    panels.model.borrow_mut().open(cornell, "cornell".into());
    panels.harness.run_steps(2);
    assert_eq!(line(&panels), (Line::Vertical, 0.5), "nothing there is of glass or metal");
}

/// Tangents of half the angles that a pane's picture takes in, along its width and its height.
fn seen(panels: &Panels) -> [f32; 2] {
    let wanted = panels.wanted();
    let shot = &wanted.panes[PaneId::A].shot;
    let frame = shot.camera.frame(shot.size.0 as f32 / shot.size.1 as f32);
    [frame.right.length(), frame.up.length()]
}

#[test]
fn no_view_crops_what_the_wipe_shows() {
    let mut panels = Panels::of("whitted");
    panels.harness.run_steps(2);
    for hidden in [false, true] {
        panels.model.borrow_mut().state.panel = !hidden;
        panels.click("Wipe", 0);
        let wipe = seen(&panels);
        assert_eq!(panels.wanted().panes[PaneId::A].shot.camera, panels.model.borrow().document.camera);
        panels.click("Side by side", 0);
        let half = seen(&panels);
        assert!(half.iter().zip(wipe).all(|(half, wipe)| *half > 0.999 * wipe), "{half:?} of {wipe:?}");
        panels.click("A", 0);
        assert_eq!(seen(&panels), wipe, "one pane alone shows the same");
    }
}

#[test]
fn the_cameras_of_a_file_are_looked_through_by_name() {
    let whitted = scene::builtin::named("whitted").expect("a built-in scene");
    let above = scene::Camera { eye: scene::Vec3::new(1.0, 30.0, 2.0), ..whitted.camera };
    let named = |name: &str, camera| scene::NamedCamera { name: name.into(), camera };
    let cameras = [named("front", whitted.camera), named("above", above)].into();
    let with_cameras = scene::Scene { cameras, ..whitted };
    let mut panels = Panels::showing(Model::new(with_cameras, "model.glb".into(), Theme::Dark));
    panels.click("Camera (both)", 0);
    panels.harness.get_by_label("The file's cameras").scroll_to_me();
    panels.harness.run_steps(5);
    panels.click("The file's cameras", 0);
    panels.click("above", 0);
    assert_eq!(panels.model.borrow().document.camera, above);
    assert!(!Panels::of("whitted").shows("The file's cameras"), "a scene that names none");
}
