//! Photon mapping on the GPU is the twin of the CPU's: pictures agree pixel by pixel, and are the same from run to run.

mod pair;

use film::{Film, Image};
use gpu::Gpu;
use pair::paths;
use pathtrace::gpu::GpuTracer;
use pathtrace::{DirectLight, PhotonSettings, SamplerKind};
use scene::{EnvironmentMap, Scene, Vec3, builtin};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

const SIZE: (u32, u32) = (96, 64);

const EVERYTHING: &str = include_str!("scenes/everything-more.toml");

/// A camera that sees a few units of a floor of 6000.
const WIDE: &str = include_str!("scenes/wide-floor.toml");

fn named(name: &str) -> Scene {
    let everything = || scene::parse(EVERYTHING, name, Path::new("everything-more.toml")).unwrap();
    match name {
        "everything" => everything(),
        "wide" => scene::parse(WIDE, name, Path::new("wide-floor.toml")).unwrap(),
        "under a picture" => under_a_picture(everything()),
        _ => builtin::named(name).unwrap(),
    }
}

/// Under a sky of eight texels, one of which is bright.
fn under_a_picture(mut scene: Scene) -> Scene {
    let texels: Vec<_> = (0..8).map(|i| if i == 1 { Vec3::splat(4.0) } else { Vec3::new(0.1, 0.1, 0.2) }).collect();
    let map = EnvironmentMap::new(Image::new(4, 2, texels).unwrap(), 1.0, 30.0).unwrap();
    scene.sky = map.mean();
    scene.environment = Some(Arc::new(map));
    scene
}

fn settings(direct: DirectLight) -> PhotonSettings {
    PhotonSettings { photons: 1 << 13, direct, ..PhotonSettings::default() }
}

/// A photon that rounding sends another way changes the pixels around two places a little: by a twentieth where twenty
/// photons are gathered.
#[test]
fn photon_maps_agree_pixel_by_pixel() {
    let devices = Gpu::each().unwrap();
    let [best, last] = [&devices[0], &devices[devices.len() - 1]];
    let cases = [
        (best, "cornell", DirectLight::Sampled, 2e-3),
        (best, "whitted", DirectLight::Sampled, 2e-3),
        (best, "everything", DirectLight::Sampled, 2e-3),
        (best, "everything", DirectLight::Photons, 2e-3),
        (best, "under a picture", DirectLight::Photons, 2e-3),
        (best, "hard/crossing-lamps", DirectLight::Photons, 2e-3),
        // a disc of photons is a fiftieth of the picture
        (best, "wide", DirectLight::Photons, 2e-2),
        (last, "everything", DirectLight::Sampled, 2e-3),
    ];
    for (gpu, name, direct, allowed) in cases {
        let pair = paths(gpu, &named(name), SIZE, 1, &settings(direct));
        let (apart, rays) = (pair.apart(1e-2), pair.rays());
        println!("{name} {direct:?}, {}: {apart} of the pixels apart, {rays} times the rays", gpu.describe());
        assert!(apart <= allowed && (rays - 1.0).abs() < 1e-3, "{name} {direct:?}: {apart} {rays}");
    }
}

/// Another radius, seed, sampler and pass: what the other test leaves at its usual value.
#[test]
fn later_passes_and_other_settings_agree_too() {
    let gpu = Gpu::headless().unwrap();
    let independent = PhotonSettings { sampler: SamplerKind::Independent, seed: 9, ..settings(DirectLight::Photons) };
    let wide = PhotonSettings { radius: Some(60.0), alpha: 0.3, ..settings(DirectLight::Sampled) };
    for settings in [independent, wide] {
        let pair = paths(&gpu, &named("cornell"), SIZE, 4, &settings);
        let (apart, rays) = (pair.apart(1e-2), pair.rays());
        println!("{settings:?}: {apart} {rays}");
        assert!(apart <= 1e-2 && (rays - 1.0).abs() < 2e-3, "{settings:?}: {apart} {rays}");
    }
}

/// Threads find their places in lists as they come, and sums must not know: at once, in many small dispatches, and where
/// each pass is stopped and made again.
#[test]
fn pictures_are_the_same_bits_from_run_to_run_in_parts_and_after_stops() {
    let gpu = Gpu::headless().unwrap();
    let scene = named("cornell");
    let settings = PhotonSettings { radius: Some(40.0), ..settings(DirectLight::Photons) }.into();
    let rendered = |parts: &[u32]| {
        let (mut tracer, mut film) = (GpuTracer::new(&gpu, &scene).unwrap(), Film::new(64, 48));
        for &spp in parts {
            tracer.render(&mut film, &scene.camera, &settings, spp, &|| false).unwrap();
        }
        film
    };
    let (at_once, again, in_parts) = (rendered(&[3]), rendered(&[3]), rendered(&[1, 2]));
    assert!(at_once.radiances().eq(again.radiances()));
    let apart = at_once.radiances().zip(in_parts.radiances()).map(|(a, b)| (a - b).abs().max_element());
    // sums on their way to the host are rounded in other places
    assert!(apart.fold(0.0, f32::max) < 1e-6);

    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    tracer.set_budget(1e-3);
    let mut halting = tracer.film(Film::new(64, 48)).unwrap();
    let mut stops = 0;
    while halting.samples_per_pixel() < 3 {
        // later and later, or a pass that begins anew would never be done
        let asked = Cell::new(0);
        let stop = || asked.replace(asked.get() + 1) >= 7 * stops;
        tracer.accumulate(&mut halting, &scene.camera, &settings, 3, &stop).unwrap();
        stops += 1;
    }
    let (halted, _) = halting.read(&gpu).unwrap();
    assert!(stops > 3 && halted.pixels().iter().all(|pixel| pixel.samples == 3), "{stops}");
    assert!(at_once.radiances().eq(halted.radiances()), "{stops}");
}

/// Points are a picture of their own.
#[test]
fn what_a_device_does_not_show_is_said_in_one_line() {
    let gpu = Gpu::headless().unwrap();
    let scene = named("cornell");
    let points = PhotonSettings { points: true, ..settings(DirectLight::Sampled) }.into();
    let mut tracer = GpuTracer::new(&gpu, &scene).unwrap();
    let refused = tracer.render(&mut Film::new(4, 4), &scene.camera, &points, 1, &|| false).unwrap_err().to_string();
    assert_eq!(refused, "photons are shown as points by the processor alone: render it on the CPU");
}
