//! Flat lamps that were made the wrong way round: all that they light is a surface a hand's breadth away, or nothing.

use crate::{Bsdf, Geometry, Instance, Scene, Shape, Vec3};

/// Of the lamp's size. Between two equal squares a tenth of their side apart more than four fifths of the light goes
/// from the one straight to the other (J. R. Howell, "A Catalog of Radiation Configuration Factors", C-11); at half the
/// side it is two fifths, and the rest lights the room as who made it may have wanted.
const HANDS_BREADTH: f32 = 0.12;

/// Of the lamp's size: what rises less above its plane lies in it.
const IN_ITS_PLANE: f32 = 1e-4;

/// Triangles that are tested at most: a scene's lamps times its triangles may be many.
const MOST_TESTS: usize = 1 << 20;

/// The first lamp whose shining side is covered while its dark side faces the rest of the scene.
pub(super) fn that_shines_into_a_wall(scene: &Scene) -> Option<String> {
    let lamps: Vec<&Shape> = scene.shapes.iter().filter(|shape| shines_on_one_side(scene, shape)).collect();
    let triangles: usize = scene.shapes.iter().map(|shape| triangle_count(&shape.geometry)).sum();
    if lamps.len().saturating_mul(10 * triangles) > MOST_TESTS {
        return None;
    }
    let (lamp, distance) = lamps.into_iter().find_map(|lamp| Some((lamp, covered_at(scene, lamp)?)))?;
    let turn = turned(lamp);
    let (name, distance) = (scene.named(lamp), super::tidy(distance));
    Some(format!(
        "the lamp, a {name}, shines at a surface {distance} away and has its dark side to the room; is that meant? If \
         not, {turn}, or give its material two_sided = true"
    ))
}

/// The first lamp that has no shape before it. One that the camera sees shine is a picture of its own.
pub(super) fn that_shines_at_nothing(scene: &Scene) -> Option<String> {
    let lamps = scene.shapes.iter().filter(|shape| shines_on_one_side(scene, shape));
    let lamp = lamps.into_iter().find(|lamp| lights_nothing(scene, lamp))?;
    let (name, turn) = (scene.named(lamp), turned(lamp));
    Some(format!(
        "the lamp, a {name}, shines away from every shape and lights none: {turn}, or give its material two_sided = true"
    ))
}

fn turned(lamp: &Shape) -> &'static str {
    match lamp.geometry {
        Geometry::Disk { .. } => "turn the signs of its normal around",
        _ => "swap its edge_u and edge_v",
    }
}

fn lights_nothing(scene: &Scene, lamp: &Shape) -> bool {
    let Some((points, normal, size)) = samples(&lamp.geometry) else { return false };
    let in_front = |point: Vec3| (point - points[0]).dot(normal) > IN_ITS_PLANE * size;
    let mut others = scene.shapes.iter().filter(|other| !std::ptr::eq(*other, lamp)).peekable();
    let some = others.peek().is_some();
    some && !in_front(scene.camera.eye)
        && !others.any(|other| super::corners(&other.geometry).into_iter().any(in_front))
}

fn shines_on_one_side(scene: &Scene, shape: &Shape) -> bool {
    let material = scene.material_of(shape);
    let flat = matches!(shape.geometry, Geometry::Rectangle { .. } | Geometry::Disk { .. });
    flat && material.shines() && material.emission.is_some_and(|emission| !emission.two_sided)
}

fn triangle_count(geometry: &Geometry) -> usize {
    match geometry {
        Geometry::Mesh(mesh) | Geometry::Instance(Instance { mesh, .. }) => mesh.triangles().len(),
        Geometry::Disk { .. } => crate::shape::DISK_SEGMENTS as usize,
        _ => 12,
    }
}

/// How far from the lamp's middle its light gets, if it gets nowhere and would on the other side.
fn covered_at(scene: &Scene, lamp: &Shape) -> Option<f32> {
    let (points, normal, size) = samples(&lamp.geometry)?;
    let distance = |point, direction| {
        let others = scene.shapes.iter().filter(|other| !std::ptr::eq(*other, lamp));
        let opaque = others.filter(|other| !matches!(scene.material_of(other).bsdf, Bsdf::Dielectric { .. }));
        opaque.filter_map(|other| hit(&other.geometry, point, direction)).fold(f32::INFINITY, f32::min)
    };
    let near = HANDS_BREADTH * size;
    if points.iter().any(|point| distance(*point, normal) > near) {
        return None;
    }
    let behind = points.map(|point| distance(point, -normal));
    let would_light = behind.iter().all(|d| *d > near) && behind.iter().any(|d| d.is_finite());
    would_light.then(|| distance(points[0], normal))
}

/// Five points of a flat shape, the middle first; its normal; and how wide it is.
fn samples(geometry: &Geometry) -> Option<([Vec3; 5], Vec3, f32)> {
    let (middle, u, v, normal) = match *geometry {
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            (corner + 0.5 * (edge_u + edge_v), 0.4 * edge_u, 0.4 * edge_v, edge_u.cross(edge_v).normalize_or_zero())
        }
        Geometry::Disk { center, normal, radius } => {
            let (u, v) = normal.any_orthonormal_pair();
            (center, 0.6 * radius * u, 0.6 * radius * v, normal)
        }
        _ => return None,
    };
    let size = 2.5 * u.length().min(v.length());
    Some(([middle, middle + u + v, middle + u - v, middle - u + v, middle - u - v], normal, size))
}

/// Distance along a ray of unit direction to a shape.
fn hit(geometry: &Geometry, origin: Vec3, direction: Vec3) -> Option<f32> {
    if let Geometry::Sphere { center, radius } = geometry {
        let to = center - origin;
        let (along, square) = (to.dot(direction), to.length_squared() - radius * radius);
        let root = (along * along - square).max(0.0).sqrt();
        let meets = along * along >= square;
        return [along - root, along + root].into_iter().find(|t| meets && *t > 0.0);
    }
    let (positions, triangles) = geometry.flat_triangles();
    let corners = |triangle: &[u32; 3]| triangle.map(|corner| positions[corner as usize]);
    triangles.iter().filter_map(|triangle| hit_triangle(corners(triangle), origin, direction)).reduce(f32::min)
}

/// T. Möller and B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
fn hit_triangle([a, b, c]: [Vec3; 3], origin: Vec3, direction: Vec3) -> Option<f32> {
    let (e1, e2, to) = (b - a, c - a, origin - a);
    let (p, q) = (direction.cross(e2), to.cross(e1));
    let scale = 1.0 / e1.dot(p);
    let (u, v, t) = (to.dot(p) * scale, direction.dot(q) * scale, e2.dot(q) * scale);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t.is_finite()).then_some(t)
}
