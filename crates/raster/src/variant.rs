//! What is compiled into the pipelines that draw a shape: shaders must not branch on uniforms, as that of
//! the forward pass says.

use crate::gpu_data::*;
use crate::looks::{bits, board_of, pictures};
use crate::repair::Repair;
use crate::settings::{Fake, RasterSettings, Shading};
use scene::{Alpha, Bsdf, Geometry, Material, Scene, Shape};

/// The space that a shape's corners are in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Space {
    /// Those of the world's small shapes.
    World,
    /// The mesh's own, to be put somewhere.
    Mesh,
    /// The same, and what puts it there turns the winding over.
    MirroredMesh,
}

/// What tells the pipelines of shapes apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Variant {
    /// Glass looks up its cube map, and only its back faces are drawn.
    pub glass: bool,
    /// It has a cube map, in which it mirrors.
    pub mirror: bool,
    /// How highlights are shaded, one of `SHADING_*`.
    pub shading: u32,
    /// Where its corners are.
    pub space: Space,
    /// Whether its normals are those of triangles which share their corners.
    pub flat: bool,
    /// Whether its corners have normals of their own, which are not those of its triangles: a mesh's, not a sphere's, which
    /// stands for what is round.
    pub smooth: bool,
    /// Whether its corners have places in pictures.
    pub uvs: bool,
    /// Those of `IMAGE_*` that its material has.
    pub images: u32,
    /// How its checkerboard is looked up, one of `BOARD_*`.
    pub board: u32,
}

impl Variant {
    /// The simplest way to draw.
    pub const PLAIN: Variant = Variant {
        glass: false,
        mirror: false,
        shading: SHADING_THREE,
        space: Space::World,
        flat: false,
        smooth: false,
        uvs: false,
        images: 0,
        board: BOARD_AS_FORMULA,
    };

    /// How the forward pass draws a shape; `None` of one that an alpha mask leaves nothing of.
    pub fn of(scene: &Scene, shape: &Shape, settings: &RasterSettings) -> Option<Variant> {
        let material = scene.material_of(shape);
        if is_masked_away(material) {
            return None;
        }
        let glass = matches!(material.bsdf, Bsdf::Dielectric { .. });
        let images = bits(&pictures(material, settings.repairs()));
        let mesh = shape.geometry.mesh_of();
        let mirror = settings.repairs().has(Repair::Mirrors) && matches!(material.bsdf, Bsdf::Mirror { .. });
        Some(Variant {
            glass,
            mirror,
            shading: if glass || mirror { SHADING_THREE } else { shading(material, settings) },
            space: match &shape.geometry {
                Geometry::Instance(instance) if instance.mirrors() => Space::MirroredMesh,
                Geometry::Instance(_) => Space::Mesh,
                _ => Space::World,
            },
            // small ones have corners of their own for each triangle
            flat: mesh.is_some_and(|mesh| mesh.is_large() && mesh.normals().is_empty()),
            smooth: mesh.is_some_and(|mesh| !mesh.normals().is_empty()),
            uvs: images != 0 && mesh.is_some_and(|mesh| !mesh.uvs().is_empty()),
            images,
            board: board_of(material, settings),
        })
    }

    /// What of it shadow maps tell apart.
    pub fn in_shadow_map(self) -> Variant {
        let images = self.images & IMAGE_ALPHA;
        Variant { space: self.space, images, uvs: self.uvs && images != 0, ..Variant::PLAIN }
    }

    /// What of it the features' pass tells apart.
    pub fn in_features(self) -> Variant {
        let images = self.images & !IMAGE_METALLIC_ROUGHNESS;
        Variant { glass: false, mirror: false, shading: SHADING_THREE, images, uvs: self.uvs && images != 0, ..self }
    }

    /// Values of the overrides in `shaders/raster/surface.wgsl`.
    pub fn constants(&self) -> [(&'static str, f64); 6] {
        [
            ("IMAGES", f64::from(self.images)),
            ("PLACED", f64::from(u8::from(self.space != Space::World))),
            ("FLAT", f64::from(u8::from(self.flat))),
            ("SMOOTH", f64::from(u8::from(self.smooth))),
            ("BOARD", f64::from(self.board)),
            ("UVS", f64::from(u8::from(self.uvs))),
        ]
    }
}

/// As taught whatever is chosen counts for all materials; fair, glTF's have the highlight that they are defined by unless
/// another one is chosen. three.js draws them so as well: its MeshStandard.
fn shading(material: &Material, settings: &RasterSettings) -> u32 {
    let has_facets = matches!(material.bsdf, Bsdf::MetallicRoughness(_));
    match settings.shading {
        Shading::Three if has_facets && settings.fake == Fake::Fair => SHADING_COOK_TORRANCE,
        Shading::Three => SHADING_THREE,
        Shading::Phong => SHADING_PHONG,
        Shading::BlinnPhong => SHADING_BLINN_PHONG,
        Shading::CookTorrance => SHADING_COOK_TORRANCE,
    }
}

/// A mask without a picture is the same everywhere.
fn is_masked_away(material: &Material) -> bool {
    matches!(&material.surface.alpha, Alpha::Mask { cutoff, factor, image: None } if factor < cutoff)
}
