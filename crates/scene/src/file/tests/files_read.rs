use super::SMALL;
use crate::{FileRead, Progress, load};
use std::path::{Path, PathBuf};

const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str, files: &[(&str, &[u8])]) -> Self {
        let folder = Folder(std::env::temp_dir().join(format!("visavis-files-read-{}-{name}", std::process::id())));
        std::fs::create_dir_all(&folder.0).unwrap();
        files.iter().for_each(|(name, bytes)| folder.write(name, bytes));
        folder
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.0.join(name), bytes).unwrap();
    }

    /// The names of the files that this one is read from, and how they were; whether or not it is a scene.
    fn read(&self, name: &str) -> (Vec<String>, Vec<FileRead>) {
        let progress = Progress::untold();
        let _ = load(&self.0.join(name), &progress);
        let name = |path: &Path| path.strip_prefix(&self.0).unwrap().display().to_string();
        let files = progress.files();
        (files.iter().map(|file| name(&file.path)).collect(), files)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn picture() -> Vec<u8> {
    image_file::encode_rgba8(1, 1, &[9; 4], &Vec::new()).unwrap()
}

#[test]
fn a_changed_scene_is_read_from_all_that_its_base_names() {
    let base = format!(
        "{SMALL}[material.picture]\ndiffuse = {{ albedo = {{ image = 'p.png' }} }}\nalpha_mask = {{ texture = {{ image = 'p.png' }} }}\n\
         [[mesh]]\nfile = 'm.ply'\nmaterial = 'picture'\n[sky]\nimage = 'sky.png'\n"
    );
    let files: [(&str, &[u8]); 5] = [
        ("own.toml", b"base = 'base.toml'\n"),
        ("base.toml", base.as_bytes()),
        ("p.png", &picture()),
        ("m.ply", TRIANGLE.as_bytes()),
        ("sky.png", &picture()),
    ];
    let folder = Folder::new("changed", &files);
    let (names, read) = folder.read("own.toml");
    assert_eq!(names, files.map(|(name, _)| name));
    for (file, (name, bytes)) in read.iter().zip(files) {
        assert!(!file.has_changed(), "{name}");
        folder.write(name, &[bytes, b"\n"].concat());
        assert!(file.has_changed(), "{name}");
    }
}

#[test]
fn a_faulty_scene_is_read_from_the_files_up_to_its_fault_those_that_are_missing_too() {
    let text = format!("{SMALL}[[mesh]]\nfile = 'gone.ply'\nmaterial = 'white'\n[sky]\nimage = 'sky.png'\n");
    let folder = Folder::new("faulty", &[("a.toml", text.as_bytes())]);
    let (names, read) = folder.read("a.toml");
    assert_eq!(names, ["a.toml", "gone.ply"]);
    assert!(read[1].stamp.is_none() && !read[1].has_changed());
    folder.write("gone.ply", TRIANGLE.as_bytes());
    assert!(read[1].has_changed(), "one that comes has changed");
    assert_eq!(folder.read("a.toml").0, ["a.toml", "gone.ply", "sky.png"]);
}

#[test]
fn a_model_is_read_from_its_buffers_and_pictures_too() {
    let json = r#"{ "asset": { "version": "2.0" }, "buffers": [{ "uri": "b%20c.bin", "byteLength": 4 }],
        "images": [{ "uri": "p.png" }, { "uri": "data:image/png;base64,AAAA" }, { "uri": "../out.png" }] }"#;
    let folder = Folder::new("model", &[("m.gltf", json.as_bytes()), ("only.ply", TRIANGLE.as_bytes())]);
    assert_eq!(folder.read("m.gltf").0, ["m.gltf", "b c.bin", "p.png"]);
    assert_eq!(folder.read("only.ply").0, ["only.ply"]);
}
