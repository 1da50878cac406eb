//! All tiles with their captions as one picture: every tile pixel for pixel as it was made, and text that can be read from the
//! last row of seats.

use super::tile::Tile;
use crate::lettering::{Canvas, Lettering, Type};
use crate::model::{SweepMeasure, SweepPlan, TileFacts, best, captions};
use film::DisplayTransform;
use image_file::{ImageFileError, MOST_PIXELS, Records};
use std::sync::Arc;
use technique::Shot;

/// The tiles and what is said of them.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// What is varied along rows and columns.
    pub plan: SweepPlan,
    /// In the order of the plan; `None` of one that could not be made.
    pub tiles: Vec<Option<Arc<Tile>>>,
    /// What is known of each.
    pub facts: Vec<TileFacts>,
    /// The error that captions tell.
    pub measure: SweepMeasure,
    /// How all are shown.
    pub display: DisplayTransform,
}

/// Why there is no such picture.
#[derive(Debug)]
pub enum SheetError {
    /// It would have more pixels than a picture may have: width and height.
    TooLarge(u32, u32),
    /// It cannot be encoded.
    File(ImageFileError),
}

impl std::fmt::Display for SheetError {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            SheetError::TooLarge(width, height) => {
                write!(
                    f,
                    "all tiles together are {width}x{height} pixels, more than {MOST_PIXELS}: make them smaller, or fewer"
                )
            }
            SheetError::File(fault) => fault.fmt(f),
        }
    }
}

impl std::error::Error for SheetError {}

/// Size of the type as a share of the height of a screen of 16 : 9 that the picture fills; at half of that it can still be read.
const TYPE: f32 = 1.0 / 36.0;

/// The smallest type of a caption, as a share of that.
const SMALLEST: f32 = 0.5;

/// Width over height of that screen.
const SCREEN: f32 = 16.0 / 9.0;

/// Height of a line in sizes of its type.
const ROW: f32 = 1.25;

/// Above and below a caption, in lines.
const MARGIN: f32 = 0.25;

/// Ground, text that is read first, text that is read second, and what marks the best.
const GROUND: [u8; 3] = [0x14, 0x16, 0x1a];
const TEXT: [u8; 3] = [0xe8, 0xea, 0xee];
const DIM: [u8; 3] = [0xb4, 0xbc, 0xc8];
const BEST: [u8; 3] = [0x6e, 0xe7, 0xc8];

/// The record of what is varied from column to column, which tells a sweep from other pictures.
pub const COLUMNS: &str = "columns";

/// Names of the records that say how tiles are made.
const RECORDS: [&str; crate::model::MOST_TILES] = [
    "tile 1", "tile 2", "tile 3", "tile 4", "tile 5", "tile 6", "tile 7", "tile 8", "tile 9", "tile 10", "tile 11",
    "tile 12", "tile 13", "tile 14", "tile 15", "tile 16",
];

/// Where things are, in pixels.
struct Layout {
    columns: u32,
    /// Width and height of a tile.
    size: (u32, u32),
    gap: u32,
    /// Size of the type.
    letters: f32,
    /// Height of a caption.
    caption: u32,
    whole: (u32, u32),
}

impl Layout {
    /// One that has room in a picture.
    fn checked(plan: &SweepPlan, size: (u32, u32), lines: usize) -> Result<Self, SheetError> {
        let layout = Layout::of(plan, size, lines);
        let (width, height) = layout.whole;
        if u64::from(width) * u64::from(height) > MOST_PIXELS {
            return Err(SheetError::TooLarge(width, height));
        }
        Ok(layout)
    }

    fn of(plan: &SweepPlan, size: (u32, u32), lines: usize) -> Self {
        let columns = columns_of(plan);
        let rows = (plan.tiles.len() as u32).div_ceil(columns);
        // and what is left above and below
        let lines = lines as f32 + 2.0 * MARGIN;
        let gap = (size.0.min(size.1) / 24).max(4);
        let (width, pictures) = (columns * size.0 + (columns + 1) * gap, rows * size.1 + (rows + 1) * gap);
        // captions are a part of the height that their letters are a share of
        let by_height = pictures as f32 * TYPE / (1.0 - rows as f32 * lines * ROW * TYPE).max(0.2);
        let letters = by_height.max(width as f32 / SCREEN * TYPE).max(10.0).ceil();
        let caption = (lines * ROW * letters).ceil() as u32;
        Layout {
            columns,
            size,
            gap,
            letters,
            caption,
            whole: (width, pictures.saturating_add(rows.saturating_mul(caption))),
        }
    }

