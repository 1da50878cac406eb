//! Seconds that each filter takes: `cargo run --release -p denoise --example speed [WIDTH HEIGHT [RUNS]]`. The least of
//! some runs, on as many threads as rayon has (RAYON_NUM_THREADS), for each kind of lanes.

use denoise::{Features, MOST_PIXELS, Network};
use film::{Image, Vec3};
use simd::Lanes;
use std::time::Instant;

fn main() {
    let numbers: Vec<u32> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let [width, height] = [numbers.first().copied().unwrap_or(640), numbers.get(1).copied().unwrap_or(360)];
    let runs = numbers.get(2).copied().unwrap_or(5);
    let color = noise(width, height, 1);
    let [albedo, normal] = [noise(width, height, 2), noise(width, height, 3)];
    let features = Features { albedo: albedo.radiances(), normal: normal.radiances() };
    println!("{width} x {height}, {} threads, pictures of {:.0} MiB", rayon::current_num_threads(), peak_memory());
    for network in [Network::small(), Network::base()].into_iter().flatten() {
        let work = network.operations_per_pixel() * f64::from(width) * f64::from(height);
        for lanes in Lanes::available().filter(|lanes| *lanes != Lanes::Scalar) {
            let (seconds, busy) = least(runs, || {
                let picture = network.denoise_on(lanes, &color, features, MOST_PIXELS, &|| false);
                assert!(picture.is_ok());
            });
            let gigaflops = work / busy / 1e9;
            println!(
                "{:24} {:8} {seconds:.4} s, {busy:.3} core-seconds, {gigaflops:.0} Gflop/s a core",
                network.name(),
                lanes.name()
            );
        }
        println!("{:24} at most {:.0} MiB", network.name(), peak_memory());
    }
}

/// The least seconds of some runs, and the mean of the seconds of all threads together.
fn least(runs: u32, mut run: impl FnMut()) -> (f64, f64) {
    let before = processor_seconds();
    let once = |_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    };
    let least = (0..runs).map(once).fold(f64::INFINITY, f64::min);
    (least, (processor_seconds() - before) / f64::from(runs))
}

/// What this process has used so far, in user mode: Linux tells, in hundredths of a second (proc(5)).
fn processor_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let behind_the_name = stat.rsplit(')').next().unwrap_or_default();
    behind_the_name
        .split_whitespace()
        .nth(11)
        .and_then(|ticks| ticks.parse().ok())
        .map_or(f64::NAN, |ticks: f64| ticks / 100.0)
}

/// The most memory that this process has had so far, in MiB: Linux tells (proc(5)).
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    line.split_whitespace().next().and_then(|kib| kib.parse().ok()).map_or(f64::NAN, |kib: f64| kib / 1024.0)
}

/// Numbers in [0, 1).
fn noise(width: u32, height: u32, seed: u32) -> Image {
    let number = |i: u32| (i.wrapping_mul(0x9e37_79b9) ^ seed).wrapping_mul(0x85eb_ca6b) as f32 / 4_294_967_296.0;
    let pixels = (0..width * height).map(|i| Vec3::new(number(3 * i), number(3 * i + 1), number(3 * i + 2)));
    Image::new(width, height, pixels.collect::<Vec<_>>()).unwrap_or_else(|| unreachable!("as many pixels as its size"))
}
