//! Chi-square tests of what maps random numbers to samples.

use pathtrace::sampling::sampler::Sampler;

/// Bins of a two-dimensional domain, as pbrt tests its BSDFs.
pub const ROWS: usize = 10;
/// See [`ROWS`].
pub const COLUMNS: usize = 20;

/// Counts of samples and the probabilities that they should follow.
pub struct Histogram {
    counts: Vec<f64>,
    probabilities: Vec<f64>,
}

impl Histogram {
    /// `samples` points of the unit square from `place`, which gets four random numbers; cells of equal probability
    /// unless `probability` of (row, column) says else.
    pub fn of_square(
        samples: u32,
        place: impl Fn([f32; 4]) -> [f64; 2],
        probability: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let bin = |value: f64, bins: usize| ((value * bins as f64).max(0.0) as usize).min(bins - 1);
        let probabilities = (0..ROWS * COLUMNS).map(|i| probability(i / COLUMNS, i % COLUMNS)).collect();
        Self::of_bins(samples, probabilities, |u| {
            let [x, y] = place(u);
            bin(x, ROWS) * COLUMNS + bin(y, COLUMNS)
        })
    }

    /// `samples` choices of a bin.
    pub fn of_bins(samples: u32, probabilities: Vec<f64>, choose: impl Fn([f32; 4]) -> usize) -> Self {
        let mut counts = vec![0.0; probabilities.len()];
        for i in 0..samples {
            counts[choose(Sampler::independent(22, i, 1).unit4(0))] += 1.0;
        }
        Histogram { counts, probabilities }
    }

    /// How many standard deviations chi-square lies above what fair samples give, by Wilson and Hilferty's normal
    /// approximation; bins that expect fewer than 5 are merged.
    pub fn deviation(&self) -> f64 {
        let n: f64 = self.counts.iter().sum();
        let (mut chi2, mut bins) = (0.0, 0);
        let (mut few, mut few_expected) = (0.0, 0.0);
        let mut add = |count: f64, expected: f64| {
            chi2 += (count - expected).powi(2) / expected;
            bins += 1;
        };
        for (&count, probability) in self.counts.iter().zip(&self.probabilities) {
            let expected = probability * n;
            if expected < 5.0 {
                (few, few_expected) = (few + count, few_expected + expected);
            } else {
                add(count, expected);
            }
        }
        if few_expected > 0.0 {
            add(few, few_expected);
        } else if few > 0.0 {
            return f64::INFINITY;
        }
        let k = f64::from(bins - 1);
        let spread = 2.0 / (9.0 * k);
        ((chi2 / k).cbrt() - (1.0 - spread)) / spread.sqrt()
    }
}

/// The same probability for each cell of the square.
pub fn alike(_: usize, _: usize) -> f64 {
    1.0 / (ROWS * COLUMNS) as f64
}
