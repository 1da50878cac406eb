//! Sessions: saved, opened again, refused, and beside a scene that changes.

use super::files::{commands, fov, write};
use super::{User, both_whole, says};
use egui::{Key, Modifiers};
use std::path::{Path, PathBuf};
use technique::TechniqueName;
use visavis::model::{PaneId, Resolution, SavedSession, Session};
use visavis_tests::Frame;

/// All that a session keeps, as it is now.
fn state_of(user: &mut User) -> SavedSession {
    let mut state = None;
    user.change(|model| state = Some(SavedSession::of(model, None)));
    state.expect("a model")
}

/// Fakes alone: samples would be counted while they come.
fn of_fakes(user: &mut User) {
    user.change(|model| model.session.panes[PaneId::B].technique = TechniqueName::Raster);
}

/// Both pictures are the fake as taught, which none is at first.
fn are_taught(frame: &Frame) -> bool {
    let taught = |pane: &str| frame.state(pane)["label"].as_str().is_some_and(|label| label.contains("as-taught"));
    both_whole(frame) && taught("a") && taught("b")
}

/// Saves by the menu.
fn save(user: &mut User, file: &Path) {
    user.click("Export");
    let menu = user.click("Session");
    assert!(!menu.shows("copy picture") && !menu.shows("format EXR linear"), "of pictures");
    user.type_into("File", &file.display().to_string());
    user.click("Save");
    user.wait_for("the session's file", |f| says(f, "Saved ") && file.is_file());
}

#[test]
fn a_session_that_was_saved_opens_as_it_was_with_the_same_pictures() {
    let mut user = User::of("whitted");
    of_fakes(&mut user);
    user.key(Key::Num4);
    let first = user.wait_for("both pictures", both_whole);
    user.wheel(first.point("picture", 0.3, 0.5), Modifiers::NONE);
    user.change(|model| {
        model.document.changes.refraction_ratio = Some(1.0 / 3.0);
        model.document.bookmarks.push(model.document.scene.camera);
        model.session.resolution = Resolution::Half;
        model.session.panes[PaneId::A].fake.knobs.segments = Some(7);
        model.session.panes[PaneId::B].truth.spp = 77;
        model.session.panes.values_mut().for_each(|pane| pane.fake.fake = raster::Fake::AsTaught);
        model.session.plots.open = true;
    });
    user.wait_for("both pictures", are_taught);
    let (made, kept) = (commands(&mut user), state_of(&mut user));
    let file = user.file("lecture.toml");
    save(&mut user, &file);

    user.open("cornell");
    user.change(|model| model.session = Session::default());
    user.wait_for("another scene", |f| f.state("scene") == "cornell");
    assert_eq!(user.hover_file(Some(&file)).value("drop"), "Drop to open lecture.toml, a scene or a session");
    user.hover_file(None);
    user.drop_file(&file);
    let said = |f: &Frame| says(f, "Opened the session ") && says(f, "lecture.toml of whitted");
    user.wait_for("the session", |f| f.state("scene") == "whitted" && said(f) && are_taught(f));
    assert_eq!(state_of(&mut user), kept);
    assert_eq!(commands(&mut user), made, "the pictures are others");
    let menu = user.click("Scene: whitted");
    assert!(menu.shows("recent lecture.toml"), "it is among the files opened before");
}

#[test]
fn a_picture_as_seen_opens_as_the_session_in_which_it_was_seen() {
    let mut user = User::of("whitted");
    of_fakes(&mut user);
    user.change(|model| {
        model.document.bookmarks.push(model.document.camera.orbited(0.1, 0.1));
        model.session.resolution = Resolution::Half;
        model.session.panes[PaneId::B].truth.spp = 77;
        model.session.comparison.held[0] = Some(0.3);
        model.session.plots.over = visavis::model::Cost::Seconds;
        model.session.panes.values_mut().for_each(|pane| pane.fake.fake = raster::Fake::AsTaught);
    });
    user.wait_for("both pictures", are_taught);
    let (made, kept) = (commands(&mut user), state_of(&mut user));
    let file = user.file("seen.png");
    user.export_as_seen(&file);
    user.open("cornell");
    user.change(|model| model.session = Session::default());
    user.wait_for("another scene", |f| f.state("scene") == "cornell");
    user.drop_file(&file);
    user.wait_for("the picture", |f| says(f, "whitted as") && says(f, "seen.png shows it") && are_taught(f));
    assert_eq!(state_of(&mut user), kept);
    assert_eq!(commands(&mut user), made, "the pictures are others");
}

