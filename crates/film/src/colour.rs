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

/// Linear grey of the farthest depth: .3 of the way from black to white as a display shows it.
pub const DARKEST: f32 = 0.073_239;

/// Linear grey of a depth: white at the nearest, [`DARKEST`] at the farthest, even steps of display brightness; black where
/// nothing is, infinitely far.
pub fn grey_of_depth(depth: f32, [nearest, farthest]: [f32; 2]) -> f32 {
    if depth == f32::INFINITY {
        return 0.0;
    }
    let far = (depth - nearest) / (farthest - nearest).max(f32::MIN_POSITIVE);
    srgb_decode(1.0 + (srgb_encode(DARKEST) - 1.0) * far)
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

    #[test]
    fn depths_are_grey_from_white_to_darkest() {
        assert_eq!(grey_of_depth(f32::INFINITY, [0.2, 0.4]), 0.0);
        assert!((grey_of_depth(0.2, [0.2, 0.4]) - 1.0).abs() < 1e-6);
        assert!((grey_of_depth(0.4, [0.2, 0.4]) - DARKEST).abs() < 1e-6);
        assert!((grey_of_depth(0.3, [0.3, 0.3]) - 1.0).abs() < 1e-6);
    }
}
