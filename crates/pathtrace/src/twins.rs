//! What both machines must agree on: constants and overrides by their names, for the test that holds them against what
//! the shaders say.

use crate::bsdf::materials::{
    CHECKERED, HAS_INDEX, LOBE_DIELECTRIC, LOBE_LAMBERT, LOBE_METALLIC_ROUGHNESS, LOBE_MIRROR, LOBE_ROUGH_CONDUCTOR,
};
use crate::bsdf::metallic_roughness::{LEAST_SPECULAR, POLISHED, SMOOTHEST};
use crate::bsdf::shading::LEAST_UPRIGHT;
use crate::caster::cone::{CONE_DENSITY, MOST_CONES, MOST_SHARE, NARROWEST, WIDEST};
use crate::caster::sphere_chain::{LAST_STEP, MOST_ROOTS, MOST_STEPS, NEAR_AXIS};
use crate::drive::gpu::dispatch::GROUP;
use crate::drive::gpu::film_data::CUT_SHIFT;
use crate::drive::gpu::instance_data::UNMOVED;
use crate::drive::gpu::mesh_data::{ATTRIBUTE_WORDS, BILINEAR, TEXEL_ROW, TEXTURE_WORDS, WRAP_CLAMP, WRAP_MIRROR};
use crate::drive::gpu::scene_data::*;
use crate::drive::gpu::shape_data::*;
use crate::drive::gpu::tables::{MOST_LEVELS, VECTORS_OF_A_NODE, WINDING_TURNED};
use crate::drive::gpu::{PipelineKey, SceneNeeds};
use crate::features::lanes::MOST_SPECULARS;
use crate::integrator::Integrator;
use crate::integrator::broken::wrong::{EPSILON, HALF_THICKNESS, LEAST_COSINE, LOST_BITS, WHITE};
use crate::integrator::broken::{Bugs, shader_numbers};
use crate::integrator::chain_state;
use crate::integrator::forks::MOST_FORKS;
use crate::integrator::light_paths::{ACCEPTS, BEGINS};
use crate::integrator::normals::NormalsSettings;
use crate::integrator::path_plan::{BY_BOTH, BY_CHANCE, BY_SAMPLING};
use crate::integrator::path_state::{ALREADY_COUNTED, CONNECTION, MET_BY_CHANCE};
use crate::integrator::photon::{FIRST_DIMENSION, MOST_CELLS, ONE_SURFACE, PhotonSettings};
use crate::integrator::roulette::{ROULETTE_SLOPE, SPARED_VERTICES, STEPS};
use crate::integrator::settings::{ConesAt, PathSettings};
use crate::integrator::splits::{ALWAYS_REFRACTED, SPLITTING_VERTICES};
use crate::integrator::whitted::{MOST_BRANCHES, MOST_LIGHTS, WhittedSettings};
use crate::intersect::coincident::NO_GROUP;
use crate::intersect::ray::BEHIND_THE_END;
use crate::intersect::{NO_LIGHT, SHADOW_END};
use crate::light::aim::NARROWEST_AIM;
use crate::light::ball::ALL_DIRECTIONS;
use crate::light::flat::SMALLEST_SOLID_ANGLE;
use crate::light::{BELOW_ONE, LEAF, LEAST_SQUARE};
use crate::prepared::NOT_A_LIGHT;
use crate::sampling::UNIFORM_HEMISPHERE_PDF;
use std::collections::BTreeSet;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, TAU};

