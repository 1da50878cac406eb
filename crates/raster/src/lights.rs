//! The fake's lights: a sun with one shadow view, and of area and point lights that of greatest power, as a point with six.
//!
//! Fair area lights stand for the one-sample direct light: a flat area light of radiance L and area A gives the
//! irradiance `L A cos' cos / d^2`, others, seen as convex, `L A/4 cos / d^2` all around (a convex body's mean
//! silhouette is a quarter of its surface: Cauchy). As taught it is three.js' PointLight: it does not decay.

use crate::cube;
use crate::gpu_data::*;
use crate::knobs::RefractedAt;
use crate::planes::Planes;
use crate::repair::Repair;
use crate::settings::{Fake, RasterSettings};
use crate::spheres;
use crate::tessellation::{corners, large_mesh, unit_normal};
use bytemuck::Zeroable;
use film::colour;
use scene::glam::{Affine3A, DVec3, Vec2, camera::rh};
use scene::{Geometry, Mesh, PointLight, Scene, Shape, Sun, Vec3};
use std::f32::consts::{FRAC_1_PI, PI, SQRT_2};

/// Texels that the shadow kernel reaches from its middle, along an axis.
const KERNEL_REACH: f32 = 2.0;

/// The area or point light that sheds light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaLight {
    /// Middle of its bounds.
    pub position: Vec3,
    /// Unit normal of a flat area light, axis of a spot.
    pub normal: Vec3,
    /// Radiant flux over pi: radiance times shining area; of a spot what it would be without its cone.
    pub power: Vec3,
    /// Radius of a disc as large as it looks; 0 of points.
    pub radius: f32,
    pattern: u32,
    form: Form,
    /// Of a spot: cosine of its outer cone, and the share of its light that a cosine above that adds.
    cone: [f32; 2],
}

/// What an area light looks like, as far as its light is known in closed form.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Form {
    Unknown,
    Quad { corner: Vec3, edge_u: Vec3, edge_v: Vec3, radiance: Vec3 },
    Sphere { radiance: Vec3 },
}

impl AreaLight {
    /// That of greatest power in `scene`, by luminance.
    pub fn brightest(scene: &Scene) -> Option<AreaLight> {
        let area_lights = scene.shapes.iter().filter_map(|shape| AreaLight::of(scene, shape));
        let all = area_lights.chain(scene.point_lights.iter().filter_map(AreaLight::of_point));
        all.max_by(|a, b| colour::luminance(a.power).total_cmp(&colour::luminance(b.power)))
    }

    fn of(scene: &Scene, shape: &Shape) -> Option<AreaLight> {
        let material = scene.material_of(shape);
        // what glows in places is seen to, and sheds no light
        let emission = material.emission.filter(|_| material.surface.emission.is_none())?;
        let emission = Some(emission).filter(|e| e.radiance.max_element() > 0.0)?;
        let (normal, pattern) = match &shape.geometry {
            Geometry::Rectangle { edge_u, edge_v, .. } => (
                unit_normal(*edge_u, *edge_v),
                if emission.two_sided { AREA_LIGHT_TWO_SIDED } else { AREA_LIGHT_ONE_SIDED },
            ),
            _ => (Vec3::ZERO, AREA_LIGHT_ALL_AROUND),
        };
        let sides = if pattern == AREA_LIGHT_TWO_SIDED { 2.0 } else { 1.0 };
        let area = area(&shape.geometry);
        let power = emission.radiance * (area * sides);
        let silhouette = if pattern == AREA_LIGHT_ALL_AROUND { 0.25 * area } else { area };
        let radius = (silhouette * FRAC_1_PI).sqrt();
        let radiance = emission.radiance;
        let form = match shape.geometry {
            Geometry::Rectangle { corner, edge_u, edge_v } => Form::Quad { corner, edge_u, edge_v, radiance },
            Geometry::Sphere { .. } => Form::Sphere { radiance },
            _ => Form::Unknown,
        };
        Some(AreaLight { position: shape.geometry.center(), normal, power, radius, pattern, form, cone: [0.0; 2] })
    }

    /// As a small sphere of this intensity, whose silhouette is a quarter of its surface.
    fn of_point(light: &PointLight) -> Option<AreaLight> {
        let all_around = AreaLight {
            position: light.position,
            normal: Vec3::ZERO,
            power: 4.0 * light.intensity,
            radius: 0.0,
            pattern: AREA_LIGHT_ALL_AROUND,
            form: Form::Unknown,
            cone: [0.0; 2],
        };
        let shines = light.intensity.max_element() > 0.0;
        let lamp = light.spot.map_or(all_around, |spot| {
            let [inner, outer] = [spot.inner, spot.outer].map(|angle| angle.to_radians().cos());
            let cone = [outer, 1.0 / (inner - outer).max(1e-3)];
            AreaLight { normal: spot.towards, pattern: AREA_LIGHT_SPOT, cone, ..all_around }
        });
        shines.then_some(lamp)
    }

