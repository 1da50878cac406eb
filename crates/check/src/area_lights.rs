//! Direct light of area lights over a grey floor.

use crate::hard::{known, spot, with_geometry};
use crate::measure::Trial;
use pathtrace::{Estimator, LightSampling, PathSettings, Roulette, Tracer, WhittedSettings};
use scene::{Camera, Geometry, Scene, Vec3};

/// Direct light alone.
pub fn direct(estimator: Estimator) -> PathSettings {
    PathSettings { estimator, bounces: Some(0), roulette: Roulette::OFF, ..PathSettings::independent() }
}

/// Whitted's direct light, by so many shadow rays to each area light.
pub fn shadow_rays(shadow_rays: u32) -> WhittedSettings {
    WhittedSettings { shadow_rays, ambient: Some(0.0), ..WhittedSettings::default() }
}

/// Looked at from a height above the floor's point (x, y, 0).
pub fn from_above(x: f32, y: f32, height: f32) -> Camera {
    spot(Vec3::new(x, y, height), Vec3::new(x, y, 0.0))
}

/// Lambert's formula for the scene's rectangle at points of the floor.
pub const RECTANGLE: [(f32, f32, f64); 4] =
    [(0.0, 0.0, 1.045356176), (1.0, 0.0, 0.7052169), (2.0, 1.0, 0.1654538478), (5.0, -3.0, 0.005788817356)];

pub fn rectangle(trial: &mut Trial) {
    let scene = known("rectangle-light");
    let tracer = Tracer::new(&scene);
    for (x, y, expected) in RECTANGLE {
        let camera = from_above(x, y, 0.5);
        let quantity = format!("at ({x}, {y})");
        for estimator in Estimator::EVERY {
            // far off, few of the directions by chance meet the area light
            if estimator.samples_lights() || expected > trial.pick(1.0, 0.1) {
                trial.traced(&quantity, expected, (&tracer, &camera), direct(estimator));
            }
        }
        let branching = PathSettings { branches: 4, ..direct(Estimator::MIS) };
        trial.traced(&format!("{quantity}, 4 branches"), expected, (&tracer, &camera), branching);
        for rays in [1, 4] {
            let quantity = format!("{quantity}, {rays} shadow rays");
            trial.traced(&quantity, expected, (&tracer, &camera), shadow_rays(rays));
        }
    }
    let mesh = mesh_area_light(scene);
    let (tracer, camera) = (Tracer::new(&mesh), from_above(1.0, 0.0, 0.5));
    for estimator in [Estimator::LIGHT, Estimator::MIS] {
        trial.traced("at (1, 0), the lamp as a mesh", 0.7052169, (&tracer, &camera), direct(estimator));
    }
}

/// The rectangles of a scene as meshes of two triangles.
pub fn mesh_area_light(scene: Scene) -> Scene {
    with_geometry(scene, |_, geometry| {
        let (positions, triangles) = geometry.flat_triangles();
        *geometry = Geometry::mesh(positions.into_owned(), triangles.into_owned());
    })
}

/// How far beside the plane of the area light the floor is looked at, and its radiance there.
pub const EDGE_ON: [(f32, f64); 4] =
    [(0.0, 0.0), (1e-6, 1.680221139e-8), (1e-3, 1.680219843e-5), (0.1, 1.667345199e-3)];

/// Those that find the area light from there.
pub const FINDING_AN_EDGE: [Estimator; 4] =
    [Estimator::LIGHT, Estimator::MIS, Estimator::UNIFORM_LIGHT, Estimator::UNIFORM_MIS];

/// The floor so far beside the area light's plane.
pub fn beside_the_plane(d: f32) -> (Scene, Camera) {
    // a floor no larger than needed, whose points are known to a fraction of d; in the plane itself, its very edge
    let half = (10.0 * d).max(1e-5);
    let first = if d == 0.0 { 0.0 } else { -half };
    let scene = with_geometry(known("edge-on-light"), |index, geometry| {
        if index == 0 {
            *geometry = Geometry::Rectangle {
                corner: Vec3::new(-half, first, 0.0),
                edge_u: Vec3::X * (2.0 * half),
                edge_v: Vec3::Y * (2.0 * half),
            };
        }
    });
    let mut camera = from_above(0.0, d, 0.25);
    if d == 0.0 {
        camera.fov_y = 0.0;
    }
    (scene, camera)
}

pub fn edge_on(trial: &mut Trial) {
    for (d, expected) in EDGE_ON {
        let (scene, camera) = beside_the_plane(d);
        let tracer = Tracer::new(&scene);
        let quantity = format!("{d} beside the lamp's plane");
        for estimator in FINDING_AN_EDGE {
            if d == 0.0 {
                let film = trial.film((&tracer, &camera), direct(estimator), 8, 64);
                trial.equal(&format!("path {}", estimator.name()), &quantity, 0.0, film.mean()[0], 0.0);
            } else if d == 1e-6 {
                let subject = format!("path {}", estimator.name());
                let settings = direct(estimator);
                let render = crate::measure::adding(&tracer, &camera, settings);
                let found = trial.mean_of(expected, 0.002, 20_000, render);
                let tolerance = 0.01 * expected;
                trial.equal(&subject, &quantity, expected, found.mean, tolerance);
            } else {
                trial.traced(&quantity, expected, (&tracer, &camera), direct(estimator));
            }
        }
        if d > 1e-6 {
            trial.traced(&quantity, expected, (&tracer, &camera), shadow_rays(4));
        }
    }
}

/// Heights of the disk, and the floor's radiance under its middle.
pub const DISKS: [(f32, f64); 5] =
    [(1.0, 0.25), (0.1, 0.495049505), (0.01, 0.499950005), (1e-3, 0.4999995), (1e-4, 0.499999995)];

