//! Light apart: which light counts, by names with their number or by an expression that is typed, and bars of how much
//! light each bounce brings.

use super::setting::Place;
use crate::model::{LightByBounce, PaneId, light_parts};
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, NumberRow, Scale, choice, fold};
use egui::{Align2, Key, Rect, Role, Sense, Stroke, StrokeKind, TextEdit, TextStyle, Ui, WidgetInfo, pos2, vec2};
use pathtrace::{LightPaths, NamedLightPaths};
use technique::settings::{Value, light_words, of_panes};

/// An expression to begin with, where what is chosen has none that fits.
const EXAMPLE: &str = "LS+DE";

/// What stands behind each word.
const WORDS: [(&str, &str); 7] = [
    ("all", "All light"),
    (
        "direct",
        "Ldir: straight from a light to the first surface that is not mirror or glass, and lights themselves: L[DG]?S*E",
    ),
    ("indirect", "Lindir: all but the direct light, L.+[DG]S*E"),
    ("emitted", "Lights themselves, LE"),
    ("bounce", "One bounce alone, counted as the limit of bounces is: 0 is one scattering vertex, L.E"),
    ("up to", "What a limit of so many bounces shows"),
    (
        "paths",
        "Paths in Heckbert's notation, from the light L by surfaces D (diffuse), G (rough metal), S (mirror or glass) or . (any) \
         to the eye E, with * + ? | ( ) [ ]",
    ),
];

impl Place<'_> {
    /// The words, and what the chosen one needs to be said.
    pub(super) fn light_paths(
        &mut self,
        (name, label, hover): (&str, &str, &str),
        paths: LightPaths,
        ui: &mut Ui,
    ) -> Option<Value> {
        ui.label(egui::RichText::new(label).color(palette(ui).dim)).explained(hover);
        let chosen = word_of(paths);
        let words = WORDS.map(|(word, hover)| (word.to_owned(), hover, WORDS[chosen].0 == word));
        let clicked = choice((name, label), words, ui, self.dump).map(|index| named_by(index, paths));
        let typed = match paths.named() {
            Some(NamedLightPaths::Bounce(bounces)) => self.bounce(name, bounces, ui).map(NamedLightPaths::Bounce),
            Some(NamedLightPaths::UpTo(bounces)) => self.bounce(name, bounces, ui).map(NamedLightPaths::UpTo),
            _ => None,
        };
        let typed = typed.map(LightPaths::from).or_else(|| {
            let is_expression = chosen == WORDS.len() - 1;
            is_expression.then(|| self.expression(name, paths, ui)).flatten()
        });
        clicked.or(typed).filter(|new| *new != paths).map(Value::LightPaths)
    }

    fn bounce(&mut self, name: &str, bounces: u32, ui: &mut Ui) -> Option<u32> {
        let mut number = f64::from(bounces);
        let row = NumberRow {
            name: &format!("{name} bounce number"),
            label: "Bounce",
            hover: "Scattering vertices after the first, as the limit of bounces counts them",
            scale: Scale::Whole(0..=NamedLightPaths::MOST_BOUNCES),
            bounds: 0.0..=f64::from(NamedLightPaths::MOST_BOUNCES),
            unit: "",
            aside: String::new(),
            resets: true,
            tint: palette(ui).slider(self.pane.map(|(pane, _)| pane)),
        };
        let told = row.show(&mut number, ui, self.dump);
        self.fault = told.fault.or(self.fault.take());
        if told.reset { Some(0) } else { told.changed.then_some(number as u32) }
    }

    /// A line that counts once Enter is pressed or the keyboard goes elsewhere, and is kept as typed where it says nothing.
    fn expression(&mut self, name: &str, paths: LightPaths, ui: &mut Ui) -> Option<LightPaths> {
        let id = ui.make_persistent_id((name, "expression"));
        let (of, mut text) =
            ui.data(|data| data.get_temp::<(LightPaths, String)>(id)).unwrap_or((paths, paths.to_string()));
        if of != paths {
            text = paths.to_string();
        }
        let edit = TextEdit::singleline(&mut text)
            .background_color(palette(ui).panel)
            .id(id.with("line"))
            .desired_width(f32::INFINITY)
            .hint_text(EXAMPLE);
        let line = ui.add(edit).explained(WORDS[WORDS.len() - 1].1).accessible_name("Light paths");
        let done = line.lost_focus() && !ui.input(|input| input.key_pressed(Key::Escape));
        self.dump.note(&format!("{name} expression"), &text, line);
        let read = done.then(|| LightPaths::parse(&text));
        ui.data_mut(|data| data.insert_temp(id, (paths, text)));
        match read? {
            Ok(read) => Some(read),
            Err(why) => {
                self.fault = Some(format!("light paths: {why}"));
                None
            }
        }
    }
}

/// Which of [`WORDS`] says these paths.
fn word_of(paths: LightPaths) -> usize {
    match paths.named() {
        Some(NamedLightPaths::All) => 0,
        Some(NamedLightPaths::Direct) => 1,
        Some(NamedLightPaths::Indirect) => 2,
        Some(NamedLightPaths::Emitted) => 3,
        Some(NamedLightPaths::Bounce(_)) => 4,
        Some(NamedLightPaths::UpTo(_)) => 5,
        Some(NamedLightPaths::From(_)) | None => 6,
    }
}

