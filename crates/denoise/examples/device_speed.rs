//! Milliseconds that a-trous takes on each graphics device and on the processor: `cargo run --release -p denoise --example
//! device_speed [WIDTH HEIGHT [RUNS]]`. The passes alone are timed by the wall's clock over all runs, sent one behind the
//! other and awaited together; a first run does not count.

use denoise::a_trous::{Guide, a_trous};
use denoise::gpu::GpuATrous;
use denoise::{DenoiseError, Features};
use film::{Image, Vec3};
use gpu::Gpu;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let numbers: Result<Vec<u32>, _> = std::env::args().skip(1).map(|word| word.parse()).collect();
    let (size, runs) = match numbers?[..] {
        [] => ((1920, 1080), 10),
        [width, height] => ((width, height), 10),
        [width, height, runs] => ((width, height), runs.max(1)),
        _ => Err("width, height and runs, or nothing")?,
    };
    let color = picture(size, |x, y, n| Vec3::splat(0.6 + 0.3 * noise(n)) * if tile(x, y) { 1.0 } else { 0.5 })?;
    let albedo = picture(size, |x, y, _| Vec3::splat(if tile(x, y) { 0.8 } else { 0.4 }))?;
    let normal = picture(size, |x, _, _| if x % 256 < 128 { Vec3::X } else { Vec3::Z })?;
    let depth: Vec<f32> = (0..size.0 * size.1).map(|n| 4.0 + 0.01 * (n % size.0) as f32).collect();
    let features = Features { albedo: albedo.radiances(), normal: normal.radiances() };
    let known = vec![0.0075; depth.len()];
    println!("{} x {}, milliseconds", size.0, size.1);
    println!("{:60} {:8} {:>9} {:>9} {:>9} {:>9}", "on", "variance", "upload", "passes", "read", "whole");
    for (name, variance) in [("known", Some(&known[..])), ("unknown", None)] {
        let guide = Guide { features, depth: &depth, variance };
        for gpu in Gpu::each()? {
            on_device(&gpu, (&color, guide, name), runs)?;
        }
        let whole = milliseconds(|| a_trous(&color, guide, &|| false))?;
        let threads = format!("{} threads", rayon::current_num_threads());
        println!("{threads:60} {name:8} {:>9} {:>9} {:>9} {whole:9.2}", "", "", "");
    }
    Ok(())
}

fn on_device(gpu: &Gpu, (color, guide, name): (&Image, Guide, &str), runs: u32) -> Result<(), Box<dyn Error>> {
    let filter = GpuATrous::new(gpu)?;
    filter.apply(color, guide, &|| false)?;
    let mut uploaded = None;
    let upload = milliseconds(|| {
        uploaded = Some(filter.upload(color, guide)?);
        Ok(())
    })?;
    let picture = uploaded.ok_or("nothing was brought to the device")?;
    let passes = milliseconds(|| {
        for _ in 0..runs {
            filter.submit(&picture)?;
        }
        Ok(gpu.wait_for_all("the passes")?)
    })?;
    let read = milliseconds(|| filter.read(&picture))?;
    let whole = milliseconds(|| filter.apply(color, guide, &|| false))?;
    let passes = passes / f64::from(runs);
    println!("{:60} {name:8} {upload:9.2} {passes:9.2} {read:9.2} {whole:9.2}", gpu.describe());
    Ok(())
}

fn milliseconds<T>(work: impl FnOnce() -> Result<T, DenoiseError>) -> Result<f64, DenoiseError> {
    let start = Instant::now();
    work()?;
    Ok(1e3 * start.elapsed().as_secs_f64())
}

/// Columns and rows of 40 pixels.
fn tile(x: u32, y: u32) -> bool {
    (x / 40 + y / 40).is_multiple_of(2)
}

/// A pseudo-random number in [-1, 1), the same for each `number`.
fn noise(number: u32) -> f32 {
    number.wrapping_mul(0x9e37_79b9).rotate_left(13).wrapping_mul(0x85eb_ca6b) as f32 / 2_147_483_648.0 - 1.0
}

/// What `of` makes of a pixel's column, row and number.
fn picture((width, height): (u32, u32), of: impl Fn(u32, u32, u32) -> Vec3) -> Result<Image, Box<dyn Error>> {
    let pixels = (0..width * height).map(|n| of(n % width, n / width, n));
    Ok(Image::new(width, height, pixels.collect::<Vec<_>>()).ok_or("as many pixels as its size")?)
}
