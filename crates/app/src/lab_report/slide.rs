//! A slide: the pictures beside each other, with what the last row of seats is to know of them.

use super::pictures::Shown;
use super::{LabReport, Measured, NO_REFERENCE_OF_A_PART, ReportedPicture};
use crate::lettering::{Canvas, Lettering, Type};
use crate::model::{Against, IN_THE_REGION, PaneId, SlideSize, View};
use crate::ruler::{brief, error_words, marks};
use anyhow::ensure;
use compare::{ColourScale, CompareError, ErrorMetric, Tick};

/// Sizes, in parts of 1080 of the slide's height. Capitals of the smallest type have 1/43 of it, so that a slide at half its
/// size is read from where the whole one is.
const MARGIN: u32 = 48;
const TITLE: u32 = 46;
const LABEL: u32 = 35;
const GAP: u32 = 24;
/// From one line of a label to the next: Inter's own row.
const ROW: u32 = 43;
/// Lines under a picture: two of its name, and three of facts.
const LINES: u32 = 5;
/// Height of a map's bar of colours.
const BAR: u32 = 20;

/// Colours of a slide: text has a contrast of 7:1 and more on its ground (WCAG 2.2, success criterion 1.4.6).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SlideColours {
    ground: [u8; 3],
    text: [u8; 3],
    /// Of A's name and of B's.
    panes: [[u8; 3]; 2],
}

/// As the dark window's.
const DARK: SlideColours = SlideColours {
    ground: [0x14, 0x16, 0x1a],
    text: [0xe8, 0xea, 0xee],
    panes: [[0x6c, 0xb2, 0xff], [0xff, 0xb0, 0x57]],
};

/// The colours of the projector's theme.
const LIGHT: SlideColours =
    SlideColours { ground: [0xff; 3], text: [0x0d, 0x11, 0x17], panes: [[0x0a, 0x4a, 0xa6], [0x86, 0x3d, 0x00]] };

impl SlideColours {
    /// Those of a dark slide, or of a light one.
    pub fn of(dark: bool) -> Self {
        if dark { DARK } else { LIGHT }
    }

    fn of_pane(&self, pane: Option<PaneId>) -> [u8; 3] {
        match pane {
            Some(PaneId::A) => self.panes[0],
            Some(_) => self.panes[1],
            None => self.text,
        }
    }
}

/// A picture with what stands under it.
struct Column {
    picture: Shown,
    pane: Option<PaneId>,
    name: String,
    facts: Vec<String>,
    scale: Option<ColourScale>,
    /// Whether it is, or was measured, against the reference.
    is_judged: bool,
}

/// A slide on its way.
struct Drawing {
    size: SlideSize,
    colours: SlideColours,
    canvas: Canvas,
    lettering: Lettering,
}

/// How many pictures stand on the slide of a view.
fn count(view: View) -> u32 {
    match view {
        View::Pane(_) => 1,
        View::Wipe | View::SideBySide => 2,
        View::ErrorMap => 3,
    }
}

impl SlideSize {
    /// Pixels of so many parts of 1080 of its height.
    fn parts(self, parts: u32) -> u32 {
        parts * self.pixels().1 / 1080
    }

    /// The most room that one of `count` pictures has.
    fn room(self, count: u32) -> (u32, u32) {
        let (width, height) = self.pixels();
        let width = (width - 2 * self.parts(MARGIN) - (count - 1) * self.parts(GAP)) / count;
        let rest = 2 * MARGIN + TITLE + 2 * GAP + LINES * ROW;
        (width, height - self.parts(rest))
    }

    /// How large pictures of this view are rendered for it, so that a pixel is a pixel: at most 16:9, and
    /// not higher than wide.
    pub fn size_of_pictures(self, view: View) -> (u32, u32) {
        let (width, height) = self.room(count(view));
        (width.min(height * 16 / 9), height.min(width))
    }
}

