//! 16 lanes: AVX-512 F, BW, DQ and VL.

use crate::{BitMatrix, Column, Double, Float, Kernel, Mask, Word, WordColumn};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

const LANES: usize = 16;

#[derive(Debug, Clone, Copy)]
pub struct Masks(__mmask16);
#[derive(Debug, Clone, Copy)]
pub struct Words(__m512i);
/// The lower and the upper eight lanes.
#[derive(Debug, Clone, Copy)]
pub struct Doubles(__m512d, __m512d);
#[derive(Debug, Clone, Copy)]
pub struct Floats(__m512);

/// Enters a kernel with the instructions that its operations need.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
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
operator!(Words BitAnd bitand _mm512_and_si512);
operator!(Words BitOr bitor _mm512_or_si512);
operator!(Words BitXor bitxor _mm512_xor_si512);
operator!(Floats Add add _mm512_add_ps);
operator!(Floats Sub sub _mm512_sub_ps);
operator!(Floats Mul mul _mm512_mul_ps);
operator!(Floats Div div _mm512_div_ps);

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
operator_of_doubles!(Add add _mm512_add_pd);
operator_of_doubles!(Sub sub _mm512_sub_pd);
operator_of_doubles!(Mul mul _mm512_mul_pd);
operator_of_doubles!(Div div _mm512_div_pd);

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

impl BitAnd for Masks {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Masks(self.0 & other.0)
    }
}

impl BitOr for Masks {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Masks(self.0 | other.0)
    }
}

impl BitXor for Masks {
    type Output = Self;
    #[inline(always)]
    fn bitxor(self, other: Self) -> Self {
        Masks(self.0 ^ other.0)
    }
}

impl Not for Masks {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Masks(!self.0)
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
        Floats(op!(_mm512_xor_ps(self.0, _mm512_set1_ps(-0.0))))
    }
}

impl Mask for Masks {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Masks(if value { u16::MAX } else { 0 })
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Masks(bits as u16)
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        u32::from(self.0)
    }
}

