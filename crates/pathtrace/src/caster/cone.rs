//! Cones of directions at shapes of mirror or glass: a part of the directions at a diffuse vertex goes there, where light
//! may come from that no light sampling finds. After "Ray Tracing: The Rest of Your Life" (Shirley), which sends a part
//! of the directions to whatever matters.
//!
//! All cones have one density per solid angle, so that a shape gets directions as it looks large: what is found in a
//! small cone has a variance like the square of its solid angle over its share of the directions, and so shares like the
//! solid angle are the best. They also leave shapes far away nearly alone.
//!
//! Twin: `shaders/pathtrace/caster/cone.wgsl`.

use crate::bsdf::Interactions;
use crate::integrator::settings::ConesAt;
use crate::intersect::sphere::{Sphere, SphereLanes};
use crate::light::{Lights, ball};
use crate::sampling::warp::{cone, to_world};
use scene::{Bsdf, Geometry, Scene, Shape, Vec3};
use simd::{Float, Vector};
use std::f32::consts::TAU;

/// Shapes that get a cone, the largest ones.
pub(crate) const MOST_CONES: usize = 4;

/// Density per solid angle in a cone, as long as all cones together get less than [`MOST_SHARE`].
pub(crate) const CONE_DENSITY: f32 = 1.0;

/// The most directions that go into cones.
pub(crate) const MOST_SHARE: f32 = 0.5;

/// `1 - cos` of the half angle of the widest cone: a shape that looks larger is met by enough directions of the lobe.
pub(crate) const WIDEST: f32 = 0.5;

/// The same of the narrowest, whose rim single precision still holds.
pub(crate) const NARROWEST: f32 = 1e-5;

/// Spheres around the shapes of mirror and glass.
#[derive(Debug, Clone, Default)]
pub struct Cones(Vec<Sphere>);

/// Cones at those spheres, as they are seen from a vertex in each lane.
#[derive(Clone, Copy)]
pub struct SeenCones<F: Float> {
    axes: [Vector<F>; MOST_CONES],
    /// `1 - cos` of the half angles; 0 where there is no cone.
    spans: [F; MOST_CONES],
    count: usize,
    /// Per solid angle, of each.
    density: F,
    /// Of all directions, of all cones.
    share: F,
}

impl Cones {
    /// Of these shapes of a scene; none where all light that they could bring is that of points, which no direction
    /// finds, or of a sky of one colour, which any direction finds.
    pub fn new(at: ConesAt, scene: &Scene, lights: &Lights) -> Self {
        if (0..lights.len()).all(|light| lights.is_delta(light)) {
            return Cones::default();
        }
        let shapes = shapes_with_cones(at, scene).into_iter();
        let mut spheres: Vec<Sphere> = shapes.map(|shape| bounding_sphere(&shape.geometry)).collect();
        spheres.sort_by(|a, b| b.radius.total_cmp(&a.radius));
        spheres.truncate(MOST_CONES);
        Cones(spheres)
    }

    /// Whether no direction goes into a cone.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Centre and radius of each sphere, for a device.
    pub(crate) fn spheres(&self) -> [[f32; 4]; MOST_CONES] {
        let mut spheres = [[0.0; 4]; MOST_CONES];
        for (to, from) in spheres.iter_mut().zip(&self.0) {
            *to = from.center.extend(from.radius).to_array();
        }
        spheres
    }

    /// The cones as seen from vertices. None from inside a sphere, nor below the surface.
    #[inline(always)]
    pub fn seen_from<F: Float>(&self, at: &Interactions<F>) -> SeenCones<F> {
        let zero = F::splat(0.0);
        let (mut axes, mut spans) = ([Vector::zero(); MOST_CONES], [zero; MOST_CONES]);
        let mut sum = zero;
        for (i, sphere) in self.0.iter().enumerate() {
            let sphere: SphereLanes<F> = sphere.lanes();
            let to_center = sphere.center - at.point.position;
            let (one_minus_cos, outside) = ball::cone(at.point.position, &sphere);
            let above = at.normal.dot(to_center).gt(-sphere.radius);
            let of_use = one_minus_cos.gt(F::splat(NARROWEST)) & one_minus_cos.lt(F::splat(WIDEST));
            let seen = outside & above & of_use;
            axes[i] = to_center.normalize();
            spans[i] = F::select(seen, one_minus_cos, zero);
            sum = sum + spans[i];
        }
        let solid_angle = sum * TAU;
        let share = (solid_angle * CONE_DENSITY).min(F::splat(MOST_SHARE));
        let density = F::splat(CONE_DENSITY).min(F::splat(MOST_SHARE) / solid_angle);
        SeenCones { axes, spans, count: self.0.len(), density, share }
    }
}