impl LabReport {
    /// The slide as RGBA bytes: the picture of one pane, A and B, or both and the map of errors, as the view says.
    ///
    /// # Errors
    /// If there is nothing to show, or no memory to measure it.
    pub fn slide(&self, size: SlideSize, colours: SlideColours) -> anyhow::Result<Vec<u8>> {
        let columns = self.columns()?;
        ensure!(!columns.is_empty(), "there is no picture for a slide yet; try again in a moment");
        let canvas = Canvas::filled(size.pixels(), colours.ground);
        let mut drawing = Drawing { size, colours, canvas, lettering: Lettering::default() };
        drawing.title(&self.title_over(&columns));
        drawing.columns(&columns);
        Ok(drawing.canvas.rgba())
    }

    fn title_over(&self, columns: &[Column]) -> String {
        let is_judged = columns.iter().any(|column| column.is_judged);
        let against = if is_judged { ", held against the reference" } else { "" };
        format!("{}{against}", self.name_of_scene())
    }

    fn columns(&self) -> Result<Vec<Column>, CompareError> {
        let measured = self.measured()?;
        let view = self.session.view;
        let is_seen = |picture: &&ReportedPicture| match view {
            View::Pane(pane) => picture.pane == pane,
            _ => true,
        };
        let pictures = self.pictures.iter().filter(is_seen);
        let mut columns: Vec<Column> = pictures.map(|picture| self.column(picture, &measured)).collect();
        if view == View::ErrorMap {
            columns.extend(self.column_of_the_map()?);
        }
        Ok(columns)
    }

    fn column(&self, picture: &ReportedPicture, measured: &[Measured]) -> Column {
        let own = |measured: &&Measured| {
            measured.of == picture.pane && measured.in_the_region == self.session.comparison.region.is_some()
        };
        let mut facts: Vec<String> =
            std::iter::once(picture.cost()).chain(picture.untold_denoiser(&self.pictures)).collect();
        let measured = measured.iter().find(own);
        if let Some(measured) = measured {
            let judge = match measured.against {
                Against::Pane(pane) => Some(pane.name()),
                Against::Reference => None,
            };
            let [off, _] = error_words(&measured.errors, judge);
            let place = if measured.in_the_region { format!(", {IN_THE_REGION}") } else { String::new() };
            facts.push(format!("{off}{place}"));
            facts.push(format!("relMSE {}, FLIP {}", brief(measured.errors.rel_mse), brief(measured.flip)));
        } else if self.shows_too_little(picture) {
            facts.push(NO_REFERENCE_OF_A_PART.to_owned());
        }
        Column {
            picture: Shown { size: picture.image.size(), rgba: self.session.display.rgba8_of(&picture.image) },
            pane: Some(picture.pane),
            name: format!("{}: {}", picture.pane, picture.label(&self.pictures)),
            facts,
            scale: None,
            is_judged: measured.is_some_and(|measured| measured.against == Against::Reference),
        }
    }

    fn column_of_the_map(&self) -> Result<Option<Column>, CompareError> {
        Ok(self.map_of_the_view()?.map(|(pane, against, map)| Column {
            picture: Shown { size: (map.width, map.height()), rgba: map.rgba() },
            pane: None,
            name: format!("{pane} against {}, {}", against.name(), map.map.name()),
            facts: meaning_of(map.map).map(str::to_owned).into_iter().collect(),
            scale: Some(map.scale),
            is_judged: against == Against::Reference,
        }))
    }
}

/// What the ends of its colours mean, where numbers do not say so.
fn meaning_of(metric: ErrorMetric) -> Option<&'static str> {
    (metric == ErrorMetric::Signed).then_some("blue: too dark, orange: too bright")
}

impl Drawing {
    fn look(&self, size: u32, semi_bold: bool, colour: [u8; 3]) -> Type {
        Type { size: self.size.parts(size) as f32, semi_bold, colour }
    }

    /// Thin strokes are the first that a bright room takes from dark type.
    fn fact(&self) -> Type {
        self.look(LABEL, self.colours == LIGHT, self.colours.text)
    }

