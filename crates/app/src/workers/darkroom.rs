//! The thread that develops: radiance through the display transform into bytes, and the error of each side against the
//! other or against the reference. Moving the exposure develops again and renders nothing. What a map of the errors is made
//! of goes on to the [`Surveyor`], which has a thread of its own: FLIP takes longer than a picture may wait.

use super::surveyor::{Survey, Surveyor};
use super::{Inbox, Order, Picture, Side, Wake};
use crate::ruler::{Against, Yardstick};
use compare::{ErrorMap, Errors, errors_of_radiances};
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
    pub map: ErrorMap,
    /// Where its scale ends; `None` to fit it.
    pub held: Option<f32>,
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

/// What a worker brings.
#[derive(Debug)]
enum Delivery {
    Picture(Picture),
    Fault(Order, String),
}

#[derive(Debug, Default)]
struct Tray {
    deliveries: [Option<Delivery>; 2],
    display: Option<DisplayTransform>,
    oldest_view: Option<u64>,
    comparison: Option<Comparison>,
    /// The reference of a view, or that there is none.
    reference: Option<Option<(u64, Yardstick)>>,
}

/// All that the thread has in hand.
#[derive(Default)]
struct Desk {
    latest: [Option<Picture>; 2],
    /// The newest job that each side has delivered.
    newest: [u64; 2],
    oldest_view: u64,
    display: DisplayTransform,
    comparison: Comparison,
    reference: Option<(u64, Yardstick)>,
}

impl Darkroom {
    /// Starts the thread, which calls `wake` whenever [`Darkroom::collect`] has something and hands what is to be drawn to the
    /// surveyor.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake, surveyor: Arc<Surveyor>) -> std::io::Result<(Arc<Self>, JoinHandle<()>)> {
        let darkroom = Arc::new(Darkroom::default());
        let thread = std::thread::Builder::new().name("darkroom".into()).spawn({
            let darkroom = darkroom.clone();
            move || darkroom.work(&wake, &surveyor)
        })?;
        Ok((darkroom, thread))
    }

    /// A new picture of one side.
    pub fn deliver(&self, side: Side, picture: Picture) {
        self.inbox.post(|tray| tray.deliveries[side as usize] = Some(Delivery::Picture(picture)));
    }

    /// A side has no picture, for a reason to be shown.
    pub fn report(&self, side: Side, order: Order, fault: String) {
        self.inbox.post(|tray| tray.deliveries[side as usize] = Some(Delivery::Fault(order, fault)));
    }

    /// A new display transform for both.
    pub fn set_display(&self, display: DisplayTransform) {
        self.inbox.post(|tray| tray.display = Some(display));
    }

    /// Another way to compare.
    pub fn set_comparison(&self, comparison: Comparison) {
        self.inbox.post(|tray| tray.comparison = Some(comparison));
    }

    /// The reference of a view as far as it has come, or that there is none.
    pub fn set_reference(&self, reference: Option<(u64, Yardstick)>) {
        self.inbox.post(|tray| tray.reference = Some(reference));
    }

    /// Forgets every picture of a view before this one, whether it has come or is still on its way.
    pub fn forget_before(&self, view: u64) {
        self.inbox.post(|tray| tray.oldest_view = Some(view));
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<Shelf> {
        self.shelf.take_now()
    }

    /// Ends the thread.
    pub fn close(&self) {
        self.inbox.close();
    }

    fn work(&self, wake: &Wake, surveyor: &Surveyor) {
        let mut desk = Desk::default();
        while let Some(tray) = self.inbox.take() {
            let redevelop = tray.display.is_some();
            let (fresh, faults) = desk.sort(tray);
            let errors = desk.errors();
            let develop = |side: usize| {
                let picture = desk.latest[side].clone()?;
                let radiances = picture.radiances.iter().copied();
                let rgba = (redevelop || fresh[side]).then(|| desk.display.to_rgba8(radiances));
                Some(Developed { picture, rgba, errors: errors[side], against: desk.comparison.against })
            };
            // both at once: the error of one belongs to the picture of the other
            let developed = [develop(0), develop(1)];
            self.shelf.post(|shelf| {
                for ((place, new), fault) in shelf.iter_mut().zip(developed).zip(faults) {
                    match (new, fault) {
                        (_, Some(fault)) => *place = Some(News::Fault(fault)),
                        (Some(new), None) => shelve(place, new),
                        (None, None) => {}
                    }
                }
            });
            wake();
            if let Some(survey) = desk.survey() {
                surveyor.submit(survey);
            }
        }
    }
}

