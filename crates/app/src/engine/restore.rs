//! What a picture of this program shows, from its records: its scene, and what is to be set up to see it again.

use crate::model::{CompareWith, Line, MapSetup, PaneId, Region, Setup, View};
use crate::sweep::COLUMNS;
use anyhow::{Context, bail};
use compare::ErrorMetric;
use image_file::shown;
use scene::{Scene, SceneHash, Vec3};
use std::path::Path;
use technique::settings::{EDIT, of_scenes};
use technique::{OWN_FOV, PaneSetup, Recorded, SampleRanges, TechniqueName, made_by_command, made_from, scene_hash};

/// A picture's scene and all that it says beside.
#[derive(Debug)]
pub struct Kept {
    /// The scene as the user asked for it then.
    pub scene: String,
    /// The scene as it was read then; `None` of a picture from before this was kept.
    pub scene_hash: Option<SceneHash>,
    /// What is set up to see it again.
    pub setup: Setup,
    /// The text of the session in which it was seen, of a picture as seen.
    pub session: Option<String>,
}

/// What a file's records say of its picture.
#[derive(Debug)]
pub enum Told {
    /// How it was made.
    Picture(Kept),
    /// That it is a scene's reference.
    Reference(Kept),
    /// That it is a map of errors, not of which pictures.
    ErrorMap,
    /// Nothing of that kind.
    Nothing,
}

/// What a picture says of itself.
///
/// # Errors
/// If it cannot be read, or if its records are damaged or of a later program.
pub fn read(file: &Path) -> anyhow::Result<Told> {
    let records = image_file::records(file)?;
    told(&records).with_context(|| format!("cannot read how it was made: {}", shown(file)))
}

fn told(records: &[(String, String)]) -> anyhow::Result<Told> {
    if let Some(made) = made_from(records)? {
        return alone(made, records).map(Told::Picture);
    }
    if let Some(kept) = as_seen(records)? {
        return Ok(Told::Picture(kept));
    }
    if let Some(kept) = of_sweep(records)? {
        return Ok(Told::Picture(kept));
    }
    if let Some(kept) = of_reference(records)? {
        return Ok(Told::Reference(kept));
    }
    let is_map = value(records, "map").is_some() && value(records, "colours").is_some();
    Ok(if is_map { Told::ErrorMap } else { Told::Nothing })
}

/// The scene of a sweep, seen as all of its tiles are; one that the window has saved keeps its session too.
fn of_sweep(records: &[(String, String)]) -> anyhow::Result<Option<Kept>> {
    let (Some(scene), Some(_)) = (value(records, "scene"), value(records, COLUMNS)) else { return Ok(None) };
    let mut setup = Setup::default();
    for (name, value) in records {
        look(&mut setup, name, value)?;
    }
    let session = value(records, SESSION).map(str::to_owned);
    Ok(Some(Kept { scene: scene.to_owned(), scene_hash: scene_hash(records)?, setup, session }))
}

/// The reference of a scene, as `reference` keeps it: it tells by which estimator it was made.
fn of_reference(records: &[(String, String)]) -> anyhow::Result<Option<Kept>> {
    let (Some(scene), Some(_)) = (value(records, "scene"), value(records, "estimator")) else { return Ok(None) };
    let mut setup = Setup::default();
    for (name, value) in records {
        look(&mut setup, name, value)?;
    }
    Ok(Some(Kept { scene: scene.to_owned(), scene_hash: scene_hash(records)?, setup, session: None }))
}

/// The picture of a pane, shown alone in A.
fn alone(made: Recorded, records: &[(String, String)]) -> anyhow::Result<Kept> {
    let mut kept = of_panes(&[(PaneId::A, made)])?;
    kept.setup.view = Some(View::Pane(PaneId::A));
    if let Some(fov) = value(records, OWN_FOV) {
        kept.setup.fov = Some(number(fov)?);
    }
    Ok(kept)
}

fn value<'a>(records: &'a [(String, String)], name: &str) -> Option<&'a str> {
    records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
}

/// What stands before the command of a pane whose picture was not all that this makes, or more.
pub const QUALIFIED: [&str; 2] = ["rough, in full: ", "with earlier views, and without: "];

