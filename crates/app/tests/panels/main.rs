//! The panels without a window: what is there, what it changes, and that everything has a name.

#![expect(clippy::expect_used, reason = "a test stops at the first thing that is not as it must be")]

mod bugs;
mod cases;
mod closer;
mod effects;
mod ladder;
mod light;
mod numbers;
mod parts;
mod plots;
mod probe;
mod settings;
mod sweep;
mod trees;
mod views;

use egui::accesskit::{Role, Toggled};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use std::cell::RefCell;
use std::rc::Rc;
use technique::{Adapter, Adapters, DeviceChoice, TechniqueName};
use visavis::model::{Against, Model, PaneId, Theme, View, ViewModel, Wanted};
use visavis::ui::{self, Dump, Textures, UiCommand, UiContext, Workspaces};

/// The window of a scene without its pictures, drawn at 1280 x 720.
struct Panels {
    harness: Harness<'static>,
    model: Rc<RefCell<Model>>,
    workspaces: Rc<RefCell<Workspaces>>,
    requests: Rc<RefCell<Vec<UiCommand>>>,
}

impl Panels {
    fn of(scene: &str) -> Self {
        let opened = scene::builtin::named(scene).expect("a built-in scene");
        Self::showing(Model::new(opened, scene.into(), Theme::Dark))
    }

    /// The same beside an adapter.
    fn beside_an_adapter(scene: &str, device: DeviceChoice) -> Self {
        let opened = scene::builtin::named(scene).expect("a built-in scene");
        let adapters = Adapters(vec![Adapter { name: "an adapter, an interface".into(), software: true }]);
        Self::showing(Model::new(opened, scene.into(), Theme::Dark).beside(adapters, device))
    }

    fn showing(model: Model) -> Self {
        Self::in_workspaces(model, Workspaces::default())
    }

    fn in_workspaces(model: Model, workspaces: Workspaces) -> Self {
        Self::with(model, workspaces, ViewModel::default())
    }

    /// The window of what there is to show, without textures.
    fn with(model: Model, workspaces: Workspaces, shown: ViewModel) -> Self {
        let model = Rc::new(RefCell::new(model));
        let workspaces = Rc::new(RefCell::new(workspaces));
        let requests = Rc::new(RefCell::new(Vec::new()));
        let (shared, offered, asked) = (model.clone(), workspaces.clone(), requests.clone());
        let harness = Harness::builder().with_size([1280.0, 800.0]).with_step_dt(1.0 / 60.0).build_ui(move |ui| {
            let mut cx = UiContext {
                model: &mut shared.borrow_mut(),
                shown: &shown,
                textures: &Textures::default(),
                dump: &mut Dump::default(),
                commands: &mut asked.borrow_mut(),
            };
            ui::show(&mut offered.borrow_mut(), &mut cx, ui);
        });
        Panels { harness, model, workspaces, requests }
    }

    fn shows(&self, label: &str) -> bool {
        self.harness.query_all_by_label_contains(label).next().is_some()
    }

    /// What shall be made of all that is chosen.
    fn wanted(&self) -> Wanted {
        self.workspaces.borrow().open().wanted(&self.model.borrow())
    }

    /// Expects that every widget has a name, and returns how many there are.
    fn count_named(&self) -> usize {
        let root = self.harness.root();
        let mut nameless = Vec::new();
        let mut named = 0;
        for node in root.children_recursive() {
            let node = node.accesskit_node();
            let widgets =
                [Role::Button, Role::CheckBox, Role::RadioButton, Role::Slider, Role::SpinButton, Role::TextInput];
            if widgets.contains(&node.role()) {
                match node.label() {
                    Some(label) if !label.trim().is_empty() => named += 1,
                    _ => nameless.push(format!("{:?} {:?}", node.role(), node.bounding_box())),
                }
            }
        }
        assert!(nameless.is_empty(), "{named} named, without a name: {nameless:#?}");
        named
    }

