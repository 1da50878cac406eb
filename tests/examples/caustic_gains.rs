//! What each answer to caustics gains on `whitted`, under suns of three sizes: relMSE and seconds of 64 Sobol samples, means over
//! independent seeds, against references that the same program makes.
//!
//!     cargo run --release -p visavis-tests --example caustic_gains [SEEDS]
//!
//! Each row adds one answer to the row above it, and the rows take turns. Seconds are the processor's, of all threads, where
//! Linux tells them, so that what else the machine does counts as little as it can; elsewhere the wall's. Under a sun of radius 0
//! chance finds no caustic, so that its error there is a bias.

use compare::errors;
use film::{Film, Image};
use pathtrace::{ConesAt, PathSettings, Tracer};
use reference::Maker;
use scene::{Scene, Vec3, builtin};
use std::error::Error;
use std::time::Instant;

const SIZE: (u32, u32) = (256, 144);
const SPP: u32 = 64;
/// Angular radii in degrees.
const SUNS: [f32; 3] = [2.5, 0.5, 0.0];

/// Independent pictures of a reference. Its own error adds to all that are measured by it: it is subtracted.
const REPLICATES: u32 = 96;
/// References and pictures share no seed.
const FIRST_REFERENCE_SEED: u32 = 0x4000_0000;

fn main() -> Result<(), Box<dyn Error>> {
    let seeds = match std::env::args().nth(1) {
        None => 24,
        Some(word) => word.parse::<u32>().ok().filter(|seeds| *seeds > 0).ok_or("how many seeds, 1 or more")?,
    };
    println!("{} x {}, {SPP} spp, {seeds} seeds", SIZE.0, SIZE.1);
    for radius in SUNS {
        let scene = under_a_sun(radius)?;
        let tracer = Tracer::new(&scene);
        let truth = Truth::new(&tracer, &scene)?;
        println!("sun of radius {radius}, reference's own relMSE {:.1e}", truth.noise);
        for row in measured(&tracer, &scene, &truth, seeds)? {
            let (error, spread) = row.rel_mse();
            let seconds = row.seconds / f64::from(seeds);
            println!("  {:28} relMSE {error:.5} +- {spread:.5}  {seconds:.3} s", row.name);
        }
    }
    Ok(())
}

fn under_a_sun(radius: f32) -> Result<Scene, Box<dyn Error>> {
    let mut scene = builtin::named("whitted")?;
    scene.sun.as_mut().ok_or("whitted has no sun")?.angular_radius = radius;
    Ok(scene)
}

/// The answers, each with those before it.
fn answers() -> [(&'static str, PathSettings); 4] {
    let split = PathSettings { cones: ConesAt::Nothing, ..PathSettings::default() };
    let connections = PathSettings { split_glass: false, ..split };
    let chance = PathSettings { connections: false, ..connections };
    let all = PathSettings::default();
    [("all left to chance", chance), ("connections", connections), ("+ split glass", split), ("+ cones", all)]
}

struct Truth {
    image: Image,
    /// The reference's own relMSE.
    noise: f64,
}

impl Truth {
    fn new(tracer: &Tracer, scene: &Scene) -> Result<Self, Box<dyn Error>> {
        let mut film = Film::try_new(SIZE.0, SIZE.1).ok_or("not enough memory")?;
        let mut pictures = Vec::new();
        for i in 0..REPLICATES {
            let picture = picture(tracer, scene, &Maker::settings(FIRST_REFERENCE_SEED + i))?;
            for (pixel, one) in film.pixels_mut().iter_mut().zip(picture.pixels()) {
                pixel.add(Vec3::from_array(one.mean().map(|v| v as f32)));
            }
            pictures.push(picture.image());
        }
        let image = film.image();
        let spread = |picture: &Image| errors(picture, &image).map(|errors| errors.rel_mse);
        let spread = pictures.iter().map(spread).sum::<Result<f64, _>>()? / f64::from(REPLICATES);
        Ok(Truth { image, noise: spread / f64::from(REPLICATES - 1) })
    }
}

struct Row {
    name: &'static str,
    /// relMSE of the picture of each seed.
    errors: Vec<f64>,
    /// Of all seeds together.
    seconds: f64,
}

impl Row {
    /// The mean and its standard error.
    fn rel_mse(&self) -> (f64, f64) {
        let count = self.errors.len() as f64;
        let mean = self.errors.iter().sum::<f64>() / count;
        let squares = self.errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>();
        (mean, (squares / (count - 1.0).max(1.0) / count).sqrt())
    }
}

fn measured(tracer: &Tracer, scene: &Scene, truth: &Truth, seeds: u32) -> Result<Vec<Row>, Box<dyn Error>> {
    let blank = |(name, _)| Row { name, errors: Vec::new(), seconds: 0.0 };
    let mut rows: Vec<Row> = answers().map(blank).into();
    for seed in 1..=seeds {
        for (row, (_, settings)) in rows.iter_mut().zip(answers()) {
            let (start, spent) = (Instant::now(), processor_seconds());
            let picture = picture(tracer, scene, &PathSettings { seed, ..settings })?;
            let by_the_processor = processor_seconds().zip(spent).map(|(after, before)| after - before);
            row.seconds += by_the_processor.unwrap_or(start.elapsed().as_secs_f64());
            row.errors.push(errors(&picture.image(), &truth.image)?.rel_mse - truth.noise);
        }
    }
    Ok(rows)
}

fn picture(tracer: &Tracer, scene: &Scene, settings: &PathSettings) -> Result<Film, Box<dyn Error>> {
    let mut film = Film::try_new(SIZE.0, SIZE.1).ok_or("not enough memory")?;
    tracer.render(&mut film, &scene.camera, &(*settings).into(), SPP, &|| false);
    Ok(film)
}

/// Of all threads of this process so far: user and system time, fields 14 and 15 of `proc_pid_stat(5)`, in the hundredths
/// of a second in which Linux tells them.
fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // the name in brackets may hold blanks; the state behind it is field 3
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field - 3)?.parse::<f64>().ok();
    Some((ticks(14)? + ticks(15)?) / 100.0)
}
