//! The film: what every technique fills and what display and ruler read. Linear RGB radiance, rows from the top, with
//! the sums that a mean and its standard error need. Sums are f64: a plain f32 sum of a million samples of .1 is off by
//! a percent.
//!
//! Twin of [`Pixel::add`]: `shaders/pathtrace/drive/film.wgsl`.

use crate::Image;
use glam::Vec3;

/// The sums of one pixel's samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pixel {
    /// Sum of the samples' radiance, RGB.
    pub sum: [f64; 3],
    /// Sum of the squares of the samples' radiance, RGB.
    pub sum_of_squares: [f64; 3],
    /// How many samples there are.
    pub samples: u32,
    /// The largest channel of any sample.
    pub largest: f32,
}

impl Pixel {
    /// A pixel of one exact value, as a technique without noise makes it.
    pub fn exact(radiance: Vec3) -> Self {
        let mut pixel = Self::default();
        pixel.add(radiance);
        pixel
    }

    /// A pixel of so many samples of one value.
    pub fn steady(radiance: Vec3, samples: u32) -> Self {
        let Pixel { sum, sum_of_squares, largest, .. } = Pixel::exact(radiance);
        let times = |sums: [f64; 3]| sums.map(|sum| sum * f64::from(samples));
        Pixel { sum: times(sum), sum_of_squares: times(sum_of_squares), samples, largest }
    }

    /// Adds one sample.
    pub fn add(&mut self, radiance: Vec3) {
        for (channel, value) in radiance.to_array().into_iter().enumerate() {
            let value = f64::from(value);
            self.sum[channel] += value;
            self.sum_of_squares[channel] += value * value;
        }
        self.samples += 1;
        self.largest = self.largest.max(radiance.max_element());
    }

    /// Adds the samples of another pixel.
    pub fn add_all(&mut self, other: &Pixel) {
        for channel in 0..3 {
            self.sum[channel] += other.sum[channel];
            self.sum_of_squares[channel] += other.sum_of_squares[channel];
        }
        self.samples += other.samples;
        self.largest = self.largest.max(other.largest);
    }

    /// The mean of the samples; zero before the first.
    pub fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| if self.samples == 0 { 0.0 } else { sum / f64::from(self.samples) })
    }

    /// Estimated variance of that mean, per channel; zero below two samples, where nothing is known about it.
    pub fn variance_of_mean(&self) -> [f64; 3] {
        let n = f64::from(self.samples);
        let mean = self.mean();
        std::array::from_fn(|c| {
            if self.samples < 2 { 0.0 } else { (self.sum_of_squares[c] / n - mean[c] * mean[c]).max(0.0) / (n - 1.0) }
        })
    }
}

/// Largest [`Film::tail_weight`] at which a standard error is believed.
const MOST_TAIL_WEIGHT: f64 = 0.01;

/// A picture in linear radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    pixels: Vec<Pixel>,
    /// Samples that were not finite and were left out. Zero unless something is broken, and shown if it is not.
    pub nonfinite: u64,
}

impl Film {
    /// A film without samples. `width` and `height` in pixels.
    pub fn new(width: u32, height: u32) -> Self {
        Film { width, height, pixels: vec![Pixel::default(); width as usize * height as usize], nonfinite: 0 }
    }

