//! What other programs' EXRs are read as.

#![expect(clippy::unwrap_used, reason = "a test stops at the first thing that is not as it must be")]

use exr::prelude as exr;
use film::{DisplayTransform, Image, LayerValues, Vec3};
use image_file::{Kind, Loaded, load_layer, load_layers, read};
use std::path::PathBuf;
use visavis_tests::TestFolder;

type Part = exr::Layer<exr::AnyChannels<exr::FlatSamples>>;

/// A part of 32-bit channels that are given pixel by pixel, rows from the top.
fn part(name: &str, size: (usize, usize), channels: &[(&str, &[f32])]) -> Part {
    let channels =
        channels.iter().map(|(name, values)| exr::AnyChannel::new(*name, exr::FlatSamples::F32(values.to_vec())));
    let channels = exr::AnyChannels::sort(channels.collect());
    exr::Layer::new(size, exr::LayerAttributes::named(name), exr::Encoding::FAST_LOSSLESS, channels)
}

fn grey(size: (usize, usize), values: &[f32]) -> Part {
    part("part", size, &[("R", values), ("G", values), ("B", values)])
}

/// A part whose data window begins there.
fn at(mut part: Part, position: (i32, i32)) -> Part {
    part.attributes.layer_position = position.into();
    part
}

fn window(position: (i32, i32), size: (usize, usize)) -> exr::ImageAttributes {
    exr::ImageAttributes::new(exr::IntegerBounds::new(position, size))
}

fn write(folder: &TestFolder, attributes: exr::ImageAttributes, parts: impl IntoIterator<Item = Part>) -> PathBuf {
    use exr::WritableImage as _;
    let path = folder.file("a.exr");
    let parts: exr::Layers<_> = parts.into_iter().collect();
    exr::Image::from_layers(attributes, parts).write().to_file(&path).unwrap();
    path
}

fn written(attributes: exr::ImageAttributes, parts: impl IntoIterator<Item = Part>) -> Result<Loaded, String> {
    let folder = TestFolder::new();
    read(&write(&folder, attributes, parts)).map_err(|fault| fault.to_string())
}

/// The red of each pixel.
fn reds(loaded: &Loaded) -> Vec<f32> {
    loaded.image.radiances().iter().map(|radiance| radiance.x).collect()
}

fn note(loaded: &Loaded) -> &str {
    let [note] = &loaded.notes[..] else { panic!("{:?}", loaded.notes) };
    assert!(note.ends_with("a.exr") && note.lines().count() == 1, "{note}");
    note
}

#[test]
fn a_picture_is_read_over_its_display_window() {
    let two = |position| at(grey((2, 1), &[1.0, 2.0]), position);
    for (display, data, expected, words) in [
        // cropped at either end
        (window((0, 0), (3, 2)), two((0, 0)), vec![1.0, 2.0, 0.0, 0.0, 0.0, 0.0], "black where there is no data"),
        (window((0, 0), (3, 2)), two((1, 1)), vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0], "2x1 pixels at (1, 1)"),
        // more than is shown, and elsewhere
        (window((0, 0), (1, 1)), two((-1, 0)), vec![2.0], "without the data outside of it"),
        (window((0, 0), (2, 1)), two((1, 0)), vec![0.0, 1.0], "black where there is no data, without the data outside"),
        (window((-5, 7), (2, 1)), two((5, 7)), vec![0.0, 0.0], "its display window, 2x1 pixels at (-5, 7)"),
    ] {
        let loaded = written(display, [data]).unwrap();
        assert_eq!(reds(&loaded), expected, "{words}");
        assert!(note(&loaded).contains(words), "{:?} lacks {words}", loaded.notes);
    }
    let elsewhere = written(window((-5, 7), (2, 1)), [two((-5, 7))]).unwrap();
    assert_eq!((reds(&elsewhere), elsewhere.notes.len()), (vec![1.0, 2.0], 0));
}

#[test]
fn two_regions_of_a_picture_have_its_size_and_their_notes() {
    let display = || window((0, 0), (2, 2));
    let first = written(display(), [at(grey((1, 1), &[1.0]), (0, 0))]).unwrap();
    let second = written(display(), [at(grey((1, 1), &[1.0]), (1, 1))]).unwrap();
    assert_eq!((reds(&first), reds(&second)), (vec![1.0, 0.0, 0.0, 0.0], vec![0.0, 0.0, 0.0, 1.0]));
    assert!(note(&first).contains("data window") && note(&second).contains("data window"));
}

