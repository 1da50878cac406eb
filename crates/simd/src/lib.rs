//! Lane types: an algorithm is written once over [`Float`], its words and masks, and runs on as many lanes as the
//! machine has: 16 with AVX-512, 8 with AVX2, 4 in plain arrays anywhere, and one, which is `f32` itself.
//!
//! What runs is a [`Kernel`]; [`Lanes::run`] picks its instantiation at run time. Every operation is IEEE 754's or
//! integer arithmetic and none but [`Float::mul_add`] is fused, so all backends give the same bits.
//!
//! Unsafe code lives in this crate alone, in two places. The x86 backends call intrinsics: their types are private,
//! values of them exist only inside a kernel that [`Lanes::run`] started, and it starts none whose instructions the
//! machine was not seen to have. And [`Lanes::run`] enters the function that carries these instructions.
//!
//! Own wrappers, because `std::simd` is unstable, `wide` chooses by `target-cpu` alone, and `pulp` has neither the
//! table look-ups nor the conversions between floats and words that the tracer needs.

mod array;
#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod lanes;
mod pages;
mod rows;
mod scalar;
mod stack;
mod tables;
mod vector;

pub use lanes::{Kernel, Lanes};
pub use pages::ask_for_large_pages;
pub use rows::{Row, RowKernel, RowLanes, Rows};
pub use stack::Stack;
pub use tables::{BitMatrix, Column, WordColumn};
pub use vector::Vector;

use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The most lanes that any backend has.
pub const MOST_LANES: usize = 16;

/// A truth value in each lane.
pub trait Mask:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// The same value in all lanes.
    fn splat(value: bool) -> Self;
    /// Lane `i` is bit `i`.
    fn from_bits(bits: u32) -> Self;
    /// Lane `i` as bit `i`.
    fn bits(self) -> u32;
    /// Whether any lane is true.
    #[inline(always)]
    fn any(self) -> bool {
        self.bits() != 0
    }
    /// In how many lanes it is true.
    #[inline(always)]
    fn count(self) -> u32 {
        self.bits().count_ones()
    }
}

/// A 32-bit unsigned integer in each lane. Arithmetic wraps.
pub trait Word:
    Copy + Debug + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> + Not<Output = Self>
{
    /// Floats of as many lanes.
    type F: Float<U = Self, M = Self::M>;
    /// Masks of as many lanes.
    type M: Mask;
    /// The same value in all lanes.
    fn splat(value: u32) -> Self;
    /// The first values of a slice of at least as many as there are lanes.
    fn load(from: &[u32]) -> Self;
    /// Writes all lanes to the beginning of a slice.
    fn store(self, to: &mut [u32]);
    /// Sum.
    fn wrapping_add(self, other: Self) -> Self;
    /// Difference.
    fn wrapping_sub(self, other: Self) -> Self;
    /// Product.
    fn wrapping_mul(self, other: Self) -> Self;
    /// Shifted to the left by `BITS` < 32.
    fn shl<const BITS: u32>(self) -> Self;
    /// Shifted to the right by `BITS` < 32; zeros come in.
    fn shr<const BITS: u32>(self) -> Self;
    /// The lowest bit becomes the highest.
    fn reverse_bits(self) -> Self;
    /// `mask ? yes : no`.
    fn select(mask: Self::M, yes: Self, no: Self) -> Self;
    /// Equal.
    fn eq(self, other: Self) -> Self::M;
    /// Less, unsigned.
    fn lt(self, other: Self) -> Self::M;
    /// The float of the same value, which must be below 2^31; exact up to 2^24.
    fn to_float(self) -> Self::F;
    /// The float of these bits.
    fn float_from_bits(self) -> Self::F;
    /// The product of a binary matrix with the bits of each lane.
    fn multiplied_by(self, matrix: &BitMatrix) -> Self;
    /// `column[self]` in each lane. A place beyond the column gives some value of it.
    fn look_up(self, column: &Column) -> Self::F;
    /// As [`Word::look_up`], of words.
    fn look_up_word(self, column: &WordColumn) -> Self;
}

/// A 64-bit float in each lane.
pub trait Double:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// Floats of as many lanes.
    type F: Float<D = Self, M = Self::M>;
    /// Masks of as many lanes.
    type M: Mask;
    /// The same value in all lanes.
    fn splat(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Less.
    fn lt(self, other: Self) -> Self::M;
    /// Rounded to single precision.
    fn narrow(self) -> Self::F;
}

/// A 32-bit float in each lane. Comparisons with a NaN are false.
pub trait Float:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
{
    /// Words of as many lanes.
    type U: Word<F = Self, M = Self::M>;
    /// Masks of as many lanes.
    type M: Mask;
    /// Doubles of as many lanes.
    type D: Double<F = Self, M = Self::M>;
    /// How many lanes there are.
    const LANES: usize;
    /// The same value in all lanes.
    fn splat(value: f32) -> Self;
    /// The first values of a slice of at least [`Float::LANES`].
    fn load(from: &[f32]) -> Self;
    /// Writes all lanes to the beginning of a slice.
    fn store(self, to: &mut [f32]);
    /// `mask ? yes : no`.
    fn select(mask: Self::M, yes: Self, no: Self) -> Self;
    /// `self < other ? self : other`; so `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// `self > other ? self : other`; so `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// Without the sign.
    fn abs(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// `self * factor + term`, rounded once with AVX2 and AVX-512, twice elsewhere: the one operation whose bits
    /// depend on the lanes. For what states a tolerance; never for a picture that is to be the same everywhere.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// The largest integer not above.
    fn floor(self) -> Self;
    /// The smallest integer not below.
    fn ceil(self) -> Self;
    /// The nearest integer, of two the even one.
    fn round(self) -> Self;
    /// Less.
    fn lt(self, other: Self) -> Self::M;
    /// Less or equal.
    fn le(self, other: Self) -> Self::M;
    /// Greater.
    fn gt(self, other: Self) -> Self::M;
    /// Greater or equal.
    fn ge(self, other: Self) -> Self::M;
    /// Equal.
    fn eq(self, other: Self) -> Self::M;
    /// Towards zero, of values in [0, 2^31).
    fn to_word(self) -> Self::U;
    /// The bits of its representation.
    fn to_bits(self) -> Self::U;
    /// As a double, exactly.
    fn widen(self) -> Self::D;

    /// This size with the sign of another.
    #[inline(always)]
    fn copysign(self, sign: Self) -> Self {
        let mask = Self::U::splat(0x8000_0000);
        ((self.to_bits() & !mask) | (sign.to_bits() & mask)).float_from_bits()
    }
    /// `self` between `least` and `most`.
    #[inline(always)]
    fn clamp(self, least: Self, most: Self) -> Self {
        self.max(least).min(most)
    }
    /// Whether neither infinite nor NaN.
    #[inline(always)]
    fn is_finite(self) -> Self::M {
        self.abs().lt(Self::splat(f32::INFINITY))
    }
    /// The next float above a finite one.
    #[inline(always)]
    fn next_up(self) -> Self {
        let (bits, one) = (self.to_bits(), Self::U::splat(1));
        let zero = Self::splat(0.0);
        let moved = Self::U::select(self.lt(zero), bits.wrapping_sub(one), bits.wrapping_add(one));
        Self::U::select(self.eq(zero), one, moved).float_from_bits()
    }
    /// The next float below a finite one.
    #[inline(always)]
    fn next_down(self) -> Self {
        -(-self).next_up()
    }
}
