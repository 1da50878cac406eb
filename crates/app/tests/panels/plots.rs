//! The drawer of plots.

use crate::Panels;
use compare::Errors;
use egui::Key;
use std::sync::Arc;
use technique::{Device, PaneSettings, Provenance, Shot, TechniqueName};
use visavis::model::{
    Against, Destination, ExportRequest, ExportSubject, Measure, Model, PaneId, PlotFile, Theme, ViewModel,
};
use visavis::ui::{UiCommand, Workspaces};

/// A fake and a path-traced picture whose errors have fallen like 1 / samples.
fn course() -> ViewModel {
    let mut shown = ViewModel::default();
    for spp in [1, 2, 4, 8] {
        for (id, technique) in [(PaneId::A, TechniqueName::Raster), (PaneId::B, TechniqueName::Path)] {
            let shot = Shot::of(scene::builtin::named("cornell").expect("a built-in scene"), (8, 8));
            let technique = PaneSettings::of(technique).in_use();
            let provenance = Some(Arc::new(Provenance { shot, technique, device: Device::Cpu }));
            let (spp, error) = if id == PaneId::A { (None, 0.2) } else { (Some(spp), 1.0 / f64::from(spp)) };
            let errors = Errors { rel_mse: error, rmse: error.sqrt(), ..Errors::default() };
            let pane = shown.panes.entry(id);
            (pane.provenance, pane.spp, pane.seconds) = (provenance, spp, f64::from(spp.unwrap_or(1)));
            pane.errors = Some((Against::Reference, errors));
            shown.note_errors(id, Vec::new());
        }
    }
    shown
}

fn panels() -> Panels {
    let scene = scene::builtin::named("cornell").expect("a built-in scene");
    Panels::with(Model::new(scene, "cornell".into(), Theme::Dark), Workspaces::default(), course())
}

#[test]
fn the_drawer_opens_by_its_button_and_its_key_and_says_the_latest_errors() {
    let mut panels = panels();
    assert!(!panels.shows("relMSE 1/"), "closed at first");
    panels.click("Plots", 0);
    assert!(panels.model.borrow().session.plots.open);
    assert!(panels.shows("A: Fake, fair: relMSE 0.200; B: Path tracing, light: relMSE 0.125"));
    panels.count_named();
    panels.click("Plot: RMSE", 0);
    assert_eq!(panels.model.borrow().session.plots.measure, Measure::Rmse);
    assert!(panels.shows("B: Path tracing, light: RMSE 0.354"));
    panels.harness.key_press(Key::G);
    panels.harness.run_steps(3);
    assert!(!panels.model.borrow().session.plots.open && !panels.shows("Plot: RMSE"));
}

#[test]
fn curves_are_pinned_once_and_unpinned() {
    let mut panels = panels();
    panels.click("Plots", 0);
    panels.click("Pin", 0);
    panels.click("Pin", 0);
    let names: Vec<String> = panels.model.borrow().state.pinned.iter().map(|curve| curve.name.clone()).collect();
    assert_eq!(names, ["Fake, fair", "Path tracing, light"]);
    panels.click("Unpin all", 0);
    assert!(panels.model.borrow().state.pinned.is_empty() && !panels.shows("Unpin all"));
}

#[test]
fn a_plot_is_saved_as_numbers_or_as_a_picture_beside_the_other_exports() {
    let mut panels = panels();
    panels.click("Plots", 0);
    for (label, kind, ending) in [
        ("Save the plot as CSV", PlotFile::Csv, "relMSE-over-samples.csv"),
        ("Save the plot as SVG", PlotFile::Svg, ".svg"),
    ] {
        panels.click(label, 0);
        let asked = panels.requests.borrow_mut().pop().expect("a command");
        let UiCommand::Export(ExportRequest { subject, to: Destination::File(file) }) = asked else {
            panic!("{asked:?} is no export to a file")
        };
        assert_eq!(subject, ExportSubject::Plot(kind));
        assert!(file.to_string_lossy().ends_with(ending), "{file:?}");
    }
}
