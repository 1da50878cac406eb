//! Meshes of scene files: written out, read from files, made by the program, named and put in their places.

use super::tests::{SMALL, fault_of};
use super::*;
use crate::{Geometry, Instance, Mesh};
use glam::Vec2;

const MESH: &str = "[[mesh]]\nname = \"flag\"\npositions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\ntriangles = [[0, 1, 2]]\nmaterial = \"white\"\n";

fn scene_with(more: &str) -> Scene {
    let read = parse(&format!("{SMALL}{more}"), "meshes", Path::new("meshes.toml"));
    read.unwrap_or_else(|fault| panic!("{fault}"))
}

fn mesh_of(scene: &Scene, shape: usize) -> &Mesh {
    scene.shapes[shape].geometry.mesh_of().expect("a mesh")
}

/// A folder of the test's own, which goes with it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("visavis-meshes-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Folder(folder)
    }

    fn with(self, name: &str, content: &str) -> Self {
        std::fs::write(self.0.join(name), content).unwrap();
        self
    }

    fn parse(&self, more: &str) -> Result<Scene, SceneError> {
        parse(&format!("{SMALL}{more}"), "meshes", &self.0.join("meshes.toml"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn written_meshes_have_normals_and_places_in_textures() {
    let attributes = "normals = [[0, 0, 2], [0, 0, 1], [0, 0, 1]]\nuvs = [[0, 0], [1, 0], [0, 0.5]]\n";
    let scene = scene_with(&format!("{MESH}{attributes}"));
    assert_eq!(mesh_of(&scene, 1).normals(), [Vec3::Z; 3]);
    assert_eq!(mesh_of(&scene, 1).uvs(), [Vec2::ZERO, Vec2::X, Vec2::new(0.0, 0.5)]);
    assert_eq!(mesh_of(&scene_with(&format!("{MESH}smooth = true\n")), 1).normals(), [Vec3::Z; 3]);
    assert!(mesh_of(&scene_with(MESH), 1).normals().is_empty());
}

#[test]
fn instances_share_their_mesh_and_stand_where_they_say() {
    let scene = scene_with(&format!(
        "{MESH}translate = [0, 0, -1]\n[[instance]]\nof = \"flag\"\nscale = 2\nrotate = [0, 90, 0]\ntranslate = [1, 2, 3]\n"
    ));
    let instance = |shape: usize| match &scene.shapes[shape].geometry {
        Geometry::Instance(instance) => instance.clone(),
        other => panic!("{other:?}"),
    };
    let (Instance { mesh, to_world }, again) = (instance(1), instance(2));
    assert!(Arc::ptr_eq(&mesh, &again.mesh));
    assert_eq!(to_world.transform_point3(Vec3::ONE), Vec3::new(1.0, 1.0, 0.0));
    // about y, from x to -z
    assert!((again.to_world.transform_point3(Vec3::X) - Vec3::new(1.0, 2.0, 1.0)).length() < 1e-6);
    assert_eq!(scene.shapes[2].material, scene.shapes[1].material);
}

#[test]
fn turns_go_about_x_then_y_then_z() {
    let scene = scene_with(&format!("{MESH}rotate = [90, 90, 0]\n"));
    let Geometry::Instance(instance) = &scene.shapes[1].geometry else { panic!("an instance") };
    // y to z about x, and on to x about y
    assert!((instance.to_world.transform_point3(Vec3::Y) - Vec3::X).length() < 1e-6);
}

#[test]
fn statues_of_a_level_are_one_mesh() {
    let statue = |x: f32| format!("[[statue]]\nlevel = 2\nmaterial = \"white\"\ntranslate = [{x:?}, 0, 0]\n");
    let scene = scene_with(&format!("{}{}", statue(1.0), statue(2.0)));
    assert_eq!(mesh_of(&scene, 1).triangles().len(), 128);
    let [one, another] = [1, 2].map(|shape: usize| scene.shapes[shape].geometry.mesh_of().expect("a mesh"));
    assert!(Arc::ptr_eq(one, another));
}

#[test]
fn faulty_meshes_are_refused_where_they_stand() {
    let statue = "[[statue]]\nlevel = 12\nmaterial = \"white\"\n";
    for (more, expected) in [
        ("[[mesh]]\nmaterial = \"white\"\n".into(), "test.toml:14:1: expected positions and triangles, or file = "),
        (format!("{MESH}file = \"a.ply\"\n"), "test.toml:14:1: expected positions and triangles, or file = "),
        (format!("{MESH}uvs = [[0, 0]]\n"), "test.toml:19:7: uvs has 1 elements, but positions has 3"),
        (format!("{MESH}uvs = [[0, 0, 0]]\n"), "expected a list of two numbers, found one of 3"),
        (format!("{MESH}normals = [[0, 0, 0], [0, 0, 1], [0, 0, 1]]\n"), "test.toml:19:11: a normal must not be zero"),
        (format!("{MESH}scale = 0\n"), "0 is not a finite number from 1e-12 to 1e12, or its negative"),
        (format!("{MESH}scale = [1, 0, 1]\n"), "0 is not a finite number from 1e-12 to 1e12, or its negative"),
        (format!("{MESH}scale = \"big\"\n"), "expected a number or a list of three numbers"),
        (
            format!("{MESH}translate = [9e11, 0, 0]\nscale = 2e11\n"),
            "test.toml:18:12: this mesh reaches farther than 1e12",
        ),
        (
            format!("{MESH}[[instance]]\nof = \"flag\"\ntranslate = [0, 1e12, 0]\nscale = 1e11\n"),
            "test.toml:20:6: this mesh reaches farther than 1e12 from 0: make scale or translate smaller",
        ),
        (format!("{MESH}{MESH}"), "test.toml:20:8: a shape is called 'flag' already"),
        (
            format!("{MESH}[[instance]]\nof = \"flog\"\n"),
            "no mesh and no statue is called 'flog': the file has flag; did you",
        ),
        (
            "[[instance]]\nof = \"x\"\n".into(),
            "no mesh and no statue is called 'x': none has a name; write name = \"x\"",
        ),
        (statue.into(), "12 is not a whole number from 0 to 11"),
    ] {
        let said = fault_of(&format!("{SMALL}{more}"));
        assert!(said.contains(expected) && said.lines().count() == 1, "{more}: {said}");
    }
}

const TRIANGLE: &str = "g a\ng b\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn files_are_read_from_beside_the_scene_and_nowhere_else() {
    let folder = Folder::new("beside").with("a.obj", TRIANGLE).with("b.OBJ", "v 0 0 0\nf 1 1 2\n").with("c.stl", "");
    let mesh = |file: &str| format!("[[mesh]]\nfile = \"{file}\"\nmaterial = \"white\"\n");
    let scene = folder.parse(&mesh("a.obj")).expect("a scene");
    assert_eq!(mesh_of(&scene, 1).positions(), [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(scene.notes()[0], "a.obj: its 2 groups are one mesh of one material");
    let smooth = folder.parse(&format!("{}smooth = true\n", mesh("a.obj"))).expect("a scene");
    assert_eq!(mesh_of(&smooth, 1).normals(), [Vec3::Z; 3]);
    for (file, expected) in [
        ("b.OBJ", "meshes.toml:15:8: "),
        ("b.OBJ", "b.OBJ, line 2: face 1 names vertex '2', of 1 so far, from 1"),
        ("c.stl", "c.stl: a mesh is read from a .ply or an .obj"),
        ("e.GLB", "e.GLB: a glTF model is a scene of its own: `visavis e.GLB` opens it"),
        ("d.ply", "d.ply: it cannot be read ("),
        ("../a.obj", "meshes.toml:15:8: '../a.obj' lies outside of the scene's folder"),
        ("/a.obj", "'/a.obj' lies outside of the scene's folder"),
    ] {
        let said = folder.parse(&mesh(file)).expect_err(file).to_string();
        assert!(said.contains(expected) && said.lines().count() == 1, "{file}: {said}");
    }
    let sky = "sky = { image = \"../sky.exr\" }\n";
    let said = parse(&format!("{sky}{SMALL}"), "sky", Path::new("sky.toml")).expect_err("a fault").to_string();
    assert!(said.starts_with("sky.toml:1:17: '../sky.exr' lies outside of the scene's folder"), "{said}");
}

#[test]
fn a_model_that_is_opened_by_itself_stands_in_sight_on_a_floor() {
    let folder = Folder::new("showcase")
        .with("far.obj", &TRIANGLE.replace("v 0", "v 1000"))
        .with("dot.obj", "v 0 0 0\nf 1 1 1\n");
    let open = |name: &str| load(&folder.0.join(name), &Progress::untold());
    let scene = open("far.obj").expect("a scene");
    assert_eq!((scene.name.as_str(), scene.shapes.len(), scene.as_read), ("far", 2, SceneHash::of(&scene)));
    assert_eq!(scene.notes(), ["far.obj: its 2 groups are one mesh of one material"]);
    assert!(
        open("dot.obj")
            .expect_err("a fault")
            .to_string()
            .ends_with("dot.obj: it is too small, too large or too far away to be seen")
    );
    assert!(matches!(open("none.ply"), Err(SceneError::Read { .. })));
}

#[test]
fn a_scene_is_read_no_further_when_it_is_told_so() {
    let stopped = |text: &str| {
        let progress = Progress::new(&|_, _| false);
        parse_telling(&format!("{SMALL}{text}"), "stopped", Path::new("stopped.toml"), &progress)
    };
    let statue = "[[statue]]\nlevel = 11\nmaterial = \"white\"\n";
    assert!(matches!(stopped(statue), Err(SceneError::Stopped)));
    assert!(stopped(MESH).is_ok(), "nothing that takes long");
}

#[test]
fn copies_of_small_meshes_have_a_bound_and_those_of_large_ones_none() {
    let scene = |level: u32, count: usize| {
        let statue = format!("[[statue]]\nname = 's'\nlevel = {level}\nmaterial = 'white'\n");
        let instance = "[[instance]]\nof = 's'\ntranslate = [1, 0, 0]\n".repeat(count);
        parse(&format!("{SMALL}{statue}{instance}"), "many", Path::new("many.toml"))
    };
    // of 2,048 triangles each
    let said = scene(4, 2049).unwrap_err().to_string();
    assert!(said.contains("have more than 4194304 triangles together"), "{said}");
    assert!(scene(4, 2048).is_ok() && scene(5, 2049).is_ok());
}
