//! What a session's file says is what comes back, and what it cannot say is told with its place.

use super::*;
use crate::model::{
    Axis, CompareWith, Counted, EVERYBODYS, Equal, LadderSettings, LadderShows, Line, Order, PaneSource, Resolution,
    Rung, SWEEP, SweepMeasure, SweepSettings, TREES, TreePlot, TreesSettings, View,
};
use compare::ErrorMetric;
use raster::{Repair, Repairs};
use scene::{Vec3, builtin};
use std::path::Path;
use technique::settings::{Kind, OF_SCENES, all_of_panes};
use technique::{DeviceChoice, TechniqueName};

fn model(scene: &str) -> Model {
    Model::new(builtin::named(scene).unwrap(), scene.into(), Theme::Dark)
}

fn saved(model: &Model) -> SavedSession {
    SavedSession::of(model, Some([1100.0, 700.0]))
}

fn text(model: &Model) -> String {
    saved(model).text(&model.document.scene, &model.document.source)
}

fn parsed(text: &str, scene: &Scene) -> Result<SavedSession, String> {
    let path = Path::new("a.toml");
    SessionDraft::parse(text, path)?.beside(scene, path)
}

/// Values of a setting, as words.
fn examples(kind: &Kind) -> Vec<String> {
    match kind {
        Kind::Number(range) => [*range.start(), *range.end(), range.start() + (range.end() - range.start()) / 3.0]
            .map(|v| v.to_string())
            .into(),
        Kind::DegreesBelow(most) => ["0".into(), most.next_down().to_string()].into(),
        Kind::Whole(range) => [range.start(), range.end()].map(u32::to_string).into(),
        Kind::Choice(words) => words.iter().map(|word| (*word).to_owned()).collect(),
        Kind::Bounces => ["0", "7", "inf"].map(str::to_owned).into(),
        Kind::Roulette => ["off", "throughput", "0.7", "0.33333334+throughput"].map(str::to_owned).into(),
        Kind::LightPaths => ["all", "direct", "bounce-3", "L(D|S)*[GS]+.?E"].map(str::to_owned).into(),
        Kind::Repairs => ["none", "all", "sky+fresnel"].map(str::to_owned).into(),
        Kind::Bugs => ["none", "no-cosine", "width-twice+clamped"].map(str::to_owned).into(),
    }
}

/// A pane in which each setting of each technique has its `nth` example.
fn changed_pane(technique: TechniqueName, nth: usize) -> PaneSettings {
    let mut pane = PaneSettings::of(technique);
    // the one in use last: it is the one that has what several share
    let others = TechniqueName::ALL.into_iter().filter(|other| *other != technique);
    for technique in others.chain([technique]) {
        pane.technique = technique;
        for row in all_of_panes().filter(|row| row.is_of(technique)) {
            let examples = examples(&row.kind_in(technique));
            pane.set(row, row.kind_in(technique).parse(&examples[nth % examples.len()]).unwrap());
        }
    }
    pane
}

#[test]
fn every_setting_of_every_technique_comes_back_as_it_was() {
    let mut unseen: Vec<_> = all_of_panes().map(|row| row.name).collect();
    for technique in TechniqueName::ALL {
        for nth in 0..7 {
            let mut model = model("whitted");
            for id in [PaneId::A, PaneId::B] {
                model.session.panes[id] = changed_pane(technique, nth + usize::from(id == PaneId::B));
            }
            let text = text(&model);
            assert_eq!(parsed(&text, &model.document.scene), Ok(saved(&model)), "{text}");
            unseen.retain(|name| !text.contains(&format!("\n{name} = ")));
        }
    }
    assert_eq!(unseen, [""; 0], "never another than in a new pane");
}

