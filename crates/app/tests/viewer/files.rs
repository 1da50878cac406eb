//! Files that are opened, dropped, changed on disk and remembered.

use super::export::export;
use super::{User, both_whole, says};
use egui::{Key, Modifiers};
use std::path::Path;
use std::time::{Duration, Instant};
use visavis::model::{CompareWith, ComparisonSettings, PaneId};
use visavis::viewer::Place;
use visavis_tests::Frame;

/// A scene with a field of view of so many degrees.
pub fn write(file: &Path, fov: &str) {
    let cornell = scene::builtin::text("cornell").expect("a built-in scene");
    assert!(cornell.contains("fov_y = 45"));
    std::fs::write(file, cornell.replace("fov_y = 45", &format!("fov_y = {fov}"))).expect("a file");
}

pub fn fov(frame: &Frame) -> f64 {
    frame.state("fov").as_f64().expect("a number")
}

/// A user who has opened a scene's file, and the file.
fn user_of_a_file(fov: &str) -> (User, std::path::PathBuf) {
    let mut user = User::of("whitted");
    let file = user.file("box.toml");
    write(&file, fov);
    user.drop_file(&file);
    user.wait_for("the scene of the file", |f| f.state("scene") == "box" && both_whole(f));
    (user, file)
}

#[test]
fn a_scene_that_changes_on_disk_is_shown_again_and_a_fault_stays_until_it_is_mended() {
    let (mut user, file) = user_of_a_file("40");
    write(&file, "50");
    let read = user.wait_for("the other version", |f| fov(f) == 50.0);
    assert!(says(&read, "Read ") && says(&read, "box.toml again"), "{}", read.state("message"));

    let middle = read.point("picture", 0.3, 0.5);
    let moved = user.wheel(middle, Modifiers::NONE);
    let framed = user.key(Key::Num4);
    assert_ne!(moved.state("eye"), read.state("eye"));
    user.wait_for("both pictures", both_whole);
    user.drop_file(Path::new("bunny.stl"));
    write(&file, "many");
    let faulty = user.wait_for("the fault", |f| f.state("scene_fault").is_string());
    let fault = faulty.state("scene_fault").as_str().expect("a line").to_owned();
    assert_eq!(faulty.value("fault"), fault, "what was said before goes");
    assert!(fault.contains("box.toml:") && fault.split(':').nth(2).is_some(), "{fault}");
    for key in [Key::P, Key::P, Key::Num3, Key::Num4] {
        user.key(key);
    }
    let still = user.wait_for("the fault in sight", |f| f.value("fault") == fault);
    let ready = ["a", "b"].map(|pane| still.state(pane)["ready"] == true);
    assert_eq!(ready, [true; 2], "the pictures of before are still there");

    write(&file, "60");
    let mended = user.wait_for("the mended version", |f| f.state("scene_fault").is_null() && both_whole(f));
    assert_eq!(mended.state("view"), framed.state("view"));
    let eye = |frame: &Frame| frame.state("eye").as_array().expect("a point").clone();
    assert_eq!(eye(&mended), eye(&still), "a camera that was moved stays");
}

#[test]
fn what_is_asked_to_be_read_again_says_what_came_of_it() {
    let (mut user, _file) = user_of_a_file("40");
    user.key_with(Key::R, Modifiers::COMMAND);
    user.wait_for("the answer", |f| says(f, "box.toml again: nothing has changed"));
    // one user at a time
    drop(user);
    let mut built_in = User::of("cornell");
    built_in.key_with(Key::R, Modifiers::COMMAND);
    built_in.wait_for("the answer", |f| says(f, "cornell is built in"));
}

#[test]
fn a_dropped_picture_is_shown_again_as_it_was_made() {
    let mut user = User::of("whitted");
    user.wait_for("both pictures", both_whole);
    let taught = |frame: &Frame| frame.state("a")["label"].as_str().is_some_and(|label| label.contains("taught"));
    user.set_slider("Refraction ratio", 0.6);
    user.click_in("A", "as-taught");
    // made after both changes
    let first = user.wait_for("both pictures", |f| both_whole(f) && taught(f));
    let picture = user.file("taught.png");
    export(&mut user, &["A alone"], &picture);

    user.click("Scene: whitted");
    user.click("cornell");
    user.wait_for("another scene", |f| f.state("scene") == "cornell" && both_whole(f));
    user.click_in("A", "fair");
    let announced = user.hover_file(Some(&picture));
    assert_eq!(announced.value("drop"), "Drop to see again what taught.png shows");
    assert!(!user.hover_file(None).shows("drop"));
    user.drop_file(&picture);
    let whole = |f: &Frame| f.state("a")["ready"] == true && f.state("a")["rough"] == false;
    let again = user.wait_for("what it shows", |f| f.state("scene") == "whitted" && whole(f) && taught(f));
    assert_eq!(again.state("view"), "A", "it is shown alone");
    assert!(says(&again, "Opened whitted as") && says(&again, "taught.png shows it"), "{}", again.state("message"));
    assert_eq!(again.value("refraction ratio"), "0.6");
    assert_eq!(again.state("a")["label"], first.state("a")["label"]);
    assert_eq!(again.value("A fake as-taught"), "true");
}

