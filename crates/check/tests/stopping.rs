//! A run of the check can be stopped, by the caller between cases and by a flag within one; and it can be seen to fail.

use check::{CASES, Case, Effort, Machine, Row, Runner, Verdict};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

fn cases(numbers: &[u32]) -> Vec<Case> {
    CASES.iter().filter(|case| numbers.contains(&case.number)).copied().collect()
}

#[test]
fn a_caller_that_has_seen_enough_gets_no_more() {
    let mut seen = Vec::new();
    let stop = AtomicBool::new(false);
    let rows = Runner::new(Machine::Processor, Effort::Quick, &stop).run(&cases(&[10, 13, 24]), |case, rows| {
        assert!(rows.iter().all(|row| row.case == case.number));
        seen.push(case.number);
        seen.len() < 2
    });
    let rows = rows.expect("no device to fail");
    assert_eq!(seen, [10, 13]);
    assert!(rows.iter().any(|row| row.case == 13) && rows.iter().all(|row| row.case != 24));
}

#[test]
fn a_stopped_case_leaves_no_rows() {
    let rows = Runner::new(Machine::Processor, Effort::Full, &AtomicBool::new(true)).run(CASES, |_, _| true);
    assert!(rows.expect("no device to fail").is_empty());
}

#[test]
fn each_row_is_told_as_soon_as_it_is_measured() {
    let (told, never) = (Mutex::new(Vec::<Row>::new()), AtomicBool::new(false));
    let tell = |row: &Row| told.lock().expect("rows").push(row.clone());
    let runner = Runner { on_row: &tell, ..Runner::new(Machine::Processor, Effort::Quick, &never) };
    let rows = runner.run_one(&cases(&[13])[0]).expect("no device to fail").expect("rows");
    assert!(rows.len() > 8);
    assert_eq!(*told.lock().expect("rows"), rows);
}

/// With expectations that are wrong on purpose: glass, means of pictures and formulas fail, and say by how much.
#[test]
fn a_spoilt_run_is_seen_to_fail() {
    let never = AtomicBool::new(false);
    let honest = Runner::new(Machine::Processor, Effort::Quick, &never);
    let spoilt = Runner { spoilt: true, ..honest };
    for case in cases(&[9, 15, 24]) {
        let rows = |runner: &Runner| runner.run_one(&case).expect("no device to fail").expect("rows");
        let failed = |rows: &[Row]| rows.iter().filter(|row| row.verdict == Verdict::Fail).count();
        let (honest, spoilt) = (rows(&honest), rows(&spoilt));
        assert_eq!(failed(&honest), 0, "{}", case.title);
        assert!(failed(&spoilt) >= 3, "{}: {spoilt:#?}", case.title);
        let measured = |rows: &[Row]| rows.iter().map(|row| row.measured).collect::<Vec<_>>();
        assert_eq!(measured(&honest), measured(&spoilt), "what is measured is the same: {}", case.title);
    }
}
