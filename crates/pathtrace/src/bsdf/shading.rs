//! Shading normals: what a mesh of few triangles, or a texture, says of a surface that is smoother or rougher than its
//! triangles are, and what keeps light from coming through it where both disagree.
//!
//! A ray's side is that of the triangle, and the normal is turned to that side. What mirrors is shaded by a normal that is no
//! further from the triangle's than leaves the mirror direction above it, what is matt by the normal as it is, as in Cycles
//! (Blender, `ensure_valid_specular_reflection`, which is asked for lobes of facets alone): Lambert's law knows no mirror
//! direction, and a normal that is turned towards the eye gets other light. A direction on another side of the triangle than
//! of the shading surface is black (Veach, "Robust Monte Carlo Methods for Light Transport Simulation" (1997), 5.3). The
//! edge of a shadow that the triangles cast on what looks round is smoothed as in Chiang, Li and Burley, "Taming the Shadow
//! Terminator" (SIGGRAPH Talks 2019).
//!
//! Twin: `shaders/pathtrace/bsdf/shading.wgsl`.

use super::Interactions;
use super::interaction::facing;
use crate::intersect::SurfaceAttributes;
use simd::{Float, Mask, Vector};

/// Least cosine between the normals of a triangle and of a matt surface: where a texture says that it is seen from below,
/// it is as good as upright. No photon's power grows by more than about its inverse.
pub const LEAST_UPRIGHT: f32 = 0.01;

/// The unit normal that a surface with this unit outward normal is shaded by, on its side that `wo` sees; `bumps` are the
/// normals of a texture, x along the tangent and z along the normal. Surfaces that do nothing but mirror have that of
/// `bent`.
#[inline(always)]
pub fn shading_normal<F: Float>(
    outwards: Vector<F>,
    attributes: &SurfaceAttributes<F>,
    bumps: Option<Vector<F>>,
    wo: Vector<F>,
    mirrors: F::M,
) -> Vector<F> {
    let zero = F::splat(0.0);
    let smooth = attributes.normal.normalize();
    let smooth = Vector::select(smooth.is_finite(), facing(smooth, outwards), outwards);
    let bumpy = bumps.map_or(smooth, |bumps| bumped(smooth, attributes, bumps));
    let behind = outwards.dot(wo).lt(zero);
    let geometric = Vector::select(behind, -outwards, outwards);
    let seen = Vector::select(behind, -bumpy, bumpy);
    let matt = upright(geometric, seen);
    if mirrors.any() { Vector::select(mirrors, bent(geometric, seen, wo), matt) } else { matt }
}

/// The unit normal by which facets mirror on a surface that has a matt body too.
#[inline(always)]
pub fn mirroring_normal<F: Float>(at: &Interactions<F>) -> Vector<F> {
    bent(facing(at.point.normal, at.wo), at.normal, at.wo)
}

/// A normal of a texture, put onto a surface.
#[inline(always)]
fn bumped<F: Float>(normal: Vector<F>, attributes: &SurfaceAttributes<F>, bumps: Vector<F>) -> Vector<F> {
    let along = attributes.tangent - normal * normal.dot(attributes.tangent);
    let s = along.normalize();
    let t = normal.cross(s) * attributes.handedness;
    let bumped = (s * bumps.x + t * bumps.y + normal * bumps.z).normalize();
    // where there is no tangent it is NaN
    Vector::select(bumped.is_finite(), bumped, normal)
}

/// The normal, raised to [`LEAST_UPRIGHT`] above the triangle of normal `g` where it is lower.
#[inline(always)]
fn upright<F: Float>(g: Vector<F>, n: Vector<F>) -> Vector<F> {
    let (along_g, least) = (n.dot(g), F::splat(LEAST_UPRIGHT));
    let x = (n - g * along_g).normalize();
    let raised = (x + g * least).normalize();
    // of normals that are one there is no plane
    let raised = Vector::select(raised.is_finite(), raised, g);
    Vector::select(along_g.ge(least), n, raised)
}

