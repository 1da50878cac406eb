//! Changes beside the scene that they are of: what it lacks, what of them is left once it has become another, and what
//! they come to in words.

use super::{CannotEdit, Edits, Kind, Property, Subject, Value};
use crate::{Scene, nearest_or_begun};

/// Names that a fault lists; a model has thousands.
const MOST_NAMES: usize = 8;

impl Edits {
    /// What of these changes can still be made in a scene that may have become another, and what cannot, each in a few
    /// words.
    pub fn fitting(&self, scene: &Scene) -> (Edits, Vec<String>) {
        let (mut fitting, mut lost) = (self.clone(), Vec::new());
        if let Some(name) = &self.variant
            && scene.variants.iter().all(|variant| variant.name != *name)
        {
            fitting.variant = None;
            lost.push(format!("variant '{}'", image_file::escaped(name)));
        }
        for subject in self.values.keys().filter(|subject| subject.index_in(scene).is_none()) {
            fitting.reset_all(subject);
            lost.push(subject.to_string());
        }
        for (subject, property, value) in self.rows() {
            let index = subject.index_in(scene);
            if index.is_some_and(|index| unknown_word(scene, subject, index, property, value).is_some()) {
                fitting.reset(subject, property);
                lost.push(format!("{} of {subject}", property.name));
            }
        }
        if let Err(why) = fitting.applied_to(scene) {
            lost.push(why.to_string());
            fitting = Edits::default();
        }
        (fitting, lost)
    }

    /// Changes that change nothing, for what they are of has no such property as it is: a line each. `edited` is the scene
    /// with these changes.
    pub fn without_effect(&self, edited: &Scene) -> Vec<String> {
        let idle = |subject: &Subject, property: &Property| {
            subject.index_in(edited).is_some_and(|index| (property.get)(edited, index).is_none())
        };
        let rows = self.rows().filter(|(subject, property, _)| idle(subject, property));
        rows.map(|(subject, property, _)| format!("{} of {subject} has no effect: it has none", property.name))
            .collect()
    }

    /// Leaves a property to the scene again, whatever it is of.
    pub fn reset_everywhere(&mut self, property: &str) {
        self.values.values_mut().for_each(|values| _ = values.remove(property));
        self.values.retain(|_, values| !values.is_empty());
    }

    /// That a picture shows a changed scene, for its label: "edited: variant 'beach', 2 parts"; `None` if it does not.
    pub fn told(&self) -> Option<String> {
        let parts = match self.values.len() {
            0 => None,
            1 => Some("1 part".to_owned()),
            count => Some(format!("{count} parts")),
        };
        let variant = self.variant.iter().map(|name| format!("variant '{}'", image_file::escaped(name)));
        let words: Vec<String> = variant.chain(parts).collect();
        (!words.is_empty()).then(|| format!("edited: {}", words.join(", ")))
    }

    /// Every change with its row.
    fn rows(&self) -> impl Iterator<Item = (&Subject, &'static Property, &Value)> {
        let of = |(subject, name, value): (_, &str, _)| Some((subject, Subject::property(subject, name)?, value));
        let each = self
            .values
            .iter()
            .flat_map(|(subject, values)| values.iter().map(move |(name, value)| (subject, *name, value)));
        each.filter_map(of)
    }
}

/// That a scene has none of a subject, with those that it has.
pub(super) fn lacks(scene: &Scene, subject: &Subject) -> CannotEdit {
    let known: Vec<String> = match subject {
        Subject::Material(_) => scene.materials.iter().map(|material| material.name.clone()).collect(),
        Subject::Shape(_) => (0..scene.shapes.len()).map(|index| scene.shape_name(index).into_owned()).collect(),
        Subject::Light(_) => (0..scene.point_lights.len()).map(|index| scene.light_name(index).into_owned()).collect(),
        Subject::Sun | Subject::Sky => Vec::new(),
    };
    let (what, name) = match subject {
        Subject::Material(name) | Subject::Shape(name) | Subject::Light(name) => (subject.to_string(), Some(name)),
        Subject::Sun => ("sun".to_owned(), None),
        Subject::Sky => ("sky".to_owned(), None),
    };
    let aside = name.map_or_else(String::new, |name| among(name, &known, "it has"));
    CannotEdit(format!("{} has no {what}{aside}", scene.name))
}

