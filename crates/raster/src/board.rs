//! The checkerboard as a texture: what the tutorial's slide of other solutions calls texture mapping.

use scene::ImageTexture;
use scene::image_texture::Sampling;
use std::sync::{Arc, LazyLock};

/// Texels along a side of a cell. Nearer than that texels are larger than pixels, and its sides blur.
const TEXELS_PER_CELL: u32 = 256;

/// Two by two cells, which repeat: 1 where a cell is even. Shared, so that it is brought to a device once.
pub fn mask() -> &'static Arc<ImageTexture> {
    static MASK: LazyLock<Arc<ImageTexture>> = LazyLock::new(|| Arc::new(two_by_two(TEXELS_PER_CELL)));
    &MASK
}

fn two_by_two(per_cell: u32) -> ImageTexture {
    let side = 2 * per_cell;
    let even = |at: u32| (at % side / per_cell + at / side / per_cell).is_multiple_of(2);
    let texel = |at: u32| [f32::from(u8::from(even(at))), 0.0, 0.0, 1.0];
    match ImageTexture::new(side, side, (0..side * side).map(texel).collect(), Sampling::default()) {
        Some(image) => image,
        None => unreachable!("as many texels as the size says"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_of_the_mask_alternate_along_both_axes() {
        let image = two_by_two(2);
        let row = |y: usize| image.texels()[4 * y..][..4].iter().map(|texel| texel[0]).collect::<Vec<_>>();
        assert_eq!([row(0), row(1)], [[1.0, 1.0, 0.0, 0.0]; 2]);
        assert_eq!([row(2), row(3)], [[0.0, 0.0, 1.0, 1.0]; 2]);
    }
}
