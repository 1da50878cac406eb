//! Support for tests: a virtual screen with real X events, the viewer in it, and folders that clean up after
//! themselves.

pub mod films;
mod folder;
mod pictures;
mod screen;
mod viewer;

pub use folder::TestFolder;
pub use pictures::place_of;
pub use screen::Screen;
pub use viewer::{Frame, ViewerUnderTest};
