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

/// The device is destroyed at once, and before anything was read: the picture is the processor's, whole, and a line
/// says so.
#[test]
fn the_processor_takes_over_where_the_device_fails() {
    let folder = TestFolder::new();
    for dispatches in ["0", "1"] {
        let output = render(&folder, Some(dispatches), &["--device", "gpu", "--spp", "32"]);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(told.contains("the processor goes on from 0 spp, the graphics device failed: "), "{told}");
        let report = json(&output);
        assert_eq!((&report["device"], &report["spp"]), (&"cpu".into(), &32.into()), "{dispatches}");
        let mean = report["mean"][0].as_f64().expect("a number");
        assert!((mean - 0.2517).abs() < 0.02, "{mean}");
        let out = folder.file("out.exr");
        let records = image_file::records(&out).expect("records");
        assert!(records.iter().any(|(name, value)| name == "device" && value == "cpu"), "{records:?}");
    }
}

/// The device is destroyed after its film was read: the processor goes on from there.
#[test]
fn the_processor_goes_on_from_the_film_that_was_read_last() {
    let folder = TestFolder::new();
    let output = render(&folder, Some("12"), &["--device", "gpu", "--spp", "1000", "--sampler", "independent"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let spp: u32 = told
        .split_once("the processor goes on from ")
        .and_then(|(_, rest)| rest.split_once(" spp"))
        .map(|(spp, _)| spp.parse().expect("a number"))
        .expect("a takeover");
    assert!(spp > 0 && spp < 1000, "{told}");
    let report = json(&output);
    assert_eq!((&report["device"], &report["spp"]), (&"cpu".into(), &1000.into()));
    assert!(report["adapter"].as_str().is_some_and(|adapter| adapter.contains(", then ")), "{}", report["adapter"]);
    assert_eq!(report["samples"], 1000 * 96 * 96);
    let (mean, error) = (report["mean"][0].as_f64().expect("a mean"), report["standard_error"][0].as_f64());
    let error = error.expect("its standard error");
    assert!((mean - 0.25169).abs() < 5.0 * error && error < 2e-3, "{mean} +- {error}");
}

#[test]
fn auto_is_the_processor_where_there_is_little_to_do_and_where_lanes_are_asked_for() {
    let folder = TestFolder::new();
    for options in [&["--spp", "1"][..], &["--spp", "1", "--lanes", "array"]] {
        let report = json(&render(&folder, None, options));
        assert_eq!(report["device"], "cpu", "{options:?}");
    }
}

#[test]
fn info_says_what_traces_rays() {
    let output = visavis(&["info"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.starts_with("path tracing and whitted, --device auto: the cpu; cpu: "), "{text}");
    assert!(text.contains("used for the fake, the first in order"), "{text}");
}

/// However little time there is, every pixel gets a sample.
#[test]
fn a_moment_is_enough_for_one_sample_on_either_machine() {
    let folder = TestFolder::new();
    for device in ["cpu", "gpu"] {
        let report = json(&render(&folder, None, &["--device", device, "--time", "0.0001"]));
        assert_eq!((&report["device"], report["spp"].as_u64() >= Some(1)), (&device.into(), true), "{report}");
    }
}

/// Mesa's layer for Vulkan looks for a Wayland display, and libwayland says "error" where it cannot.
#[test]
fn a_missing_runtime_folder_is_no_error_of_any_command() {
    let folder = TestFolder::new();
    let out = folder.file("out.exr").to_str().expect("a plain path").to_owned();
    let render = ["render", "cornell", "--size", "32x32", "--spp", "1", "-o", &out];
    let raster = [&render[..], &["--technique", "raster"]].concat();
    let on_the_device = [&render[..], &["--device", "gpu"]].concat();
    // enough to do for a graphics device to be looked for
    let auto = ["render", "cornell", "--size", "64x64", "--spp", "4096", "--time", "0.01", "-o", &out];
    for arguments in [&["info"][..], &render, &auto, &raster, &on_the_device, &["check", "--case", "24"]] {
        for runtime_folder in [None, Some(""), Some("relative")] {
            let mut command = program();
            command.env_remove("XDG_RUNTIME_DIR").envs(runtime_folder.map(|path| ("XDG_RUNTIME_DIR", path)));
            let output = command.args(arguments).output().expect("the program");
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{arguments:?}: {said}");
            assert!(!said.lines().any(|line| line.starts_with("error")), "{arguments:?}: {said}");
        }
    }
}

const FEW_PHOTONS: [&str; 6] = ["--spp", "2", "--photons", "1024", "--sampler", "independent"];

#[test]
fn what_the_processor_alone_follows_is_traced_by_it_and_refused_for_a_device() {
    let folder = TestFolder::new();
    let alone: [(&[&str], &str); 2] = [
        (&["--technique", "light-tracing"], "light tracing runs on the processor alone"),
        (
            &["--technique", "photon", "--photon-picture", "points"],
            "photons are shown as points by the processor alone",
        ),
    ];
    for (technique, why) in alone {
        let options = [technique, &FEW_PHOTONS].concat();
        let report = json(&render(&folder, None, &options));
        assert_eq!((&report["device"], &report["spp"], &report["photons"]), (&"cpu".into(), &2.into(), &1024.into()));
        let refused = render(&folder, None, &[&options[..], &["--device", "gpu"]].concat());
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(refused.status.code() == Some(2) && told.contains(&format!("--device gpu: {why}")), "{told}");
    }
}

#[test]
fn photon_maps_are_made_where_rays_are_traced() {
    let folder = TestFolder::new();
    for device in ["cpu", "gpu"] {
        let options = [&["--technique", "photon", "--device", device], &FEW_PHOTONS[..]].concat();
        let report = json(&render(&folder, None, &options));
        assert_eq!((&report["device"], &report["spp"], &report["photons"]), (&device.into(), &2.into(), &1024.into()));
        assert_eq!(report["standard_error_reliable"], false, "pixels share photons");
    }
}

/// The graphics device has no such chains: who asks for it is told, and auto leaves it alone.
#[test]
fn chains_run_on_the_processor_and_tell_what_they_did() {
    let folder = TestFolder::new();
    let refused = render(&folder, None, &["--technique", "metropolis", "--device", "gpu"]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        refused.status.code() == Some(2)
            && told.contains("--device gpu: the chains of Metropolis run on the processor alone"),
        "{told}"
    );
    let words = ["--technique", "metropolis", "--chains", "5", "--spp", "3", "--sampler", "independent"];
    // enough to be worth a device, if it were one for that
    let report = json(&render(&folder, None, &[&words[..], &["--large-step", "0.5"]].concat()));
    assert_eq!((&report["device"], &report["chains"], &report["spp"]), (&"cpu".into(), &5.into(), &3.into()));
    assert_eq!(report["standard_error_reliable"], false, "pixels share paths");
    // 9216 pixels are no multiple of 5 chains
    assert_eq!(report["mutations"], 3 * 5 * 1844);
    let [acceptance, scale] = ["acceptance", "start_up_scale"].map(|name| report[name].as_f64().expect("a number"));
    assert!(acceptance > 0.05 && acceptance < 0.95, "{acceptance}");
    let mean: Vec<f64> = (0..3).map(|c| report["mean"][c].as_f64().expect("a mean")).collect();
    let luminance = 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2];
    assert!((luminance / scale - 1.0).abs() < 1e-5, "{luminance} for {scale}");
    let out = folder.file("out.exr").to_str().expect("a plain path").to_owned();
    let again = folder.file("again.exr").to_str().expect("a plain path").to_owned();
    let made = visavis(&["render", "--from", &out, "-o", &again]);
    let said = String::from_utf8_lossy(&made.stderr).into_owned();
    assert!(said.contains("5 chains a sample took "), "{said}");
    let pixels = |file: &str| image_file::read(file.as_ref()).expect("a picture").image;
    assert_eq!(pixels(&out), pixels(&again));
}
