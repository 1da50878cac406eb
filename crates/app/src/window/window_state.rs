//! The viewer's window: one frame after the other from what egui, the viewer and the workers have.

use super::frame_stats::{Clock, FrameStats};
use super::recovery::DeviceRecovery;
use super::surface::{Painting, Presented, WindowSurface};
use super::textures::{Uploads, WindowTextures};
use super::{UserEvent, dialogue, icon, place, scale_factor};
use crate::engine::Wake;
use crate::engine::ask::Engine;
use crate::engine::beginning::Beginning;
use crate::engine::capture::Capture;
use crate::engine::memory::{self, Memory};
use crate::model::{Destination, ExportRequest, ViewArgs};
use crate::ui::{UiCommand, Workspaces};
use crate::viewer::Viewer;
use egui_wgpu::ScreenDescriptor;
use egui_winit::accesskit_winit;
use gpu::Gpu;
use reference::Store;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::event::{InnerSizeWriter, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoopProxy, OwnedDisplayHandle};
use winit::window::{Fullscreen, Window};

/// Everything that lives as long as the window.
pub struct WindowState {
    viewer: Viewer,
    textures: WindowTextures,
    egui: egui_winit::State,
    surface: WindowSurface,
    gpu: Gpu,
    window: Arc<Window>,
    /// The window's title as it was last set.
    title: String,
    display: OwnedDisplayHandle,
    recovery: DeviceRecovery,
    next_frame: Option<Instant>,
    /// Where the next frame's picture goes, beside the screen.
    poses: Vec<Destination>,
    /// Whether the window closes once those pictures are taken.
    quitting: bool,
    stats: FrameStats,
    /// Physical pixels per point in the last frame.
    scale: f32,
}

/// How soon a frame is tried again that had no surface to go to.
const RETRY: Duration = Duration::from_millis(100);

/// egui as it hears this window, and screen readers with it.
fn egui_of(
    events: &ActiveEventLoop,
    window: &Window,
    gpu: &Gpu,
    proxy: EventLoopProxy<UserEvent>,
) -> egui_winit::State {
    let mut egui = egui_winit::State::new(
        egui::Context::default(),
        egui::ViewportId::ROOT,
        &events.owned_display_handle(),
        Some(window.scale_factor() as f32),
        window.theme(),
        Some(gpu.device.limits().max_texture_dimension_2d as usize),
    );
    egui.init_accesskit(events, window, proxy);
    egui
}

impl WindowState {
    /// Opens the window on what was read.
    ///
    /// # Errors
    /// If there is no window, no adapter for it, or no threads, or if the camera that is asked for sees nothing.
    pub fn open(
        events: &ActiveEventLoop,
        beginning: Beginning,
        args: &ViewArgs,
        proxy: EventLoopProxy<UserEvent>,
        started: Instant,
        wake: Wake,
    ) -> anyhow::Result<Self> {
        scale_factor::check_screens(events)?;
        let model = beginning.model(args)?;
        let Beginning { opened, remembered } = beginning;
        let session = opened.session.as_ref().and_then(|session| session.window.size);
        let attributes = place::attributes(events, place::of_size(session, remembered.window))
            .with_title("Visavis")
            .with_window_icon(icon::icon())
            // shown once screen readers know it
            .with_visible(false);
        let window = Arc::new(
            events
                .create_window(attributes)
                .map_err(|fault| anyhow::anyhow!("no window can be opened here ({})", super::cause(&fault)))?,
        );
        let (surface, gpu, adapters) = WindowSurface::new(window.clone(), events.owned_display_handle())?;
        let egui = egui_of(events, &window, &gpu, proxy);
        window.set_visible(true);
        window.request_redraw();
        let engine = Engine::start(&gpu, &adapters, Arc::new(Store::of_the_user), wake)?;
        let workspaces = Workspaces::beginning_with(args.workspace.as_deref());
        let mut viewer = Viewer::new(model.beside(adapters, args.device), workspaces, engine, started);
        // without a thread nothing is remembered
        viewer.remember(remembered, memory::file_of_the_user().and_then(|file| Memory::start(file).ok()));
        opened.notes.iter().for_each(|line| note!("note: {line}"));
        viewer.begin_with(opened);
        Ok(WindowState {
            viewer,
            title: String::new(),
            textures: WindowTextures::default(),
            egui,
            surface,
            gpu,
            window,
            display: events.owned_display_handle(),
            recovery: DeviceRecovery::new(),
            next_frame: None,
            poses: Vec::new(),
            quitting: false,
            stats: FrameStats::default(),
            scale: 1.0,
        })
    }

