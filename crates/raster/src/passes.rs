//! The frame on the device: uniforms are written once, then one command buffer draws shadow map, cube maps and picture.
//! A cube map is drawn without its glass, and without the shadow of it; so each has its own shadow map before it, in
//! the same texture.

use crate::bounce;
use crate::casting::Casting;
use crate::caustic;
use crate::gpu_data::Object;
use crate::groups::Groups;
use crate::knobs::ShadowFilter;
use crate::looks::Looks;
use crate::pipelines::{Into, Pipelines};
use crate::plan::Plan;
use crate::repair::{Repair, Repairs};
use crate::settings::{Fake, Show};
use crate::targets::{Layers, Targets};
use crate::uniforms::{Uniforms, offset};
use crate::variant::Variant;
use crate::world::World;
use gpu::Gpu;
use scene::Vec3;
use scene::glam::Vec4;
use wgpu::{BindGroup, BindGroupLayout, BindingResource, CommandEncoder, RenderPass, RenderPipeline, TextureView};

/// Distance of the sky in cube maps, the largest half float; as `shaders/raster/repair/surroundings.wgsl` has it.
pub const NOWHERE: f32 = 65504.0;

/// All that shadow map and cube maps depend on, and where they are drawn: the camera is not part of it.
#[derive(Debug, PartialEq)]
pub struct Maps {
    numbers: Vec<u8>,
    casting: Vec<Casting>,
    variants: Vec<Option<Variant>>,
    materials: Vec<usize>,
    looks: Vec<BindGroup>,
    cube_maps: Vec<usize>,
    sky: Vec3,
    fake: Fake,
    repairs: Repairs,
    filter: ShadowFilter,
    corners: wgpu::Buffer,
    shadow_map: TextureView,
    patches: [TextureView; 2],
    cubes: Vec<TextureView>,
}

impl Maps {
    /// The maps of a picture; `None` if the frame does not draw them all.
    pub fn of(plan: &Plan, things: Things<'_>, targets: Targets<'_>) -> Option<Maps> {
        let views = &plan.views[..plan.picture_views.start];
        // no map sees through glass, so how far that bends is not part of it
        let unbent: Vec<Object> = plan.objects.iter().map(|o| Object { refraction_ratio: 0.0, ..*o }).collect();
        let numbers = [bytemuck::cast_slice(views), bytemuck::bytes_of(&plan.lights), bytemuck::cast_slice(&unbent)];
        (plan.show == Show::Picture).then(|| Maps {
            numbers: numbers.concat(),
            casting: plan.casting.clone(),
            variants: plan.variants.clone(),
            materials: plan.materials.clone(),
            looks: things.looks.groups().to_vec(),
            cube_maps: plan.cube_maps.clone(),
            sky: plan.sky,
            fake: plan.fake,
            repairs: plan.repairs,
            filter: plan.filter,
            corners: things.world.small_corners().clone(),
            shadow_map: targets.shadow.map.all.clone(),
            patches: [targets.bounce.patches[0].all.clone(), targets.bounce.harmonics[0].clone()],
            cubes: targets.cubes.each.iter().map(|cube| cube.all.clone()).collect(),
        })
    }
}

/// What is drawn, on the device.
#[derive(Debug, Clone, Copy)]
pub struct Things<'a> {
    /// The triangles that are drawn.
    pub world: &'a World,
    /// The pictures on their surfaces.
    pub looks: &'a Looks,
}

/// Draws shape after shape into a pass, and sets what differs from the one before alone.
#[derive(Debug)]
pub struct Drawing<'a, 'p> {
    pass: &'a mut RenderPass<'p>,
    things: Things<'a>,
    corners: Option<usize>,
    pipeline: Option<&'a RenderPipeline>,
    look: Option<&'a BindGroup>,
}

impl<'a, 'p> Drawing<'a, 'p> {
    /// Nothing is set but the pass' group 0.
    pub fn new(pass: &'a mut RenderPass<'p>, things: Things<'a>) -> Self {
        Drawing { pass, things, corners: None, pipeline: None, look: None }
    }

