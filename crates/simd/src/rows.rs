//! Rows of four and of eight floats: for one ray against several boxes or triangles at once, where the width is the
//! data's and not the machine's.
//!
//! What runs is a [`RowKernel`]; [`RowLanes`] picks its instantiation at run time. All operations but
//! [`Row::mul_add`] are IEEE 754's, so all backends give the same bits.
//!
//! Unsafe as in the rest of the crate: the x86 rows are private, exist only inside a kernel that [`RowLanes::run`]
//! started, and a [`RowLanes`] of theirs is made only where the machine was seen to have their instructions.

use crate::Lanes;
use std::ops::{Add, Mul, Sub};

/// As many floats as a row of the data has.
pub trait Row<const N: usize>: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same value everywhere.
    fn splat(value: f32) -> Self;
    /// From memory.
    fn load(from: &[f32; N]) -> Self;
    /// The floats of these values, each at most 255.
    fn of_bytes(from: &[u8; N]) -> Self;
    /// To memory.
    fn to_array(self) -> [f32; N];
    /// `self * factor + term`, rounded once or twice: for bounds with a margin, not for what must be the same
    /// everywhere.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// `self < other ? self : other`; so `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// `self > other ? self : other`; so `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// Where it is less or equal: element `i` is bit `i`.
    fn le(self, other: Self) -> u32;
}

/// A machine with rows.
pub trait Rows {
    /// Four floats.
    type Four: Row<4>;
    /// Eight floats.
    type Eight: Row<8>;
    /// Asks for `slice[index]` to be brought near, where the machine can be asked; any index will do.
    fn prefetch<T>(slice: &[T], index: usize);
}

/// An algorithm written over rows.
pub trait RowKernel {
    /// What it gives.
    type Output;
    /// Runs it. To be marked `#[inline(always)]`, as all that it calls with rows; closures and `array::map` are no such
    /// calls.
    fn run<R: Rows>(self) -> Self::Output;
}

/// The choice of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowLanes(Choice);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Choice {
    #[cfg(target_arch = "x86_64")]
    Avx512,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    Array,
}

impl RowLanes {
    /// Those that come nearest to `lanes` of what this machine has.
    pub fn nearest_to(lanes: Lanes) -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("fma") {
            if lanes == Lanes::Avx512 && lanes.is_available() {
                return RowLanes(Choice::Avx512);
            }
            if matches!(lanes, Lanes::Avx512 | Lanes::Avx2) && Lanes::Avx2.is_available() {
                return RowLanes(Choice::Avx2);
            }
        }
        let _ = lanes;
        RowLanes(Choice::Array)
    }

    /// Runs a kernel.
    #[inline(always)]
    pub fn run<K: RowKernel>(self, kernel: K) -> K::Output {
        match self.0 {
            #[cfg(target_arch = "x86_64")]
            Choice::Avx512 => {
                // SAFETY: made by `nearest_to`, which saw that the machine has these instructions
                unsafe { x86::with_avx512(kernel) }
            }
            #[cfg(target_arch = "x86_64")]
            Choice::Avx2 => {
                // SAFETY: as above
                unsafe { x86::with_avx2(kernel) }
            }
            Choice::Array => kernel.run::<Arrays>(),
        }
    }
}

/// Rows in plain arrays.
struct Arrays;

impl Rows for Arrays {
    type Four = Plain<4>;
    type Eight = Plain<8>;
    #[inline(always)]
    fn prefetch<T>(_: &[T], _: usize) {}
}

/// A plain array.
#[derive(Clone, Copy)]
struct Plain<const N: usize>([f32; N]);

impl<const N: usize> Plain<N> {
    #[inline(always)]
    fn with(mut self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        for i in 0..N {
            self.0[i] = f(self.0[i], other.0[i]);
        }
        self
    }
}

impl<const N: usize> Add for Plain<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Plain<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl<const N: usize> Mul for Plain<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b)
    }
}

impl<const N: usize> Row<N> for Plain<N> {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Plain([value; N])
    }
    #[inline(always)]
    fn load(from: &[f32; N]) -> Self {
        Plain(*from)
    }
    #[inline(always)]
    fn of_bytes(from: &[u8; N]) -> Self {
        let mut to = [0.0; N];
        for i in 0..N {
            to[i] = f32::from(from[i]);
        }
        Plain(to)
    }
    #[inline(always)]
    fn to_array(self) -> [f32; N] {
        self.0
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.with(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        let mut bits = 0;
        for i in 0..N {
            bits |= u32::from(self.0[i] <= other.0[i]) << i;
        }
        bits
    }
}

