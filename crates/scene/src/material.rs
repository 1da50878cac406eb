//! Materials, written once and physically. What the fake sees of one is derived in [`crate::stand_ins`].
//!
//! Twin of [`Checkerboard::at`]: `shaders/shared/checkerboard.wgsl`.

use crate::ImageTexture;
use crate::conductor::Conductor;
use crate::stand_ins::FakeMaterial;
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// How a surface looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The name that shapes refer to in the scene file.
    pub name: String,
    /// How it scatters light.
    pub bsdf: Bsdf,
    /// The light that it sends out itself, if any.
    pub emission: Option<Emission>,
    /// What pictures say of its surface beside its colour.
    pub surface: SurfaceDetail,
    /// What the fake shows instead where physics is beyond it.
    pub fake: FakeMaterial,
}

impl Material {
    /// Whether it sends out any light itself.
    pub fn shines(&self) -> bool {
        self.emission.is_some_and(|emission| emission.radiance.max_element() > 0.0)
    }
}

impl Material {
    /// Every picture that it is made of.
    pub fn images(&self) -> impl Iterator<Item = &Arc<ImageTexture>> {
        let (colour, metallic_roughness) = match &self.bsdf {
            Bsdf::Diffuse { albedo } => (albedo.image(), None),
            Bsdf::MetallicRoughness(model) => (model.base_colour.image(), model.metallic_roughness.as_ref()),
            Bsdf::Mirror { .. } | Bsdf::RoughConductor { .. } | Bsdf::Dielectric { .. } => (None, None),
        };
        let emitted = self.surface.emission.as_ref();
        let normals = self.surface.normal_map.as_ref().map(|map| &map.image);
        let alpha = self.surface.alpha.image();
        [colour, metallic_roughness, emitted, normals, alpha].into_iter().flatten()
    }

    /// Whether any picture is part of it.
    pub fn has_images(&self) -> bool {
        self.images().next().is_some()
    }
}

/// What pictures say of a surface beside its colour.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceDetail {
    /// Shading normals, in the frame that the places in textures span.
    pub normal_map: Option<NormalMap>,
    /// Where there is a surface at all.
    pub alpha: Alpha,
    /// What the radiance of its emission is multiplied by from place to place.
    pub emission: Option<Arc<ImageTexture>>,
}

/// Shading normals from a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct NormalMap {
    /// x, y and z as red, green and blue, each from [0, 1] for [-1, 1]; +x along u, +y against v (up in the picture).
    pub image: Arc<ImageTexture>,
    /// What x and y are multiplied by.
    pub scale: f32,
}

/// Where a surface is there for rays.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Alpha {
    /// It is there everywhere.
    #[default]
    Opaque,
    /// Where the product of factor and the picture's alpha is at least `cutoff`.
    Mask {
        /// Least alpha that is a surface.
        cutoff: f32,
        /// What the picture's alpha is multiplied by.
        factor: f32,
        /// The picture; of none alpha is 1.
        image: Option<Arc<ImageTexture>>,
    },
}

impl Alpha {
    /// The picture, if there is one.
    pub fn image(&self) -> Option<&Arc<ImageTexture>> {
        match self {
            Alpha::Opaque => None,
            Alpha::Mask { image, .. } => image.as_ref(),
        }
    }
}

/// How a surface scatters light.
#[derive(Debug, Clone, PartialEq)]
pub enum Bsdf {
    /// Lambert's law on both sides: BRDF = albedo / pi. Black for an area light that scatters nothing.
    Diffuse {
        /// Share of the light that is reflected, each channel in [0, 1].
        albedo: Texture,
    },
    /// A perfect mirror on both sides.
    Mirror {
        /// Share of the light that is reflected, each channel in [0, 1].
        reflectance: Vec3,
    },
    /// Metal with a rough surface, on both sides: single scattering by microfacets whose slopes have GGX' distribution.
    RoughConductor {
        /// What each microfacet reflects.
        conductor: Conductor,
        /// From .01, all but a mirror, to 1. The distribution's width, alpha, is its square.
        roughness: f32,
    },
    /// glTF's metallic-roughness model, on both sides: a mix of metal and of a coated matt body.
    MetallicRoughness(MetallicRoughness),
    /// Smooth clear glass inside a closed shape.
    Dielectric {
        /// Index of refraction of the inside over what is around the shape, > 0: 1.5 for glass in air, 1 / 1.5 for a
        /// bubble of air inside that glass. Stated per surface, so that no technique needs to know what medium a ray is
        /// in, and a camera inside glass sees rightly; see [`crate::nesting`] for what that asks of the shapes.
        ior: f32,
    },
}

