//! What tracing took.

/// What a call of [`crate::Tracer::render`] did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stats {
    /// Samples taken, one camera ray each.
    pub samples: u64,
    /// Rays traced, shadow rays included.
    pub rays: u64,
    /// Samples that lost light to [`PathSettings::HARD_CAP`](crate::PathSettings::HARD_CAP)
    /// or [`MOST_BRANCHES`](crate::integrator::whitted::MOST_BRANCHES).
    pub cut_paths: u64,
    /// What Metropolis' chains did; nothing of other integrators.
    pub chains: ChainStats,
}

/// What chains of mutations did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ChainStats {
    /// Sets of chains that were started.
    pub runs: u64,
    /// Mutations that were proposed, taken or not.
    pub mutations: u64,
    /// Those that were taken.
    pub accepted: u64,
    /// Sum of the runs' start-up scales.
    pub scales: f64,
}

impl ChainStats {
    /// The share of mutations that were taken; `None` before the first.
    pub fn acceptance(&self) -> Option<f64> {
        (self.mutations > 0).then(|| self.accepted as f64 / self.mutations as f64)
    }

    /// The start-up scale: the picture's mean luminance as the candidates tell it; `None` before the first run.
    pub fn scale(&self) -> Option<f64> {
        (self.runs > 0).then(|| self.scales / self.runs as f64)
    }

    /// The sum of both counts, field by field.
    pub fn plus(self, other: ChainStats) -> ChainStats {
        ChainStats {
            runs: self.runs + other.runs,
            mutations: self.mutations + other.mutations,
            accepted: self.accepted + other.accepted,
            scales: self.scales + other.scales,
        }
    }
}

impl Stats {
    /// The sum of both counts, field by field.
    pub fn plus(self, other: Stats) -> Stats {
        Stats {
            samples: self.samples + other.samples,
            rays: self.rays + other.rays,
            cut_paths: self.cut_paths + other.cut_paths,
            chains: self.chains.plus(other.chains),
        }
    }
}
