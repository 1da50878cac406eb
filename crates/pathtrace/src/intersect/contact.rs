//! Shapes that touch are held apart by what f32 cannot tell.
//!
//! Around a point of contact two surfaces are nearer than the step that a ray takes off one of them: it would start
//! behind the other, and light would leak. That region is not small: a sphere on a plane is within `d` of it in a circle
//! of radius `sqrt(2 r d)`. So where surfaces touch, or miss each other by less than those steps, a sphere's radius
//! shrinks, of two spheres that of the larger, and a flat face of glass moves inwards, by about 1e-6 of the coordinates
//! there. Never by more than a small share of the shape, see [`most_of_sphere`] and [`MOST_OF_GLASS`]: what is smaller
//! than that where it is stays as it is, and so does what cuts deeper into each other, and what shines. Opaque flat faces
//! are left to [`super::coincident`]. Large meshes, which are instances of trees of their own, are not asked about: what
//! stands on one is not held apart from it. One of glass moves inwards itself, as the box around it does.

use super::baking::is_instanced;
use super::coincident::overlap;
use super::gamma;
use super::pairs::{Bounds, SortedBoxes, for_each_pair, meet};
use rayon::prelude::*;
use scene::glam::{DAffine3, DVec3};
use scene::{Bsdf, Geometry, Instance, Mesh, Scene, Shape, Vec3};
use std::borrow::Cow;
use std::sync::OnceLock;

/// The scene with those shapes held apart that touch.
pub(crate) fn held_apart(scene: &Scene) -> Cow<'_, Scene> {
    let is_sphere = |shape: &Shape| matches!(shape.geometry, Geometry::Sphere { .. });
    let gives_way = |shape: &Shape| is_glass(scene, shape) || (is_sphere(shape) && !scene.material_of(shape).shines());
    if !scene.shapes.iter().any(gives_way) {
        return Cow::Borrowed(scene);
    }
    let bounds: Vec<Bounds> = scene.shapes.iter().map(|shape| grown(shape.geometry.bounds())).collect();
    let mut neighbours = vec![Vec::new(); scene.shapes.len()];
    for_each_pair(&bounds, |a, b| {
        for (one, other) in [(a, b), (b, a)] {
            if gives_way(&scene.shapes[one]) && !is_instanced(scene, &scene.shapes[other]) {
                neighbours[one].push(other);
            }
        }
    });
    // of flat shapes that spheres ask about
    let faces: Vec<OnceLock<SortedFaces>> = scene.shapes.iter().map(|_| OnceLock::new()).collect();
    let apart = |(index, neighbours): (usize, Vec<usize>)| {
        let shape = &scene.shapes[index];
        let others = neighbours.iter().map(|other| (&scene.shapes[*other].geometry, &faces[*other]));
        let moved = match shape.geometry {
            Geometry::Sphere { center, radius } => smaller_sphere(center, radius, others),
            _ if is_instanced(scene, shape) => smaller_instance(&shape.geometry, others.map(|(geometry, _)| geometry)),
            _ if is_glass(scene, shape) => moved_inwards(&shape.geometry, others.map(|(geometry, _)| geometry)),
            _ => None,
        };
        Some((index, moved?))
    };
    let moved: Vec<(usize, Geometry)> = neighbours.into_par_iter().enumerate().filter_map(apart).collect();
    if moved.is_empty() {
        return Cow::Borrowed(scene);
    }
    let mut shapes = scene.shapes.to_vec();
    moved.into_iter().for_each(|(index, geometry)| shapes[index].geometry = geometry);
    Cow::Owned(Scene { shapes: shapes.into(), ..scene.clone() })
}

fn is_glass(scene: &Scene, shape: &Shape) -> bool {
    matches!(scene.material_of(shape).bsdf, Bsdf::Dielectric { .. })
}

/// Bounds with room for all that counts as a touch.
fn grown((low, high): Bounds) -> Bounds {
    let room = Vec3::splat(1e-5 * low.abs().max(high.abs()).max_element());
    (low - room, high + room)
}

/// The largest step off a surface that is at a right angle to `normal`, and whose points are sums of such coordinates.
fn step(normal: DVec3, coordinates: DVec3) -> f64 {
    f64::from(gamma(12)) * normal.abs().dot(coordinates)
}

/// How far apart two surfaces have to be, so that a step off either stays before the other: the point that it starts from
/// is off by as much again.
fn gap(steps: [f64; 2]) -> f64 {
    2.0 * steps[0].max(steps[1])
}