#[test]
fn all_else_of_a_session_comes_back_as_it_was() {
    let mut model = model("whitted");
    for row in OF_SCENES {
        let examples = examples(&row.kind);
        (row.set)(&mut model.document.changes, row.kind.parse(examples.last().unwrap()).unwrap());
    }
    model.document.camera.eye = Vec3::new(1.0 / 3.0, 1.7e11, -9.1e11);
    model.document.camera.up = Vec3::new(0.1, 0.9, -1.0 / 3.0);
    model.document.camera.fov_y = 33.3;
    model.document.bookmarks = vec![model.document.scene.camera, model.document.camera];
    let session = &mut model.session;
    session.panes[PaneId::A].device = DeviceChoice::Gpu;
    session.panes[PaneId::B].adapter = 3;
    session.set_source(PaneId::A, PaneSource::Received(14159));
    session.set_source(PaneId::B, PaneSource::Followed("/a \"b\"/c.exr".into()));
    (session.display.exposure, session.resolution) = (0.1, Resolution::Quarter);
    (session.view, session.line, session.wipe) = (View::Pane(PaneId::B), Line::Horizontal, 0.1 + 0.2);
    let comparison = &mut session.comparison;
    (comparison.with, comparison.of, comparison.metric) = (CompareWith::Reference, PaneId::B, ErrorMetric::Flip);
    comparison.held = [Some(0.3), None, Some(3.4e38), Some(1e-38), None];
    comparison.region = crate::model::Region::between([0.1, 0.2], [1.0 / 3.0, 1.0]);
    comparison.effects = true;
    session.plots.open = true;
    session.plots.over = crate::model::Cost::Seconds;
    session.plots.measure = crate::model::Measure::Mae;
    let channel = crate::model::Channel::Green;
    session.probe = crate::model::ProbeSettings { open: true, at: [1.0 / 3.0, 0.9], channel };
    (model.state.theme, model.state.panel, model.state.labels) = (Theme::Projector, false, false);
    let text = text(&model);
    assert_eq!(parsed(&text, &model.document.scene), Ok(saved(&model)), "{text}");
}

#[test]
fn trees_come_back_as_they_were_looked_at() {
    let mut model = model("cornell");
    assert!(!text(&model).contains("[trees]"), "nobody has looked at them");
    let boxes = Some(3);
    model.session.trees = TreesSettings { level: 9, show: Counted::Triangles, boxes, plot: TreePlot::Tests };
    let read = parsed(&text(&model), &model.document.scene).unwrap();
    assert_eq!(read.session.trees, model.session.trees);
    for (line, said) in [
        ("level = 12", "4:9: level: expected a whole number from 0 to 11"),
        ("boxes = 2.5", "4:9: boxes: expected a whole number from 0 to 24"),
        ("show = \"leaves\"", "4:8: show leaves: expected surface, boxes or triangles"),
    ] {
        let session = format!("session = 1\nscene = \"cornell\"\n[trees]\n{line}\n");
        let fault = parsed(&session, &model.document.scene).expect_err(line);
        assert!(fault.contains(said), "{fault}");
    }
}

#[test]
fn a_sweep_comes_back_as_it_was_and_what_it_cannot_mean_is_told_with_its_place() {
    let mut model = model("cornell");
    assert!(!text(&model).contains("[sweep]"), "nobody has set one up");
    model.session.sweep = SweepSettings {
        of: PaneId::A,
        columns: Axis::new("bounces", "0, 1, inf"),
        rows: Axis::new("technique", "path, metropolis"),
        equal: Equal::Time,
        seconds: 2.5,
        measure: SweepMeasure::Flip,
    };
    let read = parsed(&text(&model), &model.document.scene).unwrap();
    assert_eq!(read.session.sweep, model.session.sweep);
    // in the middle of typing
    model.session.sweep.columns.values = "0,".into();
    assert_eq!(
        parsed(&text(&model), &model.document.scene).unwrap().session.sweep.columns,
        Axis::new("spp", "1, 4, 16")
    );
    model.session.sweep.of = PaneId::B;
    model.session.sweep.columns = Axis::new("bounces", "0, 1");
    model.session.sweep.rows = Axis::default();
    model.follow_the_sweep();
    // what tiles show comes back, whatever would not be made
    model.session.sweep.columns.values = "0, mny".into();
    model.session.sweep.equal = Equal::Samples;
    let read = parsed(&text(&model), &model.document.scene).unwrap().session.sweep;
    assert_eq!((read.columns, read.equal), (Axis::new("bounces", "0, 1"), Equal::Time));
    for (line, said) in [
        ("columns = \"bounces=0,many\"", "4:11: columns: bounces=many: expected a whole number"),
        ("rows = \"bouncs=0,1\"", "4:8: rows: bouncs is no setting"),
        ("rows = \"spp\"", "4:8: rows: spp: expected NAME=V1,V2"),
        ("equal = \"space\"", "4:9: equal space: expected samples or time"),
        ("seconds = 0", "4:11: seconds: expected seconds from 0.01 to 3600"),
        ("error = \"MSE\"", "4:9: error MSE: expected relMSE, RMSE or FLIP"),
    ] {
        let session = format!("session = 1\nscene = \"cornell\"\n[sweep]\n{line}\n");
        let fault = parsed(&session, &model.document.scene).expect_err(line);
        assert!(fault.contains(said), "{fault}");
    }
}

