//! Whether the planes that a camera states cut what it would see. Fitted planes never do.

use crate::settings::RasterSettings;
use crate::tessellation;
use scene::glam::Mat4;
use scene::{Bsdf, Camera, Scene, Shape, Vec3};
use std::fmt;

/// What lies on a plane up to rounding is not cut by it.
const ROUNDING: f32 = 1e-5;

/// The stated planes that cut something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cut {
    /// Something in the picture lies nearer than this.
    pub near: Option<f32>,
    /// Something in the picture lies farther than this.
    pub far: Option<f32>,
}

impl fmt::Display for Cut {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self.near, self.far) {
            (Some(near), Some(far)) => write!(f, "the camera's near ({near}) and far ({far}) cut parts of the scene"),
            (Some(near), None) => write!(f, "the camera's near ({near}) cuts parts of the scene"),
            (_, far) => write!(f, "the camera's far ({}) cuts parts of the scene", far.unwrap_or(f32::INFINITY)),
        }
    }
}

/// What the camera's stated planes cut of a picture of `scene`.
pub fn cut(scene: &Scene, camera: &Camera, settings: &RasterSettings) -> Option<Cut> {
    if settings.show.is_map() || (camera.near, camera.far) == (None, None) || camera.fault().is_some() {
        return None;
    }
    let frustum = Frustum {
        clip_from_world: camera.clip_from_world(settings.width as f32 / settings.height.max(1) as f32),
        eye: camera.eye,
        segments: settings.knobs.segments.unwrap_or(scene.fake.segments),
    };
    let any = |plane: Plane| scene.shapes.iter().any(|shape| frustum.sees_beyond(scene, shape, plane));
    let near = camera.near.filter(|near| any(Plane::nearer_than(near * (1.0 - ROUNDING))));
    let far = camera.far.filter(|far| any(Plane::farther_than(far * (1.0 + ROUNDING))));
    (near.is_some() || far.is_some()).then_some(Cut { near, far })
}

/// Points (x, y, w) in clip space, w along the line of sight, with `normal . p + offset` above 0.
#[derive(Debug, Clone, Copy)]
struct Plane {
    normal: Vec3,
    offset: f32,
}

/// What is in the picture lies on the inner side of each.
const SIDES: [Plane; 4] = [
    Plane { normal: Vec3::new(1.0, 0.0, 1.0), offset: 0.0 },
    Plane { normal: Vec3::new(-1.0, 0.0, 1.0), offset: 0.0 },
    Plane { normal: Vec3::new(0.0, 1.0, 1.0), offset: 0.0 },
    Plane { normal: Vec3::new(0.0, -1.0, 1.0), offset: 0.0 },
];

impl Plane {
    fn nearer_than(distance: f32) -> Plane {
        Plane { normal: Vec3::NEG_Z, offset: distance }
    }

    fn farther_than(distance: f32) -> Plane {
        Plane { normal: Vec3::Z, offset: -distance }
    }

    fn height(&self, p: Vec3) -> f32 {
        self.normal.dot(p) + self.offset
    }

    /// The part of a convex polygon on the inner side (Sutherland and Hodgman, "Reentrant polygon clipping", 1974).
    fn clipped(&self, polygon: &[Vec3]) -> Vec<Vec3> {
        let next = polygon.iter().cycle().skip(1);
        let corners = polygon.iter().zip(next).flat_map(|(&a, &b)| {
            let (at_a, at_b) = (self.height(a), self.height(b));
            let crossing = ((at_a > 0.0) != (at_b > 0.0)).then(|| a.lerp(b, at_a / (at_a - at_b)));
            [(at_a > 0.0).then_some(a), crossing]
        });
        corners.flatten().collect()
    }
}

/// What a picture shows, from the eye to infinity.
struct Frustum {
    clip_from_world: Mat4,
    eye: Vec3,
    segments: u32,
}

impl Frustum {
    fn in_clip(&self, p: Vec3) -> Vec3 {
        let clip = self.clip_from_world * p.extend(1.0);
        Vec3::new(clip.x, clip.y, clip.w)
    }

    /// Whether something of `shape` that is drawn lies in the picture, and on the inner side of `plane`.
    fn sees_beyond(&self, scene: &Scene, shape: &Shape, plane: Plane) -> bool {
        if self.misses(shape.geometry.bounds(), plane) {
            return false;
        }
        // of glass only back faces are drawn
        let glass = matches!(scene.material_of(shape).bsdf, Bsdf::Dielectric { .. });
        let drawn = |[a, b, c]: &[Vec3; 3]| !glass || (b - a).cross(c - a).dot(a - self.eye) > 0.0;
        let sees = |triangle: [Vec3; 3]| drawn(&triangle) && self.sees(triangle, plane);
        match tessellation::large_mesh(&shape.geometry) {
            Some(mesh) => {
                let mut near = tessellation::runs_of(mesh).filter(|(bounds, _)| !self.misses(*bounds, plane));
                near.any(|(_, mut triangles)| triangles.any(&sees))
            }
            None => {
                let sees = |mut triangles: &mut dyn Iterator<Item = _>| Iterator::any(&mut triangles, &sees);
                tessellation::triangles_of(&shape.geometry, self.segments, sees)
            }
        }
    }

    /// Whether all of a box lies on the outer side of `plane`, or of one of the picture's.
    fn misses(&self, bounds: (Vec3, Vec3), plane: Plane) -> bool {
        let corners = tessellation::corners(bounds).map(|corner| self.in_clip(corner));
        let outside = |side: &Plane| corners.iter().all(|corner| side.height(*corner) <= 0.0);
        outside(&plane) || SIDES.iter().any(outside)
    }

    /// Whether something of a triangle lies in the picture, and on the inner side of `plane`.
    fn sees(&self, triangle: [Vec3; 3], plane: Plane) -> bool {
        let corners = triangle.map(|corner| self.in_clip(corner));
        let planes = || [plane].into_iter().chain(SIDES);
        // most are cut by none or lie outside of one
        if planes().any(|plane| corners.iter().all(|corner| plane.height(*corner) <= 0.0)) {
            return false;
        }
        !planes().fold(corners.to_vec(), |polygon, plane| plane.clipped(&polygon)).is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::builtin;

    fn cut_by(near: Option<f32>, far: Option<f32>, eye: Vec3) -> Option<Cut> {
        let scene = builtin::named("whitted").unwrap();
        let camera = Camera { near, far, eye, ..scene.camera };
        cut(&scene, &camera, &RasterSettings::new(160, 90))
    }

    /// The tutorial's camera: glass, of whose sphere of radius 1 about a point 3.31 away the far half is drawn, and a
    /// floor that ends 30 units away; under the eye it is nearer, but out of the picture.
    #[test]
    fn stated_planes_cut_what_lies_before_and_behind_them_in_the_picture() {
        let eye = Vec3::new(7.5, 2.3, -4.2);
        assert_eq!(cut_by(None, None, eye), None);
        assert_eq!(cut_by(Some(0.1), Some(3000.0), eye), None);
        assert_eq!(cut_by(Some(2.5), Some(31.0), eye), None);
        assert_eq!(cut_by(Some(5.0), None, eye), Some(Cut { near: Some(5.0), far: None }));
        assert_eq!(cut_by(None, Some(30.0), eye), Some(Cut { near: None, far: Some(30.0) }));
        assert_eq!(cut_by(Some(5.0), Some(30.0), eye).unwrap().to_string(), {
            "the camera's near (5) and far (30) cut parts of the scene"
        });
    }
}
