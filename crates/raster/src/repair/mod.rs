//! What may be repaired of the fair fake, one defect at a time. A repair is a row of [`ROWS`], its number one of
//! `REPAIR_*` in `shaders/raster/repair/repairs.wgsl`, which pipelines compile in; what is done stands in the files
//! beside that. As taught nothing is repaired.

mod rows;

pub use rows::{ROWS, Row};

use std::fmt;

/// A defect of the fake that can be repaired.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Repair {
    /// Twice the samples a pixel, and spheres of more segments.
    Antialiasing,
    /// Checkerboards are textures with mip levels.
    TextureMapping,
    /// The sky is seen and lights as far as spheres leave it open, and has its sun.
    Sky,
    /// The shadow of a shape is seen in its own cube map.
    OwnShadow,
    /// Glass bends light where it enters.
    FrontFace,
    /// Cube maps are looked up where a ray leaves a sphere about them.
    ProxySphere,
    /// Cube maps are looked up where a ray meets what they show.
    Surroundings,
    /// Glass bends light where it enters and where it leaves.
    TwoInterfaces,
    /// Glass reflects what Fresnel's equations say.
    Fresnel,
    /// Mirrors have cube maps.
    Mirrors,
    /// Shadows of lights that are no points.
    SoftShadows,
    /// Spheres of glass let the sun's light through.
    LightThroughGlass,
    /// Spheres of glass focus the sun's light.
    Caustics,
    /// Area lights are no points.
    AreaLights,
    /// Lit surfaces light others, once.
    ReflectiveShadowMap,
    /// Lit surfaces light others, again and again.
    IrradianceProbes,
}

impl Repair {
    /// All of them, in the order in which light meets the defects.
    pub const ALL: [Repair; 16] = [
        Repair::Antialiasing,
        Repair::TextureMapping,
        Repair::Sky,
        Repair::OwnShadow,
        Repair::FrontFace,
        Repair::ProxySphere,
        Repair::Surroundings,
        Repair::TwoInterfaces,
        Repair::Fresnel,
        Repair::Mirrors,
        Repair::SoftShadows,
        Repair::LightThroughGlass,
        Repair::Caustics,
        Repair::AreaLights,
        Repair::ReflectiveShadowMap,
        Repair::IrradianceProbes,
    ];

    /// What there is to say about it.
    pub fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The repair of that name.
    pub fn named(name: &str) -> Option<Repair> {
        Repair::ALL.into_iter().find(|repair| repair.name() == name)
    }

    /// What stands for it in a set.
    fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// The numbers by which `shaders/raster/repair/repairs.wgsl` knows them.
pub(crate) fn shader_numbers() -> [(&'static str, f64); Repair::ALL.len()] {
    [
        ("REPAIR_ANTIALIASING", Repair::Antialiasing),
        ("REPAIR_TEXTURE_MAPPING", Repair::TextureMapping),
        ("REPAIR_SKY", Repair::Sky),
        ("REPAIR_OWN_SHADOW", Repair::OwnShadow),
        ("REPAIR_FRONT_FACE", Repair::FrontFace),
        ("REPAIR_PROXY_SPHERE", Repair::ProxySphere),
        ("REPAIR_SURROUNDINGS", Repair::Surroundings),
        ("REPAIR_TWO_INTERFACES", Repair::TwoInterfaces),
        ("REPAIR_FRESNEL", Repair::Fresnel),
        ("REPAIR_MIRRORS", Repair::Mirrors),
        ("REPAIR_SOFT_SHADOWS", Repair::SoftShadows),
        ("REPAIR_LIGHT_THROUGH_GLASS", Repair::LightThroughGlass),
        ("REPAIR_CAUSTICS", Repair::Caustics),
        ("REPAIR_AREA_LIGHTS", Repair::AreaLights),
        ("REPAIR_REFLECTIVE_SHADOW_MAP", Repair::ReflectiveShadowMap),
        ("REPAIR_IRRADIANCE_PROBES", Repair::IrradianceProbes),
    ]
    .map(|(name, repair)| (name, f64::from(repair as u32)))
}

/// A set of repairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Repairs(u32);

impl Repairs {
    /// The fair fake as it is.
    pub const NONE: Repairs = Repairs(0);
    /// Everything that can be repaired.
    pub const ALL: Repairs = Repairs((1 << Repair::ALL.len()) - 1);

    /// Whether a repair is one of them.
    pub fn has(self, repair: Repair) -> bool {
        self.0 & repair.bit() != 0
    }

    /// Whether one of several is.
    pub fn has_any(self, repairs: &[Repair]) -> bool {
        repairs.iter().any(|repair| self.has(*repair))
    }

    /// These and one more.
    #[must_use]
    pub fn with(self, repair: Repair) -> Repairs {
        Repairs(self.0 | repair.bit())
    }

    /// These but for one.
    #[must_use]
    pub fn without(self, repair: Repair) -> Repairs {
        Repairs(self.0 & !repair.bit())
    }

    /// One by one, in the order of [`Repair::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Repair> {
        Repair::ALL.into_iter().filter(move |repair| self.has(*repair))
    }

    /// How many they are.
    pub fn count(self) -> usize {
        self.0.count_ones() as usize
    }

    /// The names of all, in the order of [`Repair::ALL`].
    pub fn names() -> [&'static str; Repair::ALL.len()] {
        Repair::ALL.map(Repair::name)
    }

    /// What [`Repairs`] says of itself, read back: names with + between, "none" or "all".
    ///
    /// # Errors
    /// The name that is none.
    pub fn parse(text: &str) -> Result<Repairs, String> {
        match text {
            "none" => Ok(Repairs::NONE),
            "all" => Ok(Repairs::ALL),
            names => names.split('+').try_fold(Repairs::NONE, |repairs, name| {
                Repair::named(name).map(|repair| repairs.with(repair)).ok_or_else(|| name.to_owned())
            }),
        }
    }

    /// The bits that shaders know it by.
    pub(crate) fn bits(self) -> u32 {
        self.0
    }
}

impl FromIterator<Repair> for Repairs {
    fn from_iter<I: IntoIterator<Item = Repair>>(repairs: I) -> Self {
        repairs.into_iter().fold(Repairs::NONE, Repairs::with)
    }
}

impl fmt::Display for Repairs {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Repairs::NONE => f.write_str("none"),
            Repairs::ALL => f.write_str("all"),
            some => f.write_str(&some.iter().map(Repair::name).collect::<Vec<_>>().join("+")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_stand_in_the_order_of_all_and_say_something() {
        for (index, (repair, row)) in Repair::ALL.into_iter().zip(ROWS).enumerate() {
            assert_eq!((repair as usize, row.repair), (index, repair));
            assert_eq!(Repair::named(row.name), Some(repair));
            let long_enough = row.title.len() > 5 && row.text.len() > 60 && row.slide.len() > 5;
            assert!(long_enough && !row.name.contains(['+', ',', '=', ' ']), "{}", row.name);
        }
    }

    #[test]
    fn sets_are_read_back_as_they_are_written() {
        let some = Repairs::NONE.with(Repair::Fresnel).with(Repair::Sky);
        assert_eq!(some.to_string(), "sky+fresnel");
        for repairs in [Repairs::NONE, Repairs::ALL, some, Repairs::ALL.without(Repair::Caustics)] {
            assert_eq!(Repairs::parse(&repairs.to_string()), Ok(repairs));
        }
        assert_eq!(Repairs::parse("sky+glue"), Err("glue".to_owned()));
        assert_eq!((some.count(), Repairs::ALL.count()), (2, Repair::ALL.len()));
    }
}
