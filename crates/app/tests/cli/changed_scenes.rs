//! Pictures whose scene is no longer what it was: what is made of it then is told or refused.

use super::program;
use std::path::Path;
use std::process::Output;
use visavis_tests::TestFolder;

const SCENE: &str = r#"
[camera]
eye = [0, 1, 5]
target = [0, 1, 0]
fov_y = 30
[sky]
image = "sky.png"
[fake]
ambient = 0.25
[material.grey]
diffuse = { albedo = [0.5, 0.5, 0.5] }
[material.shiny]
mirror = { reflectance = [0.8, 0.8, 0.8] }
fake = { reflectivity = 0.5 }
[[sphere]]
center = [0, 1, 0]
radius = 1
material = "grey"
[[rectangle]]
corner = [-2, 0, -2]
edge_u = [0, 0, 4]
edge_v = [4, 0, 0]
material = "shiny"
"#;

/// A folder with the scene above, its sky and a picture of it by Whitted's method, which reads the fake's ambient light.
struct Workplace(TestFolder);

impl Workplace {
    fn new() -> Self {
        let workplace = Workplace(TestFolder::new());
        workplace.write("scene.toml", SCENE);
        workplace.paint_sky([200, 210, 220]);
        for (technique, picture) in [("whitted", "whitted.png"), ("path", "path.exr")] {
            let options = ["--technique", technique, "--size", "8x6", "--spp", "2", "-o", picture];
            workplace.done(&[&["render", "scene.toml"], &options[..]].concat());
        }
        workplace
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.file(name), text).expect("a file");
    }

    fn paint_sky(&self, colour: [u8; 3]) {
        image::RgbImage::from_pixel(2, 1, image::Rgb(colour)).save(self.0.file("sky.png")).expect("a sky");
    }

    fn run_in(&self, folder: &str, arguments: &[&str]) -> Output {
        let mut program = program();
        program.args(arguments).current_dir(self.0.file(folder)).env("VISAVIS_CACHE", self.0.file("store"));
        program.output().expect("the program")
    }

    /// What it says on stderr.
    fn done(&self, arguments: &[&str]) -> String {
        let output = self.run_in("", arguments);
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stderr).into_owned()
    }

    fn refused_in(&self, folder: &str, arguments: &[&str], words: &[&str]) {
        super::assert_failed(arguments, &self.run_in(folder, arguments), 1, words);
    }

    fn again(&self, picture: &str) -> String {
        self.done(&["render", "--from", picture, "-o", "again.exr"])
    }

    fn record(&self, picture: &str, name: &str) -> Option<String> {
        let records = image_file::records(&self.0.file(picture)).expect("records");
        records.into_iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }
}

const CHANGED: &str = "the scene has changed since";

/// Makes the picture of another scene, and measures neither.
fn assert_told(workplace: &Workplace, what: &str) {
    for picture in ["whitted.png", "path.exr"] {
        let told = workplace.again(picture);
        assert!(told.contains(&format!("note: {CHANGED} {picture} was made")), "{what}: {told}");
        workplace.refused_in("", &["compare", picture], &[CHANGED, picture, "scene.toml"]);
        assert_ne!(workplace.record("again.exr", "scene.hash"), workplace.record(picture, "scene.hash"));
    }
}

#[test]
fn what_no_picture_depends_on_may_change_without_a_word() {
    let workplace = Workplace::new();
    // sorted by its name the first material becomes the second, and one that nothing wears the first
    let unused = "[material.aaa]\nmirror = { reflectance = [1, 1, 1] }\n";
    let renamed = SCENE.replace("grey", "white").replace("center = [0, 1, 0]", "center = [-0.0, 1, -0.0]");
    workplace.write("scene.toml", &format!("# a remark\n{renamed}{unused}"));
    for picture in ["whitted.png", "path.exr"] {
        // the options of the command are no changes of the scene
        let other = workplace.done(&["render", "--from", picture, "-o", "other.png", "--fov", "50", "--size", "4x4"]);
        for told in [workplace.again(picture), other, workplace.done(&["compare", picture])] {
            assert!(!told.contains("changed"), "{told}");
        }
        assert_eq!(workplace.record("again.exr", "scene.hash"), workplace.record(picture, "scene.hash"));
    }
    let film = |name: &str| image_file::load(&workplace.0.file(name)).expect("an EXR");
    assert!(film("path.exr") == film("again.exr"));
}

