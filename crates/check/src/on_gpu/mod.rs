//! The hard cases on a graphics device: the same scenes and closed forms as on the processor, as far as a device renders
//! them. Functions by themselves (Fresnel, samplers, warps) are compared with the processor's in tests instead.

mod rays;

use crate::case::Case;
use crate::hard::{known, spot};
use crate::lamps::RECTANGLE;
use crate::measure::{Effort, Trial, farthest, independent};
use crate::meshes::Mesh;
use crate::row::{Device, Row};
use gpu::Gpu;
use pathtrace::gpu::{GpuTraceError, GpuTracer};
use pathtrace::{Estimator, PathSettings, Roulette, WhittedSettings};
use scene::{Camera, Film, Scene, Vec3};
use std::sync::atomic::AtomicBool;

type Outcome = Result<(), GpuTraceError>;

/// What runs a case on a device.
struct Bench<'a, 'b> {
    gpu: &'a Gpu,
    trial: &'a mut Trial<'b>,
}

/// Runs those of `cases` that a device renders, as [`crate::run`] does on the processor.
///
/// # Errors
/// [`GpuTraceError`] if the device fails.
pub fn run_on_gpu(
    gpu: &Gpu,
    cases: &[Case],
    effort: Effort,
    stop: &AtomicBool,
    mut on_rows: impl FnMut(&Case, &[Row]) -> bool,
) -> Result<Vec<Row>, GpuTraceError> {
    let mut all = Vec::new();
    for case in cases {
        let Some(run) = of_number(case.number) else { continue };
        let mut trial = Trial::new(case.number, effort, stop).on(Device::Gpu);
        run(&mut Bench { gpu, trial: &mut trial })?;
        if trial.stopped() {
            break;
        }
        let rows = trial.into_rows();
        let go_on = on_rows(case, &rows);
        all.extend(rows);
        if !go_on {
            break;
        }
    }
    Ok(all)
}

fn of_number(case: u32) -> Option<fn(&mut Bench) -> Outcome> {
    Some(match case {
        1 => white_furnace,
        2 => closed_box,
        3 => point_light,
        4 => rectangle,
        6 => disk,
        7 => sphere,
        8 => touching_wall,
        11 => index_one,
        14 => furnace,
        15 => camera_inside,
        16 => rays::closed_mesh,
        17 => light_tight_box,
        18 => rays::self_intersection,
        23 => million_samples,
        _ => return None,
    })
}

impl Bench<'_, '_> {
    fn tracer(&self, scene: &Scene) -> Result<GpuTracer, GpuTraceError> {
        GpuTracer::new(self.gpu, scene)
    }

    /// A square picture, its dropped samples counted.
    fn film(
        &mut self,
        (tracer, camera): (&mut GpuTracer, &Camera),
        settings: &PathSettings,
        size: u32,
        samples: u32,
    ) -> Result<Film, GpuTraceError> {
        let mut film = Film::new(size, size);
        let trial = &*self.trial;
        tracer.render(&mut film, camera, settings, samples, &|| trial.stopped())?;
        self.trial.count_nonfinite(&film);
        Ok(film)
    }

    /// A picture whose every pixel is `expected`, without noise.
    fn exactly(
        &mut self,
        quantity: &str,
        expected: f64,
        seen: (&mut GpuTracer, &Camera),
        settings: &PathSettings,
    ) -> Outcome {
        let film = self.film(seen, settings, 32, 8)?;
        let subject = format!("path {}", settings.estimator.name());
        self.trial.equal(&subject, quantity, expected, farthest(&film, expected), 1e-5);
        Ok(())
    }

    /// The mean of a picture that sees one thing, with as many samples as a relative standard error asks for.
    fn mean(
        &mut self,
        quantity: &str,
        expected: f64,
        (tracer, camera): (&mut GpuTracer, &Camera),
        settings: &PathSettings,
    ) -> Outcome {
        let power = self.trial.pick(0.01, 0.002);
        let mut film = Film::new(32, 32);
        let mut more = 16;
        loop {
            let trial = &*self.trial;
            tracer.render(&mut film, camera, settings, more, &|| trial.stopped())?;
            let samples = film.samples_per_pixel();
            // where all samples agree, one as large as the mean may still have been missed
            let unseen = expected / (1024.0 * f64::from(samples.max(1)));
            let error = film.standard_error()[0].hypot(unseen);
            if error <= power * expected || samples >= self.trial.pick(1024, 65_536) || self.trial.stopped() {
                let subject = format!("path {}", settings.estimator.name());
                self.trial.count_nonfinite(&film);
                self.trial.mean_and_error(&subject, quantity, expected, (film.mean()[0], error), power);
                return Ok(());
            }
            let wanted = (error / (power * expected)).powi(2).clamp(1.2, 8.0) * 1.2;
            more = (f64::from(samples) * (wanted - 1.0)).ceil() as u32;
        }
    }