    /// What screen readers call the buttons of a group.
    fn names_of_buttons(&self, group: &str) -> Vec<String> {
        let group = self.harness.get_by_role_and_label(Role::Group, group);
        let buttons = group.children_recursive().filter(|node| node.accesskit_node().role() == Role::Button);
        buttons.filter_map(|node| node.accesskit_node().label()).collect()
    }

    /// Unfolds the rare settings of the `nth` pane.
    fn unfold_more(&mut self, nth: usize) {
        self.harness.query_all_by_label_contains("more settings").nth(nth).expect("the title").click_accesskit();
        self.harness.run_steps(3);
    }

    /// Clicks the `nth` widget of that label, from the top.
    fn click(&mut self, label: &str, nth: usize) {
        // by its name, wherever the panel is scrolled to
        self.harness.get_all_by_label(label).nth(nth).expect("the widget").click_accesskit();
        self.harness.run_steps(3);
    }
}

#[test]
fn settings_that_cannot_apply_are_absent() {
    let (whitted, cornell) = (Panels::of("whitted"), Panels::of("cornell"));
    for of_glass_and_sun in ["Refraction ratio", "Sun radius", "Reflectivity"] {
        assert!(whitted.shows(of_glass_and_sun) && !cornell.shows(of_glass_and_sun), "{of_glass_and_sun}");
    }
    let mut two_fakes = Panels::of("cornell");
    assert!(two_fakes.shows("Samples per pixel"));
    two_fakes.click("Fake", 1);
    assert_eq!(two_fakes.model.borrow().session.panes[PaneId::B].technique, TechniqueName::Raster);
    assert!(!two_fakes.shows("Samples per pixel") && !two_fakes.shows("throughput"));
}

#[test]
fn where_rays_are_traced_is_chosen_where_there_is_a_choice() {
    let mut without = Panels::of("cornell");
    without.unfold_more(1);
    assert!(without.shows("Seed") && !without.shows("GPU"));
    let mut panels = Panels::beside_an_adapter("cornell", DeviceChoice::Gpu);
    panels.unfold_more(1);
    assert!(panels.shows("The GPU is an adapter, an interface"));
    let device = |panels: &Panels| [PaneId::A, PaneId::B].map(|pane| panels.model.borrow().session.panes[pane].device);
    assert_eq!(device(&panels), [DeviceChoice::Gpu; 2]);
    panels.click("Rays are traced by: auto", 0);
    assert_eq!(device(&panels), [DeviceChoice::Gpu, DeviceChoice::Auto]);
    assert!(!panels.shows("The GPU is"), "where the processor plays the adapter, auto is the processor");
    panels.click("Undo", 0);
    assert_eq!(device(&panels), [DeviceChoice::Gpu; 2]);
    panels.count_named();
    panels.click("Whitted", 1);
    panels.click("Rays are traced by: the CPU", 0);
    assert_eq!(device(&panels), [DeviceChoice::Gpu, DeviceChoice::Cpu], "Whitted's trees are traced there too");
    panels.click("Metropolis", 1);
    assert!(
        panels.shows("The chains of Metropolis run on the processor alone") && !panels.shows("Rays are traced by"),
        "there is no choice"
    );
}

#[test]
fn every_widget_has_a_name_and_a_slider_the_one_above_it() {
    let mut panels = Panels::of("whitted");
    panels.click("Roulette: survive with P", 0);
    panels.click("Camera (both)", 0);
    panels.click("Against: reference", 0);
    panels.click("Error map", 0);
    panels.click("Export", 0);
    let named = panels.count_named();
    assert!(named > 30, "{named}");
    assert!(panels.harness.query_by_role_and_label(Role::Slider, "Exposure").is_some());
}

