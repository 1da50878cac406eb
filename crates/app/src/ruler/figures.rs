//! Errors in words, and as what files keep.

use compare::{Errors, REL_MSE_FLOOR};
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

/// So many of what is called `one`: "1 picture", "4 pictures".
pub fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// How far off a picture is and how much too bright or too dark, in words for people: "12 % off on average", "0.3 % too
/// bright overall". Where `judge` names another picture, which need not be right itself, they are differences: "differs
/// from B by 12 % on average", "0.3 % brighter overall".
pub fn error_words(errors: &Errors, judge: Option<&str>) -> [String; 2] {
    if errors.relative_mae.is_nan() {
        return ["held against black".into(), "of which nothing is a share".into()];
    }
    let off = percent(errors.relative_mae);
    let off = match judge {
        Some(judge) => format!("differs from {judge} by {off} % on average"),
        None => format!("{off} % off on average"),
    };
    let [darker, brighter, same] = match judge {
        Some(_) => ["darker", "brighter", "as bright"],
        None => ["too dark", "too bright", "right in brightness"],
    };
    let share = errors.relative_bias;
    let brightness = match percent(share.abs()).as_str() {
        "0" => format!("{same} overall"),
        figure => format!("{figure} % {} overall", if share < 0.0 { darker } else { brighter }),
    };
    [off, brightness]
}

/// Denoised pictures of which the mean difference is told as a bias: the mean of fewer is noise as much.
pub const FEWEST_RUNS_OF_A_BIAS: u32 = 4;

/// The mean difference of what is the mean of several denoised pictures, whose noise is mostly gone: "bias -2.1 % (mean of 8 denoised runs)".
pub fn bias_words(errors: &Errors, runs: u32) -> String {
    let share = errors.relative_bias;
    let sign = if share < 0.0 { "-" } else { "+" };
    format!("bias {sign}{} % (mean of {runs} denoised runs)", percent(share.abs()))
}

/// A share in percent, with two figures and no more decimals than are worth reading; "0" below a hundredth of a percent.
fn percent(share: f64) -> String {
    match 100.0 * share {
        v if v >= 9.95 => format!("{v:.0}"),
        v if v >= 0.095 => format!("{v:.1}"),
        v if v >= 0.005 => format!("{v:.2}"),
        v if v.is_nan() => "?".into(),
        _ => "0".into(),
    }
}

/// What each figure is, a line each, with its value; A is the picture and `judge` what it is held against.
pub fn formulas(errors: &Errors, picture: &str, judge: &str) -> [String; 4] {
    let (a, b) = (picture, judge);
    [
        format!("On average: mean of |{a} - {b}| / mean of {b} = {:.4}", errors.relative_mae),
        format!(
            "Overall: (mean of {a} - mean of {b}) / mean of {b} = {:+.4}, the mean difference; noise averages out of it",
            errors.relative_bias
        ),
        format!("relMSE {}: mean of ({a} - {b})² / ({b}² + {REL_MSE_FLOOR})", brief(errors.rel_mse)),
        format!("RMSE {}: root of the mean of ({a} - {b})²", brief(errors.rmse)),
    ]
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

    fn words(relative_mae: f64, relative_bias: f64, judge: Option<&str>) -> [String; 2] {
        error_words(&Errors { relative_mae, relative_bias, ..Errors::default() }, judge)
    }

    #[test]
    fn errors_are_told_against_what_is_right_and_differences_from_what_need_not_be() {
        assert_eq!(words(0.1234, 0.0031, None), ["12 % off on average", "0.3 % too bright overall"]);
        assert_eq!(words(0.0123, -0.371, None), ["1.2 % off on average", "37 % too dark overall"]);
        assert_eq!(words(0.0, -0.000_02, None), ["0 % off on average", "right in brightness overall"]);
        assert_eq!(words(0.5, 0.02, Some("B")), ["differs from B by 50 % on average", "2.0 % brighter overall"]);
        assert_eq!(words(2.0, -0.02, Some("B")), ["differs from B by 200 % on average", "2.0 % darker overall"]);
        assert_eq!(words(0.0, 0.0, Some("A")), ["differs from A by 0 % on average", "as bright overall"]);
    }

    #[test]
    fn what_is_left_of_several_runs_is_told_as_a_bias_with_its_sign() {
        let of = |relative_bias| bias_words(&Errors { relative_bias, ..Errors::default() }, 8);
        assert_eq!(of(-0.0213), "bias -2.1 % (mean of 8 denoised runs)");
        assert_eq!(of(0.121), "bias +12 % (mean of 8 denoised runs)");
    }

    #[test]
    fn each_formula_names_both_sides_and_the_value_that_it_has() {
        let errors = Errors { rmse: 2.0, rel_mse: 0.5, relative_mae: 0.25, relative_bias: -0.125, ..Errors::default() };
        let lines = formulas(&errors, "A", "reference");
        assert!(lines[0].contains("mean of |A - reference| / mean of reference = 0.2500"), "{lines:?}");
        assert!(lines[1].contains("= -0.1250, the mean difference"), "{lines:?}");
        assert_eq!(lines[2], "relMSE 0.500: mean of (A - reference)² / (reference² + 0.01)");
        assert_eq!(lines[3], "RMSE 2.000: root of the mean of (A - reference)²");
    }

    #[test]
    fn figures_are_short_and_never_all_zeros() {
        let words = [0.0, 12.3456, 0.1234, 0.0123, 0.00123, 0.000123, -0.5].map(brief);
        assert_eq!(words, ["0", "12.346", "0.123", "0.012", "0.0012", "1.2e-4", "-0.500"]);
    }
}
