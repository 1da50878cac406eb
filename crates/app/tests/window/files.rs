//! Files in the real window: options, title, a scene that changes on disk, and what the next window remembers.

use super::{alone, both_ready, says, viewer_on};
use std::path::Path;
use visavis_tests::{Screen, TestFolder, ViewerUnderTest};

/// X11's keysym of the Escape key.
const ESCAPE: u32 = 0xff1b;

fn write(file: &Path, fov: &str) {
    let cornell = scene::builtin::text("cornell").expect("a built-in scene");
    std::fs::write(file, cornell.replace("fov_y = 45", &format!("fov_y = {fov}"))).expect("a file");
}

#[test]
fn a_lecture_is_opened_by_its_options_and_its_window_comes_back() {
    let _alone = alone();
    let (screen, folder) = (Screen::start(1280, 720), TestFolder::new());
    let file = folder.file("lecture.toml");
    write(&file, "40");
    let binary = Path::new(env!("CARGO_BIN_EXE_visavis"));
    let name = file.to_str().expect("a plain path");
    let variables = [("WINIT_X11_SCALE_FACTOR", Some("1"))];
    let options = [name, "--a", "path,spp=2,bounces=0", "--b", "path,spp=2,bounces=1", "--view", "side"];
    let mut viewer = ViewerUnderTest::start_keeping(binary, &screen, &variables, &options, folder.path());
    let first = viewer.wait_for("both pictures", both_ready);
    assert_eq!(first.state("view"), "Side by side");
    assert_eq!([first.value("A bounces"), first.value("B bounces")], ["0", "1"]);
    let window = screen.focus("Visavis");
    let parent = folder.path().file_name().expect("a name").to_string_lossy().into_owned();
    assert_eq!(screen.title(window), format!("lecture.toml ({parent}) - Visavis"));

    write(&file, "55");
    viewer.wait_for("the other version", |f| f.state("fov") == 55.0 && both_ready(f));
    screen.resize(window, 900, 640);
    viewer.wait_for("the smaller window", |f| f.rect("picture")[3] > 600.0 && f.rect("picture")[3] <= 640.0);
    screen.close(window);
    assert!(viewer.wait_for_end().success());

    let mut next = ViewerUnderTest::start_keeping(binary, &screen, &variables, &["cornell"], folder.path());
    let again = next.wait_for("both pictures", both_ready);
    let [_, _, _, bottom] = again.rect("picture");
    assert!(bottom > 600.0 && bottom <= 640.0, "as it was left: {bottom}");
    let window = screen.focus("Visavis");
    assert_eq!(screen.title(window), "cornell - Visavis");
    screen.click(again.point("scene", 0.5, 0.5));
    next.wait_for("the file of before", |f| f.shows("recent lecture.toml"));
}

/// A scene whose statue takes seconds to be made, and what stands behind it.
fn write_large(file: &Path, level: u32, behind: &str) -> String {
    let before = "[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\nfov_y = 45\n[material.a]\n\
                  diffuse = { albedo = [1, 1, 1] }\n";
    let statue = format!("[[statue]]\nlevel = {level}\nmaterial = \"a\"\n");
    std::fs::write(file, format!("{before}{statue}{behind}")).expect("a file");
    file.to_str().expect("a plain path").to_owned()
}

#[test]
fn a_window_is_there_before_its_large_scene_and_escape_opens_another_in_its_place() {
    let _alone = alone();
    let (screen, folder) = (Screen::start(1280, 720), TestFolder::new());
    let large = write_large(&folder.file("large.toml"), 11, "");
    let mut viewer = viewer_on(&screen, &[&large, "--b", "path,spp=2", "--edit", "{ material.a.colour = [1, 0, 0] }"]);
    let waits = viewer.wait_for("how far it is", |f| f.state("loading").is_string());
    assert!(waits.value("opening").ends_with("large.toml") && !waits.shows("picture"), "{waits:?}");
    assert!(waits.value("loading").starts_with("making a statue of level 11: "), "{waits:?}");
    screen.focus("Visavis");
    screen.press(ESCAPE);
    let usual = viewer.wait_for("another scene", both_ready);
    assert!(usual.state("scene") == "whitted" && says(&usual, "Reading was stopped"), "{}", usual.state("message"));

    drop(viewer);
    let mut viewer = viewer_on(&screen, &[&large]);
    viewer.wait_for("how far it is", |f| f.state("loading").is_string());
    screen.close(screen.focus("Visavis"));
    assert!(viewer.wait_for_end().success());
}

