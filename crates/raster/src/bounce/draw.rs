//! Passes of the second bounce.

use super::{Bounce, BouncePipelines, NOTHING, patches_of};
use crate::gpu_data::PATCHES_SEEN;
use crate::passes::{Drawing, Things, bind, bits_of};
use crate::plan::Plan;
use crate::uniforms::offset;
use gpu::Gpu;
use wgpu::{BindGroup, BindingResource, CommandEncoder, RenderPass, RenderPipeline, TextureView};

/// What all of these passes are bound to.
#[derive(Clone, Copy)]
pub struct Bound<'a> {
    /// Group 0, nothing of the second bounce in it.
    pub frame: &'a BindGroup,
    /// The same with what was gathered, to take means of it.
    pub gathered: &'a BindGroup,
    /// Group 1 of shapes.
    pub object: &'a BindGroup,
}

/// Draws what the lights see.
pub fn draw_patches(
    encoder: &mut CommandEncoder,
    (plan, bounce): (&Plan, &Bounce),
    pipelines: &BouncePipelines,
    things: Things<'_>,
    targets: &super::BounceTargets,
    bound: Bound<'_>,
) {
    for (view, &layer) in bounce.views.clone().zip(&bounce.layers) {
        let colours = targets.patches.each_ref().map(|patches| &patches.each[layer]);
        let mut pass = begin(encoder, colours, &targets.patch_depth);
        pass.set_bind_group(0, bound.frame, &[offset(view)]);
        shapes(&mut pass, plan, pipelines, things, (patches_of(layer), bound.object));
    }
}

/// Gathers what those send to what is seen.
pub fn gather(
    gpu: &Gpu,
    encoder: &mut CommandEncoder,
    (plan, bounce): (&Plan, &Bounce),
    pipelines: &BouncePipelines,
    things: Things<'_>,
    targets: &super::BounceTargets,
    bound: Bound<'_>,
) {
    let Some([gather, smooth]) = pipelines.gathering(&bounce.gather) else { return };
    let view = offset(plan.picture_views.start);
    draw_seen(encoder, plan, pipelines, things, targets, bound);
    let [places, lights] = targets.patches.each_ref().map(|patches| BindingResource::TextureView(&patches.all));
    let [seen, marks] = targets.seen.each_ref().map(BindingResource::TextureView);
    let patches = bind(gpu, &pipelines.gather_layout, &[places, lights, seen, marks]);
    full_screen(encoder, gather, &targets.gathered, (bound.frame, view), Some(&patches));
    full_screen(encoder, smooth, &targets.smooth, (bound.gathered, view), None);
}

/// Where surfaces are that the picture shows.
pub fn draw_seen(
    encoder: &mut CommandEncoder,
    plan: &Plan,
    pipelines: &BouncePipelines,
    things: Things<'_>,
    targets: &super::BounceTargets,
    bound: Bound<'_>,
) {
    let mut pass = begin(encoder, targets.seen.each_ref(), &targets.seen_depth);
    pass.set_bind_group(0, bound.frame, &[offset(plan.picture_views.start)]);
    shapes(&mut pass, plan, pipelines, things, (PATCHES_SEEN, bound.object));
}

/// Lamps are no patches: their light is there already, and one of them is where a light looks from.
pub fn shapes(
    pass: &mut RenderPass<'_>,
    plan: &Plan,
    pipelines: &BouncePipelines,
    things: Things<'_>,
    (looker, object): (u32, &BindGroup),
) {
    let mut drawing = Drawing::new(pass, things);
    for (shape, variant) in plan.drawn(None).filter(|(_, variant)| !variant.glass) {
        if looker == PATCHES_SEEN || plan.objects[shape].emitting_sides == 0 {
            let pipeline = pipelines.patches(plan.choice(), looker, variant);
            drawing.draw((shape, plan.materials[shape]), pipeline, object);
        }
    }
}

/// One pass over all of a target.
pub fn full_screen(
    encoder: &mut CommandEncoder,
    pipeline: &RenderPipeline,
    target: &TextureView,
    (frame, view): (&BindGroup, u32),
    patches: Option<&BindGroup>,
) {
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(attachment(target))],
        ..wgpu::RenderPassDescriptor::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, frame, &[view]);
    if let Some(patches) = patches {
        pass.set_bind_group(1, patches, &[]);
    }
    pass.draw(0..3, 0..1);
}

/// A pass into two targets, empty at first.
pub fn begin<'e>(encoder: &'e mut CommandEncoder, colours: [&TextureView; 2], depth: &TextureView) -> RenderPass<'e> {
    let depth_ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &colours.map(|colour| Some(attachment(colour))),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(depth_ops),
            stencil_ops: None,
        }),
        ..wgpu::RenderPassDescriptor::default()
    })
}

fn attachment(view: &TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(bits_of(NOTHING)), store: wgpu::StoreOp::Store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }
}