    /// Whether what it sheds is known in closed form, nothing in its way.
    pub fn has_a_known_form(&self) -> bool {
        self.form != Form::Unknown
    }

    /// Has its light integrated over its form.
    fn fill_form(&self, lights: &mut Lights) {
        match self.form {
            Form::Unknown => {}
            Form::Quad { corner, edge_u, edge_v, radiance } => {
                lights.area_light_form = AREA_FORM_QUAD;
                lights.area_light_radiance = radiance;
                lights.area_light_corner = corner;
                (lights.area_light_edge_u, lights.area_light_edge_v) = (edge_u, edge_v);
                lights.area_light_sides = if self.pattern == AREA_LIGHT_TWO_SIDED { 2 } else { 1 };
            }
            Form::Sphere { radiance } => {
                lights.area_light_form = AREA_FORM_SPHERE;
                lights.area_light_radiance = radiance;
            }
        }
    }

    /// What a white Lambert surface at distance 1, facing the area light, sends back: irradiance / pi.
    fn incident(&self) -> Vec3 {
        let silhouette = match self.pattern {
            AREA_LIGHT_ALL_AROUND | AREA_LIGHT_SPOT => 0.25,
            AREA_LIGHT_TWO_SIDED => 0.5,
            _ => 1.0,
        };
        self.power * (silhouette * FRAC_1_PI)
    }
}

fn area(geometry: &Geometry) -> f32 {
    if let Geometry::Sphere { radius, .. } = geometry {
        return 4.0 * PI * radius * radius;
    }
    if let Some((mesh, to_world)) = large_mesh(geometry) {
        return area_of_large(mesh, to_world);
    }
    let (positions, triangles) = geometry.flat_triangles();
    // in f64, where squares of lengths of any scale still fit
    triangles.iter().map(|t| area_of(t.map(|i| positions[i as usize].as_dvec3()))).sum::<f64>() as f32
}

