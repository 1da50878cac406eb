//! Tests of which parts are looked at.

use super::*;
use crate::model::{PictureArea, Theme};

#[test]
fn a_change_that_cannot_be_made_is_told_and_the_one_before_stays() {
    let scene = scene::builtin::named("cornell-balls").expect("a built-in scene");
    let glass =
        scene.shapes.iter().position(|shape| matches!(scene.material_of(shape).bsdf, scene::Bsdf::Dielectric { .. }));
    let glass = glass.expect("a glass ball");
    let other = (0..scene.shapes.len())
        .find(|index| *index != glass && scene.shapes[*index].geometry.kind() == "sphere")
        .expect("another ball");
    let subject = Subject::Shape(scene.shape_name(other).into_owned());
    let (wears, center) = (subject.property("material").expect("a row"), subject.property("center").expect("a row"));
    let material = Value::Word(scene.material_of(&scene.shapes[glass]).name.clone());
    let beside = Value::Triple(scene.shapes[glass].geometry.center() + 0.1);
    let mut model = Model::new(scene, "cornell-balls".into(), Theme::Dark);
    model.edit(&subject, wears, Some(material));
    assert!(model.state.message.is_none());
    let before = model.document.changes.clone();
    model.edit(&subject, center, Some(beside));
    assert!(model.state.message.take().is_some_and(|message| message.text.contains("would overlap")));
    assert_eq!(model.document.changes, before);
    model.edit(&subject, wears, None);
    assert!(model.document.changes.edits.is_empty());
}

/// A viewer's model with the parts open, beside a picture of 8 x 6 pixels.
fn looking(scene: &str) -> Model {
    let mut model = Model::new(scene::builtin::named(scene).expect("a built-in scene"), scene.into(), Theme::Dark);
    model.state.picture = PictureArea::of_size((8, 6), [0.0; 4]);
    model.state.parts.open = true;
    model
}

/// What is known where each row of the map shows these shapes.
fn shown(model: &Model, rows: [[u32; 4]; 3], along: Option<ShapesAlong>) -> ViewModel {
    let (scene, camera) = (model.document.seen().clone(), model.document.camera);
    let map = ObjectMap { scene, camera, size: (4, 3), shapes: rows.concat() };
    ViewModel { objects: Some(Arc::new(map)), along, ..ViewModel::default() }
}

fn chosen(model: &Model) -> Option<usize> {
    model.state.parts.selected.as_ref().and_then(|part| part.index_in(model.document.seen()))
}

#[test]
fn where_parts_are_seen_is_wanted_only_while_they_are_looked_at_and_there_is_a_picture() {
    let mut model = looking("cornell");
    let wish = model.objects_wish().expect("a wish");
    assert!(Arc::ptr_eq(&wish.scene, model.document.seen()) && wish.size == (8, 6) && wish.outlined.is_empty());
    assert!(model.objects_wish() == Some(wish));
    model.state.picture.size = (0, 6);
    assert!(model.objects_wish().is_none());
    model.state.picture.size = (8, 6);
    model.state.parts.open = false;
    assert!(model.objects_wish().is_none());
}

#[test]
fn the_chosen_shape_is_outlined_or_all_that_wear_the_chosen_material_and_no_light() {
    let mut model = looking("cornell");
    let scene = model.document.seen().clone();
    let mut outlined_of = |part: Subject| {
        model.state.parts.selected = Some(part);
        model.objects_wish().expect("a wish").outlined
    };
    assert_eq!(outlined_of(Subject::Shape(scene.shape_name(3).into_owned())), [3]);
    let worn = |material: &usize| scene.shapes.iter().filter(|shape| shape.material == *material).count();
    let material = (0..scene.materials.len()).max_by_key(worn).expect("a material");
    let wearing = outlined_of(Subject::Material(scene.materials[material].name.clone()));
    assert!(wearing.len() > 1 && wearing.iter().all(|shape| scene.shapes[*shape as usize].material == material));
    assert_eq!(wearing.len(), worn(&material));
    for part in [Subject::Sky, Subject::Sun, Subject::Shape("none".into()), Subject::Material("none".into())] {
        assert!(outlined_of(part).is_empty());
    }
}

