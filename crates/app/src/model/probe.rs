//! One pixel looked into: its samples, how their mean settles, and how they are spread.

use super::PaneId;
use film::{Pixel, Vec3, colour};
use pathtrace::FirstVertex;
use std::fmt::Write;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// What is looked into, and whether it is in sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbeSettings {
    /// Whether the probe is open.
    pub open: bool,
    /// The pixel, in shares of the picture from its upper left corner: pictures of other sizes have it too.
    pub at: [f32; 2],
    /// Which number of each sample is drawn.
    pub channel: Channel,
}

impl Default for ProbeSettings {
    /// The pixel in the middle.
    fn default() -> Self {
        ProbeSettings { open: false, at: [0.5; 2], channel: Channel::Luminance }
    }
}

impl ProbeSettings {
    /// Column and row of the pixel in a picture of this size.
    pub fn pixel(&self, size: (u32, u32)) -> [u32; 2] {
        pixel_at(self.at, size)
    }

    /// Goes to the middle of the pixel that lies so many columns and rows farther in a picture of this size, within it.
    pub fn step(&mut self, [columns, rows]: [i64; 2], size: (u32, u32)) {
        let [column, row] = self.pixel(size);
        let along = |at: u32, by: i64, side: u32| {
            let last = i64::from(side.max(1)) - 1;
            ((i64::from(at) + by).clamp(0, last) as f32 + 0.5) / side.max(1) as f32
        };
        self.at = [along(column, columns, size.0), along(row, rows, size.1)];
    }
}

/// Column and row of the pixel at a place in shares of a picture of this size.
pub fn pixel_at(at: [f32; 2], (width, height): (u32, u32)) -> [u32; 2] {
    let along = |share: f32, side: u32| ((share * side as f32) as u32).min(side.saturating_sub(1));
    [along(at[0], width), along(at[1], height)]
}

/// A number of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Channel {
    /// How bright it is to the eye.
    #[default]
    Luminance,
    /// Its radiance in red.
    Red,
    /// Its radiance in green.
    Green,
    /// Its radiance in blue.
    Blue,
}

impl Channel {
    /// All, the default first.
    pub const ALL: [Channel; 4] = [Channel::Luminance, Channel::Red, Channel::Green, Channel::Blue];

    /// The name on its button.
    pub fn name(self) -> &'static str {
        match self {
            Channel::Luminance => "luminance",
            Channel::Red => "red",
            Channel::Green => "green",
            Channel::Blue => "blue",
        }
    }

    /// Its value of a radiance.
    pub fn of(self, radiance: Vec3) -> f64 {
        f64::from(match self {
            Channel::Luminance => colour::luminance(radiance),
            Channel::Red => radiance.x,
            Channel::Green => radiance.y,
            Channel::Blue => radiance.z,
        })
    }
}

/// What shall be looked into.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbeWish {
    /// The pixel, in shares of the picture.
    pub at: [f32; 2],
    /// Which sample is taken apart, from 0; `None` for the last.
    pub sample: Option<u32>,
}

/// The most samples of a pixel that are traced again: enough for the error to fall to a 256th.
pub const MOST_PROBED: u32 = 1 << 16;

/// What is known of a pane's pixel.
#[derive(Debug, Clone, Default)]
pub struct PaneProbe {
    /// Its samples so far.
    pub samples: Option<Arc<PixelSamples>>,
    /// The sample that is taken apart, from 0, and what it has found.
    pub vertex: Option<(u32, FirstVertex)>,
    /// Why there are none: a line.
    pub fault: Option<String>,
}

/// The first samples of a pixel, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct PixelSamples {
    /// Column and row of the pixel, from the upper left corner.
    pub pixel: [u32; 2],
    /// The samples that its picture is to have.
    pub wished: u32,
    /// Those that were traced again.
    pub samples: Vec<Vec3>,
    /// Of each channel what there is to draw, in the order of [`Channel::ALL`].
    drawn: [Drawn; Channel::ALL.len()],
}

/// A channel of all samples as it is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// How the mean settles.
    pub course: Vec<RunningMean>,
    /// How the samples are spread.
    pub spread: Spread,
}

