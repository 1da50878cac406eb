//! Where subjects stand in a scene, of many at a time.

use super::Subject;
use crate::Scene;
use std::borrow::Cow;
use std::collections::HashMap;

/// Subjects from which on all names are looked through once, rather than once for each.
const MANY: usize = 8;

/// Where the subjects of a scene stand in the lists of their kinds.
pub struct Places<'a> {
    scene: &'a Scene,
    by_name: Option<ByName<'a>>,
}

/// Of names that several parts have, as materials may, the first.
struct ByName<'a> {
    materials: HashMap<&'a str, usize>,
    shapes: HashMap<Cow<'a, str>, usize>,
    lights: HashMap<Cow<'a, str>, usize>,
}

impl<'a> Places<'a> {
    /// Of so many subjects of a scene.
    pub fn of(count: usize, scene: &'a Scene) -> Self {
        let by_name = || ByName {
            materials: first_of(scene.materials.iter().map(|material| material.name.as_str())),
            shapes: first_of((0..scene.shapes.len()).map(|index| scene.shape_name(index))),
            lights: first_of((0..scene.point_lights.len()).map(|index| scene.light_name(index))),
        };
        Places { scene, by_name: (count > MANY).then(by_name) }
    }

    /// The index of a subject, as [`Subject::index_in`] finds it.
    pub fn find(&self, subject: &Subject) -> Option<usize> {
        match (&self.by_name, subject) {
            (Some(by_name), Subject::Material(name)) => by_name.materials.get(name.as_str()).copied(),
            (Some(by_name), Subject::Shape(name)) => by_name.shapes.get(name.as_str()).copied(),
            (Some(by_name), Subject::Light(name)) => by_name.lights.get(name.as_str()).copied(),
            (None, _) | (Some(_), Subject::Sun | Subject::Sky) => subject.index_in(self.scene),
        }
    }
}

fn first_of<T: Eq + std::hash::Hash>(names: impl Iterator<Item = T>) -> HashMap<T, usize> {
    let mut places = HashMap::new();
    for (index, name) in names.enumerate() {
        places.entry(name).or_insert(index);
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin;

    #[test]
    fn many_subjects_are_found_where_one_is() {
        let mut scene = builtin::named("whitted").unwrap();
        let twice = scene.materials[0].clone();
        scene.materials.push(twice);
        let materials = scene.materials.iter().map(|material| Subject::Material(material.name.clone()));
        let shapes = (0..scene.shapes.len()).map(|index| Subject::Shape(scene.shape_name(index).into_owned()));
        let others = [Subject::Light("light 1".into()), Subject::Shape("ghost".into()), Subject::Sun, Subject::Sky];
        for subject in materials.chain(shapes).chain(others) {
            let found = [1, 100].map(|count| Places::of(count, &scene).find(&subject));
            assert_eq!(found, [subject.index_in(&scene); 2], "{subject}");
        }
    }
}
