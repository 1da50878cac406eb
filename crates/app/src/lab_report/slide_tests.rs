use super::super::tests::{changed, made_elsewhere, picture, report};
use super::*;
use crate::lettering::CAPITALS;
use crate::model::CompareWith;
use film::colour::srgb_decode;
use technique::TechniqueName;

fn of_view(view: View) -> LabReport {
    let mut report = report(SlideSize::FullHd.size_of_pictures(view));
    report.session.view = view;
    report
}

/// Rows of a part of the slide in which something of this colour is seen.
fn rows_of(rgba: &[u8], width: u32, colour: [u8; 3], [left, right]: [u32; 2]) -> Vec<u32> {
    let rows = (0..).zip(rgba.chunks_exact(4 * width as usize));
    let inked = |row: &[u8]| row[4 * left as usize..4 * right as usize].chunks_exact(4).any(|p| p[..3] == colour);
    rows.filter(|(_, row)| inked(row)).map(|(y, _)| y).collect()
}

#[test]
fn a_slide_has_the_size_that_is_asked_for() {
    let report = of_view(View::SideBySide);
    for size in SlideSize::ALL {
        let (width, height) = size.pixels();
        assert_eq!(height * 16 / 9, width);
        let rgba = report.slide(size, DARK).unwrap();
        assert_eq!(rgba.len(), 4 * width as usize * height as usize);
        assert!(rgba.chunks_exact(4).all(|pixel| pixel[3] == 255));
    }
    let none = LabReport { pictures: Vec::new(), ..report };
    assert!(none.slide(SlideSize::FullHd, DARK).unwrap_err().to_string().contains("no picture"));
}

/// At half of its size a slide is read as far away as its whole height is 45 capitals, twice what books on legibility
/// ask of a screen.
#[test]
fn capitals_of_the_smallest_type_are_a_45th_of_the_height_and_more() {
    for size in SlideSize::ALL {
        let height = size.pixels().1;
        assert!(CAPITALS * size.parts(LABEL) as f32 >= height as f32 / 45.0);
        let report = of_view(View::Pane(PaneId::B));
        let rgba = report.slide(size, DARK).unwrap();
        // of "B: Path tracing, light" the B alone
        let column = report.session.view;
        let left = (size.pixels().0 - size.size_of_pictures(column).0) / 2;
        let rows = rows_of(&rgba, size.pixels().0, DARK.panes[1], [left, left + size.parts(LABEL) * 6 / 10]);
        let high = rows.last().unwrap() - rows[0] + 1;
        assert!(high as f32 >= height as f32 / 45.0 - 1.0, "{size:?}: {high} of {height}");
    }
}

/// Relative luminance and contrast as WCAG 2.2 defines them.
#[test]
fn text_has_a_contrast_of_seven_to_one() {
    let luminance = |colour: [u8; 3]| {
        let linear = colour.map(|code| srgb_decode(f32::from(code) / 255.0));
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    };
    for colours in [DARK, LIGHT] {
        for text in [colours.text, colours.panes[0], colours.panes[1]] {
            let (a, b) = (luminance(text), luminance(colours.ground));
            let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
            assert!(contrast >= 7.0, "{text:?}: {contrast}");
        }
    }
}

#[test]
fn pictures_of_their_room_are_there_pixel_by_pixel() {
    for (view, of) in [(View::Pane(PaneId::A), 1), (View::Wipe, 2), (View::SideBySide, 2), (View::ErrorMap, 3)] {
        let mut report = of_view(view);
        // every pixel another one than its neighbours
        let (width, height) = SlideSize::FullHd.size_of_pictures(view);
        let pixels = (0..width * height).map(|i| film::Vec3::new((i % 251) as f32, (i % 241) as f32, 90.0) / 260.0);
        report.pictures[0].image = film::Image::new(width, height, pixels.collect::<Vec<_>>()).unwrap();
        let rgba = report.slide(SlideSize::FullHd, LIGHT).unwrap();
        let shown = report.session.display.rgba8_of(&report.pictures[0].image);
        let stride = 4 * SlideSize::FullHd.pixels().0 as usize;
        let first = &shown[..4 * width as usize];
        let left = SlideSize::FullHd.parts(MARGIN) + (SlideSize::FullHd.room(of).0 - width) / 2;
        let mut starts = (4 * left as usize..rgba.len() - first.len()).step_by(stride);
        let at = starts.find(|at| rgba[*at..*at + first.len()] == *first).expect("its first row");
        for (y, row) in shown.chunks_exact(first.len()).enumerate() {
            assert_eq!(&rgba[at + y * stride..at + y * stride + row.len()], row, "{view:?}: row {y}");
        }
        assert_eq!(report.columns().unwrap().len(), of as usize);
    }
}

#[test]
fn figures_of_a_region_say_so() {
    let mut report = of_view(View::SideBySide);
    let facts = |report: &LabReport| report.columns().unwrap()[0].facts.clone();
    let whole = facts(&report);
    assert!(whole[1].ends_with("off on average") && whole[2].starts_with("relMSE "), "{whole:?}");
    report.session.comparison.region = crate::model::Region::between([0.5, 0.0], [1.0, 1.0]);
    let part = facts(&report);
    assert!(part[1].ends_with("off on average, in the region") && part[2] != whole[2], "{part:?}");
}

