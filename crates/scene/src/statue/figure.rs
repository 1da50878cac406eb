//! A bust on a round socle, 2 units high, that stands on y = 0 and looks towards +z: smoothly joined ellipsoids, and rays
//! from inside that find its surface. Only sums, products, quotients and square roots, so that every machine makes the same.

use super::lattice::Node;
use super::noise::{noise, octaves};
use glam::{Vec2, Vec3, Vec3Swizzles};
use rayon::prelude::*;
use std::sync::OnceLock;

/// Middle and half axes.
struct Ellipsoid(Vec3, Vec3);

const fn ellipsoid(middle: [f32; 3], half: [f32; 3]) -> Ellipsoid {
    Ellipsoid(Vec3::from_array(middle), Vec3::from_array(half))
}

const TORSO: [Ellipsoid; 6] = [
    ellipsoid([0.0, 0.88, 0.0], [0.44, 0.36, 0.25]),
    ellipsoid([0.17, 0.92, 0.12], [0.2, 0.2, 0.14]),
    ellipsoid([-0.17, 0.92, 0.12], [0.2, 0.2, 0.14]),
    ellipsoid([0.4, 1.0, -0.02], [0.17, 0.16, 0.18]),
    ellipsoid([-0.4, 1.0, -0.02], [0.17, 0.16, 0.18]),
    ellipsoid([0.0, 1.1, -0.05], [0.3, 0.11, 0.14]),
];
const NECK: Ellipsoid = ellipsoid([0.0, 1.3, -0.02], [0.118, 0.4, 0.122]);
/// In front of a mirror plane x = 0 lies one half of the face, and the other behind it.
const FACE: [Ellipsoid; 9] = [
    // the skull, the jaw, the chin
    ellipsoid([0.0, 1.7, -0.03], [0.2, 0.24, 0.245]),
    ellipsoid([0.0, 1.54, 0.06], [0.148, 0.185, 0.165]),
    ellipsoid([0.0, 1.405, 0.16], [0.06, 0.045, 0.055]),
    // the brow, the cheek, the bridge of the nose, its tip and its wing, an ear
    ellipsoid([0.075, 1.712, 0.165], [0.085, 0.026, 0.05]),
    ellipsoid([0.105, 1.585, 0.13], [0.055, 0.06, 0.065]),
    ellipsoid([0.0, 1.635, 0.225], [0.022, 0.085, 0.035]),
    ellipsoid([0.0, 1.577, 0.252], [0.02, 0.022, 0.03]),
    ellipsoid([0.03, 1.567, 0.232], [0.02, 0.02, 0.026]),
    ellipsoid([0.2, 1.625, -0.03], [0.028, 0.07, 0.045]),
];
const SOCKET: Ellipsoid = ellipsoid([0.08, 1.66, 0.235], [0.052, 0.036, 0.045]);
const EYE: Ellipsoid = ellipsoid([0.078, 1.658, 0.165], [0.042, 0.034, 0.042]);
const LIPS: [Ellipsoid; 2] =
    [ellipsoid([0.022, 1.497, 0.21], [0.042, 0.012, 0.022]), ellipsoid([0.0, 1.467, 0.206], [0.04, 0.014, 0.022])];
const HAIR: [Ellipsoid; 3] = [
    ellipsoid([0.0, 1.765, -0.07], [0.225, 0.215, 0.25]),
    ellipsoid([0.12, 1.835, 0.07], [0.12, 0.08, 0.11]),
    ellipsoid([0.0, 1.56, -0.17], [0.16, 0.17, 0.11]),
];
/// Cosine and sine of the angle by which the head is turned.
const HEAD_TURN: Vec2 = Vec2::new(0.96, 0.28);

/// Nearly the distance from an ellipsoid, below 0 inside (I. Quilez, "Distance functions").
fn distance(p: Vec3, Ellipsoid(middle, half): &Ellipsoid) -> f32 {
    let q = (p - middle) / half;
    let (k, slope) = (q.length(), (q / half).length());
    if slope > 0.0 { k * (k - 1.0) / slope } else { -half.min_element() }
}

/// The lesser of two distances, rounded over a width where they meet.
fn join(a: f32, b: f32, width: f32) -> f32 {
    let near = (width - (a - b).abs()).max(0.0) / width;
    a.min(b) - 0.25 * width * near * near
}

/// The greater of two distances, rounded alike: what lies in both.
fn common(a: f32, b: f32, width: f32) -> f32 {
    -join(-a, -b, width)
}

fn joined(p: Vec3, parts: &[Ellipsoid], width: f32) -> f32 {
    parts.iter().fold(f32::MAX, |all, part| join(all, distance(p, part), width))
}