/// Beside "on" and "off" screen readers, and who speaks to the window, need to know of what.
#[test]
fn no_two_buttons_of_a_pane_have_one_name() {
    let mut panels = Panels::beside_an_adapter("whitted", DeviceChoice::Auto);
    panels.unfold_more(0);
    let set = |panels: &mut Panels, pane: PaneId, technique: TechniqueName| {
        panels.model.borrow_mut().session.panes[pane].technique = technique;
        panels.harness.run_steps(3);
    };
    for technique in TechniqueName::ALL {
        set(&mut panels, PaneId::A, technique);
        let mut names = panels.names_of_buttons("Settings of A");
        assert!(names.len() > 2, "{technique:?}: {names:?}");
        names.sort();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{technique:?}: {names:?}");
    }
    set(&mut panels, PaneId::A, TechniqueName::Path);
    set(&mut panels, PaneId::B, TechniqueName::Raster);
    for name in ["Connections: off", "Glass splits paths: off", "Cones at glass and mirrors: all"] {
        panels.harness.get_by_label(name).click_accesskit();
        panels.harness.run_steps(3);
    }
    let path = panels.model.borrow().session.panes[PaneId::A].truth.path;
    assert_eq!((path.connections, path.split_glass, path.cones), (false, false, pathtrace::ConesAt::Everything));
}

/// An estimator that only an option names is lit too, and gone with the next choice.
#[test]
fn what_an_option_has_chosen_is_there_to_be_seen() {
    let mut panels = Panels::of("cornell");
    let is_lit = |panels: &Panels, word: &str| {
        panels.harness.query_by_label(word).is_some_and(|node| node.accesskit_node().toggled() == Some(Toggled::True))
    };
    assert!(is_lit(&panels, "light") && !panels.shows("guided-mis"));
    panels.model.borrow_mut().session.panes[PaneId::B].truth.path.estimator =
        pathtrace::Estimator::named("guided-mis").expect("an estimator");
    panels.harness.run_steps(3);
    assert!(is_lit(&panels, "guided-mis") && !is_lit(&panels, "light"));
    panels.click("mis", 0);
    assert!(is_lit(&panels, "mis") && !panels.shows("guided-mis"));
}

/// At the usual height all that is chosen for a pane takes two lines, whatever the theme.
#[test]
fn presets_stand_beside_the_techniques() {
    for (theme, size) in
        [(Theme::Dark, [1280.0, 720.0]), (Theme::Dark, [1024.0, 640.0]), (Theme::Projector, [1024.0, 640.0])]
    {
        let whitted = scene::builtin::named("whitted").expect("a built-in scene");
        let mut panels = Panels::showing(Model::new(whitted, "whitted".into(), theme));
        panels.harness.set_size(size.into());
        panels.harness.run_steps(3);
        let row = |name: &str, nth: usize| panels.harness.get_all_by_label(name).nth(nth).expect("the button").rect();
        for (pane, presets) in ["Presets of A", "Presets of B"].into_iter().enumerate() {
            let presets = row(presets, 0);
            let rows = ["Fake", "Metropolis"].map(|name| row(name, pane));
            assert!(rows.iter().any(|row| row.y_range().contains(presets.center().y)), "{theme:?} {size:?}");
            assert!(rows[1].top() - rows[0].bottom() < rows[0].height(), "two lines: {theme:?} {size:?}");
            assert!(presets.right() <= size[0], "{theme:?} {size:?}");
        }
    }
}

#[test]
fn what_the_map_and_the_reference_need_is_there_with_them_alone() {
    let mut panels = Panels::of("cornell");
    let of_both = ["Hold the scale", "Load the reference", "B - reference"];
    assert!(!of_both.iter().any(|label| panels.shows(label)));
    panels.click("Error map", 0);
    assert!(panels.shows("Hold the scale") && !panels.shows("B - reference"), "against each other it is A's alone");
    panels.click("FLIP", 0);
    assert!(!panels.shows("Hold the scale"), "the scale of FLIP is always from 0 to 1");
    panels.click("squared relative", 0);
    panels.click("Hold the scale", 0);
    panels.click("Against: reference", 0);
    assert!(of_both.iter().all(|label| panels.shows(label)));
    panels.click("B - reference", 0);
    let wish = panels.wanted().map.expect("a map to draw");
    assert_eq!((wish.comparison.of, wish.comparison.against), (PaneId::B, Against::Reference));
    assert_eq!(wish.metric, compare::ErrorMetric::SquaredRelative);
    assert_eq!(wish.held, Some(1.0), "there was no picture to fit it to");
    // each map has a scale of its own
    panels.click("relative", 0);
    assert_eq!(panels.wanted().map.map(|wish| wish.held), Some(None));
}

