//! A pixel's samples, traced again: those that a film has, and the numbers of the tutorial's integral in them.

#![expect(clippy::expect_used, reason = "a scene that does not load is a failure")]

use film::{Film, Pixel};
use pathtrace::{
    ConesAt, Directions, Estimator, FirstVertex, Integrator, LeftOut, LightPaths, LightSampling, Met,
    MetropolisSettings, NormalsSettings, PathSettings, ProbedPixel, Roulette, SamplerKind, Term, Terms, Tracer,
    WhittedSettings,
};
use scene::{Scene, Vec3, builtin};
use std::path::Path;

const SIZE: [u32; 2] = [12, 9];
/// More than the least that a thread takes at a time.
const SPP: u32 = 150;

fn named(name: &str) -> Scene {
    builtin::named(name).expect("a built-in scene")
}

fn parsed(text: &str) -> Scene {
    scene::parse(text, "a scene", Path::new("scene.toml")).expect("a scene")
}

fn at(scene: &Scene, pixel: [u32; 2]) -> ProbedPixel {
    ProbedPixel { camera: scene.camera, size: SIZE, pixel }
}

/// What walks: every way in which a sample may come to its end.
fn integrators() -> Vec<Integrator> {
    let path = PathSettings::default();
    let estimator = |directions, light| PathSettings { estimator: Estimator { directions, light }, ..path };
    vec![
        path.into(),
        PathSettings {
            roulette: Roulette::OFF,
            bounces: Some(3),
            ..estimator(Directions::Uniform, LightSampling::BsdfOnly)
        }
        .into(),
        PathSettings {
            sampler: SamplerKind::Independent,
            seed: 9,
            connections: false,
            ..estimator(Directions::Cosine, LightSampling::Mis)
        }
        .into(),
        PathSettings { branches: 3, bounces: Some(2), ..path }.into(),
        PathSettings {
            cones: ConesAt::Everything,
            split_glass: true,
            ..estimator(Directions::Cosine, LightSampling::Mis)
        }
        .into(),
        estimator(Directions::Guided, LightSampling::Mis).into(),
        WhittedSettings { shadow_rays: 2, ..WhittedSettings::default() }.into(),
        NormalsSettings::default().into(),
    ]
}

#[test]
fn the_samples_of_a_pixel_are_bit_for_bit_those_that_a_film_adds() {
    for name in ["cornell", "whitted", "phong"] {
        let scene = named(name);
        let tracer = Tracer::new(&scene);
        for integrator in integrators() {
            let mut film = Film::new(SIZE[0], SIZE[1]);
            tracer.render(&mut film, &scene.camera, &integrator, SPP, &|| false);
            for pixel in [[0, 0], [6, 4], [5, 7], [11, 8]] {
                let probed = at(&scene, pixel);
                let samples = tracer.samples_of_pixel(&probed, &integrator, 0..SPP, &|| false).expect("samples");
                let mut sum = Pixel::default();
                samples.iter().for_each(|sample| sum.add(*sample));
                assert_eq!(
                    sum,
                    film.pixels()[(pixel[1] * SIZE[0] + pixel[0]) as usize],
                    "{name} {pixel:?} {integrator:?}"
                );
                let some = tracer.samples_of_pixel(&probed, &integrator, 5..21, &|| false);
                assert_eq!(some.as_deref(), Some(&samples[5..21]), "{name} {pixel:?} {integrator:?}");
            }
        }
    }
}

#[test]
fn what_chooses_its_pixels_itself_has_no_samples_of_one_and_says_why() {
    let scene = named("cornell");
    let chains = Integrator::from(MetropolisSettings::default());
    assert!(chains.binds_pixels().is_some_and(|why| why.contains("Metropolis")));
    assert_eq!(Tracer::new(&scene).samples_of_pixel(&at(&scene, [1, 1]), &chains, 0..4, &|| false), None);
    let path = PathSettings::default().into();
    assert_eq!(Tracer::new(&scene).samples_of_pixel(&at(&scene, [1, 1]), &path, 0..4, &|| true), None, "stopped");
}

/// The product of rounded numbers, against what the walk has rounded in another order.
fn is_close(a: Vec3, b: Vec3) -> bool {
    (a - b).abs().max_element() <= 1e-5 * (a.abs() + b.abs()).max_element() + 1e-12
}

/// All first vertices of some pixels, with the samples that a film has.
fn taken_apart(scene: &Scene, settings: PathSettings, mut check: impl FnMut(&str, FirstVertex, Option<Terms>)) {
    let (tracer, integrator) = (Tracer::new(scene), Integrator::from(settings));
    for pixel in (0..SIZE[0] * SIZE[1]).map(|index| [index % SIZE[0], index / SIZE[0]]) {
        let probed = at(scene, pixel);
        let samples = tracer.samples_of_pixel(&probed, &integrator, 0..8, &|| false).expect("samples");
        for (number, sample) in samples.into_iter().enumerate() {
            let vertex = tracer.first_vertex(&probed, &integrator, number as u32, &|| false).expect("a path");
            let place = format!("{pixel:?}, sample {number}: {vertex:?}");
            assert_eq!(vertex.value, sample, "{place}");
            check(&place, vertex, vertex.terms.ok());
        }
    }
}

