//! What a pane shall be set to, in words: those of the command line, or those that a picture keeps.

use crate::settings::{Kind, Setting, Value, all_of_panes, of_panes};
use crate::{PaneSettings, Technique, TechniqueName};
use scene::Scene;

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

    /// Reads "path,spp=64,bounces=2": a technique, `usual` where none is named, and settings; a word alone is one of a
    /// setting's choices.
    ///
    /// # Errors
    /// The word that is wrong, and what was expected.
    pub fn parse(words: &str, usual: TechniqueName) -> Result<Self, String> {
        let mut words = words.split(',').map(str::trim).peekable();
        let named = words.peek().and_then(|word| TechniqueName::named(word));
        if named.is_some() {
            words.next();
        }
        let mut setup = PaneSetup::of(named.unwrap_or(usual));
        for word in words {
            match word.split_once('=') {
                Some((name, value)) => setup.set(name.trim(), value.trim())?,
                None => setup.choose(word, named.is_none())?,
            }
        }
        setup.check()?;
        Ok(setup)
    }

    /// Takes a setting by its name.
    ///
    /// # Errors
    /// What was expected.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        let technique = self.technique;
        let setting = of_panes(name).filter(|setting| setting.is_of(technique)).ok_or_else(|| {
            let known: Vec<_> = settings_of(technique).map(|setting| setting.name).collect();
            format!("{name} is no setting of {}: expected {}", technique.name(), known.join(", "))
        })?;
        let value = setting.kind.parse(value).map_err(|expected| format!("{name}={value}: expected {expected}"))?;
        self.values.push((setting.name, value));
        Ok(())
    }

    /// Takes the setting whose choice this word is.
    fn choose(&mut self, word: &str, unnamed: bool) -> Result<(), String> {
        let owner = settings_of(self.technique).find(|setting| choices(setting).contains(&word));
        match owner {
            Some(setting) => self.set(setting.name, word),
            None => {
                let known: Vec<_> = settings_of(self.technique).flat_map(choices).copied().collect();
                let techniques = TechniqueName::ALL.map(TechniqueName::name).join(", ");
                let first = if unnamed { format!("a technique ({techniques}), ") } else { String::new() };
                let technique = self.technique.name();
                Err(format!("{word}: expected {first}NAME=VALUE or a choice of {technique} ({})", known.join(", ")))
            }
        }
    }

    /// Whether such a picture can be made.
    ///
    /// # Errors
    /// Why not.
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

fn choices(setting: &Setting<PaneSettings>) -> &'static [&'static str] {
    if let Kind::Choice(words) = setting.kind { words } else { &[] }
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
            ("pth", "pth: expected a technique (raster, whitted, path, normals), NAME=VALUE"),
            ("raster,spp=4", "spp is no setting of raster: expected fake, shading"),
            ("path,branches=4", "bounces"),
            ("path,", ": expected NAME=VALUE"),
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
