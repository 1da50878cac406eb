use super::*;
use crate::{Bsdf, Geometry, Vec3};
use std::fs;

/// A folder for one test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("visavis-changed-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).expect("a folder");
        Folder(folder)
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(&path, text).expect("a file");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

fn read(text: &str) -> Result<Scene, SceneError> {
    crate::parse(text, "mine", Path::new("mine.toml"))
}

fn fault(text: &str) -> String {
    read(text).expect_err("a fault").to_string()
}

fn load(path: &Path) -> Result<Scene, SceneError> {
    crate::load(path, &Progress::untold())
}

#[test]
fn a_changed_scene_is_its_base_with_what_it_states() {
    let text = "# mine\nbase = \"whitted\"\n[camera]\nfov_y = 20\n[edit.sun]\nangular_radius = 1\n";
    let (base, scene) = (builtin::named("whitted").expect("a built-in scene"), read(text).expect("a scene"));
    assert_eq!(scene.name, "mine");
    assert_eq!((scene.camera.fov_y, scene.camera.eye), (20.0, base.camera.eye));
    assert_eq!(scene.sun.map(|sun| sun.angular_radius), Some(1.0));
    assert_eq!(scene.shapes, base.shapes);
    assert_ne!(scene.as_read, base.as_read);
    assert_eq!(scene.as_read, SceneHash::of(&scene));
    assert_eq!(read("base = \"whitted\"").expect("a scene").as_read, base.as_read, "nothing is changed");
    assert!(read("\u{feff}\n# a remark\n'base' = 'whitted'\nedit = { sun = { elevation = 5 } }").is_ok());
}

#[test]
fn it_is_told_by_what_stands_before_the_first_table() {
    for text in ["base='a'", " base = 'a'\n[x]", "\n# base\n\"base\" = 'a'"] {
        assert!(is_changed(text), "{text}");
    }
    for text in ["", "[camera]\nbase = 1", "# base = 'a'", "basement = 1", "sky = { base = 1 }"] {
        assert!(!is_changed(text), "{text}");
    }
}

#[test]
fn faults_name_the_place_of_the_change() {
    let glass = builtin::named("whitted").expect("a scene").materials;
    let glass = glass.iter().find(|material| matches!(material.bsdf, Bsdf::Dielectric { .. })).expect("glass");
    for (text, said) in [
        ("base = 3", "mine.toml:1:8: invalid type"),
        ("base = \"whited\"", "mine.toml:1:8: unknown scene 'whited'"),
        ("base = \"gone.toml\"", "mine.toml:1:8: cannot read the scene file"),
        ("base = \"a.blend\"", "mine.toml:1:8: a.blend is not a scene"),
        ("base = \"../a.toml\"", "mine.toml:1:8: '../a.toml' lies outside of the scene's folder"),
        (
            "base = \"whitted\"\nsun = 3",
            "mine.toml:2:1: unknown field `sun`, expected one of `base`, `camera`, `edit`; ",
        ),
        ("base = \"whitted\"\n[edits]", "did you mean `edit`?"),
        ("base = \"whitted\"\n[camera]\nnear = 1", "mine.toml:3:1: unknown field `near`"),
        ("base = \"whitted\"\n[camera]\nfov_y = 190", "mine.toml:3:9: the camera sees nothing"),
        ("base = \"whitted\"\n[camera]\neye = [1, 2]", "mine.toml:3:7: expected a list of three numbers"),
        ("base = \"whitted\"\n[edit.sun]\nelevation = 100", "mine.toml:3:13: elevation of the sun: expected a number"),
        ("base = \"whitted\"\n[edit.sun]\nelevatoin = 1", "mine.toml:3:1: 'elevatoin' cannot be changed in the sun"),
        ("base = \"cornell\"\n[edit.sun]\nelevation = 10", "mine.toml:2:7: cornell has no sun"),
        ("base = \"whitted\"\n[edit.material.velvet]\nior = 1", "mine.toml:2:16: whitted has no material 'velvet'"),
        ("base = \"whitted\"\n[edit]\nvariant = \"a\"", "mine.toml:3:1: no variant of whitted is called 'a'"),
        ("base = \"whitted\"\nbase = \"whitted\"", "mine.toml:2:1: duplicate key"),
        ("base = \"whitted\"\n[edit", "mine.toml:2:"),
    ] {
        let line = fault(text);
        assert!(line.contains(said) && line.lines().count() == 1, "{text}: {line}");
    }
    let lobe = format!("base = \"whitted\"\n[edit.material.{}]\nior = 2\n  lobe = \"matt\"", glass.name);
    let line = fault(&lobe);
    assert!(
        line.starts_with("mine.toml:4:3: lobe of material")
            && line.contains("is none: expected one of diffuse, mirror"),
        "{line}"
    );
}

