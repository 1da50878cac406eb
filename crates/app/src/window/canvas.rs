//! The window without what it shows: its surface and device, and egui as it hears the window.

use super::surface::{Painting, Presented, WindowSurface};
use super::{UserEvent, icon, place, scale_factor};
use crate::model::WindowPlace;
use egui_wgpu::ScreenDescriptor;
use egui_winit::accesskit_winit;
use gpu::Gpu;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use technique::Adapters;
use winit::dpi::LogicalSize;
use winit::event::{InnerSizeWriter, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoopProxy, OwnedDisplayHandle};
use winit::window::Window;

/// What a frame is drawn with.
pub struct Canvas {
    pub egui: egui_winit::State,
    pub surface: WindowSurface,
    pub gpu: Gpu,
    pub window: Arc<Window>,
    pub display: OwnedDisplayHandle,
}

/// A frame that egui has drawn, in triangles.
pub struct Drawn {
    jobs: Vec<egui::ClippedPrimitive>,
    size: [u32; 2],
    /// Physical pixels per point.
    pub scale: f32,
    textures: egui::TexturesDelta,
    /// How soon egui wants the next frame.
    wish: Duration,
}

/// How soon a frame is tried again that had no surface to go to.
const RETRY: Duration = Duration::from_millis(100);

impl Drawn {
    /// What a surface takes.
    pub fn painting(&self) -> Painting<'_> {
        let screen = ScreenDescriptor { size_in_pixels: self.size, pixels_per_point: self.scale };
        Painting { jobs: &self.jobs, screen }
    }
}

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

impl Canvas {
    /// Opens the window, and tells what there is to trace rays.
    ///
    /// # Errors
    /// If there is no window, or no adapter for it.
    pub fn open(
        events: &ActiveEventLoop,
        at: Option<WindowPlace>,
        proxy: EventLoopProxy<UserEvent>,
    ) -> anyhow::Result<(Self, Adapters)> {
        let attributes = place::attributes(events, at)
            .with_title("Visavis")
            .with_window_icon(icon::icon())
            // shown once screen readers know it
            .with_visible(false);
        let window = Arc::new(
            events
                .create_window(attributes)
                .map_err(|fault| anyhow::anyhow!("no window can be opened here ({})", super::cause(&fault)))?,
        );
        let display = events.owned_display_handle();
        let (surface, gpu, adapters) = WindowSurface::new(window.clone(), display.clone())?;
        let egui = egui_of(events, &window, &gpu, proxy);
        window.set_visible(true);
        window.request_redraw();
        Ok((Canvas { egui, surface, gpu, window, display }, adapters))
    }

    /// Asks the system for a frame.
    pub fn request_frame(&self) {
        self.window.request_redraw();
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

    /// Draws a frame, which [`Canvas::present`] shows.
    pub fn draw(&mut self, draw: impl FnMut(&mut egui::Ui)) -> Drawn {
        let input = self.egui.take_egui_input(&self.window);
        let context = self.egui.egui_ctx().clone();
        let output = context.run_ui(input, draw);
        let scale = output.pixels_per_point;
        self.egui.handle_platform_output(&self.window, output.platform_output);
        self.surface.take_textures(&self.gpu, &output.textures_delta);
        let jobs = context.tessellate(output.shapes, scale);
        let wish = output.viewport_output.get(&egui::ViewportId::ROOT).map_or(Duration::MAX, |v| v.repaint_delay);
        Drawn { jobs, size: self.surface.size(), scale, textures: output.textures_delta, wish }
    }

    /// Shows a frame on the screen, and tells when egui wants the next by itself.
    pub fn present(&mut self, mut drawn: Drawn) -> (Presented, Option<Instant>) {
        let shown = self.surface.present(&self.gpu, &drawn.painting());
        for id in &drawn.textures.free {
            self.surface.renderer.free_texture(id);
        }
        drawn.textures.clear();
        let delay = if shown == Presented::Shown { drawn.wish } else { drawn.wish.min(RETRY) };
        (shown, Instant::now().checked_add(delay))
    }

    /// Follows the window's size.
    pub fn resize(&mut self, width: u32, height: u32) {
        self.surface.resize(&self.gpu, width, height);
        self.request_frame();
    }

    /// Goes on with the scale before one that is no use. On X11 the window has that until a window manager moves it, and then
    /// begins again.
    ///
    /// # Errors
    /// Those of [`scale_factor::check`]: a scale that no window has.
    pub fn keep_scale(&self, size: &mut InnerSizeWriter) -> anyhow::Result<()> {
        scale_factor::check(self.window.scale_factor())?;
        // the window is there, and takes its size if it can
        let _ = size.request_inner_size(self.window.inner_size());
        Ok(())
    }

    /// Gives the window that is open a size in points, as far as the system lets it.
    pub fn ask_for_size(&self, [width, height]: [f64; 2]) {
        self.window.set_maximized(false);
        // that it was taken is told as an event too
        let _ = self.window.request_inner_size(LogicalSize::new(width, height));
    }
}

/// Writes what the last frame has shown, whole or not at all.
///
/// # Errors
/// If the file cannot be written.
pub fn write_dump(file: &Path, dump: &str) -> anyhow::Result<()> {
    // not as pictures are written, which reach the disk before the program goes on: a frame would take as long
    let partial = file.with_extension("partial");
    std::fs::write(&partial, dump)?;
    Ok(std::fs::rename(&partial, file)?)
}
