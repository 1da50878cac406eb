//! Every row of the table of settings has a control that sets it.

use super::Panels;
use egui::accesskit::Role;
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT, Queryable};
use pathtrace::{Bug, Bugs, Roulette};
use raster::Repair;
use technique::TechniqueName;
use technique::settings::{Kind, Look, OF_SCENES, Setting, Value, all_of_panes};
use visavis::model::{Model, PaneId};

/// How screen readers know the control of a row: a slider by its label, each word of a choice by itself and the label before it.
fn control_names<T>(
    setting: &Setting<T>,
    technique: Option<TechniqueName>,
    scene: &scene::Scene,
) -> Vec<(Role, String)> {
    let label = setting.control.label;
    let one = |role| vec![(role, label.to_owned())];
    let of_word = |word: &str| if label.is_empty() { word.to_owned() } else { format!("{label}: {word}") };
    match (&setting.kind, &setting.control.look) {
        (Kind::Roulette, _) => {
            ["Roulette: survive", "Roulette by"].map(|word| (Role::CheckBox, word.to_owned())).into()
        }
        (Kind::Choice(_), _) => {
            setting.words(technique, scene).into_iter().map(|(word, ..)| (Role::Button, of_word(word))).collect()
        }
        (Kind::LightPaths, _) => ["all", "direct", "bounce", "up to"].map(|word| (Role::Button, of_word(word))).into(),
        // a box for each that has something to repair, and words for all at once
        (Kind::Repairs, _) => {
            let usable = Repair::ALL.into_iter().filter(|repair| (repair.row().missing_in)(scene).is_none());
            usable.map(|repair| (Role::CheckBox, repair.row().title.to_owned())).collect()
        }
        (Kind::Bugs, _) => {
            Bugs::suited_to(scene).iter().map(|bug| (Role::CheckBox, bug.row().title.to_owned())).collect()
        }
        (_, Look::Typed) => one(Role::SpinButton),
        _ => one(Role::Slider),
    }
}

/// Moves one control of a row, `value` being what is set, and returns what it must have set.
fn move_control(node: &Node, (look, kind): (&Look, &Kind), name: &str, value: Value) -> Value {
    let to_other_end = |start: f64, end: f64, here: f64| {
        let target = if here == end { start } else { end };
        node.set_value_accesskit(target);
        target
    };
    match (look, value) {
        (Look::Steps { range, .. }, Value::Number(number)) => {
            let [start, end, here] = [*range.start(), *range.end(), number].map(f64::from);
            Value::Number(to_other_end(start, end, here) as f32)
        }
        (Look::Logarithmic(range), Value::Number(number)) => {
            let [start, end, here] = [*range.start(), *range.end(), number].map(f64::from);
            // the slider's places are powers of ten
            to_other_end(start.log10(), end.log10(), here.log10());
            Value::Number(if here == end { start } else { end } as f32)
        }
        (Look::Whole(range), Value::Whole(number)) => {
            let [start, end, here] = [*range.start(), *range.end(), number].map(f64::from);
            Value::Whole(to_other_end(start, end, here) as u32)
        }
        (Look::Doubling(range), Value::Whole(number)) => {
            let [start, end, here] = [*range.start(), *range.end(), number.ilog2()].map(f64::from);
            Value::Whole(1 << to_other_end(start, end, here) as u32)
        }
        (Look::Typed, Value::Whole(number)) => {
            node.set_value_accesskit(f64::from(number + 1));
            Value::Whole(number + 1)
        }
        (Look::WholeOrNone(_), Value::Bounces(None)) => {
            node.set_value_accesskit(2.0);
            Value::Bounces(Some(2))
        }
        (_, Value::Roulette(before)) => {
            node.click_accesskit();
            Value::Roulette(match name {
                "Roulette: survive" => Roulette { probability: Some(0.8), ..before },
                _ => Roulette { throughput: !before.throughput, ..before },
            })
        }
        (Look::Repairs, Value::Repairs(before)) => {
            node.click_accesskit();
            let ticked = Repair::ALL.into_iter().find(|repair| repair.row().title == name).expect("a repair");
            Value::Repairs(if before.has(ticked) { before.without(ticked) } else { before.with(ticked) })
        }
        (Look::Bugs, Value::Bugs(before)) => {
            node.click_accesskit();
            let ticked = Bug::ALL.into_iter().find(|bug| bug.row().title == name).expect("a bug");
            Value::Bugs(if before.has(ticked) { before.without(ticked) } else { before.with(ticked) })
        }
        (Look::LightPaths, _) => {
            node.click_accesskit();
            let word = name.rsplit(": ").next().unwrap_or_default();
            let named = if matches!(word, "all" | "direct") { word.to_owned() } else { format!("{word}-0") };
            kind.parse(&named.replace(' ', "-")).expect("a part of the light")
        }
        (Look::Words(_), Value::Word(_)) => {
            node.click_accesskit();
            let word = name.rsplit(": ").next().unwrap_or_default();
            kind.parse(&word.replace(' ', "-")).expect("a word of the choice")
        }
        other => panic!("no control moves {other:?}"),
    }
}

