//! Meshes for the geometry cases, and random rays at them.

use crate::hard::{known, with_geometry};
use pathtrace::sampling::sampler::Sampler;
use pathtrace::{Tracer, sampling};
use scene::glam::{DVec3, EulerRot, Quat};
use scene::{Geometry, Scene, Vec3};

/// Corners and triangles.
#[derive(Debug, Clone)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A closed grid sphere of unit radius, `rows` by `columns`, its radius disturbed by up to `noise`.
    pub fn sphere(rows: u32, columns: u32, noise: f64) -> Self {
        let random = |i: u32, j: u32| f64::from(Sampler::independent(i, j, 16).unit4(0)[0]) * 2.0 - 1.0;
        let mut positions = vec![Vec3::Y];
        for i in 1..rows {
            for j in 0..columns {
                let theta = std::f64::consts::PI * f64::from(i) / f64::from(rows);
                let phi = std::f64::consts::TAU * f64::from(j) / f64::from(columns);
                let out = DVec3::new(theta.sin() * phi.cos(), theta.cos(), -theta.sin() * phi.sin());
                positions.push((out * (1.0 + noise * random(i, j))).as_vec3());
            }
        }
        positions.push(-Vec3::Y);
        let south = positions.len() as u32 - 1;
        let at = |i: u32, j: u32| {
            if i == 0 {
                0
            } else if i == rows {
                south
            } else {
                1 + (i - 1) * columns + j % columns
            }
        };
        let mut triangles = Vec::new();
        for i in 0..rows {
            for j in 0..columns {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if i + 1 < rows {
                    triangles.push([a, b, c]);
                }
                if i > 0 {
                    triangles.push([a, c, d]);
                }
            }
        }
        Mesh { positions, triangles }
    }

    /// The cube [-1, 1]^3, each face of `n` by `n` quads.
    pub fn cube(n: u32) -> Self {
        let mut mesh = Mesh { positions: Vec::new(), triangles: Vec::new() };
        for axis in 0..3 {
            for side in [-1.0f32, 1.0] {
                let first = mesh.positions.len() as u32;
                for i in 0..=n {
                    for j in 0..=n {
                        let along = |k: u32| 2.0 * k as f32 / n as f32 - 1.0;
                        let mut p = [0.0; 3];
                        (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, along(i), along(j));
                        mesh.positions.push(Vec3::from_array(p));
                    }
                }
                let at = |i: u32, j: u32| first + i * (n + 1) + j;
                for i in 0..n {
                    for j in 0..n {
                        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                        let halves = if side > 0.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                        mesh.triangles.extend(halves);
                    }
                }
            }
        }
        mesh
    }

    /// Scaled, then moved by `shift` along every axis.
    pub fn placed(mut self, scale: f32, shift: f32) -> Self {
        for p in &mut self.positions {
            *p = *p * scale + Vec3::splat(shift);
        }
        self
    }

    /// Turned by degrees about x, y, z.
    pub fn turned(mut self, degrees: [f32; 3]) -> Self {
        let [x, y, z] = degrees.map(f32::to_radians);
        let turn = Quat::from_euler(EulerRot::XYZ, x, y, z);
        for p in &mut self.positions {
            *p = turn * *p;
        }
        self
    }

    /// A black scene of this mesh under a glaring sky.
    pub fn scene(self) -> Scene {
        with_geometry(known("light-tight-box"), |_, geometry| {
            *geometry = Geometry::mesh(self.positions.clone(), self.triangles.clone());
        })
    }

    /// Ready for rays.
    pub fn tracer(self) -> Tracer {
        Tracer::new(&self.scene())
    }
}

/// A direction uniform on the sphere.
pub fn any_direction(u: [f32; 2]) -> Vec3 {
    sampling::cone(2.0, u)
}
