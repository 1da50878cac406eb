//! What a case claims, and its rows: what was measured, what was expected, and how far they may be apart.

use super::list::{draw_mark, say_mark};
use crate::model::{CaseCourse, CaseMark, CaseResult, off_by};
use crate::ui::UiContext;
use crate::ui::theme::{figures, palette};
use crate::ui::widgets::Explained;
use check::{Case, Relation, Row, Verdict};
use egui::{Label, RichText, Sense, Ui, vec2};

/// Draws all of it.
pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    let case = cx.model.state.cases.case();
    let machine = cx.model.state.cases.machine;
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(format!("{}. {}", case.number, case.title)).heading());
        say_mark(cx, ui, case);
    });
    let claim = ui.add(Label::new(case.claim).wrap());
    cx.dump.note("text claim", case.claim, claim);
    let result = cx.shown.cases.result(machine, case);
    let line = course_of(case, result, cx.shown.cases.mark(machine, case));
    let failed = result.is_some_and(|result| matches!(result.course, CaseCourse::Failed(_)));
    let colour = if failed { palette(ui).error } else { palette(ui).dim };
    let told = ui.add(Label::new(RichText::new(&line).color(colour)).wrap());
    cx.dump.note("text case course", &line, told);
    let Some(result) = result.filter(|result| !result.rows.is_empty()) else { return };
    ui.add_space(2.0);
    egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| rows(cx, ui, &result.rows));
}

/// "58 rows in 2.1 s by the processor; may be off by ...".
fn course_of(case: &Case, result: Option<&CaseResult>, mark: CaseMark) -> String {
    let Some(result) = result else {
        return match mark {
            CaseMark::NotHere => "This machine does not render it: choose the processor".into(),
            _ => format!("Not measured here yet: Run this, or M. It may be off by {}", case.allows),
        };
    };
    let (rows, seconds, by) = (result.rows.len(), result.seconds, &result.by);
    let spoilt = if result.spoilt { ". Expectations are a twentieth too large on purpose" } else { "" };
    match &result.course {
        CaseCourse::Failed(why) => format!("Failed by {by} after {rows} rows: {why}"),
        CaseCourse::Running => format!("{rows} rows so far, {seconds:.1} s by {by} ...{spoilt}"),
        CaseCourse::Stopped => format!("Stopped after {rows} rows and {seconds:.1} s by {by}{spoilt}"),
        CaseCourse::Done => {
            format!("{rows} rows in {seconds:.1} s by {by}. They may be off by {}{spoilt}", case.allows)
        }
    }
}

const HEADS: [(&str, &str); 6] = [
    ("verdict", "whether it is as it must be"),
    ("what", "technique and estimator, or the part that was asked by itself, and what was measured of it"),
    ("measured", "what the renderer says"),
    ("expected", "the closed form, or the most that it may be"),
    ("off by", "the difference, and which share it is of the largest that passes"),
    ("tolerance", "the largest difference that passes; four standard errors where chance plays a part"),
];

/// The rows that fail stand first.
fn rows(cx: &mut UiContext, ui: &mut Ui, rows: &[Row]) {
    let font = figures();
    egui::Grid::new("rows").num_columns(HEADS.len()).spacing([14.0, 3.0]).striped(true).show(ui, |ui| {
        for (head, hover) in HEADS {
            ui.label(RichText::new(head).color(palette(ui).dim)).explained(hover);
        }
        ui.end_row();
        let fails = |row: &&Row| row.verdict == Verdict::Fail;
        let (failing, others): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(fails);
        for (index, row) in failing.into_iter().chain(others).enumerate() {
            let colour = if row.verdict == Verdict::Fail { palette(ui).error } else { palette(ui).text };
            let cells = cells_of(row);
            verdict(row.verdict, &cells[0], ui);
            for cell in &cells[1..] {
                ui.add(Label::new(RichText::new(cell).text_style(font.clone()).color(colour)).extend());
            }
            ui.end_row();
            let place = ui.min_rect();
            cx.dump.note_text(&format!("case row {}", index + 1), &cells.join(", "), place, ui.clip_rect());
        }
    });
}

/// Its mark and its word.
fn verdict(verdict: Verdict, word: &str, ui: &mut Ui) {
    let (mark, colour) = match verdict {
        Verdict::Pass => (CaseMark::Passes, palette(ui).text),
        Verdict::Fail => (CaseMark::Fails, palette(ui).error),
        Verdict::Information => (CaseMark::NotHere, palette(ui).dim),
    };
    ui.horizontal(|ui| {
        let side = 0.8 * figures().resolve(ui.style()).size;
        let (place, _) = ui.allocate_exact_size(vec2(side, side), Sense::hover());
        draw_mark(ui, place, mark);
        ui.label(RichText::new(word).text_style(figures()).color(colour));
    });
}

fn cells_of(row: &Row) -> [String; 6] {
    let (off, share) = ((row.measured - row.expected).abs(), off_by(row));
    let (expected, off, tolerance) = match row.relation {
        Relation::AtMost => (format!("at most {}", number(row.expected)), String::new(), String::new()),
        Relation::Equal if row.verdict == Verdict::Information => (number(row.expected), number(off), String::new()),
        Relation::Equal => {
            let share = if share.is_finite() { format!(" ({:.0} %)", 100.0 * share) } else { String::new() };
            (number(row.expected), format!("{}{share}", number(off)), number(row.tolerance))
        }
    };
    let power = match row.power {
        Some((reached, wanted)) if reached > wanted => " (too noisy)",
        _ => "",
    };
    [
        row.verdict.name().into(),
        format!("{}: {}{power}", row.subject, row.quantity),
        number(row.measured),
        expected,
        off,
        tolerance,
    ]
}

/// Nine digits of what is near 1, as the command line has them; powers of ten of what is not.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if !(1e-3..1e7).contains(&size) => {
            let text = format!("{value:.3e}");
            let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
            format!("{}e{power}", without_zeros(digits))
        }
        size => {
            let decimals = (8 - size.log10().floor() as i32).clamp(0, 9) as usize;
            without_zeros(&format!("{value:.decimals$}")).to_owned()
        }
    }
}

/// Without zeros that end a fraction.
fn without_zeros(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_matter() {
        let numbers = [0.0, 1.0, 1.045356176, 0.7052169, 1.680221139e-8, 9999.0, 20_000_000.0].map(number);
        assert_eq!(numbers, ["0", "1", "1.04535618", "0.7052169", "1.68e-8", "9999", "2e7"]);
    }
}