/// What one of [`WORDS`] stands for beside what was chosen before: a number stays, and so do paths as an expression.
fn named_by(word: usize, before: LightPaths) -> LightPaths {
    let bounces = match before.named() {
        Some(NamedLightPaths::Bounce(bounces) | NamedLightPaths::UpTo(bounces) | NamedLightPaths::From(bounces)) => {
            bounces
        }
        _ => 0,
    };
    match word {
        0 => LightPaths::ALL,
        1 => NamedLightPaths::Direct.into(),
        2 => NamedLightPaths::Indirect.into(),
        3 => NamedLightPaths::Emitted.into(),
        4 => NamedLightPaths::Bounce(bounces).into(),
        5 => NamedLightPaths::UpTo(bounces).into(),
        _ => expression_of(before),
    }
}

fn expression_of(paths: LightPaths) -> LightPaths {
    let expression = match paths.named() {
        Some(NamedLightPaths::All) => EXAMPLE.into(),
        Some(named) => named.expression(),
        None => return paths,
    };
    LightPaths::parse(&expression).or_else(|_| LightPaths::parse(EXAMPLE)).unwrap_or_default()
}

/// Height of a bar with the space below it, in points.
const ROW: f32 = 15.0;
/// What is left of the bars for their names, and right for their shares.
const NAMES: f32 = 40.0;
const SHARES: f32 = 52.0;
/// The smallest share that has a bar: one part in ten thousand.
const DECADES: f64 = 4.0;

/// Bars of the light by bounce, folded away; a bar that is clicked shows its light alone, and once more all of it.
pub fn bars(cx: &mut UiContext, pane: PaneId, ui: &mut Ui) {
    let id = ui.make_persistent_id(("light by bounce", pane));
    let mut chosen = None;
    let (header, open) = fold("Light by bounce", Some(palette(ui).dim), (id, false), ui, |ui| {
        cx.model.state.light_bars.push(pane);
        chosen = match cx.shown.light.get(pane) {
            Some(light) => drawn(cx, pane, light, ui),
            None => waiting("measuring ...", ui),
        };
    });
    cx.dump.note(&format!("{pane} light by bounce"), open, header);
    if let (Some(paths), Some(row)) = (chosen, of_panes("light")) {
        cx.model.session.panes[pane].set(row, Value::LightPaths(paths));
    }
}

/// In the place of the bars, so that nothing below them moves when they come.
fn waiting(words: &str, ui: &mut Ui) -> Option<LightPaths> {
    let label = ui.label(egui::RichText::new(words).color(palette(ui).dim));
    let bars = light_parts().count() as f32;
    ui.add_space(bars * (ROW + ui.spacing().item_spacing.y) - label.rect.height() - ui.spacing().item_spacing.y);
    None
}

fn drawn(cx: &mut UiContext, pane: PaneId, light: &LightByBounce, ui: &mut Ui) -> Option<LightPaths> {
    let Some(shares) = light.shares() else {
        let complete = light.luminances.len() == light_parts().count();
        return waiting(if complete { "no light comes here" } else { "measuring ..." }, ui);
    };
    let now = cx.model.session.panes[pane].in_use().light();
    let mut clicked = None;
    for (part, share) in light_parts().zip(shares) {
        let paths = LightPaths::from(part);
        let words = format!("{}: {}", light_words(paths), told(share));
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
        response.widget_info(|| WidgetInfo::selected(Role::Button, true, paths == now, &words));
        paint(ui, rect, (part, share), (pane, paths == now, response.hovered() || response.has_focus()));
        let response = response
            .explained("Shows this light alone; once more: all light. Bars are logarithmic, a decade every quarter");
        if cx.dump.note(&format!("{pane} light {part}"), told(share), response).clicked() {
            clicked = Some(if paths == now { LightPaths::ALL } else { paths });
        }
    }
    clicked
}

/// "12 %", "0.034 %".
fn told(share: f64) -> String {
    match 100.0 * share {
        0.0 => "none".into(),
        percent if percent >= 9.95 => format!("{percent:.0} %"),
        percent if percent >= 0.995 => format!("{percent:.1} %"),
        percent if percent >= 0.0095 => format!("{percent:.2} %"),
        _ => "< 0.01 %".into(),
    }
}

fn short(part: NamedLightPaths) -> String {
    match part {
        NamedLightPaths::Bounce(bounces) => bounces.to_string(),
        NamedLightPaths::From(bounces) => format!("{bounces} +"),
        _ => "lights".into(),
    }
}

fn paint(ui: &Ui, rect: Rect, (part, share): (NamedLightPaths, f64), (pane, chosen, looked_at): (PaneId, bool, bool)) {
    let (palette, painter) = (palette(ui), ui.painter());
    let font = TextStyle::Small.resolve(ui.style());
    let colour = if chosen || looked_at { palette.text } else { palette.dim };
    let whole = Rect::from_min_max(
        pos2(rect.left() + NAMES, rect.top() + 2.0),
        pos2(rect.right() - SHARES, rect.bottom() - 2.0),
    );
    let length = ((share.log10() + DECADES) / DECADES).clamp(0.0, 1.0) as f32;
    let bar = Rect::from_min_size(whole.min, vec2(length * whole.width(), whole.height()));
    painter.rect_filled(whole, 2.0, palette.filled.gamma_multiply(0.3));
    painter.rect_filled(bar, 2.0, palette.pane(pane).gamma_multiply(if looked_at { 1.0 } else { 0.8 }));
    if chosen || looked_at {
        painter.rect_stroke(whole, 2.0, Stroke::new(1.0, palette.accent), StrokeKind::Outside);
    }
    let name = pos2(whole.left() - 6.0, rect.center().y);
    painter.text(name, Align2::RIGHT_CENTER, short(part), font.clone(), colour);
    painter.text(pos2(rect.right(), rect.center().y), Align2::RIGHT_CENTER, told(share), font, colour);
}
