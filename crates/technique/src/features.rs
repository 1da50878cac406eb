//! What the pixels of a film show, beside its light: made when a denoiser asks, and seldom again.

use crate::{Accumulation, Backend, Renderer, Watch};
use film::{Features, Film};
use pathtrace::{FeaturePass, Integrator, Tracer};
use scene::Camera;

/// Samples from which features are so clean that more would change nothing that a filter sees.
const ENOUGH: u32 = 16;

/// Samples with which they are made first: of fewer, what glass sends on by chance would be noise.
const FEWEST: u32 = 4;

/// What a finished film's pixels show, on the current rayon pool; `None` once `stop` says so.
pub fn features_of(
    tracer: &Tracer,
    film: &Film,
    (camera, integrator): (&Camera, &Integrator),
    stop: &(impl Fn() -> bool + Sync),
) -> Option<Features> {
    tracer.features(&pass_of(film, (camera, integrator), ENOUGH), stop)
}

fn pass_of(film: &Film, (camera, integrator): (&Camera, &Integrator), samples: u32) -> FeaturePass {
    let sampler = (integrator.sampler(), integrator.seed());
    FeaturePass::new(camera, (film.width(), film.height()), samples, sampler)
}

impl Renderer {
    /// What a film's pixels show, from few samples at first, and from enough once it has so many itself or is `finished`.
    pub(crate) fn make_features(
        &mut self,
        accumulation: &mut Accumulation,
        (camera, integrator): (&Camera, &Integrator),
        finished: bool,
        watch: &impl Watch,
    ) {
        let samples = if finished || accumulation.spp >= ENOUGH { ENOUGH } else { FEWEST };
        if accumulation.features.as_ref().is_some_and(|(made_from, _)| *made_from >= samples) {
            return;
        }
        let pass = pass_of(accumulation.film(), (camera, integrator), samples);
        let (scene, beside) = (&self.scene, &mut self.beside_the_device);
        let tracer = match &self.backend {
            Backend::Cpu(tracer) => tracer,
            Backend::Gpu(_) => beside.get_or_insert_with(|| Box::new(Tracer::new(scene))),
        };
        let stop = || watch.ends_now();
        let traced = self.threads.turn_unless(&stop, self.rank, || tracer.features(&pass, &stop)).flatten();
        if let Some(features) = traced {
            accumulation.features = Some((samples, features));
        }
    }
}
