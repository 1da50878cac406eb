//! What stands behind the lights in their buffer: chains by the spheres that cast caustics, and the tree over many lights.

use super::scene_data::{CHAIN_OFF, CHAIN_THROUGH, Light};
use crate::caster::{Casters, THROUGH};
use crate::light::Lights;
use bytemuck::Zeroable;
use scene::Vec3;

/// The chains by spheres, which stand behind the lights.
pub fn chains(casters: &Casters) -> impl Iterator<Item = Light> {
    casters.rows().map(|(position, area, code, cumulative)| Light {
        position,
        area,
        outline: if code & THROUGH == 0 { CHAIN_OFF } else { CHAIN_THROUGH },
        material: code & !THROUGH,
        cumulative,
        ..Light::zeroed()
    })
}

/// The nodes of the tree over many lights, which stand behind the chains: what stands where
/// is said in `shaders/pathtrace/light/tree.wgsl`.
pub fn light_tree(lights: &Lights) -> impl Iterator<Item = Light> {
    let nodes = lights.table().tree().map_or(&[][..], |(tree, _)| tree.nodes());
    nodes.iter().map(|node| Light {
        position: node.center,
        area: node.radius,
        normal: node.axis,
        u: Vec3::new(node.cos_spread, 0.0, 0.0),
        radiance: Vec3::splat(node.intensity),
        outline: node.contents,
        ..Light::zeroed()
    })
}
