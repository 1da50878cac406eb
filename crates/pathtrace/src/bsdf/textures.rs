//! What textures say of the surfaces in the lanes, each looked up by itself.
//!
//! Twin: `shaders/pathtrace/bsdf/textures.wgsl`.

use crate::intersect::aggregate::lanes_of;
use crate::vectors::of_lanes;
use scene::glam::Vec2;
use scene::{Bsdf, ImageTexture, Material, MetallicRoughness, Vec3};
use simd::{Column, Float, MOST_LANES, Mask, Vector, Word, WordColumn};
use std::sync::Arc;

/// A scene's textures, and which of them its materials are made of.
#[derive(Debug, Clone, Default)]
pub struct ImageTextures {
    images: Vec<Arc<ImageTexture>>,
    /// Places among them, 1 for the first; 0 for none.
    colour: WordColumn,
    emission: WordColumn,
    normals: WordColumn,
    metallic_roughness: WordColumn,
    normal_scale: Column,
    has_emission: bool,
    has_normals: bool,
    has_metallic_roughness: bool,
}

/// The places of a material's textures among a scene's, 1 for the first; 0 for none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Places {
    pub colour: u32,
    pub emission: u32,
    pub normals: u32,
    pub metallic_roughness: u32,
    pub alpha: u32,
}

/// All textures of some materials, each once, and where each material's are.
pub(crate) fn places(materials: &[Material]) -> (Vec<Arc<ImageTexture>>, Vec<Places>) {
    let mut images: Vec<Arc<ImageTexture>> = Vec::new();
    let mut place = |image: Option<&Arc<ImageTexture>>| {
        let Some(image) = image else { return 0 };
        let known = images.iter().position(|other| Arc::ptr_eq(other, image));
        let index = known.unwrap_or_else(|| {
            images.push(image.clone());
            images.len() - 1
        });
        index as u32 + 1
    };
    let of = |material: &Material| {
        let (colour, metallic_roughness) = match &material.bsdf {
            Bsdf::Diffuse { albedo } => (albedo.image(), None),
            Bsdf::MetallicRoughness(MetallicRoughness { base_colour, metallic_roughness, .. }) => {
                (base_colour.image(), metallic_roughness.as_ref())
            }
            Bsdf::Mirror { .. } | Bsdf::RoughConductor { .. } | Bsdf::Dielectric { .. } => (None, None),
        };
        let surface = &material.surface;
        Places {
            colour: place(colour),
            emission: place(surface.emission.as_ref()),
            normals: place(surface.normal_map.as_ref().map(|map| &map.image)),
            metallic_roughness: place(metallic_roughness),
            alpha: place(surface.alpha.image()),
        }
    };
    let places = materials.iter().map(of).collect();
    (images, places)
}

impl ImageTextures {
    /// Those of the scene's materials.
    pub fn new(materials: &[Material]) -> Self {
        let (images, places) = places(materials);
        let column = |of: fn(&Places) -> u32| WordColumn::new(places.iter().map(of));
        let scale = |material: &Material| material.surface.normal_map.as_ref().map_or(1.0, |map| map.scale);
        ImageTextures {
            images,
            colour: column(|places| places.colour),
            emission: column(|places| places.emission),
            normals: column(|places| places.normals),
            metallic_roughness: column(|places| places.metallic_roughness),
            normal_scale: Column::new(materials.iter().map(scale)),
            has_emission: places.iter().any(|places| places.emission != 0),
            has_normals: places.iter().any(|places| places.normals != 0),
            has_metallic_roughness: places.iter().any(|places| places.metallic_roughness != 0),
        }
    }

    /// Whether there are none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.images.is_empty()
    }

    /// Whether any says what is sent out.
    #[inline(always)]
    pub fn has_emission(&self) -> bool {
        self.has_emission
    }

    /// Whether any is a normal map.
    #[inline(always)]
    pub fn has_normals(&self) -> bool {
        self.has_normals
    }

    /// Whether any says how rough surfaces are, and how far they are metal.
    #[inline(always)]
    pub fn has_metallic_roughness(&self) -> bool {
        self.has_metallic_roughness
    }

    /// What colours are multiplied by.
    #[inline(always)]
    pub fn colour<F: Float>(&self, material: F::U, uv: [F; 2]) -> Vector<F> {
        self.look_up(&self.colour, material, uv).1
    }

    /// What radiance sent out is multiplied by.
    #[inline(always)]
    pub fn emission<F: Float>(&self, material: F::U, uv: [F; 2]) -> Vector<F> {
        self.look_up(&self.emission, material, uv).1
    }

    /// What the share of metal and the roughness are multiplied by.
    #[inline(always)]
    pub fn metallic_roughness<F: Float>(&self, material: F::U, uv: [F; 2]) -> [F; 2] {
        let found = self.look_up(&self.metallic_roughness, material, uv).1;
        [found.z, found.y]
    }

    /// Normals of the surfaces where they have any, x along u, y against v; straight up elsewhere.
    #[inline(always)]
    pub fn normals<F: Float>(&self, material: F::U, uv: [F; 2]) -> Vector<F> {
        let (there, found) = self.look_up(&self.normals, material, uv);
        let scale = material.look_up(&self.normal_scale);
        let [x, y, z] = [found.x, found.y, found.z].map(|share| share * 2.0 - 1.0);
        Vector::select(there, Vector::new(x * scale, y * scale, z), Vector::splat([0.0, 0.0, 1.0]))
    }

    /// Red, green and blue of one kind of texture, where there is one; else 1.
    #[inline(always)]
    fn look_up<F: Float>(&self, kind: &WordColumn, material: F::U, uv: [F; 2]) -> (F::M, Vector<F>) {
        let place = material.look_up_word(kind);
        let there = !place.eq(F::U::splat(0));
        let mut found = [Vec3::ONE; MOST_LANES];
        if !there.any() {
            return (there, of_lanes(&found));
        }
        let (mut places, [mut u, mut v]) = ([0; MOST_LANES], [[0.0; MOST_LANES]; 2]);
        place.store(&mut places);
        uv[0].store(&mut u);
        uv[1].store(&mut v);
        for lane in lanes_of(there) {
            found[lane] = self.images[places[lane] as usize - 1].at(Vec2::new(u[lane], v[lane])).truncate();
        }
        (there, of_lanes(&found))
    }
}
