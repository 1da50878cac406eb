//! Pictures of a sweep as window and command line make them: one tile after the other, how far each is from the
//! reference, and all of them with their captions as one picture.

mod sheet;
mod tile;

pub use sheet::{COLUMNS, Sheet, SheetError};
pub use tile::{Asked, Devices, Onlooker, Tile, TileMaker, measure};
