//! A sphere as an area light: uniform in the cone that it fills as seen from a point outside; from inside, where only a
//! two-sided area light shines, uniform in all directions.
//!
//! Twin: `shaders/pathtrace/light/ball.wgsl`.

use crate::intersect::sphere::SphereLanes;
use crate::intersect::{SurfacePoints, gamma};
use crate::sampling::warp;
use simd::{Float, Vector};

/// `1 - cos` of the cone of all directions.
pub(crate) const ALL_DIRECTIONS: f32 = 2.0;

/// A sample of a ball in each lane.
#[derive(Debug, Clone, Copy)]
pub struct BallSamples<F: Float> {
    /// Where the area light shines.
    pub shines: F::M,
    /// Unit direction towards it.
    pub wi: Vector<F>,
    /// Density per solid angle.
    pub pdf: F,
    pub point: SurfacePoints<F>,
}

/// `1 - cos` of the half angle of the cone that the sphere fills as seen from `x`, and where `x` is outside. Exact for
/// a sphere tiny or far away, and where the point almost touches it. From inside, the cone of all directions.
///
/// A point on the sphere itself counts as inside: which side it was rounded to says nothing, from inside it sees the
/// whole sphere, and outside nothing of it.
#[inline(always)]
pub(crate) fn cone<F: Float>(x: Vector<F>, ball: &SphereLanes<F>) -> (F, F::M) {
    let (radius, distance) = (ball.radius, (ball.center - x).length_squared().sqrt());
    let rounding = (ball.center.abs().max_element() + radius) * gamma(8);
    let outside = !distance.le(radius + rounding);
    let cos = ((distance - radius) * (distance + radius)).sqrt() / distance;
    let sin = radius / distance;
    (F::select(outside, sin * sin / (cos + 1.0), F::splat(ALL_DIRECTIONS)), outside)
}

/// Where a sample from `x` may be a point of the ball on whose outer side `x` lies, or does not.
#[inline(always)]
pub fn sees<F: Float>(x: Vector<F>, ball: &SphereLanes<F>, two_sided: F::M, on_outer_side: F::M) -> F::M {
    let outside = cone(x, ball).1;
    (outside & on_outer_side) | (!outside & two_sided)
}

/// Density per solid angle of a direction from `x` that meets the ball.
#[inline(always)]
pub fn pdf<F: Float>(x: Vector<F>, ball: &SphereLanes<F>) -> F {
    warp::cone_pdf(cone(x, ball).0)
}

/// Light from the balls at `x`.
#[inline(always)]
pub fn sample<F: Float>(x: Vector<F>, ball: &SphereLanes<F>, two_sided: F::M, u: [F; 2]) -> BallSamples<F> {
    let to_center = ball.center - x;
    let (one_minus_cos, outside) = cone(x, ball);
    let local = warp::cone(one_minus_cos, u);
    let wi = Vector::select(outside, warp::to_world(local, to_center.normalize()), local);
    // at the rim, rounding may find no meeting; then the point where the direction comes nearest stands for it
    let along = to_center.dot(wi);
    let off_axis = (to_center - wi * along).length_squared();
    let half_chord = (ball.radius * ball.radius - off_axis).max(F::splat(0.0)).sqrt();
    let met = wi * F::select(outside, along - half_chord, along + half_chord) - to_center;
    let point = SurfacePoints::on_sphere(ball.center, ball.radius, met);
    BallSamples { shines: outside | two_sided, wi, pdf: warp::cone_pdf(one_minus_cos), point }
}
