//! What labels say is missing, and where noise stays.

use super::*;
use crate::{PaneSettings, SceneChanges, Technique, TechniqueName};
use pathtrace::{GlassShadows, WhittedSettings};
use scene::builtin;

fn traced(technique: TechniqueName) -> TracedSettings {
    match PaneSettings::of(technique).in_use() {
        Technique::Traced(traced) => traced,
        Technique::Fake(_) => panic!("the fake is not traced"),
    }
}

fn path(estimator: Estimator, bounces: Option<u32>) -> TracedSettings {
    let settings = PathSettings { estimator, bounces, ..PathSettings::default() };
    TracedSettings { integrator: Integrator::Path(settings), ..traced(TechniqueName::Path) }
}

fn unconnected(bounces: Option<u32>) -> TracedSettings {
    let settings = PathSettings { connections: false, bounces, ..PathSettings::default() };
    TracedSettings { integrator: Integrator::Path(settings), ..traced(TechniqueName::Path) }
}

fn under_a_sun_of_radius(radius: f32) -> Scene {
    let changes = SceneChanges { sun_radius: Some(radius), ..SceneChanges::default() };
    changes.applied_to(&builtin::named("whitted").unwrap()).unwrap()
}

fn missing(settings: &TracedSettings, scene: &Scene) -> Vec<String> {
    settings.blind_spots(scene).into_iter().map(BlindSpot::missing).collect()
}

#[test]
fn what_a_picture_lacks_is_said_whatever_else_it_lacks() {
    let (wide, delta) = (under_a_sun_of_radius(2.5), under_a_sun_of_radius(0.0));
    assert_eq!(missing(&path(Estimator::LIGHT, None), &wide), [""; 0]);
    assert_eq!(missing(&path(Estimator::LIGHT, None), &delta), ["light by way of several spheres"]);
    assert_eq!(missing(&unconnected(None), &delta), ["light behind glass"]);
    assert_eq!(missing(&path(Estimator::COSINE, None), &delta), ["the sun's light"]);
    let short = missing(&unconnected(Some(2)), &delta);
    assert_eq!(short, ["light behind glass", "light after more than 2 bounces (biased)"]);
    assert_eq!(missing(&path(Estimator::LIGHT, Some(0)), &wide), ["indirect light (biased)"]);
    assert_eq!(missing(&traced(TechniqueName::Normals), &wide), [""; 0]);
    let chains = missing(&traced(TechniqueName::Metropolis), &delta);
    assert_eq!(chains, ["light by way of several spheres"], "they have the same paths");
}

#[test]
fn what_has_no_extent_is_named_with_all_its_words_where_light_is_met_by_chance() {
    let light = scene::PointLight { position: scene::Vec3::Y, intensity: scene::Vec3::ONE, spot: None };
    let lamps = Scene { point_lights: vec![light], ..builtin::named("cornell").unwrap() };
    assert_eq!(missing(&path(Estimator::COSINE, None), &lamps), ["the point lights' light"]);
    assert_eq!(missing(&path(Estimator::LIGHT, None), &lamps), [""; 0]);
}

#[test]
fn whitteds_trees_lack_the_same_whether_or_not_glass_stops_light() {
    let glass = builtin::named("whitted").unwrap();
    for glass_shadows in GlassShadows::ALL {
        let tree = WhittedSettings { glass_shadows, ..WhittedSettings::default() };
        let trees = TracedSettings { integrator: Integrator::Whitted(tree), ..traced(TechniqueName::Whitted) };
        assert_eq!(missing(&trees, &glass), ["light between surfaces", "caustics"], "{glass_shadows:?}");
        let dull = missing(&trees, &builtin::named("cornell").unwrap());
        assert_eq!(dull, ["light between surfaces"], "{glass_shadows:?}: nothing is specular there");
    }
}

#[test]
fn photons_blur_light_and_a_pinhole_sees_them_in_no_mirror() {
    let (delta, cornell) = (under_a_sun_of_radius(0.0), builtin::named("cornell").unwrap());
    let mut photon = traced(TechniqueName::Photon);
    assert_eq!(missing(&photon, &delta), ["detail finer than the radius (biased)"], "its caustic is there");
    if let Integrator::Photon(settings) = &mut photon.integrator {
        settings.points = true;
    }
    assert_eq!(missing(&photon, &delta), [""; 0], "points are no light");
    let light = traced(TechniqueName::LightTracing);
    assert_eq!(missing(&light, &delta), ["what glass and mirrors show"]);
    assert_eq!(missing(&light, &cornell), [""; 0]);
    assert_eq!(light.noise_source(&delta), None);
}

#[test]
fn photons_hardly_come_from_far_outside_the_picture() {
    let (far, near) = (builtin::named("hard/far-lamp").unwrap(), builtin::named("cornell").unwrap());
    let by_far = "most light by way of what is far outside the picture";
    assert_eq!(missing(&traced(TechniqueName::LightTracing), &far), [by_far]);
    assert_eq!(missing(&traced(TechniqueName::Photon), &far), ["detail finer than the radius (biased)", by_far]);
    assert_eq!(missing(&traced(TechniqueName::LightTracing), &near), [""; 0]);
    assert_eq!(missing(&path(Estimator::LIGHT, None), &far), [""; 0]);
}

