//! What meshes and textures say of surfaces, as words of one buffer that shaders call `mesh_data`; and the texels of all
//! textures, in one of the device's: storage buffers are few.
//!
//! The first word stands for nothing, so that 0 is no place. Behind it lie the attributes of corners, then the rows of
//! triangles, the textures, and where lights' corners lie in textures.

use super::shape_data::Shapes;
use crate::bsdf::textures::places;
use crate::intersect::attributes::{MeshAttributes, TriangleRow};
use crate::light::Lights;
use bytemuck::Zeroable;
use gpu::upload::TexturePlan;
use gpu::{Gpu, GpuError, wgpu};
use scene::image_texture::{Sampling, Wrap};
use scene::{ImageTexture, Scene};
use std::sync::Arc;

/// Words of a corner: its normal, and its place in textures.
pub(crate) const ATTRIBUTE_WORDS: u32 = 5;
/// Words of a texture: its first texel, width, height, how it is read; matrix and offset of texture coordinates.
pub(crate) const TEXTURE_WORDS: u32 = 10;
/// Texels in a row of the device's texture, and most rows in each of its layers.
pub(crate) const TEXEL_ROW: u32 = 4096;
/// Bits that say how a texture is read: each axis has two for its wrap.
pub(crate) const WRAP_MIRROR: u32 = 2;
/// Another way to read, see [`WRAP_MIRROR`].
pub(crate) const WRAP_CLAMP: u32 = 1;
/// Another way to read, see [`WRAP_MIRROR`].
pub(crate) const BILINEAR: u32 = 16;

/// The words, and what they are found by.
#[derive(Debug)]
pub(crate) struct MeshData {
    pub words: Vec<u32>,
    /// Where the attributes begin.
    pub attributes: u32,
    /// Where the textures begin.
    pub textures: u32,
    /// Of each light where the places of its corners begin, with its material; 0 if it wears nothing.
    pub light_corners: Vec<[u32; 2]>,
    images: Vec<Arc<ImageTexture>>,
}

impl MeshData {
    /// Of a scene; surfaces get to know their rows.
    pub fn new(scene: &Scene, shapes: &mut Shapes, lights: &Lights) -> Self {
        let (images, _) = places(&scene.materials);
        let mut data =
            MeshData { words: vec![0], attributes: 1, textures: 1, light_corners: vec![[0; 2]; lights.len()], images };
        if let Some(attributes) = MeshAttributes::of(scene) {
            data.add_attributes(&attributes);
            for (surface, row) in shapes.surfaces.iter_mut().zip(&shapes.rows) {
                surface.triangle = data.add_row(row, attributes.has_normal_maps);
            }
        }
        data.add_textures();
        data.add_lights(lights);
        data
    }

    fn place(&self) -> u32 {
        self.words.len() as u32
    }

    fn add_floats(&mut self, floats: &[f32]) {
        self.words.extend(floats.iter().map(|float| float.to_bits()));
    }

    fn add_attributes(&mut self, attributes: &MeshAttributes) {
        self.attributes = self.place();
        for (normal, uv) in attributes.normals.iter().zip(&attributes.uvs) {
            self.add_floats(&[normal.x, normal.y, normal.z, uv.x, uv.y]);
        }
    }

    /// Where a row begins, 0 for one that says nothing: three entries, and a tangent where there are normal maps.
    fn add_row(&mut self, row: &TriangleRow, tangent: bool) -> u32 {
        if row.corners == [0; 3] {
            return 0;
        }
        let place = self.place();
        self.words.extend(row.corners);
        if tangent {
            self.add_floats(&[row.tangent.x, row.tangent.y, row.tangent.z, row.handedness]);
        }
        place
    }

    fn add_textures(&mut self) {
        self.textures = self.place();
        let mut first = 0;
        for image in self.images.clone() {
            let (width, height) = image.size();
            let Sampling { wrap, bilinear, turn_and_scale, offset } = image.sampling;
            let bits = wrap_bits(wrap[0]) | wrap_bits(wrap[1]) << 2 | if bilinear { BILINEAR } else { 0 };
            self.words.extend([first, width, height, bits]);
            self.add_floats(&turn_and_scale.to_cols_array());
            self.add_floats(&offset.to_array());
            first += width * height;
        }
    }

    fn add_lights(&mut self, lights: &Lights) {
        let Some(textured) = &lights.textured else { return };
        for light in 0..lights.len() {
            if let Some(worn) = textured.worn(light) {
                self.light_corners[light] = [self.place(), worn.material as u32];
                self.add_floats(worn.uvs.map(|uv| uv.to_array()).as_flattened());
            }
        }
    }

    /// Layers of the device's texture, and rows in each. At least two: wgpu takes a texture of one for one without
    /// layers on OpenGL, and shaders would read zeros.
    fn layers_and_rows(&self) -> [u64; 2] {
        let count: u64 = self.images.iter().map(|image| image.texels().len() as u64).sum();
        let rows = count.div_ceil(u64::from(TEXEL_ROW)).max(1);
        let layers = rows.div_ceil(u64::from(TEXEL_ROW)).max(2);
        [layers, rows.div_ceil(layers)]
    }

    /// Rows in a layer of the device's texture.
    pub fn texel_rows(&self) -> u32 {
        self.layers_and_rows()[1] as u32
    }

    /// The texels of all textures, one after the other, and black ones behind them.
    ///
    /// # Errors
    /// [`GpuError::TooManyBytes`] if they are more than the device's textures hold.
    pub fn texture(&self, gpu: &Gpu) -> Result<wgpu::Texture, GpuError> {
        let what = "the textures on surfaces";
        let ([layers, rows], row) = (self.layers_and_rows(), u64::from(TEXEL_ROW));
        let limit = u64::from(gpu.device.limits().max_texture_array_layers);
        if layers > limit {
            let [bytes, limit] = [layers, limit].map(|layers| layers * rows * row * 16);
            return Err(GpuError::TooManyBytes { what: what.to_owned(), bytes, limit });
        }
        let count = (row * rows * layers) as usize;
        let mut texels = Vec::with_capacity(count);
        self.images.iter().for_each(|image| texels.extend_from_slice(image.texels()));
        texels.resize(count, <[f32; 4]>::zeroed());
        let plan = TexturePlan {
            width: TEXEL_ROW,
            height: rows as u32,
            layers: layers as u32,
            samples: 1,
            format: wgpu::TextureFormat::Rgba32Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
        };
        gpu.texture_of(what, &plan, &texels)
    }
}

fn wrap_bits(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 0,
        Wrap::Clamp => WRAP_CLAMP,
        Wrap::Mirror => WRAP_MIRROR,
    }
}