#[test]
fn nothing_is_written_in_the_margin_however_long_a_name_is() {
    let mut report = of_view(View::ErrorMap);
    let mut scene = (*report.scene).clone();
    scene.name = "a scene of a very long name ".repeat(20) + "<script>\n\u{7}";
    report.scene = std::sync::Arc::new(scene);
    report.pictures[1] = picture(PaneId::B, TechniqueName::Metropolis, report.pictures[0].image.size(), 0.2);
    for size in SlideSize::ALL {
        let rgba = report.slide(size, DARK).unwrap();
        let (width, height) = size.pixels();
        let margin = size.parts(MARGIN) / 2;
        let ground = |x: u32, y: u32| rgba[4 * (y * width + x) as usize..][..3] == DARK.ground;
        assert!((0..height).all(|y| (0..margin).all(|x| ground(x, y) && ground(width - 1 - x, y))), "{size:?}");
        assert!((0..width).all(|x| (0..margin).all(|y| ground(x, y) && ground(x, height - 1 - y))), "{size:?}");
    }
}

#[test]
fn a_picture_of_another_size_keeps_its_shape() {
    let mut report = of_view(View::SideBySide);
    report.reference = None;
    for (pane, size) in [(0, (300, 100)), (1, (3000, 1000))] {
        report.pictures[pane] = picture(report.pictures[pane].pane, TechniqueName::Path, size, 0.5);
    }
    let (room, rgba) = (SlideSize::FullHd.room(2), report.slide(SlideSize::FullHd, DARK).unwrap());
    let grey = report.session.display.rgba8(film::Vec3::splat(0.5));
    let grey = [grey[0], grey[1], grey[2]];
    let half = SlideSize::FullHd.pixels().0 / 2;
    let high = |part| rows_of(&rgba, SlideSize::FullHd.pixels().0, grey, part).len() as u32;
    assert_eq!(high([0, half]), 100 * (room.0 / 300), "larger by a whole factor");
    assert!(high([half, 2 * half]).abs_diff(room.0 / 3) <= 1, "smaller by as much as it must be");
}

#[test]
fn the_map_of_a_slide_has_a_scale_of_its_own() {
    let mut report = of_view(View::ErrorMap);
    report.session.comparison.with = CompareWith::Reference;
    let ends = [PaneId::A, PaneId::B].map(|pane| {
        report.session.comparison.of = pane;
        let columns = report.columns().unwrap();
        assert!(columns[2].name.starts_with(&format!("{pane} against reference")), "{}", columns[2].name);
        columns[2].scale.unwrap().high
    });
    // 0.5 - 0.3 and 0.5 - 0.45, each to the 99th percentile
    assert!((ends[0] - 0.2).abs() < 1e-4 && (ends[1] - 0.05).abs() < 1e-4, "{ends:?}");
}

#[test]
fn both_ends_of_the_bar_of_a_map_have_numbers() {
    let canvas = Canvas::filled((600, 100), DARK.ground);
    // of 0.95 the only round value a third apart is 0
    let scale = ColourScale::up_to(ErrorMetric::Signed, 0.95);
    let mut drawing = Drawing { size: SlideSize::FullHd, colours: DARK, canvas, lettering: Lettering::default() };
    let below = drawing.bar(&scale, (0, 0), 600) - SlideSize::FullHd.parts(ROW);
    let rgba = drawing.canvas.rgba();
    let inked = |part| rows_of(&rgba, 600, DARK.text, part).iter().any(|y| *y > below);
    assert_eq!([[0, 100], [120, 280], [280, 320], [320, 480], [500, 600]].map(inked), [true, false, true, false, true]);
}

#[test]
fn a_denoised_picture_is_called_so() {
    let mut report = of_view(View::SideBySide);
    report.pictures[1] = changed(&report.pictures[1], &[("denoise", "atrous")]);
    let facts = |report: &LabReport, column: usize| report.columns().unwrap()[column].facts.clone();
    assert_eq!(facts(&report, 1)[1], "denoised by atrous (biased)", "beside another technique");
    assert!(!facts(&report, 0).concat().contains("denoised"));
    report.pictures[0] = picture(PaneId::A, TechniqueName::Path, report.pictures[1].image.size(), 0.3);
    let columns = report.columns().unwrap();
    assert_eq!(columns[1].name, "B: Path tracing, denoised by atrous (biased)", "where they differ by that");
    assert!(!columns[1].facts.concat().contains("denoised"), "and not twice");
}

#[test]
fn what_another_programs_picture_took_is_not_told() {
    let mut report = of_view(View::Pane(PaneId::B));
    report.pictures[1] = made_elsewhere(&report.pictures[1]);
    assert_eq!(report.columns().unwrap()[0].facts[0], "made by another program");
}

#[test]
fn the_title_names_the_reference_only_over_what_it_judges() {
    let mut report = of_view(View::Pane(PaneId::B));
    report.session.comparison.with = CompareWith::Reference;
    let title = |report: &LabReport| report.title_over(&report.columns().unwrap());
    let judged = title(&report);
    assert!(judged.ends_with(", held against the reference"), "{judged}");
    report.pictures[1] = changed(&report.pictures[1], &[("light", "direct")]);
    assert_eq!(title(&report), report.scene.name);
    assert_eq!(report.columns().unwrap()[0].facts[1..], ["a part of the light has no reference"]);
    report.session.view = View::SideBySide;
    assert_eq!(title(&report), judged, "A is judged");
}