/// The normal, turned towards that of the triangle on the side of `wo` as far as the mirror direction of `wo` asks that is
/// to lie above the triangle: at a sine of a hundredth, or nearly as high as `wo` where that is lower. It is the solution
/// of `2 (n . wo) (n . g) - g . wo = least` in the plane of both normals, a quadratic equation for the square of `n . g`.
#[inline(always)]
fn bent<F: Float>(g: Vector<F>, n: Vector<F>, wo: Vector<F>) -> Vector<F> {
    let (zero, one) = (F::splat(0.0), F::splat(1.0));
    let (height, along_g) = (g.dot(wo), n.dot(g));
    let least = (height * 0.9).min(F::splat(0.01));
    let valid = along_g.gt(zero) & (n.dot(wo) * along_g * 2.0 - height).ge(least);
    let x = (n - g * along_g).normalize();
    let x = (x - g * g.dot(x)).normalize();
    let across = x.dot(wo);
    let a = across * across + height * height;
    // half of the discriminant's root, and the roots in the forms that do not cancel
    let root = across.abs() * (a - least * least).max(zero).sqrt();
    let cosine = (height + least) * (height + least) / ((a + height * least + root) * 2.0);
    let sine = (height - least) * (height - least) / ((a - height * least + root) * 2.0);
    let opposite = across.lt(zero);
    let sine_squared = F::select(opposite, sine, one - cosine).max(zero);
    // above 0 by more than rounding takes
    let cosine_squared = F::select(opposite, one - sine, cosine).max(F::splat(1e-12));
    let turned = x * sine_squared.sqrt() + g * cosine_squared.sqrt();
    // of normals that are one there is no plane
    let turned = Vector::select(turned.is_finite() & a.gt(zero), turned, g);
    Vector::select(valid, n, turned)
}

/// Share of light from `wi` that a lobe which leaves a choice keeps: none from the other side of the triangle, and less
/// where the triangle's own terminator is near.
#[inline(always)]
pub fn terminator<F: Float>(normal: Vector<F>, outwards: Vector<F>, wi: Vector<F>) -> F {
    let (zero, one) = (F::splat(0.0), F::splat(1.0));
    let g = facing(outwards, normal);
    let above = g.dot(wi);
    let ratio = (above / (normal.dot(wi) * g.dot(normal))).min(one);
    let kept = ratio * (one + ratio * (one - ratio));
    F::select(above.gt(zero) & normal.dot(wi).gt(zero), kept, zero)
}

/// What remains of the weight of a direction that was drawn.
#[inline(always)]
pub fn kept<F: Float>(at: &Interactions<F>, wi: Vector<F>) -> F {
    let (zero, one) = (F::splat(0.0), F::splat(1.0));
    let g = facing(at.point.normal, at.normal);
    // of mirrors and glass, whichever side it is, if it is one
    let one_side = (g.dot(wi) * at.normal.dot(wi)).gt(zero);
    F::select(at.is_delta(), F::select(one_side, one, zero), terminator(at.normal, at.point.normal, wi))
}

/// By how much more light from `w` counts that is shaded by the normal than falls onto the triangle.
#[inline(always)]
fn over_geometric<F: Float>(at: &Interactions<F>, w: Vector<F>) -> F {
    let (zero, one) = (F::splat(0.0), F::splat(1.0));
    let kept = F::select(at.is_delta(), one, terminator(at.normal, at.point.normal, w));
    let cosine = at.point.normal.dot(w).abs();
    F::select(cosine.gt(zero), at.normal.dot(w).abs() * kept / cosine, zero)
}

/// By what the power of a photon is multiplied that comes from `wo` and stays where photons are counted
/// by the triangle's area.
#[inline(always)]
pub fn of_arriving<F: Float>(at: &Interactions<F>) -> F {
    over_geometric(at, at.wo)
}

/// A surface as a photon leaves it. One with a matt body sends light out by the triangle's own normal: the shading normal
/// says how much arrives, and is not asked again from where that is seen, which may be behind it.
#[inline(always)]
pub fn as_left<F: Float>(at: &Interactions<F>) -> Interactions<F> {
    let matt = at.is_diffuse() | at.kinds.metallic_roughness();
    Interactions { normal: Vector::select(matt, facing(at.point.normal, at.wo), at.normal), ..*at }
}

