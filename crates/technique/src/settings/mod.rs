//! The table of settings: a row says all that there is to say about one. Options, --help, records in pictures, --json,
//! notes of what has no effect and the window's controls are read from it. A new setting is a row in `rows`.

mod control;
mod rows;

pub use control::{Control, Look, capitalised, grouped};
pub use rows::{OF_SCENES, all_of_panes, light_words};

use crate::{PaneSettings, SceneChanges, Technique, TechniqueName, bounces_name, roulette_name};
use image_file::Records;
use pathtrace::{Bugs, LightPaths, Roulette};
use raster::{Repairs, Show};
use scene::Scene;
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A setting of a `T`.
pub struct Setting<T> {
    /// Of the option without dashes, and of the record.
    pub name: &'static str,
    /// The techniques whose pictures it changes.
    pub of: &'static [TechniqueName],
    /// What it may be.
    pub kind: Kind,
    /// Techniques that have fewer choices, and those.
    pub fewer_in: &'static [(&'static [TechniqueName], &'static [&'static str])],
    /// The letter that stands for its value in --help; empty where the choices do.
    pub letter: &'static str,
    /// What it is where nobody says otherwise; `None` for the scene's own.
    pub default: Option<Value>,
    /// What pictures were made with before there was this row, if not the default: what records that lack it mean.
    pub before: Option<Value>,
    /// What a scene has of its own where there is no default.
    pub own: fn(&Scene) -> Option<Value>,
    /// What a scene must have for it to change anything.
    pub needs: Need,
    /// Whether it changes anything beside the other settings, in a scene that has what it needs.
    pub acts: fn(&T, &Scene) -> bool,
    /// What it does, for --help.
    pub help: &'static str,
    /// Whether a picture's file keeps it even where it is the default.
    pub always_recorded: bool,
    /// What it is; `None` for the scene's own.
    pub get: fn(&T) -> Option<Value>,
    /// Takes a value of its kind.
    pub set: fn(&mut T, Value),
    /// How the window shows it.
    pub control: Control,
}

/// What a setting may be.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A number of this range.
    Number(RangeInclusive<f32>),
    /// Degrees from 0 to below this.
    DegreesBelow(f32),
    /// A whole number of this range.
    Whole(RangeInclusive<u32>),
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A whole number, or without limit.
    Bounces,
    /// When paths end early.
    Roulette,
    /// The part of the light that counts, by a name or an expression.
    LightPaths,
    /// Repairs of the fake: names with + between, none or all.
    Repairs,
    /// Bugs of a path tracer: names with + between, or none.
    Bugs,
}

/// A value of a setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// In the unit that the setting states.
    Number(f32),
    /// Of what is counted: bounces, rays, texels.
    Whole(u32),
    /// One of the choices.
    Word(&'static str),
    /// `None` for no limit.
    Bounces(Option<u32>),
    /// When paths end early.
    Roulette(Roulette),
    /// The part of the light that counts.
    LightPaths(LightPaths),
    /// What is repaired of the fake.
    Repairs(Repairs),
    /// What is wrong on purpose.
    Bugs(Bugs),
}

/// What a scene must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Need {
    /// Nothing: it has an effect in any scene.
    Nothing,
    /// A material that is a dielectric.
    Glass,
    /// A mirror, which rough metal is one of for Whitted's trees, or a dielectric.
    Specular,
    /// A sphere that light can be connected through or off.
    Caster,
    /// A shape that is a sphere.
    Spheres,
    /// A sun, however small its disc.
    Sun,
    /// A light that the fake draws a shadow map of.
    ShadowMap,
}

impl Need {
    /// What is missing in this scene, if it is.
    pub fn missing_in(self, scene: &Scene) -> Option<&'static str> {
        let needs = scene.needs();
        let (there, name) = match self {
            Need::Nothing => return None,
            Need::Glass => (needs.dielectric, "glass"),
            Need::Specular => {
                let metal = needs.rough_conductor || needs.metallic_roughness;
                (needs.dielectric || needs.mirror || metal, "mirror, metal or glass")
            }
            Need::Caster => (needs.casters, "sphere of glass or mirror"),
            Need::Spheres => (needs.spheres, "sphere"),
            Need::Sun => (needs.sun, "sun"),
            Need::ShadowMap => (Show::ShadowMap.available(scene), "light that casts shadows in the fake"),
        };
        (!there).then_some(name)
    }
}

impl Kind {
    /// The value that a word says.
    ///
    /// # Errors
    /// What was expected.
    pub fn parse(&self, word: &str) -> Result<Value, String> {
        let value = match self {
            Kind::Number(range) => number(word).filter(|v| range.contains(v)).map(Value::Number),
            Kind::DegreesBelow(most) => number(word).filter(|v| (0.0..*most).contains(v)).map(Value::Number),
            Kind::Whole(range) => word.trim().parse().ok().filter(|v| range.contains(v)).map(Value::Whole),
            Kind::Choice(words) => words.iter().find(|known| **known == word).map(|known| Value::Word(known)),
            Kind::Bounces if word == "inf" => Some(Value::Bounces(None)),
            Kind::Bounces => word.parse().ok().map(|n| Value::Bounces(Some(n))),
            Kind::Roulette => roulette(word).map(Value::Roulette),
            Kind::LightPaths => return rows::light_paths(word),
            Kind::Repairs => Repairs::parse(word).ok().map(Value::Repairs),
            Kind::Bugs => Bugs::parse(word).ok().map(Value::Bugs),
        };
        value.ok_or_else(|| self.expected())
    }

