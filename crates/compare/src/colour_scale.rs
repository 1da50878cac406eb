//! What a coloured error map means: its range, its label, its colour bar and the bar's ticks.

use crate::ErrorMetric;
use crate::colour_map::{ColourMap, hatched};

/// A colour map over a range of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourScale {
    /// The colours.
    pub map: ColourMap,
    /// The value at the map's 0.
    pub low: f32,
    /// The value at the map's 1, above `low`.
    pub high: f32,
    /// What the values are.
    pub label: &'static str,
}

/// A mark on a colour bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Where along the bar, 0 at the low end, 1 at the high one.
    pub position: f32,
    /// The value there.
    pub value: f32,
    /// That value for people, with a sign where the scale has both.
    pub text: String,
}

/// Share of the values that a fitted scale covers: a few fireflies do not darken all the rest.
const COVERED: f32 = 0.99;

impl ColourScale {
    /// The usual scale of a map, fitted to its values: FLIP from 0 to 1, a sign about 0, magnitudes from 0; to the 99th
    /// percentile of the finite magnitudes, or their largest where that is 0, or 1 where all are 0.
    pub fn fitted(of: ErrorMetric, values: &[f32]) -> Self {
        Self::up_to(of, most_of(values))
    }

    /// The usual scale of a map up to a given value, above 0: two pictures under one scale can be compared by eye. FLIP
    /// has its own.
    pub fn up_to(of: ErrorMetric, high: f32) -> Self {
        let (map, low, high) = match of {
            ErrorMetric::Flip => (ColourMap::Magma, 0.0, 1.0),
            ErrorMetric::Signed => (ColourMap::BlueWhiteOrange, -high, high),
            ErrorMetric::Absolute | ErrorMetric::Relative | ErrorMetric::SquaredRelative => {
                (ColourMap::Viridis, 0.0, high)
            }
        };
        ColourScale { map, low, high, label: of.label() }
    }

    /// sRGB bytes of a value at column `x`, row `y`: values beyond the range have the ends' colours, those that are not
    /// finite are hatched.
    pub fn srgb(&self, value: f32, x: u32, y: u32) -> [u8; 3] {
        if value.is_finite() { self.map.srgb(self.position(value)) } else { hatched(x, y) }
    }

    /// A map of rows of `width` as opaque RGBA bytes, four a pixel. Empty if `width` is 0.
    pub fn image(&self, values: &[f32], width: u32) -> Vec<u8> {
        let rows = values.chunks(width.max(1) as usize).take(if width == 0 { 0 } else { usize::MAX });
        let pixels = (0u32..).zip(rows).flat_map(|(y, row)| (0u32..).zip(row).map(move |(x, value)| (x, y, *value)));
        pixels
            .flat_map(|(x, y, value)| {
                let [r, g, b] = self.srgb(value, x, y);
                [r, g, b, 255]
            })
            .collect()
    }

    /// The colour bar as opaque RGBA bytes, four a pixel, `width` by `height` pixels: low at the left, or at the foot
    /// where it is higher than wide.
    pub fn bar(&self, width: u32, height: u32) -> Vec<u8> {
        let along = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        pixels
            .flat_map(|(x, y)| {
                let t = if height > width { 1.0 - along(y, height) } else { along(x, width) };
                let [r, g, b] = self.map.srgb(t);
                [r, g, b, 255]
            })
            .collect()
    }

    /// Marks at round values (1, 2 or 5 times a power of ten apart), ascending, about `count` of them and at least two
    /// where the range holds two.
    pub fn ticks(&self, count: u32) -> Vec<Tick> {
        let (low, high) = (f64::from(self.low), f64::from(self.high));
        let wish = (high - low) / f64::from(count.max(2));
        if !(wish > 0.0) || !wish.is_finite() {
            return Vec::new();
        }
        let decade = 10f64.powf(wish.log10().floor());
        // a hair of slack keeps 0.1 * 10 from being more than 1
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|s| *s >= wish * (1.0 - 1e-6));
        let step = step.unwrap_or(10.0 * decade);
        let slack = 1e-6;
        let (first, last) = ((low / step - slack).ceil() as i64, (high / step + slack).floor() as i64);
        let digits = (-step.log10().floor()).max(0.0) as usize;
        (first..=last)
            .map(|i| {
                let value = i as f64 * step;
                let position = ((value - low) / (high - low)).clamp(0.0, 1.0) as f32;
                Tick { position, value: value as f32, text: number(value, digits, low < 0.0) }
            })
            .collect()
    }

    fn position(&self, value: f32) -> f32 {
        (value - self.low) / (self.high - self.low)
    }
}

