//! Rays on the graphics device: chosen, shown and recorded.

use super::export::export;
use super::{User, both_whole};
use film::Feature;
use technique::{DeviceChoice, TechniqueName};
use visavis::model::PaneId;
use visavis_tests::Frame;

fn made_by(frame: &Frame, device: &str) -> bool {
    frame.state("b")["device"] == device && both_whole(frame)
}

#[test]
fn the_gpu_traces_b_says_so_and_is_recorded() {
    let mut user = User::of("cornell");
    let first = user.wait_for("both pictures", both_whole);
    assert_eq!(first.state("b")["device"], "cpu", "auto, where the processor plays the adapter");
    user.unfold_more("B");
    let chosen = user.click_in("B", "Rays are traced by: the GPU");
    assert_eq!(chosen.value("B device the GPU"), "true");
    let traced = user.wait_for("a picture by the GPU", |f| made_by(f, "gpu"));
    assert!(traced.value("label B").contains("on the GPU"), "{}", traced.value("label B"));
    assert!(traced.state("b")["refused"].is_null() && traced.state("b")["fault"].is_null());
    let file = user.file("b.exr");
    export(&mut user, &["B alone", "EXR linear"], &file);
    let records = image_file::records(&file).expect("records");
    let value = |name: &str| records.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str());
    assert_eq!(value("device"), Some("gpu"));
    assert!(value("command").is_some_and(|command| command.contains("--device gpu")), "{records:?}");
    assert!(value("adapter").is_some_and(|adapter| !adapter.contains("threads")), "{records:?}");

    user.click("Undo");
    let undone = user.wait_for("the processor again", |f| made_by(f, "cpu"));
    assert!(!undone.value("label B").contains("GPU"), "{}", undone.value("label B"));
}

/// Both of Mesa's interfaces are there to choose from, by name.
#[test]
fn an_adapter_is_chosen_by_its_name() {
    let mut user = User::beside("cornell", egui::vec2(1280.0, 720.0), 1.0, DeviceChoice::Gpu);
    let more = user.unfold_more("B");
    assert!(more.value("text B adapter").ends_with("Vulkan"), "{}", more.value("text B adapter"));
    let open = user.click_in("B", "Adapter");
    let entry = open.names().into_iter().find(|name| name.starts_with("B adapter") && name.ends_with("OpenGL"));
    let name = entry.expect("an entry").trim_start_matches("B adapter ").to_owned();
    let chosen = user.click(&name);
    assert!(chosen.value("text B adapter").ends_with("OpenGL"));
    user.wait_for("its picture", |f| {
        made_by(f, "gpu") && f.state("b")["adapter"].as_str().is_some_and(|adapter| adapter.ends_with("OpenGL"))
    });
}

/// Each sample has a photon map of its own, on the device that is asked for; the photons' points are not for it, and the
/// pane says so.
#[test]
fn the_gpu_makes_photon_maps_and_the_processor_shows_their_points() {
    let mut user = User::beside("cornell", egui::vec2(1280.0, 720.0), 1.0, DeviceChoice::Gpu);
    user.change(|model| {
        let pane = &mut model.session.panes[PaneId::B];
        pane.technique = TechniqueName::Photon;
        (pane.photon.spp, pane.photon.photon.photons) = (2, 1 << 12);
    });
    let of_photons = |f: &Frame| f.value("label B").to_lowercase().contains("photon");
    let traced = user.wait_for("photons by the GPU", |f| made_by(f, "gpu") && of_photons(f));
    assert!(traced.state("b")["refused"].is_null() && traced.value("label B").contains("on the GPU"));
    user.change(|model| model.session.panes[PaneId::B].photon.photon.points = true);
    user.wait_for("their points by the processor", |f| made_by(f, "cpu"));
    let more = user.unfold_more("B");
    assert_eq!(more.value("text B device"), "photons are shown as points by the processor alone");
}

#[test]
fn the_gpu_shows_albedo_where_it_traces_the_light() {
    let mut user = User::beside("cornell", egui::vec2(1280.0, 720.0), 1.0, DeviceChoice::Gpu);
    user.change(|model| model.session.panes[PaneId::B].feature = Some(Feature::Albedo));
    let by_the_gpu = |f: &Frame| made_by(f, "gpu") && f.value("label B").contains("Albedo by rays");
    let shown = user.wait_for("albedo by the GPU", by_the_gpu);
    assert!(shown.state("b")["refused"].is_null() && shown.value("label B").contains("on the GPU"));
    assert_eq!(user.unfold_more("B").value("B device the GPU"), "true");
}
