//! Glass.

use super::{Bench, Outcome};
use crate::caustics::{CONNECTING, middle_of_a_caustic, through_a_ball};
use crate::dielectrics::{
    BESIDE_THE_AXIS, CAPPED, NOWHERE, PASSES, REFLECTIONS, REFLECTIONS_OF_CAPPED, SHIFTS, THICKNESSES, after, apart,
    at_80_degrees, beside_the_axis, compare_angle, compare_exits, compare_shifts, down_to_grazing, off_the_normal,
    rays_at_the_sphere, reflectances, slab_of, slanting_ray, small_slab, to_depth, with_and_without, without_roulette,
};
use crate::hard::known;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::intersect::Ray;
use pathtrace::{Estimator, PathSettings, Roulette, SamplerKind};
use scene::{Bsdf, Scene, Vec3};

/// The slab, its upper face at z = 0, of another index.
fn slab_of_index(ior: f32) -> Scene {
    let mut scene = known("slab");
    for material in &mut scene.materials {
        if let Bsdf::Dielectric { ior: of_glass } = &mut material.bsdf {
            *of_glass = ior;
        }
    }
    scene
}

/// A ray that meets the upper face at the origin with this cosine, to the last bit: the normal is an axis.
fn at_the_upper_face(cosine: f32, entering: bool) -> Ray {
    let direction = Vec3::new((1.0 - cosine * cosine).sqrt(), 0.0, if entering { -cosine } else { cosine });
    Ray::new(-direction, direction)
}

pub fn caustic(bench: &mut Bench) -> Outcome {
    let place = middle_of_a_caustic();
    let mut tracer = bench.tracer(&place.scene)?;
    for estimator in CONNECTING {
        bench.mean(&place.what, place.expected, (&mut tracer, &place.camera), through_a_ball(estimator))?;
    }
    Ok(())
}

pub fn fresnel(bench: &mut Bench) -> Outcome {
    let all = reflectances();
    let mut measured = vec![f32::NAN; all.len()];
    let mut tracer = bench.tracer(&slab_of_index(1.5))?;
    for ior in [1.5, 1.0001] {
        tracer.set_scene(&slab_of_index(ior))?;
        let at_the_slab = |i: &usize| all[*i].interface.ior == ior && all[*i].cosine > 0.0;
        let asked: Vec<usize> = (0..all.len()).filter(at_the_slab).collect();
        let rays: Vec<Ray> =
            asked.iter().map(|&i| at_the_upper_face(all[i].cosine, all[i].interface.entering)).collect();
        for (i, answer) in asked.into_iter().zip(tracer.meet(&rays)?) {
            measured[i] = answer.reflectance;
        }
    }
    // along a plane no ray meets it; along a sphere it does
    let sphere = bench.tracer(&known("glass-sphere-in-furnace"))?;
    let along = sphere.meet(&[Ray::new(Vec3::new(-2.0, 1.0, 0.0), Vec3::X)])?[0];
    for (one, measured) in all.iter().zip(measured) {
        one.compare(bench.trial, if one.cosine == 0.0 { along.reflectance } else { measured });
    }
    tracer.set_scene(&slab_of_index(1.5))?;
    let answer = tracer.meet(&[Ray::new(at_80_degrees(), -at_80_degrees())])?[0];
    compare_angle(bench.trial, answer.refracted);
    Ok(())
}

pub fn index_one(bench: &mut Bench) -> Outcome {
    let [with, without] = with_and_without();
    let camera = with.camera;
    let estimators = [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS];
    let (mut paths, mut trees) = (Vec::new(), Vec::new());
    for scene in [&with, &without] {
        let tracer = &mut bench.tracer(scene)?;
        // one sample a pixel, in the same place of both pictures
        for estimator in estimators {
            let settings = PathSettings { estimator, ..without_roulette() };
            paths.push(bench.film((tracer, &camera), settings, 128, 1)?);
        }
        trees.push(bench.film((tracer, &camera), to_depth(16), 128, 1)?);
    }
    let (with, without) = paths.split_at(estimators.len());
    for ((estimator, with), without) in estimators.iter().zip(with).zip(without) {
        bench.trial.at_most(&format!("path {}", estimator.name()), "largest difference", 1e-5, apart(with, without));
    }
    bench.trial.at_most("whitted", "largest difference", 1e-5, apart(&trees[0], &trees[1]));
    let slab = bench.tracer(&slab_of_index(1.0))?;
    let rays: Vec<Ray> = down_to_grazing()
        .flat_map(|wo| [Ray::new(wo, -wo), Ray::new(wo * Vec3::new(1.0, 1.0, -1.0), wo * Vec3::new(-1.0, 1.0, 1.0))])
        .collect();
    let (mut turned, mut reflected) = (0f32, 0f32);
    for (ray, answer) in rays.iter().zip(slab.meet(&rays)?) {
        turned = turned.max((answer.refracted - ray.direction).abs().max_element());
        reflected = reflected.max(answer.reflectance);
    }
    bench.trial.at_most("refraction", "largest change of direction at index 1", 1e-6, f64::from(turned));
    bench.trial.at_most("fresnel", "largest reflectance at index 1", 0.0, f64::from(reflected));
    Ok(())
}

