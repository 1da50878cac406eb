//! Many samples in one pixel.

use crate::measure::Trial;
use film::Pixel;
use pathtrace::sampling::sampler::Sampler;
use scene::Vec3;

pub fn million_samples(trial: &mut Trial) {
    let uniform = |i: u32| Sampler::independent(23, i, 1).unit4(0)[0];
    // constant, multiple of a uniform number, and what one in a thousand is instead
    let streams = [
        ("constant .1", 0.1f32, 0.0f32, None),
        ("uniform", 0.0, 1.0, None),
        ("one in a thousand is 1000", 0.0, 0.0, Some(1000.0f32)),
        ("ones", 1.0, 0.0, None),
    ];
    for (name, constant, slope, rare) in streams {
        let count = if name == "ones" { trial.pick(1_000_000, 20_000_000) } else { 1_000_000 };
        let value = |u: f32| rare.filter(|_| u < 1e-3).unwrap_or(constant + slope * u);
        let (mut pixel, mut exact, mut lost) = (Pixel::default(), 0f64, 0f64);
        for i in 0..count {
            let x = value(uniform(i));
            pixel.add(Vec3::splat(x));
            // Kahan's sum in f64, as exact as is needed here
            let y = f64::from(x) - lost;
            let t = exact + y;
            lost = (t - exact) - y;
            exact = t;
        }
        let expected = exact / f64::from(count);
        trial.equal("film", &format!("mean, {name}"), expected, pixel.mean()[0], 1e-6 * expected);
    }
}
