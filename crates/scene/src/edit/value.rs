//! What a property can be, and may be.

use crate::limits;
use glam::Vec3;
use std::ops::RangeInclusive;

/// A value of a property.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// In the unit that the property states.
    Number(f32),
    /// A colour, a point, or an angle about each axis.
    Triple(Vec3),
    /// One of the words that the property offers.
    Word(String),
    /// Whether it is so: true or false.
    Flag(bool),
}

impl Value {
    /// The number, if it is one.
    pub fn number(&self) -> Option<f32> {
        if let Value::Number(number) = self { Some(*number) } else { None }
    }

    /// The three numbers, if they are such.
    pub fn triple(&self) -> Option<Vec3> {
        if let Value::Triple(triple) = self { Some(*triple) } else { None }
    }

    /// The word, if it is one.
    pub fn word(&self) -> Option<&str> {
        if let Value::Word(word) = self { Some(word) } else { None }
    }

    /// The same with 0 for -0, as it is read from a text: the sign would turn what is drawn at random.
    pub(super) fn without_signed_zeros(self) -> Self {
        match self {
            Value::Number(number) => Value::Number(number + 0.0),
            Value::Triple(triple) => Value::Triple(triple + 0.0),
            other => other,
        }
    }

    /// The flag, if it is one.
    pub fn flag(&self) -> Option<bool> {
        if let Value::Flag(flag) = self { Some(*flag) } else { None }
    }
}

/// What a property may be.
#[derive(Debug, Clone)]
pub enum Kind {
    /// A number of the range that the scene file takes. `shown` is what a slider spans of it, by orders of magnitude where
    /// `logarithmic`.
    Number {
        /// What it may be.
        range: RangeInclusive<f32>,
        /// What a slider spans.
        shown: RangeInclusive<f32>,
        /// Whether equal steps of a slider are equal factors.
        logarithmic: bool,
        /// Behind the number: "°", or nothing.
        unit: &'static str,
    },
    /// Three shares, each in [0, 1].
    Colour,
    /// Three powers, each from 0 to 1e12.
    Light,
    /// A point of the world, each coordinate within +-1e12.
    Point,
    /// Degrees about x, then y, then z.
    Turn,
    /// A word out of those that [`Property::words`](super::Property::words) lists for the scene.
    Word,
    /// Whether it is so: true or false.
    Flag,
}

impl Kind {
    /// Whether the value is one of these. Words are not looked up.
    pub fn holds(&self, value: &Value) -> bool {
        match (self, value) {
            (Kind::Number { range, .. }, Value::Number(number)) => range.contains(number),
            (Kind::Colour, Value::Triple(v)) => v.cmpge(Vec3::ZERO).all() && v.cmple(Vec3::ONE).all(),
            (Kind::Light, Value::Triple(v)) => v.cmpge(Vec3::ZERO).all() && v.cmple(Vec3::splat(limits::LARGEST)).all(),
            (Kind::Point | Kind::Turn, Value::Triple(v)) => v.abs().cmple(Vec3::splat(limits::LARGEST)).all(),
            (Kind::Word, Value::Word(_)) | (Kind::Flag, Value::Flag(_)) => true,
            _ => false,
        }
    }

    /// What is expected, for faults: "a number from 0 to 1".
    pub fn expected(&self) -> String {
        match self {
            Kind::Number { range, .. } => format!("a number from {} to {}", range.start(), range.end()),
            Kind::Colour => "a colour [r, g, b] of numbers from 0 to 1".into(),
            Kind::Light => "[r, g, b] of numbers from 0 to 1e12".into(),
            Kind::Point => "a point [x, y, z] of numbers within +-1e12".into(),
            Kind::Turn => "degrees [x, y, z] about each axis".into(),
            Kind::Word => "a word".into(),
            Kind::Flag => "true or false".into(),
        }
    }
}
