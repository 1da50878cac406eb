//! The fake as taught, pixel by pixel, against a twin on the CPU that knows nothing of passes and pipelines: it casts
//! rays at the triangles, looks up texels that it casts itself, and rounds where bytes were kept.

use film::DisplayTransform;
use film::Film;
use gpu::Gpu;
use raster::{Fake, FakeKnobs, Raster, RasterSettings, RefractedAt, shading};
use scene::glam::Vec2;
use scene::{Bsdf, Camera, Geometry, Material, Scene, Shape, Texture, Vec3, builtin};
use std::f32::consts::{PI, TAU};

/// Positions of the 4 samples of a pixel, in pixels from its top left corner.
const SAMPLES: [Vec2; 4] =
    [Vec2::new(0.375, 0.125), Vec2::new(0.875, 0.375), Vec2::new(0.125, 0.625), Vec2::new(0.625, 0.875)];

const SIZE: (u32, u32) = (320, 180);

struct Corner {
    position: Vec3,
    normal: Vec3,
}

/// A shape's triangles, in a sphere that rays are held against first.
struct Body {
    triangles: Vec<[Corner; 3]>,
    bounds: Option<(Vec3, f32)>,
    kd: Texture,
    /// Refraction ratio and reflectivity of glass.
    glass: Option<(f32, f32)>,
}

impl Body {
    fn new(scene: &Scene, shape: &Shape, segments: u32) -> Body {
        let material = scene.material_of(shape);
        let (kd, glass) = match material.bsdf.clone() {
            Bsdf::Diffuse { albedo } => (albedo, None),
            Bsdf::Mirror { reflectance } => (Texture::Constant(reflectance), None),
            Bsdf::RoughConductor { .. } | Bsdf::MetallicRoughness(_) => panic!("no scene here has any"),
            Bsdf::Dielectric { .. } => (
                Texture::Constant(Vec3::ONE),
                Some((material.fake.refraction_ratio.unwrap(), material.fake.reflectivity)),
            ),
        };
        let (triangles, bounds) = match shape.geometry {
            Geometry::Sphere { center, radius } => (sphere(center, radius, segments), Some((center, radius))),
            ref flat => {
                let (p, triangles) = flat.flat_triangles();
                let corners = triangles.iter().map(|t| {
                    let [a, b, c] = t.map(|i| p[i as usize]);
                    [a, b, c].map(|position| Corner { position, normal: (b - a).cross(c - a).normalize() })
                });
                (corners.collect(), None)
            }
        };
        Body { triangles, bounds, kd, glass }
    }
}

/// three.js' SphereGeometry.
fn sphere(center: Vec3, radius: f32, segments: u32) -> Vec<[Corner; 3]> {
    let corner = |row: u32, column: u32| {
        let (theta, phi) = (PI * row as f32 / segments as f32, TAU * column as f32 / segments as f32);
        let normal = Vec3::new(-phi.cos() * theta.sin(), theta.cos(), phi.sin() * theta.sin());
        Corner { position: center + radius * normal, normal }
    };
    let quads = (0..segments).flat_map(|row| (0..segments).map(move |column| (row, column)));
    let halves = quads.flat_map(|(row, column)| {
        let a = || corner(row, column + 1);
        let (b, c) = (|| corner(row, column), || corner(row + 1, column));
        let d = || corner(row + 1, column + 1);
        [(row > 0).then(|| [a(), b(), d()]), (row + 1 < segments).then(|| [b(), c(), d()])]
    });
    halves.flatten().collect()
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy)]
struct Hit {
    t: f32,
    body: usize,
    triangle: usize,
    weights: [f32; 3],
    front: bool,
}

/// What is drawn of a body: which sides.
#[derive(Clone, Copy, PartialEq)]
enum Sides {
    None,
    Both,
    Front,
    Back,
}

/// A ray; depths are counted along `forward`, and only those in `range` are drawn.
struct Ray {
    origin: Vec3,
    d: Vec3,
    forward: Vec3,
    range: (f32, f32),
}

