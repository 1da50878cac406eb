//! Primitives: what accessors say and what becomes of it.

use super::*;
use glam::Vec2;

#[test]
fn every_kind_of_list_gives_the_triangles_of_its_specification() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    for (mode, expected) in [(4, vec![[0, 1, 2]]), (5, vec![[0, 1, 2], [1, 3, 2]]), (6, vec![[1, 2, 0], [2, 3, 0]])] {
        let mut model = Model::triangle();
        let positions = model.vectors(&corners);
        *model.primitive() = json!({"attributes": {"POSITION": positions}, "mode": mode});
        assert_eq!(mesh_of(&model.scene(), 0).triangles(), expected, "mode {mode}");
    }
    for mode in [0, 1, 2, 3] {
        let mut model = Model::triangle();
        model.primitive()["mode"] = json!(mode);
        assert!(model.scene().shapes.is_empty());
        assert_eq!(model.remark("not drawn"), "points, lines and what has no positions are not drawn: mesh 0");
    }
}

#[test]
fn indices_of_one_two_and_four_bytes_are_read() {
    for (component, bytes) in
        [(5121, vec![2, 0, 1]), (5123, vec![2, 0, 0, 0, 1, 0]), (5125, vec![2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0])]
    {
        let mut model = Model::triangle();
        let indices = model.accessor("SCALAR", component, &bytes, 3);
        model.primitive()["indices"] = json!(indices);
        assert_eq!(mesh_of(&model.scene(), 0).triangles(), [[2, 0, 1]]);
    }
}

#[test]
fn elements_lie_as_far_apart_as_their_view_says() {
    let mut model = Model::triangle();
    // a position and a normal, one after the other
    let bytes = floats(&[0., 0., 0., 0., 0., 2., 1., 0., 0., 0., 0., 3., 0., 1., 0., 0., 0., 4.]);
    let view = model.view(&bytes);
    model.json["bufferViews"][view]["byteStride"] = json!(24);
    let accessor =
        |offset| json!({"bufferView": view, "byteOffset": offset, "componentType": 5126, "type": "VEC3", "count": 3});
    let [positions, normals] = [0, 12].map(|offset| model.push("accessors", accessor(offset)));
    model.primitive()["attributes"] = json!({"POSITION": positions, "NORMAL": normals});
    let scene = model.scene();
    assert_eq!(mesh_of(&scene, 0).positions(), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh_of(&scene, 0).normals(), [Vec3::Z; 3], "of length 1");
}

#[test]
fn whole_numbers_are_shares_where_they_are_normalised_and_themselves_elsewhere() {
    let mut model = Model::textured(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    let positions = model.accessor("VEC3", 5122, &[0, 0, 0, 0, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0, 255, 255, 0, 0], 3);
    let normals = model.accessor("VEC3", 5120, &[0, 0, 127, 0, 0, 127, 0, 129, 0], 3);
    let uvs = model.accessor("VEC2", 5121, &[0, 255, 51, 0, 102, 204], 3);
    model.json["accessors"][normals]["normalized"] = json!(true);
    model.json["accessors"][uvs]["normalized"] = json!(true);
    model.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    model.primitive()["attributes"] = json!({"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs});
    let scene = model.scene();
    let mesh = mesh_of(&scene, 0);
    assert_eq!(mesh.positions(), [Vec3::ZERO, Vec3::X * 5.0, -Vec3::Y]);
    assert_eq!(mesh.normals(), [Vec3::Z, Vec3::Z, -Vec3::Y]);
    assert_eq!(mesh.uvs(), [Vec2::new(0.0, 1.0), Vec2::new(0.2, 0.0), Vec2::new(0.4, 0.8)]);
}

#[test]
fn sparse_elements_stand_in_for_those_of_the_view_or_for_zeros() {
    for with_view in [true, false] {
        let mut model = Model::triangle();
        let (indices, values) = (model.view(&[1, 2]), model.view(&floats(&[7., 0., 0., 0., 8., 0.])));
        let sparse = json!({"count": 2, "indices": {"bufferView": indices, "componentType": 5121},
            "values": {"bufferView": values}});
        model.json["accessors"][0]["sparse"] = sparse;
        if !with_view {
            model.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        }
        assert_eq!(mesh_of(&model.scene(), 0).positions(), [Vec3::ZERO, Vec3::X * 7.0, Vec3::Y * 8.0]);
    }
}

#[test]
fn normals_of_no_length_are_those_of_the_triangles_around() {
    let mut model = Model::triangle();
    let normals = model.vectors(&[[0.0, 0.0, 0.0], [0.0, 3.0, 4.0], [f32::NAN, 0.0, 0.0]]);
    model.primitive()["attributes"]["NORMAL"] = json!(normals);
    assert_eq!(mesh_of(&model.scene(), 0).normals(), [Vec3::Z, Vec3::new(0.0, 0.6, 0.8), Vec3::Z]);
}

#[test]
fn places_in_textures_are_kept_where_a_picture_asks_for_them_and_of_its_set() {
    let plain = json!({"pbrMetallicRoughness": {"roughnessFactor": 0.5}});
    assert!(mesh_of(&Model::textured(plain).scene(), 0).uvs().is_empty());
    let mut model = Model::textured(json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}}));
    let others = model.accessor("VEC2", 5126, &floats(&[0.5, 0.0, 0.5, 1.0, 0.5, 2.0]), 3);
    model.primitive()["attributes"]["TEXCOORD_1"] = json!(others);
    assert_eq!(mesh_of(&model.scene(), 0).uvs(), [0.0, 1.0, 2.0].map(|v| Vec2::new(0.5, v)));
}

#[test]
fn what_meshes_have_and_no_picture_shows_is_told() {
    let mut model = Model::triangle();
    model.primitive()["attributes"]["COLOR_0"] = json!(0);
    model.primitive()["targets"] = json!([{"POSITION": 0}]);
    model.json["animations"] = json!([{"channels": [], "samplers": []}]);
    model.json["nodes"][0]["skin"] = json!(0);
    model.json["extensionsUsed"] = json!(["KHR_materials_clearcoat", "KHR_materials_ior", "ACME_x"]);
    for part in ["COLOR_0", "morph targets", "animations", "skins"] {
        model.remark(part);
    }
    assert!(model.remark("not read").ends_with(": 'KHR_materials_clearcoat', 'ACME_x'"));
}
