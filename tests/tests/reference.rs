//! The reference: its claim about its own error holds, making it in parts is making it at once, and the store gives
//! back what it was given and takes no more room than it may.

use film::{Image, LayerValues, Vec3};
use reference::{Goal, Key, Maker, Reference, SAMPLES_PER_REPLICATE, STANDARD_ERROR, Store};
use scene::Scene;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, SystemTime};
use technique::{Renderer, Shot, Threads};
use visavis_tests::TestFolder;

const SIZE: (u32, u32) = (24, 24);

fn cornell() -> Scene {
    scene::builtin::named("cornell").unwrap()
}

fn shot(scene: &Scene, size: (u32, u32)) -> Shot {
    Shot::of(scene.clone(), size)
}

fn renderer(scene: &Scene) -> Renderer {
    Renderer::on_the_processor(Arc::new(scene.clone()), Arc::new(Threads::all()))
}

/// A reference of so many pictures, going on with one that is there.
fn made(scene: &Scene, pictures: u32, begun: Option<&Reference>) -> Reference {
    let mut renderer = renderer(scene);
    let mut maker = Maker::new(&mut renderer, &shot(scene, SIZE), begun).unwrap();
    while maker.replicates() < pictures {
        assert!(maker.step(&|| false));
    }
    maker.reference()
}

/// Against a picture of four times as many samples, the squared differences are what the standard errors claim: pixel
/// by pixel, and summed over the picture, which is the noise that is told. The truth's own noise adds 1/4; a mean of
/// squared Student's t of 31 degrees of freedom is 31/29. The 576 pixels' channels go together, so that chance alone
/// makes about 7 % of the one; a few of the noisiest pixels rule the other. With 16 pictures the first is about 1.5
/// instead of 1: some pixels have not met their rare bright samples yet and claim too little, while the sum is right
/// already.
#[test]
fn the_standard_error_of_a_reference_is_calibrated() {
    let scene = cornell();
    let reference = made(&scene, 32, None);
    let tracer = pathtrace::Tracer::new(&scene);
    let settings = pathtrace::PathSettings { seed: 1000, ..Maker::settings(0) };
    let mut truth = film::Film::new(SIZE.0, SIZE.1);
    tracer.render(&mut truth, &scene.camera, &settings.into(), 4 * 32 * SAMPLES_PER_REPLICATE, &|| false);

    let errors = reference.standard_errors().unwrap();
    let channels = |v: &Vec3| v.to_array().map(f64::from);
    let (mut standardised, mut count, mut claimed, mut found) = (0.0, 0, 0.0, 0.0);
    for ((mean, error), truth) in reference.image.radiances().iter().zip(errors).zip(truth.radiances()) {
        for ((mean, error), truth) in channels(mean).into_iter().zip(channels(error)).zip(channels(&truth)) {
            // a pixel that is wholly area light or background does not vary
            if error > 1e-5 * (1.0 + mean) {
                standardised += ((mean - truth) / error).powi(2);
                count += 1;
            }
            claimed += error * error;
            found += (mean - truth).powi(2);
        }
    }
    let of_pixels = standardised / f64::from(count) / (1.0 + 1.0 / 4.0) / (31.0 / 29.0);
    let of_all = found / claimed / (1.0 + 1.0 / 4.0);
    println!("found over claimed: {of_pixels:.3} pixel by pixel over {count} values, {of_all:.3} in all");
    assert!(count > 1000, "{count} values that vary");
    assert!((0.75..1.25).contains(&of_pixels), "found over claimed, pixel by pixel: {of_pixels}");
    assert!((0.6..1.6).contains(&of_all), "found over claimed, in all: {of_all}");
    let told = reference.mean_squared_error().unwrap();
    assert!((told * f64::from(3 * SIZE.0 * SIZE.1) / claimed - 1.0).abs() < 1e-9);
}

