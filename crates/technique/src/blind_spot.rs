//! What settings cannot see in a scene, and where their noise stays longest: to be said rather than hidden.

use crate::TracedSettings;
use pathtrace::{Estimator, Integrator, LightSampling, PathSettings, sees_little};
use scene::{Bsdf, Needs, Scene, Shape};

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
    /// What a sun without a disc or point lights send through other glass than balls, or by other mirrors, where connections
    /// find what goes by a ball.
    CausticOfOthers(Specular),
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
    /// Photons, where the camera sees little of the scene: what comes there by way of the rest.
    FromAfar,
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
    /// The same of glass and mirrors that are no balls, where connections aim by way of balls.
    CausticOfOthers(Specular),
    /// Where light has come by way of several spheres: connections aim by way of one.
    LongChains,
    /// In smooth rough metal.
    NarrowReflections,
    /// Where chains have been: their paths are alike.
    Chains,
}

/// Which of the mirrors and glass of a scene light is connected to by way of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Connected {
    /// None of them, or there is none.
    Nothing,
    /// The balls, beside which there are these.
    BallsBut(Specular),
    /// All glass and mirrors are connected through or off.
    All,
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
            BlindSpot::CausticOfOthers(Specular::Glass) => "light behind glass that is no ball".into(),
            BlindSpot::CausticOfOthers(Specular::Mirror) => "light from mirrors that are no balls".into(),
            BlindSpot::LongChains => "light by way of several spheres".into(),
            BlindSpot::LongPaths(0) => "indirect light (biased)".into(),
            BlindSpot::LongPaths(1) => "light after more than 1 bounce (biased)".into(),
            BlindSpot::LongPaths(bounces) => format!("light after more than {bounces} bounces (biased)"),
            BlindSpot::BetweenSurfaces => "light between surfaces".into(),
            BlindSpot::Caustics => "caustics".into(),
            BlindSpot::BlurredLight => "detail finer than the radius (biased)".into(),
            BlindSpot::FromAfar => "most light by way of what is far outside the picture".into(),
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
                "a sun of radius 0 casts no caustic by chance: no path can meet it behind glass or mirror; connections find it \
                 by way of balls"
            }
            BlindSpot::CausticOfPointLights(_) => {
                "a point light casts no caustic by chance: no path can meet it behind glass or mirror; connections find it by \
                 way of balls"
            }
            BlindSpot::CausticOfOthers(_) => {
                "a light without extent is connected to by one ball at a time: what other glass and mirrors send on is missing, \
                 and what goes by several balls"
            }
            BlindSpot::LongChains => {
                "a light without extent is connected to by one sphere at a time: what goes by several of them, from within one, or more than \
                 once about in one, is missing"
            }
            BlindSpot::LongPaths(_) => return None,
            BlindSpot::BetweenSurfaces => "light from one surface on another is missing: ambient light stands for it",
            BlindSpot::Caustics => "mirrors and glass send no light on to surfaces: caustics are missing",
            BlindSpot::BlurredLight => {
                "photons are gathered over a disc: light is blurred, and too dark at edges, less with each pass"
            }
            BlindSpot::FromAfar => {
                "the camera sees little of the scene: photons are aimed there, but light that has met a surface far away hardly \
                 ever comes"
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
            NoiseSource::CausticOfOthers(Specular::Glass) => {
                "still noisy under glass that is no ball: light reaches it only by chance"
            }
            NoiseSource::CausticOfOthers(Specular::Mirror) => {
                "still noisy where mirrors that are no balls send light: it gets there only by chance"
            }
            NoiseSource::LongChains => "still a few specks: light by way of several spheres",
            NoiseSource::Chains => "still noisy in blotches: a chain's paths are alike",
            NoiseSource::NarrowReflections => "still noisy in the metal: its reflections hardly ever meet a light",
        }
    }
}

impl TracedSettings {
    /// What these settings cannot see in this scene.
    pub fn blind_spots(&self, scene: &Scene) -> Vec<BlindSpot> {
        if self.feature.is_some() {
            return Vec::new();
        }
        match self.integrator {
            Integrator::Path(path) => of_paths(&path, scene, self.sees_a_delta_sun(scene)),
            Integrator::Metropolis(chains) => of_paths(&chains.path, scene, self.sees_a_delta_sun(scene)),
            Integrator::Whitted(_) => of_trees(&scene.needs()),
            Integrator::Photon(photon) if photon.points => Vec::new(),
            Integrator::Photon(_) => [BlindSpot::BlurredLight].into_iter().chain(from_afar(scene)).collect(),
            Integrator::LightTracing(_) => {
                let speculars = Specular::of(&scene.needs()).map(BlindSpot::InSpeculars);
                speculars.into_iter().chain(from_afar(scene)).collect()
            }
            Integrator::Normals(_) => Vec::new(),
        }
    }

