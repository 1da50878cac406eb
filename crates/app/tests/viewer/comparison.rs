//! How far both panes are from the reference of what they show.

use super::{User, both_whole, says};
use egui::{Key, vec2};
use film::{Image, LayerValues};
use reference::{Key as ReferenceKey, Reference, STANDARD_ERROR, Store};
use scene::Vec3;
use std::path::Path;
use std::time::Duration;
use visavis_tests::{Frame, TestFolder};

pub const SCENE: &str = "hard/light-touching-wall";

/// What the viewer would have made, but for one picture and its numbers.
fn almost_done(size: (u32, u32)) -> Reference {
    let pixels = (size.0 * size.1) as usize;
    let grey = |value: f32| vec![Vec3::splat(value); pixels];
    let image = Image::new(size.0, size.1, grey(0.5)).expect("pixels of that size");
    let image = image.with_layer(STANDARD_ERROR, LayerValues::Rgb(grey(0.05).into()));
    Reference { image, replicates: 15, seconds: 119.999, nonfinite: 0 }
}

/// Chooses the reference for two fakes, which are done at once, in a small window: its reference takes less time.
pub fn choose_the_reference(user: &mut User) -> Frame {
    let first = user.wait_for("both pictures", both_whole);
    assert!(!first.shows("text reference") && !first.shows("reference file"));
    user.click_nth("Fake", 1);
    user.wait_for("two fakes", |f| f.state("b")["label"] == "Fake, fair" && both_whole(f));
    let chosen = user.click("Against: reference");
    assert!(chosen.shows("text reference") && chosen.shows("reference file"));
    user.resize(vec2(480.0, 320.0));
    user.click("Side by side");
    user.wait_for("small pictures that are compared with no other", |f| {
        let small = f.state("view") == "Side by side" && f.state("picture_size")[1].as_u64() < Some(320);
        small && both_whole(f) && !f.value("label A").contains("differs from B")
    })
}

fn size(frame: &Frame) -> (u32, u32) {
    let side = |i: usize| frame.state("picture_size")[i].as_u64().expect("a size") as u32;
    (side(0), side(1))
}

#[test]
fn a_reference_is_made_while_the_panes_rest_kept_and_there_at_once_the_second_time() {
    let folder = TestFolder::new();
    let store = Store::new(folder.file("store"), Store::MOST_BYTES);
    let mut user = User::who_keeps(SCENE, store.folder());
    let small = choose_the_reference(&mut user);
    let shot = user.viewer.borrow().model.document.shot(&user.viewer.borrow().model.state.picture);
    assert_eq!(shot.size, size(&small));
    let key = ReferenceKey::of(&shot);
    store.put(key, &almost_done(size(&small)), Vec::new()).expect("a store");

    // another view and back: what is looked up now is there, and is gone on with once the panes are done
    user.key(Key::Num1);
    user.wait_for("another size", |f| f.state("view") == "A" && size(f) != size(&small) && both_whole(f));
    user.key(Key::Num4);
    let judged = |f: &Frame| f.value("label A").contains("against the reference");
    let found = user.wait_for("the reference from the store", |f| judged(f) && f.state("view") == "Side by side");
    assert!(found.state("reference")[0].as_u64() >= Some(15));
    user.wait_for("one picture more", |f| f.state("reference")[0] == 16 && f.state("reference")[1] == 1);
    // it is shown before it is on the disk
    let kept = (0..200).any(|_| {
        std::thread::sleep(Duration::from_millis(50));
        store.fetch(key).is_ok_and(|kept| kept.is_some_and(|kept| kept.replicates == 16))
    });
    assert!(kept, "the reference is not kept");

    drop(user);

    let mut user = User::who_keeps(SCENE, store.folder());
    choose_the_reference(&mut user);
    user.wait_for("the reference at once", |f| judged(f) && f.state("reference")[0] == 16);
    // the map is of another size, of which there is no reference yet
    user.key(Key::Num5);
    user.wait_for("a map that waits", |f| f.value("label no map").contains("reference: 0 of 16 pictures"));
}

/// Types a file's name into the panel.
fn load(user: &mut User, file: &str) {
    let typed = user.type_into("Load a reference (.exr):", file);
    assert_eq!(typed.value("reference file"), file);
    user.click("Load the reference");
}

#[test]
fn a_reference_from_a_file_is_taken_if_it_fits() {
    let mut user = User::of(SCENE);
    user.wait_for("both pictures", both_whole);
    let open = user.click("Against: reference");
    let fitting = Reference { replicates: 64, ..almost_done(size(&open)) };
    let folder = TestFolder::new();
    let write = |name: &str, reference: &Reference, records| {
        std::fs::write(folder.file(name), reference.encode(records).expect("an EXR")).expect("a file");
        folder.file(name).display().to_string()
    };
    let scene = scene::builtin::named(SCENE).expect("a scene");
    let of_the_scene = reference::records(&technique::Shot::of(scene, size(&open)));
    let (good, small) = (write("good.exr", &fitting, of_the_scene), write("small.exr", &almost_done((8, 8)), vec![]));
    let none = user.file("none.exr").display().to_string();
    load(&mut user, &none);
    user.wait_for("the refusal", |f| says(f, "cannot read the picture") && says(f, "none.exr"));
    load(&mut user, &small);
    user.wait_for("the other refusal", |f| says(f, "the reference has 8x8 pixels") && says(f, "small.exr"));
    load(&mut user, &good);
    user.wait_for("the loaded reference", |f| f.value("text reference").starts_with("reference: good.exr"));
    user.wait_for("both judged by it", |f| {
        ["label A", "label B"].iter().all(|label| f.value(label).contains("against the reference"))
    });
    let message = user.frame().state("message").clone();
    assert!(message.is_null() || !message.to_string().contains("scene"), "{message}");
    // it knows its size, but is of something else
    let hash = ("scene.hash", format!("{:032x}-{:032x}", 1, 2));
    let other = write("other.exr", &fitting, vec![("scene", "other.toml".into()), hash]);
    let before = write("before.exr", &fitting, vec![("scene", SCENE.into())]);
    for (file, words) in [(&other, "is of another scene"), (&before, "was made before scenes were kept")] {
        load(&mut user, file);
        let name = Path::new(file).file_name().expect("a name").display();
        user.wait_for(words, |f| {
            says(f, words) && f.value("text reference").starts_with(&format!("reference: {name}"))
        });
    }
    load(&mut user, &good);
    user.wait_for("the one before", |f| f.value("text reference").starts_with("reference: good.exr"));
    // T goes from A's errors to B's
    user.key(Key::Num5);
    user.wait_for("the map of A", |f| f.state("map") == "A - reference");
    user.key(Key::T);
    user.wait_for("the map of B", |f| f.state("map") == "B - reference" && f.state("view") == "Error map");
}
