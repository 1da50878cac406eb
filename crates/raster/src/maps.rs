//! Maps that can be looked at: the texels of a cube map or a shadow map, read back and unfolded into a film.
//!
//! A cross has four columns and three rows, each face as it is seen from inside, so that neighbours join:
//!
//! ```text
//!      +y
//!  -x  -z  +x  +z
//!      -y
//! ```

use crate::cube;
use crate::error::RasterError;
use crate::lights;
use crate::plan::Plan;
use crate::settings::{Fake, RasterSettings, Show};
use crate::targets::{Layers, Targets};
use film::Film;
use film::Pixel;
use film::colour::grey_of_depth;
use gpu::upload::TexturePlan;
use gpu::{Gpu, GpuError};
use scene::Vec3;
use wgpu::TextureUsages;

pub use film::colour::DARKEST;

/// Linear grey around an unfolded map.
pub const BACKGROUND: f32 = 0.03;

/// Faces of a cross by column and row, as axes: +x, -x, +y, -y, +z, -z.
const CROSS: [[Option<usize>; 4]; 3] =
    [[None, Some(2), None, None], [Some(1), Some(5), Some(0), Some(4)], [None, Some(3), None, None]];

/// Columns and rows of a cross.
const CROSS_SHAPE: (f32, f32) = (4.0, 3.0);

/// The names of a cube map's faces, by axis as [`CROSS`] counts them.
const FACES: [&str; 6] = ["+x", "-x", "+y", "-y", "+z", "-z"];

/// Where the faces of an unfolded cube map lie in a picture of this width and height: name, and left, top and side.
pub fn faces_of_cross([width, height]: [f32; 2]) -> impl Iterator<Item = (&'static str, [f32; 3])> {
    let (columns, rows) = CROSS_SHAPE;
    let side = side_of_a_face([width, height], CROSS_SHAPE);
    let corner = move |extent: f32, count: f32, at: usize| 0.5 * extent + side * (at as f32 - 0.5 * count);
    let cells = CROSS.iter().enumerate().flat_map(|(y, row)| row.iter().enumerate().map(move |(x, axis)| (x, y, axis)));
    cells.filter_map(move |(x, y, axis)| {
        let name = FACES[(*axis)?];
        Some((name, [corner(width, columns, x), corner(height, rows, y), side]))
    })
}

/// The largest face of which so many columns and rows fit into a picture.
fn side_of_a_face([width, height]: [f32; 2], (columns, rows): (f32, f32)) -> f32 {
    (width / columns).min(height / rows)
}

/// Refuses to show what this frame does not have.
pub(crate) fn check(show: Show, plan: &Plan) -> Result<(), RasterError> {
    match show {
        Show::CubeFaces if plan.cube_maps.is_empty() => {
            Err(RasterError::NothingToShow { map: "cube map", missing: "glass" })
        }
        Show::ShadowMap if plan.shadow_layers.is_empty() => {
            Err(RasterError::NothingToShow { map: "shadow map", missing: "sun or lamp" })
        }
        _ => Ok(()),
    }
}

/// The film of a frame's map; [`check`] has let it through, and it has been drawn.
pub(crate) fn film(
    gpu: &Gpu,
    targets: Targets<'_>,
    plan: &Plan,
    settings: &RasterSettings,
) -> Result<Film, RasterError> {
    if settings.show == Show::CubeFaces {
        let cube = targets.cubes.each.first().ok_or(RasterError::Incomplete)?;
        let faces = faces(gpu, cube, 0..6)?;
        let decode = |texel: &[u8]| cube_radiance(texel, settings.fake);
        let map = Map { faces: faces.iter().map(|face| face.decoded(decode)).collect(), reach: 1.0 };
        return unfolded(settings, CROSS_SHAPE, |x, y| map.cross(x, y, cube::axis_of_layer));
    }
    let with_sun = plan.shadow_layers.start == 0;
    let layers = if with_sun { 0..1 } else { plan.shadow_layers.clone() };
    let faces = faces(gpu, &targets.shadow.map, layers)?;
    let faces: Vec<_> = faces.iter().map(|face| face.decoded(depth)).collect();
    let drawn = || faces.iter().flat_map(|face| &face.texels).copied().filter(|depth| depth.is_finite());
    let range = [drawn().fold(1.0, f32::min), drawn().fold(0.0, f32::max)];
    let reach = if with_sun { 1.0 } else { lights::area_light_reach(plan.shadow_size) };
    let faces = faces.into_iter().map(|face| face.map(|depth| Vec3::splat(grey_of_depth(depth, range)))).collect();
    let map = Map { faces, reach };
    if with_sun {
        unfolded(settings, (1.0, 1.0), |x, y| map.square(x, y))
    } else {
        unfolded(settings, CROSS_SHAPE, |x, y| map.cross(x, y, |axis| axis))
    }
}

/// One layer of a map on the CPU.
struct Face<T> {
    size: u32,
    texels: Vec<T>,
}

impl<T: Copy> Face<T> {
    fn map<U>(&self, of: impl Fn(T) -> U) -> Face<U> {
        Face { size: self.size, texels: self.texels.iter().map(|texel| of(*texel)).collect() }
    }

    /// The nearest texel to `st` in [0, 1]^2 from the top left corner.
    fn nearest(&self, s: f32, t: f32) -> Option<T> {
        let texel = |x: f32| ((x * self.size as f32) as u32).min(self.size - 1) as usize;
        self.texels.get(texel(t) * self.size as usize + texel(s)).copied()
    }
}

/// A layer's bytes as they came from the device.
struct RawFace {
    size: u32,
    bytes: Vec<u8>,
}