/// A sphere with the radius that other shapes leave it; `None` if they leave it as it is.
fn smaller_sphere<'a>(center: Vec3, radius: f32, others: impl Iterator<Item = Other<'a>>) -> Option<Geometry> {
    let smaller = others.map(|other| radius_beside(other, center, radius)).fold(radius, f32::min);
    (smaller < radius).then_some(Geometry::Sphere { center, radius: smaller })
}

/// The most that the radius of a sphere may shrink by: what its place is known to, and at least a share that nobody sees.
fn most_of_sphere(center: DVec3, radius: f64) -> f64 {
    (4e-6 * center.abs().max_element()).clamp(2e-4 * radius, 2e-3 * radius)
}

fn radius_beside(other: Other, center: Vec3, radius: f32) -> f32 {
    let (c, r) = (center.as_dvec3(), f64::from(radius));
    let apart = |touch: Touch| {
        let own = step(touch.normal, c.abs() + touch.normal.abs() * r);
        // beside the point of contact the gap grows with the square of the way there, and the step with the way
        let beside = f64::from(gamma(12)) * c.length();
        let wanted = gap([own, touch.step]) + 2.0 * beside * beside / r;
        let smaller = touch.distance - wanted;
        let touches = (touch.distance - r).abs() < wanted && r - smaller <= most_of_sphere(c, r);
        if touches { smaller as f32 } else { radius }
    };
    touches(c, r, other).into_iter().map(apart).fold(radius, f32::min)
}

/// Another shape, and room for what its faces are sorted into once.
type Other<'a> = (&'a Geometry, &'a OnceLock<SortedFaces>);

/// The triangles of a flat shape, found by where they lie.
struct SortedFaces {
    faces: Vec<Face>,
    boxes: SortedBoxes,
}

impl SortedFaces {
    fn of(geometry: &Geometry) -> Self {
        Self::sorted(Face::all_of(geometry))
    }

    /// Those that come near a box.
    fn near(geometry: &Geometry, around: Bounds) -> Self {
        let near = |face: &Face| meet(face.bounds(), around);
        Self::sorted(Face::all_of(geometry).into_iter().filter(near).collect())
    }

    fn sorted(faces: Vec<Face>) -> Self {
        let boxes = SortedBoxes::new(faces.iter().map(Face::bounds).collect());
        SortedFaces { faces, boxes }
    }
}

/// Where another surface comes near to a sphere.
struct Touch {
    /// Of the other surface from the sphere's centre.
    distance: f64,
    /// Unit direction from the sphere's centre to the other surface.
    normal: DVec3,
    /// The largest step off the other surface.
    step: f64,
}

/// The points of a shape that are nearest to a sphere's centre.
fn touches(c: DVec3, r: f64, (other, faces): Other) -> Vec<Touch> {
    match *other {
        Geometry::Sphere { center, radius } => {
            let (middle, radius) = (center.as_dvec3(), f64::from(radius));
            let (towards, between) = (middle - c).normalize_and_length();
            let step = |normal: DVec3| step(normal, middle.abs() + normal.abs() * radius);
            let beside = Touch { distance: between - radius, normal: towards, step: step(towards) };
            let around = Touch { distance: radius - between, normal: -towards, step: step(towards) };
            // spheres about one centre touch nowhere
            let is_apart = between > 1e-5 * radius;
            let beside = (is_apart && r >= radius).then_some(beside);
            beside.into_iter().chain(is_apart.then_some(around)).collect()
        }
        Geometry::Disk { center, normal, radius } => {
            let (middle, n) = (center.as_dvec3(), normal.as_dvec3());
            let off = c - middle;
            let near = middle + (off - n * n.dot(off)).clamp_length_max(f64::from(radius));
            vec![Touch::at(near, c, middle.abs() + DVec3::splat(f64::from(radius)))]
        }
        Geometry::Rectangle { .. } | Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
            let SortedFaces { faces, boxes } = faces.get_or_init(|| SortedFaces::of(other));
            let around = grown(((c - r).as_vec3(), (c + r).as_vec3()));
            let near = boxes.meeting(around).map(|index| &faces[index]);
            near.map(|face| Touch::at(nearest_on(face.corners, c), c, face.coordinates())).collect()
        }
    }
}

impl Touch {
    /// At a point of a surface whose points are sums of such coordinates, seen from a sphere's centre.
    fn at(near: DVec3, c: DVec3, coordinates: DVec3) -> Self {
        let (normal, distance) = (near - c).normalize_and_length();
        Touch { distance, normal, step: step(normal, coordinates) }
    }
}

/// A triangle that may touch something.
struct Face {
    corners: [DVec3; 3],
    low: DVec3,
    high: DVec3,
}

