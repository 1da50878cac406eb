//! What can be changed in a shape: what it wears, and where it is.

use super::places::Places;
use super::{Edits, Kind, Property, Subject, Value, no_words};
use crate::{Geometry, Instance, Scene, Shape, Variant};
use glam::{DAffine3, DQuat, DVec3, EulerRot, Vec3};
use std::collections::{BTreeMap, BTreeSet};
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
        get: |scene, index| Some(Value::Triple(middle_of(&scene.shapes[index].geometry).as_vec3())),
        set: |scene, index, value| {
            change(scene, index, value.triple(), |shape, center| move_to(&mut shape.geometry, center.as_dvec3()));
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
                let turn = about(middle_of(&shape.geometry), DAffine3::from_quat(turned_by(degrees)));
                place(&mut shape.geometry, &turn);
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

/// About x, then y, then z.
pub fn turned_by(degrees: Vec3) -> DQuat {
    let [x, y, z] = degrees.as_dvec3().to_array().map(f64::to_radians);
    DQuat::from_euler(EulerRot::ZYX, z, y, x)
}

/// The angles, in degrees, by which [`turned_by`] turns so.
pub fn degrees_of(turn: DQuat) -> Vec3 {
    let (z, y, x) = turn.to_euler(EulerRot::ZYX);
    DVec3::new(x, y, z).map(f64::to_degrees).as_vec3()
}

/// Middle of the bounds. It stays where it is whatever the shape is turned by: that of a mesh is the middle of its own
/// box, taken along.
fn middle_of(geometry: &Geometry) -> DVec3 {
    match geometry {
        Geometry::Sphere { center, .. } | Geometry::Disk { center, .. } => center.as_dvec3(),
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            corner.as_dvec3() + 0.5 * (edge_u.as_dvec3() + edge_v.as_dvec3())
        }
        Geometry::Box { corner, size, turn_y } => corner.as_dvec3() + half_of_box(*size, *turn_y),
        Geometry::Mesh(mesh) => middle_of_box(mesh.bounds()),
        Geometry::Instance(Instance { mesh, to_world }) => {
            to_world.as_daffine3().transform_point3(middle_of_box(mesh.bounds()))
        }
    }
}

fn middle_of_box((lo, hi): (Vec3, Vec3)) -> DVec3 {
    // of a mesh without corners nobody knows
    if lo.cmpgt(hi).any() { DVec3::ZERO } else { 0.5 * (lo.as_dvec3() + hi.as_dvec3()) }
}

/// From the corner that a box turns about to its middle.
fn half_of_box(size: Vec3, turn_y: f32) -> DVec3 {
    let half = 0.5 * size.as_dvec3();
    let (sin, cos) = f64::from(turn_y).to_radians().sin_cos();
    DVec3::new(half.x * cos - half.z * sin, half.y, half.x * sin + half.z * cos)
}

/// Puts the middle of a shape there.
fn move_to(geometry: &mut Geometry, middle: DVec3) {
    match geometry {
        Geometry::Sphere { center, .. } | Geometry::Disk { center, .. } => *center = rounded(middle),
        Geometry::Box { corner, size, turn_y } => *corner = rounded(middle - half_of_box(*size, *turn_y)),
        Geometry::Rectangle { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
            let by = DAffine3::from_translation(middle - middle_of(geometry));
            place(geometry, &by);
        }
    }
}

/// A map about a point that stays where it is.
fn about(center: DVec3, map: DAffine3) -> DAffine3 {
    DAffine3::from_translation(center) * map * DAffine3::from_translation(-center)
}

/// Puts a shape elsewhere; not spheres and boxes, which stay upright.
fn place(geometry: &mut Geometry, by: &DAffine3) {
    match geometry {
        Geometry::Sphere { .. } | Geometry::Box { .. } => {}
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            *corner = rounded(by.transform_point3(corner.as_dvec3()));
            for edge in [edge_u, edge_v] {
                *edge = rounded(by.transform_vector3(edge.as_dvec3()));
            }
        }
        Geometry::Disk { center, normal, .. } => {
            *center = rounded(by.transform_point3(center.as_dvec3()));
            *normal = rounded(by.transform_vector3(normal.as_dvec3()).normalize_or_zero());
        }
        Geometry::Mesh(mesh) => {
            *geometry = Geometry::Instance(Instance { mesh: mesh.clone(), to_world: by.as_affine3a() });
        }
        Geometry::Instance(instance) => instance.to_world = (*by * instance.to_world.as_daffine3()).as_affine3a(),
    }
}

/// In f32, and as in files 0 without a sign: it would turn what is drawn at random about a normal.
fn rounded(vector: DVec3) -> Vec3 {
    vector.as_vec3() + 0.0
}

/// Makes a shape larger about its middle.
fn grow(geometry: &mut Geometry, scale: f32) {
    let middle = middle_of(geometry);
    match geometry {
        Geometry::Sphere { radius, .. } | Geometry::Disk { radius, .. } => *radius *= scale,
        Geometry::Box { size, .. } => {
            *size *= scale;
            move_to(geometry, middle);
        }
        Geometry::Rectangle { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
            place(geometry, &about(middle, DAffine3::from_scale(DVec3::splat(scale.into()))));
        }
    }
}

/// Turns a box about the vertical through its middle, to so many degrees.
fn turn_box(geometry: &mut Geometry, degrees: f32) {
    let middle = middle_of(geometry);
    if let Geometry::Box { turn_y, .. } = geometry {
        *turn_y = degrees;
        move_to(geometry, middle);
    }
}

/// Which shapes are left out, by their indices.
pub fn hidden(edits: &Edits, places: &Places) -> BTreeSet<usize> {
    let is_hidden = |values: &BTreeMap<&'static str, Value>| values.get("hidden").and_then(Value::flag) == Some(true);
    let shapes = edits.iter().filter(|(subject, _)| matches!(subject, Subject::Shape(_)));
    shapes.filter(|(_, values)| is_hidden(values)).filter_map(|(subject, _)| places.find(subject)).collect()
}

/// Leaves out shapes, with their names.
pub fn remove(scene: &mut Scene, hidden: &BTreeSet<usize>) {
    if hidden.is_empty() {
        return;
    }
    let kept: Vec<usize> = (0..scene.shapes.len()).filter(|index| !hidden.contains(index)).collect();
    let (shapes, names): (Vec<_>, Vec<_>) =
        kept.iter().map(|&index| (scene.shapes[index].clone(), scene.shape_name(index).into_owned())).unzip();
    let wears = |variant: &Variant| {
        let place_of = |(shape, material): &(usize, usize)| Some((kept.binary_search(shape).ok()?, *material));
        Variant { name: variant.name.clone(), wears: variant.wears.iter().filter_map(place_of).collect() }
    };
    scene.variants = scene.variants.iter().map(wears).collect();
    scene.shapes = shapes.into();
    Arc::make_mut(&mut scene.names).shapes = names;
}
