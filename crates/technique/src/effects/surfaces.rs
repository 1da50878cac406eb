//! What rays through a map's cells meet first, and what is seen from there of lamps and of what is near.

use super::Effect;
use crate::Shot;
use film::colour::luminance;
use pathtrace::Tracer;
use pathtrace::intersect::{Intersection, Ray};
use pathtrace::light::{Lights, ShadowEnd};
use rayon::prelude::*;
use scene::camera::PictureFrame;
use scene::glam::Vec2;
use scene::{Bsdf, Material, Scene, Vec3};
use std::f32::consts::{FRAC_PI_4, TAU};

/// Where rays go through a cell: the middle, which wins where as many are of another opinion, and around it.
const IN_A_CELL: [[f32; 2]; 5] = [[0.5, 0.5], [0.25, 0.35], [0.65, 0.25], [0.35, 0.75], [0.75, 0.65]];

/// Metal of a roughness below this shows pictures of what is around it.
const SHOWS_PICTURES: f32 = 0.3;

/// Directions in which nearness is looked for.
const NEAR_DIRECTIONS: usize = 12;

/// How far what is near may be, as a share of the picture's height at that distance.
const NEAR: f32 = 0.04;

/// The share of directions that end so near from which on surfaces touch.
const TOUCHES: f32 = 0.25;

/// Most lamps that are told apart; more are looked at as one.
const MOST_LAMPS: usize = 16;

/// Points on a lamp, or on all where they are many.
const POINTS_ON_A_LAMP: usize = 12;

/// A lamp that brings less of what lamps would bring without shadows casts none that counts.
const RELEVANT: f32 = 0.1;

/// Shares of a lamp between which it is seen in part.
const IN_PART: std::ops::RangeInclusive<f32> = 0.03..=0.97;

/// The share of a lamp that has to vanish from a cell to the next to make an edge.
const JUMP: f32 = 0.5;

/// What a cell shows.
#[derive(Debug, Clone, Copy)]
pub struct FirstSurface {
    /// Where the surface says it, whatever the light does.
    pub effect: Option<Effect>,
    /// Index into the scene's shapes; [`pathtrace::NO_SHAPE`] where there is none.
    pub shape: u32,
    /// Whether another surface is near.
    pub touches: bool,
    normal: Vec3,
}

/// What all cells show.
pub struct Surfaces {
    size: (u32, u32),
    /// Row by row from the top.
    pub cells: Vec<FirstSurface>,
    /// For each cell the share that is seen of each lamp; NaN where that brings little.
    seen: Vec<f32>,
    lamps: usize,
}

impl Surfaces {
    /// Of each cell of a map of this size, on the current rayon pool; `None` once `stop` says so.
    pub fn of(tracer: &Tracer, shot: &Shot, size: (u32, u32), stop: &(dyn Fn() -> bool + Sync)) -> Option<Self> {
        let frame = shot.camera.frame(shot.size.0 as f32 / shot.size.1.max(1) as f32);
        let looker = Looker { tracer, scene: &shot.scene, frame, size, lamps: lamps(tracer.lights()) };
        let (lamps, count) = (looker.lamps.len(), size.0 as usize * size.1 as usize);
        let mut seen = vec![f32::NAN; count * lamps.max(1)];
        let rows = seen.par_chunks_mut(size.0 as usize * lamps.max(1)).enumerate();
        let rows: Vec<Vec<FirstSurface>> = rows
            .map(|(row, seen)| {
                let cells = (0..size.0).zip(seen.chunks_mut(lamps.max(1)));
                cells.map_while(|(column, seen)| (!stop()).then(|| looker.look([column, row as u32], seen))).collect()
            })
            .collect();
        let cells: Vec<FirstSurface> = rows.into_iter().flatten().collect();
        (cells.len() == count).then_some(Surfaces { size, cells, seen, lamps })
    }

    /// Where a lamp is seen in part, or not from a cell beside that shows the same surface.
    pub fn shadow_edges(&self) -> Vec<bool> {
        (0..self.cells.len()).into_par_iter().map(|cell| self.is_at_an_edge(cell)).collect()
    }

    fn is_at_an_edge(&self, cell: usize) -> bool {
        let own = self.seen_from(cell);
        own.iter().any(|seen| IN_PART.contains(seen))
            || self.around(cell).any(|other| {
                own.iter().zip(self.seen_from(other)).any(|(own, other)| (own - other).abs() > JUMP)
                    && self.are_one_surface(cell, other)
            })
    }

