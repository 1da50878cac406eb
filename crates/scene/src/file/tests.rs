use super::*;
use crate::{Bsdf, Conductor, Geometry};

mod files_read;
mod metallic_roughness;
mod names;
mod spot;

pub(super) const SMALL: &str = r#"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 45

[material.white]
diffuse = { albedo = [0.5, 0.5, 0.5] }

[[sphere]]
center = [0, 0, 0]
radius = 1
material = "white"
"#;

pub(super) fn fault_of(text: &str) -> String {
    parse(text, "test", Path::new("test.toml")).expect_err("a fault").to_string()
}

#[test]
fn built_in_scenes_load() {
    for name in crate::builtin::names() {
        let scene = crate::builtin::named(name).unwrap();
        assert!(!scene.shapes.is_empty());
    }
}

#[test]
fn a_small_scene_has_what_it_says() {
    let scene = parse(SMALL, "small", Path::new("small.toml")).unwrap();
    assert_eq!(scene.shapes[0].geometry, Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 });
    assert_eq!((scene.sun, scene.sky), (None, Vec3::ZERO));
}

/// What is made at random about a normal depends on the sign of its third component.
#[test]
fn zero_is_read_without_a_sign() {
    let text = SMALL.replace("center = [0, 0, 0]", "center = [-0.0, -0, -1e-60]");
    let scene = parse(&text, "small", Path::new("small.toml")).unwrap();
    let Geometry::Sphere { center, .. } = scene.shapes[0].geometry else { panic!("a sphere") };
    assert_eq!(center.to_array().map(f32::to_bits), [0; 3]);
}

#[test]
fn syntax_errors_name_line_and_column() {
    let said = fault_of("[camera\neye = 1");
    assert!(said.starts_with("test.toml:1:"), "{said}");
    assert_eq!(said.lines().count(), 1);
}

