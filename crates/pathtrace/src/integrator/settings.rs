//! What the user may choose about the walk of a path: how directions are drawn, how light is found, when paths end,
//! into how many they branch, and where the random numbers come from. All freely combined; [`Estimator`] names the
//! usual pairs.

use crate::integrator::broken::Bugs;
use crate::integrator::light_paths::LightPaths;
use crate::integrator::path_plan::MOST_BRANCHES;
use crate::integrator::photon::MOST_PHOTONS;
use crate::sampling::sampler::SamplerKind;
use scene::Needs;

/// How a diffuse vertex draws the direction in which the path goes on. Mirrors and glass leave no choice, or Fresnel's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Directions {
    /// Uniform on the hemisphere, density `1 / (2 pi)` (Task 2 b).
    Uniform,
    /// Proportional to BSDF times cosine, which for Lambert's law is the cosine: density `cos / pi`.
    Cosine,
    /// Where a guide says that light comes from, which was learned from some paths before; see
    /// `integrator/guide`. On the processor alone.
    Guided,
}

/// How light is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LightSampling {
    /// By chance: where a path happens to meet it. Point lights and a delta sun are never met: their light is missing.
    BsdfOnly,
    /// Area lights, point lights and sun are sampled at every diffuse vertex (Task 2 c), and not counted where the next
    /// segment meets them. The sky fills the hemisphere, where the drawn direction already is the better sample: it is
    /// found by chance. So is light behind glass or in a mirror; that of a point light or a delta sun is missing there.
    NextEvent,
    /// Both, weighted by the balance heuristic: Veach and Guibas, "Optimally Combining Sampling Techniques for Monte
    /// Carlo Rendering" (SIGGRAPH 1995). Close to an area light sampling alone has weights without bound; these stay
    /// bounded.
    Mis,
}

/// How directions are drawn and how light is found. Without a limit of bounces every pair is unbiased for all light
/// that it can find, see [`LightSampling`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Estimator {
    /// How directions are drawn.
    pub directions: Directions,
    /// How light is found.
    pub light: LightSampling,
}

impl Estimator {
    /// The tutorial's naive tracer (Task 2 b): uniform directions, light by chance.
    pub const UNIFORM: Self = Estimator { directions: Directions::Uniform, light: LightSampling::BsdfOnly };
    /// Cosine-weighted directions, light by chance.
    pub const COSINE: Self = Estimator { directions: Directions::Cosine, light: LightSampling::BsdfOnly };
    /// The tutorial's complete tracer (Task 2 d): light sampled, cosine-weighted indirect light.
    pub const LIGHT: Self = Estimator { directions: Directions::Cosine, light: LightSampling::NextEvent };
    /// Light sampled and met, weighted; cosine-weighted directions.
    pub const MIS: Self = Estimator { directions: Directions::Cosine, light: LightSampling::Mis };
    /// Light sampled, uniform directions: the cost of the wrong density alone.
    pub const UNIFORM_LIGHT: Self = Estimator { directions: Directions::Uniform, light: LightSampling::NextEvent };
    /// Light sampled and met, weighted; uniform directions.
    pub const UNIFORM_MIS: Self = Estimator { directions: Directions::Uniform, light: LightSampling::Mis };
    /// Light sampled; indirect light from where a guide has learned that it comes from.
    pub const GUIDED: Self = Estimator { directions: Directions::Guided, light: LightSampling::NextEvent };
    /// Light sampled and met, weighted; guided directions.
    pub const GUIDED_MIS: Self = Estimator { directions: Directions::Guided, light: LightSampling::Mis };
    /// Guided directions, light by chance: what a guide finds without being told where the lights are.
    pub const GUIDED_CHANCE: Self = Estimator { directions: Directions::Guided, light: LightSampling::BsdfOnly };

    /// The usual ones, in the order of the lecture.
    pub const ALL: [Self; 5] = [Self::UNIFORM, Self::COSINE, Self::LIGHT, Self::MIS, Self::GUIDED];
    /// Every pair.
    pub const EVERY: [Self; 9] = [
        Self::UNIFORM,
        Self::COSINE,
        Self::LIGHT,
        Self::MIS,
        Self::UNIFORM_LIGHT,
        Self::UNIFORM_MIS,
        Self::GUIDED,
        Self::GUIDED_MIS,
        Self::GUIDED_CHANCE,
    ];

