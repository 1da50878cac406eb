//! Guides for the pictures of a scene, learned when they are first asked for.

use super::Guide;
use super::cells::Cells;
use super::training::{Notes, SAMPLES, SIDE};
use crate::drive::lanes::{FilmJob, FilmPass};
use crate::integrator::path_plan::Plan;
use crate::integrator::settings::{ConesAt, Directions, Estimator, PathSettings};
use film::Film;
use scene::camera::PictureFrame;
use std::sync::{Arc, Mutex, PoisonError};

/// The guide that was asked for last, kept for the passes that follow.
pub struct Guides {
    cells: Cells,
    last: Mutex<Option<Kept>>,
}

/// A guide, and all that it depends on beside the scene.
struct Kept {
    settings: PathSettings,
    frame: PictureFrame,
    guide: Arc<Guide>,
}

/// Tells the paths that teach from those of a picture of the same seed.
const OTHER_SEED: u32 = 0x6a09_e667;

impl Guides {
    /// For a scene in a box.
    pub fn new(cells: Cells) -> Self {
        Guides { cells, last: Mutex::new(None) }
    }

    /// The guide of a picture: a function of scene, view, settings and seed. `None` where the job is stopped before it
    /// is learned.
    pub fn of(&self, settings: &PathSettings, job: &FilmJob) -> Option<Arc<Guide>> {
        let serves = |kept: &&Kept| kept.settings == *settings && kept.frame == job.pass.frame;
        let last = || self.last.lock().unwrap_or_else(PoisonError::into_inner);
        let known = last().as_ref().filter(serves).map(|kept| kept.guide.clone());
        known.or_else(|| {
            let guide = Arc::new(self.learned(settings, job)?);
            *last() = Some(Kept { settings: *settings, frame: job.pass.frame, guide: guide.clone() });
            Some(guide)
        })
    }

    /// Follows cosine-weighted paths of the same kind through a picture of their own.
    fn learned(&self, settings: &PathSettings, job: &FilmJob) -> Option<Guide> {
        let estimator = Estimator { directions: Directions::Cosine, ..settings.estimator };
        let seed = settings.seed ^ OTHER_SEED;
        // what a guide learns is where the lobe's own directions lead
        let (cones, split_glass) = (ConesAt::Nothing, false);
        let cosine = PathSettings { estimator, branches: 1, seed, cones, split_glass, ..*settings };
        let sampler = (settings.sampler, seed);
        let pass = FilmPass { frame: job.pass.frame, size: [SIDE; 2], until: SAMPLES, sampler, probed: None };
        let notes = Notes::new(self.cells);
        let mut film = Film::new(SIDE, SIDE);
        FilmJob { pass, ..*job }.fill(&mut film, &Plan::that_teaches(&cosine, &notes));
        (film.samples_per_pixel() == SAMPLES).then(|| notes.guide())
    }
}