    /// As [`Film::new`], but `None` where the memory for it is not to be had.
    pub fn try_new(width: u32, height: u32) -> Option<Self> {
        let count = width as usize * height as usize;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).ok()?;
        pixels.resize(count, Pixel::default());
        Some(Film { width, height, pixels, nonfinite: 0 })
    }

    /// A film of exact values, rows from the top; `None` if their number is not `width * height`. Values that are not
    /// finite are counted and stored as black.
    pub fn from_radiances(width: u32, height: u32, radiances: impl IntoIterator<Item = Vec3>) -> Option<Self> {
        let mut nonfinite = 0;
        let pixels: Vec<_> = radiances
            .into_iter()
            .map(|radiance| {
                nonfinite += u64::from(!radiance.is_finite());
                Pixel::exact(if radiance.is_finite() { radiance } else { Vec3::ZERO })
            })
            .collect();
        (pixels.len() == width as usize * height as usize).then_some(Film { width, height, pixels, nonfinite })
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Adds the samples of another film of the same size, pixel by pixel.
    pub fn add_all(&mut self, other: &Film) {
        debug_assert_eq!((self.width, self.height), (other.width, other.height));
        self.pixels.iter_mut().zip(&other.pixels).for_each(|(pixel, other)| pixel.add_all(other));
        self.nonfinite += other.nonfinite;
    }

    /// The mean of the samples that came after an `earlier` state of the same film, as a picture, and how many they are of
    /// the pixel that has fewest; `None` if that state has another size or a pixel has no more since.
    pub fn since(&self, earlier: &Film) -> Option<(Image, u32)> {
        let pairs = || self.pixels.iter().zip(&earlier.pixels);
        let fewest =
            pairs().map(|(now, then)| now.samples.saturating_sub(then.samples)).min().filter(|new| *new > 0)?;
        let mean = |(now, then): (&Pixel, &Pixel)| {
            let new = f64::from(now.samples - then.samples);
            Vec3::from_array(std::array::from_fn(|c| ((now.sum[c] - then.sum[c]) / new) as f32))
        };
        let same_size = (self.width, self.height) == (earlier.width, earlier.height);
        let image = same_size.then(|| Image::new(self.width, self.height, pairs().map(mean).collect::<Vec<_>>()));
        Some((image??, fewest))
    }

    /// All pixels, rows from the top.
    pub fn pixels(&self) -> &[Pixel] {
        &self.pixels
    }

    /// All pixels, to add samples to.
    pub fn pixels_mut(&mut self) -> &mut [Pixel] {
        &mut self.pixels
    }

    /// The mean radiance of each pixel, rows from the top.
    pub fn radiances(&self) -> impl Iterator<Item = Vec3> + '_ {
        self.pixels.iter().map(|pixel| Vec3::from_array(pixel.mean().map(|v| v as f32)))
    }

    /// Mean radiance of the pixel at column `x`, row `y` from the top left.
    pub fn at(&self, x: u32, y: u32) -> Vec3 {
        Vec3::from_array(self.pixels[(y * self.width + x) as usize].mean().map(|v| v as f32))
    }

    /// Fewest samples that any pixel has.
    pub fn samples_per_pixel(&self) -> u32 {
        self.pixels.iter().map(|p| p.samples).min().unwrap_or(0)
    }

    /// Mean radiance of the whole picture.
    pub fn mean(&self) -> [f64; 3] {
        self.averaged(Pixel::mean)
    }

    /// Share of the brightest single sample in the picture's sum of squares, in [0, 1]: with a finite variance it falls
    /// like 1 / samples; under a heavy tail, such as a caustic's, it stays, and a standard error means little.
    pub fn tail_weight(&self) -> f64 {
        let largest = self.pixels.iter().fold(0f32, |most, pixel| most.max(pixel.largest));
        let channel = |c: usize| self.pixels.iter().map(|pixel| pixel.sum_of_squares[c]).sum::<f64>();
        let squares = (0..3).map(channel).fold(0.0, f64::max);
        if squares > 0.0 { (f64::from(largest).powi(2) / squares).min(1.0) } else { 0.0 }
    }

    /// Whether [`Film::standard_error`] can be trusted: no single sample holds more than 1 % of the sum of squares.
    pub fn standard_error_is_reliable(&self) -> bool {
        self.tail_weight() <= MOST_TAIL_WEIGHT
    }

    /// Standard error of [`Film::mean`], from the spread of the samples inside each pixel. Meaningless below two
    /// samples a pixel, where samples are not independent (a low-discrepancy sampler), and too small where rare bright
    /// samples have not been met yet, see [`Film::standard_error_is_reliable`].
    pub fn standard_error(&self) -> [f64; 3] {
        let pixels = self.pixels.len().max(1) as f64;
        self.averaged(Pixel::variance_of_mean).map(|variance| (variance / pixels).sqrt())
    }

    fn averaged(&self, of: impl Fn(&Pixel) -> [f64; 3]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for pixel in &self.pixels {
            for (sum, value) in sum.iter_mut().zip(of(pixel)) {
                *sum += value;
            }
        }
        sum.map(|s| s / self.pixels.len().max(1) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_samples_of_a_tenth_average_to_a_tenth() {
        let mut pixel = Pixel::default();
        (0..1_000_000).for_each(|_| pixel.add(Vec3::splat(0.1)));
        assert!((pixel.mean()[0] - f64::from(0.1f32)).abs() < 1e-12);
    }

    #[test]
    fn what_came_since_is_the_mean_of_the_later_samples_alone() {
        let mut film = Film::new(2, 1);
        film.pixels_mut().iter_mut().for_each(|pixel| pixel.add(Vec3::splat(9.0)));
        let earlier = film.clone();
        assert_eq!(film.since(&earlier), None);
        film.pixels_mut().iter_mut().for_each(|pixel| [1.0, 2.0].iter().for_each(|v| pixel.add(Vec3::splat(*v))));
        let (image, samples) = film.since(&earlier).unwrap();
        assert_eq!((image.radiances(), samples), (&[Vec3::splat(1.5); 2][..], 2));
        assert_eq!(film.since(&Film::new(1, 2)), None);
    }

    #[test]
    fn two_films_together_are_the_film_of_all_their_samples() {
        let film = |values: &[f32]| {
            let mut film = Film::new(2, 1);
            film.pixels_mut().iter_mut().for_each(|pixel| values.iter().for_each(|v| pixel.add(Vec3::splat(*v))));
            film
        };
        let mut both = film(&[1.0, 4.0]);
        both.add_all(&film(&[2.0]));
        assert_eq!(both, film(&[1.0, 4.0, 2.0]));
    }

    #[test]
    fn standard_error_of_a_coin_is_what_binomials_say() {
        let mut film = Film::new(2, 1);
        for pixel in film.pixels_mut() {
            (0..100).for_each(|i| pixel.add(Vec3::splat((i % 2) as f32)));
        }
        // variance 1/4 (n/(n-1) corrected) over 100 samples and 2 pixels
        let expected = (0.25 / 99.0 / 2.0f64).sqrt();
        assert!((film.standard_error()[1] - expected).abs() < 1e-12);
    }

    #[test]
    fn values_that_are_not_finite_are_counted_and_black() {
        let film = Film::from_radiances(2, 1, [Vec3::NAN, Vec3::ONE]).unwrap();
        assert_eq!((film.nonfinite, film.at(0, 0), film.at(1, 0)), (1, Vec3::ZERO, Vec3::ONE));
    }
}
