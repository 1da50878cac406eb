//! A logarithmic axis: its range with some air, and its marks.

use super::Range;

/// A range of log10.
pub struct Axis {
    low: f64,
    high: f64,
}

/// Decades below which marks stand at 2 and 5 too.
const FEW: f64 = 2.5;
/// Share of the range that is added at both ends.
const AIR: f64 = 0.05;
/// Beyond as many there is no f64.
const MOST_DECADES: f64 = 300.0;

impl Axis {
    /// Holds all medians, and those ends of ranges that are positive.
    pub fn around(ranges: impl Iterator<Item = Range>) -> Self {
        let values = ranges.flat_map(|r| [r.low, r.median, r.high]).filter(|v| *v > 0.0 && v.is_finite());
        let around = |(low, high): (f64, f64), v: f64| (low.min(v.log10()), high.max(v.log10()));
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), around);
        if low > high {
            return Axis { low: 0.0, high: 1.0 };
        }
        let air = ((high - low) * AIR).max(0.1);
        Axis { low: low - air, high: high + air }
    }

    /// Where a value > 0 lies, 0 at the low end and 1 at the high one.
    pub fn at(&self, value: f64) -> f64 {
        (value.log10() - self.low) / (self.high - self.low)
    }

    /// Whether a value lies on it.
    pub fn holds(&self, value: f64) -> bool {
        (0.0..=1.0).contains(&self.at(value))
    }

    /// The value, or the low end where the logarithm has none.
    pub fn clamped(&self, value: f64) -> f64 {
        if value > 0.0 { value } else { 10f64.powf(self.low) }
    }

    /// Round values on it, ascending.
    pub fn ticks(&self) -> Vec<f64> {
        log_ticks(self.low, self.high)
    }
}

/// Round values between two, all of which but the values themselves are logarithms to base 10, ascending; none outside
/// of what f64 holds.
pub fn log_ticks(low: f64, high: f64) -> Vec<f64> {
    if !(low < high && low > -MOST_DECADES && high < MOST_DECADES) {
        return Vec::new();
    }
    let mantissas: &[f64] = if high - low < FEW { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let decades = low.floor() as i32..=high.ceil() as i32;
    let values = decades.flat_map(|decade| mantissas.iter().map(move |m| m * 10f64.powi(decade)));
    values.filter(|value| (low..=high).contains(&value.log10())).collect()
}

/// A round value for people.
pub fn number(value: f64) -> String {
    // 10 to a negative power is not exact
    match value.log10() {
        -3.01..=-0.01 => format!("{value:.4}").trim_end_matches('0').to_owned(),
        -0.01..=5.0 => format!("{value}"),
        _ => format!("{value:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_few() {
        let around = |low: f64, high: f64| Axis::around([Range { low, median: low, high }].into_iter());
        assert_eq!(around(0.9, 30.0).ticks(), [1.0, 2.0, 5.0, 10.0, 20.0]);
        assert_eq!(around(1e-6, 1.0).ticks().len(), 7);
        assert_eq!(around(1.0, 1.0).ticks(), [1.0]);
        assert_eq!(
            [1e-4, 1e-3, 0.02, 0.5, 1.0, 64.0, 1e6].map(number),
            ["1e-4", "0.001", "0.02", "0.5", "1", "64", "1e6"]
        );
    }
}