    /// Asks the system for a frame.
    pub fn request_frame(&self) {
        self.window.request_redraw();
    }

    /// When egui wants the next frame by itself.
    pub fn next_frame(&self) -> Option<Instant> {
        self.next_frame
    }

    /// Remembers where the window was, and tells what frames have cost.
    pub fn close(mut self) -> FrameStats {
        self.remember_place();
        self.stats
    }

    fn remember_place(&mut self) {
        let before = self.viewer.model.state.remembered.window;
        self.viewer.remember_window(place::of(&self.window, before));
    }

    /// Says what is open.
    fn entitle(&mut self) {
        let title = format!("{} - Visavis", self.viewer.title());
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
    }

    /// Lets egui hear an event. It answers a frame's own event with the wish for another, which would never end.
    pub fn hear(&mut self, event: &WindowEvent) {
        let repaint = self.egui.on_window_event(&self.window, event).repaint;
        if repaint && !matches!(event, WindowEvent::RedrawRequested) {
            self.request_frame();
        }
    }

    /// Does what a screen reader asks for.
    pub fn hear_screen_reader(&mut self, event: accesskit_winit::Event) {
        use accesskit_winit::WindowEvent as Wish;
        let context = self.egui.egui_ctx();
        match event.window_event {
            Wish::InitialTreeRequested => context.enable_accesskit(),
            Wish::ActionRequested(request) => self.egui.on_accesskit_action_request(request),
            Wish::AccessibilityDeactivated => context.disable_accesskit(),
        }
        self.request_frame();
    }

    /// Follows the window's size.
    pub fn resize(&mut self, width: u32, height: u32) {
        self.surface.resize(&self.gpu, width, height);
        self.request_frame();
    }

    /// Says that a scale is no use and goes on with the one before. On X11 the window has that until a window manager moves
    /// it, and then begins again.
    ///
    /// # Errors
    /// As [`scale_factor::check`].
    pub fn keep_scale(&mut self, unusable: f64, size: &mut InnerSizeWriter) -> anyhow::Result<()> {
        scale_factor::check(self.window.scale_factor())?;
        // the window is there, and takes its size if it can
        let _ = size.request_inner_size(self.window.inner_size());
        self.viewer.model.say(Err(scale_factor::is_ignored(unusable)));
        self.request_frame();
        Ok(())
    }

    /// One frame: collect, draw, ask for what has changed, present. Returns whether the user wants to quit.
    pub fn frame(&mut self) -> bool {
        let clock = Clock::start();
        self.recover();
        self.viewer.collect(&mut Uploads {
            gpu: &self.gpu,
            renderer: &mut self.surface.renderer,
            textures: &mut self.textures,
        });
        self.entitle();
        let poses = std::mem::take(&mut self.poses);
        self.viewer.model.state.posing = !poses.is_empty();
        let scale = self.window.scale_factor();
        self.viewer.model.state.window = Some(self.surface.size().map(|pixels| f64::from(pixels) / scale));
        let input = self.egui.take_egui_input(&self.window);
        let context = self.egui.egui_ctx().clone();
        let output = context.run_ui(input, |ui| self.viewer.draw(ui));
        self.scale = output.pixels_per_point;
        self.egui.handle_platform_output(&self.window, output.platform_output);
        let mut textures = output.textures_delta;
        self.surface.take_textures(&self.gpu, &textures);
        let jobs = context.tessellate(output.shapes, self.scale);
        let screen = ScreenDescriptor { size_in_pixels: self.surface.size(), pixels_per_point: self.scale };
        let painting = Painting { jobs: &jobs, screen };
        self.viewer.take_commands().into_iter().for_each(|command| self.handle(command));
        self.viewer.ask();
        let session = &self.viewer.model.session;
        self.stats.note(if session.sweep.open { "Sweep" } else { session.view.name() }, clock.elapsed());
        poses.into_iter().for_each(|to| self.capture(&painting, to));
        let shown = self.surface.present(&self.gpu, &painting);
        for id in &textures.free {
            self.surface.renderer.free_texture(id);
        }
        textures.clear();
        let wish = output.viewport_output.get(&egui::ViewportId::ROOT).map_or(Duration::MAX, |v| v.repaint_delay);
        let delay = match shown {
            Presented::Shown => {
                self.stats.note_shown(context.input(|i| i.pointer.any_down()));
                self.viewer.shown();
                wish
            }
            Presented::Skipped => wish.min(RETRY),
        };
        self.next_frame = Instant::now().checked_add(delay);
        self.quitting && self.poses.is_empty()
    }

