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
    /// Photons that were to leave the lights.
    pub photons: u64,
    /// Those that were still under way at [`PathSettings::HARD_CAP`](crate::PathSettings::HARD_CAP).
    pub cut_photons: u64,
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

/// The share of samples, or of photons, whose loss no picture shows: were each to miss a light a thousand times as bright as the
/// picture, a thousandth of its light would be missing. Whispering galleries in a ball of glass hold one in some ten
/// millions.
const HARMLESS: f64 = 1e-6;

impl Stats {
    /// What was cut short and misses light, each with how often, where that is more than a harmless share.
    pub fn cut_short(&self) -> impl Iterator<Item = (u64, &'static str)> {
        let of = [(self.cut_paths, self.samples, "samples"), (self.cut_photons, self.photons, "photons")];
        let counts = |(cut, all, _): &(u64, u64, _)| *cut as f64 > HARMLESS * *all as f64;
        of.into_iter().filter(counts).map(|(cut, _, what)| (cut, what))
    }

    /// The sum of both counts, field by field.
    pub fn plus(self, other: Stats) -> Stats {
        Stats {
            samples: self.samples + other.samples,
            rays: self.rays + other.rays,
            cut_paths: self.cut_paths + other.cut_paths,
            photons: self.photons + other.photons,
            cut_photons: self.cut_photons + other.cut_photons,
            chains: self.chains.plus(other.chains),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_cut_is_told_by_its_name_and_not_where_it_is_one_in_millions() {
        let told = |stats: Stats| stats.cut_short().collect::<Vec<_>>();
        let stats = Stats { samples: 37_748_736, photons: 1 << 25, ..Stats::default() };
        assert_eq!(told(stats), []);
        assert_eq!(told(Stats { cut_paths: 3, cut_photons: 33, ..stats }), []);
        assert_eq!(told(Stats { cut_paths: 38, cut_photons: 3, ..stats }), [(38, "samples")]);
        assert_eq!(told(Stats { cut_photons: 34, ..stats }), [(34, "photons")]);
        assert_eq!(told(Stats { samples: 1, cut_paths: 1, ..Stats::default() }), [(1, "samples")]);
    }
}