#[test]
fn the_picture_is_found_among_layers() {
    let named = |names: &[&str]| {
        // a layer's red is its place in the row
        let values: Vec<[f32; 1]> = (0..names.len()).map(|place| [place as f32]).collect();
        let channels: Vec<(String, &[f32])> = names.iter().zip(&values).map(|(n, v)| (n.to_string(), &v[..])).collect();
        let channels: Vec<(&str, &[f32])> = channels.iter().map(|(name, values)| (&name[..], *values)).collect();
        written(window((0, 0), (1, 1)), [part("part", (1, 1), &channels)])
    };
    let blender = named(&["ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"]).unwrap();
    assert_eq!((reds(&blender), blender.notes.len()), (vec![0.0], 0));
    let [r, g, b] = [["AO.R", "AO.G", "AO.B"], ["V.Combined.R", "V.Combined.G", "V.Combined.B"], ["R", "G", "B"]];
    let with_others = named(&[&r[..], &g[..]].concat()).unwrap();
    assert_eq!(reds(&with_others), [3.0]);
    assert!(note(&with_others).starts_with("of its layers AO, V.Combined this is V.Combined"));
    let outside = named(&[&r[..], &g[..], &b[..]].concat()).unwrap();
    assert_eq!(reds(&outside), [6.0]);
    assert!(note(&outside).contains("this is R, G, B"));
    let several = named(&["AO.R", "AO.G", "AO.B", "Diff.R", "Diff.G", "Diff.B"]).unwrap_err();
    assert!(several.contains("several pictures") && several.contains("AO, Diff"), "{several}");
    for none in [&["R"][..], &["R", "G"], &["Z", "ViewLayer.Depth.Z"], &["N.X", "N.Y", "N.Z"], &["X", "Y", "Z"]] {
        let said = named(none).unwrap_err();
        assert!(said.contains("its channels are ") && said.contains(none[0]), "{said}");
    }
}

#[test]
fn luminance_is_grey_and_chroma_its_colour() {
    let luminance = written(window((0, 0), (1, 1)), [part("part", (1, 1), &[("Y", &[0.25])])]).unwrap();
    assert_eq!((luminance.image.radiances(), luminance.notes.len()), (&[Vec3::splat(0.25)][..], 0));
    let colour = Vec3::new(0.5, 0.25, 1.0);
    let y = film::colour::luminance(colour);
    let chroma = [("Y", &[y][..]), ("RY", &[(colour.x - y) / y]), ("BY", &[(colour.z - y) / y])];
    let loaded = written(window((0, 0), (1, 1)), [part("part", (1, 1), &chroma)]).unwrap();
    // the shares of luminance have four digits in one place and more in the other
    assert!((loaded.image.radiances()[0] - colour).abs().max_element() < 1e-3, "{:?}", loaded.image);
}

#[test]
fn of_several_parts_the_one_that_is_named_as_the_picture_is_read_or_else_the_first_and_told_of() {
    let colour = |name, value: &[f32; 1]| part(name, (1, 1), &[("R", value), ("G", value), ("B", value)]);
    let layer = |name, value: &[f32; 1]| part(name, (1, 1), &[("L.R", value), ("L.G", value), ("L.B", value)]);
    let only = |name, channel, value: &[f32; 1]| part(name, (1, 1), &[(channel, value)]);
    let motion = || part("motion", (1, 1), &[("X", &[8.0]), ("Y", &[9.0])]);
    let (one, two) = (&[1.0], &[2.0]);
    for (parts, expected, told) in [
        (
            vec![only("depth", "depth.Y", &[9.0]), colour("one", one), colour("two", two)],
            1.0,
            "depth, one, two this is one",
        ),
        (vec![colour("albedo", one), colour("beauty", two)], 2.0, "albedo, beauty this is beauty"),
        (vec![colour("V.AO", one), colour("V.Combined", two)], 2.0, "V.AO, V.Combined this is V.Combined"),
        (vec![layer("left", one), colour("right", two)], 2.0, "left: L, right this is right"),
        (vec![only("a", "Y", one), only("b", "Y", two)], 1.0, "a, b this is a"),
        (vec![only("a", "Y", one), only("rgb", "Y", two)], 2.0, "a, rgb this is rgb"),
    ] {
        let loaded = written(window((0, 0), (1, 1)), parts).unwrap();
        assert_eq!(reds(&loaded), [expected], "{told}");
        assert!(note(&loaded).starts_with(&format!("of its layers {told}")), "{:?}", loaded.notes);
    }
    // a place or a direction is no luminance, and no picture either
    let lone = written(window((0, 0), (1, 1)), [motion(), only("lum", "Y", two)]).unwrap();
    assert_eq!((reds(&lone), lone.notes.len()), (vec![2.0], 0));
    let same = written(window((0, 0), (1, 1)), [layer("left", one), layer("right", two)]).unwrap_err();
    assert!(same.contains("several pictures") && same.contains("left: L, right: L"), "{same}");
}

