//! Files of changed scenes: `base = ".."`, the scene that they stand on, and what is changed in it. The base is read as
//! it is, with its own faults; a fault of the changes has its place in the file that states them.

mod camera;
mod save;

pub use camera::CameraChange;
pub use save::{ChangedScene, file_text, flattened, to_save};

use super::beside::beside;
use super::raw::Table;
use super::{Fault, SceneError, advice, fault, load_below};
use crate::edit::{Change, Edits, Refused, Subject, Wrong, edits_of};
use crate::progress::Progress;
use crate::{Scene, SceneHash, builtin};
use camera::RawCameraChange;
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Files of changed scenes that stand on one another.
const MOST_FILES: usize = 8;

/// The table of changes.
const EDIT: &str = "edit";

/// Whether a text is a changed scene's: whether `base` stands among the names before its first table.
pub(super) fn is_changed(text: &str) -> bool {
    let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim_start);
    let mut lines = lines.take_while(|line| !line.starts_with('['));
    lines.any(|line| {
        let behind = ["base", "\"base\"", "'base'"].iter().find_map(|name| line.strip_prefix(name));
        behind.is_some_and(|behind| behind.trim_start().starts_with('='))
    })
}

/// What such a file says.
struct Said {
    base: Spanned<String>,
    camera: Option<Spanned<RawCameraChange>>,
    edits: Edits,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawChanged {
    base: Spanned<String>,
    camera: Option<Spanned<Table<RawCameraChange>>>,
    #[serde(rename = "edit")]
    _edit: Option<IgnoredAny>,
}

impl Said {
    fn read(text: &str) -> Result<Self, Fault> {
        let RawChanged { base, camera, .. } = advice::from_toml(text)?;
        let camera = camera.map(|camera| Spanned::new(camera.span(), camera.into_inner().0));
        // once more, with the place of each value
        let edits = tables(text).and_then(|mut table| table.remove(EDIT)).map(edits_of).transpose();
        let edits = edits.or_else(|Wrong { at, message }| fault(at, message))?;
        Ok(Said { base, camera, edits: edits.unwrap_or_default() })
    }
}

fn tables(text: &str) -> Option<DeTable<'_>> {
    DeTable::parse(text).ok().map(Spanned::into_inner)
}

/// The changed scene of a text. The files `above` stand on it, each on the next.
pub(super) fn parse(
    text: &str,
    name: &str,
    path: &Path,
    progress: &Progress,
    above: &[PathBuf],
) -> Result<Scene, SceneError> {
    let wrong = |fault: Fault| fault.in_file(text, path);
    let Said { base, camera, edits } = Said::read(text).map_err(wrong)?;
    let at = base.span();
    let scene = scene_of(base.get_ref(), path, progress, above).map_err(|why| match why {
        Unread::Base(fault) => fault,
        Unread::Name(message) => wrong(Fault { at, message }),
    })?;
    let edited = edits.apply(&scene).map_err(|Refused { change, why }| {
        let at = tables(text).map_or(0..0, |table| place_of(&table, &change));
        wrong(Fault { at, message: why })
    })?;
    let camera = camera.map_or(Ok(scene.camera), |camera| camera::changed(camera, &scene.camera)).map_err(wrong)?;
    let remarks = edited.remarks.iter().cloned().chain(edits.without_effect(&edited)).collect();
    let scene = Scene { name: name.to_owned(), camera, remarks, ..edited };
    Ok(Scene { as_read: SceneHash::of(&scene), ..scene })
}

/// Why there is no base.
enum Unread {
    /// What is wrong in it.
    Base(SceneError),
    /// What is wrong with its name.
    Name(String),
}

/// The scene that a file stands on.
fn scene_of(base: &str, path: &Path, progress: &Progress, above: &[PathBuf]) -> Result<Scene, Unread> {
    let told = |fault: SceneError| match fault {
        SceneError::Unknown { .. } | SceneError::OtherFormat { .. } | SceneError::Read { .. } => {
            Unread::Name(fault.to_string())
        }
        of_base => Unread::Base(of_base),
    };
    if above.len() >= MOST_FILES {
        return Err(Unread::Name(format!(
            "more than {MOST_FILES} files of changed scenes stand on one another: let one of them name this one's base"
        )));
    }
    if is_built_in(base) {
        return builtin::named_telling(base, progress).map_err(told);
    }
    let file = beside(path.parent().unwrap_or(Path::new("")), base).map_err(Unread::Name)?;
    let above: Vec<PathBuf> = above.iter().cloned().chain([path.to_owned()]).collect();
    if let Some(first) = above.iter().position(|above| image_file::is_same_file(above, &file)) {
        let ring: Vec<String> = above[first..].iter().chain([&file]).map(|file| image_file::shown(file)).collect();
        return Err(Unread::Name(format!("a scene cannot stand on itself: {}", ring.join(" stands on "))));
    }
    load_below(&file, progress, &above).map_err(told)
}

/// Whether it is the name of a built-in scene, or would be one but for a slip: files have a suffix or a folder.
fn is_built_in(base: &str) -> bool {
    let path = Path::new(base);
    builtin::text(base).is_some() || (path.extension().is_none() && path.components().count() <= 1)
}

/// Where a change is stated, or else the table that it is in.
fn place_of(table: &DeTable, change: &Change) -> Range<usize> {
    let of_subject = |subject: &Subject| match subject {
        Subject::Material(name) => vec!["material", name].into_iter().map(str::to_owned).collect(),
        Subject::Shape(name) => vec!["shape".to_owned(), name.clone()],
        Subject::Light(name) => vec!["light".to_owned(), name.clone()],
        Subject::Sun => vec!["sun".to_owned()],
        Subject::Sky => vec!["sky".to_owned()],
    };
    let names = match change {
        Change::Variant => vec!["variant".to_owned()],
        Change::All(subject) => of_subject(subject),
        Change::One(subject, property) => of_subject(subject).into_iter().chain([(*property).to_owned()]).collect(),
    };
    let (mut table, mut at) = (Some(table), 0..0);
    for name in [EDIT].into_iter().chain(names.iter().map(String::as_str)) {
        let Some((key, value)) = table.and_then(|table| table.get_key_value(name)) else { break };
        at = key.span();
        table = if let DeValue::Table(table) = value.get_ref() { Some(table) } else { None };
    }
    at
}

#[cfg(test)]
mod tests;
