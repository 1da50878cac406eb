//! The thread that writes pictures and fills the clipboard: encoding, disk and other programs take their time.

use super::capture::{Capture, Pixels};
use super::changed_scene::SceneToSave;
use super::ladder::LadderToSave;
use super::report::{ReportToSave, SlideToSave};
use super::session::SessionToSave;
use super::worker::{Control, Service, Worker};
use super::{Picture, Wake};
use crate::model::{Destination, ErrorMap, PaneId, PixelSamples, samples_csv};
use crate::sweep::Sheet;
use anyhow::Context;
use film::DisplayTransform;
use image_file::Records;
use image_file::{self, Kind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What to export.
#[derive(Debug)]
pub enum Content {
    /// The picture as seen.
    Seen(Capture),
    /// A pane's radiance, and how it is shown.
    Pane(Box<Picture>, DisplayTransform),
    /// A map of errors.
    Map(Arc<ErrorMap>),
    /// All tiles of a sweep with their captions.
    Sweep(Box<Sheet>),
    /// All rungs of a ladder, in a folder.
    Ladder(Box<LadderToSave>),
    /// What is no picture, in a file whose name may end in anything.
    Text(String),
    /// The samples of a pixel in each pane, of which a table is made.
    Samples(Vec<(PaneId, Arc<PixelSamples>)>),
    /// What makes all pictures again.
    Session(Box<SessionToSave>),
    /// What is changed in the scene.
    Scene(Box<SceneToSave>),
    /// A page of all that is known of them.
    Report(Box<ReportToSave>),
    /// Pictures with large labels.
    Slide(Box<SlideToSave>),
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

/// What became of the exports: a line each, good or bad news.
pub type Outcome = Result<String, String>;

/// The worker; dropping it ends its thread once all exports are done.
pub struct Exporter(Worker<Vec<Export>, Vec<Outcome>>);

impl Exporter {
    /// Starts the thread, which calls `wake` whenever [`Exporter::outcomes`] has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake) -> std::io::Result<Self> {
        Worker::start("exporter", wake, || Exports { clipboard: None }).map(Exporter)
    }

    /// Exports this after what was asked for before.
    pub fn submit(&self, export: Export) {
        self.0.post(|queue| queue.push(export));
    }

    /// What has become of exports since the last call.
    pub fn outcomes(&self) -> Vec<Outcome> {
        self.0.collect().unwrap_or_default()
    }
}

impl Drop for Exporter {
    fn drop(&mut self) {
        self.0.close_when_done();
    }
}

struct Exports {
    /// Kept, because under X11 it is the program that copied which hands the picture out.
    clipboard: Option<arboard::Clipboard>,
}

impl Service for Exports {
    type Job = Vec<Export>;
    type Update = Vec<Outcome>;

    fn serve(&mut self, queue: Vec<Export>, control: &Control<Vec<Export>, Vec<Outcome>>) {
        for export in queue {
            let outcome = match &export.to {
                Destination::File(path) => save(&export, path).map(|path| told(&export.content, &path)),
                Destination::Clipboard => copy(&export, &mut self.clipboard).map(|()| "Copied the picture".into()),
            };
            control.tell(|list| list.push(outcome.map_err(|fault| format!("{fault:#}"))));
        }
    }

    fn recover(&mut self, control: &Control<Vec<Export>, Vec<Outcome>>) {
        self.clipboard = None;
        control.tell(|list| list.push(Err("the export stopped at a fault of its own".into())));
    }
}

/// What is said of a file that was written.
fn told(content: &Content, path: &Path) -> String {
    let saved = format!("Saved {}", image_file::shown(path));
    match content {
        Content::Scene(scene) => format!("{saved}: {}", scene.how_to_open(path)),
        _ => saved,
    }
}

fn save(export: &Export, path: &Path) -> anyhow::Result<PathBuf> {
    let Export { content, records, .. } = export;
    if let Content::Text(text) = content {
        return Ok(image_file::write_new(path, text.as_bytes())?);
    }
    if let Content::Ladder(ladder) = content {
        return ladder.save(path);
    }
    if let Content::Samples(panes) = content {
        return Ok(image_file::write_new(path, samples_csv(panes).as_bytes())?);
    }
    if let Content::Session(session) = content {
        return session.save(path);
    }
    if let Content::Scene(scene) = content {
        return scene.save(path);
    }
    if let Content::Report(report) = content {
        return report.save(path);
    }
    let kind =
        Kind::of(path).with_context(|| format!("the name must end in .png or .exr: {}", image_file::shown(path)))?;
    let bytes = match (content, kind) {
        (Content::Map(drawn), kind) => drawn.map.encode(kind, &drawn.map_job.pair, records.clone())?,
        (Content::Pane(picture, display), kind) => image_file::encode(kind, &picture.image, display, records)?,
        (Content::Seen(capture), Kind::Png) => {
            let Pixels { width, height, rgba } = capture.pixels()?;
            image_file::encode_rgba8(width, height, &rgba, records)?
        }
        (Content::Sweep(sheet), Kind::Png) => sheet.png(records.clone())?,
        (Content::Slide(slide), Kind::Png) => {
            let Pixels { width, height, rgba } = slide.pixels()?;
            image_file::encode_rgba8(width, height, &rgba, records)?
        }
        (
            Content::Seen(_)
            | Content::Sweep(_)
            | Content::Slide(_)
            | Content::Ladder(..)
            | Content::Text(_)
            | Content::Samples(_)
            | Content::Session(_)
            | Content::Scene(_)
            | Content::Report(_),
            _,
        ) => {
            anyhow::bail!(
                "EXR keeps the radiance of one pane: save A, B or the error map, or end the name in .png: {}",
                image_file::shown(path)
            )
        }
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
        Content::Sweep(sheet) => {
            let canvas = sheet.canvas()?;
            Pixels { width: canvas.size.0, height: canvas.size.1, rgba: canvas.rgba() }
        }
        Content::Slide(slide) => slide.pixels()?,
        Content::Ladder(..) => anyhow::bail!("a ladder is a folder of files: save it instead"),
        Content::Report(_) => anyhow::bail!("a report is a file: save it instead"),
        Content::Text(text) => {
            let outcome = opened(clipboard).and_then(|open| open.set_text(text));
            return outcome.context("cannot copy the text; save it instead");
        }
        Content::Samples(panes) => {
            let outcome = opened(clipboard).and_then(|open| open.set_text(samples_csv(panes)));
            return outcome.context("cannot copy the table; save it instead");
        }
        Content::Scene(scene) => {
            let outcome = opened(clipboard).and_then(|open| open.set_text(scene.text_in(Path::new(""))));
            return outcome.context("cannot copy the scene; save it instead");
        }
        Content::Session(session) => {
            let outcome = opened(clipboard).and_then(|open| open.set_text(session.text()));
            return outcome.context("cannot copy the session; save it instead");
        }
    };
    let image = arboard::ImageData { width: width as usize, height: height as usize, bytes: rgba.into() };
    let outcome = opened(clipboard).and_then(|open| open.set_image(image));
    outcome.context("cannot copy the picture; save it instead")
}

fn opened(clipboard: &mut Option<arboard::Clipboard>) -> Result<&mut arboard::Clipboard, arboard::Error> {
    match clipboard {
        Some(open) => Ok(open),
        None => arboard::Clipboard::new().map(|new| clipboard.insert(new)),
    }
}