#[test]
fn a_click_chooses_what_is_seen_and_one_at_the_same_place_what_is_behind() {
    const NOTHING: u32 = ObjectMap::NOTHING;
    let rows = [[2, 2, 3, NOTHING], [2, 2, 3, NOTHING], [2, 2, 3, NOTHING]];
    let mut model = looking("cornell");
    let at = [0.1, 0.5];
    model.choose_at(at, &ViewModel::default());
    assert_eq!((chosen(&model), model.state.parts.looked_into), (None, None), "nothing is known yet");
    let at_first = shown(&model, rows, None);
    model.choose_at(at, &at_first);
    assert_eq!((chosen(&model), model.state.parts.looked_into), (Some(2), Some(at)));
    model.choose_at(at, &at_first);
    assert_eq!(chosen(&model), Some(2), "what is behind is not known yet");
    let looked_into = shown(&model, rows, Some(ShapesAlong { at, shapes: vec![2, 5, 1] }));
    for (place, expected) in [(at, 5), ([0.2, 0.4], 1), (at, 2), (at, 5)] {
        model.choose_at(place, &looked_into);
        assert_eq!((chosen(&model), model.state.parts.looked_into), (Some(expected), Some(at)));
    }
    model.choose_at([0.9, 0.5], &looked_into);
    assert_eq!(
        (chosen(&model), model.state.parts.looked_into),
        (None, Some([0.9, 0.5])),
        "elsewhere, where nothing is"
    );
    assert_eq!(ShapesAlong { at, shapes: Vec::new() }.behind(None), None);
}

#[test]
fn a_map_is_of_one_scene_seen_from_one_place_at_one_size() {
    let mut model = looking("cornell");
    let map = shown(&model, [[0; 4]; 3], None).objects.expect("a map");
    let is_of = |model: &Model| {
        let shot = model.document.shot(&model.state.picture);
        let wish = model.objects_wish().expect("a wish");
        assert_eq!(map.is_of(&shot), wish.is_of_the_view_of(&map));
        map.is_of(&shot)
    };
    assert!(is_of(&model));
    model.document.camera.fov_y += 1.0;
    assert!(!is_of(&model));
    model.document.camera.fov_y = map.camera.fov_y;
    model.state.picture.size = (9, 6);
    assert!(!is_of(&model));
    model.state.picture.size = (8, 6);
    model.document.open((*map.scene).clone(), "cornell".into());
    assert!(!is_of(&model), "another scene, however alike");
}

fn material(model: &Model, name: &str) -> Subject {
    let subject = Subject::Material(name.into());
    assert!(subject.index_in(&model.document.scene).is_some());
    subject
}

fn changed(model: &mut Model, subject: &Subject, property: &str, number: f32) {
    let property = subject.property(property).expect("a row");
    model.edit(subject, property, Some(Value::Number(number)));
    model.settle(false);
}

#[test]
fn undo_gives_changes_back_and_the_scene_with_them() {
    let scene = scene::builtin::named("whitted").expect("a built-in scene");
    let mut model = Model::new(scene, "whitted".into(), Theme::Dark);
    let glass = material(&model, "glass");
    let ior = |model: &Model| {
        let seen = model.document.seen();
        (glass.property("ior").expect("a row").get)(seen, glass.index_in(seen).expect("glass"))
    };
    let own = ior(&model);
    changed(&mut model, &glass, "ior", 1.25);
    changed(&mut model, &glass, "ior", 1.75);
    model.undo();
    assert_eq!(ior(&model), Some(Value::Number(1.25)));
    model.undo();
    assert_eq!((ior(&model), model.document.changes.edits.is_empty()), (own, true));
    model.redo();
    assert_eq!(ior(&model), Some(Value::Number(1.25)));
    // the slider of all glass takes the place of what was said of one, in one step
    for ratio in [0.9, 0.8] {
        model.document.changes.set_refraction_ratio(Some(ratio));
        model.settle(ratio == 0.9);
    }
    assert!(model.document.changes.edits.is_empty());
    model.undo();
    assert_eq!(ior(&model), Some(Value::Number(1.25)));
}

