//! What is known of a picture's own noise, so that it is not taken for an error.

use compare::{CompareError, variance_by_parts};
use film::{Image, Vec3};
use std::sync::Arc;

/// The noise of one picture.
#[derive(Debug, Clone)]
pub enum Noise {
    /// It has none, or tells of none: a rasterised one, or a reference from elsewhere.
    None,
    /// It has some, and nobody knows how much: after the first sample.
    Unknown,
    /// Standard errors of its pixels, as a reference knows them.
    StandardErrors(Arc<[Vec3]>),
    /// The picture when it had fewer samples, and the samples of then and now.
    Parts(Image, [u32; 2]),
}

impl Noise {
    /// The variances of the pixels of `image`: `Some(None)` if it has no noise, `None` if that is not known.
    ///
    /// # Errors
    /// If they are those of a picture of another size.
    pub fn variances(&self, image: &Image) -> Result<Option<Option<Vec<Vec3>>>, CompareError> {
        Ok(match self {
            Noise::None => Some(None),
            Noise::Unknown => None,
            Noise::StandardErrors(errors) => Some(Some(errors.iter().map(|error| error * error).collect())),
            Noise::Parts(earlier, [before, now]) => variance_by_parts(earlier, image, (*before, *now))?.map(Some),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ruler::{HeatMap, Pair};
    use compare::{ErrorMetric, WITHIN_NOISE};
    use film::{DisplayTransform, Film};
    use pathtrace::{PathSettings, Tracer};

    /// The Cornell box in 64 of the usual, low-discrepancy samples, and what is known of its noise.
    fn traced(settings: PathSettings) -> (Image, Noise) {
        let scene = scene::builtin::named("cornell").unwrap();
        let (tracer, mut film) = (Tracer::new(&scene), Film::new(64, 64));
        let mut add = |samples| {
            tracer.render(&mut film, &scene.camera, &settings.into(), samples, &|| false);
            film.image()
        };
        let (half, whole) = (add(32), add(32));
        (whole, Noise::Parts(half, [32, 64]))
    }

    fn map_of(a: PathSettings, b: PathSettings, metric: ErrorMetric) -> HeatMap {
        let [(a, noise_of_a), (b, noise_of_b)] = [a, b].map(traced);
        let (images, noise) = ([a, b], [noise_of_a, noise_of_b]);
        let pair = Pair { names: ["A", "B"], images, noise, display: DisplayTransform::default() };
        HeatMap::of(&pair, metric, None).unwrap()
    }

    fn share_of_grey(map: &HeatMap) -> f32 {
        let pixels = map.rgba();
        let grey = pixels.chunks_exact(4).filter(|pixel| pixel[..3] == WITHIN_NOISE).count();
        grey as f32 / map.values.len() as f32
    }

    /// Noise of paths has longer tails than a normal variable's 95 %, but of smoothed variances more pixels are within
    /// two standard errors: 97 to 99 % in scenes of both kinds.
    #[test]
    fn two_pictures_of_one_scene_are_grey_and_light_that_is_missing_is_not() {
        let of = |seed, bounces| PathSettings { seed, bounces, ..PathSettings::default() };
        let same = map_of(of(1, None), of(2, None), ErrorMetric::Signed);
        assert!((0.94..0.999).contains(&share_of_grey(&same)), "{}", share_of_grey(&same));
        let darker = map_of(of(1, Some(0)), of(2, None), ErrorMetric::Signed);
        assert!(share_of_grey(&darker) < 0.25, "{}", share_of_grey(&darker));
        let seen = map_of(of(1, None), of(2, None), ErrorMetric::Flip);
        assert_eq!(share_of_grey(&seen), 0.0, "FLIP has its own idea of what can be seen");
    }

    #[test]
    fn without_a_known_noise_nothing_is_grey() {
        let image = |grey| Image::new(1, 1, [Vec3::splat(grey)]).unwrap();
        for noise in [[Noise::None, Noise::None], [Noise::None, Noise::Unknown]] {
            let images = [image(0.5), image(0.5)];
            let pair = Pair { names: ["A", "B"], images, noise, display: DisplayTransform::default() };
            assert_eq!(HeatMap::of(&pair, ErrorMetric::Signed, None).unwrap().within_noise, None);
        }
    }

    #[test]
    fn what_a_reference_cannot_tell_is_grey_and_does_not_set_the_scale() {
        let image = |greys: [f32; 2]| Image::new(2, 1, greys.map(Vec3::splat)).unwrap();
        let noise = [Noise::None, Noise::StandardErrors([0.5, 0.01].map(Vec3::splat).into())];
        let images = [image([1.4, 0.6]), image([0.5, 0.5])];
        let pair = Pair { names: ["A", "reference"], images, noise, display: DisplayTransform::default() };
        let map = HeatMap::of(&pair, ErrorMetric::Signed, None).unwrap();
        assert_eq!(map.within_noise, Some(vec![true, false]));
        assert!((map.scale.high - 0.1).abs() < 1e-6, "{}", map.scale.high);
    }
}
