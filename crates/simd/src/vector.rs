//! Three floats in each lane.

use crate::Float;
use std::ops::{Add, Mul, Neg, Sub};

/// A vector, a point or a colour in each lane.
#[derive(Debug, Clone, Copy)]
pub struct Vector<F> {
    /// First component.
    pub x: F,
    /// Second component.
    pub y: F,
    /// Third component.
    pub z: F,
}

impl<F: Float> Vector<F> {
    /// From its components.
    #[inline(always)]
    pub fn new(x: F, y: F, z: F) -> Self {
        Vector { x, y, z }
    }

    /// The same vector in all lanes.
    #[inline(always)]
    pub fn splat([x, y, z]: [f32; 3]) -> Self {
        Vector { x: F::splat(x), y: F::splat(y), z: F::splat(z) }
    }

    /// The null vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::splat([0.0; 3])
    }

    /// One component for all axes.
    #[inline(always)]
    pub fn along_all(value: F) -> Self {
        Vector { x: value, y: value, z: value }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        Vector { x: F::select(mask, yes.x, no.x), y: F::select(mask, yes.y, no.y), z: F::select(mask, yes.z, no.z) }
    }

    /// Divided by a number in each lane.
    #[inline(always)]
    pub fn divided_by(self, divisor: F) -> Self {
        Vector { x: self.x / divisor, y: self.y / divisor, z: self.z / divisor }
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Vector {
            x: self.y * other.z - other.y * self.z,
            y: self.z * other.x - other.z * self.x,
            z: self.x * other.y - other.x * self.y,
        }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> F {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Square of the length.
    #[inline(always)]
    pub fn length_squared(self) -> F {
        self.dot(self)
    }

    /// The unit vector of the same direction.
    #[inline(always)]
    pub fn normalize(self) -> Self {
        self * (F::splat(1.0) / self.length_squared().sqrt())
    }

    /// Without signs.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Vector { x: self.x.abs(), y: self.y.abs(), z: self.z.abs() }
    }

    /// The largest component.
    #[inline(always)]
    pub fn max_element(self) -> F {
        self.x.max(self.y).max(self.z)
    }

    /// Whether all components are zero.
    #[inline(always)]
    pub fn is_zero(self) -> F::M {
        let zero = F::splat(0.0);
        self.x.eq(zero) & self.y.eq(zero) & self.z.eq(zero)
    }

    /// Whether no component is infinite or NaN.
    #[inline(always)]
    pub fn is_finite(self) -> F::M {
        self.x.is_finite() & self.y.is_finite() & self.z.is_finite()
    }
}

impl<F: Float> Add for Vector<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Vector { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<F: Float> Sub for Vector<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Vector { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

/// Component by component.
impl<F: Float> Mul for Vector<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Vector { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }
}

impl<F: Float> Mul<F> for Vector<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        Vector { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<F: Float> Neg for Vector<F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Vector { x: -self.x, y: -self.y, z: -self.z }
    }
}
