//! Variance clamping (Salvi, "An Excursion in Temporal Supersampling", 2016; Karis, "High Quality Temporal Supersampling", 2014):
//! history further from the mean of a pixel's neighbours now than their spread explains is not of what is seen now.

use crate::transfer::sanitized;
use film::{Image, Vec3};

/// To each side of a pixel: 5 x 5 neighbours, for the usual 3 x 3 of a single sample each often miss a light together.
const REACH: usize = 2;

/// As many standard deviations from the mean may history be. Of clean pictures 1 is usual; there noise spreads the neighbours,
/// and what one sample found by luck must not be cut from history that knows the mean.
const GAMMA: f32 = 2.0;

/// Around each pixel of a row: means and standard deviations, in YCoCg, along whose axes colours spread least alike.
pub struct Neighbourhood {
    mean: Vec<Vec3>,
    deviation: Vec<Vec3>,
}

/// Sums of values and of their squares.
#[derive(Clone, Copy, Default)]
struct Moments {
    sum: Vec3,
    squares: Vec3,
}

impl Moments {
    fn add(&mut self, other: Moments) {
        self.sum += other.sum;
        self.squares += other.squares;
    }
}

impl Neighbourhood {
    /// As far as it is in the picture.
    pub fn of_row(image: &Image, y: u32) -> Self {
        let (width, height) = (image.width() as usize, image.height() as usize);
        let near = |at: usize, side: usize| at.saturating_sub(REACH)..(at + REACH + 1).min(side);
        let rows = near(y as usize, height);
        let mut columns = vec![Moments::default(); width];
        for row in rows.clone() {
            for (column, value) in columns.iter_mut().zip(&image.radiances()[row * width..]) {
                let value = ycocg(sanitized(*value));
                column.add(Moments { sum: value, squares: value * value });
            }
        }
        let around = (0..width).map(|x| {
            let mut moments = Moments::default();
            columns[near(x, width)].iter().for_each(|column| moments.add(*column));
            let count = (near(x, width).len() * rows.len()) as f32;
            let mean = moments.sum / count;
            (mean, (moments.squares / count - mean * mean).max(Vec3::ZERO).map(f32::sqrt))
        });
        let (mean, deviation) = around.unzip();
        Neighbourhood { mean, deviation }
    }

    /// What history says of the pixel in this column, as far as that can be.
    pub fn clamped(&self, radiance: Vec3, x: u32) -> Vec3 {
        let (mean, reach) = (self.mean[x as usize], GAMMA * self.deviation[x as usize]);
        // where squares overflow nothing is known
        if !(mean.is_finite() && reach.is_finite()) {
            return radiance;
        }
        rgb(ycocg(radiance).clamp(mean - reach, mean + reach)).max(Vec3::ZERO)
    }
}

fn ycocg(Vec3 { x: r, y: g, z: b }: Vec3) -> Vec3 {
    Vec3::new(0.25 * r + 0.5 * g + 0.25 * b, 0.5 * (r - b), 0.5 * g - 0.25 * (r + b))
}

fn rgb(Vec3 { x: luma, y: orange, z: green }: Vec3) -> Vec3 {
    let rest = luma - green;
    Vec3::new(rest + orange, luma + green, rest - orange)
}
