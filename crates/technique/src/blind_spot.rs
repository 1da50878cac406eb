//! What settings cannot see in a scene, and where their noise stays longest: to be said rather than hidden.

use crate::TracedSettings;
use pathtrace::{Estimator, Integrator, LightSampling, PathSettings};
use scene::{Needs, Scene};

/// Light of a scene that a picture lacks, or hardly ever finds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BlindSpot {
    /// A sun without a disc, where light is met by chance.
    Sun,
    /// Point lights, where light is met by chance.
    PointLights,
    /// What a sun without a disc sends through glass, or by mirrors alone.
    CausticOfSun(Specular),
    /// The same of point lights.
    CausticOfPointLights(Specular),
    /// What a sun without a disc or point lights send by way of several spheres, where connections find what goes by one.
    LongChains,
    /// What paths of more bounces than these bring.
    LongPaths(u32),
    /// Whitted's method: what one surface sends to another.
    BetweenSurfaces,
    /// Whitted's method: what mirrors and glass send to surfaces, whether or not light passes glass straight on.
    Caustics,
    /// Photon maps: what is finer than the radius in which photons are gathered.
    BlurredLight,
    /// Light tracing: what is seen in mirrors or through glass.
    InSpeculars(Specular),
    /// Lights in smooth rough metal, where light sampling alone has to hit the reflection.
    NarrowReflections,
}

/// What leaves a path no choice of its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Specular {
    /// Glass, with mirrors or without.
    Glass,
    /// Mirrors, and no glass.
    Mirror,
}

/// Where a picture is still noisy when the rest of it is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoiseSource {
    /// Wherever there is light: no estimator aims at it.
    ByChance,
    /// Where light is sent through glass, or by mirrors alone: light sampling cannot aim through them.
    Caustic(Specular),
    /// In smooth rough metal.
    NarrowReflections,
    /// Where chains have been: their paths are alike.
    Chains,
}

impl Specular {
    fn of(needs: &Needs) -> Option<Self> {
        match (needs.dielectric, needs.mirror) {
            (true, _) => Some(Specular::Glass),
            (false, true) => Some(Specular::Mirror),
            (false, false) => None,
        }
    }
}

impl BlindSpot {
    /// What is missing, in the words of a label.
    pub fn missing(self) -> String {
        match self {
            BlindSpot::Sun => "the sun's light".into(),
            BlindSpot::PointLights => "the point lights' light".into(),
            BlindSpot::CausticOfSun(Specular::Glass) | BlindSpot::CausticOfPointLights(Specular::Glass) => {
                "light behind glass".into()
            }
            BlindSpot::CausticOfSun(Specular::Mirror) | BlindSpot::CausticOfPointLights(Specular::Mirror) => {
                "light from mirrors".into()
            }
            BlindSpot::LongChains => "light by way of several spheres".into(),
            BlindSpot::LongPaths(0) => "indirect light (biased)".into(),
            BlindSpot::LongPaths(1) => "light after more than 1 bounce (biased)".into(),
            BlindSpot::LongPaths(bounces) => format!("light after more than {bounces} bounces (biased)"),
            BlindSpot::BetweenSurfaces => "light between surfaces".into(),
            BlindSpot::Caustics => "caustics".into(),
            BlindSpot::BlurredLight => "light finer than the radius (biased)".into(),
            BlindSpot::InSpeculars(Specular::Glass) => "what glass and mirrors show".into(),
            BlindSpot::InSpeculars(Specular::Mirror) => "what mirrors show".into(),
            BlindSpot::NarrowReflections => "most light in narrow reflections".into(),
        }
    }

