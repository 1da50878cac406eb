//! Photons on the device against those on the processor.

use super::*;
use crate::drive::gpu::photon_data::EmissionHeader;
use crate::drive::gpu::photon_sources::PhotonScene;
use crate::gpu::GpuTracer;
use crate::integrator::photon::{DirectLight, Photon as HostPhoton, tests::photons_of};
use crate::tracer::Tracer;
use scene::{Camera, Scene, Vec3, builtin};
use std::path::Path;

impl PhotonMaps {
    /// The photons of the last pass that was sorted, bucket by bucket, with the end of each bucket.
    pub(crate) fn read(&self, gpu: &Gpu) -> (Vec<Photon>, Vec<u32>) {
        let room = self.room.as_ref().expect("a pass was made");
        let bytes = gpu.read_buffer(WHAT, &room.map).expect("the map");
        let grid: Grid = bytemuck::pod_read_unaligned(&bytes[..size_of::<Grid>()]);
        let words = |first: usize, count: usize| &bytes[size_of::<Grid>() + 16 * first..][..16 * count];
        let places: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(words(0, grid.photons as usize));
        let found = places.iter().map(|[first, end]| end - first).sum::<u32>() as usize;
        let photons = bytemuck::pod_collect_to_vec(words(grid.photons as usize, 2 * found));
        (photons, places.iter().filter(|[first, end]| first < end).map(|[_, end]| *end).collect())
    }
}

const EVERYTHING: &str = include_str!("../../../../../../tests/tests/scenes/everything-more.toml");

/// A camera that sees a few units of a floor of 6000 by lights of all kinds, one of which faces away, and a ball of glass.
const WIDE: &str = include_str!("../../../../../../tests/tests/scenes/wide-floor.toml");

fn named(name: &str) -> Scene {
    match name {
        "wide" => scene::parse(WIDE, name, Path::new("wide-floor.toml")).expect("a scene"),
        "everything" => scene::parse(EVERYTHING, name, Path::new("everything-more.toml")).expect("a scene"),
        _ => builtin::named(name).expect("a built-in scene"),
    }
}

/// The photons of the first pass on the device, and how the map holds them.
fn on_device(gpu: &Gpu, scene: &Scene, settings: &PhotonSettings) -> (Vec<Photon>, Vec<u32>) {
    by_tracer(&mut GpuTracer::new(gpu, scene).expect("a tracer"), &scene.camera, settings)
}

fn by_tracer(tracer: &mut GpuTracer, camera: &Camera, settings: &PhotonSettings) -> (Vec<Photon>, Vec<u32>) {
    let mut film = tracer.film(film::Film::new(1, 1)).expect("a film");
    tracer.accumulate(&mut film, camera, &(*settings).into(), 1, &|| false).expect("a sample");
    tracer.photon_maps.as_ref().expect("photons were asked for").read(tracer.gpu())
}

/// Whether two photons are one but for rounding, in a scene of this size.
fn alike(ours: &Photon, theirs: &HostPhoton, size: f32) -> bool {
    let off = (ours.position - theirs.position).length();
    let power = (ours.power - theirs.power).abs().max_element();
    off < 1e-4 * size && power < 1e-2 * theirs.power.max_element()
}

/// How many photons two lists have in common, in their order: where one is not like the other, as few of both are left out
/// as lead to three that are.
fn in_common(ours: &[Photon], theirs: &[HostPhoton], size: f32) -> usize {
    let are_alike = |i: usize, j: usize, count: usize| {
        let pairs = ours.iter().skip(i).zip(theirs.iter().skip(j)).take(count);
        pairs.filter(|(ours, theirs)| alike(ours, theirs, size)).count() == count
    };
    let (mut i, mut j, mut common) = (0, 0, 0);
    while i < ours.len() && j < theirs.len() {
        if are_alike(i, j, 1) {
            (i, j, common) = (i + 1, j + 1, common + 1);
            continue;
        }
        let skips = (1..64).flat_map(|both| (0..=both).map(move |of_ours| (of_ours, both - of_ours)));
        let Some((m, n)) = skips.into_iter().find(|&(m, n)| are_alike(i + m, j + n, 3)) else { break };
        (i, j) = (i + m, j + n);
    }
    common
}

