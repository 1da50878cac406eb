//! Surfaces that are far away, lie in one another, touch, or lie in the sides of a pattern's cells: what rounding decides
//! if nothing else does. Each place has a closed form, and is looked at through whatever structure a machine has.

use crate::area_lights::{direct, from_above, shadow_rays};
use crate::dielectrics::{to_depth, without_roulette};
use crate::hard::{known, spot, with_geometry};
use crate::measure::{Trial, farthest, subject};
use pathtrace::{Estimator, Integrator, PathSettings, Tracer};
use scene::glam::{EulerRot, Quat};
use scene::material::Checkerboard;
use scene::{Bsdf, Camera, Geometry, Scene, Shape, Texture, Vec3};

/// What is looked at, and what must be seen.
pub struct Place {
    pub what: String,
    pub expected: f64,
    pub scene: Scene,
    pub camera: Camera,
}

/// Centres of lamps of radius 1e-3 over the floor.
const FAR: [[f32; 3]; 4] = [[600.0, 0.0, 800.0], [577.35, 577.35, 577.35], [60.0, 0.0, 80.0], [0.0, 0.0, 3000.0]];

/// Pixels a side and samples of pictures of them: of so many none may be lost.
pub const FAR_PICTURE: (u32, u32) = (16, 64);

/// Lamps so far away that rounding is as large as they.
pub fn far_lamps() -> Vec<Place> {
    let place = |center: Vec3| {
        let scene = with_geometry(known("far-lamp"), |index, geometry| {
            if index == 0 {
                *geometry = Geometry::Sphere { center, radius: 1e-3 };
            }
        });
        let distance = center.as_dvec3().length();
        let expected = 0.5e12 * (f64::from(1e-3f32) / distance).powi(2) * f64::from(center.z) / distance;
        Place { what: format!("lamp at {center}"), expected, scene, camera: from_above(0.0, 0.0, 0.5) }
    };
    FAR.map(Vec3::from).map(place).into()
}

/// The share of a cosine-weighted hemisphere that a rectangle fills, of these half sides, over the point below its middle.
fn overhead([a, b]: [f64; 2], height: f64) -> f64 {
    let half = |a: f64, b: f64| {
        let reach = a.hypot(height);
        a / reach * (b / reach).atan()
    };
    2.0 / std::f64::consts::PI * (half(a, b) + half(b, a))
}

/// Height of lamps over the floor, and half sides of those that cross.
const HEIGHT: f32 = 2.0;
const CROSSING: [f32; 2] = [1.0, 0.2];

/// A rectangle over the origin that shines down.
fn rectangle([a, b]: [f32; 2]) -> Geometry {
    Geometry::Rectangle { corner: Vec3::new(-a, -b, HEIGHT), edge_u: Vec3::Y * 2.0 * b, edge_v: Vec3::X * 2.0 * a }
}

/// Two lamps over the floor that have area in common, and the radiance below them.
fn pairs() -> Vec<(&'static str, [Geometry; 2], f64)> {
    let [a, b] = CROSSING.map(f64::from);
    let height = f64::from(HEIGHT);
    let disk = |radius: f32| Geometry::Disk { center: Vec3::Z * HEIGHT, normal: -Vec3::Z, radius };
    let ball = Geometry::Sphere { center: Vec3::Z * HEIGHT, radius: 0.4 };
    let block =
        Geometry::Box { corner: Vec3::new(-a as f32, -b as f32, HEIGHT), size: Vec3::new(2.0, 0.4, 1.0), turn_y: 0.0 };
    let mesh = |geometry: &Geometry| {
        let (positions, triangles) = geometry.flat_triangles();
        Geometry::mesh(positions.into_owned(), triangles.into_owned())
    };
    let one = rectangle(CROSSING);
    let of_one = overhead([a, b], height);
    let of_cross = 2.0 * of_one - overhead([b, b], height);
    let of_disk = |radius: f64| radius * radius / (radius * radius + height * height);
    let of_ball = (f64::from(0.4f32) / height).powi(2);
    vec![
        ("crossing rectangles", [one.clone(), rectangle([CROSSING[1], CROSSING[0]])], of_cross),
        ("a rectangle twice", [one.clone(), one.clone()], of_one),
        ("a mesh twice", [mesh(&one), mesh(&one)], of_one),
        ("a box on a rectangle", [one.clone(), block], of_one),
        ("a disk twice", [disk(0.5), disk(0.5)], of_disk(0.5)),
        ("a rectangle within a disk", [one, disk(1.5)], of_disk(1.5)),
        ("a ball twice", [ball.clone(), ball], of_ball),
    ]
}

