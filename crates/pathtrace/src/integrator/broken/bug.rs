//! Names of bugs, and sets of them.
//!
//! Twin: `shaders/pathtrace/integrator/broken/wrong.wgsl`.

use super::rows::{ROWS, Row};
use std::fmt;

/// A bug of a path tracer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Bug {
    /// Light counts as if it came from straight above.
    NoCosine,
    /// The density of a direction is not divided by.
    NoPdf,
    /// The density of another sampler is divided by.
    WrongPdf,
    /// Lambert's BRDF is the albedo.
    NoInversePi,
    /// Survivors of roulette do not carry the light of those that ended.
    RouletteLost,
    /// The density of a point on a lamp is taken for that of a direction.
    AreaMeasure,
    /// A lamp's area is its width times its width.
    WidthTwice,
    /// Points on lamps are drawn in a box.
    ThickLamp,
    /// Light that was sampled is counted once more where a path meets it.
    EmissionTwice,
    /// The normal stays on the outside where a surface is seen from within.
    BackFace,
    /// Rays leave surfaces by the same step whatever the size of the scene.
    Epsilon,
    /// Samples are cut off at white before they are averaged.
    Clamped,
    /// Samples are encoded for the screen before they are averaged.
    Encoded,
    /// The number of a sample is lost in a float that holds the time.
    FloatSeed,
}

impl Bug {
    /// All of them, from the integrand to the film.
    pub const ALL: [Bug; 14] = [
        Bug::NoCosine,
        Bug::NoPdf,
        Bug::WrongPdf,
        Bug::NoInversePi,
        Bug::RouletteLost,
        Bug::AreaMeasure,
        Bug::WidthTwice,
        Bug::ThickLamp,
        Bug::EmissionTwice,
        Bug::BackFace,
        Bug::Epsilon,
        Bug::Clamped,
        Bug::Encoded,
        Bug::FloatSeed,
    ];

    /// What there is to say about it.
    pub fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The bug of that name.
    pub fn named(name: &str) -> Option<Bug> {
        Bug::ALL.into_iter().find(|bug| bug.name() == name)
    }

    /// What stands for it in a set.
    fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// The numbers by which `shaders/pathtrace/integrator/broken/wrong.wgsl` knows them.
pub(crate) fn shader_numbers() -> [(&'static str, f64); Bug::ALL.len()] {
    [
        ("BUG_NO_COSINE", Bug::NoCosine),
        ("BUG_NO_PDF", Bug::NoPdf),
        ("BUG_WRONG_PDF", Bug::WrongPdf),
        ("BUG_NO_INVERSE_PI", Bug::NoInversePi),
        ("BUG_ROULETTE_LOST", Bug::RouletteLost),
        ("BUG_AREA_MEASURE", Bug::AreaMeasure),
        ("BUG_WIDTH_TWICE", Bug::WidthTwice),
        ("BUG_THICK_LAMP", Bug::ThickLamp),
        ("BUG_EMISSION_TWICE", Bug::EmissionTwice),
        ("BUG_BACK_FACE", Bug::BackFace),
        ("BUG_EPSILON", Bug::Epsilon),
        ("BUG_CLAMPED", Bug::Clamped),
        ("BUG_ENCODED", Bug::Encoded),
        ("BUG_FLOAT_SEED", Bug::FloatSeed),
    ]
    .map(|(name, bug)| (name, f64::from(bug as u32)))
}

/// A set of bugs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Bugs(u32);

impl Bugs {
    /// The truth as it is.
    pub const NONE: Bugs = Bugs(0);
    /// Every bug at once.
    pub const ALL: Bugs = Bugs((1 << Bug::ALL.len()) - 1);

    /// Whether a bug is one of them.
    pub fn has(self, bug: Bug) -> bool {
        self.0 & bug.bit() != 0
    }

    /// Whether one of several is.
    pub fn has_any(self, bugs: &[Bug]) -> bool {
        bugs.iter().any(|bug| self.has(*bug))
    }

    /// Whether there is none.
    pub fn is_none(self) -> bool {
        self == Bugs::NONE
    }

    /// These and one more.
    #[must_use]
    pub fn with(self, bug: Bug) -> Bugs {
        Bugs(self.0 | bug.bit())
    }

    /// These but for one.
    #[must_use]
    pub fn without(self, bug: Bug) -> Bugs {
        Bugs(self.0 & !bug.bit())
    }

    /// One by one, in the order of [`Bug::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Bug> {
        Bug::ALL.into_iter().filter(move |bug| self.has(*bug))
    }

    /// How many they are.
    pub fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// The names of all, in the order of [`Bug::ALL`].
    pub fn names() -> [&'static str; Bug::ALL.len()] {
        Bug::ALL.map(Bug::name)
    }

    /// What [`Bugs`] says of itself, read back: names with + or a comma between, or "none".
    ///
    /// # Errors
    /// The name that is none.
    pub fn parse(text: &str) -> Result<Bugs, String> {
        match text {
            "none" => Ok(Bugs::NONE),
            names => names.split(['+', ',']).try_fold(Bugs::NONE, |bugs, name| {
                Bug::named(name).map(|bug| bugs.with(bug)).ok_or_else(|| name.to_owned())
            }),
        }
    }

    /// The bits that shaders know it by.
    pub(crate) fn bits(self) -> u32 {
        self.0
    }
}

impl FromIterator<Bug> for Bugs {
    fn from_iter<I: IntoIterator<Item = Bug>>(bugs: I) -> Self {
        bugs.into_iter().fold(Bugs::NONE, Bugs::with)
    }
}

impl fmt::Display for Bugs {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Bugs::NONE => f.write_str("none"),
            some => f.write_str(&some.iter().map(Bug::name).collect::<Vec<_>>().join("+")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_all_and_say_something() {
        for (index, (bug, row)) in Bug::ALL.into_iter().zip(ROWS).enumerate() {
            assert_eq!((bug as usize, row.bug), (index, bug));
            assert_eq!(Bug::named(row.name), Some(bug));
            let long_enough = row.title.len() > 5 && row.text.len() > 60 && row.slide.len() > 5;
            assert!(long_enough && row.hint.len() > 30, "{}", row.name);
            assert!(!row.name.contains(['+', ',', '=', ' ']), "{}", row.name);
        }
        assert!(shader_numbers().iter().enumerate().all(|(index, (_, number))| *number == index as f64));
    }

    #[test]
    fn sets_are_read_back_as_they_are_written() {
        let some = Bugs::NONE.with(Bug::WidthTwice).with(Bug::NoCosine);
        assert_eq!(some.to_string(), "no-cosine+width-twice");
        for bugs in [Bugs::NONE, Bugs::ALL, some, Bugs::ALL.without(Bug::Clamped)] {
            assert_eq!(Bugs::parse(&bugs.to_string()), Ok(bugs));
        }
        assert_eq!(Bugs::parse("width-twice,no-cosine"), Ok(some));
        assert_eq!(Bugs::parse("no-cosine+glue"), Err("glue".to_owned()));
        assert_eq!((some.count(), Bugs::ALL.count()), (2, Bug::ALL.len()));
    }
}
