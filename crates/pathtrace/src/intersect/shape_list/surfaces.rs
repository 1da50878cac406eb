//! What shading needs of the shape that each lane's ray met, looked up by the shape's id.
//!
//! Twin: `shaders/pathtrace/intersect/shape_list.wgsl`.

use crate::intersect::sphere::SphereLanes;
use crate::intersect::{Hits, Intersections, NO_INSTANCE, Rays, SurfacePoints};
use crate::vectors::VectorColumn;
use scene::Vec3;
use scene::glam::DVec3;
use simd::{Column, Float, Mask, Vector, Word, WordColumn};

/// One shape's entry.
#[derive(Debug, Clone, Copy)]
pub struct Surface {
    pub form: Form,
    pub normal: Vec3,
    pub material: u32,
    /// See [`Intersections::light`].
    pub light: u32,
}

/// Where its points lie.
#[derive(Debug, Clone, Copy)]
pub enum Form {
    Flat {
        corner: Vec3,
        edge_u: Vec3,
        edge_v: Vec3,
        /// Only the half on the corner's side.
        half: bool,
        /// How far from its plane, as rays are tested against it, its points may lie.
        flatness: f32,
    },
    Sphere {
        center: Vec3,
        radius: f32,
    },
    Disk {
        center: Vec3,
    },
}

/// All entries, by columns.
pub struct Surfaces {
    /// Corner or centre.
    corner: VectorColumn,
    edge_u: VectorColumn,
    edge_v: VectorColumn,
    /// What gives the place along an edge of a point relative to the corner.
    dual_u: VectorColumn,
    dual_v: VectorColumn,
    /// The most that both places add up to.
    most: Column,
    normal: VectorColumn,
    flatness: Column,
    radius: Column,
    material: WordColumn,
    light: WordColumn,
    /// 0 flat, 1 sphere, 2 disk.
    form: WordColumn,
    has: [bool; 3],
    /// As they came.
    entries: Vec<Surface>,
}

impl Surfaces {
    pub fn new(surfaces: &[Surface]) -> Self {
        let vectors = |of: &dyn Fn(&Surface) -> Vec3| VectorColumn::new(surfaces.iter().map(of));
        let numbers = |of: &dyn Fn(&Surface) -> f32| Column::new(surfaces.iter().map(of));
        let words = |of: &dyn Fn(&Surface) -> u32| WordColumn::new(surfaces.iter().map(of));
        let edges = |surface: &Surface| match surface.form {
            Form::Flat { edge_u, edge_v, .. } => [edge_u, edge_v],
            Form::Sphere { .. } | Form::Disk { .. } => [Vec3::ZERO; 2],
        };
        let form = |surface: &Surface| match surface.form {
            Form::Flat { .. } => 0,
            Form::Sphere { .. } => 1,
            Form::Disk { .. } => 2,
        };
        Surfaces {
            corner: vectors(&|surface| match surface.form {
                Form::Flat { corner, .. } => corner,
                Form::Sphere { center, .. } | Form::Disk { center } => center,
            }),
            edge_u: vectors(&|surface| edges(surface)[0]),
            edge_v: vectors(&|surface| edges(surface)[1]),
            dual_u: vectors(&|surface| dual(edges(surface))),
            dual_v: vectors(&|surface| dual([edges(surface)[1], edges(surface)[0]])),
            most: numbers(&|surface| if matches!(surface.form, Form::Flat { half: true, .. }) { 1.0 } else { 2.0 }),
            normal: vectors(&|surface| surface.normal),
            flatness: numbers(&|surface| match surface.form {
                Form::Flat { flatness, .. } => flatness,
                Form::Sphere { .. } | Form::Disk { .. } => 0.0,
            }),
            radius: numbers(&|surface| match surface.form {
                Form::Sphere { radius, .. } => radius,
                Form::Flat { .. } | Form::Disk { .. } => 0.0,
            }),
            material: words(&|surface| surface.material),
            light: words(&|surface| surface.light),
            form: words(&form),
            has: [0, 1, 2].map(|kind| surfaces.iter().any(|surface| form(surface) == kind)),
            entries: surfaces.to_vec(),
        }
    }

    /// All, in the order of their ids.
    pub fn entries(&self) -> &[Surface] {
        &self.entries
    }

    /// What the rays have met that have these hits.
    #[inline(always)]
    pub fn intersections<F: Float>(&self, rays: &Rays<F>, hits: &Hits<F>) -> Intersections<F> {
        let &Hits { t, primitive: id, .. } = hits;
        let [has_flat, has_spheres, has_disks] = self.has;
        let (corner, normal) = (self.corner.look_up(id), self.normal.look_up(id));
        let near = rays.origin + rays.direction * t;
        let form = id.look_up_word(&self.form);
        let mut point = SurfacePoints { position: corner, error: corner, normal, radius: F::splat(0.0) };
        let mut barycentrics = [F::splat(0.0); 3];
        if has_flat {
            let (on_flat, [u, v]) = self.on_flat(id, near, corner, normal);
            (point, barycentrics) = (on_flat, [F::splat(1.0) - u - v, u, v]);
        }
        if has_spheres {
            let radius = id.look_up(&self.radius);
            let met = SphereLanes { center: corner, radius }.meeting(rays, t);
            let on_sphere = SurfacePoints::on_sphere(corner, radius, met);
            point = SurfacePoints::select(form.eq(F::U::splat(1)), on_sphere, point);
        }
        if has_disks {
            let on_disk = SurfacePoints::on_disk(corner, near, normal);
            point = SurfacePoints::select(form.eq(F::U::splat(2)), on_disk, point);
        }
        Intersections {
            met: hits.met(),
            point,
            material: id.look_up_word(&self.material),
            light: id.look_up_word(&self.light),
            triangle: id,
            instance: F::U::splat(NO_INSTANCE),
            barycentrics,
        }
    }

    /// The point of the shape that is nearest to where the ray met its plane. From places along its edges, far more
    /// exact than `origin + t * direction`: whatever these are, it lies on the shape. And those places.
    #[inline(always)]
    fn on_flat<F: Float>(
        &self,
        id: F::U,
        near: Vector<F>,
        corner: Vector<F>,
        normal: Vector<F>,
    ) -> (SurfacePoints<F>, [F; 2]) {
        let (zero, one) = (F::splat(0.0), F::splat(1.0));
        let from_corner = near - corner;
        let u = from_corner.dot(self.dual_u.look_up(id)).clamp(zero, one);
        let v = from_corner.dot(self.dual_v.look_up(id)).clamp(zero, one);
        let (sum, most) = (u + v, id.look_up(&self.most));
        let beyond = sum.gt(most);
        let (u, v) = if beyond.any() {
            let share = F::select(beyond, most / sum, one);
            (u * share, v * share)
        } else {
            (u, v)
        };
        let point = SurfacePoints::on_plane(corner, self.edge_u.look_up(id) * u, self.edge_v.look_up(id) * v, normal);
        let flatness = Vector::along_all(id.look_up(&self.flatness));
        (SurfacePoints { error: point.error + flatness, ..point }, [u, v])
    }
}

/// The vector `w` in the plane of two edges with `w . u` = 1 and `w . v` = 0.
fn dual([u, v]: [Vec3; 2]) -> Vec3 {
    let [u, v]: [DVec3; 2] = [u, v].map(|edge| edge.as_dvec3());
    let across = u - v * (u.dot(v) / v.length_squared());
    let dual = across / across.length_squared();
    if dual.is_finite() { dual.as_vec3() } else { Vec3::ZERO }
}
