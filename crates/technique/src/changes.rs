//! What is changed in a scene, said after each other by options, records, sessions and controls: what is said last of a
//! number holds: what is said of one glass later than of all is that one's own, and the others stay with what is said of all.

use crate::SceneChanges;
use crate::settings::OF_SCENES;
use scene::edit::{CannotEdit, Edits, Property, Subject, Value};
use scene::{Bsdf, Material, Scene};

/// Properties that a number for the whole scene stands over.
const IOR: &str = "ior";
const ANGULAR_RADIUS: &str = "angular_radius";

impl SceneChanges {
    /// Sets the index of refraction of all glass, and leaves what was said of each.
    pub fn set_refraction_ratio(&mut self, ratio: Option<f32>) {
        self.refraction_ratio = ratio;
        self.edits.reset_everywhere(IOR);
    }

    /// Sets the sun's angular radius.
    pub fn set_sun_radius(&mut self, radius: Option<f32>) {
        self.sun_radius = radius;
        self.edits.reset_everywhere(ANGULAR_RADIUS);
    }

    /// Changes parts beside what is changed already. The number of all glass stays with the others than those; that of the
    /// sun, of which there is one, is left to the scene again where the edits say another.
    pub fn take_edits(&mut self, edits: &Edits) {
        let states_the_suns = edits.iter().any(|(_, values)| values.contains_key(ANGULAR_RADIUS));
        self.sun_radius = self.sun_radius.filter(|_| !states_the_suns);
        self.edits = edits.over(&self.edits);
    }

    /// These changes over others: where both say something of the same, these hold.
    pub fn over(&self, others: &SceneChanges) -> SceneChanges {
        let mut all = others.clone();
        for setting in OF_SCENES {
            (setting.get)(self).into_iter().for_each(|value| (setting.set)(&mut all, value));
        }
        // after all glass, whose number takes the place of what others said of each
        all.take_edits(&self.edits);
        all
    }

    /// The same with what is said of all glass and of the sun said of each part, as files of changed scenes have it. The
    /// fake's ratio is then that of the material's index, by a last bit another than the slider's.
    ///
    /// # Errors
    /// Those of [`Edits::applied_to`], and if a number is beyond what may be said of a part.
    pub fn as_edits(&self, scene: &Scene) -> Result<Edits, CannotEdit> {
        let mut all = self.edits.clone();
        let edited = self.edits.applied_to(scene)?;
        if let Some(ratio) = self.refraction_ratio {
            for index in self.glass_without_its_own(&edited) {
                let subject = Subject::Material(edited.materials[index].name.clone());
                state(&mut all, &subject, IOR, 1.0 / ratio)?;
            }
        }
        if let Some(radius) = self.sun_radius.filter(|_| edited.sun.is_some()) {
            state(&mut all, &Subject::Sun, ANGULAR_RADIUS, radius)?;
        }
        Ok(all)
    }
}

impl SceneChanges {
    /// The materials of glass, by their places, for which the ratio of all glass holds: those of which no index is said.
    pub fn glass_without_its_own(&self, scene: &Scene) -> Vec<usize> {
        let says_none = |material: &Material| {
            let subject = Subject::Material(material.name.clone());
            let own = subject.property(IOR).and_then(|ior| self.edits.get(&subject, ior));
            matches!(material.bsdf, Bsdf::Dielectric { .. }) && own.is_none()
        };
        (0..).zip(&scene.materials).filter(|(_, material)| says_none(material)).map(|(index, _)| index).collect()
    }

    /// Leaves the ratio of all glass to the scene again where each glass has an index of its own.
    pub fn drop_idle_ratio(&mut self, scene: &Scene) {
        self.refraction_ratio = self.refraction_ratio.filter(|_| !self.glass_without_its_own(scene).is_empty());
    }
}

