//! What tracing took.

/// What a call of [`crate::Tracer::render`] did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stats {
    /// Samples taken, one camera ray each.
    pub samples: u64,
    /// Rays traced, shadow rays included.
    pub rays: u64,
    /// Samples that lost light to [`PathSettings::HARD_CAP`](crate::PathSettings::HARD_CAP)
    /// or [`MOST_BRANCHES`](crate::integrator::whitted::MOST_BRANCHES).
    pub cut_paths: u64,
}

impl Stats {
    /// The sum of both counts, field by field.
    pub fn plus(self, other: Stats) -> Stats {
        Stats {
            samples: self.samples + other.samples,
            rays: self.rays + other.rays,
            cut_paths: self.cut_paths + other.cut_paths,
        }
    }
}
