//! Pictures of the fake.

use super::{Bench, Outcome};
use crate::fake::{SCALES, scaled};
use crate::hard::known;
use film::{Film, colour};
use raster::{Fake, Raster, RasterError, RasterSettings};
use scene::{Scene, Vec3, builtin};

/// Pixels in a row and in a column.
const SIZE: (u32, u32) = (72, 48);

/// What a square picture of the ball on the floor has at scale 1, where three.js' planes of .1 and 3000 cut nothing: the
/// mean of all three channels.
const BALL_ON_FLOOR: f64 = 0.6913;

/// Shadows of a sun and of an area light, and the cube map of a glass, are at any scale what they are at scale 1.
pub fn at_any_scale(bench: &mut Bench) -> Outcome {
    let mut raster = Raster::new(bench.gpu)?;
    let square = film(bench, &mut raster, &known("ball-on-floor"), &RasterSettings::new(64, 64))?;
    let mean = square.mean().iter().sum::<f64>() / 3.0;
    bench.trial.equal("raster fair", "ball on a floor, mean", BALL_ON_FLOOR, mean, 1e-4);
    for (name, scene) in scenes() {
        for fake in Fake::ALL {
            let subject = format!("raster {}", fake.name());
            let settings = RasterSettings { fake, ..RasterSettings::new(SIZE.0, SIZE.1) };
            let still = film(bench, &mut raster, &scene, &settings)?;
            for scale in SCALES {
                let film = film(bench, &mut raster, &scaled(&scene, scale), &settings)?;
                // what rounding decides at edges
                let most = f64::from(SIZE.0 * SIZE.1 / 500);
                let quantity = format!("{name}, pixels apart by over 1/255, scale {scale}");
                bench.trial.at_most(&subject, &quantity, most, apart(&still, &film));
            }
        }
    }
    Ok(())
}

/// Seen from beside their own cameras: from there the middles of some of whitted's pixels lie on borders of its cells.
fn scenes() -> impl Iterator<Item = (&'static str, Scene)> {
    let builtins = ["whitted", "cornell"].into_iter().filter_map(|name| Some((name, builtin::named(name).ok()?)));
    let builtins = builtins.map(|(name, mut scene)| {
        let sight = scene.camera.target - scene.camera.eye;
        scene.camera.eye += 0.01 * sight.length() * Vec3::new(0.1, 0.7, 1.0);
        (name, scene)
    });
    [("ball on a floor", known("ball-on-floor"))].into_iter().chain(builtins)
}

fn film(bench: &mut Bench, raster: &mut Raster, scene: &Scene, settings: &RasterSettings) -> Result<Film, RasterError> {
    let film = raster.render(scene, &scene.camera, settings)?;
    bench.trial.count_nonfinite(&film);
    Ok(film)
}

/// Pixels whose bytes differ by more than 1: where bytes are drawn, rounding takes them either way.
fn apart(a: &Film, b: &Film) -> f64 {
    let encoded = |radiance: Vec3| radiance.map(|channel| 255.0 * colour::srgb_encode(channel));
    let differ = |(a, b): &(Vec3, Vec3)| (encoded(*a) - encoded(*b)).abs().max_element() > 1.5;
    a.radiances().zip(b.radiances()).filter(differ).count() as f64
}