    /// Begins again with a new device where the window's has failed. What was on the screen is frame again.
    fn recover(&mut self) {
        self.recovery.count_frame(&self.gpu);
        let Some(fault) = self.gpu.fault().filter(|_| self.recovery.is_due()) else { return };
        match self.surface.begin_again(self.display.clone()) {
            Ok(gpu) => self.gpu = gpu,
            Err(why) => {
                crate::console::to_stderr(format_args!(
                    "visavis: the window's GPU failed ({fault}) and is gone: {why:#}\n"
                ));
                return;
            }
        }
        let side = self.gpu.device.limits().max_texture_dimension_2d as usize;
        self.egui.set_max_texture_side(self.recovery.another_side(side));
        self.textures = WindowTextures::default();
        self.viewer.move_to(&self.gpu);
        self.viewer.model.say(Err(format!("The window's GPU failed and was begun again: {fault}")));
    }

    fn handle(&mut self, command: UiCommand) {
        match self.viewer.handle(command) {
            Some(UiCommand::Export(ExportRequest { to, .. })) => self.poses.push(to),
            Some(UiCommand::FullScreen) => self.toggle_full_screen(),
            Some(UiCommand::Choose(wish)) => {
                let choice = dialogue::choose(&wish, &self.window);
                self.viewer.wait_for_file(wish.purpose, choice);
            }
            Some(UiCommand::Quit) => self.quitting = true,
            _ => {}
        }
        self.request_frame();
    }

    /// On the screen that the window is on.
    fn toggle_full_screen(&mut self) {
        let is_full = self.window.fullscreen().is_some();
        if !is_full {
            // to which it comes back, also if it is closed meanwhile
            self.remember_place();
        }
        self.window.set_fullscreen((!is_full).then_some(Fullscreen::Borderless(None)));
    }

    /// Exports the picture area of a frame as it is on the screen, line and labels included.
    fn capture(&mut self, painting: &Painting, to: Destination) {
        let [width, height] = self.surface.size();
        let [left, top, right, bottom] = self.viewer.model.seen_corners();
        let pixel = |points: f32, most: u32| ((points * self.scale).round().max(0.0) as u32).min(most);
        let part = [pixel(left, width), pixel(top, height), pixel(right, width), pixel(bottom, height)];
        if part[0] >= part[2] || part[1] >= part[3] {
            return self
                .viewer
                .model
                .say(Err("nothing is shown yet that could be saved; try again in a moment".into()));
        }
        let Some(texture) = self.surface.capture(&self.gpu, painting) else {
            return self.viewer.model.say(Err("the GPU failed at this picture; try again in a moment".into()));
        };
        self.viewer.export_as_seen(Capture { gpu: self.gpu.clone(), texture, part }, to);
        // the next frame has hint and message again
        self.request_frame();
    }

    /// Writes the last frame's widgets and the state behind them, whole or not at all.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_dump(&self, file: &Path) -> anyhow::Result<()> {
        let more = serde_json::json!({ "dragged_ms": self.stats.while_dragging() });
        // not as pictures are written, which reach the disk before the program goes on: a frame would take as long
        let partial = file.with_extension("partial");
        std::fs::write(&partial, self.viewer.dump(self.egui.egui_ctx(), self.scale, more))?;
        Ok(std::fs::rename(&partial, file)?)
    }
}