/// Says a number of a part, where one may say so.
fn state(edits: &mut Edits, subject: &Subject, name: &str, number: f32) -> Result<(), CannotEdit> {
    let Some(property) = subject.property(name) else { return Ok(()) };
    let value = Value::Number(number);
    if !property.kind.holds(&value) {
        let Property { name, kind, .. } = property;
        return Err(CannotEdit(format!("{name} of {subject} is {number}: a file has {}", kind.expected())));
    }
    edits.set(subject, property, value);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PaneSettings, Provenance, Shot, TechniqueName, made_by_command, made_from};
    use std::sync::Arc;

    fn edits(text: &str) -> Edits {
        text.parse().expect("changes")
    }

    #[test]
    fn what_is_said_last_of_a_number_holds() {
        let mut changes = SceneChanges::default();
        changes.take_edits(&edits("{ material.glass = { ior = 1.2, reflectivity = 0.5 }, sun.angular_radius = 2 }"));
        changes.set_refraction_ratio(Some(0.5));
        assert_eq!(changes.edits, edits("{ material.glass.reflectivity = 0.5, sun.angular_radius = 2 }"));
        changes.set_sun_radius(Some(1.0));
        assert_eq!(changes.edits, edits("{ material.glass.reflectivity = 0.5 }"));
        changes.take_edits(&edits("{ material.glass.ior = 1.3 }"));
        assert_eq!((changes.refraction_ratio, changes.sun_radius), (Some(0.5), Some(1.0)), "of the other glasses");
        assert_eq!(changes.edits, edits("{ material.glass = { ior = 1.3, reflectivity = 0.5 } }"));
        changes.take_edits(&edits("{ sun.angular_radius = 3 }"));
        assert_eq!(changes.sun_radius, None, "there is no other sun");
    }

    #[test]
    fn of_two_that_change_the_same_the_one_over_the_other_holds() {
        let changes =
            |ratio, text: &str| SceneChanges { refraction_ratio: ratio, sun_radius: None, edits: edits(text) };
        let picture = changes(Some(0.6), "{ shape.a.hidden = true, sun.elevation = 5 }");
        let typed = changes(None, "{ sun.elevation = 9, material.glass.ior = 2 }");
        let both = changes(Some(0.6), "{ shape.a.hidden = true, sun.elevation = 9, material.glass.ior = 2 }");
        assert_eq!(typed.over(&picture), both);
        let ratio = changes(Some(0.7), "{}");
        assert_eq!(ratio.over(&both), changes(Some(0.7), "{ shape.a.hidden = true, sun.elevation = 9 }"));
        assert_eq!(SceneChanges::default().over(&both), both);
        assert_eq!(both.over(&changes(None, "{ material.ice.ior = 3 }")), both);
    }

    /// The scene's glass, and a second one.
    fn two_glasses() -> Scene {
        let mut scene = scene::builtin::named("whitted").expect("a built-in scene");
        let glass = scene.materials.iter().find(|material| material.name == "glass").expect("glass").clone();
        scene.materials.push(Material { name: "ice".into(), ..glass });
        scene
    }

    #[test]
    fn glass_with_an_index_of_its_own_keeps_it_and_the_ratio_holds_for_the_others() {
        let scene = two_glasses();
        let seen = |changes: &SceneChanges| {
            let seen = changes.applied_to(&scene).expect("it can be");
            let glass = seen.materials.iter().filter_map(|material| match material.bsdf {
                Bsdf::Dielectric { ior } => Some((material.name.clone(), ior, material.fake.refraction_ratio)),
                _ => None,
            });
            glass.collect::<Vec<_>>()
        };
        let mut changes = SceneChanges { refraction_ratio: Some(0.8), ..SceneChanges::default() };
        let own = ("glass".to_owned(), 1.25, Some(0.8));
        assert_eq!(seen(&changes), [own.clone(), ("ice".into(), 1.25, Some(0.8))]);
        changes.take_edits(&edits("{ material.ice.ior = 2 }"));
        let [glass, ice] = &seen(&changes)[..] else { panic!("two glasses") };
        assert_eq!((glass, ice.1), (&own, 2.0));
        assert_ne!(ice.2, Some(0.8), "the fake's neither");
        let folded =
            SceneChanges { edits: changes.as_edits(&scene).expect("it can be said"), ..SceneChanges::default() };
        let indices = |changes| seen(changes).into_iter().map(|(_, ior, _)| ior).collect::<Vec<_>>();
        assert_eq!(indices(&folded), indices(&changes));
        changes.drop_idle_ratio(&scene);
        assert_eq!(changes.refraction_ratio, Some(0.8));
        changes.take_edits(&edits("{ material.glass.ior = 2 }"));
        changes.drop_idle_ratio(&scene);
        assert_eq!(changes.refraction_ratio, None, "it holds for none");
    }

    #[test]
    fn sliders_said_part_by_part_make_the_same_scene() {
        let scene = scene::builtin::named("whitted").expect("a built-in scene");
        let text = "{ sun.elevation = 30 }";
        let changes = SceneChanges { refraction_ratio: Some(0.75), sun_radius: Some(2.0), edits: edits(text) };
        let all = changes.as_edits(&scene).expect("it can be said");
        let (folded, slid) =
            (all.applied_to(&scene).expect("it can be"), changes.applied_to(&scene).expect("it can be"));
        assert!(folded.sun == slid.sun && folded.shapes == slid.shapes);
        let lobes = |scene: &Scene| scene.materials.iter().map(|material| material.bsdf.clone()).collect::<Vec<_>>();
        assert!(lobes(&folded) == lobes(&slid));
        assert!(all.to_string().contains("ior = 1.3333334"), "{all}");
        let beyond = SceneChanges { refraction_ratio: Some(1000.0), ..SceneChanges::default() };
        let why = beyond.as_edits(&scene).expect_err("no file has it").to_string();
        assert!(why.contains("is 0.001: a file has a number from 0.01 to 100"), "{why}");
    }

    /// Names of parts come from files: they have blanks and quotes of all kinds.
    #[test]
    fn records_and_command_have_the_changes_as_a_shell_takes_them() {
        let mut scene = scene::builtin::named("whitted").expect("a built-in scene");
        scene.materials[0].name = "it's \"a\" \\ b = c".into();
        let mut changes = SceneChanges::default();
        let subject = Subject::Material(scene.materials[0].name.clone());
        let property = subject.property("specular").expect("a row");
        changes.edits.set(&subject, property, Value::Number(0.25));
        let shot = Shot { changes: changes.clone(), ..Shot::of(scene, (4, 4)) };
        let technique = PaneSettings::of(TechniqueName::Raster).in_use();
        let made =
            Provenance { shot: Shot { scene: Arc::clone(&shot.scene), ..shot }, technique, device: crate::Device::Gpu };
        let option = format!("--edit={}", changes.edits);
        let by_command = made_by_command(&made.command(1, 0.0, "a.png")).expect("a command");
        assert!(by_command.options.contains(&option), "{:?}", by_command.options);
        let took = crate::Made { spp: 1, seconds: 1.0, adapter: "", denoised_by: None, exposure: 0.0 };
        let records: Vec<_> = made.records(took).into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        let recorded = made_from(&records).expect("whole records").expect("a picture");
        assert!(recorded.options.contains(&option), "{:?}", recorded.options);
        let again = made_by_command(&recorded.command("b.png")).expect("a command");
        assert!(again.options.contains(&option), "{:?}", again.options);
        assert!(
            made_by_command(&made.shot.reference_command().replace("reference", "render"))
                .is_some_and(|made| made.options.contains(&option))
        );
    }
}
