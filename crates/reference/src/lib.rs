//! The reference: the truth of a scene as well as this program knows it, with an error bar of its own, to judge
//! pictures by.
//!
//! A [`Maker`] averages independently scrambled pictures by the estimator that is bounded everywhere, with seeds that
//! pictures have only if they are asked for (from 0x5eed0000 on); their spread is the [`Reference`]'s standard error. A
//! [`Store`] keeps references on disk by the [`Key`] of what they show, so that one that was made once is there at
//! once, and can be made finer later.

mod key;
mod maker;
mod seal;
mod store;

pub use key::Key;
pub use maker::{Goal, Maker, SAMPLES_PER_REPLICATE};
pub use store::{Store, StoreError, Usage};

use compare::{CompareError, Errors};
use film::{DisplayTransform, Film, Image, LayerValues, Pixel, Vec3};
use image_file::{ImageFileError, Kind, Loaded, Records};
use seal::Seal;
use std::path::Path;
use technique::Shot;

/// The layer of [`Reference::image`], and of its file, that holds the standard error of each pixel's radiance.
pub const STANDARD_ERROR: &str = "standard error";

/// What pictures of a scene are judged by.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// The radiance, with its [`STANDARD_ERROR`] for a layer; without one, a picture from elsewhere that does not tell.
    pub image: Image,
    /// Independent pictures that it is the mean of; 0 if that is not known.
    pub replicates: u32,
    /// Seconds that it took.
    pub seconds: f64,
    /// Samples that were not finite and are left out.
    pub nonfinite: u64,
}

/// What the file of a shot's reference says about it, beside what [`Reference::encode`] adds.
pub fn records(shot: &Shot) -> Records {
    shot.reference_records(Maker::settings(0).estimator.name())
}

fn damaged(path: &Path) -> ImageFileError {
    ImageFileError::Read { why: "it is damaged: it is not as it was written".into(), path: path.to_owned() }
}

impl Reference {
    /// Reads an .exr: one of this program with its standard error, or any picture without. A .png is read as well.
    ///
    /// # Errors
    /// [`ImageFileError`]: one line that says why and names the path. One of this program that was changed since is
    /// damaged.
    pub fn load(path: &Path) -> Result<Self, ImageFileError> {
        Reference::load_with_notes(path).map(|(reference, _)| reference)
    }

    /// As [`Reference::load`], with what of the file the picture does not show, a line each.
    ///
    /// # Errors
    /// As [`Reference::load`].
    pub fn load_with_notes(path: &Path) -> Result<(Self, Vec<String>), ImageFileError> {
        match Seal::of(path) {
            Ok(Seal::Broken) => Err(damaged(path)),
            // what cannot be read is told below
            _ => Reference::read(path),
        }
    }

    fn read(path: &Path) -> Result<(Self, Vec<String>), ImageFileError> {
        let Loaded { mut image, notes } = image_file::read(path)?;
        if Kind::of(path) == Some(Kind::Exr)
            && let Some(errors) = image_file::load_layer(path, STANDARD_ERROR, image.size())?
        {
            image = image.with_layer(STANDARD_ERROR, errors);
        }
        let records = image_file::records(path)?;
        let number = |name: &str| records.iter().find(|(known, _)| known == name).and_then(|(_, v)| v.parse().ok());
        let reference = Reference {
            image,
            replicates: number("replicates").unwrap_or(0.0) as u32,
            seconds: number("seconds").unwrap_or(0.0),
            nonfinite: number("nonfinite").unwrap_or(0.0) as u64,
        };
        Ok((reference, notes))
    }

    /// The bytes of an EXR that [`Reference::load`] reads, sealed; `records` stand in its header too.
    ///
    /// # Errors
    /// [`ImageFileError::Encode`].
    pub fn encode(&self, mut records: Records) -> Result<Vec<u8>, ImageFileError> {
        records.extend([
            ("replicates", self.replicates.to_string()),
            ("spp", (u64::from(self.replicates) * u64::from(SAMPLES_PER_REPLICATE)).to_string()),
            ("seconds", self.seconds.to_string()),
            ("nonfinite", self.nonfinite.to_string()),
        ]);
        image_file::encode(Kind::Exr, &self.image, &DisplayTransform::default(), &records).map(seal::sealed)
    }

    /// Standard error of each pixel's radiance, rows from the top; `None` of a picture that does not tell.
    pub fn standard_errors(&self) -> Option<&[Vec3]> {
        self.image.rgb_layer(STANDARD_ERROR)
    }

    /// Its own mean squared error, in radiance squared, by its standard errors; `None` if they are not known.
    pub fn mean_squared_error(&self) -> Option<f64> {
        self.averaged(|_| 1.0)
    }

    /// Its own relMSE, by its standard errors.
    pub fn rel_mse(&self) -> Option<f64> {
        self.averaged(|radiance| radiance * radiance + compare::REL_MSE_FLOOR)
    }

    /// How far a picture of the same pixels is from it, with what its own noise adds.
    ///
    /// # Errors
    /// [`CompareError::Sizes`] if it is of another size.
    pub fn errors(&self, image: &Image) -> Result<Errors, CompareError> {
        let errors = compare::errors(image, &self.image)?;
        Ok(self.mean_squared_error().map_or(errors, |noise| errors.with_reference_noise(noise)))
    }

    /// As a film whose samples are the replicates' means, as far as f32 keeps them.
    pub fn film(&self) -> Option<Film> {
        let n = f64::from(self.replicates.max(1));
        let mut film = Film::try_new(self.image.width(), self.image.height())?;
        let errors = self.standard_errors();
        for (i, (pixel, radiance)) in film.pixels_mut().iter_mut().zip(self.image.radiances()).enumerate() {
            let mean = radiance.to_array().map(f64::from);
            let error = errors.map_or([0.0; 3], |errors| errors[i].to_array().map(f64::from));
            // the inverse of `Pixel::variance_of_mean`
            let squares = |c: usize| n * (error[c] * error[c] * (n - 1.0) + mean[c] * mean[c]);
            *pixel = Pixel {
                sum: mean.map(|mean| mean * n),
                sum_of_squares: [0, 1, 2].map(squares),
                samples: self.replicates.max(1),
                largest: radiance.max_element(),
            };
        }
        film.nonfinite = self.nonfinite;
        Some(film)
    }

    fn of_film(film: &Film, seconds: f64) -> Self {
        let errors = film.pixels().iter().map(|p| Vec3::from_array(p.variance_of_mean().map(|v| v.sqrt() as f32)));
        Reference {
            image: film.image().with_layer(STANDARD_ERROR, LayerValues::Rgb(errors.collect())),
            replicates: film.samples_per_pixel(),
            seconds,
            nonfinite: film.nonfinite,
        }
    }

    fn averaged(&self, weight: impl Fn(f64) -> f64) -> Option<f64> {
        let errors = self.standard_errors()?;
        let channels = |v: &Vec3| v.to_array().map(f64::from);
        let of_pixel = |(error, radiance): (&Vec3, &Vec3)| {
            let (error, radiance) = (channels(error), channels(radiance));
            (0..3).map(|c| error[c] * error[c] / weight(radiance[c])).sum::<f64>()
        };
        let sum: f64 = errors.iter().zip(self.image.radiances()).map(of_pixel).filter(|v| v.is_finite()).sum();
        Some(sum / (3 * errors.len()).max(1) as f64)
    }
}
