//! glTF 2.0, .gltf and .glb: what a file of another program holds, as a [`Scene`]. Whoever wrote the file is not trusted:
//! sizes are checked before memory is taken, and only files beside it are opened.
//!
//! What it has and this program lacks is told in [`Scene::remarks`]; what cannot be shown is refused in one line.

mod accessors;
mod buffers;
mod cameras;
mod container;
mod json;
mod lights;
mod materials;
mod meshes;
mod names;
mod nodes;
mod remarks;
mod textures;
mod uri;
mod variants;

use super::SceneError;
use crate::mesh::{Instance, Mesh};
use crate::progress::{Progress, Stopped};
use crate::stand_ins::FakeNumbers;
use crate::{Bsdf, Geometry, Material, Names, Scene, SceneHash, Shape, Variant, nesting};
use buffers::Document;
use glam::{DAffine3, Vec3};
use json::Primitive;
use materials::Materials;
use meshes::Meshes;
use names::Paths;
use nodes::Placed;
use remarks::Remarks;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

/// Triangles of small meshes, each as often as it is shown: they are taken apart into triangles of the world.
const MOST_SMALL: u64 = Mesh::MOST_COPIED;

/// Shapes that a scene may have.
const MOST_SHAPES: u64 = 1 << 20;

/// Shapes of glass, and their corners, that are looked at for overlaps: it takes the square of the one in time, and
/// memory for the other.
const MOST_GLASS: (usize, usize) = (256, 1 << 22);

/// Why a file is not shown, in one line.
#[derive(Debug)]
struct Refused(String);

impl From<Stopped> for Refused {
    fn from(_: Stopped) -> Self {
        Refused("reading was stopped".into())
    }
}

/// Reads a model as a scene of its own: with the first of its cameras, or with one that is fitted to it.
pub(super) fn load(path: &Path, progress: &Progress) -> Result<Scene, SceneError> {
    let doing = format!("reading {}", image_file::shown(path.file_name().map_or(path, Path::new)));
    progress.tell(&doing, 0.0).map_err(|Stopped| SceneError::Stopped)?;
    let read = uri::read(path, buffers::MOST_BYTES);
    let file = read.map_err(|why| SceneError::Read { path: path.to_owned(), why, meant: None })?;
    let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let folder = path.parent().unwrap_or(Path::new(""));
    scene(file, &name, folder, progress).map_err(|Refused(why)| match progress.is_stopped() {
        true => SceneError::Stopped,
        false => SceneError::Model { path: path.to_owned(), why },
    })
}

fn scene(file: Vec<u8>, name: &str, folder: &Path, progress: &Progress) -> Result<Scene, Refused> {
    let mut remarks = Remarks::default();
    let parts = container::parts(&file)?;
    let root = container::parse(&file[parts.json.clone()], &mut remarks)?;
    let named = root.buffers.iter().map(|buffer| &buffer.uri).chain(root.images.iter().map(|image| &image.uri));
    uri::files(named.flatten().map(String::as_str), folder).for_each(|file| progress.reads(&file));
    let document = Document::new(root, file, &parts, folder, buffers::MOST_BYTES)?;
    tell_of_what_stays(&document, &mut remarks);
    let placed = nodes::placed(&document, &mut remarks)?;
    let mut materials = Materials::new(&document, progress);
    let Shown { shapes, names, variants } = shapes(&document, &placed, &mut materials, (&mut remarks, progress))?;
    let materials = materials.list;
    if glass_overlaps(&shapes, &materials) {
        remarks.add("glass overlaps other glass: light is bent wrongly there");
    }
    let mut lights = lights::lights(&document, &placed, &mut remarks)?;
    lights.light_models_without(shapes.iter().map(|shape| &materials[shape.material]), &mut remarks);
    let bounds = shapes.iter().map(|shape| shape.geometry.bounds());
    let bounds = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((Vec3::ZERO, Vec3::ZERO));
    lights.tell_of_glare(bounds, &mut remarks);
    let cameras = cameras::cameras(&document, &placed, bounds, &mut remarks)?;
    let camera = cameras.first().map_or_else(|| cameras::fitted(bounds), |first| first.camera);
    let scene = Scene {
        name: name.to_owned(),
        camera,
        cameras: cameras.into(),
        materials,
        names: Names::new(names, lights.names).into(),
        variants: variants.into(),
        shapes: shapes.into(),
        sun: lights.sun,
        point_lights: lights.points,
        sky: lights.sky,
        environment: None,
        fake: FakeNumbers::default(),
        remarks: remarks.lines().collect(),
        as_read: SceneHash::default(),
    };
    Ok(Scene { as_read: SceneHash::of(&scene), ..scene })
}

