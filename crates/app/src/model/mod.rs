//! What the window is about, as plain values: no egui, no threads, no window. Below `ui`, `engine` and `window`, which
//! meet only here.

mod theme;
mod view_args;

pub use theme::Theme;
pub use view_args::ViewArgs;
