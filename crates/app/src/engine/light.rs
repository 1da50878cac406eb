//! How much light each bounce brings: a small picture of each part, one after the other.

use super::Wake;
use super::worker::{Control, Service, Worker};
use crate::model::{LightByBounce, LightWish, Panes, light_parts};
use film::Film;
use film::colour::luminance;
use pathtrace::{Integrator, Tracer};
use std::sync::Arc;
use technique::{Rank, Technique, Threads, Trees};

/// Pixels along the longer side of the small pictures, 160 x 90 in a wide window.
const LONGER_SIDE: u32 = 160;

/// Samples per pixel: 230,000 paths of each part, whose mean is off by a percent or so.
const SPP: u32 = 16;

/// The thread, made when it is first asked for something; dropping it ends it.
pub struct LightMeter {
    threads: Arc<Threads>,
    wake: Wake,
    worker: Option<Worker<Vec<LightWish>, Panes<LightByBounce>>>,
    /// What it was last asked for.
    asked: Vec<LightWish>,
}

impl LightMeter {
    /// Traces on these threads in its turn.
    pub fn new(threads: Arc<Threads>, wake: Wake) -> Self {
        LightMeter { threads, wake, worker: None, asked: Vec::new() }
    }

    /// Measures the light of these pictures, if it does not already.
    pub fn measure(&mut self, wanted: &[LightWish]) {
        let same = self.asked.len() == wanted.len() && self.asked.iter().zip(wanted).all(|(a, b)| a.is_like(b));
        if same {
            return;
        }
        if self.worker.is_none() {
            let threads = self.threads.clone();
            // without a thread there are no bars; the next frame tries again
            self.worker = Worker::start("light by bounce", self.wake.clone(), || Meter { threads }).ok();
        }
        if let Some(worker) = &self.worker {
            worker.cancel();
            worker.post(|job| *job = wanted.to_vec());
            self.asked = wanted.to_vec();
        }
    }

    /// What was found since the last call.
    pub fn measured(&self) -> Panes<LightByBounce> {
        self.worker.as_ref().and_then(Worker::collect).unwrap_or_default()
    }
}

struct Meter {
    threads: Arc<Threads>,
}

impl Service for Meter {
    type Job = Vec<LightWish>;
    type Update = Panes<LightByBounce>;

    fn serve(&mut self, wishes: Vec<LightWish>, control: &Control<Self::Job, Self::Update>) {
        for wish in wishes {
            let mut light = LightByBounce::default();
            for luminance in luminances(&wish, &self.threads, &|| control.ends_soon()) {
                light.luminances.push(luminance);
                control.tell(|panes| _ = panes.insert(wish.pane, light.clone()));
            }
        }
    }

    fn recover(&mut self, _control: &Control<Self::Job, Self::Update>) {}
}

/// Mean luminance of each part, one after the other; ends early where `ends` says so.
fn luminances<'a>(
    wish: &'a LightWish,
    threads: &'a Threads,
    ends: &'a (impl Fn() -> bool + Sync),
) -> impl Iterator<Item = f64> + 'a {
    let tracer = match wish.technique {
        Technique::Traced(traced) => {
            let scene = traced.applied_to(&wish.shot.scene);
            Trees::of(&scene, &|_| !ends()).map(|_trees| Tracer::new(&scene))
        }
        Technique::Fake(_) => None,
    };
    light_parts().map_while(move |part| match wish.technique.with_light(part.into())? {
        Technique::Traced(traced) => luminance_of(tracer.as_ref()?, wish, &traced.integrator, threads, ends),
        Technique::Fake(_) => None,
    })
}

fn luminance_of(
    tracer: &Tracer,
    wish: &LightWish,
    integrator: &Integrator,
    threads: &Threads,
    ends: &(impl Fn() -> bool + Sync),
) -> Option<f64> {
    let (width, height) = small(wish.shot.size);
    let mut film = Film::try_new(width, height)?;
    threads
        .turn_unless(ends, Rank::Background, || tracer.render(&mut film, &wish.shot.camera, integrator, SPP, ends))?;
    let mean = film.mean().map(|channel| channel as f32);
    (!ends()).then(|| f64::from(luminance(mean.into())))
}

/// The same shape with fewer pixels.
fn small((width, height): (u32, u32)) -> (u32, u32) {
    let shrink = f64::from(LONGER_SIDE) / f64::from(width.max(height).max(1));
    let side = |side: u32| ((f64::from(side) * shrink).round() as u32).clamp(1, LONGER_SIDE);
    (side(width), side(height))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::PaneId;
    use std::path::Path;
    use technique::{PaneSettings, Shot, TechniqueName};

    /// A ball that shines and reflects half, seen from its middle.
    const FURNACE: &str = "camera = { eye = [0, 0, 0], target = [0, 0, 1], fov_y = 90 }\n\
        [material.wall]\ndiffuse.albedo = [0.5, 0.5, 0.5]\nemissive = { radiance = [1, 1, 1], two_sided = true }\n\
        [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'wall'\n";

    #[test]
    fn each_bounce_in_a_furnace_brings_half_of_the_one_before() {
        let scene = scene::parse(FURNACE, "furnace", Path::new("furnace.toml")).expect("a scene");
        let pane = PaneSettings::of(TechniqueName::Path);
        let shot = Shot::of(scene, (320, 180));
        let wish = LightWish::of(PaneId::B, &shot, pane.in_use()).expect("paths");
        let luminances: Vec<f64> = luminances(&wish, &Threads::all(), &|| false).collect();
        assert_eq!((luminances.len(), small(shot.size)), (light_parts().count(), (160, 90)));
        // lights 1, each bounce half of the one before, all others as much as the last; roulette makes noise of that
        for (part, luminance) in luminances.iter().enumerate() {
            let expected = 0.5f64.powi(part.min(9) as i32);
            assert!((luminance / expected - 1.0).abs() < 0.05, "part {part}: {luminance} and not {expected}");
        }
        assert_eq!(super::luminances(&wish, &Threads::all(), &|| true).count(), 0, "ended before it began");
    }
}
