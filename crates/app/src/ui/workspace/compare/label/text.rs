//! What a label says: what the picture is; how far off and at what cost; what it lacks. Always of the picture that is
//! shown, never of settings whose picture is still to come.

use crate::model::{Against, Compiling, Denoising, Drawing, Effort, IN_THE_REGION, PaneId, PaneView, Region};
use crate::ruler::{FEWEST_RUNS_OF_A_BIAS, bias_words, brief, error_words, formulas};
use compare::Errors;
use denoise::trust::LEAST_SAMPLES;
use pathtrace::{ChainStats, Integrator, PathSettings, Stats};
use technique::settings::{capitalised, grouped, of_panes};
use technique::{BlindSpot, DenoiseSettings, Device, PaneSettings, Technique, TracedSettings};

/// Between two figures of a line.
const BETWEEN: &str = " · ";

/// The words of a label.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LabelText {
    /// What the picture is, or what tells it from the one beside it.
    pub name: String,
    /// How far off, in words.
    pub errors: Vec<String>,
    /// The measure of that, and the cost.
    pub figures: Vec<String>,
    /// How it was made, where that is worth a line: plain facts, a line each.
    pub facts: Vec<String>,
    /// What else has to be said of it, a line each: what is wrong, missing or unreliable.
    pub notes: Vec<String>,
    /// What the figures mean, a line each, for who asks.
    pub explanations: Vec<String>,
}

/// The pane beside it, and what that shows.
pub type Beside<'a> = (PaneId, &'a PaneView);

/// Errors that a label tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Told {
    /// The pane whose errors they are.
    pub of: PaneId,
    /// What that pane is held against.
    pub against: Against,
    /// The part of both that is compared; `None` for all.
    pub region: Option<Region>,
    /// How far it is from that.
    pub errors: Errors,
}

impl LabelText {
    /// Of a pane's picture beside that of another.
    pub fn of(pane: PaneId, shown: &PaneView, beside: Option<Beside>, told: Option<Told>, paused: bool) -> Self {
        let mut text = LabelText { name: name(shown, beside), ..LabelText::default() };
        if let Some(told) = told {
            let of = if told.of == pane { Some(shown) } else { beside.map(|(_, other)| other) };
            text.tell(pane, told, of.and_then(denoised_runs));
        }
        if let Some(external) = &shown.external {
            super::external::tell(&mut text, shown, external);
            return text;
        }
        text.figures.push(cost(shown, paused));
        text.notes.extend(troubles(shown));
        text.facts.extend(shown.provenance.as_ref().and_then(|made| made.shot.changes.edits.told()));
        if let Some((traced, made)) = traced(shown) {
            text.notes.extend(missing(&traced.blind_spots(&made.shot.scene)));
            let source = traced.noise_source(&made.shot.scene).filter(|_| shown.noisy);
            text.notes.extend(source.map(|source| source.words().to_owned()));
            text.facts.extend(branching(traced, shown, beside));
            text.facts.extend(shown.lag.map(|lag| format!("+ {lag} (lag)")));
            text.facts.extend(denoised(shown, made.technique.denoise()));
            text.notes.extend(weightless(&traced.denoise, shown.spp.unwrap_or(0) / shown.runs.max(1)));
            text.facts.extend(chains(shown).map(|stats| told_of_chains(&stats)));
        }
        text.explanations.extend(explained(shown, beside));
        text
    }

    /// All that is read, with the pane's letter.
    pub fn whole(&self, pane: PaneId) -> String {
        let name = format!("{pane}: {}", self.name);
        let details = self.details().into_iter().map(|line| line.join(BETWEEN));
        let lines = std::iter::once(name).chain(details).chain(self.facts.iter().chain(&self.notes).cloned());
        lines.collect::<Vec<_>>().join("\n")
    }

    /// The same in lines that fit: broken between two figures, and inside one only where that alone does not fit.
    pub fn details_within(&self, fits: impl Fn(&str) -> bool) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for figures in self.details() {
            let mut line = String::new();
            for figure in figures {
                let longer = if line.is_empty() { figure.clone() } else { format!("{line}{BETWEEN}{figure}") };
                let shorter = std::mem::replace(&mut line, longer);
                if !shorter.is_empty() && !fits(&line) {
                    lines.push(shorter);
                    line.clone_from(figure);
                }
            }
            lines.push(line);
        }
        lines
    }

    /// How far off and at what cost, line by line.
    pub fn details(&self) -> Vec<&[String]> {
        [&*self.errors, &*self.figures].into_iter().filter(|line| !line.is_empty()).collect()
    }

    /// `runs` names those that the picture is the mean of, where there are several.
    fn tell(&mut self, pane: PaneId, Told { of, against, region, errors }: Told, runs: Option<u32>) {
        let judge = match against {
            Against::Pane(judge) => Some(judge.name()),
            Against::Reference => None,
        };
        let [off, brightness] = error_words(&errors, judge);
        // on another picture's label it has to be said whose they are
        let off = if of == pane { off } else { format!("{of} {off}") };
        // what their noise hides in one of them
        let brightness = match runs.filter(|_| judge.is_none()) {
            Some(runs) => bias_words(&errors, runs),
            None => brightness,
        };
        let measure = format!("relMSE {}", brief(errors.rel_mse));
        let measure = if judge.is_none() { format!("{measure} against the reference") } else { measure };
        let off = region.map_or_else(|| off.clone(), |_| format!("{}: {off}", capitalised(IN_THE_REGION)));
        self.errors.extend([off, brightness]);
        self.figures.push(measure);
        if errors.below_reference_noise() {
            self.notes.push("at the reference's noise".into());
        }
        self.explanations.extend(formulas(&errors, of.name(), against.name()));
    }
}

