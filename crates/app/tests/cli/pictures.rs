//! Pictures that are read: made again, compared, broken.

use super::{assert_refused, json, visavis};
use film::{Features, LayerValues, Vec3};
use std::path::Path;
use visavis_tests::TestFolder;

/// Beside a picture of either kind, and beside one that shows them itself; the picture is what it is without them.
#[test]
fn layers_keep_what_is_seen_without_light() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let kinds: [&[&str]; 3] =
        [&["--technique", "raster"], &["--spp", "2", "--estimator", "mis"], &["--spp", "4", "--show", "normal"]];
    for options in kinds {
        let (plain, layered) = (file("plain.exr"), file("layered.exr"));
        for (out, layers) in [(&plain, &[][..]), (&layered, &["--layers"][..])] {
            let common = ["render", "phong", "-o", out, "--size", "48x27"];
            let made = visavis(&[&common, options, layers].concat());
            assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        }
        let load = |path: &str| image_file::load(Path::new(path)).expect("an EXR");
        assert!(load(&plain) == load(&layered), "{options:?}");
        let layer = |path: &str, name| image_file::load_layer(Path::new(path), name, (48, 27)).expect("an EXR");
        let names = [Features::ALBEDO, Features::NORMAL, Features::DEPTH];
        assert_eq!(names.map(|name| layer(&plain, name)), [None, None, None]);
        let [Some(LayerValues::Rgb(albedo)), Some(LayerValues::Directions(normal)), Some(LayerValues::Depths(depth))] =
            names.map(|name| layer(&layered, name))
        else {
            panic!("layers of other channels")
        };
        assert!(albedo.iter().all(|albedo| albedo.min_element() >= 0.0 && albedo.max_element() <= 1.0));
        assert!(normal.iter().any(|normal| normal.y > 0.99), "the floor");
        let nothing = |at: usize| depth[at] == f32::INFINITY;
        assert!((0..depth.len()).all(|at| nothing(at) == (normal[at] == Vec3::ZERO)), "{options:?}");
        assert!(depth.iter().any(|depth| depth.is_finite()), "{options:?}");
    }
}

#[test]
fn what_cannot_be_shown_without_light_is_refused() {
    let refused = |words: &[&str], code, told: &[&str]| {
        assert_refused(&[&["render", "whitted", "-o", "none.png"], words].concat(), code, told);
    };
    refused(&["--show", "glass"], 2, &["expected picture, albedo, normal, depth, trust, cube-faces or shadow-map"]);
    refused(&["--show", "shadow-map"], 2, &["--show shadow-map", "only the fake has maps", "--technique path"]);
    refused(&["--technique", "photon", "--show", "cube-faces"], 2, &["only the fake has maps", "--technique photon"]);
    refused(&["--layers"], 2, &["--layers needs a file that has layers", "-o OUT.exr: none.png"]);
    refused(&["--show", "depth", "--errors"], 1, &["--errors needs a picture", "--show picture"]);
}

#[test]
fn a_picture_is_made_again_from_its_own_records() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let (first, again, other) = (file("first.exr"), file("again.exr"), file("other.png"));
    let options: [&[&str]; 5] = [
        &["--show", "normal", "--spp", "3", "--seed", "7"],
        &["--technique", "raster", "--show", "depth", "--segments", "12"],
        &["--estimator", "mis", "--bounces", "3", "--roulette", "0.8+throughput", "--spp", "5", "--seed", "7"],
        &["--technique", "whitted", "--depth", "4", "--glass-shadows", "clear", "--refraction-ratio", "0.8"],
        &["--technique", "raster", "--fake", "as-taught", "--segments", "12", "--shadow-filter", "pcf", "--fov", "50"],
    ];
    for extra in options {
        let common = ["render", "whitted", "-o", &first, "--size", "48x27", "--sun-radius", "1.5"];
        assert!(visavis(&[&common, extra].concat()).status.success());
        let made = visavis(&["render", "--from", &first, "-o", &again]);
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        let film = |path: &str| image_file::load(std::path::Path::new(path)).expect("an EXR");
        assert!(film(&first) == film(&again), "{extra:?}");
        // a PNG keeps them as well, and other options change them
        assert!(visavis(&["render", "--from", &first, "-o", &other, "--size", "24x14"]).status.success());
        assert!(visavis(&["render", "-o", &again, "--from", &other]).status.success());
        assert_eq!(film(&again).size(), (24, 14));
    }
    // two kinds of glass, neither of which was turned
    let two = r#"
