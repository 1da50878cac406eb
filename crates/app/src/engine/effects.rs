//! The thread that finds out which effect of light makes each part of the picture, while the map of errors names them, and what
//! each has of the errors. The effects stay from map to map, and the scene ready for rays from view to view.

use super::ask::Engine;
use super::worker::{Control, Service, Worker};
use super::{FAULT, Wake, step_back};
use crate::model::{EffectsOfView, ErrorMap, ShownEffects};
use compare::ErrorMetric;
use pathtrace::Tracer;
use scene::Scene;
use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use technique::effects::{EffectMap, EffectShare};
use technique::{Rank, Shot, Threads, Trees};

/// Pictures go before, but for more of their samples.
const RANK: Rank = Rank::Refinement;

/// What asks the thread, which is started when effects are first named; dropping it ends the thread.
#[derive(Default)]
pub struct Effects {
    worker: Option<Worker<Job, EffectsNews>>,
    /// The view, and the map of errors whose shares are told.
    last: Option<(Shot, Option<Arc<ErrorMap>>)>,
    /// The number of jobs so far: answers to older ones are dropped.
    jobs: u64,
}

/// What the thread is asked for.
#[derive(Debug, Default)]
enum Job {
    /// Nothing: what was cancelled. The scene stays ready.
    #[default]
    Rest,
    /// To keep nothing of what nobody looks at.
    Forget,
    /// The effects of a view, and their shares of a map's errors; the number of this job.
    Find(u64, Box<Shot>, Option<Arc<ErrorMap>>),
}

/// What became of a job, or why nothing did: a line.
type EffectsNews = Option<(u64, Result<ShownEffects, String>)>;

impl Effects {
    /// Asks for the effects of a view and what they have of these errors, if that is not what was asked for.
    pub fn follow(
        &mut self,
        (wish, errors): (Option<Shot>, Option<&Arc<ErrorMap>>),
        threads: &Arc<Threads>,
        wake: &Wake,
    ) {
        let Some(shot) = wish else {
            if let Some(worker) = self.worker.as_ref().filter(|_| self.last.is_some()) {
                worker.cancel();
                worker.post(|job| *job = Job::Forget);
            }
            self.last = None;
            return;
        };
        let is_same_view = self.last.as_ref().is_some_and(|(last, _)| last.is_of_the_same_view(&shot));
        let known = self.last.as_ref().and_then(|(_, errors)| errors.as_ref());
        let are_same_errors = match (known, errors) {
            (Some(known), Some(errors)) => Arc::ptr_eq(known, errors),
            (known, errors) => known.is_none() && errors.is_none(),
        };
        if is_same_view && are_same_errors {
            return;
        }
        if self.worker.is_none() {
            let threads = threads.clone();
            let service = move || {
                step_back();
                Finder { threads, ready: None, of_view: None, number: 0 }
            };
            // without a thread nothing is found; the next frame tries again
            self.worker = Worker::start("effects", wake.clone(), service).ok();
        }
        let Some(worker) = &self.worker else { return };
        if !is_same_view {
            worker.cancel();
        }
        self.jobs += 1;
        let errors = errors.cloned();
        worker.post(|job| *job = Job::Find(self.jobs, Box::new(shot.clone()), errors.clone()));
        self.last = Some((shot, errors));
    }

    /// What was found for the last wish since the last call, or why nothing was: a line.
    pub fn collect(&self) -> Option<Result<ShownEffects, String>> {
        let (number, found) = self.worker.as_ref()?.collect()??;
        (self.last.is_some() && number == self.jobs).then_some(found)
    }
}

impl Engine {
    /// Asks for the effects of a view, and for what they have of these errors, in turns of the threads that trace.
    pub fn follow_effects(&self, effects: &mut Effects, wish: Option<Shot>, errors: Option<&Arc<ErrorMap>>) {
        effects.follow((wish, errors), &self.threads, &self.wake);
    }
}

/// The thread that finds what is wanted.
struct Finder {
    threads: Arc<Threads>,
    /// A scene, and that ready for rays.
    ready: Option<(Arc<Scene>, Arc<Tracer>)>,
    /// The effects of the view that was asked for last.
    of_view: Option<Arc<EffectsOfView>>,
    /// Of the job in hand.
    number: u64,
}

/// Says whether another view is wanted.
type Ends<'a> = dyn Fn() -> bool + Sync + 'a;

impl Service for Finder {
    type Job = Job;
    type Update = EffectsNews;

    fn serve(&mut self, job: Job, control: &Control<Job, EffectsNews>) {
        match job {
            Job::Rest => {}
            Job::Forget => (self.ready, self.of_view) = (None, None),
            Job::Find(number, shot, errors) => {
                self.number = number;
                if let Some(of_view) = self.find(&shot, &|| control.ends_now()) {
                    let shares = errors.map_or_else(Vec::new, |errors| shares(&of_view.map, &errors));
                    control.tell(|news| *news = Some((number, Ok(ShownEffects { of_view, shares }))));
                }
            }
        }
    }

    fn recover(&mut self, control: &Control<Job, EffectsNews>) {
        (self.ready, self.of_view) = (None, None);
        control.tell(|news| *news = Some((self.number, Err(FAULT.into()))));
    }
}

