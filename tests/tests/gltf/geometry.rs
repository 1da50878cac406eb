//! Nodes, cameras and what primitives are made of.

use crate::gltf::*;
use scene::Vec3;
use scene::glam::{Quat, Vec2};
use serde_json::{Value, json};
use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

#[test]
fn nodes_stand_where_the_matrices_above_them_place_them() {
    let half = FRAC_1_SQRT_2;
    // the child, 1.2 wide and .2 high, lies .5 to the right in its parent, which turns by a quarter about z and then moves:
    // an upright bar about (.25, .25)
    let child = json!({"translation": [0.5, 0, 0], "scale": [0.6, 0.1, 1]});
    let parents = [
        json!({"rotation": [0, 0, half, half], "translation": [0.25, -0.25, 0]}),
        json!({"matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.25, -0.25, 0, 1]}),
    ];
    for parent in parents {
        let mut model = Model::under_a_sun(Vec3::Z);
        let square = model.square(matt([0.5, 0.25, 1.0], json!({})));
        model.show(square, child.clone());
        let child = model.json["nodes"].as_array().unwrap().len() - 1;
        let mut parent = parent;
        parent["children"] = json!([child]);
        model.push("nodes", parent);
        let expected = |[x, y]: [f32; 2]| {
            let inside = (x - 0.25).abs() < 0.1 && (y - 0.25).abs() < 0.6;
            if inside { Vec3::new(0.5, 0.25, 1.0) } else { Vec3::ZERO }
        };
        model.shows(expected, &[[0.25, 0.25], [0.25, 0.75], [0.25, -0.25], [0.5, 0.25], [0.25, 0.95], [0.05, 0.25]]);
    }
}

#[test]
fn what_is_mirrored_keeps_its_front_and_a_back_does_not_shine() {
    let seen = |node: Value| {
        let mut model = Model::dark();
        let square = model.square(shining(4.0, json!({})));
        model.show(square, node);
        model
    };
    seen(json!({"scale": [-1, 1, 1]})).shows(|_| SHINES, &QUARTERS);
    seen(json!({"scale": [-1, -1, 1]})).shows(|_| SHINES, &QUARTERS);
    // mirrored along z, its corners stay where they are and its front faces away
    seen(json!({"scale": [1, 1, -1]})).shows(|_| Vec3::ZERO, &QUARTERS);
    seen(json!({"rotation": [0, 1, 0, 0]})).shows(|_| Vec3::ZERO, &QUARTERS);
}

#[test]
fn a_mesh_that_several_nodes_share_is_seen_at_each_of_them() {
    let mut model = Model::under_a_sun(Vec3::Z);
    let texture = model.texture(2, &[RED, GREEN], nearest());
    let square = model.square(textured(texture));
    let mesh = model.mesh(square);
    for (x, width) in [(-0.6, 0.2), (0.0, -0.2), (0.6, 0.2)] {
        model.push("nodes", json!({"mesh": mesh, "translation": [x, 0, 0], "scale": [width, 0.5, 1]}));
    }
    let expected = |[x, y]: [f32; 2]| {
        let place = [-0.6, 0.0, 0.6].iter().position(|middle| (x - middle).abs() < 0.2 && y.abs() < 0.5);
        let right = |middle: usize| x > [-0.6, 0.0, 0.6][middle];
        match place {
            None => Vec3::ZERO,
            Some(i) => colour(if right(i) == (i != 1) { GREEN } else { RED }),
        }
    };
    let places = [-0.7, -0.5, -0.3, -0.1, 0.1, 0.3, 0.5, 0.7].map(|x| [x, 0.3]);
    model.shows(expected, &places);
    model.shows(expected, &[[0.0, 0.7], [0.6, -0.7]]);
}

#[test]
fn cameras_look_along_their_minus_z_with_their_own_field_of_view() {
    let mut model = Model::under_a_sun(Vec3::X);
    let turn = Quat::from_rotation_y(FRAC_PI_2) * Quat::from_rotation_z(0.5);
    let (eye, yfov) = (Vec3::new(3.0, 0.5, -0.25), 1.0f32);
    model.json["cameras"][0]["perspective"]["yfov"] = json!(yfov);
    model.json["nodes"][0] = json!({"camera": 0, "translation": eye.to_array(), "rotation": turn.to_array()});
    let square = model.square(matt([0.25, 0.5, 0.75], json!({})));
    let small = Vec3::new(0.0, 1.0, 0.5);
    let faces_x = turned(Vec3::Z, Vec3::X);
    model.show(square, json!({"translation": small.to_array(), "rotation": faces_x, "scale": [0.25, 0.25, 1]}));
    // where the picture's place (x, y) lies in the plane x = 0
    let in_plane = move |[x, y]: [f32; 2]| {
        let tangent = (0.5 * yfov).tan();
        let ray = turn * Vec3::new(x * tangent, y * tangent, -1.0);
        eye - ray * (eye.x / ray.x)
    };
    let seen = |place: [f32; 2]| {
        let off = (in_plane(place) - small).abs();
        if off.max_element() < 0.25 { Vec3::new(0.25, 0.5, 0.75) } else { Vec3::ZERO }
    };
    let of = |point: Vec3| {
        let local = turn.inverse() * (point - eye);
        (Vec2::new(local.x, local.y) / (-local.z * (0.5 * yfov).tan())).to_array()
    };
    let around = |reach: f32| {
        [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]].map(|[y, z]| of(small + reach * Vec3::new(0.0, y, z)))
    };
    model.shows(seen, &around(0.12));
    model.shows(seen, &around(0.4));
}

#[test]
fn strips_and_fans_are_the_triangles_of_lists_with_their_fronts() {
    let corners = [[-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0]];
    for (mode, order) in [(4, &[0u16, 1, 2, 0, 2, 3][..]), (5, &[0, 1, 3, 2]), (6, &[0, 1, 2, 3])] {
        let mut model = Model::dark();
        let positions = model.vectors(&corners);
        let indices = model.indices(order);
        let material = model.push("materials", shining(4.0, json!({})));
        let primitive = json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": mode});
        let mut primitive = primitive;
        primitive["material"] = json!(material);
        model.show(primitive, json!({}));
        model.shows(|_| SHINES, &QUARTERS);
    }
}

#[test]
fn whole_numbers_as_positions_normals_and_texture_coordinates_are_what_they_stand_for() {
    let mut model = Model::under_a_sun(Vec3::Z);
    let texture = model.texture(2, &[RED, GREEN, BLUE, GREY], nearest());
    let mut square = model.square(textured(texture));
    let shorts = |numbers: &[i16]| numbers.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<u8>>();
    let (most, least) = (32767, -32767);
    // three numbers and a hole, as views of vertices must be aligned
    let corners = [least, most, 0, 0, least, least, 0, 0, most, least, 0, 0, most, most, 0, 0];
    let positions = json!({"componentType": 5122, "normalized": true, "type": "VEC3", "count": 4});
    let positions = model.accessor(positions, &shorts(&corners));
    model.json["bufferViews"].as_array_mut().unwrap().last_mut().unwrap()["byteStride"] = json!(8);
    let normals = json!({"componentType": 5120, "normalized": true, "type": "VEC3", "count": 4});
    let (cos, sin) = (102, 76); // of 127: 4/5 and 3/5 but for rounding
    let normals = model.accessor(normals, &[0, sin, cos, 0].repeat(4));
    model.json["bufferViews"].as_array_mut().unwrap().last_mut().unwrap()["byteStride"] = json!(4);
    let uvs = json!({"componentType": 5121, "normalized": true, "type": "VEC2", "count": 4});
    let uvs = model.accessor(uvs, &[0, 0, 0, 0, 0, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0]);
    model.json["bufferViews"].as_array_mut().unwrap().last_mut().unwrap()["byteStride"] = json!(4);
    square["attributes"] = json!({"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs});
    model.show(square, json!({}));
    model.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let cosine = f32::from(cos) / f32::from(cos).hypot(f32::from(sin));
    model.shows(in_quarters([RED, GREEN, BLUE, GREY].map(|texel| colour(texel) * cosine)), &QUARTERS);
}

#[test]
fn sparse_elements_stand_in_for_those_below() {
    let mut model = Model::under_a_sun(Vec3::Z);
    let square = model.square(matt([0.5; 3], json!({})));
    let positions = square["attributes"]["POSITION"].as_u64().unwrap() as usize;
    // the two upper corners move down to the middle
    let indices = model.view(&[0, 3]);
    let values = model.view(&bytes_of(&[-1.0, 0.0, 0.0, 1.0, 0.0, 0.0]));
    model.json["accessors"][positions]["sparse"] = json!({
        "count": 2, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values},
    });
    model.show(square, json!({}));
    let half = Vec3::splat(0.5);
    model.shows(in_quarters([Vec3::ZERO, Vec3::ZERO, half, half]), &QUARTERS);
}

/// 4,608 triangles: a mesh with a tree of its own, that is never taken apart.
fn large(model: &mut Model, material: Value) -> Value {
    const SIDE: u16 = 48;
    let places: Vec<[f32; 2]> = (0..=SIDE)
        .flat_map(|row| (0..=SIDE).map(move |column| [column, row].map(|i| f32::from(i) / f32::from(SIDE))))
        .collect();
    let points: Vec<[f32; 3]> = places.iter().map(|[u, v]| [2.0 * u - 1.0, 1.0 - 2.0 * v, 0.0]).collect();
    let cell = |row: u16, column: u16| {
        let a = row * (SIDE + 1) + column;
        let below = a + SIDE + 1;
        [a, below, below + 1, a, below + 1, a + 1]
    };
    let indices: Vec<u16> = (0..SIDE).flat_map(|row| (0..SIDE).flat_map(move |column| cell(row, column))).collect();
    let [positions, uvs] = [model.vectors(&points), model.vectors(&places)];
    let (indices, material) = (model.indices(&indices), model.push("materials", material));
    json!({
        "attributes": {"POSITION": positions, "TEXCOORD_0": uvs}, "indices": indices, "material": material,
    })
}

#[test]
fn a_large_mesh_is_seen_at_both_its_nodes_and_throws_both_shadows() {
    let mut model = Model::under_a_sun(Vec3::new(0.0, 1.0, 1.0));
    let texture = model.texture(2, &[RED, GREEN, BLUE, GREY], nearest());
    let large = large(&mut model, textured(texture));
    let mesh = model.mesh(large);
    for (x, width) in [(-0.5, 0.4), (0.5, -0.4)] {
        let node = json!({"mesh": mesh, "translation": [x, 0, 0], "scale": [width, 0.4, 0.4]});
        model.push("nodes", node);
    }
    let floor = model.square(matt([0.8; 3], json!({})));
    model.show(floor, json!({"translation": [0, 0, -0.5], "scale": [2, 2, 1]}));
    let expected = |[x, y]: [f32; 2]| {
        let (across, mirrored) = (x.abs() - 0.5, x > 0.0);
        let column = usize::from((x - 0.5f32.copysign(x) > 0.0) != mirrored);
        let on = across.abs() < 0.4 && y.abs() < 0.4;
        let shadow = across.abs() < 0.4 && (y + 0.5).abs() < 0.4;
        let paper = match (on, shadow) {
            (true, _) => colour([RED, GREEN, BLUE, GREY][column + 2 * usize::from(y < 0.0)]),
            (false, true) => Vec3::ZERO,
            (false, false) => Vec3::splat(0.8),
        };
        paper * FRAC_1_SQRT_2
    };
    let places = [-0.7, -0.3, 0.3, 0.7].map(|x| [[x, 0.2], [x, -0.2], [x, -0.65], [x, 0.7]]);
    let places = [places.as_flattened(), &[[0.0, 0.0], [0.0, -0.6]]].concat();
    // light between them and the floor is more than zero along paths
    model.shows_in(&[Technique::Fake, Technique::Whitted], expected, &places);
    let on_them: Vec<[f32; 2]> = places.iter().copied().filter(|[x, y]| x.abs() > 0.1 && y.abs() < 0.4).collect();
    model.shows_in(&[Technique::Path], expected, &on_them);
    model.shows_on_devices(expected, &on_them);
}