impl Panels {
    /// Widgets of a role among a pane's settings, or anywhere, by their names but for what stands after a label.
    fn widgets(&self, pane: Option<PaneId>, (role, name): (Role, &str)) -> Vec<Node<'_>> {
        let title = pane.map_or_else(String::new, |pane| format!("Settings of {pane}"));
        let within = match pane {
            Some(_) => {
                self.harness.get_by(move |node| node.role() == Role::Group && node.label().as_deref() == Some(&title))
            }
            None => self.harness.root(),
        };
        let called = |label: &str| if role == Role::Button { label == name } else { label.starts_with(name) };
        let widgets = within.children_recursive().filter(|node| {
            let node = node.accesskit_node();
            node.role() == role && node.label().is_some_and(|label| called(&label))
        });
        widgets.collect()
    }

    /// Expects one control of this row if the scene can use it and none if not, and that moving it sets the row.
    fn expect_control<T>(&mut self, setting: &Setting<T>, pane: Option<PaneId>, of: impl Fn(&Model) -> T) -> usize {
        let scene = self.model.borrow().document.scene.clone();
        let usable = setting.needs.missing_in(&scene).is_none();
        let technique = pane.map(|pane| self.model.borrow().session.panes[pane].technique);
        let names = control_names(setting, technique, &scene);
        for name in names.iter().map(|(role, name)| (*role, name.as_str())) {
            let count = self.widgets(pane, name).len();
            assert_eq!(count, usize::from(usable), "{} has {count} controls: {name:?}", setting.name);
            if usable {
                let value = (setting.get)(&of(&self.model.borrow())).or_else(|| (setting.own)(&scene));
                let value = value.expect("a value of its own or the scene's");
                let node = self.widgets(pane, name).remove(0);
                let explained = node.accesskit_node().description().is_some_and(|text| !text.is_empty());
                assert!(explained, "nothing explains {} by {name:?}", setting.name);
                let expected = move_control(&node, (&setting.control.look, &setting.kind), name.1, value);
                self.harness.run_steps(3);
                let set = (setting.get)(&of(&self.model.borrow()));
                assert_eq!(set, Some(expected), "{} by {name:?}", setting.name);
            }
        }
        assert!(!names.is_empty(), "{} has no control", setting.name);
        usize::from(usable)
    }
}

/// A row's control reads and sets the row, in each technique that it is a row of, alone in its pane.
#[test]
fn every_setting_that_the_scene_can_use_has_one_control_that_sets_it() {
    let mut seen = Vec::new();
    for scene in ["whitted", "cornell"] {
        let mut count = 0;
        for technique in TechniqueName::ALL {
            let mut panels = Panels::of(scene);
            panels.unfold_more(1);
            panels.unfold_more(0);
            panels.model.borrow_mut().session.panes[PaneId::A].technique = technique;
            panels.harness.run_steps(3);
            if technique == TechniqueName::Path {
                panels.click("Break the truth", 0);
            }
            let untouched = panels.model.borrow().session.panes[PaneId::B];
            for setting in all_of_panes().filter(|setting| setting.is_of(technique)) {
                count += panels.expect_control(setting, Some(PaneId::A), |model| model.session.panes[PaneId::A]);
            }
            assert_eq!(panels.model.borrow().session.panes[PaneId::B], untouched, "each pane has its own");
        }
        let mut panels = Panels::of(scene);
        for setting in OF_SCENES {
            count += panels.expect_control(setting, None, |model| model.document.changes.clone());
        }
        seen.push(count);
    }
    assert!(seen[0] > seen[1] && seen[1] > 15, "whitted has glass and a sun: {seen:?}");
}

/// What one technique's control sets leaves the pane's other techniques as they were, though they share the row.
#[test]
fn a_control_sets_its_own_technique_alone() {
    let mut panels = Panels::of("whitted");
    let before = panels.model.borrow().session.panes[PaneId::B];
    panels.widgets(Some(PaneId::B), (Role::Slider, "Samples per pixel")).remove(0).set_value_accesskit(3.0);
    panels.harness.run_steps(3);
    let after = panels.model.borrow().session.panes[PaneId::B];
    assert_eq!((after.truth.spp, after.whitted), (8, before.whitted));
    panels.click("Undo", 0);
    assert_eq!(panels.model.borrow().session.panes[PaneId::B], before);
}
