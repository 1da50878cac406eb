//! Materials: metallic-roughness with its pictures, and what extensions make of it (glTF 2.0, section 3.9).

use super::buffers::Document;
use super::json::{self, AlphaMode, TextureInfo};
use super::names::Names;
use super::textures::Textures;
use super::{Refused, Remarks, named};
use crate::material::{Emission, MetallicRoughness, NormalMap, SurfaceDetail};
use crate::progress::Progress;
use crate::stand_ins::{FakeMaterial, usual_shininess};
use crate::{Alpha, Bsdf, ImageTexture, Material, Texture, Vec3};
use image_file::CodeCurve;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Roughness up to which what transmits is clear glass.
const CLEAR: f32 = 0.1;

/// Transmission from which on all light is let through.
const ALL: f32 = 0.99;

/// Alpha from which on there is a surface where it should be mixed with what is behind.
const BLENDED: f32 = 0.5;

/// A material that was made.
#[derive(Clone, Copy)]
pub struct Made {
    /// Its place in [`Materials::list`].
    pub index: usize,
    /// The set of texture coordinates that its pictures are placed by, if it has any.
    pub uv_set: Option<u32>,
}

/// The materials of a file, each made when a shape first wears it.
pub struct Materials<'a> {
    document: &'a Document,
    progress: &'a Progress<'a>,
    textures: Textures<'a>,
    made: HashMap<Option<u32>, Made>,
    /// Of variants, which cannot be shown.
    failed: HashSet<u32>,
    names: Names,
    /// Of each picture that was looked through.
    least_alphas: HashMap<*const ImageTexture, f32>,
    pub list: Vec<Material>,
}

/// The pictures of a material, which are all placed by one set of texture coordinates.
#[derive(Default)]
struct Pictures {
    uv_set: Option<u32>,
    base_colour: Option<Arc<ImageTexture>>,
    normals: Option<Arc<ImageTexture>>,
    metallic_roughness: Option<Arc<ImageTexture>>,
    emission: Option<Arc<ImageTexture>>,
}

impl<'a> Materials<'a> {
    pub fn new(document: &'a Document, progress: &'a Progress<'a>) -> Self {
        Materials {
            document,
            progress,
            textures: Textures::new(document),
            made: HashMap::new(),
            failed: HashSet::new(),
            names: Names::default(),
            least_alphas: HashMap::new(),
            list: Vec::new(),
        }
    }

    /// The material at an index of the file; without one that which the specification gives.
    pub fn of(&mut self, index: Option<u32>, remarks: &mut Remarks) -> Result<Made, Refused> {
        if let Some(made) = self.made.get(&index) {
            return Ok(*made);
        }
        let (default, document) = (json::Material::default(), self.document);
        let raw = match index {
            None => &default,
            Some(index) => self.raw(index).ok_or_else(|| {
                Refused(format!("material {index} is named, but there are {}", document.root.materials.len()))
            })?,
        };
        let shown = index.map_or_else(|| "the default material".into(), |i| named("material", i, raw.name.as_deref()));
        let fault = |Refused(why)| Refused(format!("{shown}: {why}"));
        if raw.occlusion_texture.is_some() {
            remarks.of("shadows in pictures (occlusionTexture) are left out: rays find them", shown.clone());
        }
        let pictures = self.pictures(raw, &shown, remarks).map_err(fault)?;
        let uv_set = pictures.uv_set;
        let usual = || index.map_or_else(|| "default".into(), |index| format!("material {index}"));
        let name = raw.name.as_ref().map_or_else(usual, |name| image_file::escaped(name));
        let name = self.names.free(name);
        let least_alpha = self.least_alpha(raw.alpha_mode, &pictures);
        self.list.push(material(name, raw, pictures, least_alpha, &shown, remarks).map_err(fault)?);
        let made = Made { index: self.list.len() - 1, uv_set };
        self.made.insert(index, made);
        Ok(made)
    }

    /// The material of a variant: `None` with a line if it cannot be shown, for the usual ones can.
    pub fn of_variant(&mut self, index: u32, remarks: &mut Remarks) -> Result<Option<Made>, Refused> {
        if self.failed.contains(&index) {
            return Ok(None);
        }
        match self.of(Some(index), remarks) {
            Ok(made) => Ok(Some(made)),
            Err(Refused(why)) if self.raw(index).is_some() && !self.progress.is_stopped() => {
                remarks.of("materials of variants that cannot be shown are left out: the usual ones stay", why);
                self.failed.insert(index);
                Ok(None)
            }
            Err(refused) => Err(refused),
        }
    }