/// Commands that make the pictures of both panes: camera, size and settings.
pub fn commands(user: &mut User) -> [String; 2] {
    let menu = user.click("Export");
    let commands = ["A", "B"].map(|pane| menu.value(&format!("command {pane}")).to_owned());
    user.click("Export");
    assert!(commands.iter().all(|command| command.starts_with("visavis render ")), "{commands:?}");
    commands
}

#[test]
fn a_picture_as_seen_comes_back_with_the_camera_that_made_it_narrow_or_high() {
    // side by side in a window that is wider than high, and one picture in one that is higher than wide
    for (size, view) in [([1280.0, 720.0], Key::Num4), ([700.0, 900.0], Key::Num3)] {
        let mut user = User::beside("whitted", size.into(), 1.0, technique::DeviceChoice::Cpu);
        // samples would be counted while they come
        user.change(|model| model.session.panes[PaneId::B].technique = technique::TechniqueName::Raster);
        user.key(view);
        let first = user.wait_for("both pictures", both_whole);
        let (made, shown) = (commands(&mut user), first.state("view").clone());
        let (seen, one) = (user.file("seen.png"), user.file("one.png"));
        user.export_as_seen(&seen);
        export(&mut user, &["A alone"], &one);
        for (file, words) in [(&seen, "seen.png shows it"), (&one, "one.png shows it")] {
            user.drop_file(file);
            let again = user.wait_for("it again", |f| says(f, words));
            assert_eq!(fov(&again), fov(&first), "{words} at {size:?}");
        }
        user.drop_file(&seen);
        user.wait_for("both again", |f| *f.state("view") == shown && both_whole(f));
        assert_eq!(commands(&mut user), made, "the pictures are others at {size:?}");
    }
}

#[test]
fn pictures_of_the_view_before_are_exported_with_the_camera_that_made_them() {
    let mut user = User::of("whitted");
    user.change(|model| model.session.panes[PaneId::B].technique = technique::TechniqueName::Raster);
    let whole = user.wait_for("both pictures", both_whole);
    let seen = user.file("seen.png");
    // halves show more above and below, and are still being drawn
    user.key(Key::Num4);
    user.export_as_seen(&seen);
    user.drop_file(&seen);
    let again = user.wait_for("it again", |f| says(f, "seen.png shows it"));
    assert_eq!(fov(&again), fov(&whole));
}

#[test]
fn a_map_of_errors_comes_back_as_it_was() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    let seen = user.file("map.png");
    let with = |user: &mut User, change: fn(&mut ComparisonSettings)| {
        user.change(|model| change(&mut model.session.comparison));
    };
    with(&mut user, |comparison| {
        (comparison.with, comparison.of) = (CompareWith::Reference, PaneId::B);
        comparison.metric = compare::ErrorMetric::Relative;
        comparison.held[compare::ErrorMetric::Relative as usize] = Some(0.25);
    });
    user.key(Key::Num5);
    let before = user.comparison();
    user.export_as_seen(&seen);
    with(&mut user, |comparison| *comparison = ComparisonSettings::default());
    user.key(Key::Num3);
    user.drop_file(&seen);
    user.wait_for("the map", |f| says(f, "map.png shows it") && f.state("view") == "Error map");
    assert_eq!(user.comparison(), before);
}

#[test]
fn other_files_that_are_dropped_are_compared_with_or_refused_with_a_word() {
    let mut user = User::of("cornell");
    let whole = user.wait_for("both pictures", both_whole);
    let size = whole.state("picture_size");
    let [width, height] = [0, 1].map(|side| size[side].as_u64().expect("pixels") as u32);
    let (foreign, png) = (user.file("foreign.exr"), user.file("foreign.png"));
    let pixels = vec![film::Vec3::ONE; (width * height) as usize];
    let image = film::Image::new(width, height, pixels).expect("an image");
    for file in [&foreign, &png] {
        let kind = image_file::Kind::of(file).expect("a kind");
        let bytes = image_file::encode(kind, &image, &film::DisplayTransform::default(), &Vec::new());
        std::fs::write(file, bytes.expect("a picture")).expect("a file");
    }
    user.drop_file(&png);
    user.wait_for("the refusal", |f| says(f, "does not say how it was made"));
    user.drop_file(Path::new("bunny.stl"));
    user.wait_for("the refusal", |f| says(f, "bunny.stl is neither a scene (.toml), nor a model"));
    user.drop_file(&foreign);
    user.wait_for("the reference", |f| f.state("reference")[1] == 1 && says(f, "compared with"));
}

