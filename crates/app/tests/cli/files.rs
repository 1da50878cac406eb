//! Files that are written: refused before anything is traced, never lost, and kept as they are but for what is in them.

use super::{assert_failed, assert_refused, program, visavis};
use std::path::Path;
use visavis_tests::TestFolder;

#[test]
fn what_cannot_be_written_is_refused_before_it_is_traced() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.file("folder.exr")).expect("a folder");
    for name in ["folder.exr", "none/a.exr", &format!("{}.exr", "n".repeat(252))] {
        let out = folder.file(name);
        let out = out.to_str().expect("a plain path");
        // as many samples as nobody waits for
        assert_refused(&["render", "cornell", "--spp", "1000000000", "-o", out], 1, &["cannot write the file", name]);
        assert_refused(&["reference", "cornell", "--time", "1e9", "-o", out], 1, &["cannot write the file", name]);
    }
    let longest = folder.file(&format!("{}.exr", "n".repeat(251)));
    assert!(
        visavis(&["render", "cornell", "--size", "4x4", "--spp", "1", "-o", longest.to_str().unwrap()])
            .status
            .success()
    );
    assert_eq!(folder.names().len(), 2);
}

#[test]
#[cfg(unix)]
fn a_file_keeps_its_mode_and_its_names_and_is_read_only_for_who_may_not_write_it() {
    use std::fs::Permissions;
    use std::os::unix::fs::PermissionsExt;
    let folder = TestFolder::new();
    let (out, other) = (folder.file("a.exr"), folder.file("b.exr"));
    std::fs::write(&out, "precious").expect("a file");
    std::fs::hard_link(&out, &other).expect("a second name");
    let render = |mode| {
        std::fs::set_permissions(&out, Permissions::from_mode(mode)).expect("a mode");
        let done = visavis(&["render", "cornell", "--size", "4x4", "--spp", "1", "-o", out.to_str().unwrap()]);
        let kept = out.metadata().expect("the file").permissions().mode() & 0o777;
        assert_eq!(kept, mode);
        done
    };
    let done = render(0o444);
    // root is not refused
    if std::fs::read(&out).expect("the file") == b"precious" {
        assert_failed(&["render"], &done, 1, &["cannot write the file", "a.exr"]);
    }
    assert!(render(0o600).status.success());
    assert!(image_file::load(&other).is_ok(), "it is the same file by its other name");
}

/// A point light, which the naive estimator cannot find: the program says so when it begins to trace.
#[cfg(unix)]
const UNSEEN_LIGHT: &str = r#"
camera = { eye = [0, 1, 5], target = [0, 1, 0], fov_y = 30 }
point_light = [{ position = [0, 5, 5], intensity = [9, 9, 9] }]
material.grey.diffuse.albedo = [0.5, 0.5, 0.5]
sphere = [{ center = [0, 1, 0], radius = 1, material = "grey" }]
"#;

#[test]
#[cfg(unix)]
fn ctrl_c_saves_the_samples_that_there_are() {
    use rustix::process::{Pid, Signal, kill_process};
    use std::io::{BufRead, BufReader, Read};
    let folder = TestFolder::new();
    let (scene, out) = (folder.file("a.toml"), folder.file("a.exr"));
    std::fs::write(&scene, UNSEEN_LIGHT).expect("the scene");
    let arguments = ["--size", "8x8", "--spp", "2000000", "--estimator", "uniform", "--device", "cpu", "-o"];
    let measured = ["--errors"];
    for (signal, more, end) in [
        (Signal::INT, &[][..], "visavis: interrupted: what there was by then is kept"),
        (Signal::TERM, &measured, "visavis: interrupted: the picture is saved without its errors: "),
    ] {
        let mut command = program();
        command.arg("render").arg(&scene).args(arguments).arg(&out).args(more).stderr(std::process::Stdio::piped());
        let mut render = command.spawn().expect("the program");
        let mut stderr = BufReader::new(render.stderr.take().expect("its notes"));
        let mut begun = String::new();
        stderr.read_line(&mut begun).expect("a line");
        assert!(begun.starts_with("note: "), "{begun}");
        kill_process(Pid::from_child(&render), signal).expect("a signal");
        let mut said = String::new();
        stderr.read_to_string(&mut said).expect("its notes");
        assert_eq!(render.wait().expect("an end").code(), Some(130), "{said}");
        assert!(said.contains("note: ends soon and saves what there is") && said.contains(end), "{said}");
        assert_eq!(folder.names(), ["a.exr", "a.toml"]);
        assert!((1..2_000_000).contains(&spp_of(&out)));
        std::fs::remove_file(&out).expect("the picture");
    }
}

#[cfg(unix)]
fn spp_of(file: &Path) -> u32 {
    let records = image_file::records(file).expect("records");
    let spp = records.iter().find(|(name, _)| name == "spp").expect("its samples");
    spp.1.parse().expect("a number")
}

#[test]
fn pictures_of_other_programs_are_compared_with_a_word_about_what_is_not() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let (first, second) = (file("first.exr"), file("second.exr"));
    for (path, corner) in [(&first, (0, 0)), (&second, (1, 1))] {
        write_region(Path::new(path), corner);
    }
    let done = visavis(&["compare", &first, &second]);
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    for (name, place) in [("first.exr", "(0, 0)"), ("second.exr", "(1, 1)")] {
        let note = said.lines().find(|line| line.ends_with(name)).unwrap_or_else(|| panic!("{said}"));
        assert!(note.starts_with(&format!("note: its data window is 1x1 pixels at {place}")), "{note}");
    }
    // each is white where the other is black, in two of four pixels
    assert!(String::from_utf8_lossy(&done.stdout).starts_with("RMSE      0.707107"));
}

/// One white pixel of a picture of two by two.
fn write_region(path: &Path, corner: (i32, i32)) {
    use exr::prelude::*;
    let attributes = LayerAttributes { layer_position: corner.into(), ..LayerAttributes::default() };
    let channels = SpecificChannels::rgb(|_| (1.0_f32, 1.0_f32, 1.0_f32));
    let layer = Layer::new((1, 1), attributes, Encoding::FAST_LOSSLESS, channels);
    let window = ImageAttributes::new(IntegerBounds::new((0, 0), (2, 2)));
    Image::new(window, layer).write().to_file(path).expect("an EXR");
}
