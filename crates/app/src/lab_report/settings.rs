//! The tables of settings: those that say something, and all.

use super::LabReport;
use scene::Scene;
use scene::edit::Edits;
use technique::PaneSettings;
use technique::settings::{EDIT, OF_SCENES, Setting, all_of_panes};

const OF_EDITS: &str = "what is changed in the scene part by part";

/// A setting and what it is in each picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// As options and sessions call it.
    pub name: &'static str,
    /// In the order of the pictures; `None` where it changes nothing.
    pub values: Vec<Option<String>>,
    /// What it would be in each where nobody says otherwise.
    pub usual: Vec<Option<String>>,
    /// What the setting does, as `--help` says it.
    pub help: &'static str,
}

impl Row {
    /// Whether it is not as usual in a picture, or not the same in all.
    pub fn says_something(&self) -> bool {
        let stated = || self.values.iter().zip(&self.usual).filter(|(value, _)| value.is_some());
        let first = stated().next().map(|(value, _)| value);
        stated().any(|(value, usual)| value != usual || Some(value) != first)
    }

    /// What it usually is, of techniques that differ in that one after the other.
    pub fn usual_words(&self) -> String {
        let mut words: Vec<&str> = self.usual.iter().flatten().map(String::as_str).collect();
        words.dedup();
        words.join(", ")
    }
}

impl LabReport {
    /// All settings that change one of the pictures.
    pub(super) fn rows(&self) -> Vec<Row> {
        let settings = |picture: &super::ReportedPicture| picture.provenance.technique.into();
        let made_here =
            |picture: &super::ReportedPicture| Some(settings(picture)).filter(|_| picture.external.is_none());
        let panes: Vec<Option<PaneSettings>> = self.pictures.iter().map(made_here).collect();
        let scene = self.pictures.first().map_or(&self.scene, |picture| &picture.provenance.shot.scene);
        let of_panes = all_of_panes().map(|row| row_of(row, &panes, scene));
        let rows = self.changes().into_iter().chain(of_panes);
        rows.filter(|row| row.values.iter().any(Option::is_some)).collect()
    }

    /// What is changed in the scene, for all pictures alike.
    fn changes(&self) -> Vec<Row> {
        let of = |row: &'static Setting<_>| {
            let value = |picture: &super::ReportedPicture| {
                (row.get)(&picture.provenance.shot.changes).map(|value| value.to_string())
            };
            let usual = vec![(row.own)(&self.scene).map(|value| value.to_string()); self.pictures.len()];
            Row { name: row.name, values: self.pictures.iter().map(value).collect(), usual, help: row.help }
        };
        let edits = |picture: &super::ReportedPicture| {
            Some(picture.provenance.shot.changes.edits.to_string())
                .filter(|edits| *edits != Edits::default().to_string())
        };
        let values = self.pictures.iter().map(edits).collect();
        let edits = Row { name: EDIT, values, usual: vec![None; self.pictures.len()], help: OF_EDITS };
        OF_SCENES.iter().map(of).chain([edits]).collect()
    }
}

fn row_of(row: &'static Setting<PaneSettings>, panes: &[Option<PaneSettings>], scene: &Scene) -> Row {
    let in_words = |pane: &PaneSettings| (row.get)(pane).or_else(|| (row.own)(scene)).map(|value| value.to_string());
    let acts = |pane: &&PaneSettings| pane.is_changed_by(row, scene);
    let usual = |pane: &PaneSettings| {
        let mut fresh = PaneSettings::of(pane.technique);
        fresh.take_usual_estimator(scene);
        in_words(&fresh)
    };
    let of = |words: &dyn Fn(&PaneSettings) -> Option<String>| {
        panes.iter().map(|pane| pane.as_ref().filter(acts).and_then(words)).collect()
    };
    Row { name: row.name, values: of(&in_words), usual: of(&usual), help: row.help }
}
