//! The scale of the screen. On X11 winit takes it from a variable or from resources of the server as it finds it there,
//! and panics at what is no number above 0 or makes a window that no server can hold.

use anyhow::anyhow;
use std::ops::RangeInclusive;
use winit::event_loop::ActiveEventLoop;
use winit::monitor::MonitorHandle;

/// Where winit looks first.
const VARIABLE: &str = "WINIT_X11_SCALE_FACTOR";

/// Scales at which a window still has room and texts can still be read.
const USABLE: RangeInclusive<f64> = 0.25..=8.0;

/// Sees to it that winit finds no scale in the environment that it stumbles over.
///
/// # Errors
/// If there is one, and the program cannot begin again without.
pub fn check_variable() -> anyhow::Result<()> {
    // winit does not see what is not UTF-8
    let Ok(value) = std::env::var(VARIABLE) else { return Ok(()) };
    // what winit takes for something else
    let known = !is_x11() || value.is_empty() || value.eq_ignore_ascii_case("randr");
    if known || value.parse().is_ok_and(is_usable) { Ok(()) } else { fall_back(&format!("{VARIABLE}={value}")) }
}

/// The same of what the server says of its screens.
///
/// # Errors
/// As [`check_variable`].
pub fn check_screens(events: &ActiveEventLoop) -> anyhow::Result<()> {
    let scales = events.available_monitors().map(|screen: MonitorHandle| screen.scale_factor());
    scales.filter(|scale| !is_usable(*scale)).try_for_each(check)
}

/// The same of the scale that a window has.
///
/// # Errors
/// As [`check_variable`].
pub fn check(scale: f64) -> anyhow::Result<()> {
    // nowhere else does the variable help
    if is_usable(scale) || !is_x11() { Ok(()) } else { fall_back(&of_the_screen(scale)) }
}

/// A line on a scale that is not used while the program runs.
pub fn is_ignored(scale: f64) -> String {
    format!("{} is ignored, the window keeps its own: a scale lies {}", of_the_screen(scale), range())
}

fn of_the_screen(scale: f64) -> String {
    format!("the screen's scale {scale:?} (of Xft.dpi, 96 is scale 1)")
}

fn range() -> String {
    format!("from {} to {}", USABLE.start(), USABLE.end())
}

/// NaN lies in no range.
pub fn is_usable(scale: f64) -> bool {
    USABLE.contains(&scale)
}

/// As winit decides it; on a Mac there may be an X server, but it is not asked.
fn is_x11() -> bool {
    let is_set = |name| std::env::var(name).is_ok_and(|value| !value.is_empty());
    let may_be = cfg!(all(unix, not(target_vendor = "apple")));
    may_be && is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") && !is_set("WAYLAND_SOCKET")
}

/// Begins again at scale 1.
fn fall_back(what: &str) -> anyhow::Result<()> {
    note!("note: {what} is ignored, scale 1 is used: a scale lies {}", range());
    #[cfg(unix)]
    let why = crate::environment::begin_again_with(VARIABLE, "1");
    #[cfg(not(unix))]
    let why = "only X11 has such scales";
    Err(anyhow!("cannot begin again at scale 1 ({why}): set {VARIABLE}=1"))
}
