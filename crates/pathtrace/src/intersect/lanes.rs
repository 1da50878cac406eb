//! Rays and what they meet, in each lane.
//!
//! Twins: `shaders/pathtrace/intersect/ray.wgsl`, `nearest.wgsl`, `sphere.wgsl` and `surface_point.wgsl`.

use super::{SurfacePoint, gamma};
use crate::vectors::{each_lane, in_all_lanes, lane_vector};
use scene::Vec3;
use simd::{Float, MOST_LANES, Vector};

/// A ray in each lane; points on it are `origin + direction * t` for `0 < t < tmax`.
#[derive(Debug, Clone, Copy)]
pub struct Rays<F> {
    /// Where it starts, world space.
    pub origin: Vector<F>,
    /// Where it goes; unit length but for shadow rays, which end at `t` = 1.
    pub direction: Vector<F>,
    /// Hits must lie before this.
    pub tmax: F,
}

impl<F: Float> Rays<F> {
    /// Rays without end along unit vectors.
    #[inline(always)]
    pub fn new(origin: Vector<F>, direction: Vector<F>) -> Self {
        Rays { origin, direction, tmax: F::splat(f32::INFINITY) }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Rays {
            origin: Vector::select(mask, yes.origin, no.origin),
            direction: Vector::select(mask, yes.direction, no.direction),
            tmax: F::select(mask, yes.tmax, no.tmax),
        }
    }

    /// The ray of each lane.
    #[inline(always)]
    pub fn each(&self) -> [super::Ray; MOST_LANES] {
        let [origin, direction] = [each_lane(self.origin), each_lane(self.direction)];
        let mut tmax = [0.0; MOST_LANES];
        self.tmax.store(&mut tmax);
        std::array::from_fn(|lane| super::Ray { tmax: tmax[lane], ..super::Ray::new(origin[lane], direction[lane]) })
    }
}

/// A point of a surface in each lane, with a bound on its rounding error; and the step off the surface that the bound
/// asks for (pbrt, section 6.8): large enough that a new ray cannot meet the surface that it leaves, and no larger.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoints<F> {
    /// PreparedScene space.
    pub position: Vector<F>,
    /// The surface lies within this distance along each axis.
    pub error: Vector<F>,
    /// Unit geometric normal.
    pub normal: Vector<F>,
}

impl<F: Float> SurfacePoints<F> {
    /// The point of a flat surface that is `along_u` and `along_v` from its corner.
    #[inline(always)]
    pub fn on_plane(corner: Vector<F>, along_u: Vector<F>, along_v: Vector<F>, normal: Vector<F>) -> Self {
        let error = (corner.abs() + along_u.abs() + along_v.abs()) * F::splat(gamma(5));
        SurfacePoints { position: corner + along_u + along_v, error, normal }
    }

    /// The point of a sphere in a direction from its centre, of any length but 0.
    #[inline(always)]
    pub fn on_sphere(center: Vector<F>, radius: F, from_center: Vector<F>) -> Self {
        let normal = from_center.normalize();
        let out = normal * radius;
        let error = (center.abs() + out.abs()) * F::splat(gamma(5));
        SurfacePoints { position: center + out, error, normal }
    }

    /// The point of the plane through `center` that is nearest to `near`.
    #[inline(always)]
    pub fn on_disk(center: Vector<F>, near: Vector<F>, normal: Vector<F>) -> Self {
        let from_center = near - center;
        let out = from_center - normal * normal.dot(from_center);
        // what is left of the normal in `out` is a rounding error of its length, along all axes
        let error = (center.abs() + Vector::along_all(out.length_squared().sqrt())) * F::splat(gamma(8));
        SurfacePoints { position: center + out, error, normal }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        SurfacePoints {
            position: Vector::select(mask, yes.position, no.position),
            error: Vector::select(mask, yes.error, no.error),
            normal: Vector::select(mask, yes.normal, no.normal),
        }
    }

    /// The start of a ray that leaves on the side of `direction`.
    #[inline(always)]
    pub fn leaving_towards(&self, direction: Vector<F>) -> Vector<F> {
        // the step itself is rounded too
        let error = self.error + self.position.abs() * F::splat(gamma(2));
        let along = self.normal.abs().dot(error);
        self.position + self.normal * along.copysign(direction.dot(self.normal))
    }
}

impl From<SurfacePoint> for SurfacePoints<f32> {
    fn from(point: SurfacePoint) -> Self {
        let [position, error, normal] = [point.position, point.error, point.normal].map(lane_vector);
        SurfacePoints { position, error, normal }
    }
}

/// The nearest meeting of a ray with a surface, in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Hits<F: Float> {
    /// Whether anything was met; what else is said holds only there.
    pub met: F::M,
    /// Where, with the outward normal.
    pub point: SurfacePoints<F>,
    /// Index into the scene's materials.
    pub material: F::U,
    /// Index into the list of lights, or [`super::NO_LIGHT`].
    pub light: F::U,
}

/// A sphere, the same in all lanes.
#[derive(Debug, Clone, Copy)]
pub struct SphereLanes<F> {
    /// Centre, world space.
    pub center: Vector<F>,
    /// Radius, > 0.
    pub radius: F,
}

impl<F: Float> SphereLanes<F> {
    /// The sphere in all lanes.
    #[inline(always)]
    pub fn new(center: Vec3, radius: f32) -> Self {
        SphereLanes { center: in_all_lanes(center), radius: F::splat(radius) }
    }

    /// Where a ray meets the sphere, and the distance of the nearest meeting with `0 < t < tmax`, in lengths of its
    /// direction. Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection" (Ray Tracing
    /// Gems, chapter 7).
    #[inline(always)]
    pub fn intersect(&self, rays: &Rays<F>) -> (F::M, F) {
        let (zero, d) = (F::splat(0.0), rays.direction);
        let f = rays.origin - self.center;
        let a = d.length_squared();
        let b = -f.dot(d);
        // squared distance of the centre from the line, without the cancellation of b^2 - a c
        let off_axis = f + d * (b / a);
        let discriminant = self.radius * self.radius - off_axis.length_squared();
        let q = b + (a * discriminant.max(zero)).sqrt().copysign(b);
        let c = f.length_squared() - self.radius * self.radius;
        let (t0, t1) = (c / q, q / a);
        let (near, far) = (t0.min(t1), t0.max(t1));
        let t = F::select(near.gt(zero), near, far);
        (discriminant.ge(zero) & t.gt(zero) & t.lt(rays.tmax), t)
    }

    /// The point at the distance `t` of [`SphereLanes::intersect`], relative to the centre. From the point of the ray
    /// nearest to the centre, not along the ray: what a long `t` rounds does not turn the normal.
    #[inline(always)]
    pub fn meeting(&self, rays: &Rays<F>, t: F) -> Vector<F> {
        let f = rays.origin - self.center;
        let d = rays.direction;
        let a = d.length_squared();
        let middle = -f.dot(d) / a;
        let off_axis = f + d * middle;
        let within = (self.radius * self.radius - off_axis.length_squared()).max(F::splat(0.0));
        off_axis + d * (within / a).sqrt().copysign(t - middle)
    }
}
