//! What is exported is what is shown, is never lost and can be made again.

use super::{alone, both_whole, ready, says};
use std::path::{Path, PathBuf};
use std::process::Command;
use visavis_tests::{Frame, Screen, ViewerUnderTest};

/// Chooses what to export and types a file name into the menu.
pub fn export(screen: &Screen, viewer: &mut ViewerUnderTest, choices: &[&str], file: &Path) -> Frame {
    let frame = viewer.wait_for("the window", |_| true);
    screen.click(frame.point("export", 0.5, 0.5));
    viewer.wait_for_widget("save");
    for choice in choices {
        let menu = viewer.wait_for_widget(choice);
        screen.click(menu.point(choice, 0.1, 0.5));
        viewer.wait_for("the choice", |f| f.value(choice) == "true");
    }
    let menu = viewer.wait_for_widget("export file");
    screen.click(menu.point("export file", 0.5, 0.5));
    viewer.wait_for("the cursor in the field", |f| f.state("typing") == true);
    screen.key('a', true);
    screen.type_text(&file.display().to_string());
    let typed = file.display().to_string();
    viewer.wait_for("the typed name", |f| f.value("export file") == typed);
    let menu = viewer.wait_for_widget("save");
    screen.click(menu.point("save", 0.5, 0.5));
    viewer.wait_for("the answer", |f| says(f, &typed.replace(".png", "").replace(".exr", "")) && !f.shows("save"))
}

/// Pauses and waits until the truth is held.
fn hold(screen: &Screen, viewer: &mut ViewerUnderTest) {
    screen.key('p', false);
    let mut last = None;
    loop {
        let frame = viewer.wait_for("the pause", |f| f.value("label B").contains("paused") && both_whole(f));
        if last == frame.state("b")["spp"].as_u64() {
            return;
        }
        last = frame.state("b")["spp"].as_u64();
        std::thread::sleep(std::time::Duration::from_millis(1500));
    }
}

/// Runs a command that was copied from the window, with another file to write.
fn run(command: &str, out: &Path) {
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
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, _) = ready(&screen, &[]);
    hold(&screen, &mut viewer);
    let folder = viewer.home();
    for (side, choice) in [("A", "export A alone"), ("B", "export B alone")] {
        let file = |name: &str| folder.join(format!("{}{name}", side.to_lowercase()));
        let shown = export(&screen, &mut viewer, &[choice, "format PNG as shown"], &file(".png"));
        export(&screen, &mut viewer, &[choice, "format EXR linear"], &file(".exr"));
        screen.click(shown.point("export", 0.5, 0.5));
        let name = format!("command {side}");
        let command = viewer.wait_for_widget(&name).value(&name).to_owned();
        screen.click(shown.point("export", 0.5, 0.5));
        viewer.wait_for("the menu to close", |f| !f.shows("save"));

        run(&command, &file("-again.png"));
        // the records of its error stand beside those that make it again
        let mut again = Command::new(env!("CARGO_BIN_EXE_visavis"));
        again.args(["render", "--from"]).arg(file(".exr")).arg("-o").arg(file("-again.exr"));
        let made = again.output().expect("the program");
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        for kept in [file(".png"), file(".exr")] {
            let records = image_file::records(&kept).expect("records");
            let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
            let other =
                if side == "A" { "B: visavis render whitted -o b.png" } else { "A: visavis render whitted -o a.png" };
            assert!(value("error.against").is_some_and(|against| against.starts_with(other)), "{records:?}");
            assert!(value("error.relmse").is_some_and(|error| error.parse::<f64>().is_ok_and(|e| e > 0.0)));
        }
        let pixels = |path: PathBuf| image::open(&path).expect("a picture").to_rgb8();
        assert!(pixels(file(".png")) == pixels(file("-again.png")), "{side}: {command}");
        let film = |path: PathBuf| image_file::load(&path).expect("an EXR");
        let (once, again) = (film(file(".exr")), film(file("-again.exr")));
        assert!(once == again, "{side}: the films differ: {command}");

        let display = film::DisplayTransform::default();
        let developed = display.rgba8_of(&once);
        let stored: Vec<u8> = pixels(file(".png")).pixels().flat_map(|p| [p[0], p[1], p[2], 255]).collect();
        assert!(developed == stored, "{side}: the PNG is not the film through the display transform");
    }
}

