//! What is seen: a scene with what was changed in it, from where, at which size. All that a picture depends on beside
//! the technique and the device.

use scene::edit::{CannotEdit, Edits};
use scene::{Camera, Scene, Vec3};
use std::sync::Arc;

/// A scene from one camera at one size: all that the truth of a picture depends on.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// The scene as the user asked for it: a built-in name or a file.
    pub source: String,
    /// What was changed in it.
    pub changes: SceneChanges,
    /// The scene with those changes.
    pub scene: Arc<Scene>,
    /// Seen from here rather than from the scene's own camera.
    pub camera: Camera,
    /// Which way is up in the scene's own camera as it was opened: what records need not say.
    pub own_up: Vec3,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// What sliders and options change in a scene for all techniques at once; `None` leaves it as the scene has it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneChanges {
    /// Index of refraction outside over inside of all glass, above 0.
    pub refraction_ratio: Option<f32>,
    /// Angular radius of the sun in degrees, from 0 to below 90.
    pub sun_radius: Option<f32>,
    /// What is changed part by part. An index of refraction that is said here holds over that of all glass above, and the
    /// radius of the sun above over one that is said here.
    pub edits: Edits,
}

impl Shot {
    /// A scene as it is, from its own camera.
    pub fn of(scene: Scene, size: (u32, u32)) -> Self {
        let (source, camera) = (scene.name.clone(), scene.camera);
        Shot { source, changes: SceneChanges::default(), scene: Arc::new(scene), camera, own_up: camera.up, size }
    }

    /// Whether both show the same pixels of one and the same scene, so that pictures of them can be compared.
    pub fn is_of_the_same_view(&self, other: &Shot) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene) && (self.camera, self.size) == (other.camera, other.size)
    }
}

impl SceneChanges {
    /// The scene with these changes; its meshes stay shared.
    ///
    /// # Errors
    /// Those of [`Edits::applied_to`].
    pub fn applied_to(&self, scene: &Scene) -> Result<Scene, CannotEdit> {
        let mut scene = self.edits.applied_to(scene)?;
        if let Some(ratio) = self.refraction_ratio {
            let holds_for = self.glass_without_its_own(&scene);
            let mut of_all = scene.clone();
            of_all.set_refraction_ratio(ratio);
            holds_for.into_iter().for_each(|index| scene.materials[index] = of_all.materials[index].clone());
        }
        if let (Some(radius), Some(sun)) = (self.sun_radius, &mut scene.sun) {
            sun.angular_radius = radius;
        }
        Ok(scene)
    }
}
