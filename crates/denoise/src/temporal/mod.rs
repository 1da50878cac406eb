//! Temporal accumulation: a picture of few samples put together with what pictures from other cameras showed at the same points
//! (Schied et al., "Spatiotemporal Variance-Guided Filtering", 2017, section 4.1; Yang et al., "A Survey of Temporal Antialiasing
//! Techniques", 2020). With n samples of its own and h of earlier views a pixel is (n now + h history) / (n + h).
//!
//! What depends on where it is seen from, and all that has changed, lags behind: in a mirror or behind glass the points are
//! those of the first surface, not of what is seen in it. Clamping bounds how far (`clamp`), and [`fade`] ends it where the
//! camera stands: then the picture is the mean of its own samples, to the bit.

mod clamp;
mod reprojection;

use crate::transfer::sanitized;
use crate::{DenoiseError, Stop};
use clamp::Neighbourhood;
use film::{Features, Image, Vec3};
use rayon::prelude::*;
use reprojection::{Found, Reprojection};
use scene::camera::PictureFrame;

/// A picture and what is known of its pixels.
#[derive(Debug, Clone, Copy)]
pub struct Now<'a> {
    /// Where it is seen from.
    pub frame: PictureFrame,
    /// Means of its samples, in linear radiance.
    pub image: &'a Image,
    /// How many samples each pixel has.
    pub samples: &'a [u32],
    /// What its pixels show, of few samples each.
    pub features: &'a Features,
}

/// What an earlier picture showed.
#[derive(Debug, Clone)]
pub struct History {
    frame: PictureFrame,
    image: Image,
    features: Features,
    /// Of each pixel, with those that were of earlier views then.
    samples: Vec<f32>,
    /// Mean age of each pixel's light when this was shown, in seconds.
    age: Vec<f32>,
}

/// How far earlier views count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reuse {
    /// As how many samples of a pixel at most.
    pub limit: u32,
    /// From how many samples of its own on a pixel takes nothing of them.
    pub until: u32,
    /// Seconds since the history was shown.
    pub elapsed: f32,
}

/// A picture put together with earlier views.
#[derive(Debug, Clone, PartialEq)]
pub struct Accumulated {
    /// Linear radiance, with a lag.
    pub image: Image,
    /// As how many samples earlier views count in each pixel.
    pub earlier: Vec<f32>,
    /// Mean age of all of each pixel's light, in seconds: what it has of its own is of now.
    pub age: Vec<f32>,
}

/// Which share of its history a picture of `samples` still takes, where it takes none from `until` samples on.
pub fn fade(samples: u32, until: u32) -> f32 {
    (1.0 - samples as f32 / until.max(1) as f32).max(0.0)
}

impl Now<'_> {
    /// Of as many pixels each.
    fn check(&self) -> Result<(), DenoiseError> {
        let fits = self.features.size() == self.image.size() && self.samples.len() == self.image.radiances().len();
        if fits { Ok(()) } else { Err(DenoiseError::Size) }
    }

    /// It as history of the next view, together with what it was `accumulated` to.
    ///
    /// # Errors
    /// [`DenoiseError::Size`] if not all have as many pixels.
    pub fn history(&self, accumulated: Option<&Accumulated>) -> Result<History, DenoiseError> {
        self.check()?;
        let own = self.samples.iter().map(|samples| *samples as f32);
        let (image, samples, age) = match accumulated {
            None => (self.image, own.collect(), vec![0.0; self.samples.len()]),
            Some(Accumulated { image, earlier, age }) => {
                (image, own.zip(earlier).map(|(own, earlier)| own + earlier).collect(), age.clone())
            }
        };
        if image.size() != self.image.size() {
            return Err(DenoiseError::Size);
        }
        let mut image = image.clone();
        image.layers.clear();
        Ok(History { frame: self.frame, image, features: self.features.clone(), samples, age })
    }
}

/// The picture now together with its history, row by row on the current rayon pool. A pixel that history has nothing for
/// stays as it is.
///
/// # Errors
/// [`DenoiseError`] if a layer is of another size, or `stop` said so.
pub fn accumulate(now: &Now, history: &History, reuse: Reuse, stop: Stop) -> Result<Accumulated, DenoiseError> {
    now.check()?;
    let (width, height) = now.image.size();
    let reprojection = Reprojection::new(now, history);
    let rows = (0..height).into_par_iter().map(|y| {
        if stop() {
            return Vec::new();
        }
        let around = Neighbourhood::of_row(now.image, y);
        (0..width).map(|x| mixed(now, &reprojection, &around, reuse, [x, y])).collect::<Vec<_>>()
    });
    let rows: Vec<Vec<Mixed>> = rows.collect();
    if stop() {
        return Err(DenoiseError::Stopped);
    }
    let pixels = || rows.iter().flatten();
    let radiances: Vec<Vec3> = pixels().map(|pixel| pixel.radiance).collect();
    let image = Image::new(width, height, radiances).ok_or(DenoiseError::Size)?;
    Ok(Accumulated { image, earlier: pixels().map(|p| p.earlier).collect(), age: pixels().map(|p| p.age).collect() })
}

/// A pixel of both.
struct Mixed {
    radiance: Vec3,
    earlier: f32,
    age: f32,
}

fn mixed(now: &Now, reprojection: &Reprojection, around: &Neighbourhood, reuse: Reuse, [x, y]: [u32; 2]) -> Mixed {
    let pixel = (y * now.image.width() + x) as usize;
    let (own, samples) = (now.image.radiances()[pixel], now.samples[pixel]);
    let fade = fade(samples, reuse.until);
    let found = if fade > 0.0 { reprojection.find([x, y]) } else { None };
    let Some(Found { radiance, samples: found, age }) = found else {
        return Mixed { radiance: own, earlier: 0.0, age: 0.0 };
    };
    let earlier = fade * found.min(reuse.limit as f32);
    // a pixel without samples of its own tells nothing to clamp to
    let radiance = if samples > 0 { around.clamped(radiance, x) } else { radiance };
    let share = earlier / (samples as f32 + earlier);
    Mixed { radiance: sanitized(own).lerp(radiance, share), earlier, age: share * (age + reuse.elapsed) }
}

#[cfg(test)]
mod tests;
