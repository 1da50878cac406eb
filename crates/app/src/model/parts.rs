//! The scene in hand: which of its parts is looked at and changed, and where parts are seen in the pictures.

use super::Model;
use scene::edit::{Property, Subject, Value};
use scene::{Camera, Scene};
use std::sync::Arc;

/// The parts of the scene, while they are looked at.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PartsState {
    /// Whether the parts are in sight, and a click on the picture chooses one.
    pub open: bool,
    /// The part whose properties are shown.
    pub selected: Option<Subject>,
}

/// Which shape each pixel of a view shows first, glass and all.
#[derive(Debug, Clone)]
pub struct ObjectMap {
    /// The scene that is seen, with its changes.
    pub scene: Arc<Scene>,
    /// Where it is seen from.
    pub camera: Camera,
    /// Columns and rows; a map may be coarser than the picture.
    pub size: (u32, u32),
    /// Indices of shapes, row by row from the top; [`ObjectMap::NOTHING`] where nothing is hit.
    pub shapes: Vec<u32>,
}

impl ObjectMap {
    /// Where nothing is hit.
    pub const NOTHING: u32 = u32::MAX;

    /// The shape at a place in shares of the picture from its upper left corner.
    pub fn shape_at(&self, at: [f32; 2]) -> Option<usize> {
        let [column, row] = super::pixel_at(at, self.size);
        let index = row as usize * self.size.0 as usize + column as usize;
        self.shapes.get(index).filter(|shape| **shape != Self::NOTHING).map(|shape| *shape as usize)
    }
}

/// What is to be known of where parts are seen.
#[derive(Debug, Clone)]
pub struct ObjectsWish {
    /// The scene that is seen, with its changes.
    pub scene: Arc<Scene>,
    /// Where it is seen from.
    pub camera: Camera,
    /// Width and height of the picture in pixels.
    pub size: (u32, u32),
    /// The shapes that are outlined.
    pub outlined: Vec<u32>,
}

impl PartialEq for ObjectsWish {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && (self.camera, self.size, &self.outlined) == (other.camera, other.size, &other.outlined)
    }
}

impl Model {
    /// Changes a property of a part of the scene, or leaves it to the scene again. What cannot be made is told, and left.
    pub fn edit(&mut self, subject: &Subject, property: &'static Property, value: Option<Value>) {
        let changes = &mut self.document.changes;
        match value {
            Some(value) => changes.edits.set(subject, property, value),
            None => changes.edits.reset(subject, property),
        }
        // the slider of all glass, or of the sun, would hold over what is changed here
        match property.name {
            "ior" => changes.refraction_ratio = None,
            "angular_radius" => changes.sun_radius = None,
            _ => {}
        }
        self.apply_changes();
    }