/// The record of the session in which a picture was seen.
pub const SESSION: &str = "session";

/// Names the part of the picture that figures speak of.
pub const REGION: &str = "region";

/// The picture as seen, or the map of errors: each pane's command, and how they were shown.
fn as_seen(records: &[(String, String)]) -> anyhow::Result<Option<Kept>> {
    let value = |name: &str| value(records, name);
    let command = |id: PaneId| {
        let line = value(id.name())?;
        Some((id, made_by_command(QUALIFIED.into_iter().find_map(|words| line.strip_prefix(words)).unwrap_or(line))?))
    };
    let panes: Vec<_> = [PaneId::A, PaneId::B].into_iter().filter_map(command).collect();
    if panes.is_empty() {
        return Ok(None);
    }
    let mut kept = of_panes(&panes)?;
    kept.scene_hash = scene_hash(records)?;
    kept.session = value(SESSION).map(str::to_owned);
    kept.setup.view = value("view").and_then(|name| View::ALL.into_iter().find(|view| view.name() == name));
    kept.setup.line = value("line").and_then(line);
    kept.setup.exposure = value("exposure").and_then(|stops| stops.parse().ok());
    kept.setup.with = value("against").and_then(|name| CompareWith::ALL.into_iter().find(|with| with.name() == name));
    kept.setup.map = map(records);
    kept.setup.region = value(REGION).and_then(Region::recorded);
    // the panes' commands have the camera of the pictures, which show more of it where they are narrow
    let camera = &mut kept.setup;
    camera.eye = value("eye").map(point).transpose()?.or(camera.eye);
    camera.target = value("target").map(point).transpose()?.or(camera.target);
    camera.up = value("up").map(point).transpose()?.or(camera.up);
    camera.fov = value("fov").map(number).transpose()?.or(camera.fov);
    Ok(Some(kept))
}

/// The map of errors; `None` of a picture from before it was kept.
fn map(records: &[(String, String)]) -> Option<MapSetup> {
    let of = PaneId::named(value(records, "errors of")?)?;
    let metric = ErrorMetric::named(value(records, "errors")?)?;
    let held = value(records, "scale")?.parse().ok().filter(|end: &f32| end.is_finite() && *end > 0.0);
    Some(MapSetup { of, metric, held })
}

/// Reads how the wipe's line stands and where, as records have it: "vertical at 0.5".
fn line(words: &str) -> Option<(Line, f32)> {
    let (name, at) = words.split_once(" at ")?;
    let line = [Line::Vertical, Line::Horizontal].into_iter().find(|line| line.name() == name)?;
    Some((line, at.parse().ok().filter(|at| (0.0..=1.0).contains(at))?))
}

fn of_panes(panes: &[(PaneId, Recorded)]) -> anyhow::Result<Kept> {
    let Some((_, Recorded { scene, scene_hash, .. })) = panes.first() else { bail!("it says nothing") };
    let mut setup = Setup::default();
    for (id, made) in panes {
        add(&mut setup, *id, &made.options)?;
    }
    Ok(Kept { scene: scene.clone(), scene_hash: *scene_hash, setup, session: None })
}

/// How many they are.
fn samples(ranges: &str) -> anyhow::Result<String> {
    let ranges: SampleRanges = ranges.parse().map_err(anyhow::Error::msg)?;
    Ok(ranges.count().to_string())
}

/// Sets up a pane as options of `visavis render` say.
fn add(setup: &mut Setup, id: PaneId, options: &[String]) -> anyhow::Result<()> {
    let pairs = options.iter().filter_map(|option| option.strip_prefix("--")?.split_once('='));
    let technique = pairs.clone().find(|(name, _)| *name == "technique").map_or("path", |(_, name)| name);
    let mut pane =
        PaneSetup::of(TechniqueName::named(technique).with_context(|| format!("{technique} is no technique"))?);
    for (name, value) in pairs {
        match name {
            // the window has a size and devices of its own
            "technique" | "size" | "device" => {}
            // the window begins with the first sample
            "samples" => pane.set("spp", &samples(value)?).map_err(anyhow::Error::msg)?,
            "exposure" => setup.exposure = Some(number(value)?),
            _ if look(setup, name, value)? => {}
            _ => pane.set(name, value).map_err(anyhow::Error::msg)?,
        }
    }
    pane.check().map_err(anyhow::Error::msg)?;
    setup.panes.insert(id, pane);
    Ok(())
}

