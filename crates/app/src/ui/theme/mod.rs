//! The themes in egui's words: [`palette`] has their colours, [`fonts`] their type. Everything stands on a grid of four points.

#[cfg(test)]
mod colour_vision;
mod fonts;
mod palette;

pub use fonts::{Sizes, figures, label, semi_bold};
pub use palette::Palette;

use crate::model::Theme;
use egui::style::{HandleShape, WidgetVisuals};
use egui::{Color32, CornerRadius, FontId, Margin, RichText, Shadow, Stroke, Style, Ui, Visuals, vec2};

/// What the windows wear: a theme at the sizes for a window of some height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dress {
    theme: Theme,
    sizes: Sizes,
}

/// Dresses all windows of a context, unless they wear just that; returns whether it had to. What is drawn in the same pass would still be in
/// the former style.
pub fn apply(theme: Theme, context: &egui::Context) -> bool {
    let id = egui::Id::unique("dress");
    let dress = Dress { theme, sizes: Sizes::of(theme, context.content_rect().height()) };
    let worn: Option<Dress> = context.data(|data| data.get_temp(id));
    if worn == Some(dress) {
        return false;
    }
    if worn.is_none_or(|worn| worn.theme != theme) {
        context.set_fonts(fonts::definitions(theme));
    }
    let of = if theme == Theme::Dark { egui::Theme::Dark } else { egui::Theme::Light };
    context.set_theme(of);
    context.set_style_of(of, style(dress));
    context.data_mut(|data| data.insert_temp(id, dress));
    true
}

/// The colours that are worn.
pub fn palette(ui: &Ui) -> &'static Palette {
    let worn: Option<Dress> = ui.ctx().data(|data| data.get_temp(egui::Id::unique("dress")));
    Palette::of(worn.map_or(Theme::default(), |dress| dress.theme))
}

/// The type of labels on pictures.
pub fn label_font(ui: &Ui) -> FontId {
    label().resolve(ui.style())
}

/// Text in the heavier weight.
pub fn bold(text: impl Into<String>) -> RichText {
    RichText::new(text).family(semi_bold())
}

fn style(Dress { theme, sizes }: Dress) -> Style {
    let palette = Palette::of(theme);
    let dark = theme == Theme::Dark;
    let visuals = if dark { Visuals::dark() } else { Visuals::light() };
    let mut style = Style { visuals, ..Style::default() };
    sizes.dress(&mut style);
    colour(&mut style.visuals, palette, theme == Theme::Projector);
    space(&mut style, sizes);
    // Ctrl+C belongs to the picture, and a label is not a text field
    style.interaction.selectable_labels = false;
    style.animation_time = 0.0;
    style
}

fn colour(visuals: &mut Visuals, palette: &Palette, projector: bool) {
    visuals.panel_fill = palette.panel;
    visuals.window_fill = palette.panel;
    visuals.extreme_bg_color = palette.ground;
    visuals.faint_bg_color = palette.card;
    // where cards are as the ground, what is typed in stands out from them
    visuals.text_edit_bg_color = (palette.ground == palette.card).then_some(palette.hovered);
    visuals.window_stroke = Stroke::new(1.0, palette.line);
    visuals.weak_text_color = Some(palette.dim);
    visuals.error_fg_color = palette.error;
    visuals.hyperlink_color = palette.accent;
    visuals.selection.bg_fill = palette.chosen;
    visuals.selection.stroke = Stroke::new(1.0, palette.text);
    visuals.window_corner_radius = CornerRadius::same(9);
    visuals.menu_corner_radius = CornerRadius::same(9);
    // soft shadows are paid for by the pixel where the processor draws
    (visuals.popup_shadow, visuals.window_shadow) = (Shadow::NONE, Shadow::NONE);
    visuals.slider_trailing_fill = true;
    visuals.handle_shape = HandleShape::Circle;
    let widgets = &mut visuals.widgets;
    let edge = if projector { palette.line } else { Color32::TRANSPARENT };
    widgets.noninteractive.fg_stroke = Stroke::new(1.0, palette.text);
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, palette.line);
    for (widget, ground) in [
        (&mut widgets.inactive, palette.card),
        (&mut widgets.hovered, palette.hovered),
        (&mut widgets.active, palette.hovered),
        (&mut widgets.open, palette.chosen),
    ] {
        dress_widget(widget, ground, edge, palette);
    }
    // the rail of a slider and the box of a check
    widgets.inactive.bg_fill = palette.chosen;
    widgets.hovered.bg_stroke = Stroke::new(1.0, palette.dim);
    widgets.active.bg_stroke = Stroke::new(1.0, palette.accent);
}

fn dress_widget(widget: &mut WidgetVisuals, ground: Color32, edge: Color32, palette: &Palette) {
    widget.bg_fill = ground;
    widget.weak_bg_fill = ground;
    widget.bg_stroke = Stroke::new(1.0, edge);
    widget.fg_stroke = Stroke::new(1.5, palette.text);
    widget.corner_radius = CornerRadius::same(6);
    widget.expansion = 0.0;
}

fn space(style: &mut Style, sizes: Sizes) {
    let unit = (sizes.body / 13.0).max(1.0);
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(8.0, 4.0);
    spacing.button_padding = vec2(8.0, 4.0);
    spacing.interact_size = vec2(28.0, (24.0 * unit).round());
    spacing.slider_rail_height = 4.0 * unit;
    spacing.icon_width = 14.0 * unit;
    spacing.icon_width_inner = 8.0 * unit;
    spacing.menu_margin = Margin::same(8);
    spacing.window_margin = Margin::same(12);
    spacing.tooltip_width = 320.0 * unit;
    spacing.scroll.floating = true;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_typed_in_stands_out_from_its_card() {
        for theme in Theme::ALL {
            let palette = Palette::of(theme);
            let mut visuals = Visuals::light();
            colour(&mut visuals, palette, theme == Theme::Projector);
            let has_an_edge = visuals.widgets.inactive.bg_stroke.color.a() > 0;
            assert!(has_an_edge || visuals.text_edit_bg_color() != palette.card, "{theme:?}");
            assert_ne!(visuals.text_edit_bg_color(), visuals.selection.bg_fill, "{theme:?}: what is chosen is seen");
        }
    }
}
