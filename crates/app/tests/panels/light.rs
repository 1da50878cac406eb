//! Light apart: words, numbers, expressions and bars that say which light counts.

use super::Panels;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use technique::settings::of_panes;
use visavis::model::{LightByBounce, Model, PaneId, Theme, ViewModel, light_parts};
use visavis::ui::Workspaces;

impl Panels {
    /// Which light B counts.
    fn light_of_b(&self) -> String {
        let pane = self.model.borrow().session.panes[PaneId::B];
        let row = of_panes("light").expect("a row of the table");
        (row.get)(&pane).expect("a value").to_string()
    }

    fn type_paths(&mut self, text: &str) {
        self.harness.get_by_role_and_label(Role::TextInput, "Light paths").focus();
        self.harness.run_steps(2);
        self.harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
        self.harness.get_by_role_and_label(Role::TextInput, "Light paths").type_text(text);
        self.harness.run_steps(2);
        self.harness.key_press(Key::Enter);
        self.harness.run_steps(3);
    }
}

/// The Cornell box where a half of the light is that of the part before.
fn with_bars() -> Panels {
    let opened = scene::builtin::named("cornell").expect("a built-in scene");
    let luminances = light_parts().enumerate().map(|(part, _)| 0.5f64.powi(part as i32)).collect();
    let mut shown = ViewModel::default();
    shown.light.insert(PaneId::B, LightByBounce { luminances });
    Panels::with(Model::new(opened, "cornell".into(), Theme::Dark), Workspaces::default(), shown)
}

#[test]
fn words_keep_their_number_and_become_an_expression_that_can_be_typed() {
    let mut panels = Panels::of("cornell");
    panels.click("Light: direct", 0);
    assert_eq!(panels.light_of_b(), "direct");
    panels.click("Light: paths", 0);
    assert_eq!(panels.light_of_b(), "L[DG]?S*E", "what was chosen, as an expression");
    panels.type_paths(" L S+ D E ");
    assert_eq!(panels.light_of_b(), "LS+DE");
    panels.type_paths("LSx");
    assert_eq!(panels.light_of_b(), "LS+DE", "what is no path changes nothing");
    let said = panels.model.borrow().state.message.clone().expect("a message");
    assert!(said.text.contains("column 3: expected L, D, G, S, E"), "{}", said.text);
    panels.click("Light: bounce", 0);
    panels.harness.get_by_role_and_label(Role::Slider, "Bounce").set_value_accesskit(3.0);
    panels.harness.run_steps(3);
    panels.click("Light: up to", 0);
    assert_eq!(panels.light_of_b(), "up-to-3");
    panels.click("Light: bounce", 0);
    assert_eq!(panels.light_of_b(), "bounce-3", "the number stays");
    panels.click("Light: all", 0);
    assert_eq!(panels.light_of_b(), "all");
    panels.count_named();
}

#[test]
fn a_bar_shows_its_light_alone_and_once_more_all_and_keys_reach_it() {
    let mut panels = with_bars();
    assert!(panels.wanted().light.is_empty(), "nothing is measured that nobody looks at");
    panels.click("Light by bounce", 0);
    assert_eq!(panels.wanted().light.iter().map(|wish| wish.pane).collect::<Vec<_>>(), [PaneId::B], "A is a fake");
    // lights 1, bounces 1/2, 1/4, 1/8 ... of 2 - 2^-10
    panels.click("only bounce 2: 6.3 %", 0);
    assert_eq!(panels.light_of_b(), "bounce-2");
    assert_eq!(panels.wanted().light.len(), 1, "bars are of all light");
    panels.click("only bounce 2: 6.3 %", 0);
    assert_eq!(panels.light_of_b(), "all");
    panels.harness.get_by_label("only from bounce 9 on: 0.05 %").focus();
    panels.harness.run_steps(2);
    panels.harness.key_press(Key::Space);
    panels.harness.run_steps(3);
    assert_eq!(panels.light_of_b(), "from-9");
    panels.count_named();
}

#[test]
fn bars_wait_until_all_parts_are_measured() {
    let mut panels = Panels::of("cornell");
    panels.click("Light by bounce", 0);
    assert!(panels.shows("measuring ...") && !panels.shows("only bounce"));
}
