//! The first workspace: two pictures of one scene, one against the other or both against the reference.

mod arrows;
mod closer;
mod comparison;
mod effects;
mod external;
mod flicker;
mod histogram;
mod label;
mod loupe;
mod magnify;
mod map;
mod map_faces;
mod mouse;
mod parts;
mod picture;
pub mod plots;
mod probe;
mod region;

pub(super) use map::legend;

use self::parts::Parts;
use super::Workspace;
use crate::model::{CompareWith, LightWish, Model, PaneId, ProbeWish, View, Wanted};
use crate::ui::pressed::{HelpLine, Keys};
use crate::ui::widgets::{Icon, choice, icon_button};
use crate::ui::{UiContext, controls};
use egui::{Key, Ui};

/// The workspace of pictures A and B with what lies between them: wipe, side by side, error map.
#[derive(Default)]
pub struct Compare {
    parts: Parts,
}

/// The keys of the views, in the order of [`View::ALL`].
const VIEW_KEYS: [Key; View::ALL.len()] = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5];

/// Windows narrower than this, in points, have the region's button on its card alone.
const ROOMY: f32 = 900.0;

impl Workspace for Compare {
    fn id(&self) -> &'static str {
        "compare"
    }

    fn name(&self) -> &'static str {
        "Compare"
    }

    fn icon(&self) -> Icon {
        Icon::Compare
    }

    fn about(&self) -> &'static str {
        "Two pictures of one scene, and the map of their errors"
    }

    fn bar(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        let words = View::ALL.map(|view| (view.name().to_owned(), explain(view), cx.model.session.view == view));
        if let Some(index) = choice(("view", ""), words, ui, cx.dump) {
            cx.model.choose(View::ALL[index]);
        }
        let open = cx.model.session.plots.open;
        let hover = "How errors fall while pictures are made: show or hide the plots (G)";
        let plots = icon_button(Icon::Plots, ("Plots", hover), (true, open), ui);
        if cx.dump.note("plots", open, plots).clicked() {
            cx.model.session.plots.open = !open;
        }
        if ui.ctx().content_rect().width() >= ROOMY {
            region_button(cx, ui);
            probe::button(cx, ui);
            parts::button(cx, ui);
        }
    }

    fn keys(&mut self, cx: &mut UiContext, keys: &Keys) {
        for _ in 0..keys.presses(Key::T) {
            cx.model.session.toggle();
            (cx.model.state.hint, cx.model.state.flicker) = (false, None);
        }
        if keys.presses(Key::G) % 2 == 1 {
            cx.model.session.plots.open = !cx.model.session.plots.open;
        }
        if keys.presses(Key::M) % 2 == 1 {
            region::toggle(cx);
        }
        // as the switch, it is of the map alone
        let on = cx.model.session.view == View::ErrorMap && keys.presses(Key::E) % 2 == 1;
        cx.model.session.comparison.effects ^= on;
        arrows::keys(cx, keys);
        probe::keys(cx, keys);
        parts::keys(cx, keys);
        cx.model.state.loupe ^= keys.presses(Key::I) % 2 == 1;
        if keys.presses(Key::F) % 2 == 1 {
            flicker::toggle(cx);
        }
        for (key, view) in VIEW_KEYS.into_iter().zip(View::ALL) {
            for _ in 0..keys.presses(key) {
                cx.model.choose(view);
            }
        }
    }

    fn escape(&mut self, cx: &mut UiContext) {
        if !(parts::mouse::give_up(cx) || region::end(cx)) {
            cx.model.state.parts.open = false;
        }
    }

    fn ui(&mut self, cx: &mut UiContext, ui: &mut Ui) {
        // until the card is found open
        cx.model.state.histograms = false;
        cx.model.state.light_bars.clear();
        cx.model.state.effect.hovered = None;
        self.parts.follow(cx);
        controls::panel_with(cx, ui, |cx, ui| self.parts.cards(cx, ui), heads, cards);
        self.parts.beside(cx, ui);
        plots::drawer(cx, ui);
        probe::drawer(cx, ui);
        // no ground under the pictures, which cover it: where the processor draws, every layer is paid for
        let bare = egui::CentralPanel::default().frame(egui::Frame::NONE);
        bare.show(ui, |ui| picture::show(cx, ui));
    }

    fn wanted(&self, model: &Model) -> Wanted {
        let session = &model.session;
        let panes = session.panes.ids();
        Wanted {
            comparisons: panes.map(|id| session.comparison.comparison(id)).collect(),
            histograms: model.state.histograms,
            probe: session.probe.open.then_some(ProbeWish { at: session.probe.at, sample: model.state.probed_sample }),
            objects: model.objects_wish(),
            effects: model.effects_wish(),
            light: light_wishes(model),
            map: (session.view == View::ErrorMap).then(|| session.comparison.map()),
            ..model.wanted(session.panes.ids())
        }
    }

    fn help(&self) -> Vec<HelpLine> {
        vec![
            ("drag the line", "wipe; double click: back to its first place"),
            ("drag the picture", "orbit about the target"),
            ("Shift or right drag", "pan"),
            ("wheel", "dolly: move nearer or farther"),
            ("Ctrl+wheel, pinch", "zoom: narrow or widen the view"),
            ("T", "swap A and B"),
            ("1 2", "A alone, B alone"),
            ("3", "wipe; again: turn the line"),
            ("4", "side by side"),
            ("5", "error map"),
            ("E", "on the error map: outline and name the effects of light, with their shares of the error"),
            ("G", "plots of the errors"),
            ("M, Alt+drag", "mark the region that figures and plots speak of; M or Esc: the whole picture"),
            ("Ctrl+arrows", "mark the middle, then move the region; with Shift: larger, smaller"),
            ("+ -, Shift+wheel", "show pictures larger, pixel by pixel, about the mouse"),
            ("Shift+drag, Shift+arrows", "move what is shown larger"),
            ("0, double click", "as large as they are"),
            ("I", "loupe: the pixels under the mouse of A, B, reference and error, with their numbers"),
            ("F", "A and B by turns, twice a second"),
            ("B", "probe: a pixel's samples, their mean and the integral; a click chooses the pixel"),
            ("O", "parts: what there is in the scene, to look at and to change; a click chooses, Esc closes"),
            ("Ctrl+drag", "with parts open: move a shape along the picture; with Shift: up and down alone"),
            ("Alt+arrows", "move the probe's pixel; with Shift: another of its samples"),
        ]
    }
}

