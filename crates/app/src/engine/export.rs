//! The thread that writes pictures and fills the clipboard: encoding, disk and other programs take their time.

use super::capture::{Capture, Pixels};
use super::{Inbox, Picture, Wake};
use crate::model::{Destination, ErrorMap};
use anyhow::Context;
use film::DisplayTransform;
use image_file::Records;
use image_file::{self, Kind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;

/// What to export.
#[derive(Debug)]
pub enum Content {
    /// The picture as seen.
    Seen(Capture),
    /// A pane's radiance, and how it is shown.
    Pane(Picture, DisplayTransform),
    /// A map of errors.
    Map(Arc<ErrorMap>),
}

/// Something to export.
#[derive(Debug)]
pub struct Export {
    /// The pixels, or what they are made from.
    pub content: Content,
    /// What the file keeps about it.
    pub records: Records,
    /// The file or the clipboard.
    pub to: Destination,
}

/// What became of the exports: a line each, good or bad update.
pub type Outcome = Result<String, String>;

/// The worker; dropping it ends its thread once all exports are done.
pub struct Exporter {
    inbox: Arc<Inbox<Vec<Export>>>,
    outcomes: Arc<Inbox<Vec<Outcome>>>,
    thread: Option<JoinHandle<()>>,
}

impl Exporter {
    /// Starts the thread, which calls `wake` whenever [`Exporter::outcomes`] has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake) -> std::io::Result<Self> {
        let inbox = Arc::new(Inbox::<Vec<Export>>::default());
        let outcomes = Arc::new(Inbox::<Vec<Outcome>>::default());
        let thread = std::thread::Builder::new().name("exporter".into()).spawn({
            let (inbox, outcomes) = (inbox.clone(), outcomes.clone());
            move || work(&inbox, &outcomes, &wake)
        })?;
        Ok(Exporter { inbox, outcomes, thread: Some(thread) })
    }

    /// Exports this after what was asked for before.
    pub fn submit(&self, export: Export) {
        self.inbox.post(|queue| queue.push(export));
    }

    /// What has become of exports since the last call.
    pub fn outcomes(&self) -> Vec<Outcome> {
        self.outcomes.take_now().unwrap_or_default()
    }
}

impl Drop for Exporter {
    fn drop(&mut self) {
        self.inbox.close_when_empty();
        if let Some(thread) = self.thread.take() {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

fn work(inbox: &Inbox<Vec<Export>>, outcomes: &Inbox<Vec<Outcome>>, wake: &Wake) {
    // kept, because under X11 it is the program that copied which hands the picture out
    let mut clipboard = None;
    while let Some(queue) = inbox.take() {
        for export in queue {
            let outcome = match &export.to {
                Destination::File(path) => save(&export, path).map(|path| format!("Saved {}", path.display())),
                Destination::Clipboard => copy(&export, &mut clipboard).map(|()| "Copied the picture".into()),
            };
            outcomes.post(|list| list.push(outcome.map_err(|fault| format!("{fault:#}"))));
            wake();
        }
    }
}

fn save(export: &Export, path: &Path) -> anyhow::Result<PathBuf> {
    let kind = Kind::of(path).with_context(|| format!("the name must end in .png or .exr: {}", path.display()))?;
    let bytes = match (&export.content, kind) {
        (Content::Seen(_), Kind::Exr) => {
            anyhow::bail!(
                "EXR keeps the radiance of one pane: save A, B or the error map, or end the name in .png: {}",
                path.display()
            )
        }
        (Content::Seen(capture), Kind::Png) => {
            let Pixels { width, height, rgba } = capture.pixels()?;
            image_file::encode_rgba8(width, height, &rgba, &export.records)?
        }
        (Content::Map(drawn), kind) => drawn.map.encode(kind, &drawn.map_job.pair, export.records.clone())?,
        (Content::Pane(picture, display), kind) => image_file::encode(kind, &picture.image, display, &export.records)?,
    };
    Ok(image_file::write_new(path, &bytes)?)
}

fn copy(export: &Export, clipboard: &mut Option<arboard::Clipboard>) -> anyhow::Result<()> {
    let Pixels { width, height, rgba } = match &export.content {
        Content::Seen(capture) => capture.pixels()?,
        Content::Pane(picture, display) => {
            let (width, height) = picture.image.size();
            Pixels { width, height, rgba: display.rgba8_of(&picture.image) }
        }
        Content::Map(drawn) => {
            let (width, height, rgba) = drawn.map.with_bar();
            Pixels { width, height, rgba }
        }
    };
    let image = arboard::ImageData { width: width as usize, height: height as usize, bytes: rgba.into() };
    let outcome = match clipboard {
        Some(clipboard) => clipboard.set_image(image),
        None => arboard::Clipboard::new().and_then(|new| clipboard.insert(new).set_image(image)),
    };
    outcome.context("cannot copy the picture; save it instead")
}
