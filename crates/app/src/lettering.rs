//! The type: Inter in two weights (assets/README.md says where it comes from); and text drawn in it without a window, as pixels, which
//! egui lays out and draws.

use egui::{Color32, ColorImage, Context, FontData, FontDefinitions, FontFamily, FontId, Galley, RawInput, Rect};
use std::sync::Arc;

/// The weight of most text.
pub const REGULAR: &str = "Inter";

/// The weight of headings and of what is chosen.
pub const SEMI_BOLD: &str = "Inter SemiBold";

/// egui's fonts led by Inter, in which most text is of this weight.
pub fn font_definitions(usual: &str) -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let data: [(&str, &'static [u8]); 2] = [
        (REGULAR, include_bytes!("../../../assets/fonts/Inter-Regular.otf")),
        (SEMI_BOLD, include_bytes!("../../../assets/fonts/Inter-SemiBold.otf")),
    ];
    for (name, bytes) in data {
        fonts.font_data.insert(name.into(), Arc::new(FontData::from_static(bytes)));
    }
    // what Inter lacks is looked for in egui's own fonts
    let others = fonts.families.get(&FontFamily::Proportional).cloned().unwrap_or_default();
    let led_by = |first: &str| std::iter::once(first.to_owned()).chain(others.iter().cloned()).collect::<Vec<_>>();
    fonts.families.insert(FontFamily::Proportional, led_by(usual));
    fonts.families.insert(FontFamily::Monospace, led_by(usual));
    fonts.families.insert(FontFamily::Name(SEMI_BOLD.into()), led_by(SEMI_BOLD));
    fonts
}

/// What draws text into pictures.
pub struct Lettering {
    context: Context,
}

/// A text that is laid out, and the glyphs that it is drawn from.
pub struct Line {
    galley: Arc<Galley>,
    glyphs: ColorImage,
}

/// Pixels of RGBA, rows from the top, that text is drawn into.
pub struct Canvas {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

impl Default for Lettering {
    fn default() -> Self {
        let context = Context::default();
        context.set_fonts(font_definitions(REGULAR));
        // as large as glyphs may become, so that the atlas takes them; fonts are there from the first pass on
        let input = RawInput { max_texture_side: Some(8192), ..RawInput::default() };
        let _ = context.run_pass(input, |_| ());
        Lettering { context }
    }
}

impl Lettering {
    /// A text of this size in pixels in one row; one that is wider than `widest` ends in dots.
    pub fn line(&self, text: &str, size: f32, strong: bool, widest: f32) -> Line {
        let family = if strong { FontFamily::Name(SEMI_BOLD.into()) } else { FontFamily::Proportional };
        let mut job = egui::text::LayoutJob::simple_singleline(text.into(), FontId::new(size, family), Color32::WHITE);
        job.wrap = egui::text::TextWrapping::truncate_at_width(widest);
        let galley = self.context.fonts_mut(|fonts| fonts.layout_job(job));
        Line { galley, glyphs: self.context.fonts(|fonts| fonts.image()) }
    }
}

impl Line {
    /// Width and height in pixels.
    pub fn size(&self) -> [f32; 2] {
        self.galley.size().into()
    }

    /// Draws it with its left upper corner at `at`.
    pub fn draw(&self, canvas: &mut Canvas, at: [f32; 2], colour: [u8; 3]) {
        for row in &self.galley.rows {
            for glyph in row.glyphs.iter().filter(|glyph| !glyph.uv_rect.is_nothing()) {
                let corner = row.pos + glyph.pos.to_vec2() + glyph.uv_rect.offset;
                let corner = [at[0] + corner.x, at[1] + corner.y].map(|side| side.round() as i64);
                self.stamp(canvas, corner, (glyph.uv_rect.min, glyph.uv_rect.max), colour);
            }
        }
    }

