//! The pictures of materials on the device, and how each is read: a bind group for each look that differs.

use crate::board;
use crate::gpu_data::{BOARD_AS_FORMULA, ImagePlace, Look};
use crate::passes::bind;
use crate::repair::{Repair, Repairs};
use crate::settings::RasterSettings;
use crate::texture::{Bound, white};
use bytemuck::Zeroable;
use gpu::{Gpu, GpuError};
use scene::image_texture::Sampling;
use scene::{Alpha, Bsdf, ImageTexture, Material, Scene, Texture};
use std::sync::Arc;
use wgpu::{BindGroup, BindGroupLayout, BindingResource, BufferUsages};

/// The pictures of a material in the order of `IMAGE_*`.
pub type Pictures<T> = [Option<T>; 5];

/// What a material has of them. Where textures are mapped, a checkerboard's mask is one.
pub fn pictures(material: &Material, repairs: Repairs) -> Pictures<&Arc<ImageTexture>> {
    let board = |colour: &Texture| is_mapped(colour, repairs).then(board::mask);
    let (colour, metallic_roughness) = match &material.bsdf {
        Bsdf::Diffuse { albedo } => (albedo.image().or_else(|| board(albedo)), None),
        Bsdf::MetallicRoughness(model) => {
            let colour = &model.base_colour;
            (colour.image().or_else(|| board(colour)), model.metallic_roughness.as_ref())
        }
        Bsdf::Mirror { .. } | Bsdf::RoughConductor { .. } | Bsdf::Dielectric { .. } => (None, None),
    };
    let surface = &material.surface;
    let normal = surface.normal_map.as_ref().map(|map| &map.image);
    let emission = surface.emission.as_ref().filter(|_| material.emission.is_some());
    let alpha = match &surface.alpha {
        Alpha::Mask { image, .. } => image.as_ref(),
        Alpha::Opaque => None,
    };
    [colour, metallic_roughness, normal, emission, alpha]
}

/// Whether a colour is a checkerboard that is drawn as a texture.
fn is_mapped(colour: &Texture, repairs: Repairs) -> bool {
    repairs.has(Repair::TextureMapping) && matches!(colour, Texture::Checkerboard(_))
}

/// Those that there are, a bit each. A board's mask is none of them: it is looked up in another way.
pub fn bits(pictures: &Pictures<&Arc<ImageTexture>>) -> u32 {
    let is_one = |picture: &Arc<ImageTexture>| !Arc::ptr_eq(picture, board::mask());
    pictures.iter().rev().fold(0, |bits, picture| bits << 1 | u32::from(picture.is_some_and(is_one)))
}

/// How a material's checkerboard is looked up: one of `BOARD_*`.
pub fn board_of(material: &Material, settings: &RasterSettings) -> u32 {
    let (Bsdf::Diffuse { albedo: colour }
    | Bsdf::MetallicRoughness(scene::MetallicRoughness { base_colour: colour, .. })) = &material.bsdf
    else {
        return BOARD_AS_FORMULA;
    };
    if is_mapped(colour, settings.repairs()) { settings.knobs.textures.code() } else { BOARD_AS_FORMULA }
}

/// What a bind group is made of.
#[derive(Debug, Clone)]
struct Description {
    pictures: Pictures<Arc<ImageTexture>>,
    numbers: Look,
}

impl Description {
    /// Of a material with pictures.
    fn of(material: &Material, repairs: Repairs) -> Option<Description> {
        let pictures = pictures(material, repairs).map(|picture| picture.cloned());
        let (cutoff, alpha) = match &material.surface.alpha {
            Alpha::Mask { cutoff, factor, .. } => (*cutoff, *factor),
            Alpha::Opaque => (0.0, 1.0),
        };
        let place = |picture: &Option<Arc<ImageTexture>>| picture.as_ref().map(|picture| place(&picture.sampling));
        let numbers = Look {
            places: pictures.each_ref().map(|picture| place(picture).unwrap_or(ImagePlace::zeroed())),
            normal_scale: material.surface.normal_map.as_ref().map_or(1.0, |map| map.scale),
            cutoff,
            alpha,
            unused: 0.0,
        };
        pictures.iter().any(Option::is_some).then_some(Description { pictures, numbers })
    }
}

impl PartialEq for Description {
    /// Pictures are the same by their address: most frames have the same ones.
    fn eq(&self, other: &Description) -> bool {
        let same = |(a, b): (&Option<Arc<ImageTexture>>, &Option<Arc<ImageTexture>>)| match (a, b) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        self.numbers == other.numbers && self.pictures.iter().zip(&other.pictures).all(same)
    }
}

