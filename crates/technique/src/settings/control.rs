//! What the window shows of a setting.

use super::{Setting, Value};
use crate::TechniqueName;
use pathtrace::Roulette;
use scene::Scene;
use std::ops::RangeInclusive;

/// How the window shows a setting.
pub struct Control {
    /// What it is called, above it; empty where its words say enough.
    pub label: &'static str,
    /// What its value means, after the label.
    pub aside: fn(Value) -> String,
    /// What a picture's label calls its value; `None` for its name and the value.
    pub brief: Option<fn(Value) -> String>,
    /// What its value means, in a line below it; empty for none.
    pub below: fn(Value) -> &'static str,
    /// An explanation under the mouse; empty for none.
    pub hover: &'static str,
    /// A technique that needs another explanation.
    pub hover_in: Option<(TechniqueName, &'static str)>,
    /// The kind of control that sets the value.
    pub look: Look,
    /// Whether this word of a choice makes sense among the controls of a technique, or among those of the scene, for this
    /// scene.
    pub offers: fn(&str, Option<TechniqueName>, &Scene) -> bool,
    /// The techniques among whose controls it stands under "More".
    pub more: &'static [TechniqueName],
    /// Its name in the dump of widgets, where that is not the option's.
    pub dump_name: Option<&'static str>,
}

/// The kind of control that sets a value, with its range or words.
#[derive(Debug, Clone, PartialEq)]
pub enum Look {
    /// A slider over real numbers; narrower than what the option accepts where more is of no use.
    Steps {
        /// From where to where.
        range: RangeInclusive<f32>,
        /// How far apart its stops are.
        step: f64,
    },
    /// A slider over positive numbers on which equal ways are equal ratios, for what spans several powers of ten.
    Logarithmic(RangeInclusive<f32>),
    /// A slider over whole numbers.
    Whole(RangeInclusive<u32>),
    /// The same, and behind the last number no limit.
    WholeOrNone(RangeInclusive<u32>),
    /// A slider over powers of two with these exponents, and the number beside it to be typed.
    Doubling(RangeInclusive<u32>),
    /// A number to be dragged or typed.
    Typed,
    /// Words to choose from, with spaces where they read better than the option's hyphens, and what each means. Words
    /// that are left out can be chosen by the option alone.
    Words(&'static [(&'static str, &'static str)]),
    /// Names of parts of the light with their number, and an expression to be typed.
    LightPaths,
    /// A box to tick for each repair of the fake.
    Repairs,
    /// A box to tick for each bug of a path tracer.
    Bugs,
}

/// Decimals of a number that is told, where its step has no more.
const DECIMALS: i32 = 3;

impl Look {
    /// The value as it is told: no more decimals than three, or than the slider's step has; as many digits where equal ways are equal ratios.
    pub fn rounded(&self, value: Value) -> Value {
        let decimals = |number: f32| match self {
            Look::Steps { step, .. } => Some(DECIMALS.max(-step.log10().floor() as i32)),
            Look::Logarithmic(_) if number > 0.0 => Some(DECIMALS - 1 - number.log10().floor() as i32),
            _ => None,
        };
        let rounded = |number: f32| {
            let Some(decimals) = decimals(number) else { return number };
            let shift = 10f64.powi(decimals);
            ((f64::from(number) * shift).round() / shift) as f32
        };
        match value {
            Value::Number(number) => Value::Number(rounded(number)),
            Value::Roulette(roulette) => {
                Value::Roulette(Roulette { probability: roulette.probability.map(rounded), ..roulette })
            }
            other => other,
        }
    }
}

impl Control {
    /// Its label beside this value.
    pub fn label_of(&self, value: Value) -> String {
        format!("{}{}", self.label, (self.aside)(value))
    }

    /// The explanation among the controls of a technique, or among those of the scene.
    pub fn hover_among(&self, technique: Option<TechniqueName>) -> &'static str {
        self.hover_in.filter(|(other, _)| Some(*other) == technique).map_or(self.hover, |(_, hover)| hover)
    }
}

impl<T> Setting<T> {
    /// What the mouse is told of it, among the controls of a technique or among those of the scene: its explanation, or else what --help says.
    pub fn explanation(&self, technique: Option<TechniqueName>) -> String {
        match self.control.hover_among(technique) {
            "" => capitalised(&self.description()),
            hover => hover.to_owned(),
        }
    }

    /// The words that the window offers among the controls of a technique, or among those of the scene, each with its value
    /// and what it means.
    pub fn words(&self, technique: Option<TechniqueName>, scene: &Scene) -> Vec<(&'static str, Value, &'static str)> {
        let Look::Words(words) = self.control.look else { return Vec::new() };
        let valued = words.iter().filter_map(|(word, hover)| {
            let value = self.kind.parse(&word.replace(' ', "-")).ok()?;
            matches!(value, Value::Word(name) if (self.control.offers)(name, technique, scene))
                .then_some((*word, value, *hover))
        });
        valued.collect()
    }
}

/// The text with a capital letter, as sentences that stand alone begin.
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A number that is told, in groups of three digits from five on: "4096", "131,072".
pub fn grouped(number: u32) -> String {
    let digits = number.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let (first, rest) = digits.split_at((digits.len() - 1) % 3 + 1);
    let groups = (0..rest.len()).step_by(3).map(|at| format!(",{}", &rest[at..at + 3]));
    std::iter::once(first.to_owned()).chain(groups).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Kind, OF_SCENES, all_of_panes};

