//! What tiles make of pictures, in whatever order they come, and what does not fit.

use super::super::protocol::tests::{create, packet, update, update_planes, update_strided};
use super::super::protocol::{Assembler, parse};
use super::*;

fn take(gallery: &mut Gallery, packet: &[u8]) -> Result<(), String> {
    gallery.take(parse(packet)?)
}

fn all(gallery: &mut Gallery, packets: &[Vec<u8>]) {
    packets.iter().for_each(|packet| assert_eq!(take(gallery, packet), Ok(())));
}

fn shown(gallery: &Gallery) -> (String, Image) {
    gallery.since(None).and_then(|snapshot| snapshot.picture).expect("a picture")
}

/// Not one number of it is like another.
fn picture(width: u32, height: u32) -> Image {
    let pixel = |i: u32| Vec3::new(i as f32 + 0.25, -(i as f32) / 3.0, 1e-3 * i as f32);
    Image::new(width, height, (0..width * height).map(pixel).collect::<Vec<_>>()).expect("pixels")
}

/// The numbers of a channel in a rectangle.
fn values(image: &Image, [x, y, w, h]: [i32; 4], channel: usize) -> Vec<f32> {
    let at = |i: i32| image.at((x + i % w) as u32, (y + i / w) as u32).expect("a pixel")[channel];
    (0..w * h).map(at).collect()
}

const TILES: [[i32; 4]; 4] = [[0, 0, 4, 2], [4, 0, 3, 2], [0, 2, 4, 3], [4, 2, 3, 3]];

#[test]
fn tiles_in_any_order_and_of_any_kind_make_the_picture_to_the_bit() {
    let image = picture(7, 5);
    let planes = |rect| (0..3).flat_map(move |channel| values(&picture(7, 5), rect, channel)).collect::<Vec<_>>();
    let single = |rect| {
        ["R", "G", "B"]
            .into_iter()
            .enumerate()
            .map(move |(c, name)| update("a", name, rect, &values(&picture(7, 5), rect, c)))
    };
    let woven = |rect: [i32; 4]| {
        let planes: Vec<_> = (0..3).map(|channel| values(&image, rect, channel)).collect();
        let numbers = (0..planes[0].len()).flat_map(|i| [planes[2][i], 9.0, planes[0][i], planes[1][i]]);
        update_strided("a", &["B", "A", "R", "G"], rect, [&[0, 1, 2, 3], &[4; 4]], &numbers.collect::<Vec<_>>())
    };
    let begun = create("a", (7, 5), &["R", "G", "B", "A"]);
    let backwards: Vec<_> =
        TILES.into_iter().rev().map(|rect| update_planes("a", &["R", "G", "B"], rect, &planes(rect))).collect();
    for tiles in [TILES.into_iter().flat_map(single).collect(), backwards, TILES.map(woven).into()] {
        let mut gallery = Gallery::default();
        all(&mut gallery, &[vec![begun.clone()], tiles].concat());
        assert_eq!(shown(&gallery), ("a".into(), image.clone()));
    }
}

#[test]
fn channels_without_a_colour_are_left_out_before_any_pixel_is_looked_at() {
    let mut gallery = Gallery::default();
    all(&mut gallery, &[create("a", (2, 1), &["A", "R", "Z", "G", "B"])]);
    let sent = update_planes("a", &["Z", "B", "A"], [0, 0, 2, 1], &[0.5; 6]);
    let Ok(Packet::Update(tile)) = parse(&sent) else { panic!("no tile") };
    let fitting = gallery.fitting(tile).expect("a part of the picture");
    assert_eq!(fitting.channels.iter().map(|channel| channel.name.as_str()).collect::<Vec<_>>(), ["B"]);
}

#[test]
fn what_is_not_finite_is_kept_as_it_was_sent() {
    let mut gallery = Gallery::default();
    let sent = [f32::NAN, f32::INFINITY, -0.0];
    all(&mut gallery, &[create("a", (3, 1), &["Y"]), update("a", "Y", [0, 0, 3, 1], &sent)]);
    let (_, image) = shown(&gallery);
    let bits = |value: f32| value.to_bits();
    assert_eq!(image.radiances().iter().map(|v| bits(v.y)).collect::<Vec<_>>(), sent.map(bits));
}

#[test]
fn channels_are_colours_by_their_names() {
    let of = |names: &[&str]| {
        let colours = colours_of(&names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>())?;
        Ok::<_, String>(colours.into_iter().map(|(_, colours)| colours).collect::<Vec<_>>())
    };
    let (r, g, b, none, grey) =
        ([true, false, false], [false, true, false], [false, false, true], [false; 3], [true; 3]);
    assert_eq!(of(&["A", "B", "G", "R"]), Ok(vec![none, b, g, r]));
    assert_eq!(of(&["albedo.R", "albedo.G", "albedo.B", "R", "G", "B"]), Ok(vec![none, none, none, r, g, b]));
    assert_eq!(of(&["albedo.R", "albedo.G", "albedo.B", "Z"]), Ok(vec![r, g, b, none]));
    assert_eq!((of(&["channel 0"]), of(&["Y", "A"])), (Ok(vec![grey]), Ok(vec![grey, none])));
    assert!(
        of(&["U", "V\n"]).is_err_and(|fault| fault.contains("channels U, V\\n, where R, G and B, or Y, are needed"))
    );
}

