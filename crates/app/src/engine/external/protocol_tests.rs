//! Packets as renderers send them, and what is no packet.

use super::*;

/// A packet of this kind with its length.
pub fn packet(kind: u8, payload: &[u8]) -> Vec<u8> {
    let length = u32::try_from(payload.len() + 5).expect("a short packet");
    [&length.to_le_bytes()[..], &[kind], payload].concat()
}

fn text(text: &str) -> Vec<u8> {
    [text.as_bytes(), &[0]].concat()
}

fn wholes(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

fn names(channels: &[&str]) -> Vec<u8> {
    channels.iter().flat_map(|name| text(name)).collect()
}

/// The packet by which a picture of this name, size and channels begins.
pub fn create(name: &str, (width, height): (i32, i32), channels: &[&str]) -> Vec<u8> {
    let sides = wholes(&[width, height, channels.len() as i32]);
    packet(4, &[vec![1], text(name), sides, names(channels)].concat())
}

/// A tile of one channel, as pbrt sends it.
pub fn update(name: &str, channel: &str, rect: [i32; 4], values: &[f32]) -> Vec<u8> {
    packet(3, &[vec![0], text(name), text(channel), wholes(&rect), floats(values)].concat())
}

/// A tile of several channels, one after the other.
pub fn update_planes(name: &str, channels: &[&str], rect: [i32; 4], values: &[f32]) -> Vec<u8> {
    let count = wholes(&[channels.len() as i32]);
    packet(5, &[vec![0], text(name), count, names(channels), wholes(&rect), floats(values)].concat())
}

/// A tile of several channels, whose numbers stand at these offsets and strides, as tev's own clients send it.
pub fn update_strided(name: &str, channels: &[&str], rect: [i32; 4], places: [&[i64]; 2], values: &[f32]) -> Vec<u8> {
    let count = wholes(&[channels.len() as i32]);
    let places: Vec<u8> = places.concat().iter().flat_map(|place| place.to_le_bytes()).collect();
    packet(6, &[vec![0], text(name), count, names(channels), wholes(&rect), places, floats(values)].concat())
}

fn fault(packet: &[u8]) -> String {
    parse(packet).expect_err("no packet")
}

#[test]
fn a_picture_begins_with_its_name_size_and_channels() {
    let new = NewPicture {
        name: "my été".into(),
        size: (640, 480),
        channels: ["R", "G", "B", "A"].map(str::to_owned).into(),
    };
    assert_eq!(parse(&create("my été", (640, 480), &["R", "G", "B", "A"])), Ok(Packet::Create(new)));
    // byte by byte as tev's README and pbrt have it
    let bytes = b"\x1b\0\0\0\x04\x01ab\0\x02\0\0\0\x01\0\0\0\x03\0\0\0R\0G\0B\0";
    assert_eq!(bytes[..], create("ab", (2, 1), &["R", "G", "B"])[..]);
}

#[test]
fn all_three_kinds_of_tiles_say_the_same() {
    let rect = [3, 4, 2, 1];
    let planes = update_planes("a", &["R", "B"], rect, &[1.0, 2.0, 3.0, 4.0]);
    let woven = update_strided("a", &["R", "B"], rect, [&[0, 1], &[2, 2]], &[1.0, 3.0, 2.0, 4.0]);
    for packet in [&planes, &woven] {
        let Ok(Packet::Update(tile)) = parse(packet) else { panic!("no tile") };
        let values = |channel: usize| tile.values(&tile.channels[channel]).collect::<Vec<_>>();
        assert_eq!((values(0), values(1)), (vec![1.0, 2.0], vec![3.0, 4.0]));
        assert_eq!((tile.name.as_str(), tile.corner, tile.size), ("a", (3, 4), (2, 1)));
        assert_eq!(tile.channels.iter().map(|channel| channel.name.as_str()).collect::<Vec<_>>(), ["R", "B"]);
    }
    let single = update("a", "G", rect, &[5.0, 6.0]);
    let Ok(Packet::Update(tile)) = parse(&single) else { panic!("no tile") };
    assert_eq!(tile.values(&tile.channels[0]).collect::<Vec<_>>(), [5.0, 6.0]);
}

#[test]
fn a_tile_in_parts_has_the_same_numbers_in_the_same_places() {
    let values: Vec<f32> = (0..2 * 5 * 3).map(|i| i as f32).collect();
    let woven = update_strided("a", &["R", "B"], [3, 4, 5, 3], [&[1, 0], &[2, 2]], &values);
    let Ok(Packet::Update(tile)) = parse(&woven) else { panic!("no tile") };
    let numbers = |tile: &Tile, channel: usize| tile.values(&tile.channels[channel]).collect::<Vec<_>>();
    for (most, corners, last) in [(1, vec![4, 5, 6], 1), (12, vec![4, 6], 1), (15, vec![4], 3)] {
        let parts: Vec<Tile> = tile.parts(most).collect();
        assert_eq!(
            parts.iter().map(|part| part.corner).collect::<Vec<_>>(),
            corners.into_iter().map(|y| (3, y)).collect::<Vec<_>>()
        );
        assert_eq!(parts.last().map(|part| part.size), Some((5, last)));
        for channel in [0, 1] {
            let put_together: Vec<f32> = parts.iter().flat_map(|part| numbers(part, channel)).collect();
            assert_eq!(put_together, numbers(&tile, channel), "of {most} pixels");
        }
    }
}

#[test]
fn files_graphics_and_ends_are_told_apart() {
    let named = |kind: u8, grabs: bool| packet(kind, &[if grabs { vec![1] } else { vec![] }, text("a.exr")].concat());
    assert_eq!(parse(&named(0, true)), Ok(Packet::Open("a.exr".into())));
    assert_eq!(parse(&named(7, true)), Ok(Packet::Open("a.exr".into())));
    assert_eq!(parse(&named(2, false)), Ok(Packet::Close("a.exr".into())));
    assert_eq!(parse(&packet(8, b"anything")), Ok(Packet::Graphics));
}

#[test]
fn what_is_no_packet_is_refused_in_words() {
    let tile = |rect, values: &[f32]| fault(&update("a", "R", rect, values));
    assert!(tile([0, 0, 2, 2], &[0.0; 3]).contains("2x2 pixels with 3 numbers"));
    assert!(tile([0, 0, 0, 2], &[]).contains("0x2 pixels: a side has 1 to 8192"));
    assert!(tile([0, 0, 8193, 1], &[]).contains("8193x1"));
    assert!(tile([-1, 0, 1, 1], &[0.0]).contains("a tile at -1, 0"));
    assert!(tile([0, i32::MAX, 1, 1], &[0.0]).contains("which is in no picture"));
    assert!(fault(&create("a", (1 << 20, 1), &["R"])).contains("1048576x1"));
    assert!(fault(&create("a", (-4, 1), &["R"])).contains("-4x1"));
    assert!(fault(&create("a", (4, 4), &[])).contains("0 channels"));
    assert!(fault(&create("a", (4, 4), &["R"; 65])).contains("65 channels"));
    assert!(fault(&create("a", (4, 4), &["R", "G", "R"])).contains("two channels R"));
    assert!(fault(&update_planes("a", &["\n", "\n"], [0, 0, 1, 1], &[0.0; 2])).contains("two channels \\n"));
    assert!(fault(&create(&"a".repeat(4097), (4, 4), &["R"])).contains("more than 4096 bytes"));
    assert!(parse(&create(&"a".repeat(4096), (4, 4), &["R"])).is_ok());
    assert!(fault(&packet(4, b"\x01name without end")).contains("does not end"));
    assert!(fault(&packet(4, b"")).contains("ends too early"));
    assert!(fault(&packet(9, b"")).contains("kind 9"));
}

#[test]
fn offsets_and_strides_beyond_the_numbers_are_refused_whatever_their_sum_is() {
    let strided = |offset, stride| fault(&update_strided("a", &["R"], [0, 0, 2, 1], [&[offset], &[stride]], &[0.0; 4]));
    for (offset, stride) in [(3, 1), (0, 4), ((1 << 62) - 1, (1 << 62) - 1), (1 << 61, 1)] {
        assert!(strided(offset, stride).contains("too few"), "{offset} {stride}");
    }
    for (offset, stride) in [(-1, 1), (0, -1), (0, 0), (i64::MIN, 1), (i64::MAX, 1), (0, i64::MAX)] {
        assert!(strided(offset, stride).contains("is possible"), "{offset} {stride}");
    }
}

#[test]
fn packets_are_put_together_of_pieces_of_any_size() {
    let sent = [create("a", (2, 1), &["R"]), update("a", "R", [0, 0, 2, 1], &[1.0, 2.0]), packet(8, b"")];
    let stream = sent.concat();
    for size in [1, 2, 3, 7, 20, stream.len()] {
        let (mut assembler, mut whole) = (Assembler::default(), Vec::new());
        for piece in stream.chunks(size) {
            let taken = assembler.push(piece, |packet| {
                whole.push(packet.to_vec());
                Ok(())
            });
            assert_eq!(taken, Ok(()));
        }
        assert_eq!(whole, sent, "in pieces of {size}");
        assert!(!assembler.is_midway());
    }
}

#[test]
fn a_length_that_no_packet_has_is_refused_before_the_rest_comes() {
    let said = |length: u32| Assembler::default().push(&length.to_le_bytes(), |_| Ok(())).expect_err("no length");
    assert!(said(0).contains("0 bytes") && said(4).contains("not tev's protocol"));
    assert!(said(u32::MAX).contains("4294967295 bytes") && said((1 << 27) + 1).contains("in tiles"));
    // "GET " of a browser
    assert!(said(u32::from_le_bytes(*b"GET ")).contains("if this is tev's protocol"));
    let mut begun = Assembler::default();
    assert_eq!(begun.push(&(1u32 << 27).to_le_bytes(), |_| Ok(())), Ok(()));
    assert!(begun.is_midway() && begun.begun.capacity() < 1024, "nothing is kept for what has not come");
    let mut large = Assembler::default();
    assert_eq!(large.push(&packet(8, &vec![0; 2 * KEPT]), |_| Ok(())), Ok(()));
    assert!(large.begun.capacity() <= KEPT, "nor for what has gone");
}
