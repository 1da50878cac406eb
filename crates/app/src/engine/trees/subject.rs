//! The statue that rays are counted on, and where it is seen from.

use scene::{Camera, Mesh, Progress, Vec3};
use std::sync::Arc;

/// The statue of a level; `None` if `goes_on` says no before it is made.
pub fn statue(level: u32, goes_on: &(dyn Fn() -> bool + Sync)) -> Option<Arc<Mesh>> {
    let hear = |_: &str, _: f32| goes_on();
    scene::statue(level, &Progress::new(&hear)).ok().map(Arc::new)
}

/// Degrees of the vertical field of view.
const FIELD_OF_VIEW: f32 = 30.0;

/// From the front, a little from the side and from above, so that all of it is seen in a picture that is not higher than wide.
pub fn camera_for(mesh: &Mesh) -> Camera {
    let (lo, hi) = mesh.bounds();
    let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo).length());
    let away = 1.02 * half / (0.5 * FIELD_OF_VIEW).to_radians().sin();
    let eye = middle + Vec3::new(0.45, 0.18, 1.0).normalize() * away;
    Camera { eye, target: middle, up: Vec3::Y, fov_y: FIELD_OF_VIEW, near: None, far: None }
}
