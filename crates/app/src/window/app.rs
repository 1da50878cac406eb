//! The application as winit sees it: events in, frames out.

use super::window_state::WindowState;
use super::{UserEvent, scale_factor};
use crate::engine::beginning::Beginning;
use crate::model::ViewArgs;
use std::sync::Arc;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::WindowId;

/// Before there is a window, with one, after a failure.
pub struct App {
    /// Taken when the window opens.
    beginning: Option<Beginning>,
    args: ViewArgs,
    proxy: EventLoopProxy<UserEvent>,
    started: Instant,
    window: Option<WindowState>,
    failure: Option<anyhow::Error>,
}

impl App {
    pub fn new(beginning: Beginning, args: ViewArgs, proxy: EventLoopProxy<UserEvent>, started: Instant) -> Self {
        App { beginning: Some(beginning), args, proxy, started, window: None, failure: None }
    }

    /// How it ended.
    pub fn outcome(self) -> anyhow::Result<()> {
        self.failure.map_or(Ok(()), Err)
    }

    fn finish(&mut self, events: &ActiveEventLoop, outcome: anyhow::Result<()>) {
        self.failure = outcome.err();
        if let Some(stats) = self.window.take().map(WindowState::close).filter(|_| self.args.frame_stats) {
            crate::console::to_stderr(format_args!("{stats}"));
        }
        events.exit();
    }
}

impl ApplicationHandler<UserEvent> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        let Some(beginning) = self.beginning.take() else { return };
        let proxy = self.proxy.clone();
        let wake = Arc::new(move || {
            // a closed event loop has nobody left to wake
            let _ = proxy.send_event(UserEvent::PaneUpdate);
        });
        match WindowState::open(events, beginning, &self.args, self.proxy.clone(), self.started, wake) {
            Ok(window) => self.window = Some(window),
            Err(error) => self.finish(events, Err(error)),
        }
    }

    fn user_event(&mut self, events: &ActiveEventLoop, event: UserEvent) {
        match (event, &mut self.window) {
            (UserEvent::Ended, _) => self.finish(events, Ok(())),
            (UserEvent::PaneUpdate, Some(window)) => window.request_frame(),
            (UserEvent::Accessibility(event), Some(window)) => window.hear_screen_reader(event),
            (_, None) => {}
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(window)) = (cause, &self.window) {
            window.request_frame();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let next = self.window.as_ref().and_then(WindowState::next_frame);
        events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, mut event: WindowEvent) {
        let Some(window) = &mut self.window else { return };
        if let WindowEvent::ScaleFactorChanged { scale_factor, inner_size_writer } = &mut event
            && !scale_factor::is_usable(*scale_factor)
        {
            return match window.keep_scale(*scale_factor, inner_size_writer) {
                Ok(()) => {}
                Err(unusable) => self.finish(events, Err(unusable)),
            };
        }
        window.hear(&event);
        match event {
            WindowEvent::CloseRequested => self.finish(events, Ok(())),
            WindowEvent::Resized(size) => window.resize(size.width, size.height),
            WindowEvent::RedrawRequested => {
                let asked_to_quit = window.frame();
                let dumped = self.args.ui_dump.as_ref().map_or(Ok(()), |file| window.write_dump(file));
                if asked_to_quit || dumped.is_err() {
                    self.finish(events, dumped);
                }
            }
            _ => {}
        }
    }
}
