//! The normal at the first surface that a camera ray meets, as a colour: -1 to 1 along each axis as 0 to 1. What looks
//! into a scene's geometry, and the smallest integrator that there is.
//!
//! Twin: `shaders/pathtrace/integrator/normals.wgsl`.

use crate::drive::gpu::{PipelineKey, flag};
use crate::drive::lanes::{LaneIntegrator, LanePlan};
use crate::intersect::Rays;
use crate::intersect::shape_list::Scratch;
use crate::prepared::{Outcomes, PreparedScene};
use crate::sampling::sampler::Sampler;
use crate::sampling::sampler::SamplerKind;
use crate::vectors::in_all_lanes;
use scene::Vec3;
use scene::camera::PictureFrame;
use scene::direction::unit;
use simd::{Float, Mask, Vector};

/// Whose axes a direction is told by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Space {
    /// Along the x, y and z axes of the scene.
    #[default]
    World,
    /// The camera's: x to the right, y up, z towards the viewer.
    Camera,
}

impl Space {
    /// All, the default first.
    pub const ALL: [Self; 2] = [Self::World, Self::Camera];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::World => "world",
            Self::Camera => "camera",
        }
    }

    /// The space of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|s| s.name() == name)
    }
}

/// The settings of one picture of normals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalsSettings {
    /// Whose axes are red, green and blue.
    pub space: Space,
    /// Where in a pixel samples lie.
    pub sampler: SamplerKind,
    /// Selects one of 2^32 independent pictures.
    pub seed: u32,
}

impl Default for NormalsSettings {
    fn default() -> Self {
        NormalsSettings { space: Space::World, sampler: SamplerKind::default(), seed: 1 }
    }
}

impl NormalsSettings {
    pub(super) fn pipeline_key(&self) -> PipelineKey {
        let constants = [("CAMERA_SPACE", flag(self.space == Space::Camera))];
        PipelineKey::new("pathtrace/integrator/normals.wgsl", self.sampler, &constants)
    }
}

/// The axes that are red, green and blue.
pub struct Plan([Vec3; 3]);

impl Plan {
    /// Reads the settings of a picture in this frame.
    pub fn new(settings: &NormalsSettings, frame: &PictureFrame) -> Self {
        Plan(match settings.space {
            Space::World => [Vec3::X, Vec3::Y, Vec3::Z],
            Space::Camera => [unit(frame.right).unwrap_or(Vec3::X), unit(frame.up).unwrap_or(Vec3::Y), -frame.forward],
        })
    }
}

impl LanePlan for Plan {
    type LaneState<'a, F: Float> = NormalLanes<'a, F>;

    #[inline(always)]
    fn lane_state<'a, F: Float>(&'a self, scene: &'a PreparedScene) -> NormalLanes<'a, F> {
        NormalLanes {
            scene,
            axes: self.0,
            camera: Rays::new(Vector::zero(), Vector::splat([0.0, 0.0, 1.0])),
            scratch: Scratch::new(scene.aggregate.shape_list()),
            outcome: Outcomes { radiance: Vector::zero(), cut: F::M::splat(false) },
            rays: 0,
        }
    }
}

/// A camera ray in each lane.
pub struct NormalLanes<'a, F: Float> {
    scene: &'a PreparedScene,
    axes: [Vec3; 3],
    camera: Rays<F>,
    scratch: Scratch<F>,
    outcome: Outcomes<F>,
    rays: u64,
}

impl<F: Float> LaneIntegrator<F> for NormalLanes<'_, F> {
    #[inline(always)]
    fn begin(&mut self, here: F::M, rays: &Rays<F>) {
        self.camera = Rays::select(here, *rays, self.camera);
    }

    /// Where nothing is met it is black.
    #[inline(always)]
    fn segment(&mut self, taken: F::M, _sampler: &Sampler<F::U>) -> F::M {
        self.rays += u64::from(taken.count());
        let hit = self.scene.closest(&self.camera, taken, &mut self.scratch);
        let normal = hit.point.normal;
        let [x, y, z] = self.axes;
        let along = Vector::new(
            in_all_lanes::<F>(x).dot(normal),
            in_all_lanes::<F>(y).dot(normal),
            in_all_lanes::<F>(z).dot(normal),
        );
        let colour = (along + Vector::along_all(F::splat(1.0))) * F::splat(0.5);
        self.outcome.radiance = Vector::select(hit.met, colour, Vector::zero());
        taken
    }

    #[inline(always)]
    fn outcomes(&self) -> &Outcomes<F> {
        &self.outcome
    }

    fn rays(&self) -> u64 {
        self.rays
    }
}
