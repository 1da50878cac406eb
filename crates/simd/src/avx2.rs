//! 8 lanes: AVX2.

use crate::{BitMatrix, Column, Double, Float, Kernel, Mask, Word, WordColumn};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

const LANES: usize = 8;

/// All ones where true.
#[derive(Debug, Clone, Copy)]
pub struct Masks(__m256);
#[derive(Debug, Clone, Copy)]
pub struct Words(__m256i);
/// The lower and the upper four lanes.
#[derive(Debug, Clone, Copy)]
pub struct Doubles(__m256d, __m256d);
#[derive(Debug, Clone, Copy)]
pub struct Floats(__m256);

/// Enters a kernel with the instructions that its operations need.
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
pub fn run<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Floats>()
}

/// Calls an intrinsic.
macro_rules! op {
    ($e:expr) => {{
        // SAFETY: values of this module's types exist only inside of `run`, which is entered only where the machine has
        // these instructions; memory is reached through slices whose length was checked
        #[allow(unused_unsafe, reason = "some of what is called through here is safe by itself")]
        unsafe {
            $e
        }
    }};
}

macro_rules! operator {
    ($type:ident $trait:ident $method:ident $intrinsic:ident) => {
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $type(op!($intrinsic(self.0, other.0)))
            }
        }
    };
}
operator!(Words BitAnd bitand _mm256_and_si256);
operator!(Words BitOr bitor _mm256_or_si256);
operator!(Words BitXor bitxor _mm256_xor_si256);
operator!(Floats Add add _mm256_add_ps);
operator!(Floats Sub sub _mm256_sub_ps);
operator!(Floats Mul mul _mm256_mul_ps);
operator!(Floats Div div _mm256_div_ps);

macro_rules! operator_of_doubles {
    ($trait:ident $method:ident $intrinsic:ident) => {
        impl $trait for Doubles {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                op!(Doubles($intrinsic(self.0, other.0), $intrinsic(self.1, other.1)))
            }
        }
    };
}
operator_of_doubles!(Add add _mm256_add_pd);
operator_of_doubles!(Sub sub _mm256_sub_pd);
operator_of_doubles!(Mul mul _mm256_mul_pd);
operator_of_doubles!(Div div _mm256_div_pd);

macro_rules! with_a_number {
    ($type:ident $number:ident: $($trait:ident $method:ident),*) => {$(
        impl $trait<$number> for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: $number) -> Self {
                self.$method(Self::splat(other))
            }
        }
    )*};
}
with_a_number!(Doubles f64: Add add, Sub sub, Mul mul);
with_a_number!(Floats f32: Add add, Sub sub, Mul mul, Div div);

operator!(Masks BitAnd bitand _mm256_and_ps);
operator!(Masks BitOr bitor _mm256_or_ps);
operator!(Masks BitXor bitxor _mm256_xor_ps);

impl Not for Masks {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        self ^ Self::splat(true)
    }
}

impl Not for Words {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        self ^ Self::splat(u32::MAX)
    }
}

impl Neg for Floats {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Floats(op!(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))))
    }
}

impl Mask for Masks {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Masks(op!(_mm256_castsi256_ps(_mm256_set1_epi32(if value { -1 } else { 0 }))))
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        let bit = Words::load(&[1, 2, 4, 8, 16, 32, 64, 128]);
        (Words::splat(bits) & bit).eq(bit)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        op!(_mm256_movemask_ps(self.0)).cast_unsigned()
    }
}

