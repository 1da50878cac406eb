//! A frame before it is drawn: every number that the passes need, computed on the CPU.

use crate::bounce::{self, Bounce, BounceTargetPlan};
use crate::casting::{self, Casting};
use crate::cube;
use crate::gpu_data::{Lights, Object, View};
use crate::knobs::ShadowFilter;
use crate::lights;
use crate::object::object;
use crate::pipelines::Choice;
use crate::planes::Planes;
use crate::repair::{Repair, Repairs};
use crate::settings::{Fake, RasterSettings, Show};
use crate::spheres;
use crate::targets::{CubePlan, PicturePlan, ShadowPlan, TargetPlan};
use crate::variant::Variant;
use bytemuck::Zeroable;
use scene::glam::{Mat4, Vec2};
use scene::{Bsdf, Camera, Geometry, Scene, Vec3};
use std::f32::consts::SQRT_2;
use std::ops::Range;

/// How many pieces of glass get a cube map; each costs six more views of the scene.
pub const MOST_CUBE_MAPS: usize = 8;

/// Views of the shadow map: the sun's and six of the area light.
pub const SHADOW_VIEWS: usize = 7;

/// Sub-pixel positions of the fair fake's passes, in pixels from the middle: the rotated grid of 4x multisampling.
const ROTATED_GRID: [Vec2; 4] =
    [Vec2::new(-0.125, -0.375), Vec2::new(0.375, -0.125), Vec2::new(-0.375, 0.125), Vec2::new(0.125, 0.375)];

