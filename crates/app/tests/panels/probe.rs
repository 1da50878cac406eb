//! The probe: a pixel looked into.

use crate::Panels;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Shape, Vec2, pos2, vec2};
use film::{Image, Vec3};
use pathtrace::{FirstVertex, LeftOut, LightPaths, Met, Term, Terms};
use std::sync::Arc;
use technique::{Device, PaneSettings, Provenance, Shot, TechniqueName};
use visavis::model::{
    Channel, Destination, ExportRequest, ExportSubject, External, Model, PaneId, PaneProbe, PaneSource, PixelSamples,
    Theme, ViewModel,
};
use visavis::ui::{UiCommand, Workspaces};

/// Samples of B: every fourth finds nothing, and one of them is a firefly.
fn samples() -> Vec<Vec3> {
    let sample = |i: u32| if i.is_multiple_of(4) { Vec3::ZERO } else { Vec3::splat(if i == 17 { 90.0 } else { 0.5 }) };
    (0..64).map(sample).collect()
}

fn vertex() -> FirstVertex {
    let term = |radiance: f32, survival| Term {
        f_r: Vec3::splat(0.25),
        cosine: 0.5,
        pdf: 2.0,
        radiance: Vec3::splat(radiance),
        weight: 1.0,
        survival,
        product: Vec3::splat(radiance * survival / 16.0),
    };
    let terms = Terms { light: Some(term(8.0, 1.0)), by_chance: None, onward: Some(term(4.0, 2.0)) };
    let left_out = LeftOut::default();
    FirstVertex { met: Met::Diffuse, emitted: Vec3::ZERO, value: Vec3::ONE, terms: Ok(terms), left_out }
}

/// A window in which this is known of B's pixel.
fn panels(probe: PaneProbe) -> Panels {
    let mut shown = ViewModel::default();
    shown.probe.insert(PaneId::B, probe);
    panels_that_show(shown)
}

fn panels_that_show(shown: ViewModel) -> Panels {
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    let mut panels = Panels::with(Model::new(scene, "cornell".into(), Theme::Dark), Workspaces::default(), shown);
    panels.harness.run_steps(2);
    panels
}

fn probe_of_samples() -> PaneProbe {
    let samples = Some(Arc::new(PixelSamples::new([3, 4], 64, samples())));
    PaneProbe { samples, vertex: Some((63, vertex())), fault: None }
}

fn with_samples() -> Panels {
    panels(probe_of_samples())
}

/// What there is to show where B was traced and then had a picture of one grey.
fn with_a_picture(external: Option<External>) -> ViewModel {
    let mut shown = ViewModel::default();
    shown.probe.insert(PaneId::B, probe_of_samples());
    let pane = shown.panes.entry(PaneId::B);
    pane.image = Image::new(8, 8, vec![Vec3::splat(0.25); 64]);
    pane.external = external.map(Arc::new);
    shown
}

impl Panels {
    /// Presses the button here and lets go of it there.
    fn press_and_release(&mut self, [from, to]: [Pos2; 2]) {
        let modifiers = Modifiers::NONE;
        let button = |pos, pressed| Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers };
        for event in [Event::PointerMoved(from), button(from, true), Event::PointerMoved(to), button(to, false)] {
            self.harness.event(event);
            self.harness.step();
        }
        self.harness.run_steps(2);
    }

    fn probed(&self) -> Option<([f32; 2], Option<u32>)> {
        self.wanted().probe.map(|wish| (wish.at, wish.sample))
    }

    fn pixel(&self) -> [u32; 2] {
        let model = self.model.borrow();
        model.session.probe.pixel(model.state.picture.size)
    }
}

#[test]
fn it_opens_by_its_key_and_its_button_and_is_wanted_while_it_is_open() {
    let mut panels = with_samples();
    assert_eq!(panels.probed(), None);
    panels.press_with(Key::B, Modifiers::NONE);
    assert_eq!(panels.probed(), Some(([0.5; 2], None)));
    panels.count_named();
    panels.click("Close the probe", 0);
    assert_eq!(panels.probed(), None);
    panels.click("Probe", 0);
    assert!(panels.probed().is_some());
}

