//! Surfaces that are far away, lie in one another, touch, or lie in the sides of a pattern's cells.

use super::{Bench, Outcome};
use crate::area_lights::{direct, shadow_rays};
use crate::dielectrics::{to_depth, without_roulette};
use crate::measure::{farthest, subject};
use crate::surfaces::{
    CONTACT_DEPTH, FAR_PICTURE, Place, SAMPLING, boards, coinciding_lamps, contacts, endless, far_lamps, galleries,
};
use pathtrace::gpu::GpuTracer;
use pathtrace::{Estimator, Integrator};

impl Bench<'_, '_> {
    /// A picture whose every pixel is as expected, without noise.
    fn place(
        &mut self,
        place: &Place,
        tracer: &mut GpuTracer,
        integrator: impl Into<Integrator>,
        tolerance: f64,
    ) -> Outcome {
        let integrator = integrator.into();
        let film = self.film((tracer, &place.camera), integrator, 8, 8)?;
        let measured = farthest(&film, place.expected);
        self.trial.equal(&subject(integrator), &place.what, place.expected, measured, tolerance);
        Ok(())
    }
}

pub fn far_lamp(bench: &mut Bench) -> Outcome {
    let places = far_lamps();
    let tracer = &mut bench.tracer(&places[0].scene)?;
    for place in &places {
        tracer.set_scene(&place.scene)?;
        let integrators = SAMPLING.map(|estimator| Integrator::from(direct(estimator)));
        for integrator in integrators.into_iter().chain([shadow_rays(2).into()]) {
            let film = bench.film((tracer, &place.camera), integrator, FAR_PICTURE.0, FAR_PICTURE.1)?;
            let measured = farthest(&film, place.expected);
            bench.trial.equal(&subject(integrator), &place.what, place.expected, measured, 1e-5 * place.expected);
        }
    }
    Ok(())
}

pub fn lamps_in_one_place(bench: &mut Bench) -> Outcome {
    let places = coinciding_lamps();
    let list = &mut bench.tracer(&places[0].scene)?;
    let tree = &mut GpuTracer::through_a_tree(bench.gpu, &places[0].scene)?;
    for Place { what, expected, scene, camera } in &places {
        list.set_scene(scene)?;
        tree.set_scene(scene)?;
        for estimator in SAMPLING {
            // many lights of a mesh spread their samples
            let power = bench.trial.power();
            bench.mean_to(power, what, *expected, (list, camera), direct(estimator))?;
        }
        bench.mean(what, *expected, (list, camera), shadow_rays(2))?;
        let quantity = format!("{what}, through a tree");
        bench.mean(&quantity, *expected, (tree, camera), direct(Estimator::LIGHT))?;
    }
    Ok(())
}

pub fn contact(bench: &mut Bench) -> Outcome {
    let places = contacts();
    let list = &mut bench.tracer(&places[0].scene)?;
    let tree = &mut GpuTracer::through_a_tree(bench.gpu, &places[0].scene)?;
    for place in &places {
        list.set_scene(&place.scene)?;
        tree.set_scene(&place.scene)?;
        bench.mean(&place.what, place.expected, (list, &place.camera), without_roulette())?;
        bench.place(place, list, to_depth(CONTACT_DEPTH), 2e-5)?;
        bench.place(place, tree, to_depth(CONTACT_DEPTH), 2e-5)?;
    }
    Ok(())
}

pub fn gallery(bench: &mut Bench) -> Outcome {
    let places = galleries();
    let tracer = &mut bench.tracer(&places[0].scene)?;
    for place in &places {
        tracer.set_scene(&place.scene)?;
        bench.place(place, tracer, endless(), 0.0)?;
        bench.place(place, tracer, to_depth(64), 0.0)?;
    }
    Ok(())
}

pub fn board(bench: &mut Bench) -> Outcome {
    let places = boards();
    let list = &mut bench.tracer(&places[0].scene)?;
    let tree = &mut GpuTracer::through_a_tree(bench.gpu, &places[0].scene)?;
    for place in &places {
        list.set_scene(&place.scene)?;
        tree.set_scene(&place.scene)?;
        bench.place(place, list, without_roulette(), 1e-5)?;
        bench.place(place, tree, without_roulette(), 1e-5)?;
    }
    Ok(())
}
