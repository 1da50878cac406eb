//! A pane's picture when it had fewer samples: what has come since tells how noisy the picture is.

use super::{Order, Picture, bare};
use crate::ruler::Noise;
use film::Image;
use technique::{Technique, TracedSettings};

/// Earlier states of the picture that a pane is making.
#[derive(Debug)]
pub struct Earlier {
    order: Order,
    /// The latest that had at most half of the samples that there are.
    half: Option<Part>,
    /// The one that takes its place once there are twice its samples.
    next: Part,
}

#[derive(Debug, Clone)]
struct Part {
    samples: u32,
    image: Image,
}

impl Earlier {
    /// Goes on with a pane's new picture, from what was kept of the one before; `None` of a picture without samples, and of
    /// one in which earlier views count: they are in both of its states.
    pub fn follow(before: Option<Earlier>, picture: &Picture) -> Option<Earlier> {
        let samples = picture.spp.filter(|_| !picture.rough && picture.lag.is_none())?;
        let (new, order) = (Part { samples, image: bare(&picture.image) }, picture.order.clone());
        let before = before.filter(|before| is_same_picture(&before.order, &order) && before.next.samples <= samples);
        Some(match before {
            Some(Earlier { next, .. }) if samples / 2 >= next.samples => Earlier { order, half: Some(next), next: new },
            Some(before) => Earlier { order, ..before },
            None => Earlier { order, half: None, next: new },
        })
    }

    /// What is known of the noise of a picture that was followed.
    pub fn noise_of(&self, picture: &Picture) -> Noise {
        match (&self.half, picture.spp) {
            (Some(Part { samples, image }), Some(spp)) => Noise::Parts(image.clone(), [*samples, spp]),
            _ => Noise::Unknown,
        }
    }
}

/// Whether two orders differ in the wished number of samples at most.
pub fn is_same_picture(a: &Order, b: &Order) -> bool {
    let how = |order: &Order| match order.provenance.technique {
        Technique::Fake(_) => None,
        Technique::Traced(traced) => {
            // a mean of runs is another sum than one of the first with more samples
            let runs = order.provenance.technique.runs();
            let TracedSettings { integrator, sun_radius, denoise, feature, .. } = traced;
            Some((integrator, sun_radius, denoise, feature, runs, order.view, order.restarts))
        }
    };
    how(a).is_some() && how(a) == how(b)
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use film::Vec3;
    use std::sync::Arc;
    use technique::{Device, PaneSettings, Provenance, Shot, TechniqueName};

    /// A picture of one pixel whose radiance is its number of samples.
    pub fn picture(technique: TechniqueName, view: u64, spp: u32) -> Picture {
        let mut settings = PaneSettings::of(technique);
        // more were wished for meanwhile
        settings.truth.spp = 100 + spp;
        let shot = Shot::of(scene::builtin::named("cornell").unwrap(), (1, 1));
        let own_camera = shot.camera;
        let provenance = Arc::new(Provenance { shot, technique: settings.in_use(), device: Device::Cpu });
        Picture {
            external: None,
            before: None,
            lag: None,
            image: Image::new(1, 1, [Vec3::splat(spp as f32)]).unwrap(),
            runs: 1,
            spp: (technique != TechniqueName::Raster).then_some(spp),
            seconds: 0.0,
            effort: crate::model::Effort::Traced(pathtrace::Stats::default()),
            noisy: false,
            nonfinite: 0,
            adapter: "none".into(),
            refused: None,
            filter_fault: None,
            cut: None,
            rough: false,
            coarse: false,
            unfinished: true,
            order: Order { job: 1, view, shrink: 1, restarts: 0, own_camera, provenance },
        }
    }

    /// The samples of then and now after these pictures, one after the other; `None` where the noise is not known.
    fn parts(pictures: &[Picture]) -> Option<[u32; 2]> {
        let earlier = pictures.iter().fold(None, Earlier::follow)?;
        match earlier.noise_of(pictures.last()?) {
            Noise::Parts(image, samples) => {
                assert_eq!(image.radiances()[0].x, samples[0] as f32, "the picture of then");
                Some(samples)
            }
            _ => None,
        }
    }

    #[test]
    fn the_part_has_half_of_the_samples_or_less() {
        let paths = |all: &[u32]| all.iter().map(|spp| picture(TechniqueName::Path, 1, *spp)).collect::<Vec<_>>();
        assert_eq!(parts(&paths(&[1])), None);
        assert_eq!(parts(&paths(&[1, 2])), Some([1, 2]));
        assert_eq!(parts(&paths(&[1, 2, 3])), Some([1, 3]));
        assert_eq!(parts(&paths(&[1, 2, 3, 4, 7, 8, 15])), Some([4, 15]));
        assert_eq!(parts(&paths(&[1, 16])), Some([1, 16]), "there was no other");
    }

    #[test]
    fn another_picture_begins_anew() {
        use TechniqueName::{Path, Raster, Whitted};
        let after = |new: Picture| parts(&[picture(Path, 1, 1), picture(Path, 1, 2), new]);
        assert_eq!(after(picture(Path, 1, 4)), Some([2, 4]));
        assert_eq!(after(picture(Path, 2, 4)), None, "seen from elsewhere");
        assert_eq!(after(picture(Whitted, 1, 4)), None);
        assert_eq!(after(picture(Path, 1, 1)), None, "begun again");
        let mut under_another_sun = picture(Path, 1, 4);
        let made = Arc::make_mut(&mut under_another_sun.order.provenance);
        if let technique::Technique::Traced(traced) = &mut made.technique {
            traced.sun_radius = Some(0.0);
        }
        assert_eq!(after(under_another_sun), None);
        let mut without_light = picture(Path, 1, 4);
        if let technique::Technique::Traced(traced) = &mut Arc::make_mut(&mut without_light.order.provenance).technique
        {
            traced.feature = Some(film::Feature::Albedo);
        }
        assert_eq!(after(without_light), None);
        let lag = Some(technique::Lag { samples: 2.0, seconds: 0.1 });
        assert_eq!(after(Picture { lag, ..picture(Path, 1, 4) }), None);
        assert_eq!(after(Picture { rough: true, ..picture(Path, 1, 4) }), None);
        assert!(Earlier::follow(None, &picture(Raster, 1, 1)).is_none(), "it has no samples");
    }
}
