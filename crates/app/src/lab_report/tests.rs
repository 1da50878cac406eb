use super::*;
use crate::model::{Against, CompareWith, ErrorPoint, Owner, PaneSource, Region};
use compare::{ErrorMetric, Errors, errors, finite_mean};
use film::Vec3;
use technique::settings::of_panes;
use technique::{Device, PaneSettings, Shot, TechniqueName};

/// A picture of this grey beside a brighter edge, as a pane's.
pub(super) fn picture(pane: PaneId, technique: TechniqueName, size: (u32, u32), grey: f32) -> ReportedPicture {
    let scene = scene::builtin::named("cornell").unwrap();
    let radiance = |i: u32| Vec3::splat(if i.is_multiple_of(size.0) { 0.9 } else { grey });
    let pixels: Vec<Vec3> = (0..size.0 * size.1).map(radiance).collect();
    let technique = PaneSettings::of(technique).in_use();
    let spp = (technique.name() != TechniqueName::Raster).then_some(16);
    ReportedPicture {
        pane,
        image: Image::new(size.0, size.1, pixels).unwrap(),
        provenance: Provenance { shot: Shot::of(scene, size), technique, device: Device::Cpu },
        external: None,
        spp,
        runs: 1,
        seconds: 2.5,
        core_seconds: Some(5.0),
        stats: spp.map(|_| Stats { samples: 4_000, rays: 10_000, ..Stats::default() }),
        adapter: "2 threads".into(),
        notes: Vec::new(),
    }
}

/// The same picture by changed settings.
pub(super) fn changed(picture: &ReportedPicture, changes: &[(&str, &str)]) -> ReportedPicture {
    let mut pane = PaneSettings::from(picture.provenance.technique);
    for (name, word) in changes {
        let row = of_panes(name).unwrap();
        pane.set(row, row.kind.parse(word).unwrap());
    }
    let provenance = Provenance { technique: pane.in_use(), ..picture.provenance.clone() };
    ReportedPicture { provenance, ..picture.clone() }
}

/// The same picture by another program.
pub(super) fn made_elsewhere(picture: &ReportedPicture) -> ReportedPicture {
    let source = PaneSource::Received(14158);
    let external = External { name: "mine".into(), source, changes: 1, notes: Vec::new(), fault: None };
    let provenance =
        Provenance { technique: PaneSettings::of(TechniqueName::Raster).in_use(), ..picture.provenance.clone() };
    let (external, stats) = (Some(Arc::new(external)), None);
    ReportedPicture { provenance, external, spp: None, stats, seconds: 0.0, core_seconds: None, ..picture.clone() }
}

/// The fake beside path tracing and a reference with an error of its own.
pub(super) fn report(size: (u32, u32)) -> LabReport {
    let pictures =
        vec![picture(PaneId::A, TechniqueName::Raster, size, 0.3), picture(PaneId::B, TechniqueName::Path, size, 0.45)];
    let truth = picture(PaneId::A, TechniqueName::Path, size, 0.5).image;
    let standard_errors = vec![Vec3::splat(0.01); truth.radiances().len()];
    let noise = Some(1e-4);
    let image = ReferenceImage { image: truth, standard_errors: Some(standard_errors.into()), noise };
    let point = |spp: u32| ErrorPoint {
        spp: Some(spp),
        seconds: 0.1 * f64::from(spp),
        errors: Errors { rel_mse: 1.0 / f64::from(spp), ..Errors::default() },
    };
    let curve = Curve {
        name: "B: path".into(),
        owner: Owner::Pane(PaneId::B),
        points: [1, 4, 16].map(point).into(),
        against: Against::Reference,
        region: None,
    };
    LabReport {
        scene: pictures[0].provenance.shot.scene.clone(),
        session: Session::default(),
        pictures,
        reference: Some(ReportedReference { image, made: "64 pictures, 1.0 s".into() }),
        curves: vec![curve],
        session_text: "session = 1\nscene = \"cornell\"\n".into(),
        date: "2026-03-01".into(),
    }
}

/// Elements that have no end, by the HTML standard, 13.1.2.
const VOID: [&str; 4] = ["meta", "img", "br", "link"];

