//! What is looked at: a scene, what is changed in it, and from where.

use super::PictureArea;
use scene::edit::CannotEdit;
use scene::{Camera, Scene};
use std::sync::Arc;
use technique::SceneChanges;
use technique::Shot;

/// The scene that is open.
#[derive(Debug, Clone)]
pub struct Document {
    /// As it was opened.
    pub scene: Arc<Scene>,
    /// What the user opened it by: a built-in name or a file.
    pub source: String,
    /// Counts the scenes opened.
    pub opened: u64,
    /// What is changed in it, for all panes.
    pub changes: SceneChanges,
    /// Where all panes look from.
    pub camera: Camera,
    /// Places to come back to.
    pub bookmarks: Vec<Camera>,
    /// The scene with changes, one and the same as long as they stay.
    changed: (SceneChanges, Arc<Scene>),
}

impl Document {
    /// The first view of a scene that was opened by the name `source`.
    pub fn new(scene: Scene, source: String) -> Self {
        let scene = Arc::new(scene);
        let changes = SceneChanges::default();
        Document {
            camera: scene.camera,
            source,
            opened: 0,
            changes: changes.clone(),
            bookmarks: Vec::new(),
            changed: (changes, scene.clone()),
            scene,
        }
    }

    /// Another scene, seen from its own camera.
    pub fn open(&mut self, scene: Scene, source: String) {
        *self = Document { opened: self.opened + 1, ..Document::new(scene, source) };
    }

    /// Another version of the scene that is open. A camera that was moved stays; one that was the scene's own follows it.
    /// Changes that fit it stay too; returns the others, each in a few words.
    pub fn reread(&mut self, scene: Scene) -> Vec<String> {
        let (own, new) = (self.scene.camera, scene.camera);
        let up = if self.camera.up == own.up { new.up } else { self.camera.up };
        let kept = Camera { up, near: new.near, far: new.far, ..self.camera };
        let moved = self.camera != own && kept.fault().is_none();
        self.camera = if moved { kept } else { new };
        self.scene = Arc::new(scene);
        self.changed = (SceneChanges::default(), self.scene.clone());
        let (edits, mut lost) = self.changes.edits.fitting(&self.scene);
        self.changes.edits = edits;
        lost.extend(self.apply_changes().err().map(|why| why.to_string()));
        lost
    }

    /// Makes the changes in the scene, without those of parts that it lacks.
    ///
    /// # Errors
    /// Why not all can be made: a line.
    pub fn apply_what_fits(&mut self) -> Result<(), CannotEdit> {
        let wished = self.changes.clone();
        let Err(why) = self.apply_changes() else { return Ok(()) };
        let (edits, _) = wished.edits.fitting(&self.scene);
        self.changes = SceneChanges { edits, ..wished };
        self.apply_changes().and(Err(why))
    }

    /// Makes the changes in the scene, where they are others than before. Those that cannot be made are taken back.
    ///
    /// # Errors
    /// Why they cannot: a line.
    pub fn apply_changes(&mut self) -> Result<(), CannotEdit> {
        if self.changed.0 == self.changes {
            return Ok(());
        }
        match self.changes.applied_to(&self.scene) {
            Ok(scene) => self.changed = (self.changes.clone(), Arc::new(scene)),
            Err(why) => {
                self.changes = self.changed.0.clone();
                return Err(why);
            }
        }
        Ok(())
    }

    /// The scene with its changes, as [`Document::apply_changes`] has made them last.
    pub fn seen(&self) -> &Arc<Scene> {
        &self.changed.1
    }

    /// What a picture in this area shows, after [`Document::apply_changes`].
    pub fn shot(&self, area: &PictureArea) -> Shot {
        let (changes, scene) = self.changed.clone();
        let (camera, own_up) = (area.camera(&self.camera), self.scene.camera.up);
        Shot { source: self.source.clone(), changes, scene, camera, own_up, size: area.size }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Vec3;

    #[test]
    fn a_rolled_camera_stays_rolled_when_its_scene_is_read_again_and_others_take_the_scenes_up() {
        let scene = scene::builtin::named("cornell").expect("a built-in scene");
        let mut document = Document::new(scene.clone(), "cornell".into());
        let reread = Scene { camera: Camera { up: Vec3::new(0.0, 0.8, 0.6), ..scene.camera }, ..scene.clone() };
        let seen_after = |document: &mut Document, camera: Camera| {
            document.reread(scene.clone());
            document.camera = camera;
            document.reread(reread.clone());
            document.camera
        };
        let rolled = Camera { up: Vec3::new(0.6, 0.8, 0.0), ..scene.camera };
        assert_eq!(seen_after(&mut document, rolled), rolled);
        let moved = Camera { fov_y: 20.0, ..scene.camera };
        assert_eq!(seen_after(&mut document, moved), Camera { up: reread.camera.up, ..moved });
    }
}