/// The mean of the first samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunningMean {
    /// How many they are.
    pub samples: u32,
    /// The mean of the samples so far.
    pub mean: f64,
    /// Its standard error by their spread; 0 below two samples, where nothing is known about it.
    pub error: f64,
}

impl PixelSamples {
    /// Of a pixel's samples from the first on.
    pub fn new(pixel: [u32; 2], wished: u32, samples: Vec<Vec3>) -> Self {
        let drawn = Channel::ALL.map(|channel| {
            let values: Vec<f64> = samples.iter().map(|sample| channel.of(*sample)).collect();
            Drawn { course: course(&values), spread: Spread::of(&values) }
        });
        PixelSamples { pixel, wished, samples, drawn }
    }

    /// What there is to draw of a channel.
    pub fn drawn(&self, channel: Channel) -> &Drawn {
        &self.drawn[channel as usize]
    }

    /// The mean of all in linear radiance, as a film has it.
    pub fn mean(&self) -> Vec3 {
        let mut sum = Pixel::default();
        self.samples.iter().for_each(|sample| sum.add(*sample));
        Vec3::from_array(sum.mean().map(|mean| mean as f32))
    }
}

/// A mean and the sum of squared differences from it, kept without loss where these are small: Welford, "Note on a method for
/// calculating corrected sums of squares and products" (1962).
#[derive(Default)]
struct Moments {
    count: u32,
    mean: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, value: f64) -> RunningMean {
        self.count += 1;
        let n = f64::from(self.count);
        let off = value - self.mean;
        self.mean += off / n;
        self.squares += off * (value - self.mean);
        let error = if self.count < 2 { 0.0 } else { (self.squares / (n * (n - 1.0))).sqrt() };
        RunningMean { samples: self.count, mean: self.mean, error }
    }
}

/// Places of a course up to each power of two beyond the first few, over a logarithmic axis as many as one can see.
const PLACES: f64 = 24.0;

/// How the mean of these settles: every one of the first few, then ever fewer, and the last.
pub fn course(values: &[f64]) -> Vec<RunningMean> {
    let mut moments = Moments::default();
    let place = |n: usize| (PLACES * (n as f64).log2()) as u64;
    let is_drawn = |n: usize| n == values.len() || n == 1 || place(n) > place(n - 1);
    let running = values.iter().enumerate().map(|(index, value)| (index + 1, moments.add(*value)));
    running.filter(|(n, _)| is_drawn(*n)).map(|(_, mean)| mean).collect()
}

/// How samples are spread.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Spread {
    /// How many there are.
    pub count: u32,
    /// How many of them are 0: what such a sample has looked for was not there.
    pub zeros: u32,
    /// The largest, which is a firefly where it is far from the others, and which sample it is, from 0.
    pub largest: (f64, u32),
    /// Whether the largest is so far from the mean that an even axis would show nothing else.
    pub is_heavy_tailed: bool,
    /// Counts of those above 0 over even bins.
    pub even: Vec<Bin>,
    /// The same over bins of equal ratios.
    pub logarithmic: Vec<Bin>,
}

/// How many samples lie in a range.
#[derive(Debug, Clone, PartialEq)]
pub struct Bin {
    /// From where to where.
    pub range: RangeInclusive<f64>,
    /// How many samples there are in all.
    pub count: u32,
}

/// Bins of a histogram, at least and at most: few samples in many bins would be a thicket of ones and noughts.
const BINS: RangeInclusive<f64> = 8.0..=40.0;

/// In proportion to the square root, so that of more samples there are both more bins and more in each.
fn bins_for(samples: usize) -> usize {
    (2.0 * (samples as f64).sqrt()).clamp(*BINS.start(), *BINS.end()) as usize
}

/// The largest of so many times the mean of those above 0 has a tail.
const HEAVY: f64 = 8.0;

/// An axis of ratios goes down from the largest by at most this: below it nothing is seen of a mean.
const DEEPEST: f64 = 1e-6;

