//! The viewer's window: one frame after the other from what egui, the viewer and the workers have.

use super::UserEvent;
use super::frame_stats::{Clock, FrameStats};
use super::presentation::Presentation;
use super::recovery::DeviceRecovery;
use super::stopwatch::Stopwatch;
use super::surface::{Painting, Presented, WindowSurface};
use crate::engine::ask::Engine;
use crate::engine::capture::Capture;
use crate::engine::export::{Content, Export};
use crate::engine::post_process::PaneUpdate;
use crate::engine::{Picture, Wake};
use crate::model::{Destination, ExportRequest, ExportSubject, Model, PaneId, PaneView, ViewArgs};
use crate::ui::{self, Dump, UiCommand, UiContext, Workspaces};
use anyhow::Context;
use egui_wgpu::ScreenDescriptor;
use egui_winit::accesskit_winit;
use gpu::Gpu;
use scene::Scene;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy, OwnedDisplayHandle};
use winit::window::Window;

/// Everything that lives as long as the window.
pub struct WindowState {
    engine: Engine,
    model: Model,
    workspaces: Workspaces,
    presentation: Presentation,
    egui: egui_winit::State,
    surface: WindowSurface,
    gpu: Gpu,
    window: Arc<Window>,
    display: OwnedDisplayHandle,
    recovery: DeviceRecovery,
    next_frame: Option<Instant>,
    /// Where the next frame's picture goes, beside the screen.
    poses: Vec<Destination>,
    /// Whether the window closes once those pictures are taken.
    quitting: bool,
    stopwatch: Stopwatch,
    stats: FrameStats,
    /// The last frame's widgets, and physical pixels per point.
    dump: Dump,
    scale: f32,
}

/// How soon a frame is tried again that had no surface to go to.
const RETRY: Duration = Duration::from_millis(100);

/// The window's size to begin with, as far as the screen has room for it.
fn first_size(events: &ActiveEventLoop) -> LogicalSize<f64> {
    let wished = LogicalSize::new(1280.0, 720.0);
    let Some(monitor) = events.primary_monitor().or_else(|| events.available_monitors().next()) else { return wished };
    let room: LogicalSize<f64> = monitor.size().to_logical(monitor.scale_factor());
    LogicalSize::new(wished.width.min(room.width), wished.height.min(room.height))
}