fn region_button(cx: &mut UiContext, ui: &mut Ui) {
    let marked = cx.model.state.marking || cx.model.session.comparison.region.is_some();
    let hover = "Mark the part of the pictures that figures and plots speak of, by the next drag (M); again: the whole";
    let button = icon_button(Icon::Region, ("Region", hover), (true, marked), ui);
    if cx.dump.note("region", marked, button).clicked() {
        region::toggle(cx);
    }
}

/// What A and B are, and what they are held against: always in sight.
fn heads(cx: &mut UiContext, ui: &mut Ui) {
    let panes: Vec<PaneId> = cx.model.session.panes.ids().collect();
    panes.into_iter().for_each(|pane| controls::head(cx, pane, ui));
    comparison::against(cx, ui);
}

/// The controls beside the pictures.
fn cards(cx: &mut UiContext, ui: &mut Ui) {
    let low = controls::is_low(ui);
    if cx.model.session.comparison.with == CompareWith::Reference {
        controls::group(cx, ui, "Reference", true, comparison::reference);
    }
    if cx.model.session.view == View::ErrorMap {
        controls::group(cx, ui, "Error map", true, comparison::map);
    }
    controls::scene(cx, ui);
    let panes: Vec<PaneId> = cx.model.session.panes.ids().collect();
    for pane in panes {
        controls::pane(cx, pane, !low || pane != PaneId::A, ui);
    }
    controls::display(cx, ui);
    controls::group(cx, ui, "Looking closer", false, closer::show);
    controls::group(cx, ui, "Histogram", false, histogram::show);
    controls::camera(cx, ui);
}

fn explain(view: View) -> &'static str {
    match view {
        View::Pane(PaneId::A) => "Pane A alone (1, T swaps A and B)",
        View::Pane(_) => "Pane B alone (2, T swaps A and B)",
        View::Wipe => "Both, with a line to drag (3; again: turn the line)",
        View::SideBySide => "Both whole, each in half of the window (4)",
        View::ErrorMap => "Where the errors are, and how large (5)",
    }
}

/// The pictures whose light by bounce is in sight.
fn light_wishes(model: &Model) -> Vec<LightWish> {
    let (bars, picture) = (&model.state.light_bars, &model.state.picture);
    if bars.is_empty() || picture.size.0 == 0 || picture.size.1 == 0 {
        return Vec::new();
    }
    let shot = model.document.shot(picture);
    let technique = |id: PaneId| Some(model.session.panes.get(id)?.in_use());
    bars.iter().filter_map(|id| LightWish::of(*id, &shot, technique(*id)?)).collect()
}
