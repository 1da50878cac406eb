//! Many samples in one pixel.

use crate::measure::Trial;
use pathtrace::sampler::Sampler;
use scene::Vec3;
use scene::film::Pixel;

pub fn million_samples(trial: &mut Trial) {
    let uniform = |i: u32| Sampler::independent(23, i, 1).unit4(0)[0];
    let streams: [(&str, fn(u32, f32) -> f32); 4] = [
        ("constant .1", |_, _| 0.1),
        ("uniform", |_, u| u),
        ("one in a thousand is 1000", |_, u| if u < 1e-3 { 1000.0 } else { 0.0 }),
        ("ones", |_, _| 1.0),
    ];
    for (name, value) in streams {
        let count = if name == "ones" { trial.pick(1_000_000, 20_000_000) } else { 1_000_000 };
        let (mut pixel, mut exact, mut lost) = (Pixel::default(), 0f64, 0f64);
        for i in 0..count {
            let x = value(i, uniform(i));
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
