//! Six cameras that look along the axes: for the cube maps of glass and for the shadows of an area light.
//!
//! Cube maps are left-handed: the texel at (s, t), both in [-1, 1] and t downwards, of face +x lies in direction (1,
//! -t, -s), of +y in (s, 1, t), of +z in (s, -t, 1). Right-handed cameras can't draw that. They draw the world mirrored
//! in x instead, by looking the other way along x, and the shader's lookup mirrors x too.

use crate::planes::Planes;
use scene::Vec3;
use scene::glam::{Mat4, camera::rh};

/// Line of sight and upward direction of the cameras, in the order +x, -x, +y, -y, +z, -z.
const AXES: [(Vec3, Vec3); 6] = [
    (Vec3::X, Vec3::Y),
    (Vec3::NEG_X, Vec3::Y),
    (Vec3::Y, Vec3::NEG_Z),
    (Vec3::NEG_Y, Vec3::Z),
    (Vec3::Z, Vec3::Y),
    (Vec3::NEG_Z, Vec3::Y),
];

/// Unit line of sight of a camera, 0 to 5: +x, -x, +y, -y, +z, -z.
pub fn forward(axis: usize) -> Vec3 {
    AXES[axis].0
}

/// Clip space of the camera along `axis`, 0 to 5, at `eye`; `reach` is the tangent of half its field of view, 1 for an
/// exact cube.
pub fn clip_from_world(eye: Vec3, axis: usize, reach: f32, planes: Planes) -> Mat4 {
    let (forward, up) = AXES[axis];
    let projection = rh::proj::directx::perspective_infinite_reverse(2.0 * reach.atan(), 1.0, 1.0);
    planes.applied_to(projection * rh::view::look_to_mat4(eye, forward, up))
}

/// The axis whose camera draws a cube map's layer.
pub fn axis_of_layer(layer: usize) -> usize {
    if layer < 2 { 1 - layer } else { layer }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the shader's mirrored lookup finds a world direction: layer, and (s, t) by the cube map convention.
    fn lookup(d: Vec3) -> (usize, [f32; 2]) {
        let m = Vec3::new(-d.x, d.y, d.z);
        let a = m.abs();
        if a.x >= a.y && a.x >= a.z {
            (usize::from(m.x < 0.0), [-m.z / m.x, -m.y / a.x])
        } else if a.y >= a.z {
            (2 + usize::from(m.y < 0.0), [m.x / a.y, m.z / m.y])
        } else {
            (4 + usize::from(m.z < 0.0), [m.x / m.z, -m.y / a.z])
        }
    }

    const PLANES: Planes = Planes { near: 0.1, far: 100.0 };

    #[test]
    fn a_lookup_finds_what_lies_in_its_direction() {
        let eye = Vec3::new(1.0, -2.0, 3.0);
        for i in 0..200 {
            let x = i as f32;
            let d = Vec3::new((x * 1.7).sin(), (x * 2.3 + 1.0).sin(), (x * 0.9 + 2.0).cos());
            let (layer, [s, t]) = lookup(d);
            let drawn = clip_from_world(eye, axis_of_layer(layer), 1.0, PLANES).project_point3(eye + d * 5.0);
            assert!((drawn.x - s).abs() < 1e-4 && (drawn.y + t).abs() < 1e-4, "{d}: {drawn} is not {s}, {t}");
        }
    }
}
