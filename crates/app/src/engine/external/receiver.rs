//! Receives pictures of other programs of this machine: who connects from elsewhere is not heard. A thread that takes
//! connections, and one for each of them; a sender that is faster than they are has to wait.

use super::gallery::{Gallery, Snapshot};
use super::protocol::{Assembler, MOST_BEGUN, Packet, parse};
use std::io::{ErrorKind, Read};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// How soon a connection is taken, and how soon all end that are asked to.
const PATIENCE: Duration = Duration::from_millis(50);
/// Connections at a time.
const MOST_CONNECTIONS: usize = 8;
/// Bytes that are read at a time.
const CHUNK: usize = 1 << 17;
/// Pixels of a tile that are put in their place at a time: so soon all end that are asked to.
const PART: usize = 1 << 18;

/// Listens on a port; dropping it ends that and all connections.
#[derive(Debug)]
pub struct Receiver {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Shared {
    gallery: Mutex<Gallery>,
    ends: AtomicBool,
    begun: Room,
}

/// Bytes of packets that are not whole yet, of all connections together.
#[derive(Debug)]
struct Room {
    most: usize,
    taken: AtomicUsize,
}

impl Default for Room {
    fn default() -> Self {
        Room { most: MOST_BEGUN, taken: AtomicUsize::new(0) }
    }
}

/// What a connection takes of it; dropping it leaves that to others.
struct Share<'a> {
    room: &'a Room,
    bytes: usize,
}

impl Share<'_> {
    /// Takes so much from now on.
    fn take(&mut self, bytes: usize) -> Result<(), String> {
        // round the end of all numbers where it is less than before
        let more = bytes.wrapping_sub(self.bytes);
        let taken = self.room.taken.fetch_add(more, Ordering::Relaxed).wrapping_add(more);
        self.bytes = bytes;
        if taken > self.room.most {
            let most = self.room.most;
            return Err(format!(
                "all packets that have begun have more than {most} bytes together: send pictures in tiles"
            ));
        }
        Ok(())
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        self.room.taken.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

impl Shared {
    /// A thread that panicked left whole pixels behind.
    fn gallery(&self) -> MutexGuard<'_, Gallery> {
        self.gallery.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn ends(&self) -> bool {
        self.ends.load(Ordering::Relaxed)
    }
}

impl Receiver {
    /// Listens on a port of this machine.
    ///
    /// # Errors
    /// One line, if the port is taken or the system gives no thread.
    pub fn start(port: u16) -> Result<Self, String> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|why| not_listening(port, &why))?;
        Self::on(listener, Shared::default()).map_err(|why| not_listening(port, &why))
    }

    fn on(listener: TcpListener, shared: Shared) -> std::io::Result<Self> {
        listener.set_nonblocking(true)?;
        let shared = Arc::new(shared);
        let thread = std::thread::Builder::new().name("receiver".into()).spawn({
            let shared = shared.clone();
            move || take_connections(&listener, &shared)
        })?;
        Ok(Receiver { shared, thread: Some(thread) })
    }

    /// What there is to show, if something has changed since a version.
    pub fn since(&self, version: Option<u64>) -> Option<Snapshot> {
        self.shared.gallery().since(version)
    }
}

impl Drop for Receiver {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // a panic there has been printed already
            let _ = thread.join();
        }
    }
}

fn not_listening(port: u16, why: &std::io::Error) -> String {
    if why.kind() == ErrorKind::AddrInUse {
        return format!(
            "port {port} is taken by another program, tev perhaps, or by the other pane: end that, or choose another port"
        );
    }
    format!("cannot listen on 127.0.0.1:{port} ({why}): choose another port")
}

fn take_connections(listener: &TcpListener, shared: &Arc<Shared>) {
    let mut connections: Vec<JoinHandle<()>> = Vec::new();
    while !shared.ends() {
        connections.retain(|connection| !connection.is_finished());
        match listener.accept() {
            Ok((_, from)) if connections.len() >= MOST_CONNECTIONS => {
                shared.gallery().refuse(closed(from, &format!("{MOST_CONNECTIONS} others are open")));
            }
            Ok((stream, from)) => match begin(stream, from, shared) {
                Ok(connection) => connections.push(connection),
                Err(why) => shared.gallery().refuse(closed(from, &why.to_string())),
            },
            // nobody is there, or who was is gone again
            Err(_) => std::thread::park_timeout(PATIENCE),
        }
    }
    for connection in connections {
        // as above
        let _ = connection.join();
    }
}

fn begin(stream: TcpStream, from: SocketAddr, shared: &Arc<Shared>) -> std::io::Result<JoinHandle<()>> {
    // some systems hand on that the listener does not wait
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    let shared = shared.clone();
    std::thread::Builder::new().name("received pictures".into()).spawn(move || {
        if let Err(fault) = hear(stream, &shared) {
            shared.gallery().refuse(closed(from, &fault));
        }
    })
}

/// Takes what a program sends until it ends, or sends what cannot be taken.
fn hear(mut stream: TcpStream, shared: &Shared) -> Result<(), String> {
    let (mut assembler, mut chunk) = (Assembler::default(), vec![0; CHUNK]);
    let mut begun = Share { room: &shared.begun, bytes: 0 };
    while !shared.ends() {
        match stream.read(&mut chunk) {
            Ok(0) if assembler.is_midway() => return Err("it ended within a packet".into()),
            Ok(0) => return Ok(()),
            Ok(count) => {
                begun.take(assembler.bytes() + count)?;
                assembler.push(&chunk[..count], |packet| take(parse(packet)?, shared))?;
                begun.take(assembler.bytes())?;
            }
            Err(why) if [ErrorKind::WouldBlock, ErrorKind::TimedOut, ErrorKind::Interrupted].contains(&why.kind()) => {}
            Err(why) => return Err(why.to_string()),
        }
    }
    Ok(())
}

/// Does what a packet asks for, or as much of it as there is time for.
fn take(packet: Packet, shared: &Shared) -> Result<(), String> {
    if shared.ends() {
        return Ok(());
    }
    let Packet::Update(tile) = packet else { return shared.gallery().take(packet) };
    let tile = shared.gallery().fitting(tile)?;
    for part in tile.parts(PART) {
        if shared.ends() {
            return Ok(());
        }
        shared.gallery().put(&part)?;
    }
    shared.gallery().note(&tile);
    Ok(())
}

fn closed(from: SocketAddr, why: &str) -> String {
    format!("the connection from {from} was closed: {why}")
}

#[cfg(test)]
#[path = "receiver_tests.rs"]
mod tests;
