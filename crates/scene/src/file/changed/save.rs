//! Files of changed scenes, taken apart and written.

use super::{CameraChange, MOST_FILES, Said, is_built_in, is_changed};
use crate::edit::{Edits, quoted};
use crate::file::beside::is_inside;
use crate::progress::Progress;
use crate::{Vec3, builtin};
use std::fmt::Write;
use std::path::Path;

/// A scene, and what is changed in it.
#[derive(Debug, Clone, PartialEq)]
pub struct ChangedScene {
    /// What is changed: a built-in name, or a file as this program finds it.
    pub base: String,
    /// Where it is seen from instead.
    pub camera: Option<CameraChange>,
    /// What is changed in it, part by part.
    pub edits: Edits,
}

impl ChangedScene {
    /// The text of its file in this folder, which names the base as it finds it; for no folder by its whole path.
    pub fn text_in(&self, folder: &Path) -> String {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        file_text(&base_from(&folder, &self.base), self.camera.as_ref(), &self.edits)
    }

    /// What a file says; `None` if it is none of a changed scene, or is faulty.
    fn read(path: &Path) -> Option<Self> {
        let text = super::super::read(path).ok().filter(|text| is_changed(text))?;
        let Said { base, camera, edits } = Said::read(&text).ok()?;
        let base = base.into_inner();
        let base = match is_built_in(&base) {
            true => base,
            false => path.parent().unwrap_or(Path::new("")).join(base).to_str()?.to_owned(),
        };
        Some(ChangedScene { base, camera: camera.map(|camera| camera.get_ref().into()), edits })
    }
}

/// The text of a file of a changed scene. `base` is a built-in name, or a file as the folder finds it that the text is
/// written into ([`paths::file_from`](crate::paths::file_from)).
pub fn file_text(base: &str, camera: Option<&CameraChange>, edits: &Edits) -> String {
    let mut text = String::from(
        "# A changed scene: its base, with what is stated below in place of what the base says.\n\
         # `visavis THIS_FILE` opens it. What can be changed is described in assets/README.md.\n",
    );
    if builtin::text(base).is_none() && !is_inside(Path::new(base)) {
        text += "# Its base lies outside of this folder: --allow-outside lets it be read.\n";
    }
    _ = writeln!(text, "base = {}", quoted(base));
    if let Some(CameraChange { eye, target, up, fov_y }) = camera {
        text += "\n[camera]\n";
        for (name, vector) in [("eye", eye), ("target", target), ("up", up)] {
            vector.iter().for_each(|Vec3 { x, y, z }| _ = writeln!(text, "{name} = [{x:?}, {y:?}, {z:?}]"));
        }
        fov_y.iter().for_each(|fov_y| _ = writeln!(text, "fov_y = {fov_y:?}"));
    }
    if !edits.is_empty() {
        text += "\n";
        text += &edits.tables();
    }
    text
}

/// A base as a file in this folder names it.
fn base_from(folder: &Path, base: &str) -> String {
    match builtin::text(base) {
        Some(_) => base.to_owned(),
        None => crate::paths::file_from(folder, Path::new(base)).display().to_string(),
    }
}

/// A changed scene's file by what it stands on in the end, be it through others; `None` if it is no such file, if it is
/// faulty, or if what is changed in several files cannot be said in one.
pub fn flattened(path: &Path, progress: &Progress) -> Option<ChangedScene> {
    let mut whole = ChangedScene::read(path)?;
    for _ in 1..MOST_FILES {
        if is_built_in(&whole.base) {
            return Some(whole);
        }
        let Some(below) = ChangedScene::read(Path::new(&whole.base)) else { return Some(whole) };
        let scene = builtin::named_telling(&below.base, progress).ok()?;
        whole = together(&below, whole.camera, &whole.edits, &scene)?;
    }
    Some(whole)
}

/// What is changed of a scene's base by the scene itself, and then by these.
fn together(
    below: &ChangedScene,
    camera: Option<CameraChange>,
    edits: &Edits,
    base: &crate::Scene,
) -> Option<ChangedScene> {
    let camera = camera.map(|camera| camera.over(&below.camera.unwrap_or_default())).or(below.camera);
    Some(ChangedScene { base: below.base.clone(), camera, edits: edits.after(&below.edits, base)? })
}

/// What the file of a scene's changes is to say. `source` is what the scene was opened by, a built-in name or a file;
/// where that is a changed scene itself, the new file stands on the same base, unless one file cannot say both changes.
/// Reads the base that it stands on.
pub fn to_save(source: &str, camera: Option<CameraChange>, edits: &Edits, progress: &Progress) -> ChangedScene {
    let on_base = || {
        let below = flattened(Path::new(source), progress).filter(|_| builtin::text(source).is_none())?;
        let base = builtin::named_telling(&below.base, progress).ok()?;
        together(&below, camera, edits, &base)
    };
    on_base().unwrap_or_else(|| ChangedScene { base: source.to_owned(), camera, edits: edits.clone() })
}
