//! One measurement: pictures of independent seeds by one technique at one number of samples, each timed and held against the
//! reference, and all together asked for a bias.

use crate::BenchError;
use crate::line::Line;
use crate::plan::{Part, SEEDS};
use crate::references::{Truth, Worth};
use compare::{ErrorMetric, Errors, REL_MSE_FLOOR, finite_mean, split_error};
use film::DisplayTransform;
use film::Film;
use pathtrace::{Integrator, Stats};
use raster::Raster;
use scene::Scene;
use serde::{Deserialize, Serialize};
use std::time::Instant;
use technique::{Accumulation, Backend, Device, FakeSettings, Filters, features_of};

/// Standard errors beyond which a bias is believed.
pub const SIGMAS: f64 = 4.0;

/// One picture: what it cost and how far off it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Its seed; 0 where nothing is random.
    pub seed: u32,
    /// Wall-clock seconds of tracing or drawing alone.
    pub seconds: f64,
    /// Samples taken, one camera ray each; 0 of the fake.
    pub samples: u64,
    /// Rays traced, shadow rays included; 0 of the fake.
    pub rays: u64,
    /// Samples that lost light to the hard cap of path lengths.
    pub cut_paths: u64,
    /// Samples that were not finite and are left out.
    pub nonfinite: u64,
    /// In radiance, noise of the reference included.
    pub rmse: f64,
    /// Mean of (a - r)^2 / (r^2 + 0.01), noise of the reference included.
    pub rel_mse: f64,
    /// Mean of |a - r|, in radiance.
    pub mae: f64,
    /// Mean of a - r, in radiance.
    pub bias: f64,
    /// Mean LDR-FLIP of the pictures as displayed.
    pub flip: f64,
    /// Share of its brightest sample in its sum of squares.
    pub tail_weight: f64,
}

/// What all seeds of a measurement have in common against the truth: the mean over pixels and channels of a squared
/// bias.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BiasTest {
    /// Below 0 by chance where there is no bias.
    pub bias_squared: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl BiasTest {
    /// Whether a bias is certain.
    pub fn found(&self) -> bool {
        self.bias_squared > SIGMAS * self.standard_error
    }

    /// The bias (root of its mean square) that is noticed every other time; one and a half times as large, nearly
    /// always.
    pub fn power(&self) -> f64 {
        (SIGMAS * self.standard_error).sqrt()
    }

    /// The bias; 0 where chance made its square negative.
    pub fn bias(&self) -> f64 {
        self.bias_squared.max(0.0).sqrt()
    }

    fn of(films: &[Film], truth: &Film, noise: f64) -> Result<Self, BenchError> {
        let split = split_error(&films.iter().collect::<Vec<_>>(), truth, noise)?;
        Ok(BiasTest { bias_squared: split.bias_squared, standard_error: split.bias_squared_error })
    }
}

/// The two tests of a measurement's bias.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Bias {
    /// In radiance squared: a part of the RMSE's square. The noise at a bright area light's edge drowns it.
    pub absolute: BiasTest,
    /// Of each pixel as a share of its truth, the floor as in the relMSE: a part of the relMSE.
    pub relative: BiasTest,
}

impl Bias {
    fn of(films: &[Film], truth: &Truth) -> Result<Self, BenchError> {
        let absolute = BiasTest::of(films, &truth.film, truth.worth.mse)?;
        let shares: Vec<Film> = films.iter().map(|film| as_shares(film, &truth.film)).collect();
        let relative = BiasTest::of(&shares, &as_shares(&truth.film, &truth.film), truth.worth.rel_mse)?;
        Ok(Bias { absolute, relative })
    }
}

/// All pictures of one line at one number of samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Name of the part.
    pub part: String,
    /// Name of the line.
    pub line: String,
    /// Samples per pixel; 0 of the fake.
    pub spp: u32,
    /// One for each seed.
    pub pictures: Vec<Picture>,
    /// `None` where nothing is random, and where pixels share random numbers: the test's standard error comes from pixels
    /// that are independent.
    pub bias: Option<Bias>,
    /// What they were measured by.
    pub reference: Worth,
}

/// Seed of picture `i` at rung `rung` of the ladder: no two rungs share one, so that their errors are independent.
/// References have seeds of their own, from 0x5eed0000 on.
fn seed(rung: usize, i: u32) -> u32 {
    1 + rung as u32 * SEEDS + i
}

