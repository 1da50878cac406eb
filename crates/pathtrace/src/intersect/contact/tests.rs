use super::*;
use crate::intersect::{SurfacePoint, SurfacePoints};
use crate::vectors::lane_vector;
use scene::builtin;

/// Shapes, all of one material.
fn scene_of(shapes: Vec<Geometry>, bsdf: Bsdf) -> Scene {
    let mut scene = builtin::named("hard/ball-on-mirror").expect("built in");
    scene.materials.truncate(1);
    scene.materials[0].bsdf = bsdf;
    scene.shapes = shapes.into_iter().map(|geometry| Shape { geometry, material: 0 }).collect();
    scene
}

const GLASS: Bsdf = Bsdf::Dielectric { ior: 1.5 };
const MIRROR: Bsdf = Bsdf::Mirror { reflectance: Vec3::ONE };

fn ball(center: Vec3, radius: f32) -> Geometry {
    Geometry::Sphere { center, radius }
}

/// A level floor at this height.
fn floor(y: f32) -> Geometry {
    Geometry::Rectangle { corner: Vec3::new(-5.0, y, -5.0), edge_u: Vec3::Z * 10.0, edge_v: Vec3::X * 10.0 }
}

fn radius_of(scene: &Scene, index: usize) -> f32 {
    let Geometry::Sphere { radius, .. } = scene.shapes[index].geometry else { panic!("a sphere") };
    radius
}

/// The radii of balls in a scene before and after.
fn radii(shapes: Vec<Geometry>, balls: [usize; 2]) -> [f32; 2] {
    let scene = scene_of(shapes, MIRROR);
    balls.map(|index| radius_of(&held_apart(&scene), index) / radius_of(&scene, index))
}

#[test]
fn a_ball_that_touches_shrinks_by_a_few_roundings_and_others_do_not() {
    let beside = |height: f32| radii(vec![ball(Vec3::Y * height, 1.0), floor(0.0)], [0, 0])[0];
    let touching = beside(1.0);
    assert!(touching < 1.0 - 5e-7 && touching > 1.0 - 1e-5, "{touching}");
    assert_eq!((beside(1.0001), beside(0.9999), beside(0.5)), (1.0, 1.0, 1.0));
}

/// A ball on a ground that is a ball itself, as textbooks have it: the ground gives way, which nobody sees.
#[test]
fn a_small_ball_on_a_large_one_keeps_its_size() {
    for small in [1.0, 0.2, 0.02] {
        let shapes = vec![ball(Vec3::Y * small, small), ball(Vec3::Y * -1000.0, 1000.0)];
        let [on_ground, ground] = radii(shapes, [0, 1]);
        assert_eq!(on_ground, 1.0, "{small}");
        assert!(ground < 1.0 && ground > 1.0 - 1e-5, "{ground}");
    }
    // within a ball it is the inner one
    let [inner, outer] = radii(vec![ball(Vec3::Y * 0.5, 0.5), ball(Vec3::ZERO, 1.0)], [0, 1]);
    assert!(inner < 1.0 && outer == 1.0);
}

#[test]
fn nothing_shrinks_visibly_far_from_the_origin() {
    for (radius, y) in [(0.001, 100.0), (0.002, 1000.0), (0.5, 1e5)] {
        let center = Vec3::new(0.0, y + radius, 0.0);
        assert_eq!(radii(vec![ball(center, radius), floor(y)], [0, 0])[0], 1.0, "{radius} at {y}");
    }
    let shining = {
        let mut scene = scene_of(vec![ball(Vec3::Y, 1.0), floor(0.0)], MIRROR);
        scene.materials[0].emission = Some(scene::material::Emission { radiance: Vec3::ONE, two_sided: false });
        radius_of(&held_apart(&scene), 0)
    };
    assert_eq!(shining, 1.0);
}

/// Beside the point of contact a step off the ball has a part along the floor's coordinates as well, however large.
#[test]
fn no_step_off_a_ball_crosses_the_floor_that_it_touches() {
    for x in [0.0, 100.0, 1000.0, 10_000.0] {
        let center = Vec3::new(x, 1.0, -x);
        let corner = Vec3::new(x - 5.0, 0.0, -x - 5.0);
        let under = Geometry::Rectangle { corner, edge_u: Vec3::Z * 10.0, edge_v: Vec3::X * 10.0 };
        let scene = scene_of(vec![ball(center, 1.0), under], MIRROR);
        let radius = radius_of(&held_apart(&scene), 0);
        for i in 0..1000 {
            let down = Vec3::new((i as f32 * 2e-5).sin(), -(i as f32 * 2e-5).cos(), 0.0);
            let point = SurfacePoint::from(SurfacePoints::on_sphere(lane_vector(center), radius, lane_vector(down)));
            let start = point.leaving_towards(point.normal);
            assert!(start.y > 0.0, "at {x}, {i}: {start}");
        }
    }
}

