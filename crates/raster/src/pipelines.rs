//! Pipelines and the layouts of what is bound to them.

use crate::bounce::{BouncePipelines, Layouts};
use crate::build::Build;
use crate::casting::Casting;
use crate::caustic;
use crate::error::RasterError;
use crate::gpu_data::Lights;
use crate::knobs::ShadowFilter;
use crate::plan::Plan;
use crate::repair::{Repair, Repairs};
use crate::settings::Fake;
use crate::shaders;
use crate::targets::{Colours, FEATURES, SHADOW};
use crate::variant::{Space, Variant};
use gpu::Gpu;
use scene::Vec3;
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::num::NonZeroU64;
use wgpu::{BindGroupLayout, BindingType, Face, FrontFace, RenderPipeline, ShaderStages, TextureViewDimension};

/// What a forward pass draws into.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Into {
    /// A cube map's face.
    CubeMap,
    /// The picture that is looked at.
    Picture,
}

/// What is compiled into all forward passes of a picture: a software device would run the branches that are not taken
/// too, or compile them anew for every draw. What its shapes differ in is a [`Variant`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Choice {
    /// Decides the targets' formats.
    pub fake: Fake,
    /// What is repaired of it.
    pub repairs: Repairs,
    /// How shadow maps are looked up.
    pub filter: ShadowFilter,
    /// Whether a sun shines.
    pub sun: bool,
    /// As in [`Lights::area_light_pattern`].
    pub area_light: u32,
    /// How the area light is integrated, as in [`Lights::area_light_form`].
    pub area_form: u32,
}

impl Choice {
    /// What a picture under `lights` needs.
    pub fn of((fake, repairs): (Fake, Repairs), filter: ShadowFilter, lights: &Lights) -> Choice {
        let sun = lights.sun_incident.cmpgt(Vec3::ZERO).any();
        let (area_light, area_form) = (lights.area_light_pattern, lights.area_light_form);
        Choice { fake, repairs, filter, sun, area_light, area_form }
    }

    /// Values of the overrides in `shaders/raster/forward.wgsl` and in what it imports.
    pub fn constants(&self, variant: Variant) -> Vec<(&'static str, f64)> {
        let own = [
            ("SHADOW_FILTER", f64::from(self.filter.code())),
            ("GLASS", f64::from(u8::from(variant.glass))),
            ("MIRROR", f64::from(u8::from(variant.mirror))),
            ("REPAIRS", f64::from(self.repairs.bits())),
            ("SUN", f64::from(u8::from(self.sun))),
            ("AREA_LIGHT", f64::from(self.area_light)),
            ("AREA_FORM", f64::from(self.area_form)),
            ("SHADING", f64::from(variant.shading)),
        ];
        [own.as_slice(), &variant.constants()].concat()
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
    /// Group 1 of the shadow pass and of the features' one: object.
    pub surface_layout: BindGroupLayout,
    /// Group 2 of all passes that draw shapes: pictures.
    pub look_layout: BindGroupLayout,
    /// Of the mesh of sunlight, once one is drawn.
    pub caustic: Option<RenderPipeline>,
    /// Of the second bounce, once it is gathered.
    pub bounce: Option<BouncePipelines>,
    forward_module: wgpu::ShaderModule,
    shadow_module: wgpu::ShaderModule,
    features_module: Option<wgpu::ShaderModule>,
    /// Of all that was asked for.
    forward: HashMap<(Choice, Into, Variant), RenderPipeline>,
    shadow: HashMap<(Casting, Variant), RenderPipeline>,
    features: HashMap<Variant, RenderPipeline>,
}

impl Pipelines {
    /// Composes and compiles all of them.
    pub fn new(gpu: &Gpu) -> Result<Pipelines, RasterError> {
        let shadow = shaders::compose("raster/shadow_map.wgsl")?.create(gpu)?;
        let forward = shaders::compose("raster/forward.wgsl")?.create(gpu)?;
        let resolve = shaders::compose("film/resolve.wgsl")?.create(gpu)?;
        Ok(gpu.checked("the fake's pipelines", || compile(gpu, shadow, forward, &resolve))?)
    }

