//! References on the command line: made once, there at once, measured against; and stores and disks that refuse.

use super::{assert_failed, json, program};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use visavis_tests::TestFolder;

/// A folder with a store of its own.
struct Workplace(TestFolder);

impl Workplace {
    fn new() -> Self {
        Workplace(TestFolder::new())
    }

    fn file(&self, name: &str) -> String {
        self.0.file(name).to_str().expect("a plain path").to_owned()
    }

    fn run(&self, arguments: &[&str]) -> Output {
        program().args(arguments).env("VISAVIS_CACHE", self.0.file("store")).output().expect("the program")
    }

    fn done(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// Makes the reference of a picture of `SMALL`, coarse enough to be made at once.
    fn reference(&self, scene: &str) -> String {
        let out = self.file("reference.exr");
        self.done(&[&["reference", scene, "-o", &out, "--noise", "1"], &SMALL[..]].concat());
        out
    }
}

const SMALL: [&str; 2] = ["--size", "16x12"];

fn record(file: &str, name: &str) -> Option<String> {
    let records = image_file::records(Path::new(file)).expect("records");
    records.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
}

#[test]
fn a_reference_is_made_once_and_finer_only_if_asked() {
    let workplace = Workplace::new();
    let reference = workplace.reference("cornell");
    let loaded = |file: &str| reference::Reference::load(Path::new(file)).expect("a reference");
    let first = loaded(&reference);
    assert_eq!((first.replicates, first.image.size()), (16, (16, 12)));
    assert!(first.rel_mse() < Some(1.0) && first.standard_errors().is_some());
    assert_eq!(record(&reference, "scene").as_deref(), Some("cornell"));
    // the same again is fetched, to the last bit and with the seconds of the first time
    assert_eq!(loaded(&workplace.reference("cornell")), first);
    assert!(workplace.done(&["reference"]).contains("count   1\n"));
    let finer = (0.5 * first.rel_mse().expect("noise")).to_string();
    workplace.done(&[&["reference", "cornell", "-o", &reference, "--noise", &finer], &SMALL[..]].concat());
    assert!(loaded(&reference).replicates > 16 && loaded(&reference).seconds > first.seconds);
    // another camera is another one
    let moved = workplace.file("moved.exr");
    workplace.done(&[&["reference", "cornell", "-o", &moved, "--noise", "1", "--fov", "30"], &SMALL[..]].concat());
    assert!(workplace.done(&["reference"]).contains("count   2\n"));
    assert!(workplace.done(&["reference", "--clear"]).starts_with("removed 2 references"));
    assert!(workplace.done(&["reference"]).contains("count   0\n"));
}

#[test]
fn a_picture_is_judged_by_its_reference_in_three_ways() {
    let workplace = Workplace::new();
    let reference = workplace.reference("cornell");
    let picture = workplace.file("picture.exr");
    let rendered: Value = json(
        &workplace
            .run(&[&["render", "cornell", "-o", &picture, "--spp", "4", "--errors", "--json"], &SMALL[..]].concat()),
    );
    let errors = &rendered["errors"];
    assert_eq!((&errors["against"], &errors["below_reference_noise"]), (&"reference".into(), &false.into()));
    let alone = json(&workplace.run(&["compare", &picture, "--json"]));
    let by_file = json(&workplace.run(&["compare", &picture, &reference, "--json"]));
    for figure in ["rmse", "relmse", "mae", "bias", "reference_noise"] {
        assert_eq!(errors[figure], alone[figure], "{figure}");
        assert_eq!(errors[figure], by_file[figure], "{figure}");
        assert_eq!(record(&picture, &format!("error.{figure}")), Some(errors[figure].to_string()), "{figure}");
    }
    assert_eq!(record(&picture, "error.against").as_deref(), Some("reference"));
    let words = workplace.done(&["compare", &reference, &reference]);
    assert!(words.contains("below the reference's noise"), "{words}");
    assert!(!workplace.done(&["compare", &picture]).contains("below the reference's noise"));

    // what was measured is no option: the picture is made again
    let again = workplace.file("again.exr");
    workplace.done(&["render", "--from", &picture, "-o", &again]);
    let film = |file: &str| image_file::load(Path::new(file)).expect("an EXR");
    assert!(film(&picture) == film(&again));
    assert_eq!(record(&again, "error.relmse"), None);
    let png = workplace.file("picture.png");
    workplace.done(&["render", "--from", &picture, "-o", &png, "--errors"]);
    workplace.done(&["render", "--from", &png, "-o", &again]);
    assert!(film(&picture) == film(&again));
}

/// The fake does not see how large the sun is, but its reference does.
#[test]
fn the_reference_of_a_fake_has_the_sun_that_was_asked_for() {
    let workplace = Workplace::new();
    let fake = workplace.file("fake.png");
    let sun = ["--sun-radius", "4", "--refraction-ratio", "0.8"];
    let out = workplace.file("reference.exr");
    workplace.done(&[&["reference", "whitted", "-o", &out, "--noise", "1"], &SMALL[..], &sun].concat());
    workplace.done(&[&["render", "whitted", "-o", &fake, "--technique", "raster"], &SMALL[..], &sun].concat());
    let alone = json(&workplace.run(&["compare", &fake, "--json"]));
    assert_eq!(alone["rmse"], json(&workplace.run(&["compare", &fake, &out, "--json"]))["rmse"]);
    assert!(workplace.done(&["reference"]).contains("count   1\n"), "another one was made");
    let again = workplace.run(&["render", "--from", &fake, "-o", &workplace.file("again.png")]);
    assert!(!String::from_utf8_lossy(&again.stderr).contains("no effect"));
}

/// A sun of the picture's own is no other scene: it is kept with the picture, which is made again, and judged by the
/// reference of the scene's own sun.
#[test]
fn a_picture_under_a_sun_of_its_own_is_judged_by_the_scenes() {
    let workplace = Workplace::new();
    let reference = workplace.reference("whitted");
    let [picture, again, changed] = ["picture.exr", "again.exr", "changed.exr"].map(|name| workplace.file(name));
    let whitted = ["--technique", "whitted", "--spp", "2"];
    let own = ["--traced-sun", "0", "--errors", "--json"];
    let run = |out: &str, sun: &[&str]| {
        json(&workplace.run(&[&["render", "whitted", "-o", out], &SMALL[..], &whitted, sun].concat()))
    };
    let report = run(&picture, &own);
    assert_eq!(report["traced_sun"], "0");
    assert!(workplace.done(&["reference"]).contains("count   1\n"), "a reference of another sun was made");
    let by_file = json(&workplace.run(&["compare", &picture, &reference, "--json"]));
    assert_eq!(report["errors"]["rmse"], by_file["rmse"]);
    assert_eq!(record(&picture, "traced-sun").as_deref(), Some("0"));
    assert!(record(&picture, "command").is_some_and(|command| command.contains("--traced-sun 0")));
    workplace.done(&["render", "--from", &picture, "-o", &again]);
    run(&changed, &["--sun-radius", "0", "--json"]);
    let film = |file: &str| image_file::load(Path::new(file)).expect("an EXR");
    assert!(film(&picture) == film(&again) && film(&picture) == film(&changed));
    run(&again, &["--json"]);
    assert!(film(&picture) != film(&again), "without it the sun is the scene's");
}

#[test]
fn what_cannot_be_judged_is_one_line() {
    let workplace = Workplace::new();
    let reference = workplace.reference("cornell");
    let failed = |arguments: &[&str], words: &[&str]| assert_failed(arguments, &workplace.run(arguments), 1, words);
    let (other, map) = (workplace.file("other.exr"), workplace.file("map.png"));
    workplace.done(&["render", "cornell", "-o", &other, "--size", "8x8", "--spp", "1"]);
    failed(&["compare", &other, &reference], &["differ in size", "8x8", "16x12"]);
    let whole = std::fs::read(&reference).expect("the file");
    for length in [30, whole.len() / 2, whole.len() - 1] {
        let cut = workplace.file("cut.exr");
        std::fs::write(&cut, &whole[..length]).expect("a file");
        failed(&["compare", &reference, &cut], &["cannot read the picture", "cut.exr"]);
    }
    workplace.done(&["compare", &reference, &reference, "--heatmap", &map]);
    failed(&["compare", &map], &["does not say how it was made", "map.png"]);
    let depths = ["--technique", "raster", "--show", "shadow-map"];
    workplace.done(&[&["render", "whitted", "-o", &map], &SMALL[..], &depths].concat());
    failed(&["compare", &map], &["a map of the fake"]);
    failed(&[&["render", "whitted", "-o", &map, "--errors"], &SMALL[..], &depths].concat(), &["--errors needs"]);
}

#[test]
fn a_store_that_refuses_is_told_and_does_no_harm() {
    let workplace = Workplace::new();
    std::fs::write(workplace.0.file("store"), "no folder").expect("a file");
    let out = workplace.file("reference.exr");
    let made = workplace.run(&[&["reference", "cornell", "-o", &out, "--noise", "1"], &SMALL[..]].concat());
    let said = String::from_utf8_lossy(&made.stderr);
    assert!(made.status.success(), "{said}");
    assert!(said.lines().filter(|line| line.starts_with("note: cannot keep references")).count() == 1, "{said}");
    assert!(reference::Reference::load(Path::new(&out)).is_ok());
    for arguments in [&["reference"][..], &["reference", "--clear"]] {
        assert_failed(arguments, &workplace.run(arguments), 1, &["cannot keep references", "store"]);
    }
    let limit = program().args(["reference"]).env("VISAVIS_CACHE_MIB", "much").output().expect("the program");
    assert_failed(&["reference"], &limit, 1, &["VISAVIS_CACHE_MIB much", "whole number"]);
}

/// As the XDG Base Directory Specification asks for; only the program's own variable is taken from the current folder.
#[test]
#[cfg(unix)]
fn relative_folders_of_the_system_are_ignored() {
    let workplace = Workplace::new();
    let folder = |variables: &[(&str, &str)]| {
        let mut program = program();
        program.arg("reference").current_dir(workplace.0.path()).env_remove("VISAVIS_CACHE").env_remove("LOCALAPPDATA");
        program.envs(variables.iter().copied()).output().expect("the program")
    };
    let home = workplace.0.path().canonicalize().expect("the folder");
    let home = home.to_str().expect("a plain path");
    let told = |variables: &[(&str, &str)]| {
        let listing = String::from_utf8(folder(variables).stdout).expect("words");
        listing.lines().next().and_then(|line| line.strip_prefix("folder  ")).expect("the folder").to_owned()
    };
    let in_home = told(&[("HOME", home), ("XDG_CACHE_HOME", "")]);
    assert!(in_home.starts_with(&format!("{home}/")) && in_home.ends_with("/visavis/references"), "{in_home}");
    for relative in ["cache", "./cache", "../cache"] {
        assert_eq!(told(&[("HOME", home), ("XDG_CACHE_HOME", relative)]), in_home);
    }
    let nowhere = folder(&[("HOME", "."), ("XDG_CACHE_HOME", "cache")]);
    assert_failed(&["reference"], &nowhere, 1, &["no home folder", "VISAVIS_CACHE"]);
    assert_eq!(told(&[("VISAVIS_CACHE", "mine")]), format!("{home}/mine"));
}

#[test]
fn a_damaged_reference_is_told_and_made_anew() {
    let workplace = Workplace::new();
    let reference = workplace.reference("cornell");
    let store = workplace.0.file("store");
    let kept = std::fs::read_dir(&store).expect("the store").next().expect("a reference").expect("a file").path();
    for file in [&kept, Path::new(&reference)] {
        let mut bytes = std::fs::read(file).expect("the file");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        std::fs::write(file, bytes).expect("the file");
    }
    let compared = ["compare", &reference, &reference];
    assert_failed(&compared, &workplace.run(&compared), 1, &["reference.exr", "damaged"]);
    let again = [&["reference", "cornell", "-o", &reference, "--noise", "1"], &SMALL[..]].concat();
    let told = workplace.run(&again);
    let said = String::from_utf8_lossy(&told.stderr);
    assert!(told.status.success() && said.contains("note: a reference that was kept is damaged"), "{said}");
    assert!(!String::from_utf8_lossy(&workplace.run(&again).stderr).contains("damaged"));
    workplace.done(&compared);
    assert!(workplace.done(&["reference"]).contains("count   1\n"));
}

/// A disk that is full, as a limit on the size of files: the same error of the same call.
#[test]
fn a_full_disk_is_one_line_and_no_half_a_file() {
    let workplace = Workplace::new();
    workplace.reference("cornell");
    let out = workplace.file("large.exr");
    let kept = workplace.0.names();
    // four blocks of 512 bytes: the picture's file does not fit, and the signal that would end the program is ignored
    let line = "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\"";
    let mut shell = Command::new("/bin/sh");
    shell.args(["-c", line, env!("CARGO_BIN_EXE_visavis"), "render", "cornell", "--size", "200x200", "--spp", "1"]);
    let output = shell.args(["-o", &out]).output().expect("a shell");
    assert_failed(&["render"], &output, 1, &["cannot write the file", "large.exr"]);
    assert_eq!(workplace.0.names(), kept);

    let mut shell = Command::new("/bin/sh");
    shell.args(["-c", line, env!("CARGO_BIN_EXE_visavis"), "reference", "cornell", "--size", "40x40", "--noise", "1"]);
    let output = shell.args(["-o", &out]).env("VISAVIS_CACHE", workplace.0.file("store")).output().expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.lines().count() == 2 && said.contains("note: cannot write the file"), "{said}");
    assert_eq!(workplace.0.names(), kept);
    assert_eq!(std::fs::read_dir(workplace.0.file("store")).expect("the store").count(), 1);
}
