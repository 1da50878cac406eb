//! What a user may choose about the fake.

/// Size and manner of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RasterSettings {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Which of the two fakes.
    pub fake: Fake,
    /// Which local illumination model.
    pub shading: Shading,
}

impl RasterSettings {
    /// A picture of this size by the default fake and shading.
    pub fn new(width: u32, height: u32) -> Self {
        RasterSettings { width, height, fake: Fake::default(), shading: Shading::default() }
    }
}

/// The two fakes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Fake {
    /// The fake on the truth's data: linear and unclamped.
    #[default]
    Fair,
    /// The tutorial's viewer, number for number.
    AsTaught,
}

/// The local illumination models; see [`crate::shading`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Shading {
    /// three.js' MeshPhong, which is a normalised Blinn-Phong with Fresnel.
    #[default]
    Three,
    /// The slides' Phong.
    Phong,
    /// The slides' Blinn-Phong.
    BlinnPhong,
}

impl Fake {
    /// All of them, the default first.
    pub const ALL: [Fake; 2] = [Fake::Fair, Fake::AsTaught];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Fake::Fair => "fair",
            Fake::AsTaught => "as-taught",
        }
    }

    /// The fake of that name.
    pub fn named(name: &str) -> Option<Fake> {
        Fake::ALL.into_iter().find(|fake| fake.name() == name)
    }
}

impl Shading {
    /// All of them, the default first.
    pub const ALL: [Shading; 3] = [Shading::Three, Shading::Phong, Shading::BlinnPhong];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Shading::Three => "three",
            Shading::Phong => "phong",
            Shading::BlinnPhong => "blinn-phong",
        }
    }

    /// The model of that name.
    pub fn named(name: &str) -> Option<Shading> {
        Shading::ALL.into_iter().find(|shading| shading.name() == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        assert!(Fake::ALL.iter().all(|&fake| Fake::named(fake.name()) == Some(fake)));
        assert!(Shading::ALL.iter().all(|&shading| Shading::named(shading.name()) == Some(shading)));
        assert_eq!(Fake::named("Fair"), None);
    }
}
