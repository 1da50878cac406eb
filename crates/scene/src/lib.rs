//! What is seen, without saying how: camera, shapes, materials and lights of a [`Scene`], and the TOML file that holds
//! one.
//!
//! Right-handed, y up, lengths in scene units, colours linear RGB (Rec. 709 primaries). No GPU and no window here.

pub mod builtin;
pub mod camera;
pub mod canonical;
pub mod conductor;
pub mod direction;
pub mod edit;
pub mod environment;
pub mod file;
mod files_read;
mod hash;
pub mod image_texture;
pub mod light;
mod limits;
pub mod material;
mod mesh;
mod names;
mod nearest;
mod needs;
pub mod nesting;
mod notes;
pub mod paths;
pub mod progress;
pub mod runs;
pub mod shape;
mod smooth;
pub mod stand_ins;
pub mod statue;
mod variants;

pub use camera::{Camera, NamedCamera};
pub use conductor::Conductor;
pub use environment::EnvironmentMap;
pub use file::{SceneError, allow_files_outside, allows_files_outside, load, parse};
pub use files_read::{FileRead, FileStamp};
pub use glam::{self, Vec3};
pub use hash::SceneHash;
pub use image_texture::ImageTexture;
pub use light::{PointLight, Spot, Sun};
pub use material::{Alpha, Bsdf, Material, MetallicRoughness, NormalMap, SurfaceDetail, Texture};
pub use mesh::{Instance, Mesh, in_world};
pub use names::Names;
pub use nearest::{nearest, nearest_or_begun};
pub use needs::Needs;
pub use progress::Progress;
pub use shape::{Geometry, Shape};
pub use smooth::smooth_normals;
pub use statue::statue;
pub use variants::Variant;

use stand_ins::FakeNumbers;
use std::sync::Arc;

/// Everything a technique may look at. Written once, physically; the fake's and Whitted's views are derived from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The name shown to the user: a built-in's name, or the file's stem.
    pub name: String,
    /// Where the scene is seen from unless the user moves.
    pub camera: Camera,
    /// Cameras that the file has beside it, by name; shared.
    pub cameras: Arc<[NamedCamera]>,
    /// Materials; [`Shape::material`] indexes this list.
    pub materials: Vec<Material>,
    /// What shapes and point lights are called; shared.
    pub names: Arc<Names>,
    /// What shapes wear instead in other versions of the model, by name; shared.
    pub variants: Arc<[Variant]>,
    /// Shapes in file order; shared, because copies of a scene differ in settings and not in geometry.
    pub shapes: Arc<[Shape]>,
    /// A distant disc of light, at most one.
    pub sun: Option<Sun>,
    /// Points that shine.
    pub point_lights: Vec<PointLight>,
    /// Radiance that arrives from every direction in which nothing is hit; zero for black. Of a sky from a picture its
    /// mean, for those that know skies of one colour only: the rasterised fake.
    pub sky: Vec3,
    /// The picture that is the sky, if it is one; shared.
    pub environment: Option<Arc<EnvironmentMap>>,
    /// Numbers that stand in for physics.
    pub fake: FakeNumbers,
    /// What the file asks for and does not get, or gets otherwise: a line each.
    pub remarks: Arc<[String]>,
    /// Of what was read: what is changed afterwards does not change it.
    pub as_read: SceneHash,
}

impl Scene {
    /// The material of a shape.
    pub fn material_of(&self, shape: &Shape) -> &Material {
        &self.materials[shape.material]
    }

    /// The camera that the file calls so.
    ///
    /// # Errors
    /// A line that lists those that there are.
    pub fn camera_named(&self, name: &str) -> Result<Camera, String> {
        if let Some(found) = self.cameras.iter().find(|camera| camera.name == name) {
            return Ok(found.camera);
        }
        let names: Vec<&str> = self.cameras.iter().map(|camera| camera.name.as_str()).collect();
        let known = if names.is_empty() { "it names none".into() } else { format!("it has {}", names.join(", ")) };
        Err(format!("no camera of {} is called '{}': {known}", self.name, image_file::escaped(name)))
    }

    /// Smallest axis-parallel box around all shapes: (lower corner, upper corner). The origin twice if there are none.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let all = self.shapes.iter().map(|s| s.geometry.bounds());
        all.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((Vec3::ZERO, Vec3::ZERO))
    }

    /// Index of refraction outside over inside of the scene's first dielectric; `None` if there is no glass.
    pub fn refraction_ratio(&self) -> Option<f32> {
        self.materials.iter().find_map(|m| match m.bsdf {
            Bsdf::Dielectric { ior } => Some(1.0 / ior),
            _ => None,
        })
    }

    /// Moves the one refraction ratio (> 0) of every dielectric, and of the fake that stands for it.
    pub fn set_refraction_ratio(&mut self, ratio: f32) {
        for material in &mut self.materials {
            if let Bsdf::Dielectric { ior } = &mut material.bsdf {
                *ior = 1.0 / ratio;
                material.fake.refraction_ratio = Some(ratio);
            }
        }
    }

    /// How much of the fake's glass is its environment, in [0, 1]; `None` if there is no glass.
    pub fn reflectivity(&self) -> Option<f32> {
        let glass = |m: &&Material| matches!(m.bsdf, Bsdf::Dielectric { .. });
        self.materials.iter().find(glass).map(|m| m.fake.reflectivity)
    }

    /// Sets [`Scene::reflectivity`] of every dielectric's fake.
    pub fn set_reflectivity(&mut self, reflectivity: f32) {
        for material in &mut self.materials {
            if matches!(material.bsdf, Bsdf::Dielectric { .. }) {
                material.fake.reflectivity = reflectivity;
            }
        }
    }
}
