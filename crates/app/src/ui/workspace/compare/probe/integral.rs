//! The tutorial's integral with the numbers of one sample in it, and what all samples make of it.

use super::mean::ERRORS;
use super::{is_external, probed, samples, spread, traced, value_without_samples};
use crate::model::{Channel, PaneId, PaneProbe, PixelSamples};
use crate::ruler::brief;
use crate::ui::UiContext;
use crate::ui::theme::palette;
use crate::ui::widgets::{Explained, framed};
use egui::text::{LayoutJob, TextFormat};
use egui::{Align, Color32, DragValue, FontId, Response, RichText, TextStyle, Ui};
use film::Vec3;
use pathtrace::{FirstVertex, LeftOut, Met, SamplerKind, Term, Terms};
use technique::{Device, Technique};

/// As the lecture writes it.
const INTEGRAL: &str = "L_o = L_e + ∫ f_r L_i cosθ dω ≈ L_e + 1/N Σ f_r L_i cosθ / p(ω)";

/// Turns to a sample that lies so many farther.
pub fn turn(cx: &mut UiContext, by: i64) {
    let last = most_samples(cx).saturating_sub(1);
    let now = i64::from(cx.model.state.probed_sample.unwrap_or(last).min(last));
    let next = (now + by).clamp(0, i64::from(last)) as u32;
    // the last one stays the last while there come more
    cx.model.state.probed_sample = (next < last).then_some(next);
}

fn most_samples(cx: &UiContext) -> u32 {
    samples(cx).map(|(_, samples)| samples.samples.len() as u32).max().unwrap_or(0)
}

pub fn show(cx: &mut UiContext, ui: &mut Ui) {
    formula(ui, INTEGRAL, palette(ui).text);
    stepper(cx, ui);
    let panes: Vec<PaneId> = cx.model.session.panes.ids().collect();
    for pane in panes {
        let lines = lines(cx, pane);
        for (index, line) in lines.iter().enumerate() {
            let colour = if index == 0 { palette(ui).pane(pane) } else { palette(ui).text };
            let response = formula(ui, line, colour);
            if index == 0 {
                cx.dump.note(&format!("integral {pane}"), lines.join("\n"), response);
            }
        }
    }
}

/// Which sample is taken apart.
fn stepper(cx: &mut UiContext, ui: &mut Ui) {
    let count = most_samples(cx);
    if count == 0 {
        return;
    }
    ui.horizontal(|ui| {
        let label = ui.label(RichText::new("Sample").color(palette(ui).dim));
        for (text, name, by) in [("<", "Sample before", -1), (">", "Sample after", 1)] {
            let button = ui.add(framed(text, ui)).explained("Alt+Shift and an arrow key").accessible_name(name);
            if cx.dump.note(name, "", button).clicked() {
                turn(cx, by);
            }
        }
        let mut number = cx.model.state.probed_sample.map_or(count, |sample| (sample + 1).min(count));
        let field = ui.add(DragValue::new(&mut number).range(1..=count)).labelled_by(label.id);
        if cx.dump.note("probed sample", number, field).changed() {
            cx.model.state.probed_sample = (number < count).then(|| number.saturating_sub(1));
        }
        ui.label(RichText::new(format!("of {count}")).color(palette(ui).dim));
    });
}

/// What is known of a pane's pixel, its name first.
fn lines(cx: &UiContext, pane: PaneId) -> Vec<String> {
    let channel = cx.model.session.probe.channel;
    if traced(cx, pane).is_none() {
        return vec![without_samples(cx, pane, channel)];
    }
    match probed(cx, pane) {
        None => vec![format!("{pane}: tracing ...")],
        Some(PaneProbe { fault: Some(fault), .. }) => vec![format!("{pane}: no samples of one pixel: {fault}")],
        Some(PaneProbe { samples, vertex, .. }) => {
            let first = |(number, vertex): &(u32, FirstVertex)| {
                let value = brief(channel.of(vertex.value));
                format!("{pane}: {}; sample {} is {value}", met_words(vertex.met), number + 1)
            };
            let mut lines = vec![vertex.as_ref().map_or_else(|| format!("{pane}: no integral over directions"), first)];
            lines.extend(vertex.iter().flat_map(|(_, vertex)| of_sample(vertex, channel)));
            lines.extend(samples.iter().flat_map(|samples| of_all(cx, pane, samples, channel)));
            lines
        }
    }
}

/// What there is of a picture whose pixels have one value each.
fn without_samples(cx: &UiContext, pane: PaneId, channel: Channel) -> String {
    let Some(value) = value_without_samples(cx, pane) else { return format!("{pane}: no picture yet") };
    let value = brief(channel.of(value));
    if is_external(cx, pane) {
        return format!("{pane}: {value}, one value: the picture of another program has no samples here");
    }
    format!("{pane}: {value}, one value: there are no samples")
}

