use super::*;
use crate::{Backend, DenoiseSettings, Device, Frame, Pacing, Rendered, Renderer, Threads, Watch};
use pathtrace::{
    Estimator, Integrator, LightTracingSettings, MetropolisSettings, NormalsSettings, PathSettings, PhotonSettings,
    SamplerKind, WhittedSettings,
};
use scene::Scene;
use std::sync::Arc;

const SIZE: (u32, u32) = (19, 11);

/// Keeps halves, and lets passes be as small as they may.
struct Patient;

impl Watch for Patient {
    fn ends_soon(&self, _spp: u32) -> bool {
        false
    }

    fn keeps_parts(&self) -> bool {
        true
    }

    fn pacing(&self, _spent: Duration) -> Pacing {
        Pacing { pass: Duration::ZERO, show: Duration::ZERO, growth: 1 }
    }

    fn show(&self, _frame: Frame) {}
}

fn cornell() -> Arc<Scene> {
    Arc::new(scene::builtin::named("cornell").unwrap())
}

fn samples(mut renderer: Renderer, integrator: &Integrator, [from, to]: [u32; 2]) -> Rendered {
    let blank = Accumulation::beginning_at(from, SIZE).unwrap();
    let camera = renderer.scene().camera;
    renderer.finish(blank, &camera, (integrator, to - from), DenoiseSettings::OFF, &Patient)
}

fn on_the_processor(integrator: &Integrator, range: [u32; 2]) -> Rendered {
    samples(Renderer::on_the_processor(cornell(), Arc::new(Threads::all())), integrator, range)
}

/// But for the rounding of f64, which the order of a sum has a part in.
fn assert_alike(a: &Film, b: &Film, what: &str) {
    assert_eq!(a.nonfinite, b.nonfinite);
    for (a, b) in a.pixels().iter().zip(b.pixels()) {
        assert_eq!((a.samples, a.largest), (b.samples, b.largest), "{what}");
        let sums = a.sum.iter().zip(b.sum).chain(a.sum_of_squares.iter().zip(b.sum_of_squares));
        sums.for_each(|(a, b)| assert!((a - b).abs() <= 1e-14 * b.abs(), "{what}: {a} {b}"));
    }
}

fn every_integrator() -> Vec<Integrator> {
    let guided = Estimator::named("guided").unwrap();
    let independent = SamplerKind::Independent;
    vec![
        PathSettings::default().into(),
        PathSettings { sampler: independent, estimator: guided, ..PathSettings::default() }.into(),
        WhittedSettings::default().into(),
        PhotonSettings { photons: 500, ..PhotonSettings::default() }.into(),
        LightTracingSettings { photons: 500, ..LightTracingSettings::default() }.into(),
        MetropolisSettings::default().into(),
        NormalsSettings::default().into(),
    ]
}

/// Whatever one run takes there, and nothing of what comes before.
#[test]
fn ranges_of_samples_are_together_those_of_one_run() {
    for integrator in every_integrator() {
        let whole = on_the_processor(&integrator, [0, 12]);
        let [mut film, rest] = [[0, 5], [5, 12]].map(|range| on_the_processor(&integrator, range).film);
        assert_eq!(rest.samples_per_pixel(), 7);
        film.add_all(&rest);
        assert_alike(&film, &whole.film, integrator.name());
    }
}

#[test]
fn the_halves_of_a_range_are_its_own() {
    let integrator = PathSettings::default().into();
    let earlier = on_the_processor(&integrator, [5, 13]).earlier.unwrap();
    assert_alike(&earlier, &on_the_processor(&integrator, [5, 9]).film, "half");
}

#[test]
fn a_device_makes_a_range_of_samples_and_the_processor_after_it() {
    let (gpu, scene) = (Gpu::headless().unwrap(), cornell());
    let on_the_device = || {
        let backend = Backend::on_the_device(&gpu, &scene).unwrap();
        Renderer::new(scene.clone(), backend, Arc::new(Threads::all()))
    };
    for integrator in
        [PathSettings::default().into(), PhotonSettings { photons: 500, ..PhotonSettings::default() }.into()]
    {
        let whole = samples(on_the_device(), &integrator, [0, 12]);
        let [mut film, rest] = [[0, 5], [5, 12]].map(|range| samples(on_the_device(), &integrator, range));
        assert_eq!((rest.device, rest.stats.samples), (Device::Gpu, 7 * 19 * 11));
        film.film.add_all(&rest.film);
        let (one, two) = (film.film.image(), whole.film.image());
        assert!(one.radiances().iter().zip(two.radiances()).all(|(a, b)| a.abs_diff_eq(*b, 1e-5 * b.max_element())));
    }
    let integrator = PathSettings::default().into();
    let renderer = on_the_device();
    gpu.device.destroy();
    let rendered = samples(renderer, &integrator, [5, 12]);
    assert_eq!(rendered.device, Device::Cpu);
    assert_alike(&rendered.film, &on_the_processor(&integrator, [5, 12]).film, "after a loss");
}