#[test]
fn rough_metal_is_read_in_each_of_its_ways_and_no_other() {
    let metal = |text: &str| SMALL.replace("diffuse = { albedo = [0.5, 0.5, 0.5] }", text);
    let read = |text: &str| parse(&metal(text), "test", Path::new("test.toml")).unwrap().materials[0].clone();
    let constant = read("rough_conductor = { reflectance = [0.9, 0.8, 0.5], roughness = 0.5 }");
    let expected = Conductor::Constant(Vec3::new(0.9, 0.8, 0.5));
    assert_eq!(constant.bsdf, Bsdf::RoughConductor { conductor: expected, roughness: 0.5 });
    assert_eq!(constant.fake.shininess, 30.0, "2 / alpha^2 - 2 at alpha 1/4");
    let measured = read("rough_conductor = { eta = [0.1, 1, 2], k = [4, 0, 1], roughness = 1 }");
    let expected = Conductor::Fresnel { eta: Vec3::new(0.1, 1.0, 2.0), k: Vec3::new(4.0, 0.0, 1.0) };
    assert_eq!(measured.bsdf, Bsdf::RoughConductor { conductor: expected, roughness: 1.0 });
    let gold = read("rough_conductor = { metal = \"gold\", roughness = 0.01 }");
    let expected = Conductor::named("gold").unwrap();
    assert_eq!(gold.bsdf, Bsdf::RoughConductor { conductor: expected, roughness: 0.01 });
    let faults = [
        ("{ reflectance = [1, 1, 1], roughness = 0 }", "test.toml:8:58: 0 is not a number from 0.01 to 1"),
        ("{ metal = \"tin\", roughness = 1 }", "test.toml:8:29: no metal is called 'tin': known are gold, silver, "),
        ("{ eta = [1, 1, 1], roughness = 1 }", "expected one of reflectance, eta with k, or metal"),
        ("{ eta = [1, 1, 1], k = [1, 1, 1], metal = \"gold\", roughness = 1 }", "expected one of reflectance, eta "),
        ("{ eta = [0, 1, 1], k = [1, 1, 1], roughness = 1 }", "0 is not a number from 0.01 to 100"),
        ("{ reflectance = [1, 1, 1] }", "missing field `roughness`"),
    ];
    for (lobe, expected) in faults {
        let said = fault_of(&metal(&format!("rough_conductor = {lobe}")));
        assert!(said.contains(expected) && said.lines().count() == 1, "{said}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused_where_they_stand() {
    for bad in ["nan", "inf", "-inf", "1e300"] {
        let said = fault_of(&SMALL.replace("eye = [0, 0, 5]", &format!("eye = [0, {bad}, 5]")));
        assert!(said.starts_with("test.toml:3:11: ") && said.contains("finite number"), "{said}");
    }
}

#[test]
fn ranges_types_and_names_are_checked_where_they_stand() {
    let cases = [
        ("radius = 1", "radius = 0", "test.toml:12:10: 0 is not a finite number from 1e-12 to 1e12"),
        (
            "radius = 1",
            "radius = \"big\"",
            "test.toml:12:10: invalid type: string \"big\", expected a finite number from 1e-12 to 1e12",
        ),
        ("radius = 1", "radios = 1", "test.toml:12:1: unknown field `radios`"),
        (
            "material = \"white\"",
            "material = \"grey\"",
            "test.toml:13:12: no material is called 'grey': the file has white",
        ),
        ("[0.5, 0.5, 0.5]", "[0.5, 1.5, 0.5]", "1.5 is not a number from 0 to 1"),
        ("[0.5, 0.5, 0.5]", "3", "expected a colour [r, g, b] or a checkerboard"),
        (
            "target = [0, 0, 0]",
            "target = [0, 0, 5]",
            "test.toml:4:10: the camera sees nothing: its eye and target must differ",
        ),
        (
            "fov_y = 45",
            "fov_y = 180",
            "test.toml:5:9: the camera sees nothing: its field of view must lie between 0 and 180 degrees",
        ),
        ("fov_y = 45", "fov_y = 45\nup = [0, 0, 2]", "test.toml:6:6: the camera sees nothing: its up must not"),
        ("fov_y = 45", "far = 2\nfov_y = 45\nnear = 3", "test.toml:7:8: the camera sees nothing: its near must be"),
        ("fov_y = 45\n", "", "missing field `fov_y`"),
    ];
    for (from, to, expected) in cases {
        let said = fault_of(&SMALL.replace(from, to));
        assert!(said.contains(expected), "'{to}' said: {said}");
        assert_eq!(said.lines().count(), 1);
    }
}

#[test]
fn edges_whose_squares_f32_does_not_hold_are_refused() {
    let with = |u: &str, v: &str| {
        let edges = format!("corner = [0, 0, 0]\nedge_u = [{u}, 0, 0]\nedge_v = [0, {v}, 0]\n");
        parse(&format!("{SMALL}[[rectangle]]\n{edges}material = \"white\"\n"), "edges", Path::new("edges.toml"))
    };
    for (u, v) in [("1e-20", "1"), ("1", "9e-13"), ("1e-20", "1e-20"), ("0", "1")] {
        let said = with(u, v).expect_err("a fault").to_string();
        assert!(said.starts_with("edges.toml:17:10: ") && said.contains("1e-12 long at least"), "{said}");
    }
    assert!(with("1e-12", "1e12").is_ok());
}

#[test]
fn mesh_corners_out_of_range_are_refused() {
    let mesh = "[[mesh]]\npositions = [[0,0,0],[1,0,0],[0,1,0]]\ntriangles = [[0,1,3]]\nmaterial = \"white\"\n";
    let said = fault_of(&format!("{SMALL}{mesh}"));
    assert!(said.contains("corner 3 is named, but positions has 3"), "{said}");
}

#[test]
fn disks_and_point_lights_are_read() {
    let more = "[[disk]]\ncenter = [0, 2, 0]\nnormal = [0, -2, 0]\nradius = 3\nmaterial = \"white\"\n\
                [[point_light]]\nposition = [1, 2, 3]\nintensity = [4, 5, 6]\n";
    let scene = parse(&format!("{SMALL}{more}"), "more", Path::new("more.toml")).unwrap();
    let disk = Geometry::Disk { center: Vec3::Y * 2.0, normal: -Vec3::Y, radius: 3.0 };
    assert_eq!(scene.shapes[1].geometry, disk);
    let light = PointLight { position: Vec3::new(1.0, 2.0, 3.0), intensity: Vec3::new(4.0, 5.0, 6.0), spot: None };
    assert_eq!(scene.point_lights, [light]);
    assert!(scene.needs().disks && scene.needs().point_lights);
    let said = fault_of(&format!("{SMALL}{}", more.replace("[0, -2, 0]", "[0, 0, 0]")));
    assert!(said.contains("the normal of a disk must not be zero"), "{said}");
}

#[test]
fn overlapping_glass_is_refused_at_the_later_shape() {
    let glass = SMALL.replace("diffuse = { albedo = [0.5, 0.5, 0.5] }", "dielectric = { ior = 1.5 }");
    let second = |x: f32| format!("[[sphere]]\ncenter = [{x}, 0, 0]\nradius = 1\nmaterial = \"white\"\n");
    assert!(parse(&format!("{glass}{}", second(2.0)), "apart", Path::new("apart.toml")).is_ok());
    let said = fault_of(&format!("{glass}{}", second(1.5)));
    assert!(said.starts_with("test.toml:17:12: this glass overlaps the glass around [0, 0, 0]"), "{said}");
}

/// A folder of the test's own, and a picture of two texels in it.
fn folder_with_sky(name: &str, texels: [Vec3; 2]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("visavis-scene-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let picture = film::Image::new(2, 1, texels).unwrap();
    let display = film::DisplayTransform::default();
    let bytes = image_file::encode(image_file::Kind::Exr, &picture, &display, &Vec::new()).unwrap();
    std::fs::write(folder.join("sky.exr"), bytes).unwrap();
    folder
}

#[test]
fn files_that_are_no_scenes_are_refused_with_what_to_do() {
    let folder = folder_with_sky("others", [Vec3::ONE; 2]);
    std::fs::write(folder.join("lecture.toml"), SMALL).unwrap();
    std::fs::write(
        folder.join("wide.toml"),
        "\u{feff}[camera]".encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<_>>(),
    )
    .unwrap();
    for (name, expected) in [
        ("ball.stl", "ball.stl is not a scene: a scene is a text in TOML with camera, materials and lights"),
        ("ball.BLEND", "ball.BLEND is not a scene: "),
        ("wide.toml", "this is not a text in UTF-8"),
        ("", "this is a folder: name a .toml file in it"),
        ("lectrue.toml", "lecture.toml?"),
    ] {
        let said = load(&folder.join(name), &Progress::untold()).expect_err("a fault").to_string();
        assert!(said.contains(expected) && said.lines().count() == 1, "{name}: {said}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_sky_is_a_picture_beside_the_file() {
    let texels = [Vec3::new(1.0, 2.0, 3.0), Vec3::new(3.0, 2.0, 1.0)];
    let folder = folder_with_sky("good", texels);
    let with_sky = |sky: &str| parse(&format!("sky = {sky}\n{SMALL}"), "sky", &folder.join("sky.toml"));
    let scene = with_sky(r#"{ image = "sky.exr", scale = 2, rotation = -30 }"#).unwrap();
    let map = scene.environment.clone().unwrap();
    assert_eq!((map.image().radiances(), map.scale(), map.rotation()), (&texels[..], 2.0, -30.0));
    assert_eq!(scene.sky, Vec3::splat(4.0));
    assert!(scene.needs().sky);
    let plain = with_sky(r#"{ image = "sky.exr" }"#).unwrap().environment.unwrap();
    assert_eq!((plain.scale(), plain.rotation()), (1.0, 0.0));
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn skies_that_are_none_are_refused_in_one_line() {
    let folder = folder_with_sky("bad", [Vec3::ONE, Vec3::new(1.0, f32::NAN, 1.0)]);
    std::fs::write(folder.join("torn.png"), "no picture").unwrap();
    let cases = [
        (r#"image = "none.exr""#, "test.toml:1:17: cannot read the picture ("),
        (r#"image = "torn.png""#, "test.toml:1:17: cannot read the picture ("),
        (r#"image = "sky.jpg""#, "test.toml:1:17: cannot read the picture: its name must end in .png or .exr"),
        (r#"image = "sky.exr""#, "sky.exr: pixel (1, 0) is"),
        (r#"image = "sky.exr", scale = 0"#, "0 is not a finite number above 0"),
        (r#"image = "sky.exr", radiance = [1, 1, 1]"#, "test.toml:1:17: a sky has a radiance or an image, not both"),
        (r#"rotation = 3"#, "test.toml:1:20: only a sky with an image has a scale or a rotation"),
    ];
    for (sky, expected) in cases {
        let text = format!("sky = {{ {sky} }}\n{SMALL}");
        let said = parse(&text, "test", &folder.join("test.toml")).expect_err("a fault").to_string();
        assert!(said.contains(expected) && said.lines().count() == 1, "{sky}: {said}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}

/// A scene with every list that there is, each exactly as long as it must be.
const LISTS: &str = r#"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
up = [0, 1, 0]
fov_y = 45

[material.white]
diffuse = { albedo = [0.5, 0.5, 0.5] }

[material.board]
diffuse = { albedo = { even = [1, 1, 1], odd = [0, 0, 0], origin = [0, 0, 0], cell = [1, 1, 1] } }

[material.mirror]
mirror = { reflectance = [1, 1, 1] }

[material.metal]
rough_conductor = { reflectance = [0.8, 0.8, 0.8], roughness = 0.5 }

[material.copper]
rough_conductor = { eta = [0.2, 0.9, 1], k = [4, 3, 2], roughness = 0.5 }

[material.lamp]
emissive = { radiance = [1, 1, 1] }

[[sphere]]
center = [0, 0, 0]
radius = 1
material = "white"

[[rectangle]]
corner = [0, 0, 0]
edge_u = [1, 0, 0]
edge_v = [0, 1, 0]
material = "white"

[[disk]]
center = [0, 0, 0]
normal = [0, 1, 0]
radius = 1
material = "white"

[[box]]
corner = [0, 0, 0]
size = [1, 1, 1]
material = "white"

[[mesh]]
positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
triangles = [[0, 1, 2]]
material = "white"

[sun]
towards = [0, 1, 0]
angular_radius = 0
irradiance = [1, 1, 1]

[[point_light]]
position = [0, 2, 0]
intensity = [1, 1, 1]

[sky]
radiance = [1, 1, 1]

[fake]
light_position = [1, 1, 1]
"#;

/// Byte ranges of the lists of numbers in a text.
fn lists_of_numbers(text: &str) -> Vec<Range<usize>> {
    let closing = text.match_indices(']').map(|(end, _)| end);
    let opened = closing.filter_map(|end| text[..end].rfind('[').map(|start| start..end + 1));
    // what closes a list of lists finds the last of these, and a comma tells numbers from the name of a table
    opened.filter(|list| text[list.clone()].contains(',') && text[list.clone()].matches(']').count() == 1).collect()
}

#[test]
fn every_list_is_refused_where_it_stands_unless_it_has_three_numbers() {
    assert!(parse(LISTS, "lists", Path::new("lists.toml")).is_ok());
    let lists = lists_of_numbers(LISTS);
    assert_eq!(lists.len(), 31);
    for at in lists {
        let numbers: Vec<&str> = LISTS[at.start + 1..at.end - 1].split(", ").collect();
        let [a, b, c] = numbers[..] else { panic!("{numbers:?}") };
        let (line, column) = line_and_column(LISTS, at.start);
        let expected =
            |length| format!("test.toml:{line}:{column}: expected a list of three numbers, found one of {length}");
        for (list, length) in [
            ("[]".into(), 0),
            (format!("[{a}]"), 1),
            (format!("[{a}, {b}]"), 2),
            (format!("[{a}, {b}, {c}, {c}]"), 4),
            (format!("[{a}, {b}, {c}, \"x\"]"), 4),
            (format!("[{a}, {b}, {c}, [{c}], {{ w = 1 }}]"), 5),
        ] {
            let mut text = LISTS.to_owned();
            text.replace_range(at.clone(), &list);
            assert_eq!(fault_of(&text), expected(length), "{list}");
        }
        for list in [format!("[{a}, {b}, \"x\"]"), format!("[{a}, [{b}], {c}]"), format!("[[{a}, {b}, {c}]]"), a.into()]
        {
            let mut text = LISTS.to_owned();
            text.replace_range(at.clone(), &list);
            let said = fault_of(&text);
            assert!(said.starts_with(&format!("test.toml:{line}:")) && said.contains("expected a"), "{list}: {said}");
        }
    }
}

#[test]
fn a_list_does_not_pass_for_a_table() {
    for (from, to) in [
        ("diffuse = { albedo = [0.5, 0.5, 0.5] }", "diffuse = [[0.5, 0.5, 0.5]]"),
        ("[camera]", "[[camera]]"),
        ("[[sphere]]", "[[fake]]\n[[sphere]]"),
        ("[[sphere]]", "[[material.white.fake]]\n[[sphere]]"),
        ("[camera]", "disk = [[[0, 0, 0], [0, 1, 0], 1, \"white\"]]\n[camera]"),
        ("[camera]", "sky = [[1, 1, 1]]\n[camera]"),
        ("[camera]", "sun = [[0, 1, 0], 0, [1, 1, 1]]\n[camera]"),
    ] {
        let said = fault_of(&SMALL.replace(from, to));
        assert!(said.contains("invalid type: sequence, expected a table of names and values"), "{to}: {said}");
    }
}

#[test]
fn a_mesh_without_triangles_is_refused() {
    let mesh = "[[mesh]]\npositions = [[0, 0, 0]]\ntriangles = []\nmaterial = \"white\"\n";
    let said = fault_of(&format!("{SMALL}{mesh}"));
    assert!(said.starts_with("test.toml:16:13: a mesh needs a triangle at least"), "{said}");
}

#[test]
fn whole_numbers_say_what_they_may_be() {
    for (word, expected) in [
        ("\"x\"", "invalid type: string \"x\", expected a whole number from 3 to 1024"),
        ("4.5", "invalid type: floating point `4.5`, expected a whole number from 3 to 1024"),
        ("[4, 4]", "invalid type: sequence, expected a whole number from 3 to 1024"),
        ("-4", "-4 is not a whole number from 3 to 1024"),
        ("1025", "1025 is not a whole number from 3 to 1024"),
    ] {
        let said = fault_of(&format!("{SMALL}[fake]\nsegments = {word}\n"));
        assert_eq!(said, format!("test.toml:15:12: {expected}"));
    }
}