#[test]
fn a_large_scene_whose_fault_comes_late_ends_the_window_with_one_line() {
    let _alone = alone();
    let (screen, folder) = (Screen::start(1280, 720), TestFolder::new());
    let faulty = write_large(&folder.file("large.toml"), 9, "[[instance]]\nof = \"nothing\"\n");
    let mut viewer = viewer_on(&screen, &[&faulty]);
    assert_eq!(viewer.wait_for_end().code(), Some(1));
    let said = viewer.said();
    assert!(said.starts_with("visavis: ") && said.lines().count() == 1 && said.contains("large.toml:"), "{said}");
}

#[test]
fn a_session_opens_its_window_and_a_key_saves_it_again() {
    let _alone = alone();
    let (screen, folder) = (Screen::start(1280, 720), TestFolder::new());
    write(&folder.file("box.toml"), "40");
    let file = folder.file("lecture.toml");
    let text = "session = 1\nscene = \"box.toml\"\n[view]\nshow = \"side\"\n[panes.A]\nsegments = 9\n[panes.B]\nspp = 2\n\
                [window]\nsize = [900, 640]\ntheme = \"light\"\npanel = false\n";
    std::fs::write(&file, text).expect("a file");
    let binary = Path::new(env!("CARGO_BIN_EXE_visavis"));
    let variables = [("WINIT_X11_SCALE_FACTOR", Some("1"))];
    let name = file.to_str().expect("a plain path");
    let mut viewer = ViewerUnderTest::start_keeping(binary, &screen, &variables, &[name], folder.path());
    let first = viewer.wait_for("both pictures", both_ready);
    assert_eq!((first.state("view"), first.state("fov")), (&"Side by side".into(), &40.0.into()));
    let [_, _, right, bottom] = first.rect("picture");
    assert!(
        (right, bottom) <= (900.0, 640.0) && right > 880.0 && bottom > 600.0,
        "without the panel: {right} {bottom}"
    );
    screen.focus("Visavis");
    screen.chord(&[Screen::CONTROL, Screen::SHIFT, u32::from('s')]);
    let saved = viewer.wait_for("the session's file", |f| says(f, "Saved "));
    let message = saved.state("message").as_str().expect("a line");
    let saved = std::fs::read_to_string(message.trim_start_matches("Saved ")).expect("the session");
    for line in
        ["segments = 9", "spp = 2", "show = \"side\"", "size = [900, 640]", "theme = \"light\"", "panel = false"]
    {
        assert!(saved.lines().any(|known| known == line), "{line} is not in {saved}");
    }
}

/// As a session of the desktop's ends: nobody closes the window.
#[cfg(unix)]
#[test]
fn a_window_that_the_system_ends_remembers_its_size() {
    use std::os::unix::process::ExitStatusExt;
    let _alone = alone();
    let (screen, folder) = (Screen::start(1280, 720), TestFolder::new());
    let binary = Path::new(env!("CARGO_BIN_EXE_visavis"));
    let variables = [("WINIT_X11_SCALE_FACTOR", Some("1"))];
    let mut viewer = ViewerUnderTest::start_keeping(binary, &screen, &variables, &["cornell"], folder.path());
    viewer.wait_for("both pictures", both_ready);
    let window = screen.focus("Visavis");
    screen.resize(window, 900, 640);
    viewer.wait_for("the smaller window", |f| f.rect("picture")[3] > 600.0 && f.rect("picture")[3] <= 640.0);
    let process = rustix::process::Pid::from_raw(viewer.id() as i32).expect("a process");
    rustix::process::kill_process(process, rustix::process::Signal::TERM).expect("a signal");
    assert_eq!(viewer.wait_for_end().signal(), Some(15));

    let mut next = ViewerUnderTest::start_keeping(binary, &screen, &variables, &["cornell"], folder.path());
    let again = next.wait_for("both pictures", both_ready);
    let [_, _, _, bottom] = again.rect("picture");
    assert!(bottom > 600.0 && bottom <= 640.0, "as it was left: {bottom}");
}
