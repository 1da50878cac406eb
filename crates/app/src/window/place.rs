//! Size and place of the window: as it was left, as far as the screens of today have room for it.

use crate::model::WindowPlace;
use winit::dpi::{LogicalSize, PhysicalPosition};
use winit::event_loop::ActiveEventLoop;
use winit::monitor::MonitorHandle;
use winit::window::{Window, WindowAttributes};

/// A window of the size that a session asks for, if it does, where the last one was.
pub fn of_size(size: Option<[f64; 2]>, remembered: Option<WindowPlace>) -> Option<WindowPlace> {
    let at = remembered.and_then(|place| place.at);
    size.map(|size| WindowPlace { size, at, maximised: false }).or(remembered)
}

/// Width and height in points where nothing is remembered.
const USUAL: [f64; 2] = [1280.0, 720.0];

/// The smallest window in points.
const LEAST: [f64; 2] = [480.0, 320.0];

/// Pixels of a window's upper edge that must be on a screen for a mouse to take it by.
const GRIP: i32 = 64;

/// A screen's part of the plane of all screens, in pixels, and its scale.
#[derive(Debug, Clone, Copy)]
struct Screen {
    corner: [i32; 2],
    size: [u32; 2],
    scale: f64,
}

impl Screen {
    fn of(monitor: &MonitorHandle) -> Self {
        let (corner, size) = (monitor.position(), monitor.size());
        Screen { corner: [corner.x, corner.y], size: [size.width, size.height], scale: monitor.scale_factor() }
    }

    fn room(&self) -> [f64; 2] {
        self.size.map(|pixels| f64::from(pixels) / self.scale)
    }

    /// Whether a window whose upper left corner lies here can be taken hold of.
    fn holds(&self, [x, y]: [i32; 2]) -> bool {
        let [left, top] = self.corner;
        let [right, bottom] = [0, 1].map(|axis| self.corner[axis].saturating_add_unsigned(self.size[axis]));
        // a window manager's frame may reach a little beyond the edge
        let beyond = GRIP / 2;
        x >= left - beyond && x + GRIP <= right && y >= top - beyond && y + GRIP <= bottom
    }
}

/// Attributes of a window where the last one was.
pub fn attributes(events: &ActiveEventLoop, remembered: Option<WindowPlace>) -> WindowAttributes {
    let screens: Vec<Screen> = events.available_monitors().map(|monitor| Screen::of(&monitor)).collect();
    let first = events.primary_monitor().map(|monitor| Screen::of(&monitor)).or_else(|| screens.first().copied());
    let (size, at) = fitting(remembered, &screens, first);
    let attributes = Window::default_attributes()
        .with_inner_size(LogicalSize::new(size[0], size[1]))
        .with_min_inner_size(LogicalSize::new(LEAST[0], LEAST[1]))
        .with_maximized(remembered.is_some_and(|place| place.maximised));
    match at {
        Some([x, y]) => attributes.with_position(PhysicalPosition::new(x, y)),
        None => attributes,
    }
}

/// Size in points, and place in pixels where it is one on these screens.
fn fitting(remembered: Option<WindowPlace>, screens: &[Screen], first: Option<Screen>) -> ([f64; 2], Option<[i32; 2]>) {
    let held = |at: [i32; 2]| screens.iter().copied().find(|screen| screen.holds(at));
    let found = remembered.and_then(|place| place.at).and_then(|at| Some((at, held(at)?)));
    let wished = remembered.map_or(USUAL, |place| [0, 1].map(|axis| place.size[axis].max(LEAST[axis])));
    let screen = found.map(|(_, screen)| screen).or(first);
    let room = screen.map_or(wished, |screen| screen.room());
    ([0, 1].map(|axis| wished[axis].min(room[axis])), found.map(|(at, _)| at))
}

/// Where a window is. One that fills its screen comes back to the size that is remembered of `before`, else to the usual one.
pub fn of(window: &Window, before: Option<WindowPlace>) -> WindowPlace {
    let size = window.inner_size().to_logical::<f64>(window.scale_factor());
    let at = window.outer_position().ok().map(|at| [at.x, at.y]);
    let here = WindowPlace { size: [size.width, size.height], at, maximised: window.is_maximized() };
    let is_whole = here.maximised || window.fullscreen().is_some();
    if is_whole { before_it_was_whole(here.maximised, before) } else { here }
}

/// Where a window that fills its screen comes back to: nobody has chosen the screen's size for it.
fn before_it_was_whole(maximised: bool, before: Option<WindowPlace>) -> WindowPlace {
    WindowPlace { maximised, ..before.unwrap_or(WindowPlace { size: USUAL, at: None, maximised }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_session_gives_a_window_its_size_and_no_place() {
        let before = WindowPlace { size: [900.0, 600.0], at: Some([100, 50]), maximised: true };
        let asked = WindowPlace { size: [1000.0, 700.0], maximised: false, ..before };
        assert_eq!(of_size(Some([1000.0, 700.0]), Some(before)), Some(asked));
        assert_eq!((of_size(None, Some(before)), of_size(None, None)), (Some(before), None));
        assert_eq!(of_size(Some([1.0, 2.0]), None).map(|place| place.at), Some(None));
    }

    #[test]
    fn a_screens_size_is_not_remembered_as_a_windows() {
        let before = WindowPlace { size: [900.0, 600.0], at: Some([100, 50]), maximised: false };
        assert_eq!(before_it_was_whole(true, Some(before)), WindowPlace { maximised: true, ..before });
        let first = WindowPlace { size: USUAL, at: None, maximised: false };
        assert_eq!(before_it_was_whole(false, None), first);
    }

    #[test]
    fn a_window_comes_back_where_it_was_and_never_off_the_screens() {
        let main = Screen { corner: [0, 0], size: [1920, 1080], scale: 1.0 };
        let right = Screen { corner: [1920, 0], size: [1000, 800], scale: 2.0 };
        let place = |at, size| Some(WindowPlace { size, at, maximised: false });
        let fit = |remembered, screens: &[Screen]| fitting(remembered, screens, screens.first().copied());
        assert_eq!(fit(None, &[main]), (USUAL, None));
        assert_eq!(fit(None, &[right]), ([500.0, 400.0], None), "as far as there is room");
        assert_eq!(fit(None, &[]), (USUAL, None));
        let there = place(Some([100, 50]), [900.0, 600.0]);
        assert_eq!(fit(there, &[main, right]), ([900.0, 600.0], Some([100, 50])));
        let beside = place(Some([2000, 10]), [900.0, 600.0]);
        assert_eq!(fit(beside, &[main, right]), ([500.0, 400.0], Some([2000, 10])), "in its screen's points");
        assert_eq!(fit(beside, &[main]), ([900.0, 600.0], None), "the screen is gone");
        for at in [[-500, 0], [0, -500], [1900, 0], [0, 1079], [i32::MIN, 0], [i32::MAX - 64, 0]] {
            assert_eq!(fit(place(Some(at), [900.0, 600.0]), &[main]).1, None, "{at:?}");
        }
        assert_eq!(fit(place(None, [1.0, 9000.0]), &[main]).0, [480.0, 1080.0]);
    }
}
