//! Cases beside the UI: told row by row, seen to fail, ended by a newer wish.

use super::*;
use crate::model::{CaseMark, CasesView};
use check::{Effort, Verdict};
use std::time::Duration;
use technique::Adapter;

fn bench(adapters: Adapters) -> CaseBench {
    CaseBench::start(CASES, adapters, Arc::new(|| ())).expect("a thread")
}

fn wish(number: u64, cases: &[u32]) -> WantedCases {
    let machine = CaseMachine::Processor;
    WantedCases { number, cases: cases.into(), machine, effort: Effort::Quick, spoilt: false }
}

/// Collects until `done` says so, and returns what the user was told.
fn collect(bench: &CaseBench, view: &mut CasesView, done: impl Fn(&CasesView) -> bool) -> Option<String> {
    let (start, mut fault) = (Instant::now(), None);
    while !done(view) {
        if let Some(news) = bench.collect() {
            view.results.extend(news.results);
            fault = news.fault.or(fault);
        }
        assert!(start.elapsed() < Duration::from_secs(120), "{view:?}");
        std::thread::sleep(Duration::from_millis(2));
    }
    fault
}

fn case(number: u32) -> &'static Case {
    &CASES[number as usize - 1]
}

#[test]
fn a_run_is_told_and_the_same_with_wrong_expectations_fails_in_numbers() {
    let (mut bench, mut view) = (bench(Adapters::default()), CasesView::default());
    let is = |mark: CaseMark| {
        move |view: &CasesView| [13, 15].iter().all(|n| view.mark(CaseMachine::Processor, case(*n)) == mark)
    };
    bench.follow(Some(&wish(1, &[15, 13])));
    assert_eq!(collect(&bench, &mut view, is(CaseMark::Passes)), None);
    let result = view.result(CaseMachine::Processor, case(15)).expect("a result").clone();
    assert!(result.rows.len() == 4 && result.by == "the processor" && result.course == CaseCourse::Done);
    // followed before: nothing is measured again
    bench.follow(Some(&wish(1, &[15, 13])));
    let spoilt = WantedCases { spoilt: true, ..wish(2, &[15, 13]) };
    bench.follow(Some(&spoilt));
    collect(&bench, &mut view, |view| {
        let done = |n: &u32| view.results[&(CaseMachine::Processor, *n)].course == CaseCourse::Done;
        is(CaseMark::Fails)(view) && [13, 15].iter().all(done)
    });
    let result = view.result(CaseMachine::Processor, case(15)).expect("a result");
    let failed: Vec<_> = result.rows.iter().filter(|row| row.verdict == Verdict::Fail).collect();
    assert!(failed.len() == 3 && result.spoilt, "{failed:?}");
    assert!((failed[0].expected - 1.05).abs() < 1e-9 && (failed[0].measured - 1.0).abs() < 1e-5, "{failed:?}");
}

#[test]
fn a_newer_wish_ends_the_case_in_hand_and_so_does_leaving() {
    let (mut bench, mut view) = (bench(Adapters::default()), CasesView::default());
    let course = |number: u32, course: CaseCourse| {
        move |view: &CasesView| view.results.get(&(CaseMachine::Processor, number)).is_some_and(|r| r.course == course)
    };
    // minutes of work
    let long = WantedCases { effort: Effort::Full, ..wish(1, &[17]) };
    bench.follow(Some(&long));
    collect(&bench, &mut view, course(17, CaseCourse::Running));
    bench.follow(Some(&wish(2, &[13])));
    collect(&bench, &mut view, course(13, CaseCourse::Done));
    assert!(course(17, CaseCourse::Stopped)(&view));
    assert_eq!(view.mark(CaseMachine::Processor, case(17)), CaseMark::NotRun);
    bench.follow(Some(&WantedCases { number: 3, ..long }));
    collect(&bench, &mut view, course(17, CaseCourse::Running));
    bench.follow(None);
    collect(&bench, &mut view, course(17, CaseCourse::Stopped));
}

#[test]
fn a_device_that_is_not_there_is_one_line_and_the_bench_goes_on() {
    let adapter = Adapter { name: "no such adapter".into(), software: true };
    let (mut bench, mut view) = (bench(Adapters(vec![adapter])), CasesView::default());
    let machine = CaseMachine::Adapter(0);
    bench.follow(Some(&WantedCases { machine, ..wish(1, &[14, 15, 22]) }));
    let line = collect(&bench, &mut view, |view| view.mark(machine, case(14)) == CaseMark::Fails).expect("a line");
    assert!(line.starts_with("Case 14: ") && line.contains("by the processor") && !line.contains('\n'), "{line}");
    assert_eq!(view.mark(machine, case(22)), CaseMark::NotHere, "random numbers are the processor's");
    bench.follow(Some(&wish(2, &[13])));
    let done = |view: &CasesView| view.mark(CaseMachine::Processor, case(13)) == CaseMark::Passes;
    collect(&bench, &mut view, done);
    assert_eq!(view.results.len(), 2, "the run ended at its first case");
}

#[test]
fn a_device_that_is_lost_is_one_line_and_is_opened_anew() {
    let gpu = Gpu::headless().expect("a device");
    let adapters = Adapters(vec![Adapter { name: gpu.describe(), software: true }]);
    let (held, known) = (Some((0, gpu.clone())), adapters.clone());
    let service = move || Examiner { cases: CASES, adapters: known, threads: None, device: held, in_hand: None };
    let worker = Worker::start("hard cases", Arc::new(|| ()), service).expect("a thread");
    let (mut bench, mut view) = (CaseBench { worker, followed: 0, stop: Arc::default() }, CasesView::default());
    gpu.device.destroy();
    let (machine, case) = (CaseMachine::Adapter(0), case(15));
    bench.follow(Some(&WantedCases { machine, ..wish(1, &[15]) }));
    let line = collect(&bench, &mut view, |view| view.mark(machine, case) == CaseMark::Fails).expect("a line");
    assert!(line.starts_with("Case 15: ") && !line.contains('\n'), "{line}");
    let result = view.result(machine, case).expect("a result");
    assert!(matches!(&result.course, CaseCourse::Failed(why) if line.contains(why)), "{result:?}");
    bench.follow(Some(&WantedCases { machine, ..wish(2, &[15]) }));
    assert_eq!(collect(&bench, &mut view, |view| view.mark(machine, case) == CaseMark::Passes), None);
}
