//! What is drawn into: shadow map, cube maps, picture. Each is kept as long as what it depends on stays.

use crate::bounce::{BounceTargetPlan, BounceTargets, bounce_targets};
use crate::caustic;
use crate::settings::Fake;
use gpu::upload::TexturePlan;
use gpu::{Gpu, GpuError};
use wgpu::{TextureFormat, TextureUsages, TextureView, TextureViewDimension};

/// Depths in passes are f32: the shadow map compares depths of neighbouring texels.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// The shadow map's texels: bits of f32, because integers can be drawn by every backend, floats not through OpenGL.
pub const SHADOW: TextureFormat = TextureFormat::R32Uint;

/// The features' texels, bits of f32 as well.
pub const FEATURES: TextureFormat = TextureFormat::Rgba32Uint;

/// What is bound only because something must be.
const BOUND: TextureUsages = TextureUsages::TEXTURE_BINDING;

/// How often features are drawn for one mean.
const FEATURE_PASSES: u32 = 4;

/// What is drawn and then looked up.
const LOOKED_UP: TextureUsages = TextureUsages::RENDER_ATTACHMENT.union(TextureUsages::TEXTURE_BINDING);

/// Formats and samples of a fake's colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colours {
    /// Of the picture; integers hold the bits of f32.
    pub picture: TextureFormat,
    /// Samples per pixel in hardware.
    pub samples: u32,
    /// Of the cube maps: one that is filtered everywhere.
    pub cube_map: TextureFormat,
}

impl Colours {
    /// The colours of a fake. A device that can't draw half floats (OpenGL's core profile) keeps fair cube maps in
    /// bytes.
    pub fn of(fake: Fake, gpu: &Gpu) -> Colours {
        match fake {
            Fake::AsTaught => {
                Colours { picture: TextureFormat::Rgba8Unorm, samples: 4, cube_map: TextureFormat::Rgba8Unorm }
            }
            Fake::Fair => Colours {
                picture: TextureFormat::Rgba32Uint,
                samples: 1,
                cube_map: if draws_half_floats(gpu) { TextureFormat::Rgba16Float } else { TextureFormat::Rgba8Unorm },
            },
        }
    }
}

/// Whether half floats can be drawn into.
pub fn draws_half_floats(gpu: &Gpu) -> bool {
    let usages = gpu.adapter.get_texture_format_features(TextureFormat::Rgba16Float).allowed_usages;
    usages.contains(TextureUsages::RENDER_ATTACHMENT)
}

/// What the targets of a frame depend on, part by part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TargetPlan {
    /// Of the shadow map.
    pub shadow: ShadowPlan,
    /// Of the cube maps.
    pub cubes: CubePlan,
    /// How many caustic maps.
    pub caustics: usize,
    /// Of the second bounce, if it is gathered.
    pub bounce: Option<BounceTargetPlan>,
    /// Of the picture.
    pub picture: PicturePlan,
}

/// What the shadow map depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShadowPlan {
    /// Texels along a side.
    pub size: u32,
    /// Whether it has the area light's six layers.
    pub with_area_light: bool,
}

/// What the cube maps depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CubePlan {
    /// Texels along a side of a face.
    pub size: u32,
    /// How many.
    pub count: usize,
    /// Which fake's format.
    pub fake: Fake,
}

/// What the picture depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PicturePlan {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Which fake's formats.
    pub fake: Fake,
    /// How often it is drawn for one mean.
    pub passes: u32,
}

/// Views of a shadow map or cube map.
#[derive(Debug)]
pub struct Layers {
    /// All layers together, to look up.
    pub all: TextureView,
    /// Each layer, to draw into.
    pub each: Vec<TextureView>,
}

/// The shadow map.
#[derive(Debug)]
pub struct ShadowTargets {
    /// Nearest depths: the sun's layer, then the area light's.
    pub map: Layers,
    /// Depth buffer beside it.
    pub depth: TextureView,
}

/// The cube maps.
#[derive(Debug)]
pub struct CubeTargets {
    /// One for each glass.
    pub each: Vec<Layers>,
    /// Stands in where a shape has none.
    pub none: TextureView,
    /// Depth buffer of a face.
    pub depth: TextureView,
}