impl Face {
    fn of([a, b, c]: [DVec3; 3]) -> Self {
        Face { corners: [a, b, c], low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    fn all_of(geometry: &Geometry) -> Vec<Self> {
        let (positions, triangles) = geometry.flat_triangles();
        triangles.iter().map(|t| Face::of(t.map(|i| positions[i as usize].as_dvec3()))).collect()
    }

    /// With room for all that counts as a touch.
    fn bounds(&self) -> Bounds {
        grown((self.low.as_vec3(), self.high.as_vec3()))
    }

    /// What its points are sums of: of a rectangle a corner and the edges.
    fn coordinates(&self) -> DVec3 {
        self.low.abs().max(self.high.abs()) + (self.high - self.low)
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// How far this face has to move inwards, against its normal, to be clear of another that it lies on: at least so far.
    fn way_from(&self, other: &Face, least: f64) -> Option<f64> {
        let normal = self.normal();
        let wanted = gap([step(normal, self.coordinates()), step(normal, other.coordinates())]).max(least);
        let heights = other.corners.map(|p| normal.dot(p - self.corners[0]));
        let lies_on = heights.iter().all(|height| height.abs() < wanted);
        let parallel = normal.cross(other.normal()).length() < 1e-4;
        let share = || overlap(&self.corners, &other.corners, normal, 4.0 * wanted);
        let least = heights.into_iter().fold(f64::INFINITY, f64::min);
        (normal != DVec3::ZERO && lies_on && parallel && share()).then_some(wanted - least)
    }
}

/// The most that a face of glass may move, as a share of the shape's depth behind it.
const MOST_OF_GLASS: f64 = 2e-3;

/// A flat shape of glass with the faces moved inwards that lie on others; `None` if none does, or one has too far to go.
fn moved_inwards<'a>(geometry: &Geometry, neighbours: impl Iterator<Item = &'a Geometry>) -> Option<Geometry> {
    let faces = Face::all_of(geometry);
    let (low, high) = geometry.bounds();
    // what lies in a plane of coordinates 0 is known exactly, but rays that start there do not meet it
    let least = f64::from((high - low).max_element()) / 1_048_576.0;
    let mut ways = vec![0.0f64; faces.len()];
    for other in neighbours {
        let others = SortedFaces::near(other, grown((low, high)));
        let around = grown(other.bounds());
        for (face, way) in faces.iter().zip(&mut ways).filter(|(face, _)| meet(face.bounds(), around)) {
            let found = others.boxes.meeting(face.bounds()).filter_map(|b| face.way_from(&others.faces[b], least));
            *way = found.fold(*way, f64::max);
        }
    }
    let sides = Side::all_of(&faces, &ways);
    let is_sheet = matches!(geometry, Geometry::Rectangle { .. } | Geometry::Disk { .. });
    let too_far = |side: &Side| !is_sheet && side.way > MOST_OF_GLASS * side.depth_of(geometry);
    // what touches with so many sides is round
    if sides.is_empty() || sides.len() > MOST_SIDES || sides.iter().any(too_far) {
        return None;
    }
    let farthest = ways.iter().copied().fold(0.0, f64::max);
    let back = |normal: Vec3| (normal.as_dvec3() * -farthest).as_vec3();
    Some(match geometry {
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            let corner = corner + back(edge_u.as_dvec3().cross(edge_v.as_dvec3()).normalize_or_zero().as_vec3());
            Geometry::Rectangle { corner, edge_u: *edge_u, edge_v: *edge_v }
        }
        Geometry::Disk { center, normal, radius } => {
            Geometry::Disk { center: center + back(*normal), normal: *normal, radius: *radius }
        }
        Geometry::Box { corner, size, turn_y } => smaller_box(*corner, *size, *turn_y, &ways),
        Geometry::Mesh(mesh) => Geometry::Mesh(pushed_in(mesh, &faces, &ways).into()),
        Geometry::Instance(instance) => Geometry::Mesh(pushed_in(&instance.baked(), &faces, &ways).into()),
        Geometry::Sphere { .. } => return None,
    })
}

/// A large mesh of glass, as its box in the world is moved inwards where it lies on others.
fn smaller_instance<'a>(geometry: &Geometry, neighbours: impl Iterator<Item = &'a Geometry>) -> Option<Geometry> {
    let (low, high) = geometry.bounds();
    let around = Geometry::Box { corner: low, size: high - low, turn_y: 0.0 };
    let Geometry::Box { corner, size, .. } = moved_inwards(&around, neighbours)? else { return None };
    let (mesh, to_world) = match geometry {
        Geometry::Mesh(mesh) => (mesh, DAffine3::IDENTITY),
        Geometry::Instance(Instance { mesh, to_world }) => (mesh, to_world.as_daffine3()),
        Geometry::Sphere { .. } | Geometry::Rectangle { .. } | Geometry::Disk { .. } | Geometry::Box { .. } => {
            return None;
        }
    };
    let extent = (high - low).as_dvec3();
    let share = DVec3::select(extent.cmpgt(DVec3::ZERO), size.as_dvec3() / extent, DVec3::ONE);
    let smaller = DAffine3::from_scale(share);
    let moved = DAffine3::from_translation(corner.as_dvec3() - low.as_dvec3() * share);
    let to_world = (moved * smaller * to_world).as_affine3a();
    Some(Geometry::Instance(Instance { mesh: mesh.clone(), to_world }))
}

