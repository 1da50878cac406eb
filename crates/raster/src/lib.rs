//! The fake: what a rasteriser shows of a scene. Three passes per frame:
//!
//! 1. **shadow map** ([`lights`]): depths nearest to the sun, and to the brightest lamp on the six faces of a cube;
//! 2. **cube maps** ([`cube`]): what surrounds each piece of glass, seen from its middle, without it and its shadow;
//! 3. **forward**: every shape, shaded with its lights' shadows; glass looks up its cube map along a direction that is
//!    refracted once.
//!
//! Two fakes share these passes. [`Fake::AsTaught`] is what three.js r115 draws in the tutorial's viewer, number for number:
//! bytes, clamped light, 4 samples a pixel in hardware; its film holds the light that those bytes emit on an sRGB display.
//! [`Fake::Fair`] is the same fake on the truth's data: linear, unclamped `f32`, sun, lamp and ambient light in the truth's
//! units, the mean of 4 passes a pixel.
//!
//! What it can't do is said, not hidden: at most [`MOST_CUBE_MAPS`] pieces of glass have a cube map, others show the plain
//! sky, as does glass seen in a cube map; of several lamps only the one of greatest power sheds light; as taught, a sun puts
//! out all lamps.

pub mod cube;
mod error;
pub mod gpu_data;
pub mod lights;
mod passes;
mod pipelines;
mod plan;
mod settings;
pub mod shading;
mod targets;
mod tessellation;

pub use error::RasterError;
pub use plan::MOST_CUBE_MAPS;
pub use settings::{Fake, RasterSettings, Shading};

use gpu::Gpu;
use passes::Uniforms;
use pipelines::Pipelines;
use plan::Plan;
use scene::{Camera, Film, Scene, Vec3, colour};
use targets::Targets;
use tessellation::World;

/// The rasteriser. It keeps pipelines, targets and geometry from frame to frame, and rebuilds only what changed.
#[derive(Debug)]
pub struct Raster {
    gpu: Gpu,
    pipelines: Pipelines,
    uniforms: Uniforms,
    world: Option<World>,
    targets: Option<Targets>,
}

impl Raster {
    /// A rasteriser on a device.
    ///
    /// # Errors
    /// [`RasterError::Gpu`] if the device can't take the shaders.
    pub fn new(gpu: &Gpu) -> Result<Raster, RasterError> {
        let pipelines = Pipelines::new(gpu)?;
        let uniforms = Uniforms::new(gpu)?;
        Ok(Raster { gpu: gpu.clone(), pipelines, uniforms, world: None, targets: None })
    }

    /// One frame of `scene` from `camera`: linear radiance, one sample a pixel. Waits until it is there.
    ///
    /// # Errors
    /// [`RasterError::Camera`] for a camera that sees nothing; [`RasterError::Gpu`] if picture, maps or geometry are too
    /// large for the device, or if it fails.
    pub fn render(&mut self, scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Result<Film, RasterError> {
        if let Some(why) = camera.fault() {
            return Err(RasterError::Camera(why));
        }
        let plan = Plan::new(scene, camera, settings);
        let world = World::current(&mut self.world, &self.gpu, scene)?;
        let targets = Targets::current(&mut self.targets, &self.gpu, &plan.target_plan(scene, settings))?;
        self.uniforms.write(&self.gpu, &plan)?;
        self.gpu.checked("the picture", || {
            passes::draw(&self.gpu, &self.pipelines, &self.uniforms, world, targets, &plan)
        })?;
        let bytes = self.gpu.read_texture("the picture", targets.picture())?;
        develop(&bytes, settings)
    }
}

fn develop(bytes: &[u8], settings: &RasterSettings) -> Result<Film, RasterError> {
    let film = match settings.fake {
        Fake::AsTaught => {
            Film::from_radiances(settings.width, settings.height, bytes.chunks_exact(4).map(emitted_light))
        }
        Fake::Fair => {
            let channel = |at: &[u8]| f32::from_le_bytes([at[0], at[1], at[2], at[3]]);
            let radiance = |texel: &[u8]| Vec3::new(channel(texel), channel(&texel[4..]), channel(&texel[8..]));
            Film::from_radiances(settings.width, settings.height, bytes.chunks_exact(16).map(radiance))
        }
    };
    film.ok_or(RasterError::Incomplete)
}

/// What an sRGB display emits for a texel's bytes.
fn emitted_light(texel: &[u8]) -> Vec3 {
    let light = |byte: u8| colour::srgb_decode(f32::from(byte) / 255.0);
    Vec3::new(light(texel[0]), light(texel[1]), light(texel[2]))
}
