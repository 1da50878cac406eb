//! The controls beside the pictures: how many triangles, what is shown of each ray, and what is plotted.

use crate::model::{Counted, TreePlot, TreesSettings, grouped, statue_triangles};
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, NumberRow, Scale, choice};
use crate::ui::{UiContext, controls as common};
use egui::{RichText, Ui};

/// What is being done, always in sight.
pub fn heads(cx: &mut UiContext, ui: &mut Ui) {
    let triangles = grouped(statue_triangles(cx.model.session.trees.level));
    ui.label(RichText::new(format!("{triangles} triangles")).heading());
    let doing = cx.shown.trees.doing.clone().unwrap_or_else(|| "done".into());
    let doing = if cx.model.state.paused { "paused (P)".into() } else { doing };
    let line = ui.label(RichText::new(&doing).color(palette(ui).dim));
    cx.dump.note("text trees doing", doing, line);
}

pub fn cards(cx: &mut UiContext, ui: &mut Ui) {
    common::group(cx, ui, "Statue", true, statue);
    common::group(cx, ui, "Shown of a ray", true, shown);
    common::group(cx, ui, "Boxes of the tree", true, boxes);
    common::group(cx, ui, "Plot", true, plotted);
}

fn statue(cx: &mut UiContext, ui: &mut Ui) {
    let hover = "The statue is an octahedron whose triangles are cut in four again and again: 8 x 4^level of them. \
                 From level 9 on it takes seconds to make and gigabytes to keep";
    let finest = TreesSettings::FINEST;
    whole(cx, ui, ("statue level", "Level", hover), 0..=finest, |trees| &mut trees.level);
}

fn shown(cx: &mut UiContext, ui: &mut Ui) {
    let show = cx.model.session.trees.show;
    let words = Counted::ALL.map(|each| (each.name().to_owned(), explain(each), each == show));
    if let Some(index) = choice(("trees show", "Show"), words, ui, cx.dump) {
        cx.model.session.trees.show = Counted::ALL[index];
    }
}

fn explain(show: Counted) -> &'static str {
    match show {
        Counted::Surface => "What the rays meet: the same in all three, whatever they cost",
        Counted::Boxes => "How many boxes each ray was tested against, by the colours below",
        Counted::Triangles => "How many triangles each ray was tested against, by the colours below",
    }
}

fn boxes(cx: &mut UiContext, ui: &mut Ui) {
    let mut drawn = cx.model.session.trees.boxes.is_some();
    let check = ui.checkbox(&mut drawn, "Draw them").explained("The boxes that lie so many steps below the root");
    if cx.dump.note("tree boxes", drawn, check).clicked() {
        cx.model.session.trees.boxes = drawn.then_some(2);
    }
    if cx.model.session.trees.boxes.is_some() {
        let hover = "0 is the root, around all. Leaves above stand for what is below them. Of more than 500 boxes the deepest level is drawn that has no more";
        whole(cx, ui, ("tree depth", "Steps below the root", hover), 0..=24, |trees| trees.boxes.get_or_insert(0));
    }
}

fn plotted(cx: &mut UiContext, ui: &mut Ui) {
    let plot = cx.model.session.trees.plot;
    let words = TreePlot::ALL.map(|each| (each.name().to_owned(), explain_plot(each), each == plot));
    if let Some(index) = choice(("trees plot", "Plot"), words, ui, cx.dump) {
        cx.model.session.trees.plot = TreePlot::ALL[index];
    }
}

fn explain_plot(plot: TreePlot) -> &'static str {
    match plot {
        TreePlot::Seconds => {
            "Seconds for a million rays on all threads. Eight boxes are tested at once, as pictures are traced; the other two structures are walked by plain code that counts as well"
        }
        TreePlot::Tests => "Boxes and triangles that a ray is tested against in the mean",
    }
}

fn whole(
    cx: &mut UiContext,
    ui: &mut Ui,
    (name, label, hover): (&str, &str, &str),
    range: std::ops::RangeInclusive<u32>,
    of: fn(&mut TreesSettings) -> &mut u32,
) {
    let bounds = f64::from(*range.start())..=f64::from(*range.end());
    let tint = palette(ui).accent;
    let (scale, unit, aside) = (Scale::Whole(range), "", String::new());
    let row = NumberRow { name, label, hover, scale, bounds, unit, aside, resets: false, tint };
    let mut value = f64::from(*of(&mut cx.model.session.trees));
    let told = row.show(&mut value, ui, cx.dump);
    if told.changed {
        *of(&mut cx.model.session.trees) = value as u32;
    }
}
