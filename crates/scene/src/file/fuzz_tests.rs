//! Broken files of models and scenes by the thousand, the same in every run: each is read or refused, and soon.

use super::model::{self, MOST_TRIANGLES};
use super::source::Source;
use super::{obj, parse, ply};
use crate::progress::Progress;
use std::path::Path;

/// G. Marsaglia, "Xorshift RNGs", 2003.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }
}

const PIECES: [&[u8]; 12] = [
    b"4294967295",
    b"-1",
    b"nan",
    b"1e999",
    b"\n",
    b" ",
    b"\\",
    b"#",
    b"list uchar",
    b"\xff\xff\xff\xff",
    b"0",
    b"9999999",
];

/// A few bytes changed, put in, taken out or doubled.
fn broken(whole: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len().max(1)).min(bytes.len());
        let end = (at + random.below(20)).min(bytes.len());
        match random.below(5) {
            0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = random.next() as u8),
            1 => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].iter().copied())),
            2 => drop(bytes.drain(at..end)),
            3 => bytes.truncate(at),
            _ => {
                let again = bytes[at..end].to_vec();
                bytes.splice(at..at, again);
            }
        }
    }
    bytes
}

const CUBE: &str =
    "o cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1 4/2/1\nf -1 -2 -3\n";

fn text_ply() -> Vec<u8> {
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n\
      property float ny\nproperty float nz\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
      0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n3 2 1 0\n"
        .to_vec()
}

fn byte_ply(format: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uint uint vertex_indices\nproperty list uchar float extra\nend_header\n"
    )
    .into_bytes();
    (0..9u8).for_each(|i| bytes.extend([0, 0, i, 0]));
    let words: [u32; 4] = [3, 0, 1, 2];
    let big = format.contains("big");
    words.iter().for_each(|word| bytes.extend(if big { word.to_be_bytes() } else { word.to_le_bytes() }));
    bytes.extend([1, 0, 0, 0, 0]);
    bytes
}

/// What was read, if it was, is a mesh whose corners there are; and its lists are no longer than the file allows.
fn check(bytes: &[u8], is_ply: bool) -> bool {
    let progress = Progress::untold();
    let mut source = Source::new(bytes, bytes.len() as u64, "fuzz", &progress);
    let read = if is_ply { ply::read(&mut source) } else { obj::read(&mut source) };
    let Ok(read) = read else { return false };
    assert!(read.positions.capacity() <= 2 * bytes.len() + 8 && read.triangles.capacity() <= 2 * bytes.len() + 8);
    assert!(read.triangles.len() <= MOST_TRIANGLES);
    let Ok((mesh, _)) = model::mesh(read, true) else { return false };
    let corners = mesh.positions().len() as u32;
    assert!(mesh.triangles().iter().flatten().all(|corner| *corner < corners));
    assert!(mesh.positions().iter().all(|position| position.is_finite()));
    assert!([mesh.normals().len(), mesh.uvs().len()].iter().all(|count| [0, corners as usize].contains(count)));
    true
}

#[test]
fn broken_models_are_read_or_refused() {
    let wholes = [
        (text_ply(), true),
        (byte_ply("binary_little_endian"), true),
        (byte_ply("binary_big_endian"), true),
        (CUBE.as_bytes().to_vec(), false),
    ];
    for (seed, (whole, is_ply)) in wholes.iter().enumerate() {
        assert!(check(whole, *is_ply), "the whole file {seed}");
        let mut random = Random(0x9e37_79b9_7f4a_7c15 + seed as u64);
        let read = (0..5000).filter(|_| check(&broken(whole, &mut random), *is_ply)).count();
        assert!((100..4900).contains(&read), "{read} of 5000 broken files were read");
    }
}

const MESHES: &str = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov_y = 45\n[material.a]\ndiffuse = { albedo = [1, 1, 1] }\n\
[[mesh]]\nname = \"one\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\ntriangles = [[0, 1, 2]]\nuvs = [[0, 0], [1, 0], [0, 1]]\n\
normals = [[0, 0, 1], [0, 0, 1], [0, 0, 1]]\nmaterial = \"a\"\n[[statue]]\nlevel = 0\nmaterial = \"a\"\nscale = 0.5\n\
[[instance]]\nof = \"one\"\nscale = [1, -2, 1]\nrotate = [0, 90, 0]\ntranslate = [1, 0, 0]\n";

#[test]
fn broken_scenes_are_read_or_refused_in_one_line() {
    let mut random = Random(0x1234_5678_9abc_def1);
    let mut read = 0;
    for _ in 0..3000 {
        let text = String::from_utf8_lossy(&broken(MESHES.as_bytes(), &mut random)).into_owned();
        match parse(&text, "fuzz", Path::new("fuzz.toml")) {
            Ok(_) => read += 1,
            Err(fault) => assert_eq!(fault.to_string().lines().count(), 1, "{fault}"),
        }
    }
    assert!((30..2900).contains(&read), "{read} of 3000 broken scenes were read");
}

const CHANGED: &str = "base = \"cornell-balls\"\n[camera]\nfov_y = 30\neye = [1, 2, 3]\n[edit]\nsky = { radiance = [0, 1, 0] }\n\
[edit.material.glass]\nior = 1.4\n[edit.material.red]\nlobe = \"rough_conductor\"\nmetal = \"gold\"\nroughness = 0.2\n\
[edit.shape.\"BALL\"]\ncenter = [100, 300, 200]\nscale = 0.5\nhidden = false\n";

#[test]
fn broken_files_of_changed_scenes_are_read_or_refused_in_one_line() {
    let (mut random, mut read) = (Random(0x0f1e_2d3c_4b5a_6978), 0);
    let balls = crate::builtin::named("cornell-balls").expect("a built-in scene");
    let ball = (0..balls.shapes.len()).find(|index| balls.shapes[*index].geometry.kind() == "sphere");
    let whole = CHANGED.replace("BALL", &balls.shape_name(ball.expect("a ball")));
    assert!(parse(&whole, "fuzz", Path::new("fuzz.toml")).is_ok());
    for _ in 0..3000 {
        let text = String::from_utf8_lossy(&broken(whole.as_bytes(), &mut random)).into_owned();
        match parse(&text, "fuzz", Path::new("fuzz.toml")) {
            Ok(_) => read += 1,
            Err(fault) => assert_eq!(fault.to_string().lines().count(), 1, "{fault}"),
        }
    }
    assert!((30..2900).contains(&read), "{read} of 3000 broken files were read");
}
