//! A scene that is changed in the window, and what keeps it.

use super::{User, both_whole, says};
use technique::TechniqueName;
use visavis::model::PaneId;

const EDIT: &str = "{ material.white = { colour = [0.1, 0.6, 0.2] } }";

fn edit(user: &mut User, edit: &str) {
    user.change(|model| {
        model.session.panes[PaneId::B].technique = TechniqueName::Raster;
        model.document.changes.take_edits(&edit.parse().expect("changes"));
        model.apply_changes();
    });
    user.wait_for("pictures of the changed scene", |f| both_whole(f) && f.value("label A").contains("edited: 1 part"));
}

fn edits(user: &mut User) -> String {
    let mut edits = String::new();
    user.change(|model| edits = model.document.changes.edits.to_string());
    edits
}

#[test]
fn a_picture_of_a_changed_scene_opens_as_it_was() {
    let mut user = User::of("cornell");
    edit(&mut user, EDIT);
    let file = user.file("edited.png");
    super::export::export(&mut user, &["A alone", "PNG as shown"], &file);
    user.open("whitted");
    user.wait_for("another scene", |f| f.state("scene") == "whitted" && both_whole(f));
    assert_eq!(edits(&mut user), "{}");
    user.drop_file(&file);
    user.wait_for("the changed scene", |f| {
        f.state("scene") == "cornell" && f.value("label A").contains("edited: 1 part")
    });
    assert_eq!(edits(&mut user), EDIT);
}

#[test]
fn a_changed_scene_is_saved_as_one_of_its_own() {
    let mut user = User::of("cornell");
    user.wait_for("both pictures", both_whole);
    let file = user.file("green.toml");
    let typed = file.display().to_string();
    let save = |user: &mut User| {
        user.click("Export");
        let menu = user.click("Changed scene");
        assert!(!menu.shows("copy picture"));
        user.type_into("File", &typed);
        user.click("Save");
    };
    save(&mut user);
    user.wait_for("the refusal", |f| says(f, "nothing is changed in cornell"));
    assert!(!file.exists());
    edit(&mut user, EDIT);
    save(&mut user);
    let saved = user.wait_for("the file", |f| says(f, "green.toml"));
    assert!(says(&saved, "open it as any scene"), "{}", saved.state("message"));
    let text = std::fs::read_to_string(&file).expect("a scene's file");
    assert!(text.contains("base = \"cornell\"") && text.contains("[edit.material.white]"), "{text}");
    assert!(!text.contains("[camera]"), "{text}");
}