/// A picture of this size as a reference of what `shot` shows, which is not good for more.
fn write_reference(file: &Path, shot: &technique::Shot) {
    let pixels = vec![film::Vec3::ONE; (shot.size.0 * shot.size.1) as usize];
    let image = film::Image::new(shot.size.0, shot.size.1, pixels).expect("an image");
    let made = reference::Reference { image, replicates: 64, seconds: 1.0, nonfinite: 0 };
    std::fs::write(file, made.encode(reference::records(shot)).expect("an EXR")).expect("a file");
}

fn picture_size(frame: &Frame) -> (u32, u32) {
    let side = |index: usize| frame.state("picture_size")[index].as_u64().expect("pixels") as u32;
    (side(0), side(1))
}

#[test]
fn a_reference_opens_its_scene_and_camera_and_is_compared_with() {
    let mut user = User::of("whitted");
    user.key(Key::Num4);
    let open = user.wait_for("both pictures", |f| both_whole(f) && f.state("view") == "Side by side");
    // as a window has seen it side by side, which shows more above and below
    let scene = scene::builtin::named("cornell").expect("a scene");
    let mut shot = technique::Shot::of(scene, picture_size(&open));
    (shot.source, shot.camera) = ("cornell".into(), shot.camera.orbited(0.2, 0.0).zoomed(0.5));
    let file = user.file("truth.exr");
    write_reference(&file, &shot);
    user.drop_file(&file);
    let compared = |f: &Frame| f.state("reference")[1] == 1 && says(f, "compared with") && says(f, "truth.exr");
    let seen = user.wait_for("the reference", |f| f.state("scene") == "cornell" && compared(f) && both_whole(f));
    let [command, _] = commands(&mut user);
    let number = |name: &str| -> f32 {
        let (_, behind) = command.split_once(name).expect("an option");
        behind.split(' ').next().expect("a value").parse().expect("a number")
    };
    assert!((number("--fov ") - shot.camera.fov_y).abs() < 1e-3, "{command} shows {}", shot.camera.fov_y);
    let eye = seen.state("eye")[0].as_f64().expect("a number") as f32;
    assert_eq!(eye, shot.camera.eye.x);

    // what is seen already is not opened again
    let scenes_opened = |user: &mut User| {
        let mut opened = 0;
        user.change(|model| opened = model.document.opened);
        opened
    };
    let before = scenes_opened(&mut user);
    user.change(|model| model.session.comparison.with = CompareWith::EachOther);
    user.drop_file(&file);
    user.wait_for("the reference again", |f| f.state("reference")[1] == 1 && says(f, "compared with"));
    assert_eq!(scenes_opened(&mut user), before);

    // another size: the scene and the camera alone
    shot.size = (8, 8);
    write_reference(&file, &shot);
    user.change(|model| model.session.comparison.with = CompareWith::EachOther);
    user.open("whitted");
    user.wait_for("another scene", |f| f.state("scene") == "whitted");
    user.drop_file(&file);
    user.wait_for("the scene", |f| f.state("scene") == "cornell" && says(f, "the reference has 8x8 pixels"));
    assert_eq!(user.comparison().with, CompareWith::EachOther);
}

#[test]
fn a_reference_that_does_not_fit_changes_nothing_and_names_the_cure() {
    let mut user = User::of("cornell");
    let whole = user.wait_for("both pictures", both_whole);
    let (width, height) = picture_size(&whole);
    let (small, map, cut) = (user.file("small.exr"), user.file("map.exr"), user.file("cut.exr"));
    let image = film::Image::new(8, 8, vec![film::Vec3::ONE; 64]).expect("an image");
    let write = |file: &Path, records: image_file::Records| {
        let display = film::DisplayTransform::default();
        let bytes = image_file::encode(image_file::Kind::Exr, &image, &display, &records).expect("a picture");
        std::fs::write(file, bytes).expect("a file");
    };
    write(&small, Vec::new());
    write(&map, vec![("map", "A - reference".into()), ("colours", "signed".into())]);
    std::fs::write(&cut, "no picture").expect("a file");
    let cure = format!("visavis reference cornell -o reference.exr --size {width}x{height}");
    for (file, words) in [(&small, cure.as_str()), (&map, "a map of errors"), (&cut, "cut.exr")] {
        user.drop_file(file);
        user.wait_for(words, |f| says(f, words));
        assert_eq!(user.comparison(), ComparisonSettings::default(), "{}", file.display());
    }
}