impl Spread {
    fn of(values: &[f64]) -> Self {
        let bright: Vec<f64> = values.iter().copied().filter(|value| *value > 0.0).collect();
        let largest =
            values.iter().copied().zip(0..).fold((0.0, 0), |best, next| if next.0 > best.0 { next } else { best });
        let mean = bright.iter().sum::<f64>() / bright.len().max(1) as f64;
        let least = bright.iter().copied().fold(largest.0, f64::min).max(DEEPEST * largest.0);
        Spread {
            count: values.len() as u32,
            zeros: (values.len() - bright.len()) as u32,
            largest,
            is_heavy_tailed: largest.0 > HEAVY * mean,
            even: bins(&bright, 0.0, largest.0, |value| value, |place| place),
            logarithmic: bins(&bright, least.log10(), largest.0.log10(), f64::log10, |place| 10f64.powf(place)),
        }
    }
}

/// Counts over even bins of a scale.
fn bins(values: &[f64], from: f64, to: f64, place: impl Fn(f64) -> f64, value: impl Fn(f64) -> f64) -> Vec<Bin> {
    if values.is_empty() {
        return Vec::new();
    }
    let mut counts = vec![0; bins_for(values.len())];
    let (width, last) = ((to - from).max(1e-9) / counts.len() as f64, counts.len() - 1);
    for at in values {
        counts[(((place(*at) - from) / width).max(0.0) as usize).min(last)] += 1;
    }
    let edge = |index: usize| value(from + width * index as f64);
    counts.into_iter().enumerate().map(|(i, count)| Bin { range: edge(i)..=edge(i + 1), count }).collect()
}

