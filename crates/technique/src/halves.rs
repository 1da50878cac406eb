//! The samples of a picture in two parts, independent of each other: how far these are apart tells the noise of the whole.

use film::{Film, Image, Layer};
use image_file::Records;

/// The names of the layers that are their means.
pub const HALVES: [&str; 2] = ["half0", "half1"];

/// The records that say how many samples they are the means of.
const SAMPLES: [&str; 2] = ["half0.samples", "half1.samples"];

/// Means of the earlier and of the later part of a film's samples: halves, or as near to that as was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Halves {
    /// The mean of each.
    pub images: [Image; 2],
    /// Samples per pixel of each.
    pub samples: [u32; 2],
}

impl Halves {
    /// Of a film, and of what it was `earlier`; `None` if either part has no samples.
    pub fn of(film: &Film, earlier: &Film) -> Option<Self> {
        let first = earlier.samples_per_pixel();
        let (image, later) = film.since(earlier).filter(|_| first > 0)?;
        Some(Halves { images: [earlier.image(), image], samples: [first, later] })
    }

    /// Samples per pixel of each, of films alone.
    pub fn samples_in(film: &Film, earlier: &Film) -> Option<[u32; 2]> {
        let (first, all) = (earlier.samples_per_pixel(), film.samples_per_pixel());
        (first > 0 && all > first).then(|| [first, all - first])
    }

    /// As layers of a file.
    pub fn layers(&self) -> [Layer; 2] {
        [0, 1].map(|half| self.images[half].as_layer(HALVES[half]))
    }

    /// What a file keeps of them.
    pub fn records([first, later]: [u32; 2]) -> Records {
        vec![(SAMPLES[0], first.to_string()), (SAMPLES[1], later.to_string())]
    }

    /// Samples per pixel of each, as a file's records tell; `None` where they do not.
    pub fn samples_of(records: &[(String, String)]) -> Option<[u32; 2]> {
        let samples = |name| {
            let (_, value) = records.iter().find(|(known, _)| known == name)?;
            value.parse().ok().filter(|samples| *samples > 0)
        };
        Some([samples(SAMPLES[0])?, samples(SAMPLES[1])?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use film::Vec3;

    #[test]
    fn parts_of_a_film_are_means_of_their_own_samples_and_say_how_many() {
        let mut film = Film::new(2, 1);
        let add = |film: &mut Film, value| film.pixels_mut().iter_mut().for_each(|pixel| pixel.add(Vec3::splat(value)));
        [1.0, 3.0].into_iter().for_each(|value| add(&mut film, value));
        let earlier = film.clone();
        assert_eq!(Halves::of(&film, &earlier), None, "nothing has come since");
        [5.0, 6.0, 10.0].into_iter().for_each(|value| add(&mut film, value));
        let halves = Halves::of(&film, &earlier).unwrap();
        assert_eq!(halves.samples, [2, 3]);
        assert_eq!(halves.images.each_ref().map(|image| image.radiances()[1]), [2.0, 7.0].map(Vec3::splat));
        let layers = halves.layers();
        assert_eq!(layers.each_ref().map(|layer| layer.name), ["half0", "half1"]);
        let records = Halves::records(halves.samples).into_iter().map(|(name, value)| (name.to_owned(), value));
        let records: Vec<_> = records.collect();
        assert_eq!(Halves::samples_of(&records), Some([2, 3]));
        assert_eq!(Halves::samples_of(&records[..1]), None);
        assert!(records.iter().all(|(name, _)| crate::is_of_its_pixels(name)), "they are no options");
    }
}