#[test]
fn going_on_with_a_reference_is_making_it_at_once() {
    let scene = cornell();
    let at_once = made(&scene, 6, None);
    let begun = made(&scene, 3, None);
    let in_parts = made(&scene, 6, Some(&begun));
    assert_eq!((in_parts.replicates, in_parts.image.size()), (6, SIZE));
    assert!(in_parts.seconds > begun.seconds);
    // what is kept in between is f32
    let near = |a: &[Vec3], b: &[Vec3], tolerance: f32| {
        a.iter().zip(b).all(|(a, b)| (*a - *b).abs().max_element() <= tolerance * (1e-3 + b.abs().max_element()))
    };
    assert!(near(in_parts.image.radiances(), at_once.image.radiances(), 1e-6));
    let (parts, once) = (in_parts.standard_errors().unwrap(), at_once.standard_errors().unwrap());
    assert!(near(parts, once, 1e-3));
    assert!(once.iter().any(|error| error.max_element() > 0.0));
}

#[test]
fn one_that_is_stopped_has_only_whole_pictures() {
    let scene = cornell();
    let mut renderer = renderer(&scene);
    let mut maker = Maker::new(&mut renderer, &shot(&scene, SIZE), None).unwrap();
    assert!(maker.step(&|| false));
    let before = maker.reference();
    assert!(!maker.step(&|| true));
    assert_eq!(maker.reference(), before);
    assert!(!maker.is_done(&Goal { rel_mse: f64::INFINITY, seconds: 0.0 }), "one picture does not know its noise");
}

/// As when a pane was at work for a moment: what held the reference is gone by the time anyone asks again.
#[test]
fn a_hold_that_has_ended_already_does_not_pass_off_half_a_picture_as_a_whole_one() {
    let scene = cornell();
    let mut renderer = renderer(&scene);
    let usual = made(&scene, 1, None);
    let mut maker = Maker::new(&mut renderer, &shot(&scene, SIZE), None).unwrap();
    let asked = AtomicU32::new(0);
    while !maker.step(&|| asked.fetch_add(1, Ordering::Relaxed) == 300) {}
    assert_eq!(maker.reference().image.radiances(), usual.image.radiances());
}

/// A picture that shared its random numbers with the reference would look better than it is.
#[test]
fn no_usual_picture_shares_its_seed_with_a_reference() {
    let scene = cornell();
    let tracer = pathtrace::Tracer::new(&scene);
    let reference = made(&scene, 2, None);
    for seed in (0..32).chain([Maker::settings(1).seed]) {
        let settings = Maker::settings(seed);
        let mut usual = film::Film::new(SIZE.0, SIZE.1);
        tracer.render(&mut usual, &scene.camera, &settings.into(), SAMPLES_PER_REPLICATE, &|| false);
        // the two pictures of the reference, from their mean and their spread
        let pairs = usual.radiances().zip(reference.image.radiances()).zip(reference.standard_errors().unwrap());
        let same = pairs.filter(|((u, mean), error)| ((*u - **mean).abs() - **error).abs().max_element() < 1e-6);
        let varied = reference.standard_errors().unwrap().iter().filter(|e| e.max_element() > 1e-3).count();
        assert!(same.count() < varied, "seed {seed}");
    }
    assert_eq!(pathtrace::PathSettings::default().seed, 1);
}

/// A reference without work, whose numbers are all different.
fn sketched(pictures: u32) -> Reference {
    let number = |i: u32| Vec3::new(i as f32, (i as f32).sqrt(), 1.0 / (i + pictures) as f32);
    let image = Image::new(4, 3, (0..12).map(number).collect::<Vec<_>>()).unwrap();
    let errors = (0..12).map(|i| 0.01 * number(i + 1)).collect();
    let image = image.with_layer(STANDARD_ERROR, LayerValues::Rgb(errors));
    Reference { image, replicates: pictures, seconds: 1.25, nonfinite: 7 }
}

#[test]
fn a_file_keeps_every_bit() {
    let folder = TestFolder::new();
    let file = folder.file("reference.exr");
    let reference = sketched(16);
    std::fs::write(&file, reference.encode(vec![("scene", "cornell".into())]).unwrap()).unwrap();
    assert_eq!(Reference::load(&file).unwrap(), reference);
    let records = image_file::records(&file).unwrap();
    assert!(records.contains(&("scene".into(), "cornell".into())) && records.contains(&("spp".into(), "1024".into())));
    // any other picture is one without an error
    let mut plain = reference.image.clone();
    plain.layers.clear();
    let bytes = image_file::encode(image_file::Kind::Exr, &plain, &Default::default(), &Vec::new()).unwrap();
    std::fs::write(&file, bytes).unwrap();
    let loaded = Reference::load(&file).unwrap();
    assert_eq!((loaded.standard_errors(), loaded.replicates, &loaded.image), (None, 0, &plain));
}

