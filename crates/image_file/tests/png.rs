//! What other programs' PNGs are read as, and records that have been through them.

#![expect(clippy::unwrap_used, reason = "a test stops at the first thing that is not as it must be")]

use film::{DisplayTransform, Image, Vec3, colour};
use image_file::{Kind, Loaded, encode, read, records};
use png::chunk::ChunkType;
use png::text_metadata::{ITXtChunk, TEXtChunk, ZTXtChunk};
use png::{BitDepth, ColorType, Encoder, Writer};
use std::fs::File;
use std::path::{Path, PathBuf};
use visavis_tests::TestFolder;

/// A picture of one row.
fn write(path: &Path, (kind, depth): (ColorType, BitDepth), pixels: &[u8], set: impl Fn(&mut Writer<File>)) {
    let width = match (kind, depth) {
        (ColorType::Indexed, _) => pixels.len(),
        (_, BitDepth::Sixteen) => pixels.len() / kind.samples() / 2,
        (_, BitDepth::Eight) => pixels.len() / kind.samples(),
        (_, depth) => 8 / depth as usize,
    };
    let mut encoder = Encoder::new(File::create(path).unwrap(), width as u32, 1);
    encoder.set_color(kind);
    encoder.set_depth(depth);
    if kind == ColorType::Indexed {
        encoder.set_palette(vec![0, 0, 0, 255, 0, 0, 0, 188, 0]);
        encoder.set_trns(vec![255, 255, 128]);
    }
    let mut writer = encoder.write_header().unwrap();
    set(&mut writer);
    writer.write_image_data(pixels).unwrap();
    writer.finish().unwrap();
}

fn written((kind, depth): (ColorType, BitDepth), pixels: &[u8], chunks: &[(&[u8; 4], &[u8])]) -> Loaded {
    let folder = TestFolder::new();
    let path = folder.file("a.png");
    let set = |writer: &mut Writer<File>| {
        chunks.iter().for_each(|(name, data)| writer.write_chunk(ChunkType(**name), data).unwrap());
    };
    write(&path, (kind, depth), pixels, set);
    read(&path).unwrap()
}

/// Grey of byte 188, half as bright as white in sRGB, with these chunks.
fn grey_188(chunks: &[(&[u8; 4], &[u8])]) -> Loaded {
    written((ColorType::Grayscale, BitDepth::Eight), &[188], chunks)
}

fn first(loaded: &Loaded) -> Vec3 {
    loaded.image.radiances()[0]
}

fn note(loaded: &Loaded) -> &str {
    let [note] = &loaded.notes[..] else { panic!("{:?}", loaded.notes) };
    assert!(note.ends_with("a.png") && note.lines().count() == 1, "{note}");
    note
}

const SRGB: (&[u8; 4], &[u8]) = (b"sRGB", &[0]);

#[test]
fn every_kind_and_depth_is_read_as_what_it_shows() {
    let half = colour::srgb_decode(188.0 / 255.0);
    let [white, black] = [Vec3::ONE, Vec3::ZERO];
    for (kind, depth, pixels, expected) in [
        (ColorType::Grayscale, BitDepth::One, &[0b1010_0000][..], vec![white, black, white]),
        (ColorType::Grayscale, BitDepth::Four, &[0xf0], vec![white, black]),
        (ColorType::Grayscale, BitDepth::Eight, &[188, 255], vec![Vec3::splat(half), white]),
        (ColorType::Grayscale, BitDepth::Sixteen, &[188, 188, 255, 255], vec![Vec3::splat(half), white]),
        (ColorType::Rgb, BitDepth::Eight, &[188, 0, 255], vec![Vec3::new(half, 0.0, 1.0)]),
        (ColorType::Rgb, BitDepth::Sixteen, &[188, 188, 0, 0, 255, 255], vec![Vec3::new(half, 0.0, 1.0)]),
        (ColorType::Indexed, BitDepth::Eight, &[1, 0], vec![Vec3::X, black]),
        (ColorType::Rgba, BitDepth::Eight, &[188, 0, 255, 255], vec![Vec3::new(half, 0.0, 1.0)]),
    ] {
        let loaded = written((kind, depth), pixels, &[]);
        let read = &loaded.image.radiances()[..expected.len()];
        assert!(
            read.iter().zip(&expected).all(|(a, b)| (*a - *b).abs().max_element() < 1e-6),
            "{kind:?} {depth:?} {read:?}"
        );
        assert!(loaded.notes.is_empty(), "{:?}", loaded.notes);
    }
}

