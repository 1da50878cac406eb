//! The words of labels.

use super::*;
use std::sync::Arc;
use technique::{Provenance, Shot, TechniqueName};

fn made(scene: &str, technique: TechniqueName, changes: &[(&str, &str)]) -> Provenance {
    let mut pane = PaneSettings::of(technique);
    for (name, word) in changes {
        let row = of_panes(name).unwrap();
        (row.set)(&mut pane, row.kind.parse(word).unwrap());
    }
    let shot = Shot::of(scene::builtin::named(scene).unwrap(), (1, 1));
    Provenance { shot, technique: pane.in_use(), device: Device::Cpu }
}

fn path(changes: &[(&str, &str)], spp: u32) -> PaneView {
    let stats = Stats { samples: 1000, rays: 13_500, cut_paths: 0, ..Stats::default() };
    PaneView {
        provenance: Some(Arc::new(made("whitted", TechniqueName::Path, changes))),
        spp: Some(spp),
        seconds: 0.5,
        effort: Some(Effort::Traced(stats)),
        adapter: Some("2 threads".into()),
        ..PaneView::default()
    }
}

fn fake(seconds: f64, compiling: Compiling) -> PaneView {
    PaneView {
        provenance: Some(Arc::new(made("whitted", TechniqueName::Raster, &[]))),
        seconds,
        effort: Some(Effort::Drawn(Drawing { compiling, kept_maps: false, at_rest: false })),
        ..PaneView::default()
    }
}

fn label(shown: &PaneView, told: Option<Told>) -> LabelText {
    LabelText::of(PaneId::B, shown, None, told, false)
}

#[test]
fn a_picture_of_a_changed_scene_says_so() {
    for mut shown in [path(&[], 4), fake(0.1, Compiling::Included)] {
        assert!(label(&shown, None).facts.iter().all(|fact| !fact.contains("edited")));
        let mut made = Provenance::clone(shown.provenance.as_ref().expect("a picture"));
        made.shot.changes.edits = "{ sun.elevation = 20, material.glass.ior = 2 }".parse().expect("changes");
        shown.provenance = Some(Arc::new(made));
        assert!(label(&shown, None).facts.contains(&"edited: 2 parts".to_owned()));
    }
}

#[test]
fn the_cost_is_that_of_the_picture_that_is_shown() {
    assert_eq!(label(&path(&[("spp", "256")], 64), None).figures, ["64 of 256 spp, 500 ms"]);
    assert_eq!(label(&path(&[("spp", "64")], 64), None).figures, ["64 spp, 500 ms"], "it has all that it shall have");
    let many = &[("spp", "1048576")];
    assert_eq!(label(&path(many, 65_536), None).figures, ["65,536 of 1,048,576 spp, 500 ms"]);
    assert_eq!(label(&path(&[("spp", "16")], 64), None).figures, ["64 spp, 500 ms"], "fewer are wished by now");
    assert_eq!(label(&fake(0.0041, Compiling::Apart(0.45)), None).figures, ["4.1 ms"]);
    assert_eq!(label(&fake(0.557, Compiling::Included), None).figures, ["557 ms with compiling"]);
    let rough = PaneView { rough: true, shrink: 4, ..path(&[], 2) };
    assert_eq!(label(&rough, None).figures, ["2 spp, at 1/4 of the resolution"]);
    let held = PaneView { unfinished: true, ..path(&[("spp", "256")], 64) };
    let held = LabelText::of(PaneId::B, &held, None, None, true);
    assert_eq!(held.figures, ["64 of 256 spp, 500 ms, paused"]);
}

#[test]
fn a_filter_that_failed_is_no_loss_of_what_traces() {
    let fault = "denoised on the CPU: the GPU failed: it was unplugged";
    let shown = PaneView { filter_fault: Some(fault.into()), ..path(&[], 16) };
    assert_eq!(label(&shown, None).notes, [fault]);
    let lost = PaneView { refused: Some("it was unplugged".into()), ..shown };
    assert_eq!(label(&lost, None).notes, ["on the CPU: the GPU failed: it was unplugged", fault]);
}

