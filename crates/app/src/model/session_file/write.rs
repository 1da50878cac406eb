//! A session as the text of its file.

use super::{MOST_BOOKMARKS, SESSION_VERSION, SavedSession, ladder};
use crate::model::{
    Axis, COMPARE, ComparisonSettings, PaneId, PaneSource, PlotSettings, ProbeSettings, Region, Session, SweepSettings,
    TreesSettings,
};
use compare::ErrorMetric;
use image_file::shown;
use scene::edit::quoted;
use scene::{Camera, Scene, Vec3};
use std::fmt::Write;
use technique::settings::{EDIT, OF_SCENES, Value, all_of_panes};
use technique::{DeviceChoice, PaneSettings, TechniqueName};

impl SavedSession {
    /// The file's text; `source` is the scene's built-in name, or its file as the session's folder finds it.
    pub fn text(&self, scene: &Scene, source: &str) -> String {
        let mut text = format!(
            "# A session of Visavis, which is opened as scenes are. What is left out is as in a new window.\n\
             session = {SESSION_VERSION}\nscene = {}\nscene_hash = {}\n",
            quoted(source),
            quoted(&scene.as_read.to_string())
        );
        table(&mut text, "[camera]", camera(&self.camera, scene));
        let changes = OF_SCENES.iter().filter_map(|row| Some((row.name, (row.get)(&self.changes)?)));
        let edits = Some((EDIT, self.changes.edits.to_string())).filter(|_| !self.changes.edits.is_empty());
        let changes = changes.map(|(name, value)| (name, word(value))).chain(edits);
        table(&mut text, "[scene_changes]", changes.collect());
        table(&mut text, "[view]", self.view());
        for (id, pane) in self.session.panes.iter() {
            panes(&mut text, (id, pane), self.session.source(id), scene);
        }
        comparison(&mut text, &self.session.comparison);
        table(&mut text, "[plots]", plots(self.session.plots));
        table(&mut text, "[sweep]", sweep(&self.session.sweep));
        table(&mut text, "[ladder]", ladder::lines(&self.session.ladder));
        table(&mut text, "[trees]", trees(self.session.trees));
        table(&mut text, "[probe]", probe(self.session.probe));
        // the latest
        for place in &self.bookmarks[self.bookmarks.len().saturating_sub(MOST_BOOKMARKS)..] {
            table(&mut text, "[[bookmarks]]", camera(place, scene));
        }
        table(&mut text, "[window]", self.window());
        text
    }

    fn view(&self) -> Lines {
        let Session { workspace, view, line, wipe, display, resolution, .. } = &self.session;
        let mut lines = vec![("show", quoted(view.word()))];
        lines.extend((*workspace != COMPARE).then(|| ("workspace", quoted(workspace))));
        if self.line_placed {
            lines.extend([("line", quoted(line.name())), ("line_at", number(*wipe))]);
        }
        lines.extend([("exposure", number(display.exposure)), ("resolution", quoted(resolution.name()))]);
        lines
    }

    fn window(&self) -> Lines {
        let window = &self.window;
        let size = window.size.map(|[width, height]| ("size", format!("[{}, {}]", width.round(), height.round())));
        let flags = [("panel", window.panel), ("labels", window.labels)];
        let flags = flags.into_iter().filter_map(|(name, flag)| Some((name, flag?.to_string())));
        size.into_iter().chain(window.theme.map(|theme| ("theme", quoted(theme.name())))).chain(flags).collect()
    }
}

