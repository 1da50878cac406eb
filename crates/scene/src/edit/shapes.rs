//! What can be changed in a shape: what it wears, and where it is.

use super::places::Places;
use super::{Edits, Kind, Property, Subject, Value, no_words};
use crate::{Geometry, Instance, Scene, Shape, Variant};
use glam::{Affine3A, EulerRot, Quat, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;

pub const PROPERTIES: &[Property] = &[
    Property {
        name: "material",
        label: "Material",
        help: "What it wears: any of the scene's materials",
        kind: Kind::Word,
        words: |scene| scene.materials.iter().map(|material| material.name.clone()).collect(),
        get: |scene, index| Some(Value::Word(scene.material_of(&scene.shapes[index]).name.clone())),
        set: |scene, index, value| {
            let wanted = value.word().and_then(|name| scene.materials.iter().position(|found| found.name == name));
            change(scene, index, wanted, |shape, material| shape.material = material);
        },
    },
    Property {
        name: "scale",
        label: "Size",
        help: "How many times as large it is as in the file, about its middle",
        kind: Kind::Number { range: 1e-3..=1e3, shown: 0.1..=10.0, logarithmic: true, unit: "" },
        words: no_words,
        get: |_, _| Some(Value::Number(1.0)),
        set: |scene, index, value| {
            change(scene, index, value.number(), |shape, scale| grow(&mut shape.geometry, scale))
        },
    },
    Property {
        name: "center",
        label: "Middle",
        help: "Where the middle of the box around it stands",
        kind: Kind::Point,
        words: no_words,
        get: |scene, index| Some(Value::Triple(scene.shapes[index].geometry.center())),
        set: |scene, index, value| {
            change(scene, index, value.triple(), |shape, center| {
                let by = center - shape.geometry.center();
                place(&mut shape.geometry, &Affine3A::from_translation(by));
            });
        },
    },
    Property {
        name: "turn",
        label: "Turn",
        help: "Degrees about x, then y, then z through its middle",
        kind: Kind::Turn,
        words: no_words,
        get: |scene, index| match scene.shapes[index].geometry {
            Geometry::Sphere { .. } | Geometry::Box { .. } => None,
            _ => Some(Value::Triple(Vec3::ZERO)),
        },
        set: |scene, index, value| {
            change(scene, index, value.triple(), |shape, degrees| {
                let [x, y, z] = degrees.to_array().map(f32::to_radians);
                about(shape.geometry.center(), Affine3A::from_quat(Quat::from_euler(EulerRot::ZYX, z, y, x)))
                    .apply(&mut shape.geometry);
            });
        },
    },
    Property {
        name: "turn_y",
        label: "Turn",
        help: "Degrees by which the box stands turned about the vertical through its middle",
        kind: Kind::Number { range: -360.0..=360.0, shown: -180.0..=180.0, logarithmic: false, unit: "°" },
        words: no_words,
        get: |scene, index| match scene.shapes[index].geometry {
            Geometry::Box { turn_y, .. } => Some(Value::Number(turn_y)),
            _ => None,
        },
        set: |scene, index, value| {
            change(scene, index, value.number(), |shape, degrees| turn_box(&mut shape.geometry, degrees))
        },
    },
    Property {
        name: "hidden",
        label: "Left out",
        help: "As if it were not in the scene at all",
        kind: Kind::Flag,
        words: no_words,
        get: |_, _| Some(Value::Flag(false)),
        set: |_, _, _| {},
    },
];

fn change<T>(scene: &mut Scene, index: usize, to: Option<T>, set: impl FnOnce(&mut Shape, T)) {
    let Some(to) = to else { return };
    if let Some(shape) = Arc::make_mut(&mut scene.shapes).get_mut(index) {
        set(shape, to);
    }
}

/// A map about a point that stays where it is.
fn about(center: Vec3, map: Affine3A) -> Placing {
    Placing(Affine3A::from_translation(center) * map * Affine3A::from_translation(-center))
}

struct Placing(Affine3A);

impl Placing {
    fn apply(&self, geometry: &mut Geometry) {
        place(geometry, &self.0);
    }
}

/// Puts a shape elsewhere. Boxes and spheres stay upright: theirs is only moved.
fn place(geometry: &mut Geometry, by: &Affine3A) {
    match geometry {
        Geometry::Sphere { center, .. } => *center = by.transform_point3(*center),
        Geometry::Box { corner, .. } => *corner += Vec3::from(by.translation),
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            *corner = by.transform_point3(*corner);
            (*edge_u, *edge_v) = (by.transform_vector3(*edge_u), by.transform_vector3(*edge_v));
        }
        Geometry::Disk { center, normal, .. } => {
            *center = by.transform_point3(*center);
            let turned = by.transform_vector3(*normal).as_dvec3().normalize_or_zero();
            *normal = turned.as_vec3();
        }
        Geometry::Mesh(mesh) => *geometry = Geometry::Instance(Instance { mesh: mesh.clone(), to_world: *by }),
        Geometry::Instance(instance) => instance.to_world = *by * instance.to_world,
    }
}

