//! What a pane shall be set to, in words: those of the command line, or those that a picture keeps.

use crate::settings::{Kind, Setting, Value, all_of_panes, of_panes};
use crate::{PaneSettings, Preset, Technique, TechniqueName, presets};
use scene::{Scene, nearest_or_begun};

/// A technique, and those of its settings that are no defaults.
#[derive(Debug, Clone, PartialEq)]
pub struct PaneSetup {
    technique: TechniqueName,
    /// By the names of the table.
    values: Vec<(&'static str, Value)>,
}

impl PaneSetup {
    /// This technique with its defaults.
    pub fn of(technique: TechniqueName) -> Self {
        PaneSetup { technique, values: Vec::new() }
    }

    /// The technique of a preset, with what it states.
    pub fn of_preset(preset: &Preset) -> Self {
        let values = preset.values().map(|(setting, value)| (setting.name, value)).collect();
        PaneSetup { technique: preset.technique, values }
    }

    /// Reads "path,spp=64,bounces=2": a technique or a preset, `usual` where none is named, and settings; a word alone is
    /// one of a setting's choices. What is said changes a preset.
    ///
    /// # Errors
    /// The word that is wrong, and what was expected.
    pub fn parse(words: &str, usual: TechniqueName) -> Result<Self, String> {
        let words: Vec<&str> = words.split(',').map(str::trim).collect();
        let named = TechniqueName::named(words[0]).map(PaneSetup::of);
        let named = named.or_else(|| Preset::named(words[0]).map(PaneSetup::of_preset));
        let first = usize::from(named.is_some());
        let mut setup = named.unwrap_or(PaneSetup::of(usual));
        let mut said: Vec<(&str, &str)> = Vec::new();
        for (i, word) in words.iter().enumerate().skip(first) {
            let before = words[..i].last().copied().unwrap_or_default();
            let name = setup.take(word, i == 0).map_err(|fault| fault + &decimal_comma(before, word))?;
            if let Some((_, other)) = said.iter().find(|(other, _)| *other == name) {
                return Err(format!("{other} and {word} both say {name}: leave one of them"));
            }
            said.push((name, word));
        }
        setup.check()?;
        Ok(setup)
    }

    /// Takes NAME=VALUE or a choice. Returns the setting's name.
    fn take(&mut self, word: &str, may_name: bool) -> Result<&'static str, String> {
        match word.split_once('=') {
            Some((name, value)) => self.take_value(name.trim(), value.trim()),
            None => self.choose(word, may_name),
        }
    }