fn keys(count: u32) -> Vec<Key> {
    let scene = cornell();
    (1..=count).map(|width| Key::of(&shot(&scene, (width, 3)))).collect()
}

/// What a store has of it, if that is whole.
fn fetched(store: &Store, key: Key) -> Option<Reference> {
    store.fetch(key).ok().flatten()
}

#[test]
fn a_store_returns_what_was_put_and_nothing_else() {
    let folder = TestFolder::new();
    let store = Store::new(folder.file("store"), Store::MOST_BYTES);
    let [one, other] = keys(2)[..] else { panic!("two keys") };
    assert_eq!((fetched(&store, one), store.usage().unwrap().count), (None, 0));
    store.put(one, &sketched(16), Vec::new()).unwrap();
    assert_eq!((fetched(&store, one), fetched(&store, other)), (Some(sketched(16)), None));
    store.put(one, &sketched(32), Vec::new()).unwrap();
    assert_eq!((fetched(&store, one).unwrap().replicates, store.usage().unwrap().count), (32, 1));
}

#[test]
fn a_damaged_file_is_no_reference() {
    let folder = TestFolder::new();
    let store = Store::new(folder.path().to_owned(), Store::MOST_BYTES);
    let key = keys(1)[0];
    store.put(key, &sketched(16), Vec::new()).unwrap();
    let file = folder.file(&format!("{key}.exr"));
    let whole = std::fs::read(&file).unwrap();
    for length in [0, 1, 100, whole.len() / 2, whole.len() - 1] {
        std::fs::write(&file, &whole[..length]).unwrap();
        assert_eq!(fetched(&store, key), None, "{length} bytes of {}", whole.len());
    }
    store.put(key, &sketched(16), Vec::new()).unwrap();
    assert_eq!(fetched(&store, key), Some(sketched(16)));
}

/// Bits all over a file: those of the first and last bytes, and others by Knuth's MMIX generator.
fn bits(length: usize) -> impl Iterator<Item = usize> {
    let mut state = 1u64;
    let random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % (8 * length)
    };
    (0..64).chain(8 * length - 400..8 * length).chain(std::iter::repeat_with(random).take(400))
}

/// Of a file of the user's the last bytes say that it has a hash: where they do not, it is read like any other.
#[test]
fn any_bit_that_has_turned_is_noticed() {
    let folder = TestFolder::new();
    let store = Store::new(folder.path().to_owned(), Store::MOST_BYTES);
    let key = keys(1)[0];
    store.put(key, &sketched(16), Vec::new()).unwrap();
    let file = folder.file(&format!("{key}.exr"));
    let whole = std::fs::read(&file).unwrap();
    let mark = whole.len() - 48..whole.len() - 32;
    for bit in bits(whole.len()) {
        let mut turned = whole.clone();
        turned[bit / 8] ^= 1 << (bit % 8);
        std::fs::write(&file, &turned).unwrap();
        let fault = store.fetch(key).unwrap_err().to_string();
        assert!(fault.contains("damaged") && fault.contains(&key.to_string()), "bit {bit}: {fault}");
        match Reference::load(&file) {
            Ok(read) => assert!(mark.contains(&(bit / 8)) && read == sketched(16), "bit {bit}"),
            Err(fault) => assert!(fault.to_string().contains("damaged"), "bit {bit}: {fault}"),
        }
    }
    assert_eq!(store.usage().unwrap().count, 1);
    store.put(key, &sketched(8), Vec::new()).unwrap();
    assert_eq!(fetched(&store, key), Some(sketched(8)), "anything is finer than a damaged one");
}

