//! Normals of vertices and of pictures.

use crate::gltf::*;
use scene::Vec3;
use serde_json::json;

#[test]
fn normals_of_vertices_are_interpolated_and_without_them_triangles_are_flat() {
    let sun = Vec3::new(0.3, 0.0, 1.0).normalize();
    let mut model = Model::under_a_sun(sun);
    let mut square = model.square(matt([0.75; 3], json!({})));
    let flat = square.clone();
    let [left, right] = [Vec3::new(-0.5, 0.0, 1.0), Vec3::new(0.5, 0.0, 1.0)].map(Vec3::normalize);
    let normals = model.vectors(&[left, left, right, right].map(|normal| normal.to_array()));
    square["attributes"]["NORMAL"] = json!(normals);
    // the smooth one above, the flat one below
    model.show(square, json!({"translation": [0, 0.5, 0], "scale": [1, 0.5, 1]}));
    model.show(flat, json!({"translation": [0, -0.5, 0], "scale": [1, 0.5, 1]}));
    let expected = |[x, y]: [f32; 2]| {
        let smooth = left.lerp(right, 0.5 * (x + 1.0)).normalize();
        Vec3::splat(0.75) * sun.dot(if y > 0.0 { smooth } else { Vec3::Z })
    };
    let places = [-0.8, -0.4, 0.1, 0.4, 0.8].map(|x| [[x, 0.5], [x, -0.5]]);
    model.shows(expected, places.as_flattened());
}

/// The normal that a texel of a normal map stands for, in tangent space.
fn tilted(texel: [u8; 4], scale: f32) -> Vec3 {
    let [x, y, z] = [0, 1, 2].map(|channel| f32::from(texel[channel]) / 255.0 * 2.0 - 1.0);
    Vec3::new(x * scale, y * scale, z).normalize()
}

/// Red tilts along u and green against v, on pictures that lie as they are and mirrored ones.
#[test]
fn normal_maps_tilt_along_u_and_against_v() {
    let texels = [[190, 128, 235, 255], [66, 128, 235, 255], [128, 190, 235, 255], [128, 66, 235, 255]];
    for (mirrored, scale) in [(false, 1.0), (true, 0.5)] {
        let sun = Vec3::new(0.4, 0.3, 1.0).normalize();
        let mut model = Model::under_a_sun(sun);
        let texture = model.texture(2, &texels, nearest());
        let material = matt([0.75; 3], json!({"normalTexture": {"index": texture, "scale": scale}}));
        let mut square = model.square(material);
        if mirrored {
            let uvs = model.vectors(&[[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]);
            square["attributes"]["TEXCOORD_0"] = json!(uvs);
        }
        let normals = model.vectors(&[[0.0, 0.0, 1.0]; 4]);
        square["attributes"]["NORMAL"] = json!(normals);
        model.show(square, json!({}));
        let expected = |place: [f32; 2]| {
            let of = quarter(place) ^ usize::from(mirrored);
            let along_u = if mirrored { -1.0 } else { 1.0 };
            let normal = tilted(texels[of], scale) * Vec3::new(along_u, 1.0, 1.0);
            Vec3::splat(0.75) * sun.dot(normal)
        };
        model.shows(expected, &QUARTERS);
    }
}
