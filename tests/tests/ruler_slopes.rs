//! The bench's own claims, on fixed seeds and sizes: independent numbers make errors fall like samples^-0.50, Sobol
//! points faster, and a limit of bounces leaves a bias that no number of samples takes away.
//!
//! Power: at these sizes the standard errors of slopes of the root of the relMSE are below 0.01, so that 0.05 is more
//! than five of them; samples of which every second one repeats the one before move them by 0.08. The RMSE of the
//! Cornell box is made by the few pixels at its area light's edge: its slope is known to 0.03 only, and held to 0.1.

use bench::line::{self, Line};
use bench::measure::{Measurement, traced};
use bench::plan::{Part, Speed};
use bench::references::{Truth, make};
use bench::summary::Curve;
use bench::variant::Variant;
use compare::Fit;
use pathtrace::{Estimator, SamplerKind};
use scene::Scene;
use std::sync::{Arc, LazyLock};
use technique::{Backend, Renderer, Technique, Threads};

static CORNELL: LazyLock<Subject> = LazyLock::new(|| subject("cornell", None, (64, 64)));

struct Subject {
    part: Part,
    scene: Scene,
    truth: Truth,
}

/// A part of fixed size whose reference has a fixed number of replicates, however long they take.
fn subject(scene: &str, sun_radius: Option<f32>, (width, height): (u32, u32)) -> Subject {
    let part = Part {
        name: scene.into(),
        scene: scene.into(),
        sun_radius,
        width,
        height,
        most_spp: 64,
        reference_seconds: f64::INFINITY,
        speed: Speed { reference: 1.0, lines: 1.0, learning: 0.0, denoising: 0.0 },
    };
    let scene = part.scene().unwrap();
    let mut renderer = Renderer::on_the_processor(Arc::new(scene.clone()), Arc::new(Threads::all()));
    let (truth, _) = make(&part, &mut renderer, None, &mut |_| {}).unwrap();
    Subject { part, scene, truth }
}

impl Subject {
    fn curve(&self, technique: Technique) -> Curve {
        let line = Line { technique, variant: &Variant::ALL[0] };
        let rungs = 0..self.part.ladder().len();
        let integrator = line.integrator(1).expect("it is traced");
        let mut backend = Backend::on_the_processor(&self.scene);
        let measure =
            |rung| traced(&self.part, &self.scene, &mut backend, (&line, &integrator), rung, &self.truth).unwrap();
        let measurements: Vec<Measurement> = rungs.map(measure).collect();
        assert!(measurements.iter().flat_map(|m| &m.pictures).all(|p| p.nonfinite == 0));
        Curve::new(line, &measurements.iter().collect::<Vec<_>>())
    }
}

fn light(sampler: SamplerKind) -> Technique {
    line::path(Estimator::LIGHT, sampler)
}

#[test]
fn independent_numbers_fall_like_the_root_of_samples_and_sobol_points_faster() {
    for subject in [&*CORNELL, &subject("whitted", Some(0.0), (64, 36))] {
        let scene = &subject.scene.name;
        let slopes = |sampler| {
            let curve = subject.curve(light(sampler));
            [curve.slope.unwrap(), curve.relative_slope.unwrap()]
        };
        let (independent, sobol) = (slopes(SamplerKind::Independent), slopes(SamplerKind::Sobol));
        let near = |fit: Fit, tolerance: f64| (fit.slope + 0.5).abs() < tolerance;
        assert!(independent[1].slope_error < 0.01 && near(independent[1], 0.05), "{scene}: {independent:?}");
        let tolerance = if scene == "cornell" { 0.1 } else { 0.05 };
        assert!(near(independent[0], tolerance), "{scene}: {independent:?}");
        assert!(sobol.iter().all(|fit| fit.slope + fit.slope_error < -0.45), "{scene}: {sobol:?}");
        assert!(sobol[1].slope < independent[1].slope - 0.05, "{scene}: {sobol:?}");
    }
}

#[test]
fn few_bounces_flatten_at_their_bias_and_roulette_does_not() {
    let [direct, one] = [0, 1].map(|bounces| CORNELL.curve(line::bounded(bounces)));
    let roulette = CORNELL.curve(line::survived(0.8));
    let ends = [&direct, &one, &roulette].map(|curve| curve.last_slope.unwrap());
    assert!(ends[0].abs() < 0.05 && ends[1] > -0.35 && (ends[2] + 0.5).abs() < 0.08, "{ends:?}");

    let test = |curve: &Curve| curve.last().unwrap().bias_test.unwrap().relative;
    // direct light alone loses more than a fifth of most pixels; what roulette might lose is below what would be
    // noticed
    assert!(test(&direct).found() && test(&direct).bias() > 0.2, "{:?}", test(&direct));
    assert!(test(&one).found(), "{:?}", test(&one));
    assert!(!test(&roulette).found() && test(&roulette).power() < 0.03, "{:?}", test(&roulette));
}
