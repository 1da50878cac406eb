//! What metals reflect: by their complex index of refraction, or a constant.

use glam::Vec3;

/// How much light a metal's surface reflects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Conductor {
    /// The same share at all angles, each channel in [0, 1].
    Constant(Vec3),
    /// By Fresnel's equations.
    Fresnel {
        /// Index of refraction, > 0.
        eta: Vec3,
        /// Extinction coefficient, at least 0.
        k: Vec3,
    },
}

/// Metals by name, with eta and k for linear Rec. 709: measured spectra integrated to three channels, as in the table
/// `ComplexIorData.hpp` of the renderer Tungsten (Benedikt Bitterli).
const METALS: [(&str, [f32; 3], [f32; 3]); 5] = [
    ("gold", [0.143_118_96, 0.374_957_05, 1.442_478_5], [3.983_160_4, 2.385_720_7, 1.603_215_3]),
    ("silver", [0.155_264_65, 0.116_723_3, 0.138_380_7], [4.828_343_4, 3.122_246, 2.146_950_5]),
    ("copper", [0.200_437_7, 0.924_033_4, 1.102_212], [3.912_948_6, 2.452_847_7, 2.142_188]),
    ("aluminium", [1.657_46, 0.880_368_95, 0.521_228_7], [9.223_869, 6.269_523, 4.837_001]),
    ("chromium", [4.369_683, 2.916_702_5, 1.654_700_5], [5.206_433_8, 4.231_364_5, 3.754_946_7]),
];

impl Conductor {
    /// The metal of that name.
    pub fn named(name: &str) -> Option<Self> {
        let (_, eta, k) = METALS.into_iter().find(|(metal, ..)| *metal == name)?;
        Some(Conductor::Fresnel { eta: eta.into(), k: k.into() })
    }

    /// The names of the metals.
    pub fn names() -> impl Iterator<Item = &'static str> {
        METALS.into_iter().map(|(name, ..)| name)
    }

    /// What is reflected straight back.
    pub fn at_normal_incidence(&self) -> Vec3 {
        match *self {
            Conductor::Constant(reflectance) => reflectance,
            Conductor::Fresnel { eta, k } => {
                let (below, above) = (eta - 1.0, eta + 1.0);
                (below * below + k * k) / (above * above + k * k)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Far from grey, and each as one knows it: gold and copper reflect less and less from red to blue.
    #[test]
    fn metals_have_their_colours() {
        let colour = |name| Conductor::named(name).unwrap().at_normal_incidence();
        let (gold, copper, silver) = (colour("gold"), colour("copper"), colour("silver"));
        assert!(gold.x > 0.9 && gold.x > gold.y && gold.y > 0.7 && gold.z < 0.5, "{gold}");
        assert!(copper.x > 0.9 && copper.y < 0.7 && copper.z < copper.y, "{copper}");
        assert!(silver.min_element() > 0.9, "{silver}");
        assert!(Conductor::names().all(|name| Conductor::named(name).is_some()) && Conductor::named("tin").is_none());
    }
}