/// Directions in which a shape may touch others.
const MOST_SIDES: usize = 16;

/// Faces of a shape that look in one direction, and how far the farthest of them has to go.
struct Side {
    normal: DVec3,
    corner: DVec3,
    way: f64,
}

impl Side {
    /// Those that have to move, one more than [`MOST_SIDES`] at most.
    fn all_of(faces: &[Face], ways: &[f64]) -> Vec<Self> {
        let mut sides: Vec<Self> = Vec::new();
        for (face, &way) in faces.iter().zip(ways).filter(|(_, way)| **way > 0.0) {
            let (normal, corner) = (face.normal(), face.corners[0]);
            let known = sides.iter().position(|side| side.normal.dot(normal) > 0.999_999);
            match known {
                Some(side) if sides[side].way < way => sides[side] = Side { normal, corner, way },
                Some(_) => {}
                None if sides.len() > MOST_SIDES => break,
                None => sides.push(Side { normal, corner, way }),
            }
        }
        sides
    }

    /// How deep the shape is behind it.
    fn depth_of(&self, geometry: &Geometry) -> f64 {
        let (positions, _) = geometry.flat_triangles();
        positions.iter().map(|p| self.normal.dot(self.corner - p.as_dvec3())).fold(0.0, f64::max)
    }
}

/// A box whose faces, two triangles each, have gone these ways inwards: across x, y and z, the lower one first.
fn smaller_box(corner: Vec3, size: Vec3, turn_y: f32, ways: &[f64]) -> Geometry {
    let of_face = |face: usize| ways[2 * face].max(ways[2 * face + 1]) as f32;
    let low = Vec3::new(of_face(0), of_face(2), of_face(4));
    let high = Vec3::new(of_face(1), of_face(3), of_face(5));
    let (sine, cosine) = turn_y.to_radians().sin_cos();
    let moved = Vec3::new(low.x * cosine - low.z * sine, low.y, low.x * sine + low.z * cosine);
    Geometry::Box { corner: corner + moved, size: size - low - high, turn_y }
}

/// A mesh whose triangles have gone these ways inwards, corners between several planes with all of them.
fn pushed_in(mesh: &Mesh, faces: &[Face], ways: &[f64]) -> Mesh {
    let mut planes: Vec<Vec<(DVec3, f64)>> = vec![Vec::new(); mesh.positions().len()];
    for ((triangle, face), way) in mesh.triangles().iter().zip(faces).zip(ways).filter(|(_, way)| **way > 0.0) {
        triangle.iter().for_each(|corner| planes[*corner as usize].push((face.normal(), *way)));
    }
    let moved = |(position, planes): (&Vec3, &Vec<(DVec3, f64)>)| (position.as_dvec3() + behind(planes)).as_vec3();
    let positions = mesh.positions().iter().zip(&planes).map(moved).collect();
    Mesh::with_attributes(positions, mesh.triangles().to_vec(), mesh.normals().to_vec(), mesh.uvs().to_vec())
}

/// A way that leads so far behind each of these planes: from one to the next, until all are passed (Kaczmarz). Between
/// two that are a few degrees apart it is a long one.
fn behind(planes: &[(DVec3, f64)]) -> DVec3 {
    let mut way = DVec3::ZERO;
    for _ in 0..1000 {
        let mut left = 0.0f64;
        for (normal, wanted) in planes {
            let short = (normal.dot(way) + wanted).max(0.0);
            way -= normal * short;
            left = left.max(short / wanted);
        }
        if left < 1e-3 {
            break;
        }
    }
    way
}

/// The point of a triangle that is nearest to `p`.
fn nearest_on([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let inside = |from: DVec3, to: DVec3| normal.dot((to - from).cross(p - from)) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) && normal != DVec3::ZERO {
        return p - normal * (normal.dot(p - a) / normal.length_squared());
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let edge = to - from;
        from + edge * ((p - from).dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    };
    let points = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    points.into_iter().min_by(|q, s| q.distance_squared(p).total_cmp(&s.distance_squared(p))).unwrap_or(a)
}

#[cfg(test)]
mod tests;