    /// Sees to it that all that draws a plan is compiled; returns whether some was not.
    ///
    /// # Errors
    /// [`RasterError::Gpu`] if the device can't take them.
    pub fn prepare(&mut self, gpu: &Gpu, plan: &Plan) -> Result<bool, RasterError> {
        let variants: HashSet<Variant> = plan.variants.iter().copied().flatten().collect();
        let into = if plan.cube_maps.is_empty() { &[Into::Picture][..] } else { &[Into::CubeMap, Into::Picture] };
        let mut compiled = false;
        for (variant, into) in variants.iter().flat_map(|variant| into.iter().map(move |into| (*variant, *into))) {
            let key = (plan.choice(), into, variant);
            if !self.forward.contains_key(&key) {
                let made = gpu.checked("the fake's pipelines", || self.compile_forward(gpu, key))?;
                (compiled, _) = (true, self.forward.insert(key, made));
            }
        }
        let casting = plan.casting.iter().zip(&plan.variants).filter(|(casting, _)| **casting != Casting::Nothing);
        let casting = casting.filter_map(|(casting, variant)| Some((*casting, (*variant)?.in_shadow_map())));
        // light through glass falls on either side of what is drawn
        let receivers = plan.drawn(None).filter(|_| !plan.receivers.is_empty());
        let receivers = receivers.map(|(_, variant)| (Casting::BothSides, variant.in_shadow_map()));
        for key in casting.chain(receivers).collect::<HashSet<_>>() {
            if !self.shadow.contains_key(&key) {
                let made = gpu.checked("the fake's pipelines", || self.compile_shadow(gpu, key))?;
                (compiled, _) = (true, self.shadow.insert(key, made));
            }
        }
        if !plan.receivers.is_empty() && self.caustic.is_none() {
            self.caustic = Some(caustic::pipeline(gpu, &self.frame_layout)?);
            compiled = true;
        }
        if plan.bounce.is_some() || plan.probes.is_some() {
            let bounce = match self.bounce.take() {
                Some(bounce) => bounce,
                None => BouncePipelines::new(gpu)?,
            };
            let (frame, object, look) = (&self.frame_layout, &self.object_layout, &self.look_layout);
            compiled |= self.bounce.insert(bounce).prepare(gpu, Layouts { frame, object, look }, plan)?;
        }
        Ok(compiled)
    }

    /// Sees to it that the features' pass is compiled; returns whether it was not.
    ///
    /// # Errors
    /// [`RasterError::Gpu`] if the device can't take it.
    pub fn prepare_features(&mut self, gpu: &Gpu, plan: &Plan) -> Result<bool, RasterError> {
        let module = match self.features_module.take() {
            Some(module) => module,
            None => shaders::compose("raster/features.wgsl")?.create(gpu)?,
        };
        let module = self.features_module.insert(module);
        let groups: &[_] = &[&self.shadow_layout, &self.surface_layout, &self.look_layout];
        let mut compiled = false;
        let variants = plan.variants.iter().flatten().map(|variant| variant.in_features());
        for variant in variants.collect::<HashSet<_>>() {
            if let Entry::Vacant(place) = self.features.entry(variant) {
                let constants = &variant.constants();
                let front_face = front_face(variant);
                let build = Build { targets: 2, constants, front_face, ..Build::of(groups, module, FEATURES) };
                place.insert(gpu.checked("the fake's pipelines", || build.pipeline(gpu))?);
                compiled = true;
            }
        }
        Ok(compiled)
    }

    /// The forward pass of a variant, once [`Pipelines::prepare`] has compiled it.
    pub fn forward(&self, choice: Choice, into: Into, variant: Variant) -> Option<&RenderPipeline> {
        self.forward.get(&(choice, into, variant))
    }

    /// The shadow pass of a shape, likewise; `None` of what casts none.
    pub fn casting(&self, casting: Casting, variant: Variant) -> Option<&RenderPipeline> {
        self.shadow.get(&(casting, variant.in_shadow_map()))
    }

    /// The features' pass of a variant, once [`Pipelines::prepare_features`] has compiled it.
    pub fn features(&self, variant: Variant) -> Option<&RenderPipeline> {
        self.features.get(&variant.in_features())
    }

