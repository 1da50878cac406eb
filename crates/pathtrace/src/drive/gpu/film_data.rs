//! Mirrors of the structs in `shaders/pathtrace/drive/film.wgsl`, field for field. A test compares every offset with
//! the shader compiler's. Padding is spelled out as `unused*`.

use bytemuck::{Pod, Zeroable};
use scene::{Vec3, camera};

/// A camera's axes, as in [`scene::camera::PictureFrame`].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct PictureFrame {
    /// The pinhole.
    pub eye: Vec3,
    /// Padding.
    pub unused0: u32,
    /// Unit line of sight.
    pub forward: Vec3,
    /// Padding.
    pub unused1: u32,
    /// To the right edge at distance 1.
    pub right: Vec3,
    /// Padding.
    pub unused2: u32,
    /// To the top edge at distance 1.
    pub up: Vec3,
    /// Padding.
    pub unused3: u32,
}

/// What a dispatch is asked for.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RenderParams {
    /// What the camera sees.
    pub frame: PictureFrame,
    /// Of the picture, in pixels.
    pub size: [f32; 2],
    /// The film's part at hand begins with this row ...
    pub film_row: u32,
    /// ... and these rows are sampled ...
    pub first_row: u32,
    /// One past the last of them.
    pub end_row: u32,
    /// ... between these columns.
    pub first_column: u32,
    /// One past the last of them.
    pub end_column: u32,
    /// Samples that every pixel shall have.
    pub until: u32,
    /// The picture's seed.
    pub seed: u32,
    /// Vertices at which a path may scatter; Whitted: specular scatterings along a branch.
    pub limit: u32,
    /// 1 if that is the hard cap rather than the user's wish.
    pub capped: u32,
    /// Directions at each diffuse vertex.
    pub branches: u32,
    /// Diffuse vertices of a path that may branch.
    pub branching_vertices: u32,
    /// 1 if roulette looks at the throughput.
    pub by_throughput: u32,
    /// Of surviving a vertex, beside that.
    pub probability: f32,
    /// Whitted's shadow rays to each area light.
    pub shadow_rays: u32,
    /// Whitted's ambient radiance.
    pub ambient: f32,
    /// Padding.
    pub unused: [u32; 3],
    /// Rows of the automaton that tells which light counts, see [`crate::integrator::light_paths`].
    pub light_paths: [[u32; 4]; 8],
}

/// A pixel's sums.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Pixel {
    /// Of the samples' radiance.
    pub sum: Vec3,
    /// How many samples the pixel has, those of earlier sums too.
    pub samples: u32,
    /// Of the squares.
    pub sum_of_squares: Vec3,
    /// Largest channel of a sample.
    pub largest: f32,
    /// What rounding left of the sum.
    pub sum_low: Vec3,
    /// Rays traced.
    pub rays: u32,
    /// What rounding left of the sum of squares.
    pub squares_low: Vec3,
    /// Samples that were not finite, and above them those that lost light to a cap.
    pub faults: u32,
}

/// Samples cut short are counted above this bit of [`Pixel::faults`].
pub(crate) const CUT_SHIFT: u32 = 16;

/// Samples between two readings after which no counter of a pixel has overflowed.
pub const MOST_SAMPLES: u32 = 16_384;

impl Pixel {
    /// A pixel that goes on from `samples`.
    pub fn beginning(samples: u32) -> Self {
        Pixel { samples, ..Pixel::zeroed() }
    }

    /// Adds these sums to those of a host's film; returns (rays, cut samples, samples that were not finite).
    pub fn add_to(&self, pixel: &mut film::Pixel) -> (u64, u64, u64) {
        let (sums, squares) = (self.sum.as_dvec3() + self.sum_low.as_dvec3(), self.squares());
        for channel in 0..3 {
            pixel.sum[channel] += sums[channel];
            pixel.sum_of_squares[channel] += squares[channel];
        }
        pixel.samples = self.samples;
        pixel.largest = pixel.largest.max(self.largest);
        (u64::from(self.rays), u64::from(self.faults >> CUT_SHIFT), u64::from(self.faults & ((1 << CUT_SHIFT) - 1)))
    }

    fn squares(&self) -> scene::glam::DVec3 {
        self.sum_of_squares.as_dvec3() + self.squares_low.as_dvec3()
    }
}

impl From<&camera::PictureFrame> for PictureFrame {
    fn from(frame: &camera::PictureFrame) -> Self {
        let camera::PictureFrame { eye, forward, right, up } = *frame;
        PictureFrame { eye, forward, right, up, ..PictureFrame::zeroed() }
    }
}

impl RenderParams {
    /// Of a picture of `size` seen through a frame.
    pub fn of(frame: &camera::PictureFrame, size: (u32, u32)) -> Self {
        RenderParams { frame: frame.into(), size: [size.0 as f32, size.1 as f32], ..RenderParams::zeroed() }
    }

    /// What of it a sample's cost depends on, beside what is seen: not a picture's number, nor how bright something is.
    pub fn effort(&self) -> Self {
        RenderParams { frame: PictureFrame::zeroed(), size: [0.0; 2], seed: 0, ambient: 0.0, ..*self }
    }
}
