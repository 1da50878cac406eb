//! Points, spots and suns of KHR_lights_punctual, against what its text says of their falling off.

use crate::gltf::*;
use scene::Vec3;
use serde_json::json;
use std::f32::consts::FRAC_1_PI;

const PAPER: Vec3 = Vec3::new(0.75, 0.5, 0.25);

fn paper(model: &mut Model) {
    let square = model.square(matt(PAPER.to_array(), json!({})));
    model.show(square, json!({}));
}

/// What a point of this intensity makes of the paper.
fn lit_by_a_point(intensity: Vec3, from: Vec3, [x, y]: [f32; 2]) -> Vec3 {
    let to = from - Vec3::new(x, y, 0.0);
    PAPER * FRAC_1_PI * intensity * to.normalize().z / to.length_squared()
}

const ALONG: [[f32; 2]; 6] = [[-0.9, 0.0], [-0.5, 0.3], [0.0, 0.0], [0.3, 0.2], [0.5, -0.6], [0.9, 0.9]];

#[test]
fn points_shine_by_the_inverse_square_of_the_distance() {
    let mut model = Model::dark();
    paper(&mut model);
    let from = Vec3::new(0.3, 0.2, 1.5);
    let light = json!({"type": "point", "intensity": 12, "color": [1, 0.5, 0.25]});
    model.light(light, json!({"translation": from.to_array()}));
    let expected = |place| lit_by_a_point(Vec3::new(12.0, 6.0, 3.0), from, place);
    model.shows(expected, &ALONG);
}

#[test]
fn spots_fall_off_between_their_cones() {
    let mut model = Model::dark();
    paper(&mut model);
    let (from, aimed) = (Vec3::new(0.3, 0.0, 2.0), Vec3::new(0.0, 0.2, 0.0));
    let axis = (aimed - from).normalize();
    let light = json!({"type": "spot", "intensity": 20, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}});
    model.light(light, json!({"translation": from.to_array(), "rotation": turned(Vec3::NEG_Z, axis)}));
    let expected = |place: [f32; 2]| {
        let cosine = (Vec3::new(place[0], place[1], 0.0) - from).normalize().dot(axis);
        let scale = 1.0 / (0.1f32.cos() - 0.4f32.cos());
        let share = (cosine * scale - 0.4f32.cos() * scale).clamp(0.0, 1.0);
        lit_by_a_point(Vec3::splat(20.0 * share * share), from, place)
    };
    model.shows(expected, &ALONG);
}

#[test]
fn directional_lights_shine_along_their_minus_z_and_do_not_decay() {
    let towards = Vec3::new(-0.5, 0.8, 1.0);
    let mut model = Model::dark();
    paper(&mut model);
    let light = json!({"type": "directional", "intensity": 2, "color": [1, 0.5, 0.25]});
    // neither place nor scale of the node matters
    let node = json!({"rotation": turned(Vec3::Z, towards), "translation": [0, 0, -9], "scale": [2, 2, 2]});
    model.light(light, node);
    let lux = Vec3::new(2.0, 1.0, 0.5);
    model.shows(|_| PAPER * FRAC_1_PI * lux * towards.normalize().z, &ALONG);
}