    /// Writes lines from a corner on; returns how high they are.
    fn write(&mut self, text: &str, look: Type, (at, width): ((u32, u32), u32), most_lines: usize) -> u32 {
        let laid_out = self.lettering.lay_out(text, look, width, most_lines);
        self.lettering.draw(&mut self.canvas, &laid_out, at, look.colour)
    }

    fn title(&mut self, text: &str) {
        let (margin, width) = (self.size.parts(MARGIN), self.size.pixels().0);
        let look = self.look(TITLE, true, self.colours.text);
        // the row is higher than the capitals, which keep to the margin
        let top = margin - self.size.parts(TITLE) / 5;
        self.write(text, look, ((margin, top), width - 2 * margin), 1);
    }

    fn columns(&mut self, columns: &[Column]) {
        let room = self.size.room(columns.len() as u32);
        let pictures: Vec<Shown> = columns.iter().map(|column| column.picture.within(room)).collect();
        let tallest = pictures.iter().map(|picture| picture.size.1).max().unwrap_or(0);
        let top = self.size.parts(MARGIN + TITLE + GAP) + (room.1 - tallest) / 2;
        for (place, (column, picture)) in (0..).zip(columns.iter().zip(&pictures)) {
            let left = self.size.parts(MARGIN) + place * (room.0 + self.size.parts(GAP));
            let inset = ((room.0 - picture.size.0) / 2, (tallest - picture.size.1) / 2);
            self.canvas.place((left + inset.0, top + inset.1), (picture.size.0, &picture.rgba));
            // under its picture, but never narrower than half of the room
            let width = picture.size.0.max(room.0 / 2);
            let at = (left + (room.0 - width) / 2, top + tallest + self.size.parts(GAP) / 2);
            self.label(column, at, width);
        }
    }

    fn label(&mut self, column: &Column, (left, top): (u32, u32), width: u32) {
        let name = self.look(LABEL, true, self.colours.of_pane(column.pane));
        let mut lines_left = LINES as usize;
        let mut y = top;
        if let Some(scale) = &column.scale {
            y += self.bar(scale, (left, y), width);
            lines_left -= 2;
        }
        let row = self.size.parts(ROW);
        let texts = std::iter::once((&column.name, name));
        let fact = self.fact();
        for (text, look) in texts.chain(column.facts.iter().map(|text| (text, fact))) {
            let high = self.write(text, look, ((left, y), width), lines_left.min(2));
            lines_left -= (high.div_ceil(row.max(1)) as usize).clamp(1, lines_left);
            y += high;
            if lines_left == 0 {
                return;
            }
        }
    }

    /// The colours of a map and their values; returns how high both are.
    fn bar(&mut self, scale: &ColourScale, (left, top): (u32, u32), width: u32) -> u32 {
        let height = self.size.parts(BAR);
        self.canvas.place((left, top), (width, &scale.bar(width, height)));
        let look = self.fact();
        let below = top + height;
        let mut taken: Vec<[u32; 2]> = Vec::new();
        for mark in ends_first(marks(scale, 3)) {
            let text = self.lettering.lay_out(&mark.text, look, width, 1);
            let wide = text.rect.width().ceil() as u32;
            let middle = left + (mark.position * width as f32) as u32;
            let at = middle.saturating_sub(wide / 2).clamp(left, (left + width).saturating_sub(wide).max(left));
            let room = [at.saturating_sub(wide / 8), at + wide + wide / 8];
            // what has no room beside the ends is left out
            if taken.iter().all(|other| room[1] <= other[0] || other[1] <= room[0]) {
                self.lettering.draw(&mut self.canvas, &text, (at, below), look.colour);
                taken.push(room);
            }
        }
        height + self.size.parts(ROW)
    }
}

/// In the order in which they are given room.
fn ends_first(mut marks: Vec<Tick>) -> Vec<Tick> {
    let last = marks.len().saturating_sub(1);
    if last > 1 {
        marks.swap(1, last);
    }
    marks
}

#[cfg(test)]
#[path = "slide_tests.rs"]
mod tests;
