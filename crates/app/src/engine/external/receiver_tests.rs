//! Connections of this machine: what comes, in whatever pieces, and what is closed.

use super::super::protocol::tests::{create, update, update_strided};
use super::*;
use film::Vec3;
use std::io::Write;
use std::time::Instant;

/// A receiver on a port that nobody else has, and the port.
fn receiver() -> (Receiver, SocketAddr) {
    receiver_with(Shared::default())
}

fn receiver_with(shared: Shared) -> (Receiver, SocketAddr) {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
    let address = listener.local_addr().expect("its number");
    (Receiver::on(listener, shared).expect("a thread"), address)
}

fn connect(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).expect("a connection");
    stream.set_nodelay(true).expect("pieces that are sent at once");
    stream
}

/// Looks until what is seen is as it shall be.
fn wait_for(receiver: &Receiver, holds: impl Fn(&Snapshot) -> bool) -> Snapshot {
    let start = Instant::now();
    loop {
        let seen = receiver.since(None).expect("a state");
        if holds(&seen) {
            return seen;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "waited a minute, and saw {seen:?}");
        std::thread::yield_now();
    }
}

fn pixels(snapshot: &Snapshot) -> Vec<Vec3> {
    snapshot.picture.as_ref().map_or_else(Vec::new, |(_, image)| image.radiances().to_vec())
}

fn says(words: &'static str) -> impl Fn(&Snapshot) -> bool {
    move |snapshot| snapshot.fault.as_ref().is_some_and(|fault| fault.contains(words))
}

#[test]
fn a_picture_that_comes_byte_by_byte_is_there_to_the_bit() {
    let (receiver, address) = receiver();
    let mut stream = connect(address);
    let values = [0.1, f32::MIN_POSITIVE, 1e30];
    let sent = [create("a", (3, 1), &["Y"]), update("a", "Y", [0, 0, 3, 1], &values)].concat();
    for byte in sent {
        stream.write_all(&[byte]).expect("a byte");
    }
    let seen = wait_for(&receiver, |seen| seen.changes == 1);
    assert_eq!(pixels(&seen), values.map(Vec3::splat));
    drop(stream);
    assert_eq!(wait_for(&receiver, |seen| seen.changes == 1).fault, None, "it ended where a packet ends");
}

#[test]
fn several_programs_send_at_a_time() {
    let (receiver, address) = receiver();
    let mut streams: Vec<TcpStream> = (0..4).map(|_| connect(address)).collect();
    streams[0].write_all(&create("a", (4, 1), &["Y"])).expect("a packet");
    wait_for(&receiver, |seen| seen.picture.is_some());
    for (x, stream) in (0..).zip(&mut streams) {
        stream.write_all(&update("a", "Y", [x, 0, 1, 1], &[x as f32])).expect("a packet");
    }
    let seen = wait_for(&receiver, |seen| seen.changes == 4);
    assert_eq!(pixels(&seen), [0.0, 1.0, 2.0, 3.0].map(Vec3::splat));
}

#[test]
fn a_connection_that_sends_nonsense_is_closed_with_a_line_and_the_others_go_on() {
    let (receiver, address) = receiver();
    let mut good = connect(address);
    good.write_all(&create("a", (1, 1), &["Y"])).expect("a packet");
    let mut browser = connect(address);
    browser.write_all(b"GET / HTTP/1.1\r\n\r\n").expect("words");
    let seen = wait_for(&receiver, says("tev's protocol"));
    assert!(seen.fault.is_some_and(|fault| fault.starts_with("the connection from 127.0.0.1:")));
    browser.set_read_timeout(Some(Duration::from_secs(60))).expect("patience");
    assert!(matches!(browser.read(&mut [0]), Ok(0) | Err(_)), "it is closed");
    let mut cut = connect(address);
    cut.write_all(&create("b", (1, 1), &["Y"])[..9]).expect("a part");
    drop(cut);
    wait_for(&receiver, says("ended within a packet"));
    good.write_all(&update("a", "Y", [0, 0, 1, 1], &[2.0])).expect("a packet");
    assert_eq!(pixels(&wait_for(&receiver, |seen| seen.changes == 1)), [Vec3::splat(2.0)]);
}