struct Twin {
    bodies: Vec<Body>,
    scene: Scene,
    camera: Camera,
    shadow_size: u32,
    cube_size: u32,
}

impl Twin {
    fn new(scene: &Scene, knobs: &FakeKnobs) -> Twin {
        let segments = knobs.segments.unwrap_or(scene.fake.segments);
        Twin {
            bodies: scene.shapes.iter().map(|shape| Body::new(scene, shape, segments)).collect(),
            scene: scene.clone(),
            camera: scene.camera,
            shadow_size: knobs.shadow_map.unwrap_or(512),
            cube_size: knobs.cube_map.unwrap_or(512),
        }
    }

    fn nearest(&self, ray: &Ray, sides: impl Fn(&Body) -> Sides, hidden: Option<usize>) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        for (index, body) in self.bodies.iter().enumerate().filter(|(index, _)| hidden != Some(*index)) {
            let wanted = sides(body);
            let misses = |(center, radius): (Vec3, f32)| (center - ray.origin).cross(ray.d).length() > radius;
            if wanted == Sides::None || body.bounds.is_some_and(misses) {
                continue;
            }
            for (triangle, corners) in body.triangles.iter().enumerate() {
                let Some((t, weights, front)) = intersect(ray, corners) else { continue };
                let depth = t * ray.d.dot(ray.forward);
                let drawn = wanted == Sides::Both || (wanted == Sides::Front) == front;
                let nearer = best.is_none_or(|hit| t < hit.t);
                if drawn && nearer && depth >= ray.range.0 && depth <= ray.range.1 {
                    best = Some(Hit { t, body: index, triangle, weights, front });
                }
            }
        }
        best
    }

    /// Glass is drawn by its back faces.
    fn seen(&self, ray: &Ray, hidden: Option<usize>) -> Option<Hit> {
        self.nearest(ray, |body| if body.glass.is_some() { Sides::Back } else { Sides::Both }, hidden)
    }

    /// The bytes that `ray` sees, before they are rounded; `None` where a lookup leaves a cube map's face.
    fn colour(&self, ray: &Ray, hit: Option<Hit>, hidden: Option<usize>) -> Option<Vec3> {
        let Some(hit) = hit else { return Some(self.scene.sky) };
        let (body, corners) = (&self.bodies[hit.body], &self.bodies[hit.body].triangles[hit.triangle]);
        let p = ray.origin + ray.d * hit.t;
        let mixed = |of: &dyn Fn(&Corner) -> Vec3| (0..3).map(|i| of(&corners[i]) * hit.weights[i]).sum::<Vec3>();
        if let Some((ratio, reflectivity)) = body.glass {
            let per_corner = |c: &Corner| shading::refract((c.position - ray.origin).normalize(), -c.normal, ratio);
            let environment = self.cube_map(hit.body, mixed(&per_corner).normalize())?;
            return Some(Vec3::ONE.lerp(environment, reflectivity));
        }
        let n = mixed(&|c| c.normal).normalize() * if hit.front { 1.0 } else { -1.0 };
        let l = Vec3::new(10.0, 13.0, -2.0).normalize();
        let kd = body.kd.at(p, Vec2::ZERO);
        let lit = shading::three_blinn_phong(n, l, -ray.d, kd, 17.0 / 255.0, 30.0, Vec3::ONE);
        Some((kd * 0.23 + self.shadow(p, hidden) * lit).clamp(Vec3::ZERO, Vec3::ONE))
    }

    fn shadow(&self, p: Vec3, hidden: Option<usize>) -> f32 {
        let position = Vec3::new(10.0, 13.0, -2.0);
        let forward = -position.normalize();
        let right = forward.cross(Vec3::Y).normalize();
        let up = right.cross(forward);
        let in_view = p - position;
        let uv = [0.5 + in_view.dot(right) / 10.0, 0.5 - in_view.dot(up) / 10.0];
        let depth = |along: f32| (along - 0.5) / 499.5;
        let receiver = depth(in_view.dot(forward));
        if uv.iter().any(|x| !(0.0..=1.0).contains(x)) || receiver > 1.0 {
            return 1.0;
        }
        let kept = |x: u32, y: u32| {
            let across = |texel: u32| (texel as f32 + 0.5) / self.shadow_size as f32 - 0.5;
            let origin = position + right * (10.0 * across(x)) - up * (10.0 * across(y));
            let casting = |body: &Body| match body.bounds {
                None => Sides::None,
                Some(_) if body.glass.is_some() => Sides::Front,
                Some(_) => Sides::Back,
            };
            let ray = Ray { origin, d: forward, forward, range: (0.5, 500.0) };
            self.nearest(&ray, casting, hidden).map_or(1.0, |hit| depth(hit.t))
        };
        shading::pcf_soft(kept, self.shadow_size, uv, receiver)
    }

    /// Four texels of the face that `d` leaves by, blended bilinearly.
    fn cube_map(&self, glass: usize, d: Vec3) -> Option<Vec3> {
        let eye = self.bodies[glass].bounds.unwrap().0;
        let size = self.cube_size as f32;
        let forward =
            Vec3::AXES.into_iter().flat_map(|a| [a, -a]).max_by(|a, b| a.dot(d).total_cmp(&b.dot(d))).unwrap();
        let up = if forward.y == 0.0 { Vec3::Y } else { Vec3::Z };
        let right = forward.cross(up);
        let at = Vec2::new(d.dot(right), d.dot(up)) / d.dot(forward) * (0.5 * size) + 0.5 * size - 0.5;
        let texel = |x: f32, y: f32| {
            let (x, y) = ((2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0);
            let d = (forward + right * x + up * y).normalize();
            let ray = Ray { origin: eye, d, forward, range: (0.1, 5000.0) };
            let colour = self.colour(&ray, self.seen(&ray, Some(glass)), Some(glass))?;
            Some((colour * 255.0).round() / 255.0)
        };
        let (low, f) = (at.floor(), at - at.floor());
        if low.min_element() < 0.0 || low.max_element() + 1.0 >= size {
            return None;
        }
        let row = |y: f32| Some(texel(low.x, y)?.lerp(texel(low.x + 1.0, y)?, f.x));
        Some(row(low.y)?.lerp(row(low.y + 1.0)?, f.y))
    }

    fn ray(&self, at: Vec2) -> Ray {
        let size = Vec2::new(SIZE.0 as f32, SIZE.1 as f32);
        let frame = self.camera.frame(size.x / size.y);
        let range = (self.camera.near.unwrap_or(0.0), self.camera.far.unwrap_or(f32::INFINITY));
        Ray { origin: frame.eye, d: frame.direction(at / size), forward: frame.forward, range }
    }

    /// Which body, which triangle of glass, and which cell of a checkerboard is seen there.
    fn seen_at(&self, at: Vec2) -> (Option<Hit>, Option<(usize, usize, Vec3)>) {
        let ray = self.ray(at);
        let hit = self.seen(&ray, None);
        // what is interpolated over glass is far from linear, so that a pixel on two of its triangles is a mixture
        let triangle = |h: &Hit| if self.bodies[h.body].glass.is_some() { h.triangle } else { 0 };
        (hit, hit.map(|h| (h.body, triangle(&h), self.bodies[h.body].kd.at(ray.origin + ray.d * h.t, Vec2::ZERO))))
    }
}

