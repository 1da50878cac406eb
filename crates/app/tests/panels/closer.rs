//! Looking closer: a region, magnified pictures, and A and B by turns.

use crate::Panels;
use egui::{Key, Modifiers, PointerButton, Pos2, Vec2, pos2, vec2};
use egui_kittest::kittest::Queryable;
use visavis::model::{Drag, Line, PaneId, View};

impl Panels {
    /// A point of the picture area, in shares of it.
    fn on_pictures(&self, share: [f32; 2]) -> Pos2 {
        let [left, top, right, bottom] = self.model.borrow().state.picture.corners;
        pos2(left, top) + Vec2::from(share) * vec2(right - left, bottom - top)
    }

    /// Drags over the pictures while these keys are held.
    fn drag(&mut self, from: [f32; 2], to: [f32; 2], modifiers: Modifiers) {
        let [from, to] = [from, to].map(|share| self.on_pictures(share));
        self.harness.event(egui::Event::ModifiersChanged(modifiers));
        let button =
            |pos, pressed| egui::Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
        for event in
            [egui::Event::PointerMoved(from), button(from, true), egui::Event::PointerMoved(to), button(to, false)]
        {
            self.harness.event(event);
            self.harness.step();
        }
        self.harness.event(egui::Event::ModifiersChanged(Modifiers::NONE));
        self.harness.run_steps(2);
    }

    fn press(&mut self, key: Key) {
        self.harness.key_press(key);
        self.harness.run_steps(2);
    }

    pub fn press_with(&mut self, key: Key, modifiers: Modifiers) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.run_steps(2);
    }

    /// The region's corners; all that is measured speaks of it.
    fn region(&self) -> Option<[[f32; 2]; 2]> {
        let wanted = self.wanted();
        let region = self.model.borrow().session.comparison.region;
        assert!(
            !wanted.comparisons.is_empty() && wanted.comparisons.iter().all(|comparison| comparison.region == region)
        );
        assert!(wanted.map.is_none_or(|map| map.comparison.region == region));
        region.map(|region| [region.start, region.end])
    }
}

/// Of a drag in points, which is not what a share times the size comes to in f32.
fn is_near(found: Option<[[f32; 2]; 2]>, expected: [[f32; 2]; 2]) -> bool {
    let near = |(a, b): (&f32, &f32)| (a - b).abs() < 1e-3;
    found.is_some_and(|found| found.as_flattened().iter().zip(expected.as_flattened()).all(near))
}

#[test]
fn a_drag_marks_the_region_that_figures_speak_of_and_esc_or_the_key_ends_it() {
    let mut panels = Panels::of("cornell");
    let camera = panels.model.borrow().document.camera;
    // across the wipe's line
    panels.press(Key::M);
    panels.drag([0.75, 0.25], [0.25, 0.5], Modifiers::NONE);
    assert!(is_near(panels.region(), [[0.25, 0.25], [0.75, 0.5]]), "{:?}", panels.region());
    assert!(!panels.model.borrow().state.marking, "one drag marks one region");
    panels.press(Key::Num5);
    panels.region().expect("it is mapped too");
    panels.press(Key::M);
    assert_eq!(panels.region(), None);
    panels.drag([0.1, 0.1], [0.3, 0.9], Modifiers::ALT);
    assert!(is_near(panels.region(), [[0.1, 0.1], [0.3, 0.9]]), "{:?}", panels.region());
    panels.press(Key::Escape);
    assert_eq!(panels.region(), None);
    assert_eq!(panels.model.borrow().document.camera, camera, "no drag has turned it");
    panels.drag([0.1, 0.1], [0.3, 0.9], Modifiers::NONE);
    assert!(panels.region().is_none() && panels.model.borrow().document.camera != camera);
}

#[test]
fn a_slip_of_the_mouse_marks_nothing_and_keeps_what_was_marked() {
    let mut panels = Panels::of("cornell");
    panels.drag([0.1, 0.1], [0.3, 0.9], Modifiers::ALT);
    panels.drag([0.5, 0.5], [0.501, 0.6], Modifiers::ALT);
    assert!(is_near(panels.region(), [[0.1, 0.1], [0.3, 0.9]]), "{:?}", panels.region());
    assert_eq!(panels.model.borrow().state.drag, Drag::Camera);
}

/// Side by side each half has the whole picture.
#[test]
fn a_region_is_kept_in_shares_of_the_picture_whatever_the_view_and_the_window() {
    let mut panels = Panels::of("cornell");
    panels.press(Key::Num4);
    // the right half begins beyond the gap: from 1/4 to 3/4 of B
    panels.drag([0.6265, 0.25], [0.8765, 0.75], Modifiers::ALT);
    let marked = panels.region();
    let near = |found: f32, share: f32| (found - share).abs() < 5e-3;
    assert!(marked.is_some_and(|[start, end]| near(start[0], 0.25) && near(end[0], 0.75)), "{marked:?}");
    panels.press(Key::Num1);
    panels.harness.set_size(vec2(900.0, 700.0));
    panels.harness.run_steps(2);
    assert_eq!(panels.region(), marked);
    let cornell = scene::builtin::named("cornell").expect("a built-in scene");
    panels.model.borrow_mut().open(cornell, "cornell".into());
    panels.harness.run_steps(2);
    assert_eq!(panels.region(), None, "of another scene it says nothing");
}

