//! A session from the text of its file. What depends on the scene waits until that is open.

use super::table::{Entry, Fault, Table, fault};
use super::{MOST_BOOKMARKS, SESSION_VERSION, SavedSession, SavedWindow, ladder};
use crate::model::{
    Axis, Channel, CompareWith, Cost, Counted, EVERYBODYS, Equal, Line, Measure, PaneId, PaneSource, Panes, Region,
    Resolution, SWEEP, Session, SweepMeasure, SweepSettings, TREES, Theme, TreePlot, TreesSettings, View,
};
use compare::ErrorMetric;
use image_file::{Kind, shown};
use scene::{Camera, Scene, SceneHash, Vec3};
use std::path::{Path, PathBuf};
use technique::settings::{EDIT, OF_SCENES, of_panes};
use technique::{DeviceChoice, PaneSettings, PaneSetup, SceneChanges, TechniqueName};
use toml::de::DeTable;

/// What a session's file says, without its scene.
#[derive(Debug)]
pub struct SessionDraft {
    /// The scene's built-in name, or its file as the session's folder finds it.
    pub scene: String,
    /// The scene as it was then, if the file says so.
    pub scene_hash: Option<SceneHash>,
    camera: DraftCamera,
    bookmarks: Vec<DraftCamera>,
    changes: SceneChanges,
    /// All but the panes.
    session: Session,
    line_placed: bool,
    panes: Panes<DraftPane>,
    window: SavedWindow,
}

/// A camera as far as it is stated, and where.
#[derive(Debug)]
struct DraftCamera {
    eye: Option<Vec3>,
    target: Option<Vec3>,
    up: Option<Vec3>,
    fov: Option<f32>,
    /// Line and column where it stands in the file, from 1.
    at: (usize, usize),
}

#[derive(Debug)]
struct DraftPane {
    device: DeviceChoice,
    adapter: u8,
    in_use: PaneSetup,
    /// What techniques are set to that are not in use.
    others: Vec<PaneSetup>,
    source: PaneSource,
}

impl SessionDraft {
    /// Reads the text of a file.
    ///
    /// # Errors
    /// One line with path, line and column of the first thing that is wrong, and what was expected.
    pub fn parse(text: &str, path: &Path) -> Result<Self, String> {
        parse(text).map_err(|Fault { at, message }| told(path, line_and_column(text, at.start), &message))
    }

    /// The session of this scene.
    ///
    /// # Errors
    /// If a camera sees nothing of it: one line, as [`SessionDraft::parse`].
    pub fn beside(self, scene: &Scene, path: &Path) -> Result<SavedSession, String> {
        let bookmarks = self.bookmarks.iter().map(|place| place.beside(scene, path)).collect::<Result<_, _>>()?;
        let mut panes = super::new_panes(scene);
        for (id, pane) in self.panes.iter() {
            panes.insert(id, pane.settings(scene));
        }
        Ok(SavedSession {
            changes: self.changes,
            camera: self.camera.beside(scene, path)?,
            bookmarks,
            session: Session { panes, ..self.session },
            line_placed: self.line_placed,
            window: self.window,
        })
    }
}

impl DraftCamera {
    fn beside(&self, scene: &Scene, path: &Path) -> Result<Camera, String> {
        let own = scene.camera;
        let (eye, target) = (self.eye.unwrap_or(own.eye), self.target.unwrap_or(own.target));
        let (up, fov_y) = (self.up.unwrap_or(own.up), self.fov.unwrap_or(own.fov_y));
        let camera = Camera { eye, target, up, fov_y, ..own };
        match camera.fault() {
            Some(why) => Err(told(path, self.at, &format!("this camera sees nothing: {why}"))),
            None => Ok(camera),
        }
    }
}

impl DraftPane {
    /// What is shared by techniques is as the one in use says.
    fn settings(&self, scene: &Scene) -> PaneSettings {
        let mut pane = PaneSettings::of(TechniqueName::Raster);
        (pane.device, pane.adapter) = (self.device, self.adapter);
        pane.take_usual_estimator(scene);
        self.others.iter().chain([&self.in_use]).for_each(|setup| setup.add_to(&mut pane));
        pane
    }
}

fn told(path: &Path, (line, column): (usize, usize), message: &str) -> String {
    format!("{}:{line}:{column}: {message}", shown(path))
}

/// Both from 1, the column in characters.
fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