/// Rows in registers of 128 and 256 bits. AVX-512 adds none, but doubles the number of registers.
#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{Row, RowKernel, Rows};
    use std::arch::x86_64::*;
    use std::ops::{Add, Mul, Sub};

    #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub fn with_avx2<K: RowKernel>(kernel: K) -> K::Output {
        kernel.run::<Registers>()
    }

    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
    pub fn with_avx512<K: RowKernel>(kernel: K) -> K::Output {
        kernel.run::<Registers>()
    }

    pub struct Registers;

    impl Rows for Registers {
        type Four = Four;
        type Eight = Eight;
        #[inline(always)]
        fn prefetch<T>(slice: &[T], index: usize) {
            let first = slice.as_ptr().wrapping_add(index).cast::<i8>();
            for line in 0..size_of::<T>().div_ceil(64) {
                // SAFETY: a hint, which no address makes fault
                unsafe { _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(64 * line)) }
            }
        }
    }

    macro_rules! operator {
        ($type:ident $trait:ident $method:ident $intrinsic:ident) => {
            impl $trait for $type {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    // SAFETY: rows exist only inside a kernel that was entered with these instructions
                    $type(unsafe { $intrinsic(self.0, other.0) })
                }
            }
        };
    }

    macro_rules! row {
        ($type:ident $n:literal $register:ident $splat:ident $load:ident $of_bytes:ident $store:ident
         $add:ident $sub:ident $mul:ident $mul_add:ident $min:ident $max:ident $compare:ident $bits:ident) => {
            #[derive(Clone, Copy)]
            pub struct $type($register);
            operator!($type Add add $add);
            operator!($type Sub sub $sub);
            operator!($type Mul mul $mul);

            impl Row<$n> for $type {
                #[inline(always)]
                fn splat(value: f32) -> Self {
                    // SAFETY: called only inside a kernel that was entered with these instructions, as all below
                    $type(unsafe { $splat(value) })
                }
                #[inline(always)]
                fn load(from: &[f32; $n]) -> Self {
                    // SAFETY: as above; the array is as long as the row
                    $type(unsafe { $load(from.as_ptr()) })
                }
                #[inline(always)]
                fn of_bytes(from: &[u8; $n]) -> Self {
                    // SAFETY: as above
                    $type(unsafe { $of_bytes(*from) })
                }
                #[inline(always)]
                fn to_array(self) -> [f32; $n] {
                    let mut to = [0.0; $n];
                    // SAFETY: as above; the array is as long as the row
                    unsafe { $store(to.as_mut_ptr(), self.0) };
                    to
                }
                #[inline(always)]
                fn mul_add(self, factor: Self, term: Self) -> Self {
                    // SAFETY: as above
                    $type(unsafe { $mul_add(self.0, factor.0, term.0) })
                }
                #[inline(always)]
                fn min(self, other: Self) -> Self {
                    // SAFETY: as above
                    $type(unsafe { $min(self.0, other.0) })
                }
                #[inline(always)]
                fn max(self, other: Self) -> Self {
                    // SAFETY: as above
                    $type(unsafe { $max(self.0, other.0) })
                }
                #[inline(always)]
                fn le(self, other: Self) -> u32 {
                    // SAFETY: as above
                    unsafe { $bits($compare::<_CMP_LE_OQ>(self.0, other.0)) }.cast_unsigned()
                }
            }
        };
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn four_of_bytes(bytes: [u8; 4]) -> __m128 {
        _mm_cvtepi32_ps(_mm_cvtepu8_epi32(_mm_cvtsi32_si128(i32::from_le_bytes(bytes))))
    }

    #[inline]
    #[target_feature(enable = "avx2")]
    fn eight_of_bytes(bytes: [u8; 8]) -> __m256 {
        _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_cvtsi64_si128(i64::from_le_bytes(bytes))))
    }

    row!(Four 4 __m128 _mm_set1_ps _mm_loadu_ps four_of_bytes _mm_storeu_ps _mm_add_ps _mm_sub_ps _mm_mul_ps _mm_fmadd_ps
        _mm_min_ps _mm_max_ps _mm_cmp_ps _mm_movemask_ps);
    row!(Eight 8 __m256 _mm256_set1_ps _mm256_loadu_ps eight_of_bytes _mm256_storeu_ps _mm256_add_ps _mm256_sub_ps _mm256_mul_ps
        _mm256_fmadd_ps _mm256_min_ps _mm256_max_ps _mm256_cmp_ps _mm256_movemask_ps);
}
