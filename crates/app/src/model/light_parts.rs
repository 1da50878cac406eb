//! How much light each bounce brings to a picture: its parts by bounce, and what is known of them.

use super::PaneId;
use pathtrace::{LightPaths, NamedLightPaths};
use technique::{Shot, Technique, TracedSettings};

/// Bounces that have a part of their own.
pub const BOUNCES: u32 = 9;

/// Parts of the light by bounce, which leave out none: lights themselves, each of the first bounces, and all others.
pub fn light_parts() -> impl Iterator<Item = NamedLightPaths> {
    let bounces = (0..BOUNCES).map(NamedLightPaths::Bounce);
    std::iter::once(NamedLightPaths::Emitted).chain(bounces).chain([NamedLightPaths::From(BOUNCES)])
}

/// A picture whose light by bounce is looked at.
#[derive(Debug, Clone)]
pub struct LightWish {
    /// The pane that shows it.
    pub pane: PaneId,
    /// Scene, camera and size.
    pub shot: Shot,
    /// How its light is found; all of it.
    pub technique: Technique,
}

impl LightWish {
    /// Of a pane's picture, whatever part of the light that shows; `None` where no light is followed from the eye.
    pub fn of(pane: PaneId, shot: &Shot, technique: Technique) -> Option<Self> {
        let mut technique = technique.with_light(LightPaths::ALL)?;
        if let Technique::Traced(traced) = &mut technique {
            // of which the light does not depend
            *traced = TracedSettings { sun_radius: traced.sun_radius, ..TracedSettings::new(traced.integrator, 1) };
        }
        Some(LightWish { pane, shot: shot.clone(), technique })
    }

    /// Whether both have the same light.
    pub fn is_like(&self, other: &LightWish) -> bool {
        let seen = |wish: &LightWish| (wish.pane, wish.technique, wish.shot.camera, wish.shot.size);
        seen(self) == seen(other) && std::sync::Arc::ptr_eq(&self.shot.scene, &other.shot.scene)
    }
}

/// What is known of a picture's light by bounce.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LightByBounce {
    /// Mean luminance that each of the [`light_parts`] brings, as far as they have been made.
    pub luminances: Vec<f64>,
}

impl LightByBounce {
    /// The share of the light that each part brings, once all have been made; `None` before, and where there is no light.
    pub fn shares(&self) -> Option<Vec<f64>> {
        let all: f64 = self.luminances.iter().sum();
        let complete = self.luminances.len() == light_parts().count() && all > 0.0;
        complete.then(|| self.luminances.iter().map(|luminance| luminance / all).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use technique::{PaneSettings, TechniqueName};

    #[test]
    fn shares_are_told_of_all_parts_and_add_up_to_one() {
        let mut light = LightByBounce { luminances: vec![1.0; light_parts().count() - 1] };
        assert_eq!(light.shares(), None, "one is missing");
        light.luminances.push(0.0);
        let shares = light.shares().expect("all are there");
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12 && shares[0] == 0.1);
        light.luminances.fill(0.0);
        assert_eq!(light.shares(), None, "there is no light");
    }

    #[test]
    fn a_wish_is_of_all_light_and_of_what_follows_it_from_the_eye() {
        let shot = Shot::of(scene::builtin::named("cornell").expect("built in"), (4, 4));
        let wish = |technique, light: &str, spp| {
            let mut pane = PaneSettings::of(technique);
            pane.truth.path.paths = LightPaths::parse(light).expect("light paths");
            pane.truth.spp = spp;
            LightWish::of(PaneId::A, &shot, pane.in_use())
        };
        let [all, part] = [wish(TechniqueName::Path, "all", 4), wish(TechniqueName::Path, "LDE", 9)];
        assert!(all.expect("paths").is_like(&part.expect("paths")));
        assert!(wish(TechniqueName::Raster, "all", 4).is_none() && wish(TechniqueName::Photon, "all", 4).is_none());
    }
}