    /// What is missing and why, in a line; `None` of a limit, which whoever sets it has asked for.
    pub fn explanation(self) -> Option<&'static str> {
        Some(match self {
            BlindSpot::Sun => "a sun of radius 0 cannot be hit by chance: its light is missing",
            BlindSpot::PointLights => "a point light cannot be hit by chance: its light is missing",
            BlindSpot::CausticOfSun(_) => {
                "a sun of radius 0 casts no caustic: no path can find it behind glass or mirror"
            }
            BlindSpot::CausticOfPointLights(_) => {
                "a point light casts no caustic: no path can find it behind glass or mirror"
            }
            BlindSpot::LongChains => {
                "a light without extent is connected to by one sphere at a time: what goes by several of them, or more than \
                 once about in one, is missing"
            }
            BlindSpot::LongPaths(_) => return None,
            BlindSpot::BetweenSurfaces => "light from one surface on another is missing: ambient light stands for it",
            BlindSpot::Caustics => "mirrors and glass send no light on to surfaces: caustics are missing",
            BlindSpot::BlurredLight => {
                "photons are gathered over a disc: light is blurred, and too dark at edges, less with each pass"
            }
            BlindSpot::InSpeculars(_) => {
                "mirrors and glass are black: a photon that leaves them hits the pinhole by no chance"
            }
            BlindSpot::NarrowReflections => {
                "smooth rough metal is noise without mis: light in a narrow reflection is hardly ever found"
            }
        })
    }
}

impl NoiseSource {
    /// Where and why, in the words of a label.
    pub fn words(self) -> &'static str {
        match self {
            NoiseSource::ByChance => "still noisy: light is met only by chance",
            NoiseSource::Caustic(Specular::Glass) => "still noisy under the glass: light reaches it only by chance",
            NoiseSource::Caustic(Specular::Mirror) => {
                "still noisy where mirrors send light: it gets there only by chance"
            }
            NoiseSource::Chains => "still noisy in blotches: a chain's paths are alike",
            NoiseSource::NarrowReflections => "still noisy in the metal: its reflections hardly ever meet a light",
        }
    }
}

impl TracedSettings {
    /// What these settings cannot see in this scene.
    pub fn blind_spots(&self, scene: &Scene) -> Vec<BlindSpot> {
        match self.integrator {
            Integrator::Path(path) => of_paths(&path, scene, self.sees_a_delta_sun(scene)),
            Integrator::Metropolis(chains) => of_paths(&chains.path, scene, self.sees_a_delta_sun(scene)),
            Integrator::Whitted(_) => of_trees(&scene.needs()),
            Integrator::Photon(photon) if photon.points => Vec::new(),
            Integrator::Photon(_) => vec![BlindSpot::BlurredLight],
            Integrator::LightTracing(_) => {
                Specular::of(&scene.needs()).map(BlindSpot::InSpeculars).into_iter().collect()
            }
            Integrator::Normals(_) => Vec::new(),
        }
    }

    /// Where a picture by these settings stays noisy longest, if they leave light to chance.
    pub fn noise_source(&self, scene: &Scene) -> Option<NoiseSource> {
        let path = match self.integrator {
            Integrator::Path(path) => path,
            Integrator::Metropolis(_) => return Some(NoiseSource::Chains),
            Integrator::Photon(_) | Integrator::LightTracing(_) => return None,
            Integrator::Whitted(_) | Integrator::Normals(_) => return None,
        };
        let needs = scene.needs();
        // what has no extent is not met by chance, but missing
        let disc = scene.sun.is_some() && !self.sees_a_delta_sun(scene);
        let lights = needs.area_lights || disc || scene.environment.is_some();
        match Specular::of(&needs) {
            _ if lights && !path.estimator.samples_lights() => Some(NoiseSource::ByChance),
            Some(specular) if lights && path.bounces != Some(0) && !finds_caustics(&path, &needs) => {
                Some(NoiseSource::Caustic(specular))
            }
            _ if is_blind_in_metal(&path, &needs) => Some(NoiseSource::NarrowReflections),
            _ => None,
        }
    }
}