#[test]
fn a_scene_that_has_changed_is_told_and_measures_nothing() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &SCENE.replace("[0.5, 0.5, 0.5]", "[0.5, 0.5, 0.51]"));
    assert_told(&workplace, "a colour");
    workplace.write("scene.toml", SCENE);
    workplace.paint_sky([200, 210, 221]);
    assert_told(&workplace, "the picture of the sky");
}

/// The truth does not see them, and pictures by path tracing are what they were.
#[test]
fn numbers_of_the_fake_that_have_changed_are_told_of_pictures_that_read_them() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &SCENE.replace("ambient = 0.25", "ambient = 0.5"));
    assert!(workplace.again("whitted.png").contains(CHANGED));
    assert!(!workplace.again("path.exr").contains("changed"));
    assert!(workplace.done(&["compare", "whitted.png"]).contains("the fake's numbers have changed since whitted.png"));
    assert!(!workplace.done(&["compare", "path.exr"]).contains("changed"));
}

#[test]
fn a_scene_of_the_same_name_in_another_folder_is_another_scene() {
    let workplace = Workplace::new();
    std::fs::create_dir(workplace.0.file("other")).expect("a folder");
    workplace.refused_in(
        "other",
        &["compare", "../path.exr"],
        &["../path.exr", "folder where it was made", "scene.toml"],
    );
    let again = ["render", "--from", "../path.exr", "-o", "again.exr"];
    workplace.refused_in("other", &again, &["../path.exr", "folder where it was made", "scene.toml"]);
    std::fs::copy(workplace.0.file("sky.png"), workplace.0.file("other/sky.png")).expect("a copy of the sky");
    workplace.write("other/scene.toml", &SCENE.replace("radius = 1", "radius = 0.9"));
    workplace.refused_in("other", &["compare", "../path.exr"], &[CHANGED, "../path.exr", "scene.toml"]);
    // it is the contents that count
    workplace.write("other/scene.toml", SCENE);
    assert!(workplace.run_in("other", &["compare", "../path.exr"]).status.success());
}

#[test]
fn pictures_of_two_scenes_are_compared_with_a_word() {
    let workplace = Workplace::new();
    workplace.write("small.toml", &SCENE.replace("radius = 1", "radius = 0.9"));
    workplace.done(&["render", "small.toml", "--size", "8x6", "--spp", "2", "-o", "small.exr"]);
    assert!(workplace.done(&["compare", "small.exr", "path.exr"]).contains("of two scenes"));
    assert!(!workplace.done(&["compare", "whitted.png", "path.exr"]).contains("of two scenes"));
}

#[test]
fn references_keep_the_scene_and_older_pictures_are_read_without() {
    let workplace = Workplace::new();
    workplace.done(&["reference", "scene.toml", "-o", "reference.exr", "--size", "8x6", "--noise", "1"]);
    assert_eq!(workplace.record("reference.exr", "scene.hash"), workplace.record("path.exr", "scene.hash"));
    let records = [("records", "1"), ("scene", "scene.toml"), ("technique", "path"), ("size", "2x2"), ("spp", "1")];
    let write = |name: &str, more: &[(&'static str, &str)]| {
        let records = records.iter().chain(more).map(|(name, value)| (*name, (*value).to_owned())).collect();
        let bytes = image_file::encode_rgba8(2, 2, &[0; 16], &records).expect("a PNG");
        std::fs::write(workplace.0.file(name), bytes).expect("a file");
    };
    write("old.png", &[]);
    let before = "note: old.png was made before scenes were kept with pictures: whether its scene has changed since";
    assert!(workplace.again("old.png").contains(before));
    let with_its_own_size = ["compare", "old.png", "old.png"];
    for compared in [&["compare", "old.png"][..], &with_its_own_size] {
        let told = workplace.done(compared);
        assert!(told.contains(before), "{told}");
    }
    write("odd.png", &[("scene.hash", "12-34")]);
    workplace.refused_in("", &["compare", "odd.png"], &["odd.png", "scene.hash", "12-34", "damaged"]);
    assert!(Path::new(&workplace.0.file("again.exr")).is_file());
}
