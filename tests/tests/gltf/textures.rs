//! Pictures of base colours: codes, samplers and places.

use crate::gltf::*;
use scene::Vec3;
use scene::glam::Vec2;
use serde_json::json;

#[test]
fn base_colours_are_factors_times_texels_of_srgb_from_the_upper_left_down() {
    let mut model = Model::under_a_sun(Vec3::Z);
    let texels = [RED, GREEN, BLUE, GREY];
    let texture = model.texture(2, &texels, nearest());
    let mut material = textured(texture);
    material["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 0.25, 0.75, 1]);
    let square = model.square(material);
    model.show(square, json!({}));
    model.shows(in_quarters(texels.map(|texel| Vec3::new(0.5, 0.25, 0.75) * colour(texel))), &QUARTERS);
}

/// Which of `count` texels a whole number is.
fn wrapped(mode: u32, i: i32, count: i32) -> usize {
    let within = i.rem_euclid(count);
    (match mode {
        CLAMP => i.clamp(0, count - 1),
        10497 => within,
        _ if i.div_euclid(count) % 2 == 0 => within,
        _ => count - 1 - within,
    }) as usize
}

#[test]
fn pictures_are_repeated_clamped_and_mirrored_along_each_axis() {
    let texels = [RED, GREEN, BLUE, GREY];
    for [along_u, along_v] in [[10497, CLAMP], [CLAMP, 33648], [33648, 10497]] {
        let mut model = Model::under_a_sun(Vec3::Z);
        let texture = model.texture(2, &texels, json!({"wrapS": along_u, "wrapT": along_v, "magFilter": NEAREST}));
        let mut square = model.square(textured(texture));
        let uvs = model.vectors(&[[-1.0, -1.0], [-1.0, 2.0], [2.0, 2.0], [2.0, -1.0]]);
        square["attributes"]["TEXCOORD_0"] = json!(uvs);
        model.show(square, json!({}));
        let expected = |[x, y]: [f32; 2]| {
            let [u, v] = [x, -y].map(|way| (way + 1.0) * 1.5 - 1.0);
            let [column, row] =
                [(along_u, u), (along_v, v)].map(|(mode, u)| wrapped(mode, (2.0 * u).floor() as i32, 2));
            colour(texels[2 * row + column])
        };
        let middles = [0, 1, 2, 3, 4, 5].map(|i| (i as f32 - 2.5) / 3.0);
        let places: Vec<[f32; 2]> = middles.iter().flat_map(|x| middles.map(|y| [*x, y])).collect();
        model.shows(expected, &places);
    }
}

#[test]
fn texels_are_mixed_as_light_and_not_as_codes() {
    let mut model = Model::under_a_sun(Vec3::Z);
    let texture = model.texture(2, &[[0, 0, 0, 255], [255; 4]], json!({"wrapS": CLAMP, "magFilter": LINEAR}));
    let square = model.square(textured(texture));
    model.show(square, json!({}));
    let expected = |[x, _]: [f32; 2]| Vec3::splat(((0.5 * (x + 1.0) - 0.25) / 0.5).clamp(0.0, 1.0));
    model.shows(expected, &[-0.9, -0.3, -0.1, 0.1, 0.3, 0.9].map(|x| [x, 0.0]));
}

/// Turned counterclockwise as one sees the picture, whose v points down: as the extension's text says, its example, and the
/// sample model TextureTransformTest; the matrix printed there turns the other way (KhronosGroup/glTF, issue 1563).
#[test]
fn pictures_are_scaled_then_turned_then_moved() {
    let (offset, turn, scale) = (Vec2::new(0.375, 0.2), 0.3f32, Vec2::new(0.5, 1.5));
    let mut model = Model::under_a_sun(Vec3::Z);
    let black: [u8; 4] = [0, 0, 0, 255];
    let texels = [RED, GREEN, BLUE, GREY, black, RED, GREY, BLUE, GREEN];
    let texture = model.texture(3, &texels, nearest());
    let transform = json!({"offset": offset.to_array(), "rotation": turn, "scale": scale.to_array()});
    let mut material = textured(texture);
    material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = json!({"KHR_texture_transform": transform});
    let square = model.square(material);
    model.show(square, json!({}));
    let place = |[x, y]: [f32; 2]| {
        let uv = Vec2::new(0.5 * (x + 1.0), 0.5 * (1.0 - y)) * scale;
        let (sin, cos) = turn.sin_cos();
        Vec2::new(cos * uv.x + sin * uv.y, cos * uv.y - sin * uv.x) + offset
    };
    let texel = |at: Vec2| at.to_array().map(|way| wrapped(10497, (3.0 * way).floor() as i32, 3));
    let expected = |at: [f32; 2]| {
        let [column, row] = texel(place(at));
        colour(texels[3 * row + column])
    };
    // not at the edges of texels, where pixels are mixed
    let inside = |at: &[f32; 2]| {
        let steps = [-0.05, 0.05].map(|x| [-0.05, 0.05].map(|y| [at[0] + x, at[1] + y]));
        steps.as_flattened().iter().all(|near| texel(place(*near)) == texel(place(*at)))
    };
    let grid = (0..12).flat_map(|i| (0..12).map(move |j| [i, j].map(|i| (i as f32 - 5.5) / 6.0)));
    let places: Vec<[f32; 2]> = grid.filter(inside).collect();
    assert!(places.len() > 40, "{}", places.len());
    model.shows(expected, &places);
}
