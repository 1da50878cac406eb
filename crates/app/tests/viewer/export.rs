//! What is exported is what is shown, is never lost and can be made again.

use super::{User, both_whole, says};
use egui::Key;
use std::path::{Path, PathBuf};
use std::process::Command;
use visavis_tests::Frame;

/// Chooses what to export, types a file's name into the menu and saves.
pub fn export(user: &mut User, choices: &[&str], file: &Path) -> Frame {
    user.click("Export");
    for choice in choices {
        user.click(choice);
    }
    let typed = file.display().to_string();
    let named = user.type_into("File", &typed);
    assert_eq!(named.value("export file"), typed);
    user.click("Save");
    user.wait_for("the answer", |f| says(f, &typed.replace(".png", "").replace(".exr", "")) && !f.shows("save"))
}

/// Pauses and waits until the truth is held: a pane that waits is told nothing more.
fn hold(user: &mut User) {
    user.key(Key::P);
    let mut last = None;
    loop {
        let frame = user.wait_for("the pause", |f| f.value("label B").contains("paused") && both_whole(f));
        if last == frame.state("b")["spp"].as_u64() {
            return;
        }
        last = frame.state("b")["spp"].as_u64();
        std::thread::sleep(std::time::Duration::from_millis(1500));
    }
}

/// Runs a command that was copied from the window, with another file to write.
pub fn run(command: &str, out: &Path) {
    let (before, after) = command.split_once(" -o ").expect("a command with an output");
    let (_, after) = after.split_once(' ').expect("options");
    let binary = Path::new(env!("CARGO_BIN_EXE_visavis"));
    let line = format!("{before} -o '{}' {after}", out.display());
    let path = std::env::join_paths([binary.parent().expect("a folder")]).expect("a path");
    let done = Command::new("/bin/sh").args(["-c", &line]).env("PATH", path).output().expect("a shell");
    assert!(done.status.success(), "{line}: {}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn a_pane_its_film_and_its_command_are_one_picture() {
    let mut user = User::of("whitted");
    user.wait_for("both pictures", both_whole);
    // what is changed in the scene is in film and command
    user.set_slider("Refraction ratio", 0.6);
    user.wait_for("both pictures of the changed scene", both_whole);
    hold(&mut user);
    for (pane, choice) in [("A", "A alone"), ("B", "B alone")] {
        let (png, exr) = (user.file(&format!("{pane}.png")), user.file(&format!("{pane}.exr")));
        let (png_again, exr_again) = (user.file(&format!("{pane}-again.png")), user.file(&format!("{pane}-again.exr")));
        export(&mut user, &[choice, "PNG as shown"], &png);
        export(&mut user, &[choice, "EXR linear"], &exr);
        let menu = user.click("Export");
        let command = menu.value(&format!("command {pane}")).to_owned();
        user.click("Export");

        run(&command, &png_again);
        // the records of its error stand beside those that make it again
        let mut again = Command::new(env!("CARGO_BIN_EXE_visavis"));
        again.args(["render", "--from"]).arg(&exr).arg("-o").arg(&exr_again);
        let made = again.output().expect("the program");
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        for kept in [&png, &exr] {
            let records = image_file::records(kept).expect("records");
            let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
            let other =
                if pane == "A" { "B: visavis render whitted -o b.png" } else { "A: visavis render whitted -o a.png" };
            assert!(value("error.against").is_some_and(|against| against.starts_with(other)), "{records:?}");
            assert!(value("error.relmse").is_some_and(|error| error.parse::<f64>().is_ok_and(|e| e > 0.0)));
        }
        let pixels = |path: &PathBuf| image::open(path).expect("a picture").to_rgb8();
        assert!(pixels(&png) == pixels(&png_again), "{pane}: {command}");
        let film = |path: &PathBuf| image_file::load(path).expect("an EXR");
        let (once, again) = (film(&exr), film(&exr_again));
        assert!(once == again, "{pane}: the films differ: {command}");

        let display = film::DisplayTransform::default();
        let shown = display.rgba8_of(&once);
        let stored: Vec<u8> = pixels(&png).pixels().flat_map(|p| [p[0], p[1], p[2], 255]).collect();
        assert!(shown == stored, "{pane}: the PNG is not the film through the display transform");
    }
}

#[test]
fn no_file_is_overwritten_and_a_bad_place_is_told() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    let file = user.file("kept.png");
    std::fs::write(&file, "mine").expect("a file");
    let saved = export(&mut user, &["A alone"], &file);
    assert!(says(&saved, "kept-2.png"), "{}", saved.state("message"));
    assert_eq!(std::fs::read(&file).expect("the file"), b"mine");
    assert!(user.file("kept-2.png").is_file());

    let nowhere = user.file("nowhere/kept.png");
    export(&mut user, &["A alone"], &nowhere);
    let told = user.wait_for("the refusal", |f| says(f, "cannot write the file"));
    assert!(says(&told, "nowhere"));
    let folder = file.parent().expect("a folder");
    let names = std::fs::read_dir(folder).expect("the folder").filter_map(|e| e.ok()?.file_name().into_string().ok());
    let mut left: Vec<_> = names.filter(|name| name.starts_with("kept") || name.contains("partial")).collect();
    left.sort();
    assert_eq!(left, ["kept-2.png", "kept.png"]);
}
