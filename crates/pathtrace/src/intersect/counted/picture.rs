//! A picture of what rays are tested against: one ray a pixel, from the camera to the first triangle.

use super::{CountedMesh, Tests};
use crate::intersect::{Ray, triangle_normal};
use rayon::prelude::*;
use scene::glam::Vec2;
use scene::{Camera, Vec3};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What is known of one ray.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CountedPixel {
    /// What it was tested against.
    pub tests: Tests,
    /// Cosine between the ray and the triangle that it met, in [0, 1]; `None` if it met none.
    pub cosine: Option<f32>,
}

/// One ray a pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct CountedPicture {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Row by row from the top.
    pub pixels: Vec<CountedPixel>,
    /// Seconds from the first ray to the last, all threads beside each other.
    pub seconds: f64,
}

impl CountedPicture {
    /// Traces the rays of a picture on the threads of the pool that it is called in; `None` if `goes_on` says no before it
    /// is done.
    pub fn trace(
        mesh: &CountedMesh,
        camera: &Camera,
        (width, height): (u32, u32),
        goes_on: &(dyn Fn() -> bool + Sync),
    ) -> Option<Self> {
        let (begun, stopped) = (Instant::now(), AtomicBool::new(false));
        let frame = camera.frame(width as f32 / height as f32);
        let pixel = |index: usize| {
            if stopped.load(Ordering::Relaxed) {
                return CountedPixel::default();
            }
            let (x, y) = (index as u32 % width, index as u32 / width);
            let place = (Vec2::new(x as f32, y as f32) + 0.5) / Vec2::new(width as f32, height as f32);
            let direction = frame.forward + frame.right * (2.0 * place.x - 1.0) + frame.up * (1.0 - 2.0 * place.y);
            if !goes_on() {
                stopped.store(true, Ordering::Relaxed);
            }
            seen(mesh, frame.eye, direction.normalize())
        };
        let pixels = (0..width as usize * height as usize).into_par_iter().map(pixel).collect();
        let seconds = begun.elapsed().as_secs_f64();
        (!stopped.load(Ordering::Relaxed)).then_some(CountedPicture { size: (width, height), pixels, seconds })
    }

    /// What all rays together were tested against.
    pub fn tests(&self) -> Tests {
        self.pixels.iter().fold(Tests::default(), |mut sum, pixel| {
            sum += pixel.tests;
            sum
        })
    }
}

fn seen(mesh: &CountedMesh, origin: Vec3, direction: Vec3) -> CountedPixel {
    let mut tests = Tests::default();
    let hit = mesh.closest(&Ray { origin, direction, tmax: f32::INFINITY }, &mut tests);
    let normal = hit.and_then(|hit| triangle_normal(hit.corners));
    CountedPixel { tests, cosine: normal.map(|normal| normal.dot(direction).abs()) }
}
