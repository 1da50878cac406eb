//! The thread that develops: radiance through the display transform into bytes, and the error of each side against the
//! other. Moving the exposure develops again and renders nothing.

use super::{Inbox, Picture, Side, Wake};
use compare::{Errors, errors_of_radiances};
use scene::display::DisplayTransform;
use std::sync::Arc;
use std::thread::JoinHandle;

/// A picture ready for the screen.
#[derive(Debug, Clone)]
pub struct Developed {
    /// What it was made from.
    pub picture: Picture,
    /// Its bytes; `None` where only the errors are new.
    pub rgba: Option<Vec<u8>>,
    /// How far it is from the other side; `None` unless both are there at one size.
    pub errors: Option<Errors>,
}

/// What is new for one side.
#[derive(Debug, Clone)]
pub enum News {
    /// A picture.
    Picture(Box<Developed>),
    /// Why there is none: one line.
    Fault(String),
}

/// What the UI collects.
pub type Shelf = [Option<News>; 2];

/// Posts to the thread, which [`Darkroom::start`] began.
#[derive(Debug, Default)]
pub struct Darkroom {
    inbox: Inbox<Tray>,
    shelf: Inbox<Shelf>,
}

#[derive(Debug, Default)]
struct Tray {
    pictures: [Option<Picture>; 2],
    display: Option<DisplayTransform>,
}

impl Darkroom {
    /// Starts the thread, which calls `wake` whenever [`Darkroom::collect`] has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake) -> std::io::Result<(Arc<Self>, JoinHandle<()>)> {
        let darkroom = Arc::new(Darkroom::default());
        let thread = std::thread::Builder::new().name("darkroom".into()).spawn({
            let darkroom = darkroom.clone();
            move || darkroom.work(&wake)
        })?;
        Ok((darkroom, thread))
    }

    /// A new picture of one side.
    pub fn deliver(&self, side: Side, picture: Picture) {
        self.inbox.post(|tray| tray.pictures[side as usize] = Some(picture));
    }

    /// A side has no picture, for a reason to be shown.
    pub fn report(&self, side: Side, fault: String) {
        self.shelf.post(|shelf| shelf[side as usize] = Some(News::Fault(fault)));
        // an empty delivery, so that the thread wakes the UI
        self.inbox.post(|_| {});
    }

    /// A new display transform for both.
    pub fn set_display(&self, display: DisplayTransform) {
        self.inbox.post(|tray| tray.display = Some(display));
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<Shelf> {
        self.shelf.take_now()
    }

    /// Ends the thread.
    pub fn close(&self) {
        self.inbox.close();
    }

    fn work(&self, wake: &Wake) {
        let mut display = DisplayTransform::default();
        let mut latest: [Option<Picture>; 2] = [None, None];
        while let Some(tray) = self.inbox.take() {
            let redevelop = tray.display.is_some();
            display = tray.display.unwrap_or(display);
            let fresh = tray.pictures.each_ref().map(Option::is_some);
            for (latest, new) in latest.iter_mut().zip(tray.pictures) {
                *latest = new.or_else(|| latest.take());
            }
            let errors = mutual_errors(&latest);
            for side in [Side::A, Side::B] {
                let Some(picture) = latest[side as usize].clone() else { continue };
                let develop = redevelop || fresh[side as usize];
                let rgba = develop.then(|| display.to_rgba8(picture.radiances.iter().copied()));
                let new = Developed { picture, rgba, errors: errors[side as usize] };
                self.shelf.post(|shelf| shelve(&mut shelf[side as usize], new));
            }
            wake();
        }
    }
}

/// Bytes that were not collected yet stay if what is newer brings none of its own.
fn shelve(place: &mut Option<News>, mut new: Developed) {
    if let (None, Some(News::Picture(old))) = (&new.rgba, place.as_mut()) {
        new.rgba = old.rgba.take();
    }
    *place = Some(News::Picture(Box::new(new)));
}

fn mutual_errors(latest: &[Option<Picture>; 2]) -> [Option<Errors>; 2] {
    match latest {
        [Some(a), Some(b)] if (a.width, a.height) == (b.width, b.height) => {
            let of =
                |film: &Picture, reference: &Picture| Some(errors_of_radiances(&film.radiances, &reference.radiances));
            [of(a, b), of(b, a)]
        }
        _ => [None, None],
    }
}