/// Lamps that lie in one another, upright and turned, so that rounding moves each of them.
pub fn coinciding_lamps() -> Vec<Place> {
    let mut places = Vec::new();
    for (what, lamps, share) in pairs() {
        for turned in [false, true] {
            let mut scene = known("crossing-lamps");
            let (mut shapes, lamp) = (scene.shapes.to_vec(), scene.shapes[1].material);
            shapes.truncate(1);
            shapes.extend(lamps.clone().map(|geometry| Shape { geometry, material: lamp }));
            scene.shapes = shapes.into();
            let (how, camera) = (if turned { ", turned" } else { "" }, from_above(0.0, 0.0, 0.5));
            let place = Place { what: format!("{what}{how}"), expected: 5.0 * share, scene, camera };
            if !turned {
                places.push(place);
            } else if !matches!(lamps[1], Geometry::Box { .. }) {
                places.push(turn(place));
            }
        }
    }
    places
}

/// All of a place turned about the origin.
fn turn(place: Place) -> Place {
    let by = Quat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.8);
    let scene = with_geometry(place.scene, |_, geometry| match geometry {
        Geometry::Sphere { center, .. } => *center = by * *center,
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            [corner, edge_u, edge_v].into_iter().for_each(|v| *v = by * *v);
        }
        Geometry::Disk { center, normal, .. } => [center, normal].into_iter().for_each(|v| *v = by * *v),
        Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_) => {
            let (positions, triangles) = geometry.flat_triangles();
            let positions = positions.iter().map(|p| by * *p).collect();
            *geometry = Geometry::mesh(positions, triangles.into_owned());
        }
    });
    let Camera { eye, target, up, .. } = place.camera;
    let camera = Camera { eye: by * eye, target: by * target, up: by * up, ..place.camera };
    Place { scene, camera, ..place }
}

/// Small balls below the floor, where nobody sees them: so many that a tree is worth its while.
pub fn among_many(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let material = scene.shapes[0].material;
    let ball = |i: u32| {
        let center = Vec3::new(i as f32 % 13.0 * 3.0, (i / 13) as f32 * 3.0, -100.0);
        Shape { geometry: Geometry::Sphere { center, radius: 0.5 }, material }
    };
    scene.shapes = scene.shapes.iter().cloned().chain((0..150).map(ball)).collect();
    scene
}

