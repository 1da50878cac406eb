//! What shapes and lights of a scene file are called.

use super::*;

const LAMPS: &str = "[[point_light]]\nposition = [0, 3, 0]\nintensity = [1, 1, 1]\n";
const FLAG: &str =
    "[[mesh]]\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\ntriangles = [[0, 1, 2]]\nmaterial = \"white\"\n";
const BUST: &str = "[[statue]]\nlevel = 0\nmaterial = \"white\"\n";

fn names_in(more: &str) -> Names {
    let scene = parse(&format!("{SMALL}{more}"), "test", Path::new("test.toml"));
    Names::clone(&scene.unwrap_or_else(|fault| panic!("{fault}")).names)
}

fn ball(name: &str) -> String {
    format!("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"white\"\nname = \"{name}\"\n")
}

#[test]
fn what_has_no_name_is_called_by_its_kind_and_its_number_among_it() {
    let others = "[[rectangle]]\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\nmaterial = \"white\"\n\
                  [[disk]]\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 1\nmaterial = \"white\"\n\
                  [[box]]\ncorner = [0, 0, 0]\nsize = [1, 1, 1]\nmaterial = \"white\"\n";
    let unnamed = ball("").replace("name = \"\"\n", "");
    let names = names_in(&format!("{unnamed}{others}{others}{FLAG}{BUST}{LAMPS}{LAMPS}"));
    assert_eq!(
        names.shapes,
        [
            "sphere 1",
            "sphere 2",
            "rectangle 1",
            "rectangle 2",
            "disk 1",
            "disk 2",
            "box 1",
            "box 2",
            "mesh 1",
            "statue 1"
        ]
    );
    assert_eq!(names.lights, ["light 1", "light 2"]);
}

#[test]
fn names_that_the_file_gives_hold_and_number_instances() {
    let copies = "[[instance]]\nof = \"flag\"\n".repeat(2);
    let named = format!("{FLAG}name = \"flag\"\n{copies}[[instance]]\nof = \"flag\"\nname = \"far/flag\"\n{copies}");
    let names = names_in(&format!("{}{named}{LAMPS}name = \"bulb\"\n{LAMPS}", ball("glass ball")));
    let expected = ["sphere 1", "glass ball", "flag", "flag 2", "flag 3", "far/flag", "flag 5", "flag 6"];
    assert_eq!(
        (names.shapes, names.lights),
        (expected.map(str::to_owned).into(), vec!["bulb".to_owned(), "light 2".to_owned()])
    );
}

#[test]
fn a_name_that_is_given_is_taken_from_what_is_usually_called_so() {
    let more =
        [ball("sphere 1"), ball("sphere 1 (2)"), format!("{FLAG}name = \"sphere\"\n[[instance]]\nof = \"sphere\"\n")];
    let shapes = names_in(&more.concat()).shapes;
    assert_eq!(shapes, ["sphere 1 (3)", "sphere 1", "sphere 1 (2)", "sphere", "sphere 2"]);
}

#[test]
fn names_that_tell_nothing_apart_are_refused() {
    for (more, expected) in [
        (ball("a") + &ball("a"), "test.toml:23:8: a shape is called 'a' already"),
        (ball("flag") + FLAG + "name = \"flag\"\n", "a shape is called 'flag' already"),
        (format!("{LAMPS}name = \"a\"\n{LAMPS}name = \"a\"\n"), "test.toml:21:8: a light is called 'a' already"),
        (ball(" "), "test.toml:18:8: expected a name of 1 to 200 characters in one line"),
        (ball("a\\nb"), "expected a name of 1 to 200 characters in one line"),
        (ball(&"é".repeat(201)), "expected a name of 1 to 200 characters in one line"),
        (ball("a").replace("\"a\"", "3"), "test.toml:18:8: invalid type: integer `3`, expected a string"),
    ] {
        let said = fault_of(&format!("{SMALL}{more}"));
        assert!(said.contains(expected) && said.lines().count() == 1, "{more}: {said}");
    }
    assert_eq!(names_in(&ball(&"é".repeat(200))).shapes[1].chars().count(), 200);
}

#[test]
fn a_model_that_is_opened_by_itself_is_called_as_its_file() {
    let folder = std::env::temp_dir().join(format!("visavis-names-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for (file, expected) in [("rock.obj", "rock"), ("floor.obj", "floor (2)")] {
        std::fs::write(folder.join(file), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let scene = load(&folder.join(file), &Progress::untold()).unwrap();
        assert_eq!(scene.names.shapes, ["floor", expected]);
    }
    std::fs::remove_dir_all(folder).unwrap();
}