impl RawFace {
    fn decoded<T>(&self, of: impl Fn(&[u8]) -> T) -> Face<T> {
        let texel = (self.bytes.len() / (self.size as usize * self.size as usize)).max(1);
        Face { size: self.size, texels: self.bytes.chunks_exact(texel).map(of).collect() }
    }
}

/// Decoded faces, and the tangent of half the field of view that each was drawn with.
struct Map {
    faces: Vec<Face<Vec3>>,
    reach: f32,
}

impl Map {
    /// What lies at `x`, `y` in faces from a cross's top left corner.
    fn cross(&self, x: f32, y: f32, face_of_axis: impl Fn(usize) -> usize) -> Option<Vec3> {
        let axis = (*CROSS.get(y as usize)?.get(x as usize)?)?;
        let (s, t) = (x.fract(), y.fract());
        // the cameras along y hold their heads away from the cross's middle
        let (s, t) = if axis == 2 || axis == 3 { (1.0 - s, 1.0 - t) } else { (s, t) };
        let inner = |x: f32| 0.5 + (x - 0.5) / self.reach;
        self.faces.get(face_of_axis(axis))?.nearest(inner(s), inner(t))
    }

    fn square(&self, x: f32, y: f32) -> Option<Vec3> {
        self.faces.first().filter(|_| x < 1.0 && y < 1.0)?.nearest(x, y)
    }
}

/// A film of what `at` finds at each pixel's middle, in faces from the top left corner of the largest shape of that
/// many columns and rows that fits into its middle.
fn unfolded(
    settings: &RasterSettings,
    (columns, rows): (f32, f32),
    at: impl Fn(f32, f32) -> Option<Vec3>,
) -> Result<Film, RasterError> {
    let (width, height) = (settings.width, settings.height);
    let side = side_of_a_face([width as f32, height as f32], (columns, rows));
    let in_faces =
        |pixel: u32, pixels: u32, count: f32| (pixel as f32 + 0.5 - 0.5 * pixels as f32) / side + 0.5 * count;
    let mut film = Film::try_new(width, height).ok_or(RasterError::Memory { width, height })?;
    let coordinates = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    for (pixel, (x, y)) in film.pixels_mut().iter_mut().zip(coordinates) {
        let (x, y) = (in_faces(x, width, columns), in_faces(y, height, rows));
        let inside = x >= 0.0 && y >= 0.0;
        let radiance = inside.then(|| at(x, y)).flatten().unwrap_or(Vec3::splat(BACKGROUND));
        *pixel = Pixel::exact(radiance);
    }
    Ok(film)
}

fn faces(gpu: &Gpu, map: &Layers, layers: std::ops::Range<usize>) -> Result<Vec<RawFace>, GpuError> {
    let texture = map.all.texture();
    let plan = TexturePlan {
        width: texture.width(),
        height: texture.height(),
        layers: 1,
        samples: 1,
        format: texture.format(),
        usage: TextureUsages::COPY_DST | TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING,
    };
    let face = gpu.texture("a map's face", &plan)?;
    let copied = |layer: usize| {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("a map") });
        let from = wgpu::TexelCopyTextureInfo {
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer as u32 },
            ..texture.as_image_copy()
        };
        let extent = wgpu::Extent3d { width: plan.width, height: plan.height, depth_or_array_layers: 1 };
        encoder.copy_texture_to_texture(from, face.as_image_copy(), extent);
        gpu.checked("a map's face", || gpu.queue.submit([encoder.finish()]))?;
        Ok(RawFace { size: plan.width, bytes: gpu.read_texture("a map's face", &face)? })
    };
    layers.map(copied).collect()
}

/// Infinite where nothing was drawn, which the map keeps as 1.
fn depth(texel: &[u8]) -> f32 {
    let kept = texel.first_chunk().map_or(1.0, |bytes| f32::from_le_bytes(*bytes));
    if kept < 1.0 { kept } else { f32::INFINITY }
}

/// Bytes or half floats, by the length of a texel.
fn cube_radiance(texel: &[u8], fake: Fake) -> Vec3 {
    match (texel, fake) {
        ([r, g, b, _], Fake::AsTaught) => crate::emitted_light(&[*r, *g, *b]),
        ([r, g, b, _], Fake::Fair) => Vec3::new(f32::from(*r), f32::from(*g), f32::from(*b)) / 255.0,
        _ => {
            let channel = |at: usize| half(u16::from_le_bytes([texel[at], texel[at + 1]]));
            Vec3::new(channel(0), channel(2), channel(4))
        }
    }
}

/// The value of a finite half float: its exponent and mantissa are those of an f32, shifted and 112 powers of two too
/// low.
fn half(bits: u16) -> f32 {
    let magnitude = f32::from_bits(u32::from(bits & 0x7fff) << 13) * 2f32.powi(112);
    if bits >> 15 == 1 { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_floats_are_read() {
        for (bits, value) in
            [(0x3c00, 1.0), (0xc000, -2.0), (0x7bff, 65504.0), (0x0001, 2f32.powi(-24)), (0x3555, 0.333_251_95)]
        {
            assert_eq!(half(bits), value);
        }
    }

    /// Of a picture wider than the cross, whose faces are a third of its height.
    #[test]
    fn faces_lie_as_the_cross_is_drawn() {
        let faces: Vec<_> = faces_of_cross([500.0, 300.0]).collect();
        let at = |x: f32, y: f32| [50.0 + 100.0 * x, 100.0 * y, 100.0];
        let names = [
            ("+y", 1.0, 0.0),
            ("-x", 0.0, 1.0),
            ("-z", 1.0, 1.0),
            ("+x", 2.0, 1.0),
            ("+z", 3.0, 1.0),
            ("-y", 1.0, 2.0),
        ];
        assert_eq!(faces, names.map(|(name, x, y)| (name, at(x, y))));
    }
}
