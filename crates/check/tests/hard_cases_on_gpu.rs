//! The hard cases that a graphics device renders, in quick mode, on the best device there is: leaks and offsets, and of the
//! rest one of each kind; the others take the command line.

use check::{CASES, Effort, Verdict, run_on_gpu};
use gpu::Gpu;
use std::sync::atomic::AtomicBool;

fn passes(numbers: &[u32]) {
    let all = std::env::var_os("VISAVIS_CHECK_FULL").is_some();
    let cases: Vec<_> = CASES.iter().filter(|case| all || numbers.contains(&case.number)).copied().collect();
    let rows = match Gpu::headless() {
        Ok(gpu) => run_on_gpu(&gpu, &cases, Effort::Quick, &AtomicBool::new(false), |_, _| true),
        Err(none) => panic!("{none}"),
    };
    let rows = rows.unwrap_or_else(|fault| panic!("{fault}"));
    rows.iter().for_each(|row| println!("{row}"));
    let failed: Vec<String> = rows.iter().filter(|row| row.verdict == Verdict::Fail).map(ToString::to_string).collect();
    assert!(rows.len() > numbers.len() && failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn no_ray_leaks_and_no_surface_shadows_itself() {
    passes(&[16, 17, 18]);
}

#[test]
fn energy_is_kept_by_glass_mirrors_and_diffuse_walls() {
    passes(&[2, 11, 14]);
}
