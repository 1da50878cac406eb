//! The app around the viewer: one winit window, one egui context, one wgpu device that the window and the fake share.

mod app;
mod canvas;
mod dialogue;
mod frame_stats;
mod icon;
mod place;
mod recovery;
mod scale_factor;
mod surface;
mod textures;
mod waiting;
mod window_state;

use crate::engine::beginning::Reading;
use crate::engine::load::WORTH_A_WORD;
use crate::model::ViewArgs;
use anyhow::{Context, bail};
use egui_winit::accesskit_winit;
use std::time::Duration;
use winit::event_loop::EventLoop;

/// How long a scene's fault is waited for where there is no display: it goes first.
const FAULTS_FIRST: Duration = Duration::from_secs(5);

/// Something happened beside the UI thread that it should look at.
#[derive(Debug)]
pub enum UserEvent {
    /// A worker has something.
    PaneUpdate,
    /// The system asks the program to end.
    Ended,
    /// A screen reader wants something.
    Accessibility(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for UserEvent {
    fn from(event: accesskit_winit::Event) -> Self {
        UserEvent::Accessibility(event)
    }
}

/// Opens the viewer and returns when it is closed. A scene that takes long is read while the window is open already. Who asks the program to end calls what `heed` is given, and is heeded as
/// long as lives what it returns.
///
/// # Errors
/// If the scene does not load, if there is no display, or if no adapter can draw the window.
pub fn open<Heeded>(args: &ViewArgs, heed: impl FnOnce(Box<dyn Fn() + Send>) -> Heeded) -> anyhow::Result<()> {
    let started = std::time::Instant::now();
    let mut reading = Reading::begin(&args.scene);
    // what is broken is mostly known by then, and needs no window to be told
    let first = reading.within(WORTH_A_WORD).transpose()?;
    scale_factor::check_variable()?;
    let events = match EventLoop::<UserEvent>::with_user_event().build() {
        Ok(events) => events,
        Err(fault) => {
            let first = first.or(reading.within(FAULTS_FIRST).transpose()?);
            let scene = first.map_or(args.scene.clone(), |beginning| beginning.opened.source);
            bail!(
                "no window can be opened here ({}); without a display, use: visavis render {scene} -o out.png",
                cause(&fault)
            );
        }
    };
    let proxy = events.create_proxy();
    let _heeded = heed(Box::new(move || {
        // a window that is closed has ended
        let _ = proxy.send_event(UserEvent::Ended);
    }));
    let mut app = app::App::new(first.ok_or(reading), args.clone(), events.create_proxy(), started);
    events.run_app(&mut app).context("the window stopped")?;
    app.outcome()
}

/// Why the system refuses, without the line of winit's source that begins its errors.
fn cause(fault: &impl std::fmt::Display) -> String {
    let text = fault.to_string();
    let behind = text.strip_prefix("os error at ").and_then(|place| place.split_once(": "));
    behind.map_or(text.clone(), |(_, cause)| cause.to_owned())
}

#[cfg(test)]
mod tests {
    use super::cause;

    #[test]
    fn the_cause_is_told_without_the_source_that_tells_it() {
        assert_eq!(cause(&"os error at /a/b c/mod.rs:765: no display: none"), "no display: none");
        assert_eq!(cause(&"not supported"), "not supported");
    }
}