fn met_words(met: Met) -> &'static str {
    match met {
        Met::Sky => "sees the sky first",
        Met::Light => "sees a light first",
        Met::Diffuse => "sees a diffuse surface first",
        Met::RoughMetal => "sees rough metal first",
        Met::MetallicRoughness => "sees a metallic-roughness surface first",
        Met::Mirror => "sees a mirror first",
        Met::Glass => "sees glass first",
    }
}

/// One sample with its numbers.
fn of_sample(vertex: &FirstVertex, channel: Channel) -> Vec<String> {
    let left_out = left_out(vertex.left_out);
    let terms = match vertex.terms {
        Ok(terms) => terms,
        Err(why) => return left_out.into_iter().chain([why.to_owned()]).collect(),
    };
    let multiplied = channel_of_factors(&terms, channel);
    let mut lines = Vec::from_iter(left_out);
    if multiplied != channel {
        lines.push("in green, for luminances of colours are not multiplied:".to_owned());
    }
    if vertex.emitted != Vec3::ZERO {
        lines.push(format!("L_e = {}", brief(multiplied.of(vertex.emitted))));
    }
    let is_indirect = terms.light.is_some() || vertex.left_out.direct;
    let name = if is_indirect { "L_indir" } else { "f_r L_i cosθ / p" };
    lines.extend(terms.light.iter().map(|term| of_term("L_dir", term, multiplied)));
    lines.extend(terms.by_chance.iter().map(|term| of_term("L_dir by chance", term, multiplied)));
    lines.extend(terms.onward.iter().map(|term| of_term(name, term, multiplied)));
    lines
}

/// Which of its light a picture of a part of the light does not count.
fn left_out(LeftOut { emitted, direct }: LeftOut) -> Option<String> {
    let words = [(emitted, "what shines here"), (direct, "light straight from a light")];
    let words: Vec<&str> = words.into_iter().filter(|(is_left_out, _)| *is_left_out).map(|(_, words)| words).collect();
    (!words.is_empty()).then(|| format!("not counted: {}", words.join(", ")))
}

/// In which channel the factors of all terms make their products: of luminances only where surface or light is grey.
fn channel_of_factors(terms: &Terms, channel: Channel) -> Channel {
    let is_grey = |colour: Vec3| colour.max_element() - colour.min_element() <= 1e-4 * colour.max_element();
    let parts = [terms.light, terms.by_chance, terms.onward];
    let all_grey = parts.iter().flatten().all(|term| is_grey(term.f_r) || is_grey(term.radiance));
    if channel == Channel::Luminance && !all_grey { Channel::Green } else { channel }
}

/// "L_dir = 0.159 (f_r) · 12.000 (L_i) · 0.860 (cosθ) / 2.100 (p) · 0.187 (w) = 0.146", without the weights that are 1.
fn of_term(name: &str, term: &Term, channel: Channel) -> String {
    let value = |radiance: Vec3| brief(channel.of(radiance));
    let cosine = brief(f64::from(term.cosine.max(0.0)));
    let (f_r, product) = (value(term.f_r), value(term.product));
    let light = value(term.radiance);
    let weighted = weighted(term.weight, "w") + &weighted(term.survival, "1/q");
    if term.pdf.is_finite() {
        let pdf = brief(f64::from(term.pdf));
        return format!("{name} = {f_r} (f_r) · {light} (L_i) · {cosine} (cosθ) / {pdf} (p){weighted} = {product}");
    }
    format!("{name} = {f_r} (f_r) · {light} (L_i / p, from one direction) · {cosine} (cosθ) = {product}")
}

fn weighted(weight: f32, name: &str) -> String {
    if (weight - 1.0).abs() < 5e-4 || !weight.is_finite() {
        return String::new();
    }
    format!(" · {} ({name})", brief(f64::from(weight)))
}

/// What all samples make of it.
fn of_all(cx: &UiContext, pane: PaneId, samples: &PixelSamples, channel: Channel) -> Vec<String> {
    let drawn = samples.drawn(channel);
    let Some(last) = drawn.course.last() else { return Vec::new() };
    let sum = last.mean * f64::from(last.samples);
    let mut lines = vec![
        format!(
            "Σ = {}, N = {}: mean {} ± {} (2 standard errors)",
            brief(sum),
            last.samples,
            brief(last.mean),
            brief(ERRORS * last.error)
        ),
        spread::in_words(pane, &drawn.spread).split_once(": ").map_or(String::new(), |(_, words)| words.to_owned()),
    ];
    if samples.wished > last.samples && last.samples >= crate::model::MOST_PROBED {
        lines.push(format!("the first {} of {} samples", last.samples, samples.wished));
    }
    let Some(technique) = traced(cx, pane) else { return lines };
    if technique.runs() > 1 {
        lines.push(format!("the first of {} runs", technique.runs()));
    }
    if sampler(&technique) == Some(SamplerKind::Sobol) {
        lines.push("Sobol's points keep apart: the error is smaller than their spread says".into());
    }
    let made = cx.shown.panes.get(pane).and_then(|shown| shown.provenance.as_ref());
    if made.is_some_and(|made| made.technique.denoise().is_on()) {
        lines.push("before the denoiser".into());
    }
    if made.is_some_and(|made| made.device == Device::Gpu && matches!(made.technique, Technique::Traced(_))) {
        lines.push("by the processor: the GPU, which made the picture, rounds differently".into());
    }
    lines
}

