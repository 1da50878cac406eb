//! The page on the graphics device, on whatever device there is.

use super::{assert_refused, visavis};
use visavis_tests::TestFolder;

#[test]
fn the_page_has_a_section_for_each_part_with_figures_and_is_written_too() {
    let folder = TestFolder::new();
    let out = folder.file("page.txt").display().to_string();
    let words = ["device-report", "--size", "64x36", "--parts", "adapters,rates,frames,agreement,loss", "-o", &out];
    let output = visavis(&words);
    let page = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success() && !page.contains("\nfailed: "), "{page}");
    for title in ["adapters", "rates", "frames", "agreement", "loss"] {
        assert!(page.contains(&format!("\n== {title} (")), "{title}: {page}");
    }
    let figures = |line: &str| {
        let line = page.lines().find(|found| found.starts_with(line)).unwrap_or_else(|| panic!("no {line}: {page}"));
        line.split_whitespace().filter_map(|word| word.trim_end_matches('%').parse::<f64>().ok()).collect::<Vec<_>>()
    };
    assert!(["cornell ", "whitted ", "statue "].iter().all(|scene| figures(scene).iter().all(|f| f.is_finite())));
    // paths and rays of the device and of the processor, and what a ray may cost
    assert!(figures("statue ").len() >= 6 && figures("statue ").iter().take(4).all(|rate| *rate > 0.0), "{page}");
    assert_eq!(figures("the fake repaired").len(), 5, "{page}");
    // the picture of a lost device is the processor's
    assert!(page.contains("the picture is there"), "{page}");
    assert_eq!(std::fs::read_to_string(&out).expect("the page"), page);
}

#[test]
fn the_two_machines_means_agree_on_the_page() {
    let output = visavis(&["device-report", "--parts", "agreement"]);
    let page = String::from_utf8(output.stdout).expect("text");
    let rows = page.lines().filter(|line| ["cornell", "whitted", "phong"].iter().any(|scene| line.starts_with(scene)));
    let differences = rows.map(|row| row.split_whitespace().nth(3).and_then(|d| d.parse::<f64>().ok()));
    let differences: Vec<f64> = differences.map(|d| d.expect("a figure")).collect();
    // 262,144 paths, few of which part at a rounded comparison
    assert!(differences.len() == 3 && differences.iter().all(|d| d.abs() < 1e-3), "{page}");
}

#[test]
fn no_part_begins_when_the_time_is_up_and_what_is_wrong_is_said() {
    let output = visavis(&["device-report", "--parts", "rates", "--seconds", "0"]);
    let page = String::from_utf8(output.stdout).expect("text");
    assert!(output.status.success() && page.contains("left out: the time is up"), "{page}");
    let parts = "--parts speed: expected names of adapters, rates, frames, agreement, loss, checks";
    assert_refused(&["device-report", "--parts", "speed"], 2, &[parts]);
    assert_refused(&["device-report", "--seconds", "soon"], 2, &["--seconds soon: expected a whole number"]);
    assert_refused(&["device-report", "-o", "/no/such/page.txt"], 1, &["/no/such/page.txt"]);
}
