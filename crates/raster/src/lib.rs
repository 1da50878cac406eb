//! The fake: what a rasteriser shows of a scene. Three passes per frame:
//!
//! 1. **shadow map** ([`lights`]): depths nearest to the sun, and to the brightest area light on the six faces of a cube;
//! 2. **cube maps** (`cube`): what surrounds each piece of glass, seen from its middle, without it and its shadow;
//! 3. **forward**: every shape, shaded with its lights' shadows; glass looks up its cube map along a direction that is
//!    refracted once.
//!
//! Two fakes share these passes. [`Fake::AsTaught`] is what three.js r115 draws in the tutorial's viewer, number for
//! number: bytes, clamped light, 4 samples a pixel in hardware; its film holds the light that those bytes emit on an
//! sRGB display. [`Fake::Fair`] is the same fake on the truth's data: linear, unclamped `f32`, sun, area light and
//! ambient light in the truth's units, the mean of 4 passes a pixel.
//!
//! What light falls on can be seen without it ([`Raster::features`]): one more pass, in place of all three.
//!
//! A picture may take its own numbers instead of the scene's ([`FakeKnobs`]), and the maps of passes 1 and 2 can be
//! looked at in place of the picture ([`Show`]).
//!
//! Near and far planes ([`planes`]) are fitted so that they cut nothing, but for those that the camera states ([`cut()`]
//! tells what they cut) and those of the cube map as taught, which go with the glass.
//!
//! What it can't do is said, not hidden: at most [`MOST_CUBE_MAPS`] pieces of glass have a cube map, others show the
//! plain sky, as does glass seen in a cube map; of several area and point lights only the one of greatest power sheds
//! light; as taught, a sun puts out all of them. Metal reflects nothing but the ambient light, and what glows by a picture is
//! seen, but lights nothing.

mod board;
mod bounce;
mod build;
mod casting;
mod caustic;
mod clearance;
mod cube;
mod cut;
mod error;
mod features;
pub mod gpu_data;
mod groups;
mod knobs;
pub mod lights;
mod looks;
pub mod maps;
mod object;
mod passes;
mod pipelines;
mod plan;
pub mod planes;
pub mod repair;
mod settings;
pub mod shaders;
pub mod shading;
mod spheres;
mod targets;
mod tessellation;
mod texture;
mod uniforms;
mod variant;
mod world;

pub use bounce::{GatherKnobs, PatchClamp};
pub use cut::{Cut, cut};
pub use error::RasterError;
pub use knobs::{FakeKnobs, RefractedAt, ShadowFilter, TextureFilter};
pub use plan::MOST_CUBE_MAPS;
pub use repair::{Repair, Repairs};
pub use settings::{Fake, RasterSettings, Shading, Show};

use film::Pixel;
use film::{Features, Film, colour};
use gpu::{Gpu, GpuError};
use looks::Looks;
use passes::{Maps, Things};
use pipelines::Pipelines;
use plan::Plan;
use scene::{Camera, Scene, Vec3};
use targets::{Colours, Kept};
use uniforms::Uniforms;
use world::World;

/// The rasteriser. It keeps pipelines, targets and geometry from frame to frame, and rebuilds only what changed.
#[derive(Debug)]
pub struct Raster {
    gpu: Gpu,
    pipelines: Pipelines,
    uniforms: Uniforms,
    world: Option<World>,
    looks: Option<Looks>,
    targets: Kept,
    /// The maps that are drawn.
    maps: Option<Maps>,
    work: Work,
}

/// What a frame took beside drawing its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Work {
    /// Pipelines were compiled: how long the frame took says little about the next one.
    pub compiled: bool,
    /// Shadow map and cube maps were there from the frame before.
    pub kept_maps: bool,
}

/// A frame that was submitted: what reads it needs both.
struct Drawn {
    plan: Plan,
    targets: targets::TargetPlan,
}

