//! The effects of light on a map of errors: what each has of the error, and their outlines and names drawn over the map.

use crate::cli::args::made_by;
use crate::lettering::{Canvas, Lettering, Type};
use crate::model::{EffectsOfView, label_texts, percent, put_labels};
use crate::ruler::{BAR, HeatMap, Pair};
use anyhow::Context;
use compare::ErrorMetric;
use image_file::{ImageFileError, Records};
use pathtrace::Tracer;
use serde_json::{Value, json};
use std::path::Path;
use technique::effects::{Effect, EffectMap, EffectShare};
use technique::{Rank, Shot, Threads, Trees};

/// Pictures of so many rows have lines of 1.4 pixels; larger ones have wider lines.
const USUAL_ROWS: f32 = 720.0;

/// Half the width of a line, in pixels of a usual picture.
const HALF_LINE: f32 = 0.7;

/// The same of the ground that keeps it apart from the map.
const HALF_GROUND: f32 = 1.9;

/// Type of labels as a share of the picture's height, and its least size in pixels.
const TYPE: (f32, f32) = (1.0 / 34.0, 13.0);

/// What the records of the picture in this file say that it shows.
///
/// # Errors
/// If they do not say it, or what they say cannot be read.
pub fn shot_of(film: &Path) -> anyhow::Result<Shot> {
    made_by(film).context("--effects looks at the scene that A shows")?.shot()
}

/// The effects of a picture and their shares of its error.
pub struct NamedEffects {
    of_view: EffectsOfView,
    shares: Vec<EffectShare>,
}

impl NamedEffects {
    /// Of two pictures of this shot.
    ///
    /// # Errors
    /// If there is no memory for them, or the pictures differ in size.
    pub fn of(shot: Shot, pair: &Pair) -> anyhow::Result<Self> {
        let _trees = Trees::of(&shot.scene, &|_| true);
        let trace = || EffectMap::of(&Tracer::new(&shot.scene), &shot, &|| false);
        let map = Threads::all().turn(Rank::Refinement, trace).context("not enough memory for --effects")?;
        let [picture, truth] = &pair.images;
        let squared = ErrorMetric::SquaredRelative.of(picture, truth, &pair.display)?;
        let shares = map.shares(&squared, picture.width());
        Ok(NamedEffects { of_view: EffectsOfView::new(shot, map), shares })
    }

    /// A line for each, the largest error first.
    pub fn lines(&self) -> String {
        let line = |share: &EffectShare| {
            let [pixels, error] = [share.pixels, share.error].map(percent);
            format!(
                "effect    {}: {pixels} of the pixels, {error} of the squared relative error\n",
                share.effect.title()
            )
        };
        self.shares.iter().map(line).collect()
    }

    /// The same as values.
    pub fn json(&self) -> Value {
        let value = |share: &EffectShare| {
            let row = share.effect.row();
            json!({ "effect": row.name, "title": row.title, "pixels": share.pixels, "error": share.error })
        };
        self.shares.iter().map(value).collect()
    }

    /// The map as a PNG with its bar, and over it lines and names.
    ///
    /// # Errors
    /// If it cannot be encoded.
    pub fn encode_over(&self, map: &HeatMap) -> Result<Vec<u8>, ImageFileError> {
        let (width, height, rgba) = map.with_bar();
        let mut canvas = Canvas::filled((width, height), [0; 3]);
        canvas.place((0, 0), (width, &rgba));
        self.draw(&mut canvas, (width, height - BAR));
        let shares: Vec<String> =
            self.shares.iter().map(|share| format!("{} {}", share.effect.name(), share.error)).collect();
        let records: Records = map.records().into_iter().chain([("effects", shares.join(", "))]).collect();
        image_file::encode_rgba8(width, height, &canvas.rgba(), &records)
    }

    fn draw(&self, canvas: &mut Canvas, size: (u32, u32)) {
        let scale = (size.1 as f32 / USUAL_ROWS).max(1.0);
        for (radius, colour, opacity) in [(HALF_GROUND, 0.0, 0.75), (HALF_LINE, 255.0, 1.0)] {
            let covered = covered_by(&self.of_view.outlines, size, radius * scale);
            for (pixel, covered) in canvas.pixels.iter_mut().zip(covered) {
                *pixel = pixel.map(|code| (f32::from(code) + opacity * covered * (colour - f32::from(code))) as u8);
            }
        }
        self.write_labels(canvas, size);
    }

