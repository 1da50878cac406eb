//! Rays by themselves: what each of a list meets on the device.
//!
//! Mirrors of the structs in `shaders/pathtrace/drive/rays.wgsl`.

use super::GpuTraceError;
use crate::gpu_tracer::GpuTracer;
use crate::intersect::{Ray, SurfacePoint};
use crate::shaders;
use bytemuck::{Pod, Zeroable};
use gpu::compute::{Binding, Compute};
use gpu::wgpu::BufferUsages;
use scene::Vec3;

/// `RayQuery` in `shaders/pathtrace/drive/rays.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RayQuery {
    /// Where it starts.
    pub origin: Vec3,
    /// Hits must lie before this.
    pub tmax: f32,
    /// Where it goes.
    pub direction: Vec3,
    /// Padding.
    pub unused: u32,
}

/// `RayAnswer` in `shaders/pathtrace/drive/rays.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RayAnswer {
    /// Where the ray meets the nearest surface.
    pub position: Vec3,
    /// Distance in lengths of the ray's direction, 0 where nothing is met.
    pub t: f32,
    /// Bound on the rounding error of the position.
    pub error: Vec3,
    /// Index into the scene's materials.
    pub material: u32,
    /// Unit outward normal.
    pub normal: Vec3,
    /// 1 if anything at all is met, asked as shadow rays ask.
    pub occluded: u32,
    /// Unit direction in which the ray goes on behind a dielectric surface; zero where there is none.
    pub refracted: Vec3,
    /// Share of unpolarised light that a dielectric surface reflects, 1 beyond the critical angle; 0 of other surfaces.
    pub reflectance: f32,
    /// Of a sphere that is met; 0 if the surface is flat.
    pub radius: f32,
    /// Fills the struct up to a multiple of 16 bytes, as WGSL has it.
    pub unused: [u32; 3],
}

impl RayAnswer {
    /// Where the nearest surface is met, if any is.
    pub fn point(&self) -> Option<SurfacePoint> {
        let Self { position, error, normal, radius, .. } = *self;
        (self.t > 0.0).then_some(SurfacePoint { position, error, normal, radius })
    }

    /// The ray that goes on behind a dielectric surface, if one is met and refracts it.
    pub fn behind(&self) -> Option<Ray> {
        let point = self.point().filter(|_| self.refracted != Vec3::ZERO)?;
        Some(Ray::new(point.leaving_towards(self.refracted), self.refracted))
    }
}

/// Rays in one dispatch.
const MOST_RAYS: usize = 1 << 16;

impl GpuTracer {
    /// What each ray meets. Waits for the answers.
    ///
    /// # Errors
    /// [`GpuTraceError`] if the device fails.
    pub fn meet(&self, rays: &[Ray]) -> Result<Vec<RayAnswer>, GpuTraceError> {
        let shader = shaders::compose("pathtrace/drive/rays.wgsl")?;
        let bindings = [Binding::Read, Binding::Written];
        let (scene, constants) = (self.scene_group().0, self.pipelines.needs().shape_constants());
        let compute = Compute::new(self.gpu(), &shader, "trace", Some(scene), &bindings, &constants)?;
        let mut answers = Vec::with_capacity(rays.len());
        for rays in rays.chunks(MOST_RAYS) {
            answers.extend(self.meet_some(&compute, rays)?);
        }
        Ok(answers)
    }

    fn meet_some(&self, compute: &Compute, rays: &[Ray]) -> Result<Vec<RayAnswer>, GpuTraceError> {
        let gpu = self.gpu();
        // shaders may take infinity away
        let query = |ray: &Ray| RayQuery {
            origin: ray.origin,
            tmax: ray.tmax.min(f32::MAX),
            direction: ray.direction,
            unused: 0,
        };
        let queries: Vec<RayQuery> = rays.iter().map(query).collect();
        let empty = vec![RayAnswer::zeroed(); rays.len()];
        let queries = gpu.buffer("rays", &queries, BufferUsages::STORAGE)?;
        let answers = gpu.buffer("what rays meet", &empty, BufferUsages::STORAGE | BufferUsages::COPY_SRC)?;
        let bound = [queries.as_entire_binding(), answers.as_entire_binding()];
        compute.run(gpu, Some(self.scene_group().1), &bound, rays.len())?;
        Ok(bytemuck::pod_collect_to_vec(&gpu.read_buffer("what rays meet", &answers)?))
    }
}
