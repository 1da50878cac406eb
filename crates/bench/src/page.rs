//! The page: everything in one HTML file that needs no other, to be read on a projector and printed.

mod glossary;
mod table;

use crate::pictures::{PicturePair, data_uri};
use crate::plots::{Plot, duration};
use crate::summary::{PartSummary, bias_rule, slope_words};
use compare::{Fit, escaped};

/// What the page tells.
pub struct Page<'a> {
    /// All parts, each with its plots.
    pub parts: Vec<(&'a PartSummary, Vec<Plot>)>,
    /// The techniques' pictures, and of which part.
    pub pairs: Vec<(String, Vec<PicturePair>)>,
    /// What is left out or went wrong, a sentence each.
    pub notes: &'a [String],
    /// Parts and lines whose seconds are not all by the device's own clock.
    pub by_the_wall: &'a [(String, String)],
    /// How it was made: names and values.
    pub made: Vec<(&'static str, String)>,
}

const STYLE: &str = include_str!("page/style.css");

impl Page<'_> {
    /// The page as a whole document.
    pub fn html(&self) -> String {
        let mut html = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>Visavis: speed against error</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>Speed against error</h1>\n"
        );
        html += "<p>Every technique renders the same scene at the same size; every picture is held against a reference of \
                 many more samples, in linear radiance. Five pictures of independent seeds make each number: its median, \
                 and its range.</p>\n";
        for note in self.notes {
            html += &format!("<p class=\"note\">{}</p>\n", escaped(note));
        }
        html += &self.slopes();
        for (part, plots) in &self.parts {
            html += &section(part, plots);
        }
        html += &self.timed_by_the_wall();
        for (part, pairs) in self.pairs.iter().filter(|(_, pairs)| !pairs.is_empty()) {
            html += &format!("<h2>{}: where the techniques are wrong</h2>\n", escaped(part));
            pairs.iter().for_each(|pair| html += &figure(pair));
        }
        html += &glossary::html();
        html += "<h2>How this page was made</h2>\n<table class=\"made\">\n";
        for (name, value) in &self.made {
            html += &format!("<tr><th>{}</th><td>{}</td></tr>\n", escaped(name), escaped(value));
        }
        html + "</table>\n</body>\n</html>\n"
    }

    /// Whose seconds are to be read with care, by their parts.
    fn timed_by_the_wall(&self) -> String {
        let mut parts: Vec<(&str, Vec<&str>)> = Vec::new();
        for (part, line) in self.by_the_wall {
            match parts.iter_mut().find(|(known, _)| known == part) {
                Some((_, lines)) => lines.push(line),
                None => parts.push((part, vec![line])),
            }
        }
        let item =
            |(part, lines): &(&str, Vec<&str>)| format!("<li>{}: {}</li>\n", escaped(part), escaped(&lines.join(", ")));
        match parts.is_empty() {
            true => String::new(),
            false => format!(
                "<p class=\"note\">Seconds of these lines are in part by the wall's clock. A device's own clock times each \
                 piece of work; of pieces for which it has none, or says less than a quarter of what the wall's does, the \
                 wall's seconds count, with what the driver does beside the work.</p>\n<ul>\n{}</ul>\n",
                parts.iter().map(item).collect::<String>()
            ),
        }
    }

    /// The claim of Monte Carlo and what was measured of it, in one table.
    fn slopes(&self) -> String {
        let mut html = String::from(
            "<h2>How fast errors fall</h2>\n<p>Slope ± standard error: errors fall like samples<sup>slope</sup>: \u{2212}0.50 is what independent \
             numbers promise; well-spread points do better where the picture is smooth; a bias ends it.</p>\n\
             <table>\n<tr><th>scene</th><th>line</th><th>RMSE</th><th>root of relMSE</th><th>between its last \
             two</th></tr>\n",
        );
        for (part, _) in &self.parts {
            for curve in part.curves.iter().filter(|curve| curve.line.converges() && !curve.line.is_a_variant()) {
                let words =
                    |fit: Option<Fit>| fit.map_or("within the reference's noise".into(), |fit| slope_words(&fit));
                let (slope, relative) = (words(curve.slope), words(curve.relative_slope));
                let tail = if part.worth.is_reliable() { "" } else { " (heavy tail)" };
                let last = curve.last_slope.map_or("\u{2013}".into(), |s| format!("{s:.2}").replace('-', "\u{2212}"));
                html += &format!(
                    "<tr><td>{}{tail}</td><td>{}</td><td class=\"n\">{slope}</td><td \
                     class=\"n\">{relative}</td><td class=\"n\">{last}</td></tr>\n",
                    escaped(&part.part.title()),
                    escaped(&curve.line.name())
                );
            }
        }
        html + "</table>\n"
    }
}

