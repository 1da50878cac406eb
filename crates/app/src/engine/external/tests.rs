//! A pane's thread: what it hands on of other programs' pictures.

use super::protocol::tests::{create, update};
use super::*;
use crate::engine::earlier::tests::picture;
use crate::engine::error_map::ErrorMapWorker;
use crate::engine::post_process::PaneUpdate;
use film::{DisplayTransform, Vec3};
use image_file::Kind;
use std::io::Write;
use std::net::{TcpListener, TcpStream};
use technique::TechniqueName;
use visavis_tests::TestFolder;

struct Pane {
    worker: ExternalWorker,
    post_process: Arc<PostProcess>,
}

impl Pane {
    fn new() -> Self {
        let error_map_worker = Arc::new(ErrorMapWorker::start(Arc::new(|| {})).expect("a thread"));
        let post_process = Arc::new(PostProcess::start(Arc::new(|| {}), error_map_worker).expect("a thread"));
        Pane { worker: ExternalWorker::start(PaneId::B, post_process.clone()).expect("a thread"), post_process }
    }

    fn show(&self, job: u64, source: PaneSource) {
        let order = Order { job, ..picture(TechniqueName::Raster, 1, 1).order };
        self.worker.submit(ExternalJob { source, order });
    }

    /// What is shown next that `holds`: a picture, or why there is none.
    fn next(&self, holds: impl Fn(&Result<Picture, String>) -> bool) -> Result<Picture, String> {
        let start = Instant::now();
        loop {
            let updates = self.post_process.collect().unwrap_or_default();
            let seen = updates.into_iter().find(|(pane, _)| *pane == PaneId::B).map(|(_, update)| match update {
                PaneUpdate::Picture(frame) => Ok(frame.picture),
                PaneUpdate::Fault(fault) => Err(fault),
            });
            match seen {
                Some(seen) if holds(&seen) => return seen,
                _ => assert!(start.elapsed() < Duration::from_secs(60), "waited a minute"),
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

fn grey(seen: &Result<Picture, String>) -> Option<f32> {
    Some(seen.as_ref().ok()?.image.radiances()[0].x)
}

fn free_port() -> u16 {
    TcpListener::bind(("127.0.0.1", 0)).and_then(|listener| listener.local_addr()).expect("a port").port()
}

#[test]
fn a_received_picture_is_shown_and_shown_again_for_another_view_without_being_sent_again() {
    let (pane, port) = (Pane::new(), free_port());
    pane.show(1, PaneSource::Received(port));
    let waits = pane.next(|seen| seen.is_err());
    assert!(waits.expect_err("no picture").contains(&format!("127.0.0.1:{port}")));
    let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
    let sent = [create("mine", (2, 1), &["Y"]), update("mine", "Y", [0, 0, 2, 1], &[0.5, f32::NAN])].concat();
    stream.write_all(&sent).expect("packets");
    let shown = pane.next(|seen| grey(seen) == Some(0.5)).expect("a picture");
    let external = shown.external.expect("another program's");
    assert_eq!((external.name.as_str(), external.changes, shown.nonfinite, shown.order.job), ("mine", 1, 1, 1));
    assert!(!shown.unfinished, "the reference would wait for it");
    pane.show(2, PaneSource::Received(port));
    let again = pane.next(|seen| seen.as_ref().is_ok_and(|picture| picture.order.job == 2));
    assert_eq!(grey(&again), Some(0.5));
    pane.worker.cancel();
    let start = Instant::now();
    while TcpStream::connect(("127.0.0.1", port)).is_ok() {
        assert!(start.elapsed() < Duration::from_secs(60), "it still listens");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn a_port_that_is_taken_is_told_and_listened_on_once_it_is_free() {
    let other = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
    let port = other.local_addr().expect("its number").port();
    let pane = Pane::new();
    pane.show(1, PaneSource::Received(port));
    assert!(pane.next(|seen| seen.is_err()).expect_err("no picture").contains("is taken"));
    drop(other);
    pane.next(|seen| seen.as_ref().is_err_and(|fault| fault.contains("no picture yet"))).expect_err("no picture");
}

#[test]
fn a_file_is_followed_and_another_source_takes_its_place() {
    let (pane, folder) = (Pane::new(), TestFolder::new());
    let file = folder.file("mine.exr");
    let write = |grey: f32| {
        let image = Image::new(1, 1, [Vec3::splat(grey)]).expect("a pixel");
        let bytes = image_file::encode(Kind::Exr, &image, &DisplayTransform::default(), &Vec::new()).expect("an EXR");
        std::fs::write(&file, bytes).expect("a file");
    };
    write(0.25);
    pane.show(1, PaneSource::Followed(file.clone()));
    let first = pane.next(Result::is_ok).expect("a picture");
    assert_eq!(first.external.expect("another program's").name, "mine.exr");
    write(0.75);
    pane.next(|seen| grey(seen) == Some(0.75)).expect("the new one");
    pane.show(2, PaneSource::Received(free_port()));
    pane.next(|seen| seen.as_ref().is_err_and(|fault| fault.contains("no picture yet"))).expect_err("no picture");
}
