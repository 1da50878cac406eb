//! The window's icon: a ball, its left half shaded as the fake has it with a highlight and a hard edge, its right half with
//! light from all around; between them the line. X11 and Windows show it.

use winit::window::Icon;

/// Pixels along a side.
const SIDE: u32 = 64;

/// Its radius, of half the side.
const RADIUS: f32 = 0.94;

/// Drawn anew at each start: it takes no time, and is no file to keep.
pub fn icon() -> Option<Icon> {
    Icon::from_rgba(rgba(), SIDE, SIDE).ok()
}

fn rgba() -> Vec<u8> {
    let centre = |pixel: u32| (pixel as f32 + 0.5) / (0.5 * SIDE as f32) - 1.0;
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| pixel(centre(x), -centre(y))));
    pixels.flatten().collect()
}

/// The pixel at x to the right and y up, both from -1 to 1.
fn pixel(x: f32, y: f32) -> [u8; 4] {
    let (x, y) = (x / RADIUS, y / RADIUS);
    let from_centre = x.hypot(y);
    // the edge is a pixel wide
    let cover = ((1.0 - from_centre) * 0.5 * SIDE as f32 * RADIUS + 0.5).clamp(0.0, 1.0);
    let z = (1.0 - from_centre * from_centre).max(0.0).sqrt();
    let lit = (-0.5 * x + 0.6 * y + 0.62 * z).max(0.0);
    let [r, g, b] = if x.abs() < 0.05 {
        [1.0; 3]
    } else if x < 0.0 {
        let highlight = lit.powi(40);
        [0.1 + 0.32 * lit, 0.1 + 0.55 * lit, 0.12 + 0.85 * lit].map(|channel| channel + highlight)
    } else {
        let sky = 0.5 + 0.5 * y;
        [0.3 + 0.65 * lit + 0.1 * sky, 0.18 + 0.42 * lit + 0.15 * sky, 0.1 + 0.1 * lit + 0.25 * sky]
    };
    let byte = |channel: f32| (255.0 * channel.clamp(0.0, 1.0)).round() as u8;
    [byte(r), byte(g), byte(b), byte(cover)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_a_ball_whose_halves_differ_on_nothing() {
        let bytes = rgba();
        assert!(icon().is_some());
        let at = |x: u32, y: u32| &bytes[4 * (y * SIDE + x) as usize..][..4];
        assert_eq!([at(0, 0)[3], at(63, 63)[3], at(32, 32)[3]], [0, 0, 255]);
        assert!(at(16, 32)[2] > at(16, 32)[0] && at(48, 32)[0] > at(48, 32)[2], "blue against orange");
    }
}