#[test]
fn a_faulty_session_is_refused_with_its_place_and_the_running_one_stays() {
    let mut user = User::of("cornell");
    of_fakes(&mut user);
    user.wait_for("both pictures", both_whole);
    user.change(|model| model.session.panes.values_mut().for_each(|pane| pane.fake.fake = raster::Fake::AsTaught));
    user.wait_for("both pictures", are_taught);
    let before = (commands(&mut user), state_of(&mut user));
    let huge = format!("session = 1\n#{}", " ".repeat(1 << 20));
    for (text, said) in [
        ("session = 1\nscene = \"whitted\"\n[panes.A]\nsegments = 0\n", "bad.toml:4:12: segments=0: expected"),
        ("session = 1\nscene = \"whitted\"\n[camera]\nfov = 300\n", "bad.toml:4:7: fov: expected degrees"),
        (
            "session = 1\nscene = \"whitted\"\n[camera]\neye = [0, 0, 0]\ntarget = [0, 0, 0]\n",
            "bad.toml:3:1: this camera",
        ),
        ("session = 1\nscene = \"none.toml\"\n", "the scene of "),
        ("session = 9\nscene = \"whitted\"\n", "bad.toml:1:11: this session is of version 9"),
        ("session = 1\nscene = \"whitted\"\n[view\n", "bad.toml:3:6: "),
        (&huge, "a session has at most 1048576 bytes"),
    ] {
        let file = user.file("bad.toml");
        std::fs::write(&file, text).expect("a file");
        user.drop_file(&file);
        user.wait_for(said, |f| says(f, said));
        assert_eq!((commands(&mut user), state_of(&mut user)), before, "{said}");
    }
}

/// A session of a scene's file in a folder of its own, and both.
fn session_of_a_file(user: &mut User) -> (PathBuf, PathBuf) {
    let folder = user.file("course");
    std::fs::create_dir_all(folder.join("scenes")).expect("a folder");
    let (scene, session) = (folder.join("scenes/box.toml"), folder.join("lecture.toml"));
    write(&scene, "40");
    user.drop_file(&scene);
    user.wait_for("the scene of the file", |f| f.state("scene") == "box" && both_whole(f));
    user.change(|model| model.session.panes[PaneId::A].fake.knobs.segments = Some(7));
    save(user, &session);
    (scene, session)
}

#[test]
fn a_session_follows_its_scenes_file_and_stays_what_it_is() {
    let mut user = User::of("whitted");
    of_fakes(&mut user);
    let (_, session) = session_of_a_file(&mut user);
    let text = std::fs::read_to_string(&session).expect("the session");
    assert!(text.contains("scene = \"scenes/box.toml\""), "{text}");

    // both are moved, and what is read is the scene beside the session
    let moved = user.file("moved");
    std::fs::rename(session.parent().expect("a folder"), &moved).expect("a move");
    let (scene, session) = (moved.join("scenes/box.toml"), moved.join("lecture.toml"));
    user.open("whitted");
    user.wait_for("another scene", |f| f.state("scene") == "whitted");
    user.drop_file(&session);
    // which is said for six seconds, and on a busy machine the pictures come later
    user.wait_for("the session", |f| f.state("scene") == "box" && says(f, "Opened the session"));
    let open = user.wait_for("its pictures", both_whole);
    let moved_to = user.wheel(open.point("picture", 0.3, 0.5), Modifiers::NONE);
    let kept = state_of(&mut user);
    let text = std::fs::read_to_string(&scene).expect("the scene");
    std::fs::write(&scene, text.replace("[30, 30, 30]", "[10, 10, 10]")).expect("a file");
    user.wait_for("the other version", |f| says(f, "box.toml again"));
    let read = user.wait_for("its pictures", both_whole);
    assert_eq!((state_of(&mut user), fov(&read)), (kept, fov(&moved_to)));

    // opened once more it tells that its scene is another
    user.drop_file(&session);
    user.wait_for("the note", |f| says(f, "its scene has changed since ") && says(f, "lecture.toml was made"));
    assert_eq!(state_of(&mut user).session.panes[PaneId::A].fake.knobs.segments, Some(7));
}

#[test]
fn the_key_saves_sessions_beside_each_other_and_over_none() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    let folder = user.file("kept");
    std::fs::create_dir(&folder).expect("a folder");
    user.change(|model| model.state.export.file = folder.display().to_string());
    let names = || -> Vec<_> {
        let names = std::fs::read_dir(&folder).expect("the folder").flatten().map(|entry| entry.file_name());
        let names = names.map(|name| name.to_string_lossy().into_owned());
        names.filter(|name| !name.contains("partial")).collect()
    };
    for count in 1..=2 {
        user.key_with(Key::S, Modifiers::COMMAND | Modifiers::SHIFT);
        user.wait_for("a session more", |f| names().len() == count && says(f, "Saved "));
    }
    let names = names();
    assert!(
        names.iter().all(|name| name.starts_with("visavis-cornell-session") && name.ends_with(".toml")),
        "{names:?}"
    );
}
