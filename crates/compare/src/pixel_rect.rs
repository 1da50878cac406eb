//! A rectangle of a picture's pixels, of which figures speak instead of the whole.

/// Pixels from a first column and row to before an end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelRect {
    /// The first column and row.
    pub start: (u32, u32),
    /// The column and row behind the last.
    pub end: (u32, u32),
}

impl PixelRect {
    /// How many columns and rows it has.
    pub fn size(&self) -> (u32, u32) {
        (self.end.0.saturating_sub(self.start.0), self.end.1.saturating_sub(self.start.1))
    }

    /// What lies in it of a picture's values, one a pixel in rows of `width` from the top.
    pub fn of<'a, T>(&self, values: &'a [T], width: u32) -> impl Iterator<Item = &'a T> {
        let rows = values.chunks_exact(width.max(1) as usize);
        let (first, columns) = (self.start.0 as usize, self.size().0 as usize);
        rows.skip(self.start.1 as usize).take(self.size().1 as usize).flat_map(move |row| {
            let row = row.get(first..).unwrap_or_default();
            &row[..columns.min(row.len())]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_takes_its_rows_and_nothing_beyond_the_picture() {
        let values: Vec<u32> = (0..12).collect();
        let taken = |start, end| PixelRect { start, end }.of(&values, 4).copied().collect::<Vec<_>>();
        assert_eq!(taken((1, 1), (3, 3)), [5, 6, 9, 10]);
        assert_eq!(taken((0, 0), (4, 3)), values);
        assert_eq!(taken((3, 2), (9, 9)), [11]);
        assert!(taken((4, 0), (5, 1)).is_empty() && taken((2, 1), (1, 0)).is_empty());
    }
}
