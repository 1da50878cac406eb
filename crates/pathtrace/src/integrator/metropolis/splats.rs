//! A picture to which many chains add light at once. Sums are in fixed point: their order does not matter, so that a
//! picture does not depend on the threads.

use film::Film;
use rayon::prelude::*;
use scene::Vec3;
use std::sync::atomic::{AtomicU64, Ordering};

/// Parts of the unit. What is added is a colour of luminance 1 times a weight: at most 13.9, for blue. 2^32 of them leave
/// room for 3e8 mutations in one pixel.
const PARTS: f64 = 4_294_967_296.0;

/// Sums of light in each pixel.
pub struct Splats(Vec<[AtomicU64; 3]>);

impl Splats {
    /// Of so many pixels, without any light.
    pub fn new(pixels: usize) -> Self {
        Splats((0..pixels).map(|_| [const { AtomicU64::new(0) }; 3]).collect())
    }

    /// Adds a colour of luminance 1, times a weight. What weighs nothing is often far away in memory.
    pub fn add(&self, pixel: u32, colour: Vec3, weight: f64) {
        if weight == 0.0 {
            return;
        }
        for (sum, channel) in self.0[pixel as usize].iter().zip(colour.to_array()) {
            sum.fetch_add((f64::from(channel) * weight * PARTS).round() as u64, Ordering::Relaxed);
        }
    }

    /// Adds a sample to each pixel of a film, the sums times `scale`, and forgets them.
    pub fn resolve(&mut self, film: &mut Film, scale: f64) {
        film.pixels_mut().par_iter_mut().zip(&mut self.0).for_each(|(pixel, sums)| {
            let light = sums.each_mut().map(|sum| std::mem::take(sum.get_mut()) as f64 / PARTS * scale);
            pixel.add(Vec3::from_array(light.map(|channel| channel as f32)));
        });
    }
}