#[test]
fn a_coarser_reference_does_not_take_the_place_of_a_finer_one() {
    let folder = TestFolder::new();
    let store = Store::new(folder.path().to_owned(), Store::MOST_BYTES);
    let [one, other] = keys(2)[..] else { panic!("two keys") };
    [16, 32, 16].into_iter().for_each(|pictures| store.put(one, &sketched(pictures), Vec::new()).unwrap());
    assert_eq!(fetched(&store, one).unwrap().replicates, 32);
    // at once, and while others look
    for _ in 0..8 {
        store.clear().unwrap();
        std::thread::scope(|scope| {
            for pictures in [20, 40, 10, 30] {
                let store = store.clone();
                scope.spawn(move || {
                    store.put(other, &sketched(pictures), Vec::new()).unwrap();
                    assert!(store.fetch(other).unwrap().unwrap().replicates >= pictures);
                });
            }
        });
        assert_eq!(fetched(&store, other).unwrap().replicates, 40);
    }
    assert_eq!(folder.names(), [format!("{other}.exr")]);
}

fn used(file: &Path, seconds_ago: u64) {
    let time = SystemTime::now() - Duration::from_secs(seconds_ago);
    std::fs::File::options().append(true).open(file).unwrap().set_modified(time).unwrap();
}

#[test]
fn what_was_not_used_for_longest_makes_room() {
    let folder = TestFolder::new();
    let keys = keys(4);
    let file = |key: Key| folder.file(&format!("{key}.exr"));
    let roomy = Store::new(folder.path().to_owned(), Store::MOST_BYTES);
    keys[..3].iter().for_each(|key| roomy.put(*key, &sketched(16), Vec::new()).unwrap());
    let each = roomy.usage().unwrap().bytes / 3;
    [(keys[0], 300), (keys[1], 200), (keys[2], 100)].into_iter().for_each(|(key, ago)| used(&file(key), ago));
    // looking at the oldest makes it the newest
    assert!(fetched(&roomy, keys[0]).is_some());
    let tight = Store::new(folder.path().to_owned(), 3 * each + each / 2);
    tight.put(keys[3], &sketched(16), Vec::new()).unwrap();
    assert_eq!([0, 1, 2, 3].map(|i| fetched(&tight, keys[i]).is_some()), [true, false, true, true]);
    // one that has no room beside any other still stays until the next one
    let tiny = Store::new(folder.path().to_owned(), 1);
    tiny.put(keys[1], &sketched(16), Vec::new()).unwrap();
    assert_eq!([0, 1, 2, 3].map(|i| fetched(&tiny, keys[i]).is_some()), [false, true, false, false]);
}

#[test]
fn clearing_leaves_what_is_not_the_stores() {
    let folder = TestFolder::new();
    let store = Store::new(folder.path().to_owned(), Store::MOST_BYTES);
    keys(3).into_iter().for_each(|key| store.put(key, &sketched(16), Vec::new()).unwrap());
    let foreign = [
        "0123456789abcdef0123456789abcdef.exr",
        "0123456789abcdef0123456789abcdeg.exr",
        "holiday.exr",
        "holiday.exr.12.partial",
        "notes.txt",
    ];
    foreign.iter().for_each(|name| std::fs::write(folder.file(name), "mine").unwrap());
    // what programs that were killed have left, and what one that lives is writing
    let left = [format!("{}.exr.12.partial", keys(1)[0]), ".visavis-0123456789abcdef.partial".into()];
    left.iter().for_each(|name| std::fs::write(folder.file(name), "half").unwrap());
    let living = std::fs::File::create(folder.file(".visavis-fedcba9876543210.partial")).unwrap();
    living.lock().unwrap();
    assert_eq!(store.clear().unwrap().count, 3);
    assert_eq!(folder.names(), [&[".visavis-fedcba9876543210.partial"], &foreign[..]].concat());
    assert_eq!(store.usage().unwrap().bytes, 0);
}

#[test]
fn a_file_in_the_folders_place_is_one_line() {
    let folder = TestFolder::new();
    let taken = folder.file("taken");
    std::fs::write(&taken, "a file").unwrap();
    let store = Store::new(taken, Store::MOST_BYTES);
    assert_eq!(fetched(&store, keys(1)[0]), None);
    let fault = store.put(keys(1)[0], &sketched(16), Vec::new()).unwrap_err().to_string();
    assert!(fault.contains("cannot keep references") && fault.ends_with("taken") && !fault.contains('\n'), "{fault}");
    assert!(store.usage().is_err() && store.clear().is_err());
}
