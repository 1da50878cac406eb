//! The pipelines of the second bounce, compiled when a frame first has it.

use super::Bounce;
use super::knobs::PatchClamp;
use super::{Gather, GatherKnobs};
use crate::build::Build;
use crate::error::RasterError;
use crate::gpu_data::{PATCHES_OF_AREA_LIGHT, PATCHES_OF_PROBES, PATCHES_OF_SUN, PATCHES_SEEN};
use crate::pipelines::{Choice, front_face, layout};
use crate::plan::Plan;
use crate::shaders;
use crate::targets::FEATURES;
use crate::variant::Variant;
use gpu::Gpu;
use std::collections::HashMap;
use wgpu::{BindGroupLayout, BindingType, RenderPipeline, TextureViewDimension};

/// Who looks by a layer of the lights' maps: one of `PATCHES_*`.
pub fn patches_of(layer: usize) -> u32 {
    if layer == 0 { PATCHES_OF_SUN } else { PATCHES_OF_AREA_LIGHT }
}

/// Names of the overrides of these pipelines.
pub fn override_names() -> impl Iterator<Item = &'static str> {
    let gather = Gather { layers: 1, knobs: GatherKnobs::default(), blockers: [0; 2] };
    gather.constants().map(|(name, _)| name).into_iter().chain(["PATCHES_OF"])
}

impl Gather {
    /// Values of the overrides in `shaders/raster/repair/gather.wgsl`.
    fn constants(&self) -> [(&'static str, f64); 6] {
        let GatherKnobs { clamp, shapes_hide, .. } = self.knobs;
        [
            ("LAYERS", f64::from(self.layers)),
            ("STRIDE", f64::from(self.knobs.stride())),
            ("DISC", f64::from(u8::from(clamp == PatchClamp::Disc))),
            ("SHAPES_HIDE", f64::from(u8::from(shapes_hide))),
            ("SPHERE_COUNT", f64::from(self.blockers[0])),
            ("BOX_COUNT", f64::from(self.blockers[1])),
        ]
    }
}

/// Layouts of what these pipelines share with the others.
#[derive(Debug, Clone, Copy)]
pub struct Layouts<'a> {
    /// Group 0: view, lights, maps.
    pub frame: &'a BindGroupLayout,
    /// Group 1 of what draws shapes.
    pub object: &'a BindGroupLayout,
    /// Group 2 of what draws shapes.
    pub look: &'a BindGroupLayout,
}

/// All pipelines of the second bounce.
#[derive(Debug)]
pub struct BouncePipelines {
    /// Group 1 of the pass that gathers: patches, and what is seen.
    pub gather_layout: BindGroupLayout,
    /// Group 1 of what probes are asked: places, light, harmonics.
    pub probe_layout: BindGroupLayout,
    probes_module: wgpu::ShaderModule,
    probes: Option<[RenderPipeline; 3]>,
    patches_module: wgpu::ShaderModule,
    gather_module: wgpu::ShaderModule,
    smooth_module: wgpu::ShaderModule,
    patches: HashMap<(Choice, u32, Variant), RenderPipeline>,
    gather: HashMap<Gather, RenderPipeline>,
    smooth: HashMap<u32, RenderPipeline>,
}