    fn seen_from(&self, cell: usize) -> &[f32] {
        &self.seen[cell * self.lamps..][..self.lamps]
    }

    fn are_one_surface(&self, a: usize, b: usize) -> bool {
        let [a, b] = [a, b].map(|cell| &self.cells[cell]);
        a.shape == b.shape && a.effect == b.effect && a.normal.dot(b.normal) > 0.9
    }

    /// The eight cells around one, as far as they are in the map.
    fn around(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        let (width, height) = (self.size.0 as i64, self.size.1 as i64);
        let (x, y) = (cell as i64 % width, cell as i64 / width);
        let beside = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
        let places = beside.into_iter().map(move |(dx, dy)| (x + dx, y + dy));
        let inside = places.filter(move |(x, y)| (0..width).contains(x) && (0..height).contains(y));
        inside.map(move |(x, y)| (y * width + x) as usize)
    }
}

/// Who looks through cells.
struct Looker<'a> {
    tracer: &'a Tracer,
    scene: &'a Scene,
    frame: PictureFrame,
    size: (u32, u32),
    lamps: Vec<Lamp>,
}

/// A lamp, or all where they are many, as points on it.
struct Lamp {
    /// For each point what chooses the lamp, and the point on it.
    points: Vec<(f32, [f32; 2])>,
    /// What all of its points together are to be multiplied by, so that lamps compare.
    weight: f32,
}

/// The lamps that cast shadows; a sky from a picture is none, for its shadows have no edge.
fn lamps(lights: &Lights) -> Vec<Lamp> {
    // the additive recurrence R2 (Roberts 2018): few points, evenly spread
    let point = |index: usize| [0.754_877_7, 0.569_840_3].map(|step: f32| (0.5 + step * index as f32).fract());
    if lights.len() > MOST_LAMPS {
        let count = 2 * POINTS_ON_A_LAMP;
        let points = (0..count).map(|index| ((index as f32 + 0.5) / count as f32, point(index))).collect();
        return vec![Lamp { points, weight: 1.0 / count as f32 }];
    }
    let sky = lights.environment().is_some().then(|| lights.len() - 1);
    let chooses =
        |light: usize| (0..4096).map(|step| (step as f32 + 0.5) / 4096.0).find(|u| lights.choose(*u) == light);
    let lamp = |light: usize| {
        let (chosen_by, count) = (chooses(light)?, if lights.is_delta(light) { 1 } else { POINTS_ON_A_LAMP });
        let points = (0..count).map(|index| (chosen_by, point(index))).collect();
        // samples are divided by the probability of having been chosen
        Some(Lamp { points, weight: lights.probability(light) / count as f32 })
    };
    (0..lights.len()).filter(|light| Some(*light) != sky).filter_map(lamp).collect()
}

