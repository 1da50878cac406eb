//! The rungs as rows of a bar chart: a box, a title, the error that is left and what the rung takes away of it, and what a frame
//! costs there. Bars are on logarithmic scales; all that they say stands beside them in figures.

use crate::model::{LadderView, Rung};
use crate::ruler::brief;
use crate::ui::UiContext;
use crate::ui::theme::{figures, palette, semi_bold};
use crate::ui::widgets::Explained;
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, Align2, Checkbox, Color32, EventFilter, FontId, Key, Layout, Modifiers, Popup, Rect, Response, Role, Sense,
    Stroke, StrokeKind, TextStyle, Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

/// Height of a row in sizes of the type, at least and at most.
const ROW: [f32; 2] = [1.7, 2.8];
/// Lines of the head.
const HEAD: f32 = 2.6;

/// Widths in sizes of the type: a box, the figure of an error, of what is taken away, of milliseconds.
const BOX: f32 = 1.8;
const TITLE: f32 = 13.2;
const FIGURE: f32 = 3.9;
const TAKEN: f32 = 4.5;
const TIME: f32 = 3.6;
/// A bar that is narrower says nothing.
const NARROWEST: f32 = 1.0;

/// Where the parts of a row stand, in points from its left edge: each from and to.
struct Columns {
    title: [f32; 2],
    error: [f32; 2],
    figure: [f32; 2],
    taken: [f32; 2],
    time: [f32; 2],
    milliseconds: [f32; 2],
}

impl Columns {
    /// In a row of this width. What bars have no room for, titles have.
    fn of(width: f32, size: f32) -> Self {
        let fixed = (BOX + FIGURE + TAKEN + TIME) * size;
        let title = (TITLE * size).min((width - fixed).max(5.0 * size));
        let bars = (width - fixed - title).max(0.0);
        let mut left = BOX * size;
        let mut next = |width: f32| {
            let from = left;
            left += width;
            [from, left]
        };
        Columns {
            title: next(title),
            error: next(0.58 * bars),
            figure: next(FIGURE * size),
            taken: next(TAKEN * size),
            time: next(0.42 * bars),
            milliseconds: next(TIME * size),
        }
    }
}

/// A logarithmic scale that the least figure still has a bar on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LogScale([f64; 2]);

impl LogScale {
    fn of(all: impl Iterator<Item = f64>) -> Self {
        let logs = all.filter(|figure| *figure > 0.0 && figure.is_finite()).map(f64::log10);
        let [least, most] = logs.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], log| [a.min(log), b.max(log)]);
        if least > most { LogScale([0.0, 1.0]) } else { LogScale([least - 0.3, most.max(least + 0.1)]) }
    }

    /// From 0 to 1.
    fn share(self, figure: f64) -> f32 {
        let LogScale([least, most]) = self;
        ((figure.max(1e-300).log10() - least) / (most - least)).clamp(0.0, 1.0) as f32
    }
}

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let size = TextStyle::Body.resolve(ui.style()).size;
    let rows = cx.shown.ladder.rows(cx.model.session.ladder.order);
    listen(cx, ui, &rows);
    let room = ui.available_rect_before_wrap();
    let columns = Columns::of(room.width() - 6.0, size);
    head(ui, &columns, size);
    let height = ((ui.available_height() - 4.0) / Rung::COUNT as f32).clamp(ROW[0] * size, ROW[1] * size);
    let shown = &cx.shown.ladder;
    let facts = || rows.iter().filter_map(|rung| shown.facts(*rung));
    let scales = [
        LogScale::of(facts().filter_map(|facts| Some(facts.errors?.errors.rel_mse))),
        LogScale::of(facts().map(|facts| facts.anew_ms)),
    ];
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for rung in rows {
            let (rect, _) = ui.allocate_exact_size(vec2(room.width() - 6.0, height), Sense::hover());
            row(cx, ui, (rung, rect), &columns, scales);
        }
    });
}

/// Up and down choose among the rungs that are climbed, while nothing else has the keyboard.
fn listen(cx: &mut UiContext, ui: &Ui, rows: &[Rung]) {
    let focused = ui.memory(|memory| memory.focused());
    let on_a_row = focused.is_some_and(|id| rows.iter().any(|rung| id == id_of(*rung)));
    if Popup::is_any_open(ui.ctx()) || cx.model.state.help || (focused.is_some() && !on_a_row) {
        return;
    }
    let presses = |key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as i32;
    let steps = presses(Key::ArrowDown) - presses(Key::ArrowUp);
    if steps != 0 {
        cx.model.step_on_the_ladder(rows, steps);
        if on_a_row {
            ui.memory_mut(|memory| memory.request_focus(id_of(cx.model.session.ladder.selected)));
        }
    }
}

/// What egui knows a row by.
fn id_of(rung: Rung) -> egui::Id {
    egui::Id::unique(("rung", rung.name()))
}