#[test]
fn another_scene_takes_its_own_numbers_and_shows_its_picture() {
    let mut panels = Panels::of("whitted");
    panels.unfold_more(0);
    panels.click("Show: cube faces", 0);
    panels.model.borrow_mut().session.panes[PaneId::A].fake.knobs.segments = Some(7);
    panels.harness.run_steps(2);
    let cornell = scene::builtin::named("cornell").expect("a built-in scene");
    panels.model.borrow_mut().open(cornell, "cornell".into());
    panels.harness.run_steps(2);
    let settings = panels.model.borrow().settings();
    assert_eq!(settings.panes[PaneId::A].fake.show, raster::Show::Picture);
    assert_eq!(settings.panes[PaneId::A].fake.knobs.segments, None);
}

#[test]
fn keys_that_are_held_or_come_twice_in_a_frame_count_as_often_as_they_are_pressed() {
    let mut panels = Panels::of("whitted");
    let key = |pressed, repeat| egui::Event::Key {
        key: egui::Key::T,
        physical_key: None,
        pressed,
        repeat,
        modifiers: egui::Modifiers::NONE,
    };
    let events = [key(true, false), key(true, true), key(true, true), key(false, false), key(true, false)];
    events.into_iter().for_each(|event| panels.harness.event(event));
    panels.harness.run_steps(6);
    assert_eq!(panels.model.borrow().session.view, View::Pane(PaneId::B), "from the wipe to A, and on to B");
}

#[test]
fn choices_change_their_pane_and_undo_takes_them_back() {
    let mut panels = Panels::of("whitted");
    let before = panels.model.borrow().settings();
    panels.click("as-taught", 0);
    panels.click("cosine", 0);
    let after = panels.model.borrow().settings();
    assert_eq!(after.panes[PaneId::A].fake.fake, raster::Fake::AsTaught);
    assert_eq!(after.panes[PaneId::B].truth.path.estimator, pathtrace::Estimator::COSINE);
    panels.click("Undo", 0);
    panels.click("Undo", 0);
    assert_eq!(panels.model.borrow().settings(), before);
    panels.click("Redo", 0);
    panels.click("Redo", 0);
    assert_eq!(panels.model.borrow().settings(), after);
}

#[test]
fn keys_and_menus_ask_the_shell() {
    let mut panels = Panels::of("whitted");
    panels.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::S);
    panels.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Q);
    panels.harness.run_steps(2);
    let asked = panels.requests.borrow().clone();
    assert!(matches!(asked[..], [UiCommand::Export { .. }, UiCommand::Quit]), "{asked:?}");
}

#[test]
fn a_second_workspace_has_a_tab_where_it_is_asked_for_and_wants_pictures_of_its_own() {
    let usual = Panels::of("whitted");
    assert!(usual.harness.query_by_label("Empty").is_none(), "buttons of the bar choose among the usual ones");
    let cornell = scene::builtin::named("cornell").expect("a built-in scene");
    let model = Model::new(cornell, "cornell".into(), Theme::Dark);
    let mut panels = Panels::in_workspaces(model, Workspaces::beginning_with(Some("empty")));
    assert_eq!(panels.wanted().panes.ids().count(), 0);
    assert!(!panels.shows("Side by side"), "the views belong to the comparison");
    panels.click("Compare", 0);
    assert_eq!(panels.wanted().panes.ids().collect::<Vec<_>>(), [PaneId::A, PaneId::B]);
    assert_eq!(panels.wanted().comparisons.len(), 2);
    panels.click("Side by side", 0);
    assert_eq!(panels.model.borrow().session.view, View::SideBySide);
    panels.count_named();
}
