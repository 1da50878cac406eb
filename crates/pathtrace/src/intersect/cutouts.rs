//! Holes in surfaces: where a material's alpha is below its cutoff there is nothing, and rays go on.
//!
//! Trees alone ask: a scene with holes is traced through one, however small
//! it is. Twin: `shaders/pathtrace/intersect/cutouts.wgsl`.

use super::attributes::{MeshAttributes, rows_of_tree};
use scene::glam::Vec2;
use scene::{Alpha, Scene};

/// What says where a scene's surfaces are.
#[derive(Debug)]
pub(crate) struct Cutouts {
    /// Entries of corners, by the primitives' places in the scene's order.
    corners: Vec<[u32; 3]>,
    uvs: Vec<Vec2>,
    /// The alpha of each material.
    alphas: Vec<Alpha>,
}

impl Cutouts {
    /// Of a scene that has any.
    pub fn of(scene: &Scene) -> Option<Box<Self>> {
        let attributes = scene.needs().alpha_masks.then(|| MeshAttributes::of(scene))??;
        let corners = rows_of_tree(scene, &attributes).into_iter().map(|row| row.corners).collect();
        let alphas = scene.materials.iter().map(|material| material.surface.alpha.clone()).collect();
        Some(Box::new(Cutouts { corners, uvs: attributes.uvs, alphas }))
    }

    /// Whether there is no surface where a ray meets a primitive: its place in the scene's order, its material and the
    /// barycentrics, which need not add up to 1.
    pub fn is_hole(&self, id: u32, material: u32, barycentrics: [f32; 3]) -> bool {
        if self.alphas[material as usize] == Alpha::Opaque {
            return false;
        }
        let sum = barycentrics[0] + barycentrics[1] + barycentrics[2];
        let corners = self.corners[id as usize].map(|corner| self.uvs[corner as usize]);
        let weighted = corners[0] * barycentrics[0] + corners[1] * barycentrics[1] + corners[2] * barycentrics[2];
        let uv = if sum == 0.0 { Vec2::ZERO } else { weighted / sum };
        !is_there(&self.alphas[material as usize], uv)
    }
}

/// Whether a surface is there at a place in textures.
pub(crate) fn is_there(alpha: &Alpha, uv: Vec2) -> bool {
    match alpha {
        Alpha::Opaque => true,
        Alpha::Mask { cutoff, factor, image } => factor * image.as_ref().map_or(1.0, |image| image.at(uv).w) >= *cutoff,
    }
}
