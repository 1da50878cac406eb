//! What is looked at: a scene, what is changed in it, and from where.

use super::PictureArea;
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
            changes,
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
    pub fn reread(&mut self, scene: Scene) {
        let kept = Camera { up: scene.camera.up, near: scene.camera.near, far: scene.camera.far, ..self.camera };
        let moved = self.camera != self.scene.camera && kept.fault().is_none();
        self.camera = if moved { kept } else { scene.camera };
        self.scene = Arc::new(scene);
        self.changed = (SceneChanges::default(), self.scene.clone());
    }

    /// Makes the changes in the scene, where they are others than before.
    pub fn apply_changes(&mut self) {
        if self.changed.0 != self.changes {
            self.changed = (self.changes, Arc::new(self.changes.applied_to(&self.scene)));
        }
    }

    /// What a picture in this area shows, after [`Document::apply_changes`].
    pub fn shot(&self, area: &PictureArea) -> Shot {
        let (changes, scene) = self.changed.clone();
        Shot { source: self.source.clone(), changes, scene, camera: area.camera(&self.camera), size: area.size }
    }
}
