//! The caustic maps: for each sphere of glass what the sun sees behind it, and then a mesh of sunlight bent through it, whose pieces
//! add up where they land. Places on the sun's disc are drawn one after the other.

use crate::error::RasterError;
use crate::shaders;
use crate::targets::CausticTargets;
use gpu::Gpu;
use wgpu::{BindGroup, BindGroupLayout, CommandEncoder, RenderPipeline};

/// Cells along a side of the mesh and places of the sun, as `shaders/raster/repair/caustic.wgsl` has them.
pub const CELLS: u32 = 96;
/// Places of the sun's disc that the mesh is drawn from, see [`CELLS`].
pub const SUNS: u32 = 16;

/// Texels along a side of a caustic map, which is eight radii wide.
pub const SIZE: u32 = 512;

/// What a caustic map is drawn in: halves, which every device but OpenGL's core profile can add up in.
pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// The pipeline that draws the mesh; `frame` is the layout of group 0.
///
/// # Errors
/// [`RasterError::Gpu`] if the device can't take it.
pub fn pipeline(gpu: &Gpu, frame: &BindGroupLayout) -> Result<RenderPipeline, RasterError> {
    let module = shaders::compose("raster/repair/caustic.wgsl")?.create(gpu)?;
    Ok(gpu.checked("the fake's pipelines", || compile(gpu, frame, &module))?)
}

fn compile(gpu: &Gpu, frame: &BindGroupLayout, module: &wgpu::ShaderModule) -> RenderPipeline {
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(frame)],
        immediate_size: 0,
    });
    let one = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let target = wgpu::ColorTargetState {
        format: FORMAT,
        blend: Some(wgpu::BlendState { color: one, alpha: one }),
        write_mask: wgpu::ColorWrites::ALL,
    };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            ..wgpu::PrimitiveState::default()
        },
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Adds up all sunlight that comes through sphere number `layer`.
pub fn draw(
    encoder: &mut CommandEncoder,
    pipeline: &RenderPipeline,
    (frame, view): (&BindGroup, u32),
    targets: &CausticTargets,
    layer: usize,
) {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("a caustic map"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &targets.light.each[layer],
            depth_slice: None,
            resolve_target: None,
            ops,
        })],
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, frame, &[view]);
    let strips = CELLS * SUNS;
    let first = layer as u32 * strips;
    pass.draw(0..2 * (CELLS + 1), first..first + strips);
}
