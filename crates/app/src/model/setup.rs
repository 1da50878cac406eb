//! What a scene is opened with beside itself: by options of the window, or by what a picture says of how it was made.

use super::{CompareWith, Line, Model, PaneId, PaneSource, Panes, Region, View};
use compare::ErrorMetric;
use scene::{Camera, Vec3};
use technique::{PaneSetup, SceneChanges};

/// What is not as it would be by itself; `None` leaves it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Setup {
    /// How pictures are made.
    pub panes: Panes<PaneSetup>,
    /// Where pictures come from that another program makes.
    pub sources: Panes<PaneSource>,
    /// What is changed in the scene.
    pub changes: SceneChanges,
    /// Which of the file's cameras it is, by name.
    pub camera: Option<String>,
    /// Where the camera stands.
    pub eye: Option<Vec3>,
    /// What it looks at.
    pub target: Option<Vec3>,
    /// Which direction is up in the picture.
    pub up: Option<Vec3>,
    /// Its vertical angle of view in degrees.
    pub fov: Option<f32>,
    /// What is shown of the pictures.
    pub view: Option<View>,
    /// How the wipe's line stands, and where.
    pub line: Option<(Line, f32)>,
    /// What they are compared with.
    pub with: Option<CompareWith>,
    /// The map of errors.
    pub map: Option<MapSetup>,
    /// The part of the pictures that figures speak of.
    pub region: Option<Region>,
    /// Stops added before display.
    pub exposure: Option<f32>,
}

/// Which errors are mapped, and how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapSetup {
    /// The pane whose errors are mapped.
    pub of: PaneId,
    /// How they are measured.
    pub metric: ErrorMetric,
    /// Where the scale ends; `None` to fit it.
    pub held: Option<f32>,
}

impl Model {
    /// Takes all that is set up. Undo does not go behind it.
    ///
    /// # Errors
    /// If its camera sees nothing, where the scene's own stays, or if the scene lacks what is changed in it, which is left. The
    /// rest is taken.
    pub fn set_up(&mut self, setup: &Setup) -> Result<(), String> {
        self.document.changes = setup.changes.clone();
        let changes = self.document.apply_what_fits().map_err(|why| why.to_string());
        for (id, pane) in setup.panes.iter() {
            pane.apply(&mut self.session.panes[id], self.document.seen());
            self.session.set_source(id, PaneSource::Made);
        }
        let session = &mut self.session;
        for (id, source) in setup.sources.iter() {
            session.set_source(id, source.clone());
            self.state.picture_files.remove(id);
        }
        session.view = setup.view.unwrap_or(match (session.view, setup.asked_for().min()) {
            // what was set up is seen
            (View::Pane(_), Some(first)) => View::Pane(first),
            (view, _) => view,
        });
        if let Some(line) = setup.line {
            (session.line, session.wipe) = line;
            self.state.line_placed = Some(self.document.opened);
        }
        session.comparison.with = setup.with.unwrap_or(session.comparison.with);
        session.comparison.region = setup.region;
        if let Some(MapSetup { of, metric, held }) = setup.map {
            (session.comparison.of, session.comparison.metric) = (of, metric);
            session.comparison.held[metric as usize] = held;
        }
        session.display.exposure = setup.exposure.unwrap_or(session.display.exposure);
        let camera = self.look(setup);
        self.begin_history();
        changes.and(camera)
    }

    /// Stands where this camera does, of which a picture shows all as it is seen now. Undo does not go behind it.
    pub fn look_through(&mut self, shown: &Camera) {
        self.document.camera = self.state.picture.own(shown);
        self.begin_history();
    }

    fn look(&mut self, Setup { camera, eye, target, up, fov, .. }: &Setup) -> Result<(), String> {
        let scene = &self.document.scene;
        let own = camera.as_ref().map_or(Ok(scene.camera), |name| scene.camera_named(name))?;
        let (eye, target, up) = (eye.unwrap_or(own.eye), target.unwrap_or(own.target), up.unwrap_or(own.up));
        let camera = Camera { eye, target, up, fov_y: fov.unwrap_or(own.fov_y), ..own };
        if let Some(fault) = camera.fault() {
            return Err(format!("this camera sees nothing: {fault}; change --eye, --target, --up or --fov"));
        }
        self.document.camera = camera;
        Ok(())
    }
}

impl Setup {
    /// Whether a picture that is shown alone leaves all in sight that is asked for.
    fn is_seen_in(&self, view: View) -> bool {
        let View::Pane(shown) = view else { return true };
        self.asked_for().all(|asked| asked == shown)
    }

    /// The panes of which it says something.
    fn asked_for(&self) -> impl Iterator<Item = PaneId> {
        self.panes.ids().chain(self.sources.ids())
    }

    /// The same with all that `other` says in its place.
    pub fn overridden_by(mut self, other: &Setup) -> Self {
        for (id, pane) in other.panes.iter() {
            self.panes.insert(id, pane.clone());
            self.sources.remove(id);
        }
        for (id, source) in other.sources.iter() {
            self.sources.insert(id, source.clone());
        }
        // another camera stands elsewhere
        let stays = other.camera.is_none();
        Setup {
            panes: self.panes,
            sources: self.sources,
            changes: other.changes.over(&self.changes),
            eye: other.eye.or(self.eye.filter(|_| stays)),
            target: other.target.or(self.target.filter(|_| stays)),
            up: other.up.or(self.up.filter(|_| stays)),
            fov: other.fov.or(self.fov.filter(|_| stays)),
            camera: other.camera.clone().or(self.camera),
            view: other.view.or(self.view.filter(|view| other.is_seen_in(*view))),
            line: other.line.or(self.line),
            with: other.with.or(self.with),
            map: other.map.or(self.map),
            region: other.region.or(self.region),
            exposure: other.exposure.or(self.exposure),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use technique::TechniqueName;

    #[test]
    fn a_pane_that_is_asked_for_beside_a_picture_is_seen_beside_it() {
        let pane = |id| {
            let mut setup = Setup::default();
            setup.panes.insert(id, PaneSetup::of(TechniqueName::Path));
            setup
        };
        let picture = Setup { view: Some(View::Pane(PaneId::A)), ..pane(PaneId::A) };
        let view = |other: &Setup| picture.clone().overridden_by(other).view;
        assert_eq!(view(&Setup::default()), Some(View::Pane(PaneId::A)));
        assert_eq!(view(&pane(PaneId::A)), Some(View::Pane(PaneId::A)));
        assert_eq!(view(&pane(PaneId::B)), None);
        let side = Setup { view: Some(View::SideBySide), ..pane(PaneId::B) };
        assert_eq!(view(&side), Some(View::SideBySide));
    }

    #[test]
    fn a_camera_that_is_asked_for_by_name_stands_where_it_does_and_not_where_a_picture_was_seen_from() {
        let picture = Setup { eye: Some(Vec3::X), up: Some(Vec3::Z), fov: Some(20.0), ..Setup::default() };
        let named = Setup { camera: Some("front".into()), fov: Some(30.0), ..Setup::default() };
        assert_eq!(picture.clone().overridden_by(&named), named);
        assert_eq!(picture.clone().overridden_by(&Setup::default()), picture);
    }
}
