//! What photons are aimed at: spheres around what focuses light, as Jensen's projection maps have it ("Realistic Image
//! Synthesis Using Photon Mapping", 2001, 5.3), and around what the camera sees, as Peter and Pietrek's importance maps
//! ("Importance Driven Construction of Photon Maps", 1998) but by place alone. In a wide scene few photons would come there.
//!
//! The density is that of the mixture of all spheres and of no aim at all: power is bounded by the share that is not
//! aimed.
//!
//! Twin: `shaders/pathtrace/light/aim.wgsl`.

use crate::sampling;
use scene::{Geometry, Vec3};
use std::f32::consts::FRAC_1_PI;

/// A sphere around something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The sphere's middle, in world space.
    pub center: Vec3,
    /// The sphere's radius, at least 0.
    pub radius: f32,
}

/// Spheres that photons are aimed at.
#[derive(Debug, Clone, Default)]
pub struct Aim {
    targets: Vec<Target>,
}

/// A sphere, and the share of the photons that are aimed at it.
#[derive(Debug, Clone, Copy)]
struct Target {
    bounds: Bounds,
    share: f32,
}

/// A part of what photons are drawn from, with its share of them.
#[derive(Debug, Clone, Copy)]
struct Part<T> {
    of: T,
    share: f32,
}

/// Casters that each have a sphere of their own: a photon asks all of them for its density.
const MOST_CASTERS: usize = 64;

/// `1 - cos` of the narrowest cone that is aimed at: rounding of its directions is a hundredth of its width.
pub(crate) const NARROWEST_AIM: f32 = 2e-11;

impl Aim {
    /// At casters and at what is seen. Each kind that there is has as many photons as fly without aim, and in each all
    /// spheres as many.
    pub fn at(casters: &[Bounds], seen: &[Bounds]) -> Self {
        let kinds = [casters, seen].into_iter().filter(|spheres| !spheres.is_empty());
        let share = 1.0 / (1 + kinds.clone().count()) as f32;
        let targets = kinds.flat_map(|spheres| {
            spheres.iter().map(move |bounds| Target { bounds: *bounds, share: share / spheres.len() as f32 })
        });
        Aim { targets: targets.collect() }
    }

    /// The spheres, each with the share of the photons that are aimed at it.
    pub(crate) fn targets(&self) -> impl ExactSizeIterator<Item = (Bounds, f32)> {
        self.targets.iter().map(|target| (target.bounds, target.share))
    }

    /// A direction from a point of a surface with this normal, or from a point in the air, with its density: one that is
    /// given, or one towards a sphere. The share of those that hold the point, or lie behind its surface, flies without
    /// aim.
    pub fn direction(
        &self,
        (from, normal): (Vec3, Option<Vec3>),
        (elsewhere, pdf_elsewhere): (Vec3, impl Fn(Vec3) -> f32),
        (aim, way): (f32, [f32; 2]),
    ) -> (Vec3, f32) {
        let faced = |bounds: &Bounds| normal.is_none_or(|normal| (bounds.center - from).dot(normal) > -bounds.radius);
        let cone = |target: &Target| {
            let of = target.bounds.cone_from(from).filter(|_| faced(&target.bounds))?;
            Some(Part { of, share: target.share })
        };
        let cones: Vec<Part<(Vec3, f32)>> = self.targets.iter().filter_map(cone).collect();
        let (aimed, not_aimed) = chosen(&cones, aim);
        let direction = aimed.map_or(elsewhere, |i| {
            let (axis, one_minus_cos) = cones[i].of;
            sampling::to_world(sampling::cone(one_minus_cos, way), axis)
        });
        let pdf_of = |(i, Part { of: (axis, one_minus_cos), share }): (usize, &Part<(Vec3, f32)>)| {
            // by the chord, which stays exact for small cones; rounding must not put what was drawn there outside
            let inside = aimed == Some(i) || (direction - *axis).length_squared() < 2.0 * one_minus_cos;
            if inside { share * sampling::cone_pdf(*one_minus_cos) } else { 0.0 }
        };
        let pdf: f32 = cones.iter().enumerate().map(pdf_of).sum();
        (direction, not_aimed * pdf_elsewhere(direction) + pdf)
    }

