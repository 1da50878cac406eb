//! A frame before it is drawn: every number that the passes need, computed on the CPU.

use crate::cube;
use crate::gpu_data::{Lights, Object, View};
use crate::knobs::ShadowFilter;
use crate::lights;
use crate::pipelines::Choice;
use crate::planes::Planes;
use crate::settings::{Fake, RasterSettings, Show};
use crate::targets::{CubePlan, PicturePlan, ShadowPlan, TargetPlan};
use crate::tessellation::unit_normal;
use bytemuck::Zeroable;
use scene::glam::{Mat4, Vec2};
use scene::{Bsdf, Camera, Geometry, MetallicRoughness, Scene, Texture, Vec3};
use std::f32::consts::SQRT_2;
use std::ops::Range;

/// How many pieces of glass get a cube map; each costs six more views of the scene.
pub const MOST_CUBE_MAPS: usize = 8;

/// Views of the shadow map: the sun's and six of the area light.
pub const SHADOW_VIEWS: usize = 7;

/// Sub-pixel positions of the fair fake's passes, in pixels from the middle: the rotated grid of 4x multisampling.
const ROTATED_GRID: [Vec2; 4] =
    [Vec2::new(-0.125, -0.375), Vec2::new(0.375, -0.125), Vec2::new(-0.375, 0.125), Vec2::new(0.125, 0.375)];

/// What of a shape is drawn into shadow maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Casting {
    /// Nothing.
    Nothing,
    /// All of it.
    BothSides,
    /// What the light doesn't see, so that the lit side of a closed shape never shadows itself.
    BackFaces,
    /// What the light sees.
    FrontFaces,
}

/// Everything that a frame's passes read.
#[derive(Debug)]
pub struct Plan {
    /// All cameras: shadow views, then six for each cube map, then the picture's.
    pub views: Vec<View>,
    /// The lights.
    pub lights: Lights,
    /// One for each shape.
    pub objects: Vec<Object>,
    /// One for each shape.
    pub casting: Vec<Casting>,
    /// Which shadow views are drawn.
    pub shadow_layers: Range<usize>,
    /// Texels along a side of the shadow map.
    pub shadow_size: u32,
    /// The shapes that have cube maps.
    pub cube_maps: Vec<usize>,
    /// Which views are the picture's.
    pub picture_views: Range<usize>,
    /// Fair or as taught.
    pub fake: Fake,
    /// How shadow maps are looked up.
    pub filter: ShadowFilter,
    /// Which of the passes is the last.
    pub show: Show,
    /// Background.
    pub sky: Vec3,
}

