//! Errors of pictures whose samples are not independent of each other.

use crate::integrator::Integrator;
use crate::tracer::Tracer;
use film::Film;
use scene::{Camera, Vec3};

/// Fewest replicates that a standard error may be read from: with 16 it is itself known to about 18 %.
pub const FEWEST_REPLICATES: u32 = 16;

/// A film of `size` (width, height) from `replicates` pictures of `samples` each, of the integrator's
/// seed, the next one and so on; at least [`FEWEST_REPLICATES`] are made. Each pixel's samples are the replicates'
/// means, so that [`Film::standard_error`] is right for every sampler: those of [`crate::SamplerKind::Sobol`] within
/// one picture are not independent, but two scramblings are. `stop` as in [`Tracer::render`]; a replicate that it
/// interrupts is left out.
pub fn estimate_with_replicates(
    tracer: &Tracer,
    camera: &Camera,
    integrator: &Integrator,
    size: (u32, u32),
    samples: u32,
    replicates: u32,
    stop: &(impl Fn() -> bool + Sync),
) -> Film {
    let mut film = Film::new(size.0, size.1);
    for replicate in 0..replicates.max(FEWEST_REPLICATES) {
        let integrator = integrator.with_seed(integrator.seed().wrapping_add(replicate));
        let mut picture = Film::new(size.0, size.1);
        tracer.render(&mut picture, camera, &integrator, samples, stop);
        if stop() {
            break;
        }
        film.nonfinite += picture.nonfinite;
        for (pixel, one) in film.pixels_mut().iter_mut().zip(picture.pixels()) {
            pixel.add(Vec3::from_array(one.mean().map(|v| v as f32)));
        }
    }
    film
}
