//! A run of the check can be stopped, by the caller between cases and by a flag within one.

use check::{CASES, Effort};
use std::sync::atomic::AtomicBool;

#[test]
fn a_caller_that_has_seen_enough_gets_no_more() {
    let mut seen = Vec::new();
    let stop = AtomicBool::new(false);
    let formulas: Vec<_> = CASES.iter().filter(|case| [10, 13, 24].contains(&case.number)).copied().collect();
    let rows = check::run(&formulas, Effort::Quick, &stop, |case, rows| {
        assert!(rows.iter().all(|row| row.case == case.number));
        seen.push(case.number);
        seen.len() < 2
    });
    assert_eq!(seen, [10, 13]);
    assert!(rows.iter().any(|row| row.case == 13) && rows.iter().all(|row| row.case != 24));
}

#[test]
fn a_stopped_case_leaves_no_rows() {
    let rows = check::run(CASES, Effort::Full, &AtomicBool::new(true), |_, _| true);
    assert!(rows.is_empty());
}