fn sampler(technique: &Technique) -> Option<SamplerKind> {
    match technique {
        Technique::Traced(settings) => Some(settings.integrator.sampler()),
        Technique::Fake(_) => None,
    }
}

/// A line in which what follows an underscore, up to the end of its word, stands lower.
fn formula(ui: &mut Ui, text: &str, colour: Color32) -> Response {
    let usual = TextStyle::Small.resolve(ui.style());
    let small = FontId::new(0.72 * usual.size, usual.family.clone());
    let mut job = LayoutJob::default();
    job.wrap.max_width = ui.available_width();
    for (index, part) in text.split('_').enumerate() {
        let end = if index == 0 { 0 } else { part.find(|c: char| !c.is_alphanumeric()).unwrap_or(part.len()) };
        let (lower, rest) = part.split_at(end);
        job.append(
            lower,
            0.0,
            TextFormat { font_id: small.clone(), color: colour, valign: Align::BOTTOM, ..TextFormat::default() },
        );
        job.append(rest, 0.0, TextFormat { font_id: usual.clone(), color: colour, ..TextFormat::default() });
    }
    ui.label(job)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn term(f_r: Vec3, radiance: Vec3) -> Term {
        let product = f_r * radiance * (0.5 / 2.0);
        Term { f_r, cosine: 0.5, pdf: 2.0, radiance, weight: 1.0, survival: 1.0, product }
    }

    fn vertex(terms: Terms) -> FirstVertex {
        let value = terms.onward.map_or(Vec3::ZERO, |term| term.product);
        FirstVertex { met: Met::Diffuse, emitted: Vec3::ZERO, value, terms: Ok(terms), left_out: LeftOut::default() }
    }

    fn lines(onward: Term) -> Vec<String> {
        of_sample(&vertex(Terms { onward: Some(onward), ..Terms::default() }), Channel::Luminance)
    }

    /// What stands in a line comes to what it says.
    #[test]
    fn the_numbers_of_a_line_make_its_product_whatever_the_colours() {
        let (grey, red, blue) = (Vec3::splat(0.3), Vec3::new(0.6, 0.2, 0.1), Vec3::new(1.0, 2.0, 8.0));
        for (f_r, radiance) in [(grey, blue), (red, Vec3::splat(4.0)), (red, blue)] {
            let lines = lines(term(f_r, radiance));
            let line = lines.last().expect("a line");
            let numbers: Vec<f64> = line.split([' ', '/']).filter_map(|word| word.parse().ok()).collect();
            let [f_r, radiance, cosine, pdf, product] = numbers[..] else { panic!("{line}") };
            assert!((f_r * radiance * cosine / pdf - product).abs() < 2e-3, "{line}");
        }
        assert_eq!(lines(term(red, blue))[0], "in green, for luminances of colours are not multiplied:");
        assert_eq!(lines(term(grey, blue)).len(), 1);
    }

    #[test]
    fn light_met_by_chance_is_direct_and_both_of_its_weights_are_told() {
        let light = term(Vec3::splat(0.4), Vec3::splat(5.0));
        let by_chance = Term { weight: 0.25, survival: 2.0, product: 0.5 * light.product, ..light };
        let terms = Terms { light: Some(light), by_chance: Some(by_chance), onward: None };
        let lines = of_sample(&vertex(terms), Channel::Luminance);
        assert_eq!(
            lines[1..],
            [
                "L_dir by chance = 0.400 (f_r) · 5.000 (L_i) · 0.500 (cosθ) / 2.000 (p) · 0.250 (w) · 2.000 (1/q) = 0.250"
            ]
        );
    }

    #[test]
    fn light_that_does_not_count_is_told_and_what_is_left_is_indirect() {
        let onward = Some(term(Vec3::splat(0.4), Vec3::splat(5.0)));
        let left_out = LeftOut { emitted: true, direct: true };
        let vertex = FirstVertex { left_out, ..vertex(Terms { onward, ..Terms::default() }) };
        let lines = of_sample(&vertex, Channel::Luminance);
        assert_eq!(lines[0], "not counted: what shines here, light straight from a light");
        assert!(lines.len() == 2 && lines[1].starts_with("L_indir = 0.400 (f_r) · 5.000 (L_i)"), "{lines:?}");
    }

    #[test]
    fn a_light_without_extent_has_no_density() {
        let line = lines(Term { pdf: f32::INFINITY, ..term(Vec3::splat(0.3), Vec3::splat(4.0)) }).remove(0);
        assert!(line.contains("(L_i / p, from one direction)") && !line.contains("inf"), "{line}");
    }
}
