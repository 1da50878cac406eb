//! How far from an eye the nearest thing lies that is drawn.

use crate::tessellation;
use scene::glam::DVec3;
use scene::{Geometry, Scene, Shape, Vec3};
use std::f64::consts::PI;

/// A plane that is nearer than this share of its own and the eye's coordinates goes through the eye as far as `f32` knows:
/// which of its sides is seen is chance.
const ROUNDING: f64 = 1e-7;

/// A distance from `eye` within which nothing is drawn that can be seen: of triangles in whose plane the eye lies, no
/// picture shows anything. Infinite if there is nothing else.
pub fn clearance(scene: &Scene, eye: Vec3) -> f32 {
    let (eye, segments) = (eye.as_dvec3(), scene.fake.segments);
    let of_shape = |nearest: f64, shape: &Shape| {
        let (low, high) = shape.geometry.bounds();
        let outside = Bounds { low: low.as_dvec3(), high: high.as_dvec3() }.distance(eye);
        let known = match &shape.geometry {
            _ if outside >= nearest => return nearest,
            Geometry::Sphere { center, radius } => from_sphere(*center, *radius, eye, segments),
            Geometry::Mesh(_) => Some(outside).filter(|distance| *distance > 0.0),
            _ => None,
        };
        known.map_or_else(|| nearest_triangle(&shape.geometry, eye, segments, nearest), |found| found.min(nearest))
    };
    scene.shapes.iter().fold(f64::INFINITY, of_shape) as f32
}

/// A box with sides along the axes.
struct Bounds {
    low: DVec3,
    high: DVec3,
}

