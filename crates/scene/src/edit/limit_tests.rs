//! Changes at the edge of what may be: each is made, or refused in a line, and what comes of it is a scene that a file
//! could hold.

use super::tests::{edits, scene, subjects};
use super::*;
use crate::material::Emission;
use crate::{Bsdf, Conductor, Geometry, Instance, Material, Mesh, Shape, Texture, Vec3, builtin, limits};
use glam::Affine3A;
use std::path::Path;
use std::sync::Arc;

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
        (self.next() % count.max(1) as u64) as usize
    }

    fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// Of any size, seldom none of a scene at all.
    fn number(&mut self) -> f32 {
        const EDGES: [f32; 14] = [
            0.0,
            -0.0,
            1.0,
            1e-12,
            1e12,
            -1e12,
            1e-3,
            1e3,
            0.01,
            90.0,
            f32::MIN_POSITIVE,
            f32::MAX,
            f32::NAN,
            f32::INFINITY,
        ];
        match self.below(4) {
            0 => *self.of(&EDGES),
            1 => self.below(2000) as f32 - 1000.0,
            _ => (self.next() % 1001) as f32 / 1000.0,
        }
    }

    /// Mostly what the property may be.
    fn value(&mut self, scene: &Scene, property: &Property) -> Value {
        if self.below(12) == 0 {
            return match self.below(3) {
                0 => Value::Number(self.number()),
                1 => Value::Word("no \"such\\ \n word".into()),
                _ => Value::Triple(Vec3::new(self.number(), self.number(), self.number())),
            };
        }
        let triple = |random: &mut Self| Vec3::new(random.number(), random.number(), random.number());
        match &property.kind {
            Kind::Number { range, shown, .. } => match self.below(5) {
                0 => Value::Number(*range.start()),
                1 => Value::Number(*range.end()),
                _ => Value::Number(shown.start() + (shown.end() - shown.start()) * self.below(1001) as f32 / 1000.0),
            },
            Kind::Colour | Kind::Light | Kind::Point | Kind::Turn => Value::Triple(triple(self)),
            Kind::Word => {
                let words = (property.words)(scene);
                Value::Word(if words.is_empty() { String::new() } else { self.of(&words).clone() })
            }
            Kind::Flag => Value::Flag(self.below(4) == 0),
        }
    }
}

const EXTREME: &str = r#"
[camera]
eye = [0, 0, 5]
target = [0, 0, 0]
fov_y = 45
[sun]
towards = [0, 1, 0]
angular_radius = 0
irradiance = [1e12, 0, 0]
[fake]
light_position = [1e12, 1e12, -1e12]
[[point_light]]
position = [1e12, 0, -1e12]
intensity = [0, 1e12, 0]
spot = { towards = [0, -1, 0], inner = 0, outer = 180 }
[material.glass]
dielectric = { ior = 1e12 }
[material.lamp]
emissive = { radiance = [1e12, 0, 0] }
[material.metal]
rough_conductor = { eta = [0.01, 100, 1], k = [100, 0, 1], roughness = 0.01 }
[material.coated]
metallic_roughness = { base_colour = { even = [1, 1, 1], odd = [0, 0, 0], origin = [0, 0, 0], cell = [1, 0, 1] }, metallic = 1, roughness = 0 }
[[sphere]]
center = [0, 0, 0]
radius = 1e-12
material = "glass"
[[sphere]]
center = [1e11, 0, 0]
radius = 8e10
material = "glass"
[[rectangle]]
corner = [-1e12, 0, -1e12]
edge_u = [0, 0, 1e12]
edge_v = [1e12, 0, 1e7]
material = "metal"
[[rectangle]]
corner = [1e12, 0, 0]
edge_u = [1e-12, 0, 0]
edge_v = [0, 1e-12, 0]
material = "coated"
[[disk]]
center = [0, 1, 0]
normal = [1e-12, 0, 1]
radius = 1e12
material = "lamp"
[[box]]
corner = [-1e12, -1e12, -1e12]
size = [1e-12, 1e12, 1]
turn_y = 1e12
material = "metal"
[[mesh]]
name = "flag"
positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, -1e6]]
triangles = [[0, 1, 2], [1, 2, 3]]
material = "coated"
[[instance]]
of = "flag"
scale = [1e-12, -1e-12, 1e-12]
rotate = [10, 20, 30]
[[instance]]
of = "flag"
scale = [1e5, -1, 1]
translate = [0, -1e12, 0]
"#;

fn is_share(v: Vec3) -> bool {
    v.cmpge(Vec3::ZERO).all() && v.cmple(Vec3::ONE).all()
}

