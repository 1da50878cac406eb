//! `visavis compare`: how far one picture is from another, or from the reference of what it shows, in numbers and as a
//! map.

mod effects;

use super::args::made_by;
use super::{CompareArgs, reference};
use crate::ruler::{HeatMap, Noise, Pair, error_words, kept_scene, noise_line};
use ::reference::Reference;
use anyhow::ensure;
use compare::flip::{PIXELS_PER_DEGREE, hdr_flip};
use compare::{ErrorMetric, Errors, finite_mean};
use effects::NamedEffects;
use film::{DisplayTransform, Image};
use image_file::{Kind, Loaded, Records};
use serde_json::json;
use std::path::Path;

/// What two pictures say of each other.
struct Comparison {
    errors: Errors,
    /// Mean LDR-FLIP, through the display transform.
    flip: f64,
    /// Mean HDR-FLIP, over a sweep of exposures.
    hdr_flip: f64,
}

pub fn run(args: &CompareArgs) -> anyhow::Result<()> {
    let Loaded { image: a, notes } = image_file::read(&args.film)?;
    tell(&notes);
    if let Some(out) = &args.heatmap {
        refuse_to_overwrite(args, out)?;
        image_file::check_writable(out)?;
    }
    let shot = if args.effects { Some(effects::shot_of(&args.film)?) } else { None };
    tell_of_denoising(args);
    tell_of_bugs(args);
    let r = match &args.reference {
        Some(file) => {
            refuse_other_light(&args.film, file)?;
            tell_of_two_scenes(&args.film, file);
            let (reference, notes) = Reference::load_with_notes(file)?;
            tell(&notes);
            reference
        }
        None => reference_of(&args.film, &a)?,
    };
    let clipped = |file: &Path| Kind::of(file) == Some(Kind::Png);
    if clipped(&args.film) && !args.reference.as_deref().is_some_and(clipped) {
        note!("note: what is brighter than white is clipped in a .png, and its exposure counts; an .exr has neither");
    }
    let display = DisplayTransform { exposure: args.exposure };
    let pair =
        Pair { names: ["A", "reference"], images: [a, r.image.clone()], noise: [Noise::Unknown, Noise::None], display };
    let found = measure(&pair, &r)?;
    if found.errors.nonfinite > 0 {
        note!("note: {} pixels are not finite and are left out of every mean", found.errors.nonfinite);
    }
    let effects = shot.map(|shot| NamedEffects::of(shot, &pair)).transpose()?;
    let map = match &args.heatmap {
        Some(out) => Some(draw(args, &pair, out, effects.as_ref())?),
        None => None,
    };
    let (map, effects) = (map.as_ref(), effects.as_ref());
    let text = if args.json { report(args, &pair, &found, (map, effects)) } else { table(&found, (map, effects)) };
    super::print(&text)
}

/// What of the files is not compared.
fn tell(notes: &[String]) {
    notes.iter().for_each(|line| note!("note: {line}"));
}

/// Errors of a denoised picture are its bias as much as its noise, and one that is taken for the truth is none.
fn tell_of_denoising(args: &CompareArgs) {
    if let Some(filter) = denoised_by(&args.film) {
        note!("note: A is denoised ({filter}): its errors are a bias too: {}", image_file::shown(&args.film));
    }
    if let Some((file, filter)) = args.reference.as_deref().and_then(|file| Some((file, denoised_by(file)?))) {
        note!("note: B is denoised ({filter}) and biased: it is no reference: {}", image_file::shown(file));
    }
}

/// A picture with bugs on has their errors, and one that is taken for the truth is none.
fn tell_of_bugs(args: &CompareArgs) {
    if let Some(bugs) = bugs_of(&args.film) {
        note!("note: A has {bugs}: its errors are those as well: {}", image_file::shown(&args.film));
    }
    if let Some((file, bugs)) = args.reference.as_deref().and_then(|file| Some((file, bugs_of(file)?))) {
        note!("note: B has {bugs}: the truth is broken, and no reference: {}", image_file::shown(file));
    }
}

/// By the picture's own records, where it has any.
fn bugs_of(file: &Path) -> Option<String> {
    technique::bugs_of(&image_file::records(file).ok()?).map(|words| image_file::escaped(&words))
}

/// By the picture's own records, where it has any.
fn denoised_by(file: &Path) -> Option<String> {
    // a file that cannot be read is told by who reads the picture
    technique::denoised_by(&image_file::records(file).ok()?).map(image_file::escaped)
}

/// A map must not take the place of what it is a map of.
fn refuse_to_overwrite(args: &CompareArgs, out: &Path) -> anyhow::Result<()> {
    let taken = std::iter::once(&args.film).chain(&args.reference).any(|file| image_file::is_same_file(file, out));
    ensure!(
        !taken,
        "--heatmap would overwrite a picture that is compared; give another name: {}",
        image_file::shown(out)
    );
    Ok(())
}

