//! What `render --json` prints.

use super::{Measured, spp_of_run};
use crate::cli::RenderArgs;
use scene::Scene;
use serde_json::json;
use technique::settings::Value;
use technique::{Denoised, Rendered, Technique};

/// One object about a picture and what it took.
pub fn report(
    args: &RenderArgs,
    scene: &Scene,
    (rendered, seconds): (&Rendered, f64),
    measured: Option<&Measured>,
) -> serde_json::Value {
    let technique = args.pane.technique;
    let per_second = |count: u64| count as f64 / seconds;
    let mut report = json!({
        "scene": scene.name,
        "technique": technique.name(),
        "device": rendered.device.name(),
        "adapter": rendered.made_by,
        "width": args.seen.size.0,
        "height": args.seen.size.1,
        "spp": spp_of_run(rendered),
        "runs": rendered.runs,
        "seconds": seconds,
        "samples_per_second": per_second(rendered.stats.samples),
        "rays_per_second": per_second(rendered.stats.rays),
        "mean": rendered.film.mean(),
        "nonfinite": rendered.film.nonfinite,
    });
    match args.pane.in_use() {
        Technique::Fake(fake) => report["fake"] = json!(fake.fake.name()),
        Technique::Traced(rays) => {
            let made = args.pane.in_use().with_runs(rendered.runs);
            for (name, value) in made.values(spp_of_run(rendered)).into_iter().skip(1) {
                report[name.replace('-', "_")] = match value {
                    Value::Whole(number) => json!(number),
                    other => json!(other.to_string()),
                };
            }
            report["samples"] = json!(rendered.stats.samples);
            report["rays"] = json!(rendered.stats.rays);
            report["cut_paths"] = json!(rendered.stats.cut_paths);
            if rendered.stats.photons > 0 {
                report["cut_photons"] = json!(rendered.stats.cut_photons);
            }
            report["standard_error"] = json!(rendered.film.standard_error());
            let shows_light = args.pane.in_use().shows_the_scene();
            let is_a_mean = shows_light && !rays.denoise.is_on();
            let reliable = is_a_mean && rays.integrator.is_independent() && rendered.film.standard_error_is_reliable();
            report["standard_error_reliable"] = json!(reliable);
            if let Some(scale) = rendered.stats.chains.scale() {
                report["mutations"] = json!(rendered.stats.chains.mutations);
                report["acceptance"] = json!(rendered.stats.chains.acceptance());
                report["start_up_scale"] = json!(scale);
            }
        }
    }
    if let Some(Ok(Denoised { seconds, made_by, .. })) = &rendered.denoised {
        let before = measured.and_then(|measured| measured.before).map(|e| e.rel_mse);
        report["denoised"] = json!({
            "by": args.pane.in_use().denoise().denoiser.name(), "adapter": made_by, "seconds": seconds,
            "relmse_before": before,
        });
    }
    if let Some(Measured { errors: e, .. }) = measured {
        report["errors"] = json!({
            "against": "reference", "rmse": e.rmse, "relmse": e.rel_mse, "mae": e.mae, "bias": e.bias,
            "relative_mae": e.relative_mae, "relative_bias": e.relative_bias, "reference_noise": e.reference_noise,
            "below_reference_noise": e.below_reference_noise(),
        });
    }
    report
}
