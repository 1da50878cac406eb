//! The light that a ball of glass sends down.

use crate::hard::spot;
use crate::measure::{Trial, subject};
use crate::surfaces::Place;
use film::Film;
use pathtrace::{Estimator, Integrator, LightTracingSettings, PathSettings, PhotonSettings, Tracer};
use scene::{Scene, Vec3};
use std::path::Path;

/// What connects lights to vertices by way of balls.
pub const CONNECTING: [Estimator; 2] = [Estimator::LIGHT, Estimator::MIS];

/// A ball of index 1 / .7 above a floor so dark that its own light does not count, under a sun without a disc, straight above,
/// that gives the floor a radiance of 1.
const BALL: &str = "[camera]
eye = [4, 2, 0]
target = [0, 0, 0]
fov_y = 0.5
[sun]
towards = [0, 1, 0]
angular_radius = 0
irradiance = [314.15927, 314.15927, 314.15927]
[material.floor]
diffuse = { albedo = [0.01, 0.01, 0.01] }
[material.glass]
dielectric = { ior = 1.4285715 }
[[rectangle]]
corner = [-2, 0, -2]
edge_u = [0, 0, 4]
edge_v = [4, 0, 0]
material = \"floor\"
[[sphere]]
center = [0, 3.3, 0]
radius = 1
material = \"glass\"
";

/// What two refractions leave.
pub fn through_a_ball(estimator: Estimator) -> PathSettings {
    PathSettings { estimator, bounces: Some(2), ..PathSettings::independent() }
}

/// The middle of the caustic by paraxial optics: what passes both surfaces, over the square of what is left of the beam's
/// width at the distance D, `1 - 2 (n - 1) D / n`. It is .76471.
#[expect(clippy::expect_used, reason = "the text is embedded, and a test loads it")]
pub fn middle_of_a_caustic() -> Place {
    let scene: Scene = scene::parse(BALL, "caustic", Path::new("caustic.toml")).expect("an embedded scene");
    let (n, distance) = (1.0f64 / 0.7, 3.3);
    let reflected = ((n - 1.0) / (n + 1.0)).powi(2);
    let expected = ((1.0 - reflected) / (1.0 - 2.0 * (n - 1.0) * distance / n)).powi(2);
    let camera = spot(Vec3::new(4.0, 2.0, 0.0), Vec3::ZERO);
    Place { what: "middle, over the light without the ball".to_owned(), expected, scene, camera }
}

pub fn caustic(trial: &mut Trial) {
    let place = middle_of_a_caustic();
    let tracer = Tracer::new(&place.scene);
    for estimator in CONNECTING {
        trial.traced(&place.what, place.expected, (&tracer, &place.camera), through_a_ball(estimator));
    }
    // a spot that photons can find, and a disc around it
    let photons = trial.pick(1 << 14, 1 << 16);
    let gathered = PhotonSettings { photons, radius: Some(0.05), ..PhotonSettings::default() };
    let light = LightTracingSettings { photons, ..LightTracingSettings::default() };
    for integrator in [Integrator::from(gathered), light.into()] {
        let films: Vec<Film> =
            (1..=8).map(|seed| trial.film((&tracer, &place.scene.camera), integrator.with_seed(seed), 4, 16)).collect();
        let mean = films.iter().map(|film| film.mean()[0]).sum::<f64>() / films.len() as f64;
        // reflections within the ball bring a thousandth; light is blurred by less than a hundredth
        trial.equal(&subject(integrator), &place.what, place.expected, mean, 0.02 * place.expected);
    }
}
