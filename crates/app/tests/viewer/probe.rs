//! A pixel looked into, with the samples of its real pictures.

use super::{User, both_whole};
use crate::export::export;
use egui::Key;
use std::path::Path;
use technique::TechniqueName;
use visavis::model::{Destination, ExportRequest, ExportSubject, PaneId};
use visavis::ui::UiCommand;

const SPP: u32 = 300;

/// The samples in a table, for each pane's letter.
fn samples(file: &Path, pane: &str) -> Vec<[f32; 3]> {
    let text = std::fs::read_to_string(file).expect("a table");
    let rows = text.lines().filter(|line| line.split(',').next() == Some(pane));
    let numbers = |row: &str| row.split(',').skip(4).map(|number| number.parse().expect("a number")).collect();
    rows.map(|row| {
        let numbers: Vec<f32> = numbers(row);
        [numbers[0], numbers[1], numbers[2]]
    })
    .collect()
}

fn save_samples(user: &mut User, name: &str) -> std::path::PathBuf {
    let file = user.file(name);
    let request = ExportRequest { subject: ExportSubject::Samples, to: Destination::File(file.clone()) };
    user.viewer.borrow_mut().handle(UiCommand::Export(request));
    user.wait_for("the table", |_| file.is_file());
    file
}

/// More samples than one step has, of a pixel that is no matter which: their mean is the picture's pixel, bit for bit.
#[test]
fn the_mean_of_the_samples_is_the_pixel_of_the_picture_and_follows_it() {
    let mut user = User::of("cornell");
    user.change(|model| {
        model.session.panes[PaneId::B].truth.spp = SPP;
        model.session.panes[PaneId::A].technique = TechniqueName::Whitted;
        model.session.resolution = visavis::model::Resolution::Quarter;
        model.session.probe.at = [0.4, 0.7];
    });
    user.key(Key::B);
    user.wait_for("all samples of both", |f| {
        f.value("integral B").contains(&format!("N = {SPP}")) && f.value("integral A").contains("N = 16")
    });
    user.wait_for("both pictures", |f| {
        both_whole(f) && ["a", "b"].iter().all(|pane| f.state(pane)["unfinished"] == false)
    });
    let table = save_samples(&mut user, "samples.csv");
    for (pane, count) in [("A", 16), ("B", SPP)] {
        let file = user.file(&format!("{pane}.exr"));
        export(&mut user, &[&format!("{pane} alone"), "EXR linear"], &file);
        let image = image_file::load(&file).expect("an EXR");
        let (width, height) = image.size();
        let pixel = image.at((0.4 * width as f32) as u32, (0.7 * height as f32) as u32).expect("a pixel").to_array();
        let samples = samples(&table, pane);
        assert_eq!(samples.len(), count as usize);
        for channel in 0..3 {
            let sum: f64 = samples.iter().map(|sample| f64::from(sample[channel])).sum();
            assert_eq!((sum / f64::from(count)) as f32, pixel[channel], "{pane}, channel {channel}");
        }
    }
    user.change(|model| model.state.probed_sample = Some(7));
    user.wait_for("another sample", |f| f.value("integral B").contains("sample 8 is "));
    user.change(|model| model.session.panes[PaneId::B].technique = TechniqueName::Raster);
    user.wait_for("the fake's one value", |f| f.value("integral B").contains("there are no samples"));
    let table = save_samples(&mut user, "of-a-alone.csv");
    assert_eq!(["A", "B"].map(|pane| samples(&table, pane).len()), [16, 0], "a fake has none");
    user.change(|model| model.session.panes[PaneId::B].technique = TechniqueName::Metropolis);
    user.wait_for("why there are none", |f| f.value("integral B").contains("choose their pixels themselves"));
    assert!(!user.key(Key::B).shows("integral B"));
}
