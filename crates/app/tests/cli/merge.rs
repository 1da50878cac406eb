//! A picture's samples in ranges, each made by itself, and put together.

use super::{assert_refused, json, visavis};
use film::Image;
use image_file::Layers;
use std::path::PathBuf;
use visavis_tests::TestFolder;

/// Films of a small picture, in a folder of their own.
struct Films {
    folder: TestFolder,
}

impl Films {
    fn new() -> Self {
        Films { folder: TestFolder::new() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.file(name)
    }

    fn file(&self, name: &str) -> String {
        self.path(name).to_str().expect("a plain path").to_owned()
    }

    /// Renders a picture of which these words say more.
    fn render(&self, out: &str, words: &str) -> serde_json::Value {
        let out = self.file(out);
        let words: Vec<&str> = words.split(' ').collect();
        let common = ["-o", &out, "--size", "23x14", "--device", "cpu", "--seed", "7", "--json"];
        json(&visavis(&[&["render"][..], &words, &common].concat()))
    }

    /// Films of the ranges, which are their names.
    fn ranges(&self, words: &str, ranges: &[&str]) {
        ranges
            .iter()
            .for_each(|range| drop(self.render(&format!("{range}.exr"), &format!("{words} --samples {range}"))));
    }

    fn merge(&self, parts: &[&str], out: &str) -> serde_json::Value {
        let parts: Vec<String> = parts.iter().map(|part| self.file(&format!("{part}.exr"))).collect();
        let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
        json(&visavis(&[&["merge"], &parts[..], &["-o", &self.file(out), "--json"]].concat()))
    }

    fn again(&self, from: &str, out: &str, words: &[&str]) {
        let output = visavis(&[&["render", "--from", &self.file(from), "-o", &self.file(out)], words].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }

    fn image(&self, name: &str) -> Image {
        image_file::load(&self.path(name)).expect("a picture")
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).expect("a file")
    }

    /// All that a file holds; its records are in no order.
    fn contents(&self, name: &str) -> (Image, Layers, Vec<(String, String)>) {
        let mut records = image_file::records(&self.path(name)).expect("its records");
        records.sort();
        (self.image(name), image_file::load_layers(&self.path(name), (23, 14)).expect("layers"), records)
    }

    fn record(&self, file: &str, name: &str) -> Option<String> {
        let records = image_file::records(&self.path(file)).expect("its records");
        records.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}

/// By the least step that f32 has there.
fn assert_within_an_ulp(a: &Image, b: &Image) {
    for (a, b) in a.radiances().iter().zip(b.radiances()) {
        for (a, b) in a.to_array().into_iter().zip(b.to_array()) {
            assert!(b.next_down() <= a && a <= b.next_up(), "{a} {b}");
        }
    }
}

#[test]
fn merged_ranges_are_the_picture_of_one_run_in_whatever_order() {
    let films = Films::new();
    for (picture, words) in [("a", "cornell"), ("b", "cornell --technique photon --photons 400")] {
        let one_run = films.render("one.exr", &format!("{words} --spp 12"));
        films.ranges(words, &["0..3", "3..8", "8..12"]);
        let [all, other] = [format!("{picture}.exr"), format!("other-{picture}.exr")];
        let merged = films.merge(&["0..3", "3..8", "8..12"], &all);
        assert_within_an_ulp(&films.image(&all), &films.image("one.exr"));
        films.merge(&["8..12", "0..3", "3..8"], &other);
        assert!(films.contents(&all) == films.contents(&other));
        for of in ["mean", "standard_error"] {
            let channels = [&merged, &one_run].map(|of_run| of_run[of].as_array().expect("three").clone());
            for (a, b) in channels[0].iter().zip(&channels[1]) {
                let [a, b] = [a, b].map(|value| value.as_f64().expect("a number"));
                assert!((a - b).abs() <= 1e-9 * b.abs(), "{of}: {a} {b}");
            }
        }
        assert_eq!((&merged["samples"], &merged["spp"]), (&"0..12".into(), &12.into()));
        films.again(&all, "again.exr", &[]);
        assert_eq!(films.image("again.exr"), films.image("one.exr"));
    }
}

#[test]
fn what_is_merged_can_be_merged_on_and_says_which_samples_it_has() {
    let films = Films::new();
    films.render("one.exr", "cornell --spp 12");
    films.ranges("cornell", &["0..3", "3..8", "8..12"]);
    films.merge(&["8..12", "0..3"], "gap.exr");
    let records = |file: &str| ["samples", "spp"].map(|name| films.record(file, name).expect(name));
    assert_eq!(records("gap.exr"), ["0..3,8..12", "7"]);
    assert_eq!(films.record("gap.exr", "command"), None, "no command makes it");
    films.merge(&["3..8", "gap"], "all.exr");
    assert_eq!(records("all.exr"), ["0..12", "12"]);
    assert_within_an_ulp(&films.image("all.exr"), &films.image("one.exr"));
    films.merge(&["3..8", "gap"], "all.png");
    films.again("one.exr", "one.png", &[]);
    assert_eq!(films.image("all.png"), films.image("one.png"));
    let command = films.record("all.png", "command").expect("a command");
    assert!(command.contains("-o picture.png") && command.contains("--spp 12"), "{command}");
    let [adapter, seconds] = ["adapter", "seconds"].map(|name| films.record("all.exr", name).expect(name));
    let of_part = films.record("3..8.exr", "adapter");
    assert_eq!((Some(adapter), seconds.parse::<f64>().is_ok_and(|seconds| seconds > 0.0)), (of_part, true));
    films.again("all.png", "again.exr", &[]);
    assert_eq!(films.image("again.exr"), films.image("one.exr"));
}

#[test]
fn a_range_is_made_again_from_its_records_or_changed() {
    let films = Films::new();
    films.render("one.exr", "cornell --spp 5");
    films.ranges("cornell", &["5..9"]);
    films.again("5..9.exr", "again.exr", &[]);
    assert_eq!(films.image("again.exr"), films.image("5..9.exr"));
    assert_eq!(films.record("again.exr", "samples").as_deref(), Some("5..9"));
    let command = films.record("5..9.exr", "command").expect("a command");
    assert!(command.contains("--samples 5..9") && !command.contains("--spp"), "{command}");
    films.again("5..9.exr", "from-the-first.exr", &["--spp", "5"]);
    assert_eq!(films.image("from-the-first.exr"), films.image("one.exr"));
    films.again("5..9.exr", "0..5.exr", &["--samples", "0..5"]);
    assert_eq!(films.image("0..5.exr"), films.image("one.exr"));
    films.merge(&["0..5", "again"], "0..9.exr");
}

#[test]
fn what_is_no_part_of_the_picture_is_refused_in_one_line() {
    let films = Films::new();
    films.ranges("cornell", &["0..3", "3..8"]);
    films.render("plain.exr", "cornell --spp 3");
    films.render("scene.exr", "whitted --samples 3..8");
    films.render("bounces.exr", "cornell --samples 3..8 --bounces 2");
    films.render("overlap.exr", "cornell --samples 2..4");
    films.render("other.exr", "cornell --samples 3..8 --technique whitted");
    let whole = films.bytes("3..8.exr");
    std::fs::write(films.path("cut.exr"), &whole[..whole.len() * 2 / 3]).expect("a file");
    let first = films.file("0..3.exr");
    let out = films.file("out.exr");
    let names = films.folder.names();
    for (part, words) in [
        ("scene", &["it shows another scene than", "scene.exr"][..]),
        ("bounces", &["its bounces is 2, and inf in", "0..3.exr"]),
        ("other", &["its technique is whitted, and path in"]),
        ("overlap", &["samples would count twice: 2..4, and 0..3 in", "overlap.exr"]),
        ("0..3", &["samples would count twice: 0..3"]),
        ("plain", &["it has no sums of samples, as render --samples FROM..TO writes them", "plain.exr"]),
        ("cut", &["cannot read the picture", "cut.exr"]),
        ("missing", &["cannot read the picture", "missing.exr"]),
    ] {
        let part = films.file(&format!("{part}.exr"));
        assert_refused(&["merge", &first, &part, "-o", &out], 1, words);
        assert_refused(&["merge", &part, &first, "-o", &out], 1, &words[..1]);
    }
    assert_refused(&["merge", &first, "-o", &first], 1, &["-o would overwrite a film", "0..3.exr"]);
    assert_refused(&["merge", "-o", &out], 2, &["merge needs films of render --samples"]);
    assert_refused(&["merge", &first], 2, &["merge needs a file to write"]);
    assert_refused(&["merge", "a.png", "-o", &out], 2, &["which an .exr holds: a.png"]);
    assert_refused(&["merge", &first, "-o", "a.jpg"], 2, &["must end in .png or .exr"]);
    assert_eq!(films.folder.names(), names);
}

#[test]
fn a_range_that_cannot_be_had_is_refused_in_one_line() {
    let films = Films::new();
    let (out, png) = (films.file("out.exr"), films.file("out.png"));
    for (out, words, told) in [
        (&out, "--samples 8", "--samples 8: expected FROM..TO"),
        (&out, "--samples 8..8", "TO above FROM"),
        (&out, "--samples 0..4,2..6", "expected FROM..TO"),
        (&out, "--samples 0..4,6..8", "one film has no gap; render each range by itself and merge them"),
        (&out, "--samples 0..4 --spp 4", "--samples and --spp both say how many samples"),
        (&out, "--samples 0..4 --technique raster", "--samples: the fake has no samples"),
        (&out, "--samples 0..4 --show albedo", "--show albedo is no sum of samples"),
        (&out, "--samples 0..4 --runs 2", "leave it out"),
        (&out, "--samples 0..4 --denoise unet", "leave --denoise out"),
        (&png, "--samples 0..4", "sums of samples need -o OUT.exr"),
        (&png, "--jobs 4", "--jobs: sums of samples need -o OUT.exr"),
        (&out, "--jobs 0", "--jobs 0: expected a whole number from 1"),
        (&out, "--jobs 2 --technique raster", "--jobs: the fake has no samples"),
    ] {
        let words: Vec<&str> = words.split(' ').collect();
        assert_refused(&[&["render", "cornell", "-o", out], &words[..]].concat(), 2, &[told]);
    }
    assert_eq!(films.folder.names(), [""; 0]);
}

#[test]
fn a_list_of_jobs_makes_the_films_of_one_picture() {
    let films = Films::new();
    films.render("one.exr", "cornell --spp 10 --bounces 3");
    let out = films.file("all.exr");
    let common = ["--size", "23x14", "--seed", "7", "--bounces=3", "--device", "cpu"];
    let output = visavis(&[&["render", "cornell", "--spp", "10", "--jobs", "3", "-o", &out], &common[..]].concat());
    let lines = String::from_utf8(output.stdout).expect("text");
    assert_eq!(lines.lines().count(), 3, "{lines}");
    for line in lines.lines() {
        let words: Vec<&str> = line.strip_prefix("visavis ").expect("a command").split(' ').collect();
        assert!(visavis(&words).status.success(), "{line}");
    }
    assert_eq!(films.folder.names(), ["all.1-of-3.exr", "all.2-of-3.exr", "all.3-of-3.exr", "one.exr"]);
    films.merge(&["all.1-of-3", "all.2-of-3", "all.3-of-3"], "all.exr");
    assert_within_an_ulp(&films.image("all.exr"), &films.image("one.exr"));
}

/// What denoisers are guided by is the same for all samples.
#[test]
fn a_merged_picture_keeps_what_denoisers_are_guided_by() {
    let films = Films::new();
    films.render("one.exr", "cornell --spp 6 --layers");
    films.ranges("cornell", &["0..2"]);
    films.ranges("cornell --layers", &["2..6"]);
    films.merge(&["0..2", "2..6"], "all.exr");
    let [all, one] = ["all.exr", "one.exr"].map(|file| films.path(file));
    for name in ["albedo", "normal", "depth"] {
        let layer = |path| image_file::load_layer(path, name, (23, 14)).expect("a file").expect(name);
        assert_eq!(layer(&all), layer(&one), "{name}");
    }
    assert_eq!(films.record("all.exr", "half0.samples"), None);
    let denoised = films.file("denoised.exr");
    assert!(visavis(&["denoise", all.to_str().unwrap(), "-o", &denoised]).status.success());
    assert_refused(&["merge", &denoised, "-o", &films.file("no.exr")], 1, &["it has no sums of samples"]);
}
