//! Arrow keys for what the mouse else drags: the region, and what is seen of magnified pictures.

use crate::model::{Magnification, Region};
use crate::ui::UiContext;
use crate::ui::pressed::Keys;
use egui::{Key, Modifiers};

const ARROWS: [(Key, [f32; 2]); 4] = [
    (Key::ArrowLeft, [-1.0, 0.0]),
    (Key::ArrowRight, [1.0, 0.0]),
    (Key::ArrowUp, [0.0, -1.0]),
    (Key::ArrowDown, [0.0, 1.0]),
];

/// How far one press goes, as a share of what is seen.
const STEP: f32 = 1.0 / 32.0;

pub fn keys(cx: &mut UiContext, keys: &Keys) {
    let magnification = cx.model.state.magnification;
    let pressed = |with: Modifiers| ARROWS.iter().any(|(key, _)| keys.presses_with(*key, with) > 0);
    let way = |with: Modifiers| {
        let along = |axis: usize| ARROWS.map(|(key, way)| keys.presses_with(key, with) as f32 * way[axis]).iter().sum();
        [0, 1].map(|axis| -> f32 { along(axis) }).map(|presses: f32| presses * STEP)
    };
    let resize = Modifiers::COMMAND | Modifiers::SHIFT;
    if pressed(Modifiers::COMMAND) || pressed(resize) {
        let region = &mut cx.model.session.comparison.region;
        let of_the_picture = |way: [f32; 2]| way.map(|share| share / magnification.factor() as f32);
        *region = Some(region.map_or(middle(&magnification), |region| {
            region.moved(of_the_picture(way(Modifiers::COMMAND))).enlarged(of_the_picture(way(resize)))
        }));
        (cx.model.state.marking, cx.model.state.hint) = (false, false);
    }
    if pressed(Modifiers::SHIFT) {
        let [x, y] = way(Modifiers::SHIFT);
        cx.model.state.magnification = magnification.dragged([-x, -y]);
    }
}

/// The middle quarter of what is seen.
fn middle(magnification: &Magnification) -> Region {
    Region { start: magnification.picture_at([0.25; 2]), end: magnification.picture_at([0.75; 2]) }
}
