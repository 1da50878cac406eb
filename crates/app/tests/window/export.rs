//! What is exported is what is shown, is never lost and can be made again.

use super::{alone, both_whole, ready, says};
use std::path::Path;
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
    for (name, words) in [
        ("visavis.view", "Side by side"),
        ("visavis.A", "raster"),
        ("visavis.B", "--estimator light"),
        ("visavis.scene.hash", "-"),
    ] {
        assert!(chunks.iter().any(|(n, text)| n == name && text.contains(words)), "{name} is not in {chunks:?}");
    }

    // more than one picture has no radiance of its own
    let no_film = viewer.home().join("seen.exr");
    export(&screen, &mut viewer, &["export As seen"], &no_film);
    viewer.wait_for("the refusal", |f| says(f, "EXR keeps the radiance of one pane"));
    assert!(!no_film.exists());

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
