//! Times of the networks on each graphics device: `cargo run --release -p denoise --example gpu_speed [WIDTH HEIGHT [RUNS
//! [PEAK]]]`. Of 1920 x 1080, the least of 10 runs, with upload and readback; then each layer alone. With PEAK, the
//! device's Gflop/s as its maker states them for single precision, also the share of that.

use denoise::gpu::unet::{GpuUnet, Numbers};
use denoise::{Features, Network};
use film::{Image, Vec3};
use gpu::Gpu;
use std::time::Instant;

/// What the command line asks for.
struct Asked {
    size: [u32; 2],
    runs: u32,
    peak: Option<f64>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let numbers: Vec<f64> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let number = |index: usize, usual: f64| numbers.get(index).copied().unwrap_or(usual);
    let size = [number(0, 1920.0) as u32, number(1, 1080.0) as u32];
    let asked = Asked { size, runs: (number(2, 10.0) as u32).max(1), peak: numbers.get(3).copied() };
    for gpu in Gpu::each()? {
        println!("{}, {} x {}", gpu.describe(), size[0], size[1]);
        for network in [Network::small()?, Network::base()?] {
            for numbers in Numbers::available(&gpu) {
                measure(&gpu, &network, numbers, &asked)?;
            }
        }
    }
    Ok(())
}

fn measure(gpu: &Gpu, network: &Network, numbers: Numbers, asked: &Asked) -> Result<(), Box<dyn std::error::Error>> {
    let start = Instant::now();
    let unet = GpuUnet::with_numbers(gpu, network, numbers)?;
    println!("{} {numbers:?}: compiled in {:.2} s", network.name(), start.elapsed().as_secs_f64());
    let [color, albedo, normal] = [1, 2, 3].map(|seed| noise(asked.size, seed));
    let features = Features { albedo: albedo.radiances(), normal: normal.radiances() };
    let mut least = f64::INFINITY;
    // the first one makes memory
    for _ in 0..=asked.runs {
        let start = Instant::now();
        unet.denoise(&color, features, &|| false)?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    let operations = unet.operations_per_pixel() * f64::from(asked.size[0]) * f64::from(asked.size[1]);
    println!("    picture        {}", told(operations, least, asked.peak));
    let layers = unet.time_layers(asked.runs)?;
    for layer in &layers {
        println!("    {:14} {}", layer.name, told(layer.operations, layer.seconds, asked.peak));
    }
    let [operations, seconds] =
        [layers.iter().map(|layer| layer.operations).sum(), layers.iter().map(|layer| layer.seconds).sum()];
    println!("    these layers   {}", told(operations, seconds, asked.peak));
    Ok(())
}

fn told(operations: f64, seconds: f64, peak: Option<f64>) -> String {
    let speed = operations / seconds / 1e9;
    let share = peak.map_or(String::new(), |peak| format!(", {:.0} % of the peak", 100.0 * speed / peak));
    format!("{:9.3} ms, {speed:7.0} Gflop/s{share}", 1e3 * seconds)
}

/// Numbers in [0, 1).
fn noise([width, height]: [u32; 2], seed: u32) -> Image {
    let number = |i: u32| (i.wrapping_mul(0x9e37_79b9) ^ seed).wrapping_mul(0x85eb_ca6b) as f32 / 4_294_967_296.0;
    let pixels = (0..width * height).map(|i| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2)));
    Image::new(width, height, pixels.collect::<Vec<_>>()).unwrap_or_else(|| unreachable!("as many pixels as its size"))
}
