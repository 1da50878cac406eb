//! What is asked of lamps where their samples are tampered with: see [`crate::integrator::broken`].

use super::{Table, is, kind};
use simd::{Float, Word};

impl Table {
    /// Where lights are flat shapes.
    #[inline(always)]
    pub fn is_flat<U: Word>(&self, light: U) -> U::M {
        is(light.look_up_word(&self.kind), kind::FLAT)
    }

    /// The length of a rectangle's first edge over that of its second; 1 of other lights.
    #[inline(always)]
    pub fn width_over_height<U: Word>(&self, light: U) -> U::F {
        let kind = light.look_up_word(&self.kind);
        let other = is(kind, kind::TRIANGLE) | is(kind, kind::DISK);
        let rectangle = is(kind, kind::FLAT) & !other;
        let [width, height] = [&self.edge_u, &self.edge_v].map(|edge| edge.look_up(light).length_squared().sqrt());
        U::F::select(rectangle, width / height, U::F::splat(1.0))
    }
}
