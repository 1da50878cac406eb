//! Nodes, instances, cameras and lights.

use super::*;
use crate::Spot;

fn far_apart(a: Vec3, b: Vec3) -> bool {
    (a - b).length() > 1e-5
}

#[test]
fn places_of_nodes_multiply_from_the_root_down_however_they_are_written() {
    let mut model = Model::triangle();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // a quarter about z, then twice as large and moved: (1, 0, 0) -> (0, 1, 0) -> (0, 2, 0) -> (1, 2, 3)
    model.json["nodes"] = json!([
        {"mesh": 0, "rotation": [0, 0, half, half]},
        {"children": [0], "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 3, 1]},
    ]);
    let scene = model.scene();
    assert!(!far_apart(mesh_of(&scene, 0).positions()[1], Vec3::new(1.0, 2.0, 3.0)));
    assert!(matches!(scene.shapes[0].geometry, Geometry::Mesh(_)), "small, and shown once");
}

#[test]
fn a_mesh_that_is_shown_twice_is_one_mesh() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{"mesh": 0, "translation": [1, 0, 0]}, {"mesh": 0, "scale": [-1, 1, 1]}]);
    let scene = model.scene();
    let [Geometry::Instance(a), Geometry::Instance(b)] = [0, 1].map(|i| scene.shapes[i].geometry.clone()) else {
        panic!("instances")
    };
    assert!(Arc::ptr_eq(&a.mesh, &b.mesh));
    assert_eq!((a.mirrors(), b.mirrors()), (false, true));
    assert_eq!([a, b].map(|instance| outwards(&instance.baked())), [Vec3::Z; 2]);
}

#[test]
fn a_large_mesh_is_never_taken_apart() {
    let mut model = Model::triangle();
    let indices = model.indices(&[0, 1, 2].repeat(Mesh::LARGE));
    model.primitive()["indices"] = json!(indices);
    assert!(matches!(model.scene().shapes[0].geometry, Geometry::Mesh(_)), "where it is at home");
    model.json["nodes"][0]["translation"] = json!([0, 1, 0]);
    assert!(matches!(model.scene().shapes[0].geometry, Geometry::Instance(_)));
}

#[test]
fn what_is_mirrored_keeps_its_outside_and_what_is_flat_is_seen() {
    let mut model = Model::triangle();
    let normals = model.vectors(&[[0.0, 0.6, 0.8]; 3]);
    model.primitive()["attributes"]["NORMAL"] = json!(normals);
    model.json["nodes"][0]["scale"] = json!([1, -1, 1]);
    let scene = model.scene();
    let mesh = mesh_of(&scene, 0);
    assert_eq!(mesh.positions()[2], -Vec3::Y);
    assert_eq!(outwards(mesh), Vec3::Z);
    assert!(!far_apart(mesh.normals()[0], Vec3::new(0.0, -0.6, 0.8)));
    model.json["nodes"][0]["scale"] = json!([1, 2, 0]);
    assert_eq!(mesh_of(&model.scene(), 0).positions(), [Vec3::ZERO, Vec3::X, Vec3::Y * 2.0]);
    model.remark("scaled to nothing");
}

#[test]
fn ten_thousand_nodes_one_below_the_other_are_walked() {
    let mut model = Model::triangle();
    let count = 10_000;
    let mut nodes: Vec<Value> =
        (1..count).map(|child| json!({"children": [child], "translation": [0, 0, 1]})).collect();
    nodes.push(json!({"mesh": 0}));
    model.json["nodes"] = json!(nodes);
    model.json["scenes"] = json!([{"nodes": [0]}]);
    assert_eq!(mesh_of(&model.scene(), 0).positions()[0], Vec3::Z * 9999.0);
}

#[test]
fn the_scene_that_the_file_names_is_shown() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}]);
    model.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [1]}]);
    model.json["scene"] = json!(1);
    assert_eq!(mesh_of(&model.scene(), 0).positions()[0], Vec3::X * 5.0);
    model.remark("further scenes");
}

#[test]
fn all_cameras_are_found_by_name_and_the_first_is_looked_through() {
    let mut model = Model::triangle();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    model.json["cameras"] = json!([
        {"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}},
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}},
    ]);
    model.json["nodes"] = json!([
        {"mesh": 0},
        {"camera": 0, "name": "front", "translation": [0, 0, 5]},
        {"camera": 1, "name": "flat"},
        {"camera": 0, "name": "front", "translation": [0, 5, 0], "rotation": [-half, 0, 0, half]},
    ]);
    let scene = model.scene();
    let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).collect();
    assert_eq!(names, ["front", "front 2"]);
    assert_eq!(scene.camera, scene.cameras[0].camera);
    assert_eq!((scene.camera.eye, scene.camera.up), (Vec3::Z * 5.0, Vec3::Y));
    // what one turns about is as far away as the model
    assert!(!far_apart(scene.camera.target, Vec3::ZERO), "{}", scene.camera.target);
    assert!((scene.camera.fov_y - 0.5f32.to_degrees()).abs() < 1e-4);
    // from an eye above and before, the camera's own up leans back; one turns about what is up in the world
    let above = scene.cameras[1].camera;
    assert!(!far_apart(above.up, Vec3::NEG_Z) && above.target.y < above.eye.y && above.fault().is_none());
    assert!(model.remark("orthographic").ends_with("node 2 'flat'"));
}

