//! What the passes of a frame are bound to.

use crate::gpu_data::{Lights, Object, View};
use crate::passes::{bind, sized};
use crate::pipelines::Pipelines;
use crate::targets::Targets;
use crate::uniforms::Uniforms;
use gpu::Gpu;
use wgpu::{BindGroup, BindingResource, TextureView};

/// The bind groups of a frame, for all of its passes.
pub struct Groups {
    /// Group 0 of shadow passes: a view.
    pub shadow: BindGroup,
    /// Group 1 of those: a shape's numbers.
    pub object: BindGroup,
    /// Group 0 of forward passes, but for the picture's.
    pub frame: BindGroup,
    /// The same while caustic maps are drawn: the shadow map is that of what they fall on.
    pub receivers: BindGroup,
    /// The same with light of the second bounce as it was gathered ...
    pub gathered: BindGroup,
    /// ... and as the picture looks it up.
    pub picture: BindGroup,
    /// Group 1 of forward passes, of shapes that have no cube map ...
    pub without_cube_map: BindGroup,
    /// ... and of those that have one, in the order of the plan.
    pub with_cube_map: Vec<BindGroup>,
}

impl Groups {
    /// Binds a frame's numbers and targets.
    pub fn new(gpu: &Gpu, pipelines: &Pipelines, uniforms: &Uniforms, targets: Targets<'_>) -> Groups {
        let view = || sized::<View>(&uniforms.views);
        let shadow_map = BindingResource::TextureView(&targets.shadow.map.all);
        let object = |cube: &TextureView| {
            let sampler = BindingResource::Sampler(&pipelines.sampler);
            let object = sized::<Object>(&uniforms.objects);
            bind(gpu, &pipelines.object_layout, &[object, BindingResource::TextureView(cube), sampler])
        };
        let surface = sized::<Object>(&uniforms.objects);
        let frame = |[light, receivers]: [&TextureView; 2], bounce: [&TextureView; 2]| {
            let [light, receivers] = [light, receivers].map(BindingResource::TextureView);
            let [bounce, places] = bounce.map(BindingResource::TextureView);
            let sampler = BindingResource::Sampler(&pipelines.sampler);
            let lights = sized::<Lights>(&uniforms.lights);
            let maps = [view(), lights, shadow_map.clone(), light, receivers, sampler, bounce, places];
            bind(gpu, &pipelines.frame_layout, &maps)
        };
        let (caustics, bounce) = (targets.caustics, targets.bounce);
        let drawn = [&caustics.light.all, &caustics.receivers.all];
        let no_bounce = [&bounce.none; 2];
        Groups {
            object: bind(gpu, &pipelines.surface_layout, &[surface]),
            shadow: bind(gpu, &pipelines.shadow_layout, &[view()]),
            frame: frame(drawn, no_bounce),
            receivers: frame([&caustics.none[0], &caustics.receivers.all], no_bounce),
            gathered: frame(drawn, [&bounce.gathered, &bounce.seen[0]]),
            picture: frame(drawn, [&bounce.smooth, &bounce.seen[0]]),
            without_cube_map: object(&targets.cubes.none),
            with_cube_map: targets.cubes.each.iter().map(|cube| object(&cube.all)).collect(),
        }
    }
}
