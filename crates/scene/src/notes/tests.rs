use crate::{Scene, builtin, file};
use std::path::Path;

const ROOM: &str = r#"
[camera]
eye = [0, 1, 5]
target = [0, 1, 0]
fov_y = 45

[sky]
radiance = [1, 1, 1]

[material.white]
diffuse = { albedo = [0.5, 0.5, 0.5] }

[material.glass]
dielectric = { ior = 1.5 }

[material.lamp]
emissive = { radiance = [10, 10, 10] }

[[sphere]]
center = [0, 1, 0]
radius = 1
material = "white"
"#;

fn scene(text: &str) -> Scene {
    file::parse(text, "room", Path::new("room.toml")).unwrap()
}

fn notes_with(from: &str, to: &str) -> Vec<String> {
    assert!(ROOM.contains(from), "{from}");
    scene(&ROOM.replace(from, to)).notes()
}

/// A lamp of this radiance a hand's breadth under a ceiling, its edges as they are named.
fn lamp(edges: [&str; 2], material: &str) -> Vec<String> {
    lamp_under_the_ceiling(0.1, edges, material)
}

fn lamp_under_the_ceiling(gap: f32, edges: [&str; 2], material: &str) -> Vec<String> {
    let [u, v] = edges;
    let ceiling =
        "[[rectangle]]\ncorner = [-5, 3, -5]\nedge_u = [10, 0, 0]\nedge_v = [0, 0, 10]\nmaterial = \"white\"\n";
    let lamp = format!(
        "[[rectangle]]\ncorner = [-0.5, {}, -0.5]\nedge_u = {u}\nedge_v = {v}\nmaterial = \"lamp\"\n",
        3.0 - gap
    );
    scene(&format!("{ROOM}{ceiling}{lamp}").replace("radiance = [10, 10, 10]", material)).notes()
}

#[test]
fn what_is_built_in_is_meant() {
    for name in builtin::names().chain(builtin::hard_names()) {
        assert_eq!(builtin::named(name).unwrap().notes(), [""; 0], "{name}");
    }
    assert_eq!(scene(ROOM).notes(), [""; 0]);
}

#[test]
fn each_doubt_is_one_line_with_its_cure() {
    let cases = [
        ("radiance = [1, 1, 1]", "radiance = [0, 0, 0]", "the scene has no light, so that all is black: add [sky]"),
        ("target = [0, 1, 0]", "target = [0, 1, 10]", "the camera looks past every shape: its eye is [0, 1, 5], its"),
        ("target = [0, 1, 0]", "target = [9, 1, 5]", "lie between [-1, 0, -1] and [1, 2, 1]; write target = [0, 1, 0]"),
        (
            "eye = [0, 1, 5]\ntarget = [0, 1, 0]",
            "eye = [0, 9, 0]\ntarget = [9, 9, 0]",
            "lie between [-1, 0, -1] and [1, 2, 1]; move its eye",
        ),
        ("eye = [0, 1, 5]", "eye = [0, 1, 0.5]", "the camera stands inside the sphere of 'white' around [0, 1, 0]"),
        ("fov_y = 45", "fov_y = 0.785", "fov_y is 0.785: if that is radians, write 45"),
        (
            "[sky]",
            "[sun]\ntowards = [1, -2, 0]\nangular_radius = 1\nirradiance = [1, 1, 1]\n[sky]",
            "shines from below",
        ),
        (
            "[sky]",
            "[[point_light]]\nposition = [0, 1.5, 0]\nintensity = [1, 1, 1]\n[sky]",
            "the point light at [0, 1.5, 0] is inside the sphere of 'white' around [0, 1, 0], which lets no light out",
        ),
        (
            "[sky]",
            "[[sphere]]\ncenter = [0, 1, 0]\nradius = 0.2\nmaterial = \"lamp\"\n[sky]",
            "the lamp, a sphere of 'lamp' around [0, 1, 0], is inside the sphere of 'white'",
        ),
        (
            "[sky]",
            "[[box]]\ncorner = [3, 0, 0]\nsize = [1, 1, 1]\nturn_y = 0.7854\nmaterial = \"white\"\n[sky]",
            "is 0.7854: if that is radians, write 45",
        ),
    ];
    for (from, to, expected) in cases {
        let notes = notes_with(from, to);
        assert!(notes.len() == 1 && notes[0].contains(expected) && notes[0].lines().count() == 1, "{to}: {notes:?}");
    }
    let empty = ROOM.split("[[sphere]]").next().unwrap();
    let [note] = &scene(empty).notes()[..] else { panic!("one note") };
    assert!(note.starts_with("the scene has no shapes: a scene file takes a [[sphere]]") && note.contains("a model"));
}

#[test]
fn a_camera_in_glass_or_in_a_room_with_a_light_is_no_mistake() {
    let inside = ROOM.replace("eye = [0, 1, 5]", "eye = [0, 1, 0.5]");
    assert_eq!(scene(&inside.replace("material = \"white\"", "material = \"glass\"")).notes(), [""; 0]);
    let bulb = "[[sphere]]\ncenter = [0, 1.5, 0]\nradius = 0.1\nmaterial = \"lamp\"\n";
    assert_eq!(scene(&format!("{inside}{bulb}")).notes(), [""; 0]);
}