/// A disc with a rounded rim: its middle's height, half its own, and its radius.
fn disc(p: Vec3, height: f32, half: f32, radius: f32) -> f32 {
    const ROUND: f32 = 0.02;
    let q = Vec2::new(p.xz().length() - radius, (p.y - height).abs() - half) + ROUND;
    q.max(Vec2::ZERO).length() + q.max_element().min(0.0) - ROUND
}

fn socle(p: Vec3) -> f32 {
    let slab = join(disc(p, 0.05, 0.05, 0.33), disc(p, 0.115, 0.03, 0.27), 0.01);
    let stem = disc(p, 0.32, 0.22, 0.12);
    let moulding = join(disc(p, 0.44, 0.022, 0.2), disc(p, 0.48, 0.04, 0.165), 0.015);
    join(join(slab, stem, 0.16), moulding, 0.05)
}

fn torso(p: Vec3) -> f32 {
    // cut off below as sculptors do, in a bow
    let bow = distance(p, &ellipsoid([0.0, 1.18, 0.0], [0.62, 0.68, 0.5]));
    common(joined(p, &TORSO, 0.14), bow, 0.03)
}

/// Distances from the head, and from its hair alone.
fn head(p: Vec3) -> (f32, f32) {
    let Vec2 { x, y: z } = HEAD_TURN.rotate(p.xz());
    let p = Vec3::new(x.abs(), p.y, z);
    let skin = common(joined(p, &FACE, 0.045), -distance(p, &SOCKET), 0.03);
    let skin = join(skin, distance(p, &EYE), 0.006);
    let skin = join(skin, joined(p, &LIPS, 0.004), 0.02);
    (skin, joined(p, &HAIR, 0.06))
}

/// Nearly the distance from the surface, below 0 inside; and how much of what is there is hair, from 0 to 1.
fn figure(p: Vec3) -> (f32, f32) {
    let (mut all, mut hair) = (f32::MAX, 0.0);
    if p.y < 0.8 {
        all = socle(p);
    }
    if p.y > 0.3 && p.y < 1.5 {
        all = join(all, torso(p), 0.05);
    }
    if p.y > 1.0 {
        all = join(all, distance(p, &NECK), 0.12);
    }
    if p.y > 1.2 {
        let (skin, of_hair) = head(p);
        hair = ((skin - of_hair + 0.01) * 50.0).clamp(0.0, 1.0) * (1.0 - 40.0 * of_hair).clamp(0.0, 1.0);
        all = join(join(all, skin, 0.06), of_hair, 0.015);
    }
    (all, hair)
}

/// Where a ring's rays begin and how they rise: the ring's height in the lattice, the ray's in the figure, how far it
/// goes outwards and up.
struct Ray(f32, f32, [f32; 2]);

/// Fans where the figure bulges, and rays that slide down its axis where it is narrow; no two cross inside of it.
const RAYS: [Ray; 18] = [
    Ray(1.0, 1.66, [0.0, 1.0]),
    Ray(0.86, 1.66, [0.75, 0.66]),
    Ray(0.68, 1.64, [1.0, 0.0]),
    Ray(0.48, 1.52, [0.71, -0.71]),
    Ray(0.38, 1.36, [0.9, -0.42]),
    Ray(0.31, 1.22, [1.0, 0.0]),
    Ray(0.24, 1.02, [0.75, 0.66]),
    Ray(0.15, 0.88, [0.75, 0.66]),
    Ray(0.0, 0.88, [0.98, 0.2]),
    Ray(-0.13, 0.86, [0.98, -0.2]),
    Ray(-0.29, 0.8, [0.5, -0.87]),
    Ray(-0.36, 0.56, [0.9, -0.42]),
    Ray(-0.44, 0.34, [1.0, 0.0]),
    Ray(-0.53, 0.14, [0.75, 0.66]),
    Ray(-0.58, 0.05, [0.85, 0.53]),
    Ray(-0.67, 0.05, [0.98, 0.18]),
    Ray(-0.74, 0.05, [0.99, -0.14]),
    Ray(-1.0, 0.05, [0.0, -1.0]),
];

