//! What tests of models share: texels, places, and what is known of their radiance.

use super::matt;
use scene::Vec3;
use serde_json::{Value, json};

pub const RED: [u8; 4] = [255, 0, 0, 255];
pub const GREEN: [u8; 4] = [0, 255, 0, 255];
pub const BLUE: [u8; 4] = [0, 0, 255, 255];
pub const GREY: [u8; 4] = [188, 188, 188, 255];

pub const NEAREST: u32 = 9728;
pub const LINEAR: u32 = 9729;
pub const CLAMP: u32 = 33071;

/// The middles of the square's quarters, from the upper left, row by row.
pub const QUARTERS: [[f32; 2]; 4] = [[-0.5, 0.5], [0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]];

pub const MIDDLE: [f32; 2] = [0.03, 0.03];

pub fn nearest() -> Value {
    json!({"magFilter": NEAREST, "minFilter": NEAREST})
}

/// Radiance of what sRGB writes as this code.
pub fn decoded(code: u8) -> f32 {
    let share = f32::from(code) / 255.0;
    if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
}

pub fn colour(texel: [u8; 4]) -> Vec3 {
    Vec3::new(decoded(texel[0]), decoded(texel[1]), decoded(texel[2]))
}

/// Which quarter of the square a place is in.
pub fn quarter([x, y]: [f32; 2]) -> usize {
    usize::from(x > 0.0) + 2 * usize::from(y < 0.0)
}

/// Radiances of the quarters.
pub fn in_quarters(of: [Vec3; 4]) -> impl Fn([f32; 2]) -> Vec3 {
    move |place| of[quarter(place)]
}

pub fn textured(texture: usize) -> Value {
    matt([1.0; 3], json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}))
}

/// A lamp, seen directly.
pub fn shining(strength: f32, more: Value) -> Value {
    let mut material = matt([0.0; 3], more);
    material["emissiveFactor"] = json!([1, 0.5, 0.25]);
    material["extensions"]["KHR_materials_emissive_strength"] = json!({"emissiveStrength": strength});
    material
}

pub const SHINES: Vec3 = Vec3::new(4.0, 2.0, 1.0);