#[test]
fn a_camera_that_is_not_rolled_stands_upright() {
    let mut model = Model::triangle();
    model.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}]);
    let (sin, cos) = 0.25f64.sin_cos();
    let up = |turn: [f64; 4]| {
        let mut model = model.clone();
        model.json["nodes"].as_array_mut().unwrap().push(json!({"camera": 0, "rotation": turn}));
        model.scene().camera.up
    };
    assert_eq!(up([-sin, 0.0, 0.0, cos]), Vec3::Y, "it looks half a radian down");
    assert!(!far_apart(up([0.0, 0.0, sin, cos]), Vec3::new(-0.5f32.sin(), 0.5f32.cos(), 0.0)), "it is rolled");
}

#[test]
fn a_fitted_camera_sees_all_corners() {
    let mut model = Model::triangle();
    model.json["nodes"][0]["scale"] = json!([300, 0.01, 1]);
    model.json["nodes"][0]["translation"] = json!([1000, -5, 3]);
    let scene = model.scene();
    let frame = scene.camera.frame(1.0);
    for corner in mesh_of(&scene, 0).positions() {
        let seen = frame.project(*corner).unwrap();
        assert!(seen.cmpge(glam::Vec2::ZERO).all() && seen.cmple(glam::Vec2::ONE).all(), "{corner} at {seen}");
    }
}

fn lit(lights: Value, nodes: Value) -> Model {
    let mut model = Model::triangle();
    model.json["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
    let all = model.json["nodes"].as_array_mut().unwrap();
    all.extend(nodes.as_array().unwrap().iter().cloned());
    model
}

#[test]
fn points_and_spots_shine_from_their_node_along_its_minus_z() {
    let lights = json!([
        {"type": "point", "color": [1, 0.5, 0], "intensity": 8, "range": 3},
        {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.3}},
        {"type": "spot", "spot": {"innerConeAngle": 0.7, "outerConeAngle": 0.7}},
    ]);
    let light = |index| json!({"KHR_lights_punctual": {"light": index}});
    let nodes = json!([
        {"extensions": light(0), "translation": [1, 2, 3]},
        {"extensions": light(1), "rotation": [0, 1, 0, 0]},
        {"extensions": light(2)},
    ]);
    let model = lit(lights, nodes);
    let scene = model.scene();
    let [point, spot, sharp] = &scene.point_lights[..] else { panic!("three lights") };
    assert_eq!(
        (point.position, point.intensity, point.spot),
        (Vec3::new(1.0, 2.0, 3.0), Vec3::new(8.0, 4.0, 0.0), None)
    );
    let Some(Spot { towards, inner, outer }) = spot.spot else { panic!("a spot") };
    assert!(!far_apart(towards, Vec3::Z) && !far_apart(spot.intensity, Vec3::ONE));
    assert!((inner - 0.1f32.to_degrees()).abs() < 1e-4 && (outer - 0.3f32.to_degrees()).abs() < 1e-4);
    assert!(sharp.spot.is_some_and(|spot| spot.inner < spot.outer));
    assert_eq!((scene.sky, scene.sun), (Vec3::ZERO, None));
    model.remark("range");
}

#[test]
fn the_brightest_directional_light_is_the_sun() {
    let sun = |intensity| json!({"type": "directional", "intensity": intensity});
    let nodes = json!(
        [0, 1, 2].map(|light| json!({"extensions": {"KHR_lights_punctual": {"light": light}}, "scale": [1, 1, 2]}))
    );
    let model = lit(json!([sun(1), sun(3), sun(2)]), nodes);
    let sun = model.scene().sun.unwrap();
    assert_eq!((sun.towards, sun.angular_radius, sun.irradiance), (Vec3::Z, 0.0, Vec3::splat(3.0)));
    model.remark("only the brightest");
}

#[test]
fn lights_of_thousands_of_candela_are_told_with_the_exposure_that_bears_them() {
    let shine = |intensity: f32| {
        let light = json!({"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0.5, 0.5, 10]});
        lit(json!([{"type": "point", "intensity": intensity}]), json!([light]))
    };
    // 1000 W by Blender's rule; paper has 54351 / 100 / pi, which is 2^7.4
    assert!(shine(54_351.0).remark("white").ends_with("lower the exposure: about -7 stops"));
    assert!(shine(1000.0).scene().remarks.is_empty());
}

#[test]
fn a_lamp_lights_a_model_and_a_decoration_does_not() {
    let glows = |strength: f32| {
        let extensions = json!({"KHR_materials_emissive_strength": {"emissiveStrength": strength}});
        Model::textured(json!({"emissiveFactor": [0.5, 1, 0], "extensions": extensions})).scene().sky
    };
    assert_eq!((glows(1.0), glows(4.0)), (Vec3::splat(0.8), Vec3::ZERO));
}