/// Checks that every tag is closed in its order and every attribute quoted; returns the values of `src` and `href`.
fn addresses(html: &str) -> Vec<String> {
    let body = html.strip_prefix("<!DOCTYPE html>\n").expect("a doctype");
    let (mut open, mut found): (Vec<&str>, Vec<String>) = (Vec::new(), Vec::new());
    for part in body.split('<').skip(1) {
        let (tag, text) = part.split_once('>').expect("a tag that ends");
        let is_style = open.last() == Some(&"style") || tag == "style";
        assert!(is_style || !text.contains('>'), "a bare > in: {text}");
        let name = tag.split([' ', '/', '\n']).find(|word| !word.is_empty()).expect("a name");
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "in {tag}");
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
        for name in ["src=\"", "href=\""] {
            found.extend(tag.split(name).skip(1).map(|rest| rest.split('"').next().unwrap_or_default().to_owned()));
        }
    }
    assert_eq!(open, Vec::<&str>::new(), "left open");
    found
}

#[test]
fn the_page_is_well_formed_and_needs_nothing_else() {
    let html = report((24, 16)).html().unwrap();
    let addresses = addresses(&html);
    assert_eq!(addresses.len(), 3 + 2 * 2 + 1, "two pictures, the reference, two maps with their bars, the session");
    assert!(addresses.iter().all(|address| address.starts_with("data:")), "{addresses:?}");
    assert!(!html.contains("<script") && !html.contains("url(") && !html.contains("@import"));
    let images = html.matches("<img ").count();
    assert_eq!((html.matches(" alt=\"").count(), html.matches("<figcaption>").count()), (images, 3 + 2 + 2));
    assert!(html.matches("<caption>").count() == html.matches("<table").count() && html.contains("scope=\"col\""));
    let level = |tag: &str| html.matches(tag).count();
    assert_eq!((level("<h1>"), level("<h2>"), level("<h3")), (1, 6, 0), "no level of headings is left out");
}

#[test]
fn names_from_outside_stay_text() {
    let mut report = report((8, 8));
    let evil = "<script>alert('1')</script>\"><img src=x onerror=alert(2)>&\u{7}";
    let mut scene = (*report.scene).clone();
    scene.name = evil.into();
    report.scene = Arc::new(scene);
    report.session_text = format!("scene = \"{evil}\"\n");
    for picture in &mut report.pictures {
        picture.provenance.shot.source = evil.into();
        picture.adapter = evil.into();
        picture.notes = vec![evil.into()];
    }
    report.reference.as_mut().unwrap().made = evil.into();
    let html = report.html().unwrap();
    assert!(addresses(&html).iter().all(|address| address.starts_with("data:")));
    assert!(!html.contains("<script") && !html.contains("<img src=x"), "it is no element");
    assert!(html.contains("&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt;"), "but told");
}

#[test]
fn figures_are_those_of_the_ruler() {
    let report = report((24, 16));
    let reference = report.reference.as_ref().unwrap().image.clone();
    let measured = report.measured().unwrap();
    let of: Vec<_> = measured.iter().map(|measured| (measured.of, measured.against)).collect();
    let against = Against::Reference;
    assert_eq!(of, [(PaneId::A, against), (PaneId::B, against), (PaneId::A, Against::Pane(PaneId::B))]);
    for (measured, picture) in measured.iter().zip(&report.pictures) {
        assert_eq!(measured.errors, errors(&picture.image, &reference.image).unwrap().with_reference_noise(1e-4));
        let flip = ErrorMetric::Flip.of(&picture.image, &reference.image, &report.session.display).unwrap();
        assert_eq!(measured.flip, finite_mean(&flip).0);
    }
    let html = report.html().unwrap();
    for errors in measured.iter().map(|measured| measured.errors) {
        let row = [errors.rel_mse, errors.rmse, errors.mae].map(|v| format!("<td class=\"n\">{v:.6}</td>")).concat();
        assert!(html.contains(&row), "{row}");
    }
    assert!(html.contains("0.010000 (RMSE of the reference itself)"));
}

#[test]
fn a_region_has_rows_of_its_own() {
    let mut report = report((24, 16));
    report.session.comparison.region = Region::between([0.5, 0.0], [1.0, 1.0]);
    let measured = report.measured().unwrap();
    let (whole, part): (Vec<_>, Vec<_>) = measured.iter().partition(|measured| !measured.in_the_region);
    assert_eq!((whole.len(), part.len()), (3, 3));
    // the edge that all pictures have in common is outside
    assert!((part[0].errors.mae - 0.2).abs() < 1e-6 && whole[0].errors.mae < 0.199, "{measured:?}");
    let html = report.html().unwrap();
    assert!(html.contains("A, in the region</th>") && html.contains("from 50.0 %, 0.0 % to 100.0 %, 100.0 %"));
}

