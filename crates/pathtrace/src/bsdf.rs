//! Reflection and refraction at smooth surfaces.

use scene::Vec3;

/// The mirror direction of `wo` (pointing away from the surface) about the unit normal `n`.
pub fn reflect(wo: Vec3, n: Vec3) -> Vec3 {
    2.0 * n.dot(wo) * n - wo
}

/// The surface of a smooth dielectric as a ray meets it. The index is kept as it is and never inverted: 1 / 1.5 is not
/// an f32, and its rounding moves the critical angle.
#[derive(Debug, Clone, Copy)]
pub struct Interface {
    /// Index of refraction of the inside over the outside.
    pub ior: f32,
    /// Whether the ray comes from outside.
    pub entering: bool,
}

impl Interface {
    /// Cosine of the refracted direction for `cos_i` >= 0; `None` beyond the critical angle. Written around
    /// `ior^2 - 1` rather than as the textbook's `sqrt(1 - (1 - cos^2) / ior^2)`: exact at index 1, where the latter
    /// invents a rim. In f64, because near the critical angle the difference cancels.
    pub fn refracted_cosine(self, cos_i: f32) -> Option<f32> {
        let (n, cos_i) = (f64::from(self.ior), f64::from(cos_i));
        let excess = (n - 1.0) * (n + 1.0);
        let squared = if self.entering { (excess + cos_i * cos_i) / (n * n) } else { n * n * cos_i * cos_i - excess };
        (squared > 0.0).then(|| squared.sqrt() as f32)
    }

    /// Share of unpolarised light that is reflected, in [0, 1]: Fresnel's equations, exact; 1 beyond the critical angle.
    pub fn fresnel(self, cos_i: f32) -> f32 {
        if self.ior == 1.0 {
            return 0.0;
        }
        let Some(cos_t) = self.refracted_cosine(cos_i) else { return 1.0 };
        let (outside, inside) = if self.entering { (cos_i, cos_t) } else { (cos_t, cos_i) };
        let parallel = (self.ior * outside - inside) / (self.ior * outside + inside);
        let perpendicular = (outside - self.ior * inside) / (outside + self.ior * inside);
        0.5 * (parallel * parallel + perpendicular * perpendicular)
    }

    /// The direction into which `wo` refracts at the unit normal `n` on its side (`n . wo` >= 0), by Snell's law; `None`
    /// if all is reflected.
    pub fn refract(self, wo: Vec3, n: Vec3) -> Option<Vec3> {
        let cos_i = n.dot(wo);
        let cos_t = self.refracted_cosine(cos_i)?;
        let (wo, cos_i) =
            if self.entering { (wo / self.ior, cos_i / self.ior) } else { (wo * self.ior, cos_i * self.ior) };
        Some((cos_i - cos_t) * n - wo)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INTO_GLASS: Interface = Interface { ior: 1.5, entering: true };
    const OUT_OF_GLASS: Interface = Interface { ior: 1.5, entering: false };

    fn cos(degrees: f64) -> f32 {
        degrees.to_radians().cos() as f32
    }

    /// Unpolarised reflectance of glass n = 1.5, computed in high precision.
    #[test]
    fn fresnel_of_glass_matches_the_table() {
        let into =
            [(0.0, 0.04), (45.0, 0.050_239_911), (60.0, 0.089_186_713), (80.0, 0.387_704_35), (89.0, 0.904_184_95)];
        for (angle, expected) in into {
            assert!((INTO_GLASS.fresnel(cos(angle)) - expected).abs() < 1e-6, "{angle}");
        }
        // near the critical angle the reflectance depends so steeply on the cosine that rounding it to f32 already moves
        // the result: by up to 8e-7, 4e-6 and 1.3e-4 here
        let critical = (1.0 / 1.5f64).asin();
        for (below, expected, tolerance) in
            [(1e-2, 0.439_576_06, 1e-6), (1e-4, 0.917_237_9, 2e-5), (1e-6, 0.991_349_6, 5e-4)]
        {
            let got = OUT_OF_GLASS.fresnel((critical - below).cos() as f32);
            assert!((got - expected).abs() < tolerance, "{below}: {got}");
        }
        assert_eq!(OUT_OF_GLASS.fresnel(cos(42.0)), 1.0);
        assert_eq!(INTO_GLASS.fresnel(0.0), 1.0);
        // 1.0001 itself is rounded by 2e-8, and the reflectance goes with the square of what exceeds 1
        assert!((Interface { ior: 1.0001, entering: true }.fresnel(cos(89.0)) - 0.015_746_749).abs() < 1e-5);
    }

    #[test]
    fn index_one_is_invisible_to_the_last_bit() {
        for i in 0..1000 {
            let angle = i as f32 / 1000.0 * std::f32::consts::FRAC_PI_2;
            let wo = Vec3::new(angle.sin(), 0.0, angle.cos());
            for entering in [true, false] {
                let nothing = Interface { ior: 1.0, entering };
                assert_eq!(nothing.fresnel(wo.z), 0.0);
                assert_eq!(nothing.refract(wo, Vec3::Z), Some(-wo));
            }
        }
    }

    #[test]
    fn refraction_obeys_snell() {
        let angle = 80f32.to_radians();
        let wo = Vec3::new(angle.sin(), 0.0, angle.cos());
        let wi = INTO_GLASS.refract(wo, Vec3::Z).unwrap();
        assert!((wi.length() - 1.0).abs() < 1e-6);
        assert!((wi.x.abs().asin().to_degrees() - 41.036_41).abs() < 1e-3 && wi.z < 0.0);
    }
}