fn head(ui: &mut Ui, columns: &Columns, size: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEAD * size), Sense::hover());
    let colour = palette(ui).dim;
    let font = TextStyle::Small.resolve(ui.style());
    let words = [
        ([columns.title[0], columns.title[1]], "rung", ""),
        ([columns.error[0], columns.figure[1]], "relMSE left", "log scale"),
        (columns.taken, "taken", "away"),
        ([columns.time[0], columns.milliseconds[1]], "ms a frame,", "log scale"),
    ];
    for ([from, to], above, below) in words {
        let clip = Rect::from_x_y_ranges(rect.left() + from..=rect.left() + to, rect.y_range());
        let painter = ui.painter().with_clip_rect(clip);
        painter.text(clip.left_top() + vec2(2.0, 0.0), Align2::LEFT_TOP, above, font.clone(), colour);
        painter.text(clip.left_top() + vec2(2.0, 1.15 * size), Align2::LEFT_TOP, below, font.clone(), colour);
    }
    ui.painter().hline(rect.x_range(), rect.bottom() - 2.0, Stroke::new(1.0, palette(ui).line));
}

fn row(cx: &mut UiContext, ui: &mut Ui, (rung, rect): (Rung, Rect), columns: &Columns, scales: [LogScale; 2]) {
    let ladder = cx.model.session.ladder;
    let (missing, climbed) = (cx.model.missing_for(rung), cx.model.climbs(rung));
    let part = |[from, to]: [f32; 2]| Rect::from_x_y_ranges(rect.left() + from..=rect.left() + to, rect.y_range());
    let whole = Rect::from_min_max(pos2(rect.left() + columns.title[0] - 3.0, rect.top()), rect.max);
    let response = ui.interact(whole, id_of(rung), Sense::click());
    let palette = palette(ui);
    let selected = ladder.selected == rung;
    if selected || response.hovered() {
        ui.painter().rect_filled(whole, 4.0, if selected { palette.chosen } else { palette.hovered });
    }
    if response.has_focus() {
        ui.painter().rect_stroke(whole, 4.0, Stroke::new(1.0, palette.accent), StrokeKind::Inside);
        let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    }
    tick(cx, ui, rung, Rect::from_min_max(rect.min, pos2(whole.left(), rect.bottom())), missing);
    let shown = cx.shown;
    let said = said_of(rung, missing, climbed, &shown.ladder);
    let font = TextStyle::Body.resolve(ui.style());
    let title_font = if selected { FontId::new(font.size, semi_bold()) } else { font.clone() };
    let colour = if climbed { palette.text } else { palette.dim };
    letter(ui, part(columns.title), (rung.title(), title_font, colour), false);
    match shown.ladder.facts(rung).filter(|_| climbed) {
        None => {
            let word = said.state.clone().unwrap_or_default();
            letter(ui, part([columns.error[0], columns.milliseconds[1]]), (word, font, palette.dim), false);
        }
        Some(facts) => {
            let figures = figures().resolve(ui.style());
            let small = FontId::new(figures.size.min(font.size), figures.family.clone());
            let texts = [
                (columns.figure, said.error.as_deref().unwrap_or("..."), palette.text),
                (columns.taken, said.taken.as_deref().unwrap_or(""), palette.dim),
                (columns.milliseconds, &*milliseconds(facts.anew_ms), palette.text),
            ];
            for (column, text, colour) in texts {
                letter(ui, part(column), (text, small.clone(), colour), true);
            }
            let [errors, times] = scales;
            if let Some(error) = facts.errors {
                bar(ui, part(columns.error), errors.share(error.errors.rel_mse), palette.panes[0]);
            }
            bar(ui, part(columns.time), times.share(facts.anew_ms), palette.panes[1]);
        }
    }
    let spoken = said.spoken();
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, selected, &spoken));
    let response = cx.dump.note(&format!("rung {}", rung.name()), &spoken, response.explained(rung.text()));
    choose(cx, rung, &response);
}

fn choose(cx: &mut UiContext, rung: Rung, response: &Response) {
    if response.clicked() {
        cx.model.session.ladder.selected = rung;
        response.request_focus();
    }
}

/// The box of a repair; what is no repair is always climbed.
fn tick(cx: &mut UiContext, ui: &mut Ui, rung: Rung, rect: Rect, missing: Option<&str>) {
    let Rung::Repair(repair) = rung else { return };
    let ladder = &mut cx.model.session.ladder;
    let mut on = ladder.repairs.has(repair);
    // beside the rows' own layout, which it would move
    let place = UiBuilder::new().id_salt(("climb", rung.name())).max_rect(rect);
    let mut beside = ui.new_child(place.layout(Layout::left_to_right(Align::Center)));
    let check = beside.add_enabled(missing.is_none(), Checkbox::without_text(&mut on));
    let name = format!("Climb {}", rung.title());
    check.widget_info(|| WidgetInfo::selected(Role::CheckBox, missing.is_none(), on, &name));
    let check = check.on_disabled_hover_text(
        missing.map_or_else(String::new, |what| format!("Nothing to repair here: the scene has no {what}")),
    );
    if cx.dump.note(&format!("climb {}", rung.name()), on, check).changed() {
        ladder.repairs = if on { ladder.repairs.with(repair) } else { ladder.repairs.without(repair) };
    }
}