#[test]
fn a_table_of_changes_without_a_base_says_how_such_a_file_begins() {
    let line = fault("[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nfov_y = 30\n[edit.sun]\nelevation = 1");
    assert!(line.contains("a changed scene begins with base = \"NAME\""), "{line}");
}

#[test]
fn what_a_part_does_not_have_is_noted() {
    let scene = read("base = \"cornell-balls\"\n[edit.material.glass]\nroughness = 0.5").expect("a scene");
    assert!(scene.remarks.iter().any(|remark| remark.starts_with("roughness of material 'glass' has no effect")));
}

#[test]
fn a_base_is_a_file_beside_or_below_and_its_faults_have_its_own_place() {
    let folder = Folder::new("files");
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    folder.write("models/a.obj", mesh);
    folder.write("bad.toml", "[camera]\neye = 3");
    let on = |base: &str| {
        load(&folder.write("mine.toml", &format!("base = \"{base}\"\n[edit.sun]\nelevation = 20")))
            .map_err(|why| why.to_string())
    };
    let scene = on("models/a.obj").expect("a scene");
    assert!(scene.sun.is_some_and(|sun| (sun.towards.y - 20f32.to_radians().sin()).abs() < 1e-6));
    let line = on("bad.toml").expect_err("a fault");
    assert!(line.contains("bad.toml:2:7"), "{line}");
    let line = on("models/gone.obj").expect_err("a fault");
    assert!(line.contains("mine.toml:1:8: cannot read"), "{line}");
    assert!(on("../other.toml").expect_err("outside").contains("--allow-outside"));
}

#[test]
fn scenes_that_stand_on_themselves_are_refused_in_a_line_that_names_them() {
    let folder = Folder::new("ring");
    let first = folder.write("a.toml", "base = \"b.toml\"");
    folder.write("b.toml", "base = \"./a.toml\"");
    let line = load(&first).expect_err("a ring").to_string();
    assert!(line.contains("b.toml:1:8: a scene cannot stand on itself: ") && line.matches("stands on").count() == 2);
    let itself = folder.write("c.toml", "base = \"c.toml\"");
    assert!(load(&itself).expect_err("a ring").to_string().contains("c.toml stands on "));
    assert_eq!(flattened(&first, &Progress::untold()), None);
}

#[test]
fn eight_files_stand_on_one_another_at_most() {
    let folder = Folder::new("deep");
    folder.write("1.toml", "base = \"cornell\"");
    let top = |height: usize| {
        let text = |i: usize| format!("base = \"{}.toml\"\n[camera]\nfov_y = {i}", i - 1);
        (2..=height).for_each(|i| _ = folder.write(&format!("{i}.toml"), &text(i)));
        folder.0.join(format!("{height}.toml"))
    };
    let scene = load(&top(8)).expect("a scene");
    assert_eq!(scene.camera.fov_y, 8.0);
    let line = load(&top(9)).expect_err("too many").to_string();
    assert!(line.contains("1.toml:1:8: more than 8 files of changed scenes"), "{line}");
}

