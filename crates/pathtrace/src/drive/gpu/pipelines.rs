//! Pipelines, compiled for what a scene needs and its settings choose, and the layouts of what is bound to them.
//!
//! What they are compiled for is named in `shaders/pathtrace/needs.wgsl`.

use super::GpuTraceError;
use super::film_data::RenderParams;
use super::scene_data::Header;
use super::shape_data::{FewShape, MOST_SHAPES, ShapeKinds};
use crate::caster::cone::Cones;
use crate::integrator::settings::ConesAt;
use crate::light::flat::Outline;
use crate::light::{Light, Lights};
use crate::sampling::sampler::SamplerKind;
use crate::shaders;
use gpu::{Gpu, wgpu};
use scene::{Needs, Scene};
use std::num::NonZeroU64;
use wgpu::{BindGroupLayout, BindingType, BufferBindingType, ComputePipeline};

/// What a pipeline is bound to beside the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Bound {
    /// A film, to which samples are added.
    Film,
    /// A film, and a map of photons.
    FilmAndMap,
    /// A list of photons.
    Photons,
    /// Sums of what pixels show.
    Features,
}

/// The shader of a pipeline, and what of an integrator's settings is compiled into it: those of its overrides that
/// differ from the shader's own values.
#[derive(Debug, Clone, PartialEq)]
pub struct PipelineKey {
    shader: &'static str,
    constants: Vec<(&'static str, f64)>,
    bound: Bound,
}

impl PipelineKey {
    /// Of a file under `shaders/`, with these values of the overrides that the integrator alone knows.
    pub fn new(shader: &'static str, sampler: SamplerKind, constants: &[(&'static str, f64)]) -> Self {
        let sobol = ("SOBOL", flag(sampler == SamplerKind::Sobol));
        PipelineKey { shader, constants: [&[sobol], constants].concat(), bound: Bound::Film }
    }

    /// The same shader, bound to something else than a film alone.
    pub(crate) fn bound_to(self, bound: Bound) -> Self {
        PipelineKey { bound, ..self }
    }

    /// Names of the overrides that speak of the settings.
    pub(crate) fn constant_names(self) -> impl Iterator<Item = &'static str> {
        self.constants.into_iter().map(|(name, _)| name)
    }
}

/// The value of an override that says whether something is there.
pub fn flag(set: bool) -> f64 {
    f64::from(u8::from(set))
}

/// Kinds of what is sampled as a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct LightKinds {
    rectangles: bool,
    triangles: bool,
    disks: bool,
    balls: bool,
    points: bool,
    environment: bool,
    /// Whether they are so many that a tree chooses among them.
    many: bool,
}

impl LightKinds {
    fn of(lights: &Lights) -> Self {
        let mut kinds = LightKinds { many: lights.table().tree().is_some(), ..Self::default() };
        for light in &lights.lights {
            match light {
                Light::Flat(flat, _) => match flat.outline {
                    Outline::Rectangle | Outline::Parallelogram => kinds.rectangles = true,
                    Outline::Triangle => kinds.triangles = true,
                    Outline::Disk => kinds.disks = true,
                },
                Light::Sphere(..) => kinds.balls = true,
                Light::Point(_) => kinds.points = true,
                Light::Environment(_) => kinds.environment = true,
                Light::Sun(_) => {}
            }
        }
        kinds
    }
}

/// What a scene needs of a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SceneNeeds {
    needs: Needs,
    shapes: ShapeKinds,
    large_meshes: bool,
    lights: LightKinds,
    /// Whether there are meshes of mirror or glass that get cones ...
    usual_cones: bool,
    /// ... or any shapes.
    all_cones: bool,
    /// Everything is compiled in, as if the scene had some of it.
    everything: bool,
}

impl SceneNeeds {
    /// Whether code for everything is wanted, also for what no scene of this kind asks for.
    pub fn everything(&self) -> bool {
        self.everything
    }

    /// What this scene needs.
    pub(crate) fn of(scene: &Scene, lights: &Lights, shapes: ShapeKinds, large_meshes: bool) -> Self {
        let has_cones = |at| !Cones::new(at, scene, lights).is_empty();
        SceneNeeds {
            needs: scene.needs(),
            shapes,
            large_meshes,
            lights: LightKinds::of(lights),
            usual_cones: has_cones(ConesAt::Usual),
            all_cones: has_cones(ConesAt::Everything),
            everything: false,
        }
    }

    /// The same, with code for all that any scene can ask for: to measure what leaving it out saves.
    pub fn with_everything(self) -> Self {
        SceneNeeds { everything: true, ..self }
    }