    /// Blends a part of the glyphs over the pixels.
    fn stamp(&self, canvas: &mut Canvas, [left, top]: [i64; 2], (min, max): ([u16; 2], [u16; 2]), colour: [u8; 3]) {
        let [width, height] = [canvas.size.0, canvas.size.1].map(i64::from);
        for (y, row) in (min[1]..max[1]).enumerate() {
            for (x, column) in (min[0]..max[0]).enumerate() {
                let (x, y) = (left + x as i64, top + y as i64);
                if !(0..width).contains(&x) || !(0..height).contains(&y) {
                    continue;
                }
                let cover = u32::from(self.glyphs[(usize::from(column), usize::from(row))].a());
                let pixel = 4 * (y * width + x) as usize;
                for (under, over) in canvas.rgba[pixel..pixel + 3].iter_mut().zip(colour) {
                    *under = ((u32::from(*under) * (255 - cover) + u32::from(over) * cover + 127) / 255) as u8;
                }
            }
        }
    }
}

impl Canvas {
    /// So many pixels of one opaque colour.
    pub fn filled(size: (u32, u32), [r, g, b]: [u8; 3]) -> Self {
        let pixels = size.0 as usize * size.1 as usize;
        Canvas { size, rgba: [r, g, b, 255].repeat(pixels) }
    }

    /// Copies a picture's pixels, whole, with its left upper corner at `at`.
    pub fn paste(&mut self, (left, top): (u32, u32), (width, height): (u32, u32), rgba: &[u8]) {
        let bytes = 4 * width as usize;
        for (row, pixels) in rgba.chunks_exact(bytes).take(height as usize).enumerate() {
            let begin = 4 * ((top as usize + row) * self.size.0 as usize + left as usize);
            self.rgba[begin..begin + bytes].copy_from_slice(pixels);
        }
    }

    /// Fills a rectangle, as far as it is inside.
    pub fn fill(&mut self, rect: Rect, [r, g, b]: [u8; 3]) {
        let side = |value: f32, most: u32| (value.round().max(0.0) as u32).min(most) as usize;
        let columns = side(rect.left(), self.size.0)..side(rect.right(), self.size.0);
        for row in side(rect.top(), self.size.1)..side(rect.bottom(), self.size.1) {
            for column in columns.clone() {
                let pixel = 4 * (row * self.size.0 as usize + column);
                self.rgba[pixel..pixel + 4].copy_from_slice(&[r, g, b, 255]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(text: &str) -> (Canvas, [f32; 2]) {
        let lettering = Lettering::default();
        let line = lettering.line(text, 24.0, false, f32::INFINITY);
        let mut canvas = Canvas::filled((200, 40), [0, 0, 0]);
        line.draw(&mut canvas, [4.0, 4.0], [255, 200, 0]);
        (canvas, line.size())
    }

    #[test]
    fn letters_are_where_their_line_is_and_nowhere_else() {
        let (canvas, [width, height]) = drawn("relMSE 0.125");
        let lit = |x: usize, y: usize| canvas.rgba[4 * (200 * y + x)] > 128;
        let inside = |x: usize, y: usize| {
            (4.0..=5.0 + width).contains(&(x as f32)) && (4.0..=5.0 + height).contains(&(y as f32))
        };
        let all = (0..40).flat_map(|y| (0..200).map(move |x| (x, y)));
        let lit: Vec<_> = all.filter(|(x, y)| lit(*x, *y)).collect();
        assert!(lit.len() > 300, "{}", lit.len());
        assert!(lit.iter().all(|(x, y)| inside(*x, *y)), "{width} x {height}");
        // full colour somewhere: strokes are wider than a pixel
        assert!(canvas.rgba.chunks(4).any(|pixel| pixel[..3] == [255, 200, 0]));
        assert_ne!(drawn("relMSE 0.125").0.rgba, drawn("relMSE 0.126").0.rgba);
    }

    #[test]
    fn a_text_that_is_too_wide_ends_in_dots_within_its_room() {
        let lettering = Lettering::default();
        let [wide, _] = lettering.line("no limit of bounces", 24.0, true, f32::INFINITY).size();
        let [cut, _] = lettering.line("no limit of bounces", 24.0, true, 100.0).size();
        assert!(wide > 150.0 && cut <= 100.0, "{wide} {cut}");
    }
}
