//! Meshes of the scene file as they are written: what they are made of, and where they stand.

use super::number::{Any, Factor, Number, Pair, Three, Triple, Whole};
use super::raw::Table;
use glam::Vec3;
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use toml::Spanned;

pub type CornerIndex = Whole<0, { u32::MAX }>;

/// Written out, or read from a file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawMesh {
    pub name: Option<Spanned<String>>,
    pub positions: Option<Vec<Triple<Any>>>,
    pub triangles: Option<Spanned<Vec<Three<CornerIndex>>>>,
    pub normals: Option<Spanned<Vec<Triple<Any>>>>,
    pub uvs: Option<Spanned<Vec<Pair<Any>>>>,
    pub file: Option<Spanned<String>>,
    #[serde(default)]
    pub smooth: bool,
    pub scale: Option<RawScale>,
    pub rotate: Option<Triple<Any>>,
    pub translate: Option<Triple<Any>>,
    pub material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawStatue {
    pub name: Option<Spanned<String>>,
    pub level: Whole<0, { crate::statue::FINEST }>,
    pub scale: Option<RawScale>,
    pub rotate: Option<Triple<Any>>,
    pub translate: Option<Triple<Any>>,
    pub material: Spanned<String>,
}

/// A mesh or a statue once more.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawInstance {
    pub of: Spanned<String>,
    pub name: Option<Spanned<String>>,
    pub scale: Option<RawScale>,
    pub rotate: Option<Triple<Any>>,
    pub translate: Option<Triple<Any>>,
    pub material: Option<Spanned<String>>,
}

/// Where a mesh stands.
pub struct RawPlacement {
    pub scale: Option<RawScale>,
    pub rotate: Option<Triple<Any>>,
    pub translate: Option<Triple<Any>>,
}

/// `scale = 2` or `scale = [1, 2, 1]`: told apart by hand, so that errors keep their place.
pub struct RawScale(pub Vec3);

impl<'de> Deserialize<'de> for RawScale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;
        impl<'de> Visitor<'de> for Either {
            type Value = RawScale;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number or a list of three numbers, not 0")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<RawScale, A::Error> {
                let each: Triple<Factor> = Deserialize::deserialize(SeqAccessDeserializer::new(seq))?;
                Ok(RawScale(each.into()))
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<RawScale, E> {
                let all: Number<Factor> = Deserialize::deserialize(serde::de::value::F64Deserializer::new(number))?;
                Ok(RawScale(Vec3::splat(all.get())))
            }

            fn visit_i64<E: Error>(self, whole: i64) -> Result<RawScale, E> {
                self.visit_f64(whole as f64)
            }
        }
        deserializer.deserialize_any(Either)
    }
}

impl Table<RawMesh> {
    /// Where it stands, taken out of it.
    pub fn take_placement(&mut self) -> RawPlacement {
        let RawMesh { scale, rotate, translate, .. } = &mut self.0;
        RawPlacement { scale: scale.take(), rotate: rotate.take(), translate: translate.take() }
    }
}
