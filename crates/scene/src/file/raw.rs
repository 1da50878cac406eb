//! The scene file as it is written, value by value.

use super::begun::Begun;
use super::number::{
    AboveZero, Any, AtLeastZero, CoatIndex, Extinction, Index, Length, Number, Roughness, Triple, Whole, ZeroToOne,
};
use super::picture::{RawAlphaMask, RawNormalMap, RawPicture};
use super::raw_mesh::{RawInstance, RawMesh, RawStatue};
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use toml::Spanned;

/// A table of names and values. A structure of serde's own is filled from a list as well, value by value.
#[derive(Default)]
pub struct Table<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Table<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Names<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Names<T> {
            type Value = T;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a table of names and values")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map))
            }
        }
        deserializer.deserialize_map(Names(PhantomData)).map(Table)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawScene {
    pub camera: Spanned<Table<RawCamera>>,
    #[serde(default)]
    pub material: BTreeMap<String, Spanned<Table<RawMaterial>>>,
    #[serde(default)]
    pub sphere: Vec<Table<RawSphere>>,
    #[serde(default)]
    pub rectangle: Vec<Table<RawRectangle>>,
    #[serde(default)]
    pub disk: Vec<Table<RawDisk>>,
    #[serde(default, rename = "box")]
    pub boxes: Vec<Table<RawBox>>,
    #[serde(default)]
    pub mesh: Vec<Spanned<Table<RawMesh>>>,
    #[serde(default)]
    pub statue: Vec<Table<RawStatue>>,
    #[serde(default)]
    pub instance: Vec<Table<RawInstance>>,
    pub sun: Option<Table<RawSun>>,
    #[serde(default)]
    pub point_light: Vec<Table<RawPointLight>>,
    #[serde(default)]
    pub sky: Table<RawSky>,
    #[serde(default)]
    pub fake: Table<RawFake>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawCamera {
    pub eye: Spanned<Triple<Any>>,
    pub target: Spanned<Triple<Any>>,
    pub up: Option<Spanned<Triple<Any>>>,
    pub fov_y: Spanned<Number<AboveZero>>,
    pub near: Option<Spanned<Number<AboveZero>>>,
    pub far: Option<Number<AboveZero>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawMaterial {
    pub diffuse: Option<Table<RawDiffuse>>,
    pub mirror: Option<Table<RawMirror>>,
    pub rough_conductor: Option<Table<RawRoughConductor>>,
    pub metallic_roughness: Option<Table<RawMetallicRoughness>>,
    pub dielectric: Option<Table<RawDielectric>>,
    pub emissive: Option<Table<RawEmissive>>,
    pub normal_map: Option<Table<RawNormalMap>>,
    pub alpha_mask: Option<Table<RawAlphaMask>>,
    #[serde(default)]
    pub fake: Table<RawFakeMaterial>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawDiffuse {
    pub albedo: RawTexture,
}

/// `albedo = [r, g, b]`, `albedo = { even = .., odd = .., .. }` or `albedo = { image = .., .. }`: told apart by hand, so that
/// errors keep their place.
pub enum RawTexture {
    Constant(Triple<ZeroToOne>),
    Checkerboard(RawCheckerboard),
    Image(RawPicture),
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
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = RawTexture;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a colour [r, g, b] or a checkerboard { even, odd, origin, cell } or a picture { image }")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<RawTexture, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(seq)).map(RawTexture::Constant)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawTexture, A::Error> {
                let map = Begun::of(map)?;
                if map.begins_with_one_of(&["even", "odd", "origin", "cell"]) {
                    return Deserialize::deserialize(MapAccessDeserializer::new(map)).map(RawTexture::Checkerboard);
                }
                Deserialize::deserialize(MapAccessDeserializer::new(map)).map(RawTexture::Image)
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
pub struct RawMetallicRoughness {
    pub base_colour: RawTexture,
    pub metallic: Number<ZeroToOne>,
    pub roughness: Number<ZeroToOne>,
    pub ior: Option<Number<CoatIndex>>,
    pub texture: Option<Table<RawPicture>>,
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
    pub texture: Option<Table<RawPicture>>,
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
    pub radius: Number<Length>,
    pub material: Spanned<String>,
    pub name: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawRectangle {
    pub corner: Triple<Any>,
    pub edge_u: Triple<Any>,
    pub edge_v: Spanned<Triple<Any>>,
    pub material: Spanned<String>,
    pub name: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawDisk {
    pub center: Triple<Any>,
    pub normal: Spanned<Triple<Any>>,
    pub radius: Number<Length>,
    pub material: Spanned<String>,
    pub name: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawBox {
    pub corner: Triple<Any>,
    pub size: Triple<Length>,
    #[serde(default = "unturned")]
    pub turn_y: Number<Any>,
    pub material: Spanned<String>,
    pub name: Option<Spanned<String>>,
}

fn unturned() -> Number<Any> {
    Number::default()
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
    pub spot: Option<Table<RawSpot>>,
    pub name: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawSpot {
    pub towards: Spanned<Triple<Any>>,
    pub inner: Number<AtLeastZero>,
    pub outer: Spanned<Number<AboveZero>>,
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
