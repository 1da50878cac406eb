//! A small scene against a ray in each lane: every lane meets every shape, without a tree.
//!
//! Flat shapes are watertight as in [`super::triangle`], after Woop, Benthin and Wald, and cheaper by what they share:
//! coordinates, corners and edges are each taken into the rays' frames once, however many shapes they belong to. So
//! neighbours do not only evaluate the same expression for their common edge, it is the same number. The two halves of
//! a rectangle are one facet of four edges.
//!
//! The distance to a plane is `(offset - n . origin) / (n . direction)`, above the division in f64, or exactly in f32
//! where the plane is parallel to an axis: from a point just above a wall, its sign must be right. Parallel planes
//! share their normal, and the division.
//!
//! Twins: `shaders/pathtrace/intersect/shape_list.wgsl` and `quadrilateral.wgsl`.

mod pieces;
mod prepare;
mod surfaces;

pub(crate) use pieces::{ListedForm, ListedPlane};
pub(crate) use prepare::Origin;

use super::coincident::{Groups, NO_GROUP};
use super::disk::Disk;
use super::sphere::Sphere;
use super::{Hits, Intersections, NO_INSTANCE, NO_LIGHT, NO_PRIMITIVE, Rays};
use simd::{Double, Float, Mask, Word};
use surfaces::Surfaces;

/// All shapes of a small scene.
pub struct ShapeList {
    /// What a ray may meet.
    seen: Shapes,
    /// What a shadow ray may meet: without planes that have all shapes on one side.
    shading: Shapes,
    surfaces: Surfaces,
    groups: Groups,
    /// Where each comes from.
    origins: Vec<Origin>,
}

/// A list of shapes. Their ids decide ties: the lower wins.
#[derive(Debug, Default)]
struct Shapes {
    /// Coordinates that occur along each axis.
    coordinates: [Vec<f32>; 3],
    /// Corners, as places in the coordinates.
    corners: Vec<[u16; 3]>,
    /// Edges, as places in the corners.
    edges: Vec<[u16; 2]>,
    normals: Vec<PlaneNormal>,
    facets: Vec<Facet>,
    spheres: Vec<(Place, Sphere)>,
    disks: Vec<(Place, Disk)>,
}

/// What a shape is to others.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Decides ties: the lower wins.
    id: u32,
    /// Index into the list of lights, or [`NO_LIGHT`].
    light: u32,
    /// Of the shapes that it coincides with, or [`NO_GROUP`].
    group: u32,
    /// Whether it is of glass.
    clear: bool,
}

/// The unit normal of a family of parallel planes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum PlaneNormal {
    /// Along x, y or z.
    Axis(usize),
    Tilted([f64; 3]),
}

/// A triangle or a parallelogram.
#[derive(Debug, Clone, Copy)]
struct Facet {
    place: Place,
    /// Edges around it; a triangle's last one twice.
    edges: [u16; 4],
    /// The sign bit where it runs along an edge backwards.
    turned: [u32; 4],
    /// Its corners; a triangle's last one twice.
    corners: [u16; 4],
    normal: u16,
    /// `normal . p` of its points.
    offset: f64,
}

/// What the rays of all lanes have in common with the shapes' parts. Kept from call to call.
#[derive(Debug)]
pub struct Scratch<F: Float> {
    /// What a coordinate adds to x and y of the rays' frames.
    coordinates: [Vec<[F; 2]>; 3],
    /// Corners in the rays' frames, where the ray is the z axis.
    corners: Vec<[F; 2]>,
    /// Twice the signed area of (z axis, first corner, second corner).
    edges: Vec<F>,
    planes: Vec<Slant<F>>,
}

/// How rays run towards parallel planes.
#[derive(Debug, Clone, Copy)]
struct Slant<F: Float> {
    /// `normal . origin`, where the planes are tilted.
    start: F::D,
    /// `1 / (normal . direction)`.
    inverse: F,
    /// Rays almost along the planes.
    grazing: F::M,
}