    fn expected(&self) -> String {
        match self {
            Kind::Number(range) => format!("a number from {} to {}", range.start(), range.end()),
            Kind::DegreesBelow(most) => format!("degrees from 0 to below {most}"),
            Kind::Whole(range) if *range.end() == u32::MAX => {
                format!("a whole number from {} to {}", range.start(), range.end())
            }
            Kind::Whole(range) => format!("a number from {} to {}", range.start(), range.end()),
            Kind::Choice(words) => match words {
                [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
                words => words.concat(),
            },
            Kind::Bounces => format!("a whole number from 0 to {} or inf", u32::MAX),
            Kind::Roulette => "a probability above 0 and at most 1, throughput, both as P+throughput, or off".into(),
            Kind::LightPaths => rows::LIGHT_PATHS.into(),
            Kind::Repairs => format!("none, all, or some of {} with + between", Repairs::names().join(", ")),
            Kind::Bugs => format!("none, or some of {} with + between", Bugs::names().join(", ")),
        }
    }

    /// Its bounds, where --help tells them.
    fn range(&self) -> Option<String> {
        match self {
            Kind::Number(range) => Some(format!("{} to {}", range.start(), range.end())),
            Kind::Whole(range) if *range.end() < u32::MAX => Some(format!("{} to {}", range.start(), range.end())),
            _ => None,
        }
    }
}

fn number(word: &str) -> Option<f32> {
    f32::from_str(word.trim()).ok().filter(|v| v.is_finite())
}

/// "off", "throughput", a probability, or both as "0.8+throughput".
fn roulette(word: &str) -> Option<Roulette> {
    let probability = |word: &str| number(word).filter(|p| *p > 0.0 && *p <= 1.0);
    let (first, throughput) = word.strip_suffix("+throughput").map_or((word, false), |first| (first, true));
    match word {
        "off" => Some(Roulette::OFF),
        "throughput" => Some(Roulette::THROUGHPUT),
        _ => probability(first).map(|p| Roulette { probability: Some(p), throughput }),
    }
}

impl fmt::Display for Value {
    /// As it is read back.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Value::Number(number) => number.fmt(f),
            Value::Whole(number) => number.fmt(f),
            Value::Word(word) => f.write_str(word),
            Value::Bounces(bounces) => f.write_str(&bounces_name(*bounces)),
            Value::Roulette(roulette) => f.write_str(&roulette_name(*roulette)),
            Value::LightPaths(paths) => paths.fmt(f),
            Value::Repairs(repairs) => repairs.fmt(f),
            Value::Bugs(bugs) => bugs.fmt(f),
        }
    }
}

impl<T> Setting<T> {
    /// The option: "--depth N".
    pub fn usage(&self) -> String {
        match &self.kind {
            Kind::Choice(words) if self.letter.is_empty() => format!("--{} {}", self.name, words.join("|")),
            _ => format!("--{} {}", self.name, self.letter),
        }
    }

    /// What it may be among the settings of a technique.
    pub fn kind_in(&self, technique: TechniqueName) -> Kind {
        let fewer = self.fewer_in.iter().find(|(techniques, _)| techniques.contains(&technique));
        fewer.map_or_else(|| self.kind.clone(), |(_, words)| Kind::Choice(words))
    }

    /// What it does, its bounds and its default.
    pub fn description(&self) -> String {
        let range = self.kind.range().map_or_else(String::new, |range| format!(", {range}"));
        let default = self.default.map_or_else(|| "the scene's".into(), |value| value.to_string());
        format!("{}{range} (default {default})", self.help)
    }

    /// Whether it changes pictures of this technique.
    pub fn is_of(&self, technique: TechniqueName) -> bool {
        self.of.contains(&technique)
    }

    /// What a picture's label calls a value of it: "16 spp", "seed 2".
    pub fn brief(&self, value: Value) -> String {
        let name_and_value = || format!("{} {value}", self.name.replace('-', " "));
        self.control.brief.map_or_else(name_and_value, |brief| brief(value))
    }

    /// What a file keeps of it.
    fn record(&self, of: &T) -> Option<(&'static str, Value)> {
        let value = (self.get)(of)?;
        (self.always_recorded || Some(value) != self.default).then_some((self.name, value))
    }
}

/// The setting of this name.
pub fn of_panes(name: &str) -> Option<&'static Setting<PaneSettings>> {
    all_of_panes().find(|setting| setting.name == name)
}

