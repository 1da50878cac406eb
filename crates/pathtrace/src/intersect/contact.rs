//! Shapes that touch are held apart by what f32 cannot tell.
//!
//! Around a point of contact two surfaces are nearer than the step that a ray takes off one of them: it would start
//! behind the other, and light would leak. That region is not small: a sphere on a plane is within `d` of it in a circle
//! of radius `sqrt(2 r d)`. So where surfaces touch, or miss each other by less than those steps, a sphere's radius
//! shrinks, and a flat face of glass moves inwards, by about 1e-6 of the coordinates there: less than they are known to.
//! What cuts deeper into each other stays as it is. Opaque flat faces are left to [`super::coincident`].

use super::coincident::{MOST_TRIANGLES, overlap};
use super::gamma;
use super::pairs::{Bounds, for_each_pair};
use rayon::prelude::*;
use scene::glam::DVec3;
use scene::{Bsdf, Geometry, Mesh, Scene, Shape, Vec3};
use std::borrow::Cow;

/// The scene with those shapes held apart that touch.
pub(crate) fn held_apart(scene: &Scene) -> Cow<'_, Scene> {
    let gives_way = |shape: &Shape| matches!(shape.geometry, Geometry::Sphere { .. }) || is_glass(scene, shape);
    if !scene.shapes.iter().any(gives_way) {
        return Cow::Borrowed(scene);
    }
    let bounds: Vec<Bounds> = scene.shapes.iter().map(|shape| grown(shape.geometry.bounds())).collect();
    let mut neighbours = vec![Vec::new(); scene.shapes.len()];
    for_each_pair(&bounds, |a, b| {
        neighbours[a].push(b);
        neighbours[b].push(a);
    });
    let apart = |(index, neighbours): (usize, Vec<usize>)| {
        let shape = &scene.shapes[index];
        let others = neighbours.iter().map(|other| &scene.shapes[*other].geometry);
        let moved = match shape.geometry {
            Geometry::Sphere { center, radius } => smaller_sphere(center, radius, others),
            _ if is_glass(scene, shape) => moved_inwards(&shape.geometry, others),
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
fn smaller_sphere<'a>(center: Vec3, radius: f32, others: impl Iterator<Item = &'a Geometry>) -> Option<Geometry> {
    let smaller = others.map(|other| radius_beside(other, center, radius)).fold(radius, f32::min);
    (smaller < radius).then_some(Geometry::Sphere { center, radius: smaller })
}

fn radius_beside(other: &Geometry, center: Vec3, radius: f32) -> f32 {
    let (c, r) = (center.as_dvec3(), f64::from(radius));
    let apart = |touch: Touch| {
        let own = step(touch.normal, c.abs() + touch.normal.abs() * r);
        let wanted = gap([own, touch.step]);
        if (touch.distance - r).abs() < wanted { (touch.distance - wanted).max(0.5 * r) as f32 } else { radius }
    };
    touches(c, r, other).into_iter().map(apart).fold(radius, f32::min)
}

/// Where another surface comes near to a sphere.
struct Touch {
    /// Of the other surface from the sphere's centre.
    distance: f64,
    /// Unit direction there.
    normal: DVec3,
    /// The largest step off the other surface.
    step: f64,
}

/// The points of a shape that are nearest to a sphere's centre.
fn touches(c: DVec3, r: f64, other: &Geometry) -> Vec<Touch> {
    match *other {
        Geometry::Sphere { center, radius } => {
            let (middle, radius) = (center.as_dvec3(), f64::from(radius));
            let (towards, between) = (middle - c).normalize_and_length();
            let step = |normal: DVec3| step(normal, middle.abs() + normal.abs() * radius);
            let beside = Touch { distance: between - radius, normal: towards, step: step(towards) };
            let around = Touch { distance: radius - between, normal: -towards, step: step(towards) };
            // spheres about one centre touch nowhere
            if between < 1e-5 * radius { Vec::new() } else { vec![beside, around] }
        }
        Geometry::Disk { center, normal, radius } => {
            let (middle, n) = (center.as_dvec3(), normal.as_dvec3());
            let off = c - middle;
            let near = middle + (off - n * n.dot(off)).clamp_length_max(f64::from(radius));
            vec![Touch::at(near, c, middle.abs() + DVec3::splat(f64::from(radius)))]
        }
        Geometry::Rectangle { .. } | Geometry::Box { .. } | Geometry::Mesh(_) => {
            let (positions, triangles) = other.flat_triangles();
            let reach = r * (1.0 + 1e-5) + 1e-5 * c.abs().max_element();
            let near = |triangle: &[u32; 3]| {
                let corners = triangle.map(|i| positions[i as usize].as_dvec3());
                let face = Face::of(corners);
                let beyond = (face.low - c).max(c - face.high).max_element() > reach;
                (!beyond).then(|| Touch::at(nearest_on(corners, c), c, face.coordinates()))
            };
            triangles.par_iter().with_min_len(4096).filter_map(near).collect()
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

    /// All of a shape that has not too many.
    fn all_of(geometry: &Geometry) -> Vec<Self> {
        if matches!(geometry, Geometry::Mesh(mesh) if mesh.triangles().len() > MOST_TRIANGLES) {
            return Vec::new();
        }
        let (positions, triangles) = geometry.flat_triangles();
        triangles.iter().map(|t| Face::of(t.map(|i| positions[i as usize].as_dvec3()))).collect()
    }

    /// What its points are sums of: of a rectangle a corner and the edges.
    fn coordinates(&self) -> DVec3 {
        self.low.abs().max(self.high.abs()) + (self.high - self.low)
    }

    fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// How far this face has to move inwards, against its normal, to be clear of another that it lies on.
    fn way_from(&self, other: &Face) -> Option<f64> {
        let normal = self.normal();
        let wanted = gap([step(normal, self.coordinates()), step(normal, other.coordinates())]);
        let heights = other.corners.map(|p| normal.dot(p - self.corners[0]));
        let lies_on = heights.iter().all(|height| height.abs() < wanted);
        let parallel = normal.cross(other.normal()).length() < 1e-4;
        let share = || overlap(&self.corners, &other.corners, normal, 4.0 * wanted);
        let least = heights.into_iter().fold(f64::INFINITY, f64::min);
        (normal != DVec3::ZERO && lies_on && parallel && share()).then_some(wanted - least)
    }
}

/// A flat shape of glass with the faces moved inwards that lie on others; `None` if none does.
fn moved_inwards<'a>(geometry: &Geometry, neighbours: impl Iterator<Item = &'a Geometry>) -> Option<Geometry> {
    let faces = Face::all_of(geometry);
    let mut ways = vec![0.0; faces.len()];
    for other in neighbours.flat_map(Face::all_of) {
        for (way, face) in ways.iter_mut().zip(&faces) {
            *way = face.way_from(&other).map_or(*way, |found| found.max(*way));
        }
    }
    let farthest = ways.iter().copied().fold(0.0, f64::max);
    if farthest == 0.0 {
        return None;
    }
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
        Geometry::Sphere { .. } => return None,
    })
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

/// A mesh whose triangles have gone these ways inwards: each corner once for each plane.
fn pushed_in(mesh: &Mesh, faces: &[Face], ways: &[f64]) -> Mesh {
    let mut positions: Vec<DVec3> = mesh.positions().iter().map(|p| p.as_dvec3()).collect();
    let mut gone: Vec<Vec<DVec3>> = vec![Vec::new(); positions.len()];
    for ((triangle, face), way) in mesh.triangles().iter().zip(faces).zip(ways).filter(|(_, way)| **way > 0.0) {
        let normal = face.normal();
        for corner in triangle.map(|i| i as usize) {
            if gone[corner].iter().all(|other| other.dot(normal) < 0.999) {
                positions[corner] -= normal * *way;
                gone[corner].push(normal);
            }
        }
    }
    Mesh::new(positions.into_iter().map(|p| p.as_vec3()).collect(), mesh.triangles().to_vec())
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