/// All samples as comma-separated values, a row each, with the mean of the luminances up to it and its standard error.
pub fn samples_csv(panes: &[(PaneId, Arc<PixelSamples>)]) -> String {
    let mut text = String::from("pane,column,row,sample,R,G,B,mean luminance,standard error\n");
    for (pane, pixel) in panes {
        let (mut moments, [column, row]) = (Moments::default(), pixel.pixel);
        for sample in &pixel.samples {
            let RunningMean { samples, mean, error } = moments.add(Channel::Luminance.of(*sample));
            let Vec3 { x, y, z } = sample;
            // writing to a text does not fail
            let _ = writeln!(text, "{pane},{column},{row},{samples},{x},{y},{z},{mean},{error}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathtrace::{Estimator, PathSettings, ProbedPixel, Roulette, Tracer};
    use std::path::Path;

    #[test]
    fn a_pixel_is_a_share_of_every_picture_and_steps_stay_within() {
        let mut probe = ProbeSettings { at: [1.0, 0.0], ..ProbeSettings::default() };
        assert_eq!((probe.pixel((8, 4)), probe.pixel((100, 100))), ([7, 0], [99, 0]));
        probe.step([3, -2], (8, 4));
        assert_eq!((probe.pixel((8, 4)), probe.at), ([7, 0], [7.5 / 8.0, 0.5 / 4.0]));
        probe.step([-5, 2], (8, 4));
        assert_eq!((probe.pixel((8, 4)), probe.at), ([2, 2], [2.5 / 8.0, 2.5 / 4.0]));
        for column in 0..1000 {
            let mut probe = ProbeSettings { at: [(column as f32 + 0.5) / 1000.0, 0.5], ..probe };
            probe.step([1, 0], (1000, 7));
            assert_eq!(probe.pixel((1000, 7)), [(column + 1).min(999), 3], "{column}");
        }
    }

    #[test]
    fn a_course_has_each_of_the_first_means_then_fewer_and_the_last_as_a_film_has_it() {
        let values: Vec<f64> = (0..5000).map(|i| f64::from(i * 7919 % 1009) / 1009.0 + 1e6).collect();
        let course = course(&values);
        assert!(course.iter().take(20).map(|mean| mean.samples).eq(1..=20));
        assert!((150..350).contains(&course.len()), "{}", course.len());
        let last = course.last().unwrap();
        let mean = values.iter().sum::<f64>() / 5000.0;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (5000.0 * 4999.0);
        assert_eq!(last.samples, 5000);
        assert!(
            (last.mean / mean - 1.0).abs() < 1e-14 && (last.error / variance.sqrt() - 1.0).abs() < 1e-9,
            "{last:?}"
        );
        assert_eq!(course[0].error, 0.0);
    }

    #[test]
    fn a_spread_tells_zeros_and_the_firefly_and_loses_no_sample() {
        let mut values = vec![0.0; 50];
        values.extend((1..=100).map(|i| f64::from(i) / 100.0));
        let even = Spread::of(&values);
        assert_eq!((even.count, even.zeros, even.largest, even.is_heavy_tailed), (150, 50, (1.0, 149), false));
        values[7] = 400.0;
        let heavy = Spread::of(&values);
        assert_eq!((heavy.zeros, heavy.largest, heavy.is_heavy_tailed), (49, (400.0, 7), true));
        for bins in [&even.even, &even.logarithmic, &heavy.even, &heavy.logarithmic] {
            let total: u32 = bins.iter().map(|bin| bin.count).sum();
            assert!(total == 100 || total == 101, "{total}");
            assert!(bins.windows(2).all(|pair| pair[0].range.end() == pair[1].range.start()));
        }
        assert_eq!(heavy.logarithmic.last().map(|bin| bin.count), Some(1), "alone at the end");
        assert_eq!((Spread::of(&[0.0; 3]).even, Spread::of(&[]).zeros), (Vec::new(), 0));
        assert_eq!(Spread::of(&[2.0; 3]).logarithmic.iter().map(|bin| bin.count).sum::<u32>(), 3);
    }

    #[test]
    fn few_samples_have_few_bins_and_many_no_more_than_can_be_told_apart() {
        let values = |samples: u32| (1..=samples).map(f64::from).collect::<Vec<_>>();
        let bins = [1, 16, 100, 1000, 65_536].map(|samples| Spread::of(&values(samples)).even.len());
        assert_eq!(bins, [8, 8, 20, 40, 40]);
        assert_eq!(
            Spread::of(&[[0.0; 384].as_slice(), &values(16)].concat()).logarithmic.len(),
            8,
            "zeros are in none"
        );
    }

    #[test]
    fn the_table_has_a_row_for_each_sample() {
        let samples = vec![Vec3::splat(1.0), Vec3::splat(3.0)];
        let pixel = Arc::new(PixelSamples::new([4, 5], 2, samples));
        assert_eq!(pixel.mean(), Vec3::splat(2.0));
        let text = samples_csv(&[(PaneId::A, pixel.clone()), (PaneId::B, pixel)]);
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!((rows.len(), rows[1], rows[3]), (5, "A,4,5,1,1,1,1,1,0", "B,4,5,1,1,1,1,1,0"));
        assert!(rows[2].starts_with("A,4,5,2,3,3,3,2,") && rows[2].ends_with(",1"), "{}", rows[2]);
    }

    /// Under a sky of 1 a floor of albedo 0.5 sends back 0.5, and uniform directions find cosines, which are even in [0, 1]:
    /// means of 256 of these are normal, and 95.4 % lie within two standard errors. Of 1,024 pixels the share is off by 0.65 %
    /// at one standard deviation; four of them are allowed.
    #[test]
    fn two_standard_errors_hold_the_truth_in_95_of_100_pixels() {
        let text = "sky.radiance = [1, 1, 1]\nmaterial.floor.diffuse.albedo = [0.5, 0.5, 0.5]\n\
                    camera = { eye = [0, 3, 6], target = [0, 0, 0], fov_y = 40 }\n\
                    [[rectangle]]\ncorner = [-90, 0, -90]\nedge_u = [0, 0, 180]\nedge_v = [180, 0, 0]\nmaterial = \"floor\"\n";
        let scene = scene::parse(text, "floor", Path::new("floor.toml")).unwrap();
        let (tracer, side) = (Tracer::new(&scene), 32);
        let settings =
            PathSettings { estimator: Estimator::UNIFORM, roulette: Roulette::OFF, ..PathSettings::independent() };
        let within = |index: u32| {
            let probed = ProbedPixel { camera: scene.camera, size: [side; 2], pixel: [index % side, index / side] };
            let samples = tracer.samples_of_pixel(&probed, &settings.into(), 0..256, &|| false).unwrap();
            let pixel = PixelSamples::new(probed.pixel, 256, samples);
            let RunningMean { mean, error, .. } = *pixel.drawn(Channel::Luminance).course.last().unwrap();
            (mean - 0.5).abs() <= 2.0 * error
        };
        let share = (0..side * side).filter(|index| within(*index)).count() as f64 / f64::from(side * side);
        assert!((share - 0.954).abs() < 0.026, "{share}");
    }
}