#[test]
fn what_is_of_earlier_views_is_told_with_its_age() {
    let lag = |samples| Some(technique::Lag { samples, seconds: 0.44 });
    let told = |samples| label(&PaneView { lag: lag(samples), ..path(&[("spp", "64")], 12) }, None);
    assert_eq!(told(30.2).facts, ["+ 30 spp of earlier views, 0.4 s old (lag)"]);
    assert_eq!(
        (told(0.5).facts, told(0.5).figures),
        (vec!["+ 0.5 spp of earlier views, 0.4 s old (lag)".into()], vec!["12 of 64 spp, 500 ms".into()])
    );
}

#[test]
fn chains_tell_what_they_take_and_that_their_spread_is_no_error() {
    let chains = pathtrace::ChainStats { runs: 4, mutations: 4000, accepted: 2160, scales: 0.556 };
    let of_chains = |changes: &[(&str, &str)], chains| PaneView {
        provenance: Some(Arc::new(made("whitted", TechniqueName::Metropolis, changes))),
        effort: Some(Effort::Traced(Stats { samples: 4500, rays: 9000, chains, ..Stats::default() })),
        ..path(&[], 4)
    };
    let told = label(&PaneView { noisy: true, ..of_chains(&[], chains) }, None);
    assert_eq!(told.name, "Metropolis, 32 chains");
    let blotches = "still noisy in blotches: a chain's paths are alike";
    assert_eq!(told.notes, [blotches]);
    assert_eq!(told.facts, ["54 % of mutations taken, start-up scale 0.139"]);
    assert_eq!(told.whole(PaneId::B).matches("32 chains").count(), 1, "{told:?}");
    assert!(told.explanations.iter().any(|line| line.contains("does not tell the error")), "{told:?}");
    let dark = of_chains(&[("chains", "1")], pathtrace::ChainStats { runs: 4, ..pathtrace::ChainStats::default() });
    assert_eq!(label(&dark, None).facts, ["no light found, start-up scale 0"]);
    assert_eq!(label(&PaneView { rough: true, ..of_chains(&[], chains) }, None).facts, [""; 0]);
}

#[test]
fn compiling_is_told_apart_from_drawing_and_from_what_draws() {
    let shown = PaneView { adapter: Some("llvmpipe".into()), ..fake(0.0041, Compiling::Apart(0.45)) };
    let lines = label(&shown, None).explanations;
    assert_eq!(lines[..2], ["Drawn by llvmpipe", "Compiling took 450 ms once, apart from this"]);
}

#[test]
fn a_time_that_other_work_may_have_slowed_is_told_to_be_so() {
    let slowed = "Measured while A is made: once more when that is done";
    let told = |at_rest, unfinished| {
        let drawing = Drawing { compiling: Compiling::Apart(0.45), kept_maps: false, at_rest };
        let shown = PaneView { effort: Some(Effort::Drawn(drawing)), ..fake(0.0041, Compiling::Included) };
        let other = PaneView { unfinished, ..path(&[], 64) };
        let label = LabelText::of(PaneId::B, &shown, Some((PaneId::A, &other)), None, false);
        label.explanations.iter().any(|line| line == slowed)
    };
    assert!(told(false, true));
    assert!(!told(true, true), "it was measured before the other was begun anew");
    assert!(!told(false, false), "it will be in a moment");
}

#[test]
fn the_formula_of_a_fakes_highlight_is_told_with_its_picture() {
    let explained = |changes: &[_]| {
        let made = made("phong", TechniqueName::Raster, changes);
        let shown = PaneView { provenance: Some(Arc::new(made)), ..fake(0.0041, Compiling::Apart(0.45)) };
        label(&shown, None).explanations.join("\n")
    };
    let phong = "Highlight by phong: L = k_a I_a + k_d I_d max(0, N·L) + k_s I_s max(0, R·V)^p";
    assert!(explained(&[("shading", "phong")]).contains(phong), "{}", explained(&[("shading", "phong")]));
    assert!(explained(&[("shading", "blinn-phong")]).contains("k_s I_s max(0, N·H)^p"));
    assert!(!explained(&[("shading", "phong"), ("show", "shadow-map")]).contains("Highlight"), "a map has none");
}

