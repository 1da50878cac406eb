use super::*;
use crate::progress::Progress;

fn read_text(text: &str) -> Result<Model, ModelFault> {
    let progress = Progress::untold();
    read(&mut Source::new(text.as_bytes(), text.len() as u64, "test.obj", &progress))
}

fn model(text: &str) -> Model {
    read_text(text).unwrap_or_else(|ModelFault { at, message }| panic!("{at}: {message}"))
}

const CORNERS: &str = "# a square\nv 0 0 0\nv 1 0 0 1 # w\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\n";

#[test]
fn polygons_become_fans_from_either_end_of_the_list() {
    for face in ["f 1 2 3 4", "f -4 -3 -2 -1", "f 1 2 \\\n 3 4", "f\t1  2 3 4\r"] {
        let model = model(&format!("{CORNERS}{face}\n"));
        assert_eq!((model.positions.len(), &model.triangles[..]), (4, &[[0, 1, 2], [0, 2, 3]][..]), "{face}");
        assert!(model.normals.is_empty() && model.uvs.is_empty() && model.remarks.is_empty());
    }
}

#[test]
fn a_corner_with_two_normals_becomes_two() {
    let attributes = "vn 0 0 1\nvn 0 1 0\nvt 0.25 0\nvt 1 1\n";
    let model = model(&format!("{CORNERS}{attributes}f 1/1/1 2/2/1 3/1/1\nf 1/1/2 3/1/2 4/1/2\nf 1/1/1 3/1/1 4/2/1\n"));
    assert_eq!(model.triangles, [[0, 1, 2], [3, 4, 5], [0, 2, 6]]);
    assert_eq!(model.normals[..4], [Vec3::Z, Vec3::Z, Vec3::Z, Vec3::Y]);
    assert_eq!(model.uvs[..2], [Vec2::new(0.25, 1.0), Vec2::new(1.0, 0.0)]);
    assert_eq!((model.positions[3], model.positions[6]), (Vec3::ZERO, Vec3::Y));
}

#[test]
fn faces_with_and_without_attributes_go_together() {
    let uv = "vt 1 1\n";
    let mixed = model(&format!("{CORNERS}{uv}f 2 3 4\nf 2 4 1/1\n"));
    let corners = |model: &Model| -> Vec<[Vec3; 3]> {
        model.triangles.iter().map(|t| t.map(|corner| model.positions[corner as usize])).collect()
    };
    assert_eq!(corners(&mixed), corners(&model(&format!("{CORNERS}f 2 3 4\nf 2 4 1\n"))));
    assert_eq!(mixed.remarks, ["corners without texture coordinates have 0, 0"]);
    let without = model(&format!("{CORNERS}vn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\n"));
    assert!(without.normals.is_empty());
    assert_eq!(without.remarks, ["normals are left out: not all of its faces have some"]);
}

#[test]
fn what_is_passed_over_is_named_in_a_line() {
    let text = format!("mtllib a.mtl\no one\ng two\nusemtl red\ns 1\n{CORNERS}f 1 2 3\nl 1 2\nf 1 2\n");
    assert_eq!(
        model(&text).remarks,
        [
            "its 2 groups are one mesh of one material",
            "not read of it: l, mtllib, usemtl",
            "1 of its faces have fewer than three corners, and are left out"
        ]
    );
}

#[test]
fn faults_say_which_line() {
    for (line, expected) in [
        ("f 1 2 5", "line 6: face 1 names vertex '5', of 4 so far, from 1"),
        ("f 0 1 2", "line 6: face 1 names vertex '0', of 4 so far, from 1"),
        ("f 1 2 -5", "names vertex '-5', of 4"),
        ("f 1 2 99999999999999999999", "names vertex '99999999999999999999', of 4"),
        ("f 1 2 3/1", "names texture coordinate '1', of 0"),
        ("f 1 2 3//1", "names normal '1', of 0"),
        ("f 1 2 3////", "'3////' is no corner"),
        ("f 1 2 x", "names vertex 'x'"),
        ("v 1 2", "line 6: v: expected 3 numbers, found nothing"),
        ("v 1 2 three", "line 6: v: expected 3 numbers, found 'three'"),
        ("v 1 inf 3", "line 6: vertex 5 is [1.0, inf, 3.0]"),
        ("vt nan", "line 6: vt: expected one or two finite numbers"),
        ("vn 1", "line 6: vn: expected 3 numbers, found nothing"),
    ] {
        let ModelFault { at, message } = read_text(&format!("{CORNERS}{line}\n")).expect_err(line);
        let said = format!("{at}: {message}");
        assert!(said.contains(expected), "{line}: {said}");
    }
}

#[test]
fn more_vertices_than_fit_are_refused_in_their_line() {
    let progress = Progress::untold();
    let source = Source::new(&b""[..], 0, "test.obj", &progress);
    assert!(bounded(&source, "normals", MOST_VERTICES).is_ok());
    let ModelFault { at, message } = bounded(&source, "normals", MOST_VERTICES + 1).expect_err("too many");
    assert_eq!((at.as_str(), message.split(':').next()), ("line 1", Some("more than 134217728 normals")));
}