#[test]
fn a_session_says_no_more_of_a_pane_than_a_new_one_has_not() {
    for scene in ["whitted", "cornell"] {
        let text = text(&model(scene));
        assert!(text.contains("\n[panes.A]\ntechnique = \"raster\"\n\n[panes.B]\ntechnique = \"path\"\n\n"), "{text}");
    }
    let mut chosen = model("whitted");
    chosen.session.panes[PaneId::B].truth.path.bounces = Some(2);
    assert!(text(&chosen).contains("technique = \"path\"\nbounces = 2\n\n"));
}

#[test]
fn a_session_of_two_lines_is_a_new_window() {
    for scene in ["whitted", "cornell"] {
        let new = model(scene);
        let read = parsed(&format!("session = 1\nscene = \"{scene}\""), &new.document.scene).unwrap();
        assert_eq!((&read.session, read.camera, read.line_placed), (&new.session, new.document.camera, false));
        assert_eq!((read.window, read.changes), (SavedWindow::default(), SceneChanges::default()));
    }
}

#[test]
fn names_of_scenes_come_back_whatever_is_in_them() {
    let model = model("cornell");
    for source in ["../a b.toml", "C:\\scenes\\a.toml", "a\"b\n\u{7f}\u{85}ü.toml"] {
        let text = saved(&model).text(&model.document.scene, source);
        let draft = SessionDraft::parse(&text, Path::new("a.toml")).unwrap();
        assert_eq!((draft.scene.as_str(), draft.scene_hash), (source, Some(model.document.scene.as_read)));
    }
}

