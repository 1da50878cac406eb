//! The window's surface: configuring it, getting a frame, drawing egui into it or into a texture that is read back.

use anyhow::Context;
use egui_wgpu::ScreenDescriptor;
use gpu::{Gpu, GpuError};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use technique::Adapters;
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

/// The window's surface and egui's renderer for it.
pub struct WindowSurface {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    /// Draws egui's triangles.
    pub renderer: egui_wgpu::Renderer,
}

/// What became of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presented {
    /// It is on the screen.
    Shown,
    /// There was none to draw to; try again later.
    Skipped,
}

/// Triangles of one frame.
pub struct Painting<'a> {
    /// What to draw.
    pub jobs: &'a [egui::ClippedPrimitive],
    /// Size and scale of the window.
    pub screen: ScreenDescriptor,
}

impl WindowSurface {
    /// Makes the surface and the device behind it, and tells what else there is to trace rays.
    ///
    /// # Errors
    /// If no adapter can draw to this window: one line that says what to install.
    pub fn new(window: Arc<Window>, display: OwnedDisplayHandle) -> anyhow::Result<(Self, Gpu, Adapters)> {
        let (surface, gpu, adapters) = open(&window, display)?;
        let (config, renderer) = furnish(&window, &surface, &gpu)?;
        Ok((WindowSurface { window, surface, config, renderer }, gpu, adapters))
    }

    /// Begins again with a new device, in place of one that has failed. egui's renderer is then empty.
    ///
    /// # Errors
    /// As [`WindowSurface::new`]; what was there is then still there, as far as it works.
    pub fn begin_again(&mut self, display: OwnedDisplayHandle) -> anyhow::Result<Gpu> {
        let (surface, gpu, _) = open(&self.window, display)?;
        // the one before lets go of the window first
        self.surface = surface;
        (self.config, self.renderer) = furnish(&self.window, &self.surface, &gpu)?;
        Ok(gpu)
    }

    /// Follows the window's size; a minimised window has none and keeps the last.
    pub fn resize(&mut self, gpu: &Gpu, width: u32, height: u32) {
        if width == 0 || height == 0 || (width, height) == (self.config.width, self.config.height) {
            return;
        }
        let limit = gpu.device.limits().max_texture_dimension_2d;
        (self.config.width, self.config.height) = (width.min(limit), height.min(limit));
        self.surface.configure(&gpu.device, &self.config);
    }

    /// Width and height in physical pixels.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    /// Takes what egui has drawn in its own textures.
    pub fn take_textures(&mut self, gpu: &Gpu, textures: &egui::TexturesDelta) {
        let renderer = &mut self.renderer;
        guarded(gpu, || {
            for (id, deltas) in &textures.set {
                deltas.iter().for_each(|delta| renderer.update_texture(&gpu.device, &gpu.queue, *id, delta));
            }
        });
    }

    /// Draws and presents a frame.
    pub fn present(&mut self, gpu: &Gpu, painting: &Painting) -> Presented {
        guarded(gpu, || self.presented(gpu, painting)).unwrap_or(Presented::Skipped)
    }

    fn presented(&mut self, gpu: &Gpu, painting: &Painting) -> Presented {
        use wgpu::CurrentSurfaceTexture as Frame;
        let (frame, suboptimal) = match self.surface.get_current_texture() {
            Frame::Success(frame) => (frame, false),
            Frame::Suboptimal(frame) => (frame, true),
            Frame::Timeout | Frame::Occluded => return Presented::Skipped,
            Frame::Outdated | Frame::Validation => {
                self.surface.configure(&gpu.device, &self.config);
                return Presented::Skipped;
            }
            Frame::Lost => {
                if let Ok(surface) = gpu.instance.create_surface(self.window.clone()) {
                    self.surface = surface;
                    self.surface.configure(&gpu.device, &self.config);
                }
                return Presented::Skipped;
            }
        };
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.draw(gpu, painting, &view);
        self.window.pre_present_notify();
        gpu.queue.present(frame);
        if suboptimal {
            self.surface.configure(&gpu.device, &self.config);
        }
        Presented::Shown
    }

    /// The same frame once more, into a texture of the window's size that can be read back; `None` if the device fails.
    pub fn capture(&mut self, gpu: &Gpu, painting: &Painting) -> Option<wgpu::Texture> {
        guarded(gpu, || self.captured(gpu, painting))
    }

    fn captured(&mut self, gpu: &Gpu, painting: &Painting) -> wgpu::Texture {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture as seen"),
            size: wgpu::Extent3d { width: self.config.width, height: self.config.height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.config.format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        self.draw(gpu, painting, &texture.create_view(&wgpu::TextureViewDescriptor::default()));
        texture
    }

    fn draw(&mut self, gpu: &Gpu, painting: &Painting, view: &wgpu::TextureView) {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("window") });
        let mut commands =
            self.renderer.update_buffers(&gpu.device, &gpu.queue, &mut encoder, painting.jobs, &painting.screen);
        {
            let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("egui"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            self.renderer.render(&mut pass.forget_lifetime(), painting.jobs, &painting.screen);
        }
        commands.push(encoder.finish());
        gpu.queue.submit(commands);
    }
}

/// Does `work` on a device that may be lost in the middle of it: wgpu and egui's renderer then panic.
fn guarded<T>(gpu: &Gpu, work: impl FnOnce() -> T) -> Option<T> {
    let done = catch_unwind(AssertUnwindSafe(work)).ok();
    if done.is_none() {
        gpu.remember("the graphics device was lost while it drew the window".into());
    }
    done
}

/// A surface, the best device for it, and every adapter.
fn open(window: &Arc<Window>, display: OwnedDisplayHandle) -> anyhow::Result<(wgpu::Surface<'static>, Gpu, Adapters)> {
    let instance = gpu::new_instance(Some(Box::new(display)));
    // an interface that is not there makes no surface, so that no adapter can even be asked
    let surface = instance.create_surface(window.clone()).map_err(|_| GpuError::NoAdapterForWindow)?;
    let (gpu, report) = Gpu::for_surface(instance, &surface)?;
    Ok((surface, gpu, Adapters::of(&report)))
}

/// Configures a surface, and makes egui's renderer for it.
fn furnish(
    window: &Window,
    surface: &wgpu::Surface<'static>,
    gpu: &Gpu,
) -> anyhow::Result<(wgpu::SurfaceConfiguration, egui_wgpu::Renderer)> {
    let size = window.inner_size();
    let mut config = surface
        .get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1))
        .context("this adapter cannot draw to the window; see visavis info")?;
    // egui blends in sRGB-encoded values: a format that does not encode
    let formats = surface.get_capabilities(&gpu.adapter).formats;
    let plain = [wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureFormat::Bgra8Unorm];
    config.format = plain.into_iter().find(|f| formats.contains(f)).unwrap_or(config.format);
    // where the processor draws, waiting for the screen as well would only add to it
    let software = gpu.is_software();
    config.present_mode = if software { wgpu::PresentMode::AutoNoVsync } else { wgpu::PresentMode::AutoVsync };
    config.desired_maximum_frame_latency = 1;
    surface.configure(&gpu.device, &config);
    // dithering would change the bytes of the panes
    let options = egui_wgpu::RendererOptions { dithering: false, ..Default::default() };
    let renderer = egui_wgpu::Renderer::new(&gpu.device, config.format, options);
    Ok((config, renderer))
}
