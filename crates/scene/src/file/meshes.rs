//! Meshes, statues and instances of a scene file: read or made, named, and put in their places.

use super::beside::beside;
use super::model;
use super::number::{Any, Pair, Three, Triple};
use super::raw::Table;
use super::raw_mesh::{CornerIndex, RawInstance, RawMesh, RawPlacement, RawScale, RawStatue};
use super::{Fault, advice, fault};
use crate::progress::Progress;
use crate::{Geometry, Instance, Mesh, smooth_normals, statue};
use glam::{Affine3A, EulerRot, Quat, Vec2, Vec3};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use toml::Spanned;

/// What makes meshes of tables, and what it has made.
pub struct Meshes<'a> {
    folder: &'a Path,
    progress: &'a Progress<'a>,
    named: Vec<Named>,
    /// Of each level that was asked for.
    statues: Vec<(u32, Arc<Mesh>)>,
    /// What files hold that is not shown, a line each.
    pub remarks: Vec<String>,
}

/// What instances can be of.
struct Named {
    name: String,
    mesh: Arc<Mesh>,
    material: Spanned<String>,
    /// How often it is there.
    times: usize,
}

/// A shape that a table asks for.
pub struct Made {
    pub geometry: Geometry,
    /// What it is, in a word.
    pub kind: &'static str,
    /// What the file calls it.
    pub name: Option<Spanned<String>>,
    /// What a copy is called otherwise.
    pub copied: Option<String>,
    /// The material that it wears.
    pub wears: Spanned<String>,
}

impl<'a> Meshes<'a> {
    /// Nothing so far; files lie in `folder`.
    pub fn new(folder: &'a Path, progress: &'a Progress<'a>) -> Self {
        Meshes { folder, progress, named: Vec::new(), statues: Vec::new(), remarks: Vec::new() }
    }

    /// A mesh that is written out or read from a file.
    pub fn mesh(&mut self, raw: Spanned<Table<RawMesh>>) -> Result<Made, Fault> {
        let (at, mut table) = (raw.span(), raw.into_inner());
        let placement = table.take_placement();
        let Table(RawMesh { name, positions, triangles, normals, uvs, file, smooth, material, .. }) = table;
        let mesh = match (positions, triangles, file) {
            (Some(positions), Some(triangles), None) => written(positions, triangles, normals, uvs, smooth)?,
            (None, None, Some(file)) => {
                if let Some(at) = normals.map(|normals| normals.span()).or(uvs.map(|uvs| uvs.span())) {
                    return fault(at, "a mesh that is read from a file has its normals and uvs from there");
                }
                self.read(file, smooth)?
            }
            _ => return fault(at, "expected positions and triangles, or file = \"NAME.ply\" or \"NAME.obj\" instead"),
        };
        self.placed(mesh.into(), ("mesh", name), placement, material)
    }

    fn read(&mut self, file: Spanned<String>, smooth: bool) -> Result<Mesh, Fault> {
        let at = file.span();
        let path = beside(self.folder, file.get_ref()).or_else(|why| fault(at.clone(), why))?;
        self.progress.reads(&path);
        let (mesh, remarks) = model::read(&path, smooth, self.progress).or_else(|why| fault(at, why))?;
        self.remarks.extend(remarks);
        Ok(mesh)
    }

    /// A statue; all of one level share one mesh.
    pub fn statue(&mut self, Table(raw): Table<RawStatue>) -> Result<Made, Fault> {
        let RawStatue { name, level, scale, rotate, translate, material } = raw;
        let mesh = self.statue_of(level.get()).or_else(|_| fault(material.span(), "stopped"))?;
        self.placed(mesh, ("statue", name), RawPlacement { scale, rotate, translate }, material)
    }

    fn statue_of(&mut self, level: u32) -> Result<Arc<Mesh>, crate::progress::Stopped> {
        if let Some((_, mesh)) = self.statues.iter().find(|(made, _)| *made == level) {
            return Ok(mesh.clone());
        }
        let mesh = Arc::new(statue(level, self.progress)?);
        self.statues.push((level, mesh.clone()));
        Ok(mesh)
    }

    /// What has a name once more, in another place and perhaps of another material.
    pub fn instance(&mut self, Table(raw): Table<RawInstance>) -> Result<Made, Fault> {
        let RawInstance { of, name, scale, rotate, translate, material } = raw;
        let Some(named) = self.named.iter_mut().find(|named| named.name == *of.get_ref()) else {
            let names: Vec<&str> = self.named.iter().map(|named| named.name.as_str()).collect();
            return fault(of.span(), advice::unknown_mesh(of.get_ref(), &names));
        };
        named.times += 1;
        let copied = Some(format!("{} {}", named.name, named.times));
        let geometry = put(named.mesh.clone(), RawPlacement { scale, rotate, translate }, of.span())?;
        let wears = material.unwrap_or_else(|| named.material.clone());
        Ok(Made { geometry, kind: "instance", name, copied, wears })
    }

