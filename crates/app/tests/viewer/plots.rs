//! Figures of the plots are those of the pictures.

use super::export::export;
use super::{User, says};
use std::process::Command;
use technique::TechniqueName;
use visavis::model::{Destination, ExportRequest, ExportSubject, PaneId, PlotFile};
use visavis::ui::UiCommand;
use visavis_tests::Frame;

/// Both have all their samples, and the label tells an error.
fn done(frame: &Frame) -> bool {
    let [a, b] = ["a", "b"].map(|pane| frame.state(pane));
    a["spp"] == 8 && b["spp"] == 64 && a["unfinished"] == false && b["unfinished"] == false && !a["rel_mse"].is_null()
}

#[test]
fn the_last_figures_of_a_curve_are_what_compare_says_of_the_same_films() {
    let mut user = User::of("cornell");
    user.change(|model| {
        model.session.panes[PaneId::A].technique = TechniqueName::Path;
        model.session.panes[PaneId::A].truth.spp = 8;
        model.session.panes[PaneId::B].truth.spp = 64;
    });
    user.wait_for("both pictures to their last sample", done);
    let [a, b, csv] = ["a.exr", "b.exr", "errors.csv"].map(|name| user.file(name));
    export(&mut user, &["A alone", "EXR linear"], &a);
    export(&mut user, &["B alone", "EXR linear"], &b);
    let subject = ExportSubject::Plot(PlotFile::Csv);
    user.viewer.borrow_mut().handle(UiCommand::Export(ExportRequest { subject, to: Destination::File(csv.clone()) }));
    user.wait_for("the table", |f| says(f, "errors.csv"));

    let table = std::fs::read_to_string(&csv).expect("a table");
    let last = table.lines().rfind(|line| line.starts_with("\"A: ")).expect("a row of A");
    let figures: Vec<&str> = last.rsplit(',').collect();
    assert_eq!(figures[5], "8", "samples: {last}");
    let mut compare = Command::new(env!("CARGO_BIN_EXE_visavis"));
    let told = compare.arg("compare").args([&a, &b]).arg("--json").output().expect("the program");
    let told: serde_json::Value = serde_json::from_slice(&told.stdout).expect("an object");
    for (figure, name) in [(figures[3], "relmse"), (figures[2], "rmse"), (figures[1], "mae")] {
        let (plotted, told) = (figure.parse::<f64>().expect("a number"), told[name].as_f64().expect("a number"));
        // sums of the same numbers, over as many threads as there are
        assert!((plotted / told - 1.0).abs() < 1e-9, "{name}: {plotted} in the plot, {told} by compare");
        assert!(told > 0.0, "{name}");
    }
}