    /// Takes a setting by its name.
    ///
    /// # Errors
    /// If the table has no such name, or the value is none of it: what was expected.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        self.take_value(name, value).map(|_| ())
    }

    fn take_value(&mut self, name: &str, value: &str) -> Result<&'static str, String> {
        let technique = self.technique;
        let setting = of_panes(name).filter(|setting| setting.is_of(technique)).ok_or_else(|| {
            let known: Vec<_> = settings_of(technique).map(|setting| setting.name).collect();
            let meant = did_you_mean(name, known.iter().copied());
            format!("{name} is no setting of {}: expected {}{meant}", technique.name(), known.join(", "))
        })?;
        let value = setting.kind_in(technique).parse(value).map_err(|expected| {
            let meant = did_you_mean(value, choices(setting, technique).iter().copied());
            format!("{name}={value}: expected {expected}{meant}")
        })?;
        self.values.push((setting.name, value));
        Ok(setting.name)
    }

    /// Takes the setting whose choice this word is.
    fn choose(&mut self, word: &str, may_name: bool) -> Result<&'static str, String> {
        let owner = settings_of(self.technique).find(|setting| choices(setting, self.technique).contains(&word));
        match owner {
            Some(setting) => self.take_value(setting.name, word),
            None => Err(self.no_choice(word, may_name)),
        }
    }

    /// What was expected in a word's place.
    fn no_choice(&self, word: &str, may_name: bool) -> String {
        let technique = self.technique.name();
        let choices = |setting| choices(setting, self.technique);
        let known: Vec<_> = settings_of(self.technique).flat_map(choices).copied().collect();
        let names = TechniqueName::ALL.map(TechniqueName::name);
        let presets = || presets::ALL.iter().map(|preset| preset.name);
        let first = match may_name {
            true => {
                format!("a technique ({}), a preset ({}), ", names.join(", "), presets().collect::<Vec<_>>().join(", "))
            }
            false => String::new(),
        };
        let hint = if names.contains(&word) || Preset::named(word).is_some() {
            format!("; {word} stands first or not at all")
        } else if let Some(setting) = self.owner_of(word) {
            format!("; did you mean {}={word}?", setting.name)
        } else {
            let settings = settings_of(self.technique).map(|setting| setting.name);
            let firsts = names.into_iter().chain(presets()).filter(|_| may_name);
            did_you_mean(word, known.iter().copied().chain(settings).chain(firsts))
        };
        let what = if word.is_empty() { "a word is empty" } else { word };
        format!("{what}: expected {first}NAME=VALUE or a choice of {technique} ({}){hint}", known.join(", "))
    }

    /// The setting that is no choice between words, but may be this one: "off", "inf".
    fn owner_of(&self, word: &str) -> Option<&'static Setting<PaneSettings>> {
        let is_word = word.starts_with(char::is_alphabetic);
        settings_of(self.technique).find(|setting| is_word && setting.kind_in(self.technique).parse(word).is_ok())
    }

    /// Whether such a picture can be made.
    ///
    /// # Errors
    /// If these settings make no picture: why not.
    pub fn check(&self) -> Result<(), String> {
        let mut pane = PaneSettings::of(self.technique);
        self.give_to(&mut pane);
        match pane.in_use() {
            Technique::Traced(traced) => traced.integrator.check().map_err(|fault| fault.to_string()),
            Technique::Fake(_) => Ok(()),
        }
    }

    /// Sets a pane to it. What is not said is as in a new pane for this scene; other techniques keep their settings.
    pub fn apply(&self, pane: &mut PaneSettings, scene: &Scene) {
        pane.technique = self.technique;
        let mut usual = PaneSettings::of(self.technique);
        usual.take_usual_estimator(scene);
        pane.take_settings_in_use(&usual);
        self.give_to(pane);
    }

    /// Sets a pane to its technique with what is said; what is not said stays.
    pub fn add_to(&self, pane: &mut PaneSettings) {
        pane.technique = self.technique;
        self.give_to(pane);
    }

    fn give_to(&self, pane: &mut PaneSettings) {
        for (name, value) in &self.values {
            if let Some(setting) = of_panes(name) {
                pane.set(setting, *value);
            }
        }
    }
}

fn settings_of(technique: TechniqueName) -> impl Iterator<Item = &'static Setting<PaneSettings>> {
    all_of_panes().filter(move |setting| setting.is_of(technique))
}

/// Words of which nobody knows by themselves what is on or off.
const OF_SWITCHES: [&str; 4] = ["on", "off", "auto", "all"];

/// The words that say by themselves which setting they are of: not those of a choice that has words of switches.
fn choices(setting: &Setting<PaneSettings>, technique: TechniqueName) -> &'static [&'static str] {
    match setting.kind_in(technique) {
        Kind::Choice(words) if words.iter().any(|word| OF_SWITCHES.contains(word)) => &[],
        Kind::Choice(words) => words,
        _ => &[],
    }
}

fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest_or_begun(word, known).map_or(String::new(), |name| format!("; did you mean {name}?"))
}