camera = { eye = [0, 0, 6], target = [0, 0, 0], fov_y = 40 }
sky = { radiance = [0.3, 0.5, 0.9] }
[material.glass]
dielectric = { ior = 1.5 }
[material.diamond]
dielectric = { ior = 2.4 }
[[sphere]]
center = [-1.1, 0, 0]
radius = 1
material = "glass"
[[sphere]]
center = [1.1, 0, 0]
radius = 1
material = "diamond"
"#;
    let scene = file("-two glasses.toml");
    std::fs::write(&scene, two).expect("the scene");
    assert!(visavis(&["render", &scene, "-o", &first, "--size", "48x27", "--spp", "4"]).status.success());
    let from = format!("--from={first}");
    assert!(visavis(&["render", &from, "-o", &again]).status.success());
    let load = |path: &str| image_file::load(std::path::Path::new(path)).expect("an EXR");
    assert!(load(&first) == load(&again), "two kinds of glass");
    std::fs::write(folder.file("odd.png"), "no picture").expect("a file");
    assert_refused(&["render", "--from", &file("odd.png"), "-o", &again], 1, &["cannot read the picture", "odd.png"]);
    assert_refused(&["render", "--from", &file("none.exr"), "-o", &again], 1, &["none.exr"]);
    assert_refused(&["render", "-o", &again, "--from"], 2, &["--from needs a picture"]);
    image::RgbImage::new(2, 2).save(folder.file("plain.png")).expect("a file");
    assert_refused(&["render", "--from", &file("plain.png"), "-o", &again], 1, &["does not say how it was made"]);
}

/// The records of version 1, word for word as the program wrote them before there was a table of settings. A picture that
/// keeps them is made again, and keeps the same, with what a setting was before there was one.
#[test]
fn records_of_older_pictures_are_read_and_written_as_they_were() {
    let path = "technique=path size=8x6 eye=7.5,2.3,-4.2 target=3,2,-4 fov=50 refraction-ratio=0.8 sun-radius=5 spp=3 \
                sampler=independent bounces=3 roulette=0.8+throughput estimator=mis branches=2 seed=9 exposure=1";
    let whitted = "technique=whitted size=8x6 eye=6,3,-1 target=3,2,-4 fov=40 spp=2 sampler=sobol depth=3 \
                   glass-shadows=clear shadow-rays=2 seed=4 ambient=0.3 exposure=0";
    let raster = "technique=raster size=8x6 eye=6,3,-1 target=3,2,-4 fov=40 refraction-ratio=0.9 sun-radius=3 fake=as-taught \
                  shading=phong reflectivity=0.4 shininess=12 ambient=0.2 cube-map=64 shadow-map=128 shadow-filter=hard \
                  shadow-bias=0.001 segments=20 show=shadow-map exposure=0";
    let before_caustics = ["connections", "cones", "split-glass"].map(|name| (name, "off"));
    let folder = TestFolder::new();
    let (old, new) = (folder.file("old.png"), folder.file("new.png"));
    for (words, device, unsaid) in [(path, "cpu", &before_caustics[..]), (whitted, "cpu", &[]), (raster, "gpu", &[])] {
        let kept = words.split_whitespace().map(|word| word.split_once('=').expect("a record"));
        let first =
            [("records", "1"), ("version", "0.1.0"), ("scene", "whitted"), ("device", device), ("seconds", "1")];
        let all = first.into_iter().chain(kept.clone());
        // names of records live as long as the program
        let records = all.map(|(name, value)| (&*name.to_owned().leak(), value.to_owned())).collect();
        std::fs::write(&old, image_file::encode_rgba8(1, 1, &[0; 4], &records).expect("a PNG")).expect("a file");
        let made = visavis(&["render", "--from", old.to_str().unwrap(), "-o", new.to_str().unwrap()]);
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        let again = image_file::records(&new).expect("records");
        let says_how = |name: &str| {
            !["version", "records", "scene", "scene.hash", "device", "adapter", "seconds", "command"].contains(&name)
        };
        let again: Vec<_> =
            again.iter().map(|(name, value)| (&**name, &**value)).filter(|(name, _)| says_how(name)).collect();
        let mut expected: Vec<_> = kept.collect();
        expected.splice(expected.len() - 1..expected.len() - 1, unsaid.iter().copied());
        assert_eq!(again, expected);
    }
}