/// Distance, weights of the corners, and whether it is the front (Moeller and Trumbore 1997).
fn intersect(ray: &Ray, [a, b, c]: &[Corner; 3]) -> Option<(f32, [f32; 3], bool)> {
    let (u, v) = (b.position - a.position, c.position - a.position);
    let p = ray.d.cross(v);
    let determinant = u.dot(p);
    let from = ray.origin - a.position;
    let q = from.cross(u);
    let (x, y) = (from.dot(p) / determinant, ray.d.dot(q) / determinant);
    let t = v.dot(q) / determinant;
    (x >= 0.0 && y >= 0.0 && x + y <= 1.0 && t > 0.0).then_some((t, [1.0 - x - y, x, y], determinant > 0.0))
}

fn rendered(scene: &Scene, knobs: FakeKnobs) -> Film {
    let gpu = Gpu::headless().unwrap();
    let settings = RasterSettings { fake: Fake::AsTaught, knobs, ..RasterSettings::new(SIZE.0, SIZE.1) };
    Raster::new(&gpu).unwrap().render(scene, &scene.camera, &settings).unwrap()
}

fn bytes(film: &Film, x: u32, y: u32) -> Vec3 {
    let [r, g, b, _] = DisplayTransform::default().rgba8(film.at(x, y)).map(f32::from);
    Vec3::new(r, g, b)
}

