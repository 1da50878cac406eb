//! The bench's table, as CSV.

use crate::Errors;

/// One measurement: a scene rendered one way, what it cost and how far off it is.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchRow {
    /// Name of the scene.
    pub scene: String,
    /// Name of the technique with its estimator.
    pub technique: String,
    /// Samples per pixel; 0 where a technique does not sample.
    pub spp: u32,
    /// Wall-clock seconds that the samples took.
    pub seconds: f64,
    /// Against the scene's reference.
    pub errors: Errors,
    /// The relMSE that the reference's own noise adds, estimated: figures near it say nothing.
    pub reference_rel_mse: f64,
}

/// A header and a line for each row.
pub fn csv(rows: &[BenchRow]) -> String {
    let mut text = String::from("scene,technique,spp,seconds,rmse,relmse,mae,bias,relative_bias,reference_relmse\n");
    for row in rows {
        let e = row.errors;
        text += &format!(
            "{},{},{},{:.6},{:.6e},{:.6e},{:.6e},{:.6e},{:.6e},{:.3e}\n",
            row.scene,
            row.technique,
            row.spp,
            row.seconds,
            e.rmse,
            e.rel_mse,
            e.mae,
            e.bias,
            e.relative_bias,
            row.reference_rel_mse
        );
    }
    text
}
