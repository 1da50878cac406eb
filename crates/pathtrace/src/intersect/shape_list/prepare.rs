//! A scene's shapes, taken apart into what they share.

use super::surfaces::{Form, Surface, Surfaces};
use super::{Facet, Place, PlaneNormal, ShapeList, Shapes};
use crate::intersect::baking::is_instanced;
use crate::intersect::coincident::{FLAT, Groups, NO_GROUP, Outline};
use crate::intersect::disk::Disk;
use crate::intersect::primitive::{area_lights_first, lights_after};
use crate::intersect::sphere::Sphere;
use crate::intersect::{NO_LIGHT, triangle_normal};
use scene::glam::DVec3;
use scene::{Bsdf, Geometry, Instance, Scene, Vec3};

/// A shape of the list.
#[derive(Debug, Clone, Copy)]
enum Piece {
    /// Corners around it; a triangle has its last one twice.
    Flat {
        corners: [Vec3; 4],
        half: bool,
    },
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

/// Where a piece of the list comes from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Origin {
    /// Index of the shape.
    pub shape: usize,
    /// Of a triangle of a mesh: corners as the mesh names them, and their places.
    pub triangle: Option<([u32; 3], [Vec3; 3])>,
}

/// A piece and what it is.
struct Part {
    origin: Origin,
    piece: Piece,
    normal: Vec3,
    material: u32,
    light: u32,
    clear: bool,
}

impl Part {
    fn outline(&self, id: u32) -> Option<Outline> {
        match self.piece {
            Piece::Flat { corners, half } => Outline::flat(id, self.light, &corners[..if half { 3 } else { 4 }]),
            Piece::Sphere { center, radius } => Some(Outline::sphere(id, self.light, Sphere { center, radius })),
            Piece::Disk { center, normal, radius } => Some(Outline::disk(id, self.light, center, normal, radius)),
        }
    }
}

impl ShapeList {
    /// Most shapes that are worth testing one by one. Measured on spheres of triangles in the Cornell box, the tree is
    /// faster beyond about 250 of them with 16 lanes, 170 with 8 and 50 with 4. One number for all, so that all see one
    /// picture.
    pub const MOST: usize = 128;

    /// The scene's shapes but for large meshes, if they are few enough; `light_of_shape` is [`crate::light::Lights::light_of_shape`] of it.
    pub fn new(scene: &Scene, light_of_shape: &[u32]) -> Option<Self> {
        // trees alone look for holes
        if scene.needs().alpha_masks {
            return None;
        }
        let parts = parts(scene, light_of_shape)?;
        let outlines: Vec<Outline> = (0..).zip(&parts).filter_map(|(id, part)| part.outline(id)).collect();
        let groups = Groups::of(&outlines, parts.len(), lights_after(scene, parts.iter().map(|part| part.light)));
        let group = |id: u32| groups.of_surface(id);
        let mut seen = Shapes::default();
        let surfaces: Vec<Surface> = (0..).zip(&parts).map(|(id, part)| seen.add(id, part, group(id))).collect();
        let reach = Reach::new(scene, &parts);
        let mut shading = Shapes::default();
        for (id, part) in (0..).zip(&parts) {
            let facet = seen.facets.iter().find(|facet| facet.place.id == id);
            // what coincides with a light may stand before it however the scene lies
            let never_shades = group(id) == NO_GROUP && facet.is_some_and(|facet| reach.is_beside(facet, &seen));
            if !never_shades {
                shading.add(id, part, group(id));
            }
        }
        let origins = parts.iter().map(|part| part.origin).collect();
        Some(ShapeList { seen, shading, surfaces: Surfaces::new(&surfaces), groups, origins })
    }

    /// Number of shapes that a ray may meet, and that a shadow ray may.
    pub fn len(&self) -> [usize; 2] {
        [&self.seen, &self.shading].map(|shapes| shapes.facets.len() + shapes.spheres.len() + shapes.disks.len())
    }
}