/// The start and unit direction of the ray through a corner of the lattice.
fn ray(Node { height, turn }: Node) -> (Vec3, Vec3) {
    let below = RAYS.iter().position(|ray| ray.0 <= height).unwrap_or(RAYS.len() - 1).max(1);
    let (Ray(from, y, way), Ray(to, next_y, next_way)) = (&RAYS[below - 1], &RAYS[below]);
    let t = (from - height) / (from - to);
    let rise = Vec2::from(*way).lerp(Vec2::from(*next_way), t);
    let place = turn - turn.floor();
    let in_quarter = Vec2::new(1.0 - place, place).normalize();
    let around = match turn.floor() as u32 % 4 {
        0 => in_quarter,
        1 => in_quarter.perp(),
        2 => -in_quarter,
        _ => -in_quarter.perp(),
    };
    // counter-clockwise from above is from x to -z
    let direction = Vec3::new(around.x * rise.x, rise.y, -around.y * rise.x);
    (Vec3::new(0.0, y + (next_y - y) * t, 0.0), direction.normalize())
}

/// The longest way from the axis to the surface, and a length that no ear's edge is missed over.
const FARTHEST: f32 = 1.2;
const SHORTEST_STEP: f32 = 0.001;

/// How thick the cloth is over the torso: its folds run down from the left shoulder, and its seam is cut round in front.
fn cloth(p: Vec3) -> f32 {
    let seam = 1.15 - 0.5 * p.z.max(0.0) - 0.06 * p.x;
    let covered = ((seam - p.y) * 50.0).clamp(0.0, 1.0) * ((p.y - 0.54) * 25.0).clamp(0.0, 1.0);
    if covered == 0.0 {
        return 0.0;
    }
    let (across, along) = (0.75 * p.x - 0.66 * p.y, 0.66 * p.x + 0.75 * p.y);
    let fold = |scale: f32| noise(Vec3::new(scale * across + along, 1.5 * along, 3.0 * p.z));
    covered * (0.012 + 0.016 * fold(13.0) + 0.006 * fold(29.0))
}

/// Steps from a length of [`Ways`] to the surface.
const STEPS: usize = 3;

/// Heights of the grain of stone and of locks of hair, and how many are side by side over a length of 1.
const STONE: f32 = 0.004;
const HAIR_GRAIN: f32 = 0.03;
const GRAINS_A_UNIT: f32 = 9.0;

/// Goes from inside to where the surface is first met.
fn way_out(start: Vec3, direction: Vec3) -> f32 {
    let inside = |t: f32| -figure(start + direction * t).0;
    let mut t = 0.0;
    let mut depth = inside(t);
    while depth > 0.0 && t < FARTHEST {
        t += (0.7 * depth).max(SHORTEST_STEP);
        depth = inside(t);
    }
    t
}

/// Lengths of the rays' ways out, at heights and turns evenly spaced: where rays between them begin to look.
pub struct Ways(Vec<f32>);

/// Rows of [`Ways`], and its columns.
const ROWS: usize = 512;
const COLUMNS: usize = 512;

impl Ways {
    /// Made once, however many statues there are.
    pub fn of_the_figure() -> &'static Ways {
        static WAYS: OnceLock<Ways> = OnceLock::new();
        WAYS.get_or_init(Ways::new)
    }

    /// Follows each of its rays from the axis to the surface.
    fn new() -> Self {
        let of = |at: usize| {
            let height = 1.0 - 2.0 * (at / COLUMNS) as f32 / ROWS as f32;
            let turn = 4.0 * (at % COLUMNS) as f32 / COLUMNS as f32;
            let (start, direction) = ray(Node { height, turn });
            way_out(start, direction)
        };
        Ways((0..(ROWS + 1) * COLUMNS).into_par_iter().map(of).collect())
    }

    fn between(&self, Node { height, turn }: Node) -> f32 {
        let (row, column) = (0.5 * (1.0 - height) * ROWS as f32, 0.25 * turn * COLUMNS as f32);
        let (i, j) = ((row as usize).min(ROWS - 1), column as usize);
        let at = |di: usize, dj: usize| self.0[(i + di) * COLUMNS + (j + dj) % COLUMNS];
        let (down, along) = (row - i as f32, column - j as f32);
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        mix(mix(at(0, 0), at(0, 1), along), mix(at(1, 0), at(1, 1), along), down)
    }

    /// The statue's corner that belongs to one of the lattice: on the figure, and then out or in by its grain.
    pub fn corner(&self, node: Node) -> Vec3 {
        let (start, direction) = ray(node);
        let (mut way, mut hair) = (self.between(node), 0.0);
        for _ in 0..STEPS {
            let (depth, of_hair) = figure(start + direction * way);
            (way, hair) = (way - 0.8 * depth, of_hair);
        }
        let p = start + direction * way;
        let grain = (STONE + (HAIR_GRAIN - STONE) * hair) * octaves(p * GRAINS_A_UNIT);
        let p = p + direction * (grain + cloth(p));
        // it stands on its base
        p.max(Vec3::new(f32::MIN, 0.0, f32::MIN))
    }
}