    /// A shape by a pipeline, with the uniforms of its number in `objects`; nothing without a pipeline.
    pub fn draw(
        &mut self,
        (shape, material): (usize, usize),
        pipeline: Option<&'a RenderPipeline>,
        objects: &'a BindGroup,
    ) {
        let Some(pipeline) = pipeline else { return };
        if self.pipeline.replace(pipeline) != Some(pipeline) {
            self.pass.set_pipeline(pipeline);
        }
        let look = self.things.looks.of(material);
        if self.look.replace(look) != Some(look) {
            self.pass.set_bind_group(2, look, &[]);
        }
        self.pass.set_bind_group(1, objects, &[offset(shape)]);
        self.things.world.draw(self.pass, shape, &mut self.corners);
    }
}

/// Submits a frame, or nothing before its pipelines are prepared. `maps_stay` says that shadow map and cube maps are
/// still those of the last one.
pub fn draw(
    gpu: &Gpu,
    pipelines: &Pipelines,
    uniforms: &Uniforms,
    things: Things<'_>,
    targets: Targets<'_>,
    plan: &Plan,
    maps_stay: bool,
) {
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("the fake") });
    let frame = Frame { pipelines, things, targets, plan, groups: Groups::new(gpu, pipelines, uniforms, targets) };
    let cube_maps = match plan.show {
        Show::Picture => plan.cube_maps.len(),
        Show::CubeFaces => 1,
        Show::ShadowMap | Show::Feature(_) => 0,
    };
    if !maps_stay {
        for layer in 0..plan.receivers.len() {
            frame.receivers(&mut encoder, layer);
            frame.caustic(&mut encoder, layer);
        }
        let own_shadow = plan.repairs.has(Repair::OwnShadow);
        // once more where maps show one another, the first of which has seen the others empty
        let rounds = if plan.repairs.has(Repair::Mirrors) && cube_maps > 1 { 2 } else { 1 };
        if plan.repairs.has(Repair::Mirrors) {
            (0..cube_maps).for_each(|index| frame.clear_cube_map(&mut encoder, index));
        }
        for (index, &glass) in plan.cube_maps.iter().enumerate().take(cube_maps).cycle().take(rounds * cube_maps) {
            frame.shadow_map(&mut encoder, Some(glass).filter(|_| !own_shadow));
            frame.cube_map(&mut encoder, index, glass);
        }
        if plan.show != Show::CubeFaces {
            frame.shadow_map(&mut encoder, None);
        }
        frame.patches(gpu, &mut encoder);
    }
    if plan.show == Show::Picture {
        frame.gather(gpu, &mut encoder);
        frame.picture(&mut encoder);
        if plan.fake == Fake::Fair {
            resolve(gpu, &mut encoder, pipelines, (&targets.picture.passes, &targets.picture.resolved));
        }
    }
    gpu.queue.submit([encoder.finish()]);
}

/// One `T` of a buffer that has many.
pub fn sized<T>(buffer: &wgpu::Buffer) -> BindingResource<'_> {
    let size = std::num::NonZeroU64::new(size_of::<T>() as u64);
    BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
}

/// A group of bindings 0, 1, 2 ...
pub fn bind(gpu: &Gpu, layout: &BindGroupLayout, resources: &[BindingResource<'_>]) -> BindGroup {
    let numbered = (0..).zip(resources);
    let entries: Vec<_> =
        numbered.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() }).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

struct Frame<'a> {
    pipelines: &'a Pipelines,
    things: Things<'a>,
    targets: Targets<'a>,
    plan: &'a Plan,
    groups: Groups,
}

