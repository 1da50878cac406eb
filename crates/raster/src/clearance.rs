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
            Geometry::Mesh(_) | Geometry::Instance(_) => Some(outside).filter(|distance| *distance > 0.0),
            _ => None,
        };
        match (known, tessellation::large_mesh(&shape.geometry)) {
            (Some(found), _) => found.min(nearest),
            (None, Some(mesh)) => nearest_of_runs(tessellation::runs_of(mesh), eye, nearest),
            (None, None) => tessellation::triangles_of(&shape.geometry, segments, |triangles| {
                nearest_triangle(triangles, eye, nearest)
            }),
        }
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

/// As [`nearest_triangle`], of runs of triangles with boxes around them: the nearest box first, and none that is farther
/// away than what was found.
fn nearest_of_runs<T: Iterator<Item = [Vec3; 3]>>(
    runs: impl Iterator<Item = ((Vec3, Vec3), T)>,
    eye: DVec3,
    nearest: f64,
) -> f64 {
    let distance = |(low, high): (Vec3, Vec3)| Bounds { low: low.as_dvec3(), high: high.as_dvec3() }.distance(eye);
    let runs = runs.map(|(bounds, triangles)| (distance(bounds), triangles));
    let mut near: Vec<_> = runs.filter(|(distance, _)| *distance < nearest).collect();
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter().fold(nearest, |nearest, (distance, mut triangles)| match distance < nearest {
        true => nearest_triangle(&mut triangles, eye, nearest),
        false => nearest,
    })
}

/// The least of `nearest` and the distances to triangles that can be seen.
fn nearest_triangle(triangles: &mut dyn Iterator<Item = [Vec3; 3]>, eye: DVec3, nearest: f64) -> f64 {
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
    triangles.fold(nearest, within)
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
    use scene::glam::Affine3A;
    use scene::{Instance, Mesh};
    use std::path::Path;
    use std::sync::Arc;

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

    /// Inside and beside a large ball of radius 1 that is put somewhere, twice as large.
    #[test]
    fn of_a_large_mesh_the_nearest_run_has_the_nearest_triangle() {
        let at = |row: u32, column: u32| {
            let (theta, phi) = (PI as f32 * row as f32 / 64.0, PI as f32 * column as f32 / 32.0);
            Vec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
        };
        let positions = (0..=64).flat_map(|row| (0..64).map(move |column| at(row, column))).collect();
        let index = |row: u32, column: u32| row * 64 + column % 64;
        let triangles = (0..64).flat_map(|row| {
            (0..64).flat_map(move |column| {
                let [a, b] = [index(row, column), index(row, column + 1)];
                let [c, d] = [index(row + 1, column), index(row + 1, column + 1)];
                [[a, b, d], [a, d, c]]
            })
        });
        let mesh = Arc::new(Mesh::new(positions, triangles.collect()));
        assert!(mesh.is_large());
        let to_world = Affine3A::from_translation(Vec3::new(5.0, 0.0, 0.0)) * Affine3A::from_scale(Vec3::splat(2.0));
        let text = "camera = { eye = [0, 0, 9], target = [0, 0, 0], fov_y = 40 }";
        let mut scene = scene::parse(text, "shapes", Path::new("shapes.toml")).unwrap();
        scene.shapes = [Shape { geometry: Geometry::Instance(Instance { mesh, to_world }), material: 0 }].into();
        for (off, distance) in [(0.0, 2.0), (1.0, 1.0), (1.9, 0.1), (1.99, 0.01), (2.3, 0.3), (4.0, 2.0)] {
            let eye = Vec3::new(5.0, 0.0, 0.0) + off * Vec3::new(0.36, 0.48, 0.8);
            let found = clearance(&scene, eye);
            // its faces lie inwards by up to a 300th of the radius, and from beside it its box stands for it
            let least = if off < 2.0 { distance - 0.006 } else { 0.1 * distance };
            assert!((least..=distance + 0.006).contains(&found), "{found} of {distance}");
        }
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