#[test]
fn noise_stays_where_light_is_left_to_chance() {
    let (wide, delta) = (under_a_sun_of_radius(2.5), under_a_sun_of_radius(0.0));
    let cornell = builtin::named("cornell").unwrap();
    let of = |estimator, scene: &Scene| path(estimator, None).noise_source(scene);
    assert_eq!(unconnected(None).noise_source(&wide), Some(NoiseSource::Caustic(Specular::Glass)));
    assert_eq!(of(Estimator::LIGHT, &delta), None, "what is missing is no noise");
    assert_eq!(of(Estimator::LIGHT, &cornell), None);
    assert_eq!(of(Estimator::COSINE, &cornell), Some(NoiseSource::ByChance));
    assert_eq!(of(Estimator::COSINE, &wide), Some(NoiseSource::ByChance), "before what else is left to chance");
    assert_eq!(path(Estimator::LIGHT, Some(0)).noise_source(&wide), None, "direct light passes no glass");
    assert_eq!(traced(TechniqueName::Whitted).noise_source(&wide), None);
    assert_eq!(traced(TechniqueName::Metropolis).noise_source(&cornell), Some(NoiseSource::Chains));
}

/// `scene`, some of its shapes left out, and a box of glass or of a mirror.
fn rebuilt(scene: &Scene, keeps: fn(&Bsdf) -> bool, block: Option<fn(&Bsdf) -> bool>) -> Scene {
    let kept = scene.shapes.iter().filter(|shape| keeps(&scene.material_of(shape).bsdf)).cloned();
    let geometry = scene::Geometry::Box { corner: scene::Vec3::ZERO, size: scene::Vec3::ONE, turn_y: 0.0 };
    let material = |is: fn(&Bsdf) -> bool| scene.materials.iter().position(|m| is(&m.bsdf)).unwrap();
    let block = block.map(|is| Shape { geometry, material: material(is) });
    Scene { shapes: kept.chain(block).collect(), ..scene.clone() }
}

const IS_GLASS: fn(&Bsdf) -> bool = |bsdf| matches!(bsdf, Bsdf::Dielectric { .. });
const IS_MIRROR: fn(&Bsdf) -> bool = |bsdf| matches!(bsdf, Bsdf::Mirror { .. });

#[test]
fn what_spheres_send_on_is_found_and_what_other_glass_and_mirrors_do_is_left_to_chance() {
    let (wide, delta) = (under_a_sun_of_radius(2.5), under_a_sun_of_radius(0.0));
    for (block, specular, lacks) in [
        (IS_GLASS, Specular::Glass, "light behind glass that is no ball"),
        (IS_MIRROR, Specular::Mirror, "light from mirrors that are no balls"),
    ] {
        let [wide, delta] = [&wide, &delta].map(|scene| rebuilt(scene, |_| true, Some(block)));
        let connected = path(Estimator::MIS, None);
        assert_eq!(missing(&connected, &delta), [lacks]);
        assert_eq!(connected.noise_source(&wide), Some(NoiseSource::CausticOfOthers(specular)));
        assert_eq!(missing(&unconnected(None), &delta), ["light behind glass"], "of the balls too");
        assert_eq!(unconnected(None).noise_source(&wide), Some(NoiseSource::Caustic(Specular::Glass)));
    }
    let no_ball = rebuilt(&delta, |bsdf| !IS_GLASS(bsdf) && !IS_MIRROR(bsdf), Some(IS_GLASS));
    assert_eq!(missing(&path(Estimator::MIS, None), &no_ball), ["light behind glass"]);
    let bubble = SceneChanges { refraction_ratio: Some(1.2), ..SceneChanges::default() }.applied_to(&delta).unwrap();
    assert_eq!(missing(&path(Estimator::MIS, None), &bubble), ["light behind glass that is no ball"]);
}

#[test]
fn light_goes_by_way_of_several_spheres_where_there_are_several_or_glass_to_be_reflected_in() {
    let (wide, delta) = (under_a_sun_of_radius(2.5), under_a_sun_of_radius(0.0));
    let connected = path(Estimator::MIS, None);
    let specks = Some(NoiseSource::LongChains);
    assert_eq!(connected.noise_source(&wide), specks, "the glass and the mirror");
    let glass: fn(&Bsdf) -> bool = |bsdf| !IS_MIRROR(bsdf);
    assert_eq!(connected.noise_source(&rebuilt(&wide, glass, None)), specks, "more than once about in it");
    assert_eq!(missing(&connected, &rebuilt(&delta, glass, None)), ["light by way of several spheres"]);
    let mirror: fn(&Bsdf) -> bool = |bsdf| !IS_GLASS(bsdf);
    assert_eq!(connected.noise_source(&rebuilt(&wide, mirror, None)), None, "once off it");
    assert_eq!(missing(&connected, &rebuilt(&delta, mirror, None)), [""; 0]);
}

#[test]
fn a_light_without_extent_is_told_to_be_found_by_connections_where_they_are_off() {
    let delta = under_a_sun_of_radius(0.0);
    let told = |settings: &TracedSettings| settings.blind_spots(&delta)[0].explanation().unwrap();
    assert!(told(&unconnected(None)).contains("connections find it by way of balls"), "{}", told(&unconnected(None)));
    assert!(!told(&path(Estimator::MIS, None)).contains("casts no caustic"));
}