    fn placed(
        &mut self,
        mesh: Arc<Mesh>,
        (kind, name): (&'static str, Option<Spanned<String>>),
        placement: RawPlacement,
        wears: Spanned<String>,
    ) -> Result<Made, Fault> {
        if let Some(name) = name.as_ref().map(Spanned::get_ref) {
            self.named.push(Named { name: name.clone(), mesh: mesh.clone(), material: wears.clone(), times: 1 });
        }
        let RawPlacement { scale, rotate, translate } = &placement;
        let stays = scale.is_none() && rotate.is_none() && translate.is_none();
        let geometry = match stays {
            true => Geometry::Mesh(mesh),
            false => put(mesh, placement, wears.span())?,
        };
        Ok(Made { geometry, kind, name, copied: None, wears })
    }
}

/// A mesh in its place, if it does not reach beyond what coordinates may be.
fn put(mesh: Arc<Mesh>, placement: RawPlacement, at: Range<usize>) -> Result<Geometry, Fault> {
    let instance = Instance { mesh, to_world: to_world(placement) };
    let (lo, hi) = instance.bounds();
    let reach = lo.abs().max(hi.abs()).max_element();
    match lo.is_finite() && hi.is_finite() && f64::from(reach) <= model::LARGEST {
        true => Ok(Geometry::Instance(instance)),
        false => fault(at, "this mesh reaches farther than 1e12 from 0: make scale or translate smaller"),
    }
}

/// Scaled, then turned about x, then y, then z, then moved.
fn to_world(RawPlacement { scale, rotate, translate }: RawPlacement) -> Affine3A {
    let vector = |triple: Option<Triple<Any>>| triple.map_or(Vec3::ZERO, Vec3::from);
    let scale = scale.map_or(Vec3::ONE, |RawScale(scale)| scale);
    let [x, y, z] = vector(rotate).to_array().map(f32::to_radians);
    Affine3A::from_scale_rotation_translation(scale, Quat::from_euler(EulerRot::ZYX, z, y, x), vector(translate))
}

fn written(
    positions: Vec<Triple<Any>>,
    triangles: Spanned<Vec<Three<CornerIndex>>>,
    normals: Option<Spanned<Vec<Triple<Any>>>>,
    uvs: Option<Spanned<Vec<Pair<Any>>>>,
    smooth: bool,
) -> Result<Mesh, Fault> {
    let (corners, at) = (positions.len(), triangles.span());
    let triangles = triangles.into_inner().into_iter().map(|corners| corners.0.map(CornerIndex::get));
    let triangles: Vec<[u32; 3]> = triangles.collect();
    if triangles.is_empty() {
        return fault(at, "a mesh needs a triangle at least: expected lists of three corners");
    }
    if let Some(&index) = triangles.iter().flatten().find(|&&i| i as usize >= corners) {
        return fault(at, format!("corner {index} is named, but positions has {corners}"));
    }
    let (at_normals, normals) = one_a_position("normals", normals, corners)?;
    let normals = normals.into_iter().map(Vec3::from).map(|normal| normal.as_dvec3().try_normalize());
    let Some(normals) = normals.collect::<Option<Vec<_>>>() else {
        return fault(at_normals, "a normal must not be zero");
    };
    let (_, uvs) = one_a_position("uvs", uvs, corners)?;
    let positions: Vec<Vec3> = positions.into_iter().map(Vec3::from).collect();
    let mut normals: Vec<Vec3> = normals.into_iter().map(|normal| normal.as_vec3()).collect();
    if smooth && normals.is_empty() {
        normals = smooth_normals(&positions, &triangles);
    }
    let uvs = uvs.into_iter().map(Vec2::from).collect();
    Ok(Mesh::with_attributes(positions, triangles, normals, uvs))
}

/// A list that is left out, or has as many elements as there are positions; and where it stands.
fn one_a_position<T>(
    name: &str,
    list: Option<Spanned<Vec<T>>>,
    positions: usize,
) -> Result<(Range<usize>, Vec<T>), Fault> {
    let Some(list) = list else { return Ok((0..0, Vec::new())) };
    let (at, list) = (list.span(), list.into_inner());
    match list.len() == positions {
        true => Ok((at, list)),
        false => fault(at, format!("{name} has {} elements, but positions has {positions}", list.len())),
    }
}