/// The share of photons that one machine leaves and the other does not.
fn apart((mut ours, _): (Vec<Photon>, Vec<u32>), theirs: &[HostPhoton], scene: &Scene) -> f64 {
    let (lo, hi) = scene.bounds();
    ours.sort_by_key(|photon| photon.order);
    let common = in_common(&ours, theirs, (hi - lo).length());
    1.0 - common as f64 / ours.len().max(theirs.len()) as f64
}

/// The same photons from each light, at the same places along the same ways but for rounding: it sends one in some hundreds another way,
/// where they pass glass and mirrors.
#[test]
fn both_machines_leave_the_same_photons() {
    let gpu = Gpu::headless().expect("a device");
    let of_both = [("cornell", 1e-3), ("whitted", 1e-2), ("everything", 1e-2), ("wide", 1e-2)];
    let of_both = of_both.map(|(name, allowed)| DirectLight::ALL.map(|direct| (name, direct, allowed)));
    // its only floor sends no photon on to itself
    let crossing = ("hard/crossing-lamps", DirectLight::Photons, 1e-3);
    for (name, direct, allowed) in of_both.into_iter().flatten().chain([crossing]) {
        let scene = named(name);
        let apart = apart_by(GpuTracer::new(&gpu, &scene).expect("a tracer"), &scene, direct);
        assert!(apart <= allowed, "{name} {direct:?}: {apart} of the photons are apart");
    }
}

/// As of few shapes one by one.
#[test]
fn both_machines_leave_the_same_photons_through_a_tree() {
    let gpu = Gpu::headless().expect("a device");
    for (name, allowed) in [("everything", 1e-2), ("hard/crossing-lamps", 1e-3)] {
        let scene = named(name);
        let through_a_tree = GpuTracer::through_a_tree(&gpu, &scene).expect("a tracer");
        let apart = apart_by(through_a_tree, &scene, DirectLight::Photons);
        assert!(apart <= allowed, "{name}: {apart} of the photons are apart");
    }
}

/// The share of photons that are left on one machine alone.
fn apart_by(mut tracer: GpuTracer, scene: &Scene, direct: DirectLight) -> f64 {
    let settings = PhotonSettings { photons: 1 << 14, direct, ..PhotonSettings::default() };
    let expected = photons_of(&Tracer::new(scene), scene, settings.photons, direct);
    let apart = apart(by_tracer(&mut tracer, &scene.camera, &settings), &expected, scene);
    println!("{} {direct:?}: {apart:.5} of {} photons apart", scene.name, expected.len());
    assert!(expected.len() > 1000, "{}", expected.len());
    apart
}

/// Two spheres of glass and metal; one of glass and 31 of what is seen.
#[test]
fn spheres_around_what_is_seen_are_sent_to_the_device_with_those_around_glass() {
    let targets = |name: &str| {
        let scene = named(name);
        let emission = PhotonScene::new(&scene).sources(&scene.camera.frame(1.0), None).emission;
        bytemuck::pod_read_unaligned::<EmissionHeader>(&emission[..size_of::<EmissionHeader>()]).targets
    };
    assert_eq!((targets("cornell"), targets("whitted"), targets("wide")), (0, 2, 32));
}

