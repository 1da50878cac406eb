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

/// A disk that is full, as a limit on the size of files.
#[test]
#[cfg(unix)]
fn a_full_disk_does_not_cost_a_file_with_two_names() {
    let folder = TestFolder::new();
    let (out, other) = (folder.file("a.exr"), folder.file("b.exr"));
    assert!(
        visavis(&["render", "cornell", "--size", "4x4", "--spp", "1", "-o", out.to_str().unwrap()]).status.success()
    );
    std::fs::hard_link(&out, &other).expect("a second name");
    let before = std::fs::read(&out).expect("the picture");
    let limited = "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\"";
    let mut shell = std::process::Command::new("/bin/sh");
    shell.args(["-c", limited, env!("CARGO_BIN_EXE_visavis"), "render", "cornell", "--size", "200x200", "--spp", "1"]);
    let output = shell.arg("-o").arg(&out).output().expect("a shell");
    assert_failed(&["render"], &output, 1, &["cannot write the file", "a.exr"]);
    assert!([&out, &other].into_iter().all(|name| std::fs::read(name).expect("the picture") == before));
    assert_eq!(folder.names(), ["a.exr", "b.exr"]);
}

#[test]
#[cfg(unix)]
fn names_with_ends_of_lines_are_told_in_one_line() {
    let folder = TestFolder::new();
    let (scene, out) = (folder.file("q\nq.toml"), folder.file("o\no.exr"));
    std::fs::write(&scene, "[camera\n").expect("a scene");
    let [scene_name, out_name] = [&scene, &out].map(|path| path.to_str().expect("a plain path"));
    let render = ["render", scene_name, "-o", out_name, "--size", "4x4", "--spp", "1"];
    assert_refused(&render, 1, &["q\\nq.toml:1:8"]);
    assert_refused(&["render", "z\nz.toml", "-o", out_name], 1, &["z\\nz.toml"]);
    assert_refused(&["render", "z\nz", "-o", out_name], 1, &["unknown scene 'z\\nz'"]);
    std::fs::write(&scene, super::interrupts::UNSEEN_LIGHT).expect("a scene");
    let said = |arguments: &[&str]| String::from_utf8_lossy(&visavis(arguments).stderr).into_owned();
    let made = said(&render);
    assert!(made.lines().count() == 1 && made.contains("path of q\\nq") && made.contains("o\\no.exr"), "{made}");
    // two scenes
    let other = folder.file("p\np.exr");
    let other = other.to_str().expect("a plain path");
    said(&["render", "cornell", "-o", other, "--size", "4x4", "--spp", "1"]);
    let compared = said(&["compare", out_name, other]);
    assert!(compared.lines().count() == 1 && compared.contains("o\\no.exr, "), "{compared}");
    let mut reference = program();
    reference.args(["reference", "cornell", "-o", other, "--size", "8x8", "--noise", "1"]);
    let made = reference.env("VISAVIS_CACHE", "/dev/null/c\nc").output().expect("the program");
    let made = String::from_utf8_lossy(&made.stderr);
    assert!(made.lines().count() == 2 && made.contains("c\\nc\n"), "{made}");
    // the scene has changed
    std::fs::write(&scene, super::interrupts::UNSEEN_LIGHT.replace("radius = 1", "radius = 2")).expect("a scene");
    assert_refused(&["compare", out_name], 1, &["o\\no.exr", "q\\nq.toml"]);
    let again = folder.file("again.exr");
    let again = said(&["render", "--from", out_name, "-o", again.to_str().expect("a plain path")]);
    let note = again.lines().next().unwrap_or_default();
    assert!(again.lines().count() == 2 && note.contains("o\\no.exr") && note.contains("q\\nq.toml"), "{again}");
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
