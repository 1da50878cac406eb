//! What materials send on and send out.

use crate::gltf::*;
use scene::Vec3;
use serde_json::json;
use std::f32::consts::{FRAC_1_PI, FRAC_1_SQRT_2, PI};

/// Metallic-roughness by appendix B, of which light of irradiance pi comes from `l`: the radiance towards `v`.
fn metallic_roughness(n: Vec3, l: Vec3, v: Vec3, colour: Vec3, metallic: f32, roughness: f32) -> Vec3 {
    let h = (l + v).normalize();
    let square = roughness.powi(4);
    let distribution = square * FRAC_1_PI / (n.dot(h).powi(2) * (square - 1.0) + 1.0).powi(2);
    let [n_l, n_v] = [n.dot(l), n.dot(v)];
    let lambda = |a: f32, b: f32| a * (b * b * (1.0 - square) + square).sqrt();
    let lobe = distribution * 0.5 / (lambda(n_l, n_v) + lambda(n_v, n_l));
    let grazing = (1.0 - v.dot(h)).powi(5);
    let coat = 0.04 + 0.96 * grazing;
    let dielectric = (1.0 - coat) * colour * FRAC_1_PI + Vec3::splat(coat * lobe);
    let metal = lobe * (colour + (Vec3::ONE - colour) * grazing);
    PI * n_l * dielectric.lerp(metal, metallic)
}

/// Whitted's method has no rough lobes: it leaves rough coats out, and metal mirrors, here the dark.
#[test]
fn roughness_is_green_and_metal_is_blue_and_the_lobes_are_those_of_the_appendix() {
    let sun = Vec3::new(0.3, 0.2, 1.0).normalize();
    let mut model = Model::under_a_sun(sun);
    let texels = [[9, 255, 0, 255], [90, 128, 0, 255], [0, 200, 255, 255], [255, 150, 128, 255]];
    let texture = model.texture(2, &texels, nearest());
    let square = model.square(json!({"pbrMetallicRoughness": {
        "baseColorFactor": [0.75, 0.5, 0.25, 1], "metallicRoughnessTexture": {"index": texture}, "roughnessFactor": 0.9,
    }}));
    model.show(square, json!({}));
    let paint = Vec3::new(0.75, 0.5, 0.25);
    let numbers = |place: [f32; 2]| texels[quarter(place)].map(|code| f32::from(code) / 255.0);
    let by_appendix = |place: [f32; 2]| {
        let [_, rough, metal, _] = numbers(place);
        let v = Vec3::new(-place[0], -place[1], 20.0).normalize();
        metallic_roughness(Vec3::Z, sun, v, paint, metal, 0.9 * rough)
    };
    model.shows_in(&[Technique::Fake, Technique::Path], by_appendix, &QUARTERS);
    let by_whitted = |place: [f32; 2]| paint * (1.0 - numbers(place)[2]) * sun.z;
    model.shows_in(&[Technique::Whitted], by_whitted, &QUARTERS);
}

#[test]
fn what_is_emitted_is_factor_times_texels_times_strength() {
    let mut model = Model::dark();
    let texels = [RED, GREEN, [188, 188, 0, 255], [90, 90, 255, 255]];
    let texture = model.texture(2, &texels, nearest());
    let square = model.square(shining(4.0, json!({"emissiveTexture": {"index": texture}})));
    model.show(square, json!({}));
    model.shows(in_quarters(texels.map(|texel| SHINES * colour(texel))), &QUARTERS);
}

#[test]
fn one_sided_materials_shine_in_front_alone_and_all_scatter_on_both_sides() {
    let around = json!({"rotation": [0, 1, 0, 0]});
    for (two_sided, seen) in [(false, Vec3::ZERO), (true, SHINES)] {
        let mut model = Model::dark();
        let square = model.square(shining(4.0, json!({"doubleSided": two_sided})));
        model.show(square, around.clone());
        model.shows(|_| seen, &QUARTERS);
        let mut model = Model::under_a_sun(Vec3::Z);
        let square = model.square(matt([0.5; 3], json!({"doubleSided": two_sided})));
        model.show(square, around.clone());
        model.shows(|_| Vec3::splat(0.5), &QUARTERS);
    }
}