impl Word for Words {
    type F = Floats;
    type M = Masks;
    #[inline(always)]
    fn splat(value: u32) -> Self {
        Words(op!(_mm256_set1_epi32(value.cast_signed())))
    }
    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        let from = &from[..LANES];
        Words(op!(_mm256_loadu_si256(from.as_ptr().cast())))
    }
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..LANES];
        op!(_mm256_storeu_si256(to.as_mut_ptr().cast(), self.0));
    }
    #[inline(always)]
    fn wrapping_add(self, other: Self) -> Self {
        Words(op!(_mm256_add_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn wrapping_sub(self, other: Self) -> Self {
        Words(op!(_mm256_sub_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        Words(op!(_mm256_mullo_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn shl<const BITS: u32>(self) -> Self {
        Words(op!(_mm256_sll_epi32(self.0, _mm_cvtsi32_si128(BITS as i32))))
    }
    #[inline(always)]
    fn shr<const BITS: u32>(self) -> Self {
        Words(op!(_mm256_srl_epi32(self.0, _mm_cvtsi32_si128(BITS as i32))))
    }
    #[inline(always)]
    fn reverse_bits(self) -> Self {
        // bytes by two look-ups of four bits each, then their order
        let nibble = 0x0f0f_0f0f;
        op!({
            let low = _mm256_broadcastsi128_si256(_mm_setr_epi8(
                0, -128, 0x40, -64, 0x20, -96, 0x60, -32, 0x10, -112, 0x50, -48, 0x30, -80, 0x70, -16,
            ));
            let high = _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15));
            let order =
                _mm256_broadcastsi128_si256(_mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12));
            let lower = _mm256_and_si256(self.0, _mm256_set1_epi32(nibble));
            let upper = _mm256_and_si256(_mm256_srli_epi32::<4>(self.0), _mm256_set1_epi32(nibble));
            let bytes = _mm256_or_si256(_mm256_shuffle_epi8(low, lower), _mm256_shuffle_epi8(high, upper));
            Words(_mm256_shuffle_epi8(bytes, order))
        })
    }
    #[inline(always)]
    fn select(mask: Masks, yes: Self, no: Self) -> Self {
        Float::select(mask, yes.float_from_bits(), no.float_from_bits()).to_bits()
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Masks {
        Masks(op!(_mm256_castsi256_ps(_mm256_cmpeq_epi32(self.0, other.0))))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Masks {
        // signed comparison, the order turned over
        let [a, b] = [self, other].map(|u| u ^ Self::splat(0x8000_0000));
        Masks(op!(_mm256_castsi256_ps(_mm256_cmpgt_epi32(b.0, a.0))))
    }
    #[inline(always)]
    fn to_float(self) -> Floats {
        Floats(op!(_mm256_cvtepi32_ps(self.0)))
    }
    #[inline(always)]
    fn float_from_bits(self) -> Floats {
        Floats(op!(_mm256_castsi256_ps(self.0)))
    }
    #[inline(always)]
    fn multiplied_by(self, matrix: &BitMatrix) -> Self {
        let mut product = Self::splat(0);
        let mut rest = self;
        for table in &matrix.by_three {
            // the permutation reads the lowest three bits alone
            product = product ^ Words(op!(_mm256_permutevar8x32_epi32(Self::load(table).0, rest.0)));
            rest = rest.shr::<3>();
        }
        product
    }
    #[inline(always)]
    fn look_up(self, column: &Column) -> Floats {
        let values = column.values();
        let place = self & Self::splat(values.len() as u32 - 1);
        Floats(op!(_mm256_i32gather_ps::<4>(values.as_ptr(), place.0)))
    }
    #[inline(always)]
    fn look_up_word(self, column: &WordColumn) -> Self {
        let values = column.values();
        let place = self & Self::splat(values.len() as u32 - 1);
        Words(op!(_mm256_i32gather_epi32::<4>(values.as_ptr().cast(), place.0)))
    }
}

impl Double for Doubles {
    type F = Floats;
    type M = Masks;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        op!(Doubles(_mm256_set1_pd(value), _mm256_set1_pd(value)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        op!(Doubles(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Masks {
        op!({
            let low = _mm256_castpd_si256(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0));
            let high = _mm256_castpd_si256(_mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1));
            // of each 64-bit truth value one half: pairs of them from both, then in their order
            let mixed = _mm256_packs_epi32(low, high);
            let mixed = _mm256_permute4x64_epi64::<0b11_01_10_00>(mixed);
            let [first, second] = [_mm256_castsi256_si128(mixed), _mm256_extracti128_si256::<1>(mixed)];
            // 16-bit truth values, each twice
            let words = _mm_packs_epi32(first, second);
            Masks(_mm256_castsi256_ps(_mm256_cvtepi16_epi32(words)))
        })
    }
    #[inline(always)]
    fn narrow(self) -> Floats {
        op!(Floats(_mm256_set_m128(_mm256_cvtpd_ps(self.1), _mm256_cvtpd_ps(self.0))))
    }
}

impl Float for Floats {
    type U = Words;
    type M = Masks;
    type D = Doubles;
    const LANES: usize = LANES;
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Floats(op!(_mm256_set1_ps(value)))
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from = &from[..LANES];
        Floats(op!(_mm256_loadu_ps(from.as_ptr())))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..LANES];
        op!(_mm256_storeu_ps(to.as_mut_ptr(), self.0));
    }
    #[inline(always)]
    fn select(mask: Masks, yes: Self, no: Self) -> Self {
        Floats(op!(_mm256_blendv_ps(no.0, yes.0, mask.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Floats(op!(_mm256_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Floats(op!(_mm256_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Floats(op!(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Floats(op!(_mm256_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Floats(op!(_mm256_fmadd_ps(self.0, factor.0, term.0)))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Floats(op!(_mm256_round_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0)))
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        Floats(op!(_mm256_round_ps::<{ _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC }>(self.0)))
    }
    #[inline(always)]
    fn round(self) -> Self {
        Floats(op!(_mm256_round_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Masks {
        Masks(op!(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Masks {
        Masks(op!(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn gt(self, other: Self) -> Masks {
        Masks(op!(_mm256_cmp_ps::<_CMP_GT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn ge(self, other: Self) -> Masks {
        Masks(op!(_mm256_cmp_ps::<_CMP_GE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Masks {
        Masks(op!(_mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn to_word(self) -> Words {
        Words(op!(_mm256_cvttps_epi32(self.0)))
    }
    #[inline(always)]
    fn to_bits(self) -> Words {
        Words(op!(_mm256_castps_si256(self.0)))
    }
    #[inline(always)]
    fn widen(self) -> Doubles {
        op!({
            let [low, high] = [_mm256_castps256_ps128(self.0), _mm256_extractf128_ps::<1>(self.0)];
            Doubles(_mm256_cvtps_pd(low), _mm256_cvtps_pd(high))
        })
    }
}