/// The 99th percentile of the finite magnitudes, or what stands for it.
fn most_of(values: &[f32]) -> f32 {
    let mut magnitudes: Vec<f32> = values.iter().filter(|v| v.is_finite()).map(|v| v.abs()).collect();
    if magnitudes.is_empty() {
        return 1.0;
    }
    let rank = ((magnitudes.len() - 1) as f32 * COVERED).round() as usize;
    let largest = magnitudes.iter().fold(0f32, |most, v| most.max(*v));
    let (_, percentile, _) = magnitudes.select_nth_unstable_by(rank, f32::total_cmp);
    // below this a range is nothing that a bar can label
    [*percentile, largest].into_iter().find(|v| *v > 1e-30).unwrap_or(1.0)
}

fn number(value: f64, digits: usize, signed: bool) -> String {
    let plus = if signed && value > 0.0 { "+" } else { "" };
    // zero times a negative step
    let value = if value == 0.0 { 0.0 } else { value };
    match digits {
        _ if value == 0.0 => "0".to_owned(),
        0..=4 if value.abs() < 1e5 => format!("{plus}{value:.digits$}"),
        _ => format!("{plus}{value:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(low: f32, high: f32) -> ColourScale {
        ColourScale { map: ColourMap::Viridis, low, high, label: "" }
    }

    #[test]
    fn a_fitted_scale_leaves_out_one_firefly_in_two_hundred() {
        let mut values = vec![0.5; 200];
        (values[0], values[1], values[2]) = (1e9, f32::NAN, f32::INFINITY);
        let of = |map| ColourScale::fitted(map, &values);
        assert_eq!((of(ErrorMetric::Absolute).low, of(ErrorMetric::Absolute).high), (0.0, 0.5));
        assert_eq!((of(ErrorMetric::Signed).low, of(ErrorMetric::Signed).high), (-0.5, 0.5));
        assert_eq!((of(ErrorMetric::Flip).low, of(ErrorMetric::Flip).high), (0.0, 1.0));
        assert_eq!(of(ErrorMetric::Signed).map, ColourMap::BlueWhiteOrange);
    }

    #[test]
    fn a_scale_that_is_held_is_the_same_whatever_the_values() {
        let scale = ColourScale::up_to(ErrorMetric::Signed, 0.25);
        assert_eq!((scale.low, scale.high, scale.map), (-0.25, 0.25, ColourMap::BlueWhiteOrange));
        assert_eq!(ColourScale::up_to(ErrorMetric::Flip, 0.25), ColourScale::fitted(ErrorMetric::Flip, &[]));
    }

    #[test]
    fn nothing_and_next_to_nothing_have_a_scale() {
        let high = |values: &[f32]| ColourScale::fitted(ErrorMetric::Absolute, values).high;
        assert_eq!([high(&[]), high(&[0.0; 9]), high(&[f32::NAN; 9])], [1.0; 3]);
        let mut rare = [0.0; 300];
        rare[7] = 3.0;
        assert_eq!(high(&rare), 3.0);
    }

    #[test]
    fn the_sign_is_blue_below_and_orange_above() {
        let values = [-2.0, 0.0, 2.0, f32::NAN];
        let image = ColourScale::fitted(ErrorMetric::Signed, &values).image(&values, 2);
        let expected = [[0, 114, 178, 255], [255; 4], [213, 94, 0, 255], [0, 0, 0, 255]];
        assert_eq!(image, expected.concat());
        assert!(scale(0.0, 1.0).image(&values, 0).is_empty());
    }

    #[test]
    fn ticks_are_round_and_lie_where_they_say() {
        let of = |low, high, count| scale(low, high).ticks(count);
        let texts = |low, high, count| of(low, high, count).into_iter().map(|t| t.text).collect::<Vec<_>>();
        assert_eq!(texts(0.0, 1.0, 5), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(-0.7, 0.7, 4), ["-0.5", "0", "+0.5"]);
        assert_eq!(texts(0.0, 0.033, 4), ["0", "0.01", "0.02", "0.03"]);
        assert_eq!(texts(0.0, 3e-6, 3), ["0", "1e-6", "2e-6", "3e-6"]);
        assert_eq!(texts(0.0, 4e6, 4), ["0", "1e6", "2e6", "3e6", "4e6"]);
        assert!(of(1.0, 1.0, 5).is_empty() && of(0.0, f32::INFINITY, 5).is_empty());
        for tick in of(-0.7, 0.7, 4) {
            assert!((tick.value - (-0.7 + 1.4 * tick.position)).abs() < 1e-6);
        }
    }

    #[test]
    fn the_bar_runs_from_low_to_high() {
        let s = scale(3.0, 5.0);
        let bar = s.bar(512, 2);
        assert_eq!(bar.len(), 512 * 2 * 4);
        assert_eq!((&bar[..4], &bar[511 * 4..512 * 4]), (&[68, 1, 84, 255][..], &[253, 231, 37, 255][..]));
        let upright = s.bar(2, 512);
        assert_eq!((&upright[..3], &upright[upright.len() - 4..]), (&[253, 231, 37][..], &[68, 1, 84, 255][..]));
    }
}