impl Plan {
    /// The plan of one frame.
    pub fn new(scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Plan {
        let fake = settings.fake;
        let casting: Vec<_> = (0..scene.shapes.len()).map(|shape| casting(scene, shape, fake)).collect();
        let lights = lights::lights(scene, settings, |shape| casting[shape] != Casting::Nothing);
        let glass = |shape: &usize| matches!(scene.material_of(&scene.shapes[*shape]).bsdf, Bsdf::Dielectric { .. });
        let cube_maps: Vec<_> = (0..scene.shapes.len()).filter(glass).take(MOST_CUBE_MAPS).collect();
        let mut objects: Vec<_> =
            (0..scene.shapes.len()).map(|shape| object(scene, shape, casting[shape], settings)).collect();
        let mut views = lights.shadow_views.to_vec();
        for &shape in &cube_maps {
            objects[shape].has_cube_map = 1;
            views.extend(cube_map_views(scene, &scene.shapes[shape].geometry, fake));
        }
        let first = views.len();
        views.extend(picture_views(scene, camera, settings));
        let shadow_layers = shadow_layers(scene, fake);
        Plan {
            shadow_size: if shadow_layers.is_empty() { 1 } else { scene.fake.shadow_map },
            shadow_layers,
            picture_views: first..views.len(),
            views,
            lights,
            objects,
            casting,
            cube_maps,
            fake,
            filter: settings.knobs.filter,
            show: settings.show,
            sky: scene.sky,
        }
    }

    /// What its forward passes have compiled in.
    pub fn choice(&self) -> Choice {
        Choice::of(self.fake, self.filter, &self.lights)
    }

    /// The targets that this frame needs.
    pub fn target_plan(&self, scene: &Scene, settings: &RasterSettings) -> TargetPlan {
        let &RasterSettings { width, height, fake, .. } = settings;
        TargetPlan {
            shadow: ShadowPlan { size: self.shadow_size, with_area_light: self.shadow_layers.end > 1 },
            cubes: CubePlan { size: scene.fake.cube_map, count: self.cube_maps.len(), fake },
            picture: PicturePlan { width, height, fake },
        }
    }

    /// The view of a cube map's layer: `index` counts [`Plan::cube_maps`].
    pub fn cube_view(&self, index: usize, layer: usize) -> usize {
        SHADOW_VIEWS + 6 * index + layer
    }
}

fn shadow_layers(scene: &Scene, fake: Fake) -> Range<usize> {
    let (sun, area_light) = lights::lit(scene, fake);
    let first = if sun.is_some() { 0 } else { 1 };
    let end = if area_light.is_some() { SHADOW_VIEWS } else { 1 };
    first..end
}

fn picture_views(scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Vec<View> {
    let size = Vec2::new(settings.width as f32, settings.height as f32);
    let planes = Planes::of(scene, camera, size.x / size.y);
    let clip_from_world = planes.applied_to(camera.clip_from_world(size.x / size.y));
    let shifts: &[Vec2] = match settings.fake {
        Fake::AsTaught => &[Vec2::ZERO],
        Fake::Fair => &ROTATED_GRID,
    };
    let view = |&shift: &Vec2| View {
        clip_from_world: shifted(clip_from_world, shift, size),
        near: planes.near,
        eye: camera.eye,
        sees_cube_maps: 1,
        ..View::zeroed()
    };
    shifts.iter().map(view).collect()
}

/// The view with its pixels moved by `shift` pixels to the right and down.
fn shifted(clip_from_world: Mat4, shift: Vec2, size: Vec2) -> Mat4 {
    let by = shift * Vec2::new(2.0, -2.0) / size;
    Mat4::from_translation(by.extend(0.0)) * clip_from_world
}

/// As taught three.js' CubeCamera, whose near .1 and far 5000 are made for a glass of radius 1: here they are shares of
/// its radius. Fair it cuts nothing.
fn cube_map_views(scene: &Scene, glass: &Geometry, fake: Fake) -> [View; 6] {
    let eye = glass.center();
    let planes = match fake {
        Fake::AsTaught => {
            let (low, high) = glass.bounds();
            let radius = 0.5 * (high - low).max_element();
            Planes { near: 0.1 * radius, far: 5000.0 * radius }
        }
        Fake::Fair => Planes::fitted(scene, eye, SQRT_2),
    };
    std::array::from_fn(|layer| {
        let clip_from_world = cube::clip_from_world(eye, cube::axis_of_layer(layer), 1.0, planes);
        View { clip_from_world, near: planes.near, eye, ..View::zeroed() }
    })
}

/// As taught: rectangles (the floor) only receive; `shadowSide` draws back faces of front-sided materials, and front
/// faces of the glass, whose material is back-sided. Fair: a rectangle casts if something lies behind it, and flat
/// shapes cast their lit side too, or light would leak in along the foot of a box.
fn casting(scene: &Scene, index: usize, fake: Fake) -> Casting {
    let shape = &scene.shapes[index];
    let material = scene.material_of(shape);
    if material.emission.is_some() {
        return Casting::Nothing;
    }
    let glass = matches!(material.bsdf, Bsdf::Dielectric { .. });
    match (&shape.geometry, fake) {
        (Geometry::Rectangle { .. }, Fake::AsTaught) => Casting::Nothing,
        (Geometry::Rectangle { corner, edge_u, edge_v }, Fake::Fair) => {
            let normal = unit_normal(*edge_u, *edge_v);
            if hides_something(scene, index, *corner, normal) { Casting::BothSides } else { Casting::Nothing }
        }
        _ if glass => Casting::FrontFaces,
        (Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_), Fake::Fair) => Casting::BothSides,
        _ => Casting::BackFaces,
    }
}

/// Whether another shape reaches behind a plane as a light sees it; by less than a hundredth of the scene's size does
/// not count, so that a box that sinks into its floor leaves the floor out.
fn hides_something(scene: &Scene, index: usize, corner: Vec3, normal: Vec3) -> bool {
    let (low, high) = scene.bounds();
    let depth = 0.01 * (high - low).length();
    let (sun, area_light) = lights::lit(scene, Fake::Fair);
    let sides =
        [sun.map(|sun| normal.dot(sun.towards)), area_light.map(|area_light| normal.dot(area_light.position - corner))];
    sides.into_iter().flatten().any(|side| {
        let dark = -normal * side.signum();
        let others = scene.shapes.iter().enumerate().filter(|(other, _)| *other != index);
        others.into_iter().any(|(_, other)| {
            let (low, high) = other.geometry.bounds();
            let deepest = Vec3::select(dark.cmpgt(Vec3::ZERO), high, low);
            dark.dot(deepest - corner) > depth
        })
    })
}

fn object(scene: &Scene, index: usize, casting: Casting, settings: &RasterSettings) -> Object {
    let shape = &scene.shapes[index];
    let material = scene.material_of(shape);
    let own_lit_side = settings.fake == Fake::Fair && casting == Casting::BothSides;
    let mut object = Object {
        reflectivity: material.fake.reflectivity,
        specular: material.fake.specular,
        shininess: material.fake.shininess,
        diffuse: settings.knobs.diffuse.unwrap_or(1.0),
        slack: if own_lit_side { settings.knobs.filter.reach() } else { 0.0 },
        ..Object::zeroed()
    };
    match &material.bsdf {
        Bsdf::Diffuse { albedo: colour } | Bsdf::MetallicRoughness(MetallicRoughness { base_colour: colour, .. }) => {
            paint(&mut object, colour);
        }
        Bsdf::Mirror { reflectance } => (object.even, object.odd) = (*reflectance, *reflectance),
        // as a mirror, whose highlight is as wide as the metal's lobe
        Bsdf::RoughConductor { conductor, .. } => {
            (object.even, object.odd) = (conductor.at_normal_incidence(), conductor.at_normal_incidence());
        }
        Bsdf::Dielectric { ior } => {
            object.kind = 1;
            object.refraction_ratio = material.fake.refraction_ratio.unwrap_or(1.0 / ior);
        }
    }
    if let Some(emission) = material.emission {
        object.emission = emission.radiance;
        object.emitting_sides = if emission.two_sided { 2 } else { 1 };
    }
    object
}

fn paint(object: &mut Object, colour: &Texture) {
    match colour {
        Texture::Constant(colour) | Texture::Image { factor: colour, .. } => {
            (object.even, object.odd) = (*colour, *colour);
        }
        Texture::Checkerboard(board) => {
            (object.even, object.odd) = (board.even, board.odd);
            (object.origin, object.cells_per_unit) = (board.origin, board.cells_per_unit());
        }
    }
}