#[test]
fn one_more_connection_than_there_may_be_is_closed_and_a_place_that_is_left_is_taken() {
    let (receiver, address) = receiver();
    let mut streams: Vec<TcpStream> = (0..MOST_CONNECTIONS).map(|_| connect(address)).collect();
    let _too_many = connect(address);
    wait_for(&receiver, says("8 others are open"));
    streams.pop();
    let start = Instant::now();
    while receiver.since(None).is_some_and(|seen| seen.picture.is_none()) {
        // it is closed once more until the place is free
        let _ = connect(address).write_all(&create("a", (1, 1), &["Y"]));
        assert!(start.elapsed() < Duration::from_secs(60), "the place is not taken");
        std::thread::sleep(PATIENCE);
    }
}

#[test]
fn it_ends_at_once_beside_silent_connections_and_the_port_is_free_again() {
    let (receiver, address) = receiver();
    let mut silent = connect(address);
    silent.write_all(&[200, 0, 0]).expect("a part");
    let taken = Receiver::start(address.port()).expect_err("a port that is taken");
    assert!(taken.contains(&format!("port {} is taken", address.port())), "{taken}");
    let start = Instant::now();
    drop(receiver);
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
    assert!(Receiver::start(address.port()).is_ok());
}

#[test]
fn who_sends_faster_than_it_is_shown_loses_nothing() {
    let (receiver, address) = receiver();
    let mut stream = connect(address);
    let side = 256;
    let values = vec![1.0; side * side];
    stream.write_all(&create("a", (side as i32, side as i32), &["Y"])).expect("a packet");
    let tile = update("a", "Y", [0, 0, side as i32, side as i32], &values);
    (0..200).for_each(|_| stream.write_all(&tile).expect("a packet"));
    assert!(pixels(&wait_for(&receiver, |seen| seen.changes == 200)).iter().all(|pixel| *pixel == Vec3::ONE));
}

#[test]
fn what_has_begun_on_all_connections_has_room_together_and_one_too_many_is_closed() {
    let begun = Room { most: 1000, ..Room::default() };
    let (receiver, address) = receiver_with(Shared { begun, ..Shared::default() });
    let sent = create(&"a".repeat(800), (1, 1), &["Y"]);
    let mut streams = [connect(address), connect(address)];
    streams.iter_mut().for_each(|stream| stream.write_all(&sent[..600]).expect("a part"));
    wait_for(&receiver, says("have more than 1000 bytes together: send pictures in tiles"));
    // one of them is closed
    streams.iter_mut().for_each(|stream| drop(stream.write_all(&sent[600..])));
    wait_for(&receiver, |seen| seen.picture.is_some());
    // and what it had is there for others
    connect(address).write_all(&create(&"b".repeat(900), (1, 1), &["Y"])).expect("a packet");
    wait_for(&receiver, |seen| seen.picture.as_ref().is_some_and(|(name, _)| name.starts_with('b')));
}

#[test]
fn a_tile_of_any_size_is_left_where_it_is_once_all_shall_end() {
    let shared = Shared::default();
    let side = 1024;
    let names: Vec<String> = (0..61).map(|number| format!("c{number}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).chain(["R", "G", "B"]).collect();
    let values = vec![1.0; (side * side) as usize];
    let tile = update_strided("a", &names, [0, 0, side, side], [&[0; 64], &[1; 64]], &values);
    let send = |packet: &[u8]| take(parse(packet).expect("a packet"), &shared).expect("it fits");
    send(&create("a", (side, side), &names));
    send(&tile);
    let seen = shared.gallery().since(None).expect("a state");
    assert_eq!(seen.changes, 1, "in parts it is still one tile");
    assert!(pixels(&seen).iter().all(|pixel| *pixel == Vec3::ONE));
    shared.ends.store(true, Ordering::Relaxed);
    send(&tile);
    assert!(shared.gallery().since(Some(seen.version)).is_none());
}
