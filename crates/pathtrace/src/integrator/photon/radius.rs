//! The radius in which photons are gathered: of the first pass by what the scene's own camera sees, then smaller from pass
//! to pass.

use scene::{Scene, Vec3};

/// This share of the root of the bounds' surface at most, so that some tens of photons lie in a disc where they lie as everywhere.
const SHARE_OF_BOUNDS: f32 = 1.0 / 128.0;

/// This share of the picture's height at most, where what is seen lies. Of `whitted`, on whose caustic a radius of twice
/// that or half is worse, it is as much as by its bounds.
const SHARE_OF_PICTURE: f32 = 1.0 / 10.0;

/// How many times as large as the picture the root of the bounds' surface is where little is seen.
const LITTLE: f32 = 64.0;

/// Rays along each side of the picture.
const SIDE: u16 = 8;

/// The first radius where none is set, see [`super::PhotonSettings::radius`]: by what the scene's own camera sees, which
/// of a wide scene may be little.
pub fn usual_radius(scene: &Scene) -> f32 {
    let by_bounds = SHARE_OF_BOUNDS * root_of_bounds(scene);
    let by_picture = picture_height(scene).map_or(by_bounds, |height| SHARE_OF_PICTURE * height);
    let least = ULPS * f32::EPSILON * farthest_coordinate(scene);
    rounded(by_bounds.min(by_picture).max(least).clamp(f32::MIN_POSITIVE.sqrt(), f32::MAX.sqrt()))
}

/// Photons and the points that gather them lie where f32 can: discs that are no wider than a few such steps hold many
/// of them or none.
const ULPS: f32 = 64.0;

fn farthest_coordinate(scene: &Scene) -> f32 {
    let (lo, hi) = scene.bounds();
    lo.abs().max(hi.abs()).max_element()
}

/// To three digits, which a person can type, and which do not tell shapes that touch from those held apart.
fn rounded(radius: f32) -> f32 {
    format!("{radius:.2e}").parse().unwrap_or(radius)
}

/// The root of the surface of the box around all shapes.
fn root_of_bounds(scene: &Scene) -> f32 {
    let (lo, hi) = scene.bounds();
    let Vec3 { x, y, z } = hi - lo;
    (2.0 * (x * y + y * z + z * x)).sqrt()
}

/// Whether what the scene's own camera sees is so little of it that light which comes by way of the rest seldom arrives:
/// photons can be aimed from the lights, not from one surface to another.
pub fn sees_little(scene: &Scene) -> bool {
    picture_height(scene).is_some_and(|height| height * LITTLE < root_of_bounds(scene))
}

/// The height of a square picture by the scene's own camera at the middle one of the distances of what it sees; `None` of
/// a camera that sees nothing. Boxes stand for shapes: a label may ask at any time, when there is no tree to search.
fn picture_height(scene: &Scene) -> Option<f32> {
    let boxes: Vec<(Vec3, Vec3)> = scene.shapes.iter().map(|shape| shape.geometry.bounds()).collect();
    let frame = scene.camera.frame(1.0);
    let across = |i: u16| f32::from(2 * i + 1) / f32::from(SIDE) - 1.0;
    let rays = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (across(column), across(row))));
    let depth = |(x, y): (f32, f32)| {
        let direction = frame.forward + frame.right * x + frame.up * y;
        boxes.iter().filter_map(|bounds| depth_of(*bounds, frame.eye, direction)).min_by(f32::total_cmp)
    };
    let mut depths: Vec<f32> = rays.filter_map(depth).collect();
    let middle = depths.len() / 2;
    depths.sort_unstable_by(f32::total_cmp);
    depths.get(middle).map(|depth| 2.0 * depth * frame.up.length())
}

/// Where a ray enters a box, or leaves it from within, in lengths of its direction.
fn depth_of((lo, hi): (Vec3, Vec3), eye: Vec3, direction: Vec3) -> Option<f32> {
    let [one, other] = [lo, hi].map(|corner| (corner - eye) / direction);
    let (near, far) = (one.min(other).max_element(), one.max(other).min_element());
    (near <= far && far > 0.0).then_some(if near > 0.0 { near } else { far })
}

/// The radius of a pass, counted from 0, whose first one is given: equation 15 of Knaus and Zwicker.
pub fn radius_of_pass(first: f32, alpha: f32, pass: u32) -> f32 {
    let shrink = |squared: f64, i: u32| squared * (f64::from(i) + f64::from(alpha)) / (f64::from(i) + 1.0);
    (f64::from(first).powi(2) * (1..=pass).fold(1.0, shrink)).sqrt() as f32
}
