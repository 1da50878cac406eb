//! The options that say what is seen: size, camera and what is changed in the scene. Pictures and references share
//! them.

use super::values::{number, point, size, text};
use crate::cli::CliError;
use scene::{Camera, Scene, Vec3, builtin};
use std::sync::Arc;
use technique::{SceneChanges, Shot};

/// What is seen of a scene; `None` leaves a value to the scene.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each field is the option of its name, described in --help")]
pub struct Seen {
    pub changes: SceneChanges,
    pub size: (u32, u32),
    pub eye: Option<Vec3>,
    pub target: Option<Vec3>,
    pub fov: Option<f32>,
}

impl Default for Seen {
    fn default() -> Self {
        Seen { changes: SceneChanges::default(), size: (1280, 720), eye: None, target: None, fov: None }
    }
}

impl Seen {
    /// Opens the scene of this name or file, changed and seen as the options say.
    ///
    /// # Errors
    /// If it cannot be read, or if the camera sees nothing.
    pub fn of(&self, source: &str) -> anyhow::Result<Shot> {
        let mut scene = self.changes.applied_to(&builtin::named(source)?);
        scene.camera = self.camera(&scene)?;
        let camera = scene.camera;
        Ok(Shot { source: source.to_owned(), changes: self.changes, scene: Arc::new(scene), camera, size: self.size })
    }

    /// The scene's camera with what the command line changes in it.
    fn camera(&self, scene: &Scene) -> anyhow::Result<Camera> {
        let camera = Camera {
            eye: self.eye.unwrap_or(scene.camera.eye),
            target: self.target.unwrap_or(scene.camera.target),
            fov_y: self.fov.unwrap_or(scene.camera.fov_y),
            ..scene.camera
        };
        match camera.fault() {
            Some(fault) => anyhow::bail!("this camera sees nothing: {fault}; change --eye, --target or --fov"),
            None => Ok(camera),
        }
    }
}

/// Reads one of these options; `false` if it is none.
pub fn parse_seen(option: &str, parser: &mut lexopt::Parser, seen: &mut Seen) -> Result<bool, CliError> {
    match option {
        "size" => seen.size = size(&text(parser)?)?,
        "eye" => seen.eye = Some(point(parser, "--eye")?),
        "target" => seen.target = Some(point(parser, "--target")?),
        "fov" => seen.fov = Some(number(parser, "--fov", "degrees between 0 and 180", |v| v > 0.0 && v < 180.0)?),
        "refraction-ratio" => {
            seen.changes.refraction_ratio =
                Some(number(parser, "--refraction-ratio", "a number from 0.001 to 1000", |v| {
                    (0.001..=1000.0).contains(&v)
                })?);
        }
        "sun-radius" => {
            let below_90 = |v| (0.0..90.0).contains(&v);
            seen.changes.sun_radius = Some(number(parser, "--sun-radius", "degrees from 0 to below 90", below_90)?);
        }
        _ => return Ok(false),
    }
    Ok(true)
}
