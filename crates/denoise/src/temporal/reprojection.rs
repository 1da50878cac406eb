//! Where an earlier picture shows what a pixel shows now (reverse reprojection; Nehab et al., "Accelerating Real-Time Shading with
//! Reverse Reprojection Caching", 2007).

use super::{History, Now};
use film::Vec3;
use film::glam::Vec2;
use scene::camera::PictureFrame;

/// Share of the distance by which depths of one surface may differ.
const DEPTH: f32 = 0.01;

/// Pixels along a slope by which they may differ beside: one between taps, and half a one for where in each of both
/// pixels its sample lies.
const PIXELS_OF_SLOPE: f32 = 2.0;

/// Cosine at which a surface counts as seen from its edge.
const LEAST_COSINE: f32 = 0.05;

/// Cosine of the angle between normals of one surface.
const NORMALS: f32 = 0.9;

/// How far each colour of the albedo of one surface may differ: a lamp in a ceiling, and the next field of a check, have its
/// depth and its normal.
const ALBEDO: f32 = 0.1;

/// Bilinear weight from which a pixel is found again whole, with its shares of both sides of an edge: that one sample of each told
/// another side is chance, and nothing is blurred by taking it. At rest edges so become smooth.
const WHOLE: f32 = 0.99;

/// A pixel with less than this share of the solid angle of a pixel of the history looks at a coarser one.
const COARSER: f32 = 0.5;

/// Share of the bilinear weights that must have found the surface; below it is chance.
const LEAST_WEIGHT: f32 = 0.05;

/// From the pixels of one picture to those of an earlier one.
pub struct Reprojection<'a> {
    now: &'a Now<'a>,
    history: &'a History,
    /// Angle that a pixel of the history has, about.
    pixel: f32,
    /// Solid angle of a pixel now over that of the history.
    ratio: f32,
}

/// What the history has of a point.
pub struct Found {
    pub radiance: Vec3,
    /// As many samples of a pixel of this size as it stands for.
    pub samples: f32,
    pub age: f32,
}

/// The point that a pixel shows, as the history's camera sees it.
struct Point {
    /// In pixels from the middle of the top left one.
    place: Vec2,
    albedo: Vec3,
    normal: Vec3,
    /// Infinite where nothing is met.
    distance: f32,
    tolerance: f32,
}

/// Solid angle that a pixel has, about, in the middle of a picture.
fn solid_angle(frame: &PictureFrame, (width, height): (u32, u32)) -> f32 {
    4.0 * frame.right.length() * frame.up.length() / (width as f32 * height as f32)
}

impl<'a> Reprojection<'a> {
    pub fn new(now: &'a Now<'a>, history: &'a History) -> Self {
        let then = solid_angle(&history.frame, history.image.size());
        let ratio = solid_angle(&now.frame, now.image.size()) / then;
        Reprojection { now, history, pixel: then.sqrt(), ratio }
    }

    /// The mean of the four nearest pixels that show this one's point, if any does.
    pub fn find(&self, [x, y]: [u32; 2]) -> Option<Found> {
        let pixel = (y * self.now.image.width() + x) as usize;
        let depth = self.now.features.depth[pixel];
        let point = self.point([x, y], pixel)?;
        // a pixel that was larger then spreads its samples over several now
        let closer = if depth == f32::INFINITY { 1.0 } else { depth / point.distance };
        let spread = self.ratio * closer * closer;
        if spread < COARSER && !self.is_within_its_surface(&point) {
            return None;
        }
        let mut sums = Found { radiance: Vec3::ZERO, samples: 0.0, age: 0.0 };
        let [mut weights, mut squares] = [0.0; 2];
        for (tap, weight) in self.taps(&point).filter(|(tap, weight)| self.shows(*tap, *weight, &point)) {
            sums.radiance += weight * self.history.image.radiances()[tap];
            sums.samples += weight * self.history.samples[tap];
            sums.age += weight * self.history.age[tap];
            weights += weight;
            squares += weight * weight;
        }
        // of pixels that were smaller the mean is taken of as many as the weights are for
        let share = spread.min(weights * weights / squares) / weights;
        let Found { radiance, samples, age } = sums;
        (weights >= LEAST_WEIGHT && samples > 0.0).then(|| Found {
            radiance: radiance / weights,
            samples: samples * share,
            age: age / weights,
        })
    }

