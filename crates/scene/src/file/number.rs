//! Numbers with a range, and lists of three of them. Each says in its error what it expected, and TOML adds where; so a
//! NaN, an infinity, a number too large for f32 or a list of another length never gets past the file.

use crate::limits::{LARGEST, SMALLEST};
use glam::{Vec2, Vec3};
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// A range of numbers, and its name in an error message.
pub trait Range {
    /// What was expected.
    const EXPECTED: &'static str;
    /// Whether a finite number lies in the range.
    fn holds(value: f32) -> bool;
}

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
    Length, "a finite number from 1e-12 to 1e12", |v| (SMALLEST..=LARGEST).contains(&v);
    Factor, "a finite number from 1e-12 to 1e12, or its negative", |v| (SMALLEST..=LARGEST).contains(&v.abs());
    AboveZero, "a finite number above 0 and at most 1e12", |v| v > 0.0 && v <= LARGEST;
    AtLeastZero, "a finite number from 0 to 1e12", |v| (0.0..=LARGEST).contains(&v);
    ZeroToOne, "a number from 0 to 1", |v| (0.0..=1.0).contains(&v);
    Roughness, "a number from 0.01 to 1", |v| (0.01..=1.0).contains(&v);
    CoatIndex, "a number from 1 to 100", |v| (1.0..=100.0).contains(&v);
    Index, "a number from 0.01 to 100", |v| (0.01..=100.0).contains(&v);
    Extinction, "a number from 0 to 100", |v| (0.0..=100.0).contains(&v);
}

/// A finite f32 in a [`Range`].
#[derive(Debug, Clone, Copy)]
pub struct Number<R>(f32, PhantomData<R>);

impl<R> Number<R> {
    pub fn get(self) -> f32 {
        self.0
    }
}

/// A list of exactly so many. An array of serde's own is filled from a longer list as well, whose rest is then lost.
#[derive(Debug, Clone, Copy)]
pub struct List<T, const N: usize>(pub [T; N]);

/// A list of exactly three.
pub type Three<T> = List<T, 3>;

/// Two numbers in a range: a place in textures.
pub type Pair<R> = List<Number<R>, 2>;

/// Such a list in the words of errors.
const fn list_of(count: usize) -> &'static str {
    if count == 2 { "a list of two numbers" } else { "a list of three numbers" }
}

/// Three numbers in a range: a point, a direction, a colour.
pub type Triple<R> = Three<Number<R>>;

impl Default for Number<Any> {
    fn default() -> Self {
        Number(0.0, PhantomData)
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for List<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Exactly<T, const N: usize>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Exactly<T, N> {
            type Value = List<T, N>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(list_of(N))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<List<T, N>, A::Error> {
                let mut found = Vec::with_capacity(N);
                while found.len() < N
                    && let Some(value) = list.next_element()?
                {
                    found.push(value);
                }
                let mut length = found.len();
                while list.next_element::<IgnoredAny>()?.is_some() {
                    length += 1;
                }
                match <[T; N]>::try_from(found) {
                    Ok(all) if length == N => Ok(List(all)),
                    _ => Err(A::Error::custom(format_args!("expected {}, found one of {length}", list_of(N)))),
                }
            }
        }
        deserializer.deserialize_seq(Exactly(PhantomData))
    }
}

impl<R> From<Pair<R>> for Vec2 {
    fn from(pair: Pair<R>) -> Vec2 {
        Vec2::from_array(pair.0.map(|n| n.0))
    }
}

impl<R> From<Triple<R>> for Vec3 {
    fn from(triple: Triple<R>) -> Vec3 {
        Vec3::from_array(triple.0.map(|n| n.0))
    }
}

impl<'de, R: Range> Deserialize<'de> for Number<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InRange<R>(PhantomData<R>);
        impl<R: Range> Visitor<'_> for InRange<R> {
            type Value = f32;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(R::EXPECTED)
            }

            fn visit_f64<E: Error>(self, wide: f64) -> Result<f32, E> {
                // -0 is 0: the sign would turn the axes about a normal, and so what is drawn at random there
                let value = wide as f32 + 0.0;
                let fits = value.is_finite() && R::holds(value);
                if fits { Ok(value) } else { Err(E::custom(format_args!("{wide} is not {}", R::EXPECTED))) }
            }

            fn visit_i64<E: Error>(self, whole: i64) -> Result<f32, E> {
                self.visit_f64(whole as f64)
            }
        }
        let value = deserializer.deserialize_any(InRange::<R>(PhantomData))?;
        Ok(Number(value, PhantomData))
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
        struct InRange<const LOW: u32, const HIGH: u32>;
        impl<const LOW: u32, const HIGH: u32> Visitor<'_> for InRange<LOW, HIGH> {
            type Value = u32;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "a whole number from {LOW} to {HIGH}")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<u32, E> {
                let fits = u32::try_from(value).ok().filter(|v| (LOW..=HIGH).contains(v));
                fits.ok_or_else(|| E::custom(format_args!("{value} is not a whole number from {LOW} to {HIGH}")))
            }
        }
        deserializer.deserialize_any(InRange::<LOW, HIGH>).map(Whole)
    }
}