#[test]
fn what_a_picture_lets_through_is_black() {
    let half = colour::srgb_decode(188.0 / 255.0);
    for (kind, pixels) in [(ColorType::Rgba, &[188, 188, 188, 51][..]), (ColorType::GrayscaleAlpha, &[188, 51])] {
        let loaded = written((kind, BitDepth::Eight), pixels, &[]);
        assert!((first(&loaded) - Vec3::splat(0.2 * half)).abs().max_element() < 1e-6, "{:?}", loaded.image);
        assert!(note(&loaded).contains("alpha"));
    }
    let palette = written((ColorType::Indexed, BitDepth::Eight), &[2], &[]);
    assert!((first(&palette).y - 128.0 / 255.0 * half).abs() < 1e-6 && note(&palette).contains("alpha"));
}

#[test]
fn a_gamma_is_undone_unless_the_picture_says_that_it_is_srgb() {
    let (code, srgb) = (188.0_f32 / 255.0, colour::srgb_decode(188.0 / 255.0));
    let gamma = |value: u32| value.to_be_bytes();
    let [linear, of_2_2, of_4] = [100_000, 45_455, 25_000].map(gamma);
    for (chunks, expected) in [
        (&[(b"gAMA", &linear[..])][..], code),
        (&[(b"gAMA", &of_2_2)], code.powf(2.2)),
        (&[(b"gAMA", &of_4)], code.powf(4.0)),
        (&[SRGB, (b"gAMA", &linear)], srgb),
        (&[(b"gAMA", &linear), SRGB], srgb),
        (&[(b"cICP", &[1, 13, 0, 1])], srgb),
        (&[], srgb),
    ] {
        let loaded = grey_188(chunks);
        assert!((first(&loaded).x - expected).abs() < 1e-5, "{chunks:?} {:?}", loaded.image);
        assert!(loaded.notes.is_empty(), "{:?}", loaded.notes);
    }
}

#[test]
fn what_is_not_applied_is_told_of() {
    let srgb = colour::srgb_decode(188.0 / 255.0);
    // a profile of nothing, packed without compression: its name, method 0, and zlib's stored block of one byte
    let profile = b"mine\0\0\x78\x01\x01\x01\x00\xfe\xff\x00\x00\x01\x00\x01";
    for (chunks, words) in [
        (&[(b"gAMA", &[0, 0, 0, 0][..])][..], "its chunk gAMA is damaged"),
        (&[(b"gAMA", &[1, 2])], "its chunk gAMA is damaged"),
        (&[(b"iCCP", &profile[..])], "its colour profile (iCCP) is not applied"),
        (&[(b"cICP", &[9, 16, 0, 1])], "its code points (cICP) are not those of sRGB"),
        (&[(b"pHYs", &[0, 0, 0, 1, 0, 0, 0, 2, 0])], "2.000 times as wide as high"),
        (&[(b"pHYs", &[0, 0, 0, 0, 0, 0, 0, 2, 0])], "makes no sense"),
        (&[(b"pHYs", &[0, 0, 0, 1, 0, 0, 0, 0, 0])], "makes no sense"),
    ] {
        let loaded = grey_188(chunks);
        assert!(note(&loaded).contains(words), "{:?}", loaded.notes);
        assert!((first(&loaded).x - srgb).abs() < 1e-6, "{words}");
    }
}

#[test]
fn other_primaries_are_converted() {
    // white, red, green and blue of Rec. 2020, in hundred-thousandths
    let places = [31270, 32900, 70800, 29200, 17000, 79700, 13100, 4600].map(u32::to_be_bytes).concat();
    let red = written((ColorType::Rgb, BitDepth::Eight), &[255, 0, 0], &[(b"cHRM", &places)]);
    // ITU-R BT.2087-0, to the digits that it prints
    assert!((first(&red) - Vec3::new(1.6605, -0.1246, -0.0182)).abs().max_element() < 1e-4, "{:?}", red.image);
    assert!(note(&red).contains("other primaries"));
    let named_srgb = written((ColorType::Rgb, BitDepth::Eight), &[255, 0, 0], &[SRGB, (b"cHRM", &places)]);
    assert_eq!((first(&named_srgb), named_srgb.notes.len()), (Vec3::X, 0));
}

