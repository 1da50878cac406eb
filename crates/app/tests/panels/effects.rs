//! The effects of light on the error map: switch, key, table and labels.

use super::Panels;
use compare::ErrorMetric;
use egui::Key;
use film::{DisplayTransform, Image, Vec3};
use std::sync::Arc;
use technique::Shot;
use technique::effects::{Effect, EffectMap};
use visavis::model::{EffectsOfView, ErrorMap, ErrorMapJob, Model, ShownEffects, Theme, View, ViewModel};
use visavis::ruler::{HeatMap, Noise, Pair};
use visavis::ui::Workspaces;

const SIZE: (u32, u32) = (40, 24);

/// An error map of whitted whose upper half is sky and without error, and whose lower is a caustic.
fn with_effects() -> Panels {
    let opened = scene::builtin::named("whitted").expect("a built-in scene");
    let (width, height) = SIZE;
    let pixels = (width * height) as usize;
    let grey = |value: f32| vec![Vec3::splat(value); pixels];
    let mut off = grey(0.5);
    off[pixels / 2..].fill(Vec3::splat(1.0));
    let image = |values| Image::new(width, height, values).expect("pixels of that size");
    let (noise, display) = ([Noise::None, Noise::None], DisplayTransform::default());
    let pair = Pair { names: ["A", "B"], images: [image(off), image(grey(0.5))], noise, display };
    let map = HeatMap::of(&pair, ErrorMetric::Signed, None).expect("pictures of one size");
    let map_job = ErrorMapJob { pair, map: ErrorMetric::Signed, held: None, region: None };
    let errors = ErrorMap { map_job, mean: map.mean, nonfinite: 0, rgba: Vec::new(), map };
    let mut effects = vec![Effect::Sky; pixels];
    effects[pixels / 2..].fill(Effect::Caustic);
    let map = EffectMap { size: SIZE, effects };
    let shares = map.shares(&errors.map.values, width);
    let of_view = Arc::new(EffectsOfView::new(Shot::of(opened.clone(), SIZE), map));
    let shown = ViewModel {
        map: Some(Arc::new(errors)),
        effects: Some(ShownEffects { of_view, shares }),
        ..ViewModel::default()
    };
    Panels::with(Model::new(opened, "whitted".into(), Theme::Dark), Workspaces::default(), shown)
}

#[test]
fn effects_are_wanted_of_the_map_alone_and_where_they_are_switched_on() {
    let mut panels = Panels::of("whitted");
    let effects = |panels: &Panels| panels.wanted().effects.is_some();
    panels.harness.key_press(Key::E);
    panels.harness.run_steps(3);
    assert!(!panels.model.borrow().session.comparison.effects, "there is no map that the key could be of");
    panels.click("Error map", 0);
    assert!(panels.shows("Name the effects") && !effects(&panels));
    panels.harness.key_press(Key::E);
    panels.harness.run_steps(3);
    assert!(effects(&panels) && panels.shows("looking ..."));
    panels.click("Side by side", 0);
    assert!(!effects(&panels), "nobody sees them");
    panels.click("Error map", 0);
    panels.click("Name the effects", 0);
    assert!(!effects(&panels) && !panels.shows("looking ..."));
    panels.count_named();
}

#[test]
fn a_row_says_what_an_effect_has_of_the_picture_and_of_the_error_and_a_click_what_it_is() {
    let mut panels = with_effects();
    panels.model.borrow_mut().session.view = View::ErrorMap;
    panels.model.borrow_mut().session.comparison.effects = true;
    panels.harness.run_steps(3);
    assert!(panels.shows("Sky: 50 % of the pixels, 0 % of the error"));
    let about = Effect::Caustic.row().about;
    assert!(!panels.shows(about));
    panels.click("Caustic: 50 % of the pixels, 100 % of the error", 0);
    assert_eq!(panels.model.borrow().state.effect.chosen, Some(Effect::Caustic));
    assert!(panels.shows(about));
    panels.count_named();
    panels.click("Caustic: 50 % of the pixels, 100 % of the error", 0);
    assert_eq!(panels.model.borrow().state.effect.chosen, None);
    assert!(!panels.shows(about));
}