fn glass_overlaps(shapes: &[Shape], materials: &[Material]) -> bool {
    let is_glass = |shape: &&Shape| matches!(materials[shape.material].bsdf, Bsdf::Dielectric { .. });
    let glass = shapes.iter().filter(is_glass).filter_map(|shape| shape.geometry.mesh_of());
    let (count, corners) = glass.fold((0, 0), |(count, corners), mesh| (count + 1, corners + mesh.positions().len()));
    count <= MOST_GLASS.0 && corners <= MOST_GLASS.1 && nesting::overlap(shapes, materials).is_some()
}

/// What no part of a picture shows.
fn tell_of_what_stays(document: &Document, remarks: &mut Remarks) {
    if !document.root.animations.is_empty() {
        remarks.add("animations are left out: the model is shown at rest");
    }
}

/// A primitive where a node shows it.
struct Use<'a> {
    primitive: &'a Primitive,
    /// Its place in its mesh.
    number: usize,
    /// Whether its mesh has no others.
    alone: bool,
    mesh: Arc<Mesh>,
    /// The set of texture coordinates that the mesh is made with, if any.
    uv_set: Option<u32>,
    material: usize,
    /// Among the nodes that are shown.
    place: usize,
    placed: &'a Placed<'a>,
}

impl Use<'_> {
    /// What faults call it by.
    fn name(&self, document: &Document) -> String {
        let index = self.placed.node.mesh.unwrap_or_default();
        let name = document.root.meshes.get(index as usize).and_then(|mesh| mesh.name.as_deref());
        format!("{}, primitive {}", named("mesh", index, name), self.number)
    }
}

/// The parts of a file that are shown.
struct Shown {
    shapes: Vec<Shape>,
    names: Vec<String>,
    variants: Vec<Variant>,
}

fn shapes(
    document: &Document,
    placed: &[Placed],
    materials: &mut Materials,
    (remarks, progress): (&mut Remarks, &Progress),
) -> Result<Shown, Refused> {
    let uses = uses(document, placed, materials, (remarks, progress))?;
    let mut times: HashMap<*const Mesh, u64> = HashMap::new();
    uses.iter().for_each(|found| *times.entry(Arc::as_ptr(&found.mesh)).or_default() += 1);
    let small = uses.iter().filter(|found| !found.mesh.is_large());
    let triangles: u64 = small.map(|found| found.mesh.triangles().len() as u64).sum();
    if triangles > MOST_SMALL {
        let line = format!("{triangles} triangles, each as often as it is shown: at most {MOST_SMALL}");
        return Err(Refused(format!("its meshes of less than {} triangles have {line}", Mesh::LARGE)));
    }
    let variants = variants::variants(document, &uses, materials, remarks)?;
    let (mut shapes, mut names) = (Vec::with_capacity(uses.len()), Vec::with_capacity(uses.len()));
    let mut paths = Paths::new(document, placed);
    for Use { mesh, material, place, placed, alone, .. } in uses {
        names.push(paths.of(place, (!alone).then_some(&*materials.list[material].name)));
        let once = times.get(&Arc::as_ptr(&mesh)) == Some(&1);
        let geometry = put(mesh, &placed.to_world, once, placed, remarks)?;
        shapes.push(Shape { geometry, material });
    }
    Ok(Shown { shapes, names, variants })
}