impl Frame<'_> {
    fn shadow_map(&self, encoder: &mut CommandEncoder, without: Option<usize>) {
        for layer in self.plan.shadow_layers.clone() {
            let target = Target {
                colour: &self.targets.shadow.map.each[layer],
                resolved: None,
                depth: Some(&self.targets.shadow.depth),
                // nothing is farther
                clear: bits(Vec3::ONE),
            };
            let mut pass = target.begin(encoder);
            pass.set_bind_group(0, &self.groups.shadow, &[offset(layer)]);
            let mut drawing = Drawing::new(&mut pass, self.things);
            for (shape, variant) in self.plan.drawn(without) {
                let pipeline = self.pipelines.casting(self.plan.casting[shape], variant);
                drawing.draw((shape, self.plan.materials[shape]), pipeline, &self.groups.object);
            }
        }
    }

    /// What the sun sees behind a sphere of glass.
    fn receivers(&self, encoder: &mut CommandEncoder, layer: usize) {
        let caustics = self.targets.caustics;
        let target = Target {
            colour: &caustics.receivers.each[layer],
            resolved: None,
            depth: Some(&caustics.depth),
            clear: bits(Vec3::ONE),
        };
        let mut pass = target.begin(encoder);
        pass.set_bind_group(0, &self.groups.shadow, &[offset(self.plan.receivers.start + layer)]);
        let mut drawing = Drawing::new(&mut pass, self.things);
        // what casts no shadow receives one
        for (shape, variant) in self.plan.drawn(None).filter(|(_, variant)| !variant.glass) {
            let pipeline = self.pipelines.casting(Casting::BothSides, variant);
            drawing.draw((shape, self.plan.materials[shape]), pipeline, &self.groups.object);
        }
    }

    fn caustic(&self, encoder: &mut CommandEncoder, layer: usize) {
        let Some(pipeline) = &self.pipelines.caustic else { return };
        let view = offset(self.plan.receivers.start + layer);
        caustic::draw(encoder, pipeline, (&self.groups.receivers, view), self.targets.caustics, layer);
    }

    /// What the lights see, as patches that send light on, or what probes see.
    fn patches(&self, gpu: &Gpu, encoder: &mut CommandEncoder) {
        let Some(pipelines) = &self.pipelines.bounce else { return };
        let (plan, things, targets, bound) = (self.plan, self.things, self.targets.bounce, self.bound());
        if let Some(bounce) = &plan.bounce {
            bounce::draw_patches(encoder, (plan, bounce), pipelines, things, targets, bound);
        }
        if let Some(views) = plan.probes.clone() {
            bounce::draw_probes(gpu, encoder, (plan, views), pipelines, things, targets, bound);
        }
    }

    /// What those send to what the picture shows.
    fn gather(&self, gpu: &Gpu, encoder: &mut CommandEncoder) {
        let Some(pipelines) = &self.pipelines.bounce else { return };
        let (plan, things, targets, bound) = (self.plan, self.things, self.targets.bounce, self.bound());
        if let Some(bounce) = &plan.bounce {
            bounce::gather(gpu, encoder, (plan, bounce), pipelines, things, targets, bound);
        }
        if plan.probes.is_some() {
            bounce::gather_from_probes(gpu, encoder, plan, pipelines, things, targets, bound);
        }
    }

    fn bound(&self) -> bounce::Bound<'_> {
        let Groups { frame, gathered, without_cube_map: object, .. } = &self.groups;
        bounce::Bound { frame, gathered, object }
    }

    fn clear_cube_map(&self, encoder: &mut CommandEncoder, index: usize) {
        for face in &self.targets.cubes.each[index].each {
            let target = Target { colour: face, resolved: None, depth: None, clear: self.sky() };
            drop(target.begin(encoder));
        }
    }

    fn cube_map(&self, encoder: &mut CommandEncoder, index: usize, glass: usize) {
        for layer in 0..6 {
            let target = Target {
                colour: &self.targets.cubes.each[index].each[layer],
                resolved: None,
                depth: Some(&self.targets.cubes.depth),
                clear: self.sky(),
            };
            self.shapes(&mut target.begin(encoder), self.plan.cube_view(index, layer), Some(glass));
        }
    }

    fn picture(&self, encoder: &mut CommandEncoder) {
        let multisampled = self.plan.fake == Fake::AsTaught;
        for (pass, view) in self.plan.picture_views.clone().enumerate() {
            let target = Target {
                colour: &self.targets.picture.passes.each[pass],
                resolved: multisampled.then_some(&self.targets.picture.resolved),
                depth: Some(&self.targets.picture.depth),
                clear: self.sky_of_picture(),
            };
            self.shapes(&mut target.begin(encoder), view, None);
        }
    }

    /// Every shape but `without`, as `view` sees it. In a cube map no glass has a cube map of its own, least of all the
    /// one that is being drawn; where mirrors are repaired the others have the one that there is by then.
    fn shapes(&self, pass: &mut RenderPass<'_>, view: usize, without: Option<usize>) {
        let into = if without.is_some() { Into::CubeMap } else { Into::Picture };
        let frame = if without.is_some() { &self.groups.frame } else { &self.groups.picture };
        pass.set_bind_group(0, frame, &[offset(view)]);
        let mut drawing = Drawing::new(pass, self.things);
        let others = self.plan.repairs.has(Repair::Mirrors);
        for (shape, variant) in self.plan.drawn(without) {
            let cube_map =
                self.plan.cube_maps.iter().position(|&glass| glass == shape).filter(|_| without.is_none() || others);
            let group = cube_map.map_or(&self.groups.without_cube_map, |index| &self.groups.with_cube_map[index]);
            let pipeline = self.pipelines.forward(self.plan.choice(), into, variant);
            drawing.draw((shape, self.plan.materials[shape]), pipeline, group);
        }
    }

    /// The sky of a cube map, which is nowhere where it keeps distances.
    fn sky(&self) -> wgpu::Color {
        let [r, g, b] = self.plan.sky.to_array().map(f64::from);
        let keeps_distances = self.plan.repairs.has_any(&[Repair::Surroundings, Repair::Sky]);
        wgpu::Color { r, g, b, a: if keeps_distances { f64::from(NOWHERE) } else { 1.0 } }
    }

    fn sky_of_picture(&self) -> wgpu::Color {
        match self.plan.fake {
            Fake::AsTaught => self.sky(),
            Fake::Fair => bits(self.plan.sky),
        }
    }
}