fn area_of([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// Estimated from some of its triangles, evenly spaced: all of them are too many to look at in each frame.
fn area_of_large(mesh: &Mesh, to_world: Affine3A) -> f32 {
    const SAMPLES: usize = Mesh::LARGE;
    let count = mesh.triangles().len();
    let corner = |i: u32| to_world.transform_point3(mesh.positions()[i as usize]).as_dvec3();
    let of = |sample: usize| area_of(mesh.triangles()[sample * count / SAMPLES].map(corner));
    ((0..SAMPLES).map(of).sum::<f64>() * count as f64 / SAMPLES as f64) as f32
}

/// The sun of `scene`, the area or point light that is lit beside it, and the place that light comes from for deciding who casts
/// shadows.
pub fn lit(scene: &Scene, fake: Fake) -> (Option<Sun>, Option<AreaLight>) {
    let area_light = AreaLight::brightest(scene).filter(|_| fake == Fake::Fair || scene.sun.is_none());
    (scene.sun, area_light)
}

/// The lights' uniforms. `casts` tells the shapes that throw shadows.
pub fn lights(scene: &Scene, settings: &RasterSettings, casts: impl Fn(usize) -> bool) -> Lights {
    let as_taught = settings.fake == Fake::AsTaught;
    let (sun, area_light) = lit(scene, settings.fake);
    let intensity = Vec3::splat(scene.fake.intensity);
    let mut lights = Lights {
        refracts_per_vertex: u32::from(as_taught && settings.knobs.refracted == RefractedAt::Vertices),
        ambient: if as_taught { settings.knobs.grey(scene) } else { settings.knobs.sky_light(scene) },
        shadow_bias: settings.knobs.bias,
        sky: scene.sky,
        ..Lights::zeroed()
    };
    if let Some(sun) = sun {
        lights.sun_towards = sun_towards(scene, &sun, settings.fake);
        lights.sun_incident = if as_taught { intensity } else { sun.irradiance * FRAC_1_PI };
        lights.shadow_views[0] = sun_view(scene, settings.fake, lights.sun_towards, casts);
    }
    if let Some(area_light) = area_light {
        lights.area_light_position = area_light.position;
        lights.area_light_normal = area_light.normal;
        lights.area_light_radius = area_light.radius;
        [lights.cone_outer, lights.cone_slope] = area_light.cone;
        lights.area_light_pattern = if as_taught { AREA_LIGHT_WITHOUT_DECAY } else { area_light.pattern };
        if settings.repairs().has(Repair::AreaLights) {
            area_light.fill_form(&mut lights);
        }
        lights.area_light_incident = if as_taught { intensity } else { area_light.incident() };
        let reach = area_light_reach(scene.fake.shadow_map);
        let planes = Planes::fitted(scene, area_light.position, SQRT_2 * reach);
        for axis in 0..6 {
            lights.shadow_views[1 + axis] = area_light_view(scene, area_light.position, axis, planes);
        }
    }
    spheres::fill(&mut lights, scene, settings);
    lights
}

/// As taught, a directional light shines from its position towards the origin.
fn sun_towards(scene: &Scene, sun: &Sun, fake: Fake) -> Vec3 {
    let position = scene.fake.light_position.filter(|_| fake == Fake::AsTaught).unwrap_or_default();
    position.try_normalize().unwrap_or(sun.towards)
}

/// What the planes of three.js' DirectionalLight, near .5 and far 500, are made for: the tutorial's place of the light.
/// Lights at other distances from the origin have them in proportion.
const TAUGHT_POSITION: Vec3 = Vec3::new(10.0, 13.0, -2.0);

/// The sun's view: three.js' DirectionalLight from its position; without one, from twice the scene's radius. It covers
/// what casts across and, fair, what there is along the light.
fn sun_view(scene: &Scene, fake: Fake, towards: Vec3, casts: impl Fn(usize) -> bool) -> View {
    let numbers = &scene.fake;
    let (low, high) = scene.bounds();
    let radius = (0.5 * (high - low).length()).max(f32::MIN_POSITIVE);
    let position = numbers.light_position.unwrap_or(0.5 * (low + high) + towards * (2.0 * radius));
    let up = if towards.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
    let view_from_world = rh::view::look_to_mat4(position, -towards, up);
    let in_view = |bounds: (Vec3, Vec3)| corners(bounds).map(|corner| view_from_world.transform_point3(corner));
    let across = |p: Vec3| p.x.abs().max(p.y.abs());
    let casters = scene.shapes.iter().enumerate().filter(|(index, _)| casts(*index));
    let covering = casters.flat_map(|(_, s)| in_view(s.geometry.bounds())).map(across).fold(0.0, f32::max);
    let half_width = numbers.shadow_half_width.unwrap_or(covering).max(1e-6 * radius);
    let along = in_view((low, high)).map(|p| -p.z);
    let (near, far) = match numbers.light_position {
        Some(position) => {
            let distance = if position == Vec3::ZERO { radius } else { position.length() };
            let unit = distance / TAUGHT_POSITION.length();
            let (near, far) = (0.5 * unit, 500.0 * unit);
            match fake {
                Fake::AsTaught => (near, far),
                Fake::Fair => (along.into_iter().fold(near, f32::min), along.into_iter().fold(far, f32::max)),
            }
        }
        None => (0.9 * radius, 3.1 * radius),
    };
    let ortho =
        |near, far| rh::proj::directx::orthographic(-half_width, half_width, -half_width, half_width, near, far);
    View {
        // reversed, as all views are
        clip_from_world: ortho(far, near) * view_from_world,
        depth_from_world: (ortho(near, far) * view_from_world).row(2),
        eye: position,
        texel: Vec2::new(2.0 * half_width / (numbers.shadow_map as f32 * (far - near)), 0.0),
        ..View::zeroed()
    }
}

/// Tangent of half the field of view of an area light's view of `size` texels a side.
pub fn area_light_reach(size: u32) -> f32 {
    let size = size as f32;
    size / (size - 2.0 * KERNEL_REACH).max(1.0)
}

/// An area light's view along an axis: wider than a cube's face by the kernel's reach, so that no lookup leaves its
/// face. The depth that it keeps is linear, because the kernel compares depths of neighbouring texels.
fn area_light_view(scene: &Scene, position: Vec3, axis: usize, planes: Planes) -> View {
    let size = scene.fake.shadow_map as f32;
    let reach = area_light_reach(scene.fake.shadow_map);
    let distances = corners(scene.bounds()).map(|corner| (corner - position).length());
    let far = (1.001 * distances.into_iter().fold(0.0, f32::max)).max(f32::MIN_POSITIVE);
    let plane = cube::forward(axis) / far;
    View {
        clip_from_world: cube::clip_from_world(position, axis, reach, planes),
        depth_from_world: plane.extend(-plane.dot(position)),
        eye: position,
        texel: Vec2::new(0.0, 2.0 * reach / size),
        ..View::zeroed()
    }
}
