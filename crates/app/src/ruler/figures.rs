//! Errors in words, and as what files keep.

use compare::Errors;
use image_file::Records;

/// An error for people: three decimals, more where they would be all zeros.
pub fn brief(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if v >= 0.00995 => format!("{value:.3}"),
        v if v >= 0.000995 => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// The reference's own noise as a line, and whether the errors drown in it; `None` where it is not known.
pub fn noise_line(errors: &Errors) -> Option<String> {
    let noise = errors.reference_noise?;
    let drowned = if errors.below_reference_noise() { "; the errors are below the reference's noise" } else { "" };
    Some(format!("{:.6} (RMSE of the reference itself{drowned})", noise.sqrt()))
}

/// What a picture's file keeps of its errors. Their names begin with "error.", so that none is taken for an option that
/// makes the picture again. `against` names what it was compared with.
pub fn error_records(errors: &Errors, against: String) -> Records {
    let mut records = vec![
        ("error.against", against),
        ("error.relmse", errors.rel_mse.to_string()),
        ("error.rmse", errors.rmse.to_string()),
        ("error.mae", errors.mae.to_string()),
        ("error.bias", errors.bias.to_string()),
    ];
    records.extend(errors.reference_noise.map(|noise| ("error.reference_noise", noise.to_string())));
    records
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short_and_never_all_zeros() {
        let words = [0.0, 12.3456, 0.1234, 0.0123, 0.00123, 0.000123, -0.5].map(brief);
        assert_eq!(words, ["0", "12.346", "0.123", "0.012", "0.0012", "1.2e-4", "-0.500"]);
    }
}
