//! Rays to what pixels show, one in each lane. Chains of mirrors and glass are short, so that lanes wait for each other.
//! Twin: `shaders/pathtrace/features.wgsl`.

use super::FeaturePass;
use super::sums::Sums;
use crate::bsdf::Interactions;
use crate::drive::lanes::camera_rays;
use crate::intersect::aggregate::lanes_of;
use crate::intersect::shape_list::Scratch;
use crate::intersect::{Intersections, Rays};
use crate::prepared::PreparedScene;
use crate::sampling::sampler::Sampler;
use crate::stats::Stats;
use crate::vectors::each_lane;
use scene::Vec3;
use simd::{Float, Kernel, MOST_LANES, Mask, Vector, Word};

/// Mirrors and faces of glass that are looked through, before light that is trapped is taken for a surface.
pub(crate) const MOST_SPECULARS: u32 = 32;

/// Pixels in a row of the film's order.
pub struct ChunkKernel<'a> {
    pub pass: &'a FeaturePass,
    pub scene: &'a PreparedScene,
    /// Index of the first.
    pub first: u32,
    pub sums: &'a mut [Sums],
}

impl Kernel for ChunkKernel<'_> {
    type Output = Stats;

    #[inline(always)]
    fn run<F: Float>(self) -> Stats {
        let ChunkKernel { pass, scene, first, sums } = self;
        let mut scratch = Scratch::new(scene.aggregate.shape_list());
        let mut stats = Stats::default();
        for (index, group) in sums.chunks_mut(F::LANES).enumerate() {
            let pixels: [u32; MOST_LANES] = std::array::from_fn(|lane| first + (index * F::LANES + lane) as u32);
            let here = F::M::from_bits(u32::MAX >> (u32::BITS - group.len() as u32));
            let there = group.first().map_or(0, |sums| sums.samples);
            for sample in there..pass.samples {
                let (kind, seed) = pass.sampler;
                let sampler = Sampler { kind, pixel: F::U::load(&pixels), sample: F::U::splat(sample), seed };
                let column = pixels.map(|pixel| (pixel % pass.size[0]) as f32);
                let row = pixels.map(|pixel| (pixel / pass.size[0]) as f32);
                let place = [F::load(&column), F::load(&row)];
                let rays = camera_rays(&pass.frame, pass.size, place, &sampler);
                let seen = Seen::along(rays, here, scene, &sampler, &mut scratch);
                seen.add_to(group);
                stats.samples += group.len() as u64;
                stats.rays += u64::from(seen.rays);
            }
        }
        stats
    }
}

/// What one sample of each lane's pixel shows.
struct Seen<F: Float> {
    /// What the mirrors and glass on the way leave of it.
    throughput: Vector<F>,
    albedo: Vector<F>,
    normal: Vector<F>,
    distance: F,
    met: F::M,
    rays: u32,
}

impl<F: Float> Seen<F> {
    #[inline(always)]
    fn along(
        mut rays: Rays<F>,
        here: F::M,
        scene: &PreparedScene,
        sampler: &Sampler<F::U>,
        scratch: &mut Scratch<F>,
    ) -> Self {
        let (zero, nowhere) = (Vector::zero(), F::M::splat(false));
        let one = Vector::along_all(F::splat(1.0));
        let mut seen =
            Seen { throughput: one, albedo: zero, normal: zero, distance: F::splat(0.0), met: nowhere, rays: 0 };
        let mut walking = here;
        for vertex in 0..=MOST_SPECULARS {
            let hit = scene.closest(&rays, walking, scratch);
            seen.rays += walking.count();
            let met = walking & hit.met;
            let wo = -rays.direction;
            if vertex == 0 {
                seen.met = met;
                seen.distance = (hit.point.position - rays.origin).length_squared().sqrt();
            }
            seen.show_sky(walking & !hit.met, scene, rays.direction);
            let at = scene.interaction(&hit, wo);
            let last = vertex == MOST_SPECULARS;
            let goes_on = if last { nowhere } else { met & at.is_delta() & !at.colour.is_zero() };
            seen.show_surface(met, goes_on, scene, &hit, &at);
            walking = goes_on;
            if !walking.any() {
                break;
            }
            // the block of random numbers that a path's vertex has for its direction
            let u = sampler.unit4(F::U::splat(2 * vertex + 1));
            let sample = scene.materials.sample(walking, &at, [u[0], u[1], u[3]]);
            seen.throughput = Vector::select(walking, seen.throughput * sample.weight, seen.throughput);
            rays = Rays::new(at.point.leaving_towards(sample.wi), sample.wi);
        }
        seen
    }

    /// What shines where nothing is met, at most 1.
    #[inline(always)]
    fn show_sky(&mut self, missed: F::M, scene: &PreparedScene, direction: Vector<F>) {
        if !missed.any() {
            return;
        }
        let mut radiance = scene.environment(direction, F::splat(1.0));
        if let Some(environment) = scene.lights.environment() {
            radiance = radiance + environment.look_up_lanes(direction).0;
        }
        self.show(missed, radiance);
    }

    /// Adds light and albedo of what was met, and the normal where the way does not go on.
    #[inline(always)]
    fn show_surface(
        &mut self,
        met: F::M,
        goes_on: F::M,
        scene: &PreparedScene,
        hit: &Intersections<F>,
        at: &Interactions<F>,
    ) {
        let own = Vector::select(goes_on, Vector::zero(), at.colour);
        let shining = met & scene.shines(hit);
        let colour =
            if shining.any() { own + Vector::select(shining, scene.emitted(hit, at.wo), Vector::zero()) } else { own };
        self.show(met, colour);
        self.normal = Vector::select(met & !goes_on, at.normal, self.normal);
    }

    /// Adds a colour at the end of the way, at most 1.
    #[inline(always)]
    fn show(&mut self, here: F::M, colour: Vector<F>) {
        let one = F::splat(1.0);
        let bounded = Vector::new(colour.x.min(one), colour.y.min(one), colour.z.min(one));
        self.albedo = Vector::select(here, self.albedo + self.throughput * bounded, self.albedo);
    }

    #[inline(always)]
    fn add_to(&self, sums: &mut [Sums]) {
        let (albedo, normal) = (each_lane(self.albedo), each_lane(self.normal));
        let mut distance = [0.0; MOST_LANES];
        self.distance.store(&mut distance);
        for (lane, sum) in sums.iter_mut().enumerate() {
            sum.albedo += albedo[lane].min(Vec3::ONE);
            sum.normal += normal[lane];
            sum.samples += 1;
        }
        for lane in lanes_of(self.met) {
            sums[lane].distance += distance[lane];
            sums[lane].met += 1;
        }
    }
}
