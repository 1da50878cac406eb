//! The app around the viewer: one winit window, one egui context, one wgpu device that the window and the fake share.

mod app;
mod dialogue;
mod frame_stats;
mod icon;
mod place;
mod recovery;
mod scale_factor;
mod surface;
mod textures;
mod window_state;

use crate::engine::load::{self, Loaded};
use crate::model::ViewArgs;
use anyhow::{Context, bail};
use egui_winit::accesskit_winit;
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
    let opened = match load::read(&args.scene) {
        Ok(Loaded::Scene(opened)) => *opened,
        Ok(Loaded::Reference(file)) => bail!(
            "this picture does not say how it was made; open its scene and compare with it there: {}",
            image_file::shown(&file)
        ),
        Err(refusal) => bail!("{}", refusal.line),
    };
    scale_factor::check_variable()?;
    let events = EventLoop::<UserEvent>::with_user_event().build().map_err(|e| {
        anyhow::anyhow!(
            "no window can be opened here ({e}); without a display, use: visavis render {} -o out.png",
            args.scene
        )
    })?;
    let mut app = app::App::new(opened, args.clone(), events.create_proxy(), started);
    events.run_app(&mut app).context("the window stopped")?;
    app.outcome()
}