    /// The kind and the look of a row belong together, and the slider goes nowhere where the option does not.
    fn fits(kind: &Kind, look: &Look) -> bool {
        let inside = |range: &RangeInclusive<f32>, least: f32, most: f32| {
            range.start() < range.end() && *range.start() >= least && *range.end() <= most
        };
        match (kind, look) {
            (Kind::Number(accepted), Look::Steps { range, step }) => {
                *step > 0.0 && inside(range, *accepted.start(), *accepted.end())
            }
            (Kind::Number(accepted), Look::Logarithmic(range)) => {
                *range.start() > 0.0 && inside(range, *accepted.start(), *accepted.end())
            }
            (Kind::DegreesBelow(most), Look::Steps { range, step }) => {
                *step > 0.0 && inside(range, 0.0, most.next_down())
            }
            (Kind::Roulette, Look::Steps { range, step }) => *step > 0.0 && inside(range, f32::MIN_POSITIVE, 1.0),
            (Kind::Whole(accepted), Look::Whole(range)) => {
                accepted.contains(range.start()) && accepted.contains(range.end())
            }
            (Kind::Whole(accepted), Look::Doubling(exponents)) => {
                [exponents.start(), exponents.end()].iter().all(|exponent| accepted.contains(&(1 << **exponent)))
            }
            (Kind::Whole(_), Look::Typed)
            | (Kind::Bounces, Look::WholeOrNone(_))
            | (Kind::LightPaths, Look::LightPaths)
            | (Kind::Repairs, Look::Repairs)
            | (Kind::Bugs, Look::Bugs) => true,
            (Kind::Choice(accepted), Look::Words(words)) => {
                words.iter().all(|(word, _)| accepted.contains(&word.replace(' ', "-").as_str()))
            }
            _ => false,
        }
    }

    #[test]
    fn each_control_is_of_its_settings_kind_and_within_its_bounds() {
        for setting in all_of_panes() {
            assert!(fits(&setting.kind, &setting.control.look), "{}", setting.name);
            let named = !setting.control.label.is_empty() || matches!(setting.kind, Kind::Choice(_));
            assert!(named, "{} has no label", setting.name);
        }
        for setting in OF_SCENES {
            assert!(
                fits(&setting.kind, &setting.control.look) && !setting.control.label.is_empty(),
                "{}",
                setting.name
            );
        }
        assert!(!fits(&Kind::Whole(1..=8), &Look::Doubling(0..=4)) && !fits(&Kind::Bounces, &Look::Typed));
    }

    #[test]
    fn chains_are_offered_no_estimator_that_follows_a_guide() {
        let scene = scene::builtin::named("whitted").expect("a built-in scene");
        let offered = |technique| {
            let words = crate::settings::of_panes("estimator").unwrap().words(Some(technique), &scene);
            words.into_iter().map(|(word, ..)| word).collect::<Vec<_>>()
        };
        assert_eq!(offered(TechniqueName::Path), ["uniform", "cosine", "light", "mis", "guided"]);
        assert_eq!(offered(TechniqueName::Metropolis), ["uniform", "cosine", "light", "mis"]);
    }

    #[test]
    fn numbers_are_told_with_three_decimals_or_as_many_as_their_step_has() {
        let told = |name: &str, number: f32| {
            let setting = crate::settings::of_panes(name).unwrap();
            setting.control.look.rounded(Value::Number(number)).to_string()
        };
        assert_eq!([told("specular", 1.0 / 15.0), told("specular", 0.9)], ["0.067", "0.9"]);
        assert_eq!(told("shadow-bias", -0.00251), "-0.0025");
        let radii = [0.012_345, 0.272_9, 10.643, 1234.5].map(|radius| told("radius", radius));
        assert_eq!(radii, ["0.0123", "0.273", "10.6", "1230"], "three digits where equal ways are equal ratios");
        let probability = Value::Roulette(Roulette::constant(2.0 / 3.0));
        let roulette = crate::settings::of_panes("roulette").unwrap();
        assert_eq!(roulette.control.look.rounded(probability).to_string(), "0.667");
    }

    #[test]
    fn digits_are_grouped_from_five_on() {
        let told = [0, 999, 4096, 16_384, 131_072, 1_000_000, u32::MAX].map(grouped);
        assert_eq!(told, ["0", "999", "4096", "16,384", "131,072", "1,000,000", "4,294,967,295"]);
    }

    #[test]
    fn what_the_scene_has_is_known_where_the_setting_says_nothing() {
        let scene = scene::builtin::named("whitted").expect("a built-in scene");
        let unset =
            all_of_panes().filter(|setting| setting.default.is_none()).map(|setting| (setting.name, setting.own));
        for (name, own) in unset.chain(OF_SCENES.iter().map(|setting| (setting.name, setting.own))) {
            assert!(own(&scene).is_some(), "{name}");
        }
    }
}
