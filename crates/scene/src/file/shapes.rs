//! The shapes of a scene file: their geometry, what they wear and what they are called.

use super::meshes::Made;
use super::part_names::PartNames;
use super::raw::{RawBox, RawDisk, RawRectangle, RawSphere, Table};
use super::{Fault, advice, fault};
use crate::{Geometry, Instance, Material, Mesh, Shape, limits, nesting};
use glam::Vec3;
use std::ops::Range;
use toml::Spanned;

/// The shapes of a file, in the order of the scene.
pub struct Shapes<'a> {
    materials: &'a [Material],
    pub list: Vec<Shape>,
    pub names: PartNames,
    /// Where the file says what they wear.
    places: Vec<Range<usize>>,
}

impl<'a> Shapes<'a> {
    /// None so far, of these materials.
    pub fn wearing(materials: &'a [Material]) -> Self {
        Shapes { materials, list: Vec::new(), names: PartNames::of("shape"), places: Vec::new() }
    }

    /// What tables of one kind ask for.
    pub fn add<T>(&mut self, raw: Vec<T>, mut make: impl FnMut(T) -> Result<Made, Fault>) -> Result<(), Fault> {
        raw.into_iter().try_for_each(|raw| self.push(make(raw)?))
    }

    fn push(&mut self, Made { geometry, kind, name, copied, wears }: Made) -> Result<(), Fault> {
        let found = self.materials.iter().position(|material| material.name == *wears.get_ref());
        let Some(material) = found else {
            let names: Vec<&str> = self.materials.iter().map(|material| material.name.as_str()).collect();
            return fault(wears.span(), advice::unknown_material(wears.get_ref(), &names));
        };
        self.names.add(kind, name, copied)?;
        self.list.push(Shape { geometry, material });
        self.places.push(wears.span());
        Ok(())
    }

    /// What each table may ask for, and all together may not.
    pub fn check(&self) -> Result<(), Fault> {
        self.check_copies()?;
        self.check_glass()
    }

    /// Small meshes that are copied have at most [`Mesh::MOST_COPIED`] triangles.
    fn check_copies(&self) -> Result<(), Fault> {
        let Some(at) = beyond_copies(&self.list) else { return Ok(()) };
        let most = Mesh::MOST_COPIED;
        let line = format!(
            "instances of meshes below {} triangles have more than {most} triangles together: give them larger meshes, \
             which keep one tree for all",
            Mesh::LARGE
        );
        fault(self.places[at].clone(), line)
    }

    fn check_glass(&self) -> Result<(), Fault> {
        let Some((first, second)) = nesting::overlap(&self.list, self.materials) else { return Ok(()) };
        let other = self.list[first].geometry.center();
        fault(
            self.places[second].clone(),
            format!(
                "this glass overlaps the glass around {other}: glass shapes must lie apart, or one wholly inside the \
                 other, and their flat faces must not touch"
            ),
        )
    }
}

/// The first shape with which small meshes that are copied have more than [`Mesh::MOST_COPIED`] triangles.
pub(crate) fn beyond_copies(shapes: &[Shape]) -> Option<usize> {
    let mut copied = 0;
    shapes.iter().position(|shape| {
        if let Geometry::Instance(Instance { mesh, .. }) = &shape.geometry {
            copied += if mesh.is_large() { 0 } else { mesh.triangles().len() as u64 };
        }
        copied > Mesh::MOST_COPIED
    })
}

/// What is no copy of a mesh.
fn made(geometry: Geometry, name: Option<Spanned<String>>, wears: Spanned<String>) -> Made {
    Made { kind: geometry.kind(), geometry, name, copied: None, wears }
}

pub fn sphere(Table(raw): Table<RawSphere>) -> Result<Made, Fault> {
    Ok(made(Geometry::Sphere { center: raw.center.into(), radius: raw.radius.get() }, raw.name, raw.material))
}

pub fn rectangle(Table(raw): Table<RawRectangle>) -> Result<Made, Fault> {
    let (at, edge_u, edge_v) = (raw.edge_v.span(), Vec3::from(raw.edge_u), Vec3::from(raw.edge_v.into_inner()));
    if !limits::spans(edge_u, edge_v) {
        return fault(at, "edge_u and edge_v must span an area, and be 1e-12 long at least");
    }
    Ok(made(Geometry::Rectangle { corner: raw.corner.into(), edge_u, edge_v }, raw.name, raw.material))
}

pub fn disk(Table(raw): Table<RawDisk>) -> Result<Made, Fault> {
    let (at, normal) = (raw.normal.span(), Vec3::from(raw.normal.into_inner()));
    let Some(normal) = normal.as_dvec3().try_normalize().map(|n| n.as_vec3()) else {
        return fault(at, "the normal of a disk must not be zero");
    };
    let geometry = Geometry::Disk { center: raw.center.into(), normal, radius: raw.radius.get() };
    Ok(made(geometry, raw.name, raw.material))
}

pub fn cuboid(Table(raw): Table<RawBox>) -> Result<Made, Fault> {
    let geometry = Geometry::Box { corner: raw.corner.into(), size: raw.size.into(), turn_y: raw.turn_y.get() };
    Ok(made(geometry, raw.name, raw.material))
}
