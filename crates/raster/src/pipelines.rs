//! Pipelines and the layouts of what is bound to them.

use crate::error::RasterError;
use crate::gpu_data::Lights;
use crate::knobs::ShadowFilter;
use crate::plan::Casting;
use crate::settings::Fake;
use crate::shaders;
use crate::targets::{Colours, DEPTH, FEATURES, SHADOW};
use crate::tessellation::Vertex;
use gpu::{Gpu, GpuError};
use scene::Vec3;
use std::num::NonZeroU64;
use wgpu::{BindGroupLayout, BindingType, Face, RenderPipeline, ShaderStages, TextureFormat, TextureViewDimension};

/// The forward pass into one kind of target.
#[derive(Debug)]
pub struct Forward {
    /// Both sides of everything but glass.
    pub surface: RenderPipeline,
    /// Back faces of glass.
    pub glass: RenderPipeline,
}

/// The forward passes of a [`Choice`].
#[derive(Debug)]
pub struct ForwardPasses {
    /// Into a cube map's face.
    pub cube_map: Forward,
    /// Into the picture.
    pub picture: Forward,
}

/// What is compiled into the forward passes: a software device would run the branches that are not taken too, or
/// compile them anew for every draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// Decides the targets' formats.
    pub fake: Fake,
    /// How shadow maps are looked up.
    pub filter: ShadowFilter,
    /// Whether a sun shines.
    pub sun: bool,
    /// As in [`Lights::area_light_pattern`].
    pub area_light: u32,
    /// As in [`Lights::shading`].
    pub shading: u32,
}

impl Choice {
    /// What a picture under `lights` needs.
    pub fn of(fake: Fake, filter: ShadowFilter, lights: &Lights) -> Choice {
        let sun = lights.sun_incident.cmpgt(Vec3::ZERO).any();
        Choice { fake, filter, sun, area_light: lights.area_light_pattern, shading: lights.shading }
    }

    /// Values of the overrides in `shaders/raster/forward.wgsl`, for glass or for everything else.
    pub fn constants(&self, glass: bool) -> [(&'static str, f64); 5] {
        [
            ("SHADOW_FILTER", f64::from(self.filter.code())),
            ("GLASS", f64::from(u8::from(glass))),
            ("SUN", f64::from(u8::from(self.sun))),
            ("AREA_LIGHT", f64::from(self.area_light)),
            ("SHADING", f64::from(self.shading)),
        ]
    }
}

/// All pipelines.
#[derive(Debug)]
pub struct Pipelines {
    /// Group 0 of the shadow pass: the view.
    pub shadow_layout: BindGroupLayout,
    /// Group 0 of the forward pass: view, lights, shadow map.
    pub frame_layout: BindGroupLayout,
    /// Group 1 of the forward pass: object, cube map.
    pub object_layout: BindGroupLayout,
    /// Group 0 of the resolve pass: the picture's passes.
    pub resolve_layout: BindGroupLayout,
    /// Linear, for cube maps.
    pub sampler: wgpu::Sampler,
    /// Mean of the picture's passes.
    pub resolve: RenderPipeline,
    /// Group 1 of the features' pass: object.
    pub surface_layout: BindGroupLayout,
    /// Of both sides of everything, once [`Pipelines::prepare_features`] has compiled it.
    pub features: Option<RenderPipeline>,
    forward_module: wgpu::ShaderModule,
    /// Of each choice that was asked for.
    forward: Vec<(Choice, ForwardPasses)>,
    both_sides: RenderPipeline,
    back_faces: RenderPipeline,
    front_faces: RenderPipeline,
}

impl Pipelines {
    /// Composes and compiles all of them.
    pub fn new(gpu: &Gpu) -> Result<Pipelines, RasterError> {
        let shadow = shaders::compose("raster/shadow_map.wgsl")?.create(gpu)?;
        let forward = shaders::compose("raster/forward.wgsl")?.create(gpu)?;
        let resolve = shaders::compose("film/resolve.wgsl")?.create(gpu)?;
        Ok(gpu.checked("the fake's pipelines", || compile(gpu, &shadow, forward, &resolve))?)
    }

    /// Sees to it that the forward passes of a choice are compiled; returns whether they were not.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the device can't take them.
    pub fn prepare(&mut self, gpu: &Gpu, choice: Choice) -> Result<bool, GpuError> {
        if self.of(choice).is_some() {
            return Ok(false);
        }
        let compiled = gpu.checked("the fake's pipelines", || self.compile_forward(gpu, choice))?;
        self.forward.push((choice, compiled));
        Ok(true)
    }

    /// Sees to it that the features' pass is compiled; returns whether it was not.
    ///
    /// # Errors
    /// [`RasterError::Gpu`] if the device can't take it.
    pub fn prepare_features(&mut self, gpu: &Gpu) -> Result<bool, RasterError> {
        if self.features.is_some() {
            return Ok(false);
        }
        let module = shaders::compose("raster/features.wgsl")?.create(gpu)?;
        let groups: &[_] = &[&self.shadow_layout, &self.surface_layout];
        let build = Build { targets: 2, ..Build::of(groups, &module, FEATURES) };
        self.features = Some(gpu.checked("the fake's pipelines", || build.pipeline(gpu))?);
        Ok(true)
    }