/// Both machines follow the same rays: the pictures differ by rounding, and each says where it was made.
#[test]
fn the_gpu_traces_the_picture_of_the_cpu() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    // without light also where the light is for the processor alone
    for technique in ["path", "whitted", "path --show normal", "metropolis --show albedo"] {
        let [cpu, gpu] = ["cpu", "gpu"].map(|device| {
            let out = file(&format!("{device}.exr"));
            let options = ["--size", "32x24", "--spp", "2", "--device", device, "--json"];
            let words: Vec<_> = ["--technique"].into_iter().chain(technique.split(' ')).chain(options).collect();
            let report = json(&visavis(&[&["render", "cornell", "-o", &out], &words[..]].concat()));
            assert_eq!((&report["device"], &report["spp"]), (&device.into(), &2.into()));
            (out, report["rays"].as_u64())
        });
        assert_eq!(cpu.1, gpu.1, "{technique}");
        let records = image_file::records(std::path::Path::new(&gpu.0)).expect("its records");
        let command = records.iter().find(|(name, _)| name == "command").map(|(_, command)| command.as_str());
        assert!(command.is_some_and(|command| command.contains("--device gpu")), "{command:?}");
        let again = file("again.exr");
        for (made, device) in [(&gpu.0, "gpu"), (&cpu.0, "cpu")] {
            let report = json(&visavis(&["render", "--from", made, "-o", &again, "--json"]));
            assert_eq!(report["device"], device, "{technique}");
        }
        let compared = json(&visavis(&["compare", &gpu.0, &cpu.0, "--json"]));
        assert!(compared["rmse"].as_f64().is_some_and(|rmse| rmse < 1e-4), "{compared}");
    }
}

#[test]
fn two_pictures_are_compared_in_numbers_and_as_a_map() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let (fake, truth, map) = (file("fake.exr"), file("truth.exr"), file("map.png"));
    let size = ["--size", "48x27"];
    let render = |out: &str, extra: &[&str]| {
        assert!(visavis(&[&["render", "cornell", "-o", out], &size[..], extra].concat()).status.success());
    };
    render(&truth, &["--spp", "64"]);
    render(&fake, &["--technique", "raster"]);
    for (name, colours) in [("signed", "blue-white-orange"), ("absolute", "viridis"), ("flip", "magma")] {
        let report = json(&visavis(&["compare", &fake, &truth, "--json", "--heatmap", &map, "--map", name]));
        assert_eq!(report["map"]["colours"], colours);
        for number in ["rmse", "relmse", "mae", "flip", "hdr_flip"] {
            assert!(report[number].as_f64() > Some(0.0), "{number}: {report}");
        }
        let picture = image::open(&map).expect("a PNG").to_rgb8();
        assert_eq!(picture.dimensions(), (48, 27 + 12));
    }
    for input in [&fake, &truth] {
        assert_refused(&["compare", &fake, &truth, "--heatmap", input], 1, &["overwrite", input]);
    }
    let layers = file("layers.exr");
    assert!(visavis(&["compare", &fake, &truth, "--heatmap", &layers]).status.success());
    let image = exr::prelude::read_all_data_from_file(&layers).expect("an EXR");
    let names: Vec<String> =
        image.layer_data.iter().map(|l| l.attributes.layer_name.as_ref().expect("a name").to_string()).collect();
    assert_eq!(names, ["A", "reference", "signed", "absolute", "relative", "squared-relative", "flip"]);
    let itself = json(&visavis(&["compare", &truth, &truth, "--json"]));
    for number in ["rmse", "relmse", "mae", "bias", "flip", "hdr_flip"] {
        assert_eq!(itself[number], 0.0, "{number}");
    }
    render(&fake, &["--technique", "whitted", "--size", "20x20"]);
    assert_refused(&["compare", &fake, &truth], 1, &["differ in size", "20x20"]);
    assert_refused(&["compare", &truth, &truth, "--heatmap", "map.gif"], 2, &[".png or .exr"]);
    assert_refused(&["compare", &truth, &truth, "--map", "pink"], 2, &["squared-relative"]);
}

