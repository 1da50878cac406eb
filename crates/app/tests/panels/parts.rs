//! The parts of the scene: the tree, the cards and the mouse.

use crate::Panels;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use scene::edit::Subject;
use scene::{Camera, Names, Scene, Variant, Vec3};
use std::sync::Arc;
use visavis::model::{Model, ObjectMap, Theme, ViewModel};
use visavis::ui::Workspaces;

/// A window of a scene with its parts open.
fn of(scene: Scene) -> Panels {
    with(scene, None)
}

fn built_in(name: &str) -> Scene {
    scene::builtin::named(name).expect("a built-in scene")
}

/// The same where it is known which shape each pixel shows.
fn with(scene: Scene, objects: Option<ObjectMap>) -> Panels {
    let name = scene.name.clone();
    let model = Model::new(scene, name, Theme::Dark);
    let shown = ViewModel { objects: objects.map(Arc::new), ..ViewModel::default() };
    let mut panels = Panels::with(model, Workspaces::default(), shown);
    panels.harness.run_steps(2);
    panels.hit(Key::O);
    panels
}

/// A map of two columns: these shapes, as they are seen from here.
fn map(scene: &Scene, camera: Camera, shapes: [u32; 2]) -> ObjectMap {
    ObjectMap { scene: Arc::new(scene.clone()), camera, size: (2, 1), shapes: shapes.into() }
}

impl Panels {
    fn hit(&mut self, key: Key) {
        self.harness.key_press_modifiers(Modifiers::NONE, key);
        self.harness.run_steps(3);
    }

    fn seen(&self) -> Arc<Scene> {
        self.model.borrow().document.seen().clone()
    }

    fn choose(&mut self, part: Subject) {
        self.model.borrow_mut().state.parts.selected = Some(part);
        self.harness.run_steps(4);
    }

    fn chosen(&self) -> Option<Subject> {
        self.model.borrow().state.parts.selected.clone()
    }

    fn nothing_is_changed(&self) -> bool {
        self.model.borrow().document.changes.edits.is_empty()
    }

    /// A point of the picture area, in shares of it.
    fn point(&self, x: f32, y: f32) -> Pos2 {
        let [left, top, right, bottom] = self.model.borrow().state.picture.corners;
        Pos2::new(left + x * (right - left), top + y * (bottom - top))
    }

    /// Moves the mouse, and presses or lets go of its button; the modifiers stay down.
    fn mouse(&mut self, pos: Pos2, pressed: Option<bool>, modifiers: Modifiers) {
        self.harness.event(Event::ModifiersChanged(modifiers));
        self.harness.event(Event::PointerMoved(pos));
        self.harness.step();
        if let Some(pressed) = pressed {
            self.harness.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers });
            self.harness.step();
        }
    }

    fn click_at(&mut self, at: Pos2) {
        self.mouse(at, Some(true), Modifiers::NONE);
        self.mouse(at, Some(false), Modifiers::NONE);
        self.harness.run_steps(4);
    }

    /// What rows of shapes are laid out.
    fn rows_of_shapes(&self) -> Vec<String> {
        let rows = self.harness.root().children_recursive().filter_map(|node| node.accesskit_node().label());
        rows.filter(|label| label.starts_with("Shape ")).collect()
    }
}

fn shape(name: &str) -> Subject {
    Subject::Shape(name.into())
}

fn material(name: &str) -> Subject {
    Subject::Material(name.into())
}

#[test]
fn a_key_and_a_button_open_them_and_esc_closes_them() {
    let mut panels = of(built_in("whitted"));
    assert!(panels.shows("Close the parts"));
    panels.hit(Key::Escape);
    assert!(!panels.shows("Close the parts"));
    panels.model.borrow_mut().state.panel = false;
    panels.click("Parts", 0);
    assert!(panels.shows("Close the parts"), "with the controls, among which their cards stand");
    panels.click("Close the parts", 0);
    assert!(!panels.model.borrow().state.parts.open);
}

#[test]
fn a_click_belongs_to_the_parts_or_to_the_probe() {
    let mut panels = of(built_in("whitted"));
    let open = |panels: &Panels| (panels.model.borrow().state.parts.open, panels.model.borrow().session.probe.open);
    panels.hit(Key::B);
    assert_eq!(open(&panels), (false, true));
    panels.hit(Key::O);
    assert_eq!(open(&panels), (true, false));
}

