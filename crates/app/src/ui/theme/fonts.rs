//! The type: Inter in two weights, its digits all of one width so that numbers stand under each other and do not jump while they change
//! (assets/README.md says where it comes from).

use crate::lettering::{REGULAR, SEMI_BOLD, font_definitions};
use crate::model::Theme;
use egui::{FontDefinitions, FontFamily, FontId, Style, TextStyle};

/// The weight of headings and of what is chosen.
pub fn semi_bold() -> FontFamily {
    FontFamily::Name(SEMI_BOLD.into())
}

/// The text of labels on pictures.
pub fn label() -> TextStyle {
    TextStyle::Name("label".into())
}

/// The lines of a label below its first one.
pub fn figures() -> TextStyle {
    TextStyle::Name("figures".into())
}

/// Sizes of type in points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sizes {
    /// Controls, and all that is not another.
    pub body: f32,
    /// The first line of a label on a picture.
    pub label: f32,
    /// The lines of a label below its first one.
    pub figures: f32,
    /// What is read last.
    pub small: f32,
}

/// Height of a row of Inter as a share of its size.
const ROW: f32 = 1.21;

/// What a row of a label on the picture takes of the window's height on a projector, so that the last row of seats reads it.
const PROJECTED: f32 = 0.04;

impl Sizes {
    /// Those of a theme in a window of this height in points. On a projector everything grows with the window.
    pub fn of(theme: Theme, height: f32) -> Self {
        match theme {
            Theme::Dark | Theme::Light => Sizes { body: 13.0, label: 14.0, figures: 12.0, small: 12.0 },
            Theme::Projector => {
                let label = (PROJECTED * height / ROW).round().clamp(18.0, 80.0);
                let [body, small] = [(0.72 * label).round().max(16.0), (0.62 * label).round().max(15.0)];
                Sizes { body, label, figures: label, small }
            }
        }
    }

    /// Gives a style these sizes.
    pub fn dress(self, style: &mut Style) {
        let sizes = [
            (TextStyle::Small, self.small),
            (TextStyle::Body, self.body),
            (TextStyle::Button, self.body),
            (TextStyle::Monospace, self.body),
            (label(), self.label),
            (figures(), self.figures),
        ];
        style.text_styles = sizes.map(|(name, size)| (name, FontId::proportional(size))).into();
        style.text_styles.insert(TextStyle::Heading, FontId::new(self.label, semi_bold()));
    }
}

/// The fonts of a theme: all of a projector's type is heavy, because thin strokes are the first that a bright room takes away.
pub fn definitions(theme: Theme) -> FontDefinitions {
    font_definitions(if theme == Theme::Projector { SEMI_BOLD } else { REGULAR })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_on_a_projector_takes_four_hundredths_of_the_height() {
        for height in [768.0, 1080.0, 1440.0] {
            let sizes = Sizes::of(Theme::Projector, height);
            assert!((sizes.label * ROW / height - PROJECTED).abs() < 0.001, "{height}: {sizes:?}");
            assert!(sizes.small <= sizes.body && sizes.body < sizes.label);
        }
        assert_eq!(Sizes::of(Theme::Dark, 720.0), Sizes::of(Theme::Dark, 1440.0));
    }
}
