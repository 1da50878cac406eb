//! A picture without its noise, and what it says of itself.

use super::{assert_refused, json, visavis};
use denoise::{Features, Network};
use film::{DisplayTransform, Image, LayerValues, Vec3};
use image_file::Kind;
use std::path::{Path, PathBuf};
use visavis_tests::TestFolder;

/// A noisy picture of the Cornell box, with features and without.
struct Pictures {
    folder: TestFolder,
    noisy: Image,
    features: [Vec<Vec3>; 2],
}

impl Pictures {
    fn new() -> Self {
        let folder = TestFolder::new();
        let path = folder.file("noisy.exr");
        let out = path.to_str().expect("a plain path");
        assert!(visavis(&["render", "cornell", "-o", out, "--size", "40x24", "--spp", "2"]).status.success());
        let noisy = image_file::load(&path).expect("an EXR");
        let of = |f: fn(f32) -> Vec3| (0..40 * 24).map(|pixel| f((pixel % 40) as f32 / 40.0)).collect::<Vec<_>>();
        let features = [of(|x| Vec3::new(x, 0.5, 1.0 - x)), of(|x| Vec3::new(x, 0.0, 1.0 - x))];
        let pictures = Pictures { folder, noisy, features };
        pictures.write_with_features(&path);
        pictures
    }

    fn write_with_features(&self, noisy: &Path) {
        let mut image = self.noisy.clone();
        for (name, feature) in ["albedo", "normal"].into_iter().zip(&self.features) {
            image = image.with_layer(name, LayerValues::Rgb(feature.clone().into()));
        }
        image = image.with_layer("depth", LayerValues::Numbers(vec![1.0; 40 * 24].into()));
        let mut records = image_file::records(noisy).expect("its records");
        records.push(("error.rmse".into(), "0.5".into()));
        let bytes = image_file::encode_with_read(Kind::Exr, &image, &DisplayTransform::default(), &records);
        std::fs::write(self.path("features.exr"), bytes.expect("an EXR")).expect("a file");
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.file(name)
    }

    fn file(&self, name: &str) -> String {
        self.path(name).to_str().expect("a plain path").to_owned()
    }

    fn denoise(&self, out: &str, options: &[&str]) -> String {
        let (from, out) = (self.file("features.exr"), self.file(out));
        let output = visavis(&[&["denoise", &from, "-o", &out], options].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stderr).into_owned()
    }