#[test]
fn the_picture_as_seen_goes_to_file_and_clipboard_with_its_records() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, _) = ready(&screen, &["cornell"]);
    screen.key('4', false);
    viewer.wait_for("both side by side", |f| f.state("view") == "Side by side" && both_whole(f));
    hold(&screen, &mut viewer);
    let file = viewer.home().join("seen.png");
    let saved = export(&screen, &mut viewer, &["export As seen"], &file);
    let [left, top, right, bottom] = saved.rect("picture").map(|v| v as u32);
    // the message lies on the lower part of the screen, but not of the saved picture
    let rows = (bottom - top) / 2;
    let on_screen = screen.pixels(left, top, right - left, rows);
    let picture = image::open(&file).expect("a PNG").to_rgb8();
    assert_eq!(picture.dimensions(), (right - left, bottom - top));
    assert!(picture.pixels().zip(&on_screen).all(|(a, b)| a.0 == *b), "the file is not what the screen shows");

    let chunks = text_chunks(&file);
    for (name, words) in [("visavis.view", "Side by side"), ("visavis.A", "raster"), ("visavis.B", "--estimator light")]
    {
        assert!(chunks.iter().any(|(n, text)| n == name && text.contains(words)), "{name} is not in {chunks:?}");
    }

    screen.key('c', true);
    viewer.wait_for("the copy", |f| says(f, "Copied the picture"));
    let copied = image::load_from_memory(&screen.clipboard("image/png")).expect("a PNG").to_rgb8();
    assert!(copied == picture, "the clipboard holds another picture");

    screen.click(saved.point("export", 0.5, 0.5));
    let menu = viewer.wait_for_widget("command B");
    screen.click(menu.point("command B", 0.5, 0.5));
    viewer.wait_for("the other copy", |f| says(f, "Copied the command"));
    assert_eq!(String::from_utf8_lossy(&screen.clipboard("UTF8_STRING")), menu.value("command B"));
}

fn text_chunks(file: &Path) -> Vec<(String, String)> {
    let reader = std::io::BufReader::new(std::fs::File::open(file).expect("the file"));
    let reader = png::Decoder::new(reader).read_info().expect("a PNG");
    let chunks = &reader.info().utf8_text;
    chunks.iter().map(|c| (c.keyword.clone(), c.get_text().expect("text"))).collect()
}

#[test]
fn no_file_is_overwritten_and_a_bad_place_is_told() {
    let _alone = alone();
    let screen = Screen::start(1280, 720);
    let (mut viewer, _) = ready(&screen, &["cornell"]);
    let file = viewer.home().join("kept.png");
    std::fs::write(&file, "mine").expect("a file");
    let saved = export(&screen, &mut viewer, &[], &file);
    assert!(says(&saved, "kept-2.png"), "{}", saved.state("message"));
    assert_eq!(std::fs::read(&file).expect("the file"), b"mine");
    assert!(viewer.home().join("kept-2.png").is_file());

    let (nowhere, no_film) = (viewer.home().join("nowhere/kept.png"), viewer.home().join("seen.exr"));
    export(&screen, &mut viewer, &[], &nowhere);
    let told = viewer.wait_for("the refusal", |f| says(f, "cannot write the file"));
    assert!(says(&told, "nowhere"));
    export(&screen, &mut viewer, &[], &no_film);
    viewer.wait_for("the refusal", |f| says(f, "EXR keeps the radiance of one pane"));
    let mut left: Vec<_> = std::fs::read_dir(viewer.home())
        .expect("the folder")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.starts_with("kept") || name.starts_with("seen") || name.contains("partial"))
        .collect();
    left.sort();
    assert_eq!(left, ["kept-2.png", "kept.png"]);
}