    fn raw(&self, index: u32) -> Option<&'a json::Material> {
        self.document.root.materials.get(index as usize)
    }

    /// The set of texture coordinates that a material will be placed by once it is made: that of its first picture.
    pub fn uv_set_of(&self, index: u32) -> Option<u32> {
        let raw = self.raw(index)?;
        let pbr = &raw.pbr_metallic_roughness;
        let others = [&raw.normal_texture, &pbr.metallic_roughness_texture, &raw.emissive_texture];
        let others = others.into_iter().filter(|_| raw.extensions.unlit.is_none());
        let mut infos = [&pbr.base_color_texture].into_iter().chain(others).flatten();
        let textures = &self.document.root.textures;
        let is_read = |info: &&TextureInfo| textures.get(info.index as usize).is_some_and(|t| t.source.is_some());
        infos.find(is_read).map(placed_by)
    }

    /// The least alpha of the base colour's picture, where it counts; of none 1.
    fn least_alpha(&mut self, mode: AlphaMode, pictures: &Pictures) -> f32 {
        let Some(image) = pictures.base_colour.as_ref().filter(|_| mode != AlphaMode::Opaque) else { return 1.0 };
        let least = || image.texels().iter().fold(1.0, |least: f32, texel| least.min(texel[3]));
        *self.least_alphas.entry(Arc::as_ptr(image)).or_insert_with(least)
    }

    fn pictures(&mut self, raw: &json::Material, shown: &str, remarks: &mut Remarks) -> Result<Pictures, Refused> {
        let mut uv_set = None;
        let mut read = |info: &Option<TextureInfo>, curve| match info {
            Some(info) => self.picture(info, curve, &mut uv_set, shown, remarks),
            None => Ok(None),
        };
        let base_colour = read(&raw.pbr_metallic_roughness.base_color_texture, CodeCurve::Srgb)?;
        if raw.extensions.unlit.is_some() {
            return Ok(Pictures { base_colour, uv_set, ..Pictures::default() });
        }
        let normals = read(&raw.normal_texture, CodeCurve::Linear)?;
        let metallic_roughness = read(&raw.pbr_metallic_roughness.metallic_roughness_texture, CodeCurve::Linear)?;
        let emission = read(&raw.emissive_texture, CodeCurve::Srgb)?;
        Ok(Pictures { base_colour, normals, metallic_roughness, emission, uv_set })
    }

    fn picture(
        &mut self,
        info: &TextureInfo,
        curve: CodeCurve,
        uv_set: &mut Option<u32>,
        shown: &str,
        remarks: &mut Remarks,
    ) -> Result<Option<Arc<ImageTexture>>, Refused> {
        let wanted = placed_by(info);
        if uv_set.is_some_and(|set| set != wanted) {
            remarks.of("pictures of other texture coordinates than a material's first are left out", shown.to_owned());
            return Ok(None);
        }
        let share = self.list.len() as f32 / self.document.root.materials.len().max(1) as f32;
        self.progress.tell(&format!("reading the pictures of {shown}"), share)?;
        let picture = self.textures.of(info, curve, remarks)?;
        if picture.is_some() {
            *uv_set = Some(wanted);
        }
        Ok(picture)
    }
}

/// The set of texture coordinates that a picture asks for.
fn placed_by(info: &TextureInfo) -> u32 {
    let moved = info.extensions.transform.as_ref().and_then(|transform| transform.tex_coord);
    moved.unwrap_or(info.tex_coord)
}

fn material(
    name: String,
    raw: &json::Material,
    pictures: Pictures,
    least_alpha: f32,
    shown: &str,
    remarks: &mut Remarks,
) -> Result<Material, Refused> {
    let [r, g, b, opacity] = raw.pbr_metallic_roughness.base_color_factor.unwrap_or([1.0; 4]).map(share);
    let (factor, two_sided) = (Vec3::new(r, g, b), raw.double_sided);
    let alpha = alpha(raw, opacity, least_alpha, pictures.base_colour.as_ref(), shown, remarks);
    let normals = |image| NormalMap { image, scale: raw.normal_texture.as_ref().and_then(|n| n.scale).unwrap_or(1.0) };
    let normal_map = pictures.normals.clone().map(normals);
    let (bsdf, emission, image) = if raw.extensions.unlit.is_some() {
        remarks.of("unlit materials shine with their colour, and so light what is around them", shown.to_owned());
        let emission = Emission { radiance: factor, two_sided };
        (Bsdf::Diffuse { albedo: Texture::Constant(Vec3::ZERO) }, Some(emission), pictures.base_colour)
    } else {
        // a lamp whose picture is left out would shine where it is black
        let without_picture = raw.emissive_texture.is_some() && pictures.emission.is_none();
        let emission = emission(raw)?.filter(|_| !without_picture);
        let bsdf = scattering(raw, factor, &pictures, shown, remarks);
        if matches!(bsdf, Bsdf::Dielectric { .. }) && emission.is_some() {
            remarks.of("clear glass does not shine", shown.to_owned());
            (bsdf, None, None)
        } else {
            let image = emission.and(pictures.emission);
            (bsdf, emission, image)
        }
    };
    let usual = FakeMaterial::default();
    // what is unlit has no highlight
    let specular = if raw.extensions.unlit.is_some() { 0.0 } else { usual.specular };
    let fake = FakeMaterial { shininess: usual_shininess(&bsdf), specular, ..usual };
    Ok(Material { name, bsdf, emission, surface: SurfaceDetail { normal_map, alpha, emission: image }, fake })
}