fn is_light(v: Vec3) -> bool {
    v.cmpge(Vec3::ZERO).all() && v.cmple(Vec3::splat(1e12)).all()
}

/// Whether a file could hold it.
fn is_within_limits(material: &Material) -> bool {
    let texture = |texture: &Texture| match texture {
        Texture::Constant(colour) => is_share(*colour),
        Texture::Checkerboard(board) => is_share(board.even) && is_share(board.odd),
        Texture::Image { factor, .. } => is_share(*factor),
    };
    let lobe = match &material.bsdf {
        Bsdf::Diffuse { albedo } => texture(albedo),
        Bsdf::Mirror { reflectance } => is_share(*reflectance),
        Bsdf::RoughConductor { conductor, roughness } => {
            let constant = if let Conductor::Constant(reflectance) = conductor { is_share(*reflectance) } else { true };
            constant && (0.01..=1.0).contains(roughness)
        }
        Bsdf::MetallicRoughness(model) => {
            texture(&model.base_colour)
                && [model.metallic, model.roughness].iter().all(|share| (0.0..=1.0).contains(share))
                && (1.0..=100.0).contains(&model.ior)
        }
        Bsdf::Dielectric { ior } => *ior > 0.0 && *ior <= 1e12 && material.emission.is_none(),
    };
    let fake = material.fake;
    lobe && material.emission.is_none_or(|Emission { radiance, .. }| is_light(radiance))
        && [fake.specular, fake.reflectivity].iter().all(|share| (0.0..=1.0).contains(share))
        && fake.shininess > 0.0
        && fake.shininess <= 1e12
        && fake.refraction_ratio.is_none_or(|ratio| ratio > 0.0 && ratio <= 1e12)
}

/// What of a scene no file could hold.
fn fault_of(before: &Scene, scene: &Scene) -> Option<String> {
    // what was there before may reach as far as files allow
    let stays = |shape: &Shape| before.shapes.iter().any(|old| old.geometry == shape.geometry);
    let far = scene.shapes.iter().filter(|shape| !stays(shape)).find_map(|shape| limits::beyond(&shape.geometry));
    let unit = |v: Vec3| (v.length() - 1.0).abs() < 1e-4;
    let disk = scene.shapes.iter().all(|shape| match shape.geometry {
        Geometry::Disk { normal, .. } => unit(normal),
        _ => true,
    });
    let worn = scene.shapes.iter().all(|shape| shape.material < scene.materials.len());
    let material = scene.materials.iter().find(|material| !is_within_limits(material));
    let sun = scene
        .sun
        .is_none_or(|sun| unit(sun.towards) && (0.0..90.0).contains(&sun.angular_radius) && is_light(sun.irradiance));
    let lights = scene.point_lights.iter().all(|light| {
        let spot = light.spot.is_none_or(|spot| spot.inner >= 0.0 && spot.inner < spot.outer && spot.outer <= 180.0);
        light.position.abs().max_element() <= 1e12 && is_light(light.intensity) && spot
    });
    let place = scene.fake.light_position.is_none_or(|place| place.abs().max_element() <= 1e12);
    let facts = [
        ("disk", disk),
        ("worn", worn),
        ("sun", sun),
        ("lights", lights),
        ("place", place),
        ("sky", is_light(scene.sky)),
    ];
    far.map(str::to_owned)
        .or(material.map(|material| format!("{material:?}")))
        .or(facts.iter().find(|(_, holds)| !holds).map(|(what, _)| (*what).to_owned()))
}

#[test]
fn whatever_is_changed_is_refused_in_a_line_or_a_scene_that_a_file_could_hold() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let extreme = crate::parse(EXTREME, "extreme", Path::new("extreme.toml")).expect("a scene");
    let small = builtin::names().filter(|name| *name != "statues").chain(builtin::hard_names());
    let scenes: Vec<Scene> = small.map(scene).chain(std::iter::repeat_n(extreme, 10)).collect();
    let (mut made, mut refused) = (0, 0);
    for _ in 0..6000 {
        let scene = random.of(&scenes);
        let subjects = subjects(scene);
        let mut edits = Edits::default();
        for _ in 0..1 + random.below(5) {
            let subject = random.of(&subjects);
            let property = random.of(subject.properties());
            edits.set(subject, property, random.value(scene, property));
        }
        match edits.applied_to(scene) {
            Ok(edited) => {
                assert_eq!(fault_of(scene, &edited), None, "{}: {edits}", scene.name);
                made += 1;
            }
            Err(why) => {
                assert_eq!(why.to_string().lines().count(), 1, "{why}");
                refused += 1;
            }
        }
        // what can be written down is read as the same
        let text = edits.to_string();
        let fits = edits.iter().all(|(subject, values)| {
            values.iter().all(|(name, value)| subject.property(name).is_some_and(|property| property.kind.holds(value)))
        });
        assert_eq!(text.parse::<Edits>().ok(), fits.then(|| edits.clone()), "{text}");
    }
    assert!(made > 1000 && refused > 1000, "{made} made, {refused} refused");
}

