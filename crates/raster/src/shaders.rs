//! The rasteriser's shaders: every file under `shaders/raster/`. A new one is one line of [`SOURCES`].

use crate::bounce::{self, PATCHES_SIDE, PROBE_FACE, PROBES_SIDE};
use crate::caustic::{CELLS, SUNS};
use crate::gpu_data::*;
use crate::passes::NOWHERE;
use crate::pipelines::Choice;
use crate::repair;
use crate::shading::{LEAST_COSINE, LEAST_WIDTH, SMALLEST};
use crate::spheres::CAUSTIC_REACH;
use crate::variant::Variant;
use crate::{Fake, Repairs, ShadowFilter};
use bytemuck::Zeroable;
use gpu::wgsl::{self, Composed, Source, WgslError};
use std::f32::consts::PI;

/// One line a file.
pub const SOURCES: &[Source<'static>] = gpu::wgsl_sources![
    "raster/bent.wgsl",
    "raster/features.wgsl",
    "raster/forward.wgsl",
    "raster/frame.wgsl",
    "raster/object.wgsl",
    "raster/refraction.wgsl",
    "raster/repair/area_light.wgsl",
    "raster/repair/bounce.wgsl",
    "raster/repair/caustic.wgsl",
    "raster/repair/fresnel.wgsl",
    "raster/repair/gather.wgsl",
    "raster/repair/glass.wgsl",
    "raster/repair/octahedron.wgsl",
    "raster/repair/patches.wgsl",
    "raster/repair/polygon.wgsl",
    "raster/repair/probes.wgsl",
    "raster/repair/repairs.wgsl",
    "raster/repair/smooth.wgsl",
    "raster/repair/soft_shadow.wgsl",
    "raster/repair/spheres.wgsl",
    "raster/repair/sunlight.wgsl",
    "raster/repair/surroundings.wgsl",
    "raster/shading.wgsl",
    "raster/shadow.wgsl",
    "raster/shadow_map.wgsl",
    "raster/surface.wgsl",
    "raster/view.wgsl",
];

/// [`SOURCES`], and what they import from beyond `shaders/raster/`.
pub const LIBRARY: [&[Source<'static>]; 2] = [SOURCES, gpu::shared_shaders::SOURCES];

/// The shader at `root` under `shaders/`.
///
/// # Errors
/// [`WgslError`] with file, line and column.
pub fn compose(root: &str) -> Result<Composed, WgslError> {
    wgsl::compose(&LIBRARY, root)
}

/// Constants that stand on both sides under one name. A test holds each against what the shaders say.
pub fn shared_constants() -> Vec<(&'static str, f64)> {
    let own = gpu::named_values![
        AREA_FORM_POINT,
        AREA_FORM_QUAD,
        AREA_FORM_SPHERE,
        AREA_LIGHT_ALL_AROUND,
        AREA_LIGHT_NONE,
        AREA_LIGHT_ONE_SIDED,
        AREA_LIGHT_SPOT,
        AREA_LIGHT_TWO_SIDED,
        AREA_LIGHT_WITHOUT_DECAY,
        BOARD_ANISOTROPIC,
        BOARD_AS_FORMULA,
        BOARD_BILINEAR,
        BOARD_TRILINEAR,
        CAUSTIC_REACH,
        CELLS,
        FILTER_HARD,
        FILTER_PCF,
        FILTER_PCF_SOFT,
        IMAGE_ALPHA,
        IMAGE_COLOUR,
        IMAGE_EMISSION,
        IMAGE_METALLIC_ROUGHNESS,
        IMAGE_NORMAL,
        LEAST_COSINE,
        LEAST_WIDTH,
        MOST_BOXES,
        MOST_SPHERES,
        NOWHERE,
        PATCHES_OF_AREA_LIGHT,
        PATCHES_OF_PROBES,
        PATCHES_OF_SUN,
        PATCHES_SEEN,
        PATCHES_SIDE,
        PI,
        PROBES_SIDE,
        PROBE_FACE,
        SHADING_BLINN_PHONG,
        SHADING_COOK_TORRANCE,
        SHADING_PHONG,
        SHADING_THREE,
        SMALLEST,
        SUNS,
    ];
    own.into_iter().chain(repair::shader_numbers()).collect()
}

/// Names of the overrides that the forward pass and those of the second bounce are compiled with.
pub fn override_names() -> Vec<&'static str> {
    let choice = Choice::of((Fake::Fair, Repairs::NONE), ShadowFilter::Hard, &Lights::zeroed());
    let forward = choice.constants(Variant::PLAIN).into_iter().map(|(name, _)| name);
    forward.chain(bounce::override_names()).collect()
}
