//! The scenes of the hard cases that a scene file can say: those of [`builtin::hard_names`]. A case moves the
//! camera and turns numbers from there.

use scene::glam::Vec3;
use scene::{Camera, Geometry, Scene, builtin};

/// The scene of this name.
#[expect(clippy::expect_used, reason = "the files are embedded, and a test loads each of them")]
pub(crate) fn known(name: &str) -> Scene {
    builtin::named(&format!("hard/{name}")).expect("an embedded scene")
}

/// A camera that sees nothing but a spot of `target`, from `eye`.
pub(crate) fn spot(eye: Vec3, target: Vec3) -> Camera {
    let along = (target - eye).normalize_or_zero();
    let up = if along.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
    Camera { eye, target, up, fov_y: 1e-7, near: None, far: None }
}

/// The scene with another list of shapes.
pub(crate) fn with_geometry(mut scene: Scene, change: impl Fn(usize, &mut Geometry)) -> Scene {
    let mut shapes = scene.shapes.to_vec();
    for (index, shape) in shapes.iter_mut().enumerate() {
        change(index, &mut shape.geometry);
    }
    scene.shapes = shapes.into();
    scene
}
