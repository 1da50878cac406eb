//! Pictures without light, which guide denoisers: albedo, normal and depth of what each pixel shows.
//!
//! "Follow perfect specular paths and store albedo and normal of the first diffuse hit" (Open Image Denoise's manual). The
//! ways through mirrors and glass are those of the path tracer's samples of the same numbers, so that an edge
//! in a reflection lies where the picture has it.

pub mod gpu;
pub(crate) mod lanes;
pub mod sums;

use crate::drive::lanes::Stop;
use crate::prepared::PreparedScene;
use crate::sampling::sampler::SamplerKind;
use crate::stats::Stats;
use bytemuck::Zeroable;
use film::Features;
use film::Vec3;
use lanes::ChunkKernel;
use rayon::prelude::*;
use scene::Camera;
use scene::camera::PictureFrame;
use simd::Lanes;
use sums::Sums;

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
    /// Of a picture of this size, until there are so many `samples` of each pixel, at least one.
    pub fn new(camera: &Camera, (width, height): (u32, u32), samples: u32, sampler: (SamplerKind, u32)) -> Self {
        let frame = camera.frame(width as f32 / height as f32);
        FeaturePass { frame, size: [width, height], samples: samples.max(1), sampler }
    }

    pub(crate) fn size(&self) -> (u32, u32) {
        self.size.into()
    }

    /// Adds samples until each pixel has as many as are asked for, on the current rayon pool; once `stop` says so some are
    /// left without, which the next pass completes.
    pub(crate) fn trace(&self, scene: &PreparedScene, lanes: Lanes, film: &mut FeatureFilm, stop: &Stop) -> Stats {
        let chunks = film.sums.par_chunks_mut(CHUNK).enumerate();
        let taken = chunks.map(|(index, sums)| {
            if stop() {
                return Stats::default();
            }
            lanes.run(ChunkKernel { pass: self, scene, first: (index * CHUNK) as u32, sums })
        });
        taken.reduce(Stats::default, Stats::plus)
    }
}

/// Sums of samples of what pixels show.
#[derive(Debug, Clone)]
pub struct FeatureFilm {
    size: [u32; 2],
    sums: Vec<Sums>,
}

impl FeatureFilm {
    /// Of `width` x `height` pixels, none of which has a sample.
    pub fn new((width, height): (u32, u32)) -> Self {
        FeatureFilm { size: [width, height], sums: vec![Sums::zeroed(); width as usize * height as usize] }
    }

    /// Bytes that a film of this size takes, and the means of it.
    pub fn memory((width, height): (u32, u32)) -> usize {
        let of_means = 2 * size_of::<Vec3>() + size_of::<f32>();
        (size_of::<Sums>() + of_means).saturating_mul(width as usize * height as usize)
    }

    /// Fewest samples that any pixel has.
    pub fn samples_per_pixel(&self) -> u32 {
        self.sums.iter().map(|sums| sums.samples).min().unwrap_or(0)
    }

    /// Samples of all pixels.
    pub fn samples(&self) -> u64 {
        self.sums.iter().map(|sums| u64::from(sums.samples)).sum()
    }

    /// The means; `None` while any pixel has no sample.
    pub fn features(&self) -> Option<Features> {
        let means =
            |of: fn(&Sums) -> Vec3| self.sums.iter().map(|sums| of(sums) / sums.samples as f32).collect::<Vec<_>>();
        let depth: Vec<f32> = self.sums.iter().map(Sums::depth).collect();
        let features = || Features::new(self.size.into(), means(|sum| sum.albedo), means(|sum| sum.normal), depth);
        if self.samples_per_pixel() > 0 { features() } else { None }
    }
}
