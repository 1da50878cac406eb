//! What a scene may be, but is seldom meant to be: no light, a lamp that shines into a wall, a camera inside a ball.
//! Each is one line with its cure. All are guesses of a moment, for no ray is traced through the scene.

mod lamp;

use crate::{Bsdf, Camera, Geometry, Scene, Shape, Vec3, nesting};

/// Degrees below the horizon from which on a sun is not one that sets.
const DUSK: f32 = 5.0;

/// Shapes that are tried as what the camera should look at: each is tested against all.
const MOST_TARGETS: usize = 64;

impl Scene {
    /// What is probably not meant, and what of the scene's files is not shown: a line each.
    pub fn notes(&self) -> Vec<String> {
        let doubts = [
            self.without_light(),
            self.without_sight(),
            self.without_places_in_pictures(),
            self.camera_in_a_solid(),
            self.light_in_a_solid(),
            lamp::that_shines_into_a_wall(self).or_else(|| lamp::that_shines_at_nothing(self)),
            self.sun_from_below(),
            self.angles_in_radians(),
        ];
        let of_pictures = self.environment.iter().flat_map(|map| map.notes()).cloned();
        let remarks = self.remarks.iter().cloned();
        remarks.chain(of_pictures).chain(doubts.into_iter().flatten()).collect()
    }

    fn without_light(&self) -> Option<String> {
        let some = |light: Vec3| light.max_element() > 0.0;
        let lit = some(self.sky)
            || self.sun.is_some_and(|sun| some(sun.irradiance))
            || self.point_lights.iter().any(|point| some(point.intensity))
            || self.shapes.iter().any(|shape| self.material_of(shape).shines());
        (!lit).then(|| {
            "the scene has no light, so that all is black: add [sky] with radiance = [1, 1, 1], a [sun], or a shape \
             whose material is emissive"
                .into()
        })
    }

    /// Whether the camera looks past all shapes, however wide the picture.
    fn without_sight(&self) -> Option<String> {
        if self.shapes.is_empty() {
            let nothing = self.environment.is_none();
            return nothing.then(|| {
                "the scene has no shapes: a scene file takes a [[sphere]], a [[rectangle]] or another, and a model has to \
                 be exported with its meshes"
                    .into()
            });
        }
        if self.shapes.iter().any(|shape| may_be_seen(&self.camera, &shape.geometry)) {
            return None;
        }
        let (lo, hi) = self.bounds();
        let cure = match self.target_that_shows_something() {
            Some(target) => format!("write target = {target}"),
            None => "move its eye".into(),
        };
        Some(format!(
            "the camera looks past every shape: its eye is {}, its target {}, and the shapes lie between {lo} and {hi}; \
             {cure}",
            self.camera.eye, self.camera.target
        ))
    }

    /// Shapes in pictures that do not say which part of these lies where.
    fn without_places_in_pictures(&self) -> Option<String> {
        let placed = |shape: &Shape| shape.geometry.mesh_of().is_some_and(|mesh| !mesh.uvs().is_empty());
        let lacks = |shape: &&Shape| !placed(shape) && self.material_of(shape).has_images();
        let mut lacking = self.shapes.iter().filter(lacks);
        let first = self.named(lacking.next()?);
        let others = match lacking.count() {
            0 => String::new(),
            count => format!(" (and so {count} more)"),
        };
        Some(format!(
            "the {first} has no texture coordinates{others}, so that its picture's colour at (0, 0) is everywhere: \
             pictures belong on meshes with uvs"
        ))
    }

    /// The middle of all shapes, or of one, if the camera can look there.
    fn target_that_shows_something(&self) -> Option<Vec3> {
        let (lo, hi) = self.bounds();
        let middles = self.shapes.iter().take(MOST_TARGETS).map(|shape| shape.geometry.center());
        let targets = std::iter::once(0.5 * (lo + hi)).chain(middles).map(|target| target.map(tidy));
        targets.into_iter().find(|target| {
            let camera = Camera { target: *target, ..self.camera };
            camera.fault().is_none() && self.shapes.iter().any(|shape| may_be_seen(&camera, &shape.geometry))
        })
    }

    /// Balls and boxes that no light passes. Glass is none.
    fn solids(&self) -> impl Iterator<Item = &Shape> {
        let passes = |shape: &&Shape| matches!(self.material_of(shape).bsdf, Bsdf::Dielectric { .. });
        let solid = |shape: &&Shape| matches!(shape.geometry, Geometry::Sphere { .. } | Geometry::Box { .. });
        self.shapes.iter().filter(solid).filter(move |shape| !passes(shape))
    }

    /// A closed room has a light in it; what has none is a thing that the camera was put into.
    fn camera_in_a_solid(&self) -> Option<String> {
        let eye = self.camera.eye;
        let dark = |shape: &&Shape| nesting::holds(&shape.geometry, eye) && !self.has_light_inside(shape);
        let solid = self.solids().find(dark)?;
        Some(format!("the camera stands inside the {}, where no light comes: move its eye, {eye}", self.named(solid)))
    }

