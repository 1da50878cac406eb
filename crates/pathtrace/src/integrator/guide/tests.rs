use super::histogram::{Finding, Histograms};
use super::*;
use crate::integrator::settings::{Estimator, PathSettings};
use crate::sampling::sampler::Sampler;
use crate::sampling::{cosine_hemisphere, to_world};
use crate::vectors::lane_vector;
use scene::Vec3;

/// A guide whose first cell has seen light from one bin, its second none, its third noise.
fn guide() -> Guide {
    let mut histograms = Histograms::default();
    let mut add = |place, found: f32| {
        histograms.add(&Finding { place, found: Some(found), expected: Vec3::splat(found) });
    };
    for bin in 0..BINS {
        add(bin, if bin == 19 { 50.0 } else { 0.0 });
        add(2 * BINS + bin, Sampler::independent(bin, 0, 1).unit4(0u32)[0]);
    }
    histograms.guide(Cells::new((Vec3::ZERO, Vec3::ONE)))
}

/// The numbers fill the square with the density that is said, and [`Guide::ratio`] says the same of the direction.
#[test]
fn bent_numbers_have_the_density_that_is_told() {
    let (guide, count) = (guide(), 1u32 << 16);
    for cell in 0..3u32 {
        let mut bins = [0.0f64; BINS as usize];
        let mut inverse = 0.0f64;
        for sample in 0..count {
            let [a, b, ..] = Sampler::independent(7, sample, 3).unit4(0u32);
            let bent = guide.bend(cell, [a, b]);
            let [y, x] = bent.u;
            assert!((0.0..1.0).contains(&y) && (0.0..1.0).contains(&x), "{bent:?}");
            bins[(y * 8.0) as usize * 8 + (x * 8.0) as usize] += 1.0 / f64::from(bent.ratio);
            inverse += 1.0 / f64::from(bent.ratio);
        }
        // 1 / ratio has mean 1 over the square and over each bin, with at most five times the variance of the count
        assert!((inverse / f64::from(count) - 1.0).abs() < 0.02, "{cell}: {inverse}");
        for share in bins.map(|sum| sum / f64::from(count) * f64::from(BINS)) {
            assert!((share - 1.0).abs() < 0.25, "{cell}: {share}");
        }
    }
}

#[test]
fn a_direction_has_the_density_with_which_it_was_bent() {
    let guide = guide();
    let normal = Vec3::new(0.3, -0.8, 0.52).normalize();
    let mut differ = 0;
    for sample in 0..10_000u32 {
        let [a, b, ..] = Sampler::independent(1, sample, 9).unit4(0u32);
        let bent = guide.bend(sample % 3, [a, b]);
        let wi = to_world(cosine_hemisphere(bent.u), normal);
        let ratio = guide.ratio(sample % 3, lane_vector(normal), lane_vector(wi));
        differ += u32::from((ratio / bent.ratio - 1.0).abs() > 1e-5);
    }
    // where rounding carries a direction over the side of a bin: some 1e-6 of its width
    assert!(differ <= 3, "{differ}");
}

/// Where light was found there are more directions, but nowhere less than a fifth of the cosine's.
#[test]
fn directions_follow_the_light_and_leave_nothing_out() {
    let guide = guide();
    let at = |cell, row: u32, column: u32| {
        let u = [(row as f32 + 0.5) / 8.0, (column as f32 + 0.5) / 8.0];
        guide.ratio(cell, lane_vector(Vec3::Z), lane_vector(cosine_hemisphere(u)))
    };
    assert!(at(0, 2, 3) > 3.0, "{}", at(0, 2, 3));
    for (row, column) in (0..8).flat_map(|row| (0..8).map(move |column| (row, column))) {
        assert!(at(0, row, column) >= 0.1999, "{row} {column}: {}", at(0, row, column));
        assert!((at(1, row, column) - 1.0).abs() < 1e-5, "nothing was learned there");
    }
}

#[test]
fn radiance_without_end_teaches_nothing() {
    let mut histograms = Histograms::default();
    for bad in [f32::NAN, f32::INFINITY] {
        histograms.add(&Finding { place: 3, found: Some(bad), expected: Vec3::splat(bad) });
    }
    let guide = histograms.guide(Cells::new((Vec3::ZERO, Vec3::ONE)));
    let radiance = guide.radiance::<f32>(0);
    assert!(radiance.x == 0.0 && guide.bend(0, [0.3, 0.4]).ratio == 1.0);
}

/// In a closed box whose walls shine and reflect half, radiance is 1 everywhere: whatever a guide believes.
#[test]
fn a_guide_that_is_wrong_is_unbiased_too() {
    let scene = scene::builtin::named("hard/closed-box").unwrap();
    let tracer = crate::Tracer::new(&scene);
    for estimator in [Estimator::GUIDED, Estimator::GUIDED_MIS, Estimator::GUIDED_CHANCE] {
        let settings = PathSettings { estimator, ..PathSettings::independent() };
        let mut histograms = Histograms::default();
        for cell in 0..cells::CELLS {
            for bin in [7, 8, 30 + cell % 8] {
                let expected = Vec3::new(3.0, 1.0, 0.2) * (cell % 5) as f32;
                histograms.add(&Finding { place: cell * BINS + bin, found: Some(9.0), expected });
            }
        }
        let guide = histograms.guide(Cells::new(scene.bounds()));
        let mut film = film::Film::new(64, 64);
        tracer.render_by(&mut film, &scene.camera, &settings, guide, 64);
        for (mean, error) in film.mean().into_iter().zip(film.standard_error()) {
            assert!(error < 0.003 && (mean - 1.0).abs() < 4.0 * error, "{}: {mean} +- {error}", estimator.name());
        }
    }
}
