//! The film that every technique fills, the [`Image`] that display, files and ruler read of it, and the one [`display`]
//! transform that every picture goes through. Linear RGB radiance (Rec. 709 primaries), rows from the top.

pub mod colour;
pub mod display;
mod features;
mod film;
mod image;

pub use display::DisplayTransform;
pub use features::{Feature, Features};
pub use film::{Film, Pixel};
pub use glam::{self, Vec3};
pub use image::{Image, Layer, LayerValues};
