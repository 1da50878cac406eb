//! Controls with their names: a visible one, one for screen readers and one for the dump. A number is a [`NumberRow`], words to choose from are
//! a [`choice()`], what belongs together stands on a [`card()`]. None of them knows a setting.

mod card;
mod choice;
mod icon;
mod number;
mod tooltip;

pub use card::{card, fold};
pub use choice::{choice, segmented, width_of_segments};
pub use icon::{Icon, icon_and_word, icon_button};
pub use number::{NumberRow, Scale, parse_number};
pub use tooltip::{Explained, note_panel};

use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, PopupCloseBehavior, ScrollArea, Style, Ui, vec2};

/// A menu that stays open while one uses what is in it.
pub fn menu(title: impl Into<String>) -> MenuButton<'static> {
    let stay =
        MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside).style(menu_style as fn(&mut Style));
    MenuButton::new(title.into()).config(stay)
}

/// The rows of a menu, which scroll where the window is low.
pub fn rows_of_menu(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let tallest = (ui.ctx().content_rect().height() - 100.0).max(80.0);
    ScrollArea::vertical().max_height(tallest).show(ui, contents);
}

/// egui's for menus, but with room around the words.
fn menu_style(style: &mut Style) {
    egui::containers::menu::menu_style(style);
    style.spacing.button_padding = vec2(8.0, 4.0);
}

/// A button with a ground, which menus leave out: it does something, and what has none is a choice.
pub fn framed<'a>(text: &'a str, ui: &Ui) -> Button<'a> {
    let inside_menus_too = ui.ctx().global_style().visuals.widgets.inactive.bg_fill;
    Button::new(text).fill(inside_menus_too)
}