pub fn slab(bench: &mut Bench) -> Outcome {
    let tracer = &mut bench.tracer(&slab_of(1.0, true))?;
    for thickness in THICKNESSES {
        for behind in [true, false] {
            tracer.set_scene(&slab_of(thickness, behind))?;
            for (degrees, passes) in PASSES {
                let camera = off_the_normal(degrees);
                let (expected, what) = if behind { (passes, "passes") } else { (1.0 - passes, "is reflected") };
                let quantity = format!("thickness {thickness}, {degrees} degrees, {what}");
                bench.exactly(&quantity, expected, (tracer, &camera), to_depth(64))?;
                if thickness == 1e-4 || bench.trial.full() {
                    bench.mean(&quantity, expected, (tracer, &camera), without_roulette())?;
                }
            }
        }
        tracer.set_scene(&slab_of(thickness, true))?;
        for (degrees, table) in CAPPED {
            for (reflections, expected) in REFLECTIONS_OF_CAPPED.into_iter().zip(table) {
                let quantity = format!("thickness {thickness}, {degrees} degrees, {reflections} internal reflections");
                let settings = to_depth(2 + reflections);
                bench.exactly(&quantity, expected, (tracer, &off_the_normal(degrees)), settings)?;
            }
        }
        tracer.set_scene(&small_slab(thickness))?;
        let exits = through_glass(tracer, &SHIFTS.map(|(degrees, _)| slanting_ray(thickness, degrees)))?;
        compare_shifts(bench.trial, thickness, &exits);
    }
    Ok(())
}

/// Rays that enter glass and leave it again, without reflections; they start where they left.
fn through_glass(tracer: &GpuTracer, rays: &[Ray]) -> Result<Vec<Ray>, GpuTraceError> {
    let goes_on = |rays: &[Ray]| -> Result<Vec<Ray>, GpuTraceError> {
        Ok(tracer.meet(rays)?.iter().map(|answer| answer.behind().unwrap_or(NOWHERE)).collect())
    };
    goes_on(&goes_on(rays)?)
}

pub fn through_a_sphere(bench: &mut Bench) -> Outcome {
    let tracer = bench.tracer(&known("glass-sphere-in-furnace"))?;
    let exits = through_glass(&tracer, &rays_at_the_sphere())?;
    compare_exits(bench.trial, &exits);
    Ok(())
}

pub fn furnace(bench: &mut Bench) -> Outcome {
    for name in ["glass-sphere-in-furnace", "nested-glass"] {
        let scene = known(name);
        let tracer = &mut bench.tracer(&scene)?;
        for sampler in SamplerKind::ALL {
            let quantity = format!("every pixel, {name}, {}", sampler.name());
            let settings = PathSettings { sampler, ..without_roulette() };
            bench.exactly(&quantity, 1.0, (tracer, &scene.camera), settings)?;
        }
    }
    let tracer = &mut bench.tracer(&known("glass-sphere-in-furnace"))?;
    for b in BESIDE_THE_AXIS {
        for reflections in REFLECTIONS {
            let (expected, camera) = (after(reflections, b), beside_the_axis(b));
            let quantity = format!("b = {b}, {reflections} internal reflections");
            bench.exactly(&quantity, expected, (tracer, &camera), to_depth(2 + reflections))?;
            let capped = PathSettings { bounces: Some(1 + reflections), ..without_roulette() };
            bench.mean(&quantity, expected, (tracer, &camera), capped)?;
        }
    }
    Ok(())
}

pub fn camera_inside(bench: &mut Bench) -> Outcome {
    let scene = known("camera-inside-glass");
    let tracer = &mut bench.tracer(&scene)?;
    for roulette in [Roulette::OFF, Roulette::THROUGHPUT] {
        let settings = PathSettings { roulette, ..PathSettings::independent() };
        bench.exactly("every pixel", 1.0, (tracer, &scene.camera), settings)?;
    }
    bench.exactly("every pixel", 1.0, (tracer, &scene.camera), to_depth(64))
}