impl<F: Float> SeenCones<F> {
    /// Where `u` in [0, 1) chooses a cone rather than the lobe, and a direction uniform in it.
    #[inline(always)]
    pub fn sample(&self, u: F, of_direction: [F; 2]) -> (F::M, Vector<F>) {
        let chosen = u.lt(self.share);
        let (mut axis, mut span) = (self.axes[0], self.spans[0]);
        let mut below = span * self.density * TAU;
        for i in 1..self.count {
            let next = u.ge(below) & self.spans[i].gt(F::splat(0.0));
            axis = Vector::select(next, self.axes[i], axis);
            span = F::select(next, self.spans[i], span);
            below = below + self.spans[i] * self.density * TAU;
        }
        (chosen, to_world(cone(span, of_direction), axis))
    }

    /// Density per solid angle of a direction that the lobe draws with density `lobe`: the lobe has what the cones leave.
    #[inline(always)]
    pub fn pdf(&self, wi: Vector<F>, lobe: F) -> F {
        let mut covering = F::splat(0.0);
        for i in 0..self.count {
            // by the chord between unit vectors, exact for a narrow cone where a cosine is not
            let chord = wi - self.axes[i];
            let inside = chord.length_squared().lt(self.spans[i] * 2.0);
            covering = covering + F::select(inside, F::splat(1.0), F::splat(0.0));
        }
        lobe * (F::splat(1.0) - self.share) + covering * self.density
    }
}

/// Shapes of mirror and glass that a part of the directions goes to.
pub fn shapes_with_cones(at: ConesAt, scene: &Scene) -> Vec<&Shape> {
    let is_ball = |shape: &Shape| matches!(shape.geometry, Geometry::Sphere { .. });
    let is_specular =
        |shape: &&Shape| matches!(scene.material_of(shape).bsdf, Bsdf::Mirror { .. } | Bsdf::Dielectric { .. });
    let speculars: Vec<&Shape> = scene.shapes.iter().filter(is_specular).collect();
    let several_balls = speculars.iter().filter(|shape| is_ball(shape)).count() > 1;
    let gets_one = |shape: &&Shape| match at {
        ConesAt::Nothing => false,
        ConesAt::Usual => shape.geometry.mesh_of().is_some() || (several_balls && is_ball(shape)),
        ConesAt::Everything => true,
    };
    speculars.into_iter().filter(gets_one).collect()
}

