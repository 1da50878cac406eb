//! The application as winit sees it: events in, frames out.

use super::canvas::{self, Canvas};
use super::waiting::{Waited, Waiting};
use super::window_state::{First, WindowState};
use super::{UserEvent, place, scale_factor};
use crate::engine::Wake;
use crate::engine::beginning::{Beginning, Reading};
use crate::model::{Setup, ViewArgs};
use std::sync::Arc;
use std::time::Instant;
use winit::application::ApplicationHandler;
use winit::event::{InnerSizeWriter, StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::WindowId;

/// Before there is a window, with one, after a failure.
pub struct App {
    stage: Stage,
    args: ViewArgs,
    proxy: EventLoopProxy<UserEvent>,
    started: Instant,
    failure: Option<anyhow::Error>,
}

/// How far it is.
enum Stage {
    /// There is no window; the scene was read, or is being read.
    Before(Box<Result<Beginning, Reading>>),
    /// There is one, and no scene.
    Waits(Box<Waiting>),
    /// The window and the first scene are both there.
    Shows(Box<WindowState>),
    /// The window is closed.
    Over,
}

impl App {
    pub fn new(
        first: Result<Beginning, Reading>,
        args: ViewArgs,
        proxy: EventLoopProxy<UserEvent>,
        started: Instant,
    ) -> Self {
        App { stage: Stage::Before(first.into()), args, proxy, started, failure: None }
    }

    /// How it ended.
    pub fn outcome(self) -> anyhow::Result<()> {
        self.failure.map_or(Ok(()), Err)
    }

    fn finish(&mut self, events: &ActiveEventLoop, outcome: anyhow::Result<()>) {
        self.failure = outcome.err();
        if let Stage::Shows(window) = std::mem::replace(&mut self.stage, Stage::Over) {
            let stats = window.close();
            if self.args.frame_stats {
                crate::console::to_stderr(format_args!("{stats}"));
            }
        }
        events.exit();
    }

    fn canvas(&mut self) -> Option<&mut Canvas> {
        match &mut self.stage {
            Stage::Waits(waiting) => Some(&mut waiting.canvas),
            Stage::Shows(window) => Some(&mut window.canvas),
            Stage::Before(_) | Stage::Over => None,
        }
    }

    fn next_frame(&self) -> Option<Instant> {
        match &self.stage {
            Stage::Waits(waiting) => waiting.next_frame(),
            Stage::Shows(window) => window.next_frame(),
            Stage::Before(_) | Stage::Over => None,
        }
    }

    /// What lets the window hear of what happens beside it.
    fn wake(&self) -> Wake {
        let proxy = self.proxy.clone();
        Arc::new(move || {
            // a closed event loop has nobody left to wake
            let _ = proxy.send_event(UserEvent::PaneUpdate);
        })
    }

    /// Opens the window on what was read, or to wait for it.
    fn open(&mut self, events: &ActiveEventLoop, first: Result<Beginning, Reading>) -> anyhow::Result<Stage> {
        scale_factor::check_screens(events)?;
        let proxy = self.proxy.clone();
        match first {
            Ok(beginning) => {
                let size = beginning.window_size();
                let at = place::of_size(size, beginning.remembered.window);
                let first = self.first(beginning)?;
                let (canvas, adapters) = Canvas::open(events, at, proxy)?;
                Ok(Stage::Shows(Box::new(WindowState::begin(canvas, adapters, first, &self.args, self.wake())?)))
            }
            Err(reading) => {
                reading.wakes(self.wake());
                let (canvas, adapters) = Canvas::open(events, reading.remembered().window, proxy)?;
                Ok(Stage::Waits(Box::new(Waiting::new(canvas, adapters, reading, &self.args))))
            }
        }
    }

    fn first(&self, beginning: Beginning) -> anyhow::Result<First> {
        let model = beginning.model(&self.args)?;
        let Beginning { opened, remembered } = beginning;
        Ok(First { model, opened, remembered, started: self.started })
    }

    /// Shows in the window that has waited for it what was read.
    fn show(&mut self, waiting: Waiting, beginning: Beginning) -> anyhow::Result<Stage> {
        let Waiting { canvas, adapters, .. } = waiting;
        beginning.window_size().into_iter().for_each(|size| canvas.ask_for_size(size));
        let first = self.first(beginning)?;
        Ok(Stage::Shows(Box::new(WindowState::begin(canvas, adapters, first, &self.args, self.wake())?)))
    }

    /// The scene that a window begins with which is asked for none, where the user has given up the other one.
    fn usual(&mut self) -> anyhow::Result<Beginning> {
        let scene = scene::builtin::names().next().unwrap_or_default().to_owned();
        let usual = Beginning::read(&scene);
        self.args = ViewArgs { scene, slide: None, setup: Setup::default(), ..self.args.clone() };
        usual
    }

    /// Goes on to another stage, or ends.
    fn go_on(&mut self, events: &ActiveEventLoop, stage: anyhow::Result<Stage>) {
        match stage {
            Ok(stage) => self.stage = stage,
            Err(error) => self.finish(events, Err(error)),
        }
    }

    fn frame(&mut self, events: &ActiveEventLoop) {
        let waited = match &mut self.stage {
            Stage::Waits(waiting) => waiting.frame(),
            Stage::Shows(window) => match window.frame() {
                true => Waited::Quit,
                false => Waited::On,
            },
            Stage::Before(_) | Stage::Over => Waited::On,
        };
        let (beginning, stopped) = match waited {
            Waited::On => return self.write_dump().unwrap_or_else(|error| self.finish(events, Err(error))),
            Waited::Quit => {
                let dumped = self.write_dump();
                return self.finish(events, dumped);
            }
            Waited::Read(read) => (*read, false),
            Waited::Stopped => (self.usual(), true),
        };
        let Stage::Waits(waiting) = std::mem::replace(&mut self.stage, Stage::Over) else { return };
        let stage = beginning.and_then(|beginning| self.show(*waiting, beginning));
        self.go_on(events, stage);
        if let (Stage::Shows(window), true) = (&mut self.stage, stopped) {
            window.say("Reading was stopped");
        }
    }

    fn write_dump(&self) -> anyhow::Result<()> {
        let Some(file) = &self.args.ui_dump else { return Ok(()) };
        match &self.stage {
            Stage::Waits(waiting) => canvas::write_dump(file, &waiting.dump()),
            Stage::Shows(window) => canvas::write_dump(file, &window.dump()),
            Stage::Before(_) | Stage::Over => Ok(()),
        }
    }

    /// Goes on with the scale before one that is no use, which a window without a scene does not tell.
    fn keep_scale(&mut self, events: &ActiveEventLoop, unusable: f64, size: &mut InnerSizeWriter) {
        let Some(canvas) = self.canvas() else { return };
        match (canvas.keep_scale(size), &mut self.stage) {
            (Err(error), _) => self.finish(events, Err(error)),
            (Ok(()), Stage::Shows(window)) => window.tell_of_scale(unusable),
            (Ok(()), _) => {}
        }
    }
}

impl ApplicationHandler<UserEvent> for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if !matches!(self.stage, Stage::Before(_)) {
            return;
        }
        let Stage::Before(first) = std::mem::replace(&mut self.stage, Stage::Over) else { return };
        let stage = self.open(events, *first);
        self.go_on(events, stage);
    }

    fn user_event(&mut self, events: &ActiveEventLoop, event: UserEvent) {
        match (event, self.canvas()) {
            (UserEvent::Ended, _) => self.finish(events, Ok(())),
            (UserEvent::PaneUpdate, Some(canvas)) => canvas.request_frame(),
            (UserEvent::Accessibility(event), Some(canvas)) => canvas.hear_screen_reader(event),
            (_, None) => {}
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(canvas)) = (cause, self.canvas()) {
            canvas.request_frame();
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        events.set_control_flow(self.next_frame().map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, mut event: WindowEvent) {
        if let WindowEvent::ScaleFactorChanged { scale_factor, inner_size_writer } = &mut event
            && !scale_factor::is_usable(*scale_factor)
        {
            return self.keep_scale(events, *scale_factor, inner_size_writer);
        }
        let Some(canvas) = self.canvas() else { return };
        canvas.hear(&event);
        match event {
            WindowEvent::CloseRequested => self.finish(events, Ok(())),
            WindowEvent::Resized(size) => canvas.resize(size.width, size.height),
            WindowEvent::RedrawRequested => self.frame(events),
            _ => {}
        }
    }
}