#[test]
fn the_tree_lists_what_there_is_and_every_widget_has_a_name() {
    let mut whitted = of(built_in("whitted"));
    for row in ["Lights (2)", "Sun", "Sky", "Shapes (3)", "Shape glass ball", "Materials (3)", "Material glass"] {
        assert!(whitted.harness.query_by_label(row).is_some(), "{row}");
    }
    assert!(!whitted.shows("Find a part") && !whitted.shows("Variants") && !whitted.shows("Cameras"));
    whitted.click("Shapes (3)", 0);
    assert!(whitted.rows_of_shapes().is_empty(), "folded");
    whitted.choose(shape("metal ball"));
    assert!(whitted.rows_of_shapes().contains(&"Shape metal ball".into()), "what is chosen is seen");
    whitted.count_named();
    let cornell = of(built_in("cornell-balls"));
    assert!(cornell.shows("Light lamp") && cornell.shows("Find a part"));
}

#[test]
fn a_click_chooses_the_shape_there_or_the_sky_and_the_name_stands_at_the_mouse() {
    let scene = built_in("whitted");
    let objects = map(&scene, scene.camera, [1, ObjectMap::NOTHING]);
    let mut panels = with(scene, Some(objects));
    let (ball, beside) = (panels.point(0.2, 0.9), panels.point(0.9, 0.9));
    panels.mouse(ball, None, Modifiers::NONE);
    panels.harness.run_steps(2);
    assert!(panels.shows("metal ball, metal"));
    panels.click_at(ball);
    assert_eq!(panels.chosen(), Some(shape("metal ball")));
    assert!(panels.shows("Part: metal ball") && panels.shows("Material: metal"), "with what it wears");
    assert!(panels.shows("sphere, radius 1; mirror"));
    panels.click_at(beside);
    assert_eq!(panels.chosen(), Some(Subject::Sky));
    panels.hit(Key::O);
    panels.click_at(ball);
    assert_eq!(panels.chosen(), Some(Subject::Sky), "closed");
}

#[test]
fn a_click_on_the_sun_chooses_it() {
    let scene = built_in("whitted");
    let sun = scene.sun.expect("a sun");
    let target = scene.camera.eye + sun.towards;
    let objects = map(&scene, Camera { target, ..scene.camera }, [ObjectMap::NOTHING; 2]);
    let mut panels = with(scene, Some(objects));
    let [middle, beside] = [panels.point(0.5, 0.5), panels.point(0.8, 0.3)];
    // under the line of the wipe, which is not what a click is for
    panels.click_at(middle);
    assert_eq!(panels.chosen(), Some(Subject::Sun));
    panels.click_at(beside);
    assert_eq!(panels.chosen(), Some(Subject::Sky));
}

#[test]
fn a_control_changes_what_is_seen_and_undo_and_reset_take_it_back() {
    let mut panels = of(built_in("whitted"));
    panels.click("Material glass", 0);
    let ior = |panels: &Panels| panels.seen().refraction_ratio().map(|ratio| 1.0 / ratio);
    let own = ior(&panels);
    panels.harness.get_by_role_and_label(Role::Slider, "Index of refraction").set_value_accesskit(1.8);
    panels.harness.run_steps(3);
    assert_eq!(ior(&panels), Some(1.8));
    assert!(panels.shows("Material glass, changed"));
    panels.click("Undo", 0);
    assert_eq!(ior(&panels), own);
    panels.click("Redo", 0);
    panels.click("Leave the material as in the file", 0);
    assert!(panels.nothing_is_changed());
    panels.click("Kind: mirror", 0);
    assert!(panels.shows("mirror; worn by 1 shape"));
    panels.click("Kind: as in the file", 0);
    assert!(panels.nothing_is_changed() && panels.shows("glass, n = 1.43; worn by 1 shape"));
}

#[test]
fn a_typed_number_of_a_colour_changes_that_number_alone() {
    let mut panels = of(built_in("whitted"));
    panels.click("Material metal", 0);
    let colour = |panels: &Panels| {
        let (part, seen) = (material("metal"), panels.seen());
        let property = part.property("colour").expect("a row");
        (property.get)(&seen, part.index_in(&seen).expect("metal")).and_then(|value| value.triple()).expect("a colour")
    };
    let before = colour(&panels);
    panels.type_number("Colour, green", "0,25");
    panels.enter();
    assert_eq!(colour(&panels), Vec3::new(before.x, 0.25, before.z));
    panels.type_number("Colour, green", "1.5");
    panels.enter();
    assert!(panels.message().contains("1.5 is outside 0 to 1"), "{}", panels.message());
    assert_eq!(colour(&panels).y, 0.25);
}