impl Looker<'_> {
    /// What a cell shows; `seen` takes the share of each lamp.
    fn look(&self, cell: [u32; 2], seen: &mut [f32]) -> FirstSurface {
        let through = IN_A_CELL.map(|place| self.meet(cell, place));
        let votes = |kind: Option<Effect>| through.iter().filter(|met| met.surface.effect == kind).count();
        let mut winner = &through[0];
        for met in &through {
            if votes(met.surface.effect) > votes(winner.surface.effect) {
                winner = met;
            }
        }
        let mut surface = winner.surface;
        if let Some(met) = winner.met.filter(|_| surface.effect.is_none()) {
            self.see_lamps(&met, surface.normal, seen);
            surface.touches = self.touches(&met, surface.normal);
        }
        surface
    }

    fn meet(&self, [column, row]: [u32; 2], [x, y]: [f32; 2]) -> Meeting {
        let place = Vec2::new((column as f32 + x) / self.size.0 as f32, (row as f32 + y) / self.size.1 as f32);
        let direction = self.frame.direction(place);
        let ray = Ray::new(self.frame.eye, direction);
        let accel = self.tracer.accel();
        let Some(hit) = accel.closest(&ray) else {
            let effect = Some(Effect::Sky);
            let surface = FirstSurface { effect, shape: pathtrace::NO_SHAPE, touches: false, normal: Vec3::ZERO };
            return Meeting { surface, met: None };
        };
        let met = accel.intersection(&ray, &hit);
        let is_front = met.point.normal.dot(direction) < 0.0;
        let normal = if is_front { met.point.normal } else { -met.point.normal };
        let effect = self.scene.materials.get(met.material as usize).and_then(|m| of_material(m, is_front));
        let surface = FirstSurface { effect, shape: accel.shape(&hit), touches: false, normal };
        Meeting { surface, met: Some(met) }
    }

    /// Puts down what share of each lamp is seen from a surface that faces it.
    fn see_lamps(&self, met: &Intersection, normal: Vec3, seen: &mut [f32]) {
        let brought: Vec<[f32; 2]> = self.lamps.iter().map(|lamp| self.brought_by(lamp, met, normal)).collect();
        let all: f32 = brought.iter().map(|[_, unblocked]| unblocked).sum();
        for (seen, [arrives, unblocked]) in seen.iter_mut().zip(brought) {
            let counts = unblocked > 0.0 && unblocked >= RELEVANT * all;
            *seen = if counts { arrives / unblocked } else { f32::NAN };
        }
    }

    /// What a lamp brings to a surface, and what it would bring if nothing stood between.
    fn brought_by(&self, lamp: &Lamp, met: &Intersection, normal: Vec3) -> [f32; 2] {
        let mut brought = [0.0; 2];
        for (chosen_by, point) in &lamp.points {
            let Some(sample) = self.tracer.lights().sample(met.point.position, *chosen_by, *point) else { continue };
            let weight = lamp.weight * luminance(sample.radiance_over_pdf) * normal.dot(sample.wi).max(0.0);
            if !(weight > 0.0 && weight.is_finite()) {
                continue;
            }
            let from = met.point.leaving_towards(sample.wi);
            let ray = match sample.end {
                ShadowEnd::AreaLight(end) => Ray::between(from, end.leaving_towards(-sample.wi)),
                ShadowEnd::Point(end) => Ray::between(from, end),
                ShadowEnd::Infinity => Ray::new(from, sample.wi),
            };
            brought[1] += weight;
            if !self.tracer.accel().occluded(&ray) {
                brought[0] += weight;
            }
        }
        brought
    }

    /// Whether many directions above a surface end near it.
    fn touches(&self, met: &Intersection, normal: Vec3) -> bool {
        let distance = (met.point.position - self.frame.eye).dot(self.frame.forward);
        let reach = NEAR * 2.0 * self.frame.up.length() * distance;
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        let ends_near = |index: usize| {
            // even steps of the sine's square by the golden angle: as the cosine asks for
            let sine = ((index as f32 + 0.5) / NEAR_DIRECTIONS as f32).sqrt();
            let angle = FRAC_PI_4 + TAU * 0.618_034 * index as f32;
            let beside = tangent * angle.cos() + bitangent * angle.sin();
            let direction = beside * sine + normal * (1.0 - sine * sine).sqrt();
            let ray = Ray { tmax: reach, ..Ray::new(met.point.leaving_towards(direction), direction.normalize()) };
            self.tracer.accel().occluded(&ray)
        };
        let near = (0..NEAR_DIRECTIONS).filter(|index| ends_near(*index)).count();
        near as f32 >= TOUCHES * NEAR_DIRECTIONS as f32
    }
}

/// What a ray through a cell met.
struct Meeting {
    surface: FirstSurface,
    met: Option<Intersection>,
}

/// The effect that a material has by itself, seen from its front or its back; by its factors, whatever pictures it wears.
fn of_material(material: &Material, is_front: bool) -> Option<Effect> {
    if material.emission.is_some_and(|emission| emission.two_sided || is_front) && material.shines() {
        return Some(Effect::LightSource);
    }
    match &material.bsdf {
        Bsdf::Dielectric { .. } => Some(Effect::Refraction),
        Bsdf::Mirror { .. } => Some(Effect::Reflection),
        Bsdf::RoughConductor { roughness, .. } if *roughness < SHOWS_PICTURES => Some(Effect::Reflection),
        Bsdf::MetallicRoughness(m) if m.metallic > 0.5 && m.roughness < SHOWS_PICTURES => Some(Effect::Reflection),
        Bsdf::RoughConductor { .. } | Bsdf::MetallicRoughness(_) | Bsdf::Diffuse { .. } => None,
    }
}
