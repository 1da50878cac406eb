//! Direct light of area lights over a grey floor.

use super::{Bench, Outcome};
use crate::area_lights::{
    DISKS, EDGE_ON, FINDING_AN_EDGE, RECTANGLE, SPHERES, SQUARES, WALL, along_the_edge, beside_the_plane,
    beside_the_wall, direct, facing_squares, from_above, mesh_area_light, over_the_square, shadow_rays, under_a_disk,
    under_a_sphere,
};
use crate::hard::{known, with_geometry};
use pathtrace::intersect::Ray;
use pathtrace::{Estimator, PathSettings};
use scene::{Geometry, Scene, Vec3};

pub fn rectangle(bench: &mut Bench) -> Outcome {
    let scene = known("rectangle-light");
    let tracer = &mut bench.tracer(&scene)?;
    for (x, y, expected) in RECTANGLE {
        let camera = from_above(x, y, 0.5);
        let quantity = format!("at ({x}, {y})");
        for estimator in Estimator::on_devices() {
            // far off, few of the directions by chance meet the area light
            if estimator.samples_lights() || expected > bench.trial.pick(1.0, 0.1) {
                bench.mean(&quantity, expected, (tracer, &camera), direct(estimator))?;
            }
        }
        let branching = PathSettings { branches: 4, ..direct(Estimator::MIS) };
        bench.mean(&format!("{quantity}, 4 branches"), expected, (tracer, &camera), branching)?;
        for rays in [1, 4] {
            let quantity = format!("{quantity}, {rays} shadow rays");
            bench.mean(&quantity, expected, (tracer, &camera), shadow_rays(rays))?;
        }
    }
    tracer.set_scene(&facing_away(scene.clone()))?;
    for estimator in [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS] {
        let film = bench.film((tracer, &from_above(0.0, 0.0, 0.5)), direct(estimator), 32, 64)?;
        let subject = super::subject(direct(estimator));
        bench.trial.equal(&subject, "at (0, 0), the lamp facing away", 0.0, film.mean()[0], 0.0);
    }
    let (tracer, camera) = (&mut bench.tracer(&mesh_area_light(scene))?, from_above(1.0, 0.0, 0.5));
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        bench.mean("at (1, 0), the lamp as a mesh", RECTANGLE[1].2, (tracer, &camera), direct(estimator))?;
    }
    Ok(())
}

/// The area light over the floor sends its light up.
fn facing_away(scene: Scene) -> Scene {
    with_geometry(scene, |index, geometry| match geometry {
        Geometry::Rectangle { edge_u, edge_v, .. } if index == 1 => std::mem::swap(edge_u, edge_v),
        _ => {}
    })
}

pub fn edge_on(bench: &mut Bench) -> Outcome {
    let tracer = &mut bench.tracer(&known("edge-on-light"))?;
    for (d, expected) in EDGE_ON {
        let (scene, camera) = beside_the_plane(d);
        tracer.set_scene(&scene)?;
        let quantity = format!("{d} beside the lamp's plane");
        if d == 0.0 {
            // nothing is seen of nothing as well
            let height = tracer.meet(&[Ray::new(camera.eye, -Vec3::Z)])?[0].t;
            bench.trial.equal("bvh2", "distance of the floor's edge", 0.25, f64::from(height), 0.0);
        }
        for estimator in FINDING_AN_EDGE {
            let settings = direct(estimator);
            let subject = super::subject(settings);
            if d == 0.0 {
                let film = bench.film((tracer, &camera), settings, 8, 64)?;
                bench.trial.equal(&subject, &quantity, 0.0, film.mean()[0], 0.0);
            } else if d == 1e-6 {
                let found = bench.mean_of(expected, 0.002, (tracer, &camera), settings)?;
                bench.trial.equal(&subject, &quantity, expected, found.mean, 0.01 * expected);
            } else {
                bench.mean(&quantity, expected, (tracer, &camera), settings)?;
            }
        }
        if d > 1e-6 {
            bench.mean(&quantity, expected, (tracer, &camera), shadow_rays(4))?;
        }
    }
    Ok(())
}

pub fn disk(bench: &mut Bench) -> Outcome {
    let tracer = &mut bench.tracer(&known("disk-touching"))?;
    for (height, expected) in DISKS {
        let (scene, camera) = under_a_disk(height);
        tracer.set_scene(&scene)?;
        let quantity = format!("height {height}");
        for estimator in Estimator::on_devices() {
            // sampling alone has a relative variance of 0.167, 33, 3.3e3, 3.3e5 and 3.3e7
            let weighted = matches!(estimator, Estimator::MIS | Estimator::UNIFORM_MIS);
            if estimator.samples_lights() && !weighted && height < bench.trial.pick(1.0, 0.1) {
                continue;
            }
            let found = bench.mean(&quantity, expected, (tracer, &camera), direct(estimator))?;
            if weighted {
                let quantity = format!("relative variance, height {height}");
                let subject = super::subject(direct(estimator));
                bench.trial.at_most(&subject, &quantity, 1.0, found.relative_variance());
            }
        }
    }
    Ok(())
}

pub fn sphere(bench: &mut Bench) -> Outcome {
    let tracer = &mut bench.tracer(&known("sphere-light"))?;
    for (radius, distance, degrees, expected) in SPHERES {
        let (scene, camera) = under_a_sphere(radius, distance, degrees);
        tracer.set_scene(&scene)?;
        let quantity = format!("radius {radius}, distance {distance}, {degrees} degrees");
        for estimator in Estimator::on_devices() {
            let seen_by_chance = (radius / distance).powi(2) > bench.trial.pick(0.2, 0.01);
            if estimator.samples_lights() || seen_by_chance {
                bench.mean(&quantity, expected, (tracer, &camera), direct(estimator))?;
            }
        }
        bench.mean(&quantity, expected, (tracer, &camera), shadow_rays(2))?;
    }
    Ok(())
}

pub fn touching_wall(bench: &mut Bench) -> Outcome {
    let tracer = &mut bench.tracer(&known("light-touching-wall"))?;
    for (x, factor) in WALL {
        let camera = beside_the_wall(x);
        for estimator in Estimator::on_devices() {
            if estimator.samples_lights() || factor > 0.1 || bench.trial.full() {
                let quantity = format!("at {x} from the edge");
                bench.mean(&quantity, 0.5 * factor, (tracer, &camera), direct(estimator))?;
            }
        }
    }
    let estimators = [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS].map(direct);
    let [touching, facing] = SQUARES;
    for settings in estimators {
        bench.mean("mean over the unit square", 0.5 * touching, (tracer, &over_the_square()), settings)?;
        let film = bench.film((tracer, &along_the_edge()), settings, 32, 16)?;
        let bright = film.pixels().iter().map(|pixel| pixel.mean()[0]).fold(0.0, f64::max);
        bench.trial.at_most(&super::subject(settings), "brightest pixel along the edge", 1.5, bright);
    }
    tracer.set_scene(&facing_squares())?;
    for settings in estimators {
        bench.mean("mean, facing squares", 0.5 * facing, (tracer, &over_the_square()), settings)?;
    }
    Ok(())
}