/// The mean of all passes.
pub fn resolve(
    gpu: &Gpu,
    encoder: &mut CommandEncoder,
    pipelines: &Pipelines,
    (passes, resolved): (&Layers, &TextureView),
) {
    let target = Target { colour: resolved, resolved: None, depth: None, clear: wgpu::Color::BLACK };
    let group = bind(gpu, &pipelines.resolve_layout, &[BindingResource::TextureView(&passes.all)]);
    let mut pass = target.begin(encoder);
    pass.set_pipeline(&pipelines.resolve);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
}

fn bits(colour: Vec3) -> wgpu::Color {
    bits_of(colour.extend(1.0))
}

/// The colour that clears a target of f32 bits.
pub fn bits_of(colour: Vec4) -> wgpu::Color {
    let [r, g, b, a] = colour.to_array().map(|channel| f64::from(channel.to_bits()));
    wgpu::Color { r, g, b, a }
}

/// What one pass draws into.
struct Target<'a> {
    colour: &'a TextureView,
    resolved: Option<&'a TextureView>,
    depth: Option<&'a TextureView>,
    clear: wgpu::Color,
}

impl Target<'_> {
    fn begin<'e>(&self, encoder: &'e mut CommandEncoder) -> RenderPass<'e> {
        let store = if self.resolved.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
        let depth = self.depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        });
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: self.colour,
                depth_slice: None,
                resolve_target: self.resolved,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(self.clear), store },
            })],
            depth_stencil_attachment: depth,
            ..wgpu::RenderPassDescriptor::default()
        })
    }
}