fn place(sampling: &Sampling) -> ImagePlace {
    let turn_and_scale = sampling.turn_and_scale.to_cols_array().into();
    ImagePlace { turn_and_scale, offset: sampling.offset, unused: scene::glam::Vec2::ZERO }
}

/// The bind groups of a scene's materials.
#[derive(Debug)]
pub struct Looks {
    descriptions: Vec<Option<Description>>,
    textures: Vec<(Arc<ImageTexture>, Bound)>,
    /// That of no pictures, and then one for each look.
    groups: Vec<BindGroup>,
    of_material: Vec<usize>,
}

impl Looks {
    /// Those of `scene`: the `kept` ones if nothing changed, and of pictures those that are there.
    pub fn current<'a>(
        kept: &'a mut Option<Looks>,
        gpu: &Gpu,
        layout: &BindGroupLayout,
        scene: &Scene,
        repairs: Repairs,
    ) -> Result<&'a Looks, GpuError> {
        let descriptions: Vec<_> = scene.materials.iter().map(|it| Description::of(it, repairs)).collect();
        match kept.take() {
            Some(looks) if looks.descriptions == descriptions => Ok(kept.insert(looks)),
            old => Ok(kept.insert(Looks::new(gpu, layout, descriptions, old)?)),
        }
    }

    fn new(
        gpu: &Gpu,
        layout: &BindGroupLayout,
        descriptions: Vec<Option<Description>>,
        old: Option<Looks>,
    ) -> Result<Looks, GpuError> {
        let mut looks = Looks { descriptions, textures: Vec::new(), groups: Vec::new(), of_material: Vec::new() };
        let mut old = old.map_or(Vec::new(), |old| old.textures);
        let mut different: Vec<&Description> = Vec::new();
        let none = white(gpu)?;
        looks.groups.push(group(gpu, layout, &Look::zeroed(), [&none; 5])?);
        for description in &looks.descriptions {
            let known = description.as_ref().map(|it| different.iter().position(|other| *other == it));
            looks.of_material.push(match (description, known) {
                (Some(_), Some(Some(index))) => index + 1,
                (Some(description), _) => {
                    let mut bound = [&none; 5].map(Clone::clone);
                    for (bound, picture) in bound.iter_mut().zip(&description.pictures) {
                        if let Some(picture) = picture {
                            *bound = texture(gpu, &mut looks.textures, &mut old, picture)?;
                        }
                    }
                    looks.groups.push(group(gpu, layout, &description.numbers, bound.each_ref())?);
                    different.push(description);
                    different.len()
                }
                (None, _) => 0,
            });
        }
        Ok(looks)
    }

    /// What is bound for a material.
    pub fn of(&self, material: usize) -> &BindGroup {
        &self.groups[self.of_material[material]]
    }

    /// The bind groups of all looks.
    pub fn groups(&self) -> &[BindGroup] {
        &self.groups
    }
}

/// A picture among those that are there, or moved over from `old`, or brought to the device.
fn texture(
    gpu: &Gpu,
    there: &mut Vec<(Arc<ImageTexture>, Bound)>,
    old: &mut Vec<(Arc<ImageTexture>, Bound)>,
    picture: &Arc<ImageTexture>,
) -> Result<Bound, GpuError> {
    let same = |(other, _): &(Arc<ImageTexture>, Bound)| Arc::ptr_eq(other, picture);
    if let Some((_, bound)) = there.iter().find(|it| same(it)) {
        return Ok(bound.clone());
    }
    let kept = old.iter().position(same).map(|at| old.swap_remove(at).1);
    let bound = kept.map_or_else(|| Bound::new(gpu, picture), Ok)?;
    there.push((picture.clone(), bound.clone()));
    Ok(bound)
}

fn group(gpu: &Gpu, layout: &BindGroupLayout, numbers: &Look, bound: [&Bound; 5]) -> Result<BindGroup, GpuError> {
    let numbers = gpu.buffer("how pictures are read", bytemuck::bytes_of(numbers), BufferUsages::UNIFORM)?;
    let pictures = bound.map(|bound| BindingResource::TextureView(&bound.view));
    let samplers = bound.map(|bound| BindingResource::Sampler(&bound.sampler));
    let all: Vec<_> = [numbers.as_entire_binding()].into_iter().chain(pictures).chain(samplers).collect();
    Ok(bind(gpu, layout, &all))
}
