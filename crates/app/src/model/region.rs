//! A part of the pictures, of which figures and plots speak.

use compare::PixelRect;

/// A rectangle in shares of a picture's width and height, from its upper left corner: pictures of other sizes have it too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// Its left and its upper edge.
    pub start: [f32; 2],
    /// Its right and its lower edge.
    pub end: [f32; 2],
}

/// The least width and height that keys leave of one.
const LEAST: f32 = 1.0 / 256.0;

/// After a figure that is of the region alone.
pub const IN_THE_REGION: &str = "in the region";

impl Region {
    /// The rectangle between two corners, as far as it lies in the picture; `None` if that is nothing.
    pub fn between(a: [f32; 2], b: [f32; 2]) -> Option<Self> {
        let share = |of: fn(f32, f32) -> f32, axis: usize| of(a[axis], b[axis]).clamp(0.0, 1.0);
        let start = [share(f32::min, 0), share(f32::min, 1)];
        let end = [share(f32::max, 0), share(f32::max, 1)];
        (start[0] < end[0] && start[1] < end[1]).then_some(Region { start, end })
    }

    /// The pixels that it touches of a picture of `width` by `height`: one at least.
    pub fn pixels(&self, (width, height): (u32, u32)) -> PixelRect {
        let along = |axis: usize, side: u32| {
            let first = ((self.start[axis] * side as f32) as u32).min(side.saturating_sub(1));
            (first, ((self.end[axis] * side as f32).ceil() as u32).clamp(first + 1, side.max(1)))
        };
        let (columns, rows) = (along(0, width), along(1, height));
        PixelRect { start: (columns.0, rows.0), end: (columns.1, rows.1) }
    }

    /// The same rectangle elsewhere, within the picture.
    pub fn moved(self, by: [f32; 2]) -> Self {
        let by = [0, 1].map(|axis| by[axis].clamp(-self.start[axis], 1.0 - self.end[axis]));
        let along = |edge: [f32; 2]| [edge[0] + by[0], edge[1] + by[1]];
        Region { start: along(self.start), end: along(self.end) }
    }

    /// With its right and its lower edge farther off, within the picture and never so near that nothing is left.
    pub fn enlarged(self, by: [f32; 2]) -> Self {
        let end = [0, 1].map(|axis| (self.end[axis] + by[axis]).clamp((self.start[axis] + LEAST).min(1.0), 1.0));
        Region { end, ..self }
    }

    /// As files keep it: left, top, right and bottom, in shares of the picture.
    pub fn record(&self) -> String {
        let ([left, top], [right, bottom]) = (self.start, self.end);
        format!("{left} {top} {right} {bottom}")
    }

    /// The region of such a record.
    pub fn recorded(text: &str) -> Option<Self> {
        let numbers: Option<Vec<f32>> = text.split_whitespace().map(|number| number.parse().ok()).collect();
        let [left, top, right, bottom] = numbers?.try_into().ok()?;
        Region::between([left, top], [right, bottom])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_lies_between_its_corners_in_whatever_order_and_within_the_picture() {
        let region = Region::between([0.75, -1.0], [0.25, 0.5]);
        assert_eq!(region, Some(Region { start: [0.25, 0.0], end: [0.75, 0.5] }));
        assert_eq!(Region::between([0.5, 0.2], [0.5, 0.8]), None, "a line");
        assert_eq!(Region::between([1.1, 0.2], [1.5, 0.8]), None, "beside the picture");
    }

    #[test]
    fn it_takes_the_pixels_that_it_touches_and_one_at_least() {
        let region = Region { start: [0.25, 0.5], end: [0.75, 1.0] };
        let rect = |start, end| PixelRect { start, end };
        assert_eq!(region.pixels((8, 4)), rect((2, 2), (6, 4)));
        assert_eq!(region.pixels((3, 3)), rect((0, 1), (3, 3)));
        let small = Region { start: [0.999, 0.999], end: [0.9999, 1.0] };
        assert_eq!(small.pixels((2, 2)), rect((1, 1), (2, 2)));
        assert_eq!(small.pixels((1, 1)), rect((0, 0), (1, 1)));
    }

    #[test]
    fn moved_and_enlarged_it_stays_within_the_picture_and_something_is_left_of_it() {
        let region = Region { start: [0.25, 0.5], end: [0.75, 0.75] };
        assert_eq!(region.moved([-0.125, 0.125]), Region { start: [0.125, 0.625], end: [0.625, 0.875] });
        assert_eq!(region.moved([-9.0, 9.0]), Region { start: [0.0, 0.75], end: [0.5, 1.0] });
        assert_eq!(region.enlarged([0.125, 9.0]).end, [0.875, 1.0]);
        assert_eq!(region.enlarged([-9.0, 0.0]).end, [0.25 + LEAST, 0.75]);
    }

    #[test]
    fn a_record_gives_it_back() {
        let region = Region { start: [0.1, 0.2], end: [0.7, 1.0 / 3.0] };
        assert_eq!(Region::recorded(&region.record()), Some(region));
        for text in ["", "0 0 1", "0 0 1 x", "NaN 0 1 1", "0 0 1 1 1"] {
            assert_eq!(Region::recorded(text), None, "{text}");
        }
    }
}
