//! A path between two of its vertices, and a vertex, in each lane.
//!
//! Twin: `shaders/pathtrace/integrator/path_state.wgsl`.

use crate::intersect::{Rays, SurfacePoints};
use simd::{Float, Vector, Word};

/// A path on its way, in each lane.
#[derive(Clone, Copy)]
pub struct PathStates<F: Float> {
    pub rays: Rays<F>,
    /// Product of BSDF, cosine and inverse density so far: what radiance met now is worth at the camera.
    pub throughput: Vector<F>,
    /// Vertices at which the path has scattered.
    pub vertices: F::U,
    /// Diffuse ones among them, as far as they branched.
    pub forked: F::U,
    /// Tells the branches of a sample apart: the path's number in their tree, 0 if nothing branches.
    pub branch: F::U,
    /// The last vertex.
    pub from: Vector<F>,
    /// Density per solid angle of the direction taken there, as far as the light met now needs it: [`MET_BY_CHANCE`] if
    /// it all counts, [`ALREADY_COUNTED`] if it does not, else weighted against light sampling.
    pub direction_pdf: F,
    /// How many times as dense as without a guide its directions were drawn, all together.
    pub guided: F,
    /// The row of [`crate::integrator::light_paths`] behind the last vertex, where not all light counts.
    pub light_path: F::U,
}

/// No light was sampled at the last vertex, or none could be: the camera, a mirror, glass.
pub const MET_BY_CHANCE: f32 = f32::INFINITY;
/// Light was sampled at the last vertex: meeting it now would count it twice.
pub const ALREADY_COUNTED: f32 = 0.0;

/// Set in the number of the blocks of connections: branches are numbered up to twice
/// [`crate::integrator::path_plan::MOST_BRANCHES`], in the bits from 11 to 27.
pub const CONNECTION: u32 = 1 << 31;

/// A point of a diffuse surface, in each lane.
#[derive(Clone, Copy)]
pub struct DiffuseVertices<F: Float> {
    pub point: SurfacePoints<F>,
    /// On the side that the path came from.
    pub normal: Vector<F>,
    pub albedo: Vector<F>,
}

impl<F: Float> PathStates<F> {
    /// As paths leave the camera.
    #[inline(always)]
    pub fn leaving_camera(rays: &Rays<F>) -> Self {
        let none = F::U::splat(0);
        PathStates {
            rays: *rays,
            throughput: Vector::along_all(F::splat(1.0)),
            vertices: none,
            forked: none,
            branch: none,
            from: rays.origin,
            direction_pdf: F::splat(MET_BY_CHANCE),
            guided: F::splat(1.0),
            light_path: none,
        }
    }

    /// The same path as another of these branches.
    #[inline(always)]
    pub fn numbered(self, branch: F::U) -> Self {
        PathStates { branch, ..self }
    }

    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        PathStates {
            rays: Rays::select(mask, yes.rays, no.rays),
            throughput: Vector::select(mask, yes.throughput, no.throughput),
            vertices: F::U::select(mask, yes.vertices, no.vertices),
            forked: F::U::select(mask, yes.forked, no.forked),
            branch: F::U::select(mask, yes.branch, no.branch),
            from: Vector::select(mask, yes.from, no.from),
            direction_pdf: F::select(mask, yes.direction_pdf, no.direction_pdf),
            guided: F::select(mask, yes.guided, no.guided),
            light_path: F::U::select(mask, yes.light_path, no.light_path),
        }
    }

    /// Blocks of random numbers: the camera takes block 0, each vertex two; branches keep apart by the bits above
    /// these.
    #[inline(always)]
    pub fn direction_dimension(&self) -> F::U {
        let one = F::U::splat(1);
        self.vertices.shl::<1>().wrapping_add(one).wrapping_add(self.branch.shl::<11>())
    }

    #[inline(always)]
    pub fn light_dimension(&self) -> F::U {
        self.direction_dimension().wrapping_add(F::U::splat(1))
    }

    /// Of connections by way of spheres, by the one bit that no other block has.
    #[inline(always)]
    pub fn connection_dimension(&self) -> F::U {
        self.light_dimension() | F::U::splat(CONNECTION)
    }

    /// How much light that was met counts beside the same light sampled at the last vertex with density `light_pdf`.
    #[inline(always)]
    pub fn weight_of_meeting(&self, light_pdf: F) -> F {
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        let all_counts = self.direction_pdf.eq(F::splat(MET_BY_CHANCE));
        let counted = self.direction_pdf.eq(F::splat(ALREADY_COUNTED));
        let weighted = F::select(counted, zero, balance(self.direction_pdf, light_pdf));
        F::select(all_counts, one, weighted)
    }
}

impl<F: Float> DiffuseVertices<F> {
    /// `mask ? yes : no`.
    #[inline(always)]
    pub fn select(mask: F::M, yes: Self, no: Self) -> Self {
        DiffuseVertices {
            point: SurfacePoints::select(mask, yes.point, no.point),
            normal: Vector::select(mask, yes.normal, no.normal),
            albedo: Vector::select(mask, yes.albedo, no.albedo),
        }
    }
}

/// The balance heuristic: the weight of a sample of density `own`, which may be infinite, against one of density
/// `other`.
#[inline(always)]
pub fn balance<F: Float>(own: F, other: F) -> F {
    F::splat(1.0) / (other / own + 1.0)
}
