//! Settings by name: the tutorial's, slide by slide, each as one choice.

use crate::settings::{Setting, Value, of_panes};
use crate::{PaneSettings, TechniqueName};

/// A technique and what is set in it.
#[derive(Debug)]
pub struct Preset {
    /// The name on the command line.
    pub name: &'static str,
    /// What menus call it.
    pub title: &'static str,
    /// What its picture shows a class, in a few words.
    pub about: &'static str,
    /// The technique that it sets.
    pub technique: TechniqueName,
    /// Settings by their names, and their values as words. The technique's others are at their defaults.
    pub settings: &'static [(&'static str, &'static str)],
}

use TechniqueName::{Path, Raster, Whitted};

/// All presets, in the order of the lecture.
pub const ALL: &[Preset] = &[
    Preset {
        name: "as-taught",
        title: "1 a) Fake as taught",
        about: "The tutorial's viewer, number for number",
        technique: Raster,
        settings: &[("fake", "as-taught")],
    },
    Preset {
        name: "fair",
        title: "1 a) Fake, fair",
        about: "The same fake on the truth's light",
        technique: Raster,
        settings: &[("fake", "fair")],
    },
    Preset {
        name: "repaired",
        title: "1 b) Fake, repaired",
        about: "The fair fake with all that can be repaired of it",
        technique: Raster,
        settings: &[("fake", "fair"), ("repairs", "all")],
    },
    Preset {
        name: "phong",
        title: "Fake with Phong's highlight",
        about: "k_s max(0, R·V)^p",
        technique: Raster,
        settings: &[("shading", "phong")],
    },
    Preset {
        name: "blinn-phong",
        title: "Fake with Blinn-Phong's highlight",
        about: "k_s max(0, N·H)^p",
        technique: Raster,
        settings: &[("shading", "blinn-phong")],
    },
    Preset {
        name: "whitted-1980",
        title: "Whitted 1980",
        about: "Trees of rays at mirrors and glass under a point sun",
        technique: Whitted,
        settings: &[("traced-sun", "0")],
    },
    Preset {
        name: "2b-uniform",
        title: "2 b) Uniform sampling, 20 spp",
        about: "Direct light, found by chance: p = 1 / (2 pi)",
        technique: Path,
        settings: &[("estimator", "uniform"), ("bounces", "0"), ("roulette", "off"), ("spp", "20"), INDEPENDENT],
    },
    Preset {
        name: "naive",
        title: "2 b) Naive tracer, N = 1, 16 spp",
        about: "Path tracing: one direction at each vertex, 2 bounces, light found by chance",
        technique: Path,
        settings: &[("estimator", "uniform"), ("bounces", "2"), ("roulette", "off"), ("spp", "16"), INDEPENDENT],
    },
    Preset {
        name: "naive-4",
        title: "2 b) Naive tracer, N = 4, 1 spp",
        about: "Distributed ray tracing: four directions at each vertex, 2 bounces: up to N^(bounces + 1) paths",
        technique: Path,
        settings: &[
            ("estimator", "uniform"),
            ("bounces", "2"),
            ("roulette", "off"),
            ("branches", "4"),
            ("spp", "1"),
            INDEPENDENT,
        ],
    },
    Preset {
        name: "2c-light",
        title: "2 c) Light sampling, 20 spp",
        about: "Direct light, sampled: p = 1 / S",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "0"), ("roulette", "off"), ("spp", "20"), INDEPENDENT],
    },
    Preset {
        name: "2e-0-bounces",
        title: "2 e) No bounce, 20 spp",
        about: "Direct light only",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "0"), ("roulette", "off"), ("spp", "20"), INDEPENDENT],
    },
    Preset {
        name: "2e-1-bounce",
        title: "2 e) 1 bounce, 20 spp",
        about: "Light from one surface on another, once",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "1"), ("roulette", "off"), ("spp", "20"), INDEPENDENT],
    },
    Preset {
        name: "2e-2-bounces",
        title: "2 e) 2 bounces, 20 spp",
        about: "Still biased: longer paths are lost",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "2"), ("roulette", "off"), ("spp", "20"), INDEPENDENT],
    },
    Preset {
        name: "complete",
        title: "Complete tracer: roulette, P = 0.8, 20 spp",
        about: "Unlimited and unbiased: what survives is divided by P",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "inf"), ("roulette", "0.8"), ("spp", "20"), INDEPENDENT],
    },
    Preset {
        name: "2f-1-spp",
        title: "2 f) 1 spp, 2 bounces",
        about: "One path for each pixel",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "2"), ("roulette", "off"), ("spp", "1"), INDEPENDENT],
    },
    Preset {
        name: "2f-4-spp",
        title: "2 f) 4 spp, 2 bounces",
        about: "Half the noise of 1 spp",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "2"), ("roulette", "off"), ("spp", "4"), INDEPENDENT],
    },
    Preset {
        name: "2f-16-spp",
        title: "2 f) 16 spp, 2 bounces",
        about: "A quarter of the noise of 1 spp",
        technique: Path,
        settings: &[("estimator", "light"), ("bounces", "2"), ("roulette", "off"), ("spp", "16"), INDEPENDENT],
    },
    Preset {
        name: "unlimited",
        title: "Path tracing, unlimited, 256 spp",
        about: "Every path that there is, and random numbers that keep apart",
        technique: Path,
        settings: &[("bounces", "inf"), ("roulette", "throughput"), ("spp", "256")],
    },
    Preset {
        name: "1-spp",
        title: "Path tracing, 1 spp",
        about: "One path of each pixel, and nothing else",
        technique: Path,
        settings: &[("spp", "1")],
    },
    Preset {
        name: "denoised-1-spp",
        title: "Path tracing, 1 spp, denoised",
        about: "The same path of each pixel, and a network that has seen many pictures",
        technique: Path,
        settings: &[("spp", "1"), ("denoise", "unet")],
    },
    Preset {
        name: "512-spp",
        title: "Path tracing, 512 spp",
        about: "512 paths of each pixel",
        technique: Path,
        settings: &[("spp", "512")],
    },
    Preset {
        name: "denoised-512-spp",
        title: "Path tracing, 512 spp, denoised",
        about: "The same paths and a network: smoother, and no nearer to the truth",
        technique: Path,
        settings: &[("spp", "512"), ("denoise", "unet")],
    },
    Preset {
        name: "denoise-bias",
        title: "Path tracing, 8 times 4 spp, each denoised",
        about: "The mean of eight denoised pictures: what is wrong with it is the network's bias",
        technique: Path,
        settings: &[("spp", "4"), ("denoise", "unet"), ("runs", "8")],
    },
];