/// A glass ball on a mirror, along the axis through the point of contact: upright, turned, and moved far away.
pub fn contacts() -> Vec<Place> {
    let expected = {
        let (reflected, mirror) = (0.04, 0.5);
        let passed: f64 = 1.0 - reflected;
        let below = reflected + passed * passed * mirror / (1.0 - reflected * mirror);
        reflected + passed * passed * below / (1.0 - reflected * below)
    };
    let upright = |by: Vec3| {
        let scene = with_geometry(known("ball-on-mirror"), |_, geometry| match geometry {
            Geometry::Sphere { center, .. } => *center += by,
            Geometry::Rectangle { corner, .. } => *corner += by,
            _ => {}
        });
        let camera = spot(by + Vec3::Z * 5.0, by);
        Place { what: format!("contact at {by}"), expected, scene, camera }
    };
    let changed = |what: &str, change: &dyn Fn(&mut Geometry)| {
        let place = upright(Vec3::ZERO);
        Place { what: what.into(), scene: with_geometry(place.scene, |_, geometry| change(geometry)), ..place }
    };
    let ball_into = |glass: Geometry| {
        move |geometry: &mut Geometry| {
            if let Geometry::Sphere { .. } = geometry {
                *geometry = glass.clone();
            }
        }
    };
    let block = Geometry::Box { corner: Vec3::new(-1.0, -1.0, 0.0), size: Vec3::new(2.0, 2.0, 1.5), turn_y: 0.0 };
    let (positions, triangles) = block.flat_triangles();
    let prism = Geometry::mesh(positions.into_owned(), triangles.into_owned());
    let disk = Geometry::Disk { center: Vec3::ZERO, normal: Vec3::Z, radius: 4.0 };
    let on_a_disk = |geometry: &mut Geometry| {
        if let Geometry::Rectangle { .. } = geometry {
            *geometry = disk.clone();
        }
    };
    vec![
        upright(Vec3::ZERO),
        upright(Vec3::new(100.0, -200.0, 300.0)),
        Place { what: "contact, turned".into(), ..turn(upright(Vec3::ZERO)) },
        changed("contact with a disk", &on_a_disk),
        changed("a block of glass on the mirror", &ball_into(block)),
        changed("a mesh of glass on the mirror", &ball_into(prism.clone())),
        Place { what: "a mesh of glass on the mirror, turned".into(), ..turn(changed("", &ball_into(prism))) },
    ]
}

/// Scatterings after which what goes on between ball and mirror brings less than 2e-5; each two double the branches.
pub const CONTACT_DEPTH: u32 = 14;

/// Inside a glass ball at nine tenths of its radius, looking along its wall.
pub fn galleries() -> Vec<Place> {
    let place = |far: f32| {
        let center = Vec3::splat(far);
        let scene = with_geometry(known("whispering-gallery"), |_, geometry| {
            *geometry = Geometry::Sphere { center, radius: 1.0 };
        });
        let eye = center + Vec3::X * 0.9;
        let camera = spot(eye, eye + Vec3::Y * 0.5);
        Place { what: format!("ball at {far}"), expected: 0.0, scene, camera }
    };
    [0.0, 10.0, 1000.0].map(place).into()
}

/// Floors of so many cells of triangles a side: few enough for a list, and too many.
const CELLS: [u32; 2] = [5, 17];

/// A floor of triangles in a plane between two layers of a pattern's cells, under a sky of 1: one cell, one colour, as of
/// a floor that is one rectangle, seen from either side, or a disk.
pub fn boards() -> Vec<Place> {
    let mut places = Vec::new();
    for height in [1.0, 0.3] {
        places.extend(
            CELLS.map(|cells| board_of(&format!("{} triangles", 2 * cells * cells), height, triangles(cells, height))),
        );
        let corner = Vec3::new(-5.0, height, -5.0);
        let up = Geometry::Rectangle { corner, edge_u: Vec3::Z * 10.0, edge_v: Vec3::X * 10.0 };
        let down = Geometry::Rectangle { corner, edge_u: Vec3::X * 10.0, edge_v: Vec3::Z * 10.0 };
        let disk = Geometry::Disk { center: Vec3::Y * height, normal: Vec3::Y, radius: 5.0 };
        places.extend(
            [("a rectangle", up), ("a rectangle from behind", down), ("a disk", disk)]
                .map(|(what, shape)| board_of(what, height, shape)),
        );
    }
    places
}

/// A level grid of triangles.
fn triangles(cells: u32, height: f32) -> Geometry {
    let corner = |i: u32| -5.0 + 10.0 * i as f32 / cells as f32;
    let positions = (0..=cells).flat_map(|j| (0..=cells).map(move |i| Vec3::new(corner(i), height, corner(j))));
    let cell = |j: u32, i: u32| {
        let a = j * (cells + 1) + i;
        [[a, a + cells + 1, a + 1], [a + 1, a + cells + 1, a + cells + 2]]
    };
    let triangles = (0..cells).flat_map(|j| (0..cells).flat_map(move |i| cell(j, i)));
    Geometry::mesh(positions.collect(), triangles.collect())
}