/// A sphere around a shape, not always the smallest.
fn bounding_sphere(geometry: &Geometry) -> Sphere {
    let around = |center: Vec3, corners: &[Vec3]| {
        let radius = corners.iter().map(|corner| corner.distance(center)).fold(0.0, f32::max);
        Sphere { center, radius }
    };
    match geometry {
        Geometry::Sphere { center, radius } | Geometry::Disk { center, radius, .. } => {
            Sphere { center: *center, radius: *radius }
        }
        Geometry::Rectangle { .. } | Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
            around(geometry.center(), &geometry.flat_triangles().0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::materials::Materials;
    use crate::integrator::directions::DirectionsAt;
    use crate::intersect::SurfacePoints;
    use crate::sampling::sampler::Sampler;
    use crate::sampling::warp::cosine_hemisphere;
    use crate::vectors::lane_vector;
    use scene::stand_ins::FakeMaterial;
    use scene::{Material, Texture};
    use std::f32::consts::{FRAC_1_PI, PI};

    /// A point of a diffuse floor.
    fn floor_at(position: Vec3) -> Interactions<f32> {
        let bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::ONE) };
        let materials = Materials::new(&[Material {
            name: String::new(),
            bsdf,
            emission: None,
            surface: Default::default(),
            fake: FakeMaterial::default(),
        }]);
        let (position, up) = (lane_vector(position), lane_vector(Vec3::Y));
        let point = SurfacePoints { normal: up, ..SurfacePoints::in_the_air(position) };
        Interactions { point, normal: up, wo: up, colour: up, kinds: materials.kinds(0), material: 0, uv: [0.0; 2] }
    }

    fn around(spheres: &[([f32; 3], f32)]) -> Cones {
        let sphere = |&(center, radius): &([f32; 3], f32)| Sphere { center: Vec3::from_array(center), radius };
        Cones(spheres.iter().map(sphere).collect())
    }

    /// Directions into cones that overlap, and those of the lobe beside them: the inverse density of those that fall into
    /// a cone adds up to its solid angle, and Lambert's density over it to 1. Within four standard errors.
    #[test]
    fn directions_follow_the_density_of_lobe_and_cones_together() {
        let at = floor_at(Vec3::new(1.0, 0.0, 2.0));
        let spheres = [([2.0, 2.0, 2.0], 0.5), ([2.3, 2.0, 2.4], 0.7), ([-3.0, 2.0, 2.0], 0.4)];
        let seen = around(&spheres).seen_from(&at);
        let inside = |wi: Vector<f32>, i: usize| (wi - seen.axes[i]).length_squared() < 2.0 * seen.spans[i];
        let n = 400_000;
        let mut sums = [[0.0f64; 2]; 4];
        for sample in 0..n {
            let [u, v, choice, _] = Sampler::independent(3, sample, 5).unit4(0);
            let (chosen, into_cone) = seen.sample(choice, [u, v]);
            let wi = if chosen { into_cone } else { to_world(cosine_hemisphere([u, v]), at.normal) };
            let lobe = at.normal.dot(wi).max(0.0) * FRAC_1_PI;
            let inverse = 1.0 / seen.pdf(wi, lobe);
            let values = [lobe * inverse, 0.0, 0.0, 0.0];
            for (i, sum) in sums.iter_mut().enumerate() {
                let value = if i == 0 { values[0] } else { f32::from(u8::from(inside(wi, i - 1))) * inverse };
                sum[0] += f64::from(value);
                sum[1] += f64::from(value * value);
            }
        }
        for (i, [sum, squares]) in sums.into_iter().enumerate() {
            let (mean, n) = (sum / f64::from(n), f64::from(n));
            let error = ((squares / n - mean * mean) / n).sqrt();
            let expected = if i == 0 { 1.0 } else { f64::from(2.0 * PI * seen.spans[i - 1]) };
            assert!((mean - expected).abs() < 4.0 * error && error < 0.01, "{i}: {mean} +- {error}, not {expected}");
        }
    }

    /// A ball that is half sunk: some directions at the rim of its cone lie below the horizon, and rounding takes some of
    /// those out of the cone.
    #[test]
    fn directions_at_a_rim_below_the_horizon_weigh_nothing() {
        let at = floor_at(Vec3::new(1.0, 0.0, 2.0));
        let bsdf = Bsdf::Diffuse { albedo: Texture::Constant(Vec3::ONE) };
        let materials = Materials::new(&[Material {
            name: String::new(),
            bsdf,
            emission: None,
            surface: Default::default(),
            fake: FakeMaterial::default(),
        }]);
        let mut undrawn = 0;
        for place in 0..40 {
            let cones = around(&[([4.0 + 0.1 * place as f32, 0.1, 2.3], 0.7)]).seen_from(&at);
            let directions = DirectionsAt { materials: &materials, uniform: false, cones: Some(cones) };
            for azimuth in 0..2000 {
                let u = [1.0 - 0.5 * f32::EPSILON, azimuth as f32 / 2000.0, 0.0];
                let drawn = directions.sample(true, &at, Vector::along_all(1.0), u);
                undrawn += u32::from(drawn.sample.pdf == 0.0);
                assert!(drawn.throughput.is_finite() && drawn.throughput.x >= 0.0);
            }
        }
        assert!(undrawn > 0, "none of these directions is what this is about");
    }

    /// Between running sums, as far as they are rounded, the last cone that there is.
    #[test]
    fn no_direction_goes_to_a_cone_that_is_not_there() {
        let seen = around(&[([0.0, 3.0, 0.0], 1.0), ([0.0, -9.0, 0.0], 0.5)]).seen_from(&floor_at(Vec3::ZERO));
        assert_eq!(seen.spans[1], 0.0);
        let below = seen.share.next_down();
        let (chosen, wi) = seen.sample(below.max(seen.spans[0] * seen.density * TAU), [0.5, 0.5]);
        assert!(!chosen || wi.y > 0.9, "{wi:?}");
    }

    #[test]
    fn there_is_no_cone_from_inside_below_the_floor_nor_at_what_fills_half_the_sky() {
        let share = |center: [f32; 3], radius: f32| around(&[(center, radius)]).seen_from(&floor_at(Vec3::ZERO)).share;
        assert!(share([0.0, 3.0, 0.0], 1.0) > 0.3);
        assert_eq!(share([0.0, 0.5, 0.0], 1.0), 0.0, "from inside");
        assert_eq!(share([0.0, 1.0, 0.0], 1.0), 0.0, "touching");
        assert_eq!(share([0.0, -3.0, 0.0], 1.0), 0.0, "below");
        assert_eq!(share([0.0, 1.01, 0.0], 1.0), 0.0, "wide");
        assert!(share([0.0, 1e4, 0.0], 100.0) < 4e-4, "far away it has next to no directions");
        assert_eq!(share([0.0, 1e7, 0.0], 1.0), 0.0, "nothing that f32 could draw");
    }
}