/// Those of Direct3D's standard pattern of 8 samples, in pixels from the middle.
const EIGHT_PLACES: [Vec2; 8] = {
    const fn place(x: f32, y: f32) -> Vec2 {
        Vec2::new(x / 16.0, y / 16.0)
    }
    [
        place(1.0, -3.0),
        place(-1.0, 3.0),
        place(5.0, 1.0),
        place(-3.0, -5.0),
        place(-5.0, 5.0),
        place(-7.0, -1.0),
        place(3.0, 7.0),
        place(7.0, -7.0),
    ]
};

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
    /// One for each shape; `None` where nothing of it is drawn.
    pub variants: Vec<Option<Variant>>,
    /// What each shape wears.
    pub materials: Vec<usize>,
    /// Which shadow views are drawn.
    pub shadow_layers: Range<usize>,
    /// Texels along a side of the shadow map.
    pub shadow_size: u32,
    /// The shapes that have cube maps.
    pub cube_maps: Vec<usize>,
    /// Which views see what light through spheres of glass falls on, one for each caustic map.
    pub receivers: Range<usize>,
    /// What is gathered of the second bounce.
    pub bounce: Option<Bounce>,
    /// Which views are the probes', six each, if there are some.
    pub probes: Option<Range<usize>>,
    /// Which views are the picture's.
    pub picture_views: Range<usize>,
    /// Fair or as taught.
    pub fake: Fake,
    /// What is repaired of it.
    pub repairs: Repairs,
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
        let variants: Vec<_> = scene.shapes.iter().map(|shape| Variant::of(scene, shape, settings)).collect();
        let mut casting = casting::of_all(scene, &variants, fake);
        // the shadows of these are known in closed form
        let known = spheres::casters(scene, settings);
        known.iter().for_each(|shape| casting[*shape] = Casting::Nothing);
        let mut lights = lights::lights(scene, settings, |shape| casting[shape] != Casting::Nothing);
        let repairs = settings.repairs();
        let shows_surroundings = |shape: &usize| match scene.material_of(&scene.shapes[*shape]).bsdf {
            Bsdf::Dielectric { .. } => true,
            Bsdf::Mirror { .. } => repairs.has(Repair::Mirrors),
            _ => false,
        };
        let cube_maps: Vec<_> = (0..scene.shapes.len()).filter(shows_surroundings).take(MOST_CUBE_MAPS).collect();
        let mut objects: Vec<_> =
            (0..scene.shapes.len()).map(|shape| object(scene, shape, casting[shape], settings)).collect();
        let mut views = lights.shadow_views.to_vec();
        for &shape in &cube_maps {
            objects[shape].has_cube_map = 1;
            views.extend(cube_map_views(scene, &scene.shapes[shape].geometry, settings));
        }
        let caustics = if repairs.has(Repair::Caustics) { known.len() } else { 0 };
        let receivers = views.len()..views.len() + caustics;
        views.extend((0..caustics).map(|layer| spheres::receivers_view(&lights, layer, scene)));
        let bounce = bounce::plan(scene, &lights, settings, &mut views);
        let probes = bounce::plan_probes(scene, &mut lights, settings, &mut views);
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
            variants,
            materials: scene.shapes.iter().map(|shape| shape.material).collect(),
            cube_maps,
            receivers,
            bounce,
            probes,
            fake,
            repairs,
            filter: settings.knobs.filter,
            show: settings.show,
            sky: scene.sky,
        }
    }

    /// The shapes that are drawn, all but `without`.
    pub fn drawn(&self, without: Option<usize>) -> impl Iterator<Item = (usize, Variant)> {
        let shapes = self.variants.iter().enumerate().filter(move |(shape, _)| without != Some(*shape));
        shapes.filter_map(|(shape, variant)| Some((shape, (*variant)?)))
    }

    /// What its forward passes have compiled in.
    pub fn choice(&self) -> Choice {
        Choice::of((self.fake, self.repairs), self.filter, &self.lights)
    }

    /// The targets that this frame needs.
    pub fn target_plan(&self, scene: &Scene, settings: &RasterSettings) -> TargetPlan {
        let &RasterSettings { width, height, fake, .. } = settings;
        TargetPlan {
            shadow: ShadowPlan { size: self.shadow_size, with_area_light: self.shadow_layers.end > 1 },
            cubes: CubePlan { size: scene.fake.cube_map, count: self.cube_maps.len(), fake },
            caustics: self.receivers.len(),
            bounce: (self.bounce.is_some() || self.probes.is_some()).then(|| BounceTargetPlan {
                layers: self
                    .bounce
                    .as_ref()
                    .and_then(|bounce| bounce.layers.last())
                    .map_or(0, |layer| *layer as u32 + 1),
                probes: self.probes.is_some(),
                picture: [width, height],
            }),
            picture: PicturePlan { width, height, fake, passes: passes(settings).len() as u32 },
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

/// Where in the pixels the passes over a picture look.
fn passes(settings: &RasterSettings) -> &'static [Vec2] {
    match settings.fake {
        Fake::AsTaught => &[Vec2::ZERO],
        Fake::Fair if settings.repairs().has(Repair::Antialiasing) => &EIGHT_PLACES,
        Fake::Fair => &ROTATED_GRID,
    }
}

fn picture_views(scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Vec<View> {
    let size = Vec2::new(settings.width as f32, settings.height as f32);
    let planes = Planes::of(scene, camera, size.x / size.y);
    let clip_from_world = planes.applied_to(camera.clip_from_world(size.x / size.y));
    let view = |&shift: &Vec2| View {
        clip_from_world: shifted(clip_from_world, shift, size),
        near: planes.near,
        eye: camera.eye,
        sees_cube_maps: 1,
        texel: bounce::per_pixel([settings.width, settings.height]),
        ..View::zeroed()
    };
    passes(settings).iter().map(view).collect()
}

/// The view with its pixels moved by `shift` pixels to the right and down.
fn shifted(clip_from_world: Mat4, shift: Vec2, size: Vec2) -> Mat4 {
    let by = shift * Vec2::new(2.0, -2.0) / size;
    Mat4::from_translation(by.extend(0.0)) * clip_from_world
}

/// As taught three.js' CubeCamera, whose near .1 and far 5000 are made for a glass of radius 1: here they are shares of
/// its radius. Fair it cuts nothing.
fn cube_map_views(scene: &Scene, glass: &Geometry, settings: &RasterSettings) -> [View; 6] {
    let eye = glass.center();
    let planes = match settings.fake {
        Fake::AsTaught => {
            let (low, high) = glass.bounds();
            let radius = 0.5 * (high - low).max_element();
            Planes { near: 0.1 * radius, far: 5000.0 * radius }
        }
        Fake::Fair => Planes::fitted(scene, eye, SQRT_2),
    };
    // maps show one another where mirrors have them
    let sees_cube_maps = u32::from(settings.repairs().has(Repair::Mirrors));
    let per_distance = spheres::per_distance(scene);
    std::array::from_fn(|layer| {
        let clip_from_world = cube::clip_from_world(eye, cube::axis_of_layer(layer), 1.0, planes);
        View { clip_from_world, near: planes.near, eye, sees_cube_maps, per_distance, ..View::zeroed() }
    })
}
