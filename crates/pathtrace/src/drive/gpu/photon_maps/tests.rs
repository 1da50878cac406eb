//! Photons on the device against those on the processor.

use super::*;
use crate::gpu::GpuTracer;
use crate::integrator::photon::{DirectLight, Photon as HostPhoton, tests::photons_of};
use crate::tracer::Tracer;
use scene::{Scene, builtin};
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

fn named(name: &str) -> Scene {
    match name {
        "everything" => scene::parse(EVERYTHING, name, Path::new("everything-more.toml")).expect("a scene"),
        _ => builtin::named(name).expect("a built-in scene"),
    }
}

/// The photons of the first pass on the device, and how the map holds them.
fn on_device(gpu: &Gpu, scene: &Scene, settings: &PhotonSettings) -> (Vec<Photon>, Vec<u32>) {
    by_tracer(GpuTracer::new(gpu, scene).expect("a tracer"), scene, settings)
}

fn by_tracer(mut tracer: GpuTracer, scene: &Scene, settings: &PhotonSettings) -> (Vec<Photon>, Vec<u32>) {
    let mut film = tracer.film(film::Film::new(1, 1)).expect("a film");
    tracer.accumulate(&mut film, &scene.camera, &(*settings).into(), 1, &|| false).expect("a sample");
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
/// where they pass glass and mirrors. Few shapes one by one, and as many as one likes through a tree.
#[test]
fn both_machines_leave_the_same_photons() {
    let gpu = Gpu::headless().expect("a device");
    for (name, allowed) in [("cornell", 1e-3), ("whitted", 1e-2), ("everything", 1e-2)] {
        let scene = named(name);
        for direct in DirectLight::ALL {
            let settings = PhotonSettings { photons: 1 << 14, direct, ..PhotonSettings::default() };
            let expected = photons_of(&Tracer::new(&scene), &scene, settings.photons, direct);
            let apart = apart(on_device(&gpu, &scene, &settings), &expected, &scene);
            println!("{name} {direct:?}: {apart:.5} of {} photons apart", expected.len());
            assert!(expected.len() > 1000 && apart <= allowed, "{name} {direct:?}: {apart} of the photons are apart");
        }
    }
    let scene = named("everything");
    let settings = PhotonSettings { photons: 1 << 14, direct: DirectLight::Photons, ..PhotonSettings::default() };
    let expected = photons_of(&Tracer::new(&scene), &scene, settings.photons, settings.direct);
    let through_a_tree = GpuTracer::through_a_tree(&gpu, &scene).expect("a tracer");
    let apart = apart(by_tracer(through_a_tree, &scene, &settings), &expected, &scene);
    assert!(apart <= 1e-2, "through a tree {apart} of the photons are apart");
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

/// A closed box that sends nearly all light on has far more photons at its walls than leave the lights.
#[test]
fn a_list_that_is_too_short_is_made_longer_and_one_that_no_device_holds_is_refused() {
    let gpu = Gpu::headless().expect("a device");
    let mut closed = named("hard/closed-box");
    for material in closed.materials.iter_mut() {
        material.bsdf = scene::Bsdf::Diffuse { albedo: scene::Texture::Constant(Vec3::splat(0.97)) };
    }
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