    /// Values of the overrides in `shaders/pathtrace/needs.wgsl` that say which shapes there are.
    pub fn shape_constants(&self) -> [(&'static str, f64); 7] {
        [
            ("FEW_SHAPES", flag(self.shapes.few)),
            ("QUADRILATERALS", self.flag(self.shapes.quadrilaterals)),
            ("TRIANGLES", self.flag(self.shapes.triangles)),
            ("SPHERES", self.flag(self.shapes.spheres)),
            ("DISKS", self.flag(self.shapes.disks)),
            ("LARGE_MESHES", self.flag(self.large_meshes)),
            ("COINCIDENT", self.flag(self.shapes.coincident)),
        ]
    }

    /// Values of all the overrides of `shaders/pathtrace/needs.wgsl` that speak of the scene.
    pub fn constants(&self) -> Vec<(&'static str, f64)> {
        let mut constants = self.shape_constants().to_vec();
        constants.extend([
            ("CHECKERBOARD", self.flag(self.needs.checkerboard)),
            ("MIRROR", self.flag(self.needs.mirror)),
            ("ROUGH_CONDUCTOR", self.flag(self.needs.rough_conductor)),
            ("METALLIC_ROUGHNESS", self.flag(self.needs.metallic_roughness)),
            ("DIELECTRIC", self.flag(self.needs.dielectric)),
            ("RECTANGLE_LIGHTS", self.flag(self.lights.rectangles)),
            ("TRIANGLE_LIGHTS", self.flag(self.lights.triangles)),
            ("DISK_LIGHTS", self.flag(self.lights.disks)),
            ("BALL_LIGHTS", self.flag(self.lights.balls)),
            ("MANY_LIGHTS", flag(self.lights.many)),
            ("POINT_LIGHTS", self.flag(self.lights.points)),
            ("SUN", self.flag(self.needs.sun)),
            ("ENVIRONMENT", self.flag(self.lights.environment)),
            ("CASTERS", self.flag(self.needs.casters)),
            ("USUAL_CONES", self.flag(self.usual_cones)),
            ("ALL_CONES", self.flag(self.all_cones)),
            ("SHADING_NORMALS", self.flag(self.needs.shading_normals)),
            ("IMAGE_TEXTURES", self.flag(self.needs.image_textures)),
            ("ALPHA_MASKS", self.flag(self.needs.alpha_masks)),
        ]);
        constants
    }

    /// Names of the overrides that speak of the scene.
    pub(crate) fn constant_names() -> impl Iterator<Item = &'static str> {
        let (needs, shapes, lights) = (Needs::default(), ShapeKinds::default(), LightKinds::default());
        let (large_meshes, usual_cones, all_cones, everything) = (false, false, false, false);
        let nothing = SceneNeeds { needs, shapes, large_meshes, lights, usual_cones, all_cones, everything };
        nothing.constants().into_iter().map(|(name, _)| name)
    }

    fn flag(&self, needed: bool) -> f64 {
        flag(needed || self.everything)
    }
}

/// All pipelines of a scene, each compiled when it is first asked for.
#[derive(Debug)]
pub struct Pipelines {
    /// Group 0: the scene.
    pub scene_layout: BindGroupLayout,
    /// Group 1: what is asked for, and the film.
    pub film_layout: BindGroupLayout,
    /// Group 1 of what traces photons: what is asked for, what sends them out, and their list.
    pub photon_layout: BindGroupLayout,
    /// Group 2 of what gathers photons: their map.
    pub map_layout: BindGroupLayout,
    /// Group 1 of what traces features: what is asked for, and sums of what pixels show.
    pub(crate) feature_layout: BindGroupLayout,
    needs: SceneNeeds,
    compiled: Vec<(PipelineKey, ComputePipeline)>,
}

impl Pipelines {
    /// The layouts; no pipeline yet.
    ///
    /// # Errors
    /// [`GpuTraceError::Unable`] if the device has too few bindings for storage or no compute shaders.
    pub fn new(gpu: &Gpu, needs: SceneNeeds) -> Result<Self, GpuTraceError> {
        enough_storage(gpu, 8)?;
        enough(gpu, "threads in a group", gpu.device.limits().max_compute_invocations_per_workgroup, 64)?;
        let [scene_layout, film_layout, photon_layout, map_layout, feature_layout] =
            gpu.checked("the path tracer's bindings", || {
                let read = BufferBindingType::Storage { read_only: true };
                let mut scene = vec![buffer(BufferBindingType::Uniform, size_of::<Header>())];
                scene.extend([buffer(read, 0); 6]);
                scene.push(buffer(BufferBindingType::Uniform, MOST_SHAPES * size_of::<FewShape>()));
                // the sky's
                scene.extend([TEXTURE; 2]);
                scene.extend([buffer(read, 0), TEXTURES]);
                let written = buffer(BufferBindingType::Storage { read_only: false }, 0);
                let film = [buffer(BufferBindingType::Uniform, size_of::<RenderParams>()), written];
                let photons = [BufferKind::Uniform, BufferKind::Read, BufferKind::Written];
                let features = [BufferKind::Uniform, BufferKind::Written];
                let own = [&photons[..], &[BufferKind::Read], &features].map(|kinds| layout_of(gpu, kinds));
                let [photons, map, features] = own;
                [layout(gpu, &scene), layout(gpu, &film), photons, map, features]
            })?;
        let compiled = Vec::new();
        Ok(Pipelines { scene_layout, film_layout, photon_layout, map_layout, feature_layout, needs, compiled })
    }

