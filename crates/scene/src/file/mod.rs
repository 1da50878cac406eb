//! The scene file: TOML, described in `assets/README.md`. Text becomes a `RawScene` (shape and ranges of every
//! value), which becomes a [`Scene`] (what refers to what). Every fault is one line: `file:line:column: what`.

mod advice;
mod begun;
mod beside;
pub(crate) mod changed;
mod gltf;
mod material;
mod meshes;
mod model;
mod number;
mod obj;
mod part_names;
mod picture;
mod ply;
mod raw;
mod raw_mesh;
mod shapes;
mod showcase;
mod sky;
mod source;

use crate::direction::unit;
use crate::progress::Progress;
use crate::stand_ins::FakeNumbers;
use crate::{Camera, Names, PointLight, Scene, SceneHash, Spot, Sun, nearest};
use glam::Vec3;
use meshes::Meshes;
use part_names::PartNames;
use picture::Pictures;
use raw::{RawScene, Table};
use shapes::Shapes;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Spanned;

pub use beside::{allow_files_outside, allows_files_outside};
pub(crate) use shapes::beyond_copies;

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// Neither a built-in name nor a file.
    #[error(
        "unknown scene '{}': the built-in scenes are {known}; a file's name ends in .toml, .glb, .gltf, .ply or .obj{}",
        image_file::escaped(name),
        did_you_mean(meant)
    )]
    Unknown {
        /// What was asked for.
        name: String,
        /// The built-in names.
        known: String,
        /// That of them which was probably meant.
        meant: Option<String>,
    },
    /// A file of another kind.
    #[error(
        "{} is not a scene: a scene is a text in TOML with camera, materials and lights, whose meshes are read from .ply \
         or .obj files, or a glTF model (.glb, .gltf); `visavis cornell` is one, its file's format is described in \
         assets/README.md",
        image_file::shown(path)
    )]
    OtherFormat {
        /// Where the file lies that is no scene.
        path: PathBuf,
    },
    /// A model of another program that cannot be shown.
    #[error("{}: {why}", image_file::shown(path))]
    Model {
        /// Where the model lies.
        path: PathBuf,
        /// What is wrong with which of its parts.
        why: String,
    },
    /// The file could not be read.
    #[error("cannot read the scene file ({why}): {}{}", image_file::shown(path), did_you_mean(meant))]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        why: std::io::Error,
        /// The scene file beside it that was probably meant.
        meant: Option<String>,
    },
    /// The file does not hold a scene.
    #[error("{}:{line}:{column}: {message}", image_file::shown(path))]
    Wrong {
        /// The file.
        path: PathBuf,
        /// Line of the fault, from 1.
        line: usize,
        /// Column of the fault in characters, from 1.
        column: usize,
        /// What is wrong and what was expected.
        message: String,
    },
    /// The file does not hold a mesh: its name, the place and what is wrong.
    #[error("{0}")]
    Mesh(String),
    /// Whoever asked for it wants it no more.
    #[error("reading the scene was stopped")]
    Stopped,
}

fn did_you_mean(meant: &Option<String>) -> String {
    meant.as_ref().map_or(String::new(), |name| format!("; did you mean {}?", image_file::escaped(name)))
}

/// Suffixes of models and scenes that other programs write, and people try first.
const OTHER_FORMATS: [&str; 13] =
    ["mtl", "stl", "off", "3ds", "dae", "fbx", "abc", "usd", "usda", "usdc", "usdz", "blend", "pbrt"];

/// Largest scene file that is read, in bytes; beyond it lies no scene that TOML is the right home for.
const LARGEST_FILE: u64 = 256 << 20;

/// Reads a scene file, or the file of a model, which is put into a scene of its own.
///
/// # Errors
/// [`SceneError::OtherFormat`] if its name says so, [`SceneError::Read`] if it cannot be read, [`SceneError::Wrong`] or
/// [`SceneError::Mesh`] or [`SceneError::Model`] if it does not hold a scene or a model, [`SceneError::Stopped`] if it was told to stop.
pub fn load(path: &Path, progress: &Progress) -> Result<Scene, SceneError> {
    load_below(path, progress, &[])
}

