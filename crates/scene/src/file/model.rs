//! A model's file, such as Stanford's PLY or Wavefront's OBJ: a mesh without materials, lights or a camera.

use super::source::{ModelFault, Source, of_the_file};
use super::{obj, ply};
use crate::progress::Progress;
use crate::{Mesh, smooth_normals};
use glam::{Vec2, Vec3};
use std::path::Path;

/// What files of models are called.
pub const KINDS: [&str; 2] = ["ply", "obj"];

/// The most triangles of a file: four statues of the finest level. Beyond it a computer is used up before anything is seen.
pub const MOST_TRIANGLES: usize = 1 << 27;

/// The most vertices, texture coordinates or normals of a file.
pub const MOST_VERTICES: usize = 1 << 27;

/// The largest coordinate, as in scene files.
pub const LARGEST: f64 = 1e12;

/// What a file holds.
#[derive(Debug, Default)]
pub struct Model {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Empty, or one at each position, of any length.
    pub normals: Vec<Vec3>,
    /// Empty, or one at each position, (0, 0) at the upper left.
    pub uvs: Vec<Vec2>,
    /// What of the file is not shown, or was changed.
    pub remarks: Vec<String>,
}

/// Whether a file's name is that of a model.
pub fn is_model(path: &Path) -> bool {
    path.extension().is_some_and(|suffix| KINDS.iter().any(|kind| suffix.eq_ignore_ascii_case(kind)))
}

/// Reads a model by the suffix of its name; with normals made from its triangles if it has none and `smooth` says so. The
/// lines beside it say what is not shown of it.
///
/// # Errors
/// One line that says what is wrong, and where in the file.
pub fn read(path: &Path, smooth: bool, progress: &Progress) -> Result<(Mesh, Vec<String>), String> {
    let name = path.file_name().map(|name| image_file::shown(Path::new(name))).unwrap_or_default();
    let read = || {
        let suffix = path.extension().unwrap_or_default().to_ascii_lowercase();
        if suffix == "glb" || suffix == "gltf" {
            return of_the_file(format!(
                "a glTF model is a scene of its own: `visavis {name}` opens it; a mesh is read from a .ply or an .obj"
            ));
        }
        if !is_model(path) {
            return of_the_file("a mesh is read from a .ply or an .obj: save it as one of these");
        }
        let (file, size) = open(path)?;
        let mut source = Source::new(file, size, &name, progress);
        let is_ply = path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("ply"));
        let model = if is_ply { ply::read(&mut source) } else { obj::read(&mut source) }?;
        mesh(model, smooth)
    };
    let told = |ModelFault { at, message }: ModelFault| {
        let at = if at.is_empty() { String::new() } else { format!(", {at}") };
        format!("{}{at}: {message}", image_file::shown(path))
    };
    let (mesh, remarks) = read().map_err(told)?;
    Ok((mesh, remarks.into_iter().map(|remark| format!("{name}: {remark}")).collect()))
}

/// A regular file and its size. Anything else, such as a pipe or a device, might never end.
fn open(path: &Path) -> Result<(std::fs::File, u64), ModelFault> {
    let unread = |why: std::io::Error| ModelFault { at: String::new(), message: format!("it cannot be read ({why})") };
    let found = std::fs::metadata(path).map_err(unread)?;
    if !found.is_file() {
        return of_the_file("this is not a file");
    }
    Ok((std::fs::File::open(path).map_err(unread)?, found.len()))
}

/// The mesh of a model, and what was left out of it.
pub fn mesh(model: Model, smooth: bool) -> Result<(Mesh, Vec<String>), ModelFault> {
    let Model { positions, triangles, mut normals, mut uvs, mut remarks } = model;
    if triangles.is_empty() {
        return of_the_file("it has no faces: a mesh needs a triangle at least");
    }
    if let Some(at) = uvs.iter().position(|uv| !uv.is_finite()) {
        remarks.push(format!("texture coordinates are left out: those of vertex {at} are {}", uvs[at]));
        uvs.clear();
    }
    let directions = normals.iter().map(|normal| normal.as_dvec3().try_normalize().map(|normal| normal.as_vec3()));
    normals = match directions.collect::<Option<Vec<_>>>() {
        Some(unit) => unit,
        None => {
            remarks.push("normals are left out: some are no directions".into());
            Vec::new()
        }
    };
    if smooth && normals.is_empty() {
        normals = smooth_normals(&positions, &triangles);
    }
    Ok((Mesh::with_attributes(positions, triangles, normals, uvs), remarks))
}

/// A coordinate that scenes can hold; `None` if it is not finite or too large. -0 is 0.
pub fn coordinate(number: f64) -> Option<f32> {
    (number.abs() <= LARGEST).then_some(number as f32 + 0.0)
}

/// Three coordinates of the vertex of this number, from 0.
///
/// # Errors
/// In words, if one is not finite or beyond what scenes hold.
pub fn position(numbers: [f64; 3], vertex: usize) -> Result<Vec3, String> {
    match numbers.map(coordinate) {
        [Some(x), Some(y), Some(z)] => Ok(Vec3::new(x, y, z)),
        _ => Err(format!("vertex {vertex} is {numbers:?}: coordinates are finite and within +-1e12")),
    }
}

/// That a file has more of something than is read.
pub fn too_many(what: &str, most: usize) -> String {
    format!("more than {most} {what}: more are not read; thin it out in a modeller")
}

/// Adds the fan of a polygon's triangles.
///
/// # Errors
/// In words, if they become too many.
pub fn add_fan(triangles: &mut Vec<[u32; 3]>, [first, before, corner]: [u32; 3]) -> Result<(), String> {
    if triangles.len() >= MOST_TRIANGLES {
        return Err(too_many("triangles", MOST_TRIANGLES));
    }
    triangles.push([first, before, corner]);
    Ok(())
}
