//! The themes in egui's words. Text keeps a contrast of 4.5:1 in the dark one and of 7:1 on the projector (WCAG 2.2,
//! success criteria 1.4.3 and 1.4.6).

use crate::model::Theme;
use egui::{Color32, FontFamily, FontId, Stroke, Style, TextStyle, Visuals};

/// Size of the type on the pictures, in points.
pub fn label_size(theme: Theme) -> f32 {
    match theme {
        Theme::Dark => 15.0,
        Theme::Projector => 19.0,
    }
}

/// Dresses all windows of a context.
pub fn apply(theme: Theme, context: &egui::Context) {
    let (of, style) = match theme {
        Theme::Dark => (egui::Theme::Dark, dark()),
        Theme::Projector => (egui::Theme::Light, projector()),
    };
    context.set_theme(of);
    context.set_style_of(of, style);
}

fn dark() -> Style {
    let mut style = Style { visuals: Visuals::dark(), ..Style::default() };
    let visuals = &mut style.visuals;
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(225);
    visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(225);
    visuals.weak_text_color = Some(Color32::from_gray(185));
    visuals.error_fg_color = Color32::from_rgb(255, 130, 130);
    visuals.selection.bg_fill = Color32::from_rgb(0, 80, 130);
    visuals.selection.stroke.color = Color32::WHITE;
    shared(&mut style);
    style
}

fn projector() -> Style {
    let mut style = Style { visuals: Visuals::light(), ..Style::default() };
    let visuals = &mut style.visuals;
    visuals.panel_fill = Color32::WHITE;
    visuals.window_fill = Color32::WHITE;
    visuals.extreme_bg_color = Color32::from_gray(232);
    visuals.weak_text_color = Some(Color32::from_gray(60));
    visuals.error_fg_color = Color32::from_rgb(150, 0, 0);
    visuals.selection.bg_fill = Color32::from_rgb(0, 60, 150);
    visuals.selection.stroke.color = Color32::WHITE;
    for widget in [&mut visuals.widgets.inactive, &mut visuals.widgets.hovered, &mut visuals.widgets.open] {
        (widget.bg_fill, widget.weak_bg_fill) = (Color32::from_gray(222), Color32::from_gray(222));
        // what can be used stands out from the ground by 3:1 (WCAG 1.4.11)
        widget.bg_stroke = Stroke::new(1.0, Color32::from_gray(120));
        widget.fg_stroke = Stroke::new(1.5, Color32::BLACK);
    }
    visuals.widgets.noninteractive.fg_stroke.color = Color32::BLACK;
    visuals.widgets.noninteractive.bg_stroke.color = Color32::from_gray(120);
    visuals.widgets.active.fg_stroke.color = Color32::BLACK;
    let sizes = [
        (TextStyle::Small, 18.0),
        (TextStyle::Body, 18.0),
        (TextStyle::Button, 18.0),
        (TextStyle::Heading, 22.0),
        (TextStyle::Monospace, 18.0),
    ];
    style.text_styles = sizes
        .map(|(name, size)| {
            let family = if name == TextStyle::Monospace { FontFamily::Monospace } else { FontFamily::Proportional };
            (name, FontId::new(size, family))
        })
        .into();
    shared(&mut style);
    style
}

fn shared(style: &mut Style) {
    // Ctrl+C belongs to the picture, and a label is not a text field
    style.interaction.selectable_labels = false;
    style.visuals.slider_trailing_fill = true;
    style.animation_time = 0.0;
    style.spacing.item_spacing = egui::vec2(6.0, 4.0);
}