/// As [`load`], of what the files `above` stand on, each on the next.
fn load_below(path: &Path, progress: &Progress, above: &[PathBuf]) -> Result<Scene, SceneError> {
    progress.reads(path);
    if model::is_model(path) {
        return showcase::around(path, progress);
    }
    let suffix = path.extension().unwrap_or_default().to_ascii_lowercase();
    if suffix == "gltf" || suffix == "glb" {
        return gltf::load(path, progress);
    }
    if OTHER_FORMATS.iter().any(|other| suffix == *other) {
        return Err(SceneError::OtherFormat { path: path.to_owned() });
    }
    let text = read(path).map_err(|why| {
        let missing = why.kind() == std::io::ErrorKind::NotFound;
        let meant = missing.then(|| scene_beside(path)).flatten();
        SceneError::Read { path: path.to_owned(), why, meant }
    })?;
    let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    parse_below(&text, &name, path, progress, above)
}

/// The scene file in a missing one's folder whose name is nearest to its.
fn scene_beside(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let files = std::fs::read_dir(folder).ok()?.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
    let scenes: Vec<String> = files.filter(|name| name.ends_with(".toml")).collect();
    let near = nearest(&path.file_name()?.to_string_lossy(), scenes.iter().map(String::as_str))?;
    Some(path.with_file_name(near).to_string_lossy().into_owned())
}

/// The text of a regular file. Anything else, such as a pipe or a device, might never end.
fn read(path: &Path) -> std::io::Result<String> {
    use std::io::{Error, ErrorKind, Read};
    let found = std::fs::metadata(path)?;
    if found.is_dir() {
        return Err(Error::new(ErrorKind::IsADirectory, "this is a folder: name a .toml file in it"));
    }
    if !found.is_file() {
        return Err(Error::new(ErrorKind::InvalidInput, "this is not a file"));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(Error::new(ErrorKind::FileTooLarge, format!("it has more than {LARGEST_FILE} bytes")));
    }
    let no_text = || Error::new(ErrorKind::InvalidData, "this is not a text in UTF-8: a scene is saved as one");
    String::from_utf8(bytes).map_err(|_| no_text())
}

/// Parses the text of a scene file. `path` is named in errors, and files that the scene names lie beside it.
///
/// # Errors
/// [`SceneError::Wrong`] with the place of the first fault.
pub fn parse(text: &str, name: &str, path: &Path) -> Result<Scene, SceneError> {
    parse_telling(text, name, path, &Progress::untold())
}

/// As [`parse`], telling how far it is.
///
/// # Errors
/// As those of [`parse`], and [`SceneError::Stopped`].
pub fn parse_telling(text: &str, name: &str, path: &Path, progress: &Progress) -> Result<Scene, SceneError> {
    parse_below(text, name, path, progress, &[])
}

fn parse_below(
    text: &str,
    name: &str,
    path: &Path,
    progress: &Progress,
    above: &[PathBuf],
) -> Result<Scene, SceneError> {
    if changed::is_changed(text) {
        return changed::parse(text, name, path, progress, above);
    }
    let wrong = |fault: Fault| match progress.is_stopped() {
        true => SceneError::Stopped,
        false => fault.in_file(text, path),
    };
    let raw: RawScene = advice::from_toml(text).map_err(wrong)?;
    build(raw, name, path.parent().unwrap_or(Path::new("")), progress).map_err(wrong)
}

/// A fault at a byte range of the text.
struct Fault {
    at: Range<usize>,
    message: String,
}

impl Fault {
    fn in_file(self, text: &str, path: &Path) -> SceneError {
        let (line, column) = line_and_column(text, self.at.start);
        SceneError::Wrong { path: path.to_owned(), line, column, message: self.message }
    }
}

fn fault<T>(at: Range<usize>, message: impl Into<String>) -> Result<T, Fault> {
    Err(Fault { at, message: message.into() })
}

fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

