//! `visavis check`: every hard case, as a table or as JSON.

use super::CheckArgs;
use anyhow::Context;
use check::{CASES, Case, Effort, Machine, Row, Runner, Verdict};
use gpu::Gpu;
use serde_json::{Value, json};
use std::sync::atomic::AtomicBool;
use std::time::Instant;
use technique::Device;

pub fn run(args: &CheckArgs) -> anyhow::Result<()> {
    let chosen = |case: &&Case| args.cases.is_empty() || args.cases.contains(&case.number);
    let cases: Vec<Case> = CASES.iter().filter(chosen).copied().collect();
    if args.list {
        return super::print(&cases.iter().map(listed).collect::<String>());
    }
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let start = Instant::now();
    let mut printed = Ok(());
    let (mut run, mut place, never) = (0, String::new(), AtomicBool::new(false));
    let tell = |case: &Case, rows: &[Row]| {
        run += 1;
        if !args.json {
            printed = super::print(&table(case, rows));
        }
        printed.is_ok()
    };
    let gpu = if args.on_gpu {
        let gpu = Gpu::headless().context("--device gpu needs a graphics device")?;
        place = gpu.describe();
        Some(gpu)
    } else {
        None
    };
    let machine = gpu.as_ref().map_or(Machine::Processor, Machine::Device);
    let runner = Runner { spoilt: args.spoilt, ..Runner::new(machine, effort, &never) };
    let rows = runner.run(&cases, tell)?;
    printed?;
    anyhow::ensure!(run > 0, "no graphics device renders these cases: --device cpu runs them");
    let seconds = start.elapsed().as_secs_f64();
    let count = |verdict| rows.iter().filter(|row| row.verdict == verdict).count();
    let (passed, failed) = (count(Verdict::Pass), count(Verdict::Fail));
    if args.json {
        let rows: Vec<Value> = rows.iter().map(to_json).collect();
        let report = json!({
            "effort": if args.quick { "quick" } else { "full" },
            "adapter": if args.on_gpu { json!(place) } else { Value::Null },
            "seconds": seconds,
            "passed": passed,
            "failed": failed,
            "rows": rows,
        });
        super::print(&format!("{report}\n"))?;
    } else {
        let place = if args.on_gpu { format!(" on {place}") } else { place };
        super::print(&format!("{run} cases{place}, {passed} rows passed, {failed} failed, {seconds:.0} s\n"))?;
    }
    let numbers = failed_cases(&rows);
    let effort = if args.quick { " --quick" } else { "" };
    let device = if args.on_gpu { " --device gpu" } else { "" };
    anyhow::ensure!(
        failed == 0,
        "the check failed in {numbers}: see its rows; visavis check{effort}{device} --case {numbers} runs them alone"
    );
    Ok(())
}

/// How many rows of the hard cases pass on a device, coarsely, and those that fail.
///
/// # Errors
/// If the device fails.
pub fn in_short(gpu: &Gpu) -> anyhow::Result<String> {
    let rows = Runner::new(Machine::Device(gpu), Effort::Quick, &AtomicBool::new(false)).run(CASES, |_, _| true)?;
    let of = |verdict| rows.iter().filter(move |row| row.verdict == verdict);
    let mut text = format!("{} rows pass, {} fail\n", of(Verdict::Pass).count(), of(Verdict::Fail).count());
    of(Verdict::Fail).for_each(|row| text += &format!("  {}. {row}\n", row.case));
    Ok(text)
}

fn failed_cases(rows: &[Row]) -> String {
    let mut numbers: Vec<u32> = rows.iter().filter(|r| r.verdict == Verdict::Fail).map(|r| r.case).collect();
    numbers.dedup();
    numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(",")
}

/// A case with its claim, and where it runs.
fn listed(case: &Case) -> String {
    let machines = if case.runs_on(Device::Gpu) { "processor and device" } else { "processor" };
    let Case { number, title, claim, .. } = case;
    format!("{number:>2}. {title} ({machines})\n    {claim}\n")
}

/// A case with its rows.
fn table(case: &Case, rows: &[Row]) -> String {
    let mut text = format!("{}. {} (catches {})\n", case.number, case.title, case.catches);
    rows.iter().for_each(|row| text += &format!("  {row}\n"));
    text
}

fn to_json(row: &Row) -> Value {
    let title = CASES.iter().find(|case| case.number == row.case).map(|case| case.title);
    json!({
        "case": row.case,
        "title": title,
        "device": row.device.name(),
        "subject": row.subject,
        "quantity": row.quantity,
        "expected": row.expected,
        "measured": row.measured,
        "relation": row.relation.name(),
        "tolerance": row.tolerance,
        "relative_standard_error": row.power.map(|(reached, _)| reached),
        "wanted_relative_standard_error": row.power.map(|(_, wanted)| wanted),
        "verdict": row.verdict.name(),
    })
}