/// What to write instead of "sun=0,7", whose comma parts two words.
fn decimal_comma(before: &str, word: &str) -> String {
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let whole = before.split_once('=').map_or("", |(_, value)| value.trim_start_matches('-'));
    let is_meant = digits(whole) && digits(word);
    if is_meant { format!("; numbers have a decimal point: write {before}.{word}") } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathtrace::Estimator;
    use raster::Fake;

    fn pane_of(words: &str) -> PaneSettings {
        let mut pane = PaneSettings::of(TechniqueName::Raster);
        let scene = scene::builtin::named("cornell").expect("a built-in scene");
        PaneSetup::parse(words, TechniqueName::Path).expect(words).apply(&mut pane, &scene);
        pane
    }

    #[test]
    fn words_are_a_technique_its_choices_and_settings_by_name() {
        let fake = pane_of("raster,as-taught,segments=7").fake;
        assert_eq!((fake.fake, fake.knobs.segments), (Fake::AsTaught, Some(7)));
        let truth = pane_of("path,spp=64, bounces=2,mis,branches=3");
        assert_eq!((truth.truth.spp, truth.truth.path.bounces, truth.truth.path.branches), (64, Some(2), 3));
        assert_eq!((truth.technique, truth.truth.path.estimator), (TechniqueName::Path, Estimator::MIS));
        assert_eq!(pane_of("spp=3").truth.spp, 3, "the usual technique where none is named");
    }

    #[test]
    fn a_preset_is_a_first_word_and_is_changed_by_what_follows() {
        let scene = scene::builtin::named("cornell").expect("a built-in scene");
        for preset in presets::ALL {
            let (said, mut applied) = (pane_of(preset.name), PaneSettings::of(preset.technique));
            applied.take_usual_estimator(&scene);
            let usual = applied.truth.path.estimator;
            preset.apply(&mut applied);
            if preset.values().all(|(setting, _)| setting.name != "estimator") {
                applied.truth.path.estimator = usual;
            }
            assert_eq!(said.in_use(), applied.in_use(), "{}", preset.name);
        }
        let truth = pane_of("2e-0-bounces,spp=64").truth;
        assert_eq!((truth.spp, truth.path.bounces), (64, Some(0)));
    }

    #[test]
    fn every_setting_of_every_technique_is_taken_by_its_name() {
        for technique in TechniqueName::ALL {
            for setting in settings_of(technique) {
                let Some(value) = setting.default else { continue };
                let words = format!("{},{}={value}", technique.name(), setting.name);
                assert!(PaneSetup::parse(&words, technique).is_ok(), "{words}");
            }
        }
    }

    #[test]
    fn a_wrong_word_is_named_with_what_was_expected() {
        for (words, said) in [
            ("path,spp=many", "spp=many: expected a whole number"),
            ("path,fair", "fair: expected NAME=VALUE or a choice of path (independent, sobol, "),
            (
                "pth",
                "pth: expected a technique (raster, whitted, path, photon, light-tracing, metropolis, normals), a preset (as-taught, fair, ",
            ),
            ("pth", "; did you mean path?"),
            ("2e-0-bounce", "; did you mean 2e-0-bounces?"),
            ("path,2e-0-bounces", "; 2e-0-bounces stands first or not at all"),
            ("spp=4,path", "; path stands first or not at all"),
            ("path,sampp=4", "; did you mean sampler?"),
            ("path,Light", "; did you mean light?"),
            ("path,sampler=Sobol", "; did you mean sobol?"),
            ("path,throughput", "; did you mean roulette=throughput?"),
            ("path,off", "; did you mean roulette=off?"),
            ("path,auto", "; did you mean cones=auto?"),
            ("path,all", "; did you mean cones=all?"),
            ("path,on", "; did you mean connections=on?"),
            ("path,inf", "; did you mean bounces=inf?"),
            ("whitted,traced-sun=0,7", "; numbers have a decimal point: write traced-sun=0.7"),
            ("", "a word is empty: expected a technique"),
            ("raster,,fair", "a word is empty: expected NAME=VALUE"),
            ("raster,fair,as-taught", "fair and as-taught both say fake: leave one of them"),
            ("spp=4,spp=5", "spp=4 and spp=5 both say spp: leave one of them"),
            ("path,mis,estimator=light", "mis and estimator=light both say estimator: leave one of them"),
            ("raster,spp=4", "spp is no setting of raster: expected fake, repairs, texture-filter"),
            ("path,branches=4", "bounces"),
            ("path,", "a word is empty: expected NAME=VALUE"),
        ] {
            let fault = PaneSetup::parse(words, TechniqueName::Path).expect_err(words);
            assert!(fault.contains(said), "{words}: {fault}");
        }
    }

    #[test]
    fn what_is_not_said_is_as_in_a_new_pane() {
        let scene = scene::builtin::named("cornell").expect("a built-in scene");
        let mut pane = PaneSettings::of(TechniqueName::Path);
        (pane.truth.spp, pane.truth.path.seed, pane.whitted.spp) = (5, 9, 7);
        PaneSetup::parse("path,seed=3", TechniqueName::Path).expect("words").apply(&mut pane, &scene);
        let new = PaneSettings::of(TechniqueName::Path);
        assert_eq!((pane.truth.spp, pane.truth.path.seed, pane.whitted.spp), (new.truth.spp, 3, 7));
    }
}
