//! The thread that post-processes: radiance through the display transform into bytes, and the error of each side
//! against the other or against the reference. Moving the exposure shows again and renders nothing. What a map of the
//! errors is made of goes on to the [`ErrorMapWorker`], which has a thread of its own: FLIP takes longer than a picture
//! may wait.

use super::error_map::{ErrorMapJob, ErrorMapWorker};
use super::{Inbox, Order, Picture, Side, Wake};
use crate::ruler::{Against, Pair, ReferenceImage};
use compare::{ErrorMetric, Errors, errors};
use film::DisplayTransform;
use std::sync::Arc;
use std::thread::JoinHandle;

/// A picture ready for the screen.
#[derive(Debug, Clone)]
pub struct DisplayFrame {
    /// What it was made from.
    pub picture: Picture,
    /// Its bytes; `None` where only the errors are new.
    pub rgba: Option<Vec<u8>>,
    /// How far it is from what it is compared with; `None` unless that is there at the same size.
    pub errors: Option<Errors>,
    /// What that is.
    pub against: Against,
}

/// How errors are measured and drawn.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Comparison {
    /// With what both sides are compared.
    pub against: Against,
    /// The map that is looked at, if one is.
    pub map: Option<MapWish>,
}

/// A map of errors to draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapWish {
    /// Whose errors.
    pub of: Side,
    /// Which.
    pub map: ErrorMetric,
    /// Where its scale ends; `None` to fit it.
    pub held: Option<f32>,
}

/// What is new for one side.
#[derive(Debug, Clone)]
pub enum PaneUpdate {
    /// A picture.
    Picture(Box<DisplayFrame>),
    /// Why there is none: one line.
    Fault(String),
}

/// What the UI collects.
pub type PaneUpdates = [Option<PaneUpdate>; 2];

/// Posts to the thread, which [`PostProcess::start`] began.
#[derive(Debug, Default)]
pub struct PostProcess {
    inbox: Inbox<Pending>,
    updates: Inbox<PaneUpdates>,
}

/// What a worker brings.
#[derive(Debug)]
enum Arrival {
    Picture(Picture),
    Fault(Order, String),
}

#[derive(Debug, Default)]
struct Pending {
    arrivals: [Option<Arrival>; 2],
    display: Option<DisplayTransform>,
    oldest_view: Option<u64>,
    comparison: Option<Comparison>,
    /// The reference of a view, or that there is none.
    reference: Option<Option<(u64, ReferenceImage)>>,
}

/// All that the thread has in hand.
#[derive(Default)]
struct Latest {
    latest: [Option<Picture>; 2],
    /// The newest job that each side has delivered.
    newest: [u64; 2],
    oldest_view: u64,
    display: DisplayTransform,
    comparison: Comparison,
    reference: Option<(u64, ReferenceImage)>,
}

impl PostProcess {
    /// Starts the thread, which calls `wake` whenever [`PostProcess::collect`] has something and hands what is to be
    /// drawn to the error_map_worker.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake, error_map_worker: Arc<ErrorMapWorker>) -> std::io::Result<(Arc<Self>, JoinHandle<()>)> {
        let post_process = Arc::new(PostProcess::default());
        let thread = std::thread::Builder::new().name("post_process".into()).spawn({
            let post_process = post_process.clone();
            move || post_process.work(&wake, &error_map_worker)
        })?;
        Ok((post_process, thread))
    }

    /// A new picture of one side.
    pub fn deliver(&self, side: Side, picture: Picture) {
        self.inbox.post(|pending| pending.arrivals[side as usize] = Some(Arrival::Picture(picture)));
    }

    /// A side has no picture, for a reason to be shown.
    pub fn report(&self, side: Side, order: Order, fault: String) {
        self.inbox.post(|pending| pending.arrivals[side as usize] = Some(Arrival::Fault(order, fault)));
    }

    /// A new display transform for both.
    pub fn set_display(&self, display: DisplayTransform) {
        self.inbox.post(|pending| pending.display = Some(display));
    }

    /// Another way to compare.
    pub fn set_comparison(&self, comparison: Comparison) {
        self.inbox.post(|pending| pending.comparison = Some(comparison));
    }

    /// The reference of a view as far as it has come, or that there is none.
    pub fn set_reference(&self, reference: Option<(u64, ReferenceImage)>) {
        self.inbox.post(|pending| pending.reference = Some(reference));
    }

    /// Forgets every picture of a view before this one, whether it has come or is still on its way.
    pub fn forget_before(&self, view: u64) {
        self.inbox.post(|pending| pending.oldest_view = Some(view));
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<PaneUpdates> {
        self.updates.take_now()
    }

    /// Ends the thread.
    pub fn close(&self) {
        self.inbox.close();
    }

    fn work(&self, wake: &Wake, error_map_worker: &ErrorMapWorker) {
        let mut latest = Latest::default();
        while let Some(pending) = self.inbox.take() {
            let redevelop = pending.display.is_some();
            let (fresh, faults) = latest.sort(pending);
            let errors = latest.errors();
            let resolve = |side: usize| {
                let picture = latest.latest[side].clone()?;
                let rgba = (redevelop || fresh[side]).then(|| latest.display.rgba8_of(&picture.image));
                Some(DisplayFrame { picture, rgba, errors: errors[side], against: latest.comparison.against })
            };
            // both at once: the error of one belongs to the picture of the other
            let frame = [resolve(0), resolve(1)];
            self.updates.post(|updates| {
                for ((place, new), fault) in updates.iter_mut().zip(frame).zip(faults) {
                    match (new, fault) {
                        (_, Some(fault)) => *place = Some(PaneUpdate::Fault(fault)),
                        (Some(new), None) => shelve(place, new),
                        (None, None) => {}
                    }
                }
            });
            wake();
            if let Some(map_job) = latest.map_job() {
                error_map_worker.submit(map_job);
            }
        }
    }
}

