//! What a traced picture goes through between film and display.

/// A filter that takes the noise out of a picture, and some of the truth: all but [`Denoiser::Off`] are biased.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Denoiser {
    /// The samples' mean as it is.
    #[default]
    Off,
    /// Wavelets with holes, guided by features and variance (Dammertz et al. 2010; Schied et al. 2017).
    ATrous,
    /// Open Image Denoise's small network.
    Unet,
    /// Its usual network, of three times as many weights.
    UnetBase,
}

impl Denoiser {
    /// All, the default first.
    pub const ALL: [Self; 4] = [Self::Off, Self::ATrous, Self::Unet, Self::UnetBase];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::ATrous => "atrous",
            Self::Unet => "unet",
            Self::UnetBase => "unet-base",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|denoiser| denoiser.name() == name)
    }
}
