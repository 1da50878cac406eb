//! Lights that are not shapes: the sun and point lights. Emissive shapes are lights through their material, the sky is
//! a number.

use glam::Vec3;

/// A distant disc of constant radiance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sun {
    /// Unit direction towards the centre of the disc.
    pub towards: Vec3,
    /// Half the angle under which the disc is seen, in degrees, in [0, 90). Zero is a delta light: hard shadows, and
    /// nothing that a ray can hit by chance.
    pub angular_radius: f32,
    /// Irradiance on a surface that faces the sun, RGB. Kept when the radius changes.
    pub irradiance: Vec3,
}

/// A point that shines alike in all directions. No ray can hit it: only techniques that look for lights find it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLight {
    /// World space.
    pub position: Vec3,
    /// Radiant intensity, power per solid angle, RGB: the irradiance on a surface that faces it at distance 1.
    pub intensity: Vec3,
    /// The cone that it shines into; `None` shines everywhere.
    pub spot: Option<Spot>,
}

/// A cone of light with a soft edge (glTF's KHR_lights_punctual).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Unit direction of its axis, away from the light.
    pub towards: Vec3,
    /// Degrees from the axis up to which it shines in full, from 0.
    pub inner: f32,
    /// Degrees from the axis from which on it is dark, above `inner`, at most 180.
    pub outer: f32,
}

impl Spot {
    /// Share of the intensity in a unit direction away from the light: the square of the cosine's way from the outer to
    /// the inner cone, in [0, 1].
    pub fn share(&self, direction: Vec3) -> f32 {
        let [inner, outer] = [self.inner, self.outer].map(|angle| angle.to_radians().cos());
        let way = (direction.dot(self.towards) - outer) / (inner - outer).max(1e-3);
        let way = way.clamp(0.0, 1.0);
        way * way
    }
}

impl Sun {
    /// Radiance of the disc: `E / (pi sin^2 radius)`; zero for a delta sun, which has none.
    pub fn radiance(&self) -> Vec3 {
        let sine = self.angular_radius.to_radians().sin();
        if sine > 0.0 { self.irradiance / (std::f32::consts::PI * sine * sine) } else { Vec3::ZERO }
    }

    /// `1 - cos radius`, without the cancellation that the difference has for a small sun.
    pub fn one_minus_cos(&self) -> f32 {
        let half = (self.angular_radius.to_radians() * 0.5).sin();
        2.0 * half * half
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sun_of_2_5_degrees_has_the_radiance_that_makes_a_white_wall_one() {
        let sun = Sun { towards: Vec3::Y, angular_radius: 2.5, irradiance: Vec3::splat(std::f32::consts::PI) };
        assert!((sun.radiance().x - 525.6).abs() < 0.05);
    }
}