/// Area lights first, so that an area light in the plane of a wall wins the tie against the wall.
fn parts(scene: &Scene, light_of_shape: &[u32]) -> Option<Vec<Part>> {
    let mut parts = Vec::new();
    for index in area_lights_first(scene).filter(|index| !is_instanced(scene, &scene.shapes[*index])) {
        let shape = &scene.shapes[index];
        let material = shape.material as u32;
        let clear = matches!(scene.material_of(shape).bsdf, Bsdf::Dielectric { .. });
        let first_light = light_of_shape[index];
        let mut add = |piece, normal, light, triangle| {
            let origin = Origin { shape: index, triangle };
            parts.push(Part { origin, piece, normal, material, light, clear });
        };
        match shape.geometry {
            Geometry::Sphere { center, radius } => {
                add(Piece::Sphere { center, radius }, Vec3::ZERO, first_light, None);
            }
            Geometry::Disk { center, normal, radius } => {
                add(Piece::Disk { center, normal, radius }, normal, first_light, None);
            }
            Geometry::Mesh(ref mesh) | Geometry::Instance(Instance { ref mesh, .. })
                if mesh.triangles().len() > 2 * ShapeList::MOST =>
            {
                return None;
            }
            Geometry::Rectangle { .. } | Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
                let rectangle = matches!(shape.geometry, Geometry::Rectangle { .. });
                // of a box or mesh that shines, each triangle is a light
                let halves = first_light != NO_LIGHT && !rectangle;
                let paired = !halves && shape.geometry.mesh_of().is_none();
                for (piece, normal, at, triangle) in flat_pieces(&shape.geometry, paired) {
                    let light = if rectangle || first_light == NO_LIGHT { first_light } else { first_light + at };
                    add(piece, normal, light, triangle.filter(|_| shape.geometry.mesh_of().is_some()));
                }
            }
        }
        if parts.len() > ShapeList::MOST {
            return None;
        }
    }
    Some(parts)
}

/// A piece with its normal, its number among the triangles with area, and corners and their places of a triangle.
type FlatPiece = (Piece, Vec3, u32, Option<([u32; 3], [Vec3; 3])>);

/// Triangles with area; `paired`: two and two as the parallelogram that they came from.
fn flat_pieces(geometry: &Geometry, paired: bool) -> Vec<FlatPiece> {
    let (positions, triangles) = geometry.flat_triangles();
    let corners: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(|i| positions[i as usize])).collect();
    let size = if paired { 2 } else { 1 };
    let mut pieces = Vec::new();
    let mut count = 0;
    for (pair, indices) in corners.chunks(size).zip(triangles.chunks(size)) {
        let normals: Vec<Option<Vec3>> = pair.iter().map(|&corners| triangle_normal(corners)).collect();
        if let ([[a, b, c], [.., d]], [Some(normal), Some(_)]) = (pair, &normals[..]) {
            pieces.push((Piece::Flat { corners: [*a, *b, *c, *d], half: false }, *normal, 0, None));
            continue;
        }
        for ((places @ [a, b, c], normal), indices) in pair.iter().zip(normals).zip(indices) {
            if let Some(normal) = normal {
                let piece = Piece::Flat { corners: [*a, *b, *c, *c], half: true };
                pieces.push((piece, normal, count, Some((*indices, *places))));
                count += 1;
            }
        }
    }
    pieces
}

impl Shapes {
    /// Adds a piece; what shading needs of it.
    fn add(&mut self, id: u32, part: &Part, group: u32) -> Surface {
        let Part { piece, normal, material, light, clear, .. } = *part;
        let place = Place { id, light, group, clear };
        let form = match piece {
            Piece::Flat { corners, half } => {
                let flatness = self.add_facet(place, corners, half);
                let [a, b, c, d] = corners;
                let last = if half { c } else { d };
                Form::Flat { corner: a, edge_u: b - a, edge_v: last - a, half, flatness }
            }
            Piece::Sphere { center, radius } => {
                self.spheres.push((place, Sphere { center, radius }));
                Form::Sphere { center, radius }
            }
            Piece::Disk { center, normal, radius } => {
                self.disks.push((place, Disk { center, normal, radius }));
                Form::Disk { center }
            }
        };
        Surface { form, normal, material, light }
    }

    /// Adds a facet; how far its points may lie from the plane that it is given.
    fn add_facet(&mut self, place: Place, corners: [Vec3; 4], half: bool) -> f32 {
        let (normal, offset, flatness) = self.plane(corners);
        let corners = corners.map(|corner| self.corner(corner));
        let [a, b, c, d] = corners;
        let around = if half { [[a, b], [b, c], [c, a], [c, a]] } else { [[a, b], [b, c], [c, d], [d, a]] };
        let sides = around.map(|[from, to]| self.edge(from, to));
        self.facets.push(Facet {
            place,
            edges: sides.map(|(edge, _)| edge),
            turned: sides.map(|(_, turned)| if turned { 0x8000_0000 } else { 0 }),
            corners,
            normal,
            offset,
        });
        flatness
    }

    fn corner(&mut self, corner: Vec3) -> u16 {
        let places = [0, 1, 2].map(|axis| {
            // +0.0 and -0.0 are one place
            let coordinate = corner[axis] + 0.0;
            place_of(&mut self.coordinates[axis], |&known| known == coordinate, coordinate)
        });
        place_of(&mut self.corners, |&known| known == places, places)
    }