#[test]
fn a_lamp_that_shines_at_the_ceiling_is_told_and_one_that_shines_down_is_not() {
    let (x, z, bright) = ("[1, 0, 0]", "[0, 0, 1]", "radiance = [10, 10, 10]");
    let up = lamp([z, x], bright);
    assert!(
        up.len() == 1 && up[0].contains("a rectangle of 'lamp' around [0, 2.9, 0], shines at a surface 0.1"),
        "{up:?}"
    );
    assert!(up[0].contains("swap its edge_u and edge_v"), "{up:?}");
    assert!(up[0].contains("is that meant? If not, "), "{up:?}");
    assert_eq!(lamp([x, z], bright), [""; 0]);
    assert!(up[0].contains(" 0.1 away"), "{up:?}");
    assert_eq!(lamp([z, x], &format!("{bright}, two_sided = true")), [""; 0]);
    assert_eq!(lamp([z, x], "radiance = [0, 0, 0]"), [""; 0], "that is no lamp");
}

/// A floor and, over it, a lamp of this shape.
fn lamp_alone(lamp: &str, eye: &str) -> Vec<String> {
    let camera = format!("[camera]\neye = {eye}\ntarget = [0, 0.5, 0]\nfov_y = 45\n");
    let floor = "[[rectangle]]\ncorner = [-5, 0, -5]\nedge_u = [0, 0, 10]\nedge_v = [10, 0, 0]\nmaterial = \"white\"\n";
    let materials = "[material.white]\ndiffuse = { albedo = [0.5, 0.5, 0.5] }\n[material.lamp]\nemissive = { radiance = [9, 9, 9] }\n";
    scene(&format!("{camera}{materials}{floor}{lamp}material = \"lamp\"\n")).notes()
}

#[test]
fn a_lamp_with_nothing_before_it_is_told_wherever_it_hangs() {
    let lamp = |height: f32, edges: [&str; 2]| {
        let [u, v] = edges;
        format!("[[rectangle]]\ncorner = [-0.5, {height}, -0.5]\nedge_u = {u}\nedge_v = {v}\n")
    };
    let (up, down) = (["[0, 0, 1]", "[1, 0, 0]"], ["[1, 0, 0]", "[0, 0, 1]"]);
    let notes = lamp_alone(&lamp(2.9, up), "[0, 1, 5]");
    assert!(notes.len() == 1 && notes[0].contains("around [0, 2.9, 0], shines away from every shape"), "{notes:?}");
    assert!(notes[0].ends_with("swap its edge_u and edge_v, or give its material two_sided = true"), "{notes:?}");
    assert_eq!(lamp_alone(&lamp(2.9, down), "[0, 1, 5]"), [""; 0]);
    let ceiling =
        "[[rectangle]]\ncorner = [-5, 2.9, -5]\nedge_u = [10, 0, 0]\nedge_v = [0, 0, 10]\nmaterial = \"white\"\n";
    let in_the_ceiling = lamp_alone(&format!("{ceiling}{}", lamp(2.9, up)), "[0, 1, 5]");
    assert!(
        in_the_ceiling.len() == 1 && in_the_ceiling[0].contains("shines away from every shape"),
        "{in_the_ceiling:?}"
    );
    let disk = lamp_alone("[[disk]]\ncenter = [0, 2, 0]\nnormal = [0, 1, 0]\nradius = 1\n", "[0, 1, 5]");
    assert!(disk.len() == 1 && disk[0].contains("turn the signs of its normal around"), "{disk:?}");
    assert_eq!(lamp_alone(&lamp(2.9, up), "[0, 8, 5]"), [""; 0], "a panel that is looked at");
}

/// What a scene may well be meant to be.
#[test]
fn what_is_usual_is_not_doubted() {
    let sun =
        |height: f32| format!("[sun]\ntowards = [1, {height}, 0]\nangular_radius = 1\nirradiance = [1, 1, 1]\n[sky]");
    for (from, to) in [
        ("fov_y = 45", "fov_y = 2".to_owned()),
        ("fov_y = 45", "fov_y = 0.5".to_owned()),
        ("fov_y = 45", "fov_y = 0.05".to_owned()),
        ("fov_y = 45", "fov_y = 2.7".to_owned()),
        ("[sky]", sun(0.0)),
        ("[sky]", sun(-1e-7)),
        ("[sky]", sun(-0.08)),
    ] {
        assert_eq!(notes_with(from, &to), [""; 0], "{to}");
    }
    assert_eq!(notes_with("[sky]", &sun(-0.1)).len(), 1);
    assert_eq!(notes_with("fov_y = 45", "fov_y = 2.1").len(), 1);
    let (x, z) = ("[1, 0, 0]", "[0, 0, 1]");
    let indirect = lamp_under_the_ceiling(0.3, [z, x], "radiance = [10, 10, 10]");
    assert_eq!(indirect, [""; 0], "a lamp that lights the room by its ceiling");
}