#[test]
fn alt_and_arrows_move_the_pixel_and_with_shift_turn_to_another_sample() {
    let mut panels = with_samples();
    panels.press_with(Key::ArrowRight, Modifiers::ALT);
    assert_eq!(panels.model.borrow().session.probe.at, [0.5; 2], "closed");
    panels.press_with(Key::B, Modifiers::NONE);
    let [column, row] = panels.pixel();
    panels.press_with(Key::ArrowRight, Modifiers::ALT);
    panels.press_with(Key::ArrowUp, Modifiers::ALT);
    assert_eq!(panels.pixel(), [column + 1, row - 1]);
    let sample = |panels: &Panels| panels.probed().expect("a wish").1;
    panels.press_with(Key::ArrowLeft, Modifiers::ALT | Modifiers::SHIFT);
    assert_eq!(sample(&panels), Some(62), "the one before the last");
    panels.click("Sample before", 0);
    assert_eq!(sample(&panels), Some(61));
    panels.click("Sample after", 0);
    panels.press_with(Key::ArrowRight, Modifiers::ALT | Modifiers::SHIFT);
    panels.press_with(Key::ArrowRight, Modifiers::ALT | Modifiers::SHIFT);
    assert_eq!(sample(&panels), None, "the last, however many come");
    assert_eq!(panels.pixel(), [column + 1, row - 1]);
}

#[test]
fn a_click_chooses_the_pixel_while_it_is_open_and_a_drag_still_moves_the_camera() {
    let mut panels = with_samples();
    let at = |panels: &Panels, share: [f32; 2]| {
        let [left, top, right, bottom] = panels.model.borrow().state.picture.corners;
        pos2(left, top) + Vec2::from(share) * vec2(right - left, bottom - top)
    };
    let place = at(&panels, [0.25, 0.75]);
    panels.press_and_release([place; 2]);
    assert_eq!(panels.model.borrow().session.probe.at, [0.5; 2], "closed");
    panels.press_with(Key::B, Modifiers::NONE);
    let place = at(&panels, [0.25, 0.75]);
    panels.press_and_release([place; 2]);
    let [x, y] = panels.model.borrow().session.probe.at;
    assert!((x - 0.25).abs() < 1e-3 && (y - 0.75).abs() < 1e-3, "{x}, {y}");
    let camera = panels.model.borrow().document.camera;
    let ends = [at(&panels, [0.25, 0.25]), at(&panels, [0.3, 0.25])];
    panels.press_and_release(ends);
    assert_eq!(panels.model.borrow().session.probe.at, [x, y]);
    assert_ne!(panels.model.borrow().document.camera, camera);
}

#[test]
fn it_says_mean_errors_zeros_firefly_and_the_integral_in_numbers() {
    let mut panels = with_samples();
    panels.press_with(Key::B, Modifiers::NONE);
    let channel = PixelSamples::new([3, 4], 64, samples());
    let last = *channel.drawn(Channel::Luminance).course.last().expect("a mean");
    let mean = format!("{:.3} ± {:.3}", last.mean, 2.0 * last.error);
    assert!(panels.shows(&format!("B: {mean} of 64 samples")), "{mean}");
    assert!(panels.shows("B: 25 % are 0; the largest is 90.000, of sample 18"));
    assert!(panels.shows("B: sees a diffuse surface first; sample 64 is 1.000"));
    assert!(panels.shows("Ldir = 0.250 (fr) · 8.000 (Li) · 0.500 (cosθ) / 2.000 (p) = 0.500"));
    assert!(panels.shows("Lindir = 0.250 (fr) · 4.000 (Li) · 0.500 (cosθ) / 2.000 (p) · 2.000 (1/q) = 0.500"));
    assert!(panels.shows("N = 64: mean "));
    panels.click("Samples: green", 0);
    assert_eq!(panels.model.borrow().session.probe.channel, Channel::Green);
    assert!(panels.shows("Mean green of the samples"));
    panels.click("Save the samples as CSV", 0);
    let asked = panels.requests.borrow_mut().pop().expect("a command");
    let UiCommand::Export(ExportRequest { subject: ExportSubject::Samples, to: Destination::File(file) }) = asked
    else {
        panic!("{asked:?} is no export of samples")
    };
    assert!(file.to_string_lossy().contains("samples-at-") && file.extension().is_some_and(|e| e == "csv"), "{file:?}");
}

#[test]
fn what_has_no_samples_of_one_pixel_says_why() {
    let fault = Some("the chains of Metropolis choose their pixels themselves".to_owned());
    let mut panels = panels(PaneProbe { fault, ..PaneProbe::default() });
    panels.model.borrow_mut().session.panes[PaneId::B].technique = TechniqueName::Metropolis;
    panels.press_with(Key::B, Modifiers::NONE);
    assert!(panels.shows("B: no samples of one pixel: the chains of Metropolis choose their pixels themselves"));
    assert!(!panels.shows("Sample before"));
}

