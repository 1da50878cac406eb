//! What a camera sees, as spheres that photons are aimed at: found by a few rays, which go through mirrors, metal and glass
//! to the first diffuse surface. They are a function of scene and camera, and so few that they follow a camera that moves.

use crate::drive::lanes::rays_through;
use crate::intersect::Rays;
use crate::intersect::shape_list::Scratch;
use crate::light::Bounds;
use crate::prepared::PreparedScene;
use crate::vectors::glam_vector;
use scene::Vec3;
use scene::camera::PictureFrame;

/// Rays along each side of the picture, from one edge to the other.
const SIDE: u16 = 16;

/// Surfaces up to which each ray is followed.
const MOST_SURFACES: u32 = 16;

/// Halvings of what is seen, each half with a sphere of its own: the smallest hold sixteen rays' points.
const LEVELS: u32 = 4;

/// What is seen fills little of a scene if half of the smallest spheres are smaller than the scene's by this. Sixteen of
/// them side by side then fill a sixteenth of its disc, and all photons that are aimed go there; where they fill more
/// they would come there without.
const SMALL: f32 = 1.0 / 16.0;

/// A place that a ray has come to, and how far the next one's may be.
#[derive(Debug, Clone, Copy)]
struct Seen {
    at: Vec3,
    room: f32,
}

/// Spheres around what is seen, its halves, theirs and so on: what lies between two of one level lies within one of
/// another. None where they would fill much of the scene.
/// `reach` is how far from what is seen photons count.
pub fn spheres(scene: &PreparedScene, frame: &PictureFrame, reach: f32) -> Vec<Bounds> {
    let (mut spheres, mut smallest) = (Vec::new(), Vec::new());
    let mut places = places(scene, frame);
    places.iter_mut().for_each(|seen| seen.room += reach);
    halve(&mut places, LEVELS, &mut spheres, &mut smallest);
    let middle = smallest.len() / 2;
    smallest.sort_unstable_by(f32::total_cmp);
    let is_small = smallest.get(middle).is_some_and(|radius| *radius < SMALL * scene.emitters.scene().radius);
    if is_small { spheres } else { Vec::new() }
}

/// A sphere around places, and those of their halves; of the last ones the radii too.
fn halve(places: &mut [Seen], levels: u32, spheres: &mut Vec<Bounds>, smallest: &mut Vec<f32>) {
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = places.iter().fold(none, |(low, high), seen| (low.min(seen.at), high.max(seen.at)));
    let room = places.iter().fold(0.0f32, |most, seen| most.max(seen.room));
    if places.is_empty() || room == 0.0 {
        return;
    }
    let within = Bounds::of((low, high));
    let sphere = Bounds { radius: within.radius + room, ..within };
    spheres.push(sphere);
    if levels == 0 || places.len() < 2 {
        return smallest.push(sphere.radius);
    }
    let axis = (high - low).max_position();
    let middle = places.len() / 2;
    places.select_nth_unstable_by(middle, |a, b| a.at[axis].total_cmp(&b.at[axis]));
    let (one, other) = places.split_at_mut(middle);
    halve(one, levels - 1, spheres, smallest);
    halve(other, levels - 1, spheres, smallest);
}

fn places(scene: &PreparedScene, frame: &PictureFrame) -> Vec<Seen> {
    let mut scratch = Scratch::<f32>::new(scene.aggregate.shape_list());
    let at = |i: u16| f32::from(2 * i) / f32::from(SIDE - 1) - 1.0;
    let mut places = Vec::new();
    for (row, column) in (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (row, column))) {
        follow(scene, rays_through(frame, at(column), at(row)), &mut scratch, |at, distance| {
            let apart = 2.0 / f32::from(SIDE - 1) * frame.right.length().max(frame.up.length());
            places.push(Seen { at, room: distance * apart });
        });
    }
    places
}

/// Gives the places that a ray sees, each with the length of the way there.
fn follow(scene: &PreparedScene, mut ray: Rays<f32>, scratch: &mut Scratch<f32>, mut see: impl FnMut(Vec3, f32)) {
    let mut distance = 0.0;
    for _ in 0..MOST_SURFACES {
        let hit = scene.closest(&ray, true, scratch);
        let vertex = scene.interaction(&hit, -ray.direction);
        if !hit.met || !vertex.scatters() {
            return;
        }
        distance += (hit.point.position - ray.origin).length_squared().sqrt();
        if !vertex.is_delta() {
            see(glam_vector(hit.point.position), distance);
        }
        if vertex.is_diffuse() {
            return;
        }
        // the middle of rough metal's directions, and on through glass where it lets light through
        let sample = scene.materials.sample(true, &vertex, [0.0, 0.0, LAST]);
        ray = Rays::new(vertex.point.leaving_towards(sample.wi), sample.wi);
    }
}

/// The last random number before 1: glass sends a ray on that meets it unless it reflects all.
const LAST: f32 = 1.0 - f32::EPSILON;
