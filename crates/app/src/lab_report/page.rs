//! The page: one HTML file that needs no other and no network, to be read on a phone and on a projector, and printed.

use super::pictures::{LONGEST_SIDE, Shown};
use super::settings::Row;
use super::{LabReport, Measured, NO_REFERENCE_OF_A_PART, ReportedPicture, duration, plot};
use crate::model::{Against, Cost, Curve, IN_THE_REGION, Measure, Owner, PlotSettings};
use crate::ruler::{GREY, HeatMap, error_words, marks, noise_line};
use anyhow::Context;
use bench::{Host, data_uri};
use compare::{ColourScale, ErrorMetric, REL_MSE_FLOOR, escaped};
use technique::Device;

const STYLE: &str = include_str!("style.css");

/// Pixels of a map's bar of colours.
const BAR: (u32, u32) = (256, 12);

impl LabReport {
    /// The page as a whole document.
    ///
    /// # Errors
    /// If there is no memory for a map, or a picture cannot be encoded.
    pub fn html(&self) -> anyhow::Result<String> {
        let measured = self.measured()?;
        let title = escaped(&format!("{}: lab report", self.name_of_scene()));
        let sections = [
            ("Pictures", self.all_pictures(&measured)?),
            ("Errors", self.errors(&measured)),
            ("How errors fell", self.plots()),
            ("Settings", self.settings()),
            ("Time and machine", self.times()),
            ("To make it again", self.again()),
        ];
        let sections = sections.map(|(heading, html)| format!("<section>\n<h2>{heading}</h2>\n{html}</section>\n"));
        Ok(format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <meta name=\"color-scheme\" content=\"light dark\">\n<meta name=\"generator\" content=\"visavis {version}\">\n\
             <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n<p>{}</p>\n{}\
             </main>\n</body>\n</html>\n",
            escaped(&self.head()),
            sections.concat(),
            version = env!("CARGO_PKG_VERSION"),
        ))
    }

    /// What it is about, in one line.
    fn head(&self) -> String {
        let of = |picture: &ReportedPicture| format!("{}: {}", picture.pane, picture.title(&self.pictures));
        let pictures: Vec<String> = self.pictures.iter().map(of).collect();
        format!("{}. {}.", pictures.join("; "), self.date)
    }

    fn all_pictures(&self, measured: &[Measured]) -> anyhow::Result<String> {
        let mut html = String::from("<div class=\"grid\">\n");
        for picture in &self.pictures {
            let shown = shown(&self.session.display.rgba8_of(&picture.image), picture.image.size());
            let judged = measured.iter().find(|measured| measured.of == picture.pane && !measured.in_the_region);
            let heading = format!("{}: {}", picture.pane, picture.title(&self.pictures));
            let too_little = self.shows_too_little(picture).then(|| NO_REFERENCE_OF_A_PART.to_owned());
            let facts = std::iter::once(picture.cost()).chain(judged.map(in_words)).chain(too_little);
            let facts = facts.chain(picture.notes.iter().cloned());
            html += &figure(&shown, &heading, &facts.collect::<Vec<_>>().join("; "), "")?;
        }
        if let Some(reference) = &self.reference {
            let image = &reference.image.image;
            let shown = shown(&self.session.display.rgba8_of(image), image.size());
            html += &figure(&shown, "Reference", &reference.made, "")?;
        }
        for (pane, against, map) in self.maps()? {
            let heading = format!("Errors of {pane} against {}", against.name());
            let shown = shown(&map.rgba(), (map.width, map.height()));
            html += &figure(&shown, &heading, &map_words(&map), &bar(&map.scale)?)?;
        }
        html += "</div>\n";
        let stops = self.session.display.exposure;
        let exposure = if stops == 0.0 { String::new() } else { format!(" at {stops:+} stops") };
        let size = self.pictures.first().map_or((0, 0), |picture| picture.image.size());
        html += &format!(
            "<p class=\"small\">All pictures have {} × {} pixels and go through one display transform{exposure}: linear radiance, \
             clipped at white, in sRGB.</p>\n",
            size.0, size.1
        );
        Ok(html)
    }

    fn errors(&self, measured: &[Measured]) -> String {
        if measured.is_empty() {
            return format!("<p>{}</p>\n", self.why_nothing_is_measured());
        }
        let rows: String = measured.iter().map(row_of_errors).collect();
        let names = ["Picture", "Held against", "In words", "relMSE", "RMSE", "MAE", "Mean difference", "FLIP"];
        let mut html = table("How far the pictures are off, in linear radiance", &names, &rows);
        let noise =
            measured.iter().filter(|measured| measured.against == Against::Reference && !measured.in_the_region);
        if let Some(line) = noise.filter_map(|measured| noise_line(&measured.errors)).next() {
            html += &format!("<p>The reference's own error: {}.</p>\n", escaped(&line));
        }
        for part in self.pictures.iter().filter(|picture| self.shows_too_little(picture)) {
            html += &format!("<p class=\"note\">{}: {NO_REFERENCE_OF_A_PART}.</p>\n", part.pane);
        }
        if self.reference.is_none() {
            html += "<p class=\"note\">No reference judges these pictures: they are held against each other, and either may be \
                     wrong.</p>\n";
        }
        if let Some(region) = self.session.comparison.region {
            let share = |[x, y]: [f32; 2]| format!("{:.1} %, {:.1} %", 100.0 * x, 100.0 * y);
            html += &format!(
                "<p>The region goes from {} to {} of width and height.</p>\n",
                share(region.start),
                share(region.end)
            );
        }
        html + &format!(
            "<p class=\"small\">Of a picture a held against r: relMSE is the mean of (a − r)² / (r² + {REL_MSE_FLOOR}), RMSE the root \
             of the mean of (a − r)², MAE the mean of |a − r|, the mean difference that of a − r, each over pixels and \
             channels. FLIP is the mean difference that people see, of the pictures as they are shown here. The same figures \
             as those of <code>visavis compare</code>.</p>\n"
        )
    }

    fn why_nothing_is_measured(&self) -> &'static str {
        if self.pictures.iter().any(ReportedPicture::shows_a_part_of_the_light) {
            "A part of the light has no reference, and pictures of different light are not held against each other."
        } else {
            "None of these pictures shows light that could be held against another."
        }
    }

    fn plots(&self) -> String {
        let curves = self.curves_by_label();
        if curves.is_empty() {
            return "<p>No errors were measured while these pictures were made.</p>\n".into();
        }
        let measure = self.session.plots.measure;
        let plot = |over: Cost| {
            let settings = PlotSettings { over, measure, ..self.session.plots };
            let svg = plot::svg(&curves, settings, &self.scene.name);
            let words = format!("{} over {}, both on logarithmic axes", measure.name(), over.label());
            let of = escaped(&words);
            format!(
                "<figure class=\"plot\">\n<div role=\"img\" aria-label=\"{of}\">\n{svg}</div>\n<figcaption>{of}.</figcaption>\n</figure>\n"
            )
        };
        let slope = match measure {
            Measure::RelMse => "−1",
            Measure::Rmse | Measure::Mae => "−1/2",
        };
        Cost::ALL.map(plot).concat()
            + &format!(
                "<p class=\"small\">Of nothing but noise, {} falls with the samples by a slope of {slope}, the dashed grey line. \
                 What stays level is a bias. Dotted: what takes no samples.</p>\n",
                measure.name()
            )
    }

    /// Those of panes by what tells the pictures apart, as these are called elsewhere on the page.
    fn curves_by_label(&self) -> Vec<Curve> {
        let mut curves = self.curves.clone();
        for curve in &mut curves {
            let own = |picture: &&ReportedPicture| curve.owner == Owner::Pane(picture.pane);
            if let Some(picture) = self.pictures.iter().find(own) {
                curve.name = format!("{}: {}", picture.pane, picture.title(&self.pictures));
            }
        }
        curves
    }

    fn settings(&self) -> String {
        let rows = self.rows();
        let names = || self.pictures.iter().map(|picture| picture.pane.name());
        let header: Vec<&str> = ["Setting"].into_iter().chain(names()).chain(["Usually"]).collect();
        let technique = |picture: &ReportedPicture| match picture.external {
            Some(_) => "another program's".to_owned(),
            None => picture.provenance.technique.name().name().to_owned(),
        };
        let cells = self.pictures.iter().map(|picture| cell(&technique(picture))).collect::<String>();
        let first = format!("<tr><th scope=\"row\">technique</th>{cells}<td></td></tr>\n");
        let stated: String = rows.iter().filter(|row| row.says_something()).map(row_of_settings).collect();
        let mut html = table("What is not as usual, or differs between the pictures", &header, &(first + &stated));
        let all: String = rows.iter().map(row_with_help).collect();
        let header: Vec<&str> = header.into_iter().chain(["What it does"]).collect();
        let all = table("All settings that change one of the pictures", &header, &all);
        html += &format!("<details>\n<summary>All settings ({})</summary>\n{all}</details>\n", rows.len());
        html + &self.camera()
    }

    /// What is seen, and from where.
    fn camera(&self) -> String {
        let Some(shot) = self.pictures.first().map(|picture| &picture.provenance.shot) else { return String::new() };
        let point = |p: scene::Vec3| format!("{}, {}, {}", p.x, p.y, p.z);
        let rows = [
            ("Scene", self.name_of_scene()),
            ("Opened as", shot.source.clone()),
            ("Hash of the scene", shot.scene.as_read.to_string()),
            ("Size", format!("{} × {} pixels", shot.size.0, shot.size.1)),
            ("Camera stands at", point(shot.camera.eye)),
            ("It looks at", point(shot.camera.target)),
            ("Up is", point(shot.camera.up)),
            ("Its vertical angle of view", format!("{}°", shot.camera.fov_y)),
        ];
        facts("Scene and camera", &rows)
    }

    fn times(&self) -> String {
        let names =
            ["Picture", "Samples per pixel", "Time", "Processor time", "Samples a second", "Rays a second", "Made by"];
        let rows: String = self.pictures.iter().map(row_of_times).collect();
        let made_here = self.pictures.iter().filter(|picture| picture.external.is_none());
        let on_gpu = made_here.filter(|picture| picture.provenance.device == Device::Gpu);
        let mut adapters: Vec<&str> = on_gpu.map(|picture| picture.adapter.as_str()).collect();
        adapters.dedup();
        let adapter = if adapters.is_empty() { "not used".to_owned() } else { adapters.join(", ") };
        let host = Host::this(adapter);
        let machine = [
            ("Processor", host.cpu),
            ("Threads", host.threads.to_string()),
            ("Graphics device", host.adapter),
            ("System", host.system),
            ("Program", format!("visavis {}", env!("CARGO_PKG_VERSION"))),
            ("Date", self.date.clone()),
        ];
        table("What the pictures took", &names, &rows) + &facts("The machine", &machine)
    }

    fn again(&self) -> String {
        let exposure = self.session.display.exposure;
        let line = |picture: &ReportedPicture| format!("{}\n", picture.command(exposure));
        let reference = self.pictures.first().filter(|_| self.reference.is_some());
        let reference = reference.map(|picture| format!("{}\n", picture.provenance.shot.reference_command()));
        let commands: String = self.pictures.iter().map(line).chain(reference).collect();
        let session = data_uri("application/toml", self.session_text.as_bytes());
        let page = if self.pictures.iter().any(|picture| picture.external.is_some()) {
            "from there such a page is saved."
        } else {
            "<code>visavis report session.toml -o report.html</code> makes such a page."
        };
        format!(
            "<p>Each of these lines makes one picture:</p>\n<pre><code>{}</code></pre>\n\
             <p>The session makes all of it: saved as a file, <code>visavis session.toml</code> opens it in a window, and {page}</p>\n\
             <details>\n<summary>The session</summary>\n\
             <p><a download=\"session.toml\" href=\"{session}\">Save as session.toml</a></p>\n\
             <pre><code>{}</code></pre>\n</details>\n",
            lines(&commands),
            lines(&self.session_text)
        )
    }
}

