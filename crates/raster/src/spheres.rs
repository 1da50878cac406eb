//! The spheres and boxes of a scene that repairs know in closed form, and how the sun sees spheres of glass.

use crate::gpu_data::{KnownBox, Lights, MOST_BOXES, MOST_SPHERES, Sphere, View};
use crate::repair::Repair;
use crate::settings::RasterSettings;
use crate::tessellation::corners;
use bytemuck::Zeroable;
use scene::glam::camera::rh;
use scene::{Alpha, Bsdf, Geometry, Scene, Shape, Vec3};

/// Half the width of a caustic map, in radii of its sphere; as `shaders/raster/frame.wgsl` has it.
pub const CAUSTIC_REACH: f32 = 4.0;

/// Whether the sun's light goes through a shape, other than as a shadow map knows it.
fn lets_sun_through(scene: &Scene, shape: usize, settings: &RasterSettings) -> bool {
    let through = settings.repairs().has_any(&[Repair::LightThroughGlass, Repair::Caustics]);
    through && scene.sun.is_some() && sphere(scene, shape).is_some_and(|sphere| sphere.refraction_ratio > 0.0)
}

/// A shape as a sphere, if it is one that does not shine.
fn sphere(scene: &Scene, shape: usize) -> Option<Sphere> {
    let shape = &scene.shapes[shape];
    let material = scene.material_of(shape);
    let Geometry::Sphere { center, radius } = shape.geometry else { return None };
    let refraction_ratio = match material.bsdf {
        Bsdf::Dielectric { ior } => material.fake.refraction_ratio.unwrap_or(1.0 / ior),
        _ => 0.0,
    };
    let known = Sphere { middle: center, radius, refraction_ratio, ..Sphere::zeroed() };
    material.emission.is_none().then_some(known)
}

/// A shape as a box, if it is one that light does not go through.
fn known_box(scene: &Scene, shape: &Shape) -> Option<KnownBox> {
    let Geometry::Box { size, turn_y, .. } = shape.geometry else { return None };
    let material = scene.material_of(shape);
    let (sine, cosine) = turn_y.to_radians().sin_cos();
    let known = KnownBox { middle: shape.geometry.center(), cosine, half: 0.5 * size, sine };
    let opaque = !matches!(material.bsdf, Bsdf::Dielectric { .. }) && material.surface.alpha == Alpha::Opaque;
    (opaque && material.emission.is_none()).then_some(known)
}

/// The spheres of glass that let the sun's light through, in the order of [`Lights::spheres`] and of the caustic maps' layers: as
/// many as those have room for. Others cast the shadow of a stone.
pub fn casters(scene: &Scene, settings: &RasterSettings) -> Vec<usize> {
    let all = (0..scene.shapes.len()).filter(|shape| lets_sun_through(scene, *shape, settings));
    all.take(MOST_SPHERES / 2).collect()
}

/// Writes what repairs know of the scene's spheres: glass that lets the sun through first, then the others.
pub fn fill(lights: &mut Lights, scene: &Scene, settings: &RasterSettings) {
    if settings.repairs().count() == 0 {
        return;
    }
    let glass: Vec<_> = casters(scene, settings).into_iter().filter_map(|shape| sphere(scene, shape)).collect();
    let all = (0..scene.shapes.len()).filter_map(|shape| sphere(scene, shape));
    let opaque = all.filter(|sphere| sphere.refraction_ratio == 0.0);
    let known: Vec<_> = glass.iter().copied().chain(opaque).take(MOST_SPHERES).collect();
    lights.glass_count = glass.len() as u32;
    lights.sphere_count = known.len() as u32;
    lights.spheres[..known.len()].copy_from_slice(&known);
    let boxes: Vec<_> = scene.shapes.iter().filter_map(|shape| known_box(scene, shape)).take(MOST_BOXES).collect();
    lights.box_count = boxes.len() as u32;
    lights.boxes[..boxes.len()].copy_from_slice(&boxes);
    let Some(sun) = scene.sun else { return };
    let radius = sun.angular_radius.to_radians();
    lights.sun_tangent = radius.tan();
    lights.sun_cosine = radius.cos();
    let sine = radius.sin();
    if sine > 0.0 {
        lights.sun_radiance = lights.sun_incident / (sine * sine);
    }
    let aside = if lights.sun_towards.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
    lights.sun_right = aside.cross(lights.sun_towards).normalize_or(Vec3::X);
    lights.sun_up = lights.sun_towards.cross(lights.sun_right);
    let along = corners(scene.bounds()).map(|corner| -lights.sun_towards.dot(corner));
    let first = along.into_iter().fold(f32::INFINITY, f32::min);
    let last = along.into_iter().fold(f32::NEG_INFINITY, f32::max);
    let scale = (1.02 * (last - first)).max(f32::MIN_POSITIVE).recip();
    lights.receiver_depth = (-lights.sun_towards * scale).extend(0.01 - first * scale);
}

/// The sun's view of what light through a sphere falls on.
pub fn receivers_view(lights: &Lights, layer: usize, scene: &Scene) -> View {
    let Sphere { middle, radius, .. } = lights.spheres[layer];
    let half_width = CAUSTIC_REACH * radius;
    let (low, high) = scene.bounds();
    let reach = (high - low).length().max(f32::MIN_POSITIVE);
    let eye = middle + lights.sun_towards * reach;
    let view_from_world = rh::view::look_to_mat4(eye, -lights.sun_towards, lights.sun_up);
    // reversed, as all views are
    let (near, far) = (2.0 * reach, 0.0);
    let ortho = rh::proj::directx::orthographic(-half_width, half_width, -half_width, half_width, near, far);
    View { clip_from_world: ortho * view_from_world, depth_from_world: lights.receiver_depth, eye, ..View::zeroed() }
}

/// How far a sphere about `shape`'s middle reaches to what is next to it: its own size at least.
pub fn proxy_radius(scene: &Scene, shape: usize) -> f32 {
    let (low, high) = scene.shapes[shape].geometry.bounds();
    let middle = 0.5 * (low + high);
    let others = scene.shapes.iter().enumerate().filter(|(other, _)| *other != shape);
    let distance = |bounds: (Vec3, Vec3)| middle.clamp(bounds.0, bounds.1).distance(middle);
    let nearest = others.map(|(_, other)| distance(other.geometry.bounds())).fold(f32::INFINITY, f32::min);
    let own = 0.5 * (high - low).max_element();
    if nearest.is_finite() { nearest.max(own) } else { own }
}

/// One over the scene's size, the unit of distances in cube maps.
pub fn per_distance(scene: &Scene) -> f32 {
    let (low, high) = scene.bounds();
    (high - low).length().max(f32::MIN_POSITIVE).recip()
}