#[test]
fn what_a_session_cannot_mean_is_told_with_line_and_column() {
    let scene = builtin::named("whitted").unwrap();
    for (lines, said) in [
        ("[panes.A]\nspp = 4", "a.toml:4:1: spp is no setting of raster: expected fake, repairs, texture-filter, "),
        ("[panes.B]\nspp = \"many\"", "a.toml:4:7: spp=many: expected a whole number from 1 to "),
        ("[panes.B]\nspp = 4.5", "a.toml:4:7: spp=4.5: expected a whole number"),
        ("[panes.B]\nsampler = \"sobl\"", "; did you mean sobol?"),
        ("[panes.B]\nsamplr = \"sobol\"", "a.toml:4:1: samplr is no setting of path: expected "),
        ("[panes.B]\nbounces = true", "a.toml:4:11: bounces=: expected a whole number from 0 to "),
        ("[panes.B]\ntechnique = \"pth\"", "a.toml:4:13: technique pth: expected raster, whitted, path, "),
        ("[panes.B.raster]\nsegments = 0", "a.toml:4:12: segments=0: expected a number from "),
        ("[panes.B]\ndevice = \"card\"", "a.toml:4:10: device card: expected auto, cpu or gpu"),
        ("[panes.B]\nadapter = -1", "a.toml:4:11: adapter: expected the number of an adapter"),
        ("[panes.C]\nspp = 4", "C is no key of [panes]: expected A or B"),
        ("[panes.B]\nreceived = 0", "a.toml:4:12: received: expected the port that a picture is received on"),
        ("[panes.B]\npicture = \"a.gif\"", "a.toml:4:11: picture: expected a picture's file, whose name ends in"),
        ("[panes.B]\nreceived = 9\npicture = \"a.exr\"", "a.toml:5:1: picture: received stands before it"),
        ("panes = 3", "a.toml:3:9: panes: expected a table, [panes]"),
        (
            "[scene_changes]\nrefraction-ratio = 0",
            "a.toml:4:20: refraction-ratio 0: expected a number from 0.001 to 1000",
        ),
        ("[scene_changes]\nsun_radius = 0", "; did you mean sun-radius?"),
        ("[scene_changes]\nedit = 3", "a.toml:4:8: edit: expected a table of what is changed in it"),
        (
            "[scene_changes]\nedit = { sun = { elevation = 20, azimut = 3 } }",
            "a.toml:4:34: 'azimut' cannot be changed in the sun",
        ),
        (
            "[scene_changes]\nedit = { material.glass = { ior = 0 } }",
            "a.toml:4:35: ior of material 'glass': expected a number from 0.01 to 100",
        ),
        ("[view]\nshow = \"walk\"", "a.toml:4:8: show walk: expected a, b, wipe, side or map"),
        ("[view]\nline_at = 1.5", "a.toml:4:11: line_at: expected a number from 0 to 1"),
        ("[view]\nexposure = nan", "a.toml:4:12: exposure: expected stops from -30 to 30"),
        ("[view]\n  shw = \"a\"", "a.toml:4:3: shw is no key of [view]: expected show, workspace, line, "),
        ("[camera]\neye = [1, 2]", "a.toml:4:7: eye: expected three numbers, [x, y, z]"),
        ("[camera]\nfov = 180", "a.toml:4:7: fov: expected degrees between 0 and 180"),
        (
            "[camera]\neye = [0, 1, 0]\ntarget = [0, 1, 0]",
            "a.toml:3:1: this camera sees nothing: its eye and target must differ",
        ),
        ("[[bookmarks]]\neye = [0, 1, 0]\ntarget = [0, 1, 0]", "a.toml:3:1: this camera sees nothing"),
        ("[bookmarks]\neye = [0, 1, 0]", "bookmarks: expected tables, each under [[bookmarks]]"),
        ("[comparison]\nerrors = \"bias\"", "a.toml:4:10: errors bias: expected signed, absolute, "),
        ("[comparison]\nregion = [0.5, 0, 0.5, 1]", "a.toml:4:10: region: expected left, top, right and bottom"),
        ("[comparison.scale]\nsigned = 0", "a.toml:4:10: signed: expected a number above 0"),
        ("[plots]\nopen = \"yes\"", "a.toml:4:8: open: expected true or false"),
        ("[probe]\nat = [0.5, 2]", "a.toml:4:6: at: expected a pixel's place in shares of the picture, [0.5, 0.5]"),
        ("[window]\nsize = [1280]", "a.toml:4:8: size: expected width and height in points"),
        ("[window]\ntheme = \"drk\"", "a.toml:4:9: theme drk: expected dark, light or projector; did you mean dark?"),
        ("[plot]\nopen = true", "a.toml:3:2: plot is no key of a session: expected session, scene, "),
        ("scene_hash = \"12\"", "a.toml:3:14: scene_hash: expected two hashes"),
        ("[view\nshow = \"a\"", "a.toml:3:6: "),
        ("scene = \"cornell\"", "a.toml:3:1: duplicate key"),
    ] {
        let text = format!("session = 1\nscene = \"whitted\"\n{lines}\n");
        let fault = parsed(&text, &scene).expect_err(lines);
        assert!(fault.starts_with("a.toml:") && fault.contains(said) && !fault.contains('\n'), "{lines}: {fault}");
    }
}

#[test]
fn what_is_changed_part_by_part_comes_back_and_tables_are_read_too() {
    let mut model = model("whitted");
    let edits = "{ material.glass.reflectivity = 0.25, sun = { elevation = 20.0, azimuth = -35.5 } }";
    model.document.changes.set_refraction_ratio(Some(0.6));
    model.document.changes.take_edits(&edits.parse().unwrap());
    let mut of_one = model.document.clone();
    of_one.changes.take_edits(&"{ material.glass.ior = 2 }".parse().unwrap());
    let told = text(&Model { document: of_one.clone(), ..self::model("whitted") });
    assert_eq!(parsed(&told, &model.document.scene).expect("a session").changes, of_one.changes);
    let told = text(&model);
    assert!(told.contains("\nedit = { material.glass = { reflectivity = 0.25 }, sun = { "), "{told}");
    let read = parsed(&told, &model.document.scene).expect("a session");
    assert_eq!(read.changes, model.document.changes);
    let mut restored = self::model("whitted");
    restored.restore(&read, &Setup::default()).expect("all of it fits");
    assert_eq!(restored.document.changes, model.document.changes);
    assert!(!restored.can_undo_and_redo()[0]);
    let tables = "session = 1\nscene = \"whitted\"\n[scene_changes.edit.sun]\nelevation = 20\n";
    let read = parsed(tables, &model.document.scene).expect("a session");
    assert_eq!(read.changes.edits, "{ sun.elevation = 20 }".parse().unwrap());
}

