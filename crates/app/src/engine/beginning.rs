//! What a window or a report begins with: a scene as its session, a picture of it or options set it up.

use super::load::{self, Asked, Loaded, Loader, Opened, ReferenceFile, Refusal};
use super::{Wake, memory};
use crate::model::{Document, EVERYBODYS, Model, Remembered, SavedWindow, ViewArgs};
use anyhow::bail;
use scene::Progress;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// What a window begins with.
pub struct Beginning {
    /// The scene, or the picture that shows it.
    pub opened: Opened,
    /// What earlier windows have left.
    pub remembered: Remembered,
}

impl Beginning {
    /// Reads a scene, a session or a picture by its name or file.
    ///
    /// # Errors
    /// If there is no scene to show.
    pub fn read(scene: &str) -> anyhow::Result<Self> {
        let remembered = recall();
        let asked = Asked::Open { name: scene.to_owned(), recent: remembered.recent.clone() };
        Beginning::with(load::read(&asked, &Progress::untold()), remembered)
    }

    fn with(read: Result<Loaded, Refusal>, remembered: Remembered) -> anyhow::Result<Self> {
        match read {
            Ok(Loaded::Scene(opened)) => Ok(Beginning { opened: *opened, remembered }),
            Ok(Loaded::Reference(ReferenceFile { sceneless: Some(line), .. })) => bail!("{line}"),
            Ok(Loaded::Reference(ReferenceFile { file, .. })) => bail!(
                "this picture does not say how it was made; open its scene and compare with it there: {}",
                image_file::shown(&file)
            ),
            Err(refusal) => bail!("{}", refusal.line),
        }
    }

    /// The window's size in points, where a session that was opened has one.
    pub fn window_size(&self) -> Option<[f64; 2]> {
        self.opened.session.as_ref().and_then(|session| session.window.size)
    }

    /// The scene that was read, as the options and the session or the picture that was opened set it up.
    ///
    /// # Errors
    /// If the camera that is asked for sees nothing, or the scene lacks what is to be changed in it.
    pub fn model(&self, args: &ViewArgs) -> anyhow::Result<Model> {
        let opened = &self.opened;
        let setup = opened.setup.clone().unwrap_or_default().overridden_by(&args.setup);
        let mut model = Model::new(opened.scene.clone(), opened.source.clone(), args.theme.unwrap_or_default());
        if let Some(session) = &opened.session {
            let theme = args.theme.or(session.window.theme);
            model.restore_window(&SavedWindow { theme, ..session.window });
            model.restore(session, &setup).map_err(anyhow::Error::msg)?;
        } else {
            // its scene is the one that is open
            args.slide.into_iter().for_each(|slide| _ = model.show_slide(slide));
            model.set_up(&setup).map_err(anyhow::Error::msg)?;
        }
        let Document { changes, .. } = &model.document;
        changes.edits.without_effect(model.document.seen()).iter().for_each(|line| note!("note: {line}"));
        let asked = args.workspace.as_ref().and_then(|asked| EVERYBODYS.into_iter().find(|known| known == asked));
        model.session.workspace = asked.unwrap_or(model.session.workspace);
        Ok(model)
    }
}

/// What a window begins with while it is read beside whoever opens the window.
pub struct Reading {
    loader: Loader,
    remembered: Remembered,
    doing: Option<String>,
    woken: Receiver<()>,
    /// Of the window, once there is one.
    wake: Arc<OnceLock<Wake>>,
}

impl Reading {
    /// Begins to read a scene, a session or a picture by its name or file.
    pub fn begin(scene: &str) -> Self {
        let remembered = recall();
        let (tell, woken) = channel();
        let wake = Arc::new(OnceLock::<Wake>::new());
        let of_the_window = wake.clone();
        let loader = Loader::new(Arc::new(move || {
            // nobody waits here once there is a window
            let _ = tell.send(());
            of_the_window.get().into_iter().for_each(|wake| wake());
        }));
        loader.load(Asked::Open { name: scene.to_owned(), recent: remembered.recent.clone() });
        Reading { loader, remembered, doing: None, woken, wake }
    }

    /// What was read within so long, if it was.
    pub fn within(&mut self, time: Duration) -> Option<anyhow::Result<Beginning>> {
        let begun = Instant::now();
        loop {
            let read = self.read();
            let left = time.saturating_sub(begun.elapsed());
            if read.is_some() || left.is_zero() {
                return read;
            }
            // either way it is looked at again
            let _ = self.woken.recv_timeout(left);
        }
    }

    /// What was read by now, once.
    pub fn read(&mut self) -> Option<anyhow::Result<Beginning>> {
        let read = self.loader.loaded(&mut self.doing)?;
        Some(Beginning::with(read, std::mem::take(&mut self.remembered)))
    }

    /// Lets a window hear of what is new.
    pub fn wakes(&self, wake: Wake) {
        // there is one window
        let _ = self.wake.set(wake);
    }

    /// What is being read, and how far, in words.
    pub fn doing(&self) -> Option<&str> {
        self.doing.as_deref()
    }

    /// What earlier windows have left.
    pub fn remembered(&self) -> &Remembered {
        &self.remembered
    }
}