impl<F: Float> Scratch<F> {
    /// Room for the shapes of a shape_list, if there is one.
    #[inline(always)]
    pub fn new(shape_list: Option<&ShapeList>) -> Self {
        let zero = F::splat(0.0);
        let slant = Slant { start: F::D::splat(0.0), inverse: zero, grazing: zero.lt(zero) };
        let mut scratch =
            Scratch { coordinates: [vec![], vec![], vec![]], corners: vec![], edges: vec![], planes: vec![] };
        if let Some(ShapeList { seen, .. }) = shape_list {
            for axis in 0..3 {
                scratch.coordinates[axis] = vec![[zero; 2]; seen.coordinates[axis].len()];
            }
            scratch.corners = vec![[zero; 2]; seen.corners.len()];
            scratch.edges = vec![zero; seen.edges.len()];
            scratch.planes = vec![slant; seen.normals.len()];
        }
        scratch
    }
}

/// Cosine below which the plane of a shape says little about the distance along it: there it is held between the
/// corners'.
const GRAZING: f32 = 1.0 / 256.0;

impl ShapeList {
    /// The nearest hits before `rays.tmax`; of several at one distance the one of lowest id.
    #[inline(always)]
    pub fn closest<F: Float>(&self, rays: &Rays<F>, scratch: &mut Scratch<F>) -> Hits<F> {
        // most scenes have nothing that coincides
        if self.groups.any() { self.nearest::<F, true>(rays, scratch) } else { self.nearest::<F, false>(rays, scratch) }
    }

    #[inline(always)]
    fn nearest<F: Float, const GROUPED: bool>(&self, rays: &Rays<F>, scratch: &mut Scratch<F>) -> Hits<F> {
        let frame = Frame::new(rays);
        self.seen.prepare(rays, &frame, scratch);
        let (mut t, mut id) = (rays.tmax, F::U::splat(NO_PRIMITIVE));
        for facet in &self.seen.facets {
            let (met, distance) = self.seen.meet(facet, rays, &frame, scratch);
            // in the order of their ids: at one distance the first stays
            let mut nearer = met & distance.lt(t);
            if GROUPED && facet.place.group != NO_GROUP {
                nearer = nearer & !self.is_together::<F>(id, &facet.place);
            }
            t = F::select(nearer, distance, t);
            id = F::U::select(nearer, F::U::splat(facet.place.id), id);
        }
        for (place, sphere) in &self.seen.spheres {
            (t, id) = self.nearer(sphere.lanes().intersect(rays), place, (t, id));
        }
        for (place, disk) in &self.seen.disks {
            (t, id) = self.nearer(disk.intersect(rays), place, (t, id));
        }
        Hits { t, primitive: id, instance: F::U::splat(NO_INSTANCE), barycentrics: [F::splat(0.0); 3] }
    }

    /// What the rays have met that have these hits.
    #[inline(always)]
    pub fn intersections<F: Float>(&self, rays: &Rays<F>, hits: &Hits<F>) -> Intersections<F> {
        self.surfaces.intersections(rays, hits)
    }

    /// Where `wanted` shadow rays meet anything before `rays.tmax`, see
    /// [`Aggregate::occluded`](super::aggregate::Aggregate::occluded); if `opaque`, glass does not count.
    #[inline(always)]
    pub fn occluded<F: Float>(
        &self,
        rays: &Rays<F>,
        to_light: F::U,
        wanted: F::M,
        opaque: bool,
        scratch: &mut Scratch<F>,
    ) -> F::M {
        let shapes = &self.shading;
        let frame = Frame::new(rays);
        shapes.prepare(rays, &frame, scratch);
        let endless = Rays { tmax: F::splat(f32::INFINITY), ..*rays };
        let shadow = Shadow { end: rays.tmax, light: to_light, group: self.groups.of_light(to_light) };
        let stands = |place: &&Place| !(opaque && place.clear);
        let mut occluded = !wanted;
        for facet in shapes.facets.iter().filter(|facet| stands(&&facet.place)) {
            let hit = shapes.meet(facet, rays, &frame, scratch);
            occluded = occluded | shadow.is_cast_by(&facet.place, hit);
        }
        for (place, sphere) in shapes.spheres.iter().filter(|(place, _)| stands(&place)) {
            occluded = occluded | shadow.is_cast_by(place, sphere.lanes().intersect(&endless));
        }
        for (place, disk) in shapes.disks.iter().filter(|(place, _)| stands(&place)) {
            occluded = occluded | shadow.is_cast_by(place, disk.intersect(&endless));
        }
        occluded & wanted
    }