/// Keys and what stands behind them.
pub type Lines = Vec<(&'static str, String)>;

fn table(text: &mut String, header: &str, lines: Lines) {
    if lines.is_empty() {
        return;
    }
    // writing to a text does not fail
    let _ = writeln!(text, "\n{header}");
    for (key, value) in lines {
        let _ = writeln!(text, "{key} = {value}");
    }
}

/// Which way is up is left to the scene where its own camera says the same.
fn camera(camera: &Camera, scene: &Scene) -> Lines {
    let point = |Vec3 { x, y, z }| format!("[{}, {}, {}]", number(x), number(y), number(z));
    let up = (camera.up != scene.camera.up).then(|| ("up", point(camera.up)));
    let place = [("eye", point(camera.eye)), ("target", point(camera.target)), ("fov", number(camera.fov_y))];
    place.into_iter().chain(up).collect()
}

/// The settings of a pane that are not a new one's, those of the technique in use first. What several techniques share
/// stands under the first of them alone.
fn panes(text: &mut String, (id, pane): (PaneId, &PaneSettings), source: &PaneSource, scene: &Scene) {
    let mut told = super::new_pane(id, scene);
    let mut lines = vec![("technique", quoted(pane.technique.name()))];
    if pane.device != DeviceChoice::default() {
        lines.push(("device", quoted(pane.device.name())));
    }
    if pane.adapter != 0 {
        lines.push(("adapter", pane.adapter.to_string()));
    }
    match source {
        PaneSource::Made => {}
        PaneSource::Received(port) => lines.push(("received", port.to_string())),
        PaneSource::Followed(file) => lines.push(match file.to_str() {
            Some(file) => ("picture", quoted(file)),
            None => ("# picture, whose name is no text in UTF-8", quoted(&shown(file))),
        }),
    }
    lines.extend(unlike(pane, &mut told, pane.technique));
    table(text, &format!("[panes.{id}]"), lines);
    for technique in TechniqueName::ALL.into_iter().filter(|other| *other != pane.technique) {
        let lines = unlike(pane, &mut told, technique);
        table(text, &format!("[panes.{id}.{}]", technique.name()), lines);
    }
}

/// The settings of a technique that are others than those that were `told`, which takes them.
fn unlike(pane: &PaneSettings, told: &mut PaneSettings, technique: TechniqueName) -> Lines {
    let pane = PaneSettings { technique, ..*pane };
    told.technique = technique;
    let mut lines = Vec::new();
    for row in all_of_panes().filter(|row| row.is_of(technique)) {
        let value = (row.get)(&pane).filter(|value| Some(*value) != (row.get)(told));
        if let Some(value) = value {
            told.set(row, value);
            lines.push((row.name, word(value)));
        }
    }
    lines
}

fn comparison(text: &mut String, comparison: &ComparisonSettings) {
    let mut lines = vec![
        ("against", quoted(comparison.with.word())),
        ("map_of", quoted(comparison.of.name())),
        ("errors", quoted(comparison.metric.name())),
    ];
    let sides = |region: &Region| [region.start, region.end].concat().into_iter().map(number).collect::<Vec<_>>();
    lines.extend(comparison.region.iter().map(|region| ("region", format!("[{}]", sides(region).join(", ")))));
    lines.extend(comparison.effects.then(|| ("effects", true.to_string())));
    table(text, "[comparison]", lines);
    let held = ErrorMetric::ALL.into_iter().zip(comparison.held);
    let held = held.filter_map(|(metric, end)| Some((metric.name(), number(end?))));
    table(text, "[comparison.scale]", held.collect());
}

fn plots(plots: PlotSettings) -> Lines {
    let PlotSettings { open, over, measure } = plots;
    vec![("open", open.to_string()), ("over", quoted(over.name())), ("measure", quoted(measure.name()))]
}

/// One that was never set up is left out.
fn sweep(sweep: &SweepSettings) -> Lines {
    if *sweep == SweepSettings::default() {
        return Vec::new();
    }
    let mut lines = vec![("of", quoted(sweep.of.name()))];
    // what is being typed may be none that is read again
    let axes = [("columns", &sweep.columns), ("rows", &sweep.rows)].map(|(key, axis)| (key, axis.text()));
    let whole = axes.into_iter().filter(|(_, text)| Axis::parse(text).is_ok());
    lines.extend(whole.map(|(key, text)| (key, quoted(&text))));
    lines.extend([
        ("equal", quoted(sweep.equal.name())),
        ("seconds", number(sweep.seconds)),
        ("error", quoted(sweep.measure.name())),
    ]);
    lines
}

/// Nothing where nobody has looked into a pixel.
fn probe(probe: ProbeSettings) -> Lines {
    if probe == ProbeSettings::default() {
        return Vec::new();
    }
    let ProbeSettings { open, at: [x, y], channel } = probe;
    let at = format!("[{}, {}]", number(x), number(y));
    vec![("open", open.to_string()), ("at", at), ("channel", quoted(channel.name()))]
}

/// Nothing where nobody has looked at them.
fn trees(trees: TreesSettings) -> Lines {
    if trees == TreesSettings::default() {
        return Vec::new();
    }
    let TreesSettings { level, show, boxes, plot } = trees;
    let mut lines = vec![("level", level.to_string()), ("show", quoted(show.name()))];
    lines.extend(boxes.map(|depth| ("boxes", depth.to_string())));
    lines.push(("plot", quoted(plot.name())));
    lines
}

fn word(value: Value) -> String {
    match value {
        Value::Number(value) => number(value),
        Value::Whole(value) | Value::Bounces(Some(value)) => value.to_string(),
        words => quoted(&words.to_string()),
    }
}

/// The fewest digits that come back as this number. Large ones have an exponent: TOML's whole numbers end at 2^63.
fn number(number: f32) -> String {
    format!("{number:?}")
}
