//! Lights whose meshes wear textures: what they send out varies over them, and ends where a texture's alpha says that
//! there is no surface. A triangle is chosen by the mean of its texture, and its points are as likely as ever.
//!
//! Twin: `shaders/pathtrace/light/textured.wgsl`.

use crate::bsdf::textures::{Places, places};
use crate::intersect::cutouts::is_there;
use crate::intersect::triangle_normal;
use crate::vectors::of_lanes;
use film::colour;
use scene::glam::Vec2;
use scene::{Alpha, ImageTexture, Material, Scene, Shape, Vec3};
use simd::{Float, MOST_LANES, Vector, Word};
use std::sync::Arc;

/// What lights of a scene wear, where any wears a texture.
#[derive(Debug, Clone, Default)]
pub(crate) struct TexturedLights {
    lights: Vec<Option<Worn>>,
    images: Vec<Arc<ImageTexture>>,
    places: Vec<Places>,
    alphas: Vec<Alpha>,
}

/// What a light that is a triangle wears.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worn {
    /// Index of its material.
    pub material: usize,
    /// Places of its corners in textures.
    pub uvs: [Vec2; 3],
}

/// Points along an edge of a triangle at which its texture is looked up for the mean.
const POINTS: u32 = 8;

impl TexturedLights {
    /// Of a scene whose shapes' first lights are these, of so many; `None` if none wears a texture.
    pub fn of(scene: &Scene, light_of_shape: &[u32], count: usize) -> Option<Arc<Self>> {
        let wears = |shape: &Shape| wears_textures(scene.material_of(shape));
        let shining = scene.shapes.iter().zip(light_of_shape).filter(|(_, light)| (**light as usize) < count);
        let textured: Vec<_> = shining.filter(|(shape, _)| wears(shape)).collect();
        if textured.is_empty() {
            return None;
        }
        let mut lights = vec![None; count];
        for (shape, &first) in textured {
            let worn = triangles_of(shape).into_iter().map(|uvs| Some(Worn { material: shape.material, uvs }));
            worn.zip(&mut lights[first as usize..]).for_each(|(worn, light)| *light = worn);
        }
        let (images, places) = places(&scene.materials);
        let alphas = scene.materials.iter().map(|material| material.surface.alpha.clone()).collect();
        Some(Arc::new(TexturedLights { lights, images, places, alphas }))
    }

    /// What a light wears, if it wears anything.
    pub fn worn(&self, light: usize) -> Option<Worn> {
        self.lights[light]
    }

    /// The mean of what a light's radiance is multiplied by, weighted as its power is.
    pub fn mean(&self, light: usize, radiance: Vec3) -> f32 {
        let Some(worn) = self.lights[light] else { return 1.0 };
        let points = (0..POINTS).flat_map(|i| (0..POINTS - i).map(move |j| [i, j]));
        let place = |[i, j]: [u32; 2]| [i, j].map(|k| (k as f32 + 1.0 / 3.0) / POINTS as f32);
        let sum: Vec3 = points.clone().map(|point| self.of_worn(&worn, place(point))).sum();
        let mean = sum / points.count() as f32;
        colour::luminance(radiance * mean) / colour::luminance(radiance)
    }

    /// What a light's radiance is multiplied by at places along its edges.
    pub fn at_one(&self, light: usize, place: [f32; 2]) -> Vec3 {
        self.lights[light].map_or(Vec3::ONE, |worn| self.of_worn(&worn, place))
    }

    /// The same in lanes.
    #[inline(always)]
    pub fn at<F: Float>(&self, light: F::U, place: [F; 2]) -> Vector<F> {
        let (mut lights, [mut s, mut t]) = ([0; MOST_LANES], [[0.0; MOST_LANES]; 2]);
        light.store(&mut lights);
        place[0].store(&mut s);
        place[1].store(&mut t);
        let mut found = [Vec3::ONE; MOST_LANES];
        let textured =
            (0..F::LANES).filter(|&lane| self.lights.get(lights[lane] as usize).is_some_and(Option::is_some));
        for lane in textured {
            found[lane] = self.at_one(lights[lane] as usize, [s[lane], t[lane]]);
        }
        of_lanes(&found)
    }

    fn of_worn(&self, worn: &Worn, [s, t]: [f32; 2]) -> Vec3 {
        let [a, b, c] = worn.uvs;
        let uv = a + (b - a) * s + (c - a) * t;
        if !is_there(&self.alphas[worn.material], uv) {
            return Vec3::ZERO;
        }
        match self.places[worn.material].emission {
            0 => Vec3::ONE,
            place => self.images[place as usize - 1].at(uv).truncate(),
        }
    }
}

fn wears_textures(material: &Material) -> bool {
    material.surface.emission.is_some() || material.surface.alpha != Alpha::Opaque
}

/// Places in textures of the corners of a mesh's triangles with area, in their order; of other shapes none.
fn triangles_of(shape: &Shape) -> Vec<[Vec2; 3]> {
    let Some(mesh) = shape.geometry.mesh_of() else { return Vec::new() };
    let (positions, triangles) = shape.geometry.flat_triangles();
    let has_area = |triangle: &&[u32; 3]| triangle_normal(triangle.map(|corner| positions[corner as usize])).is_some();
    let uv = |corner: u32| mesh.uvs().get(corner as usize).copied().unwrap_or(Vec2::ZERO);
    triangles.iter().filter(has_area).map(|triangle| triangle.map(uv)).collect()
}
