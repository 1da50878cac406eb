//! Connections from vertices to sampled lights by way of a sphere: every ray that goes there by one chain, with its
//! density. The light is sampled as the sphere's centre sees it, for that is the one place on the axis that all rays of a
//! chain have in common: a direction at the vertex then has a density in closed form.
//!
//! Twin: `shaders/pathtrace/caster/connect.wgsl`.

use super::Chains;
use super::sphere_chain::{Ratio, Root, SphereChains};
use crate::intersect::SurfacePoints;
use crate::light::LightSamples;
use crate::sampling::warp::{angle_of_upper, orthonormal_basis};
use simd::{Float, Mask, Vector};

/// A vertex, a sample of a light as a sphere's centre sees it, and a chain by that sphere, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Connections<F: Float> {
    /// By which sphere, and how.
    pub chain: Chains<F>,
    /// Where the ray ends.
    pub light: LightSamples<F>,
    /// Where both ends lie outside of the sphere and the light shines that way.
    pub possible: F::M,
    equation: SphereChains<F>,
    near: Ratio<F>,
    /// Unit direction from the vertex to the centre.
    axis: Vector<F>,
    /// Unit direction across the axis, on the light's side.
    side: Vector<F>,
    /// Unit direction from the centre to the light.
    to_light: Vector<F>,
    /// Between the light and the direction from which turns are counted, and its sine.
    angle: F,
    sin_angle: F,
}

/// A ray from a vertex to a light by way of a sphere, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct ConnectedRays<F> {
    /// Unit direction at the vertex.
    pub wi: Vector<F>,
    /// Where it meets the sphere.
    pub first: SurfacePoints<F>,
    /// Where it leaves the sphere.
    pub last: SurfacePoints<F>,
    /// Unit direction from there to the light.
    pub arriving: Vector<F>,
    /// Share of the light that passes, but for a mirror's colour, and with which chance goes that way.
    pub passes: F,
    /// Density per solid angle of `wi`, for each that the light's sample has as the centre sees it; 0 where no sample
    /// finds this ray.
    pub density: F,
}

impl<F: Float> Connections<F> {
    /// From the points `from` by this chain to this light, which is sampled as the sphere's centre sees it.
    #[inline(always)]
    pub fn new(from: Vector<F>, chain: Chains<F>, light: LightSamples<F>) -> Self {
        let (axis, distance) = unit_and_length(chain.center - from);
        let (to_light, far) = unit_and_length(light.point.position - chain.center);
        let to_light = Vector::select(light.endless, light.wi, to_light);
        let far = End { length: far / chain.radius, endless: light.endless };
        let near = End { length: distance / chain.radius, endless: F::M::splat(false) };
        let opposite = Vector::select(chain.through, axis, -axis);
        let (sin_angle, cos_angle) = (opposite.cross(to_light).length_squared().sqrt(), opposite.dot(to_light));
        let across = to_light - axis * axis.dot(to_light);
        // on the axis itself any side will do
        let any = orthonormal_basis(axis).0;
        let side = Vector::select(across.length_squared().gt(F::splat(f32::MIN_POSITIVE)), across.normalize(), any);
        Connections {
            possible: light.shines & near.is_outside() & far.is_outside(),
            equation: SphereChains::new(chain.through, near.ratio(), far.ratio(), chain.surface.inside),
            near: near.ratio(),
            chain,
            light,
            axis,
            side,
            to_light,
            angle: angle_of_upper(sin_angle, cos_angle),
            sin_angle,
        }
    }

    /// Where the sphere is all behind a surface, whose unit normal this is, at the vertex.
    #[inline(always)]
    pub fn is_behind(&self, normal: Vector<F>) -> F::M {
        // its height above the surface is at most -1 radius
        (normal.dot(self.axis) + self.near.times(F::splat(1.0))).le(F::splat(0.0))
    }

    /// One of the roots, below [`MOST_ROOTS`](super::sphere_chain::MOST_ROOTS), where it is wanted.
    #[inline(always)]
    pub fn root(&self, index: u32, wanted: F::M) -> Root<F> {
        self.equation.root(index, self.angle, wanted)
    }

    /// The ray of a root.
    #[inline(always)]
    pub fn ray(&self, root: &Root<F>) -> ConnectedRays<F> {
        let Chains { center, radius, surface, through } = self.chain;
        let incidence = root.incidence;
        let side = Vector::select(root.crosses, -self.side, self.side);
        let theta = [self.near.times(incidence.sin), self.near.cosine(incidence.cos)];
        // central angles from the axis to where the ray meets the sphere, and to where it leaves it on the other side
        let first = difference([incidence.sin, incidence.cos], theta);
        let last =
            difference(first, twice([surface.inside.times(incidence.sin), surface.inside.cosine(incidence.cos)]));
        let first = side * first[0] - self.axis * first[1];
        let last = Vector::select(through, self.axis * last[1] - side * last[0], first);
        let last = SurfacePoints::on_sphere(center, radius, last);
        let to_light = (self.light.point.position - last.position).normalize();
        let arriving = Vector::select(self.light.endless, self.light.wi, to_light);
        let facing = facing(&self.light.point, self.to_light, arriving);
        ConnectedRays {
            wi: self.axis * theta[1] + side * theta[0],
            first: SurfacePoints::on_sphere(center, radius, first),
            last,
            arriving,
            passes: surface.passes(through, incidence),
            density: self.equation.density(incidence, self.sin_angle) * facing,
        }
    }
}

/// How much nearer to the axis of a ray that arrives along `arriving` a light's surface is turned than to that of one from
/// the centre of the sphere, by the cosines; 1 without a surface, 0 where they come from different sides of it.
#[inline(always)]
pub fn facing<F: Float>(light: &SurfacePoints<F>, from_center: Vector<F>, arriving: Vector<F>) -> F {
    let (zero, one) = (F::splat(0.0), F::splat(1.0));
    let (center, ray) = (light.normal.dot(from_center), light.normal.dot(arriving));
    let ratio = F::select((center * ray).gt(zero), center / ray, zero);
    F::select(light.normal.is_zero(), one, ratio)
}

/// One end of a chain.
#[derive(Debug, Clone, Copy)]
pub struct End<F: Float> {
    /// From the sphere's centre, in radii.
    pub length: F,
    /// A direction rather than a point.
    pub endless: F::M,
}

impl<F: Float> End<F> {
    /// Where it lies outside of the sphere.
    #[inline(always)]
    pub fn is_outside(&self) -> F::M {
        self.endless | self.length.gt(F::splat(1.0))
    }

    /// Sine of the ray's angle there to that of the incidence.
    #[inline(always)]
    pub fn ratio(&self) -> Ratio<F> {
        Ratio::select(self.endless, Ratio::zero(), Ratio::inverse(self.length))
    }
}

#[inline(always)]
fn unit_and_length<F: Float>(v: Vector<F>) -> (Vector<F>, F) {
    let length = v.length_squared().sqrt();
    (v * (F::splat(1.0) / length), length)
}

/// Sine and cosine of the difference of two angles.
#[inline(always)]
fn difference<F: Float>([sin_a, cos_a]: [F; 2], [sin_b, cos_b]: [F; 2]) -> [F; 2] {
    [sin_a * cos_b - cos_a * sin_b, cos_a * cos_b + sin_a * sin_b]
}

/// Sine and cosine of twice an angle.
#[inline(always)]
fn twice<F: Float>([sin, cos]: [F; 2]) -> [F; 2] {
    [sin * cos * 2.0, F::splat(1.0) - sin * sin * 2.0]
}
