//! A closed mesh of any size, and the same in pieces that are small meshes.

use scene::{Geometry, Instance, Mesh, Vec3};
use std::collections::HashMap;

/// A bumpy ball about the origin with radii around 1: an octahedron of which each side is cut in two `level` times,
/// 8 x 4^level triangles.
pub fn bumpy(level: u32) -> Mesh {
    let n = 1i32 << level;
    let mut places: HashMap<[i32; 3], u32> = HashMap::new();
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for octant in 0..8 {
        let signs = [0, 1, 2].map(|axis| if octant >> axis & 1 == 0 { 1 } else { -1 });
        let mut corner = |i: i32, j: i32| {
            let at = [i * signs[0], j * signs[1], (n - i - j) * signs[2]];
            *places.entry(at).or_insert_with(|| {
                positions.push(point(Vec3::from(at.map(|x| x as f32)).normalize()));
                positions.len() as u32 - 1
            })
        };
        let inside_out = signs.iter().product::<i32>() < 0;
        let mut add = |[a, b, c]: [u32; 3]| triangles.push(if inside_out { [a, c, b] } else { [a, b, c] });
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j))) {
            add([corner(i, j), corner(i + 1, j), corner(i, j + 1)]);
            if i + j + 1 < n {
                add([corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]);
            }
        }
    }
    Mesh::new(positions, triangles)
}

fn point(direction: Vec3) -> Vec3 {
    let octave = |i: i32| {
        let q = direction * 2.0 * 2.1f32.powi(i) + 0.3;
        0.25 * 0.5f32.powi(i) * (q.x.sin() * (1.3 * q.y + 1.0).sin() + (0.9 * q.z + 2.0).cos())
    };
    direction * (1.0 + (0..5).map(octave).sum::<f32>())
}

/// An instance as meshes in the world, each too small for a tree of its own.
pub fn in_pieces(instance: &Instance) -> Vec<Geometry> {
    let baked = instance.baked();
    let piece = |triangles: &[[u32; 3]]| {
        let mut places: HashMap<u32, u32> = HashMap::new();
        let mut positions = Vec::new();
        let mut place = |index: u32| {
            *places.entry(index).or_insert_with(|| {
                positions.push(baked.positions()[index as usize]);
                positions.len() as u32 - 1
            })
        };
        let triangles = triangles.iter().map(|triangle| triangle.map(&mut place)).collect();
        Geometry::mesh(positions, triangles)
    };
    baked.triangles().chunks(Mesh::LARGE - 1).map(piece).collect()
}