fn section(summary: &PartSummary, plots: &[Plot]) -> String {
    let (part, worth) = (&summary.part, &summary.worth);
    let mut html = format!("<h2>{}, {} \u{d7} {} pixels</h2>\n", escaped(&part.title()), part.width, part.height);
    html += &format!(
        "<p>Reference: {} samples per pixel, {}; its own RMSE {:.1e}, its own relMSE {:.1e}, by the spread of its {} \
         independent pictures.</p>\n",
        worth.spp,
        duration(worth.seconds),
        worth.mse.sqrt(),
        worth.rel_mse,
        worth.spp / u64::from(reference::SAMPLES_PER_REPLICATE)
    );
    if !worth.is_reliable() {
        html += &format!(
            "<p class=\"note\">A heavy tail: {:.0} % of this reference's own squared error lie in pixels that owe their light to \
             rare paths, such as a caustic's, too few to know how rare they are. Its standard error is not to be relied on, \
             and with it slopes and bias tests; and a median of few samples looks better than it is, because most pictures \
             have not met the rarest light yet.</p>\n",
            100.0 * worth.tail_weight
        );
    }
    for plot in plots {
        html += &format!("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", plot.svg, escaped(&plot.caption));
    }
    html += &table::of(summary);
    html += &table::of_variants(summary);
    html + &format!(
        "<p class=\"small\">Spp: samples per pixel. Medians over seeds, ranges in brackets. Efficiency: 1 / (MSE \u{d7} seconds). {} Grey: within \
         the reference's own noise.</p>\n",
        escaped(&bias_rule())
    )
}

fn figure(pair: &PicturePair) -> String {
    let (width, height) = pair.size;
    let image = |png: &[u8], what: &str| {
        format!(
            "<div><img src=\"{}\" width=\"{width}\" height=\"{height}\" alt=\"{what}\"><p>{what}</p></div>\n",
            data_uri("image/png", png)
        )
    };
    let mut html = format!("<h3>{}</h3>\n<div class=\"row\">\n", escaped(&pair.title));
    html += &image(&pair.picture, "A, the technique");
    html += &image(&pair.truth, "the reference");
    html += &image(&pair.map, pair.label);
    html += &format!("</div>\n<div class=\"bar\"><img src=\"{}\" alt=\"colours\">", data_uri("image/png", &pair.bar));
    for tick in &pair.ticks {
        let at = 100.0 * tick.position;
        html += &format!("<span style=\"left:{at:.1}%\">{}</span>", escaped(&tick.text));
    }
    html + "</div>\n<p class=\"small\">Radiance, mean of the three channels; blue: too dark, orange: too bright.</p>\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page_with(by_the_wall: &[(String, String)]) -> String {
        let pairs = vec![("cornell".to_owned(), Vec::new())];
        Page { parts: Vec::new(), pairs, notes: &[], by_the_wall, made: Vec::new() }.html()
    }

    #[test]
    fn lines_that_the_wall_timed_are_one_list_below_what_was_measured() {
        let lines = [("cornell", "mis gpu"), ("cornell", "mis gpu through a tree"), ("whitted", "mis gpu")];
        let page = page_with(&lines.map(|(part, line)| (part.to_owned(), line.to_owned())));
        assert_eq!(
            page.matches("by the wall's clock").count(),
            1 + page_with(&[]).matches("by the wall's clock").count()
        );
        let list =
            page.find("<li>cornell: mis gpu, mis gpu through a tree</li>\n<li>whitted: mis gpu</li>").expect("a list");
        assert!(page.find("How fast errors fall") < Some(list) && Some(list) < page.find("<h2>Words</h2>"));
    }
}
