//! The thread that draws maps of errors. It has its own because FLIP takes a third of a second, and no picture shall wait
//! for a map; a newer wish replaces one that was not begun.

use super::{Inbox, Wake, step_back};
use crate::ruler::{HeatMap, Pair};
use compare::ErrorMap;
use scene::Vec3;
use scene::display::DisplayTransform;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

/// Two pictures of one size and what to draw of them.
#[derive(Debug, Clone)]
pub struct Survey {
    /// What they are called.
    pub names: [&'static str; 2],
    /// Pixels in a row of both.
    pub width: u32,
    /// Linear radiances, rows from the top; the first is judged by the second.
    pub radiances: [Arc<[Vec3]>; 2],
    /// How FLIP sees them.
    pub display: DisplayTransform,
    /// What to map.
    pub map: ErrorMap,
    /// Where the scale ends; `None` to fit it.
    pub held: Option<f32>,
}

/// A map that is drawn.
#[derive(Debug)]
pub struct Surveyed {
    /// What it is of.
    pub survey: Survey,
    /// The numbers and their colours.
    pub map: HeatMap,
    /// Its bytes, four a pixel, without the bar.
    pub rgba: Vec<u8>,
}

/// The worker; [`Surveyor::close`] ends its thread.
pub struct Surveyor {
    inbox: Arc<Inbox<Option<Survey>>>,
    shelf: Arc<Inbox<Option<Surveyed>>>,
    thread: Mutex<Option<JoinHandle<()>>>,
}

impl Survey {
    /// The two pictures.
    pub fn pair(&self) -> Pair<'_> {
        let [film, reference] = &self.radiances;
        Pair { names: self.names, width: self.width, radiances: [film, reference], display: self.display }
    }
}

impl Surveyor {
    /// Starts the thread, which calls `wake` whenever [`Surveyor::collect`] has something.
    ///
    /// # Errors
    /// If the system gives no thread.
    pub fn start(wake: Wake) -> std::io::Result<Self> {
        let (inbox, shelf) = (Arc::new(Inbox::<Option<Survey>>::default()), Arc::new(Inbox::default()));
        let thread = std::thread::Builder::new().name("surveyor".into()).spawn({
            let (inbox, shelf) = (inbox.clone(), shelf.clone());
            move || {
                step_back();
                while let Some(survey) = inbox.take() {
                    // two pictures without the same pixels have no map
                    let drawn = survey.and_then(draw);
                    shelf.post(|place| *place = drawn);
                    wake();
                }
            }
        })?;
        Ok(Surveyor { inbox, shelf, thread: Mutex::new(Some(thread)) })
    }

    /// Asks for a map, or says that there is nothing to draw.
    pub fn submit(&self, survey: Option<Survey>) {
        self.inbox.post(|slot| *slot = survey);
    }

    /// What is new since the last call: a map, or that there is none.
    pub fn collect(&self) -> Option<Option<Surveyed>> {
        self.shelf.take_now()
    }

    /// Ends the thread.
    pub fn close(&self) {
        self.inbox.close();
        let thread = self.thread.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(thread) = thread {
            // a panic there has been printed already, and the window is closing
            let _ = thread.join();
        }
    }
}

fn draw(survey: Survey) -> Option<Surveyed> {
    let map = HeatMap::of(&survey.pair(), survey.map, survey.held).ok()?;
    let rgba = map.rgba();
    Some(Surveyed { survey, map, rgba })
}
