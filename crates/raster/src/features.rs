//! What is seen of surfaces without light, rasterised: albedo, normal and depth of the first one that covers each of the
//! fair fake's samples. Glass and mirrors show their own, where rays go on to what is seen in them.

use crate::error::RasterError;
use crate::gpu_data::{Object, View};
use crate::passes::{Drawing, Things, bind, bits_of, resolve, sized};
use crate::pipelines::Pipelines;
use crate::plan::Plan;
use crate::targets::FeatureTargets;
use crate::uniforms::{Uniforms, offset};
use film::Features;
use gpu::{Gpu, GpuError};
use scene::Vec3;
use scene::glam::Vec4;
use wgpu::{CommandEncoder, RenderPass};

/// Submits the passes of a frame, or nothing before their pipeline is prepared.
pub fn draw(
    gpu: &Gpu,
    pipelines: &Pipelines,
    uniforms: &Uniforms,
    things: Things<'_>,
    targets: &FeatureTargets,
    plan: &Plan,
) {
    let views = bind(gpu, &pipelines.shadow_layout, &[sized::<View>(&uniforms.views)]);
    let objects = bind(gpu, &pipelines.surface_layout, &[sized::<Object>(&uniforms.objects)]);
    let label = Some("what is seen of surfaces");
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
    for (index, view) in plan.picture_views.clone().enumerate() {
        let mut pass = begin(&mut encoder, targets, index, plan.sky);
        pass.set_bind_group(0, &views, &[offset(view)]);
        let mut drawing = Drawing::new(&mut pass, things);
        for (shape, variant) in plan.drawn(None) {
            drawing.draw((shape, plan.materials[shape]), pipelines.features(variant), &objects);
        }
    }
    for (passes, resolved) in targets.passes.iter().zip(&targets.resolved) {
        resolve(gpu, &mut encoder, pipelines, (passes, resolved));
    }
    gpu.queue.submit([encoder.finish()]);
}

/// One of the passes, which holds the sky and nothing else.
fn begin<'e>(encoder: &'e mut CommandEncoder, targets: &FeatureTargets, pass: usize, sky: Vec3) -> RenderPass<'e> {
    let nothing = [sky.min(Vec3::ONE).extend(0.0), Vec4::ZERO].map(bits_of);
    let attachment = |colour: usize| {
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(nothing[colour]), store: wgpu::StoreOp::Store };
        let view = &targets.passes[colour].each[pass];
        Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
    };
    let depth_ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard };
    let depth =
        wgpu::RenderPassDepthStencilAttachment { view: &targets.depth, depth_ops: Some(depth_ops), stencil_ops: None };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[attachment(0), attachment(1)],
        depth_stencil_attachment: Some(depth),
        ..wgpu::RenderPassDescriptor::default()
    })
}

/// Brings both passes from the device as features.
pub fn read(gpu: &Gpu, targets: &FeatureTargets) -> Result<Features, RasterError> {
    let [albedo, normal] = &targets.resolved;
    let (albedo, normal) = (texels(gpu, albedo)?, texels(gpu, normal)?);
    let size = (targets.depth.texture().width(), targets.depth.texture().height());
    let xyz = |texels: &[Vec4]| texels.iter().map(|texel| texel.truncate()).collect::<Vec<_>>();
    let depth: Vec<f32> = albedo.iter().zip(&normal).map(|(albedo, normal)| depth(albedo.w, normal.w)).collect();
    Features::new(size, xyz(&albedo), xyz(&normal), depth).ok_or(RasterError::Incomplete)
}

/// The mean distance of what covers this share of a pixel.
fn depth(distance: f32, covered: f32) -> f32 {
    if covered > 0.0 { distance / covered } else { f32::INFINITY }
}

fn texels(gpu: &Gpu, view: &wgpu::TextureView) -> Result<Vec<Vec4>, GpuError> {
    let bytes = gpu.read_texture("what is seen of surfaces", view.texture())?;
    let number = |bytes: &[u8]| bytes.first_chunk().map_or(0.0, |bytes| f32::from_le_bytes(*bytes));
    let texel = |bytes: &[u8]| Vec4::from_array(std::array::from_fn(|channel| number(&bytes[4 * channel..])));
    Ok(bytes.chunks_exact(size_of::<Vec4>()).map(texel).collect())
}
