//! The tutorial's slides as they are shown: each a scene and two presets side by side, in the order of the lecture.

use super::{COMPARE, CompareWith, LADDER, Model, PaneId, PaneSource, TREES, View};
use compare::ErrorMetric;
use film::DisplayTransform;
use technique::{Preset, SceneChanges};

/// What a slide is about, as two pictures of one scene.
#[derive(Debug, PartialEq, Eq)]
pub struct Slide {
    /// Its name on the command line and in the dump.
    pub name: &'static str,
    /// As the menu calls it.
    pub title: &'static str,
    /// What to look at.
    pub about: &'static str,
    /// The name of a built-in scene.
    pub scene: &'static str,
    /// The presets of A and B by their names.
    pub presets: [&'static str; 2],
    /// Whether it is the reference that judges both.
    pub against_reference: bool,
    /// How both are seen: under the line, but side by side where each must be seen whole; or where A's errors are.
    pub view: View,
}

const fn slide(
    name: &'static str,
    title: &'static str,
    about: &'static str,
    scene: &'static str,
    presets: [&'static str; 2],
) -> Slide {
    Slide { name, title, about, scene, presets, against_reference: false, view: View::Wipe }
}

/// All slides that two pictures tell.
pub const SLIDES: &[Slide] = &[
    Slide {
        view: View::SideBySide,
        ..slide(
            "phong",
            "Phong and Blinn-Phong",
            "Where the light grazes the floor, Phong's highlight is round and Blinn-Phong's is drawn out towards the viewer",
            "phong",
            ["phong", "blinn-phong"],
        )
    },
    slide(
        "whitted",
        "Whitted 1980 above its fake",
        "Mirror and glass by trees of rays against a grey ball and a cube map",
        "whitted",
        ["whitted-1980", "as-taught"],
    ),
    slide(
        "1a",
        "1 a) The fake, as taught and fair",
        "The tutorial's viewer, and the same on linear light",
        "whitted",
        ["as-taught", "fair"],
    ),
    slide(
        "1b",
        "1 b) What went wrong here?",
        "The picture in the glass, the metal, the shadows and the light under the glass",
        "whitted",
        ["fair", "unlimited"],
    ),
    slide(
        "1d",
        "1 d) Whitted-style is wrong",
        "Light from one surface on another, soft shadows, the caustic",
        "cornell",
        ["whitted-1980", "unlimited"],
    ),
    slide(
        "1d-whitted",
        "1 d) The same of mirror and glass",
        "Whitted's picture has no caustic and hard shadows under its point sun",
        "whitted",
        ["unlimited", "whitted-1980"],
    ),
    slide(
        "2b",
        "2 b) Uniform sampling: the naive tracer",
        "Light is found by chance alone: 16 samples are noise",
        "cornell",
        ["naive", "unlimited"],
    ),
    slide(
        "naive-n",
        "N = 1 and N = 4 at every vertex",
        "Four directions cost four times the rays at each bounce: see the counters",
        "cornell",
        ["naive", "naive-4"],
    ),
    slide(
        "2c",
        "2 c) Uniform and light sampling, 20 spp",
        "The same rays, aimed at the lamp",
        "cornell",
        ["2b-uniform", "2c-light"],
    ),
    slide(
        "2e-0-1",
        "2 e) 0 and 1 bounce",
        "What one bounce adds: the ceiling, and colour on the boxes",
        "cornell",
        ["2e-0-bounces", "2e-1-bounce"],
    ),
    slide("2e-1-2", "2 e) 1 and 2 bounces", "What the second adds is less", "cornell", ["2e-1-bounce", "2e-2-bounces"]),
    slide(
        "roulette",
        "2 bounces and Russian roulette",
        "Biased, for longer paths are lost; unbiased, for what survives is divided by P",
        "cornell",
        ["2e-2-bounces", "complete"],
    ),
    slide("2f-1-4", "2 f) 1 and 4 spp", "Four times the samples halve the noise", "cornell", ["2f-1-spp", "2f-4-spp"]),
    slide("2f-4-16", "2 f) 4 and 16 spp", "And halve it again", "cornell", ["2f-4-spp", "2f-16-spp"]),
    slide("2f-1-16", "2 f) 1 and 16 spp", "A quarter of the noise", "cornell", ["2f-1-spp", "2f-16-spp"]),
    Slide {
        against_reference: true,
        ..slide(
            "denoise-1",
            "Denoising 1 spp",
            "The same samples, raw and through a network: what it makes up, the reference tells",
            "cornell",
            ["1-spp", "denoised-1-spp"],
        )
    },
    Slide {
        against_reference: true,
        ..slide(
            "denoise-512",
            "512 spp without and with a denoiser",
            "Where there are samples enough, the filter's bias is the larger error",
            "cornell",
            ["512-spp", "denoised-512-spp"],
        )
    },
    Slide {
        against_reference: true,
        view: View::ErrorMap,
        ..slide(
            "denoise-bias",
            "The bias of a denoiser",
            "What eight denoised pictures have in common and the truth has not: too bright or too dark, however many there are",
            "cornell",
            ["denoise-bias", "denoised-1-spp"],
        )
    },
];

impl Slide {
    /// The slide of that name.
    pub fn named(name: &str) -> Option<&'static Slide> {
        SLIDES.iter().find(|slide| slide.name == name)
    }
}

impl Model {
    /// Shows a slide: at once if its scene is open, else when it has come. Returns the scene to be opened for it.
    pub fn show_slide(&mut self, slide: &'static Slide) -> Option<&'static str> {
        self.state.awaited_slide = Some(slide);
        if self.session.is_in(TREES) || self.session.is_in(LADDER) {
            self.session.workspace = COMPARE;
        }
        if self.document.source != slide.scene {
            return Some(slide.scene);
        }
        self.take_awaited_slide();
        None
    }

    /// Sets the panes to the slide that waits for the scene that is open, if one does. One that waits for another is forgotten.
    pub fn take_awaited_slide(&mut self) {
        let Some(slide) = self.state.awaited_slide.take().filter(|slide| slide.scene == self.document.source) else {
            return;
        };
        for (pane, preset) in [PaneId::A, PaneId::B].into_iter().zip(slide.presets) {
            if let Some(preset) = Preset::named(preset) {
                self.take_preset(pane, preset);
            }
        }
        self.session.view = slide.view;
        self.look_at_the_whole();
        if slide.against_reference {
            self.session.comparison.with = CompareWith::Reference;
        }
        if slide.view == View::ErrorMap {
            (self.session.comparison.of, self.session.comparison.metric) = (PaneId::A, ErrorMetric::Signed);
        }
        // what was played with before is not on the slide
        self.document.changes = SceneChanges::default();
        self.apply_changes();
        self.document.camera = self.document.scene.camera;
        self.session.display = DisplayTransform::default();
        self.say(Ok(format!("{}: {}", slide.title, slide.about)));
    }

    /// Sets a pane to a preset; one that states no estimator has the one that the scene asks for.
    pub fn take_preset(&mut self, pane: PaneId, preset: &Preset) {
        let settings = &mut self.session.panes[pane];
        preset.apply(settings);
        if preset.values().all(|(setting, _)| setting.name != "estimator") {
            settings.take_usual_estimator(self.document.seen());
        }
        self.session.set_source(pane, PaneSource::Made);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Theme;
    use technique::TechniqueName;

    #[test]
    fn slides_name_scenes_and_presets_that_there_are() {
        for slide in SLIDES {
            assert!(scene::builtin::names().any(|name| name == slide.scene), "{}", slide.name);
            for preset in slide.presets {
                assert!(Preset::named(preset).is_some(), "{}: {preset}", slide.name);
            }
            assert_eq!(SLIDES.iter().filter(|other| other.name == slide.name).count(), 1);
        }
    }

    #[test]
    fn a_slide_of_another_scene_is_shown_once_that_has_come_and_no_other() {
        let open = |name: &str| scene::builtin::named(name).unwrap();
        let mut model = Model::new(open("whitted"), "whitted".into(), Theme::Dark);
        let slide = SLIDES.iter().find(|slide| slide.name == "2e-0-1").unwrap();
        assert_eq!(model.show_slide(slide), Some("cornell"));
        assert_eq!(model.session.panes[PaneId::A].technique, TechniqueName::Raster, "not yet");
        model.open(open("cornell"), "cornell".into());
        let bounces = |pane| model.session.panes[pane].truth.path.bounces;
        assert_eq!([PaneId::A, PaneId::B].map(bounces), [Some(0), Some(1)]);
        (model.document.changes.sun_radius, model.document.camera.fov_y) = (Some(1.0), 20.0);
        model.document.changes.take_edits(&"{ material.white.colour = [1, 0, 0] }".parse().unwrap());
        model.apply_changes();
        assert_eq!(model.show_slide(slide), None, "its scene is open");
        assert_eq!(model.document.changes, SceneChanges::default());
        assert!(**model.document.seen() == *model.document.scene);
        assert_eq!(model.document.camera, model.document.scene.camera);
        assert_eq!(model.show_slide(&SLIDES[0]), Some("phong"));
        model.open(open("whitted"), "whitted".into());
        model.open(open("phong"), "phong".into());
        assert_eq!(model.session.panes[PaneId::A].technique, TechniqueName::Path, "another scene came in between");
    }
}
