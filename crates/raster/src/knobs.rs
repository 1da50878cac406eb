//! The knobs of the fake: numbers that a picture may take instead of the scene's, and how its shadows are filtered.

use crate::bounce::GatherKnobs;
use crate::gpu_data;
use scene::{Scene, Vec3};
use std::fmt::Display;
use std::ops::RangeInclusive;

/// What may be turned; `None` leaves the scene's own number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FakeKnobs {
    /// Exponent of every highlight, in [`FakeKnobs::SHININESS`].
    pub shininess: Option<f32>,
    /// Ambient light, in [`FakeKnobs::AMBIENT`]. As taught it is the grey that a surface's colour is multiplied by.
    /// Fair, the sky's radiance takes its place, scaled as the grey was: half the scene's number is half the sky's
    /// light, so that one number means the same change in both fakes. Where the scene's number is 0, it is the share of
    /// the sky.
    pub ambient: Option<f32>,
    /// Lambert's share `k_d`, in [`FakeKnobs::COEFFICIENT`], times the colour of every surface: 1 is the scene's own.
    /// Ambient light keeps the whole colour.
    pub diffuse: Option<f32>,
    /// The highlight's share `k_s` of every surface, grey, in [`FakeKnobs::COEFFICIENT`].
    pub specular: Option<f32>,
    /// Texels along a side of each face of the cube maps, in [`FakeKnobs::CUBE_MAP`].
    pub cube_map: Option<u32>,
    /// Texels along a side of the shadow map, in [`FakeKnobs::SHADOW_MAP`].
    pub shadow_map: Option<u32>,
    /// How the shadow map is looked up.
    pub filter: ShadowFilter,
    /// Added to a point's depth before it is compared, in [`FakeKnobs::BIAS`] of the shadow map's range from near to
    /// far: negative lights what shadows itself, positive darkens.
    pub bias: f32,
    /// Segments of every sphere, around and from pole to pole, in [`FakeKnobs::SEGMENTS`].
    pub segments: Option<u32>,
    /// Where glass bends light as taught.
    pub refracted: RefractedAt,
    /// How textures are looked up where the checkerboard is one.
    pub textures: TextureFilter,
    /// How light of the second bounce is gathered.
    pub gather: GatherKnobs,
}

/// Ways to look up a shadow map: three.js r115's, by its names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum ShadowFilter {
    /// `BasicShadowMap`: the nearest texel alone.
    Hard,
    /// `PCFShadowMap`: the mean of 17 nearest texels, half a texel and a whole one away.
    Pcf,
    /// `PCFSoftShadowMap`: 3 x 3 texels, blended bilinearly. The tutorial's.
    #[default]
    PcfSoft,
}

/// Where the fake as taught bends light in glass; fair, every pixel does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum RefractedAt {
    /// At vertices, with directions interpolated between them: three.js r115's MeshBasic. The tutorial's.
    #[default]
    Vertices,
    /// In a fragment shader of one's own.
    Fragments,
}

impl RefractedAt {
    /// Both, the tutorial's first.
    pub const ALL: [RefractedAt; 2] = [RefractedAt::Vertices, RefractedAt::Fragments];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            RefractedAt::Vertices => "vertices",
            RefractedAt::Fragments => "fragments",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<RefractedAt> {
        RefractedAt::ALL.into_iter().find(|at| at.name() == name)
    }
}

/// How textures are looked up where many texels are one pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureFilter {
    /// Four texels about a place, of the largest level: aliases.
    Bilinear,
    /// Of two levels whose texels are about as large as a pixel is along the longer side of its footprint: blurs the other.
    Trilinear,
    /// Eight such lookups along the longer side, of levels that are as fine as the shorter (McCormack et al., "Feline", 1999).
    #[default]
    Anisotropic,
}

