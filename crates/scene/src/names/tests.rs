use super::*;
use crate::builtin;

fn names(shapes: &[&str]) -> Vec<String> {
    Names::new(shapes.iter().map(|name| (*name).to_owned()).collect(), Vec::new()).shapes
}

#[test]
fn names_that_repeat_are_told_apart_and_those_that_do_not_stay() {
    assert_eq!(names(&["a", "a", "b", "a"]), ["a", "a (2)", "b", "a (3)"]);
    assert_eq!(names(&["a", "a", "a (2)", "a (2)"]), ["a", "a (3)", "a (2)", "a (2) (2)"]);
    assert_eq!(names(&["", "", "unnamed"]), ["unnamed", "unnamed (2)", "unnamed (3)"]);
}

/// The square of their number would take hours; so would trying each number anew where all of them are taken.
#[test]
fn a_million_equal_names_are_told_apart_in_the_time_of_one_each() {
    let many = 1 << 20;
    let equal = Names::new(vec!["ball".to_owned(); many], Vec::new()).shapes;
    assert_eq!(equal[many - 1], format!("ball ({many})"));
    let half = many / 2;
    let taken = (2..=half).map(|number| format!("ball ({number})"));
    let hostile: Vec<String> = taken.chain(vec!["ball".to_owned(); half]).collect();
    let apart = Names::new(hostile.clone(), Vec::new()).shapes;
    assert_eq!(apart[..half], hostile[..half]);
    assert_eq!(apart.iter().collect::<HashSet<_>>().len(), apart.len());
}

#[test]
fn every_part_of_a_built_in_scene_has_a_name_of_its_own() {
    for name in builtin::names().chain(builtin::hard_names()) {
        let scene = builtin::named(name).unwrap();
        let named = (scene.names.shapes.len(), scene.names.lights.len());
        assert_eq!(named, (scene.shapes.len(), scene.point_lights.len()), "{name}");
        for names in [&scene.names.shapes, &scene.names.lights] {
            assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len(), "{name}: {names:?}");
        }
    }
}

#[test]
fn names_are_no_part_of_what_a_picture_depends_on() {
    for name in builtin::names().chain(builtin::hard_names()) {
        let (scene, text) = (builtin::named(name).unwrap(), builtin::text(name).unwrap());
        let is_a_name = |line: &&str| line.starts_with("name = ") && !text.contains(&line.replace("name = ", "of = "));
        let unnamed: Vec<&str> = text.lines().filter(|line| !is_a_name(line)).collect();
        assert!(unnamed.len() < text.lines().count(), "{name} names nothing");
        let unnamed = crate::parse(&unnamed.join("\n"), name, std::path::Path::new(name)).unwrap();
        assert_ne!(unnamed.names, scene.names, "{name}");
        assert_eq!(unnamed.as_read, scene.as_read, "{name}");
    }
}