#[test]
fn figures_are_kept_whole_where_they_fit_a_line() {
    let errors = ["A differs from B by 56 % on average", "12 % brighter overall"].map(str::to_owned).into();
    let figures = ["relMSE 1.338", "500 ms"].map(str::to_owned).into();
    let text = LabelText { errors, figures, ..LabelText::default() };
    let within = |most: usize| text.details_within(|line| line.chars().count() <= most);
    assert_eq!(within(99), ["A differs from B by 56 % on average · 12 % brighter overall", "relMSE 1.338 · 500 ms"]);
    let narrow = ["A differs from B by 56 % on average", "12 % brighter overall", "relMSE 1.338 · 500 ms"];
    assert_eq!(within(35), narrow, "exactly as wide as the first figure");
    assert_eq!(within(21), narrow, "what does not fit at all is left to break between its words");
}

#[test]
fn errors_stand_with_words_first_and_say_what_they_are_against() {
    let errors = Errors { relative_mae: 0.31, relative_bias: 0.003, rel_mse: 1.338, ..Errors::default() };
    let judged =
        label(&path(&[], 256), Some(Told { of: PaneId::B, against: Against::Reference, region: None, errors }));
    assert_eq!(judged.errors, ["31 % off on average", "0.3 % too bright overall"]);
    assert_eq!(judged.figures[0], "relMSE 1.338 against the reference");
    assert!(judged.explanations.iter().any(|line| line.contains("mean of |B - reference|")));
    let beside =
        label(&path(&[], 256), Some(Told { of: PaneId::A, against: Against::Pane(PaneId::B), region: None, errors }));
    let lines = [
        "B: Path tracing, light",
        "A differs from B by 31 % on average · 0.3 % brighter overall",
        "relMSE 1.338 · 256 spp, 500 ms",
    ];
    assert_eq!(beside.whole(PaneId::B), lines.join("\n"));
}

#[test]
fn a_mean_of_runs_says_of_how_many_and_that_what_is_left_of_its_error_is_bias() {
    let settings = &[("spp", "4"), ("runs", "8"), ("denoise", "unet")];
    let denoised = Some(Denoising { seconds: 0.25, errors_before: None });
    let of = |runs| PaneView { runs, denoised, ..path(settings, 4 * runs) };
    let errors = Errors { relative_mae: 0.31, relative_bias: -0.021, ..Errors::default() };
    let told = |against| label(&of(8), Some(Told { of: PaneId::B, against, region: None, errors }));
    let held = told(Against::Reference);
    assert_eq!(held.errors, ["31 % off on average", "bias -2.1 % (mean of 8 denoised runs)"]);
    assert_eq!(held.figures[1], "4 spp, mean of 8 runs, 500 ms");
    assert_eq!(held.facts, ["denoised by unet in 250 ms (biased)"]);
    assert_eq!(told(Against::Pane(PaneId::A)).errors[1], "2.1 % darker overall", "another picture is no truth");
    assert_eq!(label(&of(3), None).figures, ["4 spp, mean of 3 of 8 runs, 500 ms"]);
    let begun = PaneView { runs: 1, ..path(settings, 2) };
    assert_eq!(label(&begun, None).figures, ["2 of 4 spp, mean of 1 of 8 runs, 500 ms"]);
}

