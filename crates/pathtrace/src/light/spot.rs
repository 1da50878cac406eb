//! The cones that point lights shine into (glTF's KHR_lights_punctual). Twin: `shaders/pathtrace/light/spot.wgsl`.

use scene::{PointLight, Vec3};
use simd::{Float, Vector};
use std::f32::consts::PI;

/// What a cone's edge is made of.
#[derive(Debug, Clone, Copy)]
pub struct Cones<F> {
    /// Unit direction of the axis, away from the light; zero of a light without a cone.
    pub towards: Vector<F>,
    /// Cosine of the angle from which on it is dark.
    pub outer: F,
    /// One over what the cosine grows by from there to where it shines in full.
    pub slope: F,
}

impl<F: Float> Cones<F> {
    /// Share of the intensity in a unit direction away from the light.
    #[inline(always)]
    pub fn share(&self, direction: Vector<F>) -> F {
        let way = (direction.dot(self.towards) - self.outer) * self.slope;
        let way = way.max(F::splat(0.0)).min(F::splat(1.0));
        way * way
    }
}

/// Axis of a light's cone, and its edge as [`Cones`] have it; of one without a cone such that its share is 1 everywhere.
pub(crate) fn cone_of(light: &PointLight) -> (Vec3, [f32; 2]) {
    let Some(spot) = light.spot else { return (Vec3::ZERO, [-2.0, 1.0]) };
    let [inner, outer] = [spot.inner, spot.outer].map(|angle| angle.to_radians().cos());
    (spot.towards, [outer, 1.0 / (inner - outer).max(1e-3)])
}

/// Solid angle that would hold the same power at full intensity: that of all directions without a cone.
pub(crate) fn full_solid_angle(light: &PointLight) -> f32 {
    let Some(spot) = light.spot else { return 4.0 * PI };
    let [inner, outer] = [spot.inner, spot.outer].map(|angle| angle.to_radians().cos());
    // the mean of a square from 0 to 1 is a third
    2.0 * PI * ((1.0 - inner) + (inner - outer) / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling;
    use crate::vectors::lane_vector;
    use scene::Spot;

    fn light(inner: f32, outer: f32) -> PointLight {
        let spot = Some(Spot { towards: Vec3::new(0.6, 0.0, 0.8), inner, outer });
        PointLight { position: Vec3::ZERO, intensity: Vec3::ONE, spot }
    }

    fn share(light: &PointLight, direction: Vec3) -> f32 {
        let (towards, [outer, slope]) = cone_of(light);
        Cones { towards: lane_vector(towards), outer, slope }.share(lane_vector(direction))
    }

    #[test]
    fn the_share_is_the_scenes_and_1_without_a_cone() {
        for step in 0..1000 {
            let u = [(step as f32 + 0.5) / 1000.0, (step as f32 * 0.618_034).fract()];
            let direction = sampling::cone(2.0, u);
            for lamp in [light(10.0, 30.0), light(0.0, 90.0), light(20.0, 20.01), light(40.0, 180.0)] {
                let expected = lamp.spot.unwrap().share(direction);
                // a float's rounding of a cosine, against the narrowest edge
                assert!((share(&lamp, direction) - expected).abs() < 2e-3, "{lamp:?} {direction}");
            }
            assert_eq!(share(&PointLight { spot: None, ..light(1.0, 2.0) }, direction), 1.0);
        }
    }

    #[test]
    fn power_is_the_shares_integral() {
        for lamp in
            [light(10.0, 30.0), light(0.0, 90.0), light(40.0, 180.0), PointLight { spot: None, ..light(1.0, 2.0) }]
        {
            const STEPS: usize = 1000;
            let place =
                |index: usize| [(index / STEPS) as f32, (index % STEPS) as f32].map(|i| (i + 0.5) / STEPS as f32);
            let sum: f64 = (0..STEPS * STEPS).map(|i| f64::from(share(&lamp, sampling::cone(2.0, place(i))))).sum();
            let integral = sum / (STEPS * STEPS) as f64 * 4.0 * std::f64::consts::PI;
            assert!((f64::from(full_solid_angle(&lamp)) / integral - 1.0).abs() < 1e-3, "{lamp:?}: {integral}");
        }
    }
}
