//! A picture of what rays are tested against: one ray a pixel, from the camera to the first triangle.

use super::{CountedMesh, Tests};
use crate::intersect::{Ray, triangle_normal};
use rayon::prelude::*;
use scene::Camera;
use scene::glam::Vec2;
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
    /// Seconds from the first ray to the last, all threads beside each other: of a tree of eight boxes of the way that
    /// pictures are traced, of the others of the one that counts.
    pub seconds: f64,
}

impl CountedPicture {
    /// Traces the rays of a picture on the threads of the pool that it is called in; `None` if `goes_on` says no
    /// before it is done.
    pub fn trace(
        mesh: &CountedMesh,
        camera: &Camera,
        (width, height): (u32, u32),
        goes_on: &(dyn Fn() -> bool + Sync),
    ) -> Option<Self> {
        let (begun, stopped) = (Instant::now(), AtomicBool::new(false));
        let frame = camera.frame(width as f32 / height as f32);
        let ray = |index: usize| {
            let (x, y) = (index as u32 % width, index as u32 / width);
            let place = (Vec2::new(x as f32, y as f32) + 0.5) / Vec2::new(width as f32, height as f32);
            let direction = frame.forward + frame.right * (2.0 * place.x - 1.0) + frame.up * (1.0 - 2.0 * place.y);
            Ray::new(frame.eye, direction.normalize())
        };
        let pixel = |index: usize| {
            if stopped.load(Ordering::Relaxed) {
                return CountedPixel::default();
            }
            if !goes_on() {
                stopped.store(true, Ordering::Relaxed);
            }
            seen(mesh, &ray(index))
        };
        let indices = || (0..width as usize * height as usize).into_par_iter();
        let pixels = indices().map(pixel).collect();
        let mut seconds = begun.elapsed().as_secs_f64();
        if mesh.is_traced_otherwise() {
            let begun = Instant::now();
            indices().for_each(|index| _ = std::hint::black_box(mesh.distance(&ray(index))));
            seconds = begun.elapsed().as_secs_f64();
        }
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

fn seen(mesh: &CountedMesh, ray: &Ray) -> CountedPixel {
    let mut tests = Tests::default();
    let hit = mesh.closest(ray, &mut tests);
    let normal = hit.and_then(|hit| triangle_normal(hit.corners));
    CountedPixel { tests, cosine: normal.map(|normal| normal.dot(ray.direction).abs()) }
}