impl TextureFilter {
    /// All of them, from few texels to many.
    pub const ALL: [TextureFilter; 3] = [TextureFilter::Bilinear, TextureFilter::Trilinear, TextureFilter::Anisotropic];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            TextureFilter::Bilinear => "bilinear",
            TextureFilter::Trilinear => "trilinear",
            TextureFilter::Anisotropic => "anisotropic",
        }
    }

    /// The filter of that name.
    pub fn named(name: &str) -> Option<TextureFilter> {
        TextureFilter::ALL.into_iter().find(|filter| filter.name() == name)
    }

    /// The number by which `shaders/raster/surface.wgsl` knows it.
    pub(crate) fn code(self) -> u32 {
        match self {
            TextureFilter::Bilinear => gpu_data::BOARD_BILINEAR,
            TextureFilter::Trilinear => gpu_data::BOARD_TRILINEAR,
            TextureFilter::Anisotropic => gpu_data::BOARD_ANISOTROPIC,
        }
    }
}

impl ShadowFilter {
    /// All of them, from hard to soft.
    pub const ALL: [ShadowFilter; 3] = [ShadowFilter::Hard, ShadowFilter::Pcf, ShadowFilter::PcfSoft];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            ShadowFilter::Hard => "hard",
            ShadowFilter::Pcf => "pcf",
            ShadowFilter::PcfSoft => "pcf-soft",
        }
    }

    /// The filter of that name.
    pub fn named(name: &str) -> Option<ShadowFilter> {
        ShadowFilter::ALL.into_iter().find(|filter| filter.name() == name)
    }

    /// How many texels across the filter's diagonal, rounded up.
    pub(crate) fn reach(self) -> f32 {
        match self {
            ShadowFilter::Hard => 1.0,
            ShadowFilter::Pcf | ShadowFilter::PcfSoft => 3.0,
        }
    }

    /// The number by which `shaders/raster/shadow.wgsl` knows it.
    pub(crate) fn code(self) -> u32 {
        match self {
            ShadowFilter::Hard => gpu_data::FILTER_HARD,
            ShadowFilter::Pcf => gpu_data::FILTER_PCF,
            ShadowFilter::PcfSoft => gpu_data::FILTER_PCF_SOFT,
        }
    }
}

impl FakeKnobs {
    /// Exponents of a highlight.
    pub const SHININESS: RangeInclusive<f32> = 0.0..=1000.0;
    /// Ambient light.
    pub const AMBIENT: RangeInclusive<f32> = 0.0..=1.0;
    /// Shares of the light that a surface sends back.
    pub const COEFFICIENT: RangeInclusive<f32> = 0.0..=1.0;
    /// Texels along a side of a cube map's face.
    pub const CUBE_MAP: RangeInclusive<u32> = 4..=2048;
    /// Texels along a side of a shadow map.
    pub const SHADOW_MAP: RangeInclusive<u32> = 16..=4096;
    /// Shadow bias.
    pub const BIAS: RangeInclusive<f32> = -0.1..=0.1;
    /// Segments of a sphere.
    pub const SEGMENTS: RangeInclusive<u32> = 3..=512;

    /// The first knob that is turned too far, if one is: a line for the user.
    pub fn fault(&self) -> Option<String> {
        beyond("shininess", self.shininess, &Self::SHININESS)
            .or_else(|| beyond("ambient light", self.ambient, &Self::AMBIENT))
            .or_else(|| beyond("diffuse coefficient", self.diffuse, &Self::COEFFICIENT))
            .or_else(|| beyond("specular coefficient", self.specular, &Self::COEFFICIENT))
            .or_else(|| beyond("cube map size", self.cube_map, &Self::CUBE_MAP))
            .or_else(|| beyond("shadow map size", self.shadow_map, &Self::SHADOW_MAP))
            .or_else(|| beyond("shadow bias", Some(self.bias), &Self::BIAS))
            .or_else(|| beyond("number of segments", self.segments, &Self::SEGMENTS))
            .or_else(|| self.gather.fault())
    }