/// Compares every pixel that lies in one body and one cell. A byte may be rounded either way, twice through a cube map;
/// of four thousand pixels one may lie so near to the border of a texel or a cell that the last bit decides.
fn compare(name: &str, scene: &Scene, knobs: FakeKnobs) {
    let (film, twin) = (rendered(scene, knobs), Twin::new(scene, &knobs));
    let (mut compared, mut apart) = (vec![0; scene.shapes.len() + 1], Vec::new());
    for (x, y) in (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))) {
        let middle = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let (hit, seen) = twin.seen_at(middle);
        let corners = [Vec2::new(-0.5, -0.5), Vec2::new(0.5, -0.5), Vec2::new(-0.5, 0.5), Vec2::new(0.5, 0.5)];
        if corners.into_iter().any(|corner| twin.seen_at(middle + corner).1 != seen) {
            continue;
        }
        let Some(expected) = twin.colour(&twin.ray(middle), hit, None) else { continue };
        compared[hit.map_or(scene.shapes.len(), |hit| hit.body)] += 1;
        let found = bytes(&film, x, y);
        // beyond a triangle's edge its normal goes on straight: a small ball's facets show that
        let facets = hit.is_some_and(|h| twin.bodies[h.body].bounds.is_some() && twin.bodies[h.body].glass.is_none());
        if (found - expected * 255.0).abs().max_element() > if facets { 3.1 } else { 1.6 } {
            apart.push(((x, y), found, expected * 255.0, hit.map(|hit| hit.body)));
        }
    }
    let all: usize = compared.iter().sum();
    println!("{name}: compared {compared:?}, {} apart", apart.len());
    assert!(
        apart.len() * 4000 <= all,
        "{name}: {} of {all} are apart, such as {:?}",
        apart.len(),
        &apart[..9.min(apart.len())]
    );
    assert!(compared.iter().take(3).all(|count| *count > 300), "{name}: {compared:?}");
}

#[test]
fn every_pixel_is_the_twins() {
    let scene = builtin::named("whitted").unwrap();
    compare("the tutorial's maps", &scene, FakeKnobs { segments: Some(24), ..FakeKnobs::default() });
}

#[test]
fn every_texel_of_coarse_maps_is_the_twins() {
    let scene = builtin::named("whitted").unwrap();
    let knobs = FakeKnobs { segments: Some(12), cube_map: Some(16), shadow_map: Some(32), ..FakeKnobs::default() };
    compare("coarse maps", &scene, knobs);
}

/// Balls that cross the shadow map's border, sink into the floor, hide within the cube camera's near distance
/// and stand in the glass, in its shadow; walls
/// before and behind its far distance.
fn at_the_limits() -> Scene {
    let mut scene = builtin::named("whitted").unwrap();
    let matt = Material {
        name: "matt".into(),
        bsdf: Bsdf::Diffuse { albedo: Texture::Constant(Vec3::new(0.2, 0.7, 0.4)) },
        emission: None,
        surface: Default::default(),
        fake: Default::default(),
    };
    scene.materials.push(matt);
    let material = scene.materials.len() - 1;
    let ball = |center: Vec3, radius: f32| Geometry::Sphere { center, radius };
    let wall = |x: f32, z: f32| Geometry::Rectangle {
        corner: Vec3::new(x, 0.0, z),
        edge_u: Vec3::new(0.0, 0.0, 3000.0),
        edge_v: Vec3::new(0.0, 3000.0, 0.0),
    };
    let glass = Vec3::new(4.2, 2.6, -4.2);
    let added = [
        ball(Vec3::new(1.0, 0.4, -5.3), 0.5),
        ball(Vec3::new(3.0, 0.15, -5.2), 0.4),
        ball(glass + Vec3::new(-0.03, 0.0, 0.0), 0.05),
        ball(glass + Vec3::new(0.2, 0.35, 0.3), 0.25),
        wall(glass.x - 4500.0, glass.z),
        wall(glass.x - 5500.0, glass.z - 3000.0),
    ];
    let mut shapes = scene.shapes.to_vec();
    shapes.extend(added.map(|geometry| Shape { geometry, material }));
    scene.shapes = shapes.into();
    scene
}

