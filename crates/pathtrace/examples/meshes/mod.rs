//! A large mesh that needs no file.

use scene::{Geometry, Vec3};

/// A bumpy sphere over hills, 1,001,600 triangles.
pub fn hills_and_sphere() -> Geometry {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let mut add = |n: u32, point: &dyn Fn(f32, f32) -> Vec3| {
        let first = positions.len() as u32;
        for i in 0..=n {
            positions.extend((0..=n).map(|j| point(i as f32 / n as f32, j as f32 / n as f32)));
        }
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let a = first + i * (n + 1) + j;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    };
    add(520, &|u, v| {
        let p = 10.0 * Vec3::new(u - 0.5, 0.0, v - 0.5);
        p + Vec3::Y * (0.3 * waves(p) - 1.5)
    });
    add(480, &|u, v| {
        let (sin, cos) = (std::f32::consts::PI * v).sin_cos();
        let (y, x) = (std::f32::consts::TAU * u).sin_cos();
        let out = Vec3::new(sin * x, cos, sin * y);
        out * (1.5 + 0.3 * waves(out))
    });
    Geometry::mesh(positions, triangles)
}

/// Five octaves of bumps.
fn waves(p: Vec3) -> f32 {
    let octave = |i: i32| {
        let q = p * 3.0 * 2.1f32.powi(i);
        0.5f32.powi(i) * (q.x.sin() * (1.3 * q.y + 1.0).sin() * (0.9 * q.z + 2.0).cos())
    };
    (0..5).map(octave).sum()
}
