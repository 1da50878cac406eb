//! The app around the viewer: one winit window, one egui context, one wgpu device that the window and the fake share.

mod app;
mod frame_stats;
mod recovery;
mod scale_factor;
mod surface;
mod textures;
mod window_state;

use crate::model::ViewArgs;
use anyhow::Context;
use egui_winit::accesskit_winit;
use scene::builtin;
use winit::event_loop::EventLoop;

/// Something happened beside the UI thread that it should look at.
#[derive(Debug)]
pub enum UserEvent {
    /// A worker has something.
    PaneUpdate,
    /// A screen reader wants something.
    Accessibility(accesskit_winit::Event),
}

impl From<accesskit_winit::Event> for UserEvent {
    fn from(event: accesskit_winit::Event) -> Self {
        UserEvent::Accessibility(event)
    }
}

/// Opens the viewer and returns when it is closed.
///
/// # Errors
/// If the scene does not load, if there is no display, or if no adapter can draw the window.
pub fn open(args: &ViewArgs) -> anyhow::Result<()> {
    let started = std::time::Instant::now();
    let scene = builtin::named(&args.scene)?;
    scale_factor::check_variable()?;
    let events = EventLoop::<UserEvent>::with_user_event().build().map_err(|e| {
        anyhow::anyhow!(
            "no window can be opened here ({e}); without a display, use: visavis render {} -o out.png",
            args.scene
        )
    })?;
    let mut app = app::App::new(scene, args.clone(), events.create_proxy(), started);
    events.run_app(&mut app).context("the window stopped")?;
    app.outcome()
}
