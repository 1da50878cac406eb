//! What is drawn into: shadow map, cube maps, picture. Kept as long as sizes stay.

use crate::settings::Fake;
use gpu::upload::TexturePlan;
use gpu::{Gpu, GpuError};
use wgpu::{TextureFormat, TextureUsages, TextureView};

/// Depths in passes are f32: the shadow map compares depths of neighbouring texels.
pub const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// The shadow map's texels: bits of f32, because integers can be drawn by every backend, floats not through OpenGL.
pub const SHADOW: TextureFormat = TextureFormat::R32Uint;

/// Formats and samples of a fake's colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colours {
    /// Of the picture; integers hold the bits of f32.
    pub picture: TextureFormat,
    /// Samples per pixel in hardware.
    pub samples: u32,
    /// Passes over the picture.
    pub passes: u32,
    /// Of the cube maps: one that is filtered everywhere.
    pub cube_map: TextureFormat,
}

impl Colours {
    /// The colours of a fake. A device that can't draw half floats (OpenGL's core profile) keeps fair cube maps in bytes.
    pub fn of(fake: Fake, gpu: &Gpu) -> Colours {
        match fake {
            Fake::AsTaught => Colours {
                picture: TextureFormat::Rgba8Unorm,
                samples: 4,
                passes: 1,
                cube_map: TextureFormat::Rgba8Unorm,
            },
            Fake::Fair => Colours {
                picture: TextureFormat::Rgba32Uint,
                samples: 1,
                passes: 4,
                cube_map: if draws_half_floats(gpu) { TextureFormat::Rgba16Float } else { TextureFormat::Rgba8Unorm },
            },
        }
    }
}

fn draws_half_floats(gpu: &Gpu) -> bool {
    let usages = gpu.adapter.get_texture_format_features(TextureFormat::Rgba16Float).allowed_usages;
    usages.contains(TextureUsages::RENDER_ATTACHMENT)
}

/// What targets depend on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TargetPlan {
    /// Width of the picture.
    pub width: u32,
    /// Height of the picture.
    pub height: u32,
    /// Which fake's formats.
    pub fake: Fake,
    /// Texels along a side of the shadow map.
    pub shadow_size: u32,
    /// Whether the shadow map has the lamp's six layers.
    pub with_lamp: bool,
    /// Texels along a side of a cube map's face.
    pub cube_size: u32,
    /// How many cube maps.
    pub cube_maps: usize,
}

/// Views of a shadow map or cube map.
#[derive(Debug)]
pub struct Layers {
    /// All layers together, to look up.
    pub all: TextureView,
    /// Each layer, to draw into.
    pub each: Vec<TextureView>,
}

/// The targets of a frame.
#[derive(Debug)]
pub struct Targets {
    plan: TargetPlan,
    /// Nearest depths: the sun's layer, then the lamp's.
    pub shadow_map: Layers,
    /// Depth buffer beside it.
    pub shadow_depth: TextureView,
    /// One for each glass.
    pub cube_maps: Vec<Layers>,
    /// Stands in where a shape has none.
    pub no_cube_map: TextureView,
    /// Depth buffer of a face.
    pub cube_depth: TextureView,
    /// The picture's passes, or its samples.
    pub passes: Layers,
    /// Depth buffer of the picture.
    pub depth: TextureView,
    picture: wgpu::Texture,
    /// The finished picture.
    pub resolved: TextureView,
}

impl Targets {
    /// The targets of `plan`: the `kept` ones if they fit.
    pub fn current<'a>(kept: &'a mut Option<Targets>, gpu: &Gpu, plan: &TargetPlan) -> Result<&'a Targets, GpuError> {
        match kept.take().filter(|targets| targets.plan == *plan) {
            Some(targets) => Ok(kept.insert(targets)),
            None => Ok(kept.insert(Targets::new(gpu, *plan)?)),
        }
    }

    /// The finished picture, to read back.
    pub fn picture(&self) -> &wgpu::Texture {
        &self.picture
    }

    fn new(gpu: &Gpu, plan: TargetPlan) -> Result<Targets, GpuError> {
        let colours = Colours::of(plan.fake, gpu);
        let looked_up = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let square = |size: u32, layers: u32, format| TexturePlan {
            width: size,
            height: size,
            layers,
            samples: 1,
            format,
            usage: looked_up,
        };
        // GL takes an array of one layer for a plain texture and one of six for a cube: neither 1 nor 6
        let shadow_layers = if plan.with_lamp { 7 } else { 2 };
        let shadow_map = gpu.texture("a shadow map", &square(plan.shadow_size, shadow_layers, SHADOW))?;
        let shadow_depth = gpu.texture("a shadow map", &square(plan.shadow_size, 1, DEPTH))?;
        let cube_plan = square(plan.cube_size, 6, colours.cube_map);
        let cubes =
            (0..plan.cube_maps).map(|_| gpu.texture("a cube map", &cube_plan)).collect::<Result<Vec<_>, _>>()?;
        let no_cube = gpu.texture("a cube map", &square(1, 6, colours.cube_map))?;
        let cube_depth =
            gpu.texture("a cube map", &square(if cubes.is_empty() { 1 } else { plan.cube_size }, 1, DEPTH))?;
        let picture_plan = TexturePlan { width: plan.width, height: plan.height, ..square(1, 1, colours.picture) };
        let resolved_usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
        let picture = gpu.texture("a picture", &TexturePlan { usage: resolved_usage, ..picture_plan })?;
        let usage = if colours.samples > 1 { TextureUsages::RENDER_ATTACHMENT } else { looked_up };
        let passes_plan = TexturePlan { layers: colours.passes, samples: colours.samples, usage, ..picture_plan };
        let passes = gpu.texture("a picture", &passes_plan)?;
        let depth_plan =
            TexturePlan { format: DEPTH, layers: 1, usage: TextureUsages::RENDER_ATTACHMENT, ..passes_plan };
        let depth = gpu.texture("a picture", &depth_plan)?;
        Ok(Targets {
            plan,
            shadow_map: layers(&shadow_map, wgpu::TextureViewDimension::D2Array),
            shadow_depth: whole(&shadow_depth),
            cube_maps: cubes.iter().map(|cube| layers(cube, wgpu::TextureViewDimension::Cube)).collect(),
            no_cube_map: layers(&no_cube, wgpu::TextureViewDimension::Cube).all,
            cube_depth: whole(&cube_depth),
            passes: layers(
                &passes,
                if colours.passes > 1 { wgpu::TextureViewDimension::D2Array } else { wgpu::TextureViewDimension::D2 },
            ),
            depth: whole(&depth),
            resolved: whole(&picture),
            picture,
        })
    }
}

fn whole(texture: &wgpu::Texture) -> TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn layers(texture: &wgpu::Texture, dimension: wgpu::TextureViewDimension) -> Layers {
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
        each: (0..count).map(|layer| view(wgpu::TextureViewDimension::D2, layer, Some(1))).collect(),
    }
}
