//! Numbers with a range. Each says in its error what it expected, and TOML adds where; so a NaN, an infinity or a
//! number too large for f32 never gets past the file.

use glam::Vec3;
use serde::de::{Deserialize, Deserializer, Error, Visitor};
use std::fmt;

/// A range of numbers, and its name in an error message.
pub trait Range {
    /// What was expected.
    const EXPECTED: &'static str;
    /// Whether a finite number lies in the range.
    fn holds(value: f32) -> bool;
}

/// Squares and volumes of larger numbers leave f32 behind.
const LARGEST: f32 = 1e12;

macro_rules! ranges {
    ($($name:ident, $expected:literal, $holds:expr;)*) => {$(
        #[derive(Debug, Clone, Copy)]
        pub struct $name;
        impl Range for $name {
            const EXPECTED: &'static str = $expected;
            fn holds(value: f32) -> bool {
                let holds: fn(f32) -> bool = $holds;
                holds(value)
            }
        }
    )*};
}

ranges! {
    Any, "a finite number within +-1e12", |v| v.abs() <= LARGEST;
    AboveZero, "a finite number above 0 and at most 1e12", |v| v > 0.0 && v <= LARGEST;
    AtLeastZero, "a finite number from 0 to 1e12", |v| (0.0..=LARGEST).contains(&v);
    ZeroToOne, "a number from 0 to 1", |v| (0.0..=1.0).contains(&v);
    Roughness, "a number from 0.01 to 1", |v| (0.01..=1.0).contains(&v);
    Index, "a number from 0.01 to 100", |v| (0.01..=100.0).contains(&v);
    Extinction, "a number from 0 to 100", |v| (0.0..=100.0).contains(&v);
}

/// A finite f32 in a [`Range`].
#[derive(Debug, Clone, Copy)]
pub struct Number<R>(f32, std::marker::PhantomData<R>);

impl<R> Number<R> {
    pub fn get(self) -> f32 {
        self.0
    }
}

/// Three numbers in a range: a point, a direction, a colour.
#[derive(Debug, Clone, Copy, serde::Deserialize)]
#[serde(transparent, bound = "R: Range")]
pub struct Triple<R>([Number<R>; 3]);

impl Default for Number<Any> {
    fn default() -> Self {
        Number(0.0, std::marker::PhantomData)
    }
}

impl<R> From<Triple<R>> for Vec3 {
    fn from(triple: Triple<R>) -> Vec3 {
        Vec3::from_array(triple.0.map(|n| n.0))
    }
}

impl<'de, R: Range> Deserialize<'de> for Number<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InRange<R>(std::marker::PhantomData<R>);
        impl<R: Range> Visitor<'_> for InRange<R> {
            type Value = f32;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(R::EXPECTED)
            }

            fn visit_f64<E: Error>(self, wide: f64) -> Result<f32, E> {
                let value = wide as f32;
                let fits = value.is_finite() && R::holds(value);
                if fits { Ok(value) } else { Err(E::custom(format_args!("{wide} is not {}", R::EXPECTED))) }
            }

            fn visit_i64<E: Error>(self, whole: i64) -> Result<f32, E> {
                self.visit_f64(whole as f64)
            }
        }
        let value = deserializer.deserialize_any(InRange::<R>(std::marker::PhantomData))?;
        Ok(Number(value, std::marker::PhantomData))
    }
}

/// A whole number from `LOW` to `HIGH`.
#[derive(Debug, Clone, Copy)]
pub struct Whole<const LOW: u32, const HIGH: u32>(u32);

impl<const LOW: u32, const HIGH: u32> Whole<LOW, HIGH> {
    pub fn get(self) -> u32 {
        self.0
    }
}

impl<'de, const LOW: u32, const HIGH: u32> Deserialize<'de> for Whole<LOW, HIGH> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = i64::deserialize(deserializer)?;
        let fits = u32::try_from(value).ok().filter(|v| (LOW..=HIGH).contains(v));
        fits.map(Whole)
            .ok_or_else(|| D::Error::custom(format_args!("{value} is not a whole number from {LOW} to {HIGH}")))
    }
}
