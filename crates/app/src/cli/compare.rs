//! `visavis compare`: how far one picture is from another.

use crate::picture_file;
use compare::errors;
use serde_json::json;
use std::path::Path;

pub fn run(film: &Path, reference: &Path, json: bool) -> anyhow::Result<()> {
    let (a, b) = (picture_file::load(film)?, picture_file::load(reference)?);
    for (path, film) in [(film, &a), (reference, &b)] {
        if film.nonfinite > 0 {
            note!("note: {} pixels are not finite and count as black: {}", film.nonfinite, path.display());
        }
    }
    let e = errors(&a, &b)?;
    let text = if json {
        let report = json!({
            "a": film.to_string_lossy(), "reference": reference.to_string_lossy(),
            "width": a.width(), "height": a.height(),
            "rmse": e.rmse, "relmse": e.rel_mse, "mae": e.mae, "bias": e.bias, "relative_bias": e.relative_bias,
            "nonfinite": a.nonfinite + b.nonfinite,
        });
        format!("{report}\n")
    } else {
        format!(
            "RMSE    {:.6}\nrelMSE  {:.6}\nMAE     {:.6}\nbias    {:+.6} (A - B, {:+.3} %)\n",
            e.rmse,
            e.rel_mse,
            e.mae,
            e.bias,
            100.0 * e.relative_bias
        )
    };
    super::print(&text)
}
