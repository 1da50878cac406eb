//! The thread that post-processes: radiance through the display transform into bytes, and the error of each picture
//! against another one or against the reference. Moving the exposure shows again and renders nothing. What a map of the
//! errors is made of goes on to the [`ErrorMapWorker`], which has a thread of its own: FLIP takes longer than a picture
//! may wait.

use super::course::Course;
use super::earlier::Earlier;
use super::error_map::ErrorMapWorker;
use super::worker::{Control, Service, Worker};
use super::{Order, Picture, Wake};
use crate::model::{Against, Comparison, ErrorMapJob, ErrorPoint, MapWish, PaneId, Panes, Region};
use crate::ruler::{Noise, Pair, ReferenceImage};
use compare::{Errors, Histogram, errors, errors_within};
use film::{DisplayTransform, Image};
use std::sync::Arc;

/// A picture ready for the screen.
#[derive(Debug, Clone)]
pub struct DisplayFrame {
    /// What it was made from.
    pub picture: Picture,
    /// Its bytes; `None` where only the errors are new.
    pub rgba: Option<Vec<u8>>,
    /// What it is compared with, and how far it is from that; `None` unless that is there at the same size.
    pub errors: Option<(Against, Errors)>,
    /// The reference that it is compared with, if it is.
    pub reference: Option<ReferenceImage>,
    /// How bright the pixels of that part are, where it is asked for.
    pub histogram: Option<Arc<Histogram>>,
    /// The part of it that is compared; `None` for all.
    pub region: Option<Region>,
    /// How far it was from the reference while it was made, where that has come or become better since.
    pub course: Option<Vec<ErrorPoint>>,
    /// How far it was from the reference before it was denoised; `None` unless it was, and is held against that.
    pub errors_before: Option<Errors>,
}

/// What is new for one pane.
#[derive(Debug, Clone)]
pub enum PaneUpdate {
    /// The frame, ready to be shown in its pane.
    Picture(Box<DisplayFrame>),
    /// Why there is none: one line.
    Fault(String),
}

impl PaneUpdate {
    /// Whether it is a picture of a view before this one.
    pub fn is_older_than(&self, oldest_view: u64) -> bool {
        matches!(self, PaneUpdate::Picture(frame) if frame.picture.order.view < oldest_view)
    }
}

/// What the UI collects.
pub type PaneUpdates = Panes<PaneUpdate>;

/// The worker; [`PostProcess::close`] ends its thread.
pub struct PostProcess(Worker<Pending, PaneUpdates>);

/// What a worker brings.
#[derive(Debug)]
enum Arrival {
    Picture(Box<Picture>),
    Fault(Order, String),
    /// The pane is no longer wanted.
    Gone,
}

#[derive(Debug, Default)]
struct Pending {
    arrivals: Panes<Arrival>,
    display: Option<DisplayTransform>,
    oldest_view: Option<u64>,
    comparisons: Option<(Vec<Comparison>, Option<MapWish>)>,
    histograms: Option<bool>,
    /// The reference of a view, or that there is none.
    reference: Option<Option<(u64, ReferenceImage)>>,
}

/// All that the thread has in hand.
#[derive(Default)]
struct Latest {
    /// Draws maps of them.
    error_map_worker: Option<Arc<ErrorMapWorker>>,
    latest: Panes<Picture>,
    /// What tells how noisy they are.
    earlier: Panes<Earlier>,
    /// What tells how their errors have fallen.
    courses: Panes<Course>,
    /// The newest job that each pane has delivered.
    newest: Panes<u64>,
    oldest_view: u64,
    display: DisplayTransform,
    comparisons: Vec<Comparison>,
    map: Option<MapWish>,
    histograms: bool,
    reference: Option<(u64, ReferenceImage)>,
}

