//! Another program's picture in a pane: shown, measured, kept in sessions.

use super::{User, both_whole, says};
use film::{DisplayTransform, Image, Vec3};
use image_file::Kind;
use std::io::Write;
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use technique::TechniqueName;
use visavis::model::{COMPARE, CompareWith, PaneId, PaneSource, SWEEP, SavedSession};
use visavis_tests::Frame;

const SCENE: &str = "hard/light-touching-wall";

fn grey(size: (u32, u32), grey: f32) -> Image {
    Image::new(size.0, size.1, vec![Vec3::splat(grey); (size.0 * size.1) as usize]).expect("pixels")
}

fn write(file: &Path, image: &Image) {
    let bytes = image_file::encode(Kind::Exr, image, &DisplayTransform::default(), &Vec::new()).expect("an EXR");
    std::fs::write(file, bytes).expect("a file");
}

fn follow(user: &mut User, pane: PaneId, file: &Path) {
    let source = PaneSource::of_file(file).expect("a picture's name");
    user.change(|model| model.session.set_source(pane, source));
}

fn size(frame: &Frame) -> [u64; 2] {
    [0, 1].map(|side| frame.state("picture_size")[side].as_u64().expect("a size"))
}

fn of_size(sides: [u64; 2]) -> impl Fn(&Frame) -> bool {
    move |frame| size(frame) == sides && both_whole(frame)
}

/// A port that nobody listens on.
fn free_port() -> u16 {
    TcpListener::bind(("127.0.0.1", 0)).and_then(|listener| listener.local_addr()).expect("a port").port()
}

/// A packet of tev's protocol.
fn packet(kind: u8, payload: &[&[u8]]) -> Vec<u8> {
    let payload = payload.concat();
    [&(payload.len() as u32 + 5).to_le_bytes()[..], &[kind], &payload].concat()
}

