//! The ladder as a bar chart: what is left of the error after each rung, and what a frame costs there, both on logarithmic scales.

use super::Reached;
use std::fmt::Write;

const WIDTH: f64 = 980.0;
const ROW: f64 = 26.0;
const TOP: f64 = 64.0;
/// Where titles end, where the bars of errors lie, and those of times.
const TITLES: f64 = 290.0;
const ERRORS: [f64; 2] = [300.0, 580.0];
const TIMES: [f64; 2] = [680.0, 900.0];

/// Colours of errors and of times, which differ in brightness too.
const COLOURS: [&str; 2] = ["#2b6cb0", "#dd8a2e"];

/// The bars of all rungs as an SVG document, white and without scripts.
pub fn chart(scene: &str, reached: &[Reached]) -> String {
    let height = TOP + ROW * reached.len() as f64 + 20.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"20\" y=\"26\" font-size=\"17\" font-weight=\"bold\">{}: from the fake to the truth</text>\n\
         <text x=\"{}\" y=\"50\" fill=\"#444\">relMSE that is left</text>\n\
         <text x=\"{}\" y=\"50\" fill=\"#444\">milliseconds a frame, all maps anew</text>\n",
        escaped(scene),
        ERRORS[0],
        TIMES[0],
    );
    let scales = [
        Scale::of(reached.iter().map(|rung| rung.errors.errors.rel_mse), ERRORS),
        Scale::of(reached.iter().map(|rung| rung.anew_ms), TIMES),
    ];
    for (index, rung) in reached.iter().enumerate() {
        let y = TOP + ROW * index as f64;
        let middle = y + 0.5 * ROW + 4.0;
        let _ = writeln!(
            svg,
            "<text x=\"{TITLES}\" y=\"{middle}\" text-anchor=\"end\"><title>{}</title>{}</text>",
            escaped(rung.rung.text()),
            escaped(rung.rung.title()),
        );
        let figures = [(rung.errors.errors.rel_mse, 4), (rung.anew_ms, 1)];
        for ((scale, colour), (figure, decimals)) in scales.iter().zip(COLOURS).zip(figures) {
            let length = scale.length(figure);
            let from = scale.span[0];
            let _ = writeln!(
                svg,
                "<rect x=\"{from}\" y=\"{:.1}\" width=\"{length:.1}\" height=\"{:.1}\" fill=\"{colour}\"/>\
                 <text x=\"{:.1}\" y=\"{middle}\">{figure:.decimals$}</text>",
                y + 4.0,
                ROW - 8.0,
                from + length + 6.0,
            );
        }
    }
    svg + "</svg>\n"
}

/// A logarithmic scale across a part of the width.
struct Scale {
    /// Its ends, as powers of ten.
    least: f64,
    most: f64,
    span: [f64; 2],
}

impl Scale {
    /// One that the smallest of these figures still has a bar on.
    fn of(figures: impl Iterator<Item = f64>, span: [f64; 2]) -> Self {
        let logs = figures.filter(|figure| *figure > 0.0 && figure.is_finite()).map(f64::log10);
        let (least, most) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), log| (a.min(log), b.max(log)));
        if least > most {
            Scale { least: 0.0, most: 1.0, span }
        } else {
            Scale { least: least - 0.3, most: most.max(least + 0.1), span }
        }
    }

    fn length(&self, figure: f64) -> f64 {
        let share = (figure.max(1e-300).log10() - self.least) / (self.most - self.least);
        (self.span[1] - self.span[0]) * share.clamp(0.0, 1.0)
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_grow_with_their_figures_and_stay_within_their_part() {
        let scale = Scale::of([0.01, 1.0, f64::NAN].into_iter(), ERRORS);
        let lengths = [0.0, 0.01, 0.1, 1.0, 10.0].map(|figure| scale.length(figure));
        assert!(lengths.is_sorted() && lengths[0] == 0.0 && lengths[1] > 10.0, "{lengths:?}");
        assert_eq!(lengths[3], ERRORS[1] - ERRORS[0]);
        assert_eq!(Scale::of(std::iter::empty(), TIMES).length(5.0), (TIMES[1] - TIMES[0]) * 5f64.log10());
    }
}