fn with_shape(geometry: Geometry) -> (Scene, Subject) {
    let cornell = scene("cornell");
    let shapes = cornell.shapes.iter().cloned().chain([Shape { geometry, material: 0 }]).collect();
    let scene = Scene { shapes, ..cornell };
    let subject = Subject::Shape(scene.shape_name(scene.shapes.len() - 1).into_owned());
    (scene, subject)
}

fn slab() -> Geometry {
    Geometry::mesh(vec![Vec3::ZERO, Vec3::X * 3.0, Vec3::Y, Vec3::new(4.0, 1.0, 2.0)], vec![[0, 1, 2], [1, 2, 3]])
}

#[test]
fn a_turned_shape_keeps_the_middle_that_is_asked_for() {
    let Geometry::Mesh(mesh) = slab() else { unreachable!("a mesh") };
    let to_world = Affine3A::from_scale(Vec3::new(2.0, -1.0, 0.5));
    for geometry in [
        slab(),
        Geometry::Instance(Instance { mesh, to_world }),
        Geometry::Rectangle { corner: Vec3::ONE, edge_u: Vec3::X, edge_v: Vec3::new(0.5, 0.0, 3.0) },
        Geometry::Disk { center: Vec3::ONE, normal: Vec3::Y, radius: 2.0 },
    ] {
        let (scene, subject) = with_shape(geometry);
        let (center, turn) = (Vec3::new(5.0, -7.0, 1e4), Vec3::new(20.0, 130.0, -70.0));
        let turned = edits(&[
            (subject.clone(), "turn", Value::Triple(turn)),
            (subject.clone(), "center", Value::Triple(center)),
            (subject.clone(), "scale", Value::Number(0.3)),
        ]);
        let turned = turned.applied_to(&scene).expect("it can be");
        let row = subject.property("center").expect("a row");
        let index = subject.index_in(&turned).expect("it is there");
        let reached = (row.get)(&turned, index).and_then(|value| value.triple()).expect("a point");
        assert!((reached - center).abs().max_element() < 1e-3, "{reached}");
    }
}

#[test]
fn shapes_do_not_leave_what_a_file_may_hold() {
    let thin = Geometry::Box { corner: Vec3::ZERO, size: Vec3::new(1.0, 1e-10, 1.0), turn_y: 0.0 };
    let (scene, subject) = with_shape(thin);
    let scaled = |by: f32| edits(&[(subject.clone(), "scale", Value::Number(by))]).applied_to(&scene);
    assert!(scaled(0.02).is_ok());
    let why = scaled(0.001).expect_err("too thin").to_string();
    assert_eq!(why, format!("{subject} would be smaller than 1e-12"));
    let (scene, subject) = with_shape(Geometry::Sphere { center: Vec3::ZERO, radius: 1e6 });
    let far = edits(&[(subject, "center", Value::Triple(Vec3::splat(1e12)))]).applied_to(&scene);
    assert!(far.expect_err("too far").to_string().ends_with("would reach farther than 1e12 from 0"));
}

#[test]
fn a_far_shape_is_no_reason_to_refuse_the_change_of_another() {
    let far = Geometry::Sphere { center: Vec3::X * 1e12, radius: 1e12 };
    let (scene, _) = with_shape(far);
    let other = Subject::Shape(scene.shape_name(0).into_owned());
    assert!(edits(&[(other, "center", Value::Triple(Vec3::ONE))]).applied_to(&scene).is_ok());
}

#[test]
fn what_code_sets_is_looked_at_as_what_a_text_says() {
    let scene = scene("cornell-balls");
    let glass = Subject::Material("glass".into());
    for value in [Value::Number(f32::NAN), Value::Number(-1.0), Value::Word("thick".into()), Value::Flag(true)] {
        let why = edits(&[(glass.clone(), "ior", value)]).applied_to(&scene).expect_err("no index").to_string();
        assert_eq!(why, "ior of material 'glass': expected a number from 0.01 to 100");
    }
    let why =
        edits(&[(glass, "lobe", Value::Word("difuse".into()))]).applied_to(&scene).expect_err("no lobe").to_string();
    assert!(why.contains("'difuse' is none") && why.ends_with("; did you mean 'diffuse'?"), "{why}");
    let ball = Subject::Shape(scene.shape_name(0).into_owned());
    let why =
        edits(&[(ball, "material", Value::Word("glas".into()))]).applied_to(&scene).expect_err("none").to_string();
    assert!(why.ends_with("; did you mean 'glass'?"), "{why}");
}