    /// An edge's place, and whether it is stored the other way round.
    fn edge(&mut self, from: u16, to: u16) -> (u16, bool) {
        let sorted = [from.min(to), from.max(to)];
        (place_of(&mut self.edges, |&known| known == sorted, sorted), from > to)
    }

    /// The plane of some corners: the place of its normal, its offset, and how far the corners lie from it. Planes that
    /// are parallel, or even the same, but for rounding become so exactly: then rays meet shapes of one plane at one
    /// distance, and ties are ties.
    fn plane(&mut self, corners: [Vec3; 4]) -> (u16, f64, f32) {
        let [a, b, c, d] = corners.map(|corner| corner.as_dvec3());
        if let Some(axis) = (0..3).find(|&axis| [b, c, d].iter().all(|p| p[axis] == a[axis])) {
            let normal = PlaneNormal::Axis(axis);
            return (place_of(&mut self.normals, |&known| known == normal, normal), a[axis], 0.0);
        }
        let largest = corners.iter().map(|p| f64::from(p.abs().max_element())).fold(0.0, f64::max);
        let own = (b - a).cross(d - a).normalize();
        let range = |normal: DVec3| {
            [a, b, c, d]
                .map(|p| normal.dot(p))
                .into_iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), k| (lo.min(k), hi.max(k)))
        };
        let parallel = |normal: &PlaneNormal| {
            let PlaneNormal::Tilted(normal) = *normal else { return false };
            let normal = DVec3::from_array(normal);
            let (lo, hi) = range(normal);
            normal.cross(own).length() < 1e-4 && hi - lo <= FLAT * largest
        };
        let normal = place_of(&mut self.normals, parallel, PlaneNormal::Tilted(own.to_array()));
        let PlaneNormal::Tilted(shared) = self.normals[usize::from(normal)] else { return (normal, 0.0, 0.0) };
        let (lo, hi) = range(DVec3::from_array(shared));
        let middle = 0.5 * (lo + hi);
        let same = |facet: &&Facet| facet.normal == normal && (facet.offset - middle).abs() <= FLAT * largest;
        let offset = self.facets.iter().find(same).map_or(middle, |facet| facet.offset);
        // a parallelogram is spanned from three corners: where they are off by one, it is by up to three
        let off = 3.0 * (hi - offset).abs().max((lo - offset).abs());
        (normal, offset, (off as f32).next_up())
    }
}

/// The place of a value in a list, where it is put if it is not there yet.
fn place_of<T>(list: &mut Vec<T>, is_it: impl Fn(&T) -> bool, value: T) -> u16 {
    let place = list.iter().position(is_it).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    });
    place as u16
}

/// How far the scene goes, for planes that no shadow ray can cross.
struct Reach {
    /// Points within the scene's hull, and how far around them it goes.
    balls: Vec<(DVec3, f64)>,
    /// Whether there is a sun or a sky that is sampled: then shadow rays leave the hull.
    endless: bool,
}

impl Reach {
    fn new(scene: &Scene, parts: &[Part]) -> Self {
        let mut balls: Vec<(DVec3, f64)> =
            scene.point_lights.iter().map(|light| (light.position.as_dvec3(), 0.0)).collect();
        for part in parts {
            match part.piece {
                Piece::Flat { corners, .. } => balls.extend(corners.map(|corner| (corner.as_dvec3(), 0.0))),
                Piece::Sphere { center, radius } | Piece::Disk { center, radius, .. } => {
                    balls.push((center.as_dvec3(), f64::from(radius)));
                }
            }
        }
        for shape in scene.shapes.iter().filter(|shape| is_instanced(scene, shape)) {
            let (low, high) = shape.geometry.bounds();
            let (low, high) = (low.as_dvec3(), high.as_dvec3());
            balls.push((0.5 * (low + high), 0.5 * (high - low).length()));
        }
        Reach { balls, endless: scene.sun.is_some() || scene.environment.is_some() }
    }

    /// Whether all that shadow rays go between lies on one side of a facet's plane: then none meets it before its end.
    fn is_beside(&self, facet: &Facet, shapes: &Shapes) -> bool {
        let (normal, exact) = match shapes.normals[usize::from(facet.normal)] {
            PlaneNormal::Axis(axis) => (DVec3::AXES[axis], true),
            PlaneNormal::Tilted(normal) => (DVec3::from_array(normal), false),
        };
        let on_side = |sign: f64| {
            self.balls.iter().all(|&(center, radius)| {
                // a corner lies on an axis-parallel plane or it does not: an area light just behind a wall is in its
                // shadow
                let corner = exact && radius == 0.0;
                let rounding = if corner { 0.0 } else { FLAT * (normal * center).abs().element_sum() };
                sign * (normal.dot(center) - facet.offset) - radius >= -rounding
            })
        };
        !self.endless && (on_side(1.0) || on_side(-1.0))
    }
}