#[test]
fn a_view_of_trust_says_what_is_black_and_white_or_why_there_is_none() {
    let denoised = Some(Denoising { seconds: 0.25, errors_before: None });
    let of = |changes| label(&PaneView { denoised, ..path(changes, 8) }, None);
    let view = of(&[("denoise", "unet"), ("trust", "1"), ("show", "trust")]);
    assert_eq!(view.facts, ["black is the picture of unet, white that of the samples, in 250 ms"]);
    assert!(view.notes.is_empty());
    let few = PaneView { denoised, ..path(&[("denoise", "unet"), ("trust", "1"), ("spp", "3")], 3) };
    assert_eq!(label(&few, None).notes, ["nothing is trusted of fewer than 4 spp"]);
    let without = of(&[("denoise", "unet"), ("show", "trust")]);
    assert_eq!(without.notes, ["no trust to show: it needs a denoiser, and trust in the samples above 0"]);
}

#[test]
fn a_picture_says_what_it_lacks_and_where_it_is_noisy() {
    assert_eq!(label(&path(&[("bounces", "0")], 256), None).notes, ["missing: indirect light (biased)"]);
    let noisy = |changes| label(&PaneView { noisy: true, ..path(changes, 256) }, None).notes;
    assert_eq!(noisy(&[("connections", "off")]), ["still noisy under the glass: light reaches it only by chance"]);
    assert_eq!(noisy(&[]), ["still a few specks: light by way of several spheres"]);
    assert!(label(&path(&[], 256), None).notes.is_empty());
}

#[test]
fn rays_are_counted_on_the_label_where_paths_branch_and_else_where_asked() {
    let branching = label(&path(&[("branches", "4"), ("bounces", "1")], 256), None);
    let counted = "13.5 rays a sample, 27 thousand rays a second";
    assert_eq!(branching.facts[0], format!("N = 4, at most 4^2 = 16 paths a sample: {counted}"));
    let power = "The first hit branches too: vertices are one more than bounces, 2 here";
    assert_eq!(branching.explanations[1], power);
    let plain = label(&path(&[], 256), None);
    assert!(plain.facts.is_empty());
    assert_eq!(plain.explanations, [format!("{counted}, by 2 threads")]);
}

#[test]
fn rays_are_counted_beside_paths_that_branch_too() {
    let [straight, forked] = ["1", "4"].map(|n| path(&[("branches", n), ("bounces", "1")], 256));
    let beside = |other| LabelText::of(PaneId::A, &straight, Some((PaneId::B, other)), None, false).facts;
    let counted = "N = 1, one path a sample: 13.5 rays a sample, 27 thousand rays a second";
    assert_eq!(beside(&forked), [counted]);
    assert_eq!(beside(&straight), [""; 0], "neither branches");
}

#[test]
fn large_numbers_have_words() {
    let words = [12.0, 999.6, 27_000.0, 4_512_000.0, 999_960_000.0].map(large);
    assert_eq!(words, ["12", "1 thousand", "27 thousand", "4.5 million", "1.0 thousand million"]);
}

/// Those of two pictures against each other stand on A's label alone: B has one all the same.
#[test]
fn a_part_of_the_light_lacks_errors_only_against_other_light() {
    let of = |light, errors| PaneView { errors, ..path(&[("light", light)], 16) };
    let (direct, indirect, all) = (of("direct", None), of("indirect", None), of("all", None));
    let against_a =
        |shown: &PaneView, other: &PaneView| no_error(shown, Against::Pane(PaneId::A), Some((PaneId::A, other)));
    let why = Some("only L.+[DG]S*E: no error against other light".to_owned());
    assert_eq!(no_error(&indirect, Against::Reference, Some((PaneId::A, &indirect))), why);
    assert_eq!((against_a(&indirect, &direct), against_a(&indirect, &all)), (why.clone(), why));
    assert_eq!(against_a(&indirect, &indirect), None, "it is still to come");
    let measured = of("indirect", Some((Against::Pane(PaneId::A), Errors::default())));
    assert_eq!(against_a(&measured, &indirect), None);
    assert_eq!(no_error(&all, Against::Reference, None), None);
    assert_eq!(label(&indirect, None).notes, [""; 0]);
}
