//! How the errors of a picture have fallen while it was made.

use compare::Errors;

/// The errors of a picture at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ErrorPoint {
    /// Samples per pixel; `None` for a technique that does not sample.
    pub spp: Option<u32>,
    /// Seconds that rendering had taken when they were measured.
    pub seconds: f64,
    /// How far it was from what judges it.
    pub errors: Errors,
}

/// The errors of a picture from its first to the latest, at moments ever farther apart: memory stays bounded however
/// long it is rendered, and the whole course stays.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorHistory {
    points: Vec<ErrorPoint>,
    /// One of so many is kept.
    stride: usize,
    /// How many have come.
    count: usize,
    latest: Option<ErrorPoint>,
}

/// The most moments that are kept, the latest aside.
const MOST_POINTS: usize = 512;

impl Default for ErrorHistory {
    fn default() -> Self {
        ErrorHistory { points: Vec::new(), stride: 1, count: 0, latest: None }
    }
}

impl ErrorHistory {
    /// Adds a moment later than all before; one that says nothing new is left out.
    pub fn push(&mut self, point: ErrorPoint) {
        if self.latest == Some(point) {
            return;
        }
        if self.count.is_multiple_of(self.stride) {
            if self.points.len() == MOST_POINTS {
                self.thin_out();
            }
            // what does not fall on a doubled stride is left out
            if self.count.is_multiple_of(self.stride) {
                self.points.push(point);
            }
        }
        self.count += 1;
        self.latest = Some(point);
    }

    /// From the first to the latest, in order of time.
    pub fn iter(&self) -> impl Iterator<Item = &ErrorPoint> {
        self.points.iter().chain(self.latest.iter().filter(|latest| self.points.last() != Some(latest)))
    }

    /// The newest moment, kept or not.
    pub fn latest(&self) -> Option<&ErrorPoint> {
        self.latest.as_ref()
    }

    /// Every second one goes.
    fn thin_out(&mut self) {
        let mut index = 0;
        self.points.retain(|_| {
            index += 1;
            index % 2 == 1
        });
        self.stride *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(spp: u32) -> ErrorPoint {
        ErrorPoint { spp: Some(spp), seconds: f64::from(spp), errors: compare::Errors::default() }
    }

    #[test]
    fn a_long_history_keeps_its_first_and_latest_at_even_distances_in_bounded_memory() {
        let mut history = ErrorHistory::default();
        for spp in 0..10_001 {
            history.push(point(spp));
        }
        let spps: Vec<u32> = history.iter().filter_map(|point| point.spp).collect();
        assert!((MOST_POINTS / 2..=MOST_POINTS + 1).contains(&spps.len()), "{}", spps.len());
        assert_eq!((spps.first(), spps.last()), (Some(&0), Some(&10_000)));
        let (whole, _latest) = spps.split_at(spps.len() - 1);
        assert!(whole.windows(2).all(|pair| pair[1] - pair[0] == 32), "10001 of at most 512: one in 32");
    }

    #[test]
    fn a_short_history_is_all_that_came() {
        let mut history = ErrorHistory::default();
        (1..=3).for_each(|spp| history.push(point(spp)));
        assert_eq!(history.iter().filter_map(|point| point.spp).collect::<Vec<_>>(), [1, 2, 3]);
    }
}
