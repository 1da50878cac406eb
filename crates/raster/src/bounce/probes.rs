//! Irradiance probes: a grid of points, what they see around them in an atlas, and that as spherical harmonics, which light what
//! they see once more.

use super::{BouncePipelines, Bound, draw};
use crate::cube;
use crate::gpu_data::{Lights, View};
use crate::passes::{Things, bind};
use crate::plan::Plan;
use crate::planes::Planes;
use crate::repair::Repair;
use crate::settings::{RasterSettings, Show};
use crate::uniforms::offset;
use bytemuck::Zeroable;
use gpu::Gpu;
use scene::{Geometry, Scene, Vec3};
use std::f32::consts::SQRT_2;
use std::ops::Range;
use wgpu::{BindGroup, BindingResource, CommandEncoder, TextureView};

/// Points along each axis of the grid, as `shaders/raster/repair/probes.wgsl` has it.
pub const PROBES_SIDE: u32 = 5;
/// How many points there are.
pub const PROBES: u32 = PROBES_SIDE * PROBES_SIDE * PROBES_SIDE;
/// Texels along a side of a face of what a point sees, as `shaders/raster/repair/probes.wgsl` has it.
pub const PROBE_FACE: u32 = 8;
/// Spherical harmonics of a point.
pub const HARMONICS: u32 = 9;

/// How often what the points see is lit by what they saw: bounces beyond the second.
const ROUNDS: usize = 3;

/// The views of all points, six each, which are added to `views`; `None` where they are not repaired.
pub fn plan(
    scene: &Scene,
    lights: &mut Lights,
    settings: &RasterSettings,
    views: &mut Vec<View>,
) -> Option<Range<usize>> {
    if !settings.repairs().has(Repair::IrradianceProbes) || settings.show != Show::Picture {
        return None;
    }
    let first = views.len();
    let (low, high) = scene.bounds();
    lights.probe_low = low;
    // a flat scene has its probes in a plane
    lights.probe_cell = ((high - low) / PROBES_SIDE as f32).max(Vec3::splat(1e-6 * (high - low).max_element()));
    for row in 0..PROBES {
        let at = [row, row / PROBES_SIDE, row / (PROBES_SIDE * PROBES_SIDE)].map(|i| (i % PROBES_SIDE) as f32 + 0.5);
        let eye = low + Vec3::from_array(at) * lights.probe_cell;
        if is_buried(scene, eye) {
            lights.probes_buried[row as usize / 32] |= 1 << (row % 32);
        }
        let planes = Planes::fitted(scene, eye, SQRT_2);
        let view = |axis| {
            let clip_from_world = cube::clip_from_world(eye, axis, 1.0, planes);
            View { clip_from_world, near: planes.near, eye, ..View::zeroed() }
        };
        views.extend((0..6).map(view));
    }
    Some(first..views.len())
}

/// Whether a point lies within a ball or box, where it sees nothing of the scene.
fn is_buried(scene: &Scene, p: Vec3) -> bool {
    scene.shapes.iter().any(|shape| match shape.geometry {
        Geometry::Sphere { center, radius } => p.distance(center) < radius,
        Geometry::Box { corner, size, turn_y } => {
            let (sine, cosine) = turn_y.to_radians().sin_cos();
            let away = p - corner;
            let own = Vec3::new(cosine * away.x + sine * away.z, away.y, cosine * away.z - sine * away.x);
            own.cmpgt(Vec3::ZERO).all() && own.cmplt(size).all()
        }
        _ => false,
    })
}

/// What the points see, and what they are when it has lit itself.
pub fn draw_probes(
    gpu: &Gpu,
    encoder: &mut CommandEncoder,
    (plan, views): (&Plan, Range<usize>),
    pipelines: &BouncePipelines,
    things: Things<'_>,
    targets: &super::BounceTargets,
    bound: Bound<'_>,
) {
    let Some([relight, project, _]) = pipelines.probing() else { return };
    let first = offset(views.start);
    {
        let mut pass = draw::begin(encoder, targets.atlas.each_ref(), &targets.atlas_depth);
        for (index, view) in (0..).zip(views) {
            let [x, y] = [index % 6, index / 6].map(|place: u32| (place * PROBE_FACE) as f32);
            pass.set_viewport(x, y, PROBE_FACE as f32, PROBE_FACE as f32, 0.0, 1.0);
            pass.set_bind_group(0, bound.frame, &[offset(view)]);
            draw::shapes(&mut pass, plan, pipelines, things, (crate::gpu_data::PATCHES_OF_PROBES, bound.object));
        }
    }
    let [places, light] = targets.atlas.each_ref();
    let [harmonics, others] = targets.harmonics.each_ref();
    let group = |light, harmonics| group(gpu, pipelines, [places, light, harmonics]);
    draw::full_screen(encoder, project, harmonics, (bound.frame, first), Some(&group(light, others)));
    for _ in 1..ROUNDS {
        draw::full_screen(encoder, relight, &targets.relit, (bound.frame, first), Some(&group(light, harmonics)));
        let relit = group(&targets.relit, others);
        draw::full_screen(encoder, project, harmonics, (bound.frame, first), Some(&relit));
    }
}

/// What falls on what the picture shows.
pub fn gather_from_probes(
    gpu: &Gpu,
    encoder: &mut CommandEncoder,
    plan: &Plan,
    pipelines: &BouncePipelines,
    things: Things<'_>,
    targets: &super::BounceTargets,
    bound: Bound<'_>,
) {
    let Some([_, _, gather]) = pipelines.probing() else { return };
    draw::draw_seen(encoder, plan, pipelines, things, targets, bound);
    let [places, marks] = targets.seen.each_ref();
    let seen = group(gpu, pipelines, [places, marks, &targets.harmonics[0]]);
    draw::full_screen(encoder, gather, &targets.smooth, (bound.frame, offset(plan.picture_views.start)), Some(&seen));
}

fn group(gpu: &Gpu, pipelines: &BouncePipelines, textures: [&TextureView; 3]) -> BindGroup {
    bind(gpu, &pipelines.probe_layout, &textures.map(BindingResource::TextureView))
}
