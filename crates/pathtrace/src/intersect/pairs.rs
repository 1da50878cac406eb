//! Boxes that meet, found without holding each against every other.

use scene::Vec3;

/// Lower and upper corner of a box.
pub(super) type Bounds = (Vec3, Vec3);

/// Calls `found` with the places of any two boxes that have a point in common, each pair once: swept along the axis along
/// which their middles lie farthest apart.
pub(super) fn for_each_pair(bounds: &[Bounds], mut found: impl FnMut(usize, usize)) {
    let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let middles = bounds.iter().map(|(low, high)| 0.5 * (low + high));
    let (low, high) = middles.fold(none, |(low, high), p| (low.min(p), high.max(p)));
    let axis = (high - low).max_position();
    let mut order: Vec<usize> = (0..bounds.len()).collect();
    order.sort_by(|a, b| bounds[*a].0[axis].total_cmp(&bounds[*b].0[axis]));
    for (place, &a) in order.iter().enumerate() {
        let (low, high) = bounds[a];
        for &b in order[place + 1..].iter().take_while(|&&b| bounds[b].0[axis] <= high[axis]) {
            if bounds[b].0.cmple(high).all() && low.cmple(bounds[b].1).all() {
                found(a.min(b), a.max(b));
            }
        }
    }
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
        swept.sort_unstable();
        assert!(expected.len() > 100);
        assert_eq!(swept, expected);
    }
}
