//! A statue made by the program: a bust of up to 33,554,432 triangles, from a few numbers.
//!
//! An octahedron whose sides are subdivided `level` times is laid around smoothly joined ellipsoids, and eight octaves of
//! value noise make stone and hair of them. Positions come from sums, products, quotients and square roots alone: every
//! machine makes the same bits.

mod figure;
mod lattice;
mod noise;

use crate::progress::{Progress, Stopped};
use crate::{Mesh, smooth_normals};
use figure::Ways;
use glam::Vec3;
use lattice::Lattice;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The most times that the octahedron's sides are subdivided.
pub const FINEST: u32 = 11;

/// The finest level with shading normals. Beyond it a triangle is smaller than a pixel sees, and normals would make
/// two million triangles a fifth larger.
const FINEST_SMOOTH: u32 = 8;

/// A bust of `8 * 4^level` triangles, 2 units high, that stands on y = 0 and looks towards +z; `level` is at most
/// [`FINEST`]. Coarse ones have smooth normals.
///
/// # Errors
/// If it is told to stop.
pub fn statue(level: u32, progress: &Progress) -> Result<Mesh, Stopped> {
    let level = level.min(FINEST);
    let lattice = Lattice::new(level);
    let positions = positions(lattice, &|share| progress.tell(&format!("making a statue of level {level}"), share))?;
    let triangles = lattice.all_triangles();
    let normals = if level > FINEST_SMOOTH { Vec::new() } else { smooth_normals(&positions, &triangles) };
    progress.tell(&format!("making a statue of level {level}"), 1.0)?;
    Ok(Mesh::with_attributes(positions, triangles, normals, Vec::new()))
}

fn positions(lattice: Lattice, tell: &(dyn Fn(f32) -> Result<(), Stopped> + Sync)) -> Result<Vec<Vec3>, Stopped> {
    tell(0.0)?;
    let (ways, done) = (Ways::of_the_figure(), AtomicUsize::new(0));
    let mut positions = vec![Vec3::ZERO; lattice.nodes()];
    let (mut rest, mut rings) = (&mut positions[..], Vec::new());
    for ring in lattice.rings() {
        let (of_ring, after) = rest.split_at_mut(lattice.ring_length(ring));
        rings.push((ring, of_ring));
        rest = after;
    }
    rings.into_par_iter().try_for_each(|(ring, to)| {
        to.iter_mut().zip(lattice.ring(ring)).for_each(|(to, node)| *to = ways.corner(node));
        let done = done.fetch_add(to.len(), Ordering::Relaxed) + to.len();
        tell(done as f32 / lattice.nodes() as f32)
    })?;
    Ok(positions)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(level: u32) -> Mesh {
        statue(level, &Progress::untold()).expect("nobody stops it")
    }

    /// Six times what a closed mesh holds, by the tetrahedra of its triangles and the origin.
    fn volume(mesh: &Mesh) -> f64 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|corner| mesh.positions()[corner as usize].as_dvec3());
            a.dot(b.cross(c))
        };
        mesh.triangles().iter().map(of).sum()
    }

    #[test]
    fn the_same_bits_come_on_every_machine() {
        let mesh = made(4);
        assert_eq!(mesh.triangles().len(), 2048);
        assert_eq!(format!("{:032x}", mesh.content()), "5cfa31846743a25dbc1b3d713b02502b");
    }

    #[test]
    fn it_stands_on_the_ground_two_high_with_its_outside_outside() {
        let [coarse, fine] = [5, 7].map(made);
        for mesh in [&coarse, &fine] {
            let (lo, hi) = mesh.bounds();
            assert!(lo.y == 0.0 && (hi.y - 2.0).abs() < 0.05 && hi.x < 0.7 && lo.x > -0.7, "{lo} {hi}");
        }
        let [v, w] = [volume(&coarse), volume(&fine)];
        assert!(v > 0.0 && (v / w - 1.0).abs() < 0.03, "{v} {w}");
    }

    /// Rays from inside that jumped from one part to another would leave triangles as long as the gap between them.
    #[test]
    fn no_triangle_spans_a_gap() {
        let mesh = made(7);
        let longest = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|corner| mesh.positions()[corner as usize]);
            a.distance(b).max(b.distance(c)).max(c.distance(a))
        };
        let longest = mesh.triangles().iter().map(longest).fold(0.0, f32::max);
        assert!(longest < 0.15, "{longest}");
    }

    #[test]
    fn only_levels_whose_triangles_can_be_seen_have_normals() {
        let smooth = made(3);
        assert!(smooth.normals().iter().all(|normal| normal.is_normalized()) && smooth.normals().len() == 258);
        assert!(made(FINEST_SMOOTH + 1).normals().is_empty());
    }

    #[test]
    fn it_is_given_up_when_it_is_told_so() {
        let halfway = |_: &str, share: f32| share < 0.5;
        assert!(statue(6, &Progress::new(&halfway)).is_err());
    }
}