impl PostProcess {
    /// Starts the thread, which calls `wake` whenever [`PostProcess::collect`] has something and hands what is to be
    /// drawn to the worker of error maps.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake, error_map_worker: Arc<ErrorMapWorker>) -> std::io::Result<Self> {
        let service = || Latest { error_map_worker: Some(error_map_worker), ..Latest::default() };
        Worker::start("post_process", wake, service).map(PostProcess)
    }

    /// A new picture of one pane.
    pub fn deliver(&self, pane: PaneId, picture: Picture) {
        self.arrive(pane, Arrival::Picture(Box::new(picture)));
    }

    /// A pane has no picture, for a reason to be shown.
    pub fn report(&self, pane: PaneId, order: Order, fault: String) {
        self.arrive(pane, Arrival::Fault(order, fault));
    }

    /// A pane is no longer wanted.
    pub fn forget_pane(&self, pane: PaneId) {
        self.arrive(pane, Arrival::Gone);
    }

    fn arrive(&self, pane: PaneId, arrival: Arrival) {
        self.0.post(|pending| drop(pending.arrivals.insert(pane, arrival)));
    }

    /// A new display transform for all.
    pub fn set_display(&self, display: DisplayTransform) {
        self.0.post(|pending| pending.display = Some(display));
    }

    /// Other errors to measure, and the map that is looked at.
    pub fn set_comparisons(&self, comparisons: Vec<Comparison>, map: Option<MapWish>) {
        self.0.post(|pending| pending.comparisons = Some((comparisons, map)));
    }

    /// Whether pixels are counted by how bright they are.
    pub fn set_histograms(&self, histograms: bool) {
        self.0.post(|pending| pending.histograms = Some(histograms));
    }

    /// The reference of a view as far as it has come, or that there is none.
    pub fn set_reference(&self, reference: Option<(u64, ReferenceImage)>) {
        self.0.post(|pending| pending.reference = Some(reference));
    }

    /// Forgets every picture of a view before this one, whether it has come or is still on its way.
    pub fn forget_before(&self, view: u64) {
        self.0.post(|pending| pending.oldest_view = Some(view));
    }

    /// What is new since the last call.
    pub fn collect(&self) -> Option<PaneUpdates> {
        self.0.collect()
    }

    /// Ends the thread.
    pub fn close(&self) {
        self.0.close();
    }
}

impl Service for Latest {
    type Job = Pending;
    type Update = PaneUpdates;

    fn serve(&mut self, pending: Pending, control: &Control<Pending, PaneUpdates>) {
        let redevelop = pending.display.is_some();
        let judged_anew = pending.reference.is_some() || pending.comparisons.is_some();
        let (fresh, faults) = self.sort(pending);
        let (errors, before) = (self.errors(|picture| Some(&picture.image)), self.errors(undenoised));
        let resolve = |(pane, picture): (PaneId, &Picture)| {
            let new = redevelop || fresh.get(pane).is_some();
            let rgba = new.then(|| self.display.rgba8_of(&picture.image));
            // of two noisy pictures of the same samples it would say how alike they are
            let told = before.get(pane).filter(|(against, _)| *against == Against::Reference);
            let errors_before = told.map(|(_, errors)| *errors);
            let course = if judged_anew { self.course(pane, picture) } else { None };
            let errors = errors.get(pane).copied();
            let comparison = self.comparison(pane);
            let region = comparison.and_then(|comparison| comparison.region);
            let histogram = self.histograms.then(|| Arc::new(histogram(&picture.image, region)));
            let judged = comparison.filter(|comparison| comparison.against == Against::Reference);
            let reference = judged.and_then(|_| self.reference_of(picture)).cloned();
            (
                pane,
                DisplayFrame {
                    picture: picture.clone(),
                    rgba,
                    errors,
                    reference,
                    histogram,
                    region,
                    course,
                    errors_before,
                },
            )
        };
        // all at once: the error of one belongs to the picture of the other
        let frames: Panes<DisplayFrame> = self.latest.iter().map(resolve).collect();
        control.tell(|updates| {
            frames.into_iter().for_each(|(pane, frame)| shelve(updates, pane, frame));
            for (pane, fault) in faults {
                updates.insert(pane, PaneUpdate::Fault(fault));
            }
        });
        if let (Some(worker), Some(map_job)) = (&self.error_map_worker, self.map_job()) {
            worker.submit(map_job);
        }
    }

