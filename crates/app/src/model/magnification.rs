//! Pictures shown larger than they are, pixel by pixel.

/// How much larger than they are pictures are shown, and what of them is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Magnification {
    /// Pixels of the screen along a side of one of the picture: a power of two.
    factor: u32,
    /// Where the upper left corner of what is seen lies, in shares of the picture.
    start: [f32; 2],
}

impl Default for Magnification {
    fn default() -> Self {
        Magnification { factor: 1, start: [0.0; 2] }
    }
}

impl Magnification {
    /// All factors, the smallest first.
    pub const FACTORS: [u32; 6] = [1, 2, 4, 8, 16, 32];

    /// How many times as wide and as high pictures are shown, from 1 up.
    pub fn factor(&self) -> u32 {
        self.factor
    }

    /// Another factor, twice as large for each step; what lies at `at`, in shares of what is seen, stays there.
    pub fn stepped(self, steps: i32, at: [f32; 2]) -> Self {
        let most = Self::FACTORS.len() as i32 - 1;
        let index = (self.factor.trailing_zeros() as i32).saturating_add(steps).clamp(0, most);
        self.by(Self::FACTORS[index as usize], at)
    }

    /// A factor of [`Magnification::FACTORS`] about what lies at `at`, in shares of what is seen.
    pub fn by(self, factor: u32, at: [f32; 2]) -> Self {
        let fixed = self.picture_at(at);
        let start = [0, 1].map(|axis| fixed[axis] - at[axis] / factor as f32);
        Magnification { factor, start }.within()
    }

    /// What is seen after a drag by so much, in shares of what is seen.
    pub fn dragged(self, by: [f32; 2]) -> Self {
        let start = [0, 1].map(|axis| self.start[axis] - by[axis] / self.factor as f32);
        Magnification { start, ..self }.within()
    }

    /// What of the picture, in shares of it, lies at `at`, in shares of what is seen.
    pub fn picture_at(&self, at: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|axis| self.start[axis] + at[axis] / self.factor as f32)
    }

    /// As files keep it: factor, and the left and top of what is seen.
    pub fn record(&self) -> String {
        format!("{}x from {} {}", self.factor, self.start[0], self.start[1])
    }

    /// Nothing beside the picture is seen.
    fn within(self) -> Self {
        let most = 1.0 - 1.0 / self.factor as f32;
        Magnification { start: self.start.map(|share| share.clamp(0.0, most)), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_under_the_mouse_stays_there_while_the_factor_doubles() {
        let mut magnification = Magnification::default();
        for factor in [2, 4, 8, 16, 32, 32] {
            magnification = magnification.stepped(1, [0.75, 0.25]);
            assert_eq!(magnification.factor(), factor);
            let there = magnification.picture_at([0.75, 0.25]);
            assert!((there[0] - 0.75).abs() < 1e-6 && (there[1] - 0.25).abs() < 1e-6, "{there:?}");
        }
        assert_eq!(magnification.stepped(-9, [0.1, 0.9]), Magnification::default(), "all is seen again");
    }

    #[test]
    fn a_drag_takes_the_picture_along_and_not_beyond_its_edge() {
        let whole = Magnification::default();
        assert_eq!(whole.dragged([0.3, -0.3]), whole);
        let twice = whole.by(2, [0.5, 0.5]);
        assert_eq!(twice.picture_at([0.0, 0.0]), [0.25, 0.25]);
        assert_eq!(twice.dragged([0.25, -0.25]).picture_at([0.0, 0.0]), [0.125, 0.375]);
        assert_eq!(twice.dragged([9.0, -9.0]).picture_at([0.0, 0.0]), [0.0, 0.5]);
    }
}
