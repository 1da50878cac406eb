//! Pictures of rays as fine as there is time for, and times for the plot.

use super::subject::{camera_for, statue};
use super::{Level, TreesControl, say};
use crate::model::{TreePoint, grouped, statue_triangles};
use pathtrace::intersect::counted::{CountedMesh, CountedPicture, Structure};
use scene::Camera;
use technique::{Rank, Threads};

/// Seconds that a picture may take; what would take longer stays in blocks.
const MOST_SECONDS: f64 = 4.0;

/// Pixels along the sides of the blocks of a picture's steps.
const BLOCKS: [u32; 6] = [64, 16, 8, 4, 2, 1];

/// Seconds that a list takes at least for each of its triangles, to leave out what would take minutes.
const OF_A_TRIANGLE: f64 = 5e-9;

/// Rays of a measurement for the plot: of the whole statue, the same for each level.
const PROBE: (u32, u32) = (64, 96);

/// Seconds that a measurement of a list may take.
const MOST_PROBE_SECONDS: f64 = 1.0;

/// What takes less than so many seconds is measured as often as [`REPEATS`] says, and the shortest counts: other work of the
/// machine only makes it longer.
const SHORT: f64 = 0.05;
const REPEATS: usize = 5;

/// One picture after the other, each finer, as far as there is time; ends where something else is wanted.
pub fn pictures<'a>(
    made: &'a CountedMesh,
    camera: &'a Camera,
    (width, height): (u32, u32),
    threads: &'a Threads,
    control: &'a TreesControl,
) -> impl Iterator<Item = CountedPicture> + 'a {
    let mut of_a_ray = if made.structure() == Structure::List { OF_A_TRIANGLE * made.triangles() as f64 } else { 0.0 };
    BLOCKS.into_iter().map_while(move |block| {
        control.wait();
        let size = (width.div_ceil(block), height.div_ceil(block));
        let rays = f64::from(size.0) * f64::from(size.1);
        if of_a_ray * rays > MOST_SECONDS {
            return None;
        }
        let picture = trace(made, camera, size, threads, control)?;
        of_a_ray = picture.seconds / rays;
        Some(picture)
    })
}

fn trace(
    made: &CountedMesh,
    camera: &Camera,
    size: (u32, u32),
    threads: &Threads,
    control: &TreesControl,
) -> Option<CountedPicture> {
    let ends = || control.ends_soon();
    let traced = || CountedPicture::trace(made, camera, size, &|| !ends());
    threads.turn_unless(&ends, Rank::FirstPicture, traced).flatten()
}

/// What rays take at one level in each structure that there is time for; `None` where something else is wanted. What was
/// made of it already is used.
pub fn level(number: u32, own: Option<&Level>, threads: &Threads, control: &TreesControl) -> Option<Vec<TreePoint>> {
    let goes_on = || !control.ends_soon();
    say(control, Some(format!("measuring {} triangles", grouped(statue_triangles(number)))));
    let mesh = own.map_or_else(|| statue(number, &goes_on), |level| Some(level.mesh.clone()))?;
    let camera = camera_for(&mesh);
    let mut points = Vec::new();
    for structure in Structure::ALL {
        let kept = own.and_then(|level| level.made[structure as usize].as_ref());
        let fresh = if kept.is_none() { CountedMesh::new(&mesh, structure, &|_| goes_on()) } else { None };
        if let Some(made) = kept.or(fresh.as_ref()) {
            points.extend(point(made, structure, number, &camera, threads, control));
        }
        if control.ends_soon() {
            return None;
        }
    }
    Some(points)
}

/// `None` where even a few rays take too long.
fn point(
    made: &CountedMesh,
    structure: Structure,
    level: u32,
    camera: &Camera,
    threads: &Threads,
    control: &TreesControl,
) -> Option<TreePoint> {
    let triangles = statue_triangles(level);
    if structure == Structure::List && OF_A_TRIANGLE * triangles as f64 > 0.1 * MOST_PROBE_SECONDS {
        return None;
    }
    let (width, height) = PROBE;
    let mut measured = None;
    for block in [16, 4, 1] {
        let size = (width / block, height / block);
        let picture = trace(made, camera, size, threads, control)?;
        let mut shortest = picture.seconds;
        if block == 1 && shortest < SHORT {
            for _ in 1..REPEATS {
                shortest = shortest.min(trace(made, camera, size, threads, control)?.seconds);
            }
        }
        let (rays, tests) = (picture.pixels.len() as f64, picture.tests());
        let seconds = 1e6 * shortest / rays;
        let tests = (tests.boxes + tests.triangles) as f64 / rays;
        measured = Some(TreePoint { structure, triangles, seconds, tests });
        if 16.0 * picture.seconds > MOST_PROBE_SECONDS {
            break;
        }
    }
    measured
}