#[test]
fn what_is_probably_not_meant_is_said_of_a_scene_that_was_read_again() {
    let (mut user, file) = user_of_a_file("40");
    let text = std::fs::read_to_string(&file).expect("the file");
    std::fs::write(&file, text.replace("fov_y = 40", "fov_y = 41").replace("[30, 30, 30]", "[0, 0, 0]"))
        .expect("a file");
    let read = user.wait_for("the other version", |f| fov(f) == 41.0);
    let notes = scene::builtin::named(file.to_str().expect("a plain path")).expect("a scene").notes();
    assert!(!notes.is_empty());
    for line in notes {
        assert!(says(&read, &line) && says(&read, "box.toml again"), "{}", read.state("message"));
    }
}

#[test]
fn files_that_were_opened_are_offered_again_until_they_are_gone() {
    let (mut user, file) = user_of_a_file("40");
    write(&user.file("other.toml"), "30");
    user.wait_for("the folder's scenes", |f| f.state("neighbours") == 2);
    let menu = user.click("Scene: box");
    assert!(menu.shows("beside box.toml") && menu.shows("beside other.toml") && menu.shows("recent box.toml"));
    user.click("other.toml");
    user.wait_for("the one beside it", |f| f.state("scene") == "other");
    std::fs::remove_file(&file).expect("the file");
    user.wait_for("the folder without it", |f| f.state("neighbours") == 1);
    user.click("Scene: other");
    user.click("box.toml");
    let told = user.wait_for("the refusal", |f| says(f, "no longer among the files opened before"));
    assert_eq!(told.state("scene"), "other");
    assert!(!user.click("Scene: other").shows("recent box.toml"));
}

#[test]
fn built_in_scenes_are_offered_with_their_pictures_which_take_their_room_before_they_are_there() {
    let mut user = User::of("cornell");
    let before = user.click("Scene: cornell");
    let put_up = |user: &User, name: &'static str| {
        let uploads = user.uploads.borrow();
        uploads.iter().any(|(place, size, _)| *place == Place::Thumbnail(name) && *size == (132, 88))
    };
    let start = Instant::now();
    while !scene::builtin::names().all(|name| put_up(&user, name)) {
        user.frame();
        assert!(start.elapsed() < Duration::from_secs(60), "no pictures");
    }
    let after = user.frame();
    for name in scene::builtin::names() {
        let item = format!("scene {name}");
        let [left, top, right, bottom] = after.rect(&item);
        assert!(right - left > 66.0 && bottom - top >= 44.0, "{name}");
        assert_eq!(after.rect(&item), before.rect(&item), "{name}");
    }
    user.click("phong");
    user.wait_for("the other scene", |f| f.state("scene") == "phong");
}

#[test]
fn hard_cases_are_offered_with_a_picture_and_a_word() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    user.click("Scene: cornell");
    user.click("Hard cases");
    let menu = user.wait_for("a thumbnail", |f| f.shows("thumbnail hard/slab"));
    assert!(menu.shows("scene hard/slab"));
    user.click("hard/ball-on-floor");
    user.wait_for("the case", |f| f.state("scene") == "hard/ball-on-floor");
}

#[test]
fn a_scene_that_takes_long_is_told_of_and_escape_gives_it_up() {
    let mut user = User::of("whitted");
    let file = user.file("large.toml");
    let statue = "[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\nfov_y = 45\n[material.a]\n\
                  diffuse = { albedo = [1, 1, 1] }\n[[statue]]\nlevel = 11\nmaterial = \"a\"\n";
    std::fs::write(&file, statue).expect("a file");
    user.drop_file(&file);
    let told = user.wait_for("words on it", |f| f.state("loading").is_string());
    assert!(told.value("loading").starts_with("making a statue of level 11: "), "{}", told.value("loading"));
    let after = user.key(Key::Escape);
    let after = if says(&after, "Reading was stopped") { after } else { user.frame() };
    assert!(says(&after, "Reading was stopped") && after.state("loading").is_null());
    assert_eq!(after.state("scene"), "whitted");
}

#[test]
fn a_model_that_is_dropped_is_shown_with_a_note_on_what_is_not_shown_of_it() {
    let mut user = User::of("whitted");
    let file = user.file("flag.obj");
    std::fs::write(&file, "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a file");
    user.drop_file(&file);
    let shown = user.wait_for("the model", |f| f.state("scene") == "flag");
    assert!(says(&shown, "flag.obj: not read of it: mtllib"), "{}", shown.state("message"));
}