    fn has_light_inside(&self, solid: &Shape) -> bool {
        let inside = |point| nesting::holds(&solid.geometry, point);
        let glows = self.material_of(solid).emission.is_some_and(|emission| emission.two_sided);
        let touches = |lamp: &Shape| corners(&lamp.geometry).into_iter().chain([lamp.geometry.center()]).any(inside);
        let others = || self.shapes.iter().filter(|other| !std::ptr::eq(*other, solid));
        glows
            || self.point_lights.iter().any(|point| inside(point.position))
            || others().any(|lamp| self.material_of(lamp).shines() && touches(lamp))
    }

    /// A light that only its own hiding place is lit by.
    fn light_in_a_solid(&self) -> Option<String> {
        let eye = self.camera.eye;
        self.solids().filter(|solid| !nesting::holds(&solid.geometry, eye)).find_map(|solid| {
            let hides = |point: &Vec3| nesting::holds(&solid.geometry, *point);
            let point = self.point_lights.iter().map(|point| point.position).find(|point| hides(point));
            let lamps = self.shapes.iter().filter(|lamp| self.material_of(lamp).shines());
            let hidden = |lamp: &&Shape| !std::ptr::eq(*lamp, solid) && corners(&lamp.geometry).iter().all(hides);
            let lamp = lamps.into_iter().find(hidden).map(|lamp| format!("the lamp, a {},", self.named(lamp)));
            let light = point.map(|place| format!("the point light at {place}")).or(lamp)?;
            Some(format!("{light} is inside the {}, which lets no light out: move it out", self.named(solid)))
        })
    }

    fn sun_from_below(&self) -> Option<String> {
        let below = |towards: Vec3| -towards.dot(self.camera.up).clamp(-1.0, 1.0).asin().to_degrees();
        let towards = self.sun.filter(|sun| below(sun.towards) > DUSK)?.towards;
        Some(format!(
            "the sun shines from below: `towards`, here {towards}, points at the sun and not where its light goes; turn \
             its signs around"
        ))
    }

    fn angles_in_radians(&self) -> Option<String> {
        let fov = self.camera.fov_y;
        let narrow = is_usual_in_radians(fov).then(|| ("fov_y".to_owned(), fov, fov.to_degrees()));
        let boxes = self.shapes.iter().filter_map(|shape| match shape.geometry {
            Geometry::Box { turn_y, .. } => Some((format!("turn_y of the {}", self.named(shape)), turn_y)),
            _ => None,
        });
        let sky = self.environment.iter().map(|map| ("rotation of the sky".to_owned(), map.rotation()));
        let mut turns = boxes.chain(sky);
        let turned = || turns.find_map(|(what, turn)| Some((what, turn, as_if_in_radians(turn)?)));
        let (what, angle, meant) = narrow.or_else(turned)?;
        Some(format!("angles are in degrees, and {what} is {angle}: if that is radians, write {meant:.0}"))
    }

    fn named(&self, shape: &Shape) -> String {
        let kind = match shape.geometry {
            Geometry::Sphere { .. } => "sphere",
            Geometry::Rectangle { .. } => "rectangle",
            Geometry::Disk { .. } => "disk",
            Geometry::Box { .. } => "box",
            Geometry::Mesh(_) | Geometry::Instance(_) => "mesh",
        };
        format!("{kind} of '{}' around {}", self.material_of(shape).name, shape.geometry.center().map(tidy))
    }
}

/// Whether a shape's bounds reach into a picture of twice its height in width; false is certain.
fn may_be_seen(camera: &Camera, geometry: &Geometry) -> bool {
    let frame = camera.frame(2.0);
    let (width, height) = (frame.right.length(), frame.up.length());
    let (right, up) = (frame.right / width, frame.up / height);
    let corners = corners(geometry).map(|corner| corner - frame.eye);
    let beyond = |outside: &dyn Fn(Vec3) -> bool| corners.iter().all(|corner| outside(*corner));
    let depth = |p: Vec3| p.dot(frame.forward);
    !(beyond(&|p| depth(p) <= 0.0)
        || beyond(&|p| p.dot(right) > width * depth(p))
        || beyond(&|p| -p.dot(right) > width * depth(p))
        || beyond(&|p| p.dot(up) > height * depth(p))
        || beyond(&|p| -p.dot(up) > height * depth(p)))
}

/// A number without the last digits, in which rounding shows.
fn tidy(number: f32) -> f32 {
    format!("{number:.3e}").parse().unwrap_or(number)
}

/// Whether a field of view is a usual one, of 17 to 126 degrees, if it is in radians; whole and half degrees are meant.
fn is_usual_in_radians(fov: f32) -> bool {
    (0.3..=2.2).contains(&fov) && (2.0 * fov).fract() != 0.0
}

/// Degrees, a multiple of 15, if a turn is as many radians to three digits.
fn as_if_in_radians(turn: f32) -> Option<f32> {
    let degrees = 15.0 * (turn.to_degrees() / 15.0).round();
    (turn.fract() != 0.0 && degrees != 0.0 && (degrees.to_radians() - turn).abs() < 1e-3).then_some(degrees)
}

fn corners(geometry: &Geometry) -> [Vec3; 8] {
    let (lo, hi) = geometry.bounds();
    [0u8, 1, 2, 3, 4, 5, 6, 7].map(|i| {
        let side = |bit: u8, lo, hi| if i >> bit & 1 == 0 { lo } else { hi };
        Vec3::new(side(0, lo.x, hi.x), side(1, lo.y, hi.y), side(2, lo.z, hi.z))
    })
}

#[cfg(test)]
mod tests;
