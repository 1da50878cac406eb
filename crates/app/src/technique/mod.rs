//! A technique with its settings: what a pane of the viewer or one call of `visavis render` makes of a scene.

mod device;
mod fake;
mod provenance;
mod rays;

pub use device::{Adapter, Adapters, Device, DeviceChoice};
pub use fake::FakeSettings;
pub use provenance::{Made, Provenance, made_from, point, quoted};
pub use rays::{Method, RaySettings, TreeSettings, TruthSettings, bounces_name, roulette_name};

use pathtrace::Estimator;
use scene::Scene;

/// A way to turn a scene into a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Technique {
    /// The fake: rasterised on the GPU.
    Raster,
    /// Whitted's trees of rays.
    Whitted,
    /// The truth: path traced.
    Path,
}

impl Technique {
    /// All, in the order of the lecture.
    pub const ALL: [Technique; 3] = [Technique::Raster, Technique::Whitted, Technique::Path];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Technique::Raster => "raster",
            Technique::Whitted => "whitted",
            Technique::Path => "path",
        }
    }

    /// What runs it if nobody says otherwise.
    pub fn usual_machine(self) -> Device {
        match self {
            Technique::Raster => Device::Gpu,
            Technique::Whitted | Technique::Path => Device::Cpu,
        }
    }

    /// What a lecture calls it.
    pub fn title(self) -> &'static str {
        match self {
            Technique::Raster => "Fake",
            Technique::Whitted => "Whitted",
            Technique::Path => "Truth",
        }
    }

    /// The technique of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|t| t.name() == name)
    }
}

/// What a pane is set to: a technique, and the settings of each so that coming back to one finds them again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaneSettings {
    /// The technique that is used.
    pub technique: Technique,
    /// Where its rays are traced.
    pub device: DeviceChoice,
    /// By which of the adapters, where by one.
    pub adapter: u8,
    /// The settings of the fake.
    pub fake: FakeSettings,
    /// The settings of Whitted's method.
    pub whitted: TreeSettings,
    /// The settings of the truth.
    pub truth: TruthSettings,
}

impl PaneSettings {
    /// A pane of this technique with its default settings.
    pub fn of(technique: Technique) -> Self {
        PaneSettings {
            technique,
            device: DeviceChoice::default(),
            adapter: 0,
            fake: FakeSettings::default(),
            whitted: TreeSettings::default(),
            truth: TruthSettings::default(),
        }
    }

    /// The technique in use with its settings.
    pub fn recipe(&self) -> Recipe {
        match self.technique {
            Technique::Raster => Recipe::Fake(self.fake),
            Technique::Whitted => Recipe::Rays(self.here(self.whitted.into())),
            Technique::Path => Recipe::Rays(self.here(self.truth.into())),
        }
    }

    fn here(&self, rays: RaySettings) -> RaySettings {
        RaySettings { device: self.device, adapter: self.adapter, ..rays }
    }

    /// Takes `scene`'s own numbers again, and looks at the picture where it has no such map.
    pub fn forget_the_scene(&mut self, scene: &Scene) {
        self.fake.forget_the_scene(scene);
        self.whitted.tree.ambient = None;
    }

    /// Takes the estimator that `scene` asks for, unless another than the usual one was chosen.
    pub fn take_usual_estimator(&mut self, scene: &Scene) {
        let estimator = &mut self.truth.path.estimator;
        if *estimator == Estimator::default() {
            *estimator = Estimator::usual_for(&scene.needs());
        }
    }

    /// Samples per pixel at which rendering stops; `None` for a technique that does not sample.
    pub fn wished_spp(&self) -> Option<u32> {
        match self.recipe() {
            Recipe::Fake(_) => None,
            Recipe::Rays(rays) => Some(rays.spp),
        }
    }
}

/// A technique with its settings: all that a picture depends on beside scene, camera and size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Recipe {
    /// Rasterised.
    Fake(FakeSettings),
    /// Traced, along paths or in trees.
    Rays(RaySettings),
}

impl Recipe {
    /// Its technique.
    pub fn technique(&self) -> Technique {
        match self {
            Recipe::Fake(_) => Technique::Raster,
            Recipe::Rays(RaySettings { method: Method::Whitted(_), .. }) => Technique::Whitted,
            Recipe::Rays(RaySettings { method: Method::Path(_), .. }) => Technique::Path,
        }
    }

    /// For a pane's label: "fake (raster, fair)".
    pub fn label(&self) -> String {
        match self {
            Recipe::Fake(fake) => fake.label(),
            Recipe::Rays(rays) => rays.label(),
        }
    }

    /// Whether it shows the scene, so that its error means something; a shadow map does not.
    pub fn shows_the_scene(&self) -> bool {
        match self {
            Recipe::Fake(fake) => fake.shows_the_scene(),
            Recipe::Rays(_) => true,
        }
    }
}

/// What sliders and options change in a scene for all techniques at once; `None` leaves it as the scene has it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SceneChanges {
    /// Index of refraction outside over inside of all glass, above 0.
    pub refraction_ratio: Option<f32>,
    /// Angular radius of the sun in degrees, from 0 to below 90.
    pub sun_radius: Option<f32>,
}

impl SceneChanges {
    /// The scene with these changes; its shapes stay shared.
    pub fn applied_to(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        if let Some(ratio) = self.refraction_ratio {
            scene.set_refraction_ratio(ratio);
        }
        if let (Some(radius), Some(sun)) = (self.sun_radius, &mut scene.sun) {
            sun.angular_radius = radius;
        }
        scene
    }
}