impl Word for Words {
    type F = Floats;
    type M = Masks;
    #[inline(always)]
    fn splat(value: u32) -> Self {
        Words(op!(_mm512_set1_epi32(value.cast_signed())))
    }
    #[inline(always)]
    fn load(from: &[u32]) -> Self {
        let from = &from[..LANES];
        Words(op!(_mm512_loadu_si512(from.as_ptr().cast())))
    }
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..LANES];
        op!(_mm512_storeu_si512(to.as_mut_ptr().cast(), self.0));
    }
    #[inline(always)]
    fn wrapping_add(self, other: Self) -> Self {
        Words(op!(_mm512_add_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn wrapping_sub(self, other: Self) -> Self {
        Words(op!(_mm512_sub_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        Words(op!(_mm512_mullo_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn shl<const BITS: u32>(self) -> Self {
        Words(op!(_mm512_slli_epi32::<BITS>(self.0)))
    }
    #[inline(always)]
    fn shr<const BITS: u32>(self) -> Self {
        Words(op!(_mm512_srli_epi32::<BITS>(self.0)))
    }
    #[inline(always)]
    fn reverse_bits(self) -> Self {
        // bytes by two look-ups of four bits each, then their order
        let nibble = 0x0f0f_0f0f;
        op!({
            let low = _mm512_broadcast_i32x4(_mm_setr_epi8(
                0, -128, 0x40, -64, 0x20, -96, 0x60, -32, 0x10, -112, 0x50, -48, 0x30, -80, 0x70, -16,
            ));
            let high = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15));
            let order = _mm512_broadcast_i32x4(_mm_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12));
            let lower = _mm512_and_si512(self.0, _mm512_set1_epi32(nibble));
            let upper = _mm512_and_si512(_mm512_srli_epi32::<4>(self.0), _mm512_set1_epi32(nibble));
            let bytes = _mm512_or_si512(_mm512_shuffle_epi8(low, lower), _mm512_shuffle_epi8(high, upper));
            Words(_mm512_shuffle_epi8(bytes, order))
        })
    }
    #[inline(always)]
    fn select(mask: Masks, yes: Self, no: Self) -> Self {
        Words(op!(_mm512_mask_blend_epi32(mask.0, no.0, yes.0)))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Masks {
        Masks(op!(_mm512_cmpeq_epi32_mask(self.0, other.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Masks {
        Masks(op!(_mm512_cmplt_epu32_mask(self.0, other.0)))
    }
    #[inline(always)]
    fn to_float(self) -> Floats {
        Floats(op!(_mm512_cvtepi32_ps(self.0)))
    }
    #[inline(always)]
    fn float_from_bits(self) -> Floats {
        Floats(op!(_mm512_castsi512_ps(self.0)))
    }
    #[inline(always)]
    fn multiplied_by(self, matrix: &BitMatrix) -> Self {
        let mut product = Self::splat(0);
        let mut rest = self;
        for table in &matrix.by_four {
            // the permutation reads the lowest four bits alone
            product = product ^ Words(op!(_mm512_permutexvar_epi32(rest.0, Self::load(table).0)));
            rest = rest.shr::<4>();
        }
        product
    }
    #[inline(always)]
    fn look_up(self, column: &Column) -> Floats {
        let values = column.values();
        if values.len() == 2 * LANES {
            let [low, high] = [Floats::load(values), Floats::load(&values[LANES..])];
            return Floats(op!(_mm512_permutex2var_ps(low.0, self.0, high.0)));
        }
        let place = self & Self::splat(values.len() as u32 - 1);
        Floats(op!(_mm512_i32gather_ps::<4>(place.0, values.as_ptr())))
    }
    #[inline(always)]
    fn look_up_word(self, column: &WordColumn) -> Self {
        let values = column.values();
        if values.len() == 2 * LANES {
            let [low, high] = [Self::load(values), Self::load(&values[LANES..])];
            return Words(op!(_mm512_permutex2var_epi32(low.0, self.0, high.0)));
        }
        let place = self & Self::splat(values.len() as u32 - 1);
        Words(op!(_mm512_i32gather_epi32::<4>(place.0, values.as_ptr().cast())))
    }
}

impl Double for Doubles {
    type F = Floats;
    type M = Masks;
    #[inline(always)]
    fn splat(value: f64) -> Self {
        op!(Doubles(_mm512_set1_pd(value), _mm512_set1_pd(value)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        op!(Doubles(_mm512_sqrt_pd(self.0), _mm512_sqrt_pd(self.1)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Masks {
        op!({
            let low = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0);
            let high = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.1, other.1);
            Masks(u16::from(low) | u16::from(high) << 8)
        })
    }
    #[inline(always)]
    fn narrow(self) -> Floats {
        op!({
            let low = _mm512_castps256_ps512(_mm512_cvtpd_ps(self.0));
            Floats(_mm512_insertf32x8::<1>(low, _mm512_cvtpd_ps(self.1)))
        })
    }
}

impl Float for Floats {
    type U = Words;
    type M = Masks;
    type D = Doubles;
    const LANES: usize = LANES;
    #[inline(always)]
    fn splat(value: f32) -> Self {
        Floats(op!(_mm512_set1_ps(value)))
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from = &from[..LANES];
        Floats(op!(_mm512_loadu_ps(from.as_ptr())))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..LANES];
        op!(_mm512_storeu_ps(to.as_mut_ptr(), self.0));
    }
    #[inline(always)]
    fn select(mask: Masks, yes: Self, no: Self) -> Self {
        Floats(op!(_mm512_mask_blend_ps(mask.0, no.0, yes.0)))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Floats(op!(_mm512_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Floats(op!(_mm512_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Floats(op!(_mm512_abs_ps(self.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Floats(op!(_mm512_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Floats(op!(_mm512_fmadd_ps(self.0, factor.0, term.0)))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Floats(op!(_mm512_roundscale_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0)))
    }
    #[inline(always)]
    fn ceil(self) -> Self {
        Floats(op!(_mm512_roundscale_ps::<{ _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC }>(self.0)))
    }
    #[inline(always)]
    fn round(self) -> Self {
        Floats(op!(_mm512_roundscale_ps::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0)))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Masks {
        Masks(op!(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Masks {
        Masks(op!(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn gt(self, other: Self) -> Masks {
        Masks(op!(_mm512_cmp_ps_mask::<_CMP_GT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn ge(self, other: Self) -> Masks {
        Masks(op!(_mm512_cmp_ps_mask::<_CMP_GE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Masks {
        Masks(op!(_mm512_cmp_ps_mask::<_CMP_EQ_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn to_word(self) -> Words {
        Words(op!(_mm512_cvttps_epi32(self.0)))
    }
    #[inline(always)]
    fn to_bits(self) -> Words {
        Words(op!(_mm512_castps_si512(self.0)))
    }
    #[inline(always)]
    fn widen(self) -> Doubles {
        op!({
            let high = _mm512_extractf32x8_ps::<1>(self.0);
            Doubles(_mm512_cvtps_pd(_mm512_castps512_ps256(self.0)), _mm512_cvtps_pd(high))
        })
    }
}
