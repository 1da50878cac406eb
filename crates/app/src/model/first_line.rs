//! Where the wipe's line stands at first: glass and metal are where techniques differ most, so it runs through all of them
//! that are seen, with as much of each on one side as on the other.

use super::Line;
use scene::{Bsdf, Camera, Geometry, Scene, Shape, Vec3};
use std::ops::Range;

/// The most shapes that a line is asked to cut: the largest that are seen.
const MOST_SHAPES: usize = 8;

/// The least of a shape, as a share of its extent, that must be on either side of the line for it to be cut.
const LEAST_CUT: f32 = 0.15;

/// Parts of the picture's side that a shape must take to count.
const LEAST_SEEN: f32 = 0.02;

/// The line that cuts most evenly what is specular in a picture of `aspect` = width / height, and where it stands, from
/// 0 (left or top edge) to 1: vertical in the middle where nothing is. What of several shapes no line cuts together, is
/// left out from the smallest.
pub fn first_line(scene: &Scene, camera: &Camera, aspect: f32) -> (Line, f32) {
    let seen = specular_extents(scene, camera, aspect);
    let cut = (1..=seen.len()).rev().find_map(|count| {
        let [(x, share_x), (y, share_y)] =
            [Line::Vertical, Line::Horizontal].map(|line| most_even(&seen[..count], line));
        // two that are equal but for rounding are so
        let (line, place) = if share_y > share_x + 1e-3 { (Line::Horizontal, y) } else { (Line::Vertical, x) };
        (share_x.max(share_y) >= LEAST_CUT).then_some((line, place))
    });
    cut.unwrap_or((Line::Vertical, 0.5))
}

/// Where a line of this direction cuts most evenly.
pub fn first_place(scene: &Scene, camera: &Camera, aspect: f32, line: Line) -> f32 {
    let seen = specular_extents(scene, camera, aspect);
    let cut =
        (1..=seen.len()).rev().map(|count| most_even(&seen[..count], line)).find(|(_, share)| *share >= LEAST_CUT);
    cut.map_or(0.5, |(place, _)| place)
}

/// What a shape takes of the picture, along its width and its height.
#[derive(Debug, Clone)]
struct Extent {
    x: Range<f32>,
    y: Range<f32>,
}

impl Extent {
    fn across(&self, line: Line) -> &Range<f32> {
        match line {
            Line::Vertical => &self.x,
            Line::Horizontal => &self.y,
        }
    }

    fn area(&self) -> f32 {
        (self.x.end - self.x.start) * (self.y.end - self.y.start)
    }
}

/// The place at which the smallest share that lies on one side of the line, of all shapes, is largest, and that share.
/// Along the line's way the share of each rises to a half and falls again: the best is where one that rises meets one
/// that falls.
fn most_even(extents: &[Extent], line: Line) -> (f32, f32) {
    let ranges: Vec<_> = extents.iter().map(|extent| extent.across(line)).collect();
    let share = |at: f32| {
        let of = |range: &&Range<f32>| (at - range.start).min(range.end - at) / (range.end - range.start);
        ranges.iter().map(of).fold(0.5, f32::min)
    };
    let meetings = ranges.iter().flat_map(|rises| ranges.iter().map(move |falls| meeting(rises, falls)));
    let shares = meetings.map(|at| (at, share(at)));
    shares.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.5, 0.0))
}

/// Where as large a share of one range lies before as of the other behind.
fn meeting(rises: &Range<f32>, falls: &Range<f32>) -> f32 {
    let [rise, fall] = [rises, falls].map(|range| range.end - range.start);
    (falls.end * rise + rises.start * fall) / (rise + fall)
}

