//! Small glTF models, written and rendered.

mod known;
mod model;
mod pictures;

pub use known::*;
pub use model::{Model, bytes_of, matt, turned};
pub use pictures::Technique;
