//! A shape_list's shapes one by one, for a machine that lays them out in its own way.

use super::surfaces::Surface;
use super::{Facet, Origin, PlaneNormal, ShapeList, Shapes};
use crate::intersect::Hit;
use crate::intersect::attributes::{MeshAttributes, TriangleRow};
use crate::intersect::coincident::Groups;
use crate::intersect::disk::Disk;
use crate::intersect::primitive;
use crate::intersect::sphere::Sphere;
use scene::Vec3;
use scene::glam::DVec3;

/// A shape of a shape_list.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ListedShape {
    /// Place in the scene's order, area lights first, which decides ties.
    pub id: u32,
    /// Whether a shadow ray may meet it.
    pub shades: bool,
    pub form: ListedForm,
}

/// What it is and where.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ListedForm {
    /// Corners around it, and the plane that it is tested in.
    Quadrilateral([Vec3; 4], ListedPlane),
    Triangle([Vec3; 3], ListedPlane),
    Sphere {
        center: Vec3,
        radius: f32,
    },
    Disk {
        center: Vec3,
        normal: Vec3,
        radius: f32,
    },
}

/// A plane that all shapes in it share, bit for bit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ListedPlane {
    pub point: Vec3,
    /// Of any length but 0.
    pub normal: DVec3,
    /// How far from it the points of this shape may lie.
    pub flatness: f32,
}

impl ShapeList {
    /// Index into the scene's shapes of what a hit of this list has met.
    pub(crate) fn shape(&self, hit: &Hit) -> u32 {
        self.origins[hit.primitive as usize].shape as u32
    }

    /// What shading needs of the shapes, in the order of their ids.
    pub(crate) fn surfaces(&self) -> Vec<primitive::Surface> {
        let entry = |of: &Surface| primitive::Surface { normal: of.normal, material: of.material, light: of.light };
        self.surfaces.entries().iter().map(entry).collect()
    }

    /// What the meshes say of the shapes, in the order of their ids.
    pub(crate) fn rows(&self, attributes: &MeshAttributes) -> Vec<TriangleRow> {
        let row = |&Origin { shape, triangle }: &Origin| {
            triangle.map_or(TriangleRow::default(), |(corners, places)| attributes.row(shape, corners, places))
        };
        self.origins.iter().map(row).collect()
    }

    /// The same for a machine that sorts triangles' corners.
    pub(crate) fn sorted_rows(&self, attributes: &MeshAttributes) -> Vec<TriangleRow> {
        let sorted = |(row, origin): (TriangleRow, &Origin)| match origin.triangle {
            Some((_, places)) => row.sorted(places),
            None => row,
        };
        self.rows(attributes).into_iter().zip(&self.origins).map(sorted).collect()
    }

    /// Which of the shapes coincide.
    pub(crate) fn groups(&self) -> &Groups {
        &self.groups
    }

    /// All shapes, each kind in the order of its list.
    pub(crate) fn shapes(&self) -> impl Iterator<Item = ListedShape> {
        let shapes = &self.seen;
        let flat = shapes.facets.iter().map(|facet| (facet.place.id, shapes.form(facet)));
        let spheres = shapes
            .spheres
            .iter()
            .map(|&(of, Sphere { center, radius })| (of.id, ListedForm::Sphere { center, radius }));
        let disks = shapes.disks.iter().map(|&(of, disk)| {
            let Disk { center, normal, radius } = disk;
            (of.id, ListedForm::Disk { center, normal, radius })
        });
        let shade = |id| {
            let Shapes { facets, spheres, disks, .. } = &self.shading;
            facets.iter().any(|facet| facet.place.id == id)
                || spheres.iter().any(|sphere| sphere.0.id == id)
                || disks.iter().any(|disk| disk.0.id == id)
        };
        flat.chain(spheres).chain(disks).map(move |(id, form)| ListedShape { id, shades: shade(id), form })
    }
}

impl Shapes {
    fn form(&self, facet: &Facet) -> ListedForm {
        let corners = facet.corners.map(|corner| self.position(corner));
        let plane = self.plane_of(facet, &corners);
        let [a, b, c, d] = corners;
        if facet.corners[2] == facet.corners[3] {
            ListedForm::Triangle([a, b, c], plane)
        } else {
            ListedForm::Quadrilateral([a, b, c, d], plane)
        }
    }

    fn position(&self, corner: u16) -> Vec3 {
        let [x, y, z] = self.corners[usize::from(corner)].map(usize::from);
        Vec3::new(self.coordinates[0][x], self.coordinates[1][y], self.coordinates[2][z])
    }

    /// The plane through a corner of the first facet that lies in it.
    fn plane_of(&self, facet: &Facet, corners: &[Vec3; 4]) -> ListedPlane {
        let same = |other: &&Facet| other.normal == facet.normal && other.offset == facet.offset;
        let first = self.facets.iter().find(same).unwrap_or(facet);
        let point = self.position(first.corners[0]);
        let normal = match self.normals[usize::from(facet.normal)] {
            PlaneNormal::Axis(axis) => DVec3::AXES[axis],
            PlaneNormal::Tilted(normal) => DVec3::from_array(normal),
        };
        let off = |corner: &Vec3| normal.dot(corner.as_dvec3() - point.as_dvec3()).abs();
        let farthest = corners.iter().map(off).fold(0.0, f64::max);
        // a parallelogram is spanned from three corners: where they are off by one, it is by up to three
        let flatness = if farthest > 0.0 { ((3.0 * farthest) as f32).next_up() } else { 0.0 };
        ListedPlane { point, normal, flatness }
    }
}