/// The reference of what a picture's records say that it shows.
fn reference_of(file: &Path, picture: &Image) -> anyhow::Result<Reference> {
    let made = made_by(file)?;
    ensure!(
        made.pane.in_use().shows_the_scene(),
        "this shows no light of the scene, but a map of the fake, or albedo, normals or depths: {}",
        image_file::shown(file)
    );
    ensure!(
        made.pane.in_use().has_a_reference(),
        "this shows a part of the light (--light {}), and references have all of it; name another picture of that part to compare \
         with: {}",
        made.pane.in_use().light(),
        image_file::shown(file)
    );
    ensure!(
        made.seen.size == picture.size(),
        "its records are of another size, {}x{}: {}",
        made.seen.size.0,
        made.seen.size.1,
        image_file::shown(file)
    );
    let shot = made.shot()?;
    made.check_truth(&shot.scene)?;
    reference::obtain(&shot, None)
}

/// What differs between two parts of the light is no error. A picture that does not say what it shows is believed.
fn refuse_other_light(a: &Path, b: &Path) -> anyhow::Result<()> {
    // a file that cannot be read is told by who reads the picture
    let [of_a, of_b] = [a, b].map(|file| image_file::records(file).unwrap_or_default());
    let (Some(light_of_a), Some(light_of_b)) = (technique::light_of(&of_a), technique::light_of(&of_b)) else {
        return Ok(());
    };
    ensure!(
        light_of_a == light_of_b,
        "these show other parts of the light (--light {} and --light {}), which is no error; compare pictures of the same part: {}, {}",
        image_file::escaped(light_of_a),
        image_file::escaped(light_of_b),
        image_file::shown(a),
        image_file::shown(b)
    );
    Ok(())
}

/// Pictures of two scenes may well be compared, but then somebody meant it.
fn tell_of_two_scenes(a: &Path, b: &Path) {
    let told = |file| {
        kept_scene(file).unwrap_or_else(|line| {
            note!("note: {line}");
            None
        })
    };
    if let (Some(scene_of_a), Some(scene_of_b)) = (told(a), told(b))
        && !scene_of_a.has_the_truth_of(&scene_of_b)
    {
        note!(
            "note: these pictures are of two scenes, or of one that has changed: {}, {}",
            image_file::shown(a),
            image_file::shown(b)
        );
    }
}

fn measure(pair: &Pair, reference: &Reference) -> anyhow::Result<Comparison> {
    let [picture, truth] = &pair.images;
    let shown = ErrorMetric::Flip.of(picture, truth, &pair.display)?;
    let swept = hdr_flip(picture, truth, PIXELS_PER_DEGREE)?;
    Ok(Comparison {
        errors: reference.errors(picture)?,
        flip: finite_mean(&shown).0,
        hdr_flip: finite_mean(&swept.values).0,
    })
}

fn draw(args: &CompareArgs, pair: &Pair, out: &Path, effects: Option<&NamedEffects>) -> anyhow::Result<HeatMap> {
    let map = HeatMap::of(pair, args.map, args.scale)?;
    let kind = Kind::of(out).unwrap_or(Kind::Png);
    let bytes = match effects.filter(|_| kind == Kind::Png) {
        Some(effects) => effects.encode_over(&map)?,
        None => map.encode(kind, pair, Records::new())?,
    };
    image_file::write_or_keep(out, &bytes)?;
    Ok(map)
}

/// A map and the effects of light on it, where they are asked for.
type Drawn<'a> = (Option<&'a HeatMap>, Option<&'a NamedEffects>);

fn table(found: &Comparison, (map, effects): Drawn) -> String {
    let e = &found.errors;
    let [off, brightness] = error_words(e, None);
    let mut text = format!(
        "RMSE      {:.6}\nrelMSE    {:.6}\nMAE       {:.6} ({off})\nmean A-B  {:+.6} ({brightness})\nFLIP      {:.6}\nHDR-FLIP  {:.6}\n",
        e.rmse, e.rel_mse, e.mae, e.bias, found.flip, found.hdr_flip
    );
    if let Some(noise) = noise_line(e) {
        text += &format!("noise     {noise}\n");
    }
    if let Some(HeatMap { label, scale, .. }) = map {
        text += &format!("map       {label}, {} from {} to {}\n", scale.map.name(), scale.low, scale.high);
    }
    effects.into_iter().for_each(|effects| text += &effects.lines());
    text
}

fn report(args: &CompareArgs, pair: &Pair, found: &Comparison, (map, effects): Drawn) -> String {
    let e = &found.errors;
    let (width, height) = pair.images[0].size();
    let mut report = json!({
        "a": args.film.to_string_lossy(),
        "reference": args.reference.as_ref().map(|file| file.to_string_lossy()),
        "width": width, "height": height,
        "rmse": e.rmse, "relmse": e.rel_mse, "mae": e.mae, "relative_mae": e.relative_mae,
        "bias": e.bias, "relative_bias": e.relative_bias,
        "reference_noise": e.reference_noise, "below_reference_noise": e.below_reference_noise(),
        "flip": found.flip, "hdr_flip": found.hdr_flip,
        "nonfinite": e.nonfinite,
        "denoised": denoised_by(&args.film),
    });
    if let Some(HeatMap { label, scale, .. }) = map {
        report["map"] = json!({
            "label": label, "colours": scale.map.name(), "low": scale.low, "high": scale.high,
        });
    }
    if let Some(effects) = effects {
        report["effects"] = effects.json();
    }
    format!("{report}\n")
}
