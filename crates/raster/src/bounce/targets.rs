//! What the second bounce is drawn into.

use super::probes::{HARMONICS, PROBE_FACE, PROBES};
use super::{PATCHES_SIDE, reduced};
use crate::targets::{DEPTH, FEATURES, Layers, SHADOW, layers, square, whole};
use gpu::upload::TexturePlan;
use gpu::{Gpu, GpuError};
use wgpu::{TextureView, TextureViewDimension};

/// What these targets depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BounceTargetPlan {
    /// How many layers the lights' maps have: the highest that is drawn and one.
    pub layers: u32,
    /// Whether there are probes.
    pub probes: bool,
    /// Width and height of the picture.
    pub picture: [u32; 2],
}

/// What the second bounce is drawn into.
#[derive(Debug)]
pub struct BounceTargets {
    /// Places and lights of what the lights see: the sun's layer, then the area light's.
    pub patches: [Layers; 2],
    /// Depth buffer beside those.
    pub patch_depth: TextureView,
    /// Places and marks of what the eye sees.
    pub seen: [TextureView; 2],
    /// Depth buffer beside those.
    pub seen_depth: TextureView,
    /// What is gathered there.
    pub gathered: TextureView,
    /// The mean of that over neighbours.
    pub smooth: TextureView,
    /// What the probes see: places and light.
    pub atlas: [TextureView; 2],
    /// Depth buffer beside those.
    pub atlas_depth: TextureView,
    /// The light there once more, lit by the probes.
    pub relit: TextureView,
    /// Coefficients of the probes, and what stands in while those are drawn.
    pub harmonics: [TextureView; 2],
    /// Stands in where light is not to be looked up.
    pub none: TextureView,
}

/// The targets of a plan; the least that can be bound without one.
pub fn bounce_targets(gpu: &Gpu, plan: Option<BounceTargetPlan>) -> Result<BounceTargets, GpuError> {
    let label = "a reflective shadow map";
    let (side, count) = match plan.map_or(0, |plan| plan.layers) {
        0 => (1, 2),
        1 => (PATCHES_SIDE, 2),
        _ => (PATCHES_SIDE, 7),
    };
    // as for shadow maps: neither 1 layer nor 6
    let patches = || {
        let map = gpu.texture(label, &square(side, count, FEATURES))?;
        Ok::<_, GpuError>(layers(&map, TextureViewDimension::D2Array))
    };
    let sized = |[width, height]: [u32; 2], format| {
        let one = TexturePlan { width, height, ..square(1, 1, format) };
        Ok::<_, GpuError>(whole(&gpu.texture("light of the second bounce", &one)?))
    };
    let size = plan.map_or([1, 1], |plan| reduced(plan.picture));
    let of_picture = |format| sized(size, format);
    let probes = plan.is_some_and(|plan| plan.probes);
    let [atlas, harmonics] =
        if probes { [[6 * PROBE_FACE, PROBES * PROBE_FACE], [HARMONICS, PROBES]] } else { [[1, 1]; 2] };
    Ok(BounceTargets {
        patches: [patches()?, patches()?],
        patch_depth: whole(&gpu.texture(label, &square(side, 1, DEPTH))?),
        seen: [of_picture(FEATURES)?, of_picture(FEATURES)?],
        seen_depth: of_picture(DEPTH)?,
        gathered: of_picture(FEATURES)?,
        smooth: of_picture(FEATURES)?,
        atlas: [sized(atlas, FEATURES)?, sized(atlas, FEATURES)?],
        atlas_depth: sized(atlas, DEPTH)?,
        relit: sized(atlas, FEATURES)?,
        harmonics: [sized(harmonics, FEATURES)?, sized([1, 1], FEATURES)?],
        none: whole(&gpu.texture(label, &square(1, 1, SHADOW))?),
    })
}
