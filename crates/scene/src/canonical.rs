//! Bytes that say what the truth of a scene depends on, and nothing else: equal bytes, equal pictures. Hashed, they name
//! what was made of the scene. What the fake depends on beside that has bytes of its own.
//!
//! Numbers are the bits of their f32, little-endian, and 0 has no sign; lists say how long they are and choices which one
//! they are, so that no two scenes run into the same bytes. Each shape brings its material along: what materials are
//! called, how they are sorted and whether some are worn by nothing is seen in no picture. Structures are taken apart
//! without `..`: a new field does not compile before it has found its place here, or its reason not to have one.

use crate::image_texture::{Sampling, Wrap};
use crate::light::{PointLight, Spot, Sun};
use crate::material::{Alpha, Checkerboard, Emission, MetallicRoughness, NormalMap, SurfaceDetail};
use crate::stand_ins::{FakeMaterial, FakeNumbers};
use crate::{
    Bsdf, Camera, Conductor, EnvironmentMap, Geometry, ImageTexture, Instance, Material, Mesh, Scene, Shape, Texture,
};
use glam::Vec3;

/// Takes the bytes, one piece after the other.
pub struct Canonical<'a>(&'a mut dyn FnMut(&[u8]));

/// As many bytes as are hashed at once: blake3 is several times as fast on many as on the four of a number.
const CHUNK: usize = 1 << 16;

/// Stands before what few scenes have, so that the bytes of all others are what they were: no choice and no
/// list begins with it.
const EXTRA: u32 = 0xe0e0_0000;

/// A hash of all that is written.
pub fn hash(write: impl FnOnce(&mut Canonical)) -> u128 {
    let (mut hasher, mut chunk) = (blake3::Hasher::new(), Vec::with_capacity(CHUNK));
    write(&mut Canonical(&mut |piece| {
        chunk.extend_from_slice(piece);
        if chunk.len() >= CHUNK {
            hasher.update(&chunk);
            chunk.clear();
        }
    }));
    let mut half = [0; 16];
    hasher.update(&chunk).finalize_xof().fill(&mut half);
    u128::from_be_bytes(half)
}

