//! `visavis compare`: how far one picture is from another, in numbers and as a map.

use super::CompareArgs;
use anyhow::ensure;
use compare::flip::{PIXELS_PER_DEGREE, hdr_flip};
use compare::{ColourScale, ErrorMap, Errors, errors_of_radiances, finite_mean};
use picture_file::{self, Kind, Layer, LayerValues, Radiances, Records};
use scene::display::DisplayTransform;
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

/// Height of the colour bar under a heat map, in pixels.
const BAR: u32 = 12;

pub fn run(args: &CompareArgs) -> anyhow::Result<()> {
    let (a, b) = (picture_file::load(&args.film)?, picture_file::load(&args.reference)?);
    ensure!(
        (a.width, a.height) == (b.width, b.height),
        compare::CompareError::Sizes(a.width, a.height, b.width, b.height)
    );
    if let Some(out) = &args.heatmap {
        picture_file::check_writable(out)?;
    }
    let display = DisplayTransform { exposure: args.exposure };
    let found = measure(&a, &b, &display)?;
    if found.errors.nonfinite > 0 {
        note!("note: {} pixels are not finite and are left out of every mean", found.errors.nonfinite);
    }
    let scale = match &args.heatmap {
        Some(out) => Some(draw(args.map, &a, &b, &display, out)?),
        None => None,
    };
    let text = if args.json { report(args, &a, &found, scale) } else { table(&found, scale) };
    super::print(&text)
}

fn measure(a: &Radiances, b: &Radiances, display: &DisplayTransform) -> anyhow::Result<Comparison> {
    let shown = ErrorMap::Flip.of_radiances(&a.radiances, &b.radiances, a.width, display)?;
    let swept = hdr_flip(&a.radiances, &b.radiances, a.width, PIXELS_PER_DEGREE)?;
    Ok(Comparison {
        errors: errors_of_radiances(&a.radiances, &b.radiances),
        flip: finite_mean(&shown).0,
        hdr_flip: finite_mean(&swept.values).0,
    })
}

/// Writes the map: a PNG in colour with its colour bar below, low at the left; or an EXR with both pictures and every map
/// as layers of numbers.
fn draw(
    map: ErrorMap,
    a: &Radiances,
    b: &Radiances,
    display: &DisplayTransform,
    out: &Path,
) -> anyhow::Result<ColourScale> {
    let values_of = |map: ErrorMap| map.of_radiances(&a.radiances, &b.radiances, a.width, display);
    let values = values_of(map)?;
    let scale = ColourScale::fitted(map, &values);
    let bytes = if Kind::of(out) == Some(Kind::Exr) {
        let mut layers = vec![
            Layer { name: "A", values: LayerValues::Rgb(&a.radiances) },
            Layer { name: "reference", values: LayerValues::Rgb(&b.radiances) },
        ];
        for map in ErrorMap::ALL {
            layers.push(Layer { name: map.name(), values: LayerValues::Numbers(values_of(map)?) });
        }
        picture_file::encode_layers(a.width, a.height, &layers, &Records::new())?
    } else {
        let mut rgba = scale.image(&values, a.width);
        rgba.extend(scale.bar(a.width, BAR));
        let records = vec![
            ("map", scale.label.to_owned()),
            ("colours", scale.map.name().to_owned()),
            ("low", scale.low.to_string()),
            ("high", scale.high.to_string()),
        ];
        picture_file::encode_rgba8(a.width, a.height + BAR, &rgba, &records)?
    };
    picture_file::write_whole(out, &bytes)?;
    Ok(scale)
}

fn table(found: &Comparison, scale: Option<ColourScale>) -> String {
    let e = &found.errors;
    let mut text = format!(
        "RMSE      {:.6}\nrelMSE    {:.6}\nMAE       {:.6}\nbias      {:+.6} (A - B, {:+.3} %)\nFLIP      {:.6}\nHDR-FLIP  {:.6}\n",
        e.rmse,
        e.rel_mse,
        e.mae,
        e.bias,
        100.0 * e.relative_bias,
        found.flip,
        found.hdr_flip
    );
    if let Some(scale) = scale {
        text += &format!("map       {}, {} from {} to {}\n", scale.label, scale.map.name(), scale.low, scale.high);
    }
    text
}

fn report(args: &CompareArgs, a: &Radiances, found: &Comparison, scale: Option<ColourScale>) -> String {
    let e = &found.errors;
    let mut report = json!({
        "a": args.film.to_string_lossy(), "reference": args.reference.to_string_lossy(),
        "width": a.width, "height": a.height,
        "rmse": e.rmse, "relmse": e.rel_mse, "mae": e.mae, "bias": e.bias, "relative_bias": e.relative_bias,
        "flip": found.flip, "hdr_flip": found.hdr_flip,
        "nonfinite": e.nonfinite,
    });
    if let Some(scale) = scale {
        report["map"] = json!({
            "label": scale.label, "colours": scale.map.name(), "low": scale.low, "high": scale.high,
        });
    }
    format!("{report}\n")
}
