//! The type: Inter in two weights (assets/README.md says where it comes from); and text drawn in it where there is no window, laid out
//! by egui's own layout.

use egui::epaint::text::{Galley, LayoutJob, TextOptions, TextWrapping};
use egui::epaint::{FontColorTransferFunction, Fonts};
use egui::{Color32, FontData, FontDefinitions, FontFamily, FontId, TextFormat};
use film::colour::{srgb_decode, srgb_encode};
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

/// Height of Inter's capitals as a share of its size (`capHeight` over `unitsPerEm` of the font).
pub const CAPITALS: f32 = 0.727;

/// An opaque picture of sRGB bytes, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Canvas {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// A pixel after the other.
    pub pixels: Vec<[u8; 3]>,
}

impl Canvas {
    /// A picture of one colour.
    pub fn filled(size: (u32, u32), colour: [u8; 3]) -> Self {
        Canvas { size, pixels: vec![colour; size.0 as usize * size.1 as usize] }
    }

    /// The pixel there; `None` outside.
    pub fn at_mut(&mut self, x: i64, y: i64) -> Option<&mut [u8; 3]> {
        let (x, y) = (u32::try_from(x).ok()?, u32::try_from(y).ok()?);
        let inside = x < self.size.0 && y < self.size.1;
        inside.then(|| &mut self.pixels[y as usize * self.size.0 as usize + x as usize])
    }

    /// Lays a picture of RGBA bytes, all opaque, over this one, its upper left corner at `at`.
    pub fn place(&mut self, (left, top): (u32, u32), (width, rgba): (u32, &[u8])) {
        for (y, row) in (i64::from(top)..).zip(rgba.chunks_exact(4 * width.max(1) as usize)) {
            for (x, pixel) in (i64::from(left)..).zip(row.chunks_exact(4)) {
                if let Some(under) = self.at_mut(x, y) {
                    under.copy_from_slice(&pixel[..3]);
                }
            }
        }
    }

    /// Fills a rectangle that begins there and is so wide and high, as far as it is inside.
    pub fn fill(&mut self, (left, top): (i64, i64), (width, height): (u32, u32), colour: [u8; 3]) {
        for y in top..top + i64::from(height) {
            for x in left..left + i64::from(width) {
                self.at_mut(x, y).into_iter().for_each(|pixel| *pixel = colour);
            }
        }
    }

    /// All pixels as bytes of RGBA, opaque, rows from the top.
    pub fn rgba(&self) -> Vec<u8> {
        self.pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect()
    }
}

/// How a text looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Type {
    /// Size of the type in pixels; its capitals are [`CAPITALS`] of that.
    pub size: f32,
    /// Whether it is a heading.
    pub semi_bold: bool,
    /// The colour that letters are drawn in, as sRGB bytes.
    pub colour: [u8; 3],
}

/// The font, and the glyphs of it that were drawn so far.
pub struct Lettering(Fonts);

impl Default for Lettering {
    fn default() -> Self {
        let options = TextOptions {
            max_texture_side: 8192,
            // how much of a pixel a glyph covers, which is all that is blended by
            color_transfer_function: FontColorTransferFunction::Off,
            ..TextOptions::default()
        };
        Lettering(Fonts::new(options, font_definitions(REGULAR)))
    }
}

impl Lettering {
    /// Breaks a text into at most so many lines of a width in pixels; what has no room ends in an ellipsis.
    pub fn lay_out(&mut self, text: &str, look: Type, width: u32, most_lines: usize) -> Galley {
        let family = if look.semi_bold { FontFamily::Name(SEMI_BOLD.into()) } else { FontFamily::Proportional };
        let printable: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let [r, g, b] = look.colour;
        let format = TextFormat::simple(FontId::new(look.size, family), Color32::from_rgb(r, g, b));
        let mut job = LayoutJob::single_section(printable, format);
        job.wrap = TextWrapping { max_width: width as f32, max_rows: most_lines, ..TextWrapping::default() };
        self.0.layout_uncached(1.0, Arc::new(job))
    }

