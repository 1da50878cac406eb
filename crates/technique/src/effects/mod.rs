//! Which effect of light makes a pixel what it is: refraction, a shadow's edge, a caustic. Found out from the scene at its
//! camera, whatever scene and camera that are: what rays meet first, whether lamps are seen in part from there, what is near,
//! and by which path classes light comes. An error map says with it *what* is wrong where it shows that something is.
//!
//! An [`EffectMap`] is coarser than the picture and smoothed: it is for outlines and sums, not for single pixels.

mod light;
mod outlines;
mod places;
mod rows;
mod smoothing;
mod surfaces;

pub use places::LabelPlaces;
pub use rows::{ROWS, Row};

use crate::Shot;
use light::LightShares;
use pathtrace::Tracer;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use surfaces::{FirstSurface, Surfaces};

/// What makes a pixel what it is. Of several that hold the first in [`Effect::ALL`] is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Nothing is met: the sky, the sun in it, or black.
    Sky,
    /// What shines itself is met first.
    LightSource,
    /// Glass is met first: its picture is of what it bends and reflects.
    Refraction,
    /// A mirror is met first, or metal so smooth that it shows pictures.
    Reflection,
    /// Another surface is so near that it hides much of what is above this one.
    Contact,
    /// Much of the light comes by mirrors, glass and metal alone: L S+ D E.
    Caustic,
    /// A lamp or the sun is seen in part, or not from the pixel beside.
    ShadowEdge,
    /// Much of the light comes from other matt surfaces: L .* D .* D E.
    Interreflection,
    /// Light comes straight from where it is made, sky included.
    Direct,
}

impl Effect {
    /// All of them; an earlier one takes a pixel from a later one.
    pub const ALL: [Effect; 9] = [
        Effect::Sky,
        Effect::LightSource,
        Effect::Refraction,
        Effect::Reflection,
        Effect::Contact,
        Effect::Caustic,
        Effect::ShadowEdge,
        Effect::Interreflection,
        Effect::Direct,
    ];

    /// What there is to say about it.
    pub fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// The name in JSON: "shadow-edge".
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The name on a label: "Shadow edge".
    pub fn title(self) -> &'static str {
        self.row().title
    }
}

/// Cells along the longer side of a map: three or four pixels of a usual window each.
pub const MOST_CELLS: u32 = 384;

/// Of the light that reaches a surface, the share from which on caustics name it.
const MUCH_OF_A_CAUSTIC: f32 = 0.25;

/// The share from which on light from other surfaces names it.
const MUCH_FROM_SURFACES: f32 = 0.4;

/// The effect of each cell of a grid over a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EffectMap {
    /// Columns and rows; as wide for their height as the picture.
    pub size: (u32, u32),
    /// Row by row from the top.
    pub effects: Vec<Effect>,
}

/// What one effect has of a picture and of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectShare {
    /// Whose share it is.
    pub effect: Effect,
    /// Share of the picture's pixels, from 0 to 1.
    pub pixels: f64,
    /// Share of the sum of all errors, from 0 to 1; 0 where there is none.
    pub error: f64,
}

impl EffectMap {
    /// Columns and rows of the map of a picture: at most [`MOST_CELLS`], and no more than it has pixels.
    pub fn size_for((width, height): (u32, u32)) -> (u32, u32) {
        scaled((width, height), MOST_CELLS.min(width.max(height)))
    }

    /// The map of a shot, whose scene `tracer` has ready, on the current rayon pool: a pure function of both. `None` once `stop`
    /// says so, and where there is no memory for it.
    pub fn of(tracer: &Tracer, shot: &Shot, stop: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        // what was stopped once stays so: a part of the light would be taken for all
        let stopped = AtomicBool::new(false);
        let stop = || {
            let stops = stop();
            stopped.fetch_or(stops, Ordering::Relaxed) || stops
        };
        let size = Self::size_for(shot.size);
        let surfaces = Surfaces::of(tracer, shot, size, &stop)?;
        let light = LightShares::of(tracer, shot, &stop)?;
        let edges = surfaces.shadow_edges();
        let effect = |(cell, (surface, at_edge)): (usize, (&FirstSurface, &bool))| {
            let (x, y) = (cell as u32 % size.0, cell as u32 / size.0);
            surface.effect.unwrap_or_else(|| of_the_light(&light, surface, [x, y], size, *at_edge))
        };
        let effects = surfaces.cells.par_iter().zip(&edges).enumerate().map(effect).collect();
        let map = EffectMap { size, effects };
        (!stop()).then(|| smoothing::smoothed(map))
    }

    /// The effect at a pixel of a picture of this size.
    pub fn at(&self, [x, y]: [u32; 2], (width, height): (u32, u32)) -> Effect {
        let cell = |pixel: u32, side: u32, cells: u32| {
            let cell = (u64::from(pixel) * 2 + 1) * u64::from(cells) / (u64::from(side.max(1)) * 2);
            (cell as u32).min(cells.saturating_sub(1))
        };
        let (column, row) = (cell(x, width, self.size.0), cell(y, height, self.size.1));
        self.effects.get((row * self.size.0 + column) as usize).copied().unwrap_or(Effect::Direct)
    }

    /// What each effect has of a picture with these errors, one a pixel, row by row: those that are there, the largest share
    /// of the error first. Errors that are not finite count as none.
    pub fn shares(&self, errors: &[f32], width: u32) -> Vec<EffectShare> {
        let width = width.max(1);
        let height = (errors.len() / width as usize) as u32;
        let mut sums = Effect::ALL.map(|effect| (effect, 0u64, 0.0f64));
        for (index, error) in (0..).zip(errors) {
            let (_, pixels, sum) = &mut sums[self.at([index % width, index / width], (width, height)) as usize];
            *pixels += 1;
            *sum += if error.is_finite() { f64::from(error.abs()) } else { 0.0 };
        }
        let (pixels, error) = (errors.len() as f64, sums.iter().map(|(.., sum)| sum).sum::<f64>());
        let share = |(effect, count, sum)| EffectShare {
            effect,
            pixels: count as f64 / pixels,
            error: if error > 0.0 { sum / error } else { 0.0 },
        };
        let mut shares: Vec<EffectShare> = sums.into_iter().filter(|(_, count, _)| *count > 0).map(share).collect();
        shares.sort_by(|a, b| b.error.total_cmp(&a.error));
        shares
    }
}

/// Of a surface that scatters light: what that light does before.
fn of_the_light(
    light: &LightShares,
    surface: &FirstSurface,
    cell: [u32; 2],
    size: (u32, u32),
    at_edge: bool,
) -> Effect {
    if surface.touches {
        return Effect::Contact;
    }
    let [_, caustic, from_surfaces] = light.at(cell, size, surface.shape);
    if caustic >= MUCH_OF_A_CAUSTIC {
        Effect::Caustic
    } else if at_edge {
        Effect::ShadowEdge
    } else if from_surfaces >= MUCH_FROM_SURFACES {
        Effect::Interreflection
    } else {
        Effect::Direct
    }
}

/// The same shape with so many pixels along its longer side, at least one along the other.
fn scaled((width, height): (u32, u32), longer: u32) -> (u32, u32) {
    let longer = longer.max(1);
    let shrink = f64::from(longer) / f64::from(width.max(height).max(1));
    let side = |side: u32| ((f64::from(side) * shrink).round() as u32).clamp(1, longer);
    (side(width), side(height))
}
