//! A session as text, and back: names and words rather than the shapes of types, and the settings of techniques by their
//! table, so that a setting that comes to the table comes to sessions too.

use super::{PaneId, Panes};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use technique::settings::{all_of_panes, of_panes};
use technique::{DeviceChoice, PaneSettings, TechniqueName};

impl Serialize for PaneId {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for PaneId {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        PaneId::named(&name)
            .ok_or_else(|| D::Error::custom(format!("{name} is no pane: expected a letter from A to Z")))
    }
}

/// A pane's settings in words: those of each technique, so that coming back to one finds them again.
#[derive(Serialize, Deserialize)]
struct SavedPane {
    technique: String,
    device: String,
    adapter: u8,
    settings: BTreeMap<String, BTreeMap<String, String>>,
}

impl SavedPane {
    fn of(pane: &PaneSettings) -> Self {
        let words = |technique| {
            let pane = PaneSettings { technique, ..*pane };
            let settings = all_of_panes().filter(|setting| setting.is_of(technique));
            let words =
                settings.filter_map(|setting| Some((setting.name.to_owned(), (setting.get)(&pane)?.to_string())));
            (technique.name().to_owned(), words.collect())
        };
        SavedPane {
            technique: pane.technique.name().to_owned(),
            device: pane.device.name().to_owned(),
            adapter: pane.adapter,
            settings: TechniqueName::ALL.map(words).into(),
        }
    }

    fn settings(&self) -> Result<PaneSettings, String> {
        let device = DeviceChoice::named(&self.device).ok_or_else(|| format!("{} is no device", self.device))?;
        let mut pane =
            PaneSettings { device, adapter: self.adapter, ..PaneSettings::of(technique_of(&self.technique)?) };
        for (name, words) in &self.settings {
            let technique = technique_of(name)?;
            let mut told = PaneSettings::of(technique);
            for (name, word) in words {
                let setting = of_panes(name).ok_or_else(|| format!("{name} is no setting"))?;
                let value = setting
                    .kind_in(technique)
                    .parse(word)
                    .map_err(|expected| format!("{name} {word}: expected {expected}"))?;
                (setting.set)(&mut told, value);
            }
            pane.take_settings_in_use(&told);
        }
        Ok(pane)
    }
}

fn technique_of(name: &str) -> Result<TechniqueName, String> {
    TechniqueName::named(name).ok_or_else(|| format!("{name} is no technique"))
}

/// The settings of all panes.
pub mod panes {
    use super::*;

    pub fn serialize<S: Serializer>(panes: &Panes<PaneSettings>, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(panes.iter().map(|(id, pane)| (id, SavedPane::of(pane))))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Panes<PaneSettings>, D::Error> {
        let saved = BTreeMap::<PaneId, SavedPane>::deserialize(deserializer)?;
        let settings = |(id, pane): (PaneId, SavedPane)| Ok((id, pane.settings().map_err(D::Error::custom)?));
        saved.into_iter().map(settings).collect()
    }
}

/// A display transform, by its exposure in stops.
pub mod display {
    use super::*;
    use film::DisplayTransform;

    pub fn serialize<S: Serializer>(display: &DisplayTransform, serializer: S) -> Result<S::Ok, S::Error> {
        display.exposure.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DisplayTransform, D::Error> {
        f32::deserialize(deserializer).map(|exposure| DisplayTransform { exposure })
    }
}

/// A measure of errors, by its name.
pub mod metric {
    use super::*;
    use compare::ErrorMetric;

    pub fn serialize<S: Serializer>(metric: &ErrorMetric, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(metric.name())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<ErrorMetric, D::Error> {
        let name = String::deserialize(deserializer)?;
        ErrorMetric::named(&name).ok_or_else(|| D::Error::custom(format!("{name} is no measure of errors")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{CompareWith, Resolution, Session, View};
    use compare::ErrorMetric;
    use pathtrace::{Estimator, Roulette};

    fn changed() -> Session {
        let mut session = Session::default();
        let a = &mut session.panes[PaneId::A];
        (a.technique, a.device, a.adapter) = (TechniqueName::Whitted, DeviceChoice::Gpu, 1);
        (a.whitted.spp, a.whitted.tree.ambient) = (3, Some(0.1));
        (a.fake.knobs.segments, a.fake.reflectivity) = (Some(7), Some(1.0 / 3.0));
        let truth = &mut session.panes[PaneId::B].truth;
        (truth.spp, truth.path.seed, truth.path.bounces) = (1000, 9, Some(4));
        (truth.path.roulette, truth.path.estimator) =
            (Roulette { probability: Some(0.7), throughput: true }, Estimator::COSINE);
        session.display.exposure = 0.1;
        (session.resolution, session.view, session.wipe) = (Resolution::Half, View::Pane(PaneId::B), 0.25);
        let comparison = &mut session.comparison;
        (comparison.with, comparison.of, comparison.metric) = (CompareWith::Reference, PaneId::B, ErrorMetric::Flip);
        comparison.held[0] = Some(0.3);
        session
    }

    #[test]
    fn a_session_comes_back_as_it_was() {
        for session in [Session::default(), changed()] {
            let text = serde_json::to_string(&session).unwrap();
            assert_eq!(serde_json::from_str::<Session>(&text).unwrap(), session, "{text}");
        }
    }

    #[test]
    fn what_a_session_cannot_mean_is_told() {
        let text = serde_json::to_string(&Session::default()).unwrap();
        for (word, wrong, said) in [
            ("\"A\":", "\"a\":", "a is no pane"),
            ("\"spp\":\"256\"", "\"spp\":\"many\"", "spp many: expected a whole number"),
            ("\"estimator\":\"light\"", "\"estimate\":\"light\"", "estimate is no setting"),
        ] {
            assert!(text.contains(word), "{word} is not in {text}");
            let fault = serde_json::from_str::<Session>(&text.replacen(word, wrong, 1)).unwrap_err().to_string();
            assert!(fault.contains(said), "{fault}");
        }
    }
}