    /// The forward passes of a choice, once [`Pipelines::prepare`] has compiled them.
    pub fn of(&self, choice: Choice) -> Option<&ForwardPasses> {
        self.forward.iter().find(|(compiled, _)| *compiled == choice).map(|(_, passes)| passes)
    }

    fn compile_forward(&self, gpu: &Gpu, choice: Choice) -> ForwardPasses {
        let groups: &[_] = &[&self.frame_layout, &self.object_layout];
        let into = |format, samples| {
            let module = &self.forward_module;
            let build = |cull_mode, constants: &[_]| {
                Build { samples, cull_mode, constants, ..Build::of(groups, module, format) }.pipeline(gpu)
            };
            Forward {
                surface: build(None, &choice.constants(false)),
                glass: build(Some(Face::Front), &choice.constants(true)),
            }
        };
        let colours = Colours::of(choice.fake, gpu);
        ForwardPasses { cube_map: into(colours.cube_map, 1), picture: into(colours.picture, colours.samples) }
    }

    /// The shadow pass of a shape.
    pub fn casting(&self, casting: Casting) -> Option<&RenderPipeline> {
        match casting {
            Casting::Nothing => None,
            Casting::BothSides => Some(&self.both_sides),
            Casting::BackFaces => Some(&self.back_faces),
            Casting::FrontFaces => Some(&self.front_faces),
        }
    }
}

fn compile(
    gpu: &Gpu,
    shadow: &wgpu::ShaderModule,
    forward: wgpu::ShaderModule,
    resolve: &wgpu::ShaderModule,
) -> Pipelines {
    let texture =
        |sample_type, view_dimension| BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let array = texture(wgpu::TextureSampleType::Uint, TextureViewDimension::D2Array);
    let cube = texture(wgpu::TextureSampleType::Float { filterable: true }, TextureViewDimension::Cube);
    let sampler = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let shadow_layout = layout(gpu, &[uniform::<crate::gpu_data::View>(true)]);
    let frame = [uniform::<crate::gpu_data::View>(true), uniform::<crate::gpu_data::Lights>(false), array];
    let frame_layout = layout(gpu, &frame);
    let object = [uniform::<crate::gpu_data::Object>(true), cube, sampler];
    let object_layout = layout(gpu, &object);
    let surface_layout = layout(gpu, &object[..1]);
    let resolve_layout = layout(gpu, &[array]);

    let casting = |cull_mode| {
        let groups: &[_] = &[&shadow_layout];
        Build { cull_mode, ..Build::of(groups, shadow, SHADOW) }.pipeline(gpu)
    };
    let format = Colours::of(Fake::Fair, gpu).picture;
    let groups: &[_] = &[&resolve_layout];
    let resolve = Build { full_screen: true, ..Build::of(groups, resolve, format) };
    Pipelines {
        sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        }),
        resolve: resolve.pipeline(gpu),
        surface_layout,
        features: None,
        forward_module: forward,
        forward: Vec::new(),
        both_sides: casting(None),
        back_faces: casting(Some(Face::Front)),
        front_faces: casting(Some(Face::Back)),
        shadow_layout,
        frame_layout,
        object_layout,
        resolve_layout,
    }
}

/// Bindings 0, 1, 2 ... of a group; every stage may read all of them.
fn layout(gpu: &Gpu, bindings: &[BindingType]) -> BindGroupLayout {
    let entry = |(binding, ty): (usize, &BindingType)| wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: ShaderStages::VERTEX_FRAGMENT,
        ty: *ty,
        count: None,
    };
    let entries: Vec<_> = bindings.iter().enumerate().map(entry).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

fn uniform<T>(has_dynamic_offset: bool) -> BindingType {
    BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset,
        min_binding_size: NonZeroU64::new(size_of::<T>() as u64),
    }
}

/// What tells the pipelines apart.
#[derive(Clone, Copy)]
struct Build<'a> {
    groups: &'a [&'a BindGroupLayout],
    module: &'a wgpu::ShaderModule,
    format: TextureFormat,
    /// How many of that format.
    targets: usize,
    samples: u32,
    cull_mode: Option<Face>,
    /// One triangle without corners and depth.
    full_screen: bool,
    /// Values of the module's overrides.
    constants: &'a [(&'a str, f64)],
}

impl<'a> Build<'a> {
    /// Both sides of corners in space, one sample into one target.
    fn of(groups: &'a [&'a BindGroupLayout], module: &'a wgpu::ShaderModule, format: TextureFormat) -> Self {
        Build { groups, module, format, targets: 1, samples: 1, cull_mode: None, full_screen: false, constants: &[] }
    }

    fn fragment(&self, gpu: &Gpu) -> &'static str {
        let bits = self.format == TextureFormat::Rgba32Uint;
        let with_depth = gpu.adapter.get_info().backend == wgpu::Backend::Gl;
        match (self.full_screen, with_depth, bits) {
            (true, ..) | (false, false, false) => "fragment",
            (false, false, true) => "fragment_bits",
            (false, true, false) => "fragment_and_depth",
            (false, true, true) => "fragment_bits_and_depth",
        }
    }

    fn pipeline(&self, gpu: &Gpu) -> RenderPipeline {
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
        let corners = [Some(wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
        })];
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
            primitive: wgpu::PrimitiveState { cull_mode: self.cull_mode, ..wgpu::PrimitiveState::default() },
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