/// Makes a shape larger about its middle.
fn grow(geometry: &mut Geometry, scale: f32) {
    let middle = geometry.center();
    match geometry {
        Geometry::Sphere { radius, .. } => *radius *= scale,
        Geometry::Disk { radius, .. } => *radius *= scale,
        Geometry::Box { corner, size, .. } => {
            *corner = middle + (*corner - middle) * scale;
            *size *= scale;
        }
        Geometry::Rectangle { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
            about(middle, Affine3A::from_scale(Vec3::splat(scale))).apply(geometry);
        }
    }
}

/// Turns a box about the vertical through its middle, to so many degrees.
fn turn_box(geometry: &mut Geometry, degrees: f32) {
    let middle = geometry.center();
    if let Geometry::Box { turn_y, .. } = geometry {
        *turn_y = degrees;
        let moved = middle - geometry.center();
        place(geometry, &Affine3A::from_translation(moved));
    }
}

/// Leaves out the shapes that are hidden, with their names. The others keep their order.
pub fn remove_hidden(scene: &mut Scene, edits: &Edits, places: &Places) {
    let is_hidden = |values: &BTreeMap<&'static str, Value>| values.get("hidden").and_then(Value::flag) == Some(true);
    let shapes = edits.iter().filter(|(subject, _)| matches!(subject, Subject::Shape(_)));
    let hidden = shapes.filter(|(_, values)| is_hidden(values)).filter_map(|(subject, _)| places.find(subject));
    let mut stays = vec![true; scene.shapes.len()];
    hidden.for_each(|index| stays[index] = false);
    let kept: Vec<usize> = (0..stays.len()).filter(|index| stays[*index]).collect();
    if kept.len() == stays.len() {
        return;
    }
    let mut moved_to: Vec<Option<usize>> = vec![None; stays.len()];
    kept.iter().enumerate().for_each(|(new, old)| moved_to[*old] = Some(new));
    let names: Vec<String> = kept.iter().map(|index| scene.shape_name(*index).into_owned()).collect();
    let wears = |variant: &Variant| {
        let kept = variant.wears.iter().filter_map(|(shape, material)| Some(((*moved_to.get(*shape)?)?, *material)));
        Variant { name: variant.name.clone(), wears: kept.collect() }
    };
    scene.variants = scene.variants.iter().map(wears).collect();
    scene.shapes = kept.iter().map(|index| scene.shapes[*index].clone()).collect();
    Arc::make_mut(&mut scene.names).shapes = names;
}

/// A shape that reaches farther than coordinates may be.
pub fn beyond_coordinates(scene: &Scene) -> Option<usize> {
    scene.shapes.iter().position(|shape| {
        let (lo, hi) = shape.geometry.bounds();
        // a mesh without triangles has no bounds
        let reach = lo.abs().max(hi.abs()).max_element();
        !(lo.cmpgt(hi).any() || reach <= 1e12)
    })
}
