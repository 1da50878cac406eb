//! Large pictures in tiles, so that memory is bounded. A tile is read with so much around it that each pixel within sees
//! all that it would see in the whole picture: no seam, to the last bit.

use crate::network::ALIGNMENT;
use std::ops::Range;

/// How far a pixel sees, rounded up to a multiple of [`ALIGNMENT`]: 87 pixels to each side (16 convolutions, of which
/// those of lower levels reach further).
const OVERLAP: usize = 96;

/// Pixels that are in memory at once, those around a tile included.
pub const MOST_PIXELS: usize = 1 << 20;

/// A part of a picture whose sides are multiples of [`ALIGNMENT`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tile {
    /// Columns and rows that are read.
    pub read: [Range<usize>; 2],
    /// Columns and rows that are written, within them.
    pub written: [Range<usize>; 2],
}

impl Tile {
    /// Columns and rows that are read.
    pub fn size(&self) -> [usize; 2] {
        [self.read[0].len(), self.read[1].len()]
    }
}

/// Tiles that cover a picture of this size and are read in at most `most_pixels`, if that is enough for any tile.
pub fn tiles([width, height]: [usize; 2], most_pixels: usize) -> Vec<Tile> {
    let sides = [width, height].map(|side| side.next_multiple_of(ALIGNMENT));
    let mut counts = [1, 1];
    let read = |axis: usize, count: usize| {
        let around = if count == 1 { 0 } else { 2 * OVERLAP };
        (part(sides[axis], count) + around).min(sides[axis])
    };
    while read(0, counts[0]) * read(1, counts[1]) > most_pixels {
        // the longer side, as long as that makes it shorter
        let longer = usize::from(read(1, counts[1]) > read(0, counts[0]));
        if part(sides[longer], counts[longer]) == ALIGNMENT {
            break;
        }
        counts[longer] += 1;
    }
    let spans = |axis: usize| {
        let part = part(sides[axis], counts[axis]);
        (0..sides[axis]).step_by(part).map(move |start| {
            let written = start..(start + part).min(sides[axis]);
            (written.start.saturating_sub(OVERLAP)..(written.end + OVERLAP).min(sides[axis]), written)
        })
    };
    spans(1)
        .flat_map(|(rows, written_rows)| {
            spans(0).map(move |(columns, written)| Tile {
                read: [columns, rows.clone()],
                written: [written, written_rows.clone()],
            })
        })
        .collect()
}

/// The side of one of `count` parts.
fn part(side: usize, count: usize) -> usize {
    side.div_ceil(count).next_multiple_of(ALIGNMENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_that_fits_is_one_tile() {
        let whole = Tile { read: [0..640, 0..368], written: [0..640, 0..368] };
        assert_eq!(tiles([640, 360], MOST_PIXELS), [whole]);
        assert_eq!(tiles([1, 1], MOST_PIXELS)[0].size(), [16, 16]);
    }

    #[test]
    fn every_pixel_is_written_once_and_memory_is_bounded() {
        for size in [[4096, 2160], [1920, 1080], [1, 5000], [777, 3111]] {
            let tiles = tiles(size, MOST_PIXELS);
            let most = tiles.iter().map(|tile| tile.size()[0] * tile.size()[1]).max();
            assert!(most.unwrap() <= MOST_PIXELS, "{size:?}: {most:?}");
            let area = |tile: &Tile| tile.written[0].len() * tile.written[1].len();
            let sides = size.map(|side| side.next_multiple_of(ALIGNMENT));
            assert_eq!(tiles.iter().map(area).sum::<usize>(), sides[0] * sides[1], "{size:?}");
        }
    }
}
