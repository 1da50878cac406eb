//! The camera of a changed scene: what it does not say is its base's.

use crate::file::number::{AboveZero, Any, Number, Triple};
use crate::file::{Fault, fault};
use crate::{Camera, Vec3};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;

/// `[camera]` of a changed scene.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RawCameraChange {
    eye: Option<Spanned<Triple<Any>>>,
    target: Option<Spanned<Triple<Any>>>,
    up: Option<Spanned<Triple<Any>>>,
    fov_y: Option<Spanned<Number<AboveZero>>>,
}

/// Another place to see a scene from; what is `None` is the scene's own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraChange {
    /// Position of the pinhole.
    pub eye: Option<Vec3>,
    /// A point in the middle of the picture.
    pub target: Option<Vec3>,
    /// The direction that is up in the picture, of any length but 0.
    pub up: Option<Vec3>,
    /// Vertical field of view in degrees, in (0, 180).
    pub fov_y: Option<f32>,
}

impl CameraChange {
    /// What of `now` is not the scene's own; `None` if all is.
    pub fn between(own: &Camera, now: &Camera) -> Option<Self> {
        let change = CameraChange {
            eye: (now.eye != own.eye).then_some(now.eye),
            target: (now.target != own.target).then_some(now.target),
            up: (now.up != own.up).then_some(now.up),
            fov_y: (now.fov_y != own.fov_y).then_some(now.fov_y),
        };
        (change != CameraChange::default()).then_some(change)
    }

    /// The camera that comes of the scene's own.
    pub fn of(&self, own: &Camera) -> Camera {
        let up = self.up.map(|up| up.as_dvec3().normalize_or_zero().as_vec3());
        Camera {
            eye: self.eye.unwrap_or(own.eye),
            target: self.target.unwrap_or(own.target),
            up: up.unwrap_or(own.up),
            fov_y: self.fov_y.unwrap_or(own.fov_y),
            ..*own
        }
    }

    /// This change of the camera that `before` makes.
    pub fn over(&self, before: &CameraChange) -> CameraChange {
        CameraChange {
            eye: self.eye.or(before.eye),
            target: self.target.or(before.target),
            up: self.up.or(before.up),
            fov_y: self.fov_y.or(before.fov_y),
        }
    }
}

impl From<&RawCameraChange> for CameraChange {
    fn from(raw: &RawCameraChange) -> Self {
        let vector =
            |triple: &Option<Spanned<Triple<Any>>>| triple.as_ref().map(|triple| Vec3::from(*triple.get_ref()));
        CameraChange {
            eye: vector(&raw.eye),
            target: vector(&raw.target),
            up: vector(&raw.up),
            fov_y: raw.fov_y.as_ref().map(|number| number.get_ref().get()),
        }
    }
}

/// The camera that a file states, if it sees something.
pub fn changed(raw: Spanned<RawCameraChange>, own: &Camera) -> Result<Camera, Fault> {
    let (header, raw) = (raw.span(), raw.into_inner());
    let camera = CameraChange::from(&raw).of(own);
    let Some((value, why)) = camera.faulty_value() else { return Ok(camera) };
    let RawCameraChange { eye, target, up, fov_y } = &raw;
    let [eye, target, up] = [eye, target, up].map(|triple| triple.as_ref().map(Spanned::span));
    let stated: Option<Range<usize>> = match value {
        "eye" => eye,
        "target" => target.or(eye),
        "up" => up.or(target).or(eye),
        _ => fov_y.as_ref().map(Spanned::span),
    };
    fault(stated.unwrap_or(header), format!("the camera sees nothing: {why}"))
}
