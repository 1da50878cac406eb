//! Closed scenes that keep all their light, and many samples in one pixel.

use super::{Bench, Outcome};
use crate::area_lights::direct;
use crate::energy::{
    CLOSED, LOST, ROUGH_METAL, SPHERES, after, coated, direct_part, estimators_of_walls, floor_centre, lit_sphere,
    of_coated, power_between_walls, rough_metal, shining, with,
};
use crate::hard::known;
use crate::measure::farthest;
use film::Film;
use pathtrace::{Directions, Estimator, PathSettings, Roulette, WhittedSettings};
use scene::Vec3;

fn without_ambient(depth: u32) -> WhittedSettings {
    WhittedSettings { depth, ambient: Some(0.0), ..WhittedSettings::default() }
}

pub fn white_furnace(bench: &mut Bench) -> Outcome {
    let coat = coated();
    let tracer = &mut bench.tracer(&coat)?;
    for estimator in [Estimator::COSINE, Estimator::MIS] {
        let settings = with(estimator, None, Roulette::OFF);
        bench.mean("metallic-roughness, alpha 1/4", of_coated(), (tracer, &coat.camera), settings)?;
    }
    let metal = rough_metal();
    let tracer = &mut bench.tracer(&metal)?;
    for estimator in [Estimator::COSINE, Estimator::MIS] {
        let settings = with(estimator, None, Roulette::OFF);
        bench.mean("rough metal, alpha 1", ROUGH_METAL, (tracer, &metal.camera), settings)?;
    }
    let scene = known("white-furnace");
    let tracer = &mut bench.tracer(&scene)?;
    for estimator in [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS] {
        let settings = with(estimator, None, Roulette::THROUGHPUT);
        bench.exactly("every pixel, no variance", 1.0, (tracer, &scene.camera), settings)?;
    }
    let constant = Roulette::constant(0.9);
    let both = Roulette { throughput: true, ..constant };
    for (roulette, quantity) in [(constant, "mean, roulette .9"), (both, "mean, roulette .9 and throughput")] {
        let settings = with(Estimator::COSINE, None, roulette);
        bench.mean(quantity, 1.0, (tracer, &scene.camera), settings)?;
    }
    let straight = with(Estimator::COSINE, Some(3), Roulette::OFF);
    let found = bench.mean_of(1.0, 0.002, (tracer, &scene.camera), straight)?;
    let branching = PathSettings { branches: 3, ..straight };
    let quantity = "3 branches against 1, 3 bounces";
    bench.mean(quantity, found.mean, (tracer, &scene.camera), branching)?;
    for (scatterings, lost) in LOST {
        let settings = with(Estimator::COSINE, Some(scatterings - 1), Roulette::OFF);
        let expected = 1.0 - lost;
        let power = bench.trial.pick(0.001, 0.0003) / expected;
        let found = bench.mean_of(expected, power, (tracer, &floor_centre()), settings)?;
        let quantity = format!("floor centre after {scatterings} scatterings");
        bench.trial.equal("path cosine", &quantity, expected, found.mean, 0.001 + 4.0 * found.standard_error);
    }
    Ok(())
}

pub fn closed_box(bench: &mut Bench) -> Outcome {
    let diffuse = known("closed-box");
    let mirrors = known("mirror-box");
    let (walls, reflecting) = (&mut bench.tracer(&diffuse)?, &mut bench.tracer(&mirrors)?);
    for (share, emission) in CLOSED {
        walls.set_scene(&shining(diffuse.clone(), share, emission))?;
        reflecting.set_scene(&shining(mirrors.clone(), share, emission))?;
        let roulettes = [(Roulette::THROUGHPUT, "throughput"), (Roulette::constant(0.9), "constant .9")];
        for estimator in estimators_of_walls(share).filter(|estimator| estimator.directions != Directions::Guided) {
            for (roulette, name) in roulettes.into_iter().take(if share > 0.5 { 1 } else { 2 }) {
                let quantity = format!("mean, albedo {share}, roulette {name}");
                let settings = with(estimator, None, roulette);
                let power = power_between_walls(bench.trial, share);
                bench.mean_to(power, &quantity, 1.0, (walls, &diffuse.camera), settings)?;
            }
        }
        let settings = with(Estimator::LIGHT, None, Roulette::THROUGHPUT);
        bench.mean(&format!("mean, mirrors of {share}"), 1.0, (reflecting, &mirrors.camera), settings)?;
        for scatterings in [1, 4, 8, 16, 64] {
            let expected = after(scatterings, (share, emission));
            let quantity = format!("every pixel, {share}, {scatterings} scatterings");
            let settings = with(Estimator::COSINE, Some(scatterings - 1), Roulette::OFF);
            bench.exactly(&quantity, expected, (walls, &diffuse.camera), settings)?;
            let quantity = format!("{quantity}, mirrors");
            let settings = without_ambient(scatterings);
            bench.exactly(&quantity, expected, (reflecting, &mirrors.camera), settings)?;
        }
    }
    Ok(())
}

pub fn point_light(bench: &mut Bench) -> Outcome {
    let tracer = &mut bench.tracer(&lit_sphere(SPHERES[0]))?;
    for sphere in SPHERES {
        let (radius, albedo, _) = sphere;
        let scene = lit_sphere(sphere);
        tracer.set_scene(&scene)?;
        for estimator in [Estimator::LIGHT, Estimator::MIS, Estimator::UNIFORM_LIGHT] {
            if estimator == Estimator::UNIFORM_LIGHT && albedo > 0.5 {
                continue;
            }
            let quantity = format!("mean, radius {radius}, albedo {albedo}");
            let settings = with(estimator, None, Roulette::THROUGHPUT);
            bench.mean(&quantity, 1.0, (tracer, &scene.camera), settings)?;
        }
        let quantity = format!("every pixel, direct, radius {radius}, albedo {albedo}");
        let settings = without_ambient(WhittedSettings::default().depth);
        bench.exactly(&quantity, direct_part(sphere), (tracer, &scene.camera), settings)?;
    }
    Ok(())
}

pub fn million_samples(bench: &mut Bench) -> Outcome {
    let mut scene = known("camera-inside-glass");
    scene.shapes = [].into();
    scene.sky = Vec3::splat(0.1);
    let tracer = &mut bench.tracer(&scene)?;
    let mut film = Film::new(8, 1);
    let samples = bench.trial.pick(125_000, 1_000_000);
    let trial = &*bench.trial;
    tracer.render(&mut film, &scene.camera, &direct(Estimator::COSINE).into(), samples, &|| trial.stopped())?;
    bench.trial.count_nonfinite(&film);
    let expected = f64::from(0.1f32);
    bench.trial.equal("film", "mean, constant .1", expected, farthest(&film, expected), 1e-6 * expected);
    Ok(())
}
