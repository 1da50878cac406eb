//! By which path classes the light comes that a surface sends to the camera: three small pictures of light apart.

use super::{EffectMap, scaled};
use crate::Shot;
use film::Film;
use film::colour::luminance;
use pathtrace::{Estimator, Integrator, LightPaths, NO_SHAPE, PathSettings, Tracer};

/// Light that surfaces scatter which are no mirrors and no glass, apart: straight from where it is made, by mirrors, glass and
/// metal alone, and what a matt surface scattered before.
const CLASSES: [&str; 3] = ["L[DG]E", "L(S+[DG]|[SG]+D)E", "L.*D.*[DG]E"];

/// Samples per pixel: with what is averaged around a cell some hundreds.
const SPP: u32 = 16;

/// How far the light around a cell counts, in pixels of the small pictures.
const WINDOW: i64 = 3;

/// The standard deviation of their weights, in pixels of the small pictures.
const SPREAD: f32 = 1.5;

/// Small pictures of the light of each class.
pub struct LightShares {
    size: (u32, u32),
    /// The shape that each pixel shows.
    shapes: Vec<u32>,
    /// Luminance of each class.
    light: Vec<[f32; 3]>,
}

impl LightShares {
    /// Traces the light, on the current rayon pool; `None` once `stop` says so, and where there is no memory for it.
    pub fn of(tracer: &Tracer, shot: &Shot, stop: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let map = EffectMap::size_for(shot.size);
        let size = scaled(map, map.0.max(map.1).div_ceil(2));
        let shapes =
            tracer.first_shapes(&shot.camera.frame(shot.size.0 as f32 / shot.size.1.max(1) as f32), size, stop)?;
        let mut light = vec![[0.0; 3]; shapes.len()];
        for (class, paths) in CLASSES.into_iter().enumerate() {
            let estimator = Estimator::usual_for(&shot.scene.needs());
            let paths = LightPaths::parse(paths).ok()?;
            let integrator: Integrator = PathSettings { estimator, paths, ..PathSettings::default() }.into();
            let mut film = Film::try_new(size.0, size.1)?;
            tracer.render(&mut film, &shot.camera, &integrator, SPP, &|| stop());
            if stop() {
                return None;
            }
            let luminances: Vec<f32> = film.radiances().map(|rgb| luminance(rgb).max(0.0)).collect();
            light.iter_mut().zip(without_fireflies(&luminances, size.0)).for_each(|(light, own)| light[class] = own);
        }
        Some(LightShares { size, shapes, light })
    }

    /// The share that each class has of the light around a cell of a map of this size, as far as it is on the same shape: direct,
    /// a caustic's, from other surfaces. All 0 in the dark.
    pub fn at(&self, [column, row]: [u32; 2], (columns, rows): (u32, u32), shape: u32) -> [f32; 3] {
        let along = |cell: u32, cells: u32, side: u32| (cell as f32 + 0.5) / cells as f32 * side as f32 - 0.5;
        let (x, y) = (along(column, columns, self.size.0), along(row, rows, self.size.1));
        let mut sums = [0.0; 3];
        for v in y.round() as i64 - WINDOW..=y.round() as i64 + WINDOW {
            for u in x.round() as i64 - WINDOW..=x.round() as i64 + WINDOW {
                let Some(index) = self.index(u, v).filter(|index| self.shapes[*index] == shape && shape != NO_SHAPE)
                else {
                    continue;
                };
                let off = [u as f32 - x, v as f32 - y].map(|off| off * off);
                let weight = (-0.5 * (off[0] + off[1]) / (SPREAD * SPREAD)).exp();
                sums.iter_mut().zip(self.light[index]).for_each(|(sum, light)| *sum += weight * light);
            }
        }
        let all: f32 = sums.iter().sum();
        if all > 0.0 && all.is_finite() { sums.map(|sum| sum / all) } else { [0.0; 3] }
    }

    fn index(&self, x: i64, y: i64) -> Option<usize> {
        let (width, height) = (i64::from(self.size.0), i64::from(self.size.1));
        ((0..width).contains(&x) && (0..height).contains(&y)).then_some((y * width + x) as usize)
    }
}

/// The same values, none above the third of the nine about it: what one path in a million brings would be much of the light.
fn without_fireflies(values: &[f32], width: u32) -> Vec<f32> {
    let width = i64::from(width.max(1));
    let height = values.len() as i64 / width;
    let about = |index: usize| {
        let (x, y) = (index as i64 % width, index as i64 / width);
        let places = (-1..=1).flat_map(move |dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
        let inside = places.filter(move |(x, y)| (0..width).contains(x) && (0..height).contains(y));
        inside.map(move |(x, y)| values[(y * width + x) as usize])
    };
    let limited = |(index, own): (usize, &f32)| {
        let mut largest = [0.0f32; 3];
        for value in about(index) {
            if let Some(place) = largest.iter().position(|other| value > *other) {
                largest[place..].rotate_right(1);
                largest[place] = value;
            }
        }
        own.min(largest[2])
    };
    values.iter().enumerate().map(limited).collect()
}
