//! Cameras: those of the file, and one for a file that has none.

use super::buffers::Document;
use super::names::Names;
use super::nodes::Placed;
use super::{Refused, Remarks};
use crate::{Camera, NamedCamera, Vec3};
use glam::DVec3;

/// From the middle of a model towards the camera that is fitted to it: from the front, which faces +z, a little to
/// the right and above.
const THREE_QUARTERS: Vec3 = Vec3::new(0.6, 0.4, 1.0);

/// Field of view of the camera that is fitted, in degrees.
const FOV_Y: f32 = 45.0;

/// All cameras that see something, by the name of their node. Their near and far planes are those of other renderers: all
/// that there is is drawn. The picture's shape is the window's.
pub fn cameras(
    document: &Document,
    placed: &[Placed],
    bounds: (Vec3, Vec3),
    remarks: &mut Remarks,
) -> Result<Vec<NamedCamera>, Refused> {
    let (mut found, mut names) = (Vec::new(), Names::default());
    for node in placed {
        let Some(index) = node.node.camera else { continue };
        let Some(camera) = document.root.cameras.get(index as usize) else {
            let count = document.root.cameras.len();
            return Err(Refused(format!("{}: camera {index} is named, but there are {count}", node.name())));
        };
        let Some(perspective) = &camera.perspective else {
            remarks.of("orthographic cameras are left out", node.name());
            continue;
        };
        let seen = looking(node, perspective.yfov.to_degrees() as f32, bounds);
        if seen.fault().is_some() {
            remarks.of("cameras that see nothing are left out", node.name());
            continue;
        }
        let name = node.node.name.as_ref().or(camera.name.as_ref());
        let name = name.map_or_else(|| format!("camera {}", found.len() + 1), |name| image_file::escaped(name));
        found.push(NamedCamera { name: names.free(name), camera: seen });
    }
    Ok(found)
}

/// A camera looks along -z; its target, which one turns about, is as far away as the model's middle.
fn looking(node: &Placed, fov_y: f32, (lo, hi): (Vec3, Vec3)) -> Camera {
    let m = node.to_world.matrix3;
    let eye = node.to_world.translation;
    let forward = (-m.z_axis).normalize_or_zero();
    let up = upright(forward, m.y_axis.normalize_or_zero()).as_vec3();
    let middle = 0.5 * (lo.as_dvec3() + hi.as_dvec3());
    let size = (hi - lo).as_dvec3().length();
    let distance = forward.dot(middle - eye);
    // a camera inside of the model, or that looks away from it
    let distance = if distance > 0.05 * size { distance } else { (0.25 * size).max(1.0) };
    let target = (eye + forward * distance).as_vec3();
    Camera { eye: eye.as_vec3(), target, up, fov_y, near: None, far: None }
}

/// Straight up, for a camera that is not rolled: one turns about it. It shows the same.
fn upright(forward: DVec3, up: DVec3) -> DVec3 {
    let level = forward.cross(up).y.abs() < 1e-4;
    if level && up.y > 1e-2 { DVec3::Y } else { up }
}

/// A camera from which a model is seen in whole.
pub fn fitted((lo, hi): (Vec3, Vec3)) -> Camera {
    let middle = 0.5 * (lo.as_dvec3() + hi.as_dvec3());
    let radius = (0.5 * (hi.as_dvec3() - lo.as_dvec3())).length();
    let radius = if radius > 0.0 { radius } else { 1.0 };
    let distance = radius / f64::from(0.5 * FOV_Y).to_radians().sin();
    let eye = middle + THREE_QUARTERS.as_dvec3().normalize() * distance;
    Camera { eye: eye.as_vec3(), target: middle.as_vec3(), up: Vec3::Y, fov_y: FOV_Y, near: None, far: None }
}