impl BouncePipelines {
    /// None compiled yet.
    ///
    /// # Errors
    /// [`RasterError::Gpu`] if the device can't take the shaders.
    pub fn new(gpu: &Gpu) -> Result<BouncePipelines, RasterError> {
        let texture = |view_dimension| BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension,
            multisampled: false,
        };
        let [array, one] = [TextureViewDimension::D2Array, TextureViewDimension::D2].map(texture);
        Ok(BouncePipelines {
            gather_layout: layout(gpu, &[array, array, one, one]),
            probe_layout: layout(gpu, &[one; 3]),
            probes_module: shaders::compose("raster/repair/probes.wgsl")?.create(gpu)?,
            probes: None,
            patches_module: shaders::compose("raster/repair/patches.wgsl")?.create(gpu)?,
            gather_module: shaders::compose("raster/repair/gather.wgsl")?.create(gpu)?,
            smooth_module: shaders::compose("raster/repair/smooth.wgsl")?.create(gpu)?,
            patches: HashMap::new(),
            gather: HashMap::new(),
            smooth: HashMap::new(),
        })
    }

    /// Sees to it that all that a plan's bounce needs is compiled; returns whether some was not.
    ///
    /// # Errors
    /// [`RasterError::Gpu`] if the device can't take it.
    pub fn prepare(&mut self, gpu: &Gpu, layouts: Layouts<'_>, plan: &Plan) -> Result<bool, RasterError> {
        let mut compiled = false;
        let layers = plan.bounce.as_ref().map_or(&[][..], |bounce| &bounce.layers);
        let of_lights = layers.iter().map(|layer| patches_of(*layer));
        let lookers = of_lights.chain(plan.probes.as_ref().map(|_| PATCHES_OF_PROBES)).chain([PATCHES_SEEN]);
        for (looker, (_, variant)) in lookers.flat_map(|looker| plan.drawn(None).map(move |drawn| (looker, drawn))) {
            let key = (plan.choice(), looker, variant);
            if !variant.glass && !self.patches.contains_key(&key) {
                let made = gpu.checked("the fake's pipelines", || self.compile_patches(gpu, layouts, key))?;
                (compiled, _) = (true, self.patches.insert(key, made));
            }
        }
        if plan.probes.is_some() && self.probes.is_none() {
            let groups: &[_] = &[layouts.frame, &self.probe_layout];
            let build = |entry| {
                let build = Build::of(groups, &self.probes_module, FEATURES);
                Build { full_screen: true, entry: Some([entry; 2]), ..build }.pipeline(gpu)
            };
            let made = gpu.checked("the fake's pipelines", || ["relight", "project", "gather"].map(build))?;
            (compiled, _) = (true, self.probes.insert(made));
        }
        let Some(Bounce { gather, .. }) = &plan.bounce else { return Ok(compiled) };
        if !self.gather.contains_key(gather) {
            let made = gpu.checked("the fake's pipelines", || self.compile_gather(gpu, layouts, gather))?;
            (compiled, _) = (true, self.gather.insert(*gather, made));
        }
        let stride = gather.knobs.stride();
        if !self.smooth.contains_key(&stride) {
            let constants: &[_] = &[("STRIDE", f64::from(stride))];
            let groups: &[_] = &[layouts.frame];
            let build = Build { full_screen: true, constants, ..Build::of(groups, &self.smooth_module, FEATURES) };
            let made = gpu.checked("the fake's pipelines", || build.pipeline(gpu))?;
            (compiled, _) = (true, self.smooth.insert(stride, made));
        }
        Ok(compiled)
    }

    fn compile_patches(
        &self,
        gpu: &Gpu,
        layouts: Layouts<'_>,
        (choice, looker, variant): (Choice, u32, Variant),
    ) -> RenderPipeline {
        let groups: &[_] = &[layouts.frame, layouts.object, layouts.look];
        let mut constants = choice.constants(variant);
        constants.push(("PATCHES_OF", f64::from(looker)));
        let build = Build { constants: &constants, targets: 2, ..Build::of(groups, &self.patches_module, FEATURES) };
        Build { entry: Some(["patch_bits", "patch_bits_and_depth"]), front_face: front_face(variant), ..build }
            .pipeline(gpu)
    }

    fn compile_gather(&self, gpu: &Gpu, layouts: Layouts<'_>, gather: &Gather) -> RenderPipeline {
        let groups: &[_] = &[layouts.frame, &self.gather_layout];
        let constants: &[_] = &gather.constants();
        Build { full_screen: true, constants, ..Build::of(groups, &self.gather_module, FEATURES) }.pipeline(gpu)
    }

    /// What draws patches of a variant for who looks, once it is prepared.
    pub fn patches(&self, choice: Choice, looker: u32, variant: Variant) -> Option<&RenderPipeline> {
        self.patches.get(&(choice, looker, variant))
    }

    /// What lights what probes see, what makes harmonics of that, and what gathers those, once they are prepared.
    pub fn probing(&self) -> Option<[&RenderPipeline; 3]> {
        self.probes.as_ref().map(|pipelines| pipelines.each_ref())
    }

    /// What gathers, and what takes means of that, once they are prepared.
    pub fn gathering(&self, gather: &Gather) -> Option<[&RenderPipeline; 2]> {
        Some([self.gather.get(gather)?, self.smooth.get(&gather.knobs.stride())?])
    }
}