/// Constants that stand on both sides under one name. A test holds each against what the shaders say.
pub fn shared_constants() -> Vec<(&'static str, f64)> {
    const CONES_AT_EVERYTHING: u32 = ConesAt::Everything as u32;
    const CONES_AT_USUAL: u32 = ConesAt::Usual as u32;
    const HARD_CAP: u32 = PathSettings::HARD_CAP;
    const MOST_DEPTH: u32 = WhittedSettings::MOST_DEPTH;
    const STAGE_NONE: u32 = chain_state::NONE;
    const STAGE_LEFT: u32 = chain_state::LEFT;
    const STAGE_INSIDE: u32 = chain_state::INSIDE;
    const STAGE_OFF: u32 = chain_state::OFF;
    const STAGE_THROUGH: u32 = chain_state::THROUGH;
    const SMALLEST_POSITIVE: f32 = f32::MIN_POSITIVE;
    let named = gpu::named_values![
        ACCEPTS,
        ALL_DIRECTIONS,
        ALREADY_COUNTED,
        ALWAYS_REFRACTED,
        ATTRIBUTE_WORDS,
        BEGINS,
        BEHIND_THE_END,
        BELOW_ONE,
        BILINEAR,
        BY_BOTH,
        BY_CHANCE,
        BY_SAMPLING,
        CHAIN_OFF,
        CHAIN_THROUGH,
        CHECKERED,
        CONNECTION,
        CONE_DENSITY,
        CONES_AT_EVERYTHING,
        CONES_AT_USUAL,
        COUNT_SHIFT,
        CUT_SHIFT,
        EPSILON,
        FIRST_DIMENSION,
        FRAC_1_PI,
        FRAC_PI_2,
        GROUP,
        HALF_THICKNESS,
        HARD_CAP,
        HAS_INDEX,
        KIND_DISK,
        KIND_SHIFT,
        KIND_SPHERE,
        KIND_TRIANGLE,
        LAST_STEP,
        LEAF,
        LEAST_COSINE,
        LEAST_SQUARE,
        LEAST_SPECULAR,
        LEAST_UPRIGHT,
        LIGHT_BALL,
        LIGHT_DISK,
        LIGHT_ENVIRONMENT,
        LIGHT_POINT,
        LIGHT_RECTANGLE,
        LIGHT_SUN,
        LIGHT_TRIANGLE,
        LOBE_DIELECTRIC,
        LOBE_LAMBERT,
        LOBE_METALLIC_ROUGHNESS,
        LOBE_MIRROR,
        LOBE_ROUGH_CONDUCTOR,
        LOST_BITS,
        MET_BY_CHANCE,
        MOST_BRANCHES,
        MOST_CELLS,
        MOST_DEPTH,
        MOST_LEVELS,
        MOST_CONES,
        MOST_FORKS,
        MOST_LIGHTS,
        MOST_ROOTS,
        MOST_SHAPES,
        MOST_SHARE,
        MOST_SPECULARS,
        MOST_STEPS,
        MOST_WAITING,
        NARROWEST,
        NARROWEST_AIM,
        NEAR_AXIS,
        NOT_A_LIGHT,
        NO_LIGHT,
        NO_GROUP,
        ONE_SURFACE,
        POLISHED,
        TEXTURE_WORDS,
        ROULETTE_SLOPE,
        SHADOW_END,
        SMOOTHEST,
        SPARED_VERTICES,
        SPLITTING_VERTICES,
        SMALLEST_POSITIVE,
        SMALLEST_SOLID_ANGLE,
        STAGE_INSIDE,
        STAGE_LEFT,
        STAGE_NONE,
        STAGE_OFF,
        STAGE_THROUGH,
        STEPS,
        TAU,
        TEXEL_ROW,
        UNIFORM_HEMISPHERE_PDF,
        UNMOVED,
        VECTORS_OF_A_NODE,
        WHITE,
        WIDEST,
        WINDING_TURNED,
        WRAP_CLAMP,
        WRAP_MIRROR,
    ];
    named.into_iter().chain(shader_numbers()).collect()
}

/// Names of the overrides that pipelines are compiled with: what scenes ask for, and the settings of any integrator.
pub fn override_names() -> Vec<&'static str> {
    let photons = PhotonSettings::default();
    let broken = PathSettings { bugs: Bugs::ALL, ..PathSettings::default() };
    let integrators: [Integrator; 5] = [
        PathSettings::default().into(),
        broken.into(),
        WhittedSettings::default().into(),
        NormalsSettings::default().into(),
        photons.into(),
    ];
    let keys = integrators.map(|integrator| integrator.pipeline_key(false)).into_iter().flatten();
    // they share some
    let of_settings: BTreeSet<_> = keys.chain([photons.walk_key()]).flat_map(PipelineKey::constant_names).collect();
    SceneNeeds::constant_names().chain(of_settings).collect()
}