/// What the options of a picture's records leave unsaid because they are older than a row: settings that this technique
/// has, with what they were before.
pub fn unsaid_of_old<'a>(
    technique: TechniqueName,
    is_said: impl Fn(&str) -> bool + 'a,
) -> impl Iterator<Item = (&'static str, Value)> + 'a {
    let unsaid = move |setting: &&Setting<PaneSettings>| setting.is_of(technique) && !is_said(setting.name);
    all_of_panes().filter(unsaid).filter_map(|setting| Some((setting.name, setting.before?)))
}

/// The setting of this name.
pub fn of_scenes(name: &str) -> Option<&'static Setting<SceneChanges>> {
    OF_SCENES.iter().find(|setting| setting.name == name)
}

/// The option, and the record, of what is changed in a scene part by part: the text of [`Edits`](scene::edit::Edits).
pub const EDIT: &str = "edit";

impl Technique {
    /// Its settings with their values, as far as a file keeps them; `spp` is what the picture has.
    pub fn values(&self, spp: u32) -> Vec<(&'static str, Value)> {
        let pane = PaneSettings::from(self.with_spp(spp));
        all_of_panes()
            .filter(|setting| setting.is_of(self.name()))
            .filter_map(|setting| setting.record(&pane))
            .collect()
    }

    /// The options of `visavis render` that say how, by their names without dashes.
    pub fn options(&self, spp: u32) -> Records {
        self.values(spp).into_iter().map(|(name, value)| (name, value.to_string())).collect()
    }

    fn with_spp(mut self, wished: u32) -> Self {
        if let Technique::Traced(traced) = &mut self {
            traced.spp = wished;
        }
        self
    }
}

impl SceneChanges {
    /// What was changed, by the options' names without dashes. What was not is the scene's, and may differ from glass
    /// to glass. What is changed part by part comes last.
    pub fn options(&self) -> Records {
        self.options_where(|_| true)
    }

    /// Those that this technique sees; parts are for all.
    pub fn options_of(&self, technique: TechniqueName) -> Records {
        self.options_where(|setting| setting.is_of(technique))
    }

    fn options_where(&self, wanted: impl Fn(&Setting<SceneChanges>) -> bool) -> Records {
        let changed = OF_SCENES.iter().filter(|setting| wanted(setting)).filter_map(|setting| setting.record(self));
        let edits = Some((EDIT, self.edits.to_string())).filter(|_| !self.edits.is_empty());
        changed.map(|(name, value)| (name, value.to_string())).chain(edits).collect()
    }
}

impl SceneChanges {
    /// Leaves a number to the scene again.
    pub fn reset(&mut self, setting: &Setting<SceneChanges>) {
        let others = OF_SCENES.iter().filter(|other| other.name != setting.name);
        let fresh = set_again(SceneChanges::default(), others, self);
        *self = SceneChanges { edits: self.edits.clone(), ..fresh };
    }
}

/// All of these as `of` has them.
fn set_again<'a, T: 'a>(mut fresh: T, settings: impl Iterator<Item = &'a Setting<T>>, of: &T) -> T {
    for setting in settings {
        if let Some(value) = (setting.get)(of) {
            (setting.set)(&mut fresh, value);
        }
    }
    fresh
}

/// Rows of what is shown in place of light: all others change light alone.
const OF_FEATURES: [&str; 6] = ["show", "spp", "sampler", "seed", "segments", "traced-sun"];

impl PaneSettings {
    /// Whether a row changes the picture of `scene` beside the other settings.
    pub fn is_changed_by(&self, row: &Setting<PaneSettings>, scene: &Scene) -> bool {
        let acts = self.in_use().feature().is_none() || OF_FEATURES.contains(&row.name);
        row.is_of(self.technique) && row.needs.missing_in(scene).is_none() && acts && (row.acts)(self, scene)
    }

    /// Makes a setting of the technique in use what a new pane has, or the scene's own.
    pub fn reset(&mut self, setting: &Setting<PaneSettings>) {
        let others = all_of_panes().filter(|other| other.name != setting.name && other.is_of(self.technique));
        let fresh = set_again(PaneSettings::of(self.technique), others, self);
        self.take_settings_in_use(&fresh);
    }

    /// Takes a value for the technique in use; the others are found as they were left.
    pub fn set(&mut self, setting: &Setting<PaneSettings>, value: Value) {
        let mut told = *self;
        (setting.set)(&mut told, value);
        self.take_settings_in_use(&told);
    }

    /// Takes what `other` has set for the technique that it uses.
    pub fn take_settings_in_use(&mut self, other: &PaneSettings) {
        match other.technique {
            TechniqueName::Raster => self.fake = other.fake,
            TechniqueName::Whitted => self.whitted = other.whitted,
            TechniqueName::Path => self.truth = other.truth,
            TechniqueName::Photon => self.photon = other.photon,
            TechniqueName::LightTracing => self.light = other.light,
            TechniqueName::Metropolis => self.metropolis = other.metropolis,
            TechniqueName::Normals => self.normals = other.normals,
        }
        if rows::LIGHT.contains(&other.technique) {
            (self.denoise, self.runs, self.feature) = (other.denoise, other.runs, other.feature);
        }
    }
}

#[cfg(test)]
mod tests;