#[test]
fn maps_end_where_the_twins_do() {
    compare("at the limits", &at_the_limits(), FakeKnobs { segments: Some(24), ..FakeKnobs::default() });
}

#[test]
fn the_suns_view_reaches_from_half_a_unit_to_500() {
    let scene = builtin::named("whitted").unwrap();
    let settings = RasterSettings { fake: Fake::AsTaught, ..RasterSettings::new(1, 1) };
    let view = raster::lights::lights(&at_the_limits(), &settings, |_| true).shadow_views[0];
    let (position, l) = (scene.fake.light_position.unwrap(), Vec3::new(10.0, 13.0, -2.0).normalize());
    for (distance, depth) in [(0.5, 0.0), (500.0, 1.0)] {
        assert!((view.depth_from_world.dot((position - l * distance).extend(1.0)) - depth).abs() < 1e-5);
    }
}

#[test]
fn the_rim_of_the_glass_is_sampled_four_times() {
    let scene = builtin::named("whitted").unwrap();
    let (film, twin) = (rendered(&scene, FakeKnobs::default()), Twin::new(&scene, &FakeKnobs::default()));
    let (sky, through) = (scene.sky * 255.0, Vec3::ONE.lerp(scene.sky, 0.9) * 255.0);
    let mut rim = [0; 5];
    // the upper rim, where sky is seen on both sides
    for (x, y) in (0..55).flat_map(|y| (100..300).map(move |x| (x, y))) {
        let corner = Vec2::new(x as f32, y as f32);
        let covered = SAMPLES.into_iter().filter(|s| twin.seen_at(corner + *s).0.is_some()).count();
        let only_glass = SAMPLES
            .into_iter()
            .all(|s| twin.seen_at(corner + s).0.is_none_or(|hit| twin.bodies[hit.body].glass.is_some()));
        if only_glass {
            rim[covered] += 1;
            let expected = sky.lerp(through, covered as f32 / 4.0);
            let off = (bytes(&film, x, y) - expected).abs().max_element();
            assert!(off < 1.6, "{x}, {y}: {covered} of 4 samples, {off} apart");
        }
    }
    assert!(rim.iter().all(|count| *count > 5), "{rim:?}");
}

/// The directions of a sphere of few segments are interpolated across wide triangles; of many both are the same.
#[test]
fn refraction_in_fragments_is_what_refraction_at_vertices_becomes_with_more_of_them() {
    let scene = builtin::named("whitted").unwrap();
    let mut raster = Raster::new(&Gpu::headless().unwrap()).unwrap();
    let mut apart = |segments: u32| {
        let [vertices, fragments] = RefractedAt::ALL.map(|refracted| {
            let knobs = FakeKnobs { segments: Some(segments), refracted, ..FakeKnobs::default() };
            let settings = RasterSettings { fake: Fake::AsTaught, knobs, ..RasterSettings::new(160, 90) };
            raster.render(&scene, &scene.camera, &settings).unwrap()
        });
        let pairs = vertices.radiances().zip(fragments.radiances());
        pairs.map(|(a, b)| f64::from((a - b).abs().max_element())).sum::<f64>()
    };
    let [coarse, fine] = [8, 256].map(&mut apart);
    assert!(coarse > 1.0 && fine < 0.1 * coarse, "{fine} of {coarse}");
}