fn uses<'a>(
    document: &'a Document,
    all: &'a [Placed],
    materials: &mut Materials,
    (remarks, progress): (&mut Remarks, &Progress),
) -> Result<Vec<Use<'a>>, Refused> {
    let mut meshes = Meshes::new(document);
    let (mut uses, mut shown, mut worn) = (Vec::new(), 0, 0);
    for (place, placed) in all.iter().enumerate() {
        let Some(index) = placed.node.mesh else { continue };
        let Some(mesh) = document.root.meshes.get(index as usize) else {
            let count = document.root.meshes.len();
            return Err(Refused(format!("{}: mesh {index} is named, but there are {count}", placed.name())));
        };
        shown += mesh.primitives.len() as u64;
        if shown > MOST_SHAPES {
            return Err(Refused(format!("its nodes show more than {MOST_SHAPES} primitives of meshes")));
        }
        if placed.node.skin.is_some() {
            remarks.of("skins are left out: the model is shown at rest", placed.name());
        }
        let (name, alone) = (named("mesh", index, mesh.name.as_deref()), mesh.primitives.len() == 1);
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let fault = |Refused(why)| Refused(format!("{name}, primitive {number}: {why}"));
            progress.tell(&format!("reading {name}"), place as f32 / all.len() as f32)?;
            variants::count(&mut worn, primitive)?;
            let made = materials.of(primitive.material, remarks).map_err(fault)?;
            // what is plain as usual may wear pictures in a variant
            let of_variants = || variants::mappings(primitive).iter().find_map(|m| materials.uv_set_of(m.material));
            let uv_set = made.uv_set.or_else(of_variants);
            let mesh = meshes.of(primitive, uv_set, &name, remarks).map_err(fault)?;
            let material = made.index;
            uses.extend(mesh.map(|mesh| Use { primitive, number, alone, mesh, uv_set, material, place, placed }));
        }
    }
    Ok(uses)
}

/// A mesh at its place in the world: taken there if it is small and shown once, else as one of the instances that share it.
fn put(
    mesh: Arc<Mesh>,
    to_world: &DAffine3,
    once: bool,
    place: &Placed,
    remarks: &mut Remarks,
) -> Result<Geometry, Refused> {
    if *to_world == DAffine3::IDENTITY {
        return Ok(Geometry::Mesh(mesh));
    }
    let instance = Instance { mesh, to_world: to_world.as_affine3a() };
    let (lo, hi) = instance.bounds();
    let reach = lo.abs().max(hi.abs()).max_element();
    if !(instance.to_world.is_finite() && reach <= meshes::LARGEST) {
        return Err(Refused(format!("{}: its mesh reaches farther than 1e12 from 0", place.name())));
    }
    let inverse = instance.to_world.inverse();
    if !inverse.is_finite() || instance.to_world.matrix3.determinant() == 0.0 {
        // squeezed flat: there is something to be seen, but no way back
        remarks.of("what is scaled to nothing is flat", place.name());
        return Ok(Geometry::Mesh(Arc::new(Mesh::with_attributes(
            instance.positions(),
            instance.triangles(),
            Vec::new(),
            instance.mesh.uvs().to_vec(),
        ))));
    }
    let bake = once && !instance.mesh.is_large();
    Ok(if bake { Geometry::Mesh(Arc::new(instance.baked())) } else { Geometry::Instance(instance) })
}

/// What stands at an index of the file, with its name if it has one.
fn named(kind: &str, index: u32, name: Option<&str>) -> String {
    name.map_or_else(|| format!("{kind} {index}"), |name| format!("{kind} {index} {}", quoted(name)))
}

/// A text of the file in a line.
fn quoted(text: &str) -> String {
    const MOST: usize = 80;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("'{}...'", image_file::escaped(&text[..end])),
        None => format!("'{}'", image_file::escaped(text)),
    }
}

#[cfg(test)]
mod tests;