fn name(shown: &PaneView, beside: Option<Beside>) -> String {
    if let Some(external) = &shown.external {
        return external.title();
    }
    let Some(made) = &shown.provenance else { return String::new() };
    let made_here = beside.filter(|(_, other)| other.external.is_none());
    match made_here.and_then(|(_, other)| other.provenance.as_ref()) {
        Some(other) => made.technique.label_beside(&other.technique, &made.shot.scene),
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
    let spp = spp / shown.runs.max(1);
    let samples = grouped(spp);
    if shown.rough {
        return format!("{samples} spp{coarse}");
    }
    let wished = traced(shown).map_or(spp, |(traced, _)| traced.spp);
    let of = if wished > spp { format!(" of {}", grouped(wished)) } else { String::new() };
    let mean = mean_of_runs(shown).map_or_else(String::new, |mean| format!(", {mean}"));
    let by = if shown.provenance.as_ref().is_some_and(|made| made.device == Device::Gpu) { " on the GPU" } else { "" };
    let paused = if paused && shown.unfinished { ", paused" } else { "" };
    format!("{samples}{of} spp{mean}, {time}{by}{paused}{coarse}")
}

/// "mean of 8 runs", "mean of 3 of 8 runs".
fn mean_of_runs(shown: &PaneView) -> Option<String> {
    let wished = shown.provenance.as_ref()?.technique.runs();
    let of = if shown.runs < wished { format!("{} of ", shown.runs) } else { String::new() };
    (wished > 1).then(|| format!("mean of {of}{} runs", wished.max(shown.runs)))
}

/// How many it is the mean of, where that shows what they have in common: the filter's bias.
fn denoised_runs(shown: &PaneView) -> Option<u32> {
    Some(shown.runs).filter(|runs| *runs >= FEWEST_RUNS_OF_A_BIAS && shown.denoised.is_some())
}

/// Of a picture with fewer pixels than there is room for: ", at 1/4 of the resolution".
fn resolution(shown: &PaneView) -> String {
    if shown.shrink > 1 { format!(", at 1/{} of the resolution", shown.shrink) } else { String::new() }
}

/// "4.1 ms", "557 ms", "7.6 s".
pub fn duration(seconds: f64) -> String {
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
    let filter_fault = shown.filter_fault.as_ref().map(|fault| fault.to_string());
    refused.into_iter().chain(filter_fault).chain(cut).chain((shown.nonfinite > 0).then_some(left_out)).collect()
}

/// "only LDE", of a picture of a part of the light.
pub fn part_of_the_light(technique: &Technique) -> Option<String> {
    let paths = technique.light();
    let expression = paths.named().map_or_else(|| paths.to_string(), |named| named.expression());
    (!paths.is_all()).then(|| format!("only {expression}"))
}

/// Why a picture of a part of the light has no errors, where what it is held against has other light.
pub fn no_error(shown: &PaneView, against: Against, beside: Option<Beside>) -> Option<String> {
    let technique_of = |shown: &PaneView| Some(shown.provenance.as_ref()?.technique);
    let technique = technique_of(shown)?;
    let has_other_light = match against {
        Against::Reference => true,
        Against::Pane(judge) => {
            let (_, judge) = beside.filter(|(id, _)| *id == judge)?;
            technique_of(judge)?.light() != technique.light()
        }
    };
    let only = part_of_the_light(&technique).filter(|_| has_other_light)?;
    Some(format!("{only}: no error against other light"))
}

/// "missing: light behind glass, indirect light (biased)".
fn missing(blind_spots: &[BlindSpot]) -> Option<String> {
    let words: Vec<String> = blind_spots.iter().map(|blind_spot| blind_spot.missing()).collect();
    (!words.is_empty()).then(|| format!("missing: {}", words.join(", ")))
}

/// What several directions at each vertex cost, and beside that what one does: the slide's N to the power of the
/// vertices that branch, and what was counted.
fn branching(traced: &TracedSettings, shown: &PaneView, beside: Option<Beside>) -> Option<String> {
    let Integrator::Path(path) = &traced.integrator else { return None };
    let n = path.branches;
    let most = match branching_vertices(path) {
        Some(vertices) => format!("at most {n}^{vertices} = {} paths a sample", grouped(n.saturating_pow(vertices))),
        None if beside.is_some_and(|(_, other)| branches(other)) => "one path a sample".into(),
        None => return None,
    };
    let counted = rays(shown).map_or_else(String::new, |rays| format!(": {rays}"));
    Some(format!("N = {n}, {most}{counted}"))
}

/// Vertices of a path at which there are several directions, if there are such.
fn branching_vertices(path: &PathSettings) -> Option<u32> {
    (path.branches > 1).then(|| path.scattering_vertices().min(path.branching_vertices()))
}

/// Whether the paths of a picture branch.
fn branches(shown: &PaneView) -> bool {
    let integrator = traced(shown).map(|(traced, _)| traced.integrator);
    matches!(integrator, Some(Integrator::Path(PathSettings { branches: 2.., .. })))
}

/// "denoised by unet in 0.4 s (biased), relMSE 0.107 before"; or what is shown of that in its place.
fn denoised(shown: &PaneView, settings: DenoiseSettings) -> Option<String> {
    let Denoising { seconds, errors_before } = shown.denoised?;
    let by = settings.denoiser;
    if settings.shows_the_weight() {
        return Some(format!(
            "black is the picture of {}, white that of the samples, in {}",
            by.name(),
            duration(seconds)
        ));
    }
    let before = errors_before.map_or_else(String::new, |errors| format!(", relMSE {} before", brief(errors.rel_mse)));
    Some(format!("denoised by {} in {} (biased){before}", by.name(), duration(seconds)))
}

/// Why there is no weight to be seen, where that is asked for.
fn weightless(settings: &DenoiseSettings, samples: u32) -> Option<String> {
    let (shows, few) = (settings.shows_trust, samples < LEAST_SAMPLES);
    match settings.trusts() {
        false if shows => Some("no trust to show: it needs a denoiser, and trust in the samples above 0".into()),
        true if few => Some(format!("nothing is trusted of fewer than {LEAST_SAMPLES} spp")),
        _ => None,
    }
}

/// What Metropolis' chains did.
fn chains(shown: &PaneView) -> Option<ChainStats> {
    let Some(Effort::Traced(Stats { chains, .. })) = shown.effort else { return None };
    (chains.runs > 0 && !shown.rough).then_some(chains)
}

/// "54 % of mutations taken, start-up scale 0.139".
fn told_of_chains(stats: &ChainStats) -> String {
    let acceptance = stats.acceptance();
    let taken =
        acceptance.map_or("no light found".into(), |share| format!("{:.0} % of mutations taken", 100.0 * share));
    format!("{taken}, start-up scale {}", brief(stats.scale().unwrap_or_default()))
}

/// What these figures mean.
const OF_CHAINS: [&str; 2] = [
    "The start-up scale is the mean luminance of the candidates that chains begin with: all light counts as much",
    "Neighbouring pixels share a chain's paths: their spread does not tell the error",
];

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

/// How its time was spent, by which formula it shines, and why it lacks what it lacks.
fn explained(shown: &PaneView, beside: Option<Beside>) -> Vec<String> {
    let adapter = shown.adapter.as_deref();
    let mut lines = Vec::new();
    if let Some(rays) = rays(shown) {
        lines.push(adapter.map_or_else(|| rays.clone(), |adapter| format!("{rays}, by {adapter}")));
    }
    lines.extend(chains(shown).into_iter().flat_map(|_| OF_CHAINS.map(str::to_owned)));
    if let Some(Effort::Drawn(drawing)) = shown.effort {
        lines.extend(adapter.map(|adapter| format!("Drawn by {adapter}")));
        lines.extend(drawn(drawing, beside));
        lines.extend(shown.provenance.as_ref().and_then(|made| highlight(&made.technique)));
    }
    if let Some((traced, made)) = traced(shown) {
        if let Integrator::Path(path) = &traced.integrator {
            lines.extend(branching_vertices(path).map(first_vertex));
        }
        let blind_spots = traced.blind_spots(&made.shot.scene).into_iter();
        lines.extend(blind_spots.filter_map(BlindSpot::explanation).map(capitalised));
    }
    lines
}

/// What the fake's time is that of.
fn drawn(drawing: Drawing, beside: Option<Beside>) -> Vec<String> {
    let compiling = match drawing.compiling {
        Compiling::Included => "The time has that of compiling in it".into(),
        Compiling::Apart(seconds) => format!("Compiling took {} once, apart from this", duration(seconds)),
    };
    let at_work = beside.filter(|(_, other)| other.unfinished && !drawing.at_rest);
    let at_work = at_work.map(|(pane, _)| format!("Measured while {pane} is made: once more when that is done"));
    let kept = drawing.kept_maps.then(|| "Shadow map and cube maps were there from the picture before".into());
    std::iter::once(compiling).chain(at_work).chain(kept).collect()
}

/// Why the power is one more than the bounces.
fn first_vertex(vertices: u32) -> String {
    format!("The first hit branches too: vertices are one more than bounces, {vertices} here")
}

/// The slides' formula of the highlights in a picture of the fake.
fn highlight(technique: &Technique) -> Option<String> {
    let row = of_panes("shading").filter(|row| row.is_of(technique.name()))?;
    let pane = PaneSettings::from(*technique);
    let shading = (row.get)(&pane).filter(|_| pane.fake.shows_the_scene())?;
    Some(format!("Highlight by {shading}: {}", (row.control.below)(shading)))
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
