//! Changes of a changed scene, as changes of what that stands on.

use super::{Edits, Subject, Value, shapes};
use crate::{Geometry, Scene};

/// Which properties of shapes count from the scene's own, and those that follow from their places: how these come
/// together is not told by what they are.
const PLACING: [&str; 5] = ["scale", "center", "turn", "turn_y", "hidden"];

impl Edits {
    /// The changes of `scene` that come to the same as `before`, and then these of the scene with those; `None` if there
    /// are none: the size of a shape may be changed by so much at once and no more.
    pub fn after(&self, before: &Edits, scene: &Scene) -> Option<Edits> {
        let between = before.applied_to(scene).ok()?;
        let wanted = self.applied_to(&between).ok()?;
        let mut all = self.over(before);
        for (subject, values) in before.iter().filter(|(subject, _)| matches!(subject, Subject::Shape(_))) {
            for (name, earlier) in values {
                let property = subject.property(name)?;
                if let Some(both) = self.get(subject, property).and_then(|later| together(name, earlier, later)) {
                    all.set(subject, property, both);
                }
            }
        }
        // what one kind of material has handed on to the next is said outright
        let there = all.applied_to(scene).ok()?;
        let subjects: Vec<Subject> = all.iter().map(|(subject, _)| subject.clone()).collect();
        for subject in subjects {
            let (Some(here), Some(index)) = (subject.index_in(&there), subject.index_in(&wanted)) else { continue };
            let stated = |name: &str| matches!(subject, Subject::Shape(_)) && PLACING.contains(&name);
            for property in subject.properties().iter().filter(|property| !stated(property.name)) {
                let value = (property.get)(&wanted, index);
                if let Some(value) = value.filter(|value| (property.get)(&there, here).as_ref() != Some(value)) {
                    all.set(&subject, property, value);
                }
            }
        }
        let same = all.applied_to(scene).ok()?;
        are_alike(&same, &wanted).then_some(all)
    }
}

/// What comes of a value that counts from the scene's own, and then another.
fn together(name: &str, earlier: &Value, later: &Value) -> Option<Value> {
    match (name, earlier, later) {
        ("scale", Value::Number(a), Value::Number(b)) => Some(Value::Number(a * b)),
        ("turn", Value::Triple(a), Value::Triple(b)) => {
            let turn = shapes::turned_by(*b) * shapes::turned_by(*a);
            Some(Value::Triple(shapes::degrees_of(turn)))
        }
        _ => None,
    }
}

/// Whether two scenes are the same but for what is rounded on the way.
fn are_alike(a: &Scene, b: &Scene) -> bool {
    let shapes = a.shapes.iter().zip(b.shapes.iter()).enumerate();
    let mut shapes = shapes.map(|(index, (one, other))| {
        one.material == other.material
            && a.shape_name(index) == b.shape_name(index)
            && are_near(&one.geometry, &other.geometry)
    });
    let sun = match (&a.sun, &b.sun) {
        (Some(a), Some(b)) => {
            (a.towards - b.towards).length() < 1e-5
                && (a.angular_radius, a.irradiance) == (b.angular_radius, b.irradiance)
        }
        (a, b) => a == b,
    };
    a.shapes.len() == b.shapes.len()
        && shapes.all(|alike| alike)
        && sun
        && (&a.materials, &a.point_lights, a.sky, &a.environment)
            == (&b.materials, &b.point_lights, b.sky, &b.environment)
}

fn are_near(a: &Geometry, b: &Geometry) -> bool {
    let [(lo, hi), (others_lo, others_hi)] = [a.bounds(), b.bounds()];
    let largest = lo.abs().max(hi.abs()).max_element();
    let apart = (lo - others_lo).abs().max((hi - others_hi).abs()).max_element();
    a == b || (std::mem::discriminant(a) == std::mem::discriminant(b) && apart <= 1e-5 * largest)
}