/// Every way in which directions and lights are sampled one at a time.
const WAYS: [(Directions, LightSampling); 4] = [
    (Directions::Uniform, LightSampling::BsdfOnly),
    (Directions::Cosine, LightSampling::BsdfOnly),
    (Directions::Cosine, LightSampling::NextEvent),
    (Directions::Cosine, LightSampling::Mis),
];

fn limited((directions, light): (Directions, LightSampling)) -> PathSettings {
    let estimator = Estimator { directions, light };
    PathSettings { estimator, bounces: Some(3), connections: false, ..PathSettings::default() }
}

fn parts(terms: &Terms) -> impl Iterator<Item = Term> + Clone {
    [terms.light, terms.by_chance, terms.onward].into_iter().flatten()
}

/// What a sample is, of the numbers that are told of it.
fn check_numbers(place: &str, vertex: &FirstVertex, terms: &Terms) {
    let sum = parts(terms).map(|term| term.product).sum::<Vec3>() + vertex.emitted;
    assert!(is_close(sum, vertex.value), "{place}");
    for term in parts(terms) {
        let product = term.f_r * term.radiance * (term.cosine.max(0.0) / term.pdf * term.weight * term.survival);
        // what has come to other light was rounded with it
        let rounding = 3e-7 * vertex.value.max_element();
        let off = (product - term.product).abs().max_element();
        assert!(is_close(product, term.product) || off <= rounding, "{product}: {place}");
        assert!(term.product.min_element() >= 0.0 && term.radiance.min_element() >= 0.0, "{place}");
    }
}

#[test]
fn the_numbers_of_the_integral_are_those_that_make_the_sample() {
    let scenes = [named("cornell"), parsed(LAMP)];
    let [mut with_light, mut both, mut by_chance] = [0, 0, 0];
    for (scene, way) in scenes.iter().flat_map(|scene| WAYS.map(|way| (scene, way))) {
        for roulette in [Roulette::OFF, Roulette { probability: Some(0.5), throughput: false }] {
            taken_apart(scene, PathSettings { roulette, ..limited(way) }, |place, vertex, terms| {
                let terms = terms.expect("one direction");
                check_numbers(place, &vertex, &terms);
                assert_eq!(vertex.left_out, LeftOut::default(), "{place}");
                let lit = |term: Option<Term>| term.is_some_and(|term| term.product != Vec3::ZERO);
                with_light += parts(&terms).filter(|term| term.product != Vec3::ZERO).count() as u32;
                both += u32::from(lit(terms.light) && lit(terms.onward));
                by_chance += u32::from(lit(terms.by_chance));
                assert!(way.1 == LightSampling::Mis || terms.by_chance.is_none(), "{place}");
                let Some(leaving) = terms.by_chance.or(terms.onward) else { return };
                // 0.5 is a multiple of the steps of a probability
                let survival = if roulette == Roulette::OFF { 1.0 } else { 2.0 };
                assert!((leaving.survival - survival).abs() < 1e-5, "{place}");
                let density = if way.0 == Directions::Uniform { 0.5 } else { leaving.cosine } / std::f32::consts::PI;
                assert!((leaving.pdf - density).abs() < 1e-5, "{place}");
            });
        }
    }
    assert!(with_light > 1000 && both > 100 && by_chance > 100, "{with_light}, {both}, {by_chance}");
}

/// In the middle of a ball that shines and reflects half, everywhere.
const FURNACE: &str = include_str!("../../../tests/tests/scenes/furnace.toml");

