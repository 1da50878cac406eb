//! What shapes and lights of a model are called.

use super::*;

fn shape_names(model: &Model) -> Vec<String> {
    model.scene().names.shapes.clone()
}

#[test]
fn shapes_are_called_by_the_nodes_from_the_root_to_them() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([
        {"name": "house", "children": [1, 2, 3]},
        {"name": "roof", "mesh": 0},
        {"mesh": 0},
        {"name": "a/b\n", "mesh": 0, "children": [4]},
        {"name": " ", "mesh": 0},
    ]);
    assert_eq!(shape_names(&model), ["house/roof", "house/node 2", "house/a_b\\n", "house/a_b\\n/node 4"]);
    model.json["meshes"][0]["name"] = json!("Gable");
    assert_eq!(shape_names(&model)[1], "house/Gable");
}

#[test]
fn primitives_of_one_mesh_are_told_apart_by_their_materials() {
    let mut model = Model::triangle();
    let primitives = model.json["meshes"][0]["primitives"].as_array_mut().unwrap();
    primitives.resize(4, primitives[0].clone());
    for (primitive, material) in primitives.iter_mut().zip([0, 1, 1]) {
        primitive["material"] = json!(material);
    }
    model.json["materials"] = json!([{"name": "red/warm"}, {}]);
    model.json["nodes"] = json!([{"name": "roof", "mesh": 0}]);
    let expected = ["roof/red_warm", "roof/material 1", "roof/material 1 (2)", "roof/default"];
    assert_eq!(shape_names(&model), expected);
}

#[test]
fn shapes_and_lights_of_one_name_are_told_apart() {
    let mut model = Model::triangle();
    let lights = json!([{"type": "point"}, {"type": "point", "name": "bulb"}, {"type": "directional"}]);
    model.json["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
    let light = |light: u32| json!({"KHR_lights_punctual": {"light": light}});
    model.json["nodes"] = json!([
        {"name": "a", "mesh": 0, "extensions": light(2)},
        {"name": "a", "mesh": 0, "extensions": light(1)},
        {"name": "a", "mesh": 0, "extensions": light(1)},
        {"name": "lamp", "extensions": light(0)},
        {"extensions": light(0)},
    ]);
    let scene = model.scene();
    assert_eq!(scene.names.shapes, ["a", "a (2)", "a (3)"]);
    assert_eq!(scene.names.lights, ["bulb", "bulb (2)", "lamp", "light 4"]);
}

#[test]
fn names_are_cut_however_long_they_are_and_however_deep_their_nodes() {
    let mut model = Model::triangle();
    let deep = 20;
    let node = |index: usize| json!({"name": format!("{index}-{}", "é".repeat(200)), "children": [index + 1]});
    let mut nodes: Vec<Value> = (0..deep).map(node).collect();
    nodes.push(json!({"mesh": 0, "name": "leaf"}));
    model.json["nodes"] = json!(nodes);
    let name = shape_names(&model).remove(0);
    let levels: Vec<&str> = name.split('/').collect();
    assert_eq!((levels.len(), levels[7]), (8, "leaf"));
    assert!(levels[0].starts_with("13-é") && levels[0].ends_with("é..."), "{}", levels[0]);
    assert_eq!(levels[0].chars().count(), 83);
}

/// Sixty thousand shapes below eight levels of long names would take 160 MB of names.
#[test]
fn names_of_many_shapes_together_stay_below_their_bytes() {
    let mut model = Model::triangle();
    let node = |index: usize| json!({"name": "\u{1d11e}".repeat(80), "children": [index + 1]});
    let mut nodes: Vec<Value> = (0..7).map(node).collect();
    let shown = 60_000;
    nodes[6]["children"] = (8..8 + shown).chain([7]).collect::<Vec<_>>().into();
    nodes.extend((0..=shown).map(|_| json!({"mesh": 0})));
    model.json["nodes"] = json!(nodes);
    let names = shape_names(&model);
    let bytes: usize = names.iter().map(String::len).sum();
    assert!(bytes < (1 << 26) + (1 << 21), "{bytes}");
    assert!(names[0].ends_with("/node 8"), "{}", names[0]);
    assert_eq!(names[shown - 1], format!("node {}", shown + 7));
}