#[test]
fn the_picture_that_was_begun_last_is_shown_and_one_of_its_name_begins_anew() {
    let mut gallery = Gallery::default();
    assert!(gallery.since(None).is_some_and(|snapshot| snapshot.picture.is_none()));
    all(&mut gallery, &[create("a", (1, 1), &["Y"]), update("a", "Y", [0, 0, 1, 1], &[1.0])]);
    all(&mut gallery, &[create("b", (2, 1), &["Y"]), update("a", "Y", [0, 0, 1, 1], &[2.0])]);
    assert_eq!(shown(&gallery).0, "b");
    all(&mut gallery, &[packet(2, b"b\0")]);
    assert_eq!(shown(&gallery), ("a".into(), Image::new(1, 1, [Vec3::splat(2.0)]).expect("a pixel")));
    let before = gallery.since(None).expect("a state");
    assert_eq!(before.changes, 2);
    assert!(gallery.since(Some(before.version)).is_none(), "nothing has changed");
    all(&mut gallery, &[create("a", (1, 1), &["Y"])]);
    let begun = gallery.since(Some(before.version)).expect("a new state");
    assert_eq!((begun.changes, begun.seconds), (0, 0.0));
    assert_eq!(shown(&gallery).1.radiances(), [Vec3::ZERO]);
}

#[test]
fn the_oldest_pictures_go_where_there_is_no_room_and_larger_ones_are_refused() {
    let mut gallery = Gallery::with_room_for(100);
    all(&mut gallery, &[create("a", (6, 10), &["Y"]), create("b", (4, 10), &["Y"]), create("c", (1, 10), &["Y"])]);
    assert_eq!(gallery.pixels(), 50, "a is gone");
    assert!(
        take(&mut gallery, &update("a", "Y", [0, 0, 1, 1], &[0.0]))
            .is_err_and(|fault| fault.contains("a tile of a, which"))
    );
    assert!(take(&mut gallery, &create("d", (101, 1), &["Y"])).is_err_and(|fault| fault.contains("101x1 pixels")));
    assert_eq!(shown(&gallery).0, "c", "as it was");
    (0..40).for_each(|i| all(&mut gallery, &[create(&i.to_string(), (1, 1), &["Y"])]));
    assert_eq!(gallery.pixels(), MOST_PICTURES);
}

#[test]
fn tiles_beyond_the_picture_or_of_other_channels_are_refused_and_change_nothing() {
    let mut gallery = Gallery::default();
    all(&mut gallery, &[create("a", (2, 2), &["R", "G", "B"])]);
    let mut said = |packet: &[u8]| take(&mut gallery, packet).expect_err("it does not fit");
    assert!(said(&update("a", "R", [1, 0, 2, 1], &[1.0; 2])).contains("2x1 pixels at 1, 0 of a picture of 2x2"));
    assert!(said(&update("a", "R", [0, 2, 1, 1], &[1.0])).contains("at 0, 2"));
    assert!(said(&update("a", "r", [0, 0, 1, 1], &[1.0])).contains("channel r, where the picture has R, G, B"));
    assert!(said(&update_planes("a", &["R", "Q"], [0, 0, 1, 1], &[1.0; 2])).contains("channel Q"));
    assert_eq!(shown(&gallery).1.radiances(), [Vec3::ZERO; 4]);
    // nobody reads files that others name
    all(&mut gallery, &[packet(0, b"\x01/etc/passwd\0")]);
    assert!(
        gallery
            .since(None)
            .is_some_and(|snapshot| snapshot.fault.is_some_and(|fault| fault.contains("asks to open /etc/passwd")))
    );
}

/// Numbers by xorshift from a fixed seed.
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }
}

#[test]
fn tens_of_thousands_of_damaged_packets_neither_panic_nor_take_more_room_than_there_is() {
    const ROOM: u64 = 1 << 12;
    let tile = [0.5; 4 * 6];
    let good = [
        create("a", (32, 16), &["R", "G", "B", "A"]),
        update("a", "G", [3, 5, 4, 6], &tile),
        update_planes("a", &["R", "B"], [0, 0, 4, 3], &tile),
        update_strided("a", &["R", "G", "B"], [28, 14, 4, 2], [&[0, 1, 2], &[3; 3]], &tile),
        packet(2, b"a\0"),
        packet(7, b"\x01a.exr\0\0"),
        packet(8, b"\0a\0\0\x01\0\0\0\x05"),
    ];
    let (mut dice, mut gallery) = (Dice(0x9e37_79b9_7f4a_7c15), Gallery::with_room_for(ROOM));
    let (mut taken, mut refused) = (0, 0);
    for _ in 0..60_000 {
        let mut bytes = good[dice.below(good.len())].clone();
        for _ in 0..dice.below(4) {
            let at = dice.below(bytes.len());
            bytes[at] = [0, 1, 0x7f, 0x80, 0xff, dice.below(256) as u8][dice.below(6)];
        }
        if dice.below(8) == 0 {
            bytes.truncate(dice.below(bytes.len()));
        }
        let outcome = Assembler::default().push(&bytes, |packet| take(&mut gallery, packet));
        *(if outcome.is_ok() { &mut taken } else { &mut refused }) += 1;
        assert!(gallery.pixels() as u64 <= ROOM && gallery.pictures.len() <= MOST_PICTURES);
    }
    assert!(taken > 10_000 && refused > 10_000, "{taken} taken, {refused} refused");
    // and goes on as before
    all(&mut gallery, &[good[0].clone(), good[1].clone()]);
    assert_eq!(shown(&gallery).1.at(3, 5), Some(Vec3::new(0.0, 0.5, 0.0)));
}
