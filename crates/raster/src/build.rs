//! One pipeline: its shader, what it is bound to, and what it draws into.

use crate::targets::DEPTH;
use gpu::Gpu;
use wgpu::{BindGroupLayout, Face, FrontFace, RenderPipeline, TextureFormat};

/// What tells the pipelines apart.
#[derive(Clone, Copy)]
pub struct Build<'a> {
    pub groups: &'a [&'a BindGroupLayout],
    pub module: &'a wgpu::ShaderModule,
    pub format: TextureFormat,
    /// How many of that format.
    pub targets: usize,
    pub samples: u32,
    pub cull_mode: Option<Face>,
    /// Which way round triangles are seen from outside.
    pub front_face: FrontFace,
    /// One triangle without corners and depth.
    pub full_screen: bool,
    /// Names of the entry points that write bits, without and with depths, if they are not the usual ones.
    pub entry: Option<[&'static str; 2]>,
    /// Values of the module's overrides.
    pub constants: &'a [(&'a str, f64)],
}

impl<'a> Build<'a> {
    /// Both sides of corners in space, one sample into one target.
    pub fn of(groups: &'a [&'a BindGroupLayout], module: &'a wgpu::ShaderModule, format: TextureFormat) -> Self {
        Build {
            groups,
            module,
            format,
            targets: 1,
            samples: 1,
            cull_mode: None,
            front_face: FrontFace::Ccw,
            full_screen: false,
            entry: None,
            constants: &[],
        }
    }

    fn fragment(&self, gpu: &Gpu) -> &'static str {
        let bits = self.format == TextureFormat::Rgba32Uint;
        let with_depth = gpu.adapter.get_info().backend == wgpu::Backend::Gl;
        if let Some([without, with]) = self.entry {
            return if with_depth { with } else { without };
        }
        match (self.full_screen, with_depth, bits) {
            (true, ..) | (false, false, false) => "fragment",
            (false, false, true) => "fragment_bits",
            (false, true, false) => "fragment_and_depth",
            (false, true, true) => "fragment_bits_and_depth",
        }
    }

    pub fn pipeline(&self, gpu: &Gpu) -> RenderPipeline {
        let groups: Vec<_> = self.groups.iter().copied().map(Some).collect();
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        let options = || wgpu::PipelineCompilationOptions {
            constants: self.constants,
            ..wgpu::PipelineCompilationOptions::default()
        };
        let slots = [
            &wgpu::vertex_attr_array![0 => Float32x3],
            &wgpu::vertex_attr_array![1 => Float32x3],
            &wgpu::vertex_attr_array![2 => Float32x2],
        ];
        let corners = slots.map(|attributes| {
            Some(wgpu::VertexBufferLayout {
                array_stride: attributes[0].format.size(),
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes,
            })
        });
        let depth = wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        };
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some("vertex"),
                compilation_options: options(),
                buffers: if self.full_screen { &[] } else { &corners },
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: self.cull_mode,
                front_face: self.front_face,
                ..wgpu::PrimitiveState::default()
            },
            depth_stencil: (!self.full_screen).then_some(depth),
            multisample: wgpu::MultisampleState { count: self.samples, ..wgpu::MultisampleState::default() },
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(self.fragment(gpu)),
                compilation_options: options(),
                targets: &vec![Some(self.format.into()); self.targets],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
