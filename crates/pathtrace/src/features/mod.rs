//! Pictures without light, which guide denoisers: albedo, normal and depth of what each pixel shows.
//!
//! "Follow perfect specular paths and store albedo and normal of the first diffuse hit" (Open Image Denoise's manual). The
//! ways through mirrors and glass are those of the path tracer's samples of the same numbers, so that an edge
//! in a reflection lies where the picture has it.

mod lanes;

use crate::drive::lanes::Stop;
use crate::prepared::PreparedScene;
use crate::sampling::sampler::SamplerKind;
use film::Features;
use film::Vec3;
use lanes::{ChunkKernel, Sums};
use rayon::prelude::*;
use scene::Camera;
use scene::camera::PictureFrame;
use simd::Lanes;

/// Samples from which features are clean enough that more would change nothing that a filter sees.
pub const ENOUGH_SAMPLES: u32 = 32;

/// Pixels that one thread takes at a time: whole groups of all kinds of lanes.
const CHUNK: usize = 1024;

/// Which features of what.
#[derive(Debug, Clone, Copy)]
pub struct FeaturePass {
    /// What the camera sees.
    frame: PictureFrame,
    size: [u32; 2],
    samples: u32,
    sampler: (SamplerKind, u32),
}

impl FeaturePass {
    /// Of a picture of this size, from as many `samples` of each pixel, at least one.
    pub fn new(camera: &Camera, (width, height): (u32, u32), samples: u32, sampler: (SamplerKind, u32)) -> Self {
        let frame = camera.frame(width as f32 / height as f32);
        FeaturePass { frame, size: [width, height], samples: samples.max(1), sampler }
    }

    /// Traces them on the current rayon pool; `None` where it was stopped.
    pub(crate) fn trace(&self, scene: &PreparedScene, lanes: Lanes, stop: &Stop) -> Option<Features> {
        let pixels = self.size[0] as usize * self.size[1] as usize;
        let mut sums = vec![Sums::default(); pixels];
        sums.par_chunks_mut(CHUNK).enumerate().for_each(|(index, sums)| {
            if !stop() {
                lanes.run(ChunkKernel { pass: self, scene, first: (index * CHUNK) as u32, sums });
            }
        });
        let share = 1.0 / self.samples as f32;
        let means = |of: fn(&Sums) -> Vec3| sums.iter().map(|sum| of(sum) * share).collect::<Vec<_>>();
        let depth: Vec<f32> = sums.iter().map(Sums::depth).collect();
        let whole = !stop();
        Features::new(self.size.into(), means(|sum| sum.albedo), means(|sum| sum.normal), depth).filter(|_| whole)
    }
}