    /// The name on the command line and in the window.
    pub fn name(self) -> &'static str {
        match (self.directions, self.light) {
            (Directions::Uniform, LightSampling::BsdfOnly) => "uniform",
            (Directions::Cosine, LightSampling::BsdfOnly) => "cosine",
            (Directions::Cosine, LightSampling::NextEvent) => "light",
            (Directions::Cosine, LightSampling::Mis) => "mis",
            (Directions::Uniform, LightSampling::NextEvent) => "uniform-light",
            (Directions::Uniform, LightSampling::Mis) => "uniform-mis",
            (Directions::Guided, LightSampling::NextEvent) => "guided",
            (Directions::Guided, LightSampling::Mis) => "guided-mis",
            (Directions::Guided, LightSampling::BsdfOnly) => "guided-chance",
        }
    }

    /// The estimator of that name, one of [`Estimator::EVERY`].
    pub fn named(name: &str) -> Option<Self> {
        Self::EVERY.into_iter().find(|e| e.name() == name)
    }

    /// The one to begin with in a scene that asks for so much: a rough metal's lobe or a coat's may be so narrow that light
    /// sampling alone hardly ever hits it, and what [`crate::caster`]s focus has 5 to 9 times the variance near a focus where
    /// chance's share of it is not weighted in.
    pub fn usual_for(needs: &Needs) -> Self {
        if needs.rough_conductor || needs.metallic_roughness || needs.casters { Self::MIS } else { Self::default() }
    }

    /// Those that graphics devices know too.
    pub fn on_devices() -> impl Iterator<Item = Self> {
        Self::EVERY.into_iter().filter(|estimator| estimator.directions != Directions::Guided)
    }

    /// Whether area lights, point lights and sun are sampled.
    pub fn samples_lights(self) -> bool {
        self.light != LightSampling::BsdfOnly
    }
}

impl Default for Estimator {
    fn default() -> Self {
        Self::LIGHT
    }
}

/// Russian roulette: when a path may end early. Tested at every vertex; what survives is divided by the probability, so
/// that the expected value stays ("Solution: Russian Roulette"). Both ways together multiply their probabilities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roulette {
    /// The tutorial's: every vertex is survived with this probability, in (0, 1]; `None` is 1.
    pub probability: Option<f32>,
    /// Survival with four times the path's largest throughput channel, at most 1: dark paths end, bright ones go on. Not at
    /// mirrors and glass, which leave no choice: a path is as dark there as what it finds may be bright.
    pub throughput: bool,
}

impl Roulette {
    /// Paths end by the number of bounces alone.
    pub const OFF: Self = Roulette { probability: None, throughput: false };
    /// By throughput alone.
    pub const THROUGHPUT: Self = Roulette { probability: None, throughput: true };

    /// By a constant probability in (0, 1] alone.
    pub const fn constant(probability: f32) -> Self {
        Roulette { probability: Some(probability), throughput: false }
    }
}

impl Default for Roulette {
    fn default() -> Self {
        Self::THROUGHPUT
    }
}

/// Shapes of mirror and glass that get a part of the directions at diffuse vertices, where light is sampled and the other
/// directions are by the cosine: see [`crate::caster::cone`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ConesAt {
    /// None: caustics are found as often as chance meets what throws them.
    Nothing,
    /// Those that pay on every scene that was measured: meshes, and balls where there are several, between which light goes
    /// on ways that no connection finds. relMSE by chance over that with cones, suns of 4 and 15 degrees, for 1.2 to 1.5
    /// times the time: 2.3 to 3.8 for glass meshes above a floor, 1.15 to 1.5 where they touch it. `whitted` beside
    /// connections, for 1.2 times the time: 1.9 under its sun, 2.4 under one of half a degree.
    Usual,
    /// All, balls, boxes and flat mirrors too: 1.4 to 1.5 for a glass box and 1.1 to 1.6 for a mirroring disk, which just
    /// pays for the time.
    Everything,
}

