//! A picture to compare with: taken once it is known that it can be read and has the size of what is seen.

use super::Viewer;
use crate::engine::load::{Opened, ReferenceFile};
use crate::engine::reference::misfit;
use crate::model::{CompareWith, Model, in_few};
use image_file::shown;
use scene::Camera;
use std::path::PathBuf;

/// A picture that was read.
#[derive(Debug)]
pub struct Judge {
    reference: ReferenceFile,
    /// The camera that it was made from, where that was opened with it.
    camera: Option<Camera>,
    /// What there is to say of its scene.
    notes: Vec<String>,
}

impl Judge {
    /// Of what is seen already.
    pub fn alone(reference: ReferenceFile) -> Self {
        Judge { reference, camera: None, notes: Vec::new() }
    }

    /// Of the scene that was just opened with it.
    pub fn of_its_scene(reference: ReferenceFile, model: &Model, notes: Vec<String>) -> Self {
        Judge { reference, camera: Some(model.document.camera), notes }
    }
}

impl Viewer {
    /// Whether a reference is opened of what is seen: nothing is to be set up for it.
    pub(super) fn is_seen(&self, opened: &Opened) -> bool {
        let (Some(_), Some(setup)) = (&opened.reference, &opened.setup) else { return false };
        let document = &self.model.document;
        let Camera { eye, target, up, fov_y, .. } = document.shot(&self.model.state.picture).camera;
        document.scene.as_read == opened.scene.as_read
            && document.changes == setup.changes
            && (setup.eye, setup.target) == (Some(eye), Some(target))
            && setup.up.unwrap_or(document.scene.camera.up) == up
            // a part of a window widens the angle, which is rounded on the way
            && setup.fov.is_some_and(|fov| (fov - fov_y).abs() < 1e-3)
    }

    /// Compares with the picture that waits, if it fits; else says why not, and all stays as it is. Returns its file.
    pub(super) fn take_judge(&mut self) -> Option<PathBuf> {
        let Judge { reference, camera, notes } = self.judge.take()?;
        let ReferenceFile { file, size, .. } = reference;
        let shot = self.model.document.shot(&self.model.state.picture);
        if let Some(line) = misfit(&file, size, &shot) {
            let lines = [vec![line], notes].concat();
            let (text, left) = in_few(&lines);
            self.model.say(Err(text));
            left.iter().for_each(|line| note!("note: {line}"));
            return None;
        }
        camera.iter().for_each(|camera| self.model.look_through(camera));
        self.model.session.comparison.with = CompareWith::Reference;
        self.model.state.reference_file = file.display().to_string();
        let said = format!("A and B are compared with {}", shown(&file));
        if notes.is_empty() {
            self.model.say(Ok(said));
        } else {
            self.tell(&[vec![said], notes].concat());
        }
        Some(file)
    }
}
