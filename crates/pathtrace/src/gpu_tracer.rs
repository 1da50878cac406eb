//! A scene made ready on a device, the counterpart of [`crate::Tracer`].
//!
//! A [`GpuTracer`] adds samples to a [`GpuFilm`], which sums them where they are made and is read when someone looks;
//! [`GpuTracer::render`] does both for a [`film::Film`]. Nothing here panics when the device fails: every fault is a
//! [`GpuTraceError`], and the processor's [`crate::Tracer`] can take over.

use crate::caster::Casters;
use crate::drive::gpu::dispatch::Dispatcher;
use crate::drive::gpu::film_data::RenderParams;
use crate::drive::gpu::instance_data::{Instances, Parted};
use crate::drive::gpu::mesh_data::MeshData;
use crate::drive::gpu::photon_maps::{PhotonMaps, PhotonWork};
use crate::drive::gpu::photon_sources::{PhotonScene, PhotonSources};
use crate::drive::gpu::pipelines::{PipelineKey, Pipelines, SceneNeeds};
use crate::drive::gpu::shape_data::{FewShape, MOST_SHAPES, Shapes};
use crate::drive::gpu::slices::Slices;
use crate::drive::gpu::tables::Tables;
use crate::drive::gpu::timing::{BUDGET_SECONDS, Pace, Stopwatch};
use crate::drive::gpu::{GpuFilm, GpuTraceError, behind_lights, environment_data, scene_data};
use crate::features::{self, gpu::FeatureWork};
use crate::integrator::Integrator;
use crate::integrator::photon::PhotonSettings;
use crate::intersect::baking::made_ready;
use crate::light::Lights;
use crate::stats::Stats;
use bytemuck::Zeroable;
use film::Film;
use gpu::{Gpu, GpuError, wgpu};
use scene::camera::PictureFrame;
use scene::{Camera, Scene};
use std::sync::Arc;
use wgpu::BufferUsages;

/// A scene on a device, ready for rays. Camera and settings come with each call.
#[derive(Debug)]
pub struct GpuTracer {
    gpu: Gpu,
    pub(crate) pipelines: Pipelines,
    scene: wgpu::BindGroup,
    /// Held, so that other tracers find them.
    tables: Arc<Tables>,
    leaves: Leaves,
    /// The scene on the processor, its shapes held apart.
    here: Scene,
    /// Once photons were asked for.
    photon_scene: Option<PhotonScene>,
    /// Once photons were asked for.
    pub(crate) photon_maps: Option<PhotonMaps>,
    /// In samples of pixels.
    feature_pace: Pace,
    stopwatch: Stopwatch,
    paces: Vec<(PipelineKey, Effort, Pace)>,
    budget: f64,
    /// What dispatches have taken.
    seconds: f64,
}