impl ConesAt {
    /// All, the fewest cones first.
    pub const ALL: [Self; 3] = [Self::Nothing, Self::Usual, Self::Everything];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nothing => "off",
            Self::Usual => "auto",
            Self::Everything => "all",
        }
    }

    /// The shapes of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|cones| cones.name() == name)
    }
}

/// The settings of one picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSettings {
    /// How directions are drawn and light is found.
    pub estimator: Estimator,
    /// The tutorial's count: N bounces are N + 1 scattering vertices, specular ones too; 0 is direct light. `None`: no
    /// limit but [`PathSettings::HARD_CAP`]. A limit loses the light of longer paths: it is biased.
    pub bounces: Option<u32>,
    /// When paths may end early.
    pub roulette: Roulette,
    /// Directions drawn at each diffuse vertex, their light averaged: 1 is path tracing, more is distributed ray
    /// tracing, whose rays multiply with every bounce. At least 1; [`PathSettings::check`] says how many are too many.
    pub branches: u32,
    /// Whether light that is sampled is also looked for through spheres of glass and off those and mirroring ones: the
    /// caustics of the scene's [`crate::caster`]s. Without it chance has to find them.
    pub connections: bool,
    /// What diffuse vertices send a part of their directions to.
    pub cones: ConesAt,
    /// Whether glass that the camera sees, straight or by mirrors and glass, sends a path on both ways at the first
    /// vertices, rather than one by chance. Not with more than one branch, which are the tutorial's alone.
    pub split_glass: bool,
    /// Which light counts. What is drawn does not depend on it, but paths end where none can count any more.
    pub paths: LightPaths,
    /// Where random numbers come from.
    pub sampler: SamplerKind,
    /// Selects one of 2^32 independent pictures.
    pub seed: u32,
    /// What is wrong on purpose. With any bug paths are the tutorial's plain ones: no guide, no branches, no connections,
    /// no cones, no glass that splits them.
    pub bugs: Bugs,
    /// Above 0: the number of a bug that is on as well, and not told. See [`PathSettings::hidden_bug`].
    pub find_bug: u32,
}