    /// Left upper corner of a tile.
    fn corner(&self, index: usize) -> (u32, u32) {
        let (column, row) = (index as u32 % self.columns, index as u32 / self.columns);
        (self.gap + column * (self.size.0 + self.gap), self.gap + row * (self.size.1 + self.caption + self.gap))
    }
}

/// Tiles in a row: those of a matrix as it is; a long strip goes on below.
fn columns_of(plan: &SweepPlan) -> u32 {
    let count = plan.columns.values.len() as u32;
    if plan.rows.is_none() && count > LONG { count.div_ceil(2) } else { count }
}

/// A strip of more tiles is in two rows.
const LONG: u32 = 5;

impl Sheet {
    /// Whether tiles of what is seen will make one picture with what stands below them.
    ///
    /// # Errors
    /// [`SheetError::TooLarge`] of more pixels than a picture may have.
    pub fn check_size(plan: &SweepPlan, shot: &Shot, with_errors: bool) -> Result<(), SheetError> {
        let names = plan.tiles.first().map_or(0, |tile| tile.names.len());
        let more = usize::from(with_errors) + usize::from(!shot.changes.edits.is_empty());
        Layout::checked(plan, shot.size, names + 1 + more).map(|_| ())
    }

    /// The whole as a picture.
    ///
    /// # Errors
    /// [`SheetError::TooLarge`], before memory is taken for it.
    pub fn canvas(&self) -> Result<Canvas, SheetError> {
        let shown = |tile: &&Arc<Tile>| tile.facts.has_a_picture();
        let size = self.tiles.iter().flatten().find(shown).map_or((320, 180), |tile| tile.image.size());
        let captions = captions(&self.plan, &self.facts, self.measure);
        let lines = captions.iter().map(Vec::len).max().unwrap_or_default();
        let layout = Layout::checked(&self.plan, size, lines)?;
        let mut canvas = Canvas::filled(layout.whole, GROUND);
        let mut lettering = Lettering::default();
        let letters = fitting(&mut lettering, captions.iter().flatten(), (layout.letters, size.0));
        let best = best(&self.facts, self.measure);
        for (index, (tile, caption)) in self.tiles.iter().zip(&captions).enumerate() {
            let best = best.contains(&index);
            if best {
                mark(&mut canvas, &layout, index);
            }
            if let Some(tile) = tile.as_ref().filter(shown) {
                canvas.place(layout.corner(index), (size.0, &self.display.rgba8_of(&tile.image)));
            }
            letter(&mut canvas, (&mut lettering, letters), &layout, (index, caption, best));
        }
        Ok(canvas)
    }

    /// The bytes of a PNG that keeps how each tile is made.
    ///
    /// # Errors
    /// [`SheetError`]: it is too large, or not to be encoded.
    pub fn png(&self, more: Records) -> Result<Vec<u8>, SheetError> {
        let canvas = self.canvas()?;
        let records: Records = self.records().into_iter().chain(more).collect();
        image_file::encode_rgba8(canvas.size.0, canvas.size.1, &canvas.rgba(), &records).map_err(SheetError::File)
    }

    /// Scene, camera and changes, which are the same of all tiles.
    fn records_of_the_view(&self) -> Records {
        let Some(tile) = self.tiles.iter().flatten().next() else { return Vec::new() };
        let shot = &tile.provenance.shot;
        let mut records = vec![("scene", shot.source.clone()), shot.hash_record()];
        records.extend(shot.camera_options(&shot.camera).into_iter().chain(shot.changes.options()));
        records.push(("exposure", self.display.exposure.to_string()));
        records
    }

    /// What is varied, and for each tile the command that makes it.
    pub fn records(&self) -> Records {
        let SweepPlan { columns, rows, seconds, .. } = &self.plan;
        let line = |line: &crate::model::SweepLine| format!("{}: {}", line.setting, line.values.join(", "));
        let mut records = vec![("version", env!("CARGO_PKG_VERSION").to_owned()), (COLUMNS, line(columns))];
        records.extend(self.records_of_the_view());
        records.extend(rows.iter().map(|rows| ("rows", line(rows))));
        let equal =
            seconds.map_or_else(|| "samples".into(), |seconds| format!("time: {seconds} s of rendering a tile"));
        records.push(("equal", equal));
        let shown = |tile: &&Arc<Tile>| tile.facts.has_a_picture();
        let commands = RECORDS.into_iter().zip(&self.tiles);
        let exposure = self.display.exposure;
        records
            .extend(commands.filter_map(|(name, tile)| Some((name, tile.as_ref().filter(shown)?.command(exposure)))));
        records
    }
}

