//! Steps have the lengths that they should, and coordinates do not depend on when they are asked for.

use super::*;

const SIZE: f32 = 1.0 / 64.0;

/// A step's signed length as a part of the unit interval.
fn length(word: u32) -> f64 {
    f64::from(small_step(word, SIZE).cast_signed()) / 4_294_967_296.0
}

#[test]
fn small_steps_are_log_uniform_and_as_often_forth_as_back() {
    let count = 1 << 16;
    let lengths = || (0..count).map(|i| length(pcg4d([i, 1, 2, 3])[0]));
    let (least, most) = (f64::from(SIZE) / 16.0 * 0.997, f64::from(SIZE));
    assert!(lengths().all(|l| (least..=most).contains(&l.abs())));
    // r is uniform: each fifth of its range holds 13,107 of 65,536 with a standard deviation of 102
    let mut fifths = [0; 5];
    lengths().for_each(|l| fifths[(((f64::from(SIZE) / l.abs()).log2() / 4.0 * 5.0) as usize).min(4)] += 1);
    assert!(fifths.iter().all(|n: &i32| (n - 13_107).abs() < 600), "{fifths:?}");
    let forth = lengths().filter(|l| *l > 0.0).count() as f64;
    assert!((forth - 32_768.0).abs() < 4.0 * 128.0, "{forth}");
}

/// Two chains with the same history in all lanes; `ask` says which blocks are looked at on the way.
fn walked<F: Float>(ask: impl Fn(u32) -> Vec<u32>) -> Vec<[u32; 4]> {
    let mut points = PrimaryPoints::<F>::new(7, SIZE);
    let all = F::M::from_bits(((1u64 << F::LANES) - 1) as u32);
    points.active = all;
    (0..F::LANES).for_each(|lane| points.start(lane, 5, Sampler::independent(1, 2, 3)));
    for mutation in 0..200 {
        for lane in 0..F::LANES {
            let u = points.mutate(lane, 0.02);
            if u < 0.5 {
                points.accept(lane);
            }
        }
        for block in ask(mutation) {
            points.words4(all, F::U::splat(block));
        }
    }
    let words = |block| points.words4(all, F::U::splat(block)).map(|words| of_last_lane::<F>(words));
    [0, 1, 9, 300, 5000].map(words).into()
}

fn of_last_lane<F: Float>(words: F::U) -> u32 {
    let mut lanes = [0; MOST_LANES];
    words.store(&mut lanes);
    lanes[F::LANES - 1]
}

#[test]
fn coordinates_do_not_depend_on_when_they_are_asked_for() {
    let lazily = walked::<f32>(|_| Vec::new());
    let eagerly = walked::<f32>(|_| vec![0, 1, 9, 300, 5000]);
    assert_eq!(lazily, eagerly);
    let now_and_then = walked::<f32>(|mutation| if mutation % 3 == 0 { vec![1, mutation % 10] } else { vec![9] });
    assert_eq!(lazily, now_and_then);
}

#[test]
fn a_point_is_its_start_until_it_moves_and_what_a_large_step_drew_afterwards() {
    let mut points = PrimaryPoints::<f32>::new(7, SIZE);
    let candidate = Sampler { kind: SamplerKind::Sobol, pixel: 4, sample: 11, seed: 2 };
    points.active = true;
    points.start(0, 5, candidate);
    assert_eq!(points.words4(true, 3), candidate.words4(3));
    points.mutate(0, 1.0);
    let proposed = points.words4(true, 3);
    assert_ne!(proposed, candidate.words4(3));
    points.accept(0);
    points.mutate(0, 0.0);
    let nearby = points.words4(true, 3);
    for (far, near) in proposed.into_iter().zip(nearby) {
        let distance = f64::from(near.wrapping_sub(far).cast_signed().unsigned_abs()) / 4_294_967_296.0;
        assert!(distance > 0.0 && distance <= f64::from(SIZE), "{distance}");
    }
    assert_eq!(points.up_to_date(true, 3), proposed, "a proposal that is not taken leaves the point");
}

/// What a path of the most vertices asks for: all of it is kept, in places of their own.
#[test]
fn every_block_of_a_path_is_kept() {
    use crate::integrator::path_state::PathStates;
    use simd::Vector;
    let ray = crate::intersect::Rays::new(Vector::zero(), Vector::splat([0.0, 0.0, 1.0]));
    let mut path = PathStates::<f32>::leaving_camera(&ray);
    let mut slots = vec![slot(0)];
    for vertices in 0..=PathSettings::HARD_CAP {
        path.vertices = vertices;
        slots.extend([path.direction_dimension(), path.light_dimension(), path.connection_dimension()].map(slot));
    }
    assert!(slots.iter().all(|slot| *slot < KEPT_BLOCKS));
    let count = slots.len();
    slots.sort_unstable();
    slots.dedup();
    assert_eq!(slots.len(), count);
}
