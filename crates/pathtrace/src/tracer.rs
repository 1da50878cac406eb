//! From rays to a film: progressive, parallel over chunks of pixels, cancelled at once.

use crate::drive::lanes::{FilmJob, FilmPass, Stop};
use crate::features::{FeatureFilm, FeaturePass};
use crate::integrator::Integrator;
use crate::integrator::guide::{cells::Cells, guides::Guides};
#[cfg(test)]
use crate::integrator::{guide::Guide, path_plan::Plan, settings::PathSettings};
use crate::intersect::Accel;
use crate::intersect::aggregate::Aggregate;
use crate::intersect::baking::made_ready;
use crate::light::Lights;
use crate::prepared::PreparedScene;
use crate::stats::Stats;
use film::{Features, Film};
use scene::stand_ins::FakeNumbers;
use scene::{Camera, Scene};
use simd::Lanes;

/// A scene made ready for rays. Camera and settings come with each call, so that moving them costs no rebuild.
pub struct Tracer {
    scene: PreparedScene,
    stand_ins: FakeNumbers,
    guides: Guides,
    lanes: Lanes,
}

impl Tracer {
    /// Builds the acceleration structure and the list of lights.
    pub fn new(scene: &Scene) -> Self {
        let scene = &*made_ready(scene);
        Tracer {
            scene: PreparedScene::new(scene),
            stand_ins: scene.fake,
            guides: Guides::new(Cells::new(scene.bounds())),
            lanes: Lanes::best(),
        }
    }

    /// Traces in these lanes from now on. All give the same picture, bit for bit.
    pub fn with_lanes(self, lanes: Lanes) -> Self {
        Tracer { lanes, ..self }
    }

    /// Traces one ray at a time from now on, through the tree, also where the shapes are few: the same picture but for
    /// rounding, for measuring what meeting all shapes in all lanes saves.
    pub fn with_single_rays(mut self) -> Self {
        self.scene.aggregate.forget_shape_list();
        self
    }

    /// Forgets what the scene lacks, for measuring what knowing it saves: one ray at a time, and every kind of material
    /// is looked for. The same picture but for rounding.
    pub fn for_any_scene(mut self) -> Self {
        self.scene.materials.expect_everything();
        self.with_single_rays()
    }

    /// What it traces in.
    pub fn lanes(&self) -> Lanes {
        self.lanes
    }

    /// Triangles, spheres and disks in the scene.
    pub fn primitives(&self) -> usize {
        self.accel().len()
    }

    /// The shapes, ready for single rays.
    pub fn accel(&self) -> &Accel {
        self.scene.aggregate.accel()
    }

    /// The shapes, ready for rays in lanes.
    pub fn aggregate(&self) -> &Aggregate {
        &self.scene.aggregate
    }

    /// The scene as integrators ask it.
    #[cfg(test)]
    pub(crate) fn prepared(&self) -> &PreparedScene {
        &self.scene
    }

    /// What is sampled as a light.
    pub fn lights(&self) -> &Lights {
        &self.scene.lights
    }

    /// Adds `samples` to every pixel of `film`, on the current rayon pool. Sample numbers go on from what each pixel has,
    /// so that many small calls give the same picture as a large one. `stop` is asked before every segment of a path; once
    /// it says so the call returns, and pixels hold whole samples, but not all equally many: the next call brings every
    /// pixel to `samples` more than the fewest.
    ///
    /// `integrator` should pass [`Integrator::check`], which says what becomes of it if it does not.
    pub fn render(
        &self,
        film: &mut Film,
        camera: &Camera,
        integrator: &Integrator,
        samples: u32,
        stop: &(impl Fn() -> bool + Sync),
    ) -> Stats {
        let pass = FilmPass::new(film, camera, samples, (integrator.sampler(), integrator.seed()));
        // not generic: kernels are large, and compiled in this crate once
        integrator.fill(film, &self.job(pass, stop))
    }

    /// What denoisers are guided by, on the current rayon pool; `None` once `stop` says so.
    pub fn features(&self, pass: &FeaturePass, stop: &(impl Fn() -> bool + Sync)) -> Option<Features> {
        let mut film = FeatureFilm::new(pass.size());
        self.add_features(&mut film, pass, stop);
        film.features().filter(|_| !stop())
    }

    /// Adds samples to what is known of pixels, which are of the pass's size, on the current rayon pool; once `stop` says so
    /// some are left without, which the next pass completes.
    pub fn add_features(&self, film: &mut FeatureFilm, pass: &FeaturePass, stop: &(impl Fn() -> bool + Sync)) -> Stats {
        pass.trace(&self.scene, self.lanes, film, stop)
    }

    /// The scene and what is traced in.
    pub(crate) fn ready(&self) -> (&PreparedScene, Lanes) {
        (&self.scene, self.lanes)
    }

    pub(crate) fn job<'a>(&'a self, pass: FilmPass, stop: &'a Stop) -> FilmJob<'a> {
        let Tracer { scene, stand_ins, guides, lanes } = self;
        FilmJob { scene, stand_ins, guides, lanes: *lanes, pass, stop }
    }

    /// As [`Tracer::render`], by a guide that was not learned.
    #[cfg(test)]
    pub(crate) fn render_by(
        &self,
        film: &mut Film,
        camera: &Camera,
        settings: &PathSettings,
        guide: Guide,
        samples: u32,
    ) {
        let pass = FilmPass::new(film, camera, samples, (settings.sampler, settings.seed));
        self.job(pass, &|| false).fill(film, &Plan::guided_by(settings, guide.into()));
    }
}