/// What the program remembers of earlier windows; what cannot be read is told and left.
fn recall() -> Remembered {
    let file = memory::file_of_the_user();
    file.as_deref().map_or(Ok(Remembered::default()), memory::recall).unwrap_or_else(|fault| {
        note!("note: {fault}");
        Remembered::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::Command;
    use crate::model::{PaneId, Region, Theme, View};
    use technique::{Adapters, DeviceChoice};

    fn opened_with(words: &[&str]) -> Model {
        let Ok(Command::View(args)) = Command::parse(words.iter().map(Into::into)) else { panic!("{words:?}") };
        let asked = Asked::Open { name: args.scene.clone(), recent: Vec::new() };
        let Ok(Loaded::Scene(opened)) = load::read(&asked, &Progress::untold()) else { panic!("{}", args.scene) };
        Beginning { opened: *opened, remembered: Remembered::default() }
            .model(&args)
            .unwrap()
            .beside(Adapters::default(), args.device)
    }

    #[test]
    fn what_is_read_beside_is_waited_for_no_longer_than_it_may_take_and_tells_how_far_it_is() {
        let folder = visavis_tests::TestFolder::new();
        let large = folder.file("large.toml");
        let statue = "[camera]\neye = [0, 1, 5]\ntarget = [0, 1, 0]\nfov_y = 45\n[material.a]\n\
                      diffuse = { albedo = [1, 1, 1] }\n[[statue]]\nlevel = 11\nmaterial = \"a\"\n";
        std::fs::write(&large, statue).unwrap();
        let minute = Duration::from_secs(60);
        let read = |scene: &str| Reading::begin(scene).within(minute).expect("it is small");
        assert_eq!(read("cornell").expect("a scene").opened.source, "cornell");
        let fault = read("gone.toml").map(|_| ()).expect_err("there is none").to_string();
        assert!(fault.contains("gone.toml"), "{fault}");
        let mut reading = Reading::begin(large.to_str().unwrap());
        assert!(reading.within(Duration::ZERO).is_none() && reading.doing().is_none());
        let (tell, told) = channel();
        reading.wakes(Arc::new(move || _ = tell.send(())));
        told.recv_timeout(minute).expect("the window is woken");
        assert!(reading.read().is_none());
        assert!(reading.doing().is_some_and(|doing| doing.starts_with("making a statue of level 11: ")));
    }

    #[test]
    fn a_session_is_opened_as_it_was_and_what_else_is_said_changes_it() {
        let folder = visavis_tests::TestFolder::new();
        let file = folder.file("lecture.toml");
        let text = "session = 1\nscene = \"cornell\"\n[camera]\nfov = 30\n[view]\nshow = \"side\"\nexposure = 2\n\
                    [panes.A]\nsegments = 9\n[panes.B]\ndevice = \"cpu\"\nspp = 3\n[comparison]\nregion = [0.25, 0.5, 0.75, 1]\n[window]\ntheme = \"light\"\npanel = false\n";
        std::fs::write(&file, text).unwrap();
        let file = file.to_str().unwrap();
        let [a, b] = [PaneId::A, PaneId::B];
        let model = opened_with(&[file]);
        assert_eq!((model.document.camera.fov_y, model.session.view), (30.0, View::SideBySide));
        assert_eq!((model.session.panes[a].fake.knobs.segments, model.session.panes[b].truth.spp), (Some(9), 3));
        assert_eq!((model.state.theme, model.state.panel), (Theme::Light, false));
        assert_eq!(model.session.panes[b].device, DeviceChoice::Cpu);
        assert_eq!(model.session.comparison.region, Region::between([0.25, 0.5], [0.75, 1.0]));
        assert!(!model.can_undo_and_redo()[0], "there is nothing behind it");
        let words = [file, "--b", "path,spp=5", "--fov", "50", "--theme", "dark", "--view", "map", "--device", "gpu"];
        let model = opened_with(&words);
        assert_eq!((model.document.camera.fov_y, model.session.view), (50.0, View::ErrorMap));
        assert_eq!((model.session.panes[a].fake.knobs.segments, model.session.panes[b].truth.spp), (Some(9), 5));
        assert_eq!((model.state.theme, model.session.display.exposure), (Theme::Dark, 2.0));
        assert_eq!(model.session.panes[b].device, DeviceChoice::Gpu);
    }

    #[test]
    fn a_slide_is_shown_with_its_scene_and_what_else_is_said_changes_it() {
        let paths = |model: &Model| {
            [PaneId::A, PaneId::B]
                .map(|id| (model.session.panes[id].truth.path.bounces, model.session.panes[id].truth.spp))
        };
        let slide = opened_with(&["--slide", "2e-0-1"]);
        assert_eq!((slide.document.source.as_str(), paths(&slide)), ("cornell", [(Some(0), 20), (Some(1), 20)]));
        assert_eq!(opened_with(&["--slide", "phong"]).session.view, View::SideBySide);
        let changed = opened_with(&["--b", "2e-2-bounces,spp=64", "--slide", "2e-0-1", "--view", "map"]);
        assert_eq!((changed.session.view, paths(&changed)), (View::ALL[4], [(Some(0), 20), (Some(2), 64)]));
    }
}
