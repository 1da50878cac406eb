//! The cases at the left, each with what came of it, and what is measured how.

use crate::model::{CaseCourse, CaseMachine, CaseMark};
use crate::ui::UiContext;
use crate::ui::theme::{bold, palette};
use crate::ui::widgets::{Explained, choice, framed};
use check::{CASES, Case, Effort};
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align2, Color32, Frame, Margin, Rect, RichText, Role, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2,
};

/// Draws the panel, unless controls are hidden.
pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    if !cx.model.state.panel {
        return;
    }
    let type_size = TextStyle::Body.resolve(ui.style()).size;
    let width = (22.8 * type_size).min(0.34 * ui.available_width()).max(150.0);
    let frame = Frame::new().fill(palette(ui).panel).inner_margin(Margin { left: 8, right: 8, top: 8, bottom: 0 });
    egui::Panel::left("hard cases").resizable(false).exact_size(width).frame(frame).show(ui, |ui| {
        summary(cx, ui);
        buttons(cx, ui);
        settings(cx, ui);
        ui.separator();
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| rows(cx, ui));
    });
}

/// Whether something is being measured on any machine.
pub fn is_running(cx: &UiContext) -> bool {
    cx.shown.cases.results.values().any(|result| result.course == CaseCourse::Running)
}

/// Opens the scene of the case for the comparison.
pub fn open(cx: &mut UiContext) {
    if let Err(fault) = cx.model.open_case() {
        cx.model.say(Err(fault));
    }
}

fn mark_of(cx: &UiContext, case: &Case) -> CaseMark {
    cx.shown.cases.mark(cx.model.state.cases.machine, case)
}

fn summary(cx: &mut UiContext, ui: &mut Ui) {
    let count = |mark: CaseMark| CASES.iter().filter(|case| mark_of(cx, case) == mark).count();
    let [passes, fails] = [CaseMark::Passes, CaseMark::Fails].map(count);
    let text = match passes + fails {
        0 => format!("{} cases whose answers are known", CASES.len()),
        _ => format!("{passes} of {} cases pass, {fails} fail", CASES.len()),
    };
    let label = ui.label(RichText::new(&text).heading());
    cx.dump.note("text cases", text, label);
}

fn buttons(cx: &mut UiContext, ui: &mut Ui) {
    ui.horizontal_wrapped(|ui| {
        let this = "Measure this case on the chosen machine; what is being measured ends (M)";
        if cx.dump.note("run case", "", ui.add(framed("Run this", ui)).explained(this)).clicked() {
            let case = cx.model.state.cases.looked_at;
            cx.model.state.cases.measure([case]);
        }
        let all = "Measure all cases, one after the other (A)";
        if cx.dump.note("run all cases", "", ui.add(framed("Run all", ui)).explained(all)).clicked() {
            cx.model.state.cases.measure(CASES.iter().map(|case| case.number));
        }
        let running = is_running(cx);
        let stop = ui.add_enabled(running, framed("Stop", ui)).explained("Measure no more (Esc)");
        if cx.dump.note("stop cases", running, stop).clicked() {
            cx.model.state.cases.measure([]);
        }
        let scene = "Opens the scene of this case for the comparison, with all of its tools; Undo leads back (O)";
        if cx.dump.note("open case", "", ui.add(framed("Open as a scene", ui)).explained(scene)).clicked() {
            open(cx);
        }
    });
}

fn settings(cx: &mut UiContext, ui: &mut Ui) {
    let adapters = &cx.model.adapters.0;
    let on_adapters = (0..adapters.len().min(8) as u8).map(CaseMachine::Adapter);
    let machines: Vec<CaseMachine> = std::iter::once(CaseMachine::Processor).chain(on_adapters).collect();
    let name = |machine: CaseMachine| match machine {
        CaseMachine::Processor => "processor".to_owned(),
        CaseMachine::Adapter(place) => adapters[usize::from(place)].name.clone(),
    };
    let chosen = cx.model.state.cases.machine;
    ui.label(RichText::new("Measured and rendered by").color(palette(ui).dim));
    let words: Vec<_> = machines.iter().map(|machine| (name(*machine), "", *machine == chosen)).collect();
    if let Some(index) = choice(("case machine", "Measured by"), words, ui, cx.dump) {
        cx.model.state.cases.machine = machines[index];
    }
    let cases = &mut cx.model.state.cases;
    let efforts = [
        ("quick", "Within a minute for all: notices faults of half a percent", Effort::Quick),
        ("full", "Within ten minutes for all: notices faults of a tenth of a percent", Effort::Full),
    ];
    let words = efforts.map(|(word, hover, effort)| (word.to_owned(), hover, effort == cases.effort));
    if let Some(index) = choice(("case effort", "Effort"), words, ui, cx.dump) {
        cases.effort = efforts[index].2;
    }
    let spoilt = ui.checkbox(&mut cases.spoilt, "See it fail").explained(
        "Expects a twentieth too much of what is measured from now on: a check is trusted once it was seen to fail",
    );
    cx.dump.note("spoil cases", cases.spoilt, spoilt);
    let failing = ui.checkbox(&mut cases.only_failing, "List failing cases alone");
    cx.dump.note("failing cases", cases.only_failing, failing);
}

