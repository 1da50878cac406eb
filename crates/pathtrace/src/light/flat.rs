//! A flat area light: the tutorial's `L cos' S / |x - x'|^2`, a point uniform on the area light and its density `1 / S`
//! turned into solid angle. From nearby that weight has no bound; a rectangle is then sampled uniformly in solid angle
//! instead.
//!
//! Twin: `shaders/pathtrace/light/flat.wgsl`.

use super::spherical_rectangle::SphericalRectangles;
use crate::intersect::SurfacePoints;
use crate::sampling::warp;
use scene::Vec3;
use scene::glam::DVec3;
use simd::{Float, Mask, Vector};
use std::f32::consts::PI;

/// What a flat area light looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outline {
    /// All of the parallelogram of its edges.
    Parallelogram,
    /// As [`Outline::Parallelogram`], the edges at right angles.
    Rectangle,
    /// The half of it on the corner's side.
    Triangle,
    /// The corner is its centre, the edges are radii at right angles.
    Disk,
}

/// A flat area light.
#[derive(Debug, Clone, Copy)]
pub struct Flat {
    pub outline: Outline,
    pub corner: Vec3,
    pub edge_u: Vec3,
    pub edge_v: Vec3,
    /// Unit.
    pub normal: Vec3,
    /// Of one side.
    pub area: f32,
}

/// Solid angle from which on a rectangle may be sampled by it: below, single precision knows the angle too badly.
pub(crate) const SMALLEST_SOLID_ANGLE: f32 = 0.05;

impl Flat {
    /// A parallelogram; `None` without area. In f64, whose squares hold what f32's do not.
    pub fn parallelogram(corner: Vec3, edge_u: Vec3, edge_v: Vec3) -> Option<Self> {
        let (u, v) = (edge_u.as_dvec3(), edge_v.as_dvec3());
        let cross = u.cross(v);
        let square = u.dot(v).abs() <= 1e-6 * u.length() * v.length();
        let outline = if square { Outline::Rectangle } else { Outline::Parallelogram };
        let normal = cross.try_normalize()?.as_vec3();
        Some(Flat { outline, corner, edge_u, edge_v, normal, area: cross.length() as f32 })
    }

    /// A triangle with its unit normal.
    pub fn triangle([a, b, c]: [Vec3; 3], normal: Vec3) -> Self {
        let doubled = (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3()).length();
        let [edge_u, edge_v] = [b - a, c - a];
        Flat { outline: Outline::Triangle, corner: a, edge_u, edge_v, normal, area: (0.5 * doubled) as f32 }
    }

    /// How far along its edges the uniform point lies that two numbers choose.
    pub fn place(&self, u: [f32; 2]) -> [f32; 2] {
        match self.outline {
            Outline::Parallelogram | Outline::Rectangle => u,
            Outline::Triangle => {
                let [_, s, t] = warp::triangle(u);
                [s, t]
            }
            Outline::Disk => warp::disk(u),
        }
    }

    /// A disk with its unit normal. Its radii in f64: each component shall be right for itself.
    pub fn disk(center: Vec3, normal: Vec3, radius: f32) -> Self {
        let exact = normal.as_dvec3().normalize();
        let edge_u = exact.any_orthonormal_vector();
        let [edge_u, edge_v] = [edge_u, exact.cross(edge_u)].map(|edge: DVec3| (edge * f64::from(radius)).as_vec3());
        Flat { outline: Outline::Disk, corner: center, edge_u, edge_v, normal, area: PI * radius * radius }
    }
}

/// A flat area light in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Flats<F: Float> {
    pub corner: Vector<F>,
    pub edge_u: Vector<F>,
    pub edge_v: Vector<F>,
    pub normal: Vector<F>,
    pub area: F,
    pub two_sided: F::M,
    pub is_rectangle: F::M,
    pub is_triangle: F::M,
    pub is_disk: F::M,
}

