//! Materials of a scene file.

use super::picture::Pictures;
use super::raw::{self, RawMaterial, RawTexture, Table};
use super::{Fault, fault};
use crate::material::{Checkerboard, Emission};
use crate::stand_ins::{self, FakeMaterial};
use crate::{Bsdf, Conductor, Material, MetallicRoughness, Texture};
use glam::Vec3;
use std::ops::Range;
use toml::Spanned;

/// The material of this name.
pub(super) fn material(
    name: String,
    raw: Spanned<Table<RawMaterial>>,
    pictures: &mut Pictures,
) -> Result<Material, Fault> {
    let (at, Table(raw)) = (raw.span(), raw.into_inner());
    let kinds = [
        raw.diffuse.is_some(),
        raw.mirror.is_some(),
        raw.rough_conductor.is_some(),
        raw.metallic_roughness.is_some(),
        raw.dielectric.is_some(),
    ];
    if kinds.iter().filter(|&&k| k).count() > 1 {
        return fault(at, format!("material '{name}' scatters in several ways: expected one of {LOBES}"));
    }
    let bsdf = if let Some(Table(diffuse)) = raw.diffuse {
        Bsdf::Diffuse { albedo: texture(diffuse.albedo, pictures)? }
    } else if let Some(Table(mirror)) = raw.mirror {
        Bsdf::Mirror { reflectance: mirror.reflectance.into() }
    } else if let Some(Table(metal)) = raw.rough_conductor {
        Bsdf::RoughConductor { roughness: metal.roughness.get(), conductor: conductor(metal, &name, at.clone())? }
    } else if let Some(Table(model)) = raw.metallic_roughness {
        Bsdf::MetallicRoughness(metallic_roughness(model, pictures)?)
    } else if let Some(Table(glass)) = raw.dielectric {
        Bsdf::Dielectric { ior: glass.ior.get() }
    } else if raw.emissive.is_some() {
        Bsdf::Diffuse { albedo: Texture::Constant(Vec3::ZERO) }
    } else {
        return fault(at, format!("material '{name}' is empty: expected {LOBES} or emissive"));
    };
    if raw.emissive.is_some() && matches!(bsdf, Bsdf::Dielectric { .. }) {
        return fault(at, format!("material '{name}': expected emissive alone, or with another lobe than dielectric"));
    }
    let (emission, glow) = raw.emissive.map_or((None, None), |Table(e)| {
        (Some(Emission { radiance: e.radiance.into(), two_sided: e.two_sided }), e.texture)
    });
    let surface = pictures.surface(raw.normal_map, raw.alpha_mask, glow)?;
    let (d, raw_fake) = (FakeMaterial::default(), raw.fake.0);
    let fake = FakeMaterial {
        refraction_ratio: raw_fake.refraction_ratio.map(|v| v.get()),
        reflectivity: raw_fake.reflectivity.map_or(d.reflectivity, |v| v.get()),
        specular: raw_fake.specular.map_or(d.specular, |v| v.get()),
        shininess: raw_fake.shininess.map_or_else(|| stand_ins::usual_shininess(&bsdf), |v| v.get()),
    };
    Ok(Material { name, bsdf, emission, surface, fake })
}

/// The ways to scatter, as a fault lists them.
const LOBES: &str = "diffuse, mirror, rough_conductor, metallic_roughness, dielectric";

fn conductor(raw: raw::RawRoughConductor, material: &str, at: Range<usize>) -> Result<Conductor, Fault> {
    match (raw.reflectance, raw.eta, raw.k, raw.metal) {
        (Some(reflectance), None, None, None) => Ok(Conductor::Constant(reflectance.into())),
        (None, Some(eta), Some(k), None) => Ok(Conductor::Fresnel { eta: eta.into(), k: k.into() }),
        (None, None, None, Some(name)) => match Conductor::named(name.get_ref()) {
            Some(metal) => Ok(metal),
            None => {
                let known = Conductor::names().collect::<Vec<_>>().join(", ");
                fault(name.span(), format!("no metal is called '{}': known are {known}", name.get_ref()))
            }
        },
        _ => fault(at, format!("material '{material}': expected one of reflectance, eta with k, or metal")),
    }
}

fn metallic_roughness(raw: raw::RawMetallicRoughness, pictures: &mut Pictures) -> Result<MetallicRoughness, Fault> {
    let read = |Table(raw)| pictures.without_factor(raw, image_file::Encoding::Linear);
    let metallic_roughness = raw.texture.map(read).transpose()?;
    Ok(MetallicRoughness {
        base_colour: texture(raw.base_colour, pictures)?,
        metallic: raw.metallic.get(),
        roughness: raw.roughness.get(),
        metallic_roughness,
        ior: raw.ior.map_or(MetallicRoughness::USUAL_IOR, |ior| ior.get()),
    })
}

fn texture(raw: RawTexture, pictures: &mut Pictures) -> Result<Texture, Fault> {
    Ok(match raw {
        RawTexture::Constant(colour) => Texture::Constant(colour.into()),
        RawTexture::Image(picture) => pictures.colour(picture)?,
        RawTexture::Checkerboard(b) => Texture::Checkerboard(Checkerboard {
            even: b.even.into(),
            odd: b.odd.into(),
            origin: b.origin.into(),
            cell: b.cell.into(),
        }),
    })
}