/// Settings that no picture can be made with.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SettingsError {
    /// Too many rays for one sample.
    #[error(
        "{branches} directions at each of {vertices} vertices make more than {MOST_BRANCHES} paths of one sample: \
         fewer directions or fewer bounces"
    )]
    TooManyBranches {
        /// Directions at each diffuse vertex.
        branches: u32,
        /// Vertices that may branch.
        vertices: u32,
    },
    /// Branching paths without end.
    #[error("{0} directions at each vertex need a limit of bounces")]
    EndlessBranches(u32),
    /// No direction at all.
    #[error("a vertex needs at least one direction")]
    NoBranch,
    /// Chains cannot follow a guide, which is learned pixel by pixel.
    #[error("a guide is learned for paths, not for chains: choose another estimator than {0}")]
    GuidedChains(&'static str),
    /// Bugs are those of the plain path tracer.
    #[error("bugs are those of a plain path tracer, which knows no {0}: leave out one of the two")]
    BrokenAnd(&'static str),
    /// A probability outside (0, 1].
    #[error("a path survives with a probability above 0 and at most 1, not {0}")]
    Probability(f32),
    /// No photons, or more than there is memory for.
    #[error("a pass has 1 to {MOST_PHOTONS} photons, not {0}")]
    Photons(u32),
    /// A radius that is none.
    #[error("photons are gathered within a radius above 0, not {0}")]
    Radius(f32),
    /// A shrinking that is none.
    #[error("alpha is above 0 and below 1, not {0}: at 1 the radius would never shrink")]
    Alpha(f32),
}

impl PathSettings {
    /// Scattering vertices at which an unlimited path is cut, and counted in [`crate::Stats::cut_paths`]: without it a
    /// ray between perfect mirrors would never end.
    pub const HARD_CAP: u32 = 1000;

    /// The default settings, with samples that are independent of each other: their spread tells their error.
    pub fn independent() -> Self {
        PathSettings { sampler: SamplerKind::Independent, ..Self::default() }
    }

    /// What directions go to: where they are the tutorial's naive ones, or light is found by chance alone, nothing.
    pub(crate) fn cones(&self) -> ConesAt {
        let drawn_well = self.estimator.directions == Directions::Cosine && self.estimator.samples_lights();
        if drawn_well { self.cones } else { ConesAt::Nothing }
    }

    /// Whether glass splits paths.
    pub(crate) fn splits(&self) -> bool {
        self.split_glass && self.branches < 2
    }

    /// The number of vertices at which a path may scatter.
    pub fn scattering_vertices(&self) -> u32 {
        self.bounces.map_or(Self::HARD_CAP, |n| n.saturating_add(1).min(Self::HARD_CAP))
    }

    /// Whether these settings mean something. More than one direction at a vertex needs a limit of N bounces with
    /// `branches ^ (N + 1)` at most `MOST_BRANCHES`.
    ///
    /// # Errors
    /// What is wrong, as a line for the user. [`crate::Tracer::render`] does not fail on such settings: from the vertex
    /// on where there would be too many paths it draws one direction, which is unbiased too.
    pub fn check(&self) -> Result<(), SettingsError> {
        if let Some(p) = self.roulette.probability.filter(|p| !(*p > 0.0 && *p <= 1.0)) {
            return Err(SettingsError::Probability(p));
        }
        if self.is_broken() && self.estimator.directions == Directions::Guided {
            return Err(SettingsError::BrokenAnd("guide"));
        }
        if self.is_broken() && self.branches > 1 {
            return Err(SettingsError::BrokenAnd("more than one direction at a vertex"));
        }
        let (branches, vertices) = (self.branches, self.scattering_vertices());
        match branches {
            0 => Err(SettingsError::NoBranch),
            1 => Ok(()),
            _ if self.bounces.is_none() => Err(SettingsError::EndlessBranches(branches)),
            _ if vertices > self.branching_vertices() => Err(SettingsError::TooManyBranches { branches, vertices }),
            _ => Ok(()),
        }
    }

    /// Diffuse vertices of a path that may branch before there would be more than `MOST_BRANCHES` paths.
    pub fn branching_vertices(&self) -> u32 {
        if self.branches < 2 { 0 } else { MOST_BRANCHES.ilog(self.branches) }
    }
}

impl Default for PathSettings {
    fn default() -> Self {
        PathSettings {
            estimator: Estimator::LIGHT,
            bounces: None,
            roulette: Roulette::THROUGHPUT,
            branches: 1,
            connections: true,
            cones: ConesAt::Usual,
            split_glass: true,
            paths: LightPaths::ALL,
            sampler: SamplerKind::default(),
            seed: 1,
            bugs: Bugs::NONE,
            find_bug: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back() {
        assert!(Estimator::EVERY.iter().all(|&e| Estimator::named(e.name()) == Some(e)));
        assert!(ConesAt::ALL.iter().all(|&c| ConesAt::named(c.name()) == Some(c)));
        assert!(SamplerKind::ALL.iter().all(|&s| SamplerKind::named(s.name()) == Some(s)));
        assert_eq!(Estimator::named("MIS"), None);
    }

    #[test]
    fn exploding_settings_are_refused_by_the_rule() {
        let with = |branches, bounces| PathSettings { branches, bounces, ..PathSettings::default() }.check();
        assert_eq!(with(1, None), Ok(()));
        assert_eq!(with(16, Some(3)), Ok(()));
        assert_eq!(with(16, Some(4)), Err(SettingsError::TooManyBranches { branches: 16, vertices: 5 }));
        assert_eq!(with(2, Some(15)), Ok(()));
        assert_eq!(with(2, None), Err(SettingsError::EndlessBranches(2)));
        assert_eq!(with(0, None), Err(SettingsError::NoBranch));
        let roulette = Roulette::constant(0.0);
        assert!(PathSettings { roulette, ..PathSettings::default() }.check().is_err());
    }
}