fn rows(cx: &mut UiContext, ui: &mut Ui) {
    let only_failing = cx.model.state.cases.only_failing;
    let listed = |case: &&Case| !only_failing || mark_of(cx, case) == CaseMark::Fails;
    let cases: Vec<&Case> = CASES.iter().filter(listed).collect();
    if cases.is_empty() {
        let line = ui.label(RichText::new("None of those that were measured here fails.").color(palette(ui).dim));
        cx.dump.note("text no case fails", "", line);
    }
    for case in cases {
        row(cx, ui, case);
    }
}

fn row(cx: &mut UiContext, ui: &mut Ui, case: &Case) {
    let (mark, chosen) = (mark_of(cx, case), cx.model.state.cases.looked_at == case.number);
    let height = ui.spacing().interact_size.y;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    let palette = palette(ui);
    if chosen || response.hovered() {
        ui.painter().rect_filled(rect, 4.0, if chosen { palette.chosen } else { palette.hovered });
    }
    if response.has_focus() {
        let stroke = Stroke::new(1.0, palette.accent);
        ui.painter().rect_stroke(rect, 4.0, stroke, egui::StrokeKind::Inside);
    }
    let side = 0.6 * height;
    let place = Rect::from_center_size(pos2(rect.left() + 0.5 * height, rect.center().y), vec2(side, side));
    draw_mark(ui, place, mark);
    let font = TextStyle::Body.resolve(ui.style());
    let left = rect.left() + height + 4.0;
    let number = pos2(left + 1.6 * font.size, rect.center().y);
    ui.painter().text(number, Align2::RIGHT_CENTER, case.number.to_string(), font.clone(), palette.dim);
    let text = left + 2.0 * font.size;
    let mut job = LayoutJob::simple_singleline(case.title.to_owned(), font, palette.text);
    job.wrap = TextWrapping::truncate_at_width((rect.right() - text - 4.0).max(20.0));
    let galley = ui.painter().layout_job(job);
    let at = pos2(text, rect.center().y - 0.5 * galley.size().y);
    ui.painter().galley(at, galley, palette.text);
    let spoken = format!("Case {}: {}, {}", case.number, case.title, mark.name());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    let response = response.explained(&format!("{} Catches {}.", case.claim, case.catches));
    if cx.dump.note(&format!("case {}", case.number), mark.name(), response).clicked() {
        cx.model.state.cases.looked_at = case.number;
        ui.ctx().request_repaint();
    }
}

/// Forms tell marks apart, not colours alone: a tick, a cross, a part of a ring, a ring, a dash.
pub fn draw_mark(ui: &Ui, place: Rect, mark: CaseMark) {
    let palette = palette(ui);
    let painter = ui.painter();
    let at = |x: f32, y: f32| pos2(place.left() + x * place.width(), place.top() + y * place.height());
    let line = |points: &[(f32, f32)], colour: Color32| {
        let points = points.iter().map(|(x, y)| at(*x, *y)).collect();
        painter.line(points, Stroke::new((place.width() / 7.0).max(1.6), colour));
    };
    match mark {
        CaseMark::Passes => line(&[(0.1, 0.55), (0.4, 0.85), (0.95, 0.15)], palette.accent),
        CaseMark::Fails => {
            line(&[(0.1, 0.1), (0.9, 0.9)], palette.error);
            line(&[(0.9, 0.1), (0.1, 0.9)], palette.error);
        }
        CaseMark::Running => {
            let arc: Vec<_> = (0..=18).map(|i| f32::to_radians(15.0 * i as f32)).collect();
            let arc: Vec<_> = arc.iter().map(|a| (0.5 + 0.45 * a.sin(), 0.5 - 0.45 * a.cos())).collect();
            line(&arc, palette.text);
        }
        CaseMark::NotRun => {
            _ = painter.circle_stroke(place.center(), 0.3 * place.width(), Stroke::new(1.4, palette.dim))
        }
        CaseMark::NotHere => line(&[(0.15, 0.5), (0.85, 0.5)], palette.dim),
    }
}

/// "passes", "fails": beside its mark, in words.
pub fn say_mark(cx: &mut UiContext, ui: &mut Ui, case: &Case) {
    let mark = mark_of(cx, case);
    let height = TextStyle::Body.resolve(ui.style()).size;
    let (place, _) = ui.allocate_exact_size(vec2(height, height), Sense::hover());
    draw_mark(ui, place, mark);
    let colour = if mark == CaseMark::Fails { palette(ui).error } else { palette(ui).text };
    let label = ui.label(bold(mark.name()).color(colour));
    cx.dump.note("text case mark", mark.name(), label);
}
