//! Numbers are typed, dragged, refused with a word and brought back.

use super::Panels;
use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;

impl Panels {
    /// Types into the number of this name and leaves it by Enter.
    pub(super) fn type_number(&mut self, name: &str, text: &str) {
        self.harness.get_by_role_and_label(Role::SpinButton, name).click();
        self.harness.run_steps(2);
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.run_steps(1);
        self.harness.event(egui::Event::Text(text.into()));
        self.harness.run_steps(2);
    }

    pub(super) fn enter(&mut self) {
        self.harness.key_press(Key::Enter);
        self.harness.run_steps(3);
    }

    fn ratio(&self) -> Option<f32> {
        self.model.borrow().document.changes.refraction_ratio
    }

    pub(super) fn message(&self) -> String {
        self.model.borrow().state.message.as_ref().map_or(String::new(), |message| message.text.clone())
    }
}

#[test]
fn a_typed_number_counts_on_enter_with_a_point_or_a_comma() {
    let mut panels = Panels::of("whitted");
    panels.type_number("Refraction ratio", "0,55");
    assert_eq!(panels.ratio(), None, "it is still being typed");
    panels.enter();
    assert_eq!(panels.ratio(), Some(0.55));
    panels.type_number("Refraction ratio", "0.8");
    panels.enter();
    assert_eq!(panels.ratio(), Some(0.8));
}

#[test]
fn a_number_that_is_refused_stays_and_is_told() {
    let mut panels = Panels::of("whitted");
    for (typed, said) in [("5000", "5000 is outside 0.001 to 1000"), ("O.7", "\"O.7\" is no number")] {
        panels.type_number("Refraction ratio", typed);
        panels.enter();
        assert_eq!(panels.ratio(), None, "{typed}");
        assert!(panels.message().contains(said), "{}", panels.message());
    }
}

#[test]
fn esc_gives_up_what_is_typed() {
    let mut panels = Panels::of("whitted");
    panels.type_number("Refraction ratio", "0.5");
    panels.harness.key_press(Key::Escape);
    panels.harness.run_steps(6);
    assert_eq!(panels.ratio(), None);
    panels.type_number("Refraction ratio", "0.6");
    panels.enter();
    assert_eq!(panels.ratio(), Some(0.6), "and the next number counts");
}

#[test]
fn the_cameras_numbers_are_refused_with_a_word_as_all_are() {
    let mut panels = Panels::of("whitted");
    // which unfolds its card
    panels.model.borrow_mut().document.camera.fov_y = 59.0;
    panels.harness.run_steps(3);
    panels.harness.get_by_role_and_label(Role::SpinButton, "Field of view").scroll_to_me();
    panels.harness.run_steps(5);
    panels.type_number("Field of view", "500");
    panels.enter();
    assert!(panels.message().contains("500 is outside"), "{}", panels.message());
    assert_eq!(panels.model.borrow().document.camera.fov_y, 59.0);
}

#[test]
fn a_double_click_on_a_slider_brings_back_what_is_usual() {
    let mut panels = Panels::of("whitted");
    panels.harness.get_by_role_and_label(Role::Slider, "Refraction ratio").set_value_accesskit(0.5);
    panels.harness.run_steps(2);
    assert_eq!(panels.ratio(), Some(0.5));
    let at = panels.harness.get_by_role_and_label(Role::Slider, "Refraction ratio").rect().left_center();
    let (button, modifiers, pos) = (PointerButton::Primary, Modifiers::NONE, at + egui::vec2(9.0, 0.0));
    panels.harness.event(egui::Event::PointerMoved(pos));
    panels.harness.step();
    for pressed in [true, false, true, false] {
        panels.harness.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
    }
    panels.harness.step();
    panels.harness.run_steps(2);
    assert_eq!(panels.ratio(), None, "the scene's own, and not a number like it");
}

#[test]
fn undo_covers_the_camera() {
    let mut panels = Panels::of("whitted");
    let before = panels.model.borrow().document.camera;
    panels.model.borrow_mut().document.camera.fov_y = 30.0;
    panels.harness.run_steps(3);
    panels.click("Undo", 0);
    assert_eq!(panels.model.borrow().document.camera, before);
    panels.click("Redo", 0);
    assert_eq!(panels.model.borrow().document.camera.fov_y, 30.0);
}