/// Looking at a part changes nothing, whatever way a value takes to its control and back.
#[test]
fn every_property_has_a_control_and_none_changes_by_being_looked_at() {
    for name in ["whitted", "phong", "cornell-balls", "hard/point-light-in-sphere", "hard/slab"] {
        let scene = built_in(name);
        let mut panels = of(scene.clone());
        let shapes = (0..scene.shapes.len()).map(|index| shape(&scene.shape_name(index)));
        let materials = scene.materials.iter().map(|found| material(&found.name));
        let lights = (0..scene.point_lights.len()).map(|index| Subject::Light(scene.light_name(index).into()));
        let parts: Vec<Subject> = shapes.chain(materials).chain(lights).chain([Subject::Sun, Subject::Sky]).collect();
        for part in parts {
            let Some(index) = part.index_in(&scene) else { continue };
            panels.choose(part.clone());
            let there = part.properties().iter().filter(|property| (property.get)(&scene, index).is_some());
            there.for_each(|row| assert!(panels.shows(row.label), "{name}: {} of {part}", row.name));
            panels.count_named();
            assert!(panels.nothing_is_changed(), "{name}: {part}");
        }
    }
}

#[test]
fn a_variant_is_chosen_by_its_name() {
    let scene = built_in("whitted");
    let other = scene.shapes[2].material;
    let variants = [Variant { name: "red".into(), wears: vec![(0, other)] }];
    let mut panels = of(Scene { variants: variants.into(), ..scene.clone() });
    panels.click("Variant red", 0);
    assert_eq!(panels.seen().shapes[0].material, other);
    panels.click("Variant usual", 0);
    assert_eq!(panels.seen().shapes[0].material, scene.shapes[0].material);
    panels.click("Undo", 0);
    assert_eq!(panels.seen().shapes[0].material, other);
    panels.click("Leave all as in the file", 0);
    assert!(panels.nothing_is_changed());
}

#[test]
fn what_is_left_out_stays_in_the_tree_and_comes_back() {
    let mut panels = of(built_in("whitted"));
    panels.click("Shape glass ball", 0);
    panels.click("Left out", 0);
    assert_eq!(panels.seen().shapes.len(), 2);
    assert!(panels.shows("Shape glass ball, left out, changed") && panels.shows("Part: glass ball"));
    panels.count_named();
    panels.click("Show glass ball again", 0);
    assert!(panels.nothing_is_changed() && panels.seen().shapes.len() == 3);
}

#[test]
fn a_change_that_cannot_be_made_is_told_until_one_can() {
    let scene = built_in("cornell-balls");
    let ball = |glass: bool| {
        let is_glass = |index: &usize| {
            let bsdf = &scene.material_of(&scene.shapes[*index]).bsdf;
            matches!(bsdf, scene::Bsdf::Dielectric { .. }) == glass && scene.shapes[*index].geometry.kind() == "sphere"
        };
        (0..scene.shapes.len()).find(is_glass).expect("a ball")
    };
    let [glass, other] = [ball(true), ball(false)];
    let mut panels = of(scene.clone());
    panels.choose(shape(&scene.shape_name(other)));
    panels.harness.get_by_label("Material: mirror (menu)").click_accesskit();
    panels.harness.run_steps(4);
    panels.harness.get_by_role_and_label(Role::Button, "glass").click_accesskit();
    panels.harness.run_steps(4);
    assert_eq!(panels.seen().shapes[other].material, scene.shapes[glass].material);
    let before = panels.seen();
    panels.harness.get_by_role_and_label(Role::Slider, "Size").set_value_accesskit(0.4);
    panels.harness.run_steps(4);
    assert!(panels.message().contains("would overlap other glass"), "{}", panels.message());
    assert!(Arc::ptr_eq(&panels.seen(), &before), "the one before stays");
    panels.harness.get_by_role_and_label(Role::Slider, "Size").set_value_accesskit(-0.2);
    panels.harness.run_steps(4);
    assert_eq!(panels.message(), "");
    assert!(!Arc::ptr_eq(&panels.seen(), &before));
}

/// So many balls with names in folders.
fn crowd(count: usize) -> Scene {
    let scene = built_in("whitted");
    let names = (0..count).map(|index| format!("hall/row {}/seat {index}", index / 100)).collect();
    let shapes = vec![scene.shapes[1].clone(); count].into();
    Scene { shapes, names: Arc::new(Names::new(names, Vec::new())), variants: Arc::new([]), ..scene }
}