/// What is wrong with a word that is none of its property's; `None` where nothing is.
pub(super) fn unknown_word(
    scene: &Scene,
    subject: &Subject,
    index: usize,
    property: &Property,
    value: &Value,
) -> Option<CannotEdit> {
    let word = value.word().filter(|_| matches!(property.kind, Kind::Word))?;
    let known = (property.words)(scene);
    // what it is already may have no name that it could be asked for by
    let is_already = || (property.get)(scene, index).is_some_and(|now| now == *value);
    if known.iter().any(|known| known == word) || is_already() {
        return None;
    }
    let (shown, aside) = (image_file::escaped(word), among(word, &known, "expected one of"));
    Some(CannotEdit(format!("{} of {subject}: '{shown}' is none{aside}", property.name)))
}

/// "; did you mean glass?", or ": it has a, b and 7 more".
fn among(word: &str, known: &[String], has: &str) -> String {
    if let Some(meant) = nearest_or_begun(word, known.iter().map(String::as_str)) {
        return format!("; did you mean '{}'?", image_file::escaped(meant));
    }
    if known.is_empty() {
        return String::new();
    }
    let listed: Vec<_> = known.iter().take(MOST_NAMES).map(|name| image_file::escaped(name)).collect();
    let more = known.len() - listed.len();
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!(": {has} {}{more}", listed.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin;

    fn edits(text: &str) -> Edits {
        text.parse().expect("changes")
    }

    fn refused(scene: &Scene, text: &str) -> String {
        edits(text).applied_to(scene).expect_err("it cannot be").to_string()
    }

    #[test]
    fn a_name_that_was_probably_meant_is_told_and_else_those_that_there_are() {
        let mut scene = builtin::named("cornell").expect("a built-in scene");
        scene.materials[0].name = "plaster".into();
        let why = refused(&scene, "{ material.plastre.colour = [1, 1, 1] }");
        assert_eq!(why, "cornell has no material 'plastre'; did you mean 'plaster'?");
        let why = refused(&scene, "{ material.velvet.colour = [1, 1, 1] }");
        assert!(why.starts_with("cornell has no material 'velvet': it has plaster, "), "{why}");
        assert_eq!(refused(&scene, "{ sun.elevation = 3 }"), "cornell has no sun");
        let why = refused(&scene, "{ material.plaster.lobe = \"dielektric\" }");
        assert_eq!(why, "lobe of material 'plaster': 'dielektric' is none; did you mean 'dielectric'?");
    }

    #[test]
    fn of_a_scene_that_became_another_what_it_still_has_stays_changed() {
        let scene = builtin::named("cornell").expect("a built-in scene");
        let kept = format!("material.{:?}", scene.materials[0].name);
        let all = edits(&format!(
            "{{ variant = \"beach\", {kept} = {{ colour = [1, 0, 0], lobe = \"felt\" }}, shape.gone.hidden = true }}"
        ));
        let (fitting, lost) = all.fitting(&scene);
        assert_eq!(fitting, edits(&format!("{{ {kept}.colour = [1, 0, 0] }}")));
        assert_eq!(
            lost,
            ["variant 'beach'", "shape 'gone'", &format!("lobe of material '{}'", scene.materials[0].name)]
        );
        assert_eq!(fitting.fitting(&scene), (fitting.clone(), Vec::new()));
    }

    #[test]
    fn what_changes_nothing_is_told() {
        let scene = builtin::named("whitted").expect("a built-in scene");
        let lamp = scene.materials.iter().find(|material| !matches!(material.bsdf, crate::Bsdf::Dielectric { .. }));
        let idle = edits(&format!("{{ material.{:?}.ior = 2 }}", lamp.expect("no glass").name));
        let told = idle.without_effect(&idle.applied_to(&scene).expect("it can be"));
        assert!(told.len() == 1 && told[0].starts_with("ior of material"), "{told:?}");
        assert!(edits("{ sun.elevation = 20 }").without_effect(&scene).is_empty());
    }

    #[test]
    fn a_property_is_left_to_the_scene_whatever_it_is_of() {
        let mut all = edits("{ material = { a.ior = 2, b = { ior = 3, emission = [1, 1, 1] } }, sun.elevation = 3 }");
        assert_eq!(all.told().as_deref(), Some("edited: 3 parts"));
        all.reset_everywhere("ior");
        assert_eq!(all, edits("{ material.b.emission = [1, 1, 1], sun.elevation = 3 }"));
        assert_eq!(
            edits("{ variant = \"x\", sun.elevation = 3 }").told().as_deref(),
            Some("edited: variant 'x', 1 part")
        );
        assert_eq!(Edits::default().told(), None);
    }
}
