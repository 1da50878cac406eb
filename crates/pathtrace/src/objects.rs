//! Which of the scene's shapes a picture shows where: the first that a ray through each pixel's middle meets, glass and
//! all, or all that one such ray meets. No light, so no integrator; what alpha masks cut out is not there.

use crate::Tracer;
use crate::drive::lanes::{Stop, rays_through};
use crate::intersect::Rays;
use crate::intersect::shape_list::Scratch;
use crate::prepared::PreparedScene;
use rayon::prelude::*;
use scene::Vec3;
use scene::camera::PictureFrame;
use simd::{Float, Kernel, MOST_LANES, Mask};

/// What stands for the shape of a pixel that shows none.
pub const NO_SHAPE: u32 = u32::MAX;

/// Shapes that are told along one ray, at most.
pub const MOST_ALONG: usize = 16;

/// Surfaces that one ray is followed through for them, at most: a thicket has more than anybody looks behind.
const MOST_SURFACES: usize = 4096;

/// Pixels that one thread takes at a time: whole groups of all kinds of lanes.
const CHUNK: usize = 1024;

/// A shape where a ray meets it first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MetShape {
    /// Index into the shapes of the scene that the tracer was made of.
    pub shape: u32,
    /// From the camera, in the scene's units.
    pub distance: f32,
    /// Where, in the world.
    pub position: Vec3,
}

impl Tracer {
    /// For each of `width` x `height` pixels of what the camera sees, row by row from the top, the index of the shape that
    /// a ray through its middle meets first, into the shapes of the scene that the tracer was made of; [`NO_SHAPE`] where
    /// there is none. On the current rayon pool; `None` once `ends` says so.
    pub fn first_shapes(&self, frame: &PictureFrame, (width, height): (u32, u32), ends: &Stop) -> Option<Vec<u32>> {
        let (scene, lanes) = self.ready();
        let mut shapes = vec![NO_SHAPE; width as usize * height as usize];
        let chunks = shapes.par_chunks_mut(CHUNK).enumerate();
        chunks.for_each(|(index, shapes)| {
            if !ends() {
                let (size, first) = ([width, height], index * CHUNK);
                lanes.run(ChunkKernel { scene, frame, size, first, shapes });
            }
        });
        (!ends()).then_some(shapes)
    }

    /// The shapes that a ray through the middle of one pixel meets, each once, from front to back: `most` of them at most, and
    /// never more than [`MOST_ALONG`]. The first is that of [`Tracer::first_shapes`]; of surfaces that lie in one another
    /// one is there.
    pub fn shapes_along(
        &self,
        frame: &PictureFrame,
        size: (u32, u32),
        [column, row]: [u32; 2],
        most: usize,
    ) -> Vec<MetShape> {
        let (scene, _) = self.ready();
        let mut scratch = Scratch::<f32>::new(scene.aggregate.shape_list());
        let mut rays = rays_through_middles(frame, size.into(), [column as f32, row as f32]);
        let mut found: Vec<MetShape> = Vec::new();
        for _ in 0..MOST_SURFACES {
            let hits = scene.aggregate.closest(&rays, true, &mut scratch);
            let [Some(shape), ..] = scene.aggregate.shapes(hits.met().bits(), &hits.each()) else { break };
            let point = scene.aggregate.intersections(&rays, &hits).point;
            let position = Vec3::new(point.position.x, point.position.y, point.position.z);
            if found.iter().all(|met| met.shape != shape) {
                found.push(MetShape { shape, distance: position.distance(frame.eye), position });
            }
            if found.len() >= most.min(MOST_ALONG) {
                break;
            }
            rays = Rays::new(point.leaving_towards(rays.direction), rays.direction);
        }
        found.truncate(most);
        found
    }
}

/// Pixels in a row of the picture's order.
struct ChunkKernel<'a> {
    scene: &'a PreparedScene,
    frame: &'a PictureFrame,
    size: [u32; 2],
    /// Index of the first.
    first: usize,
    shapes: &'a mut [u32],
}

impl Kernel for ChunkKernel<'_> {
    type Output = ();

    #[inline(always)]
    fn run<F: Float>(self) {
        let ChunkKernel { scene, frame, size, first, shapes } = self;
        let mut scratch = Scratch::new(scene.aggregate.shape_list());
        for (index, group) in shapes.chunks_mut(F::LANES).enumerate() {
            let pixels: [u32; MOST_LANES] = std::array::from_fn(|lane| (first + index * F::LANES + lane) as u32);
            let here = F::M::from_bits(u32::MAX >> (u32::BITS - group.len() as u32));
            let column = pixels.map(|pixel| (pixel % size[0]) as f32);
            let row = pixels.map(|pixel| (pixel / size[0]) as f32);
            let rays = rays_through_middles(frame, size, [F::load(&column), F::load(&row)]);
            let hits = scene.aggregate.closest(&rays, here, &mut scratch);
            let met = scene.aggregate.shapes((here & hits.met()).bits(), &hits.each());
            for (shape, met) in group.iter_mut().zip(met) {
                *shape = met.unwrap_or(NO_SHAPE);
            }
        }
    }
}

/// The rays through the middles of pixels of these columns and rows.
#[inline(always)]
fn rays_through_middles<F: Float>(frame: &PictureFrame, [width, height]: [u32; 2], [column, row]: [F; 2]) -> Rays<F> {
    let x = (column + 0.5) / width as f32 * 2.0 - 1.0;
    let y = F::splat(1.0) - (row + 0.5) / height as f32 * 2.0;
    rays_through(frame, x, y)
}