    /// What comes first: what was met, or the nearest so far.
    #[inline(always)]
    fn nearer<F: Float>(&self, (met, distance): (F::M, F), place: &Place, (t, best): (F, F::U)) -> (F, F::U) {
        let id = F::U::splat(place.id);
        let mut nearer = distance.lt(t) | (distance.eq(t) & id.lt(best));
        if place.group != NO_GROUP {
            let together = self.is_together::<F>(best, place);
            nearer = (together & id.lt(best)) | (!together & nearer);
        }
        let nearer = met & nearer;
        (F::select(nearer, distance, t), F::U::select(nearer, id, best))
    }

    /// Where the nearest so far is a shape that this one coincides with.
    #[inline(always)]
    fn is_together<F: Float>(&self, best: F::U, place: &Place) -> F::M {
        let found = !best.eq(F::U::splat(NO_PRIMITIVE));
        found & self.groups.of_surface(best).eq(F::U::splat(place.group))
    }
}

/// Where shadow rays go.
struct Shadow<F: Float> {
    /// Distance of their ends, in lengths of their directions.
    end: F,
    /// Indices of the lights that they go to.
    light: F::U,
    /// Of what coincides with it, or [`NO_GROUP`].
    group: F::U,
}

impl<F: Float> Shadow<F> {
    /// Where a shape that was met at these distances stands before the light: not the light itself, and of what
    /// coincides with it what comes earlier.
    #[inline(always)]
    fn is_cast_by(&self, place: &Place, (met, distance): (F::M, F)) -> F::M {
        let mut casts = met & distance.lt(self.end);
        if place.light != NO_LIGHT {
            casts = casts & !self.light.eq(F::U::splat(place.light));
        }
        if place.group != NO_GROUP {
            let together = self.group.eq(F::U::splat(place.group));
            let earlier = F::U::splat(place.light).lt(self.light);
            casts = (together & met & earlier) | (!together & casts);
        }
        casts
    }
}

/// The frame of a ray: the axis along which it goes farthest is kept, and the others sheared along it until the ray is
/// the z axis. Rows of a matrix for points relative to the origin; its zeros and ones are exact.
struct Frame<F> {
    x: [F; 3],
    y: [F; 3],
    /// `t` of a point of the ray.
    t: [F; 3],
    /// The largest component of the direction.
    longest: F,
}

impl<F: Float> Frame<F> {
    #[inline(always)]
    fn new(rays: &Rays<F>) -> Self {
        let (zero, one, d) = (F::splat(0.0), F::splat(1.0), rays.direction);
        let size = d.abs();
        let along_x = size.x.gt(size.y) & size.x.gt(size.z);
        let along_y = !along_x & size.y.gt(size.z);
        let longest = [along_x, along_y];
        // z is the longest axis, x and y the next ones round
        let depth = along::<F>(longest, d.x, d.y, d.z);
        let shear_x = -(along::<F>(longest, d.y, d.z, d.x) / depth);
        let shear_y = -(along::<F>(longest, d.z, d.x, d.y) / depth);
        let inverse = one / depth;
        Frame {
            x: [
                along::<F>(longest, shear_x, zero, one),
                along::<F>(longest, one, shear_x, zero),
                along::<F>(longest, zero, one, shear_x),
            ],
            y: [
                along::<F>(longest, shear_y, one, zero),
                along::<F>(longest, zero, shear_y, one),
                along::<F>(longest, one, zero, shear_y),
            ],
            t: [
                along::<F>(longest, inverse, zero, zero),
                along::<F>(longest, zero, inverse, zero),
                along::<F>(longest, zero, zero, inverse),
            ],
            longest: depth.abs(),
        }
    }
}

/// Of three values the one for the longest axis, given where that is x and where y.
#[inline(always)]
fn along<F: Float>([is_x, is_y]: [F::M; 2], x: F, y: F, z: F) -> F {
    F::select(is_x, x, F::select(is_y, y, z))
}

