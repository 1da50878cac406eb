//! The scene file as it is written, value by value.

use super::number::{AboveZero, Any, AtLeastZero, Extinction, Index, Number, Roughness, Triple, Whole, ZeroToOne};
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawScene {
    pub camera: Spanned<RawCamera>,
    #[serde(default)]
    pub material: BTreeMap<String, Spanned<RawMaterial>>,
    #[serde(default)]
    pub sphere: Vec<RawSphere>,
    #[serde(default)]
    pub rectangle: Vec<RawRectangle>,
    #[serde(default)]
    pub disk: Vec<RawDisk>,
    #[serde(default, rename = "box")]
    pub boxes: Vec<RawBox>,
    #[serde(default)]
    pub mesh: Vec<RawMesh>,
    pub sun: Option<RawSun>,
    #[serde(default)]
    pub point_light: Vec<RawPointLight>,
    #[serde(default)]
    pub sky: RawSky,
    #[serde(default)]
    pub fake: RawFake,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawCamera {
    pub eye: Triple<Any>,
    pub target: Triple<Any>,
    pub up: Option<Triple<Any>>,
    pub fov_y: Number<AboveZero>,
    pub near: Option<Number<AboveZero>>,
    pub far: Option<Number<AboveZero>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawMaterial {
    pub diffuse: Option<RawDiffuse>,
    pub mirror: Option<RawMirror>,
    pub rough_conductor: Option<RawRoughConductor>,
    pub dielectric: Option<RawDielectric>,
    pub emissive: Option<RawEmissive>,
    #[serde(default)]
    pub fake: RawFakeMaterial,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawDiffuse {
    pub albedo: RawTexture,
}

/// `albedo = [r, g, b]` or `albedo = { even = .., odd = .., .. }`: told apart by hand, so that errors keep their place.
pub enum RawTexture {
    Constant(Triple<ZeroToOne>),
    Checkerboard(RawCheckerboard),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawCheckerboard {
    pub even: Triple<ZeroToOne>,
    pub odd: Triple<ZeroToOne>,
    pub origin: Triple<Any>,
    pub cell: Triple<AtLeastZero>,
}

impl<'de> Deserialize<'de> for RawTexture {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> serde::de::Visitor<'de> for Either {
            type Value = RawTexture;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a colour [r, g, b] or a checkerboard { even, odd, origin, cell }")
            }

            fn visit_seq<A: serde::de::SeqAccess<'de>>(self, seq: A) -> Result<RawTexture, A::Error> {
                Deserialize::deserialize(serde::de::value::SeqAccessDeserializer::new(seq)).map(RawTexture::Constant)
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<RawTexture, A::Error> {
                Deserialize::deserialize(serde::de::value::MapAccessDeserializer::new(map))
                    .map(RawTexture::Checkerboard)
            }
        }
        deserializer.deserialize_any(Either)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawMirror {
    pub reflectance: Triple<ZeroToOne>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawRoughConductor {
    pub reflectance: Option<Triple<ZeroToOne>>,
    pub eta: Option<Triple<Index>>,
    pub k: Option<Triple<Extinction>>,
    pub metal: Option<Spanned<String>>,
    pub roughness: Number<Roughness>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawDielectric {
    pub ior: Number<AboveZero>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawEmissive {
    pub radiance: Triple<AtLeastZero>,
    #[serde(default)]
    pub two_sided: bool,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct RawFakeMaterial {
    pub refraction_ratio: Option<Number<AboveZero>>,
    pub reflectivity: Option<Number<ZeroToOne>>,
    pub specular: Option<Number<ZeroToOne>>,
    pub shininess: Option<Number<AboveZero>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawSphere {
    pub center: Triple<Any>,
    pub radius: Number<AboveZero>,
    pub material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawRectangle {
    pub corner: Triple<Any>,
    pub edge_u: Triple<Any>,
    pub edge_v: Spanned<Triple<Any>>,
    pub material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawDisk {
    pub center: Triple<Any>,
    pub normal: Spanned<Triple<Any>>,
    pub radius: Number<AboveZero>,
    pub material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawBox {
    pub corner: Triple<Any>,
    pub size: [Number<AboveZero>; 3],
    #[serde(default = "unturned")]
    pub turn_y: Number<Any>,
    pub material: Spanned<String>,
}

fn unturned() -> Number<Any> {
    Number::default()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawMesh {
    pub positions: Vec<Triple<Any>>,
    pub triangles: Spanned<Vec<[u32; 3]>>,
    pub material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawSun {
    pub towards: Spanned<Triple<Any>>,
    pub angular_radius: Spanned<Number<AtLeastZero>>,
    pub irradiance: Triple<AtLeastZero>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawPointLight {
    pub position: Triple<Any>,
    pub intensity: Triple<AtLeastZero>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub struct RawSky {
    pub radiance: Option<Triple<AtLeastZero>>,
    pub image: Option<Spanned<String>>,
    pub scale: Option<Spanned<Number<AboveZero>>>,
    pub rotation: Option<Spanned<Number<Any>>>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct RawFake {
    pub ambient: Option<Number<AtLeastZero>>,
    pub intensity: Option<Number<AtLeastZero>>,
    pub light_position: Option<Triple<Any>>,
    pub shadow_half_width: Option<Number<AboveZero>>,
    pub shadow_map: Option<Whole<1, 8192>>,
    pub cube_map: Option<Whole<1, 4096>>,
    pub segments: Option<Whole<3, 1024>>,
}
