//! Rays on a graphics device without a window, and the processor that takes over.

use super::{json, program, visavis};
use visavis_tests::TestFolder;

fn render(folder: &TestFolder, fails_after: Option<&str>, options: &[&str]) -> std::process::Output {
    let out = folder.file("out.exr");
    let mut command = program();
    command.args(["render", "cornell", "--size", "96x96", "--json", "-o", out.to_str().expect("a plain path")]);
    command.args(options);
    command.envs(fails_after.map(|dispatches| ("VISAVIS_GPU_FAILS_AFTER", dispatches)));
    command.output().expect("the program")
}

/// The device is destroyed at once, in the middle, and before the last reading: the picture is the processor's, whole, and
/// a line says so.
#[test]
fn the_processor_takes_over_where_the_device_fails() {
    let folder = TestFolder::new();
    for dispatches in ["0", "3"] {
        let output = render(&folder, Some(dispatches), &["--device", "gpu", "--spp", "32"]);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(told.contains("the processor goes on from 0 spp, the graphics device failed: "), "{told}");
        let report = json(&output);
        assert_eq!((&report["device"], &report["spp"]), (&"cpu".into(), &32.into()), "{dispatches}");
        let mean = report["mean"][0].as_f64().expect("a number");
        assert!((mean - 0.2517).abs() < 0.02, "{mean}");
        let out = folder.file("out.exr");
        let records = picture_file::records(&out).expect("records");
        assert!(records.iter().any(|(name, value)| name == "device" && value == "cpu"), "{records:?}");
    }
}

#[test]
fn auto_is_the_processor_where_it_plays_the_device_and_where_there_is_little_to_do() {
    let folder = TestFolder::new();
    // 2^24 samples are more than little
    for options in [&["--spp", "1"][..], &["--spp", "1830"], &["--spp", "1", "--lanes", "array"]] {
        let report = json(&render(&folder, None, options));
        assert_eq!(report["device"], "cpu", "{options:?}");
    }
}

#[test]
fn info_says_what_traces_rays() {
    let output = visavis(&["info"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.starts_with("truth (path) and whitted, --device auto: the cpu; cpu: "), "{text}");
    assert!(text.contains("used for the fake, the first in order"), "{text}");
}