impl Finder {
    /// The effects of a view; `None` once `ends` says so.
    fn find(&mut self, shot: &Shot, ends: &Ends) -> Option<Arc<EffectsOfView>> {
        if let Some(known) = self.of_view.as_ref().filter(|known| known.shot.is_of_the_same_view(shot)) {
            return Some(known.clone());
        }
        let tracer = self.make_ready(&shot.scene, ends)?;
        let map = loop {
            // first pictures go before: what is begun is given up and begun again
            let gave_way = AtomicBool::new(false);
            let gives_way = || {
                let gives_way = ends() || self.threads.are_wanted_by_more_than(RANK);
                gave_way.fetch_or(gives_way, Ordering::Relaxed);
                gives_way
            };
            match self.threads.turn_unless(ends, RANK, || EffectMap::of(&tracer, shot, &gives_way))? {
                Some(map) => break map,
                None if gave_way.load(Ordering::Relaxed) && !ends() => {}
                None => return None,
            }
        };
        let of_view = Arc::new(EffectsOfView::new(shot.clone(), map));
        self.of_view = Some(of_view.clone());
        Some(of_view)
    }

    /// The scene ready for rays, made so unless it is.
    fn make_ready(&mut self, scene: &Arc<Scene>, ends: &Ends) -> Option<Arc<Tracer>> {
        if let Some((_, tracer)) = self.ready.as_ref().filter(|(ready, _)| Arc::ptr_eq(ready, scene)) {
            return Some(tracer.clone());
        }
        let _trees = Trees::of(scene, &|_| !ends())?;
        // before there is another: both would take twice the memory
        self.ready = None;
        let tracer = Arc::new(self.threads.turn_unless(ends, RANK, || Tracer::new(scene))?);
        self.ready = Some((scene.clone(), tracer.clone()));
        Some(tracer)
    }
}

/// What each effect has of the squared relative errors, whichever the map shows: relMSE is their mean.
fn shares(effects: &EffectMap, errors: &ErrorMap) -> Vec<EffectShare> {
    let pair = &errors.map_job.pair;
    let squared = match errors.map.map {
        ErrorMetric::SquaredRelative => Cow::Borrowed(&errors.map.values),
        _ => {
            let [image, reference] = &pair.images;
            // two pictures of one size, or there would be no map
            Cow::Owned(ErrorMetric::SquaredRelative.of(image, reference, &pair.display).unwrap_or_default())
        }
    };
    effects.shares(&squared, errors.map.width)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::ErrorMapJob;
    use crate::ruler::{HeatMap, Noise, Pair};
    use film::{DisplayTransform, Image, Vec3};
    use std::time::{Duration, Instant};
    use technique::effects::Effect;

    fn shot() -> Shot {
        Shot::of(scene::builtin::named("whitted").unwrap(), (96, 54))
    }

    /// A map of errors of which 480 pixels of the sky are off by one, and 150 of the floor by a half.
    fn errors(metric: ErrorMetric) -> Arc<ErrorMap> {
        let grey = |value: f32| vec![Vec3::splat(value); 96 * 54];
        let mut off = grey(1.0);
        off[..96 * 5].fill(Vec3::splat(2.0));
        off.chunks_mut(96).skip(49).for_each(|row| row[30..60].fill(Vec3::splat(1.5)));
        let images = [Image::new(96, 54, off).unwrap(), Image::new(96, 54, grey(1.0)).unwrap()];
        let (noise, display) = ([Noise::None, Noise::None], DisplayTransform::default());
        let pair = Pair { names: ["A", "reference"], images, noise, display };
        let map = HeatMap::of(&pair, metric, None).unwrap();
        let map_job = ErrorMapJob { pair, map: metric, held: None, region: None };
        Arc::new(ErrorMap { map_job, mean: map.mean, nonfinite: 0, rgba: Vec::new(), map })
    }

    fn found(effects: &Effects) -> ShownEffects {
        let start = Instant::now();
        loop {
            if let Some(found) = effects.collect() {
                return found.unwrap();
            }
            assert!(start.elapsed() < Duration::from_secs(60), "nothing is found");
            std::thread::yield_now();
        }
    }

    #[test]
    fn effects_are_found_and_their_shares_are_of_the_squared_error_whichever_is_shown() {
        let (threads, wake): (_, Wake) = (Arc::new(Threads::all()), Arc::new(|| ()));
        let mut effects = Effects::default();
        let shot = shot();
        effects.follow((Some(shot.clone()), None), &threads, &wake);
        let before = found(&effects);
        assert!(before.shares.is_empty() && !before.of_view.outlines.is_empty());
        let signed = errors(ErrorMetric::Signed);
        effects.follow((Some(shot.clone()), Some(&signed)), &threads, &wake);
        let after = found(&effects);
        assert!(Arc::ptr_eq(&before.of_view, &after.of_view), "the view's effects are not found again");
        let sky = after.shares[0];
        assert!(sky.effect == Effect::Sky && (sky.error - 480.0 / 517.5).abs() < 1e-5, "480 of 480 + 150 / 4: {sky:?}");
        effects.follow((Some(shot.clone()), Some(&signed)), &threads, &wake);
        assert!(effects.collect().is_none(), "the same again is no new wish");
        effects.follow((Some(shot), Some(&errors(ErrorMetric::SquaredRelative))), &threads, &wake);
        assert_eq!(found(&effects).shares, after.shares);
    }

    #[test]
    fn the_newest_view_wins_and_what_is_no_longer_wanted_is_not_told() {
        let (threads, wake): (_, Wake) = (Arc::new(Threads::all()), Arc::new(|| ()));
        let mut effects = Effects::default();
        let (first, mut second) = (shot(), shot());
        second.camera.fov_y = 30.0;
        effects.follow((Some(first), None), &threads, &wake);
        effects.follow((Some(second.clone()), None), &threads, &wake);
        assert!(found(&effects).of_view.shot.is_of_the_same_view(&second));
        effects.follow((None, None), &threads, &wake);
        assert!(effects.collect().is_none());
    }
}