/// What the specular shapes take of the picture, the largest first.
fn specular_extents(scene: &Scene, camera: &Camera, aspect: f32) -> Vec<Extent> {
    let is_specular = |shape: &&Shape| !matches!(scene.material_of(shape).bsdf, Bsdf::Diffuse { .. });
    let specular = scene.shapes.iter().filter(is_specular);
    let mut seen: Vec<Extent> = specular.filter_map(|shape| extent(&shape.geometry, camera, aspect)).collect();
    seen.sort_by(|a, b| b.area().total_cmp(&a.area()));
    seen.truncate(MOST_SHAPES);
    seen
}

/// What of a shape is within the picture; `None` if that is next to nothing, or if the camera is in it or beside it.
fn extent(geometry: &Geometry, camera: &Camera, aspect: f32) -> Option<Extent> {
    let frame = camera.frame(aspect);
    let (right, up) = (frame.right.length(), frame.up.length());
    // distances to the right, upwards and along the line of sight
    let in_camera = |point: Vec3| {
        let from_eye = point - frame.eye;
        Vec3::new(from_eye.dot(frame.right) / right, from_eye.dot(frame.up) / up, from_eye.dot(frame.forward))
    };
    let (x, y) = match geometry {
        Geometry::Sphere { center, radius } => {
            let c = in_camera(*center);
            (tangents(c.x, c.z, *radius)?, tangents(c.y, c.z, *radius)?)
        }
        other => {
            let (lo, hi) = other.bounds();
            let corner = |i: u8| Vec3::select(scene::glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), hi, lo);
            let corners = (0..8).map(|i| in_camera(corner(i))).collect::<Vec<_>>();
            let in_front = corners.iter().all(|corner| corner.z > 0.0);
            let range = |of: fn(&Vec3) -> f32| {
                corners
                    .iter()
                    .map(|c| of(c) / c.z)
                    .fold(f32::INFINITY..f32::NEG_INFINITY, |range, at| range.start.min(at)..range.end.max(at))
            };
            in_front.then(|| (range(|c| c.x), range(|c| c.y)))?
        }
    };
    let within = |from: f32, to: f32| from.max(0.0)..to.min(1.0);
    let x = within(0.5 + 0.5 * x.start / right, 0.5 + 0.5 * x.end / right);
    let y = within(0.5 - 0.5 * y.end / up, 0.5 - 0.5 * y.start / up);
    let is_seen = |range: &Range<f32>| range.end - range.start >= LEAST_SEEN;
    (is_seen(&x) && is_seen(&y)).then_some(Extent { x, y })
}