/// Sets the camera or what is changed in the scene; returns whether it is of that kind.
fn look(setup: &mut Setup, name: &str, value: &str) -> anyhow::Result<bool> {
    match name {
        "eye" => setup.eye = Some(point(value)?),
        "target" => setup.target = Some(point(value)?),
        "up" => setup.up = Some(point(value)?),
        "fov" => setup.fov = Some(number(value)?),
        EDIT => setup.changes.take_edits(&value.parse().with_context(|| format!("{EDIT} is damaged"))?),
        _ => {
            let Some(change) = of_scenes(name) else { return Ok(false) };
            let value = change.kind.parse(value);
            let value = value.map_err(|expected| anyhow::anyhow!("{name}: expected {expected}"))?;
            (change.set)(&mut setup.changes, value);
        }
    }
    Ok(true)
}

fn number(word: &str) -> anyhow::Result<f32> {
    word.parse().ok().filter(|number: &f32| number.is_finite()).with_context(|| format!("{word} is no number"))
}

fn point(word: &str) -> anyhow::Result<Vec3> {
    let numbers = word.split(',').map(number).collect::<anyhow::Result<Vec<f32>>>()?;
    let [x, y, z] = numbers[..] else { bail!("{word} is no point") };
    Ok(Vec3::new(x, y, z))
}