#[test]
fn another_programs_picture_has_one_value_whatever_the_pane_was_before() {
    let source = PaneSource::Followed("/pictures/mine.exr".into());
    let (name, notes, fault) = ("mine.exr".to_owned(), Vec::new(), None);
    let external = External { name, source: source.clone(), changes: 0, notes, fault };
    for (shown, words) in [
        (with_a_picture(Some(external)), "B: 0.250, one value: the picture of another program has no samples here"),
        (with_a_picture(None), "B: no picture yet"),
    ] {
        let mut panels = panels_that_show(shown);
        panels.model.borrow_mut().session.set_source(PaneId::B, source.clone());
        panels.press_with(Key::B, Modifiers::NONE);
        assert!(panels.shows(words), "{words}");
        for of_samples in ["B: tracing", "N = 64", "of 64 samples", "are 0", "Sample before"] {
            assert!(!panels.shows(of_samples), "{words}: {of_samples}");
        }
    }
}

/// The same picture, made so.
fn with_a_picture_by(technique: TechniqueName, device: Device) -> ViewModel {
    let mut shown = with_a_picture(None);
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    let provenance =
        Provenance { shot: Shot::of(scene, (8, 8)), technique: PaneSettings::of(technique).in_use(), device };
    shown.panes[PaneId::B].provenance = Some(Arc::new(provenance));
    shown
}

#[test]
fn a_fake_has_the_value_of_its_own_picture_and_of_none_that_was_traced_before() {
    for (shown_is, words) in [
        (TechniqueName::Raster, "B: 0.250, one value: there are no samples"),
        (TechniqueName::Path, "B: no picture yet"),
    ] {
        let mut panels = panels_that_show(with_a_picture_by(shown_is, Device::Cpu));
        panels.model.borrow_mut().session.panes[PaneId::B].technique = TechniqueName::Raster;
        panels.press_with(Key::B, Modifiers::NONE);
        assert!(panels.shows(words) && !panels.shows("of 64 samples"), "{words}");
    }
}

#[test]
fn it_says_of_which_picture_the_samples_are_where_what_is_shown_is_another() {
    let mut of_the_gpu = panels_that_show(with_a_picture_by(TechniqueName::Path, Device::Gpu));
    of_the_gpu.press_with(Key::B, Modifiers::NONE);
    assert!(of_the_gpu.shows("by the processor: the GPU, which made the picture, rounds differently"));
    assert!(!of_the_gpu.shows("runs"));
    let mut of_runs = with_samples();
    of_runs.model.borrow_mut().session.panes[PaneId::B].runs = 4;
    of_runs.press_with(Key::B, Modifiers::NONE);
    assert!(of_runs.shows("the first of 4 runs") && !of_runs.shows("by the processor"));
}

/// Whether a shape is a line of many steps, each upright or level.
fn is_of_steps(shape: &Shape) -> bool {
    let is_step = |ends: &[Pos2]| (ends[1] - ends[0]).abs().min_elem() < 1e-3;
    match shape {
        Shape::Vec(shapes) => shapes.iter().any(is_of_steps),
        Shape::Path(path) => path.points.len() > 20 && path.points.windows(2).all(is_step),
        _ => false,
    }
}

/// A is drawn solid, and plots make bands of solid lines.
#[test]
fn the_outline_of_a_histogram_has_upright_steps() {
    let mut shown = ViewModel::default();
    shown.probe.insert(PaneId::A, probe_of_samples());
    let mut panels = panels_that_show(shown);
    panels.model.borrow_mut().session.panes[PaneId::A].technique = TechniqueName::Path;
    let has_steps = |panels: &Panels| panels.harness.output().shapes.iter().any(|drawn| is_of_steps(&drawn.shape));
    assert!(!has_steps(&panels), "closed");
    panels.press_with(Key::B, Modifiers::NONE);
    assert!(has_steps(&panels));
}

#[test]
fn a_part_of_the_light_is_named_in_the_head() {
    let mut panels = with_samples();
    let indirect = LightPaths::parse("indirect").expect("light paths");
    panels.model.borrow_mut().session.panes[PaneId::B].truth.path.paths = indirect;
    panels.press_with(Key::B, Modifiers::NONE);
    assert!(panels.shows("B: only L.+[DG]S*E"));
    panels.model.borrow_mut().session.set_source(PaneId::B, PaneSource::Followed("theirs.exr".into()));
    panels.harness.run_steps(2);
    assert!(!panels.shows("B: only"), "another program's light is not known");
}