/// The material of glTF 2.0, its appendix B: metal whose facets reflect the base colour at normal incidence, mixed with a
/// matt body of that colour under a clear coat, whose facets reflect by the index of refraction.
#[derive(Debug, Clone, PartialEq)]
pub struct MetallicRoughness {
    /// Albedo of the body and reflectance of the metal.
    pub base_colour: Texture,
    /// Share of metal, in [0, 1].
    pub metallic: f32,
    /// In [0, 1]; the distribution's width, alpha, is its square.
    pub roughness: f32,
    /// What both are multiplied by: roughness by green, the share of metal by blue.
    pub metallic_roughness: Option<Arc<ImageTexture>>,
    /// Index of refraction of the coat, from 1; usually 1.5.
    pub ior: f32,
}

impl MetallicRoughness {
    /// Index of refraction of the coat where none is stated.
    pub const USUAL_IOR: f32 = 1.5;
}

/// Light that a surface sends out, the same in all directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emission {
    /// Radiance, RGB.
    pub radiance: Vec3,
    /// Whether both sides shine; else only the one that the normal points away from.
    pub two_sided: bool,
}

/// A colour that may vary over space.
#[derive(Debug, Clone, PartialEq)]
pub enum Texture {
    /// One colour.
    Constant(Vec3),
    /// A solid checkerboard: the parity of the cell that a point lies in.
    Checkerboard(Checkerboard),
    /// A picture, where a mesh says which part of it lies where.
    Image {
        /// The picture that is shown.
        image: Arc<ImageTexture>,
        /// What its colours are multiplied by, each channel in [0, 1].
        factor: Vec3,
    },
}

/// Cells of two colours that fill space, so that no shape needs texture coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Checkerboard {
    /// Colour of cells whose indices add up to an even number.
    pub even: Vec3,
    /// Colour of the others.
    pub odd: Vec3,
    /// A corner of cell (0, 0, 0), world space.
    pub origin: Vec3,
    /// Size of a cell along each axis; 0 where the pattern does not change along that axis.
    pub cell: Vec3,
}

impl Texture {
    /// The picture, if it is one.
    pub fn image(&self) -> Option<&Arc<ImageTexture>> {
        match self {
            Texture::Image { image, .. } => Some(image),
            Texture::Constant(_) | Texture::Checkerboard(_) => None,
        }
    }

    /// The colour at a point of world space that lies at `uv` in textures.
    pub fn at(&self, point: Vec3, uv: Vec2) -> Vec3 {
        match self {
            Texture::Constant(colour) => *colour,
            Texture::Checkerboard(board) => board.at(point),
            Texture::Image { image, factor } => image.at(uv).truncate() * *factor,
        }
    }
}

impl Checkerboard {
    /// The colour at a point of world space ("Task 1 a) Add Checkerboard").
    pub fn at(&self, point: Vec3) -> Vec3 {
        let index = (point - self.origin) * self.cells_per_unit();
        let sum = index.x.floor() + index.y.floor() + index.z.floor();
        if sum - 2.0 * (sum * 0.5).floor() < 0.5 { self.even } else { self.odd }
    }

    /// `1 / cell`, and 0 along axes on which the pattern does not change.
    pub fn cells_per_unit(&self) -> Vec3 {
        Vec3::from_array(self.cell.to_array().map(|size| if size > 0.0 { 1.0 / size } else { 0.0 }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checkerboard_alternates_also_left_of_its_origin_and_ignores_flat_axes() {
        let board = Checkerboard {
            even: Vec3::ONE,
            odd: Vec3::ZERO,
            origin: Vec3::new(-23.0, 0.0, -7.5),
            cell: Vec3::new(1.0, 0.0, 1.0),
        };
        assert_eq!(board.at(Vec3::new(-22.5, 0.0, -7.0)), Vec3::ONE);
        assert_eq!(board.at(Vec3::new(-21.5, 9.0, -7.0)), Vec3::ZERO);
        assert_eq!(board.at(Vec3::new(-23.5, -3.0, -7.0)), Vec3::ZERO);
        assert_eq!(board.at(Vec3::new(-23.5, 0.0, -8.0)), Vec3::ONE);
    }
}