    /// Makes the document's changes. What cannot be made is told, and left.
    pub fn apply_changes(&mut self) {
        if let Err(why) = self.document.apply_changes() {
            self.say(Err(why.to_string()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Theme;

    #[test]
    fn a_change_that_cannot_be_made_is_told_and_the_one_before_stays() {
        let scene = scene::builtin::named("cornell-balls").expect("a built-in scene");
        let glass = scene
            .shapes
            .iter()
            .position(|shape| matches!(scene.material_of(shape).bsdf, scene::Bsdf::Dielectric { .. }));
        let glass = glass.expect("a glass ball");
        let other = (0..scene.shapes.len())
            .find(|index| *index != glass && scene.shapes[*index].geometry.kind() == "sphere")
            .expect("another ball");
        let subject = Subject::Shape(scene.shape_name(other).into_owned());
        let (wears, center) =
            (subject.property("material").expect("a row"), subject.property("center").expect("a row"));
        let material = Value::Word(scene.material_of(&scene.shapes[glass]).name.clone());
        let beside = Value::Triple(scene.shapes[glass].geometry.center() + 0.1);
        let mut model = Model::new(scene, "cornell-balls".into(), Theme::Dark);
        model.edit(&subject, wears, Some(material));
        assert!(model.state.message.is_none());
        let before = model.document.changes.clone();
        model.edit(&subject, center, Some(beside));
        assert!(model.state.message.take().is_some_and(|message| message.text.contains("would overlap")));
        assert_eq!(model.document.changes, before);
        model.edit(&subject, wears, None);
        assert!(model.document.changes.edits.is_empty());
    }

    fn material(model: &Model, name: &str) -> Subject {
        let subject = Subject::Material(name.into());
        assert!(subject.index_in(&model.document.scene).is_some());
        subject
    }

    fn changed(model: &mut Model, subject: &Subject, property: &str, number: f32) {
        let property = subject.property(property).expect("a row");
        model.edit(subject, property, Some(Value::Number(number)));
        model.settle(false);
    }

    #[test]
    fn undo_gives_changes_back_and_the_scene_with_them() {
        let scene = scene::builtin::named("whitted").expect("a built-in scene");
        let mut model = Model::new(scene, "whitted".into(), Theme::Dark);
        let glass = material(&model, "glass");
        let ior = |model: &Model| {
            let seen = model.document.seen();
            (glass.property("ior").expect("a row").get)(seen, glass.index_in(seen).expect("glass"))
        };
        let own = ior(&model);
        changed(&mut model, &glass, "ior", 1.25);
        changed(&mut model, &glass, "ior", 1.75);
        model.undo();
        assert_eq!(ior(&model), Some(Value::Number(1.25)));
        model.undo();
        assert_eq!((ior(&model), model.document.changes.edits.is_empty()), (own, true));
        model.redo();
        assert_eq!(ior(&model), Some(Value::Number(1.25)));
        // the slider of all glass takes the place of what was said of one, in one step
        for ratio in [0.9, 0.8] {
            model.document.changes.set_refraction_ratio(Some(ratio));
            model.settle(ratio == 0.9);
        }
        assert!(model.document.changes.edits.is_empty());
        model.undo();
        assert_eq!(ior(&model), Some(Value::Number(1.25)));
    }

    #[test]
    fn a_change_that_is_refused_is_no_step() {
        let scene = scene::builtin::named("cornell").expect("a built-in scene");
        let mut model = Model::new(scene, "cornell".into(), Theme::Dark);
        let white = material(&model, "white");
        let lobe = white.property("lobe").expect("a row");
        model.edit(&white, lobe, Some(Value::Word("felt".into())));
        model.settle(false);
        assert!(model.state.message.is_some());
        assert_eq!(model.can_undo_and_redo(), [false, false]);
    }

    #[test]
    fn of_a_scene_that_is_read_again_changes_stay_that_fit_and_no_undo_brings_the_others_back() {
        let scene = scene::builtin::named("whitted").expect("a built-in scene");
        let mut without = scene.clone();
        without.materials.iter_mut().filter(|m| m.name == "glass").for_each(|m| m.name = "ice".into());
        let mut model = Model::new(scene, "whitted".into(), Theme::Dark);
        let glass = material(&model, "glass");
        changed(&mut model, &glass, "ior", 1.25);
        changed(&mut model, &Subject::Sun, "elevation", 30.0);
        let lost = model.reread(without.clone()).expect("it is another");
        assert!(lost.len() == 1 && lost[0].ends_with(": material 'glass'"), "{lost:?}");
        assert_eq!(model.document.changes.edits, "{ sun.elevation = 30 }".parse().expect("changes"));
        let towards = |model: &Model| model.document.seen().sun.expect("a sun").towards;
        assert!((towards(&model).y - 0.5).abs() < 1e-6);
        model.settle(false);
        model.undo();
        assert!(model.document.changes.edits.is_empty() && model.state.message.is_none());
        assert_eq!(towards(&model), without.sun.expect("a sun").towards);
        assert!(!model.can_undo_and_redo()[0], "what was changed in glass is no step");
        assert_eq!(model.reread(without), None);
    }
}