impl Kept {
    /// A line where the scene is no longer the one that the picture shows.
    pub fn note(&self, file: &Path, now: &Scene) -> Option<String> {
        let then = self.scene_hash?;
        (then != now.as_read).then(|| format!("its scene has changed since {} was made", shown(file)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Model, Theme};
    use film::{DisplayTransform, Image};
    use image_file::{Kind, Records};
    use scene::Camera;
    use std::sync::Arc;
    use technique::{Device, Made, PaneSettings, Provenance, SceneChanges, Shot};
    use visavis_tests::TestFolder;

    /// Two pictures of a scene that was changed and turned, as pictures and as what makes them again.
    fn pictures() -> [Provenance; 2] {
        let edits =
            "{ material.checkerboard = { odd = [0.5, 0.25, 0] }, sun.elevation = 30 }".parse().expect("changes");
        let changes = SceneChanges { refraction_ratio: Some(0.6), edits, ..SceneChanges::default() };
        let scene = scene::builtin::named("whitted").expect("a built-in scene");
        let camera = Camera { up: Vec3::new(0.2, 0.9, -0.1), ..scene.camera.orbited(0.3, 0.1) };
        let (source, own_up, size) = ("whitted".into(), scene.camera.up, (1, 1));
        let shot = Shot { source, changes, scene: Arc::new(scene), camera, own_up, size };
        let mut fake = PaneSettings::of(TechniqueName::Raster);
        fake.fake.knobs.segments = Some(9);
        let mut truth = PaneSettings::of(TechniqueName::Path);
        (truth.truth.spp, truth.truth.path.bounces) = (5, Some(3));
        [fake, truth].map(|pane| Provenance { shot: shot.clone(), technique: pane.in_use(), device: Device::Cpu })
    }

    fn written(folder: &TestFolder, name: &str, records: &Records) -> Kept {
        let (file, image) = (folder.file(name), Image::new(1, 1, [Vec3::ONE]).expect("a pixel"));
        let kind = Kind::of(&file).expect("a kind");
        let bytes = image_file::encode(kind, &image, &DisplayTransform::default(), records).expect("a picture");
        std::fs::write(&file, bytes).expect("a file");
        match read(&file).expect("records") {
            Told::Picture(kept) => kept,
            other => panic!("{other:?}"),
        }
    }

    fn restored(kept: &Kept) -> Model {
        let scene = scene::builtin::named(&kept.scene).expect("its scene");
        let mut model = Model::new(scene, kept.scene.clone(), Theme::Dark);
        model.set_up(&kept.setup).expect("a camera that sees something");
        model
    }

    #[test]
    fn a_panes_picture_is_set_up_in_a_as_it_was_made() {
        let folder = TestFolder::new();
        for (name, picture) in ["fake.png", "truth.exr"].into_iter().zip(pictures()) {
            let made = Made { spp: 5, seconds: 1.0, adapter: "", denoised_by: None, exposure: 1.5 };
            let model = restored(&written(&folder, name, &picture.records(made)));
            let technique = model.session.panes[PaneId::A].in_use();
            assert_eq!((technique, model.document.camera), (picture.technique, picture.shot.camera), "{name}");
            assert_eq!((&model.document.changes, model.session.display.exposure), (&picture.shot.changes, 1.5));
            assert!(!model.can_undo_and_redo()[0], "{name}: there is nothing behind it");
        }
    }

    #[test]
    fn of_a_range_of_samples_as_many_are_wished_for() {
        let [_, truth] = pictures();
        let made = Made { spp: 5, seconds: 1.0, adapter: "", denoised_by: None, exposure: 0.0 };
        let mut records = truth.records(made);
        records.push(("samples", "3..8".into()));
        let model = restored(&written(&TestFolder::new(), "part.exr", &records));
        assert_eq!(model.session.panes[PaneId::A].in_use(), truth.technique);
    }

    #[test]
    fn a_picture_as_seen_is_set_up_in_both_with_its_view() {
        let [fake, truth] = pictures();
        let records = vec![
            ("view", "Side by side".to_owned()),
            ("line", "horizontal at 0.25".to_owned()),
            ("exposure", "-1".to_owned()),
            fake.shot.hash_record(),
            ("A", fake.command(1, -1.0, "a.png")),
            ("B", format!("rough, in full: {}", truth.command(5, -1.0, "b.png"))),
        ];
        let kept = written(&TestFolder::new(), "seen.png", &records);
        assert_eq!(kept.scene_hash, Some(fake.shot.scene.as_read));
        let model = restored(&kept);
        let session = &model.session;
        assert_eq!([PaneId::A, PaneId::B].map(|id| session.panes[id].in_use()), [fake.technique, truth.technique]);
        assert_eq!((session.view, session.line, session.wipe), (View::SideBySide, Line::Horizontal, 0.25));
        assert_eq!((model.document.camera, session.display.exposure), (fake.shot.camera, -1.0));
    }

    #[test]
    fn a_reference_tells_its_scene_and_camera_and_a_map_what_it_is() {
        let [picture, _] = pictures();
        let owned = |records: Records| -> Vec<(String, String)> {
            records.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
        };
        let Ok(Told::Reference(kept)) = told(&owned(reference::records(&picture.shot))) else { panic!("no reference") };
        let model = restored(&kept);
        assert_eq!((model.document.camera, model.document.changes), (picture.shot.camera, picture.shot.changes));
        assert_eq!(kept.scene_hash, Some(picture.shot.scene.as_read));
        let map = vec![("map", "A - reference".to_owned()), ("colours", "signed".to_owned())];
        assert!(matches!(told(&owned(map)), Ok(Told::ErrorMap)));
    }

    #[test]
    fn other_pictures_say_nothing_and_damaged_records_are_told() {
        let folder = TestFolder::new();
        let image = Image::new(1, 1, [Vec3::ONE]).expect("a pixel");
        let [picture, _] = pictures();
        let made = Made { spp: 1, seconds: 1.0, adapter: "", denoised_by: None, exposure: 0.0 };
        let mut damaged = picture.records(made);
        damaged.iter_mut().filter(|(name, _)| *name == "eye").for_each(|(_, value)| *value = "here".into());
        for (records, said) in [(Records::new(), None), (damaged, Some("here is no number"))] {
            let file = folder.file("picture.png");
            let bytes = image_file::encode(Kind::Png, &image, &DisplayTransform::default(), &records).expect("a PNG");
            std::fs::write(&file, bytes).expect("a file");
            match (read(&file), said) {
                (Ok(Told::Nothing), None) => {}
                (Err(fault), Some(said)) => assert!(format!("{fault:#}").contains(said), "{fault:#}"),
                (other, _) => panic!("{other:?}"),
            }
        }
    }
}