/// A PNG with what `set` writes before its pixels, and `end` behind them.
fn with_texts(folder: &TestFolder, set: impl Fn(&mut Writer<File>), end: impl Fn(&mut Writer<File>)) -> PathBuf {
    let path = folder.file("a.png");
    let mut writer = Encoder::new(File::create(&path).unwrap(), 1, 1).write_header().unwrap();
    set(&mut writer);
    writer.write_image_data(&[1]).unwrap();
    end(&mut writer);
    writer.finish().unwrap();
    path
}

#[test]
fn records_are_found_in_every_kind_of_text_before_and_behind_the_pixels() {
    let all = |writer: &mut Writer<File>| {
        let mut packed = ITXtChunk::new("visavis.packed", "a\u{e9}\u{4e16}");
        packed.compressed = true;
        writer.write_text_chunk(&ITXtChunk::new("visavis.scene", "cornell")).unwrap();
        writer.write_text_chunk(&packed).unwrap();
        writer.write_text_chunk(&TEXtChunk::new("visavis.spp", "64")).unwrap();
        writer.write_text_chunk(&ZTXtChunk::new("visavis.seed", "7")).unwrap();
        writer.write_text_chunk(&TEXtChunk::new("Comment", "no record")).unwrap();
    };
    let folder = TestFolder::new();
    let expected = [("scene", "cornell"), ("packed", "a\u{e9}\u{4e16}"), ("spp", "64"), ("seed", "7")];
    let expected = expected.map(|(name, value)| (name.to_owned(), value.to_owned()));
    for path in [with_texts(&folder, all, |_| ()), with_texts(&folder, |_| (), all)] {
        assert_eq!(records(&path).unwrap(), expected);
    }
}

#[test]
fn texts_without_end_are_refused_and_damaged_ones_cost_no_other() {
    let folder = TestFolder::new();
    let bomb = |writer: &mut Writer<File>| {
        let mut bomb = ITXtChunk::new("visavis.scene", "a".repeat(20 << 20));
        bomb.compressed = true;
        writer.write_text_chunk(&bomb).unwrap();
    };
    let path = with_texts(&folder, bomb, |_| ());
    assert!(path.metadata().unwrap().len() < 1 << 20);
    let Err(said) = records(&path).map(|_| ()) else { panic!("it is unpacked") };
    let said = said.to_string();
    assert!(said.contains("visavis.scene") && said.lines().count() == 1, "{said}");
    assert!(read(&path).is_ok());
    let damaged = |writer: &mut Writer<File>| {
        writer.write_chunk(ChunkType(*b"iTXt"), b"visavis.scene\0\0\0\0\0\xff\xfe").unwrap();
        writer.write_chunk(ChunkType(*b"iTXt"), b"no end of the keyword").unwrap();
        writer.write_text_chunk(&ITXtChunk::new("visavis.spp", "64")).unwrap();
    };
    let read = records(&with_texts(&folder, damaged, |_| ())).unwrap();
    assert_eq!(read, [("spp".to_owned(), "64".to_owned())]);
}

#[test]
fn records_and_pixels_of_this_program_come_back() {
    let folder = TestFolder::new();
    let image = Image::new(2, 1, [Vec3::new(0.25, 0.5, 1.0), Vec3::ZERO]).unwrap();
    for kind in [Kind::Png, Kind::Exr] {
        let path = folder.file(if kind == Kind::Png { "own.png" } else { "own.exr" });
        let bytes = encode(kind, &image, &DisplayTransform::default(), &vec![("spp", "64".into())]).unwrap();
        std::fs::write(&path, bytes).unwrap();
        let loaded = read(&path).unwrap();
        assert_eq!((records(&path).unwrap(), loaded.notes), (vec![("spp".to_owned(), "64".to_owned())], vec![]));
        let difference = (first(&read(&path).unwrap()) - image.radiances()[0]).abs().max_element();
        // half a step of a byte at white, where steps are longest
        assert!(difference < if kind == Kind::Png { 0.005 } else { f32::MIN_POSITIVE }, "{difference}");
    }
}