/// The left half of a square before a floor is missing: the floor is seen there, in the shadow of the right half, and no
/// shadow lies to the left of that.
#[test]
fn masks_are_seen_and_shone_through_where_alpha_is_below_the_cutoff() {
    let mut model = Model::under_a_sun(Vec3::new(1.0, 0.0, 1.0));
    // times .8: .31 and .63
    let texture = model.texture(2, &[[255, 255, 255, 100], [255, 255, 255, 200]], nearest());
    let mut material = textured(texture);
    material["alphaMode"] = json!("MASK");
    material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.25, 0.5, 0.75, 0.8]);
    let mut kept = model.clone();
    let square = model.square(material.clone());
    let node = json!({"translation": [0, 0, 0.5], "scale": [0.5, 0.5, 1]});
    model.show(square, node.clone());
    let floor = model.square(matt([0.8; 3], json!({})));
    model.show(floor, json!({"scale": [2, 2, 1]}));
    let expected = |[x, y]: [f32; 2]| {
        let (on, shadow) = (x > 0.0 && x < 0.5, x > -0.5 && x < 0.0);
        let paper = match (on && y.abs() < 0.5, shadow && y.abs() < 0.5) {
            (true, _) => Vec3::new(0.25, 0.5, 0.75),
            (false, true) => Vec3::ZERO,
            (false, false) => Vec3::splat(0.8),
        };
        paper * FRAC_1_SQRT_2
    };
    let places = [[-0.75, 0.0], [-0.25, 0.0], [0.25, 0.0], [0.75, 0.0], [0.25, 0.75], [-0.25, -0.75]];
    // paths find what floor and square send each other
    model.shows_in(&[Technique::Fake, Technique::Whitted], expected, &places);
    model.shows_in(&[Technique::Path], expected, &[places[2]]);
    let mut alone = kept.clone();
    let square = alone.square(material.clone());
    alone.show(square, node.clone());
    let alone_seen = |at: [f32; 2]| if at[0] > 0.0 { expected(at) } else { Vec3::ZERO };
    alone.shows(alone_seen, &[places[1], places[2]]);
    // below the least alpha there is nothing to cut
    material["alphaCutoff"] = json!(0.3);
    let square = kept.square(material);
    kept.show(square, node);
    kept.shows(|_| Vec3::new(0.25, 0.5, 0.75) * FRAC_1_SQRT_2, &[places[1], places[2]]);
}

/// A slab before a lamp: of all its light `(1 - R) / (1 + R)` comes through, R by Fresnel at normal incidence, and what is
/// reflected inside counts. The fake looks at what is behind and loses nothing.
#[test]
fn clear_glass_lets_through_what_fresnel_leaves() {
    let mut model = Model::dark();
    let corners: Vec<[f32; 3]> =
        (0..8).map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -1.0 } else { 1.0 })).collect();
    let sides: [[u16; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices: Vec<u16> = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    let [positions, indices] = [model.vectors(&corners), model.indices(&indices)];
    let glass = model.push(
        "materials",
        json!({
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
            "extensions": {
                "KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 2},
                "KHR_materials_volume": {"thicknessFactor": 1},
            },
        }),
    );
    let slab = json!({"attributes": {"POSITION": positions}, "indices": indices, "material": glass});
    model.show(slab, json!({"translation": [0, 0, 1], "scale": [3, 3, 0.25]}));
    let lamp = model.square(shining(4.0, json!({})));
    model.show(lamp, json!({"translation": [0, 0, -1], "scale": [3, 3, 1]}));
    let reflected = (1.0f32 / 3.0).powi(2);
    let through = SHINES * (1.0 - reflected) / (1.0 + reflected);
    model.shows_in(&[Technique::Whitted, Technique::Path], |_| through, &QUARTERS);
    model.shows_in(&[Technique::Fake], |_| SHINES, &[MIDDLE]);
}

#[test]
fn unlit_materials_look_as_their_colour_under_any_light() {
    let mut model = Model::under_a_sun(Vec3::new(1.0, 0.0, 1.0));
    let texels = [RED, GREEN, BLUE, GREY];
    let texture = model.texture(2, &texels, nearest());
    let mut material = textured(texture);
    material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 0.25, 0.75, 1]);
    material["extensions"] = json!({"KHR_materials_unlit": {}});
    let square = model.square(material);
    model.show(square, json!({}));
    model.shows(in_quarters(texels.map(|texel| Vec3::new(0.5, 0.25, 0.75) * colour(texel))), &QUARTERS);
    model.says("unlit materials shine");
}

/// One square is plain as usual and wears a picture in a variant, the other has no material for it.
#[test]
fn variants_wear_the_materials_of_their_mappings_and_else_the_usual_ones() {
    let mut model = Model::under_a_sun(Vec3::Z);
    let texels = [RED, GREEN, BLUE, GREY];
    let texture = model.texture(2, &texels, nearest());
    let pictured = model.push("materials", textured(texture));
    let lamp = model.push("materials", shining(4.0, json!({})));
    let mut upper = model.square(matt([0.5; 3], json!({})));
    upper["extensions"] = json!({"KHR_materials_variants": {"mappings": [
        {"variants": [0], "material": pictured}, {"variants": [1, 2], "material": lamp},
    ]}});
    let lower = model.square(matt([0.25; 3], json!({})));
    model.json["extensions"]["KHR_materials_variants"] =
        json!({"variants": [{"name": "picture"}, {"name": "lamp"}, {"name": "lamp"}]});
    model.show(upper, json!({"translation": [0, 0, 0.1], "scale": [1, 0.5, 1]}));
    model.show(lower, json!({}));
    let places = [[-0.5, 0.25], [0.5, 0.25], [-0.5, -0.25], [0.5, -0.25], [0.5, 0.8], [0.5, -0.8]];
    let below = Vec3::splat(0.25);
    let over = |upper: [Vec3; 4]| move |[x, y]: [f32; 2]| if y.abs() < 0.5 { upper[quarter([x, y])] } else { below };
    model.shows(over([Vec3::splat(0.5); 4]), &places);
    model.shows_as("picture", over(texels.map(colour)), &places);
    // a lamp lights what is around it
    let on_the_lamp = &places[..4];
    model.shows_as("lamp", over([SHINES; 4]), on_the_lamp);
    model.shows_as("lamp 2", over([SHINES; 4]), on_the_lamp);
}
