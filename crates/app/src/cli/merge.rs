//! `visavis merge`: films of ranges of one picture's samples become the film of all of them.

mod parts;

use self::parts::{Part, checked};
use super::MergeArgs;
use super::args::made_by;
use anyhow::{Context, ensure};
use film::{DisplayTransform, Feature, Film, Layer, LayerValues};
use image_file::{Kind, load_layer};
use serde_json::json;
use technique::{NONFINITE, SampleRanges, Technique, film_of_sums, layers_of_sums, tell_samples};

pub fn run(args: &MergeArgs) -> anyhow::Result<()> {
    let (parts, samples) = checked(&args.parts)?;
    for part in &args.parts {
        ensure!(
            !image_file::is_same_file(part, &args.out),
            "-o would overwrite a film that is merged; give another name: {}",
            image_file::shown(&args.out)
        );
    }
    image_file::check_writable(&args.out)?;
    let size = made_by(&parts[0].file)?.seen.size;
    let film = together(&parts, size)?;
    save(args, &parts, &film, &samples)?;
    if film.nonfinite > 0 {
        note!("visavis: {} samples were not finite and are left out: please report this scene", film.nonfinite);
    }
    if args.json {
        return super::print(&format!("{}\n", report(&parts, &film, &samples)?));
    }
    let gaps = if samples.without_gaps().is_some() { "" } else { ", with gaps between them" };
    let (files, spp) = (parts.len(), samples.count());
    note!("merged {files} films: samples {samples}{gaps}, {spp} spp: {}", image_file::shown(&args.out));
    Ok(())
}

/// The sums of all, added in the order of the samples, so that the order of the files is nothing.
fn together(parts: &[Part], size: (u32, u32)) -> anyhow::Result<Film> {
    let no_memory = || format!("not enough memory for a film of {}x{} pixels", size.0, size.1);
    let mut all = Film::try_new(size.0, size.1).with_context(no_memory)?;
    for part in parts {
        let film = film_of_sums(&part.file, size, &part.samples)?.with_context(|| parts::no_sums(&part.file))?;
        all.add_all(&film);
        all.nonfinite = all.nonfinite.saturating_add(part.nonfinite()?);
    }
    Ok(all)
}

fn save(args: &MergeArgs, parts: &[Part], film: &Film, samples: &SampleRanges) -> anyhow::Result<()> {
    let kind = Kind::of(&args.out).context("a picture's name must end in .png or .exr")?;
    let mut image = film.image();
    if kind == Kind::Exr {
        image.layers = layers_of_sums(film);
        image.layers.extend(features(parts, image.size())?);
    }
    let mut records = parts::records_of_all(parts, args.exposure);
    tell_samples(&mut records, samples)?;
    if film.nonfinite > 0 {
        records.push((NONFINITE.into(), film.nonfinite.to_string()));
    }
    let display = DisplayTransform { exposure: args.exposure };
    let bytes = image_file::encode_with_read(kind, &image, &display, &records)?;
    Ok(image_file::write_or_keep(&args.out, &bytes)?)
}

/// What is seen without light, which is the same whatever samples there are: of the first film that has it, for denoisers.
fn features(parts: &[Part], size: (u32, u32)) -> anyhow::Result<Vec<Layer>> {
    for part in parts {
        let layer = |feature: Feature| {
            let values = load_layer(&part.file, feature.name(), size)?;
            Ok(values.map(|values: LayerValues| Layer { name: feature.name(), values }))
        };
        let layers: anyhow::Result<Vec<_>> = Feature::ALL.into_iter().map(layer).collect();
        if let Some(layers) = layers?.into_iter().collect() {
            return Ok(layers);
        }
    }
    Ok(Vec::new())
}

fn report(parts: &[Part], film: &Film, samples: &SampleRanges) -> anyhow::Result<serde_json::Value> {
    let independent = match made_by(&parts[0].file)?.pane.in_use() {
        technique @ Technique::Traced(traced) => traced.integrator.is_independent() && technique.shows_the_scene(),
        Technique::Fake(_) => false,
    };
    Ok(json!({
        "films": parts.len(),
        "samples": samples.to_string(),
        "spp": samples.count(),
        "width": film.width(),
        "height": film.height(),
        "mean": film.mean(),
        "nonfinite": film.nonfinite,
        "standard_error": film.standard_error(),
        "standard_error_reliable": independent && film.standard_error_is_reliable(),
    }))
}