    fn point(&self, [x, y]: [u32; 2], pixel: usize) -> Option<Point> {
        let (now, then) = (&self.now.frame, &self.history.frame);
        let features = self.now.features;
        let (albedo, normal, depth) = (features.albedo[pixel], features.normal[pixel], features.depth[pixel]);
        let size = |(width, height): (u32, u32)| Vec2::new(width as f32, height as f32);
        let direction = now.direction((Vec2::new(x as f32, y as f32) + 0.5) / size(self.now.image.size()));
        let arm = if depth == f32::INFINITY { direction } else { now.eye + direction * depth - then.eye };
        let place = then.project(then.eye + arm)? * size(self.history.image.size()) - 0.5;
        let length = arm.length();
        if depth == f32::INFINITY {
            return Some(Point { place, albedo, normal, distance: depth, tolerance: 0.0 });
        }
        let cosine = normal.try_normalize().map_or(1.0, |normal| (normal.dot(arm) / length).abs()).max(LEAST_COSINE);
        let slope = self.pixel * (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
        let tolerance = length * (DEPTH + PIXELS_OF_SLOPE * slope);
        (depth > 0.0 && length.is_finite()).then_some(Point { place, albedo, normal, distance: length, tolerance })
    }

    /// The pixels around it with their bilinear weights, as far as they are in the picture.
    fn taps(&self, point: &Point) -> impl Iterator<Item = (usize, f32)> + use<> {
        let (width, height) = self.history.image.size();
        let corner = point.place.floor();
        let inner = point.place - corner;
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].into_iter().filter_map(move |[x, y]| {
            let tap = corner + Vec2::new(x, y);
            let inside = tap.min_element() >= 0.0 && tap.x < width as f32 && tap.y < height as f32;
            let weight = (1.0 - (x - inner.x).abs()) * (1.0 - (y - inner.y).abs());
            inside.then(|| (tap.y as usize * width as usize + tap.x as usize, weight))
        })
    }

    /// Whether the nearest pixels of a coarser history, and those around them, show one surface. A pixel on an edge is told by a
    /// sample of one side, and has the light of both; the pixel beside it is then of the other side.
    fn is_within_its_surface(&self, point: &Point) -> bool {
        let (width, height) = self.history.image.size();
        let corner = point.place.floor();
        // depths there are of twice as many pixels along a slope
        let point = Point { tolerance: 2.0 * point.tolerance, ..*point };
        let near = |corner: f32, side: u32| (corner as i64 - 1).max(0)..(corner as i64 + 3).min(i64::from(side));
        near(corner.y, height)
            .all(|y| near(corner.x, width).all(|x| self.shows(y as usize * width as usize + x as usize, 0.0, &point)))
    }

    /// Whether a pixel of the history, of this bilinear weight, shows the surface on which the point is.
    fn shows(&self, tap: usize, weight: f32, point: &Point) -> bool {
        let History { image, features, .. } = self.history;
        let depth = features.depth[tap];
        let same_depth = depth == point.distance || (depth - point.distance).abs() <= point.tolerance;
        let alike = (features.albedo[tap] - point.albedo).abs().cmple(Vec3::splat(ALBEDO)).all();
        let same_surface = same_depth && (alike || weight >= WHOLE) && are_alike(features.normal[tap], point.normal);
        same_surface && image.radiances()[tap].is_finite()
    }
}

/// Of what has no normal both have none.
fn are_alike(a: Vec3, b: Vec3) -> bool {
    match (a.try_normalize(), b.try_normalize()) {
        (Some(a), Some(b)) => a.dot(b) >= NORMALS,
        (None, None) => true,
        _ => false,
    }
}