fn parse(text: &str) -> Result<SessionDraft, Fault> {
    let parsed = DeTable::parse(text).map_err(|fault| Fault {
        at: fault.span().unwrap_or(0..0),
        message: fault.message().lines().collect::<Vec<_>>().join(", "),
    })?;
    let whole = parsed.span();
    let mut table = Table::new("", whole, parsed.into_inner());
    version(&mut table)?;
    let scene = match table.take("scene") {
        Some(entry) => entry.text("the name of a built-in scene, or a scene's file")?,
        None => return fault(&(0..0), "a session needs its scene: scene = \"whitted\", or a scene's file"),
    };
    let scene_hash = table.read("scene_hash", hash)?;
    let camera = camera(table.table("camera")?, text)?;
    let changes = changes(table.table("scene_changes")?)?;
    let mut session = Session::default();
    let line_placed = view(table.table("view")?, &mut session)?;
    let panes = panes(table.table("panes")?)?;
    panes.iter().for_each(|(id, pane)| session.set_source(id, pane.source.clone()));
    comparison(table.table("comparison")?, &mut session)?;
    plots(table.table("plots")?, &mut session)?;
    let [mut of_sweep, mut of_trees] = [table.table("sweep")?, table.table("trees")?];
    was_open(&mut of_sweep, SWEEP, &mut session)?;
    was_open(&mut of_trees, TREES, &mut session)?;
    session.sweep = sweep(of_sweep)?;
    session.ladder = ladder::read(table.table("ladder")?)?;
    session.trees = trees(of_trees)?;
    probe(table.table("probe")?, &mut session)?;
    let bookmarks = table.read("bookmarks", |entry| entry.tables("bookmarks"))?.unwrap_or_default();
    if let Some(first_too_many) = bookmarks.get(MOST_BOOKMARKS) {
        return fault(&first_too_many.at, format!("bookmarks: expected {MOST_BOOKMARKS} at most"));
    }
    let bookmarks = bookmarks.into_iter().map(|place| self::camera(place, text)).collect::<Result<_, _>>()?;
    let window = window(table.table("window")?)?;
    table.end()?;
    Ok(SessionDraft { scene, scene_hash, camera, bookmarks, changes, session, line_placed, panes, window })
}

/// Before all else: a later version may have other keys.
fn version(table: &mut Table) -> Result<(), Fault> {
    let Some(entry) = table.take("session") else {
        return fault(&(0..0), format!("a session begins with session = {SESSION_VERSION}"));
    };
    let expected = format!("session: expected {SESSION_VERSION}, the version of its format");
    match entry.word().and_then(|word| word.parse::<u32>().ok()) {
        Some(SESSION_VERSION) => Ok(()),
        Some(later) if later > SESSION_VERSION => fault(
            &entry.at,
            format!(
                "this session is of version {later}, which a later visavis has written: this one reads version \
                 {SESSION_VERSION}"
            ),
        ),
        _ => fault(&entry.at, expected),
    }
}

fn hash(entry: Entry) -> Result<SceneHash, Fault> {
    let word = entry.text("a hash, or no such line")?;
    word.parse().map_err(|why| Fault { at: entry.at, message: format!("scene_hash: {why}, or no such line") })
}

fn camera(mut table: Table, text: &str) -> Result<DraftCamera, Fault> {
    let at = line_and_column(text, table.at.start);
    let eye = table.read("eye", |entry| entry.point())?;
    let target = table.read("target", |entry| entry.point())?;
    let up = table.read("up", |entry| entry.point())?;
    let is_angle = |degrees| degrees > 0.0 && degrees < 180.0;
    let fov = table.read("fov", |entry| entry.number("degrees between 0 and 180", is_angle))?;
    table.end()?;
    Ok(DraftCamera { eye, target, up, fov, at })
}

fn changes(mut table: Table) -> Result<SceneChanges, Fault> {
    let edits = table.read(EDIT, Entry::edits)?.unwrap_or_default();
    let mut changes = SceneChanges::default();
    for row in OF_SCENES {
        let Some(entry) = table.take(row.name) else { continue };
        let word = entry.word().unwrap_or_default();
        let value = row.kind.parse(&word);
        let value = value.or_else(|expected| fault(&entry.at, format!("{} {word}: expected {expected}", row.name)))?;
        (row.set)(&mut changes, value);
    }
    // what is said of one glass holds over what is said of all
    changes.take_edits(&edits);
    table.end()?;
    Ok(changes)
}