    fn whitted(
        &mut self,
        quantity: &str,
        expected: f64,
        (tracer, camera): (&mut GpuTracer, &Camera),
        settings: &WhittedSettings,
    ) -> Outcome {
        let mut film = Film::new(8, 8);
        tracer.render_whitted(&mut film, camera, settings, 4, &|| false)?;
        self.trial.count_nonfinite(&film);
        self.trial.equal("whitted", quantity, expected, farthest(&film, expected), 1e-5);
        Ok(())
    }
}

fn with(estimator: Estimator, bounces: Option<u32>) -> PathSettings {
    PathSettings { estimator, bounces, ..independent() }
}

fn direct(estimator: Estimator) -> PathSettings {
    PathSettings { roulette: Roulette::OFF, ..with(estimator, Some(0)) }
}

fn white_furnace(bench: &mut Bench) -> Outcome {
    let scene = known("white-furnace");
    let tracer = &mut bench.tracer(&scene)?;
    for estimator in [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS] {
        bench.exactly("every pixel, no variance", 1.0, (tracer, &scene.camera), &with(estimator, None))?;
    }
    let settings = PathSettings { roulette: Roulette::constant(0.9), ..with(Estimator::COSINE, None) };
    bench.mean("mean, roulette .9", 1.0, (tracer, &scene.camera), &settings)
}

fn closed_box(bench: &mut Bench) -> Outcome {
    let scene = known("closed-box");
    let tracer = &mut bench.tracer(&scene)?;
    // a software device takes seconds to compile each
    for &estimator in bench.trial.pick(&[Estimator::COSINE, Estimator::MIS][..], &Estimator::EVERY[..]) {
        bench.mean("mean, albedo .5", 1.0, (tracer, &scene.camera), &with(estimator, None))?;
    }
    let mirrors = known("mirror-box");
    let tracer = &mut bench.tracer(&mirrors)?;
    bench.mean("mean, mirrors of .5", 1.0, (tracer, &mirrors.camera), &with(Estimator::LIGHT, None))?;
    for depth in [1u32, 4, 8, 16] {
        let expected = 1.0 - 0.5f64.powi(depth as i32 + 1);
        let settings = WhittedSettings { depth, ambient: Some(0.0), ..WhittedSettings::default() };
        let quantity = format!("every pixel, mirrors, {depth} scatterings");
        bench.whitted(&quantity, expected, (tracer, &mirrors.camera), &settings)?;
    }
    Ok(())
}

fn point_light(bench: &mut Bench) -> Outcome {
    let scene = known("point-light-in-sphere");
    let tracer = &mut bench.tracer(&scene)?;
    for estimator in [Estimator::LIGHT, Estimator::MIS, Estimator::UNIFORM_LIGHT] {
        bench.mean("mean", 1.0, (tracer, &scene.camera), &with(estimator, None))?;
    }
    let settings = WhittedSettings { ambient: Some(0.0), ..WhittedSettings::default() };
    bench.whitted("every pixel, direct", 0.5, (tracer, &scene.camera), &settings)
}

fn rectangle(bench: &mut Bench) -> Outcome {
    let scene = known("rectangle-light");
    let tracer = &mut bench.tracer(&scene)?;
    for (x, y, expected) in RECTANGLE {
        let camera = spot(Vec3::new(x, y, 0.5), Vec3::new(x, y, 0.0));
        for estimator in Estimator::EVERY {
            if estimator.samples_lights() || expected > 1.0 {
                bench.mean(&format!("at ({x}, {y})"), expected, (tracer, &camera), &direct(estimator))?;
            }
        }
    }
    Ok(())
}

/// The scene's picture as the processor's cases see it: of its own camera, by all that finds its light.
fn as_seen(bench: &mut Bench, name: &str, expected: f64, camera: &Camera) -> Outcome {
    let tracer = &mut bench.tracer(&known(name))?;
    for estimator in [Estimator::COSINE, Estimator::MIS, Estimator::UNIFORM_MIS] {
        bench.mean("from above", expected, (tracer, camera), &direct(estimator))?;
    }
    Ok(())
}

fn disk(bench: &mut Bench) -> Outcome {
    for (height, expected) in [(1.0f32, 0.25), (0.1, 0.495049505), (1e-3, 0.4999995), (1e-4, 0.499999995)] {
        let scene = crate::hard::with_geometry(known("disk-touching"), |_, geometry| {
            if let scene::Geometry::Disk { center, .. } = geometry {
                center.z = height;
            }
        });
        let tracer = &mut bench.tracer(&scene)?;
        let camera = spot(Vec3::new(0.0, 0.0, 0.5 * height), Vec3::ZERO);
        for estimator in [Estimator::COSINE, Estimator::MIS, Estimator::UNIFORM_MIS] {
            bench.mean(&format!("height {height}"), expected, (tracer, &camera), &direct(estimator))?;
        }
    }
    Ok(())
}