/// The same pass of the same scene, seen from elsewhere: its photons are aimed at something else.
#[test]
fn a_camera_that_has_moved_has_photons_of_its_own() {
    let gpu = Gpu::headless().expect("a device");
    let (scene, mut moved) = (named("wide"), named("wide"));
    (moved.camera.eye, moved.camera.target) = (scene.camera.eye + Vec3::X, scene.camera.target + Vec3::X);
    let settings = PhotonSettings { photons: 1 << 10, radius: Some(0.1), ..PhotonSettings::default() };
    let mut tracer = GpuTracer::new(&gpu, &scene).expect("a tracer");
    // buckets lie where they come
    let in_order = |(mut photons, _): (Vec<Photon>, Vec<u32>)| {
        photons.sort_by_key(|photon| photon.order);
        photons
    };
    let [before, after] = [&scene, &moved].map(|scene| in_order(by_tracer(&mut tracer, &scene.camera, &settings)));
    let expected = in_order(on_device(&gpu, &moved, &settings));
    assert!(after == expected && before != expected && !expected.is_empty());
}

/// Whoever is traced first: within each bucket photons lie in the order in which they left their lights.
#[test]
fn buckets_are_in_the_order_of_photons() {
    let gpu = Gpu::headless().expect("a device");
    let settings = PhotonSettings { photons: 1 << 14, direct: DirectLight::Photons, ..PhotonSettings::default() };
    let (photons, ends) = on_device(&gpu, &named("cornell"), &PhotonSettings { radius: Some(60.0), ..settings });
    let all: std::collections::BTreeSet<u32> = photons.iter().map(|photon| photon.order).collect();
    assert!(all.len() == photons.len() && photons.len() > 10 * ends.len(), "each once, and many in a bucket");
    let starts: std::collections::BTreeSet<u32> = ends.iter().copied().chain([0]).collect();
    for (place, pair) in (1..).zip(photons.windows(2)) {
        assert!(pair[0].order < pair[1].order || starts.contains(&place), "{place}: {pair:?}");
    }
}

/// A closed box whose walls send on this share of their light.
fn closed_box(albedo: f32) -> Scene {
    let mut closed = named("hard/closed-box");
    for material in closed.materials.iter_mut() {
        material.bsdf = scene::Bsdf::Diffuse { albedo: scene::Texture::Constant(Vec3::splat(albedo)) };
    }
    closed
}

/// Where all light is sent on no photon ends by itself.
#[test]
fn photons_that_were_cut_short_are_counted_as_such() {
    let gpu = Gpu::headless().expect("a device");
    let white = closed_box(1.0);
    let settings = PhotonSettings { photons: 48, ..PhotonSettings::default() }.into();
    let mut tracer = GpuTracer::new(&gpu, &white).expect("a tracer");
    let mut film = film::Film::new(2, 2);
    let stats = tracer.render(&mut film, &white.camera, &settings, 2, &|| false).expect("two samples");
    assert_eq!((stats.photons, stats.cut_photons, stats.cut_paths), (96, 96, 0));
}

/// A closed box that sends nearly all light on has far more photons at its walls than leave the lights.
#[test]
fn a_list_that_is_too_short_is_made_longer_and_one_that_no_device_holds_is_refused() {
    let gpu = Gpu::headless().expect("a device");
    let closed = closed_box(0.97);
    let settings = PhotonSettings { photons: 1 << 12, direct: DirectLight::Photons, ..PhotonSettings::default() };
    let expected = photons_of(&Tracer::new(&closed), &closed, settings.photons, settings.direct);
    let (photons, _) = on_device(&gpu, &closed, &settings);
    let off = photons.len() as f64 / expected.len() as f64 - 1.0;
    // a walk that goes another way may be longer or shorter by some dozens of surfaces
    assert!(expected.len() as u32 > 2 * USUAL_SHARE * settings.photons && off.abs() < 0.01, "{off}");
    let most = most_photons(&gpu);
    assert_eq!(with_reserve(&gpu, most).expect("room"), most);
    let refused = with_reserve(&gpu, most + 1).expect_err("more than there is room for").to_string();
    assert!(
        refused.contains(&format!("has room for {most}")) && refused.contains("ask for fewer photons"),
        "{refused}"
    );
}