impl Bounds {
    fn of(triangle: [DVec3; 3]) -> Bounds {
        let [a, b, c] = triangle;
        Bounds { low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    fn distance(&self, eye: DVec3) -> f64 {
        (self.low - eye).max(eye - self.high).max(DVec3::ZERO).length()
    }

    fn rounding(&self, eye: DVec3) -> f64 {
        ROUNDING * self.low.abs().max(self.high.abs()).max(eye.abs()).max_element()
    }
}

/// The distance to the faces of a tessellated sphere, if the eye lies outside or well inside: they bend inwards by no
/// more than the middles of chords along rows and columns do.
fn from_sphere(center: Vec3, radius: f32, eye: DVec3, segments: u32) -> Option<f64> {
    let (radius, from_center) = (f64::from(radius), eye.distance(center.as_dvec3()));
    let inner = radius * (PI / f64::from(segments.max(3))).cos().powi(2);
    Some((from_center - radius).max(inner - from_center)).filter(|distance| *distance > 0.01 * (radius - inner))
}

/// The least of `nearest` and the distances to a shape's triangles that can be seen.
fn nearest_triangle(geometry: &Geometry, eye: DVec3, segments: u32, nearest: f64) -> f64 {
    let eye_of_f32 = eye.as_vec3();
    let within = |nearest: f64, triangle: [Vec3; 3]| {
        let [a, b, c] = triangle;
        let gap = (a.min(b).min(c) - eye_of_f32).max(eye_of_f32 - a.max(b).max(c)).max(Vec3::ZERO);
        // most lie farther away than this, and need no more than that
        if f64::from(gap.length_squared()) >= nearest * nearest {
            return nearest;
        }
        let triangle = triangle.map(|corner| corner.as_dvec3());
        let bounds = Bounds::of(triangle);
        let normal = normal(triangle);
        let seen = (eye - triangle[0]).dot(normal).abs() > bounds.rounding(eye);
        if seen { nearest.min(distance(eye, triangle, normal)) } else { nearest }
    };
    tessellation::triangles_of(geometry, segments, |triangles| triangles.fold(nearest, within))
}

/// Unit; zero of a triangle without area, which is not seen.
fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// Of a point from a triangle: from its plane where the point lies over it, else from its edges.
fn distance(p: DVec3, [a, b, c]: [DVec3; 3], normal: DVec3) -> f64 {
    let edges = [(a, b), (b, c), (c, a)];
    if edges.iter().all(|(from, to)| (to - from).cross(p - from).dot(normal) >= 0.0) {
        return (p - a).dot(normal).abs();
    }
    edges.map(|(from, to)| distance_to_edge(p, from, to)).into_iter().fold(f64::INFINITY, f64::min)
}

fn distance_to_edge(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let edge = to - from;
    let along = (p - from).dot(edge) / edge.length_squared().max(f64::MIN_POSITIVE);
    p.distance(from + along.clamp(0.0, 1.0) * edge)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn of(shapes: &str, eye: Vec3) -> f32 {
        let camera = "camera = { eye = [0, 0, 9], target = [0, 0, 0], fov_y = 40 }";
        let text = format!("{camera}\nmaterial.grey.diffuse.albedo = [0.5, 0.5, 0.5]\n{shapes}");
        clearance(&scene::parse(&text, "shapes", Path::new("shapes.toml")).unwrap(), eye)
    }

    const BALL: &str = "sphere = [{ center = [0, 1, 0], radius = 1, material = 'grey' }]\n";
    const FLOOR: &str =
        "rectangle = [{ corner = [-40, 0, -40], edge_u = [0, 0, 80], edge_v = [80, 0, 0], material = 'grey' }]\n";

    #[test]
    fn nothing_is_nearer_and_a_plane_through_the_eye_does_not_count() {
        let close = |found: f32, expected: f32| assert!((found / expected - 1.0).abs() < 1e-5, "{found}, {expected}");
        close(of(FLOOR, Vec3::new(3.0, 0.25, 5.0)), 0.25);
        close(of(FLOOR, Vec3::new(3.0, -1e-4, 5.0)), 1e-4);
        assert_eq!(of(FLOOR, Vec3::new(3.0, 0.0, 5.0)), f32::INFINITY);
        assert_eq!(of(FLOOR, Vec3::new(3.0, 0.0, 40.01)), f32::INFINITY);
        close(of(&format!("{FLOOR}{BALL}"), Vec3::new(0.0, 0.0, 8.0)), 65f32.sqrt() - 1.0);
        // above a floor of which f32 does not know whether it is above or below
        let wide = FLOOR.replace("-40", "-1e11").replace("80", "2e11");
        close(of(&format!("{wide}{BALL}"), Vec3::new(0.0, 2.0, 5.0)), 26f32.sqrt() - 1.0);
        assert_eq!(of("", Vec3::ZERO), f32::INFINITY);
    }

    /// Points about a tessellated sphere and a tilted mesh, near its faces and in the box around it: against a dense
    /// sampling of all triangles, which finds no point that is nearer.
    #[test]
    fn no_point_of_any_triangle_is_nearer() {
        let mesh = "mesh = [{ positions = [[0, 0, 0], [2, 1, 0], [0, 1, 2], [1, 3, 1]], triangles = [[0, 1, 2], [1, 3, 2]], \
                    material = 'grey' }]\nfake.segments = 6\n";
        let text = format!(
            "camera = {{ eye = [0, 0, 9], target = [0, 0, 0], fov_y = 40 }}\n{mesh}{BALL}\
                            material.grey.diffuse.albedo = [0.5, 0.5, 0.5]"
        );
        let scene = scene::parse(&text, "shapes", Path::new("shapes.toml")).unwrap();
        let of_shape =
            |shape: &Shape| tessellation::triangles_of(&shape.geometry, 6, |triangles| triangles.collect::<Vec<_>>());
        let triangles: Vec<_> = scene.shapes.iter().flat_map(of_shape).collect();
        for i in 0..300 {
            let x = i as f32;
            let eye = Vec3::new((x * 1.7).sin(), 1.0 + (x * 2.3).sin(), (x * 0.9).cos()) * 1.1;
            let steps = || (0..=24).flat_map(|u| (0..=24 - u).map(move |v| (u as f32 / 24.0, v as f32 / 24.0)));
            let sampled =
                triangles.iter().flat_map(|&[a, b, c]| steps().map(move |(u, v)| a + u * (b - a) + v * (c - a)));
            let nearest = sampled.map(|p| p.distance(eye)).fold(f32::INFINITY, f32::min);
            let found = clearance(&scene, eye);
            assert!(found > 0.0 && found <= nearest + 1e-5, "{found} of {nearest} from {eye}");
        }
    }
}