/// What spheres of glass do to sunlight, a layer for each.
#[derive(Debug)]
pub struct CausticTargets {
    /// Multiples of the sun's light.
    pub light: Layers,
    /// How far along sunlight what it falls on lies.
    pub receivers: Layers,
    /// Depth buffer beside that.
    pub depth: TextureView,
    /// Stand in where nothing is drawn, and where these are drawn.
    pub none: [TextureView; 2],
}

/// The picture.
#[derive(Debug)]
pub struct PictureTargets {
    /// Its passes, or its samples.
    pub passes: Layers,
    /// Its depth buffer.
    pub depth: TextureView,
    /// It when finished.
    pub resolved: TextureView,
}

/// What is seen of surfaces without light.
#[derive(Debug)]
pub struct FeatureTargets {
    /// The passes of either colour.
    pub passes: [Layers; 2],
    /// The depth buffer that both targets share.
    pub depth: TextureView,
    /// Both passes as they are read back, their samples put together.
    pub resolved: [TextureView; 2],
}

/// The parts that the last frame had.
#[derive(Debug, Default)]
pub struct Kept {
    shadow: Option<(ShadowPlan, ShadowTargets)>,
    cubes: Option<(CubePlan, CubeTargets)>,
    caustics: Option<(usize, CausticTargets)>,
    bounce: Option<(Option<BounceTargetPlan>, BounceTargets)>,
    picture: Option<(PicturePlan, PictureTargets)>,
    features: Option<([u32; 2], FeatureTargets)>,
}

/// The targets of a frame.
#[derive(Debug, Clone, Copy)]
pub struct Targets<'a> {
    /// Nearest depths.
    pub shadow: &'a ShadowTargets,
    /// What surrounds the glass.
    pub cubes: &'a CubeTargets,
    /// What spheres of glass focus.
    pub caustics: &'a CausticTargets,
    /// What surfaces send on.
    pub bounce: &'a BounceTargets,
    /// What is seen.
    pub picture: &'a PictureTargets,
}

impl Kept {
    /// The targets of `plan`: of the kept ones those that fit.
    pub fn current(&mut self, gpu: &Gpu, plan: &TargetPlan) -> Result<Targets<'_>, GpuError> {
        Ok(Targets {
            shadow: fitting(&mut self.shadow, plan.shadow, |plan| shadow_targets(gpu, plan))?,
            cubes: fitting(&mut self.cubes, plan.cubes, |plan| cube_targets(gpu, plan))?,
            caustics: fitting(&mut self.caustics, plan.caustics, |count| caustic_targets(gpu, count))?,
            bounce: fitting(&mut self.bounce, plan.bounce, |plan| bounce_targets(gpu, plan))?,
            picture: fitting(&mut self.picture, plan.picture, |plan| picture_targets(gpu, plan))?,
        })
    }

    /// Those of features of so many pixels.
    pub fn of_features(&mut self, gpu: &Gpu, size: [u32; 2]) -> Result<&FeatureTargets, GpuError> {
        fitting(&mut self.features, size, |size| feature_targets(gpu, size))
    }
}

/// What does not fit is let go before its successor takes memory.
fn fitting<P: Copy + PartialEq, T>(
    kept: &mut Option<(P, T)>,
    plan: P,
    make: impl FnOnce(P) -> Result<T, GpuError>,
) -> Result<&T, GpuError> {
    let made = match kept.take().filter(|(made_for, _)| *made_for == plan) {
        Some(made) => made,
        None => (plan, make(plan)?),
    };
    Ok(&kept.insert(made).1)
}

/// A square that is drawn, looked up and read back.
pub fn square(size: u32, layers: u32, format: TextureFormat) -> TexturePlan {
    // read back to be looked at
    let usage = LOOKED_UP | if format == DEPTH { TextureUsages::empty() } else { TextureUsages::COPY_SRC };
    TexturePlan { width: size, height: size, layers, samples: 1, format, usage }
}

fn shadow_targets(gpu: &Gpu, plan: ShadowPlan) -> Result<ShadowTargets, GpuError> {
    // GL takes an array of one layer for a plain texture and one of six for a cube: neither 1 nor 6
    let map = gpu.texture("a shadow map", &square(plan.size, if plan.with_area_light { 7 } else { 2 }, SHADOW))?;
    let depth = gpu.texture("a shadow map", &square(plan.size, 1, DEPTH))?;
    Ok(ShadowTargets { map: layers(&map, TextureViewDimension::D2Array), depth: whole(&depth) })
}

