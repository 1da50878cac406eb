//! A choice among few or many, each with a probability of its own.

use simd::{Column, Float, Word};

/// Probabilities that add up to 1, as lanes choose by them.
#[derive(Debug, Clone, Default)]
pub struct Discrete {
    /// Their running sum, the last one 1.
    cumulative: Column,
    count: u32,
}

impl Discrete {
    /// Of these probabilities, which add up to 1.
    pub fn new(probabilities: impl IntoIterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let running = probabilities.into_iter().map(|probability| {
            sum += probability;
            sum as f32
        });
        let mut cumulative: Vec<f32> = running.collect();
        if let Some(last) = cumulative.last_mut() {
            *last = 1.0;
        }
        Discrete { count: cumulative.len() as u32, cumulative: Column::new(cumulative) }
    }

    /// Whether there is nothing to choose.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Among how many it chooses.
    pub fn len(&self) -> usize {
        self.count as usize
    }

    /// The running sums of the probabilities, the last one 1.
    pub fn running_sums(&self) -> &[f32] {
        &self.cumulative.values()[..self.len()]
    }

    /// Which one `u` in [0, 1) chooses; there must be one. The first whose running sum is above `u`, by halving.
    #[inline(always)]
    pub fn choose<F: Float>(&self, u: F) -> F::U {
        let mut below = F::U::splat(0);
        if self.count > 1 {
            let last = F::U::splat(self.count - 1);
            let mut step = self.count.next_power_of_two();
            while step > 0 {
                let next = below.wrapping_add(F::U::splat(step));
                let of_next = next.wrapping_sub(F::U::splat(1));
                let passed = !last.lt(next) & of_next.look_up(&self.cumulative).le(u);
                below = F::U::select(passed, next, below);
                step /= 2;
            }
        }
        below
    }
}