#[test]
fn the_numbers_of_a_part_of_the_light_are_those_that_make_its_sample() {
    let mut skies = 0;
    // whether light that is seen counts, and light straight from a lamp to a diffuse surface
    let classes = [
        ("direct", [true, true]),
        ("indirect", [false, false]),
        ("bounce-0", [false, true]),
        ("emitted", [true, false]),
    ];
    for scene in [named("cornell"), named("whitted"), parsed(FURNACE)] {
        for (way, (class, [seen, straight])) in WAYS.into_iter().flat_map(|way| classes.map(|class| (way, class))) {
            let paths = LightPaths::parse(class).expect("light paths");
            let settings = PathSettings { paths, roulette: Roulette::OFF, ..limited(way) };
            taken_apart(&scene, settings, |place, vertex, terms| {
                let place = format!("{class}, {place}");
                terms.iter().for_each(|terms| check_numbers(&place, &vertex, terms));
                assert!(seen || vertex.emitted == Vec3::ZERO, "{place}");
                assert!(!vertex.left_out.emitted || !seen, "{place}");
                assert!(vertex.met != Met::Light || vertex.left_out.emitted != seen, "{place}");
                skies += u32::from(vertex.met == Met::Sky && vertex.left_out.emitted);
                if vertex.met == Met::Diffuse {
                    assert_eq!(vertex.left_out.direct, !straight, "{place}");
                }
                let Some(terms) = terms else { return };
                let lights = [terms.light, terms.by_chance];
                assert!(straight || lights == [None; 2], "{place}");
                // nothing but a light that is met there comes from where the walk went on
                let rest = terms.onward.filter(|_| terms.light.is_some() && class != "indirect");
                assert!(rest.is_none_or(|rest| rest.product == Vec3::ZERO), "{place}");
            });
        }
    }
    assert!(skies > 0, "that of one scene shines");
}

/// A floor under a lamp, and nothing else.
const LAMP: &str = r#"
camera = { eye = [0, 3, 6], target = [0, 0, 0], fov_y = 40 }
material.floor.diffuse.albedo = [0.6, 0.3, 0.1]
material.lamp.emissive.radiance = [5, 4, 3]
[[rectangle]]
corner = [-9, 0, -9]
edge_u = [0, 0, 18]
edge_v = [18, 0, 0]
material = "floor"
[[rectangle]]
corner = [-2, 3, -2]
edge_u = [4, 0, 0]
edge_v = [0, 0, 4]
material = "lamp"
"#;

#[test]
fn what_arrives_at_a_floor_is_the_lamps_radiance_or_nothing() {
    let lamp = Vec3::new(5.0, 4.0, 3.0);
    let f_r = Vec3::new(0.6, 0.3, 0.1) / std::f32::consts::PI;
    let scene = parsed(LAMP);
    // sampled evenly over its area, or where it is near over its solid angle
    let over_area = |cosine: f32| (3.0 / cosine).powi(2) / (16.0 * cosine);
    for light in [LightSampling::BsdfOnly, LightSampling::Mis] {
        let estimator = Estimator { directions: Directions::Cosine, light };
        let settings = PathSettings { estimator, roulette: Roulette::OFF, bounces: Some(0), ..PathSettings::default() };
        let [mut lit, mut floor] = [0, 0];
        taken_apart(&scene, settings, |place, vertex, terms| {
            if vertex.met != Met::Diffuse {
                return;
            }
            floor += 1;
            let terms = terms.expect("one direction");
            let leaving = terms.by_chance.or(terms.onward).expect("a direction");
            assert!(is_close(leaving.f_r, f_r), "{place}");
            let dark = leaving.radiance == Vec3::ZERO;
            assert!(dark || is_close(leaving.radiance, lamp), "{place}");
            lit += u32::from(!dark);
            if light == LightSampling::BsdfOnly {
                assert_eq!((terms.light, terms.by_chance), (None, None), "{place}");
                return;
            }
            let sampled = terms.light.expect("a light");
            assert!(is_close(sampled.radiance, lamp), "nothing is in the way: {place}");
            assert_eq!((terms.by_chance.is_none(), terms.onward.is_some()), (dark, dark), "one direction: {place}");
            let is_over_area = (over_area(sampled.cosine) / sampled.pdf - 1.0).abs() < 1e-3;
            let light_pdf = if is_over_area { over_area(leaving.cosine) } else { sampled.pdf };
            let weight = if dark { 1.0 } else { leaving.pdf / (leaving.pdf + light_pdf) };
            assert!((leaving.weight - weight).abs() < 1e-4, "{weight}: {place}");
        });
        assert!(floor > 300 && (50..floor - 50).contains(&lit), "{lit} of {floor}");
    }
}

#[test]
fn what_has_no_directions_to_choose_is_told_apart() {
    let mut met = Vec::new();
    let settings = PathSettings { connections: false, ..PathSettings::default() };
    taken_apart(&named("whitted"), settings, |_, vertex, _| {
        if !met.contains(&vertex.met) {
            met.push(vertex.met);
        }
        assert_eq!(vertex.terms.is_err(), [Met::Mirror, Met::Glass].contains(&vertex.met), "{vertex:?}");
        assert!(vertex.met != Met::Sky || vertex.emitted == vertex.value, "{vertex:?}");
    });
    for kind in [Met::Sky, Met::Diffuse, Met::Mirror, Met::Glass] {
        assert!(met.contains(&kind), "{kind:?}: {met:?}");
    }
    let settings = PathSettings { branches: 2, bounces: Some(1), ..settings };
    taken_apart(&named("cornell"), settings, |place, vertex, terms| {
        assert!(vertex.met != Met::Diffuse || terms.is_none(), "{place}");
    });
}
