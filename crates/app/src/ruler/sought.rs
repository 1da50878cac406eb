//! The reference that a picture asks for: what it shows, by which name it is kept, and what its file says about itself.

use crate::technique::{SceneChanges, point, quoted};
use image_file::Records;
use reference::{Key, Maker, Subject};
use scene::{Camera, Scene};
use std::sync::Arc;

/// Everything that a reference depends on.
#[derive(Debug, Clone)]
pub struct Sought {
    /// The scene as the user asked for it: a built-in name or a file.
    pub source: String,
    /// What was changed in it.
    pub changes: SceneChanges,
    /// The scene with those changes.
    pub scene: Arc<Scene>,
    /// From where.
    pub camera: Camera,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

impl Sought {
    /// What it shows.
    pub fn subject(&self) -> Subject<'_> {
        Subject { scene: &self.scene, camera: &self.camera, size: self.size }
    }

    /// What it is kept by. Takes as long as it takes to read the whole scene.
    pub fn key(&self) -> Key {
        Key::of(&self.subject())
    }

    /// What its file says about it, beside what [`reference::Reference::encode`] adds.
    pub fn records(&self) -> Records {
        let mut records = vec![
            ("version", env!("CARGO_PKG_VERSION").into()),
            ("scene", self.source.clone()),
            ("size", format!("{}x{}", self.size.0, self.size.1)),
            ("eye", point(self.camera.eye)),
            ("target", point(self.camera.target)),
            ("fov", self.camera.fov_y.to_string()),
            ("estimator", Maker::settings(0).estimator.name().into()),
        ];
        records.extend(self.changes.refraction_ratio.map(|ratio| ("refraction-ratio", ratio.to_string())));
        records.extend(self.changes.sun_radius.map(|radius| ("sun-radius", radius.to_string())));
        records.push(("command", self.command()));
        records
    }

    /// The line that makes it, for a shell of the POSIX kind.
    fn command(&self) -> String {
        let changed = [("refraction-ratio", self.changes.refraction_ratio), ("sun-radius", self.changes.sun_radius)];
        let changed = changed.iter().filter_map(|(name, value)| Some(format!(" --{name} {}", (*value)?)));
        format!(
            "visavis reference {} -o reference.exr --size {}x{} --eye {} --target {} --fov {}{}",
            quoted(&self.source),
            self.size.0,
            self.size.1,
            point(self.camera.eye),
            point(self.camera.target),
            self.camera.fov_y,
            changed.collect::<String>()
        )
    }
}
