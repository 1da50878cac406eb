//! The truth against an independent renderer, block by block: `tests/data` says where the values come from.

use film::Film;
use pathtrace::{Estimator, PathSettings, Roulette, SamplerKind, Tracer};
use scene::{Scene, builtin};
use serde_json::Value;

fn reference(text: &str) -> Value {
    serde_json::from_str(text).expect("reference values")
}

fn rgb(value: &Value) -> [f64; 3] {
    std::array::from_fn(|channel| value[channel].as_f64().expect("a number"))
}

fn render(scene: &Scene, size: (u32, u32), spp: u32, settings: &PathSettings) -> Film {
    let mut film = Film::new(size.0, size.1);
    Tracer::new(scene).render(&mut film, &scene.camera, &(*settings).into(), spp, &|| false);
    assert_eq!(film.nonfinite, 0);
    film
}

/// Mean and its standard error over some pixels.
fn over(film: &Film, keep: impl Fn(u32, u32) -> bool) -> ([f64; 3], [f64; 3]) {
    let (mut sum, mut variance, mut count) = ([0.0; 3], [0.0; 3], 0.0);
    for y in 0..film.height() {
        for x in (0..film.width()).filter(|&x| keep(x, y)) {
            let pixel = &film.pixels()[(y * film.width() + x) as usize];
            for c in 0..3 {
                sum[c] += pixel.mean()[c];
                variance[c] += pixel.variance_of_mean()[c];
            }
            count += 1.0;
        }
    }
    (sum.map(|s| s / count), variance.map(|v| v.sqrt() / count))
}

/// Standard errors that one of 768 comparisons (256 blocks, 3 channels) exceeds by chance in one run of a hundred, by
/// Šidák's correction: two-sided, 1 - .99^(1 / 768).
const SIDAK: f64 = 4.36;

/// Every block agrees within [`SIDAK`] standard errors of both renderers together, beside the five digits that the
/// reference was rounded to.
fn assert_blocks_agree(film: &Film, reference: &Value, block: u32) {
    let (mut worst, mut blocks) = (0.0f64, 0);
    for (row, means) in reference["mean_grid"].as_array().expect("rows").iter().enumerate() {
        for (column, mean) in means.as_array().expect("columns").iter().enumerate() {
            let (ours, our_error) = over(film, |x, y| x / block == column as u32 && y / block == row as u32);
            let (theirs, their_error) = (rgb(mean), rgb(&reference["se_grid"][row][column]));
            for c in 0..3 {
                let error = our_error[c].hypot(their_error[c]);
                let allowed = SIDAK * error + 2e-5 * theirs[c] + 1e-6;
                let off = (ours[c] - theirs[c]).abs();
                worst = worst.max(off / allowed);
                assert!(
                    off <= allowed,
                    "block ({column}, {row}) channel {c}: {} against {} +- {error}",
                    ours[c],
                    theirs[c]
                );
            }
            blocks += 1;
        }
    }
    println!("{blocks} blocks agree; the worst uses {:.0} % of what is allowed", 100.0 * worst);
}

#[test]
fn cornell_agrees_block_by_block_and_outside_the_area_light() {
    let scene = builtin::named("cornell").expect("built in");
    for (text, bounces, roulette) in [
        (include_str!("../data/cornell.json"), None, Roulette::THROUGHPUT),
        (include_str!("../data/cornell-2-bounces.json"), Some(2), Roulette::OFF),
    ] {
        let settings = PathSettings { bounces, roulette, ..PathSettings::independent() };
        let film = render(&scene, (128, 128), 512, &settings);
        let expected = reference(text);
        for (mean, theirs) in film.mean().into_iter().zip(rgb(&expected["mean"])) {
            assert!((mean / theirs - 1.0).abs() < 0.005, "{mean} against {theirs}");
        }
        let side = |name: &str, end: usize| expected["lamp_box"][name][end].as_u64().expect("a pixel") as u32;
        let (rows, columns) = (side("rows", 0)..side("rows", 1), side("cols", 0)..side("cols", 1));
        let (outside, _) = over(&film, |x, y| !(rows.contains(&y) && columns.contains(&x)));
        for (mean, theirs) in outside.into_iter().zip(rgb(&expected["outside_mean"])) {
            assert!((mean / theirs - 1.0).abs() < 0.005, "outside the lamp: {mean} against {theirs}");
        }
        assert_blocks_agree(&film, &expected, 8);
    }
}

#[test]
fn every_estimator_agrees_on_cornell_block_by_block() {
    let scene = builtin::named("cornell").expect("built in");
    let expected = reference(include_str!("../data/cornell.json"));
    for estimator in Estimator::EVERY {
        let film = render(&scene, (128, 128), 384, &PathSettings { estimator, seed: 9, ..PathSettings::independent() });
        print!("{}: ", estimator.name());
        assert_blocks_agree(&film, &expected, 8);
    }
    let sobol = PathSettings { sampler: SamplerKind::Sobol, estimator: Estimator::MIS, ..PathSettings::independent() };
    let film = render(&scene, (128, 128), 128, &sobol);
    for (mean, theirs) in film.mean().into_iter().zip(rgb(&expected["mean"])) {
        assert!((mean / theirs - 1.0).abs() < 0.005, "Sobol: {mean} against {theirs}");
    }
}

/// With a delta sun the picture has little noise: glass, mirror, shadows and sky block by block.
#[test]
fn whitted_under_a_delta_sun_agrees_block_by_block() {
    let mut scene = builtin::named("whitted").expect("built in");
    if let Some(sun) = &mut scene.sun {
        sun.angular_radius = 0.0;
    }
    let expected = reference(include_str!("../data/whitted-sun-0.json"));
    for estimator in Estimator::EVERY.into_iter().filter(|estimator| estimator.samples_lights()) {
        // the other renderer finds no caustic of a light without extent
        let settings = PathSettings { estimator, connections: false, ..PathSettings::independent() };
        let film = render(&scene, (192, 108), 256, &settings);
        print!("{}: ", estimator.name());
        assert_blocks_agree(&film, &expected, 12);
    }
}

/// With a sun of 2.5 degrees the caustic's rare bright paths make block errors unreliable; the whole picture is
/// compared within 1 %, four times what 64 batches of this length spread by.
#[test]
fn whitted_under_a_wide_sun_agrees_as_a_whole() {
    let scene = builtin::named("whitted").expect("built in");
    let film = render(&scene, (192, 108), 2048, &PathSettings::independent());
    let expected = reference(include_str!("../data/whitted-sun-2.5.json"));
    for (mean, theirs) in film.mean().into_iter().zip(rgb(&expected["mean"])) {
        assert!((mean / theirs - 1.0).abs() < 0.01, "{mean} against {theirs}");
    }
}