fn cube_targets(gpu: &Gpu, plan: CubePlan) -> Result<CubeTargets, GpuError> {
    let format = Colours::of(plan.fake, gpu).cube_map;
    let cube_map = |size| Ok(layers(&gpu.texture("a cube map", &square(size, 6, format))?, TextureViewDimension::Cube));
    let depth_size = if plan.count == 0 { 1 } else { plan.size };
    Ok(CubeTargets {
        each: (0..plan.count).map(|_| cube_map(plan.size)).collect::<Result<_, GpuError>>()?,
        none: cube_map(1)?.all,
        depth: whole(&gpu.texture("a cube map", &square(depth_size, 1, DEPTH))?),
    })
}

fn caustic_targets(gpu: &Gpu, count: usize) -> Result<CausticTargets, GpuError> {
    let texture = |size, layers, format| gpu.texture("a caustic map", &square(size, layers, format));
    let maps = |size, count| {
        let light =
            TexturePlan { usage: if size > 1 { LOOKED_UP } else { BOUND }, ..square(size, count, caustic::FORMAT) };
        let light = gpu.texture("a caustic map", &light)?;
        Ok::<_, GpuError>([light, texture(size, count, SHADOW)?].map(|map| layers(&map, TextureViewDimension::D2Array)))
    };
    let size = if count == 0 { 1 } else { caustic::SIZE };
    // as for shadow maps: neither 1 nor 6
    let layers_of_all = match count {
        0 | 1 => 2,
        6 => 7,
        count => count as u32,
    };
    let [light, receivers] = maps(size, layers_of_all)?;
    let depth = whole(&texture(size, 1, DEPTH)?);
    Ok(CausticTargets { light, receivers, depth, none: maps(1, 2)?.map(|map| map.all) })
}

fn picture_targets(gpu: &Gpu, plan: PicturePlan) -> Result<PictureTargets, GpuError> {
    let colours = Colours::of(plan.fake, gpu);
    let one = TexturePlan {
        width: plan.width,
        height: plan.height,
        layers: 1,
        samples: 1,
        format: colours.picture,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
    };
    let resolved = gpu.texture("a picture", &one)?;
    let usage = if colours.samples > 1 { TextureUsages::RENDER_ATTACHMENT } else { LOOKED_UP };
    let all = TexturePlan { layers: plan.passes, samples: colours.samples, usage, ..one };
    let passes = gpu.texture("a picture", &all)?;
    let depth = TexturePlan { format: DEPTH, layers: 1, usage: TextureUsages::RENDER_ATTACHMENT, ..all };
    let depth = gpu.texture("a picture", &depth)?;
    let dimension = if plan.passes > 1 { TextureViewDimension::D2Array } else { TextureViewDimension::D2 };
    Ok(PictureTargets { passes: layers(&passes, dimension), depth: whole(&depth), resolved: whole(&resolved) })
}

fn feature_targets(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<FeatureTargets, GpuError> {
    let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
    let one = TexturePlan { width, height, layers: 1, samples: 1, format: FEATURES, usage };
    let depth = TexturePlan { format: DEPTH, usage: TextureUsages::RENDER_ATTACHMENT, ..one };
    let all = TexturePlan { layers: FEATURE_PASSES, usage: LOOKED_UP, ..one };
    let texture = |plan: &TexturePlan| gpu.texture("what is seen of surfaces", plan);
    let passes = || Ok::<_, GpuError>(layers(&texture(&all)?, TextureViewDimension::D2Array));
    Ok(FeatureTargets {
        passes: [passes()?, passes()?],
        depth: whole(&texture(&depth)?),
        resolved: [whole(&texture(&one)?), whole(&texture(&one)?)],
    })
}

/// All of a texture that has one layer.
pub fn whole(texture: &wgpu::Texture) -> TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// All layers of a texture together, and each.
pub fn layers(texture: &wgpu::Texture, dimension: TextureViewDimension) -> Layers {
    let view = |dimension, base_array_layer, array_layer_count| {
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(dimension),
            base_array_layer,
            array_layer_count,
            ..wgpu::TextureViewDescriptor::default()
        })
    };
    let count = texture.depth_or_array_layers();
    Layers {
        all: view(dimension, 0, Some(count)),
        each: (0..count).map(|layer| view(TextureViewDimension::D2, layer, Some(1))).collect(),
    }
}