#[test]
fn an_index_of_one_glass_leaves_the_others_at_the_slider_of_all_until_each_has_its_own() {
    let mut scene = scene::builtin::named("whitted").expect("a built-in scene");
    let glass = scene.materials.iter().find(|material| material.name == "glass").expect("glass").clone();
    scene.materials.push(scene::Material { name: "ice".into(), ..glass });
    let mut model = Model::new(scene, "whitted".into(), Theme::Dark);
    let [glass, ice] = ["glass", "ice"].map(|name| material(&model, name));
    let indices = |model: &Model| {
        let dielectric = |material: &scene::Material| match material.bsdf {
            scene::Bsdf::Dielectric { ior } => Some(ior),
            _ => None,
        };
        model.document.seen().materials.iter().filter_map(dielectric).collect::<Vec<_>>()
    };
    model.document.changes.set_refraction_ratio(Some(0.8));
    model.settle(false);
    changed(&mut model, &ice, "ior", 2.0);
    assert_eq!((indices(&model), model.document.changes.refraction_ratio), (vec![1.25, 2.0], Some(0.8)));
    // and there and back, as sessions and undo keep it
    model.undo();
    assert_eq!(indices(&model), [1.25, 1.25]);
    model.redo();
    assert_eq!(indices(&model), [1.25, 2.0]);
    changed(&mut model, &glass, "ior", 1.5);
    assert_eq!((indices(&model), model.document.changes.refraction_ratio), (vec![1.5, 2.0], None));
    let row = ice.property("ior").expect("a row");
    model.document.changes.set_refraction_ratio(Some(0.5));
    changed(&mut model, &ice, "ior", 3.0);
    model.edit(&ice, row, None);
    assert_eq!(indices(&model), [2.0, 2.0], "what is taken back is at the slider again");
}

#[test]
fn a_change_that_is_refused_is_no_step() {
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    let mut model = Model::new(scene, "cornell".into(), Theme::Dark);
    let white = material(&model, "white");
    let lobe = white.property("lobe").expect("a row");
    model.edit(&white, lobe, Some(Value::Word("felt".into())));
    model.settle(false);
    assert!(model.state.message.is_some());
    assert_eq!(model.can_undo_and_redo(), [false, false]);
}

#[test]
fn of_a_scene_that_is_read_again_changes_stay_that_fit_and_no_undo_brings_the_others_back() {
    let scene = scene::builtin::named("whitted").expect("a built-in scene");
    let mut without = scene.clone();
    without.materials.iter_mut().filter(|m| m.name == "glass").for_each(|m| m.name = "ice".into());
    let mut model = Model::new(scene, "whitted".into(), Theme::Dark);
    let glass = material(&model, "glass");
    changed(&mut model, &glass, "ior", 1.25);
    changed(&mut model, &Subject::Sun, "elevation", 30.0);
    let lost = model.reread(without.clone()).expect("it is another");
    assert!(lost.len() == 1 && lost[0].ends_with(": material 'glass'"), "{lost:?}");
    assert_eq!(model.document.changes.edits, "{ sun.elevation = 30 }".parse().expect("changes"));
    let towards = |model: &Model| model.document.seen().sun.expect("a sun").towards;
    assert!((towards(&model).y - 0.5).abs() < 1e-6);
    model.settle(false);
    model.undo();
    assert!(model.document.changes.edits.is_empty() && model.state.message.is_none());
    assert_eq!(towards(&model), without.sun.expect("a sun").towards);
    assert!(!model.can_undo_and_redo()[0], "what was changed in glass is no step");
    assert_eq!(model.reread(without), None);
}
