//! A pane's picture when it had fewer samples: what has come since tells how noisy the picture is.

use super::{Order, Picture};
use crate::ruler::Noise;
use film::Image;
use technique::Technique;

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
    /// Goes on with a pane's new picture, from what was kept of the one before; `None` of a picture without samples.
    pub fn follow(before: Option<Earlier>, picture: &Picture) -> Option<Earlier> {
        let samples = picture.spp.filter(|_| !picture.rough)?;
        let (new, order) = (Part { samples, image: picture.image.clone() }, picture.order.clone());
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
fn is_same_picture(a: &Order, b: &Order) -> bool {
    let how = |order: &Order| match order.provenance.technique {
        Technique::Fake(_) => None,
        Technique::Traced(traced) => Some((traced.integrator, order.view, order.restarts)),
    };
    how(a).is_some() && how(a) == how(b)
}
