use super::*;
use crate::{Bsdf, Geometry, Vec3, builtin};

pub(super) fn scene(name: &str) -> Scene {
    builtin::named(name).expect("a built-in scene")
}

pub(super) fn edits(changes: &[(Subject, &str, Value)]) -> Edits {
    let mut edits = Edits::default();
    for (subject, name, value) in changes {
        edits.set(subject, subject.property(name).expect("a property"), value.clone());
    }
    edits
}

pub(super) fn subjects(scene: &Scene) -> Vec<Subject> {
    let materials = scene.materials.iter().map(|material| Subject::Material(material.name.clone()));
    let shapes = (0..scene.shapes.len()).map(|index| Subject::Shape(scene.shape_name(index).into_owned()));
    let lights = (0..scene.point_lights.len()).map(|index| Subject::Light(scene.light_name(index).into_owned()));
    let ones = [Subject::Sun, Subject::Sky].into_iter().filter(|subject| subject.index_in(scene).is_some());
    materials.chain(shapes).chain(lights).chain(ones).collect()
}

#[test]
fn every_property_set_to_what_it_is_changes_nothing() {
    for name in builtin::names() {
        let scene = scene(name);
        for subject in subjects(&scene) {
            for property in subject.properties() {
                let index = subject.index_in(&scene).expect("it is there");
                let Some(value) = (property.get)(&scene, index) else { continue };
                assert!(property.kind.holds(&value), "{name}: {subject}: {} is {value:?}", property.name);
                let same = edits(&[(subject.clone(), property.name, value)]).applied_to(&scene).expect("it can be");
                assert!(same == scene, "{name}: {subject}: {}", property.name);
            }
        }
    }
}

#[test]
fn a_shape_moves_to_where_its_middle_is_wanted_whatever_it_is() {
    for name in builtin::names() {
        let scene = scene(name);
        for index in 0..scene.shapes.len() {
            let subject = Subject::Shape(scene.shape_name(index).into_owned());
            let center = Vec3::new(300.0, 250.0, -120.0);
            let moved = edits(&[(subject, "center", Value::Triple(center))]).applied_to(&scene).expect("it can be");
            let reached = moved.shapes[index].geometry.center();
            assert!((reached - center).abs().max_element() < 1e-3, "{name} {index}: {reached}");
            let size = |scene: &Scene| {
                let (lo, hi) = scene.shapes[index].geometry.bounds();
                hi - lo
            };
            assert!((size(&moved) - size(&scene)).abs().max_element() < 1e-3, "{name} {index}");
        }
    }
}

#[test]
fn glass_is_not_moved_into_other_glass() {
    let scene = scene("cornell-balls");
    let is_glass = |index: &usize| matches!(scene.material_of(&scene.shapes[*index]).bsdf, Bsdf::Dielectric { .. });
    let glass = (0..scene.shapes.len()).find(is_glass).expect("a glass ball");
    let other = (0..scene.shapes.len())
        .find(|index| matches!(scene.shapes[*index].geometry, Geometry::Sphere { .. }) && *index != glass);
    let other = other.expect("another ball");
    let subject = Subject::Shape(scene.shape_name(other).into_owned());
    let material = Value::Word(scene.material_of(&scene.shapes[glass]).name.clone());
    let (from, to) = (scene.shapes[other].geometry.center(), scene.shapes[glass].geometry.center());
    let into = edits(&[
        (subject.clone(), "material", material.clone()),
        (subject.clone(), "center", Value::Triple(to + 0.3 * (from - to))),
    ]);
    let why = into.applied_to(&scene).expect_err("they overlap").to_string();
    assert!(why.contains("would overlap other glass"), "{why}");
    assert!(edits(&[(subject, "material", material)]).applied_to(&scene).is_ok());
}

#[test]
fn what_is_left_out_is_gone_and_others_keep_their_names() {
    let scene = scene("cornell");
    let gone = Subject::Shape(scene.shape_name(1).into_owned());
    let third = scene.shape_name(2).into_owned();
    let without = edits(&[(gone.clone(), "hidden", Value::Flag(true))]).applied_to(&scene).expect("it can be");
    assert_eq!(without.shapes.len() + 1, scene.shapes.len());
    assert_eq!(gone.index_in(&without), None);
    assert_eq!(without.shape_name(1), third);
    assert_eq!(without.shapes[1], scene.shapes[2]);
}

#[test]
fn a_part_that_is_not_there_is_named() {
    let lost = edits(&[(Subject::Material("velvet".into()), "colour", Value::Triple(Vec3::ONE))]);
    let why = lost.applied_to(&scene("cornell")).expect_err("no velvet").to_string();
    assert!(why.starts_with("cornell has no material 'velvet'"), "{why}");
}

#[test]
fn another_kind_of_material_keeps_colour_and_roughness() {
    let scene = scene("cornell");
    let name = scene.materials[scene.shapes[0].material].name.clone();
    let index = scene.shapes[0].material;
    let colour = (Subject::Material(String::new()).property("colour").expect("a row").get)(&scene, index);
    let subject = Subject::Material(name);
    let turned = |lobe: &str| {
        edits(&[(subject.clone(), "lobe", Value::Word(lobe.into()))]).applied_to(&scene).expect("it can be")
    };
    let colour_in = |scene: &Scene| (subject.property("colour").expect("a row").get)(scene, index);
    for lobe in ["mirror", "rough_conductor", "metallic_roughness"] {
        assert_eq!(colour_in(&turned(lobe)), colour, "{lobe}");
    }
    assert_eq!(colour_in(&turned("dielectric")), None);
}

#[test]
fn the_sun_comes_from_where_its_angles_say_and_the_fakes_light_with_it() {
    let scene = scene("whitted");
    let aimed =
        edits(&[(Subject::Sun, "elevation", Value::Number(30.0)), (Subject::Sun, "azimuth", Value::Number(90.0))]);
    let aimed = aimed.applied_to(&scene).expect("it can be");
    let towards = aimed.sun.expect("a sun").towards;
    assert!((towards - Vec3::new(0.75f32.sqrt(), 0.5, 0.0)).length() < 1e-6, "{towards}");
    if let Some(place) = aimed.fake.light_position {
        assert!((place.normalize() - towards).length() < 1e-6);
    }
}

/// The product of the two would take hours.
#[test]
fn many_changes_of_a_scene_with_many_shapes_take_the_time_of_their_sum() {
    let mut scene = scene("whitted");
    let many = 1 << 20;
    let ball = scene.shapes[1].clone();
    scene.shapes = vec![ball; many].into();
    scene.names = crate::Names::new((0..many).map(|number| format!("ball {number}")).collect(), Vec::new()).into();
    for material in &mut scene.materials {
        material.bsdf = Bsdf::Diffuse { albedo: crate::Texture::Constant(Vec3::ONE) };
    }
    let subject = |number: usize| Subject::Shape(format!("ball {number}"));
    let moved = (0..many).step_by(8).map(|number| (subject(number), "center", Value::Triple(Vec3::ZERO)));
    let hidden = (1..many).step_by(8).map(|number| (subject(number), "hidden", Value::Flag(true)));
    let changed = edits(&moved.chain(hidden).collect::<Vec<_>>()).applied_to(&scene).expect("it can be");
    assert_eq!(changed.shapes.len(), many - many / 8);
    assert!(changed.shapes[7].geometry.center().length() < 1e-6);
    assert_eq!((changed.shape_name(7), changed.shape_name(8)), ("ball 8".into(), "ball 10".into()));
}
