//! Directions from vectors of any length.

use glam::Vec3;

/// The unit vector along `v`, which may have any length but 0, also one whose square f32 does not hold; `None` for 0 and
/// what is not finite.
pub fn unit(v: Vec3) -> Option<Vec3> {
    let largest = f64::from(v.abs().max_element());
    if !(v.is_finite() && largest > 0.0) {
        return None;
    }
    // by a power of two, which rounds nothing
    let exponent = (largest.to_bits() >> 52) as i32 - 1023;
    (v.as_dvec3() * 2f64.powi(-exponent)).as_vec3().try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn length_does_not_change_a_direction() {
        let v = Vec3::new(0.3, -0.7, 0.2);
        for power in -100..=120 {
            let scaled = v * 2f32.powi(power);
            assert_eq!(unit(scaled), Some(v.normalize()), "2^{power}");
        }
        // of the least numbers that there are, few bits are left to say a direction
        let least = unit(v * 1e-40).unwrap();
        assert!((least - v.normalize()).length() < 1e-4);
        assert_eq!(unit(Vec3::new(0.0, 1e-45, 0.0)), Some(Vec3::Y));
        assert_eq!((unit(Vec3::ZERO), unit(Vec3::new(1.0, f32::INFINITY, 0.0)), unit(Vec3::NAN)), (None, None, None));
    }
}