/// Returns whether the line has a place.
fn view(mut table: Table, session: &mut Session) -> Result<bool, Fault> {
    let show = table.read("show", |entry| entry.one_of(&View::ALL, View::word))?;
    session.view = show.unwrap_or(session.view);
    let workspace = table.read("workspace", |entry| entry.one_of(&EVERYBODYS, |word| word))?;
    session.workspace = workspace.unwrap_or(session.workspace);
    let lines = [Line::Vertical, Line::Horizontal];
    let line = table.read("line", |entry| entry.one_of(&lines, Line::name))?;
    let of_the_picture = |at| (0.0..=1.0).contains(&at);
    let at = table.read("line_at", |entry| entry.number("a number from 0 to 1", of_the_picture))?;
    (session.line, session.wipe) = (line.unwrap_or(session.line), at.unwrap_or(session.wipe));
    let stops = |stops: f32| stops.abs() <= 30.0;
    let exposure = table.read("exposure", |entry| entry.number("stops from -30 to 30", stops))?;
    session.display.exposure = exposure.unwrap_or_default();
    let resolution = table.read("resolution", |entry| entry.one_of(&Resolution::ALL, Resolution::name))?;
    session.resolution = resolution.unwrap_or_default();
    table.end()?;
    Ok(line.is_some() || at.is_some())
}

fn panes(mut table: Table) -> Result<Panes<DraftPane>, Fault> {
    let mut panes = Panes::default();
    for (id, usual) in Session::default().panes.iter() {
        let name = table.name_of(id.name());
        if let Some(entry) = table.take(id.name()) {
            panes.insert(id, pane(entry.table(name)?, usual.technique)?);
        }
    }
    table.end()?;
    Ok(panes)
}

fn pane(mut table: Table, usual: TechniqueName) -> Result<DraftPane, Fault> {
    let technique = table.read("technique", |entry| entry.one_of(&TechniqueName::ALL, TechniqueName::name))?;
    let technique = technique.unwrap_or(usual);
    let device = table.read("device", |entry| entry.one_of(&DeviceChoice::ALL, DeviceChoice::name))?;
    let adapter = table.read("adapter", |entry| entry.small_number("the number of an adapter, the best is 0"))?;
    let mut others = Vec::new();
    for other in TechniqueName::ALL {
        let name = table.name_of(other.name());
        if let Some(entry) = table.take(other.name()) {
            others.push(settings(entry.table(name)?, other)?);
        }
    }
    let source = source(&mut table)?;
    let in_use = settings(table, technique)?;
    let (device, adapter) = (device.unwrap_or_default(), adapter.unwrap_or_default());
    Ok(DraftPane { device, adapter, in_use, others, source })
}

/// Where the pane's picture comes from.
fn source(table: &mut Table) -> Result<PaneSource, Fault> {
    let port = |entry: Entry| match entry.word().and_then(|word| word.parse().ok()).filter(|port| *port > 0) {
        Some(port) => Ok(PaneSource::Received(port)),
        None => entry.no("the port that a picture is received on, from 1 to 65535"),
    };
    let received = table.read("received", port)?;
    let Some(entry) = table.take("picture") else { return Ok(received.unwrap_or_default()) };
    if received.is_some() {
        return fault(&entry.key_at, "picture: received stands before it; leave one of the two");
    }
    let file = PathBuf::from(entry.text("a picture's file")?);
    match Kind::of(&file) {
        Some(_) => Ok(PaneSource::Followed(file)),
        None => entry.no("a picture's file, whose name ends in .png or .exr"),
    }
}

/// The settings of a technique, by the names of their table.
fn settings(table: Table, technique: TechniqueName) -> Result<PaneSetup, Fault> {
    let mut setup = PaneSetup::of(technique);
    for entry in table.rest() {
        let known = of_panes(&entry.key).is_some_and(|row| row.is_of(technique));
        let at = if known { &entry.at } else { &entry.key_at };
        setup.set(&entry.key, &entry.word().unwrap_or_default()).or_else(|why| fault(at, why))?;
    }
    Ok(setup)
}

fn comparison(mut table: Table, session: &mut Session) -> Result<(), Fault> {
    let comparison = &mut session.comparison;
    let with = table.read("against", |entry| entry.one_of(&CompareWith::ALL, CompareWith::word))?;
    comparison.with = with.unwrap_or(comparison.with);
    let of = table.read("map_of", |entry| entry.one_of(&[PaneId::A, PaneId::B], PaneId::name))?;
    comparison.of = of.unwrap_or(comparison.of);
    let metric = table.read("errors", |entry| entry.one_of(&ErrorMetric::ALL, ErrorMetric::name))?;
    comparison.metric = metric.unwrap_or(comparison.metric);
    let sides = "left, top, right and bottom in shares of the picture, [0, 0, 0.5, 1]";
    let region = table.read("region", |entry| {
        let [left, top, right, bottom] = entry.numbers(sides, |side| (0.0..=1.0).contains(&side))?;
        let region = Region::between([left, top], [right, bottom]);
        region.map_or_else(|| entry.no(sides), Ok)
    })?;
    comparison.region = region;
    comparison.effects = table.read("effects", |entry| entry.flag())?.unwrap_or_default();
    let mut scale = table.table("scale")?;
    for metric in ErrorMetric::ALL {
        let end = scale.read(metric.name(), |entry| entry.number("a number above 0", |end| end > 0.0))?;
        comparison.held[metric as usize] = end;
    }
    scale.end()?;
    table.end()
}