/// The lowest point of the first shape over the height that it stands on.
fn clearance(glass: Geometry, under: Geometry, y: f32) -> f32 {
    let scene = scene_of(vec![glass, under], GLASS);
    let scene = held_apart(&scene);
    let (positions, _) = scene.shapes[0].geometry.flat_triangles();
    positions.iter().map(|p| p.y).fold(f32::INFINITY, f32::min) - y
}

#[test]
fn flat_glass_is_lifted_off_what_it_lies_on() {
    let many = |y: f32| {
        let corner = |i: u32| Vec3::new((i % 31) as f32 / 3.0 - 5.0, y, (i / 31) as f32 / 3.0 - 5.0);
        let cell = |i: u32| [[i, i + 31, i + 1], [i + 1, i + 31, i + 32]];
        let cells = (0..900).map(|i| i / 30 * 31 + i % 30).flat_map(cell);
        Geometry::mesh((0..31 * 31).map(corner).collect(), cells.collect())
    };
    // glass of many small triangles needs as much
    let grid = |y: f32| {
        let Geometry::Mesh(flat) = many(y) else { panic!("a mesh") };
        let above = flat.positions().iter().map(|p| *p + Vec3::Y);
        let first = flat.positions().len() as u32;
        let lower = flat.triangles().iter().map(|[a, b, c]| [*a, *c, *b]);
        let upper = flat.triangles().iter().map(|t| t.map(|i| i + first));
        Geometry::mesh(flat.positions().iter().copied().chain(above).collect(), lower.chain(upper).collect())
    };
    for y in [0.0, 0.5, -3.0, 100.0] {
        let lifted = clearance(grid(y), floor(y), y);
        assert!(lifted > 5e-6 && lifted < 1e-3, "many small triangles at {y}: {lifted}");
        let cube = |size: Vec3| Geometry::Box { corner: Vec3::new(-0.4, y, -0.3), size, turn_y: 20.0 };
        let mesh = |geometry: &Geometry| {
            let (positions, triangles) = geometry.flat_triangles();
            Geometry::mesh(positions.into_owned(), triangles.into_owned())
        };
        let block = cube(Vec3::ONE);
        for (glass, under) in [(&block, floor(y)), (&mesh(&block), floor(y)), (&block, many(y))] {
            let lifted = clearance(glass.clone(), under, y);
            assert!(lifted > 2e-7 && lifted < 1e-3, "at {y}: {lifted}");
        }
        // a plate as thin as the way is left alone, and what stands apart
        let plate = 1e-5f32.max(y.abs() * 1e-6);
        assert_eq!(clearance(cube(Vec3::new(1.0, plate, 1.0)), floor(y), y), 0.0, "at {y}");
        assert_eq!(clearance(block, floor(y - 0.1), y), 0.0);
    }
}

/// Between a floor and a ramp each corner has to be clear of both.
#[test]
fn glass_in_a_wedge_is_clear_of_both_sides() {
    for degrees in [90.0f32, 60.0, 30.0, 10.0] {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let ramp = Vec3::new(cosine, sine, 0.0);
        let base = Vec3::Y * 2.5;
        let corners = [Vec3::ZERO, Vec3::X, ramp].map(|p| base + p);
        let positions = corners.into_iter().chain(corners.map(|p| p + Vec3::Z)).collect();
        let triangles = vec![[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [0, 3, 5], [0, 5, 2]];
        let slope = Geometry::Rectangle { corner: base - Vec3::Z, edge_u: ramp * 2.0, edge_v: Vec3::Z * 3.0 };
        let scene = scene_of(vec![Geometry::mesh(positions, triangles), floor(2.5), slope], GLASS);
        let scene = held_apart(&scene);
        let (positions, _) = scene.shapes[0].geometry.flat_triangles();
        let into = Vec3::new(sine, -cosine, 0.0);
        for p in positions.iter() {
            assert!(p.y - 2.5 > 5e-7 && (p - base).dot(into) > 5e-7, "{degrees} degrees: {p}");
        }
    }
}
