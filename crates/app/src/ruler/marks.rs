//! The marks of a colour bar that has little room.

use super::brief;
use compare::{ColourScale, Tick};

/// How far from the ends a round value stands beside their numbers.
const BETWEEN: std::ops::RangeInclusive<f32> = 0.25..=0.75;

/// Both ends, whatever their numbers, without which no colour means a value; between them round values, of which there are
/// about `count` along the whole bar. Ascending.
pub fn marks(scale: &ColourScale, count: u32) -> Vec<Tick> {
    let round = scale.ticks(count);
    let end = |value: f32, position: f32| {
        let is_there = |tick: &&Tick| (tick.position - position).abs() < 1e-4;
        let text = round.iter().find(is_there).map_or_else(|| number(value, scale), |tick| text(tick, scale));
        Tick { position, value, text }
    };
    let between = round.iter().filter(|tick| BETWEEN.contains(&tick.position));
    let between = between.map(|tick| Tick { text: text(tick, scale), ..*tick });
    [end(scale.low, 0.0)].into_iter().chain(between).chain([end(scale.high, 1.0)]).collect()
}

/// A round value as the scale tells it, where that is in plain decimals: of powers of ten it has a single digit.
fn text(tick: &Tick, scale: &ColourScale) -> String {
    let is_plain = tick.value == 0.0 || (1e-3..1e4).contains(&tick.value.abs());
    if is_plain { tick.text.clone() } else { number(tick.value, scale) }
}

/// With a sign where the scale has both.
fn number(value: f32, scale: &ColourScale) -> String {
    let plus = if scale.low < 0.0 && value > 0.0 { "+" } else { "" };
    let text = if value.abs() < 1e4 { brief(value.into()) } else { format!("{value:.1e}") };
    format!("{plus}{text}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use compare::ErrorMetric;

    #[test]
    fn both_ends_have_their_numbers_whatever_these_are() {
        for metric in ErrorMetric::ALL {
            for (decade, step) in (-7..7).flat_map(|decade| (0..90).map(move |step| (decade, step))) {
                let scale = ColourScale::up_to(metric, (1.0 + 0.1 * step as f32) * 10f32.powi(decade));
                for count in [3, 4] {
                    let marks = marks(&scale, count);
                    let (first, last) = (&marks[0], &marks[marks.len() - 1]);
                    assert_eq!((first.position, last.position), (0.0, 1.0), "{scale:?}");
                    assert_eq!((first.value, last.value), (scale.low, scale.high));
                    for mark in &marks {
                        let (told, value): (f32, f32) = (mark.text.parse().unwrap(), mark.value);
                        // two digits at the least
                        assert!((told - value).abs() <= 0.051 * value.abs(), "{told} for {value}");
                        assert_eq!(mark.text.starts_with('+'), metric == ErrorMetric::Signed && value > 0.0);
                    }
                    assert!(marks.is_sorted_by(|a, b| a.position < b.position), "{marks:?}");
                    let has_zero = marks.iter().any(|mark| mark.text == "0");
                    assert!(has_zero, "right and wrong are told apart: {marks:?}");
                }
            }
        }
    }
}
