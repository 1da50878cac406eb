//! Versions of a model that differ in its materials (KHR_materials_variants). Where a primitive names none for a variant it
//! wears its usual one.

use super::buffers::Document;
use super::json::{Mapping, Primitive};
use super::materials::Materials;
use super::names::{self, Names};
use super::{Refused, Remarks, Use};
use crate::Variant;

/// What shapes wear otherwise, in all variants together.
const MOST_WORN: usize = 1 << 22;

/// What a primitive wears in which variants.
pub fn mappings(primitive: &Primitive) -> &[Mapping] {
    primitive.extensions.variants.as_ref().map_or(&[], |variants| &variants.mappings)
}

/// Adds what a primitive wears in variants where a node shows it: files are small that name it a million times a million.
pub fn count(worn: &mut usize, primitive: &Primitive) -> Result<(), Refused> {
    let mappings = mappings(primitive);
    *worn += mappings.len();
    if *worn <= MOST_WORN {
        *worn += mappings.iter().map(|mapping| mapping.variants.len()).sum::<usize>();
    }
    match *worn > MOST_WORN {
        true => Err(Refused(format!("its nodes show more than {MOST_WORN} materials of variants"))),
        false => Ok(()),
    }
}

/// All variants of a file, of the shapes in the order of `uses`.
pub fn variants(
    document: &Document,
    uses: &[Use],
    materials: &mut Materials,
    remarks: &mut Remarks,
) -> Result<Vec<Variant>, Refused> {
    let mut variants = named(document);
    for (shape, used) in uses.iter().enumerate() {
        for mapping in mappings(used.primitive) {
            let fault = |Refused(why)| Refused(format!("{}: {why}", used.name(document)));
            wear(&mut variants, shape, used, mapping, (materials, remarks)).map_err(fault)?;
        }
    }
    Ok(variants)
}

/// Variants that differ in nothing so far.
fn named(document: &Document) -> Vec<Variant> {
    let raw = document.root.extensions.variants.as_ref().map_or(&[][..], |variants| &variants.variants);
    let mut names = Names::default();
    let variant = |(index, raw): (usize, &super::json::Named)| {
        let name = raw.name.as_deref().and_then(names::level).unwrap_or_else(|| format!("variant {}", index + 1));
        Variant { name: names.free(name), wears: Vec::new() }
    };
    raw.iter().enumerate().map(variant).collect()
}

/// Of several mappings for one variant the first holds.
fn wear(
    variants: &mut [Variant],
    shape: usize,
    used: &Use,
    mapping: &Mapping,
    (materials, remarks): (&mut Materials, &mut Remarks),
) -> Result<(), Refused> {
    if let Some(beyond) = mapping.variants.iter().find(|variant| **variant as usize >= variants.len()) {
        return Err(Refused(format!("variant {beyond} is named, but there are {}", variants.len())));
    }
    let Some(made) = materials.of_variant(mapping.material, remarks)? else { return Ok(()) };
    if made.uv_set.is_some() && made.uv_set != used.uv_set {
        remarks.of(
            "pictures of variants by other texture coordinates than the usual material's are placed by those",
            materials.list[made.index].name.clone(),
        );
    }
    for variant in &mapping.variants {
        let wears = &mut variants[*variant as usize].wears;
        if wears.last().is_none_or(|(last, _)| *last != shape) {
            wears.push((shape, made.index));
        }
    }
    Ok(())
}