fn sphere(bench: &mut Bench) -> Outcome {
    let (radius, distance) = (1.0f32, 1.0001f32);
    for (radius, distance, expected) in [(0.5, 2.0, 0.5), (radius, distance, 7.99840024)] {
        let scene = crate::hard::with_geometry(known("sphere-light"), |_, geometry| {
            if matches!(geometry, scene::Geometry::Sphere { .. }) {
                *geometry = scene::Geometry::Sphere { center: Vec3::Z * distance, radius };
            }
        });
        let tracer = &mut bench.tracer(&scene)?;
        let camera = spot(Vec3::new(0.0, 0.0, (0.5 * (distance - radius)).min(0.5)), Vec3::ZERO);
        for estimator in [Estimator::LIGHT, Estimator::MIS, Estimator::UNIFORM_LIGHT] {
            let quantity = format!("radius {radius}, distance {distance}");
            bench.mean(&quantity, expected, (tracer, &camera), &direct(estimator))?;
        }
    }
    Ok(())
}

fn touching_wall(bench: &mut Bench) -> Outcome {
    for (x, factor) in [(1.0f32, 0.07109343905), (0.01, 0.4921589522), (1e-3, 0.4992157976)] {
        let x = x.min(1.0 - 1e-6);
        let camera = spot(Vec3::new(x, 0.0, 0.5), Vec3::new(x, 0.0, 0.0));
        as_seen(bench, "light-touching-wall", 0.5 * factor, &camera)?;
    }
    Ok(())
}

fn index_one(bench: &mut Bench) -> Outcome {
    let with_glass = known("index-one");
    let mut without = with_glass.clone();
    let solid = with_glass.shapes.iter().filter(|shape| with_glass.material_of(shape).name != "nothing");
    without.shapes = solid.cloned().collect();
    let camera = with_glass.camera;
    let settings = PathSettings { roulette: Roulette::OFF, ..with(Estimator::LIGHT, None) };
    let trees = WhittedSettings { depth: 16, ..WhittedSettings::default() };
    let (mut paths, mut whitted) = (Vec::new(), Vec::new());
    for scene in [&with_glass, &without] {
        let tracer = &mut bench.tracer(scene)?;
        // one sample a pixel, in the same place of both pictures
        paths.push(bench.film((tracer, &camera), &settings, 128, 1)?);
        let mut film = Film::new(128, 128);
        tracer.render_whitted(&mut film, &camera, &trees, 1, &|| false)?;
        whitted.push(film);
    }
    for (subject, films) in [("path light", paths), ("whitted", whitted)] {
        let apart = films[0].radiances().zip(films[1].radiances()).map(|(a, b)| (a - b).abs().max_element());
        bench.trial.at_most(subject, "largest difference", 1e-5, f64::from(apart.fold(0.0, f32::max)));
    }
    Ok(())
}

fn furnace(bench: &mut Bench) -> Outcome {
    let settings = PathSettings { roulette: Roulette::OFF, ..with(Estimator::LIGHT, None) };
    for name in ["glass-sphere-in-furnace", "nested-glass"] {
        let scene = known(name);
        let tracer = &mut bench.tracer(&scene)?;
        bench.exactly(&format!("every pixel, {name}"), 1.0, (tracer, &scene.camera), &settings)?;
    }
    Ok(())
}

fn camera_inside(bench: &mut Bench) -> Outcome {
    let scene = known("camera-inside-glass");
    let tracer = &mut bench.tracer(&scene)?;
    bench.exactly("every pixel", 1.0, (tracer, &scene.camera), &with(Estimator::LIGHT, None))
}

fn light_tight_box(bench: &mut Bench) -> Outcome {
    let scene = known("light-tight-box");
    let samples = bench.trial.pick(32, 2048);
    let settings = with(Estimator::COSINE, None);
    let camera =
        Camera { eye: Vec3::new(0.1, 0.2, -0.3), target: Vec3::new(0.3, -0.5, 1.0), fov_y: 150.0, ..scene.camera };
    let turned = [17.0, 31.0, 47.0];
    for (name, scene, camera) in [
        ("the box", scene.clone(), scene.camera),
        ("turned box", Mesh::cube(1).turned(turned).scene(), camera),
        ("64 x 64 quads a wall, turned", Mesh::cube(64).turned(turned).scene(), camera),
    ] {
        let tracer = &mut bench.tracer(&scene)?;
        let film = bench.film((tracer, &camera), &settings, 64, samples)?;
        let brightest = film.pixels().iter().map(|pixel| pixel.mean()[0]).fold(0.0, f64::max);
        bench.trial.equal("path cosine", &format!("brightest pixel, {name}"), 0.0, brightest, 0.0);
    }
    Ok(())
}

fn million_samples(bench: &mut Bench) -> Outcome {
    let mut scene = known("camera-inside-glass");
    scene.shapes = [].into();
    scene.sky = Vec3::splat(0.1);
    let tracer = &mut bench.tracer(&scene)?;
    let mut film = Film::new(8, 1);
    let samples = bench.trial.pick(125_000, 1_000_000);
    let trial = &*bench.trial;
    tracer.render(&mut film, &scene.camera, &direct(Estimator::COSINE), samples, &|| trial.stopped())?;
    let expected = f64::from(0.1f32);
    bench.trial.equal("film", "mean, constant .1", expected, farthest(&film, expected), 1e-6 * expected);
    Ok(())
}