    /// What has come is still there, and shown with the next that comes.
    fn recover(&mut self, _control: &Control<Pending, PaneUpdates>) {}
}

impl Latest {
    /// Takes what has come; returns which panes have a new picture, and why others have none.
    fn sort(&mut self, pending: Pending) -> (Panes<()>, Panes<String>) {
        self.display = pending.display.unwrap_or(self.display);
        if let Some((comparisons, map)) = pending.comparisons {
            (self.comparisons, self.map) = (comparisons, map);
        }
        self.histograms = pending.histograms.unwrap_or(self.histograms);
        self.reference = pending.reference.unwrap_or_else(|| self.reference.take());
        self.oldest_view = pending.oldest_view.unwrap_or(self.oldest_view);
        let oldest_view = self.oldest_view;
        self.latest.retain(|_, picture| picture.order.view >= oldest_view);
        let (mut fresh, mut faults) = (Panes::default(), Panes::default());
        for (pane, arrival) in pending.arrivals {
            let newest = self.newest.entry(pane);
            match arrival {
                Arrival::Picture(picture) if still_wanted(&picture.order, oldest_view, *newest) => {
                    *newest = picture.order.job;
                    if let Some(earlier) = Earlier::follow(self.earlier.remove(pane), &picture) {
                        self.earlier.insert(pane, earlier);
                    }
                    if let Some(course) = Course::follow(self.courses.remove(pane), &picture) {
                        self.courses.insert(pane, course);
                    }
                    self.latest.insert(pane, *picture);
                    fresh.insert(pane, ());
                }
                Arrival::Fault(order, fault) if still_wanted(&order, oldest_view, *newest) => {
                    *newest = order.job;
                    self.latest.remove(pane);
                    faults.insert(pane, fault);
                }
                Arrival::Gone => {
                    drop((self.latest.remove(pane), self.earlier.remove(pane), self.courses.remove(pane)));
                }
                Arrival::Picture(_) | Arrival::Fault(..) => {}
            }
        }
        (fresh, faults)
    }

    /// How far what each pane has is from what judges it, where both show one view at one size.
    fn errors(&self, of: impl Fn(&Picture) -> Option<&Image>) -> Panes<(Against, Errors)> {
        let measured = |comparison: &Comparison| {
            let picture = self.latest.get(comparison.of)?;
            let image = of(picture)?;
            let errors = match comparison.against {
                Against::Pane(judge) => {
                    let judge = self.latest.get(judge).filter(|judge| comparable(picture, judge))?;
                    match comparison.region {
                        Some(region) => errors_within(image, &judge.image, &region.pixels(image.size())).ok()?,
                        None => errors(image, &judge.image).ok()?,
                    }
                }
                Against::Reference => self.errors_of(image, picture, comparison.region)?,
            };
            Some((comparison.of, (comparison.against, errors)))
        };
        self.comparisons.iter().filter_map(measured).collect()
    }

    /// How far a pane's picture was from the reference while it was made, where that judges it.
    fn course(&self, pane: PaneId, picture: &Picture) -> Option<Vec<ErrorPoint>> {
        let comparison = self.comparison(pane).filter(|comparison| comparison.against == Against::Reference)?;
        let points = self.courses.get(pane)?.measured(|image| self.errors_of(image, picture, comparison.region));
        (!points.is_empty()).then_some(points)
    }

    fn comparison(&self, pane: PaneId) -> Option<&Comparison> {
        self.comparisons.iter().find(|comparison| comparison.of == pane)
    }

