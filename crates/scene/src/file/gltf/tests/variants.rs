//! Variants: what they wear, and what is refused of them.

use super::*;

const EXTENSION: &str = "KHR_materials_variants";

/// A triangle with three materials and two variants, which wears the second and third one there.
fn varied() -> Model {
    let mut model = Model::textured(json!({"name": "usual"}));
    model.json["materials"] = json!([{"name": "usual"}, {"name": "red"}, {"name": "blue"}]);
    model.json["extensions"] = json!({EXTENSION: {"variants": [{"name": "warm"}, {"name": "cold"}]}});
    model.map(json!([{"variants": [0], "material": 1}, {"variants": [1], "material": 2}]));
    model
}

impl Model {
    fn map(&mut self, mappings: Value) {
        self.primitive()["extensions"] = json!({EXTENSION: {"mappings": mappings}});
    }
}

/// What the shapes wear in a variant.
fn worn(model: &Model, variant: &str) -> Vec<String> {
    let mut scene = model.scene();
    scene.wear(variant).unwrap_or_else(|why| panic!("{why}"));
    scene.shapes.iter().map(|shape| scene.material_of(shape).name.clone()).collect()
}

#[test]
fn a_shape_wears_in_each_variant_what_its_primitive_says_at_every_node() {
    let mut model = varied();
    model.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]}]);
    assert_eq!(worn(&model, "warm"), ["red", "red"]);
    assert_eq!(worn(&model, "cold"), ["blue", "blue"]);
    let scene = model.scene();
    assert!(scene.shapes.iter().all(|shape| scene.material_of(shape).name == "usual"));
    assert!(!scene.remarks.iter().any(|line| line.contains("variant")), "{:?}", scene.remarks);
    let why = scene.clone().wear("hot").expect_err("no such variant");
    assert_eq!(why, "no variant of model is called 'hot': it has warm, cold");
}

#[test]
fn a_variant_without_a_mapping_leaves_the_usual_material_and_the_first_of_two_holds() {
    let mut model = varied();
    model.map(json!([{"variants": [1], "material": 1}, {"variants": [1], "material": 2}]));
    assert_eq!(worn(&model, "warm"), ["usual"]);
    assert_eq!(worn(&model, "cold"), ["red"]);
    model.primitive()["extensions"] = json!({EXTENSION: {}});
    assert_eq!(worn(&model, "cold"), ["usual"]);
}

#[test]
fn variants_of_one_name_or_of_none_are_told_apart() {
    let mut model = varied();
    model.json["extensions"][EXTENSION]["variants"] = json!([{"name": "a"}, {"name": "a"}, {}, {"name": "\n"}]);
    let scene = model.scene();
    let names: Vec<&str> = scene.variants.iter().map(|variant| variant.name.as_str()).collect();
    assert_eq!(names, ["a", "a 2", "variant 3", "\\n"]);
}

#[test]
fn indices_of_variants_and_of_their_materials_are_checked() {
    let mut model = varied();
    model.map(json!([{"variants": [0, 2], "material": 1}]));
    assert_eq!(model.fault(), "mesh 0, primitive 0: variant 2 is named, but there are 2");
    model.map(json!([{"variants": [0], "material": 3}]));
    assert_eq!(model.fault(), "mesh 0, primitive 0: material 3 is named, but there are 3");
    model.map(json!([{"variants": [0], "material": -1}]));
    assert!(model.fault().starts_with("its JSON: invalid value: integer `-1`, expected u32"), "{}", model.fault());
}

/// The file's usual look is shown whatever is wrong with another one.
#[test]
fn a_material_that_cannot_be_shown_leaves_its_variant_the_usual_one() {
    let mut model = varied();
    model.json["images"][0] = json!({"uri": "no-such-picture.png"});
    model.json["materials"][1]["normalTexture"] = json!({"index": 0});
    assert!(model.remark("variants").contains(": material 1 'red': image 0: "), "{}", model.remark("variants"));
    assert_eq!(worn(&model, "warm"), ["usual"]);
    assert_eq!(worn(&model, "cold"), ["blue"]);
    model.primitive()["material"] = json!(1);
    assert!(model.fault().contains("material 1 'red': image 0: "), "{}", model.fault());
}

#[test]
fn a_mesh_has_the_texture_coordinates_that_its_variants_ask_for() {
    let mut model = varied();
    assert_eq!(mesh_of(&model.scene(), 0).uvs().len(), 0);
    let first = model.primitive()["attributes"]["TEXCOORD_0"].clone();
    let second = model.accessor("VEC2", 5126, &floats(&[9.0; 6]), 3);
    model.primitive()["attributes"] = json!({"POSITION": 0, "TEXCOORD_0": first, "TEXCOORD_1": second});
    let pictured = |set: u32| json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": set}}});
    model.json["materials"][2] = pictured(1);
    assert_eq!(mesh_of(&model.scene(), 0).uvs()[0].x, 9.0);
    model.json["materials"][0] = pictured(0);
    assert_eq!(mesh_of(&model.scene(), 0).uvs()[1].x, 1.0);
    assert!(model.remark("other texture coordinates").ends_with("are placed by those: material 2"));
}

#[test]
fn a_model_whose_variants_alone_shine_is_lit_by_the_grey_sky() {
    let mut model = varied();
    let strong = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 9}});
    model.json["materials"][1] = json!({"emissiveFactor": [1, 1, 1], "extensions": strong});
    assert_eq!(model.scene().sky, Vec3::splat(0.8));
}

/// A thousand nodes that show a primitive of ten thousand mappings.
#[test]
fn variants_of_small_files_do_not_grow_beyond_memory() {
    let mut model = varied();
    model.json["nodes"] = json!(vec![json!({"mesh": 0}); 1000]);
    for mapping in [json!({"variants": [], "material": 1}), json!({"variants": [0], "material": 1})] {
        model.map(json!(vec![mapping; 10_000]));
        assert_eq!(model.fault(), "its nodes show more than 4194304 materials of variants");
    }
}
