//! Boxes that meet, found without holding each against every other.

use scene::Vec3;

/// Lower and upper corner of a box.
pub(crate) type Bounds = (Vec3, Vec3);

/// Whether two boxes have a point in common.
pub(super) fn meet(a: Bounds, b: Bounds) -> bool {
    b.0.cmple(a.1).all() && a.0.cmple(b.1).all()
}

/// Calls `found` with the places of any two boxes that have a point in common, each pair once: swept along the axis along
/// which they overlap least.
pub(crate) fn for_each_pair(bounds: &[Bounds], mut found: impl FnMut(usize, usize)) {
    let axis = sparsest_axis(bounds);
    let mut order: Vec<usize> = (0..bounds.len()).collect();
    order.sort_by(|a, b| bounds[*a].0[axis].total_cmp(&bounds[*b].0[axis]));
    for (place, &a) in order.iter().enumerate() {
        let end = bounds[a].1[axis];
        for &b in order[place + 1..].iter().take_while(|&&b| bounds[b].0[axis] <= end) {
            if meet(bounds[a], bounds[b]) {
                found(a.min(b), a.max(b));
            }
        }
    }
}

/// Boxes in which those near another are found quickly.
pub(super) struct SortedBoxes {
    axis: usize,
    /// Where they begin along the axis, and their places, in that order.
    starts: Vec<(f32, u32)>,
    longest: f32,
    bounds: Vec<Bounds>,
}

impl SortedBoxes {
    pub fn new(bounds: Vec<Bounds>) -> Self {
        let axis = sparsest_axis(&bounds);
        let mut starts: Vec<(f32, u32)> = bounds.iter().map(|(low, _)| low[axis]).zip(0..).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let longest = bounds.iter().map(|(low, high)| high[axis] - low[axis]).fold(0.0, f32::max);
        SortedBoxes { axis, starts, longest, bounds }
    }

    /// The places of those that have a point in common with this one.
    pub fn meeting(&self, (low, high): Bounds) -> impl Iterator<Item = usize> {
        // the difference is rounded
        let earliest = (low[self.axis] - self.longest).next_down();
        let first = self.starts.partition_point(|(start, _)| *start < earliest);
        let near = self.starts[first..].iter().take_while(move |(start, _)| *start <= high[self.axis]);
        near.map(|(_, place)| *place as usize).filter(move |place| meet(self.bounds[*place], (low, high)))
    }
}

/// The axis along which boxes are shortest for how far apart they lie.
fn sparsest_axis(bounds: &[Bounds]) -> usize {
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let middles = bounds.iter().map(|(low, high)| 0.5 * (low + high));
    let (low, high) = middles.fold(none, |(low, high), p| (low.min(p), high.max(p)));
    let lengths: Vec3 = bounds.iter().map(|(low, high)| high - low).sum();
    let share = lengths / (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
    (0..3).min_by(|a, b| share[*a].total_cmp(&share[*b])).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::sampler::Sampler;

    #[test]
    fn pairs_are_those_that_meet_each_once() {
        let place = |i: u32| {
            let [x, y, z, size] = Sampler::independent(3, i, 14).unit4(0);
            let low = Vec3::new(x, 0.2 * y, 3.0 * z);
            (low, low + 0.2 * size)
        };
        let boxes: Vec<Bounds> = (0..300).map(place).collect();
        let mut swept = Vec::new();
        for_each_pair(&boxes, |a, b| swept.push((a, b)));
        let meet = |a: &Bounds, b: &Bounds| (0..3).all(|axis| a.0[axis] <= b.1[axis] && b.0[axis] <= a.1[axis]);
        let all = (0..300).flat_map(|a| (a + 1..300).map(move |b| (a, b)));
        let expected: Vec<_> = all.filter(|&(a, b)| meet(&boxes[a], &boxes[b])).collect();
        let sorted = SortedBoxes::new(boxes.clone());
        let found = (0..300).flat_map(|a| sorted.meeting(boxes[a]).map(move |b| (a, b)));
        let mut found: Vec<_> = found.filter(|(a, b)| a < b).collect();
        found.sort_unstable();
        assert_eq!(found, expected);
        swept.sort_unstable();
        assert!(expected.len() > 100);
        assert_eq!(swept, expected);
    }
}