fn build(raw: RawScene, name: &str, folder: &Path, progress: &Progress) -> Result<Scene, Fault> {
    let camera = camera(raw.camera)?;
    let mut pictures = Pictures::beside(folder, progress);
    let materials = raw.material.into_iter().map(|(name, m)| material::material(name, m, &mut pictures));
    let materials = materials.collect::<Result<Vec<_>, _>>()?;
    let mut meshes = Meshes::new(folder, progress);
    let mut shapes = Shapes::wearing(&materials);
    shapes.add(raw.sphere, shapes::sphere)?;
    shapes.add(raw.rectangle, shapes::rectangle)?;
    shapes.add(raw.disk, shapes::disk)?;
    shapes.add(raw.boxes, shapes::cuboid)?;
    shapes.add(raw.mesh, |raw| meshes.mesh(raw))?;
    shapes.add(raw.statue, |raw| meshes.statue(raw))?;
    shapes.add(raw.instance, |raw| meshes.instance(raw))?;
    shapes.check()?;
    let Shapes { list: shapes, names, .. } = shapes;
    let sun = raw.sun.map(|Table(raw)| sun(raw)).transpose()?;
    let (sky, environment) = sky::sky(raw.sky.0, folder, progress)?;
    let mut light_names = PartNames::of("light");
    let point_lights = raw.point_light.into_iter().map(|Table(p)| {
        light_names.add("light", p.name, None)?;
        let spot = p.spot.map(|Table(raw)| spot(raw)).transpose()?;
        Ok(PointLight { position: p.position.into(), intensity: p.intensity.into(), spot })
    });
    let point_lights = point_lights.collect::<Result<_, Fault>>()?;
    let names = Names::new(names.all(), light_names.all());
    let (d, raw_fake) = (FakeNumbers::default(), raw.fake.0);
    let fake = FakeNumbers {
        ambient: raw_fake.ambient.map_or(d.ambient, |v| v.get()),
        intensity: raw_fake.intensity.map_or(d.intensity, |v| v.get()),
        light_position: raw_fake.light_position.map(Vec3::from),
        shadow_half_width: raw_fake.shadow_half_width.map(|v| v.get()),
        shadow_map: raw_fake.shadow_map.map_or(d.shadow_map, |v| v.get()),
        cube_map: raw_fake.cube_map.map_or(d.cube_map, |v| v.get()),
        segments: raw_fake.segments.map_or(d.segments, |v| v.get()),
    };
    let scene = Scene {
        name: name.to_owned(),
        camera,
        cameras: Arc::default(),
        materials,
        names: names.into(),
        variants: Arc::default(),
        shapes: shapes.into(),
        sun,
        point_lights,
        sky,
        environment,
        fake,
        remarks: meshes.remarks.into(),
        as_read: SceneHash::default(),
    };
    Ok(Scene { as_read: SceneHash::of(&scene), ..scene })
}

fn camera(raw: Spanned<Table<raw::RawCamera>>) -> Result<Camera, Fault> {
    let (header, Table(raw)) = (raw.span(), raw.into_inner());
    let (eye, target, fov_y) = (raw.eye.span(), raw.target.span(), raw.fov_y.span());
    let (up, near) = (raw.up.as_ref().map(Spanned::span), raw.near.as_ref().map(Spanned::span));
    let camera = Camera {
        eye: raw.eye.into_inner().into(),
        target: raw.target.into_inner().into(),
        up: raw.up.map_or(Vec3::Y, |up| up.into_inner().into()).as_dvec3().normalize_or_zero().as_vec3(),
        fov_y: raw.fov_y.into_inner().get(),
        near: raw.near.map(|v| v.into_inner().get()),
        far: raw.far.map(|v| v.get()),
    };
    let Some((value, why)) = camera.faulty_value() else { return Ok(camera) };
    let at = match value {
        "eye" => eye,
        "target" => target,
        "fov_y" => fov_y,
        "up" => up.unwrap_or(target),
        _ => near.unwrap_or(header),
    };
    fault(at, format!("the camera sees nothing: {why}"))
}

fn sun(raw: raw::RawSun) -> Result<Sun, Fault> {
    let Some(towards) = unit(Vec3::from(*raw.towards.get_ref())) else {
        return fault(raw.towards.span(), "the direction towards the sun must not be zero");
    };
    let angular_radius = raw.angular_radius.get_ref().get();
    if angular_radius >= 90.0 {
        return fault(raw.angular_radius.span(), "expected degrees below 90");
    }
    Ok(Sun { towards, angular_radius, irradiance: raw.irradiance.into() })
}

fn spot(raw: raw::RawSpot) -> Result<Spot, Fault> {
    let Some(towards) = unit(Vec3::from(*raw.towards.get_ref())) else {
        return fault(raw.towards.span(), "the direction of a spot must not be zero");
    };
    let (inner, outer) = (raw.inner.get(), raw.outer.get_ref().get());
    if outer <= inner || outer > 180.0 {
        return fault(raw.outer.span(), "expected degrees above inner and at most 180");
    }
    Ok(Spot { towards, inner, outer })
}

#[cfg(test)]
mod fuzz_tests;
#[cfg(test)]
mod mesh_tests;
#[cfg(test)]
mod tests;