#[test]
fn broken_and_enormous_pictures_are_refused_without_taking_memory() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let good = file("good.exr");
    assert!(visavis(&["render", "cornell", "-o", &good, "--size", "32x32", "--spp", "1"]).status.success());
    let whole = std::fs::read(&good).expect("the file");
    let refused = |name: &str, bytes: &[u8], words: &[&str]| {
        std::fs::write(folder.file(name), bytes).expect("a file");
        assert_refused(&["compare", &file(name), &good], 1, words);
    };
    for length in [0, 3, 40, 300, whole.len() / 2, whole.len() - 1] {
        refused("cut.exr", &whole[..length], &["cannot read the picture", "cut.exr"]);
    }
    // the data window and the display window, the latter without an edge in common with what is there
    let mut huge = whole.clone();
    let at =
        huge.windows(10).position(|w| w == b"dataWindow").expect("a data window") + "dataWindow\0box2i\0".len() + 4;
    huge[at + 8..at + 16].copy_from_slice(&[0xff, 0xff, 0x01, 0, 0xff, 0xff, 0x01, 0]);
    refused("huge.exr", &huge, &["cannot read the picture", "huge.exr"]);
    let mut bomb = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\x01\x86\xa0\0\x01\x86\xa0\x08\x02\0\0\0".to_vec();
    bomb.extend(crc32(&bomb[12..]).to_be_bytes());
    bomb.extend(b"\0\0\0\0IDAT\x35\xaf\x06\x1e\0\0\0\0IEND\xae\x42\x60\x82");
    refused("bomb.png", &bomb, &["cannot read the picture", "bomb.png"]);
    assert_refused(&["compare", folder.file("").to_str().expect("a plain path"), &good], 1, &["cannot read"]);
    // records of a later version
    let later: Vec<u8> = whole.clone();
    let record = b"visavis.records\0string\0\x01\0\0\0";
    let place = later.windows(record.len()).position(|w| w == record).expect("the record") + record.len();
    let mut later = later;
    later[place] = b'9';
    std::fs::write(folder.file("later.exr"), &later).expect("a file");
    assert_refused(&["render", "--from", &file("later.exr"), "-o", &file("out.png")], 1, &["version 9", "newer"]);
}

/// The checksum of a PNG's chunk.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| if c & 1 == 1 { (c >> 1) ^ 0xedb8_8320 } else { c >> 1 })
    })
}

#[test]
fn planes_that_a_scene_states_are_told_where_they_cut_the_fake() {
    let folder = TestFolder::new();
    let file = |name: &str| folder.file(name).to_str().expect("a plain path").to_owned();
    let text = scene::builtin::text("hard/ball-on-floor").expect("an embedded scene");
    let said = |planes: &str, technique: &str| {
        std::fs::write(folder.file("scene.toml"), text.replace("fov_y = 40", planes)).expect("the scene");
        let scene = file("scene.toml");
        let size = ["--size", "32x32", "--technique", technique];
        let made = visavis(&[&["render", &scene, "-o", &file("out.png")], &size[..]].concat());
        assert!(made.status.success());
        String::from_utf8_lossy(&made.stderr).into_owned()
    };
    assert!(!said("fov_y = 40", "raster").contains("note:"));
    assert!(!said("fov_y = 40\nnear = 0.1\nfar = 3000", "raster").contains("note:"));
    let cut = said("fov_y = 40\nnear = 4.5\nfar = 8", "raster");
    assert!(cut.contains("note: the camera's near (4.5) and far (8) cut parts of the scene"), "{cut}");
    assert!(!said("fov_y = 40\nnear = 4.5", "whitted").contains("cut"), "rays know no planes");
}

/// The radius that a picture leaves to the scene goes by the scene's own camera, which its record replaces by the picture's.
#[test]
fn photons_of_another_camera_are_gathered_in_the_same_radius_again() {
    let folder = TestFolder::new();
    let [first, again] =
        ["first.exr", "again.exr"].map(|name| folder.file(name).to_str().expect("a plain path").to_owned());
    let common = ["render", "whitted", "-o", &first, "--size", "24x14", "--spp", "2", "--technique", "photon"];
    assert!(visavis(&[&common[..], &["--photons", "4096", "--eye", "5,2.6,-4.2"]].concat()).status.success());
    let records = image_file::records(std::path::Path::new(&first)).expect("records");
    assert!(records.iter().any(|(name, value)| name == "radius" && value.parse::<f32>().is_ok_and(|r| r < 0.25)));
    assert!(visavis(&["render", "--from", &first, "-o", &again]).status.success());
    let film = |path: &str| image_file::load(std::path::Path::new(path)).expect("an EXR");
    assert!(film(&first) == film(&again));
}

#[test]
fn time_stops_a_render() {
    let folder = TestFolder::new();
    let out = folder.file("t.png");
    let output = visavis(&[
        "render",
        "cornell",
        "--size",
        "64x64",
        "--time",
        "1",
        "--json",
        "-o",
        out.to_str().expect("a plain path"),
    ]);
    let report = json(&output);
    let seconds = report["seconds"].as_f64().expect("seconds");
    assert!((0.9..6.0).contains(&seconds), "{seconds}");
    assert!(report["spp"].as_u64() > Some(1));
}