/// Tangents of the angles between which a sphere is seen that lies `side` beside and `depth` along the line of sight, as
/// far as it lies before the eye.
fn tangents(side: f32, depth: f32, radius: f32) -> Option<Range<f32>> {
    let half = (radius / side.hypot(depth)).asin();
    let middle = side.atan2(depth);
    let in_front = half.is_finite() && (middle.abs() + half) < std::f32::consts::FRAC_PI_2;
    in_front.then(|| (middle - half).tan()..(middle + half).tan())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mirrors with these centres and radii, seen from the origin along -z with a field of view of 90 degrees: a point
    /// at (x, y, -1) is at (x, y) of the picture, from -1 to 1.
    fn mirrors(spheres: &[([f32; 3], f32)]) -> Scene {
        let mut text = "[camera]\neye = [0, 0, 0]\ntarget = [0, 0, -1]\nfov_y = 90\n[sky]\nradiance = [1, 1, 1]\n\
                        [material.m]\nmirror = { reflectance = [1, 1, 1] }\n"
            .to_owned();
        for (center, radius) in spheres {
            text += &format!("[[sphere]]\ncenter = {center:?}\nradius = {radius}\nmaterial = \"m\"\n");
        }
        scene::parse(&text, "mirrors", std::path::Path::new("mirrors.toml")).unwrap()
    }

    fn line_of(scene: &Scene) -> (Line, f32) {
        first_line(scene, &scene.camera, 1.0)
    }

    /// The share of each extent before the line.
    fn shares(scene: &Scene, aspect: f32, (line, place): (Line, f32)) -> Vec<f32> {
        let extents = specular_extents(scene, &scene.camera, aspect);
        let share = |range: &Range<f32>| (place - range.start) / (range.end - range.start);
        extents.iter().map(|extent| share(extent.across(line))).collect()
    }

    #[test]
    fn a_sphere_is_seen_within_the_tangents_to_it() {
        // 45 degrees aside, and its angle of view is 2 asin(sqrt(2) / 2 / sqrt(2)) = 60 degrees
        let scene = mirrors(&[([2.0, 0.0, -2.0], 2.0f32.sqrt())]);
        let seen = tangents(2.0, 2.0, 2.0f32.sqrt()).unwrap();
        assert!(
            (seen.start - 15f32.to_radians().tan()).abs() < 1e-5 && (seen.end - 75f32.to_radians().tan()).abs() < 1e-4
        );
        let [extent] = &specular_extents(&scene, &scene.camera, 1.0)[..] else { panic!("one sphere") };
        assert!((extent.x.start - (0.5 + 0.5 * seen.start)).abs() < 1e-5);
        assert_eq!(extent.x.end, 1.0, "the rest is beyond the edge");
    }

    #[test]
    fn the_line_halves_one_sphere_and_cuts_two_as_evenly_as_it_can() {
        let (line, at) = line_of(&mirrors(&[([-0.4, 0.3, -1.0], 0.2)]));
        assert_eq!(line, Line::Vertical);
        assert!((at - 0.29).abs() < 0.01, "{at}");
        // beside each other: no vertical line cuts both
        let (line, at) = line_of(&mirrors(&[([-0.5, 0.1, -1.0], 0.3), ([0.5, -0.1, -1.0], 0.3)]));
        assert_eq!(line, Line::Horizontal);
        assert!((at - 0.5).abs() < 1e-3, "{at}");
        let (line, _) = line_of(&mirrors(&[([0.1, -0.5, -1.0], 0.3), ([-0.1, 0.5, -1.0], 0.3)]));
        assert_eq!(line, Line::Vertical);
    }

    #[test]
    fn what_no_line_cuts_together_with_the_rest_is_left_out_from_the_smallest() {
        let scene = mirrors(&[([-0.6, 0.6, -1.0], 0.3), ([0.7, -0.7, -1.0], 0.1)]);
        let (line, at) = line_of(&scene);
        let [large, small] = shares(&scene, 1.0, (line, at))[..] else { panic!("two spheres") };
        assert!((large - 0.5).abs() < 1e-3 && !(0.0..1.0).contains(&small), "{large} {small}");
    }

    #[test]
    fn without_anything_specular_the_line_is_vertical_in_the_middle() {
        let cornell = scene::builtin::named("cornell").unwrap();
        assert_eq!(line_of(&cornell), (Line::Vertical, 0.5));
        let behind_the_eye = mirrors(&[([0.0, 0.0, 2.0], 0.5)]);
        assert_eq!(line_of(&behind_the_eye), (Line::Vertical, 0.5));
        let around_the_eye = mirrors(&[([0.0, 0.0, -1.0], 3.0)]);
        assert_eq!(line_of(&around_the_eye), (Line::Vertical, 0.5));
    }

    /// Above it the fake's white metal and its upright glass, below it a mirror of the checkerboard.
    #[test]
    fn in_the_first_scene_a_third_of_glass_and_metal_lies_on_either_side() {
        let whitted = scene::builtin::named("whitted").unwrap();
        for aspect in [1.2, 1.41, 1.78] {
            let (line, at) = first_line(&whitted, &whitted.camera, aspect);
            assert_eq!(line, Line::Horizontal);
            let shares = shares(&whitted, aspect, (line, at));
            assert_eq!(shares.len(), 2);
            assert!(shares.iter().all(|share| (0.32..0.68).contains(share)), "{shares:?}");
            let vertical = first_place(&whitted, &whitted.camera, aspect, Line::Vertical);
            assert!((0.2..0.5).contains(&vertical), "{vertical}");
        }
    }
}
