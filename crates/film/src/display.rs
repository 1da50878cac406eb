//! The one display transform: exposure, clamp to [0, 1], sRGB encoding, rounding to bytes. Every pane and every PNG
//! goes through it, and no metric does.

use crate::{Image, colour};
use glam::Vec3;
use std::sync::LazyLock;

/// How linear radiance becomes bytes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DisplayTransform {
    /// Exposure in stops: radiance is multiplied by 2^exposure.
    pub exposure: f32,
}

impl DisplayTransform {
    /// Bytes of one pixel: red, green, blue, opaque. NaN shows as black: it is counted and named elsewhere.
    pub fn rgba8(&self, radiance: Vec3) -> [u8; 4] {
        self.encode(radiance, self.scale())
    }

    /// Bytes of a whole picture, four a pixel, rows from the top.
    pub fn rgba8_of(&self, image: &Image) -> Vec<u8> {
        let scale = self.scale();
        image.radiances().iter().flat_map(|radiance| self.encode(*radiance, scale)).collect()
    }

    /// The sRGB code values, in [0, 1], of those bytes.
    pub fn code_values_of(&self, image: &Image) -> Image {
        let scale = self.scale();
        image.map(|radiance| {
            let [r, g, b, _] = self.encode(radiance, scale).map(f32::from);
            Vec3::new(r / 255.0, g / 255.0, b / 255.0)
        })
    }

    fn scale(&self) -> f32 {
        self.exposure.exp2()
    }

    fn encode(&self, radiance: Vec3, scale: f32) -> [u8; 4] {
        let shown = radiance * scale;
        [srgb_byte(shown.x), srgb_byte(shown.y), srgb_byte(shown.z), 255]
    }
}

/// The linear values at which the rounded sRGB byte steps up: byte b is shown from `STEPS[b - 1]` on.
static STEPS: LazyLock<[f32; 255]> =
    LazyLock::new(|| std::array::from_fn(|b| colour::srgb_decode((b as f32 + 0.5) / 255.0)));

/// The byte at the start of each bucket of [`bucket`]: a start for the search in [`STEPS`], so that encoding costs a
/// lookup and about one comparison instead of a power.
static BUCKETS: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let start = |index: u32| f32::from_bits((index + (FIRST_BUCKET_BITS >> BUCKET_SHIFT)) << BUCKET_SHIFT);
    (0..=bucket(1.0)).map(|index| STEPS.partition_point(|&step| step <= start(index as u32)) as u8).collect()
});

const BUCKET_SHIFT: u32 = 16;
/// 2^-13: below the first step.
const FIRST_BUCKET_BITS: u32 = 0x3900_0000;

fn bucket(linear: f32) -> usize {
    ((linear.to_bits() >> BUCKET_SHIFT) - (FIRST_BUCKET_BITS >> BUCKET_SHIFT)) as usize
}

/// The sRGB byte of a linear value, rounded to nearest; values outside [0, 1] are clamped, NaN is 0.
pub fn srgb_byte(linear: f32) -> u8 {
    if linear >= 1.0 {
        return 255;
    }
    // written so that NaN takes this branch
    if !(linear >= STEPS[0]) {
        return 0;
    }
    let mut byte = BUCKETS[bucket(linear)];
    while byte < 255 && STEPS[byte as usize] <= linear {
        byte += 1;
    }
    byte
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_equals_the_formula_on_a_dense_sweep_and_at_every_step() {
        let slow = |x: f32| (colour::srgb_encode(x) * 255.0).round() as u8;
        for i in 0..200_000u32 {
            let x = i as f32 / 190_000.0;
            assert!(srgb_byte(x).abs_diff(slow(x)) <= 1, "{x}");
        }
        for (byte, &step) in STEPS.iter().enumerate() {
            assert_eq!(srgb_byte(step) as usize, byte + 1);
            assert_eq!(srgb_byte(step.next_down()) as usize, byte);
        }
    }

    #[test]
    fn odd_values_become_black_or_white_bytes() {
        assert_eq!([f32::NAN, -1.0, f32::NEG_INFINITY, -0.0].map(srgb_byte), [0; 4]);
        assert_eq!([1.0, 7.0, f32::INFINITY].map(srgb_byte), [255; 3]);
    }

    #[test]
    fn code_values_are_the_bytes_over_255() {
        let image = Image::new(2, 1, [Vec3::new(0.0, 0.5, f32::NAN), Vec3::new(-1.0, 0.1, 7.0)]).unwrap();
        let display = DisplayTransform { exposure: 0.5 };
        let values = display.code_values_of(&image).radiances().iter().flat_map(|v| v.to_array()).collect::<Vec<_>>();
        let bytes = display.rgba8_of(&image);
        let expected = bytes.chunks_exact(4).flat_map(|p| [0, 1, 2].map(|c| f32::from(p[c]) / 255.0));
        assert!(values.into_iter().eq(expected));
    }

    #[test]
    fn one_stop_doubles_the_light() {
        let stop = DisplayTransform { exposure: 1.0 };
        assert_eq!(stop.rgba8(Vec3::splat(0.25)), DisplayTransform::default().rgba8(Vec3::splat(0.5)));
    }
}
