//! The options that say what is seen: size, camera and what is changed in the scene. Pictures and references share
//! them.

use super::options::CommandOption;
use super::usage;
use super::values::{number, point, shown, size, text};
use crate::engine::session::is_session_file;
use scene::edit::Edits;
use scene::{Camera, Scene, Vec3, builtin};
use std::path::Path;
use std::sync::Arc;
use technique::{SceneChanges, Shot};

/// What is seen of a scene; `None` leaves a value to the scene.
#[derive(Debug, Clone, PartialEq)]
#[expect(missing_docs, reason = "each field is the option of its name, described in --help")]
pub struct Seen {
    pub changes: SceneChanges,
    pub size: (u32, u32),
    pub camera: Option<String>,
    pub eye: Option<Vec3>,
    pub target: Option<Vec3>,
    pub up: Option<Vec3>,
    pub fov: Option<f32>,
}

impl Default for Seen {
    fn default() -> Self {
        let changes = SceneChanges::default();
        Seen { changes, size: (1280, 720), camera: None, eye: None, target: None, up: None, fov: None }
    }
}

impl Seen {
    /// Opens the scene of this name or file, changed and seen as the options say, and tells what of it is probably not
    /// meant.
    ///
    /// # Errors
    /// If it cannot be read, if it lacks what is to be changed in it, or if the camera sees nothing.
    pub fn of(&self, source: &str) -> anyhow::Result<Shot> {
        let mut scene = self.changes.applied_to(&scene_of(source)?)?;
        let own_up = scene.camera.up;
        scene.camera = self.camera(&scene)?;
        let idle = self.changes.edits.without_effect(&scene);
        scene.notes().iter().chain(&idle).for_each(|line| note!("note: {line}"));
        let (source, changes, camera, size) = (source.to_owned(), self.changes.clone(), scene.camera, self.size);
        Ok(Shot { source, changes, scene: Arc::new(scene), camera, own_up, size })
    }

    /// The scene's camera with what the command line changes in it.
    fn camera(&self, scene: &Scene) -> anyhow::Result<Camera> {
        let own = self.camera.as_ref().map_or(Ok(scene.camera), |name| scene.camera_named(name));
        let own = own.map_err(anyhow::Error::msg)?;
        let camera = Camera {
            eye: self.eye.unwrap_or(own.eye),
            target: self.target.unwrap_or(own.target),
            up: self.up.unwrap_or(own.up),
            fov_y: self.fov.unwrap_or(own.fov_y),
            ..own
        };
        match camera.fault() {
            Some(fault) => anyhow::bail!("this camera sees nothing: {fault}; change --eye, --target, --up or --fov"),
            None => Ok(camera),
        }
    }
}

/// A scene, which a session is none of.
fn scene_of(source: &str) -> anyhow::Result<Scene> {
    let scene = builtin::named(source);
    if scene.is_err() && is_session_file(Path::new(source)) {
        anyhow::bail!(
            "this is a session, which the window opens; name the scene that stands in it: {}",
            image_file::shown(Path::new(source))
        );
    }
    Ok(scene?)
}

/// Options that are read into what is seen, for commands that have one.
pub fn options<A: AsMut<Seen>>() -> Vec<CommandOption<A>> {
    let mut options = of_the_camera();
    options.extend(of_parts());
    options.push(allow_outside());
    options
}

/// Of the picture's size and the camera.
fn of_the_camera<A: AsMut<Seen>>() -> Vec<CommandOption<A>> {
    vec![
        CommandOption {
            names: &["--size"],
            value: "WxH",
            help: "pixels (default 1280x720)",
            read: |args, parser| {
                args.as_mut().size = size(&text(parser)?)?;
                Ok(())
            },
        },
        CommandOption {
            names: &["--camera"],
            value: "NAME",
            help: "which of the cameras of a model is looked through (default the first); options behind it move it",
            read: |args, parser| {
                let seen = args.as_mut();
                seen.camera = Some(text(parser)?);
                // where a picture's camera stood that is made again
                (seen.eye, seen.target, seen.up, seen.fov) = (None, None, None, None);
                Ok(())
            },
        },
        CommandOption {
            names: &["--eye"],
            value: "X,Y,Z",
            help: "where the camera stands (default the scene's)",
            read: |args, parser| {
                args.as_mut().eye = Some(point(parser, "--eye")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--target"],
            value: "X,Y,Z",
            help: "what it looks at (default the scene's)",
            read: |args, parser| {
                args.as_mut().target = Some(point(parser, "--target")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--up"],
            value: "X,Y,Z",
            help: "which direction is up in the picture (default the scene's)",
            read: |args, parser| {
                args.as_mut().up = Some(point(parser, "--up")?);
                Ok(())
            },
        },
        CommandOption {
            names: &["--fov"],
            value: "DEG",
            help: "its vertical angle of view (default the scene's)",
            read: |args, parser| {
                let between = |v| v > 0.0 && v < 180.0;
                args.as_mut().fov = Some(number(parser, "--fov", "degrees between 0 and 180", between)?);
                Ok(())
            },
        },
    ]
}

/// Of what is changed in the scene part by part.
fn of_parts<A: AsMut<Seen>>() -> [CommandOption<A>; 2] {
    [
        CommandOption {
            names: &["--edit"],
            value: "EDITS",
            help: "changes parts of the scene, by the names that its file has: '{ material.glass = { ior = 1.4 }, shape.\"sphere 1\" = { \
                   center = [0, 1, 0] }, sun = { elevation = 20 } }', TOML in a line (assets/README.md lists what can be changed); given \
                   again, later ones hold over earlier ones",
            read: |args, parser| {
                let words = text(parser)?;
                match words.parse::<Edits>() {
                    Ok(edits) => args.as_mut().changes.take_edits(&edits),
                    Err(why) => return usage(format!("--edit {}: {why}", shown(&words))),
                }
                Ok(())
            },
        },
        CommandOption {
            names: &["--variant"],
            value: "NAME",
            help: "which of the variants of a model its parts wear (default the file's own)",
            read: |args, parser| {
                args.as_mut().changes.edits.variant = Some(text(parser)?);
                Ok(())
            },
        },
    ]
}

/// The option of every command that opens a scene, named on its command line or in the records of a picture.
pub fn allow_outside<A>() -> CommandOption<A> {
    CommandOption {
        names: &["--allow-outside"],
        value: "",
        help: "scenes may name files that lie outside of their folder: ../rock.ply, /models/rock.ply",
        read: |_, _| {
            scene::allow_files_outside();
            Ok(())
        },
    }
}
