use super::*;
use crate::sampling;
use crate::sampling::sampler::Sampler;
use film::Image;

/// A sky of random greys with a black row, a black corner and a texel 1000 times as bright.
fn sky(width: u32, height: u32, rotation: f32) -> Environment {
    let texel = |i: u32| match (i % width, i / width) {
        (_, 2) | (0, 0) => Vec3::ZERO,
        (3, 4) => Vec3::splat(1000.0),
        _ => Vec3::splat(Sampler::independent(i, 0, 3).unit4(0)[0]),
    };
    let image = Image::new(width, height, (0..width * height).map(texel).collect::<Vec<_>>()).unwrap();
    Environment::new(&EnvironmentMap::new(image, 2.0, rotation).unwrap()).unwrap()
}

fn random(i: u32) -> [f32; 2] {
    let [u, v, ..] = Sampler::independent(7, i, 11).unit4(0);
    [u, v]
}

#[test]
fn a_black_map_is_no_light() {
    let map = EnvironmentMap::new(Image::new(2, 1, [Vec3::ZERO; 2]).unwrap(), 1.0, 0.0).unwrap();
    assert!(Environment::new(&map).is_none());
}

/// By the midpoint rule in height and azimuth, whose cells have one solid angle: texels' edges fall within cells, which
/// makes errors of about 1 / 700 of the brightest texel's share.
#[test]
fn the_density_integrates_to_one() {
    for environment in [sky(9, 6, 0.0), sky(64, 32, 100.0), sky(1, 5, 0.0)] {
        let side = 1400;
        let mut sum = 0.0;
        for i in 0..side * side {
            let [u, v] = [i % side, i / side].map(|k| (k as f32 + 0.5) / side as f32);
            sum += f64::from(environment.look_up(lane_vector(sampling::cone(2.0, [u, v]))).1);
        }
        let integral = sum * 4.0 * std::f64::consts::PI / f64::from(side * side);
        assert!((integral - 1.0).abs() < 5e-3, "{integral}");
    }
}

/// Chi-square of 400,000 samples against the texels' probabilities, cut into four by their middles: 4 * 9 * 6 cells,
/// those of the 9 + 1 black texels left out, make 175 degrees of freedom, whose 99.99 % quantile is 253.
#[test]
fn samples_follow_their_density() {
    let environment = sky(9, 6, 0.0);
    let n = 400_000;
    let mut cells = vec![0u32; 18 * 12];
    let depths: Vec<f64> = row_bounds(6).collect();
    for i in 0..n {
        let wi = glam_vector(environment.sample(random(i)).wi);
        let depth = -f64::from(wi.y);
        let row = depths[1..6].iter().filter(|&&bound| depth >= bound).count();
        let lower = depth >= 0.5 * (depths[row] + depths[row + 1]);
        let across = (f64::from(-wi.x).atan2(f64::from(wi.z)) / std::f64::consts::TAU).rem_euclid(1.0) * 18.0;
        cells[(2 * row + usize::from(lower)) * 18 + (across as usize).min(17)] += 1;
    }
    let (mut chi_square, mut freedom) = (0.0, 0);
    for (cell, &count) in cells.iter().enumerate() {
        let (row, column) = (cell / 36, cell % 18 / 2);
        let solid_angle = (depths[row + 1] - depths[row]) * std::f64::consts::TAU / 9.0;
        let density = environment.density::<f32>(row as u32, column as u32);
        let expected = 0.25 * f64::from(n) * f64::from(density) * solid_angle;
        if expected == 0.0 {
            assert_eq!(count, 0, "a black texel is drawn");
            continue;
        }
        freedom += 1;
        chi_square += (f64::from(count) - expected).powi(2) / expected;
    }
    assert_eq!(freedom, 4 * (9 * 6 - 10));
    assert!(chi_square < 254.0, "{chi_square} of {freedom} cells");
}

/// But for directions within rounding of a texel's edge.
#[test]
fn what_is_drawn_is_found_again_with_its_density_and_radiance() {
    for (environment, allowed) in [(sky(9, 6, 0.0), 2), (sky(9, 6, 123.0), 2), (sky(500, 400, 33.0), 200)] {
        let environment = environment.chosen_with(0.25);
        let mut other = 0;
        for i in 0..50_000 {
            let sample = environment.sample(random(i));
            assert!((glam_vector(sample.wi).length() - 1.0).abs() < 1e-6);
            assert!(sample.pdf > 0.0 && sample.pdf.is_finite());
            let (radiance, pdf) = environment.look_up(sample.wi);
            other += u32::from(pdf != 0.25 * sample.pdf || glam_vector(radiance) != glam_vector(sample.radiance));
        }
        assert!(other <= allowed, "{other}");
    }
}

#[test]
fn samples_are_finite_at_both_ends_of_the_random_numbers() {
    let last = 1.0 - f32::EPSILON / 2.0;
    for environment in [sky(9, 6, 10.0), sky(1, 5, 0.0), sky(300, 200, 359.0)] {
        for u in [[0.0, 0.0], [last, last], [0.0, last], [last, 0.0]] {
            let sample = environment.sample(u);
            assert!((glam_vector(sample.wi).length() - 1.0).abs() < 1e-6 && sample.pdf > 0.0);
        }
        for axis in Vec3::AXES {
            for direction in [axis, -axis] {
                let (radiance, pdf) = environment.look_up(lane_vector(direction));
                assert!(glam_vector(radiance).is_finite() && pdf.is_finite());
            }
        }
    }
}

/// The middle of the picture lies towards -z, its right half towards +x; a turn moves it as it moves a box.
#[test]
fn the_picture_lies_where_the_scene_file_says() {
    let numbered = |rotation| {
        let texel = |i: u32| Vec3::splat(1.0 + i as f32);
        let image = Image::new(4, 2, (0..8).map(texel).collect::<Vec<_>>()).unwrap();
        Environment::new(&EnvironmentMap::new(image, 1.0, rotation).unwrap()).unwrap()
    };
    let at = |environment: &Environment, direction: Vec3| environment.look_up(lane_vector(direction.normalize())).0.x;
    let plain = numbered(0.0);
    let [left, right] = [-0.1, 0.1].map(|x| at(&plain, Vec3::new(x, 0.5, -1.0)));
    assert_eq!([left, right], [2.0, 3.0]);
    assert_eq!(at(&plain, Vec3::new(0.1, -0.5, 1.0)), 8.0);
    // a box turned by 90 degrees takes +x to +z, and -z to +x
    let turned = numbered(90.0);
    assert_eq!(at(&turned, Vec3::new(1.0, 0.5, -0.1)), at(&plain, Vec3::new(-0.1, 0.5, -1.0)));
    assert_eq!(at(&turned, Vec3::new(1.0, 0.5, 0.1)), at(&plain, Vec3::new(0.1, 0.5, -1.0)));
}
