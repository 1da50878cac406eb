//! Which shape of the scene a primitive belongs to.

/// For runs of primitives in the scene's order, area lights first, the shape that each run belongs to.
#[derive(Debug, Default)]
pub(crate) struct Owners(Vec<Run>);

#[derive(Debug)]
struct Run {
    /// The first primitive's place in that order.
    first: u32,
    /// Index into the scene's shapes.
    shape: u32,
}

impl Owners {
    /// Says that the primitives from this place on belong to a shape, until the next call; places only grow.
    pub fn begin(&mut self, shape: usize, first: usize) {
        self.0.push(Run { first: first as u32, shape: shape as u32 });
    }

    /// Index into the scene's shapes of what a primitive at this place belongs to. A shape without primitives owns none:
    /// of several runs that begin at one place the last is there.
    pub fn of(&self, id: u32) -> u32 {
        let behind = self.0.partition_point(|run| run.first <= id);
        self.0[behind.saturating_sub(1)].shape
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_primitive_belongs_to_the_run_that_it_lies_in_and_an_empty_run_owns_none() {
        let mut owners = Owners::default();
        for (shape, first) in [(4, 0), (1, 2), (7, 2), (0, 5), (9, 6)] {
            owners.begin(shape, first);
        }
        assert_eq!([0, 1, 2, 3, 4, 5].map(|id| owners.of(id)), [4, 4, 7, 7, 7, 0]);
    }
}