    fn compile_forward(&self, gpu: &Gpu, (choice, into, variant): (Choice, Into, Variant)) -> RenderPipeline {
        let groups: &[_] = &[&self.frame_layout, &self.object_layout, &self.look_layout];
        let colours = Colours::of(choice.fake, gpu);
        let (format, samples) = match into {
            Into::CubeMap => (colours.cube_map, 1),
            Into::Picture => (colours.picture, colours.samples),
        };
        let constants = &choice.constants(variant);
        let build = Build { samples, constants, ..Build::of(groups, &self.forward_module, format) };
        let near_side = choice.repairs.has_any(&[Repair::FrontFace, Repair::TwoInterfaces, Repair::Fresnel]);
        let cull_mode = variant.glass.then_some(if near_side { Face::Back } else { Face::Front });
        Build { cull_mode, front_face: front_face(variant), ..build }.pipeline(gpu)
    }

    fn compile_shadow(&self, gpu: &Gpu, (casting, variant): (Casting, Variant)) -> RenderPipeline {
        let groups: &[_] = &[&self.shadow_layout, &self.surface_layout, &self.look_layout];
        let cull_mode = match casting {
            Casting::Nothing | Casting::BothSides => None,
            Casting::BackFaces => Some(Face::Front),
            Casting::FrontFaces => Some(Face::Back),
        };
        let constants = &variant.constants();
        let build = Build { cull_mode, constants, ..Build::of(groups, &self.shadow_module, SHADOW) };
        Build { front_face: front_face(variant), ..build }.pipeline(gpu)
    }
}

/// Which way round the triangles of a variant are seen from outside.
pub fn front_face(variant: Variant) -> FrontFace {
    if variant.space == Space::MirroredMesh { FrontFace::Cw } else { FrontFace::Ccw }
}

fn compile(
    gpu: &Gpu,
    shadow: wgpu::ShaderModule,
    forward: wgpu::ShaderModule,
    resolve: &wgpu::ShaderModule,
) -> Pipelines {
    let texture =
        |sample_type, view_dimension| BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let array = texture(wgpu::TextureSampleType::Uint, TextureViewDimension::D2Array);
    let bits = texture(wgpu::TextureSampleType::Uint, TextureViewDimension::D2);
    let cube = texture(wgpu::TextureSampleType::Float { filterable: true }, TextureViewDimension::Cube);
    let picture = texture(wgpu::TextureSampleType::Float { filterable: true }, TextureViewDimension::D2);
    let sampler = BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let caustics = texture(wgpu::TextureSampleType::Float { filterable: true }, TextureViewDimension::D2Array);
    let lights = uniform::<crate::gpu_data::Lights>(false);
    let frame = [uniform::<crate::gpu_data::View>(true), lights, array, caustics, array, sampler, bits, bits];
    let object = [uniform::<crate::gpu_data::Object>(true), cube, sampler];
    let look = [[uniform::<crate::gpu_data::Look>(false)].as_slice(), &[picture; 5], &[sampler; 5]].concat();
    let resolve_layout = layout(gpu, &[array]);
    let groups: &[_] = &[&resolve_layout];
    let resolve = Build { full_screen: true, ..Build::of(groups, resolve, Colours::of(Fake::Fair, gpu).picture) };
    Pipelines {
        sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..wgpu::SamplerDescriptor::default()
        }),
        resolve: resolve.pipeline(gpu),
        shadow_layout: layout(gpu, &[uniform::<crate::gpu_data::View>(true)]),
        frame_layout: layout(gpu, &frame),
        object_layout: layout(gpu, &object),
        surface_layout: layout(gpu, &object[..1]),
        look_layout: layout(gpu, &look),
        resolve_layout,
        caustic: None,
        bounce: None,
        forward_module: forward,
        shadow_module: shadow,
        features_module: None,
        forward: HashMap::new(),
        shadow: HashMap::new(),
        features: HashMap::new(),
    }
}

/// Bindings 0, 1, 2 ... of a group; every stage may read all of them.
pub fn layout(gpu: &Gpu, bindings: &[BindingType]) -> BindGroupLayout {
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