#[test]
fn a_layer_is_read_by_the_name_of_its_part() {
    let value = |name, value: &[f32; 1]| part(name, (1, 1), &[("R", value), ("G", value), ("B", value)]);
    let folder = TestFolder::new();
    let path = write(&folder, window((0, 0), (1, 1)), [value("one", &[1.0]), value("two", &[2.0])]);
    assert_eq!(load_layer(&path, "two", (1, 1)).unwrap(), Some(LayerValues::Rgb([Vec3::splat(2.0)].into())));
}

#[test]
fn layers_come_back_as_what_they_are_beside_the_picture() {
    let image = Image::new(2, 1, vec![Vec3::splat(4.0), Vec3::ONE]).unwrap();
    let layers = [
        ("albedo", LayerValues::Rgb([Vec3::X, Vec3::splat(0.5)].into()), vec!["B", "G", "R"]),
        ("normal", LayerValues::Directions([Vec3::NEG_Y, Vec3::ZERO].into()), vec!["X", "Y", "Z"]),
        ("depth", LayerValues::Depths([2.5, f32::INFINITY].into()), vec!["Z"]),
        ("weight", LayerValues::Numbers([0.25, 1.0].into()), vec!["Y"]),
    ];
    let with_layers =
        layers.iter().fold(image.clone(), |image, (name, values, _)| image.with_layer(name, values.clone()));
    let records = vec![("scene", "cornell".to_owned())];
    let bytes = image_file::encode(Kind::Exr, &with_layers, &DisplayTransform::default(), &records).unwrap();
    let folder = TestFolder::new();
    let path = folder.file("layers.exr");
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(
        read(&path).unwrap(),
        Loaded { image, notes: Vec::new() },
        "the picture is the radiance, and nothing is told"
    );
    let meta = exr::MetaData::read_from_file(&path, true).unwrap();
    for (name, values, channels) in layers {
        assert_eq!(load_layer(&path, name, (2, 1)).unwrap(), Some(values), "{name}");
        let part = meta.headers.iter().find(|part| part.own_attributes.layer_name.as_ref().unwrap().eq(name)).unwrap();
        let named: Vec<_> = part.channels.list.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(named, channels, "{name}");
    }
    assert_eq!(load_layer(&path, "depth", (1, 1)).unwrap(), None, "of another size");
}

#[test]
fn samples_of_every_type_and_files_of_every_make_are_read() {
    let values = [0.0, 0.5, 1.0, 2.0, 3.0, 4.0];
    let types = [
        exr::FlatSamples::F32(values.to_vec()),
        exr::FlatSamples::F16(values.iter().map(|v| exr::f16::from_f32(*v)).collect()),
    ];
    let tiles = exr::Blocks::Tiles(exr::Vec2(2, 2));
    for samples in types {
        for (blocks, compression) in [
            (exr::Blocks::ScanLines, exr::Compression::Uncompressed),
            (exr::Blocks::ScanLines, exr::Compression::PIZ),
            (tiles, exr::Compression::ZIP1),
            (tiles, exr::Compression::RLE),
        ] {
            let channels = ["R", "G", "B"].map(|name| exr::AnyChannel::new(name, samples.clone()));
            let encoding = exr::Encoding { compression, blocks, line_order: exr::LineOrder::Increasing };
            let channels = exr::AnyChannels::sort(channels.into_iter().collect());
            let layer = exr::Layer::new((3, 2), exr::LayerAttributes::named("part"), encoding, channels);
            let loaded = written(window((0, 0), (3, 2)), [layer]).unwrap();
            assert_eq!((reds(&loaded), loaded.notes.len()), (values.to_vec(), 0), "{compression:?}");
        }
    }
}

#[test]
fn other_primaries_are_converted_and_rec_709_is_left_to_the_last_bit() {
    use ::exr::meta::attribute::Chromaticities;
    let of = |[red, green, blue]: [(f32, f32); 3], colour: [f32; 3]| {
        let mut attributes = window((0, 0), (1, 1));
        let [red, green, blue] = [red, green, blue].map(exr::Vec2::from);
        attributes.chromaticities = Some(Chromaticities { red, green, blue, white: (0.3127, 0.329).into() });
        let [r, g, b] = colour.map(|value| [value]);
        written(attributes, [part("part", (1, 1), &[("R", &r), ("G", &g), ("B", &b)])]).unwrap()
    };
    let (rec_709, rec_2020) =
        ([(0.64, 0.33), (0.3, 0.6), (0.15, 0.06)], [(0.708, 0.292), (0.17, 0.797), (0.131, 0.046)]);
    let same = of(rec_709, [0.1, 0.2, 0.3]);
    assert_eq!((same.image.radiances(), same.notes.len()), (&[Vec3::new(0.1, 0.2, 0.3)][..], 0));
    let red = of(rec_2020, [1.0, 0.0, 0.0]);
    // ITU-R BT.2087-0, to the digits that it prints
    let expected = Vec3::new(1.6605, -0.1246, -0.0182);
    assert!((red.image.radiances()[0] - expected).abs().max_element() < 1e-4, "{:?}", red.image);
    assert!(note(&red).contains("other primaries"));
    let nothing = of([(0.0, 0.0); 3], [0.1, 0.2, 0.3]);
    assert_eq!(nothing.image.radiances(), [Vec3::new(0.1, 0.2, 0.3)]);
    assert!(note(&nothing).contains("span no colours"));
}

