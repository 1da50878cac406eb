//! What a label says: what the picture is; how far off and at what cost; what it lacks. Always of the picture that is
//! shown, never of settings whose picture is still to come.

use crate::model::{Against, Compiling, Drawing, Effort, PaneId, PaneView};
use crate::ruler::{brief, error_words, formulas};
use compare::Errors;
use pathtrace::{Integrator, PathSettings, Stats};
use technique::{BlindSpot, Device, Technique, TracedSettings};

/// The words of a label.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LabelText {
    /// What the picture is, or what tells it from the one beside it.
    pub name: String,
    /// How far off, in words.
    pub errors: Vec<String>,
    /// The measure of that, and the cost.
    pub figures: Vec<String>,
    /// What else has to be said of it, a line each.
    pub notes: Vec<String>,
    /// What the figures mean, a line each, for who asks.
    pub explanations: Vec<String>,
}

/// Errors that a label tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// Whose they are.
    pub of: PaneId,
    /// What judges it.
    pub against: Against,
    /// How far it is from that.
    pub errors: Errors,
}

impl LabelText {
    /// Of a pane's picture beside one by `other`.
    pub fn of(pane: PaneId, shown: &PaneView, other: Option<&Technique>, told: Option<Told>, paused: bool) -> Self {
        let mut text = LabelText { name: name(shown, other), ..LabelText::default() };
        if let Some(told) = told {
            text.tell(pane, told);
        }
        text.figures.push(cost(shown, paused));
        text.notes.extend(troubles(shown));
        if let Some((traced, made)) = traced(shown) {
            text.notes.extend(missing(&traced.blind_spots(&made.shot.scene)));
            let source = traced.noise_source(&made.shot.scene).filter(|_| shown.noisy);
            text.notes.extend(source.map(|source| source.words().to_owned()));
            text.notes.extend(branching(traced, shown));
        }
        text.explanations.extend(explained(shown));
        text
    }

    /// All that is read, with the pane's letter.
    pub fn whole(&self, pane: PaneId) -> String {
        let name = format!("{pane}: {}", self.name);
        let details = self.details().into_iter().map(|line| line.join(" · "));
        let lines = std::iter::once(name).chain(details).chain(self.notes.iter().cloned());
        lines.collect::<Vec<_>>().join("\n")
    }

    /// How far off and at what cost, line by line.
    pub fn details(&self) -> Vec<&[String]> {
        [&*self.errors, &*self.figures].into_iter().filter(|line| !line.is_empty()).collect()
    }

    fn tell(&mut self, pane: PaneId, Told { of, against, errors }: Told) {
        let judge = match against {
            Against::Pane(judge) => Some(judge.name()),
            Against::Reference => None,
        };
        let [off, brightness] = error_words(&errors, judge);
        // on another picture's label it has to be said whose they are
        let off = if of == pane { off } else { format!("{of} {off}") };
        let measure = format!("relMSE {}", brief(errors.rel_mse));
        let measure = if judge.is_none() { format!("{measure} against the reference") } else { measure };
        self.errors.extend([off, brightness]);
        self.figures.push(measure);
        if errors.below_reference_noise() {
            self.notes.push("at the reference's noise".into());
        }
        self.explanations.extend(formulas(&errors, of.name(), against.name()));
    }
}

fn name(shown: &PaneView, other: Option<&Technique>) -> String {
    let Some(made) = &shown.provenance else { return String::new() };
    match other {
        Some(other) => made.technique.label_beside(other, &made.shot.scene),
        None => made.technique.label(),
    }
}

fn traced(shown: &PaneView) -> Option<(&TracedSettings, &technique::Provenance)> {
    let made = shown.provenance.as_deref()?;
    match &made.technique {
        Technique::Traced(traced) => Some((traced, made)),
        Technique::Fake(_) => None,
    }
}

/// "64 of 256 spp, 1.2 s on the GPU, paused"; "4.1 ms".
fn cost(shown: &PaneView, paused: bool) -> String {
    let time = duration(shown.seconds);
    let coarse = resolution(shown);
    let Some(spp) = shown.spp else {
        let compiling = matches!(shown.effort, Some(Effort::Drawn(Drawing { compiling: Compiling::Included, .. })));
        return format!("{time}{}{coarse}", if compiling { " with compiling" } else { "" });
    };
    if shown.rough {
        return format!("{spp} spp{coarse}");
    }
    let wished = traced(shown).map_or(spp, |(traced, _)| traced.spp);
    let of = if wished > spp { format!(" of {wished}") } else { String::new() };
    let by = if shown.provenance.as_ref().is_some_and(|made| made.device == Device::Gpu) { " on the GPU" } else { "" };
    let paused = if paused && shown.unfinished { ", paused" } else { "" };
    format!("{spp}{of} spp, {time}{by}{paused}{coarse}")
}