/// The tutorial's random numbers, whose error falls like 1 / sqrt(spp).
const INDEPENDENT: (&str, &str) = ("sampler", "independent");

/// What the tutorial's own path tracers, those with its random numbers, leave to chance.
const LEFT_TO_CHANCE: &[(&str, &str)] = &[("connections", "off"), ("cones", "off"), ("split-glass", "off")];

impl Preset {
    /// The preset of that name.
    pub fn named(name: &str) -> Option<&'static Preset> {
        ALL.iter().find(|preset| preset.name == name)
    }

    /// What it states, and what it leaves to chance as the tutorial did.
    fn all_settings(&self) -> impl Iterator<Item = &'static (&'static str, &'static str)> {
        let taught = self.settings.contains(&INDEPENDENT);
        self.settings.iter().chain(if taught { LEFT_TO_CHANCE } else { &[] })
    }

    /// What it states, by the rows of the table.
    pub fn values(&self) -> impl Iterator<Item = (&'static Setting<PaneSettings>, Value)> {
        self.all_settings().filter_map(|(name, word)| {
            let setting = of_panes(name)?;
            Some((setting, setting.kind.parse(word).ok()?))
        })
    }

    /// Sets a pane to it; device and the other techniques' settings stay.
    pub fn apply(&self, pane: &mut PaneSettings) {
        let mut preset = PaneSettings::of(self.technique);
        self.values().for_each(|(setting, value)| (setting.set)(&mut preset, value));
        pane.technique = self.technique;
        pane.take_settings_in_use(&preset);
    }

    /// Its settings as options are typed: "estimator uniform, bounces 0".
    pub fn words(&self) -> String {
        let words: Vec<_> = self.all_settings().map(|(name, word)| format!("{name} {word}")).collect();
        words.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::all_of_panes;
    use crate::{DeviceChoice, Technique};

    #[test]
    fn a_preset_sets_what_it_states_and_nothing_else() {
        let mut changed = PaneSettings { device: DeviceChoice::Gpu, adapter: 3, ..PaneSettings::of(Raster) };
        changed.fake.knobs.segments = Some(7);
        (changed.whitted.spp, changed.truth.path.seed) = (3, 9);
        for preset in ALL {
            let mut pane = changed;
            preset.apply(&mut pane);
            assert_eq!((pane.technique, pane.device, pane.adapter), (preset.technique, DeviceChoice::Gpu, 3));
            for setting in all_of_panes().filter(|setting| setting.is_of(preset.technique)) {
                let stated = preset.all_settings().find(|(name, _)| *name == setting.name);
                let expected = match stated {
                    Some((_, word)) => Some(setting.kind.parse(word).unwrap()),
                    None => (setting.get)(&PaneSettings::of(preset.technique)),
                };
                assert_eq!((setting.get)(&pane), expected, "{} of {}", setting.name, preset.name);
            }
            let others =
                |pane: &PaneSettings| (pane.fake, pane.whitted, pane.truth, pane.photon, pane.light, pane.normals);
            let mut back = pane;
            back.take_settings_in_use(&PaneSettings { technique: preset.technique, ..changed });
            assert_eq!(others(&back), others(&changed), "{} leaves other techniques alone", preset.name);
        }
    }

    #[test]
    fn presets_name_settings_of_their_technique_and_can_be_traced() {
        for preset in ALL {
            assert_eq!(preset.values().count(), preset.all_settings().count(), "{}: {}", preset.name, preset.words());
            assert!(preset.values().all(|(setting, _)| setting.is_of(preset.technique)), "{}", preset.name);
            let of_the_name = ALL.iter().filter(|other| other.name == preset.name).count();
            assert_eq!(of_the_name, 1, "{}", preset.name);
            let mut pane = PaneSettings::of(Raster);
            preset.apply(&mut pane);
            if let Technique::Traced(traced) = pane.in_use() {
                assert!(traced.integrator.check().is_ok(), "{}", preset.name);
            }
        }
    }
}