    /// How far an earlier or later state of a picture is from the picture's reference.
    fn errors_of(&self, image: &Image, picture: &Picture, region: Option<Region>) -> Option<Errors> {
        let reference = self.reference_of(picture)?;
        match region {
            Some(region) => reference.errors_within(image, &region.pixels(image.size())).ok(),
            None => reference.errors(image).ok(),
        }
    }

    /// The reference, if it is that of this picture.
    fn reference_of(&self, picture: &Picture) -> Option<&ReferenceImage> {
        let (view, reference_image) = self.reference.as_ref()?;
        let fits = *view == picture.order.view && reference_image.image.size() == picture.image.size();
        (fits && !picture.coarse && picture.order.provenance.technique.has_a_reference()).then_some(reference_image)
    }

    /// What is known of the noise of a pane's picture.
    fn noise_of(&self, pane: PaneId, picture: &Picture) -> Noise {
        let has_samples = picture.spp.is_some() || picture.external.is_some();
        let unknown = if has_samples { Noise::Unknown } else { Noise::None };
        self.earlier.get(pane).map_or(unknown, |earlier| earlier.noise_of(picture))
    }

    /// What to draw; `None` to leave the map as it is, where it only has to wait for a picture on its way.
    fn map_job(&self) -> Option<Option<ErrorMapJob>> {
        let MapWish { comparison: Comparison { of, against, region }, metric, held } = self.map?;
        let film = self.latest.get(of);
        let judge = match against {
            Against::Pane(judge) => self.latest.get(judge),
            Against::Reference => None,
        };
        let judged_by = match against {
            Against::Pane(id) => judge
                .filter(|judge| film.is_some_and(|film| comparable(film, judge)))
                .map(|judge| (&judge.image, self.noise_of(id, judge))),
            Against::Reference => film
                .and_then(|film| self.reference_of(film))
                .map(|reference| (&reference.image, reference.noise_of_pixels())),
        };
        let on_its_way = match (film, judge) {
            (Some(film), Some(judge)) => film.rough || judge.rough || film.order.view != judge.order.view,
            _ => film.is_some_and(|film| film.rough),
        };
        match (film, judged_by) {
            (Some(film), Some((judged_by, its_noise))) => Some(Some(ErrorMapJob {
                pair: Pair {
                    names: [of.name(), against.name()],
                    images: [film.image.clone(), judged_by.clone()],
                    noise: [self.noise_of(of, film), its_noise],
                    display: self.display,
                },
                map: metric,
                held,
                region,
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
fn shelve(updates: &mut PaneUpdates, pane: PaneId, mut new: DisplayFrame) {
    if let (None, Some(PaneUpdate::Picture(old))) = (&new.rgba, updates.get_mut(pane)) {
        new.rgba = old.rgba.take();
    }
    if let (None, Some(PaneUpdate::Picture(old))) = (&new.course, updates.get_mut(pane)) {
        new.course = old.course.take();
    }
    updates.insert(pane, PaneUpdate::Picture(Box::new(new)));
}

fn histogram(image: &Image, region: Option<Region>) -> Histogram {
    match region {
        Some(region) => Histogram::of(region.pixels(image.size()).of(image.radiances(), image.width())),
        None => Histogram::of(image.radiances().iter()),
    }
}

fn undenoised(picture: &Picture) -> Option<&Image> {
    picture.before.as_ref().map(|before| &before.image)
}

fn comparable(a: &Picture, b: &Picture) -> bool {
    let shows_the_scene = |picture: &Picture| picture.order.provenance.technique.shows_the_scene();
    let light = |picture: &Picture| picture.order.provenance.technique.light();
    let same = (a.image.size(), a.order.view, light(a)) == (b.image.size(), b.order.view, light(b));
    same && !a.coarse && !b.coarse && shows_the_scene(a) && shows_the_scene(b)
}

#[cfg(test)]
#[path = "post_process_tests.rs"]
mod tests;
