//! Which meshes keep a tree of their own, and those that do not put into the world before anything else looks at a scene.

use super::contact::held_apart;
use scene::{Alpha, Geometry, Scene, Shape};
use std::borrow::Cow;
use std::sync::Arc;

/// Whether a shape is met as an instance of its mesh's tree: the mesh is large, does not shine and has no holes. Lights are
/// sampled triangle by triangle in the world, so what shines lies there as triangles; and holes are asked for in the
/// trees of these alone.
pub(crate) fn is_instanced(scene: &Scene, shape: &Shape) -> bool {
    let material = scene.material_of(shape);
    let is_large = shape.geometry.mesh_of().is_some_and(|mesh| mesh.is_large());
    is_large && !material.shines() && material.surface.alpha == Alpha::Opaque
}

/// The scene as rays meet it: small instances are meshes in the world's space, and shapes that touch are held apart.
/// Large meshes stay as they are, and so does what touches them.
pub(crate) fn made_ready(scene: &Scene) -> Cow<'_, Scene> {
    match baked(scene) {
        Cow::Borrowed(scene) => held_apart(scene),
        Cow::Owned(scene) => Cow::Owned(held_apart(&scene).into_owned()),
    }
}

fn baked(scene: &Scene) -> Cow<'_, Scene> {
    let is_to_bake = |shape: &Shape| matches!(shape.geometry, Geometry::Instance(_)) && !is_instanced(scene, shape);
    if !scene.shapes.iter().any(is_to_bake) {
        return Cow::Borrowed(scene);
    }
    let mut shapes = scene.shapes.to_vec();
    for shape in shapes.iter_mut().filter(|shape| is_to_bake(shape)) {
        if let Geometry::Instance(instance) = &shape.geometry {
            shape.geometry = Geometry::Mesh(Arc::new(instance.baked()));
        }
    }
    Cow::Owned(Scene { shapes: shapes.into(), ..scene.clone() })
}
