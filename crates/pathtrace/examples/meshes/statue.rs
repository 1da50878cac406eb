//! A closed mesh of any size that needs no file.

use rayon::prelude::*;
use scene::Vec3;
use scene::glam::IVec3;

/// Corners and triangles of a bumpy ball: an octahedron whose edges are cut into 2^level, 8 x 4^level triangles.
/// Neighbours share their corners.
pub fn statue(level: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let n = 1i32 << level;
    let points: Vec<IVec3> =
        (-n..=n).flat_map(|y| (0..ring(n - y.abs())).map(move |k| on_ring(n - y.abs(), y, k))).collect();
    let positions = points.par_iter().map(|p| bumpy(p.as_vec3())).collect();
    let mut triangles = Vec::with_capacity(8 << (2 * level));
    let mut first = 0;
    for y in -n..n {
        let (below, above) = (n - y.abs(), n - (y + 1).abs());
        let next = first + ring(below);
        between((first, below), (next, above), &mut triangles);
        first = next;
    }
    (positions, triangles)
}

/// How many points lie on a ring of this radius.
fn ring(radius: i32) -> u32 {
    if radius == 0 { 1 } else { 4 * radius.unsigned_abs() }
}

fn on_ring(radius: i32, y: i32, k: u32) -> IVec3 {
    if radius == 0 {
        return IVec3::new(0, y, 0);
    }
    let (side, i) = (k as i32 / radius, k as i32 % radius);
    let (x, z) = match side {
        0 => (radius - i, i),
        1 => (-i, radius - i),
        2 => (i - radius, -i),
        _ => (i, i - radius),
    };
    IVec3::new(x, y, z)
}

/// Adds the triangles between two rings, each given by its first point and its radius, which differ by one.
fn between(lower: (u32, i32), upper: (u32, i32), triangles: &mut Vec<[u32; 3]>) {
    let grows = upper.1 > lower.1;
    let (outer, inner) = if grows { (upper, lower) } else { (lower, upper) };
    let at = |(first, radius): (u32, i32), side: i32, i: i32| {
        if radius == 0 { first } else { first + ((side * radius + i) % (4 * radius)) as u32 }
    };
    let mut add = |[a, b, c]: [u32; 3]| triangles.push(if grows { [a, b, c] } else { [a, c, b] });
    for side in 0..4 {
        for i in 0..outer.1 {
            add([at(outer, side, i), at(outer, side, i + 1), at(inner, side, i)]);
            if i + 1 < outer.1 {
                add([at(inner, side, i), at(outer, side, i + 1), at(inner, side, i + 1)]);
            }
        }
    }
}

/// The point of the surface in this direction: eight octaves of noise on a ball, half as wide as high.
fn bumpy(direction: Vec3) -> Vec3 {
    let out = direction.normalize();
    let (mut radius, mut height, mut place) = (1.0, 0.35, out * 2.0);
    for _ in 0..8 {
        radius += height * (noise(place + 17.0) - 0.5);
        (height, place) = (0.5 * height, place * 2.03);
    }
    out * radius * Vec3::new(0.5, 1.0, 0.45)
}

/// A value between 0 and 1, smooth between integer places.
fn noise(place: Vec3) -> f32 {
    let low = place.floor();
    let t = place - low;
    let t = t * t * (3.0 - 2.0 * t);
    let corner = |k: i32| {
        let offset = IVec3::new(k & 1, k >> 1 & 1, k >> 2 & 1);
        let share = offset.as_vec3() * t + (1 - offset).as_vec3() * (1.0 - t);
        hash(low.as_ivec3() + offset) * share.element_product()
    };
    (0..8).map(corner).sum()
}

fn hash(p: IVec3) -> f32 {
    let p = p.as_uvec3();
    let mut h = p.x.wrapping_mul(0x9e37_79b1) ^ p.y.wrapping_mul(0x85eb_ca77) ^ p.z.wrapping_mul(0xc2b2_ae3d);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    (h ^ (h >> 12)) as f32 / u32::MAX as f32
}