/// Text of several lines, which [`escaped`] would join.
fn lines(text: &str) -> String {
    text.lines().map(|line| escaped(line) + "\n").collect()
}

fn shown(rgba: &[u8], size: (u32, u32)) -> Shown {
    Shown { size, rgba: rgba.to_vec() }
}

fn figure(picture: &Shown, heading: &str, words: &str, below: &str) -> anyhow::Result<String> {
    let side = picture.shrink_within(LONGEST_SIDE);
    let small = picture.shrunk(side);
    let shrunk = match side {
        1 => String::new(),
        _ => format!("; here the mean of {side} × {side} pixels is one"),
    };
    let address = small.address().context("cannot put a picture into the report")?;
    let ((width, height), heading) = (small.size, escaped(heading));
    let words = escaped(&format!("{words}{shrunk}"));
    Ok(format!(
        "<figure>\n<img src=\"{address}\" width=\"{width}\" height=\"{height}\" alt=\"{heading}; {words}\">\n{below}\
         <figcaption><b>{heading}</b><br>{words}</figcaption>\n</figure>\n"
    ))
}

/// A map's colours with what they mean.
fn bar(scale: &ColourScale) -> anyhow::Result<String> {
    let picture = Shown { size: BAR, rgba: scale.bar(BAR.0, BAR.1) };
    let address = picture.address().context("cannot put a bar of colours into the report")?;
    let mark = |tick: &compare::Tick| {
        format!("<span style=\"left:{:.1}%\">{}</span>", 100.0 * tick.position, escaped(&tick.text))
    };
    let numbers: String = marks(scale, 4).iter().map(mark).collect();
    let (low, high) = (scale.low, scale.high);
    Ok(format!("<div class=\"bar\"><img src=\"{address}\" alt=\"Colours from {low} to {high}\">{numbers}</div>\n"))
}