/// A factor, which the specification has from 0 to 1.
fn share(factor: f32) -> f32 {
    factor.clamp(0.0, 1.0)
}

fn emission(raw: &json::Material) -> Result<Option<Emission>, Refused> {
    let strength = raw.extensions.emissive_strength.as_ref().and_then(|e| e.emissive_strength).unwrap_or(1.0);
    let radiance = Vec3::from(raw.emissive_factor.unwrap_or([0.0; 3]).map(share)) * strength;
    if !(radiance.min_element() >= 0.0 && radiance.max_element() <= super::meshes::LARGEST) {
        return Err(Refused("what it emits must be from 0 to 1e12".into()));
    }
    let shines = radiance.max_element() > 0.0;
    Ok(shines.then_some(Emission { radiance, two_sided: raw.double_sided }))
}

/// Clear glass, or the metallic-roughness model.
fn scattering(raw: &json::Material, factor: Vec3, pictures: &Pictures, shown: &str, remarks: &mut Remarks) -> Bsdf {
    let pbr = &raw.pbr_metallic_roughness;
    let ior = raw.extensions.ior.as_ref().and_then(|ior| ior.ior).filter(|ior| (1.0..=100.0).contains(ior));
    let (ior, roughness) = (ior.unwrap_or(1.5), share(pbr.roughness_factor.unwrap_or(1.0)));
    let metallic = share(pbr.metallic_factor.unwrap_or(1.0));
    let transmission = raw.extensions.transmission.as_ref();
    if let Some(transmission) = transmission.filter(|t| t.transmission_factor > 0.0) {
        let whole = transmission.transmission_factor >= ALL && transmission.transmission_texture.is_none();
        if whole && roughness < CLEAR && metallic < 1.0 - ALL {
            tell_of_glass(raw, factor, pictures, shown, remarks);
            return Bsdf::Dielectric { ior };
        }
        remarks.of("glass that is rough, or lets only a part through, is opaque", shown.to_owned());
    }
    let base_colour = match &pictures.base_colour {
        Some(image) => Texture::Image { image: image.clone(), factor },
        None => Texture::Constant(factor),
    };
    let metallic_roughness = pictures.metallic_roughness.clone();
    Bsdf::MetallicRoughness(MetallicRoughness { base_colour, metallic, roughness, metallic_roughness, ior })
}

/// What clear glass lacks of what the file says.
fn tell_of_glass(raw: &json::Material, factor: Vec3, pictures: &Pictures, shown: &str, remarks: &mut Remarks) {
    let volume = raw.extensions.volume.as_ref();
    if volume.is_some_and(|volume| volume.attenuation_distance.is_some()) {
        remarks.of("what glass absorbs on the way through (KHR_materials_volume) is left out", shown.to_owned());
    }
    if !volume.is_some_and(|volume| volume.thickness_factor > 0.0) {
        remarks.of("glass without thickness is taken as solid: it refracts", shown.to_owned());
    }
    if factor != Vec3::ONE || pictures.base_colour.is_some() {
        remarks.of("clear glass has no colour", shown.to_owned());
    }
}

/// Where there is a surface. What should be mixed with what is behind is there or not; what is opaque everywhere costs nothing.
fn alpha(
    raw: &json::Material,
    factor: f32,
    least_alpha: f32,
    image: Option<&Arc<ImageTexture>>,
    shown: &str,
    remarks: &mut Remarks,
) -> Alpha {
    let least = factor * least_alpha;
    let cutoff = match raw.alpha_mode {
        AlphaMode::Opaque => return Alpha::Opaque,
        AlphaMode::Mask => raw.alpha_cutoff.unwrap_or(0.5),
        AlphaMode::Blend => BLENDED,
    };
    if raw.alpha_mode == AlphaMode::Blend && least < 1.0 {
        remarks.of("alpha is not mixed (BLEND): a surface is there from alpha 0.5 on", shown.to_owned());
    }
    if least >= cutoff { Alpha::Opaque } else { Alpha::Mask { cutoff, factor, image: image.cloned() } }
}