    fn write_labels(&self, canvas: &mut Canvas, (width, height): (u32, u32)) {
        let look = Type { size: (TYPE.0 * height as f32).max(TYPE.1), semi_bold: false, colour: [255; 3] };
        let (beside, above) = ((0.5 * look.size).round(), (0.25 * look.size).round());
        let mut lettering = Lettering::default();
        let laid: Vec<_> = label_texts(&self.of_view.places, &self.shares, None)
            .into_iter()
            .map(|(effect, text)| (effect, lettering.lay_out(&text, look, width, 1)))
            .collect();
        let sizes: Vec<(Effect, [f32; 2])> = laid
            .iter()
            .map(|(effect, text)| (*effect, [text.rect.width() + 2.0 * beside, text.rect.height() + 2.0 * above]))
            .collect();
        let picture = [0.0, 0.0, width as f32, height as f32];
        for (effect, [left, top, right, bottom]) in
            put_labels(&sizes, &self.of_view.places, (picture, picture), Vec::new())
        {
            let Some((_, text)) = laid.iter().find(|(other, _)| *other == effect) else { continue };
            let ground = ((right - left).ceil() as u32, (bottom - top).ceil() as u32);
            canvas.fill((left as i64, top as i64), ground, [22, 24, 28]);
            lettering.draw(canvas, text, ((left + beside) as u32, (top + above) as u32), look.colour);
        }
    }
}

/// The share of each pixel that lines of this half width cover, lines in shares of a picture of this size.
fn covered_by(lines: &[Vec<[f32; 2]>], (width, height): (u32, u32), radius: f32) -> Vec<f32> {
    let mut covered = vec![0.0f32; width as usize * height as usize];
    let pixels = |[x, y]: [f32; 2]| [x * width as f32, y * height as f32];
    for piece in lines.iter().flat_map(|line| line.windows(2)) {
        let [from, to] = [pixels(piece[0]), pixels(piece[1])];
        let range = |axis: usize, side: u32| {
            let reach = radius + 1.0;
            let first = (from[axis].min(to[axis]) - reach).clamp(0.0, side as f32) as u32;
            first..(from[axis].max(to[axis]) + reach).clamp(0.0, side as f32) as u32
        };
        for y in range(1, height) {
            for x in range(0, width) {
                let off = distance([x as f32 + 0.5, y as f32 + 0.5], from, to);
                let pixel = &mut covered[(y * width + x) as usize];
                *pixel = pixel.max((radius + 0.5 - off).clamp(0.0, 1.0));
            }
        }
    }
    covered
}

/// How far a point is from the piece of a line between two others.
fn distance(point: [f32; 2], from: [f32; 2], to: [f32; 2]) -> f32 {
    let minus = |a: [f32; 2], b: [f32; 2]| [a[0] - b[0], a[1] - b[1]];
    let dot = |a: [f32; 2], b: [f32; 2]| a[0] * b[0] + a[1] * b[1];
    let (along, arm) = (minus(to, from), minus(point, from));
    let length = dot(along, along);
    let share = if length > 0.0 { (dot(arm, along) / length).clamp(0.0, 1.0) } else { 0.0 };
    let off = minus(arm, along.map(|axis| share * axis));
    dot(off, off).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_covers_the_pixels_that_it_runs_over_and_no_others() {
        // along the middle of the third row, from the second column's middle to the sixth's
        let covered = covered_by(&[vec![[0.15, 0.5], [0.55, 0.5]]], (10, 5), 0.5);
        for (index, covered) in covered.iter().enumerate() {
            let (x, y) = (index % 10, index / 10);
            assert_eq!(*covered, f32::from(u8::from(y == 2 && (1..=5).contains(&x))), "{x} {y}");
        }
        assert_eq!(distance([3.0, 4.0], [0.0; 2], [0.0; 2]), 5.0, "a point");
    }
}
