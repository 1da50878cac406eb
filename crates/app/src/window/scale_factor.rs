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
    let Some(value) = std::env::var_os(VARIABLE).filter(|_| cfg!(unix) && is_x11()) else { return Ok(()) };
    let value = value.to_string_lossy();
    // what winit takes for something else, or does not see
    let known = value.is_empty() || value.eq_ignore_ascii_case("randr") || value.contains(char::REPLACEMENT_CHARACTER);
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

/// The same of a scale that has changed.
///
/// # Errors
/// As [`check_variable`].
pub fn check(scale: f64) -> anyhow::Result<()> {
    if is_usable(scale) {
        Ok(())
    } else {
        fall_back(&format!("the screen's scale {scale:?} (of Xft.dpi, 96 is scale 1)"))
    }
}

/// NaN lies in no range.
fn is_usable(scale: f64) -> bool {
    USABLE.contains(&scale)
}

/// As winit decides it.
fn is_x11() -> bool {
    let is_set = |name| std::env::var(name).is_ok_and(|value| !value.is_empty());
    is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") && !is_set("WAYLAND_SOCKET")
}

/// Begins again at scale 1.
fn fall_back(what: &str) -> anyhow::Result<()> {
    let range = format!("from {} to {}", USABLE.start(), USABLE.end());
    note!("note: {what} is ignored, scale 1 is used: a scale lies {range}");
    #[cfg(unix)]
    let why = crate::environment::begin_again_with(VARIABLE, "1");
    #[cfg(not(unix))]
    let why = "only X11 has such scales";
    Err(anyhow!("cannot begin again at scale 1 ({why}): set {VARIABLE}=1"))
}
