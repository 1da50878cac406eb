//! What of each shape is drawn into shadow maps.

use crate::lights::{self, AreaLight};
use crate::settings::Fake;
use crate::tessellation::unit_normal;
use crate::variant::Variant;
use scene::{Alpha, Bsdf, Geometry, Scene, Sun, Vec3};

/// What of a shape is drawn into shadow maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Casting {
    /// It casts no shadow.
    Nothing,
    /// Both sides of all of it.
    BothSides,
    /// What the light doesn't see, so that the lit side of a closed shape never shadows itself.
    BackFaces,
    /// What the light sees.
    FrontFaces,
}

/// Of all shapes of a scene; those that are not drawn cast nothing.
pub fn of_all(scene: &Scene, variants: &[Option<Variant>], fake: Fake) -> Vec<Casting> {
    let bounds: Vec<_> = scene.shapes.iter().map(|shape| shape.geometry.bounds()).collect();
    let (low, high) = scene.bounds();
    let (sun, area_light) = lights::lit(scene, Fake::Fair);
    let surroundings = Surroundings { bounds, depth: 0.01 * (high - low).length(), sun, area_light };
    let of = |(shape, variant): (usize, &Option<Variant>)| match variant {
        Some(_) => casting(scene, shape, fake, &surroundings),
        None => Casting::Nothing,
    };
    variants.iter().enumerate().map(of).collect()
}

/// As taught: rectangles (the floor) only receive; `shadowSide` draws back faces of front-sided materials, and front
/// faces of the glass, whose material is back-sided. Fair: a rectangle casts if something lies behind it, and flat
/// shapes cast their lit side too, or light would leak in along the foot of a box. What an alpha mask cuts out of a
/// sheet casts by both of its sides. Lamps cast nothing, but for what glows in places.
fn casting(scene: &Scene, index: usize, fake: Fake, surroundings: &Surroundings) -> Casting {
    let shape = &scene.shapes[index];
    let material = scene.material_of(shape);
    if material.emission.is_some() && material.surface.emission.is_none() {
        return Casting::Nothing;
    }
    let glass = matches!(material.bsdf, Bsdf::Dielectric { .. });
    match (&shape.geometry, fake) {
        (Geometry::Rectangle { .. }, Fake::AsTaught) => Casting::Nothing,
        (Geometry::Rectangle { corner, edge_u, edge_v }, Fake::Fair) => {
            let normal = unit_normal(*edge_u, *edge_v);
            if surroundings.lie_behind(index, *corner, normal) { Casting::BothSides } else { Casting::Nothing }
        }
        _ if glass => Casting::FrontFaces,
        _ if material.surface.alpha != Alpha::Opaque => Casting::BothSides,
        (Geometry::Box { .. } | Geometry::Mesh(_) | Geometry::Instance(_), Fake::Fair) => Casting::BothSides,
        _ => Casting::BackFaces,
    }
}

/// What rectangles may hide.
struct Surroundings {
    /// The box of each shape.
    bounds: Vec<(Vec3, Vec3)>,
    /// What reaches behind a plane by less does not count: a box that sinks into its floor leaves the floor out.
    depth: f32,
    sun: Option<Sun>,
    area_light: Option<AreaLight>,
}

impl Surroundings {
    /// Whether a shape other than this one reaches behind a plane as a light sees it.
    fn lie_behind(&self, index: usize, corner: Vec3, normal: Vec3) -> bool {
        let sun = self.sun.map(|sun| normal.dot(sun.towards));
        let area_light = self.area_light.map(|area_light| normal.dot(area_light.position - corner));
        [sun, area_light].into_iter().flatten().any(|side| {
            let dark = -normal * side.signum();
            let mut others = self.bounds.iter().enumerate().filter(|(other, _)| *other != index);
            others.any(|(_, (low, high))| {
                let deepest = Vec3::select(dark.cmpgt(Vec3::ZERO), *high, *low);
                dark.dot(deepest - corner) > self.depth
            })
        })
    }
}
