//! The three lies of a reflective shadow map, each of which can be told or not.

/// How light is gathered from patches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct GatherKnobs {
    /// How many patches a pixel takes of each view of a light: one of [`GatherKnobs::SAMPLES`].
    pub samples: u32,
    /// How near a patch may come.
    pub clamp: PatchClamp,
    /// Whether spheres and boxes of the scene hide patches; else nothing does.
    pub shapes_hide: bool,
}

/// What keeps the inverse square of a patch's distance finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum PatchClamp {
    /// Nothing: where patches touch what they light there are bright spots.
    None,
    /// A patch is a disc of its area, which a point that it touches sees fill its view.
    #[default]
    Disc,
}

impl PatchClamp {
    /// All of them, from the worse to the better.
    pub const ALL: [PatchClamp; 2] = [PatchClamp::None, PatchClamp::Disc];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            PatchClamp::None => "none",
            PatchClamp::Disc => "disc",
        }
    }

    /// The clamp of that name.
    pub fn named(name: &str) -> Option<PatchClamp> {
        PatchClamp::ALL.into_iter().find(|clamp| clamp.name() == name)
    }
}

impl Default for GatherKnobs {
    fn default() -> Self {
        GatherKnobs { samples: 256, clamp: PatchClamp::default(), shapes_hide: true }
    }
}

impl GatherKnobs {
    /// Patches that a pixel may take of each view: squares that divide all of them.
    pub const SAMPLES: [u32; 4] = [16, 64, 256, 1024];

    /// The first knob that is turned too far, if one is: a line for the user.
    pub(crate) fn fault(&self) -> Option<String> {
        let fine = Self::SAMPLES.contains(&self.samples);
        let refused = || format!("{} patches a pixel are not to be had: choose 16, 64, 256 or 1024", self.samples);
        (!fine).then(refused)
    }

    /// Every how manieth patch along a side that is.
    pub(crate) fn stride(&self) -> u32 {
        (super::PATCHES_SIDE / self.samples.isqrt().max(1)).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_squares_that_divide_a_map() {
        for samples in GatherKnobs::SAMPLES {
            let knobs = GatherKnobs { samples, ..GatherKnobs::default() };
            let side = super::super::PATCHES_SIDE / knobs.stride();
            assert_eq!((side * side, knobs.fault()), (samples, None));
        }
        let fault = GatherKnobs { samples: 17, ..GatherKnobs::default() }.fault();
        assert!(fault.is_some_and(|line| line.starts_with("17 patches")));
        assert!(PatchClamp::ALL.into_iter().all(|clamp| PatchClamp::named(clamp.name()) == Some(clamp)));
    }
}