impl Desk {
    /// Takes what has come; returns which sides have a new picture, and why others have none.
    fn sort(&mut self, tray: Tray) -> ([bool; 2], [Option<String>; 2]) {
        self.display = tray.display.unwrap_or(self.display);
        self.comparison = tray.comparison.unwrap_or(self.comparison);
        self.reference = tray.reference.unwrap_or_else(|| self.reference.take());
        self.oldest_view = tray.oldest_view.unwrap_or(self.oldest_view);
        let oldest_view = self.oldest_view;
        self.latest.iter_mut().for_each(|kept| drop(kept.take_if(|picture| picture.order.view < oldest_view)));
        let (mut fresh, mut faults) = ([false; 2], [None, None]);
        for (side, delivery) in tray.deliveries.into_iter().enumerate() {
            match delivery {
                Some(Delivery::Picture(picture)) if still_wanted(&picture.order, oldest_view, self.newest[side]) => {
                    self.newest[side] = picture.order.job;
                    self.latest[side] = Some(picture);
                    fresh[side] = true;
                }
                Some(Delivery::Fault(order, fault)) if still_wanted(&order, oldest_view, self.newest[side]) => {
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
                [(a, b), (b, a)].map(|(film, other)| Some(errors_of_radiances(&film.radiances, &other.radiances)))
            }
            (Against::EachOther, _) => [None, None],
            (Against::Reference, sides) => [0, 1].map(|side| {
                let picture = sides[side].as_ref()?;
                Some(self.yardstick_of(picture)?.errors(&picture.radiances))
            }),
        }
    }

    /// The reference, if it is that of this picture.
    fn yardstick_of(&self, picture: &Picture) -> Option<&Yardstick> {
        let (view, yardstick) = self.reference.as_ref()?;
        let fits = *view == picture.order.view && yardstick.size == (picture.width, picture.height);
        (fits && picture.order.provenance.recipe.shows_the_scene()).then_some(yardstick)
    }

    /// What to draw; `None` to leave the map as it is, where it only has to wait for a picture on its way.
    fn survey(&self) -> Option<Option<Survey>> {
        let MapWish { of, map, held } = self.comparison.map?;
        let film = self.latest[of as usize].as_ref();
        let (name, against) = match self.comparison.against {
            Against::EachOther => {
                let other = self.latest[of.other() as usize].as_ref();
                let other = other.filter(|other| film.is_some_and(|film| comparable(film, other)));
                (of.other().name(), other.map(|other| other.radiances.clone()))
            }
            Against::Reference => {
                let yardstick = film.and_then(|film| self.yardstick_of(film));
                ("reference", yardstick.map(|yardstick| yardstick.radiances.clone()))
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
            (Some(film), Some(against)) => Some(Some(Survey {
                names: [of.name(), name],
                width: film.width,
                radiances: [film.radiances.clone(), against],
                display: self.display,
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
fn shelve(place: &mut Option<News>, mut new: Developed) {
    if let (None, Some(News::Picture(old))) = (&new.rgba, place.as_mut()) {
        new.rgba = old.rgba.take();
    }
    *place = Some(News::Picture(Box::new(new)));
}

fn comparable(a: &Picture, b: &Picture) -> bool {
    let shows_the_scene = |picture: &Picture| picture.order.provenance.recipe.shows_the_scene();
    (a.width, a.height, a.order.view) == (b.width, b.height, b.order.view) && shows_the_scene(a) && shows_the_scene(b)
}

#[cfg(test)]
#[path = "darkroom_tests.rs"]
mod tests;
