//! The thread that develops: radiance through the display transform into bytes, and the error of each side against the
//! other. Moving the exposure develops again and renders nothing.

use super::{Inbox, Order, Picture, Side, Wake};
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

    fn work(&self, wake: &Wake) {
        let mut display = DisplayTransform::default();
        let mut oldest_view = 0;
        let mut latest: [Option<Picture>; 2] = [None, None];
        let mut newest = [0; 2];
        while let Some(tray) = self.inbox.take() {
            let redevelop = tray.display.is_some();
            display = tray.display.unwrap_or(display);
            oldest_view = tray.oldest_view.unwrap_or(oldest_view);
            latest.iter_mut().for_each(|kept| drop(kept.take_if(|picture| picture.order.view < oldest_view)));
            let mut fresh = [false; 2];
            for (side, delivery) in tray.deliveries.into_iter().enumerate() {
                match delivery {
                    Some(Delivery::Picture(picture)) if still_wanted(&picture.order, oldest_view, newest[side]) => {
                        newest[side] = picture.order.job;
                        latest[side] = Some(picture);
                        fresh[side] = true;
                    }
                    Some(Delivery::Fault(order, fault)) if still_wanted(&order, oldest_view, newest[side]) => {
                        newest[side] = order.job;
                        latest[side] = None;
                        self.shelf.post(|shelf| shelf[side] = Some(News::Fault(fault)));
                    }
                    _ => {}
                }
            }
            let errors = mutual_errors(&latest);
            for side in 0..2 {
                let Some(picture) = latest[side].clone() else { continue };
                let rgba = (redevelop || fresh[side]).then(|| display.to_rgba8(picture.radiances.iter().copied()));
                let new = Developed { picture, rgba, errors: errors[side] };
                self.shelf.post(|shelf| shelve(&mut shelf[side], new));
            }
            wake();
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

/// Each side against the other, where both show one view at one size.
fn mutual_errors(latest: &[Option<Picture>; 2]) -> [Option<Errors>; 2] {
    match latest {
        [Some(a), Some(b)] if comparable(a, b) => {
            let of =
                |film: &Picture, reference: &Picture| Some(errors_of_radiances(&film.radiances, &reference.radiances));
            [of(a, b), of(b, a)]
        }
        _ => [None, None],
    }
}

fn comparable(a: &Picture, b: &Picture) -> bool {
    let shows_the_scene = |picture: &Picture| picture.order.provenance.recipe.shows_the_scene();
    (a.width, a.height, a.order.view) == (b.width, b.height, b.order.view) && shows_the_scene(a) && shows_the_scene(b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::{PaneSettings, Provenance, SceneChanges, Technique};
    use scene::Vec3;

    fn order(job: u64, view: u64) -> Order {
        let scene = Arc::new(scene::builtin::named("cornell").unwrap());
        let provenance = Arc::new(Provenance {
            source: "cornell".into(),
            changes: SceneChanges::default(),
            camera: scene.camera,
            recipe: PaneSettings::of(Technique::Path).recipe(),
            size: (1, 1),
        });
        Order { job, view, restarts: 0, scene, provenance }
    }

    fn picture(view: u64) -> Picture {
        let order = order(view, view);
        let radiances = [Vec3::splat(view as f32)].into();
        Picture {
            width: 1,
            height: 1,
            radiances,
            spp: None,
            seconds: 0.0,
            nonfinite: 0,
            adapter: "none".into(),
            rough: false,
            unfinished: false,
            order,
        }
    }

    /// Runs a darkroom over what `post` posts, and returns all that it shelved.
    fn developed(post: impl Fn(&Darkroom)) -> Shelf {
        let (darkroom, thread) = Darkroom::start(Arc::new(|| {})).unwrap();
        post(&darkroom);
        let mut shelf = Shelf::default();
        for _ in 0..200 {
            for (place, news) in shelf.iter_mut().zip(darkroom.collect().unwrap_or_default()) {
                *place = news.or_else(|| place.take());
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        darkroom.close();
        thread.join().unwrap();
        shelf
    }

    #[test]
    fn only_pictures_of_one_view_are_compared() {
        for (view_of_b, comparable) in [(1, true), (2, false)] {
            let shelf = developed(|darkroom| {
                darkroom.deliver(Side::A, picture(1));
                darkroom.deliver(Side::B, picture(view_of_b));
            });
            let [Some(News::Picture(a)), Some(News::Picture(b))] = shelf else { panic!("two pictures") };
            assert_eq!((a.errors.is_some(), b.errors.is_some()), (comparable, comparable));
        }
    }

    #[test]
    fn a_picture_of_an_older_job_does_not_replace_a_newer_one() {
        let shelf = developed(|darkroom| {
            darkroom.deliver(Side::A, Picture { order: order(8, 1), ..picture(1) });
            std::thread::sleep(std::time::Duration::from_millis(20));
            darkroom.deliver(Side::A, Picture { order: order(7, 1), ..picture(1) });
        });
        assert!(matches!(&shelf[0], Some(News::Picture(developed)) if developed.picture.order.job == 8));
    }

    #[test]
    fn a_fault_stays_and_forgotten_views_do_not_come_back() {
        let shelf = developed(|darkroom| {
            darkroom.forget_before(5);
            darkroom.report(Side::A, picture(5).order, "no".into());
            darkroom.deliver(Side::B, picture(4));
        });
        assert!(matches!(&shelf[0], Some(News::Fault(fault)) if fault == "no"));
        assert!(shelf[1].is_none());
    }
}
