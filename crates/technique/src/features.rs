//! What the pixels of a film show, beside its light: made when a denoiser asks, and seldom again.

use crate::{Accumulation, Backend, Renderer, Watch};
use pathtrace::{FeaturePass, Integrator, Tracer};
use scene::Camera;

/// Samples from which features are so clean that more would change nothing that a filter sees.
const SAMPLES_OF_FEATURES: u32 = 16;

impl Renderer {
    /// What a film's pixels show, from as many samples as it has, up to what is enough; made anew when it has four times
    /// as many as then.
    pub(crate) fn make_features(
        &mut self,
        accumulation: &mut Accumulation,
        (camera, integrator): (&Camera, &Integrator),
        watch: &impl Watch,
    ) {
        let samples = accumulation.spp.clamp(1, SAMPLES_OF_FEATURES);
        if accumulation.features.as_ref().is_some_and(|(made_from, _)| made_from.saturating_mul(4) > samples) {
            return;
        }
        let film = accumulation.film();
        let sampler = (integrator.sampler(), integrator.seed());
        let pass = FeaturePass::new(camera, (film.width(), film.height()), samples, sampler);
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
