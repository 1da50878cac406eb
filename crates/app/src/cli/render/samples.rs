//! A range of a picture's samples, for `visavis merge` to put together with others: where it begins, and what its file says.

use crate::cli::RenderArgs;
use film::{Film, Layer};
use image_file::Records;
use technique::{Accumulation, NONFINITE, layers_of_sums, tell_samples};

/// A film that begins where the range does; `None` if there is no memory for it.
pub fn blank(args: &RenderArgs, size: (u32, u32)) -> Option<Accumulation> {
    match &args.samples {
        Some(samples) => Accumulation::beginning_at(samples.first(), size),
        None => Accumulation::blank(size),
    }
}

/// The sums of the range.
pub fn layers(args: &RenderArgs, film: &Film) -> Vec<Layer> {
    if args.samples.is_some() { layers_of_sums(film) } else { Vec::new() }
}

/// With which samples of the range were made, if it is one.
pub fn records(args: &RenderArgs, film: &Film, records: Records) -> anyhow::Result<Vec<(String, String)>> {
    let mut records = records.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    if let Some(samples) = &args.samples {
        let first = samples.first();
        tell_samples(&mut records, &(first..first + film.samples_per_pixel()).into())?;
        if film.nonfinite > 0 {
            records.push((NONFINITE.into(), film.nonfinite.to_string()));
        }
    }
    Ok(records)
}
