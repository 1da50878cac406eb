//! `visavis denoise`: a picture without its noise, and with a bias, of which its records tell.

use super::args::made_by;
use super::{DenoiseArgs, RenderArgs, interrupt};
use anyhow::{Context, ensure};
use film::colour::luminance;
use film::{DisplayTransform, Features, Image, Vec3};
use image_file::{Kind, Layers, Loaded};
use std::path::Path;
use std::time::Instant;
use technique::{
    DENOISE, Denoiser, EARLIER_VIEWS, FILTER, Filters, HALVES, Halves, Technique, denoised_by, is_of_its_pixels,
};

pub fn run(args: &DenoiseArgs) -> anyhow::Result<()> {
    let Loaded { image, notes } = image_file::read(&args.picture)?;
    notes.iter().for_each(|line| note!("note: {line}"));
    ensure!(
        !image_file::is_same_file(&args.picture, &args.out),
        "-o would overwrite the noisy picture; give another name: {}",
        image_file::shown(&args.out)
    );
    let records = image_file::records(&args.picture)?;
    if let Some(filter) = denoised_by(&records) {
        let filter = image_file::escaped(filter);
        note!("note: this picture was denoised before ({filter}): {}", image_file::shown(&args.picture));
    }
    let layers = image_file::load_layers(&args.picture, image.size())?;
    image_file::check_writable(&args.out)?;
    let _heeded = interrupt::heed();
    let start = Instant::now();
    let denoised = filtered(args, &image, &layers, Halves::samples_of(&records))?;
    let seconds = start.elapsed().as_secs_f64();
    save(args, &denoised, records, seconds)?;
    let (name, out) = (args.filter.name(), image_file::shown(&args.out));
    note!("denoised by {name} in {seconds:.2} s, which leaves a bias: {out}");
    Ok(())
}

/// `samples` are those of the halves, where the file says how many.
fn filtered(args: &DenoiseArgs, image: &Image, layers: &Layers, samples: Option<[u32; 2]>) -> anyhow::Result<Image> {
    let (albedo, normal) = (layers.triples("albedo"), layers.triples("normal"));
    let depth = layers.depth();
    let needs_depth = args.filter == Denoiser::ATrous;
    let there = [
        ("albedo (R, G, B)", albedo.is_some()),
        ("normal (X, Y, Z)", normal.is_some()),
        ("depth (Z)", depth.is_some() || !needs_depth),
    ];
    let missing: Vec<&str> = there.into_iter().filter(|(_, there)| !there).map(|(name, _)| name).collect();
    let (Some(albedo), Some(normal), true) = (albedo, normal, missing.is_empty()) else {
        anyhow::bail!("{}", missing_layers(&args.picture, args.filter, &missing));
    };
    // the networks know no depth
    let depth = depth.unwrap_or_else(|| vec![0.0; albedo.len()]);
    let features =
        Features::new(image.size(), albedo, normal, depth).context("a layer is not of the picture's size")?;
    // halves that say nothing of their samples have as many as each other
    let variance = variance_by_halves(layers, samples.unwrap_or([1; 2]));
    let denoised =
        args.filter.apply(image, &features, variance.as_deref(), &Filters::on_the_processor(), &interrupt::is_asked);
    denoised.context("cannot denoise the picture")
}

fn missing_layers(picture: &Path, filter: Denoiser, missing: &[&str]) -> String {
    let (missing, picture) = (missing.join(" and "), image_file::shown(picture));
    format!(
        "cannot denoise by {}, which needs layers of the picture's size that are not there, {missing}: {picture}",
        filter.name()
    )
}

/// Whether `render --denoise` comes to the same: of light that was traced and not denoised before, in one run, without earlier views, and by a network, for
/// which the variance of samples is nothing.
fn is_made_again(args: &DenoiseArgs, records: &[(String, String)]) -> bool {
    let of_traced_light = |made: RenderArgs| match made.pane.in_use() {
        technique @ Technique::Traced(_) => technique.shows_the_scene() && technique.runs() == 1,
        Technique::Fake(_) => false,
    };
    let lags = records.iter().any(|(name, _)| name == EARLIER_VIEWS);
    let new = denoised_by(records).is_none() && !lags && args.filter != Denoiser::ATrous;
    new && made_by(&args.picture).is_ok_and(of_traced_light)
}

/// The variance of the luminance of the mean of two parts of so many samples, which are independent; `None` if they are not there.
/// That of their difference is as 1 / n0 + 1 / n1, and that of the mean as 1 / (n0 + n1).
fn variance_by_halves(layers: &Layers, samples: [u32; 2]) -> Option<Vec<f32>> {
    let [first, later] = HALVES.map(|half| layers.triples(half));
    let [n0, n1] = samples.map(|samples| samples as f32);
    let share = n0 * n1 / (n0 + n1).powi(2);
    let variance = |(a, b): (&Vec3, &Vec3)| share * luminance(*a - *b).powi(2);
    Some(first?.iter().zip(&later?).map(variance).collect())
}

/// With the noisy picture's records, those excepted that tell of its errors and the command that makes it. The filter is the option of
/// `render` where that makes this picture again.
fn save(args: &DenoiseArgs, denoised: &Image, records: Vec<(String, String)>, seconds: f64) -> anyhow::Result<()> {
    let name = if is_made_again(args, &records) { DENOISE } else { FILTER };
    let stays = |(name, _): &(String, String)| !is_of_its_pixels(name) && name != "command";
    let mut records: Vec<_> = records.into_iter().filter(stays).collect();
    records.push((name.into(), args.filter.name().into()));
    if let (Some(name), Some(hash)) = (args.filter.network_name(), args.filter.weights()) {
        records.push((format!("{DENOISE}.network"), name.into()));
        records.push((format!("{DENOISE}.weights"), hash));
    }
    records.push((format!("{DENOISE}.seconds"), seconds.to_string()));
    let kind = Kind::of(&args.out).context("a picture's name must end in .png or .exr")?;
    let display = DisplayTransform { exposure: args.exposure };
    let bytes = image_file::encode_with_read(kind, denoised, &display, &records)?;
    Ok(image_file::write_or_keep(&args.out, &bytes)?)
}
