use super::*;
use crate::progress::Progress;

const SQUARE: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty double y\n\
                      property int z\nproperty uchar red\nproperty float s\nproperty float t\nelement edge 1\n\
                      property int vertex1\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n\
                      0 0 0 255 0 0\n1 0 0 255 1 0\n1 1.5 -0 9 1 1\n0 1 0 9 0 1\n7\n4 0 1 2 3\n";

fn read_bytes(bytes: &[u8]) -> Result<Model, ModelFault> {
    let progress = Progress::untold();
    read(&mut Source::new(bytes, bytes.len() as u64, "test.ply", &progress))
}

fn fault_of(text: &str) -> String {
    let ModelFault { at, message } = read_bytes(text.as_bytes()).expect_err("a fault");
    format!("{at}: {message}")
}

/// The square of [`SQUARE`] with normals, as bytes.
fn binary(format: &str, swapped: bool) -> Vec<u8> {
    let header = format!(
        "ply\r\nformat {format} 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty double y\r\nproperty short z\r\n\
         property list uint8 int16 extra\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\n\
         element face 1\r\nproperty char flag\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
    );
    let mut bytes = header.into_bytes();
    let mut put = |little: &[u8]| {
        let in_order =
            |bytes: &mut Vec<u8>| if swapped { bytes.extend(little.iter().rev()) } else { bytes.extend(little) };
        in_order(&mut bytes);
    };
    for [x, y] in [[0f32, 0.0], [1.0, 0.0], [1.0, 1.5], [0.0, 1.0]] {
        put(&x.to_le_bytes());
        put(&f64::from(y).to_le_bytes());
        put(&0i16.to_le_bytes());
        put(&[1]);
        put(&(-7i16).to_le_bytes());
        [0f32, 0.0, 2.0].iter().for_each(|n| put(&n.to_le_bytes()));
    }
    put(&[1]);
    put(&[4]);
    (0..4i32).for_each(|corner| put(&corner.to_le_bytes()));
    bytes
}

fn square() -> Vec<Vec3> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.5], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec()
}

#[test]
fn text_is_read_with_all_its_types_and_the_rest_is_named() {
    let model = read_bytes(SQUARE.as_bytes()).expect("a model");
    assert_eq!((model.positions, model.triangles), (square(), vec![[0, 1, 2], [0, 2, 3]]));
    assert_eq!(model.uvs, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(Vec2::from));
    assert!(model.normals.is_empty());
    assert_eq!(model.remarks, ["not read of its vertices: red", "not read of it: edge"]);
}

#[test]
fn bytes_are_read_in_either_order() {
    for (format, swapped) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let model = read_bytes(&binary(format, swapped)).expect(format);
        assert_eq!((model.positions, model.triangles), (square(), vec![[0, 1, 2], [0, 2, 3]]), "{format}");
        assert_eq!(model.normals, [2.0 * Vec3::Z; 4]);
    }
}

#[test]
fn faults_say_where_and_what() {
    for (from, to, expected) in [
        ("ply\n", "PLY\n", ": this is no PLY file: its first line is not 'ply'"),
        ("ascii", "morse", "line 2: expected 'format' with ascii"),
        ("property int z", "property long z", "line 7: 'long' is no type"),
        ("property int z", "property int height", ": its vertices have no x, y and z"),
        ("element vertex 4", "element vertex many", "line 4: expected how many there are of 'vertex'"),
        ("element vertex 4", "element vertex 100000000", ": its header says that there are 100000000 of 'vertex', for"),
        (
            "element face 1",
            "element face 99999999999999999999",
            ": its header says that there are 18446744073709551615",
        ),
        ("end_header\n", "", "line 15: '0' is no word of a PLY header"),
        ("1 1.5 -0", "1 nan -0", "line 18: vertex 2 is [1.0, NaN, -0.0]: coordinates are finite"),
        ("1 1.5 -0", "1 1e13 -0", "line 18: vertex 2 is [1.0, 10000000000000.0"),
        ("1 1.5 -0", "1 one -0", "line 18: 'one' is no number"),
        ("4 0 1 2 3", "4 0 1 2 4", "face 0 names vertex 4, of 4 from 0"),
        ("4 0 1 2 3", "4 0 1 2 -1", "face 0 names vertex -1, of 4 from 0"),
        ("4 0 1 2 3", "4 0 1 2 0.5", "face 0 names vertex 0.5, of 4 from 0"),
        ("4 0 1 2 3", "4294967296 0 1 2 3", "a list of 4294967296: the file is too short"),
        ("4 0 1 2 3", "-4 0 1 2 3", "a list of -4: the file is too short for that, or it is no length"),
        ("4 0 1 2 3\n", "4 0 1 2", "line 21: a list of 4: the file is too short"),
        ("4 0 1 2 3\n", "4 0 1 02", "the file ends here, before all that its header names"),
        ("element face 1\nproperty list uchar uint vertex_indices\n", "", ": it has no faces, only points"),
        ("vertex_indices", "corners", ": its faces have no list vertex_indices"),
    ] {
        let text = SQUARE.replace(from, to);
        assert_ne!(text, SQUARE, "{from}");
        let said = fault_of(&text);
        assert!(said.contains(expected), "{to}: {said}");
    }
}

#[test]
fn faces_of_two_corners_are_left_out_and_counted() {
    let model = read_bytes(SQUARE.replace("face 1", "face 2").replace("4 0 1 2 3", "2 0 1\n3 0 1 2").as_bytes());
    let model = model.expect("a model");
    assert_eq!(model.triangles, [[0, 1, 2]]);
    assert!(model.remarks.contains(&"1 of its faces have fewer than three corners, and are left out".to_owned()));
}

#[test]
fn reading_ends_when_it_is_told_to() {
    let hear = |what: &str, _: f32| what != "reading test.ply";
    let progress = Progress::new(&hear);
    let read = read(&mut Source::new(SQUARE.as_bytes(), SQUARE.len() as u64, "test.ply", &progress));
    assert!(read.is_err() && progress.is_stopped());
}

#[test]
fn more_vertices_than_fit_and_strips_are_refused_by_their_names() {
    let vertices = "ply\nformat ascii 1.0\nelement vertex COUNT\nproperty float x\n";
    let faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let many = fault_of(&format!("{vertices}{faces}").replace("COUNT", "134217729"));
    assert_eq!(many, ": more than 134217728 vertices: more are not read; thin it out in a modeller");
    let strips = "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    let strips = fault_of(&format!("{vertices}{strips}").replace("COUNT", "3"));
    assert!(strips.contains("strips (tristrips), which are not read: save it with faces"), "{strips}");
}