    /// The scene with these numbers in place of its own, but for ambient light and Lambert's share.
    pub(crate) fn applied(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        let fake = &mut scene.fake;
        fake.cube_map = self.cube_map.unwrap_or(fake.cube_map);
        fake.shadow_map = self.shadow_map.unwrap_or(fake.shadow_map);
        fake.segments = self.segments.unwrap_or(fake.segments);
        for material in &mut scene.materials {
            material.fake.shininess = self.shininess.unwrap_or(material.fake.shininess);
            material.fake.specular = self.specular.unwrap_or(material.fake.specular);
        }
        scene
    }

    /// Ambient light as taught: grey.
    pub(crate) fn grey(&self, scene: &Scene) -> Vec3 {
        Vec3::splat(self.ambient.unwrap_or(scene.fake.ambient))
    }

    /// Ambient light of the fair fake: the mean radiance of a uniform sky is that sky's.
    pub(crate) fn sky_light(&self, scene: &Scene) -> Vec3 {
        let own = scene.fake.ambient;
        scene.sky * self.ambient.map_or(1.0, |ambient| if own > 0.0 { ambient / own } else { ambient })
    }
}

/// NaN lies in no range.
fn beyond<T: PartialOrd + Display>(what: &str, value: Option<T>, range: &RangeInclusive<T>) -> Option<String> {
    let value = value.filter(|value| !range.contains(value))?;
    Some(format!("{what} {value} is out of range: choose from {} to {}", range.start(), range.end()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        assert!(ShadowFilter::ALL.iter().all(|&filter| ShadowFilter::named(filter.name()) == Some(filter)));
        assert!(TextureFilter::ALL.iter().all(|&filter| TextureFilter::named(filter.name()) == Some(filter)));
        assert!(RefractedAt::ALL.iter().all(|&at| RefractedAt::named(at.name()) == Some(at)));
    }

    #[test]
    fn each_knob_is_bounded_on_both_sides_and_bounds_count_in() {
        let fine = [
            FakeKnobs::default(),
            FakeKnobs { cube_map: Some(4), shadow_map: Some(16), segments: Some(3), ..FakeKnobs::default() },
            FakeKnobs { cube_map: Some(2048), shadow_map: Some(4096), segments: Some(512), ..FakeKnobs::default() },
            FakeKnobs { shininess: Some(1000.0), ambient: Some(1.0), bias: -0.1, ..FakeKnobs::default() },
        ];
        assert!(fine.iter().all(|knobs| knobs.fault().is_none()));
        let d = FakeKnobs::default();
        let beyond = [
            (FakeKnobs { cube_map: Some(3), ..d }, "cube map size 3"),
            (FakeKnobs { cube_map: Some(2049), ..d }, "cube map size 2049"),
            (FakeKnobs { shadow_map: Some(15), ..d }, "shadow map size 15"),
            (FakeKnobs { shadow_map: Some(4097), ..d }, "shadow map size 4097"),
            (FakeKnobs { segments: Some(2), ..d }, "segments 2"),
            (FakeKnobs { segments: Some(513), ..d }, "segments 513"),
            (FakeKnobs { shininess: Some(-1.0), ..d }, "shininess -1"),
            (FakeKnobs { shininess: Some(f32::NAN), ..d }, "shininess NaN"),
            (FakeKnobs { ambient: Some(1.5), ..d }, "ambient light 1.5"),
            (FakeKnobs { diffuse: Some(1.1), ..d }, "diffuse coefficient 1.1"),
            (FakeKnobs { specular: Some(-0.1), ..d }, "specular coefficient -0.1"),
            (FakeKnobs { bias: f32::INFINITY, ..d }, "shadow bias inf"),
        ];
        for (knobs, named) in beyond {
            assert!(knobs.fault().is_some_and(|fault| fault.contains(named)), "{named}: {:?}", knobs.fault());
        }
    }
}
