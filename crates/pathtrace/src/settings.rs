//! What the user may choose about the walk of a path.

/// How directions are drawn and how light is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// Directions uniform on the hemisphere, light found by chance: the tutorial's naive tracer (Task 2 b).
    Uniform,
    /// Directions proportional to the cosine, light found by chance.
    Cosine,
    /// Lamps and sun sampled at every diffuse vertex, cosine-weighted indirect light: the tutorial's complete tracer
    /// (Task 2 d). The sky fills the hemisphere, where the cosine-weighted direction already is the better sample: it is
    /// found by chance. So is light behind glass or in a mirror.
    #[default]
    Light,
}

impl Estimator {
    /// All, in the order of the lecture.
    pub const ALL: [Estimator; 3] = [Estimator::Uniform, Estimator::Cosine, Estimator::Light];

    /// The name on the command line and in the window.
    pub fn name(self) -> &'static str {
        match self {
            Estimator::Uniform => "uniform",
            Estimator::Cosine => "cosine",
            Estimator::Light => "light",
        }
    }

    /// The estimator of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|e| e.name() == name)
    }
}

/// Russian roulette: when a path may end early. Tested at every vertex; what survives is divided by the probability, so
/// that the expected value stays ("Solution: Russian Roulette").
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Roulette {
    /// Paths end by the number of bounces alone.
    Off,
    /// The tutorial's: every vertex is survived with this probability, in (0, 1].
    Probability(f32),
    /// Survival with twice the path's largest throughput channel, at most 1: dark paths end, bright ones go on.
    #[default]
    Throughput,
}

/// The settings of one picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSettings {
    /// How light is found.
    pub estimator: Estimator,
    /// The tutorial's count: N bounces are N + 1 scattering vertices, specular ones too; 0 is direct light. `None`: no
    /// limit but [`PathSettings::HARD_CAP`]. A limit loses the light of longer paths: it is biased.
    pub bounces: Option<u32>,
    /// When paths may end early.
    pub roulette: Roulette,
    /// Selects one of 2^32 independent pictures.
    pub seed: u32,
}

impl PathSettings {
    /// Scattering vertices at which an unlimited path is cut, and counted in [`crate::Stats::cut_paths`]: without it a
    /// ray between perfect mirrors would never end.
    pub const HARD_CAP: u32 = 1000;

    /// The number of vertices at which a path may scatter.
    pub fn scattering_vertices(&self) -> u32 {
        self.bounces.map_or(Self::HARD_CAP, |n| n.saturating_add(1).min(Self::HARD_CAP))
    }
}

impl Default for PathSettings {
    fn default() -> Self {
        PathSettings { estimator: Estimator::Light, bounces: None, roulette: Roulette::Throughput, seed: 1 }
    }
}
