//! What numbers a scene may hold. The scene file is read within these limits, and what is changed later stays in them.

use crate::direction::unit;
use crate::{Geometry, Instance};
use glam::Vec3;

/// Squares and volumes of larger numbers leave f32 behind.
pub const LARGEST: f32 = 1e12;

/// As do squares and volumes of smaller lengths, below the least number that is not 0.
pub const SMALLEST: f32 = 1e-12;

/// Whether the edges of a rectangle span an area.
pub fn spans(edge_u: Vec3, edge_v: Vec3) -> bool {
    let [u, v] = [edge_u, edge_v].map(|edge| unit(edge).unwrap_or(Vec3::ZERO));
    let shortest = edge_u.as_dvec3().length().min(edge_v.as_dvec3().length());
    u.cross(v).length() > 1e-6 && shortest >= SMALLEST.into()
}

/// What a shape would do that none may: words behind "would". Of a mesh only where it stands is looked at.
pub fn beyond(geometry: &Geometry) -> Option<&'static str> {
    let (lo, hi) = geometry.bounds();
    let is_near = lo.is_finite() && hi.is_finite() && lo.abs().max(hi.abs()).max_element() <= LARGEST;
    // a mesh without corners is nowhere
    if !(is_near || lo.cmpgt(hi).any()) {
        return Some("reach farther than 1e12 from 0");
    }
    let of_length = |length: f32| match length {
        small if small < SMALLEST => Some("be smaller than 1e-12"),
        fits if fits <= LARGEST => None,
        _ => Some("be larger than 1e12"),
    };
    match geometry {
        Geometry::Sphere { radius, .. } | Geometry::Disk { radius, .. } => of_length(*radius),
        Geometry::Box { size, .. } => of_length(size.min_element()).or(of_length(size.max_element())),
        Geometry::Rectangle { edge_u, edge_v, .. } => {
            let flat = (!spans(*edge_u, *edge_v)).then_some("span no area, or have edges shorter than 1e-12");
            flat.or(of_length(edge_u.abs().max(edge_v.abs()).max_element()))
        }
        Geometry::Mesh(_) => None,
        Geometry::Instance(instance) => squeezed(instance),
    }
}

/// A map that cannot be undone, or not in f32.
fn squeezed(Instance { to_world, .. }: &Instance) -> Option<&'static str> {
    let m = to_world.matrix3.as_dmat3();
    let lengths = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.length());
    if lengths.iter().any(|length| *length > LARGEST.into()) {
        return Some("be scaled by more than 1e12");
    }
    let is_small = lengths.iter().any(|length| *length < f64::from(SMALLEST) * (1.0 - 1e-6));
    let is_undone = to_world.matrix3.determinant() != 0.0 && to_world.inverse().is_finite();
    (is_small || !is_undone).then_some("be scaled to nothing")
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Affine3A, Vec3A};
    use std::sync::Arc;

    #[test]
    fn shapes_within_the_limits_of_files_may_be_and_others_not() {
        let ball = |x: f32, radius| Geometry::Sphere { center: Vec3::new(x, 0.0, 0.0), radius };
        for fits in [ball(0.0, 1e-12), ball(0.0, 1e12), ball(-9e11, 1e10)] {
            assert_eq!(beyond(&fits), None, "{fits:?}");
        }
        for (geometry, words) in [
            (ball(0.0, 9e-13), "smaller"),
            (ball(1e12, 1e6), "farther"),
            (ball(f32::NAN, 1.0), "farther"),
            (ball(0.0, f32::NAN), "farther"),
            (Geometry::Box { corner: Vec3::splat(-9e11), size: Vec3::new(1.0, 1.0, 1.1e12), turn_y: 0.0 }, "larger"),
            (Geometry::Box { corner: Vec3::ZERO, size: Vec3::new(1.0, 1e-13, 1.0), turn_y: 0.0 }, "smaller"),
            (Geometry::Rectangle { corner: Vec3::ZERO, edge_u: Vec3::X, edge_v: Vec3::X * 2.0 }, "area"),
            (Geometry::Rectangle { corner: Vec3::splat(-9e11), edge_u: Vec3::X * 1.5e12, edge_v: Vec3::Y }, "larger"),
        ] {
            assert!(beyond(&geometry).is_some_and(|said| said.contains(words)), "{geometry:?}: {words}");
        }
    }

    #[test]
    fn a_mesh_that_is_scaled_to_nothing_has_no_way_back() {
        let Geometry::Mesh(mesh) = Geometry::mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]) else {
            unreachable!("a mesh")
        };
        let scaled = |by: Vec3| Geometry::Instance(Instance { mesh: mesh.clone(), to_world: Affine3A::from_scale(by) });
        for (by, fits) in [
            (Vec3::splat(1e-12), true),
            (Vec3::new(1e12, -1.0, 1.0), true),
            (Vec3::new(1.0, 0.0, 1.0), false),
            (Vec3::splat(1e-15), false),
        ] {
            assert_eq!(beyond(&scaled(by)).is_none(), fits, "{by}");
        }
        let torn = Affine3A { matrix3: Default::default(), translation: Vec3A::NAN };
        assert!(beyond(&Geometry::Instance(Instance { mesh: Arc::clone(&mesh), to_world: torn })).is_some());
    }
}
