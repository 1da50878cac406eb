//! The choice of lanes, made at run time.

use crate::Float;
use crate::array::Floats;
use std::sync::atomic::{AtomicU8, Ordering};

/// What a kernel can run on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Lanes {
    /// 16 lanes, x86-64 with AVX-512 F, BW, DQ and VL.
    Avx512,
    /// 8 lanes, x86-64 with AVX2 and FMA.
    Avx2,
    /// 4 lanes in plain arrays, anywhere.
    Array,
    /// One lane.
    Scalar,
}

/// An algorithm written over lane types.
pub trait Kernel {
    /// What it gives.
    type Output;
    /// Runs it. To be marked `#[inline(always)]`, as all that it calls with lanes: instructions beyond the baseline
    /// exist only inside the function that [`Lanes::run`] enters.
    fn run<F: Float>(self) -> Self::Output;
}

/// What [`Lanes::best`] shall give, as a place in [`Lanes::ALL`]; anything else for the widest.
static PREFERRED: AtomicU8 = AtomicU8::new(u8::MAX);

impl Lanes {
    /// All, the widest first.
    pub const ALL: [Self; 4] = [Self::Avx512, Self::Avx2, Self::Array, Self::Scalar];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Array => "array",
            Self::Scalar => "scalar",
        }
    }

    /// How many they are.
    pub fn count(self) -> usize {
        match self {
            Self::Avx512 => 16,
            Self::Avx2 => 8,
            Self::Array => 4,
            Self::Scalar => 1,
        }
    }

    /// The lanes of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|lanes| lanes.name() == name)
    }

    /// Whether this machine has them.
    pub fn is_available(self) -> bool {
        match self {
            Self::Avx512 => has_avx512(),
            Self::Avx2 => has_avx2(),
            Self::Array | Self::Scalar => true,
        }
    }

    /// Those that this machine has, the widest first.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|lanes| lanes.is_available())
    }

    /// The widest that this machine has, unless others are preferred.
    pub fn best() -> Self {
        let preferred = Self::ALL.get(usize::from(PREFERRED.load(Ordering::Relaxed))).copied();
        preferred.filter(|lanes| lanes.is_available()).or_else(|| Self::available().next()).unwrap_or(Self::Array)
    }

    /// Makes [`Lanes::best`] give these from now on, in the whole process.
    pub fn prefer(self) {
        PREFERRED.store(self as u8, Ordering::Relaxed);
    }

    /// Runs a kernel on these lanes, or on [`Lanes::Array`] where the machine lacks them.
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 if has_avx512() => {
                // SAFETY: the machine was seen to have these instructions
                unsafe { crate::avx512::run(kernel) }
            }
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 if has_avx2() => {
                // SAFETY: the machine was seen to have these instructions
                unsafe { crate::avx2::run(kernel) }
            }
            Self::Scalar => kernel.run::<f32>(),
            _ => kernel.run::<Floats<4>>(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
}

#[cfg(target_arch = "x86_64")]
fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt")
}

#[cfg(not(target_arch = "x86_64"))]
fn has_avx512() -> bool {
    false
}

#[cfg(not(target_arch = "x86_64"))]
fn has_avx2() -> bool {
    false
}