/// A frame about a tile.
fn mark(canvas: &mut Canvas, layout: &Layout, index: usize) {
    let (left, top) = layout.corner(index);
    let wide = (layout.gap / 3).max(2);
    let corner = (i64::from(left) - i64::from(wide), i64::from(top) - i64::from(wide));
    canvas.fill(corner, (layout.size.0 + 2 * wide, layout.size.1 + 2 * wide), BEST);
}

/// The size of type at which the longest line fits below a tile of this width, if that can still be read.
fn fitting<'a>(lettering: &mut Lettering, lines: impl Iterator<Item = &'a String>, (size, room): (f32, u32)) -> f32 {
    let look = Type { size, semi_bold: true, colour: TEXT };
    let longest = lines.map(|line| lettering.lay_out(line, look, u32::MAX, 1).rect.width()).fold(1.0, f32::max);
    size * (0.98 * room as f32 / longest).clamp(SMALLEST, 1.0)
}

fn letter(
    canvas: &mut Canvas,
    (lettering, letters): (&mut Lettering, f32),
    layout: &Layout,
    (index, caption, best): (usize, &[String], bool),
) {
    let (left, top) = layout.corner(index);
    let row = ROW * layout.letters;
    let top = (top + layout.size.1) as f32 + MARGIN * row;
    for (number, text) in caption.iter().enumerate() {
        let colour = match number {
            0 => TEXT,
            last if best && last + 1 == caption.len() => BEST,
            _ => DIM,
        };
        let look = Type { size: letters, semi_bold: number == 0, colour };
        let line = lettering.lay_out(text, look, layout.size.0, 1);
        lettering.draw(canvas, &line, (left, (top + number as f32 * row).round() as u32), colour);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Axis;
    use technique::{PaneSettings, TechniqueName};

    fn plan(columns: &str, rows: Option<&str>) -> SweepPlan {
        let rows = rows.map_or_else(Axis::default, |values| Axis::new("seed", values));
        SweepPlan::of(&PaneSettings::of(TechniqueName::Path), [&Axis::new("spp", columns), &rows], None).unwrap()
    }

    #[test]
    fn a_long_line_below_a_narrow_tile_is_in_smaller_type_and_none_becomes_larger() {
        let mut lettering = Lettering::default();
        let long = "roulette P 0.8 and throughput".to_owned();
        let look = |size| Type { size, semi_bold: true, colour: TEXT };
        assert!(lettering.lay_out(&long, look(24.0), 320, 1).elided);
        let letters = fitting(&mut lettering, [&long, &"4 spp".to_owned()].into_iter(), (24.0, 320));
        assert!(!lettering.lay_out(&long, look(letters), 320, 1).elided && letters > 12.0, "{letters}");
        assert_eq!(fitting(&mut lettering, std::iter::once(&"4 spp".to_owned()), (24.0, 320)), 24.0);
        assert_eq!(fitting(&mut lettering, std::iter::once(&"m".repeat(200)), (24.0, 320)), 12.0);
    }

    /// On a screen that the whole fills, in either direction, letters are at least a fortieth of the height; of more rows than
    /// five captions alone would be higher than that.
    #[test]
    fn letters_are_read_however_many_tiles_there_are_and_none_lies_over_another() {
        let plans = [
            ("1,2", None),
            ("1,2,3,4,5", None),
            ("1,2,3,4,5,6,7,8", None),
            ("1,2,3,4", Some("1,2,3,4")),
            ("1,2", Some("1,2,3,4,5,6,7,8")),
        ];
        for (columns, rows) in plans {
            for size in [(320, 320), (1280, 720), (48, 36)] {
                let plan = plan(columns, rows);
                let layout = Layout::of(&plan, size, 4);
                let (width, height) = (layout.whole.0 as f32, layout.whole.1 as f32);
                let many = rows.is_some_and(|rows| rows.len() > 10);
                assert!(many || layout.letters >= height.max(width / SCREEN) / 40.0, "{columns} {rows:?} {size:?}");
                let corners: Vec<_> = (0..plan.tiles.len()).map(|index| layout.corner(index)).collect();
                for (left, top) in &corners {
                    assert!(left + size.0 + layout.gap <= layout.whole.0);
                    assert!(top + size.1 + layout.caption + layout.gap <= layout.whole.1);
                    let beside = |(x, y): &(u32, u32)| {
                        x.abs_diff(*left) >= size.0 || y.abs_diff(*top) >= size.1 + layout.caption
                    };
                    assert!(corners.iter().filter(|other| !beside(other)).count() == 1, "{columns} {rows:?} {size:?}");
                }
            }
        }
    }
}