impl Canonical<'_> {
    /// All that light meets in a scene. Not its name, not its own camera, and not the fake's numbers.
    pub fn scene(&mut self, scene: &Scene) {
        let Scene {
            name: _,
            camera: _,
            cameras: _,
            materials,
            names: _,
            variants: _,
            shapes,
            sun,
            point_lights,
            sky,
            environment,
            fake: _,
            remarks: _,
            as_read: _,
        } = scene;
        self.count(shapes.len());
        for Shape { geometry, material } in shapes.iter() {
            self.geometry(geometry);
            self.material(&materials[*material]);
        }
        self.option(sun.as_ref(), Self::sun);
        self.count(point_lights.len());
        point_lights.iter().for_each(|light| self.point_light(light));
        self.vector(*sky);
        self.option(environment.as_deref(), Self::environment);
    }

    /// What stands in for physics: the fake's numbers, and the planes between which it draws.
    pub fn fake(&mut self, scene: &Scene) {
        let Scene {
            name: _,
            camera,
            cameras: _,
            materials,
            names: _,
            variants: _,
            shapes,
            sun: _,
            point_lights: _,
            sky: _,
            environment: _,
            fake,
            remarks: _,
            as_read: _,
        } = scene;
        let Camera { eye: _, target: _, up: _, fov_y: _, near, far } = camera;
        [near, far].into_iter().for_each(|plane| self.option(plane.as_ref(), |this, distance| this.number(*distance)));
        self.count(shapes.len());
        for Shape { geometry: _, material } in shapes.iter() {
            let Material { name: _, bsdf: _, emission: _, surface: _, fake } = &materials[*material];
            self.fake_material(fake);
        }
        self.fake_numbers(fake);
    }

    /// What a camera shows. Its near and far planes are the raster's.
    pub fn camera(&mut self, camera: &Camera) {
        let Camera { eye, target, up, fov_y, near: _, far: _ } = camera;
        [eye, target, up].into_iter().for_each(|v| self.vector(*v));
        self.number(*fov_y);
    }

    /// Four bytes of a whole number, the lowest first.
    pub fn word(&mut self, word: u32) {
        (self.0)(&word.to_le_bytes());
    }

    fn count(&mut self, count: usize) {
        (self.0)(&(count as u64).to_le_bytes());
    }

    fn number(&mut self, number: f32) {
        self.word(without_sign_of_zero(number).to_bits());
    }

    pub(crate) fn vector(&mut self, v: Vec3) {
        let mut bytes = [0; 12];
        for (bytes, number) in bytes.as_chunks_mut().0.iter_mut().zip(v.to_array()) {
            *bytes = without_sign_of_zero(number).to_le_bytes();
        }
        (self.0)(&bytes);
    }

    fn option<T>(&mut self, value: Option<&T>, write: impl FnOnce(&mut Self, &T)) {
        self.word(u32::from(value.is_some()));
        if let Some(value) = value {
            write(self, value);
        }
    }

    fn material(&mut self, material: &Material) {
        let Material { name: _, bsdf, emission, surface, fake: _ } = material;
        match bsdf {
            Bsdf::Diffuse { albedo } => {
                self.word(0);
                self.texture(albedo);
            }
            Bsdf::Mirror { reflectance } => {
                self.word(1);
                self.vector(*reflectance);
            }
            Bsdf::Dielectric { ior } => {
                self.word(2);
                self.number(*ior);
            }
            Bsdf::MetallicRoughness(model) => {
                self.word(4);
                self.metallic_roughness(model);
            }
            Bsdf::RoughConductor { conductor, roughness } => {
                self.word(3);
                self.conductor(conductor);
                self.number(*roughness);
            }
        }
        self.option(emission.as_ref(), |this, Emission { radiance, two_sided }| {
            this.vector(*radiance);
            this.word(u32::from(*two_sided));
        });
        if *surface != SurfaceDetail::default() {
            self.word(EXTRA);
            self.surface(surface);
        }
    }

    fn surface(&mut self, SurfaceDetail { normal_map, alpha, emission }: &SurfaceDetail) {
        self.option(normal_map.as_ref(), |this, NormalMap { image, scale }| {
            this.content(image.content());
            this.number(*scale);
        });
        match alpha {
            Alpha::Opaque => self.word(0),
            Alpha::Mask { cutoff, factor, image } => {
                self.word(1);
                self.number(*cutoff);
                self.number(*factor);
                self.option(image.as_ref(), |this, image| this.content(image.content()));
            }
        }
        self.option(emission.as_ref(), |this, image| this.content(image.content()));
    }

    fn metallic_roughness(&mut self, model: &MetallicRoughness) {
        let MetallicRoughness { base_colour, metallic, roughness, metallic_roughness, ior } = model;
        self.texture(base_colour);
        [metallic, roughness, ior].into_iter().for_each(|number| self.number(*number));
        self.option(metallic_roughness.as_ref(), |this, image| this.content(image.content()));
    }

    /// The sixteen bytes of a hash of what is large.
    fn content(&mut self, hash: u128) {
        (self.0)(&hash.to_le_bytes());
    }

    /// All that a picture on a surface depends on.
    pub(crate) fn image_texture(&mut self, image: &ImageTexture) {
        let (width, height) = image.size();
        [width, height].into_iter().for_each(|side| self.word(side));
        image.texels().iter().flatten().for_each(|number| self.number(*number));
        let Sampling { wrap, bilinear, turn_and_scale, offset } = image.sampling;
        wrap.into_iter().for_each(|wrap| {
            self.word(match wrap {
                Wrap::Repeat => 0,
                Wrap::Clamp => 1,
                Wrap::Mirror => 2,
            })
        });
        self.word(u32::from(bilinear));
        turn_and_scale.to_cols_array().into_iter().chain(offset.to_array()).for_each(|number| self.number(number));
    }

    fn conductor(&mut self, conductor: &Conductor) {
        match conductor {
            Conductor::Constant(reflectance) => {
                self.word(0);
                self.vector(*reflectance);
            }
            Conductor::Fresnel { eta, k } => {
                self.word(1);
                [eta, k].into_iter().for_each(|v| self.vector(*v));
            }
        }
    }

    fn fake_material(&mut self, fake: &FakeMaterial) {
        let FakeMaterial { refraction_ratio, reflectivity, specular, shininess } = fake;
        self.option(refraction_ratio.as_ref(), |this, ratio| this.number(*ratio));
        [reflectivity, specular, shininess].into_iter().for_each(|number| self.number(*number));
    }

    fn fake_numbers(&mut self, fake: &FakeNumbers) {
        let FakeNumbers { ambient, intensity, light_position, shadow_half_width, shadow_map, cube_map, segments } =
            fake;
        [ambient, intensity].into_iter().for_each(|number| self.number(*number));
        self.option(light_position.as_ref(), |this, position| this.vector(*position));
        self.option(shadow_half_width.as_ref(), |this, width| this.number(*width));
        [shadow_map, cube_map, segments].into_iter().for_each(|count| self.word(*count));
    }

    fn texture(&mut self, texture: &Texture) {
        match texture {
            Texture::Constant(colour) => {
                self.word(0);
                self.vector(*colour);
            }
            Texture::Checkerboard(Checkerboard { even, odd, origin, cell }) => {
                self.word(1);
                [even, odd, origin, cell].into_iter().for_each(|v| self.vector(*v));
            }
            Texture::Image { image, factor } => {
                self.word(2);
                self.content(image.content());
                self.vector(*factor);
            }
        }
    }

    fn geometry(&mut self, geometry: &Geometry) {
        match geometry {
            Geometry::Sphere { center, radius } => {
                self.word(0);
                self.vector(*center);
                self.number(*radius);
            }
            Geometry::Rectangle { corner, edge_u, edge_v } => {
                self.word(1);
                [corner, edge_u, edge_v].into_iter().for_each(|v| self.vector(*v));
            }
            Geometry::Disk { center, normal, radius } => {
                self.word(2);
                self.vector(*center);
                self.vector(*normal);
                self.number(*radius);
            }
            Geometry::Box { corner, size, turn_y } => {
                self.word(3);
                self.vector(*corner);
                self.vector(*size);
                self.number(*turn_y);
            }
            Geometry::Mesh(mesh) if mesh.is_large() => {
                self.word(5);
                self.content(mesh.content());
            }
            Geometry::Mesh(mesh) => {
                self.word(4);
                self.mesh(mesh);
            }
            Geometry::Instance(Instance { mesh, to_world }) => {
                self.word(6);
                self.content(mesh.content());
                to_world.to_cols_array().into_iter().for_each(|number| self.number(number));
            }
        }
    }

    /// All that a mesh holds.
    pub(crate) fn mesh(&mut self, mesh: &Mesh) {
        self.count(mesh.positions().len());
        mesh.positions().iter().for_each(|position| self.vector(*position));
        self.count(mesh.triangles().len());
        for triangle in mesh.triangles() {
            (self.0)(triangle.map(u32::to_le_bytes).as_flattened());
        }
        if !mesh.normals().is_empty() {
            self.word(EXTRA);
            mesh.normals().iter().for_each(|normal| self.vector(*normal));
        }
        if !mesh.uvs().is_empty() {
            self.word(EXTRA + 1);
            mesh.uvs().iter().flat_map(|uv| uv.to_array()).for_each(|number| self.number(number));
        }
    }

    /// Its picture may hold more than its pixels, but they are all that shines.
    fn environment(&mut self, map: &EnvironmentMap) {
        let (width, height) = map.image().size();
        [width, height].into_iter().for_each(|side| self.word(side));
        map.image().radiances().iter().for_each(|radiance| self.vector(*radiance));
        self.number(map.scale());
        self.number(map.rotation());
    }

    fn sun(&mut self, Sun { towards, angular_radius, irradiance }: &Sun) {
        self.vector(*towards);
        self.number(*angular_radius);
        self.vector(*irradiance);
    }

    fn point_light(&mut self, PointLight { position, intensity, spot }: &PointLight) {
        self.vector(*position);
        self.vector(*intensity);
        if let Some(Spot { towards, inner, outer }) = spot {
            self.word(EXTRA);
            self.vector(*towards);
            [inner, outer].into_iter().for_each(|angle| self.number(*angle));
        }
    }
}

/// 0 for -0, and any other number as it is: their sum is 0.
fn without_sign_of_zero(number: f32) -> f32 {
    number + 0.0
}

#[cfg(test)]
mod tests;