fn board_of(what: &str, height: f32, geometry: Geometry) -> Place {
    let mut scene = known("white-furnace");
    scene.shapes = [Shape { geometry, material: 0 }].into();
    let board =
        Checkerboard { even: Vec3::splat(0.8), odd: Vec3::splat(0.2), origin: Vec3::ZERO, cell: Vec3::splat(height) };
    scene.materials[0].bsdf = Bsdf::Diffuse { albedo: Texture::Checkerboard(board) };
    let middle = Vec3::splat(height) * Vec3::new(0.5, 1.0, 0.5);
    let camera = Camera { fov_y: 12.0, ..spot(middle + Vec3::Y * 4.0 * height, middle) };
    Place { what: format!("cells of {height}, {what}"), expected: 0.2, scene, camera }
}

/// Estimators that find lamps however small.
pub const SAMPLING: [Estimator; 2] = [Estimator::LIGHT, Estimator::MIS];

/// Those that find lamps of some size.
pub const FINDING: [Estimator; 3] = [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS];

/// A path that goes on until it finds light, or is cut.
pub fn endless() -> PathSettings {
    without_roulette()
}

fn exactly(trial: &mut Trial, place: &Place, integrator: impl Into<Integrator>, tolerance: f64) {
    let (tracer, integrator) = (Tracer::new(&place.scene), integrator.into());
    let film = trial.film((&tracer, &place.camera), integrator, 8, 8);
    trial.equal(&subject(integrator), &place.what, place.expected, farthest(&film, place.expected), tolerance);
}

pub fn far_lamp(trial: &mut Trial) {
    for place in far_lamps() {
        let tracer = Tracer::new(&place.scene);
        let integrators = SAMPLING.map(|estimator| Integrator::from(direct(estimator)));
        for integrator in integrators.into_iter().chain([shadow_rays(2).into()]) {
            // every sample is the same, unless the lamp stands before itself
            let film = trial.film((&tracer, &place.camera), integrator, FAR_PICTURE.0, FAR_PICTURE.1);
            let measured = farthest(&film, place.expected);
            trial.equal(&subject(integrator), &place.what, place.expected, measured, 1e-5 * place.expected);
        }
    }
}

pub fn lamps_in_one_place(trial: &mut Trial) {
    for place in coinciding_lamps() {
        let many = among_many(&place.scene);
        for (scene, where_) in [(&place.scene, ""), (&many, ", among many")] {
            let (tracer, quantity) = (Tracer::new(scene), format!("{}{where_}", place.what));
            for estimator in FINDING {
                trial.traced(&quantity, place.expected, (&tracer, &place.camera), direct(estimator));
            }
            trial.traced(&quantity, place.expected, (&tracer, &place.camera), shadow_rays(2));
        }
    }
}

pub fn contact(trial: &mut Trial) {
    for place in contacts() {
        for scene in [place.scene.clone(), among_many(&place.scene)] {
            let (tracer, seen) = (Tracer::new(&scene), scene.shapes.len());
            let quantity = format!("{}, {seen} shapes", place.what);
            trial.traced(&quantity, place.expected, (&tracer, &place.camera), without_roulette());
        }
        exactly(trial, &place, to_depth(CONTACT_DEPTH), 2e-5);
    }
}

pub fn gallery(trial: &mut Trial) {
    for place in galleries() {
        exactly(trial, &place, endless(), 0.0);
        exactly(trial, &place, to_depth(64), 0.0);
    }
}

pub fn board(trial: &mut Trial) {
    for place in boards() {
        exactly(trial, &place, without_roulette(), 1e-5);
    }
}
