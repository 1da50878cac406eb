//! The colour spaces FLIP measures in: sRGB to YCxCz (a linear opponent space in which contrast sensitivity is
//! filtered) and linear RGB to CIELAB, D65 white; the Hunt adjustment and the HyAB distance. Andersson et al. 2020,
//! section 4.1; HyAB from Abasi et al. 2020, "Distance metrics for very large color differences".

use film::colour::srgb_decode;

type Matrix = [[f32; 3]; 3];

/// sRGB primaries under D65, exact fractions rounded to f32.
const XYZ_FROM_RGB: Matrix = [
    [(10135552.0 / 24577794.0) as f32, (8788810.0 / 24577794.0) as f32, (4435075.0 / 24577794.0) as f32],
    [(2613072.0 / 12288897.0) as f32, (8788810.0 / 12288897.0) as f32, (887015.0 / 12288897.0) as f32],
    [(1425312.0 / 73733382.0) as f32, (8788810.0 / 73733382.0) as f32, (70074185.0 / 73733382.0) as f32],
];
const RGB_FROM_XYZ: Matrix = [
    [3.241003275, -1.537398934, -0.498615861],
    [-0.969224334, 1.875930071, 0.041554224],
    [0.055639423, -0.204011202, 1.057148933],
];
/// XYZ of linear RGB (1, 1, 1).
const WHITE: [f32; 3] = [0.950428545, 1.0, 1.088900371];

fn transformed(matrix: &Matrix, v: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// XYZ as shares of white's.
fn relative_xyz(linear: [f32; 3]) -> [f32; 3] {
    let xyz = transformed(&XYZ_FROM_RGB, linear);
    std::array::from_fn(|c| xyz[c] / WHITE[c])
}

/// sRGB code values in [0, 1] to YCxCz: Y in [-16, 100], Cx and Cz around 0.
pub fn ycxcz_from_srgb(code: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = relative_xyz(code.map(srgb_decode));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// YCxCz to linear RGB, clamped to [0, 1]: a filter may leave what a screen can show.
pub fn rgb_from_ycxcz([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (y + 16.0) / 116.0;
    let xyz = [(y + cx / 500.0) * WHITE[0], y * WHITE[1], (y - cz / 200.0) * WHITE[2]];
    transformed(&RGB_FROM_XYZ, xyz).map(|v| v.clamp(0.0, 1.0))
}

/// Linear RGB in [0, 1] to CIELAB with the Hunt adjustment: chroma counts less in the dark.
pub fn hunt_adjusted_lab(linear: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let root = |t: f32| if t > DELTA.powi(3) { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let [x, y, z] = relative_xyz(linear).map(root);
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// City block in lightness, Euclidean in chroma.
pub fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_grey_and_black_have_no_chroma_and_their_lightness() {
        for (linear, lightness) in [(1.0, 100.0), (0.184_186_5, 50.0), (0.0, 0.0)] {
            let lab = hunt_adjusted_lab([linear; 3]);
            assert!((lab[0] - lightness).abs() < 1e-3, "{lab:?}");
            assert!(lab[1].abs() < 1e-3 && lab[2].abs() < 1e-3, "{lab:?}");
        }
    }

    #[test]
    fn ycxcz_goes_there_and_back() {
        for code in [[0.2, 0.5, 0.9], [1.0, 0.0, 0.3], [0.01, 0.02, 0.03]] {
            let back = rgb_from_ycxcz(ycxcz_from_srgb(code));
            for (back, code) in back.into_iter().zip(code) {
                assert!((back - srgb_decode(code)).abs() < 1e-5);
            }
        }
    }
}
