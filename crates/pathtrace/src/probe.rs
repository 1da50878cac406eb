//! One pixel looked into: the samples of which it is the mean, traced again. A sample is a pure function of its pixel, its
//! number and the seed, so that these are the very ones that a film of the picture has.

use crate::Tracer;
use crate::drive::lanes::{FilmPass, Stop, camera_rays};
use crate::integrator::Integrator;
use crate::integrator::first_vertex::{FirstVertex, follow};
use crate::integrator::path_plan::Plan;
use crate::sampling::sampler::Sampler;
use film::Film;
use scene::{Camera, Vec3};
use std::ops::Range;

/// A pixel of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProbedPixel {
    /// What the picture is seen from.
    pub camera: Camera,
    /// Its width and height.
    pub size: [u32; 2],
    /// The pixel's column and row, from the upper left corner.
    pub pixel: [u32; 2],
}

impl ProbedPixel {
    fn pass(&self, integrator: &Integrator, first: u32) -> FilmPass {
        let [width, height] = self.size;
        FilmPass {
            frame: self.camera.frame(width as f32 / height as f32),
            size: self.size,
            until: 1,
            sampler: (integrator.sampler(), integrator.seed()),
            probed: Some((self.pixel, first)),
        }
    }
}

impl Tracer {
    /// The samples of a pixel whose numbers these are, in their order, on the current rayon pool: bit for bit what
    /// [`Tracer::render`] adds to it, those black that were not finite. `None` once `stop` says so, where there is no
    /// memory for them, and of what [`Integrator::binds_pixels`].
    pub fn samples_of_pixel(
        &self,
        probed: &ProbedPixel,
        integrator: &Integrator,
        range: Range<u32>,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Option<Vec<Vec3>> {
        if integrator.binds_pixels().is_some() {
            return None;
        }
        let mut film = Film::try_new(range.len() as u32, 1)?;
        let stop: &Stop = stop;
        integrator.fill(&mut film, &self.job(probed.pass(integrator, range.start), stop));
        let sample = |pixel: &film::Pixel| Vec3::from_array(pixel.sum.map(|sum| sum as f32));
        film.pixels().iter().map(|pixel| (pixel.samples == 1).then(|| sample(pixel))).collect()
    }

    /// One sample of a pixel taken apart at the first surface; `None` of what follows no random paths, and where `stop` ends
    /// what a guide learns before.
    pub fn first_vertex(
        &self,
        probed: &ProbedPixel,
        integrator: &Integrator,
        sample: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Option<FirstVertex> {
        let settings = integrator.paths()?;
        let pass = probed.pass(integrator, sample);
        let job = self.job(pass, stop);
        let plan = Plan::of(settings, &job)?;
        let ([column, row], (kind, seed)) = (probed.pixel, pass.sampler);
        let sampler = Sampler { kind, pixel: row * probed.size[0] + column, sample, seed };
        let rays = camera_rays::<f32>(&pass.frame, pass.size, [column as f32, row as f32], &sampler);
        Some(follow(job.scene, &plan, &rays, &sampler))
    }
}
