//! Sweeps in one click: those of the tutorial, and what a lecture compares most.

use super::Axis;
use technique::{PaneSetup, TechniqueName};

/// What is varied, and of what.
#[derive(Debug, PartialEq)]
pub struct SweepPreset {
    /// Its name in the dump, and on the command line.
    pub name: &'static str,
    /// What its button says.
    pub title: &'static str,
    /// What a class sees in it.
    pub about: &'static str,
    /// The settings of all tiles, as `--b` of the window is typed.
    pub base: &'static str,
    /// A setting and its values.
    pub columns: (&'static str, &'static str),
    /// A second one; two empty words for a strip.
    pub rows: (&'static str, &'static str),
    /// Seconds for each tile; `None` for equal samples.
    pub seconds: Option<f32>,
}

const STRIP: (&str, &str) = ("", "");

/// All of them, in the order of the lecture.
pub const SWEEPS: &[SweepPreset] = &[
    SweepPreset {
        name: "bounces",
        title: "2 e) 0 / 1 / 2 bounces",
        about: "direct light, then what one bounce adds, and the second: less",
        base: "2e-0-bounces",
        columns: ("bounces", "0, 1, 2"),
        rows: STRIP,
        seconds: None,
    },
    SweepPreset {
        name: "spp",
        title: "2 f) 1 / 4 / 16 spp",
        about: "four times the samples halve the noise",
        base: "2f-1-spp",
        columns: ("spp", "1, 4, 16"),
        rows: STRIP,
        seconds: None,
    },
    SweepPreset {
        name: "estimators",
        title: "Estimators",
        about: "the same number of samples, aimed ever better",
        base: "path,spp=16",
        columns: ("estimator", "uniform, cosine, light, mis"),
        rows: STRIP,
        seconds: None,
    },
    SweepPreset {
        name: "samplers",
        title: "Estimators by samplers",
        about: "random numbers that keep apart help every estimator",
        base: "path,spp=16",
        columns: ("estimator", "uniform, cosine, light, mis"),
        rows: ("sampler", "independent, sobol"),
        seconds: None,
    },
    SweepPreset {
        name: "roulettes",
        title: "Roulettes, 1 s each",
        about: "all are unbiased: at equal time the noise tells them apart",
        base: "path",
        columns: ("roulette", "0.5, 0.8, throughput, 0.8+throughput"),
        rows: STRIP,
        seconds: Some(1.0),
    },
    SweepPreset {
        name: "integrators",
        title: "Integrators, 1 s each",
        about: "what each finds in the same time",
        base: "path",
        columns: ("technique", "whitted, path, photon, light-tracing, metropolis"),
        rows: STRIP,
        seconds: Some(1.0),
    },
    SweepPreset {
        name: "denoisers",
        title: "Denoisers, 4 spp",
        about: "the same four samples, raw and through each filter",
        base: "path,spp=4",
        columns: ("denoise", "off, atrous, unet, unet-base"),
        rows: STRIP,
        seconds: None,
    },
    SweepPreset {
        name: "mis",
        title: "Light, BSDF, both (MIS)",
        about: "light sampled, directions by the BSDF, and both, weighted: see the scene veach",
        base: "path,spp=16",
        columns: ("estimator", "light, cosine, mis"),
        rows: STRIP,
        seconds: None,
    },
];

impl SweepPreset {
    /// The sweep of that name.
    pub fn named(name: &str) -> Option<&'static SweepPreset> {
        SWEEPS.iter().find(|preset| preset.name == name)
    }

    /// What all tiles are set to.
    pub fn base(&self) -> PaneSetup {
        // a test reads all of them
        PaneSetup::parse(self.base, TechniqueName::Path).unwrap_or(PaneSetup::of(TechniqueName::Path))
    }

    /// What is varied from row to row.
    pub fn rows(&self) -> Axis {
        Axis::new(self.rows.0, self.rows.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Model, PaneId, Theme};

    #[test]
    fn every_preset_can_be_made_in_every_scene_of_the_lecture() {
        for scene in scene::builtin::names() {
            for preset in SWEEPS {
                assert!(PaneSetup::parse(preset.base, TechniqueName::Path).is_ok(), "{}", preset.base);
                let mut model = Model::new(scene::builtin::named(scene).unwrap(), scene.into(), Theme::Dark);
                model.take_sweep(preset);
                let plan = model.sweep_plan().unwrap_or_else(|fault| panic!("{}: {fault}", preset.name));
                assert_eq!(plan.rows.is_some(), preset.rows != STRIP);
                assert_eq!(SWEEPS.iter().filter(|other| other.name == preset.name).count(), 1);
            }
        }
    }

    #[test]
    fn the_tutorials_bounces_have_20_spp_and_its_samples_2_bounces() {
        let mut model = Model::new(scene::builtin::named("cornell").unwrap(), "cornell".into(), Theme::Dark);
        let mut tiles = |name: &str| {
            model.take_sweep(SweepPreset::named(name).unwrap());
            let tiles = model.sweep_plan().unwrap().tiles;
            tiles.iter().map(|tile| (tile.pane.truth.path.bounces, tile.pane.truth.spp)).collect::<Vec<_>>()
        };
        assert_eq!(tiles("bounces"), [(Some(0), 20), (Some(1), 20), (Some(2), 20)]);
        assert_eq!(tiles("spp"), [(Some(2), 1), (Some(2), 4), (Some(2), 16)]);
        assert_eq!(model.session.sweep.of, PaneId::B);
    }
}