#[test]
fn without_a_reference_the_pictures_are_held_against_each_other_and_the_page_says_so() {
    let report = LabReport { reference: None, curves: Vec::new(), ..report((24, 16)) };
    let html = report.html().unwrap();
    assert!(html.contains("Errors of A against B") && html.contains("either may be wrong"));
    assert!(html.contains("No errors were measured") && !html.contains("<svg"));
    addresses(&html);
    let other = |size| picture(PaneId::B, TechniqueName::Path, size, 0.4);
    let uneven = LabReport { pictures: vec![report.pictures[0].clone(), other((9, 9))], ..report };
    assert!(uneven.html().unwrap().contains("None of these pictures"), "nothing of the same pixels");
}

#[test]
fn settings_that_say_nothing_are_folded_away() {
    let mut report = report((8, 8));
    report.pictures.remove(0);
    let mut settings = PaneSettings::from(report.pictures[0].provenance.technique);
    settings.take_usual_estimator(&report.scene);
    settings.truth.path.bounces = Some(2);
    report.pictures[0].provenance.technique = settings.in_use();
    let rows = report.rows();
    let said: Vec<_> = rows.iter().filter(|row| row.says_something()).map(|row| row.name).collect();
    assert_eq!(said, ["bounces"], "all others are as usual");
    let bounces = rows.iter().find(|row| row.name == "bounces").unwrap();
    assert_eq!((bounces.values[0].as_deref(), bounces.usual_words().as_str()), (Some("2"), "inf"));
    assert!(rows.len() > 5, "{rows:?}");
}

#[test]
fn a_large_picture_is_embedded_smaller_and_the_page_says_so() {
    let html = report((2000, 4)).html().unwrap();
    assert!(html.contains("width=\"1000\" height=\"2\"") && html.contains("the mean of 2 × 2 pixels is one"));
    assert!(html.contains("All pictures have 2000 × 4 pixels"));
}

#[test]
fn the_session_is_text_and_a_file_to_save() {
    let report = report((8, 8));
    let html = report.html().unwrap();
    let address = bench::data_uri("application/toml", report.session_text.as_bytes());
    assert!(html.contains(&format!("<a download=\"session.toml\" href=\"{address}\">")));
    assert!(html.contains("session = 1\nscene = &quot;cornell&quot;\n</code></pre>"));
    for picture in &report.pictures {
        assert!(html.contains(&compare::escaped(&picture.command(0.0))), "the line that makes it");
    }
}

#[test]
fn a_denoised_picture_and_one_made_elsewhere_are_called_so_wherever_the_page_names_them() {
    let mut report = report((8, 8));
    report.pictures[1] = changed(&report.pictures[1], &[("denoise", "atrous")]);
    report.pictures[0] = made_elsewhere(&report.pictures[0]);
    let html = report.html().unwrap();
    let name = "B: Path tracing, light, denoised by atrous (biased)";
    assert!(html.contains(&format!("<p>A: mine; {name}. ")), "the head");
    assert!(html.contains(&format!("<figcaption><b>{name}</b>")), "the picture");
    assert!(html.contains("<b>A: mine</b><br>made by another program; "), "and not what it took");
}

#[test]
fn why_a_part_of_the_light_has_no_row_of_errors_is_told() {
    let mut report = report((8, 8));
    report.session.comparison.with = CompareWith::Reference;
    let words = "a part of the light has no reference";
    assert!(!report.html().unwrap().contains(words));
    report.pictures[1] = changed(&report.pictures[1], &[("light", "direct")]);
    let html = report.html().unwrap();
    assert!(html.contains(&format!("<p class=\"note\">B: {words}.</p>")) && html.contains(&format!("; {words}")));
    let size = report.pictures[1].image.size();
    let indirect = picture(PaneId::A, TechniqueName::Path, size, 0.3);
    report.pictures[0] = changed(&indirect, &[("light", "indirect")]);
    report.reference = None;
    let html = report.html().unwrap();
    assert!(html.contains("pictures of different light are not held against each other"));
    assert!(!html.contains("None of these pictures"), "that is not why");
}