fn numbers(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A picture of one channel begins.
fn begin(width: i32, height: i32) -> Vec<u8> {
    packet(4, &[b"\x01mine\0", &numbers(&[width, height, 1]), b"Y\0"])
}

/// All of it in one grey.
fn tile(width: i32, height: i32, grey: f32) -> Vec<u8> {
    let values: Vec<u8> = (0..width * height).flat_map(|_| grey.to_le_bytes()).collect();
    packet(3, &[b"\0mine\0Y\0", &numbers(&[0, 0, width, height]), &values])
}

#[test]
fn what_a_program_sends_is_measured_against_the_other_pane_at_its_own_size() {
    let mut user = User::of(SCENE);
    let first = user.wait_for("both pictures", both_whole);
    assert_ne!(size(&first), [60, 40]);
    let port = free_port();
    user.change(|model| model.session.set_source(PaneId::B, PaneSource::Received(port)));
    let waiting = user.wait_for("nothing yet", |f| f.value("label fault B").contains("no picture yet"));
    assert!(waiting.value("label fault B").contains(&format!("127.0.0.1:{port}")));
    let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
    stream.write_all(&begin(60, 40)).expect("a packet");
    stream.write_all(&tile(60, 40, 0.5)).expect("a packet");
    let shown = user.wait_for("the picture, and A at its size", |f| {
        of_size([60, 40])(f) && f.state("b")["changes"] == 1 && f.state("b")["rel_mse"].is_f64()
    });
    assert!(shown.value("label B").starts_with("B: mine\n60 x 40 pixels"), "{}", shown.value("label B"));
    assert!(shown.value("label A").contains("differs from B"), "{}", shown.value("label A"));
    // what is in the middle is shown in whole pixels: 720 points are less than 18 times 40 and the bar
    let [left, top, right, bottom] = shown.rect("picture");
    assert_eq!(((right - left) % 60.0, (bottom - top) % 40.0), (0.0, 0.0));

    stream.write_all(&tile(60, 40, 0.25)).expect("a packet");
    let before = shown.state("b")["rel_mse"].as_f64();
    user.wait_for("the next", |f| f.state("b")["changes"] == 2 && f.state("b")["rel_mse"].as_f64() != before);

    stream.write_all(b"nonsense").expect("bytes");
    let closed = |f: &Frame| says(f, "B: the connection from 127.0.0.1:") && says(f, "was closed");
    let closed = user.wait_for("the line", closed);
    assert!(of_size([60, 40])(&closed) && closed.state("b")["external"] == "mine", "the picture stays");

    user.click_nth("Fake", 1);
    let made = user.wait_for("B made here", |f| f.state("b")["external"].is_null() && size(f) == size(&first));
    assert!(made.state("b")["fault"].is_null());
    let start = std::time::Instant::now();
    while TcpStream::connect(("127.0.0.1", port)).is_ok() {
        assert!(start.elapsed().as_secs() < 60, "it still listens");
    }
}

#[test]
fn a_receiver_outlives_a_visit_to_the_sweep_unless_the_pane_is_made_here_again() {
    let mut user = User::of(SCENE);
    let port = free_port();
    user.change(|model| model.session.set_source(PaneId::B, PaneSource::Received(port)));
    user.wait_for("nothing yet", |f| f.value("label fault B").contains("no picture yet"));
    let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
    stream.write_all(&[begin(24, 16), tile(24, 16, 0.5)].concat()).expect("packets");
    user.wait_for("the picture", |f| of_size([24, 16])(f) && f.state("b")["changes"] == 1);
    let in_the_sweep = |user: &mut User, open| {
        user.change(|model| model.session.workspace = if open { SWEEP } else { COMPARE });
        user.wait_for("the other workspace", |f| f.state("sweep")["open"] == open);
    };
    in_the_sweep(&mut user, true);
    stream.write_all(&tile(24, 16, 0.25)).expect("a packet meanwhile");
    in_the_sweep(&mut user, false);
    let back = user.wait_for("both tiles", |f| of_size([24, 16])(f) && f.state("b")["changes"] == 2);
    assert!(!says(&back, "closed"), "{back:?}");
    stream.write_all(&tile(24, 16, 0.125)).expect("a packet");
    user.wait_for("the third", |f| f.state("b")["changes"] == 3);

    in_the_sweep(&mut user, true);
    user.change(|model| model.session.set_source(PaneId::B, PaneSource::Made));
    let start = std::time::Instant::now();
    while TcpStream::connect(("127.0.0.1", port)).is_ok() {
        user.frame();
        assert!(start.elapsed().as_secs() < 60, "it still listens");
    }
}

#[test]
fn a_followed_file_is_measured_against_the_reference_and_again_when_it_is_written() {
    let mut user = User::of(SCENE);
    let file = user.file("mine.exr");
    write(&file, &grey((24, 16), 0.5));
    user.change(|model| {
        model.session.comparison.with = CompareWith::Reference;
        model.session.panes[PaneId::A].technique = TechniqueName::Raster;
    });
    follow(&mut user, PaneId::B, &file);
    let measured = |f: &Frame| f.state("b")["rel_mse"].as_f64();
    let first = user.wait_for("its error", |f| size(f) == [24, 16] && measured(f).is_some());
    assert!(first.value("label B").contains("against the reference"), "{}", first.value("label B"));
    write(&file, &grey((24, 16), 9.0));
    let worse = user.wait_for("another error", |f| measured(f) > measured(&first).map(|error| 4.0 * error));
    assert_eq!(worse.state("b")["changes"], 1);
    // of another size: all follow
    write(&file, &grey((30, 30), 0.5));
    user.wait_for("another size", |f| size(f) == [30, 30] && f.state("b")["changes"] == 2 && measured(f).is_some());
    std::fs::write(&file, b"half").expect("a file");
    let broken = user.wait_for("the line", |f| says(f, "B: ") && says(f, "mine.exr"));
    assert!(size(&broken) == [30, 30] && broken.state("b")["external"] == "mine.exr", "the picture stays");
}

#[test]
fn pictures_of_two_programs_of_two_sizes_are_shown_and_said_not_to_be_measured() {
    let mut user = User::of(SCENE);
    let (one, other) = (user.file("one.exr"), user.file("other.exr"));
    write(&one, &grey((24, 16), 0.5));
    write(&other, &grey((12, 8), 0.5));
    follow(&mut user, PaneId::A, &one);
    follow(&mut user, PaneId::B, &other);
    let told = "it has 12x8 pixels, and what is seen 24x16: not measured";
    let said = user.wait_for("both", |f| size(f) == [24, 16] && f.value("label B").contains(told));
    assert!(said.state("b")["rel_mse"].is_null());
    user.click("Error map");
    user.wait_for("why there is none", |f| f.value("label no map").contains("B has 12x8 pixels"));
}

#[test]
fn a_session_keeps_a_followed_picture_as_its_folder_finds_it() {
    let mut user = User::of(SCENE);
    let (file, session) = (user.file("mine.exr"), user.file("lecture.toml"));
    write(&file, &grey((24, 16), 0.5));
    follow(&mut user, PaneId::B, &file);
    user.wait_for("the picture", of_size([24, 16]));
    user.click("Export");
    user.click("Session");
    user.type_into("File", &session.display().to_string());
    user.click("Save");
    user.wait_for("the session's file", |f| says(f, "Saved ") && session.is_file());
    let text = std::fs::read_to_string(&session).expect("a session");
    assert!(text.contains("\npicture = \"mine.exr\"\n"), "{text}");
    let mut kept = None;
    user.change(|model| {
        kept = Some(SavedSession::of(model, None).session.sources);
        model.session.set_source(PaneId::B, PaneSource::Made);
    });
    user.wait_for("B made here", |f| f.state("b")["external"].is_null());
    user.drop_file(&session);
    user.wait_for("the picture again", |f| f.state("b")["external"] == "mine.exr" && size(f) == [24, 16]);
    user.change(|model| assert_eq!(Some(&model.session.sources), kept.as_ref()));
}

#[test]
fn an_export_says_that_no_command_makes_it() {
    let mut user = User::of(SCENE);
    let (file, alone, seen) = (user.file("mine.exr"), user.file("alone.exr"), user.file("seen.png"));
    let image = grey((24, 16), 0.5);
    write(&file, &image);
    follow(&mut user, PaneId::B, &file);
    user.wait_for("the picture", of_size([24, 16]));
    let menu = user.click("Export");
    assert!(menu.shows("command A") && !menu.shows("command B"));
    user.click("B alone");
    user.type_into("File", &alone.display().to_string());
    user.click("Save");
    user.wait_for("the file", |f| says(f, "Saved ") && alone.is_file());
    assert_eq!(image_file::load(&alone).expect("a picture"), image);
    let record = |file: &PathBuf, name: &str| {
        let records = image_file::records(file).expect("records");
        records.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
    };
    assert_eq!(record(&alone, "command"), None);
    assert!(record(&alone, "picture").is_some_and(|told| told.contains("another program mine.exr, read from ")));
    user.export_as_seen(&seen);
    assert!(record(&seen, "A").is_some_and(|told| told.starts_with("visavis render ")));
    assert!(record(&seen, "B").is_some_and(|told| told.starts_with("the picture of another program mine.exr")));
    // and opens with the session that it was seen in
    user.change(|model| model.session.set_source(PaneId::B, PaneSource::Made));
    user.drop_file(&seen);
    user.wait_for("as it was seen", |f| says(f, "seen.png shows it") && f.state("b")["external"] == "mine.exr");
}

#[test]
fn the_card_of_a_pane_chooses_and_undo_takes_it_back() {
    let mut user = User::of(SCENE);
    user.wait_for("both pictures", both_whole);
    let (file, port) = (user.file("mine.png"), free_port());
    let image = image_file::encode(Kind::Png, &grey((24, 16), 0.5), &DisplayTransform::default(), &Vec::new());
    std::fs::write(&file, image.expect("a PNG")).expect("a file");
    user.click_in("B", "Another program's picture");
    user.click_in("B", "Picture of B: a file");
    user.type_into("Picture file of B", "mine.gif");
    user.click("Follow the picture file of B");
    user.wait_for("the refusal", |f| says(f, "ends in .png or .exr"));
    user.type_into("Picture file of B", &file.display().to_string());
    user.click("Follow the picture file of B");
    user.wait_for("the picture", |f| f.state("b")["external"] == "mine.png" && size(f) == [24, 16]);
    user.click("Picture of B: received");
    user.change(|model| {
        assert_eq!(model.session.source(PaneId::B), &PaneSource::Received(14158));
        model.session.set_source(PaneId::B, PaneSource::Received(port));
    });
    let waits = user.wait_for("nothing yet", |f| f.value("label fault B").contains("no picture yet"));
    assert_eq!(waits.value("B port"), port.to_string());
    user.click("Picture of B: made here");
    user.wait_for("B made here", |f| f.state("b")["external"].is_null() && both_whole(f));
    user.change(|model| {
        (0..3).for_each(|_| model.undo());
        let source = model.session.source(PaneId::B).clone();
        assert!(matches!(source, PaneSource::Followed(_)), "{source:?}");
    });
    user.wait_for("the picture", |f| f.state("b")["external"] == "mine.png");
}