fn of_paths(path: &PathSettings, scene: &Scene, delta_sun: bool) -> Vec<BlindSpot> {
    let needs = scene.needs();
    let by_chance = path.estimator.light == LightSampling::BsdfOnly;
    let sources = [
        (delta_sun, BlindSpot::Sun, BlindSpot::CausticOfSun as fn(Specular) -> BlindSpot),
        (needs.point_lights, BlindSpot::PointLights, BlindSpot::CausticOfPointLights),
    ];
    let specular = Specular::of(&needs);
    let caustics = |of: fn(Specular) -> BlindSpot| {
        let missing = |specular| if finds_caustics(path, &needs) { BlindSpot::LongChains } else { of(specular) };
        specular.map(missing)
    };
    let mut unseen: Vec<_> = sources
        .into_iter()
        .filter(|(there, ..)| *there)
        .filter_map(|(_, all, caustic)| if by_chance { Some(all) } else { caustics(caustic) })
        .collect();
    unseen.dedup();
    let metal = is_blind_in_metal(path, &needs).then_some(BlindSpot::NarrowReflections);
    unseen.into_iter().chain(metal).chain(path.bounces.map(BlindSpot::LongPaths)).collect()
}

/// Whether lights are connected to by way of all that is glass or a mirror.
fn finds_caustics(path: &PathSettings, needs: &Needs) -> bool {
    path.connections && path.estimator.samples_lights() && !needs.other_speculars
}

/// What trees of rays lack whatever their settings are: rough metal is a mirror to them.
fn of_trees(needs: &Needs) -> Vec<BlindSpot> {
    let caustics = Specular::of(needs).is_some() || needs.rough_conductor;
    std::iter::once(BlindSpot::BetweenSurfaces).chain(caustics.then_some(BlindSpot::Caustics)).collect()
}

fn is_blind_in_metal(path: &PathSettings, needs: &Needs) -> bool {
    needs.rough_conductor
        && path.estimator.samples_lights()
        && !matches!(path.estimator, Estimator::MIS | Estimator::GUIDED_MIS)
}

#[cfg(test)]
mod tests {
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
        changes.applied_to(&builtin::named("whitted").unwrap())
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
        assert_eq!(
            missing(&traced(TechniqueName::Metropolis), &delta),
            ["light behind glass"],
            "it has the same paths"
        );
    }

    #[test]
    fn what_has_no_extent_is_named_with_all_its_words_where_light_is_met_by_chance() {
        let light = scene::PointLight { position: scene::Vec3::Y, intensity: scene::Vec3::ONE };
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
        assert_eq!(missing(&photon, &delta), ["light finer than the radius (biased)"], "its caustic is there");
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
    fn noise_stays_where_light_is_left_to_chance() {
        let (wide, delta) = (under_a_sun_of_radius(2.5), under_a_sun_of_radius(0.0));
        let cornell = builtin::named("cornell").unwrap();
        let of = |estimator, scene: &Scene| path(estimator, None).noise_source(scene);
        let caustic = Some(NoiseSource::Caustic(Specular::Glass));
        assert_eq!(of(Estimator::LIGHT, &wide), None, "connections aim at it");
        assert_eq!(unconnected(None).noise_source(&wide), caustic);
        let block = scene::Geometry::Box { corner: scene::Vec3::ZERO, size: scene::Vec3::ONE, turn_y: 0.0 };
        let mut blocks = wide.clone();
        let glass = wide.materials.iter().position(|m| matches!(m.bsdf, scene::Bsdf::Dielectric { .. })).unwrap();
        blocks.shapes =
            wide.shapes.iter().cloned().chain([scene::Shape { geometry: block, material: glass }]).collect();
        assert_eq!(of(Estimator::LIGHT, &blocks), caustic, "a block of glass is left to chance");
        assert_eq!(of(Estimator::LIGHT, &delta), None, "what is missing is no noise");
        assert_eq!(of(Estimator::LIGHT, &cornell), None);
        assert_eq!(of(Estimator::COSINE, &cornell), Some(NoiseSource::ByChance));
        assert_eq!(path(Estimator::LIGHT, Some(0)).noise_source(&wide), None, "direct light passes no glass");
        assert_eq!(traced(TechniqueName::Whitted).noise_source(&wide), None);
        assert_eq!(traced(TechniqueName::Metropolis).noise_source(&cornell), Some(NoiseSource::Chains));
    }
}
