//! The colours of each theme. Text keeps a contrast of 4.5:1 on whatever it stands, and of 7:1 on the projector (WCAG 2.2, success criteria
//! 1.4.3 and 1.4.6); what can be used stands out from its ground by 3:1 there (1.4.11).

use crate::model::{PaneId, Theme};
use egui::Color32;

/// Colours by what they are for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Palette {
    /// Under everything: fields that are typed into.
    pub ground: Color32,
    /// The ground of bars, panels and menus.
    pub panel: Color32,
    /// What belongs together on a panel.
    pub card: Color32,
    /// Edges of panels and fields.
    pub line: Color32,
    /// Text that is read first.
    pub text: Color32,
    /// What is read second: names of controls, what is not chosen.
    pub dim: Color32,
    /// The rail of a slider, and what is chosen of several words.
    pub chosen: Color32,
    /// Under the mouse, and what has the keyboard: neither chosen nor not.
    pub hovered: Color32,
    /// The part of a slider's rail before its handle, where no pane lends it a colour.
    pub filled: Color32,
    /// The handle of a slider.
    pub handle: Color32,
    /// Pane A and pane B: blue and orange, which nobody takes for each other.
    pub panes: [Color32; 2],
    /// Curves that were pinned, one after the other: apart from each other and from the panes also to those who do not see red or green.
    pub pinned: [Color32; 6],
    /// What has the keyboard, and what is new.
    pub accent: Color32,
    /// Text that says what has failed.
    pub error: Color32,
}

const fn rgb(hex: u32) -> Color32 {
    Color32::from_rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8)
}

const DARK: Palette = Palette {
    ground: rgb(0x14161a),
    panel: rgb(0x1b1e24),
    card: rgb(0x22262e),
    line: rgb(0x2e333d),
    text: rgb(0xe8eaee),
    dim: rgb(0x9aa3b2),
    chosen: rgb(0x39404d),
    hovered: rgb(0x2a2f39),
    filled: rgb(0x7e8899),
    handle: rgb(0xe8eaee),
    panes: [rgb(0x6cb2ff), rgb(0xffb057)],
    pinned: [rgb(0xf0f0f0), rgb(0xf03090), rgb(0x009090), rgb(0xd06000), rgb(0xf09090), rgb(0x9060f0)],
    accent: rgb(0x6ee7c8),
    error: rgb(0xff8f8f),
};

const LIGHT: Palette = Palette {
    ground: rgb(0xffffff),
    panel: rgb(0xf4f5f7),
    card: rgb(0xffffff),
    line: rgb(0xd3d8e0),
    text: rgb(0x0d1117),
    dim: rgb(0x4b5565),
    chosen: rgb(0xd5dae2),
    hovered: rgb(0xe9ecf1),
    filled: rgb(0x6b7688),
    handle: rgb(0x2b3442),
    panes: [rgb(0x0b57c2), rgb(0xa34a00)],
    pinned: [rgb(0x000000), rgb(0x606060), rgb(0x309060), rgb(0xb06090), rgb(0x000060), rgb(0x003000)],
    accent: rgb(0x0b6b57),
    error: rgb(0xa31515),
};

const PROJECTOR: Palette = Palette {
    panel: rgb(0xffffff),
    card: rgb(0xf4f5f7),
    line: rgb(0x6b7688),
    dim: rgb(0x3c4656),
    chosen: rgb(0xc9d0da),
    hovered: rgb(0xe6eaf0),
    filled: rgb(0x4b5565),
    handle: rgb(0x0d1117),
    panes: [rgb(0x0a4aa6), rgb(0x863d00)],
    error: rgb(0x8f0000),
    ..LIGHT
};

impl Palette {
    /// The colours of a theme.
    pub fn of(theme: Theme) -> &'static Palette {
        match theme {
            Theme::Dark => &DARK,
            Theme::Light => &LIGHT,
            Theme::Projector => &PROJECTOR,
        }
    }

    /// A pane's own colour on cards; panes beyond the two have none.
    pub fn pane(&self, pane: PaneId) -> Color32 {
        self.own_colour(pane).unwrap_or(self.text)
    }

    /// The filled part of the sliders of a pane, or of what belongs to no pane.
    pub fn slider(&self, pane: Option<PaneId>) -> Color32 {
        pane.and_then(|pane| self.own_colour(pane)).unwrap_or(self.filled)
    }

    fn own_colour(&self, pane: PaneId) -> Option<Color32> {
        match pane {
            PaneId::A => Some(self.panes[0]),
            PaneId::B => Some(self.panes[1]),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of an sRGB colour, as WCAG 2.2 defines it.
    fn luminance(colour: Color32) -> f64 {
        let linear = |byte: u8| {
            let v = f64::from(byte) / 255.0;
            if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
    }

    fn contrast(a: Color32, b: Color32) -> f64 {
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn every_text_can_be_read_on_every_ground_that_it_stands_on() {
        for (theme, least) in [(Theme::Dark, 4.5), (Theme::Light, 4.5), (Theme::Projector, 7.0)] {
            let p = Palette::of(theme);
            for (name, text) in
                [("text", p.text), ("dim", p.dim), ("A", p.panes[0]), ("B", p.panes[1]), ("error", p.error)]
            {
                for (on, ground) in [("ground", p.ground), ("panel", p.panel), ("card", p.card)] {
                    let ratio = contrast(text, ground);
                    assert!(ratio >= least, "{theme:?}: {name} on {on} is {ratio:.2}");
                }
            }
            assert!(contrast(p.text, p.chosen) >= least, "{theme:?}: a chosen word");
            for pinned in p.pinned {
                assert!(contrast(pinned, p.panel) >= 3.0, "{theme:?}: a pinned curve");
            }
            assert!(p.hovered != p.chosen && contrast(p.text, p.hovered) >= least, "{theme:?}: under the mouse");
        }
    }

    #[test]
    fn sliders_stand_out_from_their_card() {
        for theme in Theme::ALL {
            let p = Palette::of(theme);
            for (name, colour) in [("filled", p.filled), ("handle", p.handle), ("A", p.panes[0]), ("B", p.panes[1])] {
                let ratio = contrast(colour, p.card);
                assert!(ratio >= 3.0, "{theme:?}: {name} is {ratio:.2}");
            }
        }
    }
}
