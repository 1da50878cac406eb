//! A scene around a model that is opened by itself: on a grey floor, under sun and sky, seen as a whole.

use super::{SceneError, model, parse};
use crate::progress::Progress;
use crate::{Geometry, Names, Scene, SceneHash, Shape};
use glam::Vec3;
use std::path::Path;
use std::sync::Arc;

/// Half the height of the picture over the distance, of a camera with 35 degrees.
const HALF_HEIGHT: f32 = 0.315;

/// From where it is seen: from the front, a little from the right and from above.
const SEEN_FROM: Vec3 = Vec3::new(0.45, 0.3, 1.0);

/// Reads a model and builds the scene around it.
///
/// # Errors
/// [`SceneError::Read`] if there is no such file, [`SceneError::Mesh`] if it holds no model.
pub fn around(path: &Path, progress: &Progress) -> Result<Scene, SceneError> {
    std::fs::metadata(path).map_err(|why| SceneError::Read { path: path.to_owned(), why, meant: None })?;
    let stopped = |why| if progress.is_stopped() { SceneError::Stopped } else { SceneError::Mesh(why) };
    let (mesh, remarks) = model::read(path, false, progress).map_err(stopped)?;
    let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let room = room(mesh.bounds()).and_then(|text| parse(&text, &name, path).ok()).ok_or_else(|| {
        SceneError::Mesh(format!("{}: it is too small, too large or too far away to be seen", image_file::shown(path)))
    })?;
    let shape = Shape { geometry: Geometry::Mesh(Arc::new(mesh)), material: 1 };
    let shapes = room.shapes.iter().cloned().chain([shape]).collect();
    let names = room.names.shapes.iter().cloned().chain([called(&name)]).collect();
    let names = Names::new(names, Vec::new()).into();
    let scene = Scene { shapes, names, remarks: remarks.into(), ..room };
    Ok(Scene { as_read: SceneHash::of(&scene), ..scene })
}

/// The model, by the name of its file in one line.
fn called(stem: &str) -> String {
    image_file::escaped(stem).replace('/', "_")
}

/// The text of a scene with the floor and the camera for a model with these bounds; `None` if it is next to nothing.
fn room((lo, hi): (Vec3, Vec3)) -> Option<String> {
    let (middle, reach) = (0.5 * (lo + hi), 0.5 * (hi - lo).length());
    if !(reach > 1e-5 * middle.abs().max_element() && reach > 1e-11) {
        return None;
    }
    let eye = middle + SEEN_FROM.normalize() * (reach / HALF_HEIGHT);
    let (corner, side) = (middle - 20.0 * reach, 40.0 * reach);
    Some(format!(
        "[camera]\neye = {eye:?}\ntarget = {middle:?}\nfov_y = 35\n\
         [sky]\nradiance = [0.5, 0.6, 0.8]\n\
         [sun]\ntowards = [0.6, 1, 0.5]\nangular_radius = 1\nirradiance = [2.2, 2.1, 1.9]\n\
         [material.floor]\ndiffuse = {{ albedo = [0.4, 0.4, 0.4] }}\n\
         [material.model]\ndiffuse = {{ albedo = [0.7, 0.7, 0.7] }}\n\
         [[rectangle]]\ncorner = [{:?}, {:?}, {:?}]\nedge_u = [0, 0, {side:?}]\nedge_v = [{side:?}, 0, 0]\n\
         name = \"floor\"\n\
         material = \"floor\"\n",
        corner.x,
        lo.y,
        corner.z,
        eye = eye.to_array(),
        middle = middle.to_array(),
    ))
}
