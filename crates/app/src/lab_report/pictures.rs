//! Pictures within a page or a slide: as they are shown, and no larger than they are seen there.

use bench::data_uri;
use film::colour::{srgb_decode, srgb_encode};
use image_file::{ImageFileError, Records, encode_rgba8};

/// The longest side of a picture in a page: a window's, or a projector's. Of a larger one whole squares of pixels become one
/// each, or a page would have a hundred megabytes.
pub const LONGEST_SIDE: u32 = 1920;

/// A picture as it is shown: RGBA bytes, all opaque, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

impl Shown {
    /// The address of the picture within the page.
    ///
    /// # Errors
    /// If it cannot be encoded.
    pub fn address(&self) -> Result<String, ImageFileError> {
        let png = encode_rgba8(self.size.0, self.size.1, &self.rgba, &Records::new())?;
        Ok(data_uri("image/png", &png))
    }

    /// Pixels along a side that become one, so that no side is longer than this.
    pub fn shrink_within(&self, longest: u32) -> u32 {
        self.size.0.max(self.size.1).div_ceil(longest.max(1)).max(1)
    }

    /// The mean light of each square of `side` pixels, those at the edges of what there is of them.
    pub fn shrunk(&self, side: u32) -> Shown {
        if side <= 1 {
            return self.clone();
        }
        self.resampled((self.size.0.div_ceil(side), self.size.1.div_ceil(side)), f64::from(side))
    }

    /// As large as fits within a box: larger pixels, as many for one as fit, or the mean light of what a smaller pixel covers.
    /// Neither invents what is not there nor rings at edges, as smoother filters do.
    pub fn within(&self, (width, height): (u32, u32)) -> Shown {
        let fits = |side: u32, room: u32| f64::from(room.max(1)) / f64::from(side.max(1));
        let scale = fits(self.size.0, width).min(fits(self.size.1, height));
        if scale >= 1.0 {
            return self.magnified(scale as u32);
        }
        let side = |pixels: u32| ((f64::from(pixels) * scale).round() as u32).max(1);
        self.resampled((side(self.size.0), side(self.size.1)), 1.0 / scale)
    }

    fn magnified(&self, factor: u32) -> Shown {
        let size = (self.size.0 * factor, self.size.1 * factor);
        let pixel = |x: u32, y: u32| {
            let at = 4 * ((y / factor) as usize * self.size.0 as usize + (x / factor) as usize);
            self.rgba[at..at + 4].to_vec()
        };
        let rgba = (0..size.1).flat_map(|y| (0..size.0).flat_map(move |x| pixel(x, y))).collect();
        Shown { size, rgba }
    }

    /// Each pixel is the mean light of the square of `side` pixels that it covers, edges by their shares: along x, then y.
    fn resampled(&self, size: (u32, u32), side: f64) -> Shown {
        let light: Vec<f32> = (0..=255u8).map(|code| srgb_decode(f32::from(code) / 255.0)).collect();
        let (columns, rows) = (covers(self.size.0, size.0, side), covers(self.size.1, size.1, side));
        let width = size.0 as usize;
        let mut narrow = vec![[0f32; 3]; width * self.size.1 as usize];
        for (y, row) in self.rgba.chunks_exact(4 * self.size.0.max(1) as usize).enumerate() {
            for (x, cover) in columns.iter().enumerate() {
                let pixels = cover.iter().map(|(from, share)| (&row[4 * from..4 * from + 3], share));
                narrow[y * width + x] = pixels
                    .fold([0.0; 3], |sum, (p, share)| [0, 1, 2].map(|c| sum[c] + share * light[usize::from(p[c])]));
            }
        }
        let mut rgba = Vec::with_capacity(4 * width * size.1 as usize);
        for cover in &rows {
            for x in 0..width {
                let column = cover.iter().map(|(from, share)| (narrow[from * width + x], share));
                let mean = column.fold([0.0; 3], |sum, (p, share)| [0, 1, 2].map(|c| sum[c] + share * p[c]));
                rgba.extend(mean.map(|light| (255.0 * srgb_encode(light)).round() as u8));
                rgba.push(255);
            }
        }
        Shown { size, rgba }
    }
}

/// For each of `to` pixels those of `from` that it covers, and their shares of it.
fn covers(from: u32, to: u32, side: f64) -> Vec<Vec<(usize, f32)>> {
    let cover = |pixel: u32| {
        let (begin, end) = (f64::from(pixel) * side, (f64::from(pixel + 1) * side).min(f64::from(from)));
        let (first, last) = (begin.floor() as u32, (end.ceil() as u32).min(from));
        let share = |at: u32| (end.min(f64::from(at + 1)) - begin.max(f64::from(at))).max(0.0) / (end - begin);
        (first..last).map(|at| (at as usize, share(at) as f32)).collect()
    };
    (0..to).map(cover).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(size: (u32, u32), of: impl Fn(u32, u32) -> u8) -> Shown {
        let pixels = (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y)));
        Shown { size, rgba: pixels.flat_map(|(x, y)| [[of(x, y); 3].as_slice(), &[255]].concat()).collect() }
    }

    #[test]
    fn a_square_becomes_its_mean_light() {
        let checks = grey((4, 4), |x, y| 255 * ((x + y) % 2) as u8);
        let small = checks.shrunk(2);
        assert_eq!(small.size, (2, 2));
        // half the light: 0.5 has the code 188
        assert!(small.rgba.chunks_exact(4).all(|pixel| pixel == [188, 188, 188, 255]), "{:?}", small.rgba);
        assert_eq!(grey((3, 3), |_, _| 9).shrunk(2), grey((2, 2), |_, _| 9), "edges weigh as the others");
    }

    #[test]
    fn a_picture_fits_its_box_and_keeps_its_shape() {
        let picture = grey((300, 200), |x, _| (x % 256) as u8);
        assert_eq!(picture.within((150, 150)).size, (150, 100));
        assert_eq!(picture.within((700, 700)).size, (600, 400), "by a whole factor");
        assert_eq!(picture.within((300, 900)), picture);
        let flat = grey((301, 199), |_, _| 77).within((97, 97));
        assert_eq!(flat, grey(flat.size, |_, _| 77), "what is of one grey stays of it");
    }

    #[test]
    fn no_side_is_longer_than_it_may_be() {
        let shrink = |size| Shown { size, rgba: Vec::new() }.shrink_within(LONGEST_SIDE);
        assert_eq!([(1920, 1080), (1921, 10), (3840, 2160), (10, 4000)].map(shrink), [1, 2, 2, 3]);
    }
}