impl Latest {
    /// Takes what has come; returns which sides have a new picture, and why others have none.
    fn sort(&mut self, pending: Pending) -> ([bool; 2], [Option<String>; 2]) {
        self.display = pending.display.unwrap_or(self.display);
        self.comparison = pending.comparison.unwrap_or(self.comparison);
        self.reference = pending.reference.unwrap_or_else(|| self.reference.take());
        self.oldest_view = pending.oldest_view.unwrap_or(self.oldest_view);
        let oldest_view = self.oldest_view;
        self.latest.iter_mut().for_each(|kept| drop(kept.take_if(|picture| picture.order.view < oldest_view)));
        let (mut fresh, mut faults) = ([false; 2], [None, None]);
        for (side, arrival) in pending.arrivals.into_iter().enumerate() {
            match arrival {
                Some(Arrival::Picture(picture)) if still_wanted(&picture.order, oldest_view, self.newest[side]) => {
                    self.newest[side] = picture.order.job;
                    self.latest[side] = Some(picture);
                    fresh[side] = true;
                }
                Some(Arrival::Fault(order, fault)) if still_wanted(&order, oldest_view, self.newest[side]) => {
                    self.newest[side] = order.job;
                    self.latest[side] = None;
                    faults[side] = Some(fault);
                }
                _ => {}
            }
        }
        (fresh, faults)
    }

    /// Each side against the other, or against the reference, where both show one view at one size.
    fn errors(&self) -> [Option<Errors>; 2] {
        match (self.comparison.against, &self.latest) {
            (Against::EachOther, [Some(a), Some(b)]) if comparable(a, b) => {
                [(a, b), (b, a)].map(|(picture, other)| errors(&picture.image, &other.image).ok())
            }
            (Against::EachOther, _) => [None, None],
            (Against::Reference, sides) => [0, 1].map(|side| {
                let picture = sides[side].as_ref()?;
                self.reference_of(picture)?.errors(&picture.image).ok()
            }),
        }
    }

    /// The reference, if it is that of this picture.
    fn reference_of(&self, picture: &Picture) -> Option<&ReferenceImage> {
        let (view, reference_image) = self.reference.as_ref()?;
        let fits = *view == picture.order.view && reference_image.image.size() == picture.image.size();
        (fits && picture.order.provenance.recipe.shows_the_scene()).then_some(reference_image)
    }

    /// What to draw; `None` to leave the map as it is, where it only has to wait for a picture on its way.
    fn map_job(&self) -> Option<Option<ErrorMapJob>> {
        let MapWish { of, map, held } = self.comparison.map?;
        let film = self.latest[of as usize].as_ref();
        let (name, against) = match self.comparison.against {
            Against::EachOther => {
                let other = self.latest[of.other() as usize].as_ref();
                let other = other.filter(|other| film.is_some_and(|film| comparable(film, other)));
                (of.other().name(), other.map(|other| other.image.clone()))
            }
            Against::Reference => {
                let reference_image = film.and_then(|film| self.reference_of(film));
                ("reference", reference_image.map(|reference_image| reference_image.image.clone()))
            }
        };
        let rough = |picture: &Picture| picture.rough;
        let on_its_way = match &self.latest {
            [Some(a), Some(b)] if self.comparison.against == Against::EachOther => {
                rough(a) || rough(b) || a.order.view != b.order.view
            }
            _ => film.is_some_and(rough),
        };
        match (film, against) {
            (Some(film), Some(against)) => Some(Some(ErrorMapJob {
                pair: Pair { names: [of.name(), name], images: [film.image.clone(), against], display: self.display },
                map,
                held,
            })),
            _ if on_its_way => None,
            _ => Some(None),
        }
    }
}

/// A pane may change its technique while the other one still delivers: what comes from an older job is too late.
fn still_wanted(order: &Order, oldest_view: u64, newest_job: u64) -> bool {
    order.view >= oldest_view && order.job >= newest_job
}

/// Bytes that were not collected yet stay if what is newer brings none of its own.
fn shelve(place: &mut Option<PaneUpdate>, mut new: DisplayFrame) {
    if let (None, Some(PaneUpdate::Picture(old))) = (&new.rgba, place.as_mut()) {
        new.rgba = old.rgba.take();
    }
    *place = Some(PaneUpdate::Picture(Box::new(new)));
}

fn comparable(a: &Picture, b: &Picture) -> bool {
    let shows_the_scene = |picture: &Picture| picture.order.provenance.recipe.shows_the_scene();
    (a.image.size(), a.order.view) == (b.image.size(), b.order.view) && shows_the_scene(a) && shows_the_scene(b)
}

#[cfg(test)]
#[path = "post_process_tests.rs"]
mod tests;
