//! Compute shaders over lists: one bind group of what a shader reads and writes, a thread for each item.

use crate::wgsl::Composed;
use crate::{Gpu, GpuError};
use wgpu::{BindingResource, BindingType, BufferBindingType};

/// What stands at a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Binding {
    /// A storage buffer that is read.
    Read,
    /// A storage buffer that is written.
    Written,
    /// A uniform buffer, which all threads read alike.
    Uniform,
    /// Layers of a texture of words.
    WordTexture,
}

/// A shader as a pipeline.
#[derive(Debug)]
pub struct Compute {
    what: String,
    pipeline: wgpu::ComputePipeline,
    /// Of the shader's own group.
    layout: wgpu::BindGroupLayout,
    /// In a workgroup, along x, y and z.
    threads: [u32; 3],
}

impl Compute {
    /// The pipeline of an entry point. Group 0 is `shared` with others if there is such a layout; the shader's own
    /// group comes next, with bindings 0, 1, 2 ...
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the device can't take it.
    pub fn new(
        gpu: &Gpu,
        shader: &Composed,
        entry_point: &str,
        shared: Option<&wgpu::BindGroupLayout>,
        bindings: &[Binding],
        constants: &[(&str, f64)],
    ) -> Result<Compute, GpuError> {
        let what = format!("{entry_point} of shaders/{}", shader.name);
        let entry = shader.module.entry_points.iter().find(|entry| entry.name == entry_point);
        let threads = entry.map_or([1; 3], |entry| entry.workgroup_size);
        let module = shader.create(gpu)?;
        let (pipeline, layout) = gpu.checked(&what, || {
            let entries: Vec<_> = (0..).zip(bindings).map(layout_entry).collect();
            let own = wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries };
            let own = gpu.device.create_bind_group_layout(&own);
            let groups: Vec<_> = shared.into_iter().chain([&own]).map(Some).collect();
            let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: None,
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
            let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(&what),
                layout: Some(&layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
                cache: None,
            });
            (pipeline, own)
        })?;
        Ok(Compute { what, pipeline, layout, threads })
    }

    /// Runs it over `items`, with the shared group if it has one, and what stands at its own bindings.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the device objects.
    pub fn run(
        &self,
        gpu: &Gpu,
        shared: Option<&wgpu::BindGroup>,
        resources: &[BindingResource<'_>],
        items: usize,
    ) -> Result<(), GpuError> {
        gpu.checked(&self.what, || {
            let own = self.bind(gpu, resources);
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            self.record(&mut pass, shared, &own, [items as u32, 1, 1]);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        })
    }

    /// What stands at its own bindings, 0, 1, 2 ...; within [`Gpu::checked`].
    pub fn bind(&self, gpu: &Gpu, resources: &[BindingResource<'_>]) -> wgpu::BindGroup {
        let bound = (0..).zip(resources);
        let entries: Vec<_> =
            bound.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() }).collect();
        let own = wgpu::BindGroupDescriptor { label: Some(&self.what), layout: &self.layout, entries: &entries };
        gpu.device.create_bind_group(&own)
    }

    /// Adds to a pass that it runs over so many items along x, y and z: for several shaders, one after the other, in
    /// one submission. Within [`Gpu::checked`].
    pub fn record(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        shared: Option<&wgpu::BindGroup>,
        own: &wgpu::BindGroup,
        items: [u32; 3],
    ) {
        pass.set_pipeline(&self.pipeline);
        for (index, group) in (0..).zip(shared.into_iter().chain([own])) {
            pass.set_bind_group(index, group, &[]);
        }
        let [x, y, z] = std::array::from_fn(|axis| items[axis].div_ceil(self.threads[axis].max(1)));
        pass.dispatch_workgroups(x, y, z);
    }
}

fn layout_entry((binding, kind): (u32, &Binding)) -> wgpu::BindGroupLayoutEntry {
    let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let ty = match kind {
        Binding::Read => buffer(BufferBindingType::Storage { read_only: true }),
        Binding::Written => buffer(BufferBindingType::Storage { read_only: false }),
        Binding::Uniform => buffer(BufferBindingType::Uniform),
        Binding::WordTexture => BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        },
    };
    wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
}
