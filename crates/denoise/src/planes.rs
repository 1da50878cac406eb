//! Values between two layers. Channels lie in blocks of [`BLOCK`]; a block is a plane of pixels with a border of zeros one
//! pixel wide, so that a kernel of 3 x 3 needs no test at the edges; a pixel is its block's channels side by side, so that
//! pixels are the same distance apart whatever the number of channels.

/// Channels that lie side by side: as many as the widest lanes.
pub const BLOCK: usize = simd::MOST_LANES;

/// One block's channels of one pixel.
pub type Pixel = [f32; BLOCK];

/// Pixels behind the last plane that a row of the kernel may read and nobody uses.
const SLACK: usize = 16;

/// How many channels and pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shape {
    /// Channels that hold something; they fill whole blocks.
    pub channels: usize,
    /// Columns without the border.
    pub width: usize,
    /// Rows without the border.
    pub height: usize,
}

impl Shape {
    /// Blocks of channels, the last one padded.
    pub fn blocks(self) -> usize {
        self.channels.div_ceil(BLOCK)
    }

    /// Pixels from a row to the next.
    pub fn stride(self) -> usize {
        self.width + 2
    }

    /// Pixels of a plane.
    pub fn plane(self) -> usize {
        self.stride() * (self.height + 2)
    }

    /// Pixels of all planes, and those behind the last.
    pub fn pixels(self) -> usize {
        self.blocks() * self.plane() + SLACK
    }
}

/// Planes in memory that is used again and again.
#[derive(Debug, Default)]
pub struct Planes {
    /// What they are at present.
    pub shape: Shape,
    memory: Vec<Pixel>,
}

impl Planes {
    /// Memory for so many pixels; `None` if there is not so much.
    pub fn with_room_for(pixels: usize) -> Option<Self> {
        let mut memory = Vec::new();
        memory.try_reserve_exact(pixels).ok()?;
        memory.resize(pixels, [0.0; BLOCK]);
        Some(Planes { shape: Shape::default(), memory })
    }

    /// Takes a shape for which there is room, and its border of zeros; the pixels within are whatever they were.
    pub fn reshape(&mut self, shape: Shape) {
        self.shape = shape;
        let (stride, used) = (shape.stride(), shape.blocks() * shape.plane());
        for plane in self.memory[..used].chunks_exact_mut(shape.plane()) {
            plane[..stride].fill([0.0; BLOCK]);
            plane[shape.plane() - stride..].fill([0.0; BLOCK]);
            for row in plane.chunks_exact_mut(stride) {
                row[0] = [0.0; BLOCK];
                row[stride - 1] = [0.0; BLOCK];
            }
        }
    }

    /// The plane of a block and what lies behind it.
    pub fn starting_at(&self, block: usize) -> &[Pixel] {
        &self.memory[block * self.shape.plane()..]
    }

    /// The rows of a block's plane without those of the border, each with the border's pixels at its ends.
    pub fn rows(&self, block: usize) -> impl Iterator<Item = &[Pixel]> {
        let stride = self.shape.stride();
        self.starting_at(block)[stride..].chunks_exact(stride).take(self.shape.height)
    }

    /// The planes of all blocks, to be filled.
    pub fn planes_mut(&mut self) -> impl Iterator<Item = &mut [Pixel]> {
        let (plane, used) = (self.shape.plane(), self.shape.blocks() * self.shape.plane());
        self.memory[..used].chunks_exact_mut(plane)
    }
}

/// The rows of a plane without those of the border, `count` at a time.
pub fn strips(plane: &mut [Pixel], shape: Shape, count: usize) -> impl Iterator<Item = &mut [Pixel]> {
    let stride = shape.stride();
    plane[stride..stride * (shape.height + 1)].chunks_mut(count * stride)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_shape_has_a_border_of_zeros() {
        let shape = Shape { channels: 17, width: 3, height: 2 };
        let mut planes = Planes::with_room_for(shape.pixels()).unwrap();
        planes.memory.fill([7.0; BLOCK]);
        planes.reshape(shape);
        for block in 0..2 {
            let plane = &planes.starting_at(block)[..20];
            let inside = |i: usize| (1..=3).contains(&(i % 5)) && (1..=2).contains(&(i / 5));
            assert!((0..20).all(|i| plane[i][0] == if inside(i) { 7.0 } else { 0.0 }), "{block}");
        }
    }
}