    /// Draws what was laid out, its upper left corner at `at`. Returns how high it is.
    pub fn draw(&mut self, canvas: &mut Canvas, text: &Galley, at: (u32, u32), colour: [u8; 3]) -> u32 {
        let atlas = self.0.image();
        for row in &text.rows {
            for glyph in row.row.glyphs.iter().filter(|glyph| !glyph.uv_rect.is_nothing()) {
                // as egui's tessellator places it
                let left_top = (row.pos + glyph.pos.to_vec2() + glyph.uv_rect.offset).round();
                let (left, top) = (i64::from(at.0) + left_top.x as i64, i64::from(at.1) + left_top.y as i64);
                let ([u0, v0], [u1, v1]) = (glyph.uv_rect.min, glyph.uv_rect.max);
                for (y, v) in (top..).zip(v0..v1) {
                    for (x, u) in (left..).zip(u0..u1) {
                        let covered = atlas[(usize::from(u), usize::from(v))].a();
                        canvas.at_mut(x, y).into_iter().for_each(|under| cover(under, colour, covered));
                    }
                }
            }
        }
        text.rect.height().ceil() as u32
    }
}

/// Lays a colour over a pixel of which it covers so many of 255 parts, in linear light.
fn cover(under: &mut [u8; 3], colour: [u8; 3], covered: u8) {
    let share = f32::from(covered) / 255.0;
    let linear = |code: u8| srgb_decode(f32::from(code) / 255.0);
    for (under, over) in under.iter_mut().zip(colour) {
        let light = linear(*under) + share * (linear(over) - linear(*under));
        *under = (255.0 * srgb_encode(light)).round() as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLACK: [u8; 3] = [0; 3];
    const WHITE: [u8; 3] = [255; 3];

    /// Rows and columns in which anything is drawn, first and behind the last.
    fn inked(canvas: &Canvas) -> Option<[u32; 4]> {
        let width = canvas.size.0 as usize;
        let inked = (0..canvas.pixels.len()).filter(|i| canvas.pixels[*i][0] > 127);
        inked.map(|i| ((i % width) as u32, (i / width) as u32)).fold(None, |found, (x, y)| {
            let [left, top, right, bottom] = found.unwrap_or([x, y, x + 1, y + 1]);
            Some([left.min(x), top.min(y), right.max(x + 1), bottom.max(y + 1)])
        })
    }

    fn drawn(text: &str, size: f32) -> Canvas {
        let mut canvas = Canvas::filled((400, 200), BLACK);
        let mut lettering = Lettering::default();
        let galley = lettering.lay_out(text, Type { size, semi_bold: false, colour: WHITE }, 400, 1);
        lettering.draw(&mut canvas, &galley, (10, 20), WHITE);
        canvas
    }

    #[test]
    fn capitals_are_as_high_as_the_font_says() {
        for size in [20.0, 34.0, 100.0] {
            let [left, top, _, bottom] = inked(&drawn("H", size)).unwrap();
            let height = (bottom - top) as f32;
            assert!((height - CAPITALS * size).abs() <= 1.0, "{size}: {height}");
            assert!(left >= 10 && top > 20, "{left} {top}");
        }
    }

    #[test]
    fn a_text_is_one_letter_after_the_other() {
        let width = |text: &str| inked(&drawn(text, 40.0)).map(|[left, _, right, _]| right - left).unwrap();
        let letters = ["H", "HH", "HHH"].map(width);
        assert!((letters[2] - letters[1]).abs_diff(letters[1] - letters[0]) <= 1, "{letters:?}");
        let look = Type { size: 40.0, semi_bold: false, colour: WHITE };
        let laid_out = |text: &str| Lettering::default().lay_out(text, look, 400, 1).rect.width();
        let advance = laid_out("HH") - laid_out("H");
        assert!((letters[1] - letters[0]).abs_diff(advance.round() as u32) <= 1, "{letters:?}: {advance}");
        assert_eq!(drawn("a\nb", 40.0), drawn("a b", 40.0), "a line stays one");
        assert_eq!(inked(&drawn(" ", 40.0)), None);
    }

    #[test]
    fn what_has_no_room_is_broken_and_ends_in_an_ellipsis() {
        let mut lettering = Lettering::default();
        let look = Type { size: 30.0, semi_bold: true, colour: WHITE };
        let text = "path tracing with light sampling and roulette by throughput";
        let galley = lettering.lay_out(text, look, 300, 2);
        assert!(galley.rows.len() == 2 && galley.elided && galley.rect.width() <= 300.0, "{:?}", galley.rect);
        assert!(!lettering.lay_out("path", look, 300, 2).elided);
        let unbroken = lettering.lay_out(&"m".repeat(200), look, 300, 1);
        assert!(unbroken.rect.width() <= 300.0 && unbroken.elided, "{:?}", unbroken.rect);
    }
}
