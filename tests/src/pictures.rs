//! Pictures as bytes of RGBA, rows from the top.

/// Width and height, and four bytes a pixel.
pub type Rgba<'a> = ((u32, u32), &'a [u8]);

/// Where a picture stands in another, if it does, pixel for pixel: its left upper corner.
pub fn place_of(((width, height), part): Rgba, ((whole_width, whole_height), whole): Rgba) -> Option<(u32, u32)> {
    let (right, bottom) = (whole_width.checked_sub(width)?, whole_height.checked_sub(height)?);
    let row = |pixels, width: u32, (left, top): (u32, u32), length: u32| {
        let begin = 4 * (top as usize * width as usize + left as usize);
        let pixels: &[u8] = pixels;
        &pixels[begin..begin + 4 * length as usize]
    };
    let is_at = |&(left, top): &(u32, u32)| {
        let mut rows = 0..height;
        rows.all(|y| row(part, width, (0, y), width) == row(whole, whole_width, (left, top + y), width))
    };
    (0..=bottom).flat_map(|top| (0..=right).map(move |left| (left, top))).find(is_at)
}