#[test]
fn of_a_hundred_thousand_shapes_only_those_in_sight_are_laid_out() {
    let mut panels = of(crowd(100_000));
    assert!(panels.rows_of_shapes().is_empty(), "folded");
    panels.click("Shapes of hall", 0);
    panels.click("Shapes of hall/row 0", 0);
    let rows = panels.rows_of_shapes();
    assert!(rows.len() > 5 && rows.len() < 60, "{}", rows.len());
    panels.choose(shape("hall/row 777/seat 77742"));
    assert!(panels.rows_of_shapes().contains(&"Shape hall/row 777/seat 77742".into()), "scrolled there");
    // by what it is called, in whatever case
    panels.harness.get_by_label("Find a part").click();
    panels.harness.run_steps(2);
    panels.harness.event(Event::Text("SEAT 9999".into()));
    panels.harness.run_steps(4);
    assert!(panels.shows("Shapes (11)"), "9999 and 99990 to 99999");
    assert!(panels.rows_of_shapes().contains(&"Shape hall/row 99/seat 9999".into()));
    panels.choose(shape("hall/row 1/seat 100"));
    assert!(panels.rows_of_shapes().contains(&"Shape hall/row 1/seat 100".into()), "what hides it is taken away");
}

#[test]
fn ctrl_and_a_drag_move_the_shape_in_one_step() {
    let scene = built_in("whitted");
    let objects = map(&scene, scene.camera, [1, ObjectMap::NOTHING]);
    let mut panels = with(scene, Some(objects));
    let center = |panels: &Panels| panels.seen().shapes[1].geometry.center();
    let (before, camera) = (center(&panels), panels.model.borrow().document.camera);
    let start = panels.point(0.2, 0.9);
    let drag = |panels: &mut Panels, modifiers: Modifiers| {
        panels.mouse(start, Some(true), modifiers);
        for step in 1..=4 {
            panels.mouse(start + vec2(10.0, -10.0) * step as f32, None, modifiers);
        }
    };
    let let_go = |panels: &mut Panels, modifiers: Modifiers| {
        panels.mouse(start + vec2(40.0, -40.0), Some(false), modifiers);
        panels.harness.event(Event::ModifiersChanged(Modifiers::NONE));
        panels.harness.run_steps(3);
    };
    drag(&mut panels, Modifiers::COMMAND);
    let_go(&mut panels, Modifiers::COMMAND);
    assert_eq!(panels.chosen(), Some(shape("metal ball")));
    let moved = center(&panels) - before;
    let frame = camera.frame(1.0);
    assert!(moved.length() > 0.01 && moved.dot(frame.forward).abs() < 1e-4 * moved.length(), "{moved}");
    assert!(moved.dot(frame.right) > 0.0 && moved.dot(frame.up) > 0.0, "after the mouse: {moved}");
    // as far as the mouse, which went as many points to the right as up
    let [right, up] = [frame.right, frame.up].map(|axis| moved.dot(axis.normalize()));
    assert!((right / up - 1.0).abs() < 1e-2, "{right} {up}");
    assert_eq!(panels.model.borrow().document.camera, camera, "which stays");
    panels.click("Undo", 0);
    assert_eq!(center(&panels), before);
    drag(&mut panels, Modifiers::COMMAND | Modifiers::SHIFT);
    let_go(&mut panels, Modifiers::COMMAND | Modifiers::SHIFT);
    let moved = center(&panels) - before;
    assert!(moved.y > 0.01 && moved.x == 0.0 && moved.z == 0.0, "{moved}");
    let lifted = center(&panels);
    drag(&mut panels, Modifiers::COMMAND);
    assert_ne!(center(&panels), lifted);
    panels.harness.key_press(Key::Escape);
    panels.harness.run_steps(2);
    assert_eq!(center(&panels), lifted, "given up");
    let_go(&mut panels, Modifiers::COMMAND);
    assert_eq!((center(&panels), panels.model.borrow().document.camera), (lifted, camera));
    assert!(panels.model.borrow().state.parts.open, "the next Esc closes them");
}

#[test]
fn narrow_windows_have_the_tree_among_the_controls() {
    for (size, theme) in
        [([1024.0, 768.0], Theme::Projector), ([640.0, 360.0], Theme::Light), ([800.0, 600.0], Theme::Dark)]
    {
        let mut model = Model::new(built_in("whitted"), "whitted".into(), theme);
        model.state.parts.open = true;
        let mut panels = Panels::showing(model);
        panels.harness.set_size(size.into());
        panels.choose(shape("metal ball"));
        panels.harness.run_steps(4);
        let tree = panels.harness.get_by_label("Shape metal ball").rect();
        let [left, _, right, _] = panels.model.borrow().state.picture.corners;
        assert_eq!(tree.left() < left, size[0] >= 1000.0, "{size:?}");
        assert!(right - left > 0.45 * size[0], "{size:?}: the picture is {} wide", right - left);
        panels.count_named();
    }
}