/// By what the weight of a direction `wi` is multiplied in which a photon leaves a surface ([`as_left`]): light walks there against
/// the way that lobes are made for, and shading normals are no symmetric matter (Veach, as above). Not of
/// metallic-roughness.
#[inline(always)]
pub fn adjoint<F: Float>(at: &Interactions<F>, wi: Vector<F>) -> F {
    let (zero, arrives, leaves) = (F::splat(0.0), of_arriving(at), over_geometric(at, wi));
    F::select(at.is_diffuse(), arrives, F::select(leaves.gt(zero), arrives / leaves, zero))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling;
    use crate::sampling::sampler::Sampler;
    use crate::vectors::lane_vector;
    use scene::Vec3;

    fn direction(i: u32, block: u32) -> Vec3 {
        let [u, v, ..] = Sampler::independent(block, i, 91).unit4(0);
        sampling::cone(2.0, [u, v])
    }

    /// Whatever a mesh says, the normal is unit, on the side of the triangle that is seen, and mirrors what is seen above it:
    /// at a hundredth, or at nine tenths of the height from which it is seen, but for some last digits.
    #[test]
    fn mirror_directions_stay_above_the_triangle() {
        let mut turned = 0;
        for i in 0..100_000 {
            let g = direction(i, 1);
            let seen = direction(i, 2);
            // as often as not nearly along the triangle
            let seen = if i % 2 == 0 { (seen - g * g.dot(seen) * 0.999).normalize() } else { seen };
            let [g, n, wo] = [g, direction(i, 3), seen * g.dot(seen).signum()].map(lane_vector);
            let bent = bent(g, n, wo);
            let height = g.dot(wo);
            let mirrored = n_mirrors(bent, wo).dot(g);
            assert!((bent.length_squared() - 1.0).abs() < 1e-5 && bent.dot(g) > 0.0, "{i}: {bent:?}");
            assert!(mirrored >= (0.9 * height).min(0.01) - 2e-6, "{i}: {mirrored}, seen from {height}");
            let kept = (bent - n).length_squared() == 0.0;
            assert!(kept || n.dot(g) <= 0.0 || n_mirrors(n, wo).dot(g) < 0.01, "{i} is turned without need");
            turned += u32::from(!kept);
        }
        assert!((20_000..90_000).contains(&turned), "{turned}");
    }

    /// Matt surfaces keep their normals, but for those that lean below the triangle, which are raised in their own plane.
    #[test]
    fn matt_normals_stay_above_the_triangle() {
        let mut raised = 0;
        for i in 0..10_000 {
            let [g, n] = [1, 3].map(|block| lane_vector(direction(i, block)));
            let upright = upright(g, n);
            let kept = (upright - n).length_squared() == 0.0;
            assert!((upright.length_squared() - 1.0).abs() < 1e-5, "{i}: {upright:?}");
            assert!(upright.dot(g) > 0.99 * LEAST_UPRIGHT && upright.dot(n.cross(g)).abs() < 1e-5, "{i}: {upright:?}");
            assert_eq!(kept, n.dot(g) >= LEAST_UPRIGHT, "{i}");
            raised += u32::from(!kept);
        }
        assert!((4_000..6_000).contains(&raised), "{raised}");
        let g = lane_vector(Vec3::Z);
        assert!((upright(g, -g) - g).length_squared() == 0.0, "straight below there is no plane");
    }

    fn n_mirrors(n: Vector<f32>, wo: Vector<f32>) -> Vector<f32> {
        n * (n.dot(wo) * 2.0) - wo
    }

    /// Where both normals are one, all light stays, to the last bits; behind the triangle none; and never more than all.
    #[test]
    fn light_is_kept_in_front_and_lost_behind() {
        for i in 0..10_000 {
            let [g, n, wi] = [1, 2, 3].map(|block| lane_vector(direction(i, block)));
            let own = terminator(g, g, wi);
            assert!(if g.dot(wi) > 0.0 { (own - 1.0).abs() < 1e-6 } else { own == 0.0 }, "{i}: {own}");
            let kept = terminator(n, g, wi);
            let front = facing(g, n).dot(wi) > 0.0 && n.dot(wi) > 0.0;
            assert!(if front { (0.0..=1.0).contains(&kept) } else { kept == 0.0 }, "{i}: {kept}");
        }
    }

    /// The cosine that shades, with what the terminator keeps, over the triangle's own is bounded: no photon counts more
    /// than by 5 / 4 of the inverse of the cosine between both normals.
    #[test]
    fn no_photon_counts_without_bound() {
        for i in 0..10_000 {
            let [u, v, ..] = Sampler::independent(4, i, 91).unit4(0);
            let (g, n) = (lane_vector(direction(i, 1)), direction(i, 2));
            let wi = lane_vector(sampling::to_world(sampling::cosine_hemisphere([u, v]), n));
            let n = lane_vector(n);
            let over = n.dot(wi) * terminator(n, g, wi) / g.dot(wi).abs();
            assert!(over <= 1.26 / n.dot(g).abs() + 1e-3, "{i}: {over}");
        }
    }
}