impl Shapes {
    /// Takes coordinates, corners, edges and planes into the rays' frames.
    #[inline(always)]
    fn prepare<F: Float>(&self, rays: &Rays<F>, frame: &Frame<F>, scratch: &mut Scratch<F>) {
        let origin = [rays.origin.x, rays.origin.y, rays.origin.z];
        for axis in 0..3 {
            let (x, y, origin) = (frame.x[axis], frame.y[axis], origin[axis]);
            for (place, &coordinate) in scratch.coordinates[axis].iter_mut().zip(&self.coordinates[axis]) {
                let from_origin = F::splat(coordinate) - origin;
                *place = [x * from_origin, y * from_origin];
            }
        }
        let [x, y, z] = &scratch.coordinates;
        for (corner, places) in scratch.corners.iter_mut().zip(&self.corners) {
            let (x, y, z) = (x[usize::from(places[0])], y[usize::from(places[1])], z[usize::from(places[2])]);
            *corner = [x[0] + y[0] + z[0], x[1] + y[1] + z[1]];
        }
        for (edge, ends) in scratch.edges.iter_mut().zip(&self.edges) {
            let (p, q) = (scratch.corners[usize::from(ends[0])], scratch.corners[usize::from(ends[1])]);
            // rounding is monotone, so without fusing the sign is right or it is 0
            *edge = p[0] * q[1] - p[1] * q[0];
        }
        for (plane, normal) in scratch.planes.iter_mut().zip(&self.normals) {
            *plane = normal.slant(rays, frame.longest);
        }
    }

    /// Where rays meet a facet from either side, its edges included, and how far away.
    #[inline(always)]
    fn meet<F: Float>(&self, facet: &Facet, rays: &Rays<F>, frame: &Frame<F>, scratch: &Scratch<F>) -> (F::M, F) {
        let zero = F::splat(0.0);
        let [a, b, c, d] =
            [side(facet, 0, scratch), side(facet, 1, scratch), side(facet, 2, scratch), side(facet, 3, scratch)];
        let (least, most) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
        let inside = least.ge(zero) | most.le(zero);
        let slant = &scratch.planes[usize::from(facet.normal)];
        let distance = match self.normals[usize::from(facet.normal)] {
            PlaneNormal::Axis(axis) => {
                let start = [rays.origin.x, rays.origin.y, rays.origin.z][axis];
                (F::splat(facet.offset as f32) - start) * slant.inverse
            }
            PlaneNormal::Tilted(_) => (F::D::splat(facet.offset) - slant.start).narrow() * slant.inverse,
        };
        // NaN, from a ray in the plane, fails
        let met = inside & distance.gt(zero);
        if (met & slant.grazing).any() {
            let (near, far) = self.extent(facet, rays, frame);
            let held = distance.max(near).min(far);
            return (met & held.gt(zero), F::select(slant.grazing, held, distance));
        }
        (met, distance)
    }

    /// The least and the largest distance of a facet's corners along the rays.
    #[inline(always)]
    fn extent<F: Float>(&self, facet: &Facet, rays: &Rays<F>, frame: &Frame<F>) -> (F, F) {
        let (mut near, mut far) = (F::splat(f32::INFINITY), F::splat(f32::NEG_INFINITY));
        for corner in facet.corners {
            let places = self.corners[usize::from(corner)];
            let x = F::splat(self.coordinates[0][usize::from(places[0])]) - rays.origin.x;
            let y = F::splat(self.coordinates[1][usize::from(places[1])]) - rays.origin.y;
            let z = F::splat(self.coordinates[2][usize::from(places[2])]) - rays.origin.z;
            let t = x * frame.t[0] + y * frame.t[1] + z * frame.t[2];
            (near, far) = (near.min(t), far.max(t));
        }
        (near, far)
    }
}

/// Twice the signed area of the rays and one edge of a facet, as it runs around it.
#[inline(always)]
fn side<F: Float>(facet: &Facet, side: usize, scratch: &Scratch<F>) -> F {
    let area = scratch.edges[usize::from(facet.edges[side])];
    (area.to_bits() ^ F::U::splat(facet.turned[side])).float_from_bits()
}

impl PlaneNormal {
    #[inline(always)]
    fn slant<F: Float>(&self, rays: &Rays<F>, longest: F) -> Slant<F> {
        let (o, d) = (rays.origin, rays.direction);
        let (start, towards) = match *self {
            PlaneNormal::Axis(axis) => (F::D::splat(0.0), [d.x, d.y, d.z][axis]),
            PlaneNormal::Tilted([x, y, z]) => (
                o.x.widen() * x + o.y.widen() * y + o.z.widen() * z,
                (d.x.widen() * x + d.y.widen() * y + d.z.widen() * z).narrow(),
            ),
        };
        Slant { start, inverse: F::splat(1.0) / towards, grazing: towards.abs().lt(longest * GRAZING) }
    }
}

#[cfg(test)]
mod tests;