#[test]
fn a_file_is_read_as_it_was_written_and_stands_on_the_same_base() {
    let folder = Folder::new("saved");
    let base = builtin::named("whitted").expect("a built-in scene");
    let ball = Subject::Shape(base.shape_name(0).into_owned());
    let first: Edits = format!(
        "{{ shape.\"{}\" = {{ center = [0, 5, 0], scale = 0.5 }}, sun = {{ elevation = 30 }} }}",
        base.shape_name(0)
    )
    .parse()
    .expect("changes");
    let camera = CameraChange { fov_y: Some(33.0), ..CameraChange::default() };
    let saved = to_save("whitted", Some(camera), &first, &Progress::untold());
    assert_eq!(saved.base, "whitted");
    let path = folder.write("first.toml", &saved.text_in(&folder.0));
    assert_eq!(flattened(&path, &Progress::untold()), Some(saved));
    let opened = load(&path).expect("a scene");
    assert_eq!(opened.shapes, first.applied_to(&base).expect("it can be").shapes);

    // once more as large, seen from elsewhere
    let second: Edits = format!("{{ shape.\"{}\" = {{ scale = 3 }} }}", base.shape_name(0)).parse().expect("changes");
    let moved = CameraChange { eye: Some(Vec3::splat(9.0)), ..CameraChange::default() };
    let again = to_save(path.to_str().expect("a text"), Some(moved), &second, &Progress::untold());
    assert_eq!(again.base, "whitted");
    assert_eq!(again.camera, Some(CameraChange { eye: moved.eye, ..camera }));
    let scale = again.edits.get(&ball, ball.property("scale").expect("a row"));
    assert_eq!(scale.and_then(crate::edit::Value::number), Some(1.5));
    let path = folder.write("second.toml", &again.text_in(&folder.0));
    let (twice, then) = (load(&path).expect("a scene"), second.applied_to(&opened).expect("it can be"));
    let radius = |scene: &Scene| match scene.shapes[0].geometry {
        Geometry::Sphere { radius, .. } => radius,
        _ => panic!("a ball"),
    };
    assert!((radius(&twice) / radius(&then) - 1.0).abs() < 1e-6);
}

#[test]
fn what_one_kind_of_material_hands_on_to_the_next_is_kept_in_one_file() {
    let folder = Folder::new("lobes");
    let glass = folder.write("glass.toml", "base = \"cornell\"\n[edit.material.red]\nlobe = \"dielectric\"\n");
    let opened = load(&glass).expect("a scene");
    let matt: Edits = "{ material.red = { lobe = \"diffuse\" } }".parse().expect("changes");
    let saved = to_save(glass.to_str().expect("a text"), None, &matt, &Progress::untold());
    assert_eq!(saved.base, "cornell");
    let path = folder.write("matt.toml", &saved.text_in(&folder.0));
    assert_eq!(load(&path).expect("a scene").materials, matt.applied_to(&opened).expect("it can be").materials);
}

#[test]
fn a_change_that_one_file_cannot_say_stands_on_the_file_that_was_open() {
    let folder = Folder::new("too-large");
    let scaled = |base: &str| format!("base = \"{base}\"\n[edit.shape.\"{}\"]\nscale = 0.001", shape_of("whitted"));
    let small = folder.write("small.toml", &scaled("whitted"));
    let smaller: Edits =
        format!("{{ shape.\"{}\" = {{ scale = 0.5 }} }}", shape_of("whitted")).parse().expect("changes");
    let source = small.to_str().expect("a text");
    let saved = to_save(source, None, &smaller, &Progress::untold());
    assert_eq!((saved.base.as_str(), &saved.edits), (source, &smaller));
    assert!(saved.text_in(&folder.0).contains("\nbase = \"small.toml\"\n"));
}

fn shape_of(scene: &str) -> String {
    builtin::named(scene).expect("a built-in scene").shape_name(0).into_owned()
}

#[test]
fn a_base_outside_of_the_folder_is_said_to_need_leave() {
    let folder = Folder::new("outside");
    let base = folder.write("a.toml", "base = \"cornell\"");
    let scene = ChangedScene { base: base.to_str().expect("a text").into(), camera: None, edits: Edits::default() };
    let text = |below: &str| scene.text_in(&folder.0.join(below));
    fs::create_dir_all(folder.0.join("b")).expect("a folder");
    assert!(text("b").contains("--allow-outside") && text("b").contains("base = \"../a.toml\""));
    assert!(!text("").contains("--allow-outside"));
}

#[test]
fn an_example_stands_on_a_file_beside_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/tests/scenes");
    let [base, scene] = ["everything.toml", "changed.toml"].map(|name| load(&folder.join(name)).expect("a scene"));
    let floor = |scene: &Scene| scene.materials.iter().find(|material| material.name == "floor").cloned();
    assert!(matches!(floor(&scene).map(|floor| floor.bsdf), Some(Bsdf::RoughConductor { roughness: 0.4, .. })));
    assert_eq!(scene.shapes, base.shapes);
    assert_eq!((scene.name.as_str(), scene.remarks.len()), ("changed", 0));
}
