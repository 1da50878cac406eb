//! Colour facts: the sRGB transfer function (IEC 61966-2-1) and luminance (Rec. 709).

use glam::Vec3;

/// Linear light, clamped to [0, 1], to an sRGB code value in [0, 1].
pub fn srgb_encode(linear: f32) -> f32 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

/// An sRGB code value in [0, 1] to linear light.
pub fn srgb_decode(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

/// Relative luminance of linear RGB.
pub fn luminance(rgb: Vec3) -> f32 {
    rgb.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_maps_half_to_188_and_keeps_the_ends() {
        let byte = |linear| (srgb_encode(linear) * 255.0).round();
        assert_eq!([0.0, 0.5, 1.0].map(byte), [0.0, 188.0, 255.0]);
    }

    #[test]
    fn srgb_decode_inverts_encode_at_every_byte() {
        for byte in 0..=255u8 {
            let code = f32::from(byte) / 255.0;
            assert_eq!((srgb_encode(srgb_decode(code)) * 255.0).round(), f32::from(byte));
        }
    }
}
