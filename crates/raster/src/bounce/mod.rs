//! Light of the second bounce, by a reflective shadow map (Dachsbacher and Stamminger 2005): what a light sees is drawn as patches
//! that send its light on (`patches.wgsl`), kept with the other maps while the camera moves. A frame then draws where surfaces are
//! at a part of its size, gathers there what the patches send (`gather.wgsl`), takes the mean over the pixels that took all of
//! them between them (`smooth.wgsl`), and the forward pass looks that up (`bounce.wgsl`). In place of patches a grid of probes may
//! say what falls there (`probes`), of more bounces.

mod draw;
mod knobs;
mod pipelines;
mod probes;
mod targets;

pub use draw::{Bound, draw_patches, gather};
pub use knobs::{GatherKnobs, PatchClamp};
pub use pipelines::{BouncePipelines, Layouts, override_names, patches_of};
pub use probes::{PROBE_FACE, PROBES_SIDE, draw_probes, gather_from_probes, plan as plan_probes};
pub use targets::{BounceTargetPlan, BounceTargets, bounce_targets};

use crate::cube;
use crate::gpu_data::{AREA_LIGHT_ONE_SIDED, Lights, View};
use crate::planes::Planes;
use crate::repair::Repair;
use crate::settings::{RasterSettings, Show};
use bytemuck::Zeroable;
use scene::glam::{Mat4, Vec2, Vec4};
use scene::{Scene, Vec3};
use std::ops::Range;

/// Texels along a side of a reflective shadow map, as `shaders/raster/repair/gather.wgsl` has it.
pub const PATCHES_SIDE: u32 = 64;

/// How many pixels of the picture, along a side, share one for which light is gathered.
pub const REDUCTION: u32 = 4;

/// How much wider than its shadow map the sun's reflective one is: light from beyond comes from far away.
const SUN_REACH: f32 = 2.0;

/// What a frame gathers, and from what.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounce {
    /// The views of the lights, one for each of [`Bounce::layers`].
    pub views: Range<usize>,
    /// The layers that are drawn: 0 the sun's, 1 to 6 the area light's.
    pub layers: Vec<usize>,
    /// How it is gathered.
    pub gather: Gather,
}

/// What is compiled into the pass that gathers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Gather {
    /// A bit for each layer.
    pub layers: u32,
    /// How it is gathered, as far as the user chooses.
    pub knobs: GatherKnobs,
    /// How many spheres and boxes may stand in the way.
    pub blockers: [u32; 2],
}

/// What of the second bounce a frame gathers; its views are added to `views`.
pub fn plan(scene: &Scene, lights: &Lights, settings: &RasterSettings, views: &mut Vec<View>) -> Option<Bounce> {
    // of several repairs of one defect the last one holds
    let repairs = settings.repairs();
    let wished = repairs.has(Repair::ReflectiveShadowMap) && !repairs.has(Repair::IrradianceProbes);
    if !wished || settings.show != Show::Picture {
        return None;
    }
    let first = views.len();
    let sun = lights.sun_incident.max_element() > 0.0;
    let of_area_light = (1..7).filter(|layer| lights.area_light_pattern != 0 && !is_dark(lights, layer - 1));
    let layers: Vec<usize> = sun.then_some(0).into_iter().chain(of_area_light).collect();
    let planes = Planes::fitted(scene, lights.area_light_position, std::f32::consts::SQRT_2);
    views.extend(layers.iter().map(|layer| match layer {
        0 => sun_view(&lights.shadow_views[0]),
        layer => area_light_view(lights.area_light_position, layer - 1, planes),
    }));
    let gather = Gather {
        layers: layers.iter().fold(0, |bits, layer| bits | 1 << layer),
        knobs: settings.knobs.gather,
        blockers: [lights.sphere_count - lights.glass_count, lights.box_count],
    };
    (!layers.is_empty()).then_some(Bounce { views: first..views.len(), layers, gather })
}

/// Whether a lamp that shines to one side sends nothing along an axis, as wide as a cube's face.
fn is_dark(lights: &Lights, axis: usize) -> bool {
    let (normal, forward) = (lights.area_light_normal, cube::forward(axis));
    let across = (normal - normal.dot(forward) * forward).abs().element_sum();
    lights.area_light_pattern == AREA_LIGHT_ONE_SIDED && normal.dot(forward) + across <= 0.0
}

/// As its shadow map sees it, but wider. Its texels' area is that across the light.
fn sun_view(shadow: &View) -> View {
    let wider = Mat4::from_scale(Vec3::new(1.0 / SUN_REACH, 1.0 / SUN_REACH, 1.0));
    let clip_from_world = wider * shadow.clip_from_world;
    let [right, up] = [0, 1].map(|row| clip_from_world.row(row).truncate().length());
    let texel = 2.0 / PATCHES_SIDE as f32;
    View { clip_from_world, texel: Vec2::new(texel * texel / (right * up), 0.0), ..*shadow }
}

/// A cube's face. Its texels' size is that on a plane at distance 1; the plane kept tells how far along the axis a point lies.
fn area_light_view(position: Vec3, axis: usize, planes: Planes) -> View {
    let texel = 2.0 / PATCHES_SIDE as f32;
    let forward = cube::forward(axis);
    View {
        clip_from_world: cube::clip_from_world(position, axis, 1.0, planes),
        depth_from_world: forward.extend(-forward.dot(position)),
        eye: position,
        texel: Vec2::new(0.0, texel * texel),
        near: planes.near,
        ..View::zeroed()
    }
}

/// The size at which light is gathered for a picture.
pub fn reduced([width, height]: [u32; 2]) -> [u32; 2] {
    [width.div_ceil(REDUCTION), height.div_ceil(REDUCTION)]
}

/// What pixels of a picture are multiplied by to be places where light was gathered.
pub fn per_pixel(size: [u32; 2]) -> Vec2 {
    let [all, part] = [size, reduced(size)].map(|[width, height]| Vec2::new(width as f32, height as f32));
    part / all.max(Vec2::ONE)
}

/// Nothing is seen there: an area of 0.
pub const NOTHING: Vec4 = Vec4::ZERO;
