//! Pictures one after another: what is drawn must not stay in memory.

#![cfg(target_os = "linux")]

use gpu::Gpu;
use raster::{Fake, FakeKnobs, Raster, RasterSettings};
use scene::builtin;

/// Megabytes of memory that this process holds.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").parse::<u64>().unwrap() / 1024
}

/// With the shadow's bias turned, shadow map and cube maps are drawn again too.
#[test]
fn rendering_again_and_again_takes_no_more_memory() {
    let gpu = Gpu::headless().unwrap();
    let mut raster = Raster::new(&gpu).unwrap();
    let scene = builtin::named("whitted").unwrap();
    let mut render = |turn: u32| {
        let fake = if turn % 4 == 3 { Fake::AsTaught } else { Fake::Fair };
        let bias = if turn.is_multiple_of(2) { 0.0 } else { turn as f32 * 1e-5 };
        let small = FakeKnobs { segments: Some(12), cube_map: Some(16), shadow_map: Some(64), ..FakeKnobs::default() };
        let knobs = FakeKnobs { bias, ..small };
        let settings = RasterSettings { fake, knobs, ..RasterSettings::new(64, 36) };
        raster.render(&scene, &scene.camera, &settings).unwrap();
    };
    (0..10).for_each(&mut render);
    let before = resident();
    (10..110).for_each(&mut render);
    let after = resident();
    assert!(after < before + 60, "100 pictures took {before} MB to {after} MB");
}