/// What a row says, in words.
struct Said {
    title: &'static str,
    /// Why there are no figures.
    state: Option<String>,
    error: Option<String>,
    taken: Option<String>,
    time: Option<String>,
}

impl Said {
    fn spoken(&self) -> String {
        let Said { title, state, error, taken, time } = self;
        let error = error.as_ref().map(|error| format!("relMSE {error}"));
        let taken = taken.as_ref().map(|taken| format!("taken away {taken}"));
        let parts = [Some((*title).to_owned()), state.clone(), error, taken, time.clone()];
        parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}

fn said_of(rung: Rung, missing: Option<&str>, climbed: bool, shown: &LadderView) -> Said {
    let facts = shown.facts(rung).filter(|_| climbed);
    let state = match (missing, climbed, facts) {
        (Some(what), ..) => Some(format!("no {what}")),
        (None, false, _) => Some("left out".into()),
        (None, true, None) if shown.fault.is_some() => Some("not reached".into()),
        (None, true, None) => Some("waits ...".into()),
        (None, true, Some(facts)) => facts.errors.is_none().then(|| "no reference yet".into()),
    };
    let taken = shown.taken_by(rung).filter(|_| climbed);
    Said {
        title: rung.title(),
        state,
        error: facts.and_then(|facts| facts.errors).map(|errors| figure(errors.errors.rel_mse)),
        taken: taken.map(signed),
        time: facts.map(|facts| format!("{} ms", milliseconds(facts.anew_ms))),
    }
}

/// With a minus where the error has grown.
fn signed(taken: f64) -> String {
    if taken < 0.0 { format!("−{}", figure(-taken)) } else { figure(taken) }
}

/// Four digits behind the point, so that figures below one another can be compared; of what is smaller, how small it is.
pub fn figure(error: f64) -> String {
    if error >= 1e-4 { format!("{error:.4}") } else { brief(error) }
}

/// Milliseconds to three digits, without a unit.
pub fn milliseconds(ms: f64) -> String {
    match ms {
        ms if ms < 9.95 => format!("{ms:.2}"),
        ms if ms < 99.5 => format!("{ms:.1}"),
        ms => format!("{ms:.0}"),
    }
}

fn letter(ui: &Ui, rect: Rect, (text, font, colour): (impl Into<String>, FontId, Color32), at_the_right: bool) {
    let mut job = LayoutJob::simple_singleline(text.into(), font, colour);
    job.wrap = TextWrapping::truncate_at_width((rect.width() - 4.0).max(1.0));
    let galley = ui.painter().layout_job(job);
    let left = if at_the_right { rect.right() - 4.0 - galley.size().x } else { rect.left() + 2.0 };
    ui.painter().galley(pos2(left, rect.center().y - 0.5 * galley.size().y), galley, colour);
}

fn bar(ui: &Ui, room: Rect, share: f32, colour: Color32) {
    let type_size = TextStyle::Body.resolve(ui.style()).size;
    if room.width() < NARROWEST * type_size {
        return;
    }
    let height = 0.55 * room.height();
    let place = Rect::from_min_size(
        pos2(room.left() + 2.0, room.center().y - 0.5 * height),
        vec2((room.width() - 4.0) * share, height),
    );
    ui.painter().rect_filled(place, 2.0, colour);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_grow_with_their_figures_and_without_figures_there_is_a_scale_too() {
        let scale = LogScale::of([0.01, 1.0, f64::NAN].into_iter());
        let shares = [0.0, 0.01, 0.1, 1.0, 10.0].map(|figure| scale.share(figure));
        assert!(shares.is_sorted() && shares[0] == 0.0 && shares[1] > 0.05 && shares[3] == 1.0, "{shares:?}");
        assert_eq!(LogScale::of(std::iter::empty()).share(10.0), 1.0);
    }

    #[test]
    fn the_parts_of_a_row_end_at_its_edge_however_narrow_it_is() {
        for width in [330.0, 455.0, 700.0] {
            let columns = Columns::of(width, 13.0);
            assert!(columns.milliseconds[1] <= width + 1.0, "{width}: {}", columns.milliseconds[1]);
            assert!(columns.title[1] - columns.title[0] >= 65.0);
        }
    }

    #[test]
    fn what_a_rung_makes_worse_has_a_sign() {
        assert_eq!([0.25, -0.25, 2e-5, 0.0].map(signed), ["0.2500", "−0.2500", "2.0e-5", "0"]);
        assert_eq!([0.123, 12.34, 1234.5].map(milliseconds), ["0.12", "12.3", "1234"]);
    }
}