    /// A point of the plane through the middle of the scene with these two axes, with its density: one of the disc that
    /// the scene fills as seen along its normal, or one of a sphere's. Relative to the scene's middle.
    pub fn place(&self, scene: &Bounds, (s, t): (Vec3, Vec3), (aim, way): (f32, [f32; 2])) -> ([f32; 2], f32) {
        let across = |v: Vec3| [v.dot(s), v.dot(t)];
        let disc = |target: &Target| {
            let Bounds { center, radius } = target.bounds;
            Part { of: (across(center - scene.center), radius), share: target.share }
        };
        let discs: Vec<Part<([f32; 2], f32)>> =
            self.targets.iter().filter(|target| target.bounds.radius > 0.0).map(disc).collect();
        let (aimed, not_aimed) = chosen(&discs, aim);
        let ([x, y], radius) = aimed.map_or(([0.0; 2], scene.radius), |i| discs[i].of);
        let [u, v] = crate::sampling::warp::disk(way);
        let [x, y] = [x + radius * u, y + radius * v];
        let pdf_of = |(i, Part { of: ([cx, cy], radius), share }): (usize, &Part<([f32; 2], f32)>)| {
            let inside = aimed == Some(i) || (x - cx).powi(2) + (y - cy).powi(2) < radius * radius;
            if inside { share * FRAC_1_PI / (radius * radius) } else { 0.0 }
        };
        let pdf: f32 = discs.iter().enumerate().map(pdf_of).sum();
        ([x, y], not_aimed * FRAC_1_PI / (scene.radius * scene.radius) + pdf)
    }
}

/// The part that a number in [0, 1) chooses, or none of them; and the share that is left for none.
fn chosen<T>(parts: &[Part<T>], u: f32) -> (Option<usize>, f32) {
    let mut sum = 0.0;
    let mut chosen = None;
    for (i, part) in parts.iter().enumerate() {
        sum += part.share;
        chosen = chosen.or((u < sum).then_some(i));
    }
    (chosen, 1.0 - sum)
}

/// Spheres around these shapes, or one around all where there are many.
pub fn around_each(shapes: Vec<&Geometry>) -> Vec<Bounds> {
    if shapes.len() <= MOST_CASTERS {
        return shapes.into_iter().map(Bounds::around).collect();
    }
    let boxes = shapes.into_iter().map(Geometry::bounds);
    boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).map(Bounds::of).into_iter().collect()
}

impl Bounds {
    /// The smallest sphere around a box.
    pub fn of((lo, hi): (Vec3, Vec3)) -> Self {
        // centre and half diagonal are rounded; a photon at the very rim shall not miss what is there
        let rounding = 1.0 + 16.0 * f32::EPSILON;
        Bounds { center: 0.5 * (lo + hi), radius: 0.5 * (hi - lo).length() * rounding }
    }

    fn around(geometry: &Geometry) -> Self {
        match *geometry {
            Geometry::Sphere { center, radius } | Geometry::Disk { center, radius, .. } => Bounds { center, radius },
            _ => Bounds::of(geometry.bounds()),
        }
    }

    /// Axis and `1 - cos` of the cone that it fills as seen from a point outside.
    fn cone_from(&self, from: Vec3) -> Option<(Vec3, f32)> {
        let to_center = self.center - from;
        let distance = to_center.length();
        if distance <= self.radius {
            return None;
        }
        let cos = ((distance - self.radius) * (distance + self.radius)).sqrt() / distance;
        let sin = self.radius / distance;
        let one_minus_cos = sin * sin / (1.0 + cos);
        (one_minus_cos > NARROWEST_AIM).then_some((to_center / distance, one_minus_cos))
    }
}