fn map_words(map: &HeatMap) -> String {
    let sign = if map.map == ErrorMetric::Signed { "; blue: too dark, orange: too bright" } else { "" };
    let grey = if map.within_noise.is_some() { format!("; grey: {GREY}") } else { String::new() };
    format!("{}{sign}{grey}", map.label)
}

fn in_words(measured: &Measured) -> String {
    error_words(&measured.errors, judge(measured)).join(", ")
}

/// The name of what need not be right itself.
fn judge(measured: &Measured) -> Option<&'static str> {
    match measured.against {
        Against::Pane(pane) => Some(pane.name()),
        Against::Reference => None,
    }
}

fn row_of_errors(measured: &Measured) -> String {
    let e = &measured.errors;
    let place = if measured.in_the_region { format!(", {IN_THE_REGION}") } else { String::new() };
    let numbers = [e.rel_mse, e.rmse, e.mae].map(|value| number(&format!("{value:.6}"))).concat();
    format!(
        "<tr><th scope=\"row\">{}{place}</th>{}{}{numbers}{}{}</tr>\n",
        measured.of,
        cell(measured.against.name()),
        cell(&in_words(measured)),
        number(&format!("{:+.6}", e.bias)),
        number(&format!("{:.6}", measured.flip))
    )
}

fn row_of_settings(row: &Row) -> String {
    format!("<tr><th scope=\"row\">{}</th>{}{}</tr>\n", row.name, values(row), cell(&row.usual_words()))
}

