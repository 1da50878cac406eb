//! `visavis bench`: speed against error. Each technique renders each built-in scene at doubling sample counts, against a
//! reference made here with another seed; table and plots go to a folder.

use anyhow::Context;
use compare::{BenchRow, Errors, LogLogPlot, Series, csv, errors};
use gpu::Gpu;
use pathtrace::{Estimator, PathSettings, Tracer};
use picture_file::write_whole;
use raster::{Fake, Raster, RasterSettings};
use scene::{Film, Scene, builtin};
use std::path::Path;
use std::time::Instant;

/// How much work goes into one scene.
struct Effort {
    scene: &'static str,
    size: (u32, u32),
    /// Samples of the estimators double from 1 up to this.
    most_spp: u32,
    reference_spp: u32,
}

/// The sphere scene's caustic is met by few paths: its reference needs many samples and stays noisier.
const QUICK: [Effort; 2] = [
    Effort { scene: "cornell", size: (96, 96), most_spp: 256, reference_spp: 8192 },
    Effort { scene: "whitted", size: (128, 72), most_spp: 256, reference_spp: 16384 },
];

/// Pictures of different seeds that a row's errors are the mean of, at most.
const MOST_PICTURES: u32 = 64;

const REFERENCE_SEED: u32 = 0x5eed;

pub fn run(folder: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let mut rows = Vec::new();
    for effort in &QUICK {
        let measured = measure(effort)?;
        write_whole(&folder.join(format!("{}.svg", effort.scene)), plot(effort, &measured).as_bytes())?;
        rows.extend(measured);
    }
    let table = csv(&rows);
    write_whole(&folder.join("bench.csv"), table.as_bytes())?;
    note!("wrote bench.csv and a plot for each scene: {}", folder.display());
    super::print(&table)
}

fn measure(effort: &Effort) -> anyhow::Result<Vec<BenchRow>> {
    let scene = builtin::named(effort.scene)?;
    let tracer = Tracer::new(&scene);
    note!("{}: reference at {} spp", effort.scene, effort.reference_spp);
    let settings = PathSettings { seed: REFERENCE_SEED, ..PathSettings::default() };
    let (reference, _) = render(&tracer, &scene, effort, &settings, effort.reference_spp);
    let row = |technique: String, spp, seconds, film: &Film| -> anyhow::Result<BenchRow> {
        Ok(BenchRow {
            scene: effort.scene.into(),
            technique,
            spp,
            seconds,
            errors: errors(film, &reference)?,
            reference_rel_mse: own_rel_mse(&reference),
        })
    };
    let mut rows = Vec::new();
    for estimator in Estimator::ALL {
        let mut spp = 1;
        while spp <= effort.most_spp {
            // rare bright paths make one picture of few samples look better than it is: few samples, many pictures
            let pictures = (effort.most_spp / spp).min(MOST_PICTURES);
            let mut measured = Vec::new();
            for seed in 1..=pictures {
                let settings = PathSettings { estimator, seed, ..PathSettings::default() };
                let (film, seconds) = render(&tracer, &scene, effort, &settings, spp);
                measured.push(row(format!("path {}", estimator.name()), spp, seconds, &film)?);
            }
            rows.extend(mean_row(&measured));
            spp *= 2;
        }
    }
    let gpu = Gpu::headless().context("the fake's row of the bench needs a GPU")?;
    let mut raster = Raster::new(&gpu)?;
    for fake in Fake::ALL {
        let settings = RasterSettings { fake, ..RasterSettings::new(effort.size.0, effort.size.1) };
        raster.render(&scene, &scene.camera, &settings)?;
        let start = Instant::now();
        let film = raster.render(&scene, &scene.camera, &settings)?;
        rows.push(row(format!("raster {}", fake.name()), 0, start.elapsed().as_secs_f64(), &film)?);
    }
    Ok(rows)
}

/// Mean time and errors of several pictures; the root of the mean square for the RMSE.
fn mean_row(rows: &[BenchRow]) -> Option<BenchRow> {
    let mean = |of: fn(&BenchRow) -> f64| rows.iter().map(of).sum::<f64>() / rows.len() as f64;
    let errors = Errors::mean(&rows.iter().map(|row| row.errors).collect::<Vec<_>>())?;
    rows.first().map(|first| BenchRow { seconds: mean(|row| row.seconds), errors, ..first.clone() })
}

fn render(tracer: &Tracer, scene: &Scene, effort: &Effort, settings: &PathSettings, spp: u32) -> (Film, f64) {
    let start = Instant::now();
    let mut film = Film::new(effort.size.0, effort.size.1);
    tracer.render(&mut film, &scene.camera, settings, spp, &|| false);
    (film, start.elapsed().as_secs_f64())
}

/// The relMSE that a film's own noise amounts to, by its standard errors.
fn own_rel_mse(film: &Film) -> f64 {
    let of_pixel = |pixel: &scene::film::Pixel| -> f64 {
        pixel.variance_of_mean().iter().zip(pixel.mean()).map(|(variance, mean)| variance / (mean * mean + 0.01)).sum()
    };
    film.pixels().iter().map(of_pixel).sum::<f64>() / (3 * film.pixels().len()) as f64
}

fn plot(effort: &Effort, rows: &[BenchRow]) -> String {
    let mut series: Vec<Series> = Vec::new();
    for row in rows {
        let point = (row.seconds, row.errors.rel_mse);
        match series.last_mut() {
            Some(last) if last.name == row.technique => last.points.push(point),
            _ => series.push(Series { name: row.technique.clone(), points: vec![point], level: row.spp == 0 }),
        }
    }
    for line in series.iter_mut().filter(|line| line.level) {
        if let Some((seconds, _)) = line.points.last() {
            line.name += &format!(", {:.0} ms", seconds * 1000.0);
        }
    }
    let noise = rows.first().map_or(0.0, |row| row.reference_rel_mse);
    let title = format!("{}, {} x {}: error against time", effort.scene, effort.size.0, effort.size.1);
    let x_label = format!("seconds (1 to {} spp, doubling)", effort.most_spp);
    let y_label = format!("relMSE (the reference's own: {noise:.0e})");
    LogLogPlot { title: &title, x_label: &x_label, y_label: &y_label, series }.svg()
}
