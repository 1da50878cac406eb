//! A sky from a picture in latitude and longitude: light from all directions, infinitely far away.
//!
//! Rows are bands of equal angle from straight up (the first) to straight down. Columns are sectors around y; the
//! middle of a picture that is not turned lies towards -z, its right half towards +x. A texel is one colour.

use film::Image;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// A picture wrapped around the scene: radiance that arrives from each direction.
#[derive(Debug)]
pub struct EnvironmentMap {
    image: Image,
    scale: f32,
    rotation: f32,
    mean: Vec3,
    /// Mean and largest radiance of the picture as it was read.
    read: (Vec3, f32),
    notes: Vec<String>,
}

impl EnvironmentMap {
    /// Texels along a side at most: what every graphics device takes.
    pub const MOST_SIDE: u32 = 8192;
    /// Largest radiance of a texel, scaled: that of numbers in scene files.
    const LARGEST: f32 = 1e12;

    /// Of linear radiances, times `scale`, turned about y by `rotation` degrees as a box is by its `turn_y`.
    ///
    /// # Errors
    /// What is wrong with the picture, in a few words.
    pub fn new(image: Image, scale: f32, rotation: f32) -> Result<Self, String> {
        let (width, height) = image.size();
        if width == 0 || height == 0 {
            return Err("it is empty".to_owned());
        }
        if width.max(height) > Self::MOST_SIDE {
            return Err(format!("{width} x {height} pixels: a sky has at most {} along a side", Self::MOST_SIDE));
        }
        let wrong = |radiance: &Vec3| {
            let scaled = *radiance * scale;
            !(radiance.cmpge(Vec3::ZERO).all() && scaled.cmple(Vec3::splat(Self::LARGEST)).all())
        };
        if let Some(at) = image.radiances().iter().position(wrong) {
            let [x, y] = [at % width as usize, at / width as usize];
            let colour = image.radiances()[at];
            return Err(format!("pixel ({x}, {y}) is {colour}: a sky's radiance lies between 0 and 1e12, scaled"));
        }
        let mean = mean_radiance(&image);
        let largest = image.radiances().iter().fold(0.0, |largest: f32, radiance| largest.max(radiance.max_element()));
        Ok(EnvironmentMap { image, scale, rotation, mean: mean * scale, read: (mean, largest), notes: Vec::new() })
    }

    /// The same picture at another strength, turned otherwise; `None` where it would shine with more than 1e12. Its
    /// pixels stay shared, and nobody looks at them.
    pub fn shown_otherwise(&self, scale: f32, rotation: f32) -> Option<Self> {
        let (mean, largest) = self.read;
        let fits = largest * scale <= Self::LARGEST && rotation.is_finite();
        fits.then(|| EnvironmentMap {
            image: self.image.clone(),
            scale,
            rotation,
            mean: mean * scale,
            read: self.read,
            notes: self.notes.clone(),
        })
    }

    /// The same, with what of its file the picture does not show.
    pub fn with_notes(self, notes: Vec<String>) -> Self {
        EnvironmentMap { notes, ..self }
    }

    /// What of its file the picture does not show, a line each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The picture as it was read.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// What its pixels are multiplied by.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// Degrees by which it is turned about y.
    pub fn rotation(&self) -> f32 {
        self.rotation
    }

    /// Radiance of each texel, rows from the top.
    pub fn radiances(&self) -> impl ExactSizeIterator<Item = Vec3> {
        self.image.radiances().iter().map(|radiance| *radiance * self.scale)
    }

    /// Mean radiance over all directions: what stands for it where a sky has one colour.
    pub fn mean(&self) -> Vec3 {
        self.mean
    }
}

impl PartialEq for EnvironmentMap {
    /// One map is equal to itself without a look at its texels.
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
            || ((self.scale, self.rotation) == (other.scale, other.rotation) && self.image == other.image)
    }
}

/// Minus the height on the unit sphere of the bounds of so many rows, from -1 straight up to 1 straight down: one more
/// than there are rows. A band's share of the sphere is half the difference of its bounds.
pub fn row_bounds(rows: u32) -> impl ExactSizeIterator<Item = f64> {
    (0..rows as usize + 1).map(move |row| {
        // from the nearer end, so that both halves are alike
        let from_end = row.min(rows as usize - row);
        let height = 2.0 * (0.5 * PI * from_end as f64 / f64::from(rows)).sin().powi(2) - 1.0;
        if from_end == row { height } else { -height }
    })
}

fn mean_radiance(image: &Image) -> Vec3 {
    let (width, height) = image.size();
    let bounds: Vec<f64> = row_bounds(height).collect();
    let rows = image.radiances().chunks_exact(width as usize).zip(bounds.windows(2));
    let of_row = |(row, bounds): (&[Vec3], &[f64])| {
        row.iter().map(|radiance| radiance.as_dvec3()).sum::<DVec3>() * (0.5 * (bounds[1] - bounds[0]))
    };
    (rows.map(of_row).sum::<DVec3>() / f64::from(width)).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_weighs_rows_by_their_solid_angle() {
        // 60 degrees around the zenith are a quarter of the sphere
        let bright_top = [Vec3::splat(4.0), Vec3::ZERO, Vec3::ZERO];
        let map = EnvironmentMap::new(Image::new(1, 3, bright_top).unwrap(), 0.5, 0.0).unwrap();
        assert!((map.mean() - 0.5).abs().max_element() < 1e-6, "{}", map.mean());
    }

    #[test]
    fn row_bounds_are_symmetric_and_exact_at_the_ends() {
        for rows in [1, 2, 3, 1000, 1001] {
            let bounds: Vec<f64> = row_bounds(rows).collect();
            assert_eq!((bounds[0], bounds[rows as usize]), (-1.0, 1.0));
            assert!(bounds.iter().zip(bounds.iter().rev()).all(|(a, b)| (a + b).abs() < 1e-15));
            assert!(bounds.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }

    #[test]
    fn what_cannot_be_a_sky_is_refused() {
        let of = |pixels: Vec<Vec3>, scale| {
            let image = Image::new(pixels.len() as u32, 1, pixels).unwrap();
            EnvironmentMap::new(image, scale, 0.0).unwrap_err()
        };
        assert!(of(vec![], 1.0).contains("empty"));
        assert!(of(vec![Vec3::ONE, Vec3::NAN], 1.0).starts_with("pixel (1, 0) is"));
        assert!(of(vec![Vec3::ONE, Vec3::INFINITY], 1.0).starts_with("pixel (1, 0) is"));
        assert!(of(vec![Vec3::ONE, Vec3::new(1.0, -1e-9, 1.0)], 1.0).starts_with("pixel (1, 0) is"));
        assert!(of(vec![Vec3::ONE], 2e12).starts_with("pixel (0, 0) is"));
        assert!(of(vec![Vec3::ONE; 8193], 1.0).contains("at most 8192"));
    }
}
