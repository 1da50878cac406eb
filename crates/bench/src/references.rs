//! The reference of each part: taken from the user's store, or made finer until the plan is met, and kept there.

use crate::BenchError;
use crate::plan::Part;
use film::Film;
use pathtrace::FEWEST_REPLICATES;
use reference::{Key, Maker, Reference, SAMPLES_PER_REPLICATE, Store};
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};
use technique::{Renderer, Shot};

/// Seconds after which a reference in the making is kept, so that little is lost when it is interrupted.
const KEPT_EVERY: Duration = Duration::from_secs(20);

/// A channel whose standard error is more than this share of its mean owes its light to fewer than 16 replicates' worth
/// of bright paths, whose number is too small to be known.
const RARE: f64 = 0.25;

/// Largest share of the summed squared standard errors that such channels may hold before their sum is doubted.
const MOST_TAIL_WEIGHT: f64 = 0.1;

/// What a reference is known to be worth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Worth {
    /// Samples per pixel.
    pub spp: u64,
    /// Seconds that it took.
    pub seconds: f64,
    /// Mean radiance over pixels and channels.
    pub mean: f64,
    /// Its own mean squared error, by its standard errors, in radiance squared.
    pub mse: f64,
    /// Its own relMSE, by its standard errors.
    pub rel_mse: f64,
    /// Share of [`Worth::mse`] in pixels whose light comes from rare paths, too few to know how rare.
    pub tail_weight: f64,
    /// Samples that were not finite and are left out.
    pub nonfinite: u64,
}

/// A reference as films are measured by it.
pub struct Truth {
    /// The reference with its standard errors.
    pub reference: Reference,
    /// As a film.
    pub film: Film,
    /// What it is worth.
    pub worth: Worth,
}

impl Worth {
    /// Whether its own error can be believed: under a heavy tail, such as a caustic's, the rarest light is not met yet.
    pub fn is_reliable(&self) -> bool {
        self.tail_weight <= MOST_TAIL_WEIGHT
    }

    fn of(reference: &Reference) -> Self {
        let channels = |v: &scene::Vec3| v.to_array().map(f64::from);
        let radiances = reference.image.radiances();
        let pixels = reference.standard_errors().into_iter().flatten().zip(radiances);
        let channels_of = pixels.flat_map(|(error, mean)| channels(error).into_iter().zip(channels(mean)));
        let (sum, rare) = channels_of.fold((0.0, 0.0), |(sum, rare), (error, mean)| {
            let square = error * error;
            (sum + square, if error > RARE * mean { rare + square } else { rare })
        });
        let radiance = radiances.iter().map(|v| f64::from(v.element_sum())).sum::<f64>();
        Worth {
            spp: u64::from(reference.replicates) * u64::from(SAMPLES_PER_REPLICATE),
            seconds: reference.seconds,
            mean: radiance / (3 * radiances.len()).max(1) as f64,
            mse: reference.mean_squared_error().unwrap_or(0.0),
            rel_mse: reference.rel_mse().unwrap_or(0.0),
            tail_weight: if sum > 0.0 { rare / sum } else { 0.0 },
            nonfinite: reference.nonfinite,
        }
    }
}

/// The part's reference. `progress` hears how far it is, from 0 to 1: first
/// what is there already. A store that cannot be written loses nothing but
/// time: what stands in its way is returned beside the reference.
///
/// # Errors
/// [`BenchError::Memory`].
pub fn make(
    part: &Part,
    renderer: &mut Renderer,
    store: Option<&Store>,
    progress: &mut dyn FnMut(f64),
) -> Result<(Truth, Option<String>), BenchError> {
    let size = (part.width, part.height);
    let shot = Shot::of((**renderer.scene()).clone(), size);
    let key = Key::of(&shot);
    let fetched = store.map_or(Ok(None), |store| store.fetch(key));
    let mut fault = fetched.as_ref().err().map(ToString::to_string);
    let begun = fetched.ok().flatten();
    let no_memory = || BenchError::Memory(size.0, size.1);
    let mut maker = Maker::new(renderer, &shot, begun.as_ref()).ok_or_else(no_memory)?;
    let before = maker.replicates();
    let enough = |maker: &Maker| {
        maker.replicates() >= part.replicates()
            || (maker.replicates() >= FEWEST_REPLICATES && maker.seconds() >= part.reference_seconds)
    };
    let mut keep = |reference: &Reference| {
        let records = vec![("scene", part.name.clone()), shot.hash_record()];
        if let Some(Err(e)) = store.map(|store| store.put(key, reference, records)) {
            fault = Some(e.to_string());
        }
    };
    let share = |maker: &Maker| {
        let by_replicates = f64::from(maker.replicates()) / f64::from(part.replicates());
        by_replicates.max(maker.seconds() / part.reference_seconds).min(1.0)
    };
    progress(if enough(&maker) { 1.0 } else { share(&maker) });
    let mut kept = Instant::now();
    while !enough(&maker) {
        maker.step(&|| false);
        progress(share(&maker));
        if kept.elapsed() >= KEPT_EVERY {
            keep(&maker.reference());
            kept = Instant::now();
        }
    }
    let reference = if before == maker.replicates() { begun } else { None }.unwrap_or_else(|| maker.reference());
    if before < maker.replicates() {
        keep(&reference);
    }
    let film = reference.film().ok_or_else(no_memory)?;
    Ok((Truth { worth: Worth::of(&reference), film, reference }, fault))
}