/// The floor under a disk at this height.
pub fn under_a_disk(height: f32) -> (Scene, Camera) {
    let scene = with_geometry(known("disk-touching"), |_, geometry| {
        if let Geometry::Disk { center, .. } = geometry {
            center.z = height;
        }
    });
    (scene, from_above(0.0, 0.0, 0.5 * height))
}

pub fn disk(trial: &mut Trial) {
    for (height, expected) in DISKS {
        let (scene, camera) = under_a_disk(height);
        let tracer = Tracer::new(&scene);
        let quantity = format!("height {height}");
        for estimator in Estimator::EVERY {
            // sampling alone has a relative variance of 0.167, 33, 3.3e3, 3.3e5 and 3.3e7
            let alone = estimator.light == LightSampling::NextEvent;
            if alone && height < trial.pick(1.0, 0.1) {
                continue;
            }
            let found = trial.traced(&quantity, expected, (&tracer, &camera), direct(estimator));
            if estimator.light == LightSampling::Mis {
                let subject = format!("path {}", estimator.name());
                let quantity = format!("relative variance, height {height}");
                trial.at_most(&subject, &quantity, 1.0, found.relative_variance());
            }
        }
    }
}

/// Radius, distance and degrees from the normal of sphere lights, and the floor's radiance.
pub const SPHERES: [(f32, f32, f32, f64); 4] =
    [(0.5, 2.0, 0.0, 0.5), (0.5, 2.0, 60.0, 0.25), (1.0, 1.0001, 0.0, 7.99840024), (0.01, 10.0, 30.0, 6.92820323e-6)];

/// The floor under such a light.
pub fn under_a_sphere(radius: f32, distance: f32, degrees: f32) -> (Scene, Camera) {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let center = Vec3::new(distance * sin, 0.0, distance * cos);
    let scene = with_geometry(known("sphere-light"), |_, geometry| {
        if matches!(geometry, Geometry::Sphere { .. }) {
            *geometry = Geometry::Sphere { center, radius };
        }
    });
    // between floor and area light where there is no other room
    (scene, from_above(0.0, 0.0, (0.5 * (distance - radius)).min(0.5)))
}

pub fn sphere(trial: &mut Trial) {
    for (radius, distance, degrees, expected) in SPHERES {
        let (scene, camera) = under_a_sphere(radius, distance, degrees);
        let tracer = Tracer::new(&scene);
        let quantity = format!("radius {radius}, distance {distance}, {degrees} degrees");
        for estimator in Estimator::EVERY {
            let seen_by_chance = (radius / distance).powi(2) > trial.pick(0.2, 0.01);
            if estimator.samples_lights() || seen_by_chance {
                trial.traced(&quantity, expected, (&tracer, &camera), direct(estimator));
            }
        }
        trial.traced(&quantity, expected, (&tracer, &camera), shadow_rays(2));
    }
}

/// Distances from the foot of the wall, and the wall's form factor there.
pub const WALL: [(f32, f64); 4] =
    [(1.0, 0.07109343905), (0.1, 0.4225448602), (0.01, 0.4921589522), (1e-3, 0.4992157976)];

/// The floor so far from the wall.
pub fn beside_the_wall(x: f32) -> Camera {
    from_above(x.min(1.0 - 1e-6), 0.0, 0.5)
}

/// Mean form factors of unit squares that share an edge and that face each other at distance 1.
pub const SQUARES: [f64; 2] = [0.2000437761, 0.1998248957];

/// What sees the floor's unit square and nothing else.
pub fn over_the_square() -> Camera {
    let height = 0.9f32;
    Camera {
        eye: Vec3::new(0.5, 0.0, height),
        target: Vec3::new(0.5, 0.0, 0.0),
        up: Vec3::Y,
        fov_y: 2.0 * (0.5 / height).atan().to_degrees(),
        near: None,
        far: None,
    }
}

/// What has the edge that floor and wall share in its middle.
pub fn along_the_edge() -> Camera {
    Camera { eye: Vec3::new(0.5, 0.0, 0.5), target: Vec3::ZERO, fov_y: 1.0, ..over_the_square() }
}

/// The wall moved over the floor.
pub fn facing_squares() -> Scene {
    with_geometry(known("light-touching-wall"), |index, geometry| {
        if index == 1 {
            *geometry = Geometry::Rectangle { corner: Vec3::new(0.0, -0.5, 1.0), edge_u: Vec3::Y, edge_v: Vec3::X };
        }
    })
}

pub fn touching_wall(trial: &mut Trial) {
    let scene = known("light-touching-wall");
    let tracer = Tracer::new(&scene);
    for (x, factor) in WALL {
        let camera = beside_the_wall(x);
        for estimator in Estimator::EVERY {
            if estimator.samples_lights() || factor > 0.1 || trial.full() {
                trial.traced(&format!("at {x} from the edge"), 0.5 * factor, (&tracer, &camera), direct(estimator));
            }
        }
    }
    let opposite = Tracer::new(&facing_squares());
    let [touching, facing] = SQUARES;
    for estimator in [Estimator::COSINE, Estimator::LIGHT, Estimator::MIS] {
        let settings = direct(estimator);
        trial.traced("mean over the unit square", 0.5 * touching, (&tracer, &over_the_square()), settings);
        trial.traced("mean, facing squares", 0.5 * facing, (&opposite, &over_the_square()), settings);
        let film = trial.film((&tracer, &along_the_edge()), settings, 32, 16);
        let bright = film.pixels().iter().map(|pixel| pixel.mean()[0]).fold(0.0, f64::max);
        trial.at_most(&format!("path {}", estimator.name()), "brightest pixel along the edge", 1.5, bright);
    }
}