fn row_with_help(row: &Row) -> String {
    let (usual, help) = (cell(&row.usual_words()), cell(row.help));
    format!("<tr><th scope=\"row\">{}</th>{}{usual}{help}</tr>\n", row.name, values(row))
}

fn values(row: &Row) -> String {
    row.values.iter().map(|value| cell(value.as_deref().unwrap_or("–"))).collect()
}

fn row_of_times(picture: &ReportedPicture) -> String {
    let a_second = |count: u64| format!("{:.3e}", count as f64 / picture.seconds.max(1e-9));
    let known = |value: Option<String>| number(&value.unwrap_or_else(|| "–".into()));
    let samples = picture.spp.map(|_| match picture.runs {
        1 => picture.spp_of_run().to_string(),
        runs => format!("{runs} × {}", picture.spp_of_run()),
    });
    let stats = picture.stats.filter(|_| picture.external.is_none());
    let cells = [
        known(samples),
        known(Some(duration(picture.seconds)).filter(|_| picture.external.is_none())),
        known(picture.core_seconds.map(|seconds| format!("{seconds:.2} core-seconds"))),
        known(stats.map(|stats| a_second(stats.samples))),
        known(stats.map(|stats| a_second(stats.rays))),
        cell(&match &picture.external {
            Some(external) => external.source.to_string(),
            None => format!("{}: {}", picture.provenance.device.name(), picture.adapter),
        }),
    ];
    format!("<tr><th scope=\"row\">{}</th>{}</tr>\n", picture.pane, cells.concat())
}

fn cell(text: &str) -> String {
    format!("<td>{}</td>", escaped(text))
}

fn number(text: &str) -> String {
    let signed = text.strip_prefix('-').map_or_else(|| text.to_owned(), |digits| format!("−{digits}"));
    format!("<td class=\"n\">{}</td>", escaped(&signed))
}

fn table(caption: &str, names: &[&str], rows: &str) -> String {
    let header: String = names.iter().map(|name| format!("<th scope=\"col\">{}</th>", escaped(name))).collect();
    format!(
        "<div class=\"wide\">\n<table>\n<caption>{}</caption>\n<thead><tr>{header}</tr></thead>\n<tbody>\n{rows}</tbody>\n\
         </table>\n</div>\n",
        escaped(caption)
    )
}

/// A table of names and what they are.
fn facts(caption: &str, rows: &[(&str, String)]) -> String {
    let row = |(name, value): &(&str, String)| {
        format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(name), escaped(value))
    };
    let rows: String = rows.iter().map(row).collect();
    format!("<table class=\"facts\">\n<caption>{}</caption>\n<tbody>\n{rows}</tbody>\n</table>\n", escaped(caption))
}
