//! The hard cases from the command line: what they claim, and that they can be seen to fail.

use crate::{json, visavis};

#[test]
fn the_list_says_what_each_case_claims_and_where_it_runs() {
    let output = visavis(&["check", "--list"]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success());
    assert_eq!(text.lines().filter(|line| line.contains(" (processor")).count(), 31, "{text}");
    assert!(
        text.contains(" 4. Rectangle light, Lambert's polygon formula (processor and device)\n    The floor under ")
    );
    assert!(text.contains("22. Samplers (processor)\n"), "{text}");
    let one = visavis(&["check", "--list", "--case", "7"]);
    assert_eq!(String::from_utf8_lossy(&one.stdout).lines().count(), 2);
}

#[test]
fn a_check_with_wrong_expectations_fails_in_numbers_and_in_its_exit_code() {
    let output = visavis(&["check", "--quick", "--case", "15", "--spoil", "--json"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("the check failed in 15"));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("a report");
    let row = &report["rows"][0];
    assert!(report["failed"] == 3 && row["verdict"] == "fail" && row["expected"] == 1.05, "{report}");
    let honest = json(&visavis(&["check", "--quick", "--case", "15", "--json"]));
    assert_eq!((&honest["failed"], &honest["rows"][0]["measured"]), (&0.into(), &row["measured"]));
}

#[test]
fn the_check_prints_a_table_or_rows_of_json() {
    let table = visavis(&["check", "--quick", "--case", "10,23"]);
    assert!(table.status.success());
    let text = String::from_utf8_lossy(&table.stdout);
    assert!(text.contains("10. Fresnel table") && text.contains("23. A million samples"), "{text}");
    assert!(text.contains(" pass") && text.contains("0 failed"), "{text}");
    let report = json(&visavis(&["check", "--quick", "--case", "15", "--device", "gpu", "--json"]));
    assert_eq!((&report["rows"][0]["device"], &report["failed"]), (&"gpu".into(), &0.into()));
    let report = json(&visavis(&["check", "--quick", "--case", "10", "--json"]));
    let rows = report["rows"].as_array().expect("rows");
    assert!(rows.len() > 10 && rows.iter().all(|row| row["case"] == 10 && row["verdict"] == "pass"));
    assert_eq!(report["failed"], 0);
}