/// Of a picture with fewer pixels than there is room for: ", at 1/4 of the resolution".
fn resolution(shown: &PaneView) -> String {
    if shown.shrink > 1 { format!(", at 1/{} of the resolution", shown.shrink) } else { String::new() }
}

/// "4.1 ms", "557 ms", "7.6 s".
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.00995 => format!("{:.1} ms", 1000.0 * s),
        s if s < 0.9995 => format!("{:.0} ms", 1000.0 * s),
        s => format!("{s:.1} s"),
    }
}

/// What has gone wrong with it.
fn troubles(shown: &PaneView) -> Vec<String> {
    let refused = shown.refused.as_ref().map(|why| format!("on the CPU: the GPU failed: {why}"));
    let cut = shown.cut.as_ref().map(|cut| cut.to_string());
    let left_out = format!("{} samples were not finite and are left out", shown.nonfinite);
    refused.into_iter().chain(cut).chain((shown.nonfinite > 0).then_some(left_out)).collect()
}

/// "missing: light behind glass, indirect light (biased)".
fn missing(blind_spots: &[BlindSpot]) -> Option<String> {
    let words: Vec<String> = blind_spots.iter().map(|blind_spot| blind_spot.missing()).collect();
    (!words.is_empty()).then(|| format!("missing: {}", words.join(", ")))
}

/// What several directions at each vertex cost: the slide's N to the power of the vertices that branch, and what was
/// counted. N bounces are N + 1 vertices.
fn branching(traced: &TracedSettings, shown: &PaneView) -> Option<String> {
    let Integrator::Path(path @ PathSettings { branches: 2.., .. }) = traced.integrator else { return None };
    let vertices = path.scattering_vertices().min(path.branching_vertices());
    let (n, paths) = (path.branches, path.branches.saturating_pow(vertices));
    let counted = rays(shown).map_or_else(String::new, |rays| format!(": {rays}"));
    Some(format!("N = {n}, at most {n}^{vertices} = {paths} paths a sample{counted}"))
}

/// "12.3 rays a sample, 4.5 million rays a second".
fn rays(shown: &PaneView) -> Option<String> {
    let Some(Effort::Traced(Stats { samples: samples @ 1.., rays, .. })) = shown.effort else { return None };
    let per_sample = rays as f64 / samples as f64;
    let per_second = (shown.seconds > 0.0).then(|| rays as f64 / shown.seconds);
    let speed = per_second.map_or_else(String::new, |speed| format!(", {} rays a second", large(speed)));
    Some(format!("{per_sample:.1} rays a sample{speed}"))
}

/// "850", "12 thousand", "4.5 million".
fn large(number: f64) -> String {
    match number {
        v if v < 999.5 => format!("{v:.0}"),
        v if v < 999_500.0 => format!("{:.0} thousand", v / 1e3),
        v if v < 999.95e6 => format!("{:.1} million", v / 1e6),
        v => format!("{:.1} thousand million", v / 1e9),
    }
}

/// How its time was spent, and why it lacks what it lacks.
fn explained(shown: &PaneView) -> Vec<String> {
    let by = shown.adapter.as_ref().map_or_else(String::new, |adapter| format!(", by {adapter}"));
    let mut lines: Vec<String> = rays(shown).map(|rays| format!("{rays}{by}")).into_iter().collect();
    if let Some(Effort::Drawn(Drawing { compiling, kept_maps })) = shown.effort {
        lines.push(match compiling {
            Compiling::Included => format!("The time has that of compiling in it{by}"),
            Compiling::Apart(seconds) => format!("Compiling took {} once, apart from this{by}", duration(seconds)),
        });
        if kept_maps {
            lines.push("Shadow map and cube maps were there from the picture before".into());
        }
    }
    if let Some((traced, made)) = traced(shown) {
        let blind_spots = traced.blind_spots(&made.shot.scene).into_iter();
        lines.extend(blind_spots.filter_map(BlindSpot::explanation).map(str::to_owned));
    }
    lines
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
