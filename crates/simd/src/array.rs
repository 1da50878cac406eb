//! Plain arrays: what runs where no intrinsics do, as wide as the compiler's vectorizer makes it, and the oracle of the
//! others.

use crate::{BitMatrix, Column, Double, Float, Mask, Word, WordColumn};
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// All ones where true.
#[derive(Debug, Clone, Copy)]
#[repr(align(16))]
pub struct Masks<const N: usize>([u32; N]);
#[derive(Debug, Clone, Copy)]
#[repr(align(16))]
pub struct Words<const N: usize>([u32; N]);
#[derive(Debug, Clone, Copy)]
#[repr(align(16))]
pub struct Doubles<const N: usize>([f64; N]);
#[derive(Debug, Clone, Copy)]
#[repr(align(16))]
pub struct Floats<const N: usize>([f32; N]);

macro_rules! lane_by_lane {
    ($type:ident: $($trait:ident $method:ident),*) => {$(
        impl<const N: usize> $trait for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $type(from_fn(|i| self.0[i].$method(other.0[i])))
            }
        }
    )*};
}
lane_by_lane!(Masks: BitAnd bitand, BitOr bitor, BitXor bitxor);
lane_by_lane!(Words: BitAnd bitand, BitOr bitor, BitXor bitxor);
lane_by_lane!(Doubles: Add add, Sub sub, Mul mul, Div div);
lane_by_lane!(Floats: Add add, Sub sub, Mul mul, Div div);

macro_rules! with_a_number {
    ($type:ident $number:ident: $($trait:ident $method:ident),*) => {$(
        impl<const N: usize> $trait<$number> for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: $number) -> Self {
                $type(from_fn(|i| self.0[i].$method(other)))
            }
        }
    )*};
}
with_a_number!(Doubles f64: Add add, Sub sub, Mul mul);
with_a_number!(Floats f32: Add add, Sub sub, Mul mul, Div div);

impl<const N: usize> Not for Masks<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Masks(self.0.map(|m| !m))
    }
}

impl<const N: usize> Not for Words<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Words(self.0.map(|u| !u))
    }
}

impl<const N: usize> Neg for Floats<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Floats(self.0.map(|f| -f))
    }
}

#[inline(always)]
fn all_ones_if(value: bool) -> u32 {
    0u32.wrapping_sub(u32::from(value))
}

impl<const N: usize> Masks<N> {
    #[inline(always)]
    fn of(value: impl Fn(usize) -> bool) -> Self {
        Masks(from_fn(|i| all_ones_if(value(i))))
    }
}

impl<const N: usize> Mask for Masks<N> {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Masks([all_ones_if(value); N])
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self::of(|i| bits >> i & 1 != 0)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.iter().enumerate().fold(0, |bits, (i, m)| bits | (m & 1) << i)
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().fold(0, |any, m| any | m) != 0
    }
}

impl<const N: usize> Word for Words<N> {
    type F = Floats<N>;
    type M = Masks<N>;
    #[inline(always)]
    fn splat(value: u32) -> Self {
        Words([value; N])
    }
    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        Words(from_fn(|i| from[i]))
    }
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn wrapping_add(self, other: Self) -> Self {
        Words(from_fn(|i| self.0[i].wrapping_add(other.0[i])))
    }
    #[inline(always)]
    fn wrapping_sub(self, other: Self) -> Self {
        Words(from_fn(|i| self.0[i].wrapping_sub(other.0[i])))
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        Words(from_fn(|i| self.0[i].wrapping_mul(other.0[i])))
    }
    #[inline(always)]
    fn shl<const BITS: u32>(self) -> Self {
        Words(self.0.map(|u| u << BITS))
    }
    #[inline(always)]
    fn shr<const BITS: u32>(self) -> Self {
        Words(self.0.map(|u| u >> BITS))
    }
    #[inline(always)]
    fn reverse_bits(self) -> Self {
        Words(self.0.map(u32::reverse_bits))
    }
    #[inline(always)]
    fn select(mask: Self::M, yes: Self, no: Self) -> Self {
        Words(from_fn(|i| yes.0[i] & mask.0[i] | no.0[i] & !mask.0[i]))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] == other.0[i])
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] < other.0[i])
    }
    #[inline(always)]
    fn to_float(self) -> Self::F {
        // signed, for which machines have an instruction
        Floats(self.0.map(|u| u as i32 as f32))
    }
    #[inline(always)]
    fn float_from_bits(self) -> Self::F {
        Floats(self.0.map(f32::from_bits))
    }
    #[inline(always)]
    fn multiplied_by(self, matrix: &BitMatrix) -> Self {
        Words(self.0.map(|u| matrix.times(u)))
    }
    #[inline(always)]
    fn look_up(self, column: &Column) -> Self::F {
        Floats(self.0.map(|u| u.look_up(column)))
    }
    #[inline(always)]
    fn look_up_word(self, column: &WordColumn) -> Self {
        Words(self.0.map(|u| u.look_up_word(column)))
    }
}

impl<const N: usize> Double for Doubles<N> {
    type F = Floats<N>;
    type M = Masks<N>;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Doubles([value; N])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Doubles(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] < other.0[i])
    }
    #[inline(always)]
    fn narrow(self) -> Self::F {
        Floats(self.0.map(|d| d as f32))
    }
}

impl<const N: usize> Float for Floats<N> {
    type U = Words<N>;
    type M = Masks<N>;
    type D = Doubles<N>;
    const LANES: usize = N;
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Floats([value; N])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        Floats(from_fn(|i| from[i]))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn select(mask: Self::M, yes: Self, no: Self) -> Self {
        Floats(from_fn(|i| f32::from_bits(yes.0[i].to_bits() & mask.0[i] | no.0[i].to_bits() & !mask.0[i])))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Floats(from_fn(|i| Float::min(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Floats(from_fn(|i| Float::max(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Floats(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Floats(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Floats(self.0.map(f32::floor))
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        Floats(self.0.map(f32::ceil))
    }
    #[inline(always)]
    fn round(self) -> Self {
        Floats(self.0.map(f32::round_ties_even))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] < other.0[i])
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] <= other.0[i])
    }
    #[inline(always)]
    fn gt(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] > other.0[i])
    }
    #[inline(always)]
    fn ge(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] >= other.0[i])
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Self::M {
        Masks::of(|i| self.0[i] == other.0[i])
    }
    #[inline(always)]
    fn to_word(self) -> Self::U {
        // signed, for which machines have an instruction
        Words(self.0.map(|f| f as i32 as u32))
    }
    #[inline(always)]
    fn to_bits(self) -> Self::U {
        Words(self.0.map(f32::to_bits))
    }
    #[inline(always)]
    fn widen(self) -> Self::D {
        Doubles(self.0.map(f64::from))
    }
}
