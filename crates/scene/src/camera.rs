//! A pinhole camera: eye, target and vertical field of view. Raster and rays see the same picture through it.
//!
//! Twin: `shaders/pathtrace/camera.wgsl`.

use crate::direction::unit;
use glam::{Mat4, Vec2, Vec3, camera::rh};

/// A pinhole camera in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the pinhole.
    pub eye: Vec3,
    /// A point in the middle of the picture.
    pub target: Vec3,
    /// The direction that is up in the picture; not parallel to the line of sight.
    pub up: Vec3,
    /// Vertical field of view in degrees, in (0, 180).
    pub fov_y: f32,
    /// Nearest distance that the raster draws, along the line of sight; `None` lets it draw all that there is. Rays
    /// ignore it.
    pub near: Option<f32>,
    /// Farthest distance that the raster draws, likewise.
    pub far: Option<f32>,
}

/// A camera that a file names.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedCamera {
    /// What it is chosen by.
    pub name: String,
    /// Where it stands and looks.
    pub camera: Camera,
}

/// A camera's orthonormal axes scaled so that `forward + x * right + y * up` passes through the point (x, y) of the
/// picture, x and y in [-1, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureFrame {
    /// The pinhole.
    pub eye: Vec3,
    /// Unit line of sight.
    pub forward: Vec3,
    /// From the middle of the picture to its right edge at distance 1.
    pub right: Vec3,
    /// From the middle of the picture to its top edge at distance 1.
    pub up: Vec3,
}

impl Camera {
    /// Fields of view, in degrees, that zooming stays in.
    pub const FIELD_OF_VIEW: std::ops::RangeInclusive<f32> = 1.0..=170.0;

    /// The frame of a picture of `aspect` = width / height.
    pub fn frame(&self, aspect: f32) -> PictureFrame {
        let forward = unit(self.target - self.eye).unwrap_or(Vec3::NEG_Z);
        let right = forward.cross(self.up).normalize();
        let up = right.cross(forward);
        let half_height = (self.fov_y.to_radians() * 0.5).tan();
        PictureFrame { eye: self.eye, forward, right: right * (half_height * aspect), up: up * half_height }
    }

    /// The matrix that takes world space to clip space. Depth is the reciprocal of the distance along the line of sight;
    /// near and far planes are up to the raster.
    pub fn clip_from_world(&self, aspect: f32) -> Mat4 {
        let view_from_world = rh::view::look_to_mat4(self.eye, self.frame(1.0).forward, self.up);
        rh::proj::directx::perspective_infinite_reverse(self.fov_y.to_radians(), aspect, 1.0) * view_from_world
    }

    /// Why this camera sees nothing, if it does not: a line for the user.
    pub fn fault(&self) -> Option<&'static str> {
        self.faulty_value().map(|(_, why)| why)
    }

    /// The value by which this camera sees nothing, by its name in a scene's file, and why.
    pub fn faulty_value(&self) -> Option<(&'static str, &'static str)> {
        // in f64, where squares of large f32 still fit
        let (sight, up) = (self.target.as_dvec3() - self.eye.as_dvec3(), self.up.as_dvec3());
        let size = self.eye.as_dvec3().length().max(self.target.as_dvec3().length());
        if !(self.eye.is_finite() && self.target.is_finite() && self.up.is_finite()) {
            Some(("eye", "its eye, target and up must be finite"))
        } else if size > 1e12 {
            Some(("eye", "its eye and target must lie within 1e12 of the origin"))
        } else if sight.length() <= 1e-6 * size {
            Some(("target", "its eye and target must differ"))
        } else if sight.normalize_or_zero().cross(up.normalize_or_zero()).length() < 1e-4 {
            Some((
                "up",
                "its up must not be parallel to the line from eye to target: to look straight down or up, \
                 up = [0, 0, -1] will do",
            ))
        } else if !(self.fov_y > 0.0 && self.fov_y < 180.0) {
            Some(("fov_y", "its field of view must lie between 0 and 180 degrees"))
        } else if !(self.near.is_none_or(|near| near > 0.0)
            && self.far.is_none_or(|far| far > self.near.unwrap_or(0.0)))
        {
            Some(("near", "its near must be positive and below its far"))
        } else {
            None
        }
    }

    /// The camera turned about its target by `yaw` and `pitch` radians, stopping short of the poles.
    pub fn orbited(&self, yaw: f32, pitch: f32) -> Self {
        let arm = self.eye - self.target;
        let up = self.up.normalize();
        let back = unit(arm).unwrap_or(Vec3::Z);
        let height = up.dot(back).clamp(-1.0, 1.0).asin();
        let limit = 89f32.to_radians();
        let pitch = (height + pitch).clamp(-limit, limit) - height;
        let side = back.cross(up).normalize();
        let turn = glam::Quat::from_axis_angle(up, yaw) * glam::Quat::from_axis_angle(side, pitch);
        Camera { eye: self.target + turn * arm, ..*self }
    }

    /// The camera moved sideways so that what lies at the target follows a drag by `shift`, in picture heights.
    pub fn panned(&self, shift: Vec2) -> Self {
        let frame = self.frame(1.0);
        let distance = (self.target - self.eye).length();
        let by = (frame.right * -shift.x + frame.up * shift.y) * (2.0 * distance);
        Camera { eye: self.eye + by, target: self.target + by, ..*self }
    }

    /// The camera with a longer lens: what is seen grows by `factor` (> 0), the eye stays.
    pub fn zoomed(&self, factor: f32) -> Self {
        let half = (0.5 * self.fov_y.to_radians()).tan() / factor;
        let fov_y = (2.0 * half.atan().to_degrees()).clamp(*Self::FIELD_OF_VIEW.start(), *Self::FIELD_OF_VIEW.end());
        Camera { fov_y, ..*self }
    }

    /// The camera moved towards its target: the distance is divided by `factor` (> 0).
    pub fn dollied(&self, factor: f32) -> Self {
        Camera { eye: self.target + (self.eye - self.target) / factor, ..*self }
    }
}