impl GpuTracer {
    /// Builds the acceleration structure and the list of lights, and uploads them.
    ///
    /// # Errors
    /// [`GpuTraceError`] if the scene is too large for the device, or the device too small for any.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, GpuTraceError> {
        Self::leaving_out(gpu, scene, Leaves::default())
    }

    /// As [`GpuTracer::new`], with code for everything that any scene can ask for: to measure what leaving it out
    /// saves.
    ///
    /// # Errors
    /// As [`GpuTracer::new`].
    pub fn with_everything(gpu: &Gpu, scene: &Scene) -> Result<Self, GpuTraceError> {
        Self::leaving_out(gpu, scene, Leaves { nothing_out: true, ..Leaves::default() })
    }

    /// As [`GpuTracer::new`], through a tree even if there are few shapes: to measure what doing without saves.
    ///
    /// # Errors
    /// As [`GpuTracer::new`].
    pub fn through_a_tree(gpu: &Gpu, scene: &Scene) -> Result<Self, GpuTraceError> {
        Self::leaving_out(gpu, scene, Leaves { always_a_tree: true, ..Leaves::default() })
    }

    fn leaving_out(gpu: &Gpu, scene: &Scene, leaves: Leaves) -> Result<Self, GpuTraceError> {
        let scene = &*made_ready(scene);
        let made = Made::of(scene, leaves)?;
        let pipelines = Pipelines::new(gpu, made.needs)?;
        let tables = made.tables(gpu);
        Ok(GpuTracer {
            scene: made.upload(gpu, &pipelines.scene_layout, scene, &tables)?,
            pipelines,
            tables,
            leaves,
            here: scene.clone(),
            photon_scene: None,
            photon_maps: None,
            feature_pace: Pace::default(),
            stopwatch: Stopwatch::new(gpu),
            paces: Vec::new(),
            budget: BUDGET_SECONDS,
            seconds: 0.0,
            gpu: gpu.clone(),
        })
    }

    /// Takes another scene. What is compiled stays where that needs nothing else: while a slider moves, say.
    ///
    /// # Errors
    /// As [`GpuTracer::new`]; the scene before is then still there.
    pub fn set_scene(&mut self, scene: &Scene) -> Result<(), GpuTraceError> {
        let scene = &*made_ready(scene);
        let made = Made::of(scene, self.leaves)?;
        let tables = made.tables(&self.gpu);
        if made.needs != self.pipelines.needs() {
            let pipelines = Pipelines::new(&self.gpu, made.needs)?;
            self.scene = made.upload(&self.gpu, &pipelines.scene_layout, scene, &tables)?;
            (self.pipelines, self.paces, self.photon_maps) = (pipelines, Vec::new(), None);
            self.feature_pace = Pace::default();
        } else {
            self.scene = made.upload(&self.gpu, &self.pipelines.scene_layout, scene, &tables)?;
            self.paces.iter_mut().for_each(|(.., pace)| pace.doubt());
            self.photon_maps.iter_mut().for_each(PhotonMaps::forget);
            self.feature_pace.doubt();
        }
        (self.here, self.photon_scene, self.tables) = (scene.clone(), None, tables);
        Ok(())
    }

    /// The device that the scene is on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Layout and contents of bind group 0, the scene, for shaders that import `pathtrace/scene.wgsl`.
    pub fn scene_group(&self) -> (&wgpu::BindGroupLayout, &wgpu::BindGroup) {
        (&self.pipelines.scene_layout, &self.scene)
    }

    /// Sets how long a dispatch may take, in seconds, > 0; a twentieth at first. What shares the device, such as a
    /// window, waits about that long, and so does `stop`.
    pub fn set_budget(&mut self, seconds: f64) {
        self.budget = seconds;
    }

    /// Whether rays can be traced like this at once, without compiling anything first: that takes a software device
    /// seconds.
    pub fn has_compiled(&self, integrator: &Integrator) -> bool {
        let key = integrator.told_in(&self.here).pipeline_key(self.pipelines.needs().everything());
        let photons = integrator
            .gathers()
            .is_none_or(|settings| self.photon_maps.is_some() && self.pipelines.has_compiled(&settings.walk_key()));
        photons && key.is_ok_and(|key| self.pipelines.has_compiled(&key))
    }

    /// Whether all dispatches so far were timed by the device's own clock. Some are not even if it has one: those of
    /// which it says far less than the wall's clock allows.
    pub fn has_a_clock(&self) -> bool {
        self.stopwatch.is_exact()
    }

    /// Seconds that dispatches have taken since the last call, see [`GpuTracer::has_a_clock`]: tracing alone, without
    /// compiling and without films on their way.
    pub fn take_seconds(&mut self) -> f64 {
        std::mem::take(&mut self.seconds)
    }

    /// A film on the device that goes on from `film`.
    ///
    /// # Errors
    /// [`GpuTraceError::Gpu`] if the device can't hold it.
    pub fn film(&self, film: Film) -> Result<GpuFilm, GpuTraceError> {
        GpuFilm::new(&self.gpu, &self.pipelines.film_layout, film)
    }

    /// Adds to a film on the device until each of its pixels has `until` samples. `stop` is asked between dispatches;
    /// once it says so the call returns, and pixels hold whole samples, but not all equally many. See
    /// [`GpuTracer::set_budget`] for how long a dispatch takes.
    ///
    /// # Errors
    /// [`GpuTraceError`] if the device fails; what it had done is then lost.
    pub fn accumulate(
        &mut self,
        film: &mut GpuFilm,
        camera: &Camera,
        integrator: &Integrator,
        until: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<(), GpuTraceError> {
        let Some(settings) = integrator.gathers() else {
            return self.add_samples(film, camera, integrator, None, until, stop);
        };
        let photon_scene = self.photon_scene.get_or_insert_with(|| PhotonScene::new(&self.here));
        let sources = photon_scene.sources(&frame(film, camera), settings.radius);
        for number in film.samples_done..until {
            let Some(map) = self.map_photons(film, &sources, settings, number, stop)? else { break };
            self.add_samples(film, camera, integrator, Some(&map), number + 1, stop)?;
            if film.samples_done <= number {
                break;
            }
        }
        Ok(())
    }

    /// The photons of a pass; `None` where it was stopped. One that is made again is the same.
    fn map_photons(
        &mut self,
        film: &mut GpuFilm,
        sources: &PhotonSources,
        settings: &PhotonSettings,
        number: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<Option<wgpu::BindGroup>, GpuTraceError> {
        let walk = self.pipelines.prepare(&self.gpu, &settings.walk_key())?;
        let maps = match &mut self.photon_maps {
            Some(maps) => maps,
            none => none.insert(PhotonMaps::new(&self.gpu)?),
        };
        let (gpu, budget, what) = (&self.gpu, self.budget, "a part of a pass of photons");
        let slices = Slices { gpu, stopwatch: &mut self.stopwatch, budget, seconds: &mut self.seconds, what };
        let layouts = [&self.pipelines.photon_layout, &self.pipelines.map_layout];
        let scene = &self.scene;
        let mut work = PhotonWork { walk: &walk, scene, layouts, sources, settings, number, slices };
        let made = maps.make(&mut work, stop)?;
        Ok(made.map(|(map, took)| {
            film.count(took);
            map
        }))
    }

    /// Brings each pixel to `until` samples, of which all gather from one map if there is one.
    fn add_samples(
        &mut self,
        film: &mut GpuFilm,
        camera: &Camera,
        integrator: &Integrator,
        map: Option<&wgpu::BindGroup>,
        until: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<(), GpuTraceError> {
        let key = integrator.told_in(&self.here).pipeline_key(self.pipelines.needs().everything());
        let key = key.map_err(GpuTraceError::ForTheProcessor)?;
        let pipeline = self.pipelines.prepare(&self.gpu, &key)?;
        let params = integrator.render_params(params(film, camera), &self.here.fake);
        let effort = Effort { params: params.effort(), photons: integrator.gathers().map(PhotonSettings::effort) };
        let known = self.paces.iter().position(|(known, ..)| *known == key).unwrap_or_else(|| {
            self.paces.push((key, effort, Pace::default()));
            self.paces.len() - 1
        });
        let (_, known_effort, pace) = &mut self.paces[known];
        if *known_effort != effort {
            (*known_effort, *pace) = (effort, Pace::default());
        }
        let dispatcher = Dispatcher {
            gpu: &self.gpu,
            pipeline: &pipeline,
            scene: &self.scene,
            map,
            stopwatch: &mut self.stopwatch,
            pace,
            budget: self.budget,
            seconds: &mut self.seconds,
            in_flight: Vec::new(),
            submitted: 0,
            learning: true,
        };
        dispatcher.run(film, params, until, stop)
    }

    /// What a pass of features works with.
    pub(crate) fn feature_work(&mut self, key: &PipelineKey) -> Result<FeatureWork<'_>, GpuTraceError> {
        let pipeline = self.pipelines.prepare(&self.gpu, key)?;
        let (gpu, budget, what) = (&self.gpu, self.budget, features::gpu::WHAT);
        let slices = Slices { gpu, stopwatch: &mut self.stopwatch, budget, seconds: &mut self.seconds, what };
        let (scene, layout) = (&self.scene, &self.pipelines.feature_layout);
        Ok(FeatureWork { pipeline, scene, layout, pace: &mut self.feature_pace, slices })
    }

    /// Adds `samples` to every pixel of `film`, as [`crate::Tracer::render`] does, and waits for them.
    ///
    /// # Errors
    /// [`GpuTraceError`] if the device fails; `film` is then as it was.
    pub fn render(
        &mut self,
        film: &mut Film,
        camera: &Camera,
        integrator: &Integrator,
        samples: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<Stats, GpuTraceError> {
        let until = film.samples_per_pixel().saturating_add(samples);
        let mut on_device = self.film(film.clone())?;
        self.accumulate(&mut on_device, camera, integrator, until, stop)?;
        let (read, stats) = on_device.read(&self.gpu)?;
        *film = read;
        Ok(stats)
    }
}

fn params(film: &GpuFilm, camera: &Camera) -> RenderParams {
    RenderParams::of(&frame(film, camera), (film.width(), film.height()))
}

fn frame(film: &GpuFilm, camera: &Camera) -> PictureFrame {
    camera.frame(film.width() as f32 / film.height() as f32)
}

/// What a sample's cost depends on, beside the scene and what is seen of it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Effort {
    params: RenderParams,
    photons: Option<PhotonSettings>,
}

/// What is left out of what any scene can ask for.
#[derive(Debug, Clone, Copy, Default)]
struct Leaves {
    nothing_out: bool,
    always_a_tree: bool,
}

/// A scene made ready, before it is on a device.
struct Made {
    lights: Lights,
    casters: Casters,
    shapes: Shapes,
    mesh_data: MeshData,
    instances: Instances,
    needs: SceneNeeds,
}

impl Made {
    fn of(scene: &Scene, leaves: Leaves) -> Result<Self, GpuTraceError> {
        let lights = Lights::new(scene);
        let Parted { others, light_of_shape, instances } = Parted::new(scene, lights.light_of_shape());
        let make = if leaves.always_a_tree { Shapes::in_a_tree } else { Shapes::new };
        let shapes = make(&others, &light_of_shape)?;
        let mut shapes = if instances.is_empty() { shapes } else { shapes.among_others() };
        let needs = SceneNeeds::of(scene, &lights, shapes.kinds(), !instances.is_empty());
        let needs = if leaves.nothing_out { needs.with_everything() } else { needs };
        let mesh_data = MeshData::new(scene, &mut shapes, &lights);
        Ok(Made { lights, casters: Casters::new(scene), shapes, mesh_data, instances, needs })
    }

    fn tables(&self, gpu: &Gpu) -> Arc<Tables> {
        Tables::of(gpu, &self.instances.meshes)
    }

    fn upload(
        mut self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        tables: &Tables,
    ) -> Result<wgpu::BindGroup, GpuTraceError> {
        let tables = tables.upload(&self.instances.meshes)?;
        let mut header = scene_data::header(scene, &self.shapes, &self.lights, &self.casters, &self.mesh_data);
        self.instances.append_to(&mut self.shapes, &tables, &mut header)?;
        let Made { lights, casters, shapes, mesh_data, .. } = &self;
        let mut aims = scene_data::lights(lights, &shapes.groups, mesh_data);
        aims.extend(behind_lights::chains(casters));
        aims.extend(behind_lights::light_tree(lights));
        let mut few = [FewShape::zeroed(); MOST_SHAPES];
        few[..shapes.few.len()].copy_from_slice(&shapes.few);
        let buffers = [
            gpu.buffer("the scene", &[header], BufferUsages::UNIFORM)?,
            storage(gpu, "the tree of boxes", &shapes.nodes)?,
            storage(gpu, "the shapes", &shapes.primitives)?,
            storage(gpu, "the surfaces", &shapes.surfaces)?,
            storage(gpu, "the materials", &scene_data::materials(scene, casters))?,
            storage(gpu, "the lights", &aims)?,
            tables.buffer,
            gpu.buffer("the shapes", &few, BufferUsages::UNIFORM)?,
        ];
        let sky = scene.environment.as_deref().zip(lights.environment());
        let views = environment_data::textures(gpu, sky)?.map(|texture| texture.create_view(&Default::default()));
        let views = views.iter().map(wgpu::BindingResource::TextureView);
        let words = storage(gpu, "what meshes say of their surfaces", &mesh_data.words)?;
        let layers = wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..wgpu::TextureViewDescriptor::default()
        };
        let texels = mesh_data.texture(gpu)?.create_view(&layers);
        let resources = buffers.iter().map(wgpu::Buffer::as_entire_binding).chain(views);
        let resources = resources.chain([words.as_entire_binding(), wgpu::BindingResource::TextureView(&texels)]);
        let bound = resources.zip(0..).map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource });
        let entries: Vec<_> = bound.collect();
        let descriptor = wgpu::BindGroupDescriptor { label: Some("the scene"), layout, entries: &entries };
        Ok(gpu.checked("the scene", || gpu.device.create_bind_group(&descriptor))?)
    }
}

/// A buffer that shaders read, of at least one element.
fn storage<T: bytemuck::Pod>(gpu: &Gpu, what: &str, data: &[T]) -> Result<wgpu::Buffer, GpuError> {
    let (bytes, limit) = (size_of_val(data) as u64, gpu.device.limits().max_storage_buffer_binding_size);
    if bytes > limit {
        return Err(GpuError::TooManyBytes { what: what.to_owned(), bytes, limit });
    }
    let none = [T::zeroed()];
    gpu.buffer(what, if data.is_empty() { &none } else { data }, BufferUsages::STORAGE)
}