#[test]
fn of_a_sessions_changes_those_are_made_that_its_scene_has_and_the_others_told() {
    let mut model = model("cornell");
    let lines = "session = 1\nscene = \"cornell\"\n[scene_changes]\n\
                 edit = { material.white.colour = [1, 0, 0], material.gone.colour = [1, 1, 1] }\n";
    let read = parsed(lines, &model.document.scene).expect("a session");
    let why = model.restore(&read, &Setup::default()).expect_err("one is not there");
    assert!(why.starts_with("cornell has no material 'gone'"), "{why}");
    assert_eq!(model.document.changes.edits, "{ material.white.colour = [1, 0, 0] }".parse().unwrap());
}

#[test]
fn a_session_of_a_later_version_is_refused_in_words() {
    let fault = |text: &str| SessionDraft::parse(text, Path::new("a.toml")).unwrap_err();
    let later = fault("session = 2\nscene = \"whitted\"\nholograms = true");
    assert!(
        later.starts_with("a.toml:1:11: this session is of version 2, which a later visavis has written"),
        "{later}"
    );
    assert!(fault("session = \"x\"").contains("a.toml:1:11: session: expected 1"));
    assert!(fault("session = 1").contains("a session needs its scene"));
}

#[test]
fn a_session_is_told_by_its_first_key() {
    for text in ["session = 1", "\u{feff}\n# one\n  session=7 # two\n[", "session = \"x\""] {
        assert!(is_session(text), "{text}");
    }
    for text in
        ["", "[camera]\nsession = 1", "sessions = 1", "session", "#session = 1", builtin::text("whitted").unwrap()]
    {
        assert!(!is_session(text), "{text}");
    }
}

#[test]
fn a_session_opens_in_its_workspace_and_so_do_those_that_said_it_elsewhere() {
    let mut model = model("cornell");
    assert!(!text(&model).contains("workspace"), "the comparison is the usual one");
    for workspace in EVERYBODYS {
        model.session.workspace = workspace;
        assert_eq!(parsed(&text(&model), &model.document.scene).unwrap().session.workspace, workspace);
    }
    for (table, workspace) in [("sweep", SWEEP), ("trees", TREES)] {
        let earlier = format!("session = 1\nscene = \"cornell\"\n[{table}]\nopen = true\n");
        assert_eq!(parsed(&earlier, &model.document.scene).unwrap().session.workspace, workspace);
    }
    let unknown = "session = 1\nscene = \"cornell\"\n[view]\nworkspace = \"lader\"\n";
    let fault = parsed(unknown, &model.document.scene).expect_err("no such workspace");
    assert!(fault.contains("4:13: workspace lader: expected") && fault.ends_with("did you mean ladder?"), "{fault}");
}

#[test]
fn a_ladder_comes_back_as_it_was_and_what_it_cannot_mean_is_told_with_its_place() {
    let mut model = model("cornell");
    assert!(!text(&model).contains("[ladder]"), "nobody has looked at it");
    model.session.ladder = LadderSettings {
        repairs: Repairs::NONE.with(Repair::Sky).with(Repair::Fresnel),
        order: Order::BestFirst,
        selected: Rung::Repair(Repair::Fresnel),
        shows: LadderShows::Step,
    };
    let read = parsed(&text(&model), &model.document.scene).unwrap();
    assert_eq!(read.session.ladder, model.session.ladder);
    for (line, said) in [
        ("repairs = \"sky+glue\"", "4:11: repairs: glue is none: expected repairs with + between"),
        ("order = \"worst\"", "4:9: order worst: expected light or best-first"),
        ("rung = \"skye\"", "did you mean sky?"),
        ("steps = 2", "steps is no key of [ladder]"),
    ] {
        let session = format!("session = 1\nscene = \"cornell\"\n[ladder]\n{line}\n");
        let fault = parsed(&session, &model.document.scene).expect_err(line);
        assert!(fault.contains(said), "{fault}");
    }
}