#[test]
fn the_card_names_the_region_and_goes_back_to_the_whole_picture() {
    let mut panels = Panels::of("cornell");
    panels.harness.get_by_label("Looking closer").scroll_to_me();
    panels.harness.run_steps(3);
    panels.click("Looking closer", 0);
    panels.harness.get_by_label("Mark a region").scroll_to_me();
    panels.harness.run_steps(3);
    panels.click("Mark a region", 0);
    panels.drag([0.0, 0.0], [0.5, 0.5], Modifiers::NONE);
    assert!(panels.shows("Region: ") && panels.shows("at 0, 0"));
    panels.count_named();
    panels.click("Whole picture", 0);
    assert!(panels.region().is_none() && panels.shows("Mark a region"));
}

#[test]
fn keys_magnify_about_the_mouse_and_back_and_nothing_is_made_anew() {
    let mut panels = Panels::of("cornell");
    panels.harness.run_steps(2);
    let (at, size) = (panels.on_pictures([0.2, 0.8]), panels.model.borrow().state.picture.size);
    let seen = |panels: &Panels| panels.model.borrow().state.magnification;
    panels.harness.hover_at(at);
    panels.press(Key::Plus);
    panels.press(Key::Plus);
    panels.press(Key::Plus);
    assert_eq!(seen(&panels).factor(), 8);
    let there = seen(&panels).picture_at([0.2, 0.8]);
    assert!((there[0] - 0.2).abs() < 1e-3 && (there[1] - 0.8).abs() < 1e-3, "{there:?}");
    panels.press(Key::Minus);
    assert_eq!(seen(&panels).factor(), 4);
    let (camera, before) = (panels.model.borrow().document.camera, seen(&panels).picture_at([0.0; 2]));
    panels.drag([0.3, 0.5], [0.4, 0.4], Modifiers::SHIFT);
    let after = seen(&panels).picture_at([0.0; 2]);
    assert!((before[0] - after[0] - 0.025).abs() < 1e-3 && (after[1] - before[1] - 0.025).abs() < 1e-3, "{after:?}");
    assert_eq!(panels.model.borrow().document.camera, camera);
    assert_eq!(panels.model.borrow().state.picture.size, size);
    panels.press(Key::Num0);
    assert_eq!(seen(&panels).factor(), 1);
}

/// What is marked in a magnified picture is that part of the picture.
#[test]
fn a_region_is_marked_in_magnified_pictures_too() {
    let mut panels = Panels::of("cornell");
    panels.press(Key::Num1);
    panels.press(Key::Plus);
    panels.drag([0.0, 0.0], [0.5, 0.5], Modifiers::ALT);
    assert!(is_near(panels.region(), [[0.25, 0.25], [0.5, 0.5]]), "{:?}", panels.region());
}

#[test]
fn a_and_b_flicker_twice_a_second_once_that_is_asked_for() {
    let mut panels = Panels::of("cornell");
    assert_eq!(panels.model.borrow().state.flicker, None, "off at first");
    panels.press(Key::F);
    // three seconds of 60 frames
    let turns: Vec<View> = (0..180)
        .map(|_| {
            panels.harness.step();
            panels.model.borrow().seen()
        })
        .collect();
    let changes = turns.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!((11..=12).contains(&changes), "two flashes a second are four changes: {changes}");
    assert!(turns.contains(&View::Pane(PaneId::A)) && turns.contains(&View::Pane(PaneId::B)));
    assert_eq!(panels.model.borrow().session.view, View::Wipe, "the view that was chosen waits");
    panels.press(Key::F);
    assert_eq!(panels.model.borrow().seen(), View::Wipe);
    panels.press(Key::F);
    panels.press(Key::Num3);
    assert_eq!(panels.model.borrow().state.flicker, None, "another view ends it");
    assert_ne!(panels.model.borrow().session.line, Line::Horizontal, "and shows the wipe as it was");
}

#[test]
fn arrow_keys_alone_mark_move_and_enlarge_the_region_and_move_magnified_pictures() {
    let mut panels = Panels::of("cornell");
    let line = panels.model.borrow().session.wipe;
    panels.press_with(Key::ArrowLeft, Modifiers::COMMAND);
    assert!(is_near(panels.region(), [[0.25, 0.25], [0.75, 0.75]]), "{:?}", panels.region());
    panels.press_with(Key::ArrowLeft, Modifiers::COMMAND);
    panels.press_with(Key::ArrowDown, Modifiers::COMMAND | Modifiers::SHIFT);
    let step = 1.0 / 32.0;
    assert!(is_near(panels.region(), [[0.25 - step, 0.25], [0.75 - step, 0.75 + step]]), "{:?}", panels.region());
    panels.press(Key::Plus);
    let seen = |panels: &Panels| panels.model.borrow().state.magnification.picture_at([0.0; 2]);
    let before = seen(&panels);
    panels.press_with(Key::ArrowRight, Modifiers::SHIFT);
    assert!((seen(&panels)[0] - before[0] - 0.5 * step).abs() < 1e-6, "{before:?} {:?}", seen(&panels));
    assert_eq!(panels.model.borrow().session.wipe, line, "the line has its own arrows");
}