impl Raster {
    /// A rasteriser on a device.
    ///
    /// # Errors
    /// [`RasterError::Gpu`] if the device can't take the shaders.
    pub fn new(gpu: &Gpu) -> Result<Raster, RasterError> {
        let pipelines = Pipelines::new(gpu)?;
        let uniforms = Uniforms::new(gpu)?;
        let (targets, work) = (Kept::default(), Work::default());
        Ok(Raster { gpu: gpu.clone(), pipelines, uniforms, world: None, looks: None, targets, maps: None, work })
    }

    /// One frame of `scene` from `camera`: linear radiance, one sample a pixel. Waits until it is there.
    ///
    /// # Errors
    /// [`RasterError::Camera`] for a camera that sees nothing; [`RasterError::Knob`] for a number out of range;
    /// [`RasterError::NothingToShow`] for a map that the scene does not have; [`RasterError::Gpu`] if picture, maps or
    /// geometry are too large for the device, or if it fails; [`RasterError::Memory`] if the film is too large for this
    /// computer.
    pub fn render(&mut self, scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Result<Film, RasterError> {
        if let Some(feature) = settings.show.feature() {
            let &RasterSettings { width, height, .. } = settings;
            let film = self.features(scene, camera, settings)?.film(feature, 1);
            return film.ok_or(RasterError::Memory { width, height });
        }
        let drawn = self.submit(scene, camera, settings)?;
        let targets = self.targets.current(&self.gpu, &drawn.targets)?;
        if settings.show != Show::Picture {
            return maps::film(&self.gpu, targets, &drawn.plan, settings);
        }
        let bytes = self.gpu.read_texture("the picture", targets.picture.resolved.texture())?;
        resolve(&bytes, settings)
    }

    /// Draws a frame as [`Raster::render`] does and leaves it on the device. Waits until it is drawn: what a frame costs that
    /// nobody reads back.
    ///
    /// # Errors
    /// As [`Raster::render`].
    pub fn draw(&mut self, scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Result<(), RasterError> {
        self.submit(scene, camera, settings)?;
        Ok(self.gpu.wait_for_all("the picture")?)
    }

    fn submit(&mut self, scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Result<Drawn, RasterError> {
        self.check(camera, settings)?;
        let settings = &self.without_what_is_not_drawn(scene, settings);
        let scene = &settings.applied(scene);
        let plan = Plan::new(scene, camera, settings);
        maps::check(settings.show, &plan)?;
        let world = World::current(&mut self.world, &self.gpu, scene)?;
        let looks = Looks::current(&mut self.looks, &self.gpu, &self.pipelines.look_layout, scene, plan.repairs)?;
        let things = Things { world, looks };
        let target_plan = plan.target_plan(scene, settings);
        let targets = self.targets.current(&self.gpu, &target_plan)?;
        let compiled = self.pipelines.prepare(&self.gpu, &plan)?;
        self.uniforms.write(&self.gpu, &plan)?;
        // kept from frame to frame while only the camera moves; a frame that fails has drawn nothing for certain
        let maps = Maps::of(&plan, things, targets);
        let maps_stay = maps.is_some() && self.maps.take() == maps;
        self.work = Work { compiled, kept_maps: maps_stay };
        self.gpu.checked("the picture", || {
            passes::draw(&self.gpu, &self.pipelines, &self.uniforms, things, targets, &plan, maps_stay)
        })?;
        self.maps = maps;
        Ok(Drawn { plan, targets: target_plan })
    }

    /// What is seen of surfaces from `camera`, without light: of the first one, be it glass or mirror, for either fake the
    /// mean of four places in each pixel. Waits until it is there.
    ///
    /// # Errors
    /// As [`Raster::render`].
    pub fn features(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        settings: &RasterSettings,
    ) -> Result<Features, RasterError> {
        // whose samples are passes
        let settings = &RasterSettings { fake: Fake::Fair, repairs: Repairs::NONE, ..*settings };
        self.check(camera, settings)?;
        let scene = &settings.applied(scene);
        let plan = Plan::new(scene, camera, settings);
        let world = World::current(&mut self.world, &self.gpu, scene)?;
        let looks = Looks::current(&mut self.looks, &self.gpu, &self.pipelines.look_layout, scene, plan.repairs)?;
        let things = Things { world, looks };
        let targets = self.targets.of_features(&self.gpu, [settings.width, settings.height])?;
        self.work = Work { compiled: self.pipelines.prepare_features(&self.gpu, &plan)?, kept_maps: false };
        self.uniforms.write(&self.gpu, &plan)?;
        self.gpu.checked("what is seen of surfaces", || {
            features::draw(&self.gpu, &self.pipelines, &self.uniforms, things, targets, &plan)
        })?;
        features::read(&self.gpu, targets)
    }

    /// Distances in cube maps and sums of sunlight need half floats, which OpenGL's core profile does not draw. Light of a second
    /// bounce takes its time even where there is none.
    fn without_what_is_not_drawn(&self, scene: &Scene, settings: &RasterSettings) -> RasterSettings {
        let repairs = if targets::draws_half_floats(&self.gpu) {
            settings.repairs
        } else {
            settings.repairs.without(Repair::Surroundings).without(Repair::Caustics)
        };
        let gathered = [Repair::ReflectiveShadowMap, Repair::IrradianceProbes];
        let idle = gathered.into_iter().filter(|repair| (repair.row().missing_in)(scene).is_some());
        let repairs = idle.fold(repairs, Repairs::without);
        RasterSettings { repairs, ..*settings }
    }

    /// Refuses what no frame can be drawn of.
    fn check(&self, camera: &Camera, settings: &RasterSettings) -> Result<(), RasterError> {
        if let Some(why) = camera.fault() {
            return Err(RasterError::Camera(why));
        }
        if let Some(why) = settings.knobs.fault() {
            return Err(RasterError::Knob(why));
        }
        Ok(self.check_size(settings)?)
    }

    /// What the last frame took beside drawing its picture.
    pub fn work(&self) -> Work {
        self.work
    }

    /// Draws shadow map and cube maps anew with the next frame, whatever stays.
    pub fn forget_maps(&mut self) {
        self.maps = None;
    }

    /// Refuses a picture that could be drawn but not read back, before its memory is taken.
    fn check_size(&self, settings: &RasterSettings) -> Result<(), GpuError> {
        let what = "a picture";
        self.gpu.check_size(what, settings.width, settings.height)?;
        let texel = Colours::of(settings.fake, &self.gpu).picture.block_copy_size(None).unwrap_or(16);
        let row = (settings.width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(row) * u64::from(settings.height);
        let limit = self.gpu.device.limits().max_buffer_size;
        if bytes > limit { Err(GpuError::TooManyBytes { what: what.to_owned(), bytes, limit }) } else { Ok(()) }
    }
}

fn resolve(bytes: &[u8], settings: &RasterSettings) -> Result<Film, RasterError> {
    let &RasterSettings { width, height, fake, .. } = settings;
    let (texel, radiance): (usize, fn(&[u8]) -> Vec3) = match fake {
        Fake::AsTaught => (4, emitted_light),
        Fake::Fair => (16, |texel| {
            let channel = |at: usize| f32::from_le_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
            Vec3::new(channel(0), channel(4), channel(8))
        }),
    };
    let mut film = Film::try_new(width, height).ok_or(RasterError::Memory { width, height })?;
    if bytes.len() != texel * film.pixels().len() {
        return Err(RasterError::Incomplete);
    }
    let mut nonfinite = 0;
    for (pixel, texel) in film.pixels_mut().iter_mut().zip(bytes.chunks_exact(texel)) {
        let radiance = radiance(texel);
        nonfinite += u64::from(!radiance.is_finite());
        *pixel = Pixel::exact(if radiance.is_finite() { radiance } else { Vec3::ZERO });
    }
    film.nonfinite = nonfinite;
    Ok(film)
}

/// What an sRGB display emits for a texel's bytes.
fn emitted_light(texel: &[u8]) -> Vec3 {
    let light = |byte: u8| colour::srgb_decode(f32::from(byte) / 255.0);
    Vec3::new(light(texel[0]), light(texel[1]), light(texel[2]))
}