fn plots(mut table: Table, session: &mut Session) -> Result<(), Fault> {
    let plots = &mut session.plots;
    plots.open = table.read("open", |entry| entry.flag())?.unwrap_or(plots.open);
    plots.over = table.read("over", |entry| entry.one_of(&Cost::ALL, Cost::name))?.unwrap_or_default();
    plots.measure = table.read("measure", |entry| entry.one_of(&Measure::ALL, Measure::name))?.unwrap_or_default();
    table.end()
}

/// Workspaces said themselves whether they were open before `[view]` has said which one is.
fn was_open(table: &mut Table, workspace: &'static str, session: &mut Session) -> Result<(), Fault> {
    if table.read("open", |entry| entry.flag())? == Some(true) {
        session.workspace = workspace;
    }
    Ok(())
}

fn sweep(mut table: Table) -> Result<SweepSettings, Fault> {
    let usual = SweepSettings::default();
    let axis = |entry: Entry| {
        let text = entry.text("NAME=V1,V2,... of a setting")?;
        Axis::parse(&text).or_else(|why| fault(&entry.at, format!("{}: {why}", entry.key)))
    };
    let seconds = |seconds| (0.01..=3600.0).contains(&seconds);
    let sweep = SweepSettings {
        of: table.read("of", |entry| entry.one_of(&[PaneId::A, PaneId::B], PaneId::name))?.unwrap_or(usual.of),
        columns: table.read("columns", axis)?.unwrap_or(usual.columns),
        rows: table.read("rows", axis)?.unwrap_or(usual.rows),
        equal: table.read("equal", |entry| entry.one_of(&Equal::ALL, Equal::name))?.unwrap_or(usual.equal),
        seconds: table
            .read("seconds", |entry| entry.number("seconds from 0.01 to 3600", seconds))?
            .unwrap_or(usual.seconds),
        measure: table
            .read("error", |entry| entry.one_of(&SweepMeasure::ALL, SweepMeasure::name))?
            .unwrap_or(usual.measure),
    };
    table.end()?;
    Ok(sweep)
}

fn trees(mut table: Table) -> Result<TreesSettings, Fault> {
    let usual = TreesSettings::default();
    let whole = |entry: Entry, expected: &str, most: f32| {
        entry.number(expected, |n| (0.0..=most).contains(&n) && n.fract() == 0.0).map(|n| n as u32)
    };
    let level = |entry: Entry| whole(entry, "a whole number from 0 to 11", TreesSettings::FINEST as f32);
    let depth = |entry: Entry| whole(entry, "a whole number from 0 to 24", 24.0);
    let trees = TreesSettings {
        level: table.read("level", level)?.unwrap_or(usual.level),
        show: table.read("show", |entry| entry.one_of(&Counted::ALL, Counted::name))?.unwrap_or(usual.show),
        boxes: table.read("boxes", depth)?,
        plot: table.read("plot", |entry| entry.one_of(&TreePlot::ALL, TreePlot::name))?.unwrap_or(usual.plot),
    };
    table.end()?;
    Ok(trees)
}

fn probe(mut table: Table, session: &mut Session) -> Result<(), Fault> {
    let probe = &mut session.probe;
    probe.open = table.read("open", |entry| entry.flag())?.unwrap_or(probe.open);
    let place = "a pixel's place in shares of the picture, [0.5, 0.5]";
    let at = table.read("at", |entry| entry.numbers(place, |share| (0.0..=1.0).contains(&share)))?;
    probe.at = at.unwrap_or(probe.at);
    probe.channel = table.read("channel", |entry| entry.one_of(&Channel::ALL, Channel::name))?.unwrap_or_default();
    table.end()
}

fn window(mut table: Table) -> Result<SavedWindow, Fault> {
    let points = |points| (1.0..=65536.0).contains(&points);
    let size = table.read("size", |entry| entry.numbers("width and height in points, [1280, 720]", points))?;
    let window = SavedWindow {
        size: size.map(|size: [f32; 2]| size.map(f64::from)),
        theme: table.read("theme", |entry| entry.one_of(&Theme::ALL, Theme::name))?,
        panel: table.read("panel", |entry| entry.flag())?,
        labels: table.read("labels", |entry| entry.flag())?,
    };
    table.end()?;
    Ok(window)
}