/// Measures a line that is traced, at rung number `rung` of its ladder. Seconds of a graphics device are its own, once its
/// pipelines are built and without its film on its way there and back.
///
/// # Errors
/// [`BenchError::Memory`], [`BenchError::Compare`], [`BenchError::Gpu`].
pub fn traced(
    part: &Part,
    scene: &Scene,
    backend: &mut Backend,
    (line, integrator): (&Line, &Integrator),
    rung: usize,
    truth: &Truth,
) -> Result<Measurement, BenchError> {
    let mut trace = |seed: u32, spp: u32| {
        let no_memory = BenchError::Memory(part.width, part.height);
        let mut accumulation = Accumulation::blank((part.width, part.height)).ok_or(no_memory)?;
        let start = Instant::now();
        backend.accumulate(&mut accumulation, &scene.camera, &integrator.with_seed(seed), spp, &|| false)?;
        let seconds = start.elapsed().as_secs_f64();
        let seconds = backend.take_device_seconds().unwrap_or(seconds);
        backend.resolve(&mut accumulation)?;
        let start = Instant::now();
        let denoised = denoised(line, backend, accumulation.film(), (scene, seed))?;
        let seconds = if denoised.is_some() { seconds + start.elapsed().as_secs_f64() } else { seconds };
        Ok::<_, BenchError>((denoised.unwrap_or_else(|| accumulation.film().clone()), accumulation.stats(), seconds))
    };
    if line.device() == Device::Gpu {
        trace(0, 1)?;
    }
    let spp = part.rungs(line).get(rung).copied().unwrap_or(1);
    let (mut pictures, mut films) = (Vec::new(), Vec::new());
    for i in 0..SEEDS {
        let seed = seed(rung, i);
        let (film, stats, seconds) = trace(seed, spp)?;
        pictures.push(judged(&film, seed, seconds, stats, truth)?);
        films.push(film);
    }
    let bias = if integrator.shares_between_pixels() { None } else { Some(Bias::of(&films, truth)?) };
    Ok(Measurement { part: part.name.clone(), line: line.name(), spp, pictures, bias, reference: truth.worth })
}

/// A line's film as its filter leaves it, with the features that guides it; `None` without a filter.
fn denoised(
    line: &Line,
    backend: &Backend,
    film: &Film,
    (scene, seed): (&Scene, u32),
) -> Result<Option<Film>, BenchError> {
    let denoise = line.technique.denoise();
    let (Backend::Cpu(tracer), Some(integrator)) = (backend, line.integrator(seed)) else { return Ok(None) };
    if !denoise.is_on() {
        return Ok(None);
    }
    let never = || false;
    let Some(features) = features_of(tracer, film, (&scene.camera, &integrator), &never) else { return Ok(None) };
    let image = denoise.apply(film, None, &features, &Filters::on_the_processor(), &never)?;
    Ok(Film::from_radiances(film.width(), film.height(), image.radiances().iter().copied()))
}

/// Measures a fake, once its pipelines are built: as many frames as others have seeds, all of one picture.
///
/// # Errors
/// What the GPU says, as a line; [`BenchError::Compare`] within.
pub fn drawn(
    part: &Part,
    scene: &Scene,
    raster: &mut Raster,
    (line, fake): (&Line, &FakeSettings),
    truth: &Truth,
) -> Result<Result<Measurement, BenchError>, String> {
    let settings = fake.sized(part.width, part.height);
    let mut draw = || raster.render(scene, &scene.camera, &settings).map_err(|e| e.to_string());
    draw()?;
    let mut frames = Vec::new();
    for _ in 0..SEEDS {
        let start = Instant::now();
        let film = draw()?;
        frames.push((film, start.elapsed().as_secs_f64()));
    }
    let judge = |(film, seconds): &(Film, f64)| judged(film, 0, *seconds, Stats::default(), truth);
    let pictures: Result<Vec<Picture>, BenchError> = frames.iter().map(judge).collect();
    Ok(pictures.map(|pictures| Measurement {
        part: part.name.clone(),
        line: line.name(),
        spp: 0,
        pictures,
        bias: None,
        reference: truth.worth,
    }))
}

/// A film with each value divided by the root of `r^2 + 0.01`, r being the truth there: its mean squared errors are
/// relative ones.
fn as_shares(film: &Film, truth: &Film) -> Film {
    let mut shares = film.clone();
    for (pixel, truth) in shares.pixels_mut().iter_mut().zip(truth.pixels()) {
        for (sum, truth) in pixel.sum.iter_mut().zip(truth.mean()) {
            *sum /= (truth * truth + REL_MSE_FLOOR).sqrt();
        }
    }
    shares
}

fn judged(film: &Film, seed: u32, seconds: f64, stats: Stats, truth: &Truth) -> Result<Picture, BenchError> {
    let image = film.image();
    let Errors { rmse, rel_mse, mae, bias, nonfinite, .. } = compare::errors(&image, &truth.reference.image)?;
    let flip = ErrorMetric::Flip.of(&image, &truth.reference.image, &DisplayTransform::default())?;
    Ok(Picture {
        seed,
        seconds,
        samples: stats.samples,
        rays: stats.rays,
        cut_paths: stats.cut_paths,
        // those of the reference are told with it
        nonfinite: film.nonfinite + nonfinite,
        rmse,
        rel_mse,
        mae,
        bias,
        flip: finite_mean(&flip).0,
        tail_weight: film.tail_weight(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use film::Vec3;
    use reference::Reference;

    #[test]
    fn a_pictures_own_samples_that_are_not_finite_are_counted_and_the_references_are_not() {
        let reference = Reference { image: Film::new(2, 1).image(), replicates: 16, seconds: 1.0, nonfinite: 3 };
        let worth =
            Worth { spp: 1024, seconds: 1.0, mean: 0.0, mse: 0.0, rel_mse: 0.0, tail_weight: 0.0, nonfinite: 3 };
        let truth = Truth { film: reference.film().unwrap(), worth, reference };
        let film = Film::from_radiances(2, 1, [Vec3::NAN, Vec3::ONE]).unwrap();
        assert_eq!(judged(&film, 1, 1.0, Stats::default(), &truth).unwrap().nonfinite, 1);
    }
}