    fn record(&self, file: &str, name: &str) -> Option<String> {
        let records = image_file::records(&self.path(file)).expect("its records");
        records.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}

#[test]
fn a_picture_is_denoised_with_its_layers_and_says_by_what() {
    let pictures = Pictures::new();
    let [albedo, normal] = &pictures.features;
    for (filter, network) in [("unet", Network::small()), ("unet-base", Network::base())] {
        let network = network.expect("the weights");
        let said = pictures.denoise("out.exr", &["--filter", filter]);
        assert!(said.lines().count() == 1 && said.contains("which leaves a bias"), "{said}");
        let expected = network.denoise(&pictures.noisy, Features { albedo, normal }, &|| false).expect("a picture");
        assert_eq!(image_file::load(&pictures.path("out.exr")).expect("an EXR"), expected);
        let record = |name| pictures.record("out.exr", name);
        assert_eq!(record("denoise").as_deref(), Some(filter));
        assert_eq!(record("denoise.weights"), Some(network.hash()));
        assert_eq!((record("scene").as_deref(), record("error.rmse")), (Some("cornell"), None));
    }
    pictures.denoise("out.png", &["--filter", "atrous"]);
    let record = |name| pictures.record("out.png", name);
    assert_eq!(
        (record("denoise"), record("denoise.filter").as_deref(), record("denoise.weights")),
        (None, Some("atrous"), None)
    );
}

#[test]
fn who_measures_a_denoised_picture_is_told() {
    let pictures = Pictures::new();
    pictures.denoise("out.exr", &[]);
    let (noisy, denoised) = (pictures.file("noisy.exr"), pictures.file("out.exr"));
    let note = |arguments: &[&str]| String::from_utf8_lossy(&visavis(arguments).stderr).into_owned();
    let of_a = note(&["compare", &denoised, &noisy]);
    assert!(of_a.starts_with("note: A is denoised (unet): its errors are a bias too: "), "{of_a}");
    let of_b = note(&["compare", &noisy, &denoised]);
    assert!(of_b.starts_with("note: B is denoised (unet) and biased: it is no reference: "), "{of_b}");
    assert_eq!(note(&["compare", &noisy, &noisy]), "");
    assert_eq!(json(&visavis(&["compare", &denoised, &noisy, "--json"]))["denoised"], "unet");
    assert!(json(&visavis(&["compare", &noisy, &noisy, "--json"]))["denoised"].is_null());
    let twice = note(&["denoise", &denoised, "-o", &pictures.file("twice.exr")]);
    assert!(twice.starts_with("note: this picture was denoised before (unet): "), "{twice}");
}

#[test]
fn a_denoised_picture_is_made_again_with_its_noise() {
    let pictures = Pictures::new();
    pictures.denoise("out.exr", &[]);
    let again = pictures.file("again.exr");
    assert!(
        visavis(&["render", "--from", &pictures.file("out.exr"), "--denoise", "off", "-o", &again]).status.success()
    );
    assert_eq!(image_file::load(Path::new(&again)).expect("an EXR"), pictures.noisy);
}

#[test]
fn what_cannot_be_denoised_is_refused_in_one_line() {
    let pictures = Pictures::new();
    let (noisy, with, out) = (pictures.file("noisy.exr"), pictures.file("features.exr"), pictures.file("new.exr"));
    assert_refused(&["denoise", &noisy, "-o", &out], 1, &["albedo (R, G, B) and normal (X, Y, Z)", "by unet,", &noisy]);
    assert_refused(&["denoise", &noisy, "-o", &out, "--filter", "atrous"], 1, &["normal (X, Y, Z) and depth (Z)"]);
    assert_refused(&["denoise", &with, "-o", &with], 1, &["-o would overwrite the noisy picture", &with]);
    assert_refused(&["denoise", &with], 2, &["-o OUT.exr"]);
    assert_refused(&["denoise"], 2, &["visavis denoise A.exr -o OUT"]);
    assert_refused(&["denoise", "a.png", "-o", &out], 2, &["a.png", ".exr"]);
    assert_refused(&["denoise", &with, "-o", "b.jpg"], 2, &["b.jpg", ".png or .exr"]);
    assert_refused(&["denoise", &with, "-o", &out, "--filter", "nlm"], 2, &["unet, unet-base or atrous"]);
    assert_refused(&["denoise", "missing.exr", "-o", &out], 1, &["missing.exr"]);
    assert_eq!(pictures.folder.names(), ["features.exr", "noisy.exr"], "nothing is written");
}

/// Two parts of 1 and 3 samples differ by a variance that is 4 / 3 of one sample's, of which the mean has a quarter.
#[test]
fn halves_tell_the_variance_by_the_samples_that_they_have() {
    let pictures = Pictures::new();
    let [albedo, normal] = &pictures.features;
    let depth = vec![1.0; 40 * 24];
    let half = |bright: f32| pictures.noisy.map(|radiance| bright * radiance).radiances().to_vec();
    let write = |name: &str, samples: Option<[u32; 2]>| {
        let mut image = pictures.noisy.clone();
        for (name, values) in [("albedo", albedo), ("normal", normal), ("half0", &half(0.5)), ("half1", &half(1.5))] {
            image = image.with_layer(name, LayerValues::Rgb(values.clone().into()));
        }
        let image = image.with_layer("depth", LayerValues::Depths(depth.clone().into()));
        let records = samples.into_iter().flat_map(technique::Halves::records);
        let records: Vec<_> = records.map(|(name, value)| (name.to_owned(), value)).collect();
        let bytes = image_file::encode_with_read(Kind::Exr, &image, &DisplayTransform::default(), &records);
        std::fs::write(pictures.path(name), bytes.expect("an EXR")).expect("a file");
    };
    let features = film::Features::new((40, 24), albedo.clone(), normal.clone(), depth.clone()).expect("features");
    for (samples, share) in [(None, 0.25), (Some([1, 3]), 3.0 / 16.0), (Some([2, 2]), 0.25)] {
        write("features.exr", samples);
        pictures.denoise("out.exr", &["--filter", "atrous"]);
        let difference = |radiance: &Vec3| film::colour::luminance(0.5 * *radiance - 1.5 * *radiance);
        let variance: Vec<f32> =
            pictures.noisy.radiances().iter().map(|radiance| share * difference(radiance).powi(2)).collect();
        let expected = technique::Denoiser::ATrous
            .apply(&pictures.noisy, &features, Some(&variance), &technique::Filters::on_the_processor(), &|| false)
            .expect("a picture");
        let made = image_file::load(&pictures.path("out.exr")).expect("an EXR");
        let off =
            made.radiances().iter().zip(expected.radiances()).map(|(a, b)| (*a - *b).length() / (1.0 + b.length()));
        assert!(off.fold(0.0, f32::max) < 1e-4, "{samples:?}");
        assert!(pictures.record("out.exr", "half0.samples").is_none(), "it has no halves");
    }
}