/// A sample of a flat area light in each lane.
#[derive(Debug, Clone, Copy)]
pub struct FlatSamples<F: Float> {
    /// Where the area light shines.
    pub shines: F::M,
    /// Unit direction towards it.
    pub wi: Vector<F>,
    /// Of the density per solid angle.
    pub inverse_pdf: F,
    pub point: SurfacePoints<F>,
    /// How far along its edges the point lies.
    pub place: [F; 2],
}

impl<F: Float> Flats<F> {
    /// Light from the area lights at `x`.
    #[inline(always)]
    pub fn sample(&self, x: Vector<F>, u: [F; 2]) -> FlatSamples<F> {
        let mut place = u;
        if self.is_triangle.any() {
            let [_, s, t] = warp::triangle(u);
            place = [F::select(self.is_triangle, s, place[0]), F::select(self.is_triangle, t, place[1])];
        }
        if self.is_disk.any() {
            let [s, t] = warp::disk(u);
            place = [F::select(self.is_disk, s, place[0]), F::select(self.is_disk, t, place[1])];
        }
        let (near, mut solid_angle) = (self.is_near(x), F::splat(0.0));
        if near.any() {
            let seen = self.seen_from(x);
            let [s, t] = seen.sample(u);
            solid_angle = seen.solid_angle();
            let by_angle = near & solid_angle.gt(F::splat(SMALLEST_SOLID_ANGLE));
            place = [F::select(by_angle, s, place[0]), F::select(by_angle, t, place[1])];
        }
        let by_angle = near & solid_angle.gt(F::splat(SMALLEST_SOLID_ANGLE));
        let point = SurfacePoints::on_plane(self.corner, self.edge_u * place[0], self.edge_v * place[1], self.normal);
        let to_light = point.position - x;
        let distance_squared = to_light.length_squared();
        let wi = to_light * (F::splat(1.0) / distance_squared.sqrt());
        let cos_light = self.cosine(wi);
        let inverse_pdf = F::select(by_angle, solid_angle, cos_light * self.area / distance_squared);
        // also refuses x on the area light itself, where wi is NaN
        FlatSamples { shines: cos_light.gt(F::splat(0.0)), wi, inverse_pdf, point, place }
    }

    /// Density per solid angle of the direction from `x` to the point `on` the area light; infinite for an edge that no
    /// sample sees.
    #[inline(always)]
    pub fn pdf(&self, x: Vector<F>, on: Vector<F>) -> F {
        let to_light = on - x;
        let distance_squared = to_light.length_squared();
        let cos_light = self.cosine(to_light * (F::splat(1.0) / distance_squared.sqrt()));
        let by_area =
            F::select(cos_light.gt(F::splat(0.0)), distance_squared / (cos_light * self.area), F::splat(f32::INFINITY));
        let near = self.is_near(x);
        if !near.any() {
            return by_area;
        }
        let solid_angle = self.seen_from(x).solid_angle();
        let by_angle = near & solid_angle.gt(F::splat(SMALLEST_SOLID_ANGLE));
        F::select(by_angle, F::splat(1.0) / solid_angle, by_area)
    }

    #[inline(always)]
    fn cosine(&self, wi: Vector<F>) -> F {
        let cosine = -self.normal.dot(wi);
        F::select(self.two_sided, cosine.abs(), cosine)
    }

    /// Whether it is a rectangle whose middle is nearer than the root of its area: there its solid angle is worth its
    /// price.
    #[inline(always)]
    fn is_near(&self, x: Vector<F>) -> F::M {
        let to_middle = self.corner + (self.edge_u + self.edge_v) * F::splat(0.5) - x;
        self.is_rectangle & to_middle.length_squared().le(self.area)
    }

    #[inline(always)]
    fn seen_from(&self, x: Vector<F>) -> SphericalRectangles<F> {
        SphericalRectangles::new(x, self.corner, self.edge_u, self.edge_v)
    }
}