impl WindowState {
    /// Opens the window on a scene.
    ///
    /// # Errors
    /// If there is no window, no adapter for it, or no threads.
    pub fn open(
        events: &ActiveEventLoop,
        scene: Scene,
        args: &ViewArgs,
        proxy: EventLoopProxy<UserEvent>,
        started: Instant,
        wake: Wake,
    ) -> anyhow::Result<Self> {
        let attributes = Window::default_attributes()
            .with_title("Visavis")
            .with_inner_size(first_size(events))
            .with_min_inner_size(LogicalSize::new(480.0, 320.0))
            // shown once screen readers know it
            .with_visible(false);
        let window = Arc::new(events.create_window(attributes).context("no window can be opened here")?);
        let (surface, gpu, adapters) = WindowSurface::new(window.clone(), events.owned_display_handle())?;
        let mut egui = egui_winit::State::new(
            egui::Context::default(),
            egui::ViewportId::ROOT,
            &events.owned_display_handle(),
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(gpu.device.limits().max_texture_dimension_2d as usize),
        );
        egui.init_accesskit(events, &window, proxy);
        window.set_visible(true);
        window.request_redraw();
        Ok(WindowState {
            engine: Engine::start(&gpu, &adapters, wake)?,
            model: Model::new(scene, args.scene.clone(), args.theme).beside(adapters, args.device),
            workspaces: Workspaces::beginning_with(args.workspace.as_deref()),
            presentation: Presentation::default(),
            egui,
            surface,
            gpu,
            window,
            display: events.owned_display_handle(),
            recovery: DeviceRecovery::new(),
            next_frame: None,
            poses: Vec::new(),
            quitting: false,
            stopwatch: Stopwatch::new(started),
            stats: FrameStats::default(),
            dump: Dump::default(),
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

    /// What frames have cost so far.
    pub fn frame_stats(self) -> FrameStats {
        self.stats
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

    /// One frame: collect, draw, ask for what has changed, present. Returns whether the user wants to quit.
    pub fn frame(&mut self) -> bool {
        let clock = Clock::start();
        self.recover();
        self.collect();
        let poses = std::mem::take(&mut self.poses);
        self.model.state.posing = !poses.is_empty();
        let input = self.egui.take_egui_input(&self.window);
        let context = self.egui.egui_ctx().clone();
        let mut commands = Vec::new();
        let output = context.run_ui(input, |ui| {
            self.dump = Dump::default();
            let mut cx = UiContext {
                model: &mut self.model,
                shown: &self.presentation.shown,
                textures: &self.presentation.textures,
                dump: &mut self.dump,
                commands: &mut commands,
            };
            ui::show(&mut self.workspaces, &mut cx, ui);
        });
        self.scale = output.pixels_per_point;
        self.egui.handle_platform_output(&self.window, output.platform_output);
        let mut textures = output.textures_delta;
        self.surface.take_textures(&self.gpu, &textures);
        let jobs = context.tessellate(output.shapes, self.scale);
        let screen = ScreenDescriptor { size_in_pixels: self.surface.size(), pixels_per_point: self.scale };
        let painting = Painting { jobs: &jobs, screen };
        commands.into_iter().for_each(|request| self.handle(request));
        let wanted = self.workspaces.open().wanted(&self.model);
        self.presentation.keep(&wanted);
        self.engine.ask(&wanted).values().for_each(|job| self.stopwatch.asked(*job));
        self.stats.note(self.model.session.view.name(), clock.elapsed());
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
                self.stopwatch
                    .shown(wanted.panes.ids().all(|pane| self.presentation.textures.panes.get(pane).is_some()));
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
        self.presentation.lose_textures();
        self.engine.move_to(&self.gpu);
        self.model.say(Err(format!("The window's GPU failed and was begun again: {fault}")));
    }

    /// Takes what the workers have finished.
    fn collect(&mut self) {
        let updates = self.engine.collect().unwrap_or_default();
        for (pane, update) in updates.iter() {
            if let PaneUpdate::Picture(frame) = update {
                self.stopwatch.received(frame.picture.order.job);
                self.tell_of_refusal(pane, &frame.picture);
            }
        }
        self.presentation.update(updates, &self.gpu, &mut self.surface.renderer);
        if let Some(drawn) = self.engine.error_map() {
            self.presentation.update_map(drawn, &self.gpu, &mut self.surface.renderer);
        }
        self.follow_the_reference();
        match self.engine.loaded() {
            Some(Ok(opened)) => {
                self.model.say(Ok(format!("Opened {}", opened.scene.name)));
                self.model.open(opened.scene, opened.source);
                self.presentation.clear();
            }
            Some(Err(fault)) => self.model.say(Err(fault)),
            None => {}
        }
        self.engine.exported().into_iter().for_each(|outcome| self.model.say(outcome));
    }

    /// Says once that a pane's rays are not traced where they should be.
    fn tell_of_refusal(&mut self, pane: PaneId, picture: &Picture) {
        let known = self.presentation.shown.panes.get(pane).and_then(|shown| shown.refused.as_ref());
        if let Some(why) = picture.refused.as_ref().filter(|why| known != Some(why)) {
            self.model.say(Err(format!("{pane} goes on on the CPU, the GPU failed: {why}. R tries it again")));
        }
    }

    fn follow_the_reference(&mut self) {
        let view = self.engine.view_of_the_reference();
        self.presentation.shown.reference.take_if(|progress| Some(progress.view) != view);
        let Some(update) = self.engine.update() else { return };
        self.presentation.shown.reference = update.progress.or_else(|| self.presentation.shown.reference.take());
        update.faults.into_iter().for_each(|fault| self.model.say(Err(fault)));
    }

    fn handle(&mut self, request: UiCommand) {
        match request {
            UiCommand::Export(ExportRequest { subject, to }) => match subject {
                ExportSubject::AsSeen => self.poses.push(to),
                ExportSubject::Pane(pane) => self.export_pane(pane, to),
                ExportSubject::ErrorMap => self.export_map(to),
            },
            UiCommand::Open(name) => self.engine.load(name),
            UiCommand::LoadReference(file) => self.engine.load_reference(file),
            UiCommand::Quit => self.quitting = true,
        }
        self.request_frame();
    }

    fn export_pane(&mut self, pane: PaneId, to: Destination) {
        match self.presentation.pane(pane, self.model.session.display) {
            Some((content, records)) => self.engine.export(Export { content, records, to }),
            None => self.model.say(Err(format!("{pane} has no whole picture yet; try again in a moment"))),
        }
    }

    fn export_map(&mut self, to: Destination) {
        match self.presentation.map(&self.model) {
            Some((content, records)) => self.engine.export(Export { content, records, to }),
            None => self.model.say(Err("there is no error map yet; try again in a moment".into())),
        }
    }

    /// Exports the picture area of a frame as it is on the screen, line and labels included.
    fn capture(&mut self, painting: &Painting, to: Destination) {
        let [width, height] = self.surface.size();
        let [left, top, right, bottom] = self.model.state.picture.corners;
        let pixel = |points: f32, most: u32| ((points * self.scale).round().max(0.0) as u32).min(most);
        let part = [pixel(left, width), pixel(top, height), pixel(right, width), pixel(bottom, height)];
        let Some(texture) = self.surface.capture(&self.gpu, painting) else {
            return self.model.say(Err("the GPU failed at this picture; try again in a moment".into()));
        };
        let content = Content::Seen(Capture { gpu: self.gpu.clone(), texture, part });
        self.engine.export(Export { content, records: self.presentation.records_of_all(&self.model), to });
        // the next frame has hint and message again
        self.request_frame();
    }

    /// Writes the last frame's widgets and the state behind them, whole or not at all.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_dump(&self, file: &Path) -> anyhow::Result<()> {
        let ready = |pane| self.presentation.textures.panes.get(pane).is_some();
        let shown = &self.presentation.shown;
        let pane = |id| dumped(shown.panes.get(id).unwrap_or(&PaneView::default()), ready(id));
        let Model { document, session, state, .. } = &self.model;
        let context = self.egui.egui_ctx();
        let state = serde_json::json!({
            "scene": document.scene.name,
            "view": session.view.name(),
            "line": session.line.name(),
            "wipe": session.wipe,
            "paused": state.paused,
            "theme": state.theme.name(),
            "picture_size": state.picture.size,
            "eye": document.camera.eye.to_array(),
            "fov": document.camera.fov_y,
            "message": state.message.as_ref().map(|m| &m.text),
            "focus_id": context.memory(|m| m.focused()).map(|id| id.value()),
            "pressing": context.input(|i| i.pointer.any_down()),
            "typing": context.text_edit_focused(),
            "map": shown.map.as_ref().map(|map| &map.map.label),
            "reference": shown.reference.as_ref().map(|r| [r.pictures, u32::from(r.done)]),
            "a": pane(PaneId::A),
            "b": pane(PaneId::B),
            "frames": self.stopwatch.frames(),
            "dragged_ms": self.stats.while_dragging(),
            "latency_ms": self.stopwatch.latency().map(|t| t.as_millis() as u64),
            "first_pictures_ms": self.stopwatch.first_pictures().map(|t| t.as_millis() as u64),
        });
        // not as pictures are written, which reach the disk before the program goes on: a frame would take as long
        let partial = file.with_extension("partial");
        std::fs::write(&partial, self.dump.json(self.scale, state))?;
        Ok(std::fs::rename(&partial, file)?)
    }
}

/// What the dump says of a pane.
fn dumped(pane: &PaneView, ready: bool) -> serde_json::Value {
    serde_json::json!({
        "ready": ready,
        "label": pane.provenance.as_ref().map(|p| p.technique.label()),
        "spp": pane.spp,
        "rough": pane.rough,
        "unfinished": pane.unfinished,
        "nonfinite": pane.nonfinite,
        "rel_mse": pane.errors.map(|(_, e)| e.rel_mse),
        "fault": pane.fault,
        "adapter": pane.adapter.as_deref(),
        "device": pane.provenance.as_ref().map(|p| p.device.name()),
        "refused": pane.refused.as_deref(),
    })
}