    /// Where a picture by these settings stays noisy longest, if they leave light to chance.
    pub fn noise_source(&self, scene: &Scene) -> Option<NoiseSource> {
        let path = match self.integrator {
            _ if self.feature.is_some() => return None,
            Integrator::Path(path) => path,
            Integrator::Metropolis(_) => return Some(NoiseSource::Chains),
            Integrator::Photon(_) | Integrator::LightTracing(_) => return None,
            Integrator::Whitted(_) | Integrator::Normals(_) => return None,
        };
        let needs = scene.needs();
        // what has no extent is not met by chance, but missing
        let disc = scene.sun.is_some() && !self.sees_a_delta_sun(scene);
        let lights = needs.area_lights || disc || scene.environment.is_some();
        if lights && !path.estimator.samples_lights() {
            return Some(NoiseSource::ByChance);
        }
        let goes_on = lights && path.bounces != Some(0);
        let metal = is_blind_in_metal(&path, &needs).then_some(NoiseSource::NarrowReflections);
        match Connected::by(&path, scene) {
            Connected::Nothing if goes_on => Specular::of(&needs).map(NoiseSource::Caustic).or(metal),
            Connected::BallsBut(others) if goes_on => Some(NoiseSource::CausticOfOthers(others)),
            Connected::All if goes_on && has_long_chains(scene) => metal.or(Some(NoiseSource::LongChains)),
            _ => metal,
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
    let connected = Connected::by(path, scene);
    let caustics = |of: fn(Specular) -> BlindSpot| match connected {
        Connected::Nothing => specular.map(of),
        Connected::BallsBut(others) => Some(BlindSpot::CausticOfOthers(others)),
        Connected::All => has_long_chains(scene).then_some(BlindSpot::LongChains),
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

impl Connected {
    fn by(path: &PathSettings, scene: &Scene) -> Self {
        let needs = scene.needs();
        if !(path.connections && path.estimator.samples_lights() && needs.casters) || path.is_broken() {
            return Connected::Nothing;
        }
        let others = scene.shapes.iter().filter(|shape| !scene.is_caster(shape));
        let (dielectric, mirror) = others.fold((false, false), |(glass, mirror), shape| {
            let bsdf = &scene.material_of(shape).bsdf;
            (glass || matches!(bsdf, Bsdf::Dielectric { .. }), mirror || matches!(bsdf, Bsdf::Mirror { .. }))
        });
        let others = Specular::of(&Needs { dielectric, mirror, ..Needs::default() });
        others.map_or(Connected::All, Connected::BallsBut)
    }
}

/// Whether light goes by way of several casters, or more than once about in one of glass.
fn has_long_chains(scene: &Scene) -> bool {
    let mut casters = scene.shapes.iter().filter(|shape| scene.is_caster(shape));
    let inside = |shape: &Shape| matches!(scene.material_of(shape).bsdf, Bsdf::Dielectric { .. });
    casters.next().is_some_and(|first| inside(first) || casters.next().is_some())
}

/// What trees of rays lack whatever their settings are: rough metal is a mirror to them, and so are the metal and
/// the polish of metallic-roughness.
fn of_trees(needs: &Needs) -> Vec<BlindSpot> {
    let caustics = Specular::of(needs).is_some() || needs.rough_conductor || needs.metallic_roughness;
    std::iter::once(BlindSpot::BetweenSurfaces).chain(caustics.then_some(BlindSpot::Caustics)).collect()
}

fn from_afar(scene: &Scene) -> Option<BlindSpot> {
    sees_little(scene).then_some(BlindSpot::FromAfar)
}

fn is_blind_in_metal(path: &PathSettings, needs: &Needs) -> bool {
    (needs.rough_conductor || needs.metallic_roughness)
        && path.estimator.samples_lights()
        && !matches!(path.estimator, Estimator::MIS | Estimator::GUIDED_MIS)
}

#[cfg(test)]
mod tests;