#[test]
fn small_meshes_that_are_moved_are_as_few_as_a_file_may_copy() {
    let corners: Vec<Vec3> = (0..4090).map(|i| Vec3::new(i as f32, (i % 2) as f32, 0.0)).collect();
    let mesh = Arc::new(Mesh::new(corners, (0..4088).map(|i| [i, i + 1, i + 2]).collect()));
    let cornell = scene("cornell");
    let count = Mesh::MOST_COPIED as usize / 4088;
    let instance = Instance { mesh: mesh.clone(), to_world: Affine3A::from_translation(Vec3::X) };
    let instances = std::iter::repeat_n(Geometry::Instance(instance), count);
    let geometries = instances.chain([Geometry::Mesh(mesh)]);
    let scene = Scene { shapes: geometries.map(|geometry| Shape { geometry, material: 0 }).collect(), ..cornell };
    let last = Subject::Shape(scene.shape_name(count).into_owned());
    let why = edits(&[(last, "scale", Value::Number(2.0))]).applied_to(&scene).expect_err("too many").to_string();
    assert!(why.contains("4194304 triangles together at most"), "{why}");
}

/// Glass meshes of many corners that all cross glass balls: what is looked at is bounded, whatever there is.
#[test]
fn of_large_glass_no_more_is_looked_at_than_a_slider_has_time_for() {
    let corner = |i: i32| Vec3::new(0.0, (i as f32).sin(), (i as f32).cos());
    let mesh = Arc::new(Mesh::new((0..100_000).map(corner).collect(), vec![[0, 1, 2]]));
    let glass =
        Material { bsdf: Bsdf::Dielectric { ior: 1.5 }, emission: None, ..scene("cornell").materials[0].clone() };
    let at = |i: usize| Affine3A::from_translation(Vec3::X * if i == 19 { 0.5 } else { 1e-3 * i as f32 });
    let meshes = (0..20).map(|i| Geometry::Instance(Instance { mesh: mesh.clone(), to_world: at(i) }));
    // holds every corner, but no box around a mesh
    let ball = Geometry::Sphere { center: Vec3::ZERO, radius: 1.3 };
    let shapes = meshes.chain([ball]).map(|geometry| Shape { geometry, material: 0 }).collect();
    let scene = Scene { shapes, materials: vec![glass], ..scene("cornell") };
    let ball = Subject::Shape(scene.shape_name(20).into_owned());
    let smaller = |by: f32| edits(&[(ball.clone(), "scale", Value::Number(by))]).applied_to(&scene);
    assert!(smaller(0.85).is_ok(), "it crosses the last mesh, which is not looked at any more");
    // what is found early is refused
    let why = smaller(0.5).expect_err("they cross").to_string();
    assert!(why.contains("would overlap other glass"), "{why}");
}

#[test]
fn glass_that_overlapped_before_may_go_on_to() {
    let cornell = scene("cornell");
    let glass = Material { bsdf: Bsdf::Dielectric { ior: 1.5 }, ..cornell.materials[0].clone() };
    let ball = |x: f32| Geometry::Sphere { center: Vec3::X * x, radius: 1.0 };
    let shapes = [0.0, 1.5, 9.0].map(|x| Shape { geometry: ball(x), material: 0 });
    let scene = Scene { shapes: shapes.into(), materials: vec![glass], ..cornell };
    let moved = |index: usize, x: f32| {
        let subject = Subject::Shape(scene.shape_name(index).into_owned());
        edits(&[(subject, "center", Value::Triple(Vec3::X * x))]).applied_to(&scene)
    };
    assert!(moved(1, 1.2).is_ok() && moved(2, 20.0).is_ok());
    assert!(moved(2, 3.0).is_err() && moved(1, 8.0).is_err());
}

#[test]
fn a_sky_does_not_become_brighter_than_a_file_allows() {
    let image = film::Image::new(2, 1, vec![Vec3::splat(1e7), Vec3::ZERO]).expect("a picture");
    let map = crate::EnvironmentMap::new(image, 1.0, 0.0).expect("a sky");
    let scene = Scene { sky: map.mean(), environment: Some(Arc::new(map)), ..scene("cornell") };
    let strong = |by: f32| edits(&[(Subject::Sky, "strength", Value::Number(by))]).applied_to(&scene);
    assert!(strong(1e5).is_ok_and(|scene| scene.sky == Vec3::splat(5e11)));
    assert!(strong(1e6).expect_err("too bright").to_string().contains("more than 1e12"));
}
