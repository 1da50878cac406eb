//! Scenes scaled and moved, and geometry that is not what it should be. Files that are refused never come to a device.

use super::{Bench, Outcome};
use crate::area_lights::direct;
use crate::robustness::{Invariant, PLACEMENTS, flat_triangles, invariants, placed, rays_at_corners, under_slivers};
use pathtrace::Estimator;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use scene::Vec3;

pub fn invariance(bench: &mut Bench) -> Outcome {
    for (invariant, in_a_tree) in invariants().into_iter().flat_map(|one| [(one.clone(), false), (one, true)]) {
        let name = if in_a_tree { format!("{}, in a tree", invariant.name) } else { invariant.name };
        let invariant = Invariant { name, ..invariant };
        let new = if in_a_tree { GpuTracer::through_a_tree } else { GpuTracer::new };
        let mut tracer = new(bench.gpu, &invariant.scene)?;
        let mean = |(scale, shift, _)| -> Result<f64, GpuTraceError> {
            let (scene, camera) = placed(invariant.scene.clone(), invariant.camera, scale, shift);
            tracer.set_scene(&scene)?;
            let seen = (&mut tracer, &camera);
            let film = match &invariant.trees {
                Some(trees) => bench.film(seen, *trees, 8, 4),
                None => bench.film(seen, invariant.settings, 32, bench.trial.pick(64, 512)),
            };
            Ok(film?.mean()[0])
        };
        let means: Vec<f64> = PLACEMENTS.into_iter().map(mean).collect::<Result<_, _>>()?;
        invariant.compare(bench.trial, &means);
    }
    Ok(())
}

pub fn degenerate(bench: &mut Bench) -> Outcome {
    let mut mesh = flat_triangles();
    let rays = rays_at_corners(&mesh.positions);
    // one with an area, behind all rays: or there would be no tree to go through
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([Vec3::X, Vec3::Y, Vec3::ONE].map(|p| p + 1e4 * Vec3::Z));
    mesh.triangles.insert(0, [first, first + 1, first + 2]);
    let mut few = mesh.clone();
    few.triangles.truncate(16);
    for (subject, mesh) in [("bvh2", mesh), ("one by one", few)] {
        let answers = bench.tracer(&mesh.scene())?.meet(&rays)?;
        let hits = answers.iter().filter(|answer| answer.t > 0.0 || answer.occluded == 1).count();
        bench.trial.equal(subject, "hits on triangles without area", 0.0, hits as f64, 0.0);
    }
    let (scene, camera, expected) = under_slivers();
    let tracer = &mut bench.tracer(&scene)?;
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        bench.mean("under slivers 1e-6 wide", expected, (tracer, &camera), direct(estimator))?;
    }
    Ok(())
}