#[test]
fn alpha_and_oblong_pixels_are_told_of() {
    let translucent = [("R", &[0.5][..]), ("G", &[0.5]), ("B", &[0.5]), ("A", &[0.5])];
    let loaded = written(window((0, 0), (1, 1)), [part("part", (1, 1), &translucent)]).unwrap();
    assert_eq!(reds(&loaded), [0.5]);
    assert!(note(&loaded).contains("alpha"));
    let opaque = [("R", &[0.5][..]), ("G", &[0.5]), ("B", &[0.5]), ("A", &[1.0])];
    let loaded = written(window((0, 0), (1, 1)), [part("part", (1, 1), &opaque)]).unwrap();
    assert!(loaded.notes.is_empty());
    let folder = TestFolder::new();
    let path = write(&folder, window((0, 0), (1, 1)), [grey((1, 1), &[1.0])]);
    let bytes = std::fs::read(&path).unwrap();
    let name = b"pixelAspectRatio\0float\0\x04\0\0\0";
    let place = bytes.windows(name.len()).position(|bytes| bytes == name).unwrap() + name.len();
    for (aspect, words) in [(2.0, "2.000 times as wide"), (f32::NAN, "makes no sense"), (0.0, "makes no sense")] {
        let mut oblong = bytes.clone();
        oblong[place..place + 4].copy_from_slice(&f32::to_le_bytes(aspect));
        std::fs::write(&path, oblong).unwrap();
        assert!(note(&read(&path).unwrap()).contains(words), "{aspect}");
    }
}

#[test]
fn a_display_window_without_end_is_refused_before_memory_is_taken() {
    let said = written(window((0, 0), (1 << 20, 1 << 20)), [grey((1, 1), &[1.0])]).unwrap_err();
    assert!(said.contains("1048576x1048576 pixels are more than"), "{said}");
}

/// As the house, as a renderer with one part, and as Blender with one part for each view layer.
#[test]
fn features_are_read_by_the_names_that_renderers_give_them() {
    let [a, b, c]: [&[f32]; 3] = [&[1.0, 2.0], &[3.0, 4.0], &[5.0, 6.0]];
    let size = (2, 1);
    let colour = [("R", c), ("G", b), ("B", a)];
    let other = part("small", (1, 1), &[("albedo.R", &[0.0]), ("albedo.G", &[0.0]), ("albedo.B", &[0.0])]);
    let in_parts = vec![
        other,
        part("radiance", size, &colour),
        part("albedo", size, &[("R", a), ("G", b), ("B", c)]),
        part("normal", size, &[("X", a), ("Y", b), ("Z", c)]),
        part("depth", size, &[("Y", a)]),
    ];
    let layers = [("albedo.R", a), ("albedo.G", b), ("albedo.B", c), ("normal.X", a), ("normal.Y", b), ("normal.Z", c)];
    let in_one = vec![part("picture", size, &[&colour[..], &layers, &[("Z", a)]].concat())];
    let of_blender = ["R", "G", "B"].map(|name| format!("ViewLayer.Denoising Albedo.{name}"));
    let normals = ["X", "Y", "Z"].map(|name| format!("ViewLayer.Denoising Normal.{name}"));
    let names: Vec<(&str, &[f32])> =
        of_blender.iter().chain(&normals).map(String::as_str).zip([a, b, c, a, b, c]).collect();
    let blenders = vec![part("ViewLayer", size, &[&names[..], &[("ViewLayer.Depth.Z", a)]].concat())];
    let folder = TestFolder::new();
    let expected = vec![Vec3::new(1.0, 3.0, 5.0), Vec3::new(2.0, 4.0, 6.0)];
    for parts in [in_parts, in_one, blenders] {
        let layers = load_layers(&write(&folder, window((0, 0), size), parts), (2, 1)).unwrap();
        assert_eq!(layers.triples("albedo"), Some(expected.clone()));
        assert_eq!(layers.triples("normal"), Some(expected.clone()));
        assert_eq!(layers.depth(), Some(a.to_vec()));
        assert_eq!(layers.triples("half0"), None);
    }
    let layers = load_layers(&write(&folder, window((0, 0), size), [part("radiance", size, &colour)]), (2, 1)).unwrap();
    assert_eq!((layers.triples("albedo"), layers.depth()), (None, None));
}
