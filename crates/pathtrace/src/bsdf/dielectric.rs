//! Smooth clear glass: reflection and refraction. Twin: `shaders/pathtrace/bsdf/dielectric.wgsl`.

use super::mirror::reflected;
use super::{BsdfSamples, Interactions};
use crate::vectors::{glam_vector, lane_vector};
use scene::Vec3;
use simd::{Double, Float, Vector};

/// Reflects with the probability that Fresnel gives, else refracts, by `u`; the weights cancel. No scaling of radiance
/// by the square of the index: a camera outside sees the same either way.
#[inline(always)]
pub fn sample<F: Float>(at: &Interactions<F>, ior: F, u: F) -> BsdfSamples<F> {
    let interface = Interfaces::at(at, ior);
    let reflects = u.lt(interface.fresnel(at.normal.dot(at.wo)));
    let (refracted, refracts) = interface.refract(at.wo, at.normal);
    let wi = Vector::select(refracts & !reflects, refracted, reflected(at.wo, at.normal)).normalize();
    BsdfSamples { wi, ..BsdfSamples::delta(at) }
}

/// Share that is reflected of light of which the rest goes on in the refracted direction `wi`.
#[inline(always)]
pub fn reflected_beside<F: Float>(at: &Interactions<F>, ior: F, wi: Vector<F>) -> F {
    Interfaces::at(at, ior).reflected_share(at.normal.dot(at.wo), at.normal.dot(wi).abs())
}

/// Where light goes on, and how much of it.
#[derive(Debug, Clone, Copy)]
pub struct Split<F: Float> {
    /// Share that is reflected.
    pub reflectance: F,
    /// Where some is refracted ...
    pub refracts: F::M,
    /// ... in this unit direction.
    pub refracted: Vector<F>,
}

/// Both ways in which light goes on.
#[inline(always)]
pub fn split<F: Float>(at: &Interactions<F>, ior: F) -> Split<F> {
    let interface = Interfaces::at(at, ior);
    let reflectance = interface.fresnel(at.normal.dot(at.wo));
    let (refracted, refracts) = interface.refract(at.wo, at.normal);
    Split { reflectance, refracts: refracts & reflectance.lt(F::splat(1.0)), refracted: refracted.normalize() }
}

/// The surface of a smooth dielectric as a ray meets it, in each lane. The index is kept as it is and never inverted:
/// 1 / 1.5 is not an f32, and its rounding moves the critical angle.
#[derive(Debug, Clone, Copy)]
pub struct Interfaces<F: Float> {
    /// Index of refraction of the inside over the outside.
    pub ior: F,
    /// Whether the ray comes from outside.
    pub entering: F::M,
}

impl<F: Float> Interfaces<F> {
    #[inline(always)]
    fn at(at: &Interactions<F>, ior: F) -> Self {
        Interfaces { ior, entering: at.point.normal.dot(at.wo).ge(F::splat(0.0)) }
    }

    /// Cosine of the refracted direction for `cos_i` >= 0, and where there is one: not beyond the critical angle.
    /// Written around `ior^2 - 1` rather than as the textbook's `sqrt(1 - (1 - cos^2) / ior^2)`: exact at index 1,
    /// where the latter invents a rim. In f64, because near the critical angle the difference cancels.
    #[inline(always)]
    pub fn refracted_cosine(self, cos_i: F) -> (F, F::M) {
        let (n, cos_i) = (self.ior.widen(), cos_i.widen());
        let excess = (n - 1.0) * (n + 1.0);
        let from_outside = (excess + cos_i * cos_i) / (n * n);
        let from_inside = n * n * cos_i * cos_i - excess;
        let zero = F::D::splat(0.0);
        let refracts = (self.entering & zero.lt(from_outside)) | (!self.entering & zero.lt(from_inside));
        (F::select(self.entering, from_outside.sqrt().narrow(), from_inside.sqrt().narrow()), refracts)
    }

    /// Share of unpolarised light that is reflected, in [0, 1]: Fresnel's equations, exact; 1 beyond the critical
    /// angle.
    #[inline(always)]
    pub fn fresnel(self, cos_i: F) -> F {
        let (cos_t, refracts) = self.refracted_cosine(cos_i);
        F::select(refracts | self.ior.eq(F::splat(1.0)), self.reflected_share(cos_i, cos_t), F::splat(1.0))
    }

    /// The same where the rest is refracted at `cos_t`.
    #[inline(always)]
    fn reflected_share(self, cos_i: F, cos_t: F) -> F {
        let outside = self.ior * F::select(self.entering, cos_i, cos_t);
        let inside = F::select(self.entering, cos_t, cos_i);
        let parallel = (outside - inside) / (outside + inside);
        let outside = F::select(self.entering, cos_i, cos_t);
        let inside = self.ior * inside;
        let perpendicular = (outside - inside) / (outside + inside);
        let share = (parallel * parallel + perpendicular * perpendicular) * 0.5;
        F::select(self.ior.eq(F::splat(1.0)), F::splat(0.0), share)
    }

    /// The direction into which `wo` refracts at the unit normal `n` on its side (`n . wo` >= 0), by Snell's law, and
    /// where there is one: elsewhere all is reflected.
    #[inline(always)]
    pub fn refract(self, wo: Vector<F>, n: Vector<F>) -> (Vector<F>, F::M) {
        let cos_i = n.dot(wo);
        let (cos_t, refracts) = self.refracted_cosine(cos_i);
        let wo = Vector::select(self.entering, wo.divided_by(self.ior), wo * self.ior);
        let cos_i = F::select(self.entering, cos_i / self.ior, cos_i * self.ior);
        (n * (cos_i - cos_t) - wo, refracts)
    }
}

/// [`Interfaces`] of one lane.
#[derive(Debug, Clone, Copy)]
pub struct Interface {
    /// Index of refraction of the inside over the outside.
    pub ior: f32,
    /// Whether the ray comes from outside.
    pub entering: bool,
}

impl Interface {
    fn lane(self) -> Interfaces<f32> {
        Interfaces { ior: self.ior, entering: self.entering }
    }

    /// Cosine of the refracted direction for `cos_i` >= 0; `None` beyond the critical angle.
    pub fn refracted_cosine(self, cos_i: f32) -> Option<f32> {
        let (cosine, refracts) = self.lane().refracted_cosine(cos_i);
        refracts.then_some(cosine)
    }

    /// Share of unpolarised light that is reflected, in [0, 1]; 1 beyond the critical angle.
    pub fn fresnel(self, cos_i: f32) -> f32 {
        self.lane().fresnel(cos_i)
    }

    /// The direction into which `wo` refracts at the unit normal `n` on its side (`n . wo` >= 0), by Snell's law;
    /// `None` if all is reflected.
    pub fn refract(self, wo: Vec3, n: Vec3) -> Option<Vec3> {
        let (direction, refracts) = self.lane().refract(lane_vector(wo), lane_vector(n));
        refracts.then(|| glam_vector(direction))
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
        // near the critical angle the reflectance depends so steeply on the cosine that rounding it to f32 already
        // moves the result: by up to 8e-7, 4e-6 and 1.3e-4 here
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
