//! The viewer's window: one frame after the other from what egui, the viewer and the workers have.

use super::stopwatch::Stopwatch;
use super::surface::{Painting, Presented, WindowSurface};
use super::textures::PaneTexture;
use crate::picture_file;
use crate::ui::{Dump, Pane, Request, Viewer};
use crate::workers::crew::Crew;
use crate::workers::darkroom::{News, Shelf};
use crate::workers::{Side, Wake};
use anyhow::Context;
use egui_wgpu::ScreenDescriptor;
use gpu::Gpu;
use scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

/// Everything that lives as long as the window.
pub struct ViewerWindow {
    crew: Crew,
    viewer: Viewer,
    panes: [Pane; 2],
    textures: [PaneTexture; 2],
    egui: egui_winit::State,
    surface: WindowSurface,
    gpu: Gpu,
    window: Arc<Window>,
    next_frame: Option<Instant>,
    stopwatch: Stopwatch,
    /// The last frame's widgets, and physical pixels per point.
    dump: Dump,
    scale: f32,
}

/// How soon a frame is tried again that had no surface to go to.
const RETRY: Duration = Duration::from_millis(100);

impl ViewerWindow {
    /// Opens the window on a scene.
    ///
    /// # Errors
    /// If there is no window, no adapter for it, or no threads.
    pub fn open(events: &ActiveEventLoop, scene: Scene, started: Instant, wake: Wake) -> anyhow::Result<Self> {
        let attributes = Window::default_attributes()
            .with_title("Visavis")
            .with_inner_size(LogicalSize::new(1280.0, 720.0))
            .with_min_inner_size(LogicalSize::new(480.0, 320.0));
        let window = Arc::new(events.create_window(attributes).context("no window can be opened here")?);
        let (surface, gpu) = WindowSurface::new(window.clone(), events.owned_display_handle())?;
        let context = egui::Context::default();
        context.set_theme(egui::Theme::Dark);
        let egui = egui_winit::State::new(
            context,
            egui::ViewportId::ROOT,
            &events.owned_display_handle(),
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(gpu.device.limits().max_texture_dimension_2d as usize),
        );
        window.request_redraw();
        Ok(ViewerWindow {
            crew: Crew::start(&gpu, wake)?,
            viewer: Viewer::new(scene),
            panes: Default::default(),
            textures: Default::default(),
            egui,
            surface,
            gpu,
            window,
            next_frame: None,
            stopwatch: Stopwatch::new(started),
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

    /// Lets egui hear an event. It answers a frame's own event with the wish for another, which would never end.
    pub fn hear(&mut self, event: &WindowEvent) {
        let repaint = self.egui.on_window_event(&self.window, event).repaint;
        if repaint && !matches!(event, WindowEvent::RedrawRequested) {
            self.request_frame();
        }
    }

    /// Follows the window's size.
    pub fn resize(&mut self, width: u32, height: u32) {
        self.surface.resize(&self.gpu, width, height);
        self.request_frame();
    }

    /// One frame: collect, draw, ask for what has changed, present.
    pub fn frame(&mut self) {
        self.collect();
        let input = self.egui.take_egui_input(&self.window);
        let context = self.egui.egui_ctx().clone();
        let mut requests = Vec::new();
        let output = context.run_ui(input, |ui| {
            self.dump = Dump::default();
            requests.extend(self.viewer.ui(ui, &self.panes, &mut self.dump));
        });
        self.scale = output.pixels_per_point;
        self.egui.handle_platform_output(&self.window, output.platform_output);
        let mut textures = output.textures_delta;
        for (id, deltas) in &textures.set {
            for delta in deltas {
                self.surface.renderer.update_texture(&self.gpu.device, &self.gpu.queue, *id, delta);
            }
        }
        let jobs = context.tessellate(output.shapes, self.scale);
        let screen = ScreenDescriptor { size_in_pixels: self.surface.size(), pixels_per_point: self.scale };
        let painting = Painting { jobs: &jobs, screen };
        for request in requests {
            self.grant(request, &painting);
        }
        if let Some(job) = self.crew.ask(&self.viewer) {
            self.stopwatch.asked(job);
        }
        let shown = self.surface.present(&self.gpu, &painting);
        for id in &textures.free {
            self.surface.renderer.free_texture(id);
        }
        textures.clear();
        let wish = output.viewport_output.get(&egui::ViewportId::ROOT).map_or(Duration::MAX, |v| v.repaint_delay);
        let delay = match shown {
            Presented::Shown => {
                self.stopwatch.shown(self.panes.iter().all(|pane| pane.texture.is_some()));
                wish
            }
            Presented::Skipped => wish.min(RETRY),
        };
        self.next_frame = Instant::now().checked_add(delay);
    }

    /// Takes what the workers have finished.
    fn collect(&mut self) {
        if let Some(fault) = self.gpu.fault() {
            self.viewer.message = Some((format!("The GPU failed: {fault}"), true));
        }
        self.hang(self.crew.collect().unwrap_or_default());
        if let Some(loaded) = self.crew.loaded() {
            let opened = loaded.map(|scene| {
                let message = format!("Opened {}", scene.name);
                self.viewer.open(scene);
                self.panes = Default::default();
                message
            });
            self.say(opened);
        }
    }

    /// Puts what is new on the panes.
    fn hang(&mut self, shelf: Shelf) {
        if let Some(News::Picture(truth)) = &shelf[Side::B as usize] {
            self.stopwatch.received(truth.picture.order.job);
        }
        for ((news, pane), texture) in shelf.into_iter().zip(&mut self.panes).zip(&mut self.textures) {
            match news {
                None => {}
                Some(News::Fault(fault)) => *pane = Pane { fault: Some(fault), ..Pane::default() },
                Some(News::Picture(developed)) => {
                    let picture = &developed.picture;
                    if let Some(rgba) = &developed.rgba {
                        let renderer = &mut self.surface.renderer;
                        pane.texture = Some(texture.upload(&self.gpu, renderer, picture.width, picture.height, rgba));
                        pane.fault = None;
                        pane.label.clone_from(&picture.order.label);
                    }
                    (pane.spp, pane.seconds, pane.rough) = (picture.spp, picture.seconds, picture.rough);
                    pane.errors = developed.errors;
                }
            }
        }
    }

    fn grant(&mut self, request: Request, painting: &Painting) {
        match request {
            Request::Save => {
                let saved = self.save(painting).map(|path| format!("Saved {}", path.display()));
                self.say(saved.map_err(|error| format!("{error:#}")));
            }
            Request::Open(name) => self.crew.load(name),
        }
        self.request_frame();
    }

    fn say(&mut self, outcome: Result<String, String>) {
        let failed = outcome.is_err();
        self.viewer.message = Some((outcome.unwrap_or_else(|fault| fault), failed));
    }

    /// Saves the picture area as it is on the screen, line and labels included.
    fn save(&mut self, painting: &Painting) -> anyhow::Result<PathBuf> {
        let [width, height] = self.surface.size();
        let bytes = self.surface.capture(&self.gpu, painting)?;
        let rect = self.viewer.picture_rect;
        let pixel = |v: f32, most: u32| ((v * self.scale).round().max(0.0) as u32).min(most) as usize;
        let (left, right) = (pixel(rect.left(), width), pixel(rect.right(), width));
        let (top, bottom) = (pixel(rect.top(), height), pixel(rect.bottom(), height));
        let rows = bytes.chunks_exact(4 * width as usize).take(bottom).skip(top);
        let picture: Vec<u8> = rows.flat_map(|row| &row[4 * left..4 * right]).copied().collect();
        let stem =
            format!("visavis-{}-{}", self.viewer.scene.name, self.viewer.view.name().to_lowercase().replace(' ', "-"));
        let path = picture_file::free_name(&picture_file::default_folder()?, &stem)?;
        picture_file::save_rgba8(&path, (right - left) as u32, (bottom - top) as u32, &picture)?;
        Ok(path)
    }

    /// Writes the last frame's widgets and the state behind them, whole or not at all.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_dump(&self, file: &Path) -> anyhow::Result<()> {
        let [a, b] = &self.panes;
        let state = serde_json::json!({
            "scene": self.viewer.scene.name,
            "view": self.viewer.view.name(),
            "picture_size": self.viewer.picture_size,
            "wipe": self.viewer.wipe,
            "eye": self.viewer.camera.eye.to_array(),
            "message": self.viewer.message.as_ref().map(|m| &m.0),
            "typing": self.egui.egui_ctx().text_edit_focused(),
            "a_ready": a.texture.is_some(),
            "b_ready": b.texture.is_some(),
            "b_spp": b.spp,
            "b_rough": b.rough,
            "rel_mse": a.errors.map(|e| e.rel_mse),
            "faults": [a.fault.as_ref(), b.fault.as_ref()],
            "frames": self.stopwatch.frames(),
            "latency_ms": self.stopwatch.latency().map(|t| t.as_millis() as u64),
            "first_pictures_ms": self.stopwatch.first_pictures().map(|t| t.as_millis() as u64),
        });
        picture_file::write_whole(file, self.dump.json(self.scale, state).as_bytes())
    }
}
