//! Near and far planes of a perspective view. Its depth is reversed, 1 at the near plane and 0 at the far one or at
//! infinity: `f32` is as fine about 0 as perspective is coarse about what is far, so that depths differ where distances
//! do, by a part in ten million, however near the near plane is (Reed, "Depth precision visualized", 2015).

use crate::clearance::clearance;
use scene::glam::{Mat4, Vec4};
use scene::{Camera, Scene, Vec3};

/// A fitted near plane, as a share of the distance along the line of sight at which something may be. No less than is
/// needed: `f32` knows a triangle's plane to a part in ten million of its size, and of a plane that goes through the eye
/// but for that part there is the less to see, the farther away it is cut.
const MARGIN: f32 = 0.5;

/// A fitted near plane where every plane goes through the eye, as a share of the distance to the farthest thing.
const OF_REACH: f32 = 1e-3;

/// Distances along the line of sight between which a view draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planes {
    /// Distance of the near plane, above 0.
    pub near: f32,
    /// Above `near`; may be infinite.
    pub far: f32,
}

impl Planes {
    /// Planes that cut nothing of `scene`, seen from `eye` in any direction, but what `clearance` leaves out; `corner`
    /// is the tangent of the angle from the line of sight to the picture's corners.
    pub fn fitted(scene: &Scene, eye: Vec3, corner: f32) -> Planes {
        let clearance = clearance(scene, eye);
        let near =
            if clearance.is_finite() { MARGIN * clearance / corner.hypot(1.0) } else { OF_REACH * reach(scene, eye) };
        Planes { near: near.max(f32::MIN_POSITIVE), far: f32::INFINITY }
    }

    /// The planes of a camera's picture of `aspect` = width / height: where it states none, they are fitted.
    pub fn of(scene: &Scene, camera: &Camera, aspect: f32) -> Planes {
        let frame = camera.frame(aspect);
        let fitted = Planes::fitted(scene, camera.eye, (frame.right + frame.up).length());
        let far = camera.far.unwrap_or(fitted.far);
        Planes { near: camera.near.unwrap_or(fitted.near.min(MARGIN * far)), far }
    }

    /// `clip_from_world` of a perspective view with its depth between these planes: `a w + b`, where `w` is the distance
    /// along the line of sight.
    pub fn applied_to(self, clip_from_world: Mat4) -> Mat4 {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        let (a, b) = if self.far.is_finite() { (-near / (far - near), near / (1.0 - near / far)) } else { (0.0, near) };
        let depth = clip_from_world.row(3) * a as f32 + Vec4::W * b as f32;
        let rows = clip_from_world.transpose();
        Mat4 { z_axis: depth, ..rows }.transpose()
    }
}

/// The distance from `eye` to the farthest corner of the scene's bounds.
fn reach(scene: &Scene, eye: Vec3) -> f32 {
    let (low, high) = scene.bounds();
    (low - eye).abs().max((high - eye).abs()).length()
}
