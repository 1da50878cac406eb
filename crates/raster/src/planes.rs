//! Near and far planes of a perspective view. Its depth is reversed, 1 at the near plane and 0 at the far one or at
//! infinity: `f32` is as fine about 0 as perspective is coarse about what is far, so that depths differ where distances
//! do, by a part in ten million, however near the near plane is (Reed, "Depth precision visualized", 2015).

use scene::glam::{Mat4, Vec4};
use scene::{Camera, Scene, Vec3};

/// Fitted near planes, as a share of the distance to the farthest thing. The least that clipping stands: there `f32`
/// knows a corner of a triangle to a part in ten million of the triangle's size.
const NEAREST: f32 = 1e-10;

/// Distances along the line of sight between which a view draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Planes {
    /// Above 0.
    pub near: f32,
    /// Above `near`; may be infinite.
    pub far: f32,
}

impl Planes {
    /// Planes that cut nothing of `scene`, seen from `eye` in any direction.
    pub fn fitted(scene: &Scene, eye: Vec3) -> Planes {
        Planes { near: (NEAREST * reach(scene, eye)).max(f32::MIN_POSITIVE), far: f32::INFINITY }
    }

    /// The planes of a camera: where it states none, they are fitted.
    pub fn of(scene: &Scene, camera: &Camera) -> Planes {
        let fitted = Planes::fitted(scene, camera.eye);
        let far = camera.far.unwrap_or(fitted.far);
        Planes { near: camera.near.unwrap_or(fitted.near.min(NEAREST * far)), far }
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