impl PictureFrame {
    /// Unit direction of the ray through `point`, in [0, 1]^2 from the picture's top left corner.
    pub fn direction(&self, point: Vec2) -> Vec3 {
        let (x, y) = (2.0 * point.x - 1.0, 1.0 - 2.0 * point.y);
        (self.forward + self.right * x + self.up * y).normalize()
    }

    /// Where a point of the scene lies in the picture, in [0, 1]^2 from the top left corner, or beyond: the inverse of
    /// [`PictureFrame::direction`]. `None` for what is not before the pinhole.
    pub fn project(&self, point: Vec3) -> Option<Vec2> {
        let arm = point - self.eye;
        let along = |axis: Vec3| arm.dot(axis) / axis.length_squared();
        let distance = arm.dot(self.forward);
        let seen = Vec2::new(along(self.right), -along(self.up)) / distance;
        (distance > 0.0 && seen.is_finite()).then_some(0.5 + 0.5 * seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: Camera = Camera {
        eye: Vec3::new(1.0, 2.0, 3.0),
        target: Vec3::new(0.0, 1.0, 0.0),
        up: Vec3::Y,
        fov_y: 50.0,
        near: None,
        far: None,
    };

    #[test]
    fn ray_and_raster_agree_on_where_a_point_lands() {
        let frame = CAMERA.frame(1.5);
        for point in [Vec2::new(0.1, 0.2), Vec2::new(0.5, 0.5), Vec2::new(0.93, 0.41)] {
            let seen = frame.eye + frame.direction(point) * 7.0;
            let clip = CAMERA.clip_from_world(1.5).project_point3(seen);
            let landed = Vec2::new(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
            assert!((landed - point).length() < 1e-5, "{point} landed at {landed}");
            let projected = frame.project(seen).expect("it lies before the camera");
            assert!((projected - point).length() < 1e-5, "{point} is projected to {projected}");
        }
        assert_eq!(frame.project(frame.eye - frame.forward), None);
        assert_eq!(frame.project(frame.eye), None);
    }

    #[test]
    fn zooming_magnifies_by_its_factor_within_its_range() {
        let half_height = |camera: &Camera| camera.frame(1.0).up.length();
        let zoomed = CAMERA.zoomed(2.0);
        assert!((half_height(&CAMERA) / half_height(&zoomed) - 2.0).abs() < 1e-5);
        assert_eq!((CAMERA.zoomed(1e9).fov_y, CAMERA.zoomed(1e-9).fov_y), (1.0, 170.0));
    }

    #[test]
    fn orbit_keeps_the_distance_and_stops_at_the_pole() {
        let start = (CAMERA.eye - CAMERA.target).length();
        let turned = CAMERA.orbited(1.0, 10.0);
        assert!(((turned.eye - turned.target).length() - start).abs() < 1e-5);
        assert_eq!(turned.fault(), None);
    }
}