    /// What they are compiled for.
    pub fn needs(&self) -> SceneNeeds {
        self.needs
    }

    /// Whether a pipeline is there already.
    pub fn has_compiled(&self, key: &PipelineKey) -> bool {
        self.compiled.iter().any(|(compiled, _)| compiled == key)
    }

    /// The pipeline of a key.
    ///
    /// # Errors
    /// [`gpu::GpuError::Refused`] if the device can't take it.
    pub fn prepare(&mut self, gpu: &Gpu, key: &PipelineKey) -> Result<ComputePipeline, GpuTraceError> {
        if let Some((_, pipeline)) = self.compiled.iter().find(|(compiled, _)| compiled == key) {
            return Ok(pipeline.clone());
        }
        let module = shaders::compose(key.shader)?.create(gpu)?;
        let constants = [self.needs.constants(), key.constants.clone()].concat();
        if matches!(key.bound, Bound::FilmAndMap | Bound::Photons) {
            enough_storage(gpu, 9)?;
        }
        let own = match key.bound {
            Bound::Features => vec![&self.feature_layout],
            Bound::Film => vec![&self.film_layout],
            Bound::FilmAndMap => vec![&self.film_layout, &self.map_layout],
            Bound::Photons => vec![&self.photon_layout],
        };
        let groups: Vec<_> = [&self.scene_layout].into_iter().chain(own).map(Some).collect();
        let pipeline = gpu.checked("the path tracer's pipeline", || {
            let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some("path tracer"),
                layout: Some(&layout),
                module: &module,
                entry_point: Some("trace"),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &constants,
                    ..wgpu::PipelineCompilationOptions::default()
                },
                cache: None,
            })
        })?;
        self.compiled.push((key.clone(), pipeline.clone()));
        Ok(pipeline)
    }
}

/// Whether a shader can be bound to so many storage buffers.
fn enough_storage(gpu: &Gpu, needs: u32) -> Result<(), GpuTraceError> {
    enough(gpu, "storage buffers in a shader", gpu.device.limits().max_storage_buffers_per_shader_stage, needs)
}

fn enough(gpu: &Gpu, what: &'static str, has: u32, needs: u32) -> Result<(), GpuTraceError> {
    if has >= needs { Ok(()) } else { Err(GpuTraceError::Unable { adapter: gpu.describe(), what, has, needs }) }
}

/// What a shader does with a buffer.
#[derive(Debug, Clone, Copy)]
pub(crate) enum BufferKind {
    /// Reads it, a small one.
    Uniform,
    /// A storage buffer that shaders only read.
    Read,
    /// Reads and writes it.
    Written,
}

/// Buffers at bindings 0, 1, 2 ... of a group.
pub(crate) fn layout_of(gpu: &Gpu, kinds: &[BufferKind]) -> BindGroupLayout {
    let of_kind = |kind: &BufferKind| match kind {
        BufferKind::Uniform => BufferBindingType::Uniform,
        BufferKind::Read => BufferBindingType::Storage { read_only: true },
        BufferKind::Written => BufferBindingType::Storage { read_only: false },
    };
    let bindings: Vec<_> = kinds.iter().map(|kind| buffer(of_kind(kind), 0)).collect();
    layout(gpu, &bindings)
}

/// A group of whole buffers at bindings 0, 1, 2 ...
///
/// # Errors
/// [`gpu::GpuError::Refused`] if the device can't take it.
pub(crate) fn group(
    gpu: &Gpu,
    what: &str,
    layout: &BindGroupLayout,
    buffers: &[&wgpu::Buffer],
) -> Result<wgpu::BindGroup, GpuTraceError> {
    let resources = buffers.iter().map(|buffer| buffer.as_entire_binding());
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    let descriptor = wgpu::BindGroupDescriptor { label: Some(what), layout, entries: &entries };
    Ok(gpu.checked(what, || gpu.device.create_bind_group(&descriptor))?)
}

/// A buffer of at least so many bytes.
fn buffer(ty: BufferBindingType, size: usize) -> BindingType {
    BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: NonZeroU64::new(size as u64) }
}

/// A texture of floats, read texel by texel.
const TEXTURE: BindingType = BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: false },
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};

/// The same in several layers.
const TEXTURES: BindingType = BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: false },
    view_dimension: wgpu::TextureViewDimension::D2Array,
    multisampled: false,
};

/// Bindings 0, 1, 2 ... of a group.
fn layout(gpu: &Gpu, bindings: &[BindingType]) -> BindGroupLayout {
    let entry = |(binding, &ty): (usize, &BindingType)| wgpu::BindGroupLayoutEntry {
        binding: binding as u32,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let entries: Vec<_> = bindings.iter().enumerate().map(entry).collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}
